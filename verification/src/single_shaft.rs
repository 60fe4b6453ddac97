//! A shaft on linear supports without bearings: whirl, unbalance response, damped critical speeds. Closed forms and other programs have this
//! problem; scenes of this program have bearings.

use bearing_dynamics::ch4_rotor::disc::unbalance_force;
use bearing_dynamics::members::beam::{Beam, BeamMatrices, STATION};
use bearing_dynamics::vibrations::critical_speeds::Critical;
use bearing_dynamics::vibrations::rotor::{LinearSystem, RotorError, RotorModel};
use nalgebra::{Complex, DMatrix, DVector, Matrix4};

/// A linear spring and dashpot between a shaft section and the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// Position, m from the shaft's first end.
    pub at: f64,
    /// Stiffness over y, z, turn_y, turn_z: N/m, N, N·m.
    pub stiffness: Matrix4<f64>,
    /// Damping over the same: N·s/m, N·s, N·m·s.
    pub damping: Matrix4<f64>,
}

/// Fixed coordinates of a shaft section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fixed {
    /// Position, m from the shaft's first end.
    pub at: f64,
    /// y, z, turn_y, turn_z.
    pub coordinates: [bool; 4],
}

impl Fixed {
    /// y and z fixed.
    pub fn pin(at: f64) -> Fixed {
        Fixed { at, coordinates: [true, true, false, false] }
    }

    pub fn clamp(at: f64) -> Fixed {
        Fixed { at, coordinates: [true; 4] }
    }
}

/// A shaft and its supports.
#[derive(Clone, Debug, PartialEq)]
pub struct SingleShaft {
    pub beam: Beam,
    pub supports: Vec<Support>,
    pub fixed: Vec<Fixed>,
    /// α of the damping α M of lateral motion in axes that do not turn, 1/s.
    pub mass_damping: f64,
    /// Positions of further stations, m.
    pub places: Vec<f64>,
    /// Largest number of modes kept.
    pub modes: usize,
}

impl SingleShaft {
    /// A free shaft; twelve modes in each plane.
    pub fn new(beam: Beam) -> SingleShaft {
        let (supports, fixed, places) = (Vec::new(), Vec::new(), Vec::new());
        SingleShaft { beam, supports, fixed, mass_damping: 0.0, places, modes: 24 }
    }

    /// The shaft over its modes at rest.
    ///
    /// # Errors
    /// Sections that no shaft has; an unstable equilibrium; nothing that moves.
    pub fn model(&self) -> Result<RotorModel, RotorError> {
        let supports = self.supports.iter().map(|support| support.at);
        let fixed = self.fixed.iter().map(|fixed| fixed.at);
        let places: Vec<f64> = supports.chain(fixed).chain(self.places.iter().copied()).collect();
        let matrices = self.beam.matrices(&places)?;
        let mut stiffness = matrices.stiffness.clone();
        let mut damping = &matrices.mass * self.mass_damping;
        for support in &self.supports {
            let first = STATION * station(&matrices, support.at);
            let mut block = stiffness.fixed_view_mut::<STATION, STATION>(first, first);
            block += support.stiffness;
            let mut block = damping.fixed_view_mut::<STATION, STATION>(first, first);
            block += support.damping;
        }
        let size = matrices.mass.nrows();
        let system = LinearSystem {
            free: self.free_coordinates(&matrices),
            mass: matrices.mass,
            stiffness,
            damping,
            gyroscopic: matrices.gyroscopic,
            circulating: DMatrix::zeros(size, size),
            pairs: (0..size / 2).map(|pair| [2 * pair, 2 * pair + 1]).collect(),
            relaxing: Vec::new(),
        };
        RotorModel::of(&system, self.modes, matrices.stations, None)
    }

    fn free_coordinates(&self, matrices: &BeamMatrices) -> Vec<usize> {
        let mut free = vec![true; matrices.mass.nrows()];
        for fixed in &self.fixed {
            let first = STATION * station(matrices, fixed.at);
            for (i, &is_fixed) in fixed.coordinates.iter().enumerate() {
                free[first + i] &= !is_fixed;
            }
        }
        (0..free.len()).filter(|&i| free[i]).collect()
    }
}

fn station(matrices: &BeamMatrices, at: f64) -> usize {
    matrices.station(at).expect("each support has a station")
}

/// An eccentric mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unbalance {
    /// Position of a station, m from the shaft's first end.
    pub at: f64,
    /// Mass times distance from the axis, kg·m.
    pub moment: f64,
    /// Angle from Y towards Z at t = 0, rad.
    pub angle: f64,
}

/// An ellipse (y, z) = Re((y, z) e^{iΩt}), m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    pub y: Complex<f64>,
    pub z: Complex<f64>,
}

impl Orbit {
    /// Semi-major axis, m: the sum of the radii of the forward and the backward circle.
    pub fn semi_major(&self) -> f64 {
        let [forward, backward] = self.circles();
        forward + backward
    }

    /// Radii of the forward and the backward circle whose sum is the ellipse, m.
    pub fn circles(&self) -> [f64; 2] {
        let i = Complex::new(0.0, 1.0);
        [0.5 * (self.y + i * self.z).norm(), 0.5 * (self.y - i * self.z).norm()]
    }
}

/// Steady response to unbalances at spin `speed` (rad/s), in modal coordinates; `None` at an undamped resonance.
pub fn response(
    model: &RotorModel,
    unbalances: &[Unbalance],
    speed: f64,
) -> Option<DVector<Complex<f64>>> {
    let modes = model.natural.len();
    let mut load = DVector::from_element(modes, Complex::new(0.0, 0.0));
    for unbalance in unbalances {
        let first = STATION * model.station(unbalance.at).expect("a station at the unbalance");
        // A rotating force: cos Ωt of the force at t = 0, sin Ωt of the force a quarter turn later.
        let quarter = std::f64::consts::FRAC_PI_2;
        let phases = [Complex::new(1.0, 0.0), Complex::new(0.0, -1.0)];
        for (angle, phase) in [unbalance.angle, unbalance.angle + quarter].into_iter().zip(phases) {
            let force = unbalance_force(unbalance.moment, angle, speed, 0.0);
            let modal = model.basis.row(first) * force.x + model.basis.row(first + 1) * force.y;
            load += modal.transpose().map(|value| phase * value);
        }
    }
    let spin = Complex::new(0.0, speed);
    let mut dynamic = DMatrix::from_fn(modes, modes, |i, j| {
        let inertia = if i == j { spin * spin } else { Complex::new(0.0, 0.0) };
        let rate = model.damping[(i, j)] + speed * model.gyroscopic[(i, j)];
        inertia + spin * rate + model.stiffness[(i, j)] + speed * model.circulating[(i, j)]
    });
    model.relaxing.iter().for_each(|spring| dynamic += spring.stiffness_at(spin, speed));
    dynamic.lu().solve(&load)
}

/// Orbit of a station in a [`response`].
pub fn orbit(model: &RotorModel, response: &DVector<Complex<f64>>, station: usize) -> Orbit {
    let along = |coordinate: usize| {
        let row = model.basis.row(STATION * station + coordinate);
        row.iter().zip(response.iter()).map(|(mode, p)| p * *mode).sum()
    };
    Orbit { y: along(0), z: along(1) }
}

/// Speed within an interval (rad/s) with the largest orbit of a station, and its semi-major axis (m): golden sections to 1e-9 of the speed,
/// for an interval with one peak.
pub fn peak(
    model: &RotorModel,
    unbalances: &[Unbalance],
    station: usize,
    [mut low, mut high]: [f64; 2],
) -> [f64; 2] {
    let height = |speed: f64| match response(model, unbalances, speed) {
        Some(response) => orbit(model, &response, station).semi_major(),
        None => f64::INFINITY,
    };
    let part = 0.5 * (5f64.sqrt() - 1.0);
    let mut inner = [high - part * (high - low), low + part * (high - low)];
    let mut heights = inner.map(height);
    while high - low > 1e-9 * high {
        if heights[0] > heights[1] {
            high = inner[1];
            inner = [high - part * (high - low), inner[0]];
            heights = [height(inner[0]), heights[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + part * (high - low)];
            heights = [heights[1], height(inner[1])];
        }
    }
    let speed = 0.5 * (low + high);
    [speed, height(speed)]
}

/// Speed near `critical` at which the damped frequency of its motion equals the spin, rad/s: secants to 1e-12. `None` if they do not converge.
///
/// # Errors
/// Eigenvalues that are not found.
pub fn damped_critical_speed(
    model: &RotorModel,
    critical: &Critical,
) -> Result<Option<f64>, RotorError> {
    let excess = |speed: f64| -> Result<f64, RotorError> {
        let whirls = model.whirls(speed, 2 * model.natural.len())?;
        let likeness = whirls.iter().map(|whirl| (critical.whirl.likeness(whirl), whirl));
        let best = likeness.max_by(|a, b| a.0.total_cmp(&b.0));
        Ok(best.map_or(f64::NAN, |(_, whirl)| whirl.frequency() - speed))
    };
    let mut from = (critical.speed, excess(critical.speed)?);
    let next = critical.speed + from.1;
    let mut to = (next, if from.1 == 0.0 { 0.0 } else { excess(next)? });
    for _ in 0..40 {
        if (to.0 - from.0).abs() <= 1e-12 * critical.speed || to.1 == from.1 {
            return Ok(Some(to.0));
        }
        let next = to.0 - to.1 * (to.0 - from.0) / (to.1 - from.1);
        (from, to) = (to, (next, excess(next)?));
    }
    Ok(None)
}
