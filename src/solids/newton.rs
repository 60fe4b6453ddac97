//! Newton's method for the equilibrium of a solid of any material.

use crate::kinematics::vec3::Vec3;
use crate::solids::error::{SolidError, StepFailure};
use crate::solids::tangent::{PRESCRIBED, Unknowns};

/// Convergence criteria of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// Largest force residual over the largest force.
    pub tolerance: f64,
    /// The same if it falls no further because of rounding.
    pub rounding: f64,
    pub most_iterations: usize,
}

/// Forces in a state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unbalanced {
    /// Largest residual on an unknown, N.
    pub largest: f64,
    /// Largest force at work, N.
    pub scale: f64,
    /// Rounding of contact forces, N.
    pub rounding: f64,
    /// True if the contact nodes are others than in the state before.
    pub changed: bool,
}

impl Unbalanced {
    /// Of the forces of the elements on the nodes and a fraction of the loads, N; `right` takes the residuals.
    ///
    /// # Errors
    ///
    /// [`StepFailure::NotFinite`].
    pub fn of<const N: usize>(
        unknowns: &Unknowns,
        [internal, loads]: [&[[f64; N]]; 2],
        fraction: f64,
        right: &mut [f64],
    ) -> Result<Unbalanced, StepFailure> {
        let mut found = Unbalanced::default();
        let mut finite = true;
        for (n, of) in unknowns.of.iter().enumerate() {
            for i in 0..3 {
                let (inner, outer) = (internal[n][i], loads[n][i]);
                found.scale = found.scale.max(inner.abs()).max(outer.abs());
                // `max` would drop NaN.
                finite &= inner.is_finite() && outer.is_finite();
                if of[i] != PRESCRIBED {
                    right[of[i]] = inner + fraction * outer;
                    found.largest = found.largest.max(right[of[i]].abs());
                }
            }
        }
        if finite { Ok(found) } else { Err(StepFailure::NotFinite) }
    }
}

/// Adds the unknowns of a solution to a displacement.
pub fn add_solution(unknowns: &Unknowns, solution: &[f64], displacement: &mut [Vec3]) {
    for (u, of) in displacement.iter_mut().zip(&unknowns.of) {
        for i in 0..3 {
            if of[i] != PRESCRIBED {
                u[i] += solution[of[i]];
            }
        }
    }
}

/// Newton iterations: `balance` evaluates the forces, `step` adds the solution with the present factors. Factors of an
/// earlier state are kept where they serve, as long as they reduce the residual tenfold a step.
///
/// # Errors
///
/// No convergence, and those of `balance` and `factorise`.
pub fn converge<S>(
    search: &mut S,
    options: &Convergence,
    balance: impl Fn(&mut S) -> Result<Unbalanced, SolidError>,
    serves: impl Fn(&S) -> bool,
    factorise: impl Fn(&mut S) -> Result<(), SolidError>,
    step: impl Fn(&mut S),
) -> Result<Unbalanced, SolidError> {
    let mut last = f64::INFINITY;
    let mut fresh = false;
    for iteration in 0..=options.most_iterations {
        let found = balance(search)?;
        let Unbalanced { largest, scale, rounding, changed } = found;
        // With factors of the same state and the same contact nodes the step did not halve the residual: it is rounding.
        let stagnates = fresh && !changed && largest > 0.5 * last;
        if largest <= f64::max(options.tolerance * scale, rounding)
            || (stagnates && largest <= options.rounding * scale)
        {
            return Ok(found);
        }
        let diverged = iteration > 3 && largest > 1e3 * last;
        if iteration == options.most_iterations || diverged {
            let (residual, iterations) = (largest, iteration);
            return Err(StepFailure::NotConverged { residual, scale, iterations }.into());
        }
        fresh = !serves(search) || largest > 0.1 * last;
        if fresh {
            factorise(search)?;
        }
        last = largest;
        step(search);
    }
    unreachable!("the loop returns at its last iteration")
}
