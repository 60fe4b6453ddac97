//! Errors of a solid.

use crate::ch2_housing::elastomer::ElastomerError;
use crate::elements::ElementError;
use crate::kinematics::vec3::Vec3;
use crate::numeric::clock::{rounded, to_digits};
use crate::numeric::sparse::FactorError;
use crate::solids::labels::{Labels, node_text};
use crate::solids::tangent::Unknowns;
use crate::solids::trust::Placed;
use std::fmt;
use thiserror::Error;

/// Elements and nodes by their [`Labels`], `at` undeformed, m.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SolidError {
    #[error("element {element} at {}: {source}; check the mesh", place(at))]
    Element { element: u64, at: Vec3, source: ElementError },
    #[error("density is {0} kg/m3; it must be positive and finite")]
    Density(f64),
    #[error("damping is {0} 1/s; it must be zero or positive, and finite")]
    Damping(f64),
    #[error("node {node} does not exist: the mesh has {count} nodes")]
    NoSuchNode { node: u32, count: usize },
    #[error(
        "{} belongs to no element, so it has no mass; remove it from the mesh",
        node_text(node)
    )]
    NoMass { node: Option<u64> },
    #[error("axis {axis} of node {node} is prescribed; axes are 0, 1 and 2")]
    NoSuchAxis { node: u32, axis: usize },
    #[error("axis {axis} of node {node} is prescribed twice")]
    PrescribedTwice { node: u32, axis: usize },
    #[error(transparent)]
    Constants(#[from] ElastomerError),
    #[error("elements of four nodes; rubber needs ten-node elements")]
    FourNodes,
    #[error("the {what} is {value}; it must be positive and finite")]
    Option { what: &'static str, value: f64 },
    #[error("the angular frequency is {0} rad/s; it must not be negative")]
    Pulsation(f64),
    #[error(
        "the complex stiffness does not converge: with {vectors} basis vectors it still changes by \
         {change:.1e}; {tolerance:.1e} is allowed"
    )]
    NotSettled { vectors: usize, change: f64, tolerance: f64 },
    #[error(
        "the step of {step:.3e} s is beyond the stability limit of {limit:.3e} s, set by element \
         {element} at {}; take a smaller step or a coarser mesh there",
        place(at)
    )]
    Step { step: f64, limit: f64, element: u64, at: Vec3 },
    #[error(
        "{} at {} has a value that is not finite at t = {} s, step {step}",
        node_text(node),
        place(at),
        rounded(*time)
    )]
    NotFinite { node: Option<u64>, at: Vec3, time: f64, step: u64 },
    #[error(
         "element {element} at {} is inverted at t = {} s, step {step} (volume ratio {ratio:.3})",
        place(at),
        rounded(*time)
    )]
    Inverted { element: u64, at: Vec3, ratio: f64, time: f64, step: u64 },
    #[error("element {element} at {} at t = {} s, step {step}: {source}", place(at), rounded(*time))]
    Material { element: u64, at: Vec3, source: ElastomerError, time: f64, step: u64 },
    #[error(transparent)]
    Factor(#[from] FactorError),
    #[error(
        "the stiffness of the body at rest is not positive definite ({pivot}): a part is free to move, or is barely \
          supported; fix it, or check the mesh for parts that are not joined"
    )]
    Free { pivot: Pivot },
    /// In a step or at a fraction of the load; a smaller step may succeed.
    #[error(transparent)]
    Failed(#[from] StepFailure),
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
    #[error("no equilibrium found: at {fraction} of the load {failure}; {}", remedy(*poisson_ratio))]
    Unbalanced { fraction: f64, failure: StepFailure, poisson_ratio: f64 },
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

/// Failure of a search for equilibrium.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum StepFailure {
    #[error(
        "{iterations} iterations left a residual of {residual:.3e} N for forces of up to {scale:.3e} N"
    )]
    NotConverged { residual: f64, scale: f64, iterations: usize },
    #[error("element {element} at {} is inverted (volume ratio {ratio:.3})", place(at))]
    Inverted { element: u64, at: Vec3, ratio: f64 },
    #[error("in element {element} at {} {source}", place(at))]
    Material { element: u64, at: Vec3, source: ElastomerError },
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
    /// The component of an unknown of a solid with these `nodes`.
    pub fn of(nodes: &[Vec3], labels: &Labels, unknowns: &Unknowns, number: usize) -> Pivot {
        let found = unknowns.of.iter().enumerate().find_map(|(node, of)| {
            let axis = of.iter().position(|unknown| *unknown == number)?;
            Some((node, axis))
        });
        let (node, axis) = found.expect("factors have a pivot for each unknown");
        Pivot { node: labels.node(node), at: nodes[node], axis }
    }
}

impl fmt::Display for Pivot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axis = ["x", "y", "z"][self.axis];
        write!(f, "{} at {}, along {axis}", node_text(&self.node), place(&self.at))
    }
}

/// Error of a factorisation of the stiffness at rest.
pub(crate) fn at_rest(
    error: FactorError,
    nodes: &[Vec3],
    labels: &Labels,
    unknowns: &Unknowns,
) -> SolidError {
    match error {
        FactorError::NotPositiveDefinite { pivot } => {
            SolidError::Free { pivot: Pivot::of(nodes, labels, unknowns, pivot) }
        }
        error => error.into(),
    }
}

pub(crate) fn place(at: &Vec3) -> String {
    format!("({:.6}, {:.6}, {:.6}) m", at[0], at[1], at[2])
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
