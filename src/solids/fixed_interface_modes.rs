//! Modes of a housing with its race fixed: the part that static displacements under the race's motion omit.
//!
//! About an equilibrium the contact nodes of the bore are coupled to the race by their contact springs, P = Σ K n nᵀ.
//! The displacements that follow the race are orthogonal, under K + P, to all that vanish at it; the two share mass
//! alone (Craig and Bampton 1968, with the race's four coordinates as the interface). Modes with the race fixed are
//! combinations of (K + P)⁻¹ M φ for the natural modes φ of the housing without contact, ω² M φ = K φ. Up to a factor
//! that is φ less the response to the loads by which the race holds the contact nodes, so that nothing has to be
//! factorised again.

use crate::kinematics::vec3::{Vec3, add, dot};
use crate::solids::bore_equilibrium::BoreSearch;
use crate::solids::condensation::CondensedBore;
use crate::solids::model::SolidModel;
use crate::solids::modes::Mode;
use crate::solids::reduction::{ReduceError, lowest_modes, natural_modes};
use crate::solids::tangent::{MassMatrix, consistent_momentum};
use crate::vibrations::quasi_static_limit::{FixedInterfaceMode, HousingMass, housing_mass};
use nalgebra::{DMatrix, SymmetricEigen};
use std::f64::consts::TAU;

/// Choice of natural modes of a housing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Natural {
    /// This number of the lowest.
    Lowest(usize),
    /// Up to this frequency, Hz.
    UpTo(f64),
}

/// Natural modes of `model`, condensed as `bore`, and the frequency of the first omitted one, Hz: frequencies close to
/// it are overestimated.
///
/// # Errors
///
/// Natural modes that are not found.
pub fn natural_modes_of(
    model: &SolidModel,
    bore: &CondensedBore,
    natural: Natural,
) -> Result<(Vec<Mode>, f64), ReduceError> {
    match natural {
        Natural::UpTo(frequency) => natural_modes(model, bore, frequency, MassMatrix::Consistent),
        Natural::Lowest(count) => lowest_modes(model, bore, count),
    }
}

/// The housing `model` of a search about the last equilibrium of its bore: displacements that follow the race, the body of
/// index `race` among the moving ones, and modes with the race fixed from the `natural` modes; `damping` of its
/// elements in 1/s.
pub fn vibrating_housing(
    search: &BoreSearch,
    model: &SolidModel,
    race: usize,
    natural: &[Mode],
    damping: f64,
) -> HousingMass {
    HousingMass {
        held: fixed_interface_modes(search, model, natural),
        damping,
        ..housing_mass(search, model, race)
    }
}

/// Modes with the race fixed, from the responses of natural modes to their own inertia.
fn fixed_interface_modes(
    search: &BoreSearch,
    model: &SolidModel,
    natural: &[Mode],
) -> Vec<FixedInterfaceMode> {
    if natural.is_empty() {
        return Vec::new();
    }
    let bore = search.bore();
    let held: Vec<Vec<Vec3>> =
        natural.iter().map(|mode| with_race_fixed(search, &mode.shape)).collect();
    let followers = search.loads_by_pose().map(|loads| bore.response(&loads));
    let inner = |a: &[Vec3], b: &[Vec3]| -> f64 { a.iter().zip(b).map(|(u, v)| dot(*u, *v)).sum() };
    let momentum = |shape: &[Vec3]| consistent_momentum(model, shape);
    let own: Vec<Vec<Vec3>> = natural.iter().map(|mode| momentum(&mode.shape)).collect();
    let of_held: Vec<Vec<Vec3>> = held.iter().map(|shape| momentum(shape)).collect();
    let count = held.len();
    // (K + P) χ_l = ω_l² M φ_l.
    let stiffness = DMatrix::from_fn(count, count, |k, l| {
        (TAU * natural[l].frequency).powi(2) * inner(&held[k], &own[l])
    });
    let mass = DMatrix::from_fn(count, count, |k, l| inner(&held[k], &of_held[l]));
    let shared = DMatrix::from_fn(4, count, |i, l| inner(&followers[i], &of_held[l]));
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

/// A displacement of all nodes with the response to the forces of the fixed race at the contact nodes.
fn with_race_fixed(search: &BoreSearch, shape: &[Vec3]) -> Vec<Vec3> {
    let bore = search.bore();
    let outward = bore.nodes.iter().map(|node| {
        let out = bore.to_world([0.0, node.normal[0], node.normal[1]]);
        dot(shape[node.node as usize], out)
    });
    let loads = search.loads_against(&outward.collect::<Vec<_>>());
    let answer = bore.response(&loads);
    shape.iter().zip(answer).map(|(own, answer)| add(*own, answer)).collect()
}
