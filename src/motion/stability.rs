//! Largest stable step of Runge–Kutta, from the eigenvalues of the Jacobian at a state.

use crate::assembly::lists::Assembly;
use crate::assembly::places::Places;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::members::state::{Layout, ORIENTATION, POSITION, SPIN, VELOCITY, quaternion_rate};
use crate::motion::system::System;
use nalgebra::{Complex, DMatrix, DVector, Quaternion, Schur};
use serde::{Deserialize, Serialize};

/// Stability limit of an explicit method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepLimit {
    /// Largest stable step of classical Runge–Kutta, s.
    pub step: f64,
    /// The eigenvalue that limits it, 1/s.
    #[serde(with = "ComplexParts")]
    pub eigenvalue: Complex<f64>,
    /// State entry of the rate with most kinetic energy in the mode of that eigenvalue.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<usize>,
}

/// A complex number in a state file.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Complex<f64>")]
struct ComplexParts {
    re: f64,
    im: f64,
}

impl StepLimit {
    fn decays(eigenvalue: Complex<f64>) -> bool {
        eigenvalue.re.abs() > eigenvalue.im.abs()
    }

    /// The rate of the limiting mode, and its largest component.
    pub fn reason(&self, assembly: &Assembly) -> String {
        let (re, im) = (self.eigenvalue.re, self.eigenvalue.im);
        let rate = match StepLimit::decays(self.eigenvalue) {
            true => format!("decay at {:.2e} 1/s", -re),
            false => format!("oscillation at {:.0} Hz", im.abs() / std::f64::consts::TAU),
        };
        match self.component.and_then(|entry| coordinate(assembly, entry)) {
            Some((name, _)) => format!("{rate}, mainly of {name}"),
            None => rate,
        }
    }
}

/// Name of the coordinate of a rate in the state, and its mass, moment of inertia or (for modes) one.
fn coordinate(assembly: &Assembly, entry: usize) -> Option<(String, f64)> {
    let rigid = |at: &dyn Fn(usize) -> usize, inertia: &Inertia, name: &dyn Fn() -> String| {
        (0..3).find_map(|i| {
            let axis = ["x", "y", "z"][i];
            let moment = if i == 0 { inertia.axial } else { inertia.transverse };
            if entry == at(VELOCITY + i) {
                return Some((format!("{} along {axis}", name()), inertia.mass));
            }
            (entry == at(SPIN + i)).then(|| (format!("{} about {axis}", name()), moment))
        })
    };
    for (bearing, layout) in assembly.bearings.iter().zip(Layout::of(assembly)) {
        let of = || bearing.name.as_ref().map_or(String::new(), |name| format!(" of {name}"));
        let ball = |ball: usize| {
            let at = |component: usize| layout.ball(component) + ball;
            rigid(&at, &bearing.ball, &|| format!("ball {}{}", ball + 1, of()))
        };
        if let Some(found) = (0..layout.balls).find_map(ball) {
            return Some(found);
        }
    }
    let places = Places::of(assembly);
    for (index, body) in assembly.bodies.iter().enumerate() {
        let at = |component: usize| places.body(index) + component;
        let found = body.inertia().and_then(|of| rigid(&at, of, &|| body.name.clone()));
        if found.is_some() {
            return found;
        }
    }
    let solids = assembly.solids.iter().zip(places.solids(assembly));
    let solids = solids.map(|(solid, at)| (at + solid.count(), solid.count(), &solid.name));
    let shafts = assembly.shafts.iter().zip(places.shafts(assembly)).map(|(shaft, at)| {
        let name = &assembly.bodies[shaft.body].name;
        (at + shaft.amplitudes(), shaft.amplitudes(), name)
    });
    let floating =
        assembly.floating.iter().zip(places.floating(assembly)).map(|(solid, at)| {
            (at + solid.count(), solid.count(), &assembly.bodies[solid.body].name)
        });
    let mut modes = solids.chain(shafts).chain(floating);
    let (first, _, name) = modes.find(|(at, count, _)| (*at..at + count).contains(&entry))?;
    Some((format!("mode {} of {name}", entry - first + 1), 1.0))
}

/// |1 + z + z²/2 + z³/6 + z⁴/24|, the growth of one step.
pub fn growth(z: Complex<f64>) -> f64 {
    let one = Complex::new(1.0, 0.0);
    (one + z * (one + z / 2.0 * (one + z / 3.0 * (one + z / 4.0)))).norm()
}

/// A direction in which a state is perturbed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Direction {
    /// An entry of the state vector that is a position (m).
    Position(usize),
    /// An entry that is a velocity or a spin (m/s, rad/s).
    Rate(usize),
    /// Rotation (rad) of the body whose 13 entries start at `body` about inertial axis `axis`.
    Turn { body: usize, axis: usize },
}

impl Direction {
    fn step(self, state: &[f64], ball_radius: f64) -> f64 {
        match self {
            // Far below an overlap of 1 µm, at the races' radius too, and a slip of 1e-5 of the rolling speed.
            Direction::Position(_) => 1e-10,
            Direction::Turn { .. } => 1e-9,
            Direction::Rate(entry) => 1e-7 * state[entry].abs().max(ball_radius),
        }
    }

    fn shift(self, state: &mut [f64], by: f64) {
        match self {
            Direction::Position(entry) | Direction::Rate(entry) => state[entry] += by,
            Direction::Turn { body, axis } => {
                // dq = ½ dθ q.
                let mut turn = [0.0; 3];
                turn[axis] = by;
                let q = [0, 1, 2, 3].map(|i| state[body + ORIENTATION + i]);
                for (i, change) in quaternion_rate(q, turn).into_iter().enumerate() {
                    state[body + ORIENTATION + i] += change;
                }
            }
        }
    }

    /// Rate of the state in this direction.
    fn rate(self, state: &[f64], rates: &[f64]) -> f64 {
        match self {
            Direction::Position(entry) | Direction::Rate(entry) => rates[entry],
            Direction::Turn { body, axis } => {
                // ω = 2 dq/dt q*, vector part.
                let quaternion = |of: &[f64]| {
                    let q = [0, 1, 2, 3].map(|i| of[body + ORIENTATION + i]);
                    Quaternion::new(q[0], q[1], q[2], q[3])
                };
                2.0 * (quaternion(rates) * quaternion(state).conjugate()).imag()[axis]
            }
        }
    }
}

/// Jacobian of the rates by central differences, without the orientation of balls, the energy ledger and padding, which
/// do not feed back.
pub fn jacobian(system: &mut System, t: f64, state: &[f64]) -> DMatrix<f64> {
    let directions = directions(system);
    let mut rates = vec![0.0; state.len()];
    let mut shifted = state.to_vec();
    let mut matrix = DMatrix::zeros(directions.len(), directions.len());
    let radii = system.assembly.bearings.iter().map(|bearing| bearing.geometry.ball_radius);
    let radius = Some(radii.fold(f64::INFINITY, f64::min)).filter(|radius| radius.is_finite());
    // Any length serves for bodies on springs alone.
    let radius = radius.unwrap_or(1e-2);
    for (column, direction) in directions.iter().enumerate() {
        let step = direction.step(state, radius);
        for sign in [1.0, -1.0] {
            shifted.copy_from_slice(state);
            direction.shift(&mut shifted, sign * step);
            system.evaluate(t, &shifted, &mut rates);
            for (row, direction) in directions.iter().enumerate() {
                matrix[(row, column)] += sign * direction.rate(&shifted, &rates) / (2.0 * step);
            }
        }
    }
    matrix
}

fn directions(system: &System) -> Vec<Direction> {
    let mut directions = Vec::new();
    let mut add = |of: &dyn Fn(usize) -> usize| {
        for i in 0..3 {
            directions.push(Direction::Position(of(POSITION + i)));
            directions.push(Direction::Rate(of(VELOCITY + i)));
            directions.push(Direction::Rate(of(SPIN + i)));
        }
    };
    for layout in system.sets.iter().map(|set| set.layout) {
        for ball in 0..layout.balls {
            add(&|component| layout.ball(component) + ball);
        }
    }
    let bodies = system.assembly.bodies.iter().enumerate();
    let moving: Vec<usize> = bodies
        .filter(|(_, body)| body.moves())
        .map(|(index, _)| system.places.body(index))
        .collect();
    for body in &moving {
        add(&|component| body + component);
    }
    for body in moving {
        directions.extend((0..3).map(|axis| Direction::Turn { body, axis }));
    }
    for (solid, at) in system.assembly.solids.iter().zip(&system.solids) {
        for shape in 0..solid.count() {
            directions.push(Direction::Position(at + shape));
            directions.push(Direction::Rate(at + solid.count() + shape));
        }
    }
    for (shaft, at) in system.assembly.shafts.iter().zip(&system.shafts) {
        let half = shaft.amplitudes();
        directions.extend((0..half).map(|k| Direction::Position(at + k)));
        directions.extend((half..2 * half).map(|k| Direction::Rate(at + k)));
    }
    for (solid, at) in system.assembly.floating.iter().zip(&system.floating) {
        let half = solid.count();
        directions.extend((0..half).map(|k| Direction::Position(at + k)));
        directions.extend((half..2 * half).map(|k| Direction::Rate(at + k)));
    }
    for (connection, at) in system.assembly.connections.iter().zip(&system.connections) {
        directions.extend((0..6 * connection.maxwell().len()).map(|k| Direction::Position(at + k)));
    }
    directions
}

/// Largest stable step at a state; `None` without any contact.
pub fn step_limit(system: &mut System, t: f64, state: &[f64]) -> Option<StepLimit> {
    let matrix = jacobian(system, t, state);
    let (step, eigenvalue) = limiting(&matrix)?;
    let component = largest_component(system, &matrix, eigenvalue);
    Some(StepLimit { step, eigenvalue, component })
}

/// State entry of the rate that has most kinetic energy in the mode of an eigenvalue, by inverse iteration.
fn largest_component(
    system: &System,
    matrix: &DMatrix<f64>,
    eigenvalue: Complex<f64>,
) -> Option<usize> {
    // Next to the eigenvalue, so that the matrix is not singular.
    let near = eigenvalue * (1.0 + 1e-6);
    let mut shifted = matrix.map(|value| Complex::new(value, 0.0));
    for i in 0..matrix.nrows() {
        shifted[(i, i)] -= near;
    }
    let factors = shifted.lu();
    let mut mode = DVector::from_element(matrix.nrows(), Complex::new(1.0, 0.0));
    for _ in 0..3 {
        factors.solve_mut(&mut mode);
        mode.unscale_mut(mode.norm());
    }
    let energy = |(direction, part): (Direction, &Complex<f64>)| match direction {
        Direction::Rate(entry) => {
            let (_, mass) = coordinate(&system.assembly, entry)?;
            Some((entry, mass * part.norm_sqr()))
        }
        Direction::Position(_) | Direction::Turn { .. } => None,
    };
    let energies = directions(system).into_iter().zip(mode.iter()).filter_map(energy);
    energies.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(entry, _)| entry)
}

/// Largest stable step and the eigenvalue that limits it.
fn limiting(matrix: &DMatrix<f64>) -> Option<(f64, Complex<f64>)> {
    let eigenvalues = eigenvalues(matrix)?;
    let largest = eigenvalues.iter().map(|value| value.norm()).fold(0.0, f64::max);
    eigenvalues
        .iter()
        // Slow modes may grow physically (an inverted pendulum) and limit no step.
        .filter(|value| value.norm() > 1e-2 * largest)
        .map(|&eigenvalue| (limit_of(eigenvalue), eigenvalue))
        .filter(|limit| limit.0.is_finite())
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Eigenvalues by the QR algorithm. It stalls on some matrices of high symmetry (a preloaded bearing at rest); a small
/// uneven shift of the diagonal then breaks the symmetry.
fn eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let size = matrix.nrows();
    let scale = matrix.amax();
    for attempt in 0..4 {
        let mut tried = matrix.clone();
        for i in 0..size {
            // Far below the accuracy of the finite differences.
            tried[(i, i)] += 1e-9 * scale * f64::from(attempt) * i as f64 / size as f64;
        }
        if let Some(schur) = Schur::try_new(tried, f64::EPSILON, 200 * size) {
            return Some(schur.complex_eigenvalues().iter().copied().collect());
        }
    }
    None
}

/// Largest h at which a step grows no faster than the motion itself (|R(hλ)| ≤ e^(h·Re λ) for a growing one), by a
/// march to the first excess and bisection.
fn limit_of(eigenvalue: Complex<f64>) -> f64 {
    let size = eigenvalue.norm();
    if size == 0.0 {
        return f64::INFINITY;
    }
    // Rounding of undamped modes: a growth of 1e-6 a step is not an instability of the method.
    let own = eigenvalue.re.max(0.0);
    let stable = |h: f64| growth(eigenvalue * h) <= libm::exp(own * h) + 1e-6;
    let mut low = 1e-3 / size;
    if !stable(low) {
        return f64::INFINITY;
    }
    let mut high = low;
    while stable(high) && high * size < 10.0 {
        low = high;
        high *= 1.05;
    }
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if stable(middle) { low = middle } else { high = middle }
    }
    low
}
