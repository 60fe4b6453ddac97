//! The step that Runge–Kutta can take: from the Jacobian's eigenvalues at a state.

use super::system::System;
use nalgebra::{Complex, DMatrix};

/// Where the step of an explicit method ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimit {
    /// Largest stable step of classical Runge–Kutta, s.
    pub step: f64,
    /// The eigenvalue that sets it, 1/s.
    pub eigenvalue: Complex<f64>,
}

impl StepLimit {
    /// What sets the step: an oscillation of a contact, or the onset of traction.
    pub fn reason(&self) -> String {
        let (re, im) = (self.eigenvalue.re, self.eigenvalue.im);
        if re.abs() > im.abs() {
            format!("traction onset: slip decays at {:.2e} 1/s", -re)
        } else {
            format!("stiffest contact: oscillation at {:.0} Hz", im.abs() / std::f64::consts::TAU)
        }
    }
}

/// |1 + z + z²/2 + z³/6 + z⁴/24|, the growth of one step.
pub fn growth(z: Complex<f64>) -> f64 {
    let one = Complex::new(1.0, 0.0);
    (one + z * (one + z / 2.0 * (one + z / 3.0 * (one + z / 4.0)))).norm()
}

/// Jacobian of the rates by central differences, over the entries that matter: orientations and
/// the energy ledger do not feed back on the motion of symmetric bodies, padding does not move.
pub fn jacobian(system: &mut System, t: f64, state: &[f64]) -> DMatrix<f64> {
    let entries = moving_entries(system);
    let mut rates = [vec![0.0; state.len()], vec![0.0; state.len()]];
    let mut shifted = state.to_vec();
    let mut matrix = DMatrix::zeros(entries.len(), entries.len());
    let radius = system.problem.geometry.ball_radius;
    for (column, &(entry, is_position)) in entries.iter().enumerate() {
        // Far below an overlap of 1 µm and a creep of 1e-5 of the rolling speed.
        let step = if is_position { 1e-10 } else { 1e-7 * state[entry].abs().max(radius) };
        for (rates, sign) in rates.iter_mut().zip([1.0, -1.0]) {
            shifted[entry] = state[entry] + sign * step;
            system.evaluate(t, &shifted, rates);
        }
        shifted[entry] = state[entry];
        for (row, &(entry, _)) in entries.iter().enumerate() {
            matrix[(row, column)] = (rates[0][entry] - rates[1][entry]) / (2.0 * step);
        }
    }
    matrix
}

/// Entries of the state that take part, and whether they are positions.
fn moving_entries(system: &System) -> Vec<(usize, bool)> {
    use super::state::{BODY, POSITION, SPIN, VELOCITY};
    let layout = system.layout;
    let mut entries = Vec::new();
    let mut add = |of: &dyn Fn(usize) -> usize| {
        for i in 0..3 {
            entries.push((of(POSITION + i), true));
            entries.push((of(VELOCITY + i), false));
            entries.push((of(SPIN + i), false));
        }
    };
    for ball in 0..layout.balls {
        add(&|component| layout.ball(component) + ball);
    }
    add(&|component| layout.inner() + component);
    if system.problem.outer.is_some() {
        add(&|component| layout.outer() + component);
    }
    if layout.has_cage {
        add(&|component| layout.cage() + component);
    }
    debug_assert!(entries.iter().all(|entry| entry.0 < layout.ledger() + BODY));
    entries
}

/// Largest stable step at a state; `None` where nothing is stiff (no contact at all).
pub fn step_limit(system: &mut System, t: f64, state: &[f64]) -> Option<StepLimit> {
    let matrix = jacobian(system, t, state);
    let eigenvalues = matrix.complex_eigenvalues();
    let largest = eigenvalues.iter().map(|value| value.norm()).fold(0.0, f64::max);
    eigenvalues
        .iter()
        // Slow modes may grow physically (a pendulum upside down) and set no step.
        .filter(|value| value.norm() > 1e-2 * largest)
        .map(|&eigenvalue| StepLimit { step: limit_of(eigenvalue), eigenvalue })
        .filter(|limit| limit.step.is_finite())
        .min_by(|a, b| a.step.total_cmp(&b.step))
}

/// Largest h with |R(hλ)| ≤ 1, by a march to the first excess and bisection.
fn limit_of(eigenvalue: Complex<f64>) -> f64 {
    let size = eigenvalue.norm();
    if size == 0.0 {
        return f64::INFINITY;
    }
    // Rounding of undamped modes: growth of 1e-6 a step is no instability of the method.
    let stable = |h: f64| growth(eigenvalue * h) <= 1.0 + 1e-6;
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
