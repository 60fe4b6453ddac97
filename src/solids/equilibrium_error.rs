//! Errors in the equilibrium of a solid.

use crate::kinematics::vec3::Vec3;
use crate::numeric::clock::to_digits;
use crate::numeric::sparse::FactorError;
use crate::solids::model::{SolidModel, place};
use crate::solids::tangent::Unknowns;
use crate::solids::trust::Placed;
use std::fmt;
use thiserror::Error;

/// A displacement component at which a stiffness is not positive definite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pivot {
    /// Number in the mesh file; `None` for a mid-side node that the file does not have.
    pub node: Option<u64>,
    /// Undeformed position, m.
    pub at: Vec3,
    /// 0, 1 or 2 for X, Y, Z.
    pub axis: usize,
}

impl Pivot {
    /// The component of this unknown.
    pub fn of(model: &SolidModel, unknowns: &Unknowns, number: usize) -> Pivot {
        let found = unknowns.of.iter().enumerate().find_map(|(node, of)| {
            let axis = of.iter().position(|unknown| *unknown == number)?;
            Some((node, axis))
        });
        let (node, axis) = found.expect("factors have a pivot for each unknown");
        Pivot { node: model.labels.node(node), at: model.problem.nodes[node], axis }
    }
}

impl fmt::Display for Pivot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axis = ["x", "y", "z"][self.axis];
        write!(
            f,
            "{} at {}, along {axis}",
            crate::solids::labels::node_text(&self.node),
            place(&self.at)
        )
    }
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum EquilibriumError {
    #[error(transparent)]
    Factor(FactorError),
    #[error("{}", free_text(pivot))]
    Free { pivot: Pivot },
    #[error(
         "no equilibrium found {}: beyond that the stiffness is not positive definite ({pivot}). Without load \
          it is positive definite, so that no part is free to move: the load is too large for the body, or the \
          body buckles. For comparison: a linear solution under the whole load has a displacement of {} mm \
          (at {}), and the body has a size of {} mm; {}",
        reached_load_text(*reached, moved), millimetres(linear.value), place(&linear.at), millimetres(*size),
        remedy(*poisson_ratio)
    )]
    TooLarge {
        /// Largest fraction of the load with an equilibrium, and the largest displacement there.
        reached: f64,
        moved: Box<Placed>,
        pivot: Box<Pivot>,
        /// Largest displacement by the stiffness at rest under the whole load, m.
        linear: Box<Placed>,
        /// Diagonal of the box around the body, m.
        size: f64,
        poisson_ratio: f64,
    },
    #[error(
         "no equilibrium found: at {fraction} of the load the force residual is {residual:.3e} N \
         of {scale:.3e} N after {iterations} iterations; {}",
        remedy(*poisson_ratio)
    )]
    NotConverged { fraction: f64, residual: f64, scale: f64, iterations: usize, poisson_ratio: f64 },
    #[error(
         "no equilibrium found: at {fraction} of the load element {element} at {} is inverted \
         (volume ratio {ratio:.3}); {}",
        place(at),
        remedy(*poisson_ratio)
    )]
    Inverted { fraction: f64, element: u64, at: Vec3, ratio: f64, poisson_ratio: f64 },
}

/// Message for a body whose stiffness at rest is singular.
pub fn free_text(pivot: &Pivot) -> String {
    format!(
        "the stiffness of the body at rest is not positive definite ({pivot}): a part is free to move, or is barely \
          supported; fix it, or check the mesh for parts that are not joined"
    )
}

/// The last equilibrium of a search.
fn reached_load_text(reached: f64, moved: &Placed) -> String {
    if reached > 0.0 {
        let moved_by = millimetres(moved.value);
        return format!(
            "beyond {} % of the load, where the body has moved by up to {moved_by} mm (at {})",
            to_digits(100.0 * reached, 3),
            place(&moved.at)
        );
    }
    "under the smallest fraction of the load that was tried".to_string()
}

fn millimetres(length: f64) -> f64 {
    to_digits(1e3 * length, 4)
}

/// 1 − 2ν below which rounding of stresses, 1e-16 over it, exceeds
/// [`EquilibriumOptions::rounding`](crate::solids::equilibrium::EquilibriumOptions::rounding).
const INCOMPRESSIBLE: f64 = 2e-6;

fn remedy(poisson_ratio: f64) -> String {
    if 1.0 - 2.0 * poisson_ratio < INCOMPRESSIBLE {
        return format!(
            "Poisson's ratio {poisson_ratio} is so near to 1/2, where no volume changes, that rounding of the \
             stresses is larger than what has to balance: write 0.49999 or less, with order = 2 in \
             [solid.mesh]"
        );
    }
    "apply less load, or check its unit and Young's modulus".to_string()
}
