//! Newton's method in a trust region, for energies with exact second derivatives.

use super::dense::{Matrix, dot, norm, solve_positive_definite};

/// The energy and its derivatives at one point.
pub struct Expansion {
    pub value: f64,
    /// Rounding that `value` may carry.
    pub noise: f64,
    pub gradient: Vec<f64>,
    pub hessian: Matrix,
}

pub struct Minimum {
    pub point: Vec<f64>,
    pub gradient_norm: f64,
    pub iterations: usize,
}

const MAX_ITERATIONS: usize = 2000;

/// Descends from `start` until neither the energy nor its gradient can be lowered in f64. The
/// caller judges `gradient_norm`. All variables must have one unit; `radius` is the first step's
/// length in it.
pub fn minimise(start: &[f64], mut radius: f64, expand: impl Fn(&[f64]) -> Expansion) -> Minimum {
    let mut point = start.to_vec();
    let mut here = expand(&point);
    let mut gradient_norm = norm(&here.gradient);
    let (mut iterations, mut refusals) = (0, 0);
    while iterations < MAX_ITERATIONS && gradient_norm > 0.0 {
        iterations += 1;
        let step = step_within(&here, radius);
        let curvature: f64 =
            step.iter().zip(&here.hessian).map(|(s, row)| s * dot(row, &step)).sum();
        let predicted = -dot(&here.gradient, &step) - 0.5 * curvature;
        let candidate: Vec<f64> = point.iter().zip(&step).map(|(x, s)| x + s).collect();
        let there = expand(&candidate);
        let norm_there = norm(&there.gradient);
        // Once the gain drowns in the rounding of the energy the gradient decides alone.
        let energy_is_blind = predicted <= 4.0 * here.noise;
        let gain = (here.value - there.value) / predicted;
        let accepted = if energy_is_blind { norm_there < gradient_norm } else { gain > 1e-4 };
        if energy_is_blind {
            // A contact about to open can overshoot: shorter steps before giving up.
            refusals = if accepted { 0 } else { refusals + 1 };
            if refusals > 8 {
                break;
            }
            if !accepted {
                radius = 0.25 * norm(&step);
            }
        } else if gain < 0.25 || gain.is_nan() {
            radius = 0.25 * norm(&step);
        } else if gain > 0.75 && norm(&step) > 0.5 * radius {
            radius *= 3.0;
        }
        if accepted {
            (point, here, gradient_norm) = (candidate, there, norm_there);
        }
    }
    Minimum { point, gradient_norm, iterations }
}

/// Minimiser of the quadratic model within `radius`, its multiplier found by bisection.
fn step_within(here: &Expansion, radius: f64) -> Vec<f64> {
    let downhill: Vec<f64> = here.gradient.iter().map(|g| -g).collect();
    if let Some(step) = solve_positive_definite(&here.hessian, 0.0, &downhill)
        && norm(&step) <= radius
    {
        return step;
    }
    let size = here.hessian.iter().map(|row| dot(row, row)).sum::<f64>().sqrt();
    // This shift outweighs any negative curvature and shortens the step below the radius.
    let mut high = (size + norm(&downhill) / radius) * 1.01;
    let mut low = 1e-16 * high;
    let mut best = solve_positive_definite(&here.hessian, high, &downhill)
        .unwrap_or_else(|| vec![0.0; downhill.len()]);
    for _ in 0..50 {
        if norm(&best) >= 0.8 * radius || high <= 1.1 * low {
            break;
        }
        let middle = (low * high).sqrt();
        match solve_positive_definite(&here.hessian, middle, &downhill) {
            Some(step) if norm(&step) <= radius => (best, high) = (step, middle),
            _ => low = middle,
        }
    }
    best
}
