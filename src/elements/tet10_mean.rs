//! The ten-node tetrahedron with one change of volume for the whole element: mean dilatation
//! (Nagtegaal, Parks and Rice 1974), for solids that hardly change their volume.
//!
//! Shear and stretch are taken at each quadrature point, volume by its mean J̄. An element has one
//! constraint of volume then, where a pointwise J would have four, more than its share of unknowns: that
//! locks. The energy is Σ V W(E) + V U(J̄), whose derivatives forces and stiffness are.

use super::tet10::{POINTS, Tet10};
use crate::kinematics::strain::{
    Mat3, Sym3, Tangent, cofactor, deformation_gradient, double_dot, first_piola_kirchhoff, full,
    green_lagrange, times, volume_change,
};
use crate::kinematics::vec3::{Vec3, add_scaled, cross, dot, scale};

/// Components of displacement: three for each of ten nodes.
pub const COMPONENTS: usize = 30;

/// Lower triangle and diagonal are filled; rows and columns are 3 · node + axis.
pub type Stiffness = [[f64; COMPONENTS]; COMPONENTS];

/// Strain at every quadrature point, and J̄ − 1. `None` where a point is turned inside out: then its
/// volume ratio.
pub fn strains(tet: &Tet10, displacement: &[Vec3; 10]) -> ([Sym3; POINTS], f64, Option<f64>) {
    let mut strains = [[0.0; 6]; POINTS];
    let (mut sum, mut volume, mut inverted) = (0.0, 0.0, None);
    for (strain, point) in strains.iter_mut().zip(&tet.points) {
        let h = point.displacement_gradient(displacement);
        *strain = green_lagrange(&h);
        let change = volume_change(&h);
        sum += point.volume * change;
        volume += point.volume;
        let sound = 1.0 + change > 0.0;
        if !sound {
            inverted = Some(1.0 + change);
        }
    }
    (strains, sum / volume, inverted)
}

/// Forces on the nodes, N, from the second Piola–Kirchhoff stress without the part of volume at each
/// point and the mean stress U′(J̄), Pa.
pub fn nodal_forces(
    tet: &Tet10,
    displacement: &[Vec3; 10],
    stresses: &[Sym3; POINTS],
    mean_stress: f64,
) -> [Vec3; 10] {
    let mut forces = [[0.0; 3]; 10];
    for (point, stress) in tet.points.iter().zip(stresses) {
        let h = point.displacement_gradient(displacement);
        let mut p = first_piola_kirchhoff(&h, stress);
        let volume = cofactor(&deformation_gradient(&h));
        for i in 0..3 {
            for j in 0..3 {
                p[i][j] = -point.volume * (p[i][j] + mean_stress * volume[i][j]);
            }
        }
        for (force, gradient) in forces.iter_mut().zip(&point.gradients) {
            *force = add_scaled(*force, 1.0, times(&p, *gradient));
        }
    }
    forces
}

/// What the stiffness needs of the material at one point, Pa.
#[derive(Clone, Copy, Debug)]
pub struct Response {
    /// Second Piola–Kirchhoff stress without the part of volume, and its derivative by the strain.
    pub stress: Sym3,
    pub tangent: Tangent,
}

/// Derivative of minus the nodal forces by the displacements, N/m; `mean_stress` is U′(J̄) and `bulk`
/// U″(J̄), Pa.
pub fn stiffness(
    tet: &Tet10,
    displacement: &[Vec3; 10],
    responses: &[Response; POINTS],
    mean_stress: f64,
    bulk: f64,
) -> Stiffness {
    let mut k = [[0.0; COMPONENTS]; COMPONENTS];
    // Derivative of V J̄ by the displacements.
    let mut of_volume = [[0.0; 3]; 10];
    let mut volume = 0.0;
    for (point, response) in tet.points.iter().zip(responses) {
        let f = deformation_gradient(&point.displacement_gradient(displacement));
        let cofactors = cofactor(&f);
        let stress = full(&response.stress);
        volume += point.volume;
        for (of, gradient) in of_volume.iter_mut().zip(&point.gradients) {
            *of = add_scaled(*of, point.volume, times(&cofactors, *gradient));
        }
        let strain_rows = point.gradients.map(|gradient| strains_by_node(&f, gradient));
        for b in 0..10 {
            let gradient = point.gradients[b];
            let pulled = scale(times(&stress, gradient), point.volume);
            // Stress by the three components of node b, with the volume, and shear counted twice.
            let mut by_node = [[0.0; 6]; 3];
            for j in 0..3 {
                for c in 0..6 {
                    let twice = if c < 3 { 1.0 } else { 2.0 };
                    by_node[j][c] =
                        twice * point.volume * double_dot(&response.tangent[c], &strain_rows[b][j]);
                }
            }
            for a in b..10 {
                let geometric = dot(point.gradients[a], pulled);
                // Second derivative of J: ε along F(∇Nₐ × ∇N_b).
                let turned = scale(
                    times(&f, cross(point.gradients[a], gradient)),
                    mean_stress * point.volume,
                );
                let rows = &mut k[3 * a..3 * a + 3];
                for i in 0..3 {
                    for j in 0..3 {
                        rows[i][3 * b + j] += plain_dot(&strain_rows[a][i], &by_node[j]);
                    }
                    rows[i][3 * b + i] += geometric;
                }
                rows[0][3 * b + 1] += turned[2];
                rows[1][3 * b] -= turned[2];
                rows[1][3 * b + 2] += turned[0];
                rows[2][3 * b + 1] -= turned[0];
                rows[2][3 * b] += turned[1];
                rows[0][3 * b + 2] -= turned[1];
            }
        }
    }
    let flat = of_volume.as_flattened();
    for row in 0..COMPONENTS {
        let factor = bulk / volume * flat[row];
        for column in 0..=row {
            k[row][column] += factor * flat[column];
        }
    }
    k
}

/// Change of the strain by the three components of a node's displacement: sym(Fᵀ (eᵢ ⊗ ∇N)).
#[inline(always)]
fn strains_by_node(f: &Mat3, g: Vec3) -> [Sym3; 3] {
    f.map(|f| {
        [
            f[0] * g[0],
            f[1] * g[1],
            f[2] * g[2],
            0.5 * (f[0] * g[1] + f[1] * g[0]),
            0.5 * (f[1] * g[2] + f[2] * g[1]),
            0.5 * (f[2] * g[0] + f[0] * g[2]),
        ]
    })
}

#[inline(always)]
fn plain_dot(a: &Sym3, b: &Sym3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5]
}
