//! Rigid motions and masses of a solid, and tests of axisymmetry about X.

use crate::elements::{tet4::Tet4, tet10};
use crate::kinematics::vec3::{Vec3, cross, sub};
use crate::members::condensed_shaft::SolidShaftError;
use crate::members::free_modes::lowest;
use crate::mesh::tet_mesh::Elements;
use crate::solids::model::{SolidProblem, corners};
use nalgebra::{DMatrix, DVector};

/// Largest relative difference of inertia and stiffness around: that of coarse meshes of round bodies.
const ROUND: f64 = 1e-2;
/// Largest eccentricity of a section's centre, in radii.
pub(crate) const CENTRED: f64 = 1e-2;
pub(crate) const AXES: [Vec3; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
pub(crate) const NONE: Vec3 = [0.0; 3];

/// Displacements of all nodes of a body that translates and rotates about `origin`.
pub(crate) fn rigid(nodes: &[Vec3], origin: Vec3, [velocity, spin]: [Vec3; 2]) -> DVector<f64> {
    DVector::from_fn(3 * nodes.len(), |row, _| {
        velocity[row % 3] + cross(spin, sub(nodes[row / 3], origin))[row % 3]
    })
}

/// Centre of mass of a body whose mass is axisymmetric about X.
pub(crate) fn centre_of_round(problem: &SolidProblem) -> Result<Vec3, SolidShaftError> {
    let motions = AXES.map(|axis| [[axis, NONE], [NONE, axis]]).into_iter().flatten();
    let motions: Vec<DVector<f64>> =
        motions.map(|motion| rigid(&problem.nodes, NONE, motion)).collect();
    let motions = DMatrix::from_columns(&motions);
    // Over translation and rotation along X, Y and Z.
    let inertia = motions.tr_mul(&momenta(problem, &motions));
    let mass = inertia[(0, 0)];
    // The momentum along Y of a rotation about X is −z, and cyclically.
    let centre = [inertia[(4, 3)], inertia[(0, 5)], inertia[(2, 1)]].map(|moment| -moment / mass);
    // ∫ρ(y² − z²), 2∫ρyz and ∫ρ(y² + z²) about the axis through the centre.
    let [_, y, z] = centre;
    let unlike = inertia[(5, 5)] - inertia[(3, 3)] - mass * (y * y - z * z);
    let oblique = -2.0 * inertia[(3, 5)] - 2.0 * mass * y * z;
    let about = inertia[(1, 1)] - mass * (y * y + z * z);
    let off = libm::hypot(y, z);
    if off > CENTRED * (about / mass).sqrt() {
        return Err(SolidShaftError::OffAxis { at: centre[0], off });
    }
    not_round("its inertia", 2.0 * libm::hypot(unlike, oblique) / about)?;
    Ok(centre)
}

/// Number of fields of a component processed for each pair of nodes.
const BESIDE: usize = 16;

/// Consistent masses times displacements.
pub(crate) fn momenta(problem: &SolidProblem, fields: &DMatrix<f64>) -> DMatrix<f64> {
    let SolidProblem { nodes, density, elements, .. } = problem;
    // Masses of each element, row by row.
    let mut shares: Vec<f64> = Vec::new();
    match elements {
        Elements::Linear(list) => {
            for element in list {
                let tet = Tet4::new(&corners(nodes, element));
                let tet = tet.expect("elements were checked when the model was made");
                let all = (0..16).map(|i| tet.consistent_mass(*density, i / 4, i % 4));
                shares.extend(all);
            }
        }
        Elements::Quadratic(list) => {
            for element in list {
                let own = tet10::consistent_mass(&corners(nodes, element), *density);
                shares.extend(own.iter().flatten());
            }
        }
    }
    let mut momenta = DMatrix::zeros(fields.nrows(), fields.ncols());
    for first in (0..fields.ncols()).step_by(BESIDE) {
        let count = BESIDE.min(fields.ncols() - first);
        let from = fields.columns(first, count).transpose();
        let mut to = DMatrix::<f64>::zeros(count, fields.nrows());
        let mut shares = shares.iter();
        for element in 0..elements.len() {
            for a in elements.nodes(element) {
                for (b, share) in elements.nodes(element).iter().zip(shares.by_ref()) {
                    for i in 0..3 {
                        let (at, of) = (3 * *a as usize + i, 3 * *b as usize + i);
                        to.column_mut(at).axpy(*share, &from.column(of), 1.0);
                    }
                }
            }
        }
        momenta.columns_mut(first, count).copy_from(&to.transpose());
    }
    momenta
}

/// Refuses a shaft whose two planes differ.
pub(crate) fn refuse_unlike(
    mass_y: &DMatrix<f64>,
    stiffness_y: &DMatrix<f64>,
    mass_z: &DMatrix<f64>,
    stiffness_z: &DMatrix<f64>,
) -> Result<(), SolidShaftError> {
    let first = |mass: &DMatrix<f64>, stiffness: &DMatrix<f64>| {
        let stiffest = (0..mass.nrows()).map(|i| stiffness[(i, i)] / mass[(i, i)]);
        let shift = 1e-4 * stiffest.fold(f64::INFINITY, f64::min);
        lowest(mass, stiffness, shift, 3).and_then(|(_, squares)| squares.get(2).copied())
    };
    let [y, z] = [first(mass_y, stiffness_y), first(mass_z, stiffness_z)]
        .map(|square| square.unwrap_or(f64::NAN));
    not_round("its stiffness", (y - z).abs() / (0.5 * (y + z)))
}

fn not_round(what: &'static str, part: f64) -> Result<(), SolidShaftError> {
    let is_round = part <= ROUND;
    if is_round { Ok(()) } else { Err(SolidShaftError::NotRound { what, part, most: ROUND }) }
}
