//! Ten-node tetrahedron with a continuous mean stress, for nearly incompressible solids.
//!
//! The deviatoric strain is evaluated at each quadrature point. The volume ratio is averaged around each corner node
//! over all adjacent elements, weighted by the corner's linear shape function; the resulting mean stress is linear
//! within an element and continuous across faces. This is the Taylor–Hood mixed element with a lumped pressure mass
//! matrix: pressure is not an unknown and the stiffness remains positive definite. A pointwise volume ratio locks. A
//! volume ratio per element (mean dilatation) does not lock, but its mean stress is discontinuous, which costs one
//! order of convergence.
//!
//! The energy is Σ V W(E) over points plus Σ V U(J̄) over corner nodes; forces and stiffness are its derivatives.

use super::tet10::{POINTS, Tet10, stiffness_rule};
use crate::kinematics::strain::{
    Mat3, Sym3, Tangent, cofactor, deformation_gradient, double_dot, first_piola_kirchhoff, full,
    green_lagrange, times, volume_change,
};
use crate::kinematics::vec3::{Vec3, add_scaled, cross, dot, scale};

/// Displacement components: three for each of ten nodes.
pub const COMPONENTS: usize = 30;

/// Lower triangle and diagonal of a stiffness matrix; rows and columns are 3 · node + axis.
pub type Stiffness = [[f64; COMPONENTS]; COMPONENTS];

/// Strain and J − 1 at every quadrature point; the volume ratio of an inverted one as error.
pub fn strains(
    tet: &Tet10,
    displacement: &[Vec3; 10],
) -> ([Sym3; POINTS], [f64; POINTS], Option<f64>) {
    let mut strains = [[0.0; 6]; POINTS];
    let mut changes = [0.0; POINTS];
    let mut inverted = None;
    for (p, point) in tet.points.iter().enumerate() {
        let h = point.displacement_gradient(displacement);
        strains[p] = green_lagrange(&h);
        changes[p] = volume_change(&h);
        let sound = 1.0 + changes[p] > 0.0;
        if !sound {
            inverted = Some(1.0 + changes[p]);
        }
    }
    (strains, changes, inverted)
}

/// Integrals over the element of values at its quadrature points times each corner's shape function. For values of 1
/// they are the corners' tributary volumes, m³.
pub fn at_corners(tet: &Tet10, values: &[f64; POINTS]) -> [f64; 4] {
    let mut sums = [0.0; 4];
    for (p, point) in tet.points.iter().enumerate() {
        let shares = stiffness_rule(p);
        for (sum, share) in sums.iter_mut().zip(shares) {
            *sum += point.volume * share * values[p];
        }
    }
    sums
}

/// Values at the quadrature points of the linear field through corner values.
pub fn at_points(corners: &[f64; 4]) -> [f64; POINTS] {
    std::array::from_fn(|p| {
        stiffness_rule(p).iter().zip(corners).map(|(share, value)| share * value).sum()
    })
}

/// Nodal forces, N, from the second Piola–Kirchhoff stress without its volumetric part and the mean stress at each
/// point, Pa.
pub fn nodal_forces(
    tet: &Tet10,
    displacement: &[Vec3; 10],
    stresses: &[Sym3; POINTS],
    mean_stresses: &[f64; POINTS],
) -> [Vec3; 10] {
    let mut forces = [[0.0; 3]; 10];
    for ((point, stress), mean_stress) in tet.points.iter().zip(stresses).zip(mean_stresses) {
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

/// Material response at one point, Pa.
#[derive(Clone, Copy, Debug)]
pub struct Response {
    /// Second Piola–Kirchhoff stress without its volumetric part, and its derivative by the strain.
    pub stress: Sym3,
    pub tangent: Tangent,
}

/// Derivative of ∫ J times one corner's shape function by the displacements, m².
pub fn volume_slopes(tet: &Tet10, displacement: &[Vec3; 10], corner: usize) -> [Vec3; 10] {
    let mut slopes = [[0.0; 3]; 10];
    for (p, point) in tet.points.iter().enumerate() {
        let f = deformation_gradient(&point.displacement_gradient(displacement));
        let cofactors = cofactor(&f);
        let share = point.volume * stiffness_rule(p)[corner];
        for (slope, gradient) in slopes.iter_mut().zip(&point.gradients) {
            *slope = add_scaled(*slope, share, times(&cofactors, *gradient));
        }
    }
    slopes
}

/// Stiffness at fixed mean stresses (Pa), minus the derivative of the nodal forces by the displacements, N/m. The
/// missing contribution of the mean stresses is U″(J̄)/V times the product of [`volume_slopes`] summed over the
/// elements around a corner.
pub fn stiffness(
    tet: &Tet10,
    displacement: &[Vec3; 10],
    responses: &[Response; POINTS],
    mean_stresses: &[f64; POINTS],
) -> Stiffness {
    let mut k = [[0.0; COMPONENTS]; COMPONENTS];
    for ((point, response), mean_stress) in tet.points.iter().zip(responses).zip(mean_stresses) {
        let f = deformation_gradient(&point.displacement_gradient(displacement));
        let stress = full(&response.stress);
        let strain_rows = point.gradients.map(|gradient| strains_by_node(&f, gradient));
        for b in 0..10 {
            let gradient = point.gradients[b];
            let traction = scale(times(&stress, gradient), point.volume);
            // Stress change by the three components of node b, including volume, with shear counted twice.
            let mut by_node = [[0.0; 6]; 3];
            for j in 0..3 {
                for c in 0..6 {
                    let twice = if c < 3 { 1.0 } else { 2.0 };
                    by_node[j][c] =
                        twice * point.volume * double_dot(&response.tangent[c], &strain_rows[b][j]);
                }
            }
            for a in b..10 {
                let geometric = dot(point.gradients[a], traction);
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
