//! Sparse symmetric matrices over the nodes of a mesh, and their Cholesky factors.

pub mod dissection;
pub mod elimination;
pub mod factor;
pub mod graph;
pub mod matrix;
pub mod memory;
pub mod minimum_degree;
pub mod separator;

use crate::kinematics::vec3::Vec3;
use elimination::{Elimination, analyse};
pub use factor::Factor;
use graph::Graph;
pub use matrix::{Entry, SymmetricMatrix};
pub use memory::{Memory, Task, TooLarge};
use thiserror::Error;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum FactorError {
    #[error("the stiffness matrix is not positive definite (unknown {pivot})")]
    NotPositiveDefinite { pivot: usize },
    #[error("not enough memory for the factor of the stiffness matrix, {:.2} GB", 1e-9 * bytes)]
    NoMemory { bytes: f64 },
}

/// Method of the elimination order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ordering {
    MinimumDegree,
    NestedDissection,
    /// The method with fewer operations; beyond 20 000 nodes always dissection, which had fewer on every large mesh tested.
    Cheapest,
}

/// Number of nodes beyond which only dissection is tried.
const LARGE: usize = 20_000;

/// Elimination order of the nodes with unknowns (`weight`), and the resulting structure of the factor.
pub fn ordered(
    graph: &Graph,
    places: &[Vec3],
    weight: impl Fn(u32) -> usize,
    ordering: Ordering,
) -> (Vec<u32>, Elimination) {
    let nodes: Vec<u32> = (0..graph.nodes() as u32).filter(|node| weight(*node) > 0).collect();
    let graph = graph.permuted(&nodes);
    let places: Vec<Vec3> = nodes.iter().map(|node| places[*node as usize]).collect();
    let analysed = |order: Vec<u32>| analyse(&graph, &order, |node| weight(nodes[node as usize]));
    let by_degree = || analysed(minimum_degree::minimum_degree(&graph));
    let dissected = || analysed(dissection::nested_dissection(&graph, &places));
    let found = match ordering {
        Ordering::MinimumDegree => by_degree(),
        Ordering::NestedDissection => dissected(),
        Ordering::Cheapest if nodes.len() > LARGE => dissected(),
        Ordering::Cheapest => {
            let (one, other) = (by_degree(), dissected());
            if one.elimination.operations < other.elimination.operations { one } else { other }
        }
    };
    let order = found.order.iter().map(|node| nodes[*node as usize]).collect();
    (order, found.elimination)
}
