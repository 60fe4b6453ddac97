//! Cross-section of a finite-element rotor (4.2.3): mean displacement and rotation of its nodes, and the consistent
//! distribution of forces and moments to them; for small displacements and for a spinning rotor.

use crate::kinematics::strain::{Mat3, times};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

/// Ratio of the nodes' spread about two axes below which they are on one line.
const ON_A_LINE: f64 = 1e-9;

/// Nodes in one plane across the rotor, with their area weights.
#[derive(Clone, Debug, PartialEq)]
pub struct RotorSection {
    /// Centroid of the undeformed section, m.
    pub centre: Vec3,
    /// m².
    pub area: f64,
    /// Node number, area weight (sum 1), undeformed position from the centre, m.
    nodes: Vec<(u32, f64, Vec3)>,
    /// Inverse of Σ weight (r² − r rᵀ), 1/m².
    spread: Mat3,
}

impl RotorSection {
    /// Section from nodes, their positions (m) and areas (m²); `None` if the nodes are on one line.
    pub fn new(nodes: &[(u32, Vec3, f64)]) -> Option<RotorSection> {
        let area: f64 = nodes.iter().map(|(_, _, area)| area).sum();
        let mut centre = [0.0; 3];
        for (_, place, of) in nodes {
            centre = add_scaled(centre, of / area, *place);
        }
        let nodes: Vec<(u32, f64, Vec3)> =
            nodes.iter().map(|(node, at, of)| (*node, of / area, sub(*at, centre))).collect();
        let mut sum = [[0.0; 3]; 3];
        for (_, weight, arm) in &nodes {
            for (i, row) in sum.iter_mut().enumerate() {
                for (j, value) in row.iter_mut().enumerate() {
                    let round = if i == j { dot(*arm, *arm) } else { 0.0 };
                    *value += weight * (round - arm[i] * arm[j]);
                }
            }
        }
        let sum = nalgebra::Matrix3::from_fn(|i, j| sum[i][j]);
        // Nodes on one line have no rotation about it.
        let about = sum.symmetric_eigenvalues();
        let spread = sum.try_inverse()?;
        let is_sound = area > 0.0 && about.min() > ON_A_LINE * about.max();
        let spread = [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| spread[(i, j)]));
        is_sound.then_some(RotorSection { centre, area, nodes, spread })
    }

    /// Mean displacement (m) and rotation (rad): the small rotation that best fits the displacements of the nodes, by
    /// least squares weighted by area.
    pub fn motion(&self, displacement: impl Fn(u32) -> Vec3) -> [Vec3; 2] {
        let (mut mean, mut swept) = ([0.0; 3], [0.0; 3]);
        for (node, weight, arm) in &self.nodes {
            let of = displacement(*node);
            mean = add_scaled(mean, *weight, of);
            swept = add_scaled(swept, *weight, cross(*arm, of));
        }
        [mean, times(&self.spread, swept)]
    }

    /// Forces on the nodes (N) that do the same work as a force (N) and a moment (N·m) on [`RotorSection::motion`].
    pub fn forces(&self, force: Vec3, moment: Vec3) -> impl Iterator<Item = (u32, Vec3)> + '_ {
        let couple = times(&self.spread, moment);
        self.nodes.iter().map(move |(node, weight, arm)| {
            (*node, scale(add(force, cross(couple, *arm)), *weight))
        })
    }
}

/// Position and velocity of a rotor section after any displacement and rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionPlace {
    /// Centroid, m.
    pub centre: Vec3,
    /// Rotation from the undeformed section to this one: the best fit by least squares weighted by area.
    pub orientation: UnitQuaternion<f64>,
    /// m/s.
    pub velocity: Vec3,
    /// Angular velocity, rad/s, inertial axes.
    pub spin: Vec3,
    /// Maps a moment on the section to a vector c, 1/m²; c × arm, times the weight, is the nodal force.
    couple: Mat3,
}

impl RotorSection {
    /// Position and velocity of the section from displacements (m) and velocities (m/s) of its nodes.
    ///
    /// The rotation R satisfies Σ weight (R x) × y = 0 with the undeformed and current arms x and y of a node. Its
    /// angular velocity follows from the same sum: S ω = Σ weight (R x) × ẏ with S = tr A − A, A = Σ weight y (R x)ᵀ,
    /// which is symmetric for this R.
    pub fn place(
        &self,
        displacement: impl Fn(u32) -> Vec3,
        rate: impl Fn(u32) -> Vec3,
    ) -> SectionPlace {
        let (mut mean, mut velocity) = ([0.0; 3], [0.0; 3]);
        for (node, weight, _) in &self.nodes {
            mean = add_scaled(mean, *weight, displacement(*node));
            velocity = add_scaled(velocity, *weight, rate(*node));
        }
        // Σ weight y xᵀ and, for the undeformed section, Σ weight x xᵀ.
        let (mut moved, mut plane) = (Matrix3::zeros(), Matrix3::zeros());
        for (node, weight, arm) in &self.nodes {
            let x = Vector3::from(*arm);
            let y = Vector3::from(add(*arm, sub(displacement(*node), mean)));
            moved += y * x.transpose() * *weight;
            plane += x * x.transpose() * *weight;
        }
        let orientation = rotation_of(&moved, &plane);
        let turn = orientation.to_rotation_matrix();
        let along = moved * turn.transpose();
        let couple = rotation_derivative(&along).try_inverse().unwrap_or_else(Matrix3::zeros);
        let mut swept = Vector3::zeros();
        for (node, weight, arm) in &self.nodes {
            let arm = turn * Vector3::from(*arm);
            swept += arm.cross(&Vector3::from(rate(*node))) * *weight;
        }
        let spin: Vec3 = (couple * swept).into();
        SectionPlace {
            centre: add(self.centre, mean),
            orientation,
            velocity,
            spin,
            couple: [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| couple[(i, j)])),
        }
    }

    /// Forces on the nodes (N) with the same resultant and power as a force (N) and a moment (N·m) on the section at
    /// `place`.
    pub fn forces_at(
        &self,
        place: &SectionPlace,
        force: Vec3,
        moment: Vec3,
    ) -> impl Iterator<Item = (u32, Vec3)> + '_ {
        let turn = place.orientation.to_rotation_matrix();
        let couple = times(&place.couple, moment);
        self.nodes.iter().map(move |(node, weight, arm)| {
            let arm: Vec3 = (turn * Vector3::from(*arm)).into();
            (*node, scale(add(force, cross(couple, arm)), *weight))
        })
    }
}

/// tr A − A with A made symmetric: derivative of the sum of cross products by the rotation.
fn rotation_derivative(along: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * along.trace() - (along + along.transpose()) * 0.5
}

/// Best-fit rotation from x to y, from Σ weight y xᵀ and Σ weight x xᵀ, for nodes in a plane across X.
///
/// For a rigidly rotated section the two columns across the axis already give it; a strained section needs Newton
/// steps, which converge quadratically.
fn rotation_of(moved: &Matrix3<f64>, plane: &Matrix3<f64>) -> UnitQuaternion<f64> {
    const STEPS: usize = 3;
    let [yy, yz, zz] = [plane[(1, 1)], plane[(1, 2)], plane[(2, 2)]];
    let per = 1.0 / (yy * zz - yz * yz);
    let (by_y, by_z) = (moved.column(1), moved.column(2));
    let across = (by_y * zz - by_z * yz) * per;
    let up = (by_z * yy - by_y * yz) * per;
    let axis = across.cross(&up).normalize();
    let across = (across - axis * axis.dot(&across)).normalize();
    let columns = Matrix3::from_columns(&[axis, across, axis.cross(&across)]);
    let mut turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(columns));
    for _ in 0..STEPS {
        let along = moved * turn.to_rotation_matrix().transpose();
        let residual = Vector3::new(
            along[(2, 1)] - along[(1, 2)],
            along[(0, 2)] - along[(2, 0)],
            along[(1, 0)] - along[(0, 1)],
        );
        let Some(inverse) = rotation_derivative(&along).try_inverse() else { break };
        let by = inverse * residual * 0.5;
        turn = UnitQuaternion::new_normalize(Quaternion::new(1.0, by.x, by.y, by.z)) * turn;
    }
    turn
}
