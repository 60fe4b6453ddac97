//! Inertia of bodies and of the housings that move with them: natural modes about an equilibrium.
//!
//! A mass on a spring that is driven at ω moves by 1/(1 − (ω/ω_n)²) of its static displacement. So (ω/ω_n)² is the
//! relative error of a quasi-static answer, as long as it is small and the drive is smooth.

use crate::ch2_housing::bearing::inertia::Inertia;
use crate::kinematics::vec3::dot;
use crate::solids::bore_equilibrium::BoreSearch;
use crate::solids::model::SolidModel;
use crate::solids::tangent::consistent_momentum;
use nalgebra::{DMatrix, DVector, Matrix4, SymmetricEigen};
use std::f64::consts::TAU;

/// A rigid body in motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingBody {
    /// Index in the assembly.
    pub body: usize,
    pub inertia: Inertia,
    /// Free coordinates; the others are fixed.
    pub free: [bool; 5],
}

/// x, y, z (m) and tilts (rad) of each moving body, or their rates.
pub type Coordinates = DVector<f64>;

/// Mass of a housing along y, z and the tilts of a race in it.
#[derive(Clone, Debug, PartialEq)]
pub struct HousingMass {
    /// Index of the race's body in the list of moving bodies.
    pub race: usize,
    pub mass: Matrix4<f64>,
    /// Modes with the race fixed.
    pub held: Vec<FixedInterfaceMode>,
    /// α of the damping α M of its elements, 1/s.
    pub damping: f64,
}

/// Mode of a housing with its race fixed, of a modal mass of 1 kg: see [`crate::solids::fixed_interface_modes`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedInterfaceMode {
    /// ω², 1/s².
    pub square: f64,
    /// Mass coupling with y, z and the tilts of the race, √kg and m √kg.
    pub shared: [f64; 4],
}

/// A natural mode about an equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// ω², 1/s².
    pub square: f64,
    /// Normalised to unit modal mass; zero in fixed coordinates.
    pub shape: Coordinates,
    /// Mass times mode.
    pub momentum: Coordinates,
    /// Fractions of the modal mass in the housings.
    pub housings: Vec<f64>,
}

/// Stiffness over the coordinates of the bodies, the amplitudes of modes (of 1 kg) and the fixed-interface modes of
/// housings, in this order; and the mass matrix of the same.
pub fn with_housings(
    stiffness: &DMatrix<f64>,
    bodies: &[MovingBody],
    housings: &[HousingMass],
) -> [DMatrix<f64>; 2] {
    let known = stiffness.nrows();
    let count = known + housings.iter().map(|of| of.held.len()).sum::<usize>();
    let mut whole = DMatrix::zeros(count, count);
    whole.view_mut((0, 0), (known, known)).copy_from(stiffness);
    let mut mass = DMatrix::zeros(count, count);
    for (of, MovingBody { inertia, .. }) in bodies.iter().enumerate() {
        for (i, own) in diagonal(inertia).into_iter().enumerate() {
            mass[(5 * of + i, 5 * of + i)] = own;
        }
    }
    (5 * bodies.len()..known).for_each(|shape| mass[(shape, shape)] = 1.0);
    let squares = housings.iter().flat_map(|of| &of.held).map(|motion| motion.square);
    (known..).zip(squares).for_each(|(at, square)| whole[(at, at)] = square);
    add_housings(&mut mass, known, housings, |_| 1.0);
    [whole, mass]
}

/// Adds the mass of housings, each with a factor `times`; their fixed-interface modes begin at `first`.
pub fn add_housings(
    to: &mut DMatrix<f64>,
    first: usize,
    housings: &[HousingMass],
    times: impl Fn(&HousingMass) -> f64,
) {
    let mut at = first;
    for of in housings {
        let (race, times) = (5 * of.race + 1, times(of));
        let mut block = to.fixed_view_mut::<4, 4>(race, race);
        block += of.mass * times;
        for FixedInterfaceMode { shared, .. } in &of.held {
            to[(at, at)] += times;
            for (i, shared) in shared.iter().enumerate() {
                to[(race + i, at)] += times * shared;
                to[(at, race + i)] += times * shared;
            }
            at += 1;
        }
    }
}

/// Natural modes about an equilibrium with this stiffness over the coordinates of the bodies and the amplitudes of
/// modes, lowest first; those of housings come last. `None` if the mass matrix is not positive definite.
pub fn modes(
    stiffness: &DMatrix<f64>,
    bodies: &[MovingBody],
    housings: &[HousingMass],
) -> Vec<Mode> {
    let (own, known) = (5 * bodies.len(), stiffness.nrows());
    let [stiffness, mass] = with_housings(stiffness, bodies, housings);
    let count = stiffness.nrows();
    let kept: Vec<usize> = (0..count).filter(|&i| i >= own || bodies[i / 5].free[i % 5]).collect();
    let picked = |of: &DMatrix<f64>| of.select_rows(&kept).select_columns(&kept);
    let (stiffness, mass) = (picked(&stiffness), picked(&mass));
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
            let mut at = known;
            let mut share = |HousingMass { race, mass, held, .. }: &HousingMass| {
                let own = shape.fixed_rows::<4>(5 * race + 1);
                let mut part = (own.transpose() * mass * own)[(0, 0)];
                for FixedInterfaceMode { shared, .. } in held {
                    let with_race: f64 = shared.iter().zip(own.iter()).map(|(m, x)| m * x).sum();
                    part += shape[at] * (shape[at] + 2.0 * with_race);
                    at += 1;
                }
                part
            };
            let housings = housings.iter().map(&mut share).collect();
            Mode { square: eigen.eigenvalues[k], momentum, housings, shape }
        })
        .collect();
    found.sort_by(|a, b| a.square.total_cmp(&b.square));
    found
}

/// Lowest natural frequency, Hz, about an equilibrium with this stiffness over the coordinates of the bodies and the
/// amplitudes of modes. `None` if nothing moves or a body has no mass.
pub fn lowest_frequency(
    stiffness: &DMatrix<f64>,
    bodies: &[MovingBody],
    housings: &[HousingMass],
) -> Option<f64> {
    let found = modes(stiffness, bodies, housings);
    found.first().map(|lowest| lowest.square.max(0.0).sqrt() / TAU)
}

/// Inertia of a body along x, y, z (kg) and its tilts (kg·m²).
fn diagonal(inertia: &Inertia) -> [f64; 5] {
    let Inertia { mass, transverse, .. } = *inertia;
    [mass, mass, mass, transverse, transverse]
}

/// Consistent mass of a housing `model` along the outer race's coordinates about the last equilibrium of its bore: of the displacement
/// under the loads of a unit of each coordinate, with the same contact nodes.
pub fn housing_mass(search: &BoreSearch, model: &SolidModel, race: usize) -> HousingMass {
    let (bore, loads) = (search.bore(), search.loads_by_pose());
    let shapes = loads.each_ref().map(|loads| bore.response(loads));
    let momenta = shapes.each_ref().map(|shape| consistent_momentum(model, shape));
    let mass =
        Matrix4::from_fn(|i, j| shapes[i].iter().zip(&momenta[j]).map(|(u, v)| dot(*u, *v)).sum());
    HousingMass { race, mass, held: Vec::new(), damping: 0.0 }
}
