//! How much a quasi-static answer leaves out: natural frequencies of the assembly against the
//! frequencies of what drives it.
//!
//! A body on a spring that is driven at ω moves by 1/(1 − (ω/ω_n)²) of its static displacement, so
//! (ω/ω_n)² is the part that leaving out inertia misses, as long as it is small and the drive is
//! smooth. [`super::course_inertia`] follows a whole course, whose velocity jumps.

use super::condensed::CondensedBore;
use super::housed::{HousedSearch, HousedState};
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::kinematics::vec3::dot;
use crate::solver::statics::{Condition, StaticProblem};
use nalgebra::{DMatrix, DVector, Matrix4, SVector, SymmetricEigen};
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

/// Outer y, z, tilts; inner x, y, z, tilts: m and rad, or their rates.
pub(super) type Coordinates = SVector<f64, 9>;

/// One natural motion about an equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mode {
    /// ω², 1/s².
    pub square: f64,
    /// Of unit modal mass; zero in coordinates that are given.
    pub shape: Coordinates,
    /// Mass times shape.
    pub momentum: Coordinates,
    /// Part of the modal mass that is the housing's.
    pub housing: f64,
}

/// Natural motions about `state`, slowest first; the inner race's coordinates that are not `free`
/// stay where they are. `housing` is the mass that [`housing_mass`] gives. None of a mass matrix that
/// is not positive.
pub(super) fn modes(
    free: &[bool; 5],
    state: &HousedState,
    masses: &Masses,
    housing: &Matrix4<f64>,
) -> Vec<Mode> {
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
    let race = race_mass(masses);
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
    let kept: Vec<usize> = (0..9).filter(|&i| i < 4 || free[i - 4]).collect();
    let picked = |of: &DMatrix<f64>| of.select_rows(&kept).select_columns(&kept);
    let (stiffness, mass) = (picked(&stiffness), picked(&mass));
    let Some(factor) = mass.clone().cholesky() else { return Vec::new() };
    let lower = factor.l();
    let half = lower.solve_lower_triangular(&stiffness).unwrap_or_else(|| stiffness.clone());
    let both = lower.solve_lower_triangular(&half.transpose()).unwrap_or(half);
    let eigen = SymmetricEigen::new(0.5 * (&both + both.transpose()));
    let whole = |part: &DVector<f64>| {
        let mut all = Coordinates::zeros();
        kept.iter().zip(part.iter()).for_each(|(&i, x)| all[i] = *x);
        all
    };
    let mut found: Vec<Mode> = (0..kept.len())
        .map(|k| {
            let column = eigen.eigenvectors.column(k).into_owned();
            let shape = lower.transpose().solve_upper_triangular(&column).unwrap_or(column);
            let outer = shape.rows(0, 4);
            Mode {
                square: eigen.eigenvalues[k],
                momentum: whole(&(&mass * &shape)),
                housing: (outer.transpose() * housing * outer)[(0, 0)],
                shape: whole(&shape),
            }
        })
        .collect();
    found.sort_by(|a, b| a.square.total_cmp(&b.square));
    found
}

/// Natural frequency about `state`, the last equilibrium that `search` found. The housing takes part with the mass that its static
/// shape under the race's motion carries (Rayleigh), for each of the race's coordinates; that is an
/// upper bound of the frequency, near the truth while the housing's own modes are higher.
pub fn estimate(
    bearing: &StaticProblem,
    search: &HousedSearch,
    state: &HousedState,
    masses: &Masses,
) -> InertiaEstimate {
    let free = bearing.conditions.map(|condition| matches!(condition, Condition::Load(_)));
    let found = modes(&free, state, masses, &housing_mass(search));
    let Some(lowest) = found.first() else {
        return InertiaEstimate { lowest: f64::NAN, housing_share: f64::NAN };
    };
    let race = race_mass(masses);
    let races: f64 = (0..4).map(|i| race[i] * lowest.shape[i] * lowest.shape[i]).sum();
    InertiaEstimate {
        lowest: lowest.square.max(0.0).sqrt() / TAU,
        housing_share: lowest.housing / races,
    }
}

/// Of the outer race along y, z (kg) and its tilts (kg·m²).
fn race_mass(masses: &Masses) -> [f64; 4] {
    let outer = &masses.outer;
    [outer.mass, outer.mass, outer.transverse, outer.transverse]
}

/// Mass of the housing along the outer race's coordinates about the last equilibrium: its shape is
/// that under the loads which go with a unit of each while the same nodes touch.
pub(super) fn housing_mass(search: &HousedSearch) -> Matrix4<f64> {
    let (bore, loads): (&CondensedBore, _) = (search.bore().bore(), search.bore().loads_by_pose());
    let shapes = loads.each_ref().map(|loads| bore.response(loads));
    Matrix4::from_fn(|i, j| {
        let pairs = shapes[i].iter().zip(&shapes[j]).zip(&bore.mass);
        pairs.map(|((u, v), mass)| mass * dot(*u, *v)).sum()
    })
}
