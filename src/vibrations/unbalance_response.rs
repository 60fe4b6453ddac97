//! Orbits that unbalances force at steady speed.

use crate::ch4_rotor::disc::unbalance_force;
use crate::members::beam::STATION;
use crate::vibrations::rotor::RotorModel;
use nalgebra::{Complex, DMatrix, DVector};

/// A mass beside the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unbalance {
    /// m from the shaft's first end, one of the places that the rotor has stations at.
    pub at: f64,
    /// Mass times distance from the axis, kg·m.
    pub moment: f64,
    /// From Y towards Z at t = 0, rad.
    pub angle: f64,
}

/// An ellipse (y, z) = Re((y, z) e^{iΩt}), m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    pub y: Complex<f64>,
    pub z: Complex<f64>,
}

impl Orbit {
    /// Largest distance from its centre, m: forward and backward circles add.
    pub fn semi_major(&self) -> f64 {
        let [forward, backward] = self.circles();
        forward + backward
    }

    /// Radii of the circles, forward and backward, that make up the ellipse, m.
    pub fn circles(&self) -> [f64; 2] {
        let i = Complex::new(0.0, 1.0);
        [0.5 * (self.y + i * self.z).norm(), 0.5 * (self.y - i * self.z).norm()]
    }
}

impl RotorModel {
    /// Coordinates over the natural motions at spin `speed` (rad/s); [`None`] where nothing damps a resonance.
    ///
    /// # Panics
    /// If an unbalance is at no station.
    pub fn response(&self, unbalances: &[Unbalance], speed: f64) -> Option<DVector<Complex<f64>>> {
        let modes = self.natural.len();
        let mut load = DVector::from_element(modes, Complex::new(0.0, 0.0));
        for unbalance in unbalances {
            let at = self.station(unbalance.at).expect("unbalances sit at stations");
            // A force that turns: its part along Y, and a quarter turn later along Z.
            let quarter = std::f64::consts::FRAC_PI_2;
            for (angle, part) in [(unbalance.angle, 0), (unbalance.angle + quarter, 1)] {
                let now = unbalance_force(unbalance.moment, angle, speed, 0.0);
                let modal = self.modal_load(at, [now.x, now.y, 0.0, 0.0]);
                // cos Ωt of the force now, sin Ωt of the force a quarter turn later.
                let phase =
                    if part == 0 { Complex::new(1.0, 0.0) } else { Complex::new(0.0, -1.0) };
                load += modal.map(|value| phase * value);
            }
        }
        let spin = Complex::new(0.0, speed);
        let mut dynamic = DMatrix::from_fn(modes, modes, |i, j| {
            let inertia = if i == j { spin * spin } else { Complex::new(0.0, 0.0) };
            let rate = self.damping[(i, j)] + speed * self.gyroscopic[(i, j)];
            inertia + spin * rate + self.stiffness[(i, j)] + speed * self.circulating[(i, j)]
        });
        self.relaxing.iter().for_each(|of| dynamic += of.stiffness_at(spin, speed));
        dynamic.lu().solve(&load)
    }

    /// Orbit of a station.
    pub fn orbit(&self, response: &DVector<Complex<f64>>, station: usize) -> Orbit {
        let along = |coordinate: usize| {
            let row = self.basis.row(STATION * station + coordinate);
            row.iter().zip(response.iter()).map(|(shape, p)| p * *shape).sum()
        };
        Orbit { y: along(0), z: along(1) }
    }

    /// Speed between two (rad/s) at which a station's orbit is largest, and its semi-major axis there (m): golden sections, of a
    /// stretch with one peak. To 1e-9 of the speed.
    pub fn peak(&self, unbalances: &[Unbalance], station: usize, between: [f64; 2]) -> [f64; 2] {
        let height = |speed: f64| match self.response(unbalances, speed) {
            Some(response) => self.orbit(&response, station).semi_major(),
            None => f64::INFINITY,
        };
        let part = 0.5 * (5f64.sqrt() - 1.0);
        let [mut low, mut high] = between;
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
}
