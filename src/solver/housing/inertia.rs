//! How much a quasi-static course leaves out: natural frequencies of the assembly against the
//! frequencies of what drives it.
//!
//! A body on a spring that is driven at ω moves by 1/(1 − (ω/ω_n)²) of its static displacement, so
//! (ω/ω_n)² is the part that leaving out inertia misses, as long as it is small.

use super::assembly::{AssemblySearch, AssemblyState};
use super::condensed::CondensedBore;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::kinematics::vec3::dot;
use crate::solver::statics::{Condition, StaticProblem};
use nalgebra::{DMatrix, Matrix4, SymmetricEigen};
use std::f64::consts::TAU;

/// What moves besides the housing. The outer race is held along its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Masses {
    pub inner: Inertia,
    pub outer: Inertia,
}

/// Part of a quasi-static answer that inertia would change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertiaEstimate {
    /// Lowest natural frequency of inner race, outer race and the housing that moves with it, Hz.
    pub lowest: f64,
    /// Kinetic energy of the housing in that motion over that of the outer race.
    pub housing_share: f64,
}

impl InertiaEstimate {
    /// (f/f_n)² of an excitation, Hz: an error over the part of the displacement that goes with it.
    pub fn error_at(&self, frequency: f64) -> f64 {
        (frequency / self.lowest).powi(2)
    }
}

/// Natural frequency about `state`, the last equilibrium that `search` found. The housing takes part with the mass that its static
/// shape under the race's motion carries (Rayleigh), for each of the race's coordinates; that is an
/// upper bound of the frequency, near the truth while the housing's own modes are higher.
pub fn estimate(
    bearing: &StaticProblem,
    search: &AssemblySearch,
    state: &AssemblyState,
    masses: &Masses,
) -> InertiaEstimate {
    // Coordinates: outer y, z, tilts; inner x, y, z, tilts.
    let mut stiffness = DMatrix::<f64>::zeros(9, 9);
    let inner = &state.bearing.stiffness;
    for i in 0..5 {
        for j in 0..5 {
            stiffness[(4 + i, 4 + j)] += inner[(i, j)];
            if i > 0 {
                stiffness[(i - 1, 4 + j)] -= inner[(i, j)];
                stiffness[(4 + j, i - 1)] -= inner[(i, j)];
                if j > 0 {
                    stiffness[(i - 1, j - 1)] += inner[(i, j)];
                }
            }
        }
    }
    let support = &state.bore.stiffness;
    for i in 0..4 {
        for j in 0..4 {
            stiffness[(i, j)] += support[(i, j)];
        }
    }
    let housing = housing_mass(search.bore().bore(), &search.bore().loads_by_pose());
    let race =
        [masses.outer.mass, masses.outer.mass, masses.outer.transverse, masses.outer.transverse];
    let own = [
        masses.inner.mass,
        masses.inner.mass,
        masses.inner.mass,
        masses.inner.transverse,
        masses.inner.transverse,
    ];
    let mut mass = DMatrix::<f64>::zeros(9, 9);
    for i in 0..4 {
        mass[(i, i)] += race[i];
        for j in 0..4 {
            mass[(i, j)] += housing[(i, j)];
        }
    }
    for i in 0..5 {
        mass[(4 + i, 4 + i)] = own[i];
    }
    let free: Vec<usize> = (0..9)
        .filter(|&i| i < 4 || matches!(bearing.conditions[i - 4], Condition::Load(_)))
        .collect();
    let picked = |of: &DMatrix<f64>| of.select_rows(&free).select_columns(&free);
    let (stiffness, mass) = (picked(&stiffness), picked(&mass));
    let Some(factor) = mass.clone().cholesky() else {
        return InertiaEstimate { lowest: f64::NAN, housing_share: f64::NAN };
    };
    let lower = factor.l();
    let half = lower.solve_lower_triangular(&stiffness).unwrap_or_else(|| stiffness.clone());
    let both = lower.solve_lower_triangular(&half.transpose()).unwrap_or(half);
    let eigen = SymmetricEigen::new(0.5 * (&both + both.transpose()));
    let lowest = eigen.eigenvalues.imin();
    let shape = lower
        .transpose()
        .solve_upper_triangular(&eigen.eigenvectors.column(lowest).into_owned())
        .unwrap_or_else(|| eigen.eigenvectors.column(lowest).into_owned());
    let outer = shape.rows(0, 4);
    let energy = |m: &Matrix4<f64>| (outer.transpose() * m * outer)[(0, 0)];
    let races = energy(&Matrix4::from_diagonal(&race.into()));
    InertiaEstimate {
        lowest: eigen.eigenvalues[lowest].max(0.0).sqrt() / TAU,
        housing_share: energy(&housing) / races,
    }
}

/// Mass of the housing along the race's coordinates: its shape is that under the loads which go with
/// a unit of each while the same nodes touch.
fn housing_mass(bore: &CondensedBore, loads: &[Vec<f64>; 4]) -> Matrix4<f64> {
    let shapes = loads.each_ref().map(|loads| bore.response(loads));
    Matrix4::from_fn(|i, j| {
        let pairs = shapes[i].iter().zip(&shapes[j]).zip(&bore.mass);
        pairs.map(|((u, v), mass)| mass * dot(*u, *v)).sum()
    })
}
