//! How much a quasi-static answer leaves out: natural frequencies of the assembly against the
//! frequencies of what drives it.
//!
//! A body on a spring that is driven at ω moves by 1/(1 − (ω/ω_n)²) of its static displacement, so
//! (ω/ω_n)² is the part that leaving out inertia misses, as long as it is small and the drive is
//! smooth. [`super::course_inertia`] follows a whole course, whose velocity jumps.

use super::bore_equilibrium::BoreSearch;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::kinematics::vec3::dot;
use nalgebra::{DMatrix, DVector, Matrix4, SymmetricEigen};
use std::f64::consts::TAU;

/// A rigid body that takes part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingBody {
    /// Index in the assembly.
    pub body: usize,
    pub inertia: Inertia,
    /// Coordinates that it may move along; others stay where they are.
    pub free: [bool; 5],
}

/// Part of a quasi-static answer that inertia would change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertiaEstimate {
    /// Lowest natural frequency of bodies and the housings that move with them, Hz.
    pub lowest: f64,
    /// Kinetic energy of the housings in that motion over that of the races in them.
    pub housing_share: f64,
}

impl InertiaEstimate {
    /// (f/f_n)² of an excitation, Hz: an error over the part of the displacement that goes with it.
    pub fn error_at(&self, frequency: f64) -> f64 {
        (frequency / self.lowest).powi(2)
    }
}

/// x, y, z (m) and tilts (rad) of each body that takes part, or their rates.
pub type Coordinates = DVector<f64>;

/// Mass of a housing along y, z and the tilts of a race in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HousingMass {
    /// Place of the race's body in the list of those that take part.
    pub race: usize,
    pub mass: Matrix4<f64>,
}

/// One natural motion about an equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// ω², 1/s².
    pub square: f64,
    /// Of unit modal mass; zero in coordinates that are given.
    pub shape: Coordinates,
    /// Mass times shape.
    pub momentum: Coordinates,
    /// Parts of the modal mass that are the housings'.
    pub housings: Vec<f64>,
}

/// Over the five coordinates of each body.
pub fn mass_matrix(bodies: &[MovingBody], housings: &[HousingMass]) -> DMatrix<f64> {
    let count = 5 * bodies.len();
    let mut mass = DMatrix::<f64>::zeros(count, count);
    for (of, MovingBody { inertia, .. }) in bodies.iter().enumerate() {
        for (i, own) in diagonal(inertia).into_iter().enumerate() {
            mass[(5 * of + i, 5 * of + i)] = own;
        }
    }
    for HousingMass { race, mass: own } in housings {
        let mut block = mass.fixed_view_mut::<4, 4>(5 * race + 1, 5 * race + 1);
        block += own;
    }
    mass
}

/// Natural motions about an equilibrium with this stiffness over the coordinates of the bodies, and amplitudes of shapes
/// behind them, slowest first. None of
/// a mass matrix that is not positive.
pub fn modes(
    stiffness: &DMatrix<f64>,
    bodies: &[MovingBody],
    housings: &[HousingMass],
) -> Vec<Mode> {
    let of_bodies = mass_matrix(bodies, housings);
    let (own, count) = (of_bodies.nrows(), stiffness.nrows());
    // Shapes have a mass of 1 kg.
    let mut mass = DMatrix::identity(count, count);
    mass.view_mut((0, 0), (own, own)).copy_from(&of_bodies);
    let kept: Vec<usize> = (0..count).filter(|&i| i >= own || bodies[i / 5].free[i % 5]).collect();
    let picked = |of: &DMatrix<f64>| of.select_rows(&kept).select_columns(&kept);
    let (stiffness, mass) = (picked(stiffness), picked(&mass));
    let Some(factor) = mass.clone().cholesky() else { return Vec::new() };
    let lower = factor.l();
    let half = lower.solve_lower_triangular(&stiffness).unwrap_or_else(|| stiffness.clone());
    let both = lower.solve_lower_triangular(&half.transpose()).unwrap_or(half);
    let eigen = SymmetricEigen::new(0.5 * (&both + both.transpose()));
    let whole = |part: &DVector<f64>| {
        let mut all = Coordinates::zeros(count);
        kept.iter().zip(part.iter()).for_each(|(&i, x)| all[i] = *x);
        all
    };
    let mut found: Vec<Mode> = (0..kept.len())
        .map(|k| {
            let column = eigen.eigenvectors.column(k).into_owned();
            let shape = lower.transpose().solve_upper_triangular(&column).unwrap_or(column);
            let momentum = whole(&(&mass * &shape));
            let shape = whole(&shape);
            let share = |HousingMass { race, mass }: &HousingMass| {
                let own = shape.fixed_rows::<4>(5 * race + 1);
                (own.transpose() * mass * own)[(0, 0)]
            };
            let housings = housings.iter().map(share).collect();
            Mode { square: eigen.eigenvalues[k], momentum, housings, shape }
        })
        .collect();
    found.sort_by(|a, b| a.square.total_cmp(&b.square));
    found
}

/// Natural frequency about an equilibrium with this stiffness over the coordinates of the bodies. A housing takes part
/// with the mass that its static shape under the race's motion carries (Rayleigh), for each of the race's coordinates;
/// that is an upper bound of the frequency, near the truth while the housing's own modes are higher.
pub fn estimate(
    stiffness: &DMatrix<f64>,
    bodies: &[MovingBody],
    housings: &[HousingMass],
) -> InertiaEstimate {
    let found = modes(stiffness, bodies, housings);
    let Some(lowest) = found.first() else {
        return InertiaEstimate { lowest: f64::NAN, housing_share: f64::NAN };
    };
    let of_race = |HousingMass { race, .. }: &HousingMass| {
        let own = diagonal(&bodies[*race].inertia);
        (1..5)
            .map(|i| own[i] * lowest.shape[5 * race + i] * lowest.shape[5 * race + i])
            .sum::<f64>()
    };
    InertiaEstimate {
        lowest: lowest.square.max(0.0).sqrt() / TAU,
        housing_share: lowest.housings.iter().sum::<f64>()
            / housings.iter().map(of_race).sum::<f64>(),
    }
}

/// Of a body along x, y, z (kg) and its tilts (kg·m²).
fn diagonal(inertia: &Inertia) -> [f64; 5] {
    let Inertia { mass, transverse, .. } = *inertia;
    [mass, mass, mass, transverse, transverse]
}

/// Mass of a housing along the outer race's coordinates about the last equilibrium of its bore: its shape is
/// that under the loads which go with a unit of each while the same nodes touch.
pub fn housing_mass(search: &BoreSearch, race: usize) -> HousingMass {
    let (bore, loads) = (search.bore(), search.loads_by_pose());
    let shapes = loads.each_ref().map(|loads| bore.response(loads));
    let mass = Matrix4::from_fn(|i, j| {
        let pairs = shapes[i].iter().zip(&shapes[j]).zip(&bore.mass);
        pairs.map(|((u, v), mass)| mass * dot(*u, *v)).sum()
    });
    HousingMass { race, mass }
}
