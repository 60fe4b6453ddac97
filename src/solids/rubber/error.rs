//! Errors of a solid of rubber.

use crate::ch2_housing::elastomer::ElastomerError;
use crate::kinematics::vec3::Vec3;
use crate::numeric::clock::rounded;
use crate::numeric::sparse::FactorError;
use crate::solids::model::{SolidError, place};
use thiserror::Error;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum RubberError {
    #[error(transparent)]
    Problem(#[from] SolidError),
    #[error(transparent)]
    Material(#[from] ElastomerError),
    #[error("the {what} is {value}; it must be positive and finite")]
    Option { what: &'static str, value: f64 },
    #[error("the angular frequency is {0} rad/s; it must not be negative")]
    Pulsation(f64),
    #[error(
        "the complex stiffness does not converge: with {vectors} basis vectors it still changes by \
         {change:.1e}; {tolerance:.1e} is allowed"
    )]
    NotSettled { vectors: usize, change: f64, tolerance: f64 },
    #[error("elements of four nodes; rubber needs ten-node elements")]
    FourNodes,
    #[error("not enough memory for the factorised stiffness matrix, {:.2} GB", 1e-9 * bytes)]
    NoMemory { bytes: f64 },
    #[error("the body or a part of it is free to move; fix it")]
    Free,
    /// Steps were halved down to the smallest.
    #[error(
        "no equilibrium was found after t = {} s; the last step tried was {step:.3e} s: {failure}",
        rounded(*time)
    )]
    NoEquilibrium { time: f64, step: f64, failure: StepFailure },
    /// The state is that of the last step.
    #[error("stopped at t = {} s", rounded(*time))]
    Stopped { time: f64 },
}

/// Failure of a step.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum StepFailure {
    #[error(
        "{iterations} iterations left a residual of {residual:.3e} N for forces of up to {scale:.3e} N"
    )]
    NotConverged { residual: f64, scale: f64, iterations: usize },
    #[error("element {element} at {} is inverted (volume ratio {ratio:.3})", place(at))]
    Inverted { element: usize, at: Vec3, ratio: f64 },
    #[error("in element {element} at {} {source}", place(at))]
    Material { element: usize, at: Vec3, source: ElastomerError },
    #[error("the stiffness is no longer positive definite: equilibrium is lost or not stable")]
    Unstable,
    #[error("forces are not finite")]
    NotFinite,
    #[error("the step changes strains by {strain:.3} (root mean square), too much for one step")]
    Far { strain: f64 },
    #[error(
        "{:.2} % of the work of a step is missing from the energy balance, even in the shortest step: the \
         rubber jumps to another equilibrium", 100.0 * part
    )]
    Jump { part: f64 },
    #[error("the estimated error stays above what is allowed")]
    Inaccurate,
}

/// Error of a factorisation at rest.
pub fn at_rest(error: FactorError) -> RubberError {
    match error {
        FactorError::NotPositiveDefinite { .. } => RubberError::Free,
        FactorError::NoMemory { bytes } => RubberError::NoMemory { bytes },
    }
}
