//! Fewer Maxwell elements for one run: those far slower than the run act as one, and so do those
//! far faster than its steps.
//!
//! An element with τ ≫ T, the run's duration, gives γ(S − S₀) − (γ/τ)∫(S − S₀)dt and then terms of
//! (T/τ)²: elements with the same Σγ and Σγ/τ are the same to that order. One with τ ≪ Δt gives
//! γτ dS/dt: the same Σγτ and Σγτ² are the same but for what survives a step, exp(−Δt/τ).
//!
//! Bounds. What elements and their merger differ by is ∫ k(t − s) dS(s), k the difference of their
//! relaxations Σ γ exp(−u/τ). Of slow ones |k| stays below the bound for all of the run, so that it
//! holds for any course. Of fast ones ∫ k du vanishes: where DEV S has gone straight for a while h, that while
//! leaves ∫ |k| beyond h, and each while of h before it exp(−h/τ) less. Until h after a jump or a corner there is
//! no such bound but |k| ≤ Σγ.

use super::maxwell::Maxwell;

/// With V the total variation of DEV S in the run and v the largest within `shortest_step` of it, the sum of
/// the stresses strays by at most
/// - `slow_bound` V + `fast_bound` v where DEV S has gone straight for `shortest_step` or longer, hence at
///   the end of every step as long as that;
/// - `slow_bound` V + (`fast_bound` + `sudden_bound`) v at all other times: at a jump, and at the end of a
///   shorter step.
#[derive(Clone, Debug, PartialEq)]
pub struct Merged {
    /// Slowest first.
    pub elements: Vec<Maxwell>,
    pub slow_bound: f64,
    pub fast_bound: f64,
    /// Σγ of the fast elements that became one.
    pub sudden_bound: f64,
}

/// Error of one element taken as slow, over the variation of DEV S, at most.
fn slow_error(element: &Maxwell, duration: f64) -> f64 {
    let ratio = duration / element.tau;
    0.5 * element.gamma * ratio * ratio
}

/// Error of one element taken as fast, over the variation of DEV S within a step: of the step itself, and
/// of all before it.
fn fast_error(element: &Maxwell, step: f64) -> f64 {
    let ratio = step / element.tau;
    element.gamma * libm::exp(-ratio) * (1.0 / ratio - 1.0 / libm::expm1(-ratio))
}

/// As few elements as keep the bounds of steps of `shortest_step` s or more in a run of `duration` s within
/// `tolerance`.
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
    let some_fast = sorted.len() - fast > 1;
    let of_all = sums(&sorted[fast..], |e| [e.gamma, 0.0])[0];
    Merged {
        elements: kept,
        slow_bound: if slow > 1 { slow_bound } else { 0.0 },
        fast_bound: if some_fast { fast_bound } else { 0.0 },
        sudden_bound: if some_fast { of_all } else { 0.0 },
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
