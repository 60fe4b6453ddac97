//! Fewer Maxwell elements for one run: those far slower than the run act as one, and so do those
//! far faster than its steps.
//!
//! An element with τ ≫ T, the run's duration, gives γ(S − S₀) − (γ/τ)∫(S − S₀)dt and then terms of
//! (T/τ)²: elements with the same Σγ and Σγ/τ are the same to that order. One with τ ≪ Δt gives
//! γτ dS/dt: the same Σγτ and Σγτ² are the same but for what survives a step, exp(−Δt/τ).

use super::maxwell::Maxwell;

#[derive(Clone, Debug, PartialEq)]
pub struct Merged {
    /// Slowest first.
    pub elements: Vec<Maxwell>,
    /// How far the sum of their stresses may stray, over the total variation of DEV S in the run.
    pub slow_bound: f64,
    /// The same over the largest change of DEV S in a step.
    pub fast_bound: f64,
}

/// Error of one element taken as slow, over the variation of DEV S, at most.
fn slow_error(element: &Maxwell, duration: f64) -> f64 {
    let ratio = duration / element.tau;
    0.5 * element.gamma * ratio * ratio
}

/// Error of one element taken as fast, over a step's change of DEV S: what is left of it after the
/// step, and of the step before.
fn fast_error(element: &Maxwell, step: f64) -> f64 {
    let ratio = step / element.tau;
    2.0 * element.gamma / ratio * libm::exp(-ratio)
}

/// As few elements as keep both bounds within `tolerance`, for a run of `duration` s in steps of
/// `shortest_step` s or more.
pub fn merged(elements: &[Maxwell], duration: f64, shortest_step: f64, tolerance: f64) -> Merged {
    let mut sorted = elements.to_vec();
    sorted.sort_by(|a, b| b.tau.total_cmp(&a.tau));
    let mut slow = 0;
    let mut slow_bound = 0.0;
    while slow < sorted.len() {
        let bound = of_slow(&sorted[..=slow], duration);
        let within = bound <= tolerance;
        if !within {
            break;
        }
        (slow, slow_bound) = (slow + 1, bound);
    }
    let mut fast = sorted.len();
    let mut fast_bound = 0.0;
    while fast > slow {
        let bound = of_fast(&sorted[fast - 1..], shortest_step);
        let within = bound <= tolerance;
        if !within {
            break;
        }
        (fast, fast_bound) = (fast - 1, bound);
    }
    let mut kept = Vec::with_capacity(fast - slow + 2);
    if slow > 0 {
        kept.push(one_slow(&sorted[..slow]));
    }
    kept.extend_from_slice(&sorted[slow..fast]);
    if fast < sorted.len() {
        kept.push(one_fast(&sorted[fast..]));
    }
    // One element in the place of one is that element.
    Merged {
        elements: kept,
        slow_bound: if slow > 1 { slow_bound } else { 0.0 },
        fast_bound: if sorted.len() - fast > 1 { fast_bound } else { 0.0 },
    }
}

fn one_slow(elements: &[Maxwell]) -> Maxwell {
    let [sum, rate] = sums(elements, |e| [e.gamma, e.gamma / e.tau]);
    if let [only] = elements { *only } else { Maxwell { gamma: sum, tau: sum / rate } }
}

fn of_slow(elements: &[Maxwell], duration: f64) -> f64 {
    let each: f64 = elements.iter().map(|e| slow_error(e, duration)).sum();
    each + slow_error(&one_slow(elements), duration)
}

fn one_fast(elements: &[Maxwell]) -> Maxwell {
    let [first, second] = sums(elements, |e| [e.gamma * e.tau, e.gamma * e.tau * e.tau]);
    match elements {
        [only] => *only,
        _ => Maxwell { gamma: first * first / second, tau: second / first },
    }
}

fn of_fast(elements: &[Maxwell], step: f64) -> f64 {
    let each: f64 = elements.iter().map(|e| fast_error(e, step)).sum();
    each + fast_error(&one_fast(elements), step)
}

fn sums(elements: &[Maxwell], of: impl Fn(&Maxwell) -> [f64; 2]) -> [f64; 2] {
    elements.iter().map(of).fold([0.0; 2], |sum, x| [sum[0] + x[0], sum[1] + x[1]])
}
