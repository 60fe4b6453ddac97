//! How a housing swings while the race in it stands still: what static shapes under the race's motion leave out.
//!
//! About an equilibrium the bore's nodes that touch hang on the race by their contact springs, P = Σ K n nᵀ. The shapes that follow
//! the race are orthogonal, under K + P, to all that vanish at it; the motions of the two share mass alone (Craig and Bampton 1968,
//! the race's four coordinates as the interface). Those with the race at rest are combined of (K + P)⁻¹ M φ for the natural shapes φ
//! of the housing without contact, ω² M φ = K φ: up to a factor that is φ less the answer to the loads with which the race keeps the nodes
//! in contact where they are, so that nothing has to be factorised again.

use crate::kinematics::vec3::{Vec3, add, dot};
use crate::solids::bore_equilibrium::BoreSearch;
use crate::solids::condensation::CondensedBore;
use crate::solids::model::SolidModel;
use crate::solids::modes::Mode;
use crate::solids::reduction::{ReduceError, lowest_shapes, natural_shapes};
use crate::vibrations::quasi_static_limit::{FixedInterfaceMode, HousingMass, housing_mass};
use nalgebra::{DMatrix, SymmetricEigen};
use std::f64::consts::TAU;

/// Natural shapes of a housing that are made use of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Natural {
    /// So many of the lowest.
    Lowest(usize),
    /// Up to this frequency, Hz.
    UpTo(f64),
}

/// Natural shapes of `model`, condensed as `bore`, and the frequency of the first one that is left out, Hz: what swings nearly as fast
/// as that is told too fast.
///
/// # Errors
/// Natural shapes that are not found.
pub fn natural_shapes_of(
    model: &SolidModel,
    bore: &CondensedBore,
    natural: Natural,
) -> Result<(Vec<Mode>, f64), ReduceError> {
    match natural {
        Natural::UpTo(frequency) => natural_shapes(model, bore, frequency),
        Natural::Lowest(count) => lowest_shapes(model, bore, count),
    }
}

/// The housing of a search about the last equilibrium of its bore, with its shapes that follow the race, the body of number `race` among
/// those that take part, and what its `natural` shapes do besides; `damping` of its elements in 1/s.
pub fn swinging_housing(
    search: &BoreSearch,
    race: usize,
    natural: &[Mode],
    damping: f64,
) -> HousingMass {
    HousingMass {
        held: fixed_interface_modes(search, natural),
        damping,
        ..housing_mass(search, race)
    }
}

/// Motions with the race at rest, combined of what natural shapes (lumped masses) become under a unit of their own inertia.
fn fixed_interface_modes(search: &BoreSearch, natural: &[Mode]) -> Vec<FixedInterfaceMode> {
    if natural.is_empty() {
        return Vec::new();
    }
    let bore = search.bore();
    let held: Vec<Vec<Vec3>> = natural.iter().map(|mode| held_back(search, &mode.shape)).collect();
    let followers = search.loads_by_pose().map(|loads| bore.response(&loads));
    let inner = |a: &[Vec3], b: &[Vec3]| -> f64 {
        a.iter().zip(b).zip(&bore.mass).map(|((u, v), mass)| mass * dot(*u, *v)).sum()
    };
    let count = held.len();
    // (K + P) χ_l = ω_l² M φ_l.
    let stiffness = DMatrix::from_fn(count, count, |k, l| {
        (TAU * natural[l].frequency).powi(2) * inner(&held[k], &natural[l].shape)
    });
    let mass = DMatrix::from_fn(count, count, |k, l| inner(&held[k], &held[l]));
    let shared = DMatrix::from_fn(4, count, |i, l| inner(&followers[i], &held[l]));
    let Some(factor) = mass.cholesky() else { return Vec::new() };
    let lower = factor.l();
    let over = |of: DMatrix<f64>| lower.solve_lower_triangular(&of).unwrap_or(of);
    let both = over(over(0.5 * (&stiffness + stiffness.transpose())).transpose());
    let eigen = SymmetricEigen::new(0.5 * (&both + both.transpose()));
    let shared = over(shared.transpose()).transpose() * &eigen.eigenvectors;
    let of = |k: usize| FixedInterfaceMode {
        square: eigen.eigenvalues[k],
        shared: std::array::from_fn(|i| shared[(i, k)]),
    };
    let mut all: Vec<FixedInterfaceMode> = (0..count).map(of).collect();
    all.sort_by(|a, b| a.square.total_cmp(&b.square));
    all
}

/// A displacement of all nodes with what the race, which stands still, does against it where nodes touch.
fn held_back(search: &BoreSearch, shape: &[Vec3]) -> Vec<Vec3> {
    let bore = search.bore();
    let outward = bore.nodes.iter().map(|node| {
        let out = bore.to_world([0.0, node.normal[0], node.normal[1]]);
        dot(shape[node.node as usize], out)
    });
    let loads = search.loads_against(&outward.collect::<Vec<_>>());
    let answer = bore.response(&loads);
    shape.iter().zip(answer).map(|(own, answer)| add(*own, answer)).collect()
}
