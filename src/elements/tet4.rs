//! Four-node tetrahedron of the dissertation: constant strain and stress per element.

use super::ElementError;
use crate::kinematics::number::Number;
use crate::kinematics::strain::{
    Mat3, Sym3, cauchy, deformation_gradient, first_piola_kirchhoff, full, green_lagrange,
    green_lagrange_change, times,
};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};

/// Corner nodes of the faces, each anticlockwise seen from outside; face i is opposite node i.
pub const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Undeformed geometry of an element.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tet4<T = f64> {
    /// ∂N/∂X of the first three nodes, 1/m; the fourth is minus their sum.
    pub gradients: [[T; 3]; 3],
    /// m³.
    pub volume: T,
}

impl Tet4 {
    /// Gradients and volume from the undeformed corners, m. The volume is positive if (X₂−X₁)·[(X₃−X₁)×(X₄−X₁)] is, the
    /// node order of Gmsh, Abaqus and VTK.
    ///
    /// # Errors
    /// If the volume is not positive.
    pub fn new(corners: &[Vec3; 4]) -> Result<Tet4, ElementError> {
        let [a, b, c] = [1, 2, 3].map(|i: usize| sub(corners[i], corners[0]));
        let six_volumes = dot(a, cross(b, c));
        let volume = six_volumes / 6.0;
        if !(volume > 0.0 && volume.is_finite()) {
            return Err(ElementError::Volume { volume });
        }
        let per = 1.0 / six_volumes;
        let of_a = scale(cross(b, c), per);
        let of_b = scale(cross(c, a), per);
        let of_c = scale(cross(a, b), per);
        let of_first = scale(add(of_a, add(of_b, of_c)), -1.0);
        Ok(Tet4 { gradients: [of_first, of_a, of_b], volume })
    }
}

/// For one element, or one element per SIMD lane.
impl<T: Number> Tet4<T> {
    /// Displacement gradient H = Σ u ⊗ ∂N/∂X, the sum of (4.2), from displacements of the first three nodes relative to
    /// the fourth.
    #[inline(always)]
    pub fn displacement_gradient(&self, relative: &[[T; 3]; 3]) -> Mat3<T> {
        let [a, b, c] = &self.gradients;
        let [u, v, w] = relative;
        let row = |i: usize| {
            [
                u[i] * a[0] + v[i] * b[0] + w[i] * c[0],
                u[i] * a[1] + v[i] * b[1] + w[i] * c[1],
                u[i] * a[2] + v[i] * b[2] + w[i] * c[2],
            ]
        };
        [row(0), row(1), row(2)]
    }

    /// Forces on the first three nodes, −V P ∂N/∂X with P = F S, N; the fourth takes minus their sum. Equal to the
    /// face-by-face distribution of (4.6) and (4.7) (errata: sign).
    #[inline(always)]
    pub fn nodal_forces(
        &self,
        relative: &[[T; 3]; 3],
        stress: impl Fn(&Sym3<T>) -> Sym3<T>,
    ) -> [[T; 3]; 3] {
        let h = self.displacement_gradient(relative);
        let mut s = stress(&green_lagrange(&h));
        // Six products here save nine at the gradients.
        for component in &mut s {
            *component = *component * -self.volume;
        }
        self.along_gradients(&first_piola_kirchhoff(&h, &s))
    }

    #[inline(always)]
    pub(super) fn along_gradients(&self, p: &Mat3<T>) -> [[T; 3]; 3] {
        let g = &self.gradients;
        [times(p, g[0]), times(p, g[1]), times(p, g[2])]
    }
}

impl Tet4 {
    /// Linearised change of the nodal forces: tangent stiffness applied to `change`, with the sign of forces. The
    /// stress must be linear in the strain.
    #[inline(always)]
    pub fn force_change(
        &self,
        relative: &[Vec3; 3],
        change: &[Vec3; 3],
        stress: impl Fn(&Sym3) -> Sym3,
    ) -> [Vec3; 3] {
        let h = self.displacement_gradient(relative);
        let dh = self.displacement_gradient(change);
        let s = stress(&green_lagrange(&h));
        let ds = stress(&green_lagrange_change(&h, &dh));
        let mut dp = first_piola_kirchhoff(&h, &ds);
        let s = full(&s);
        for i in 0..3 {
            for j in 0..3 {
                dp[i][j] += dh[i][0] * s[0][j] + dh[i][1] * s[1][j] + dh[i][2] * s[2][j];
                dp[i][j] *= -self.volume;
            }
        }
        self.along_gradients(&dp)
    }

    /// Nodal forces by (2.6): Cauchy stress times the area vectors of the deformed faces, shared by the nodes of each
    /// face. The sign is that of a force on the node (errata).
    pub fn face_forces_deformed(
        &self,
        corners: &[Vec3; 4],
        displacement: &[Vec3; 4],
        stress: impl Fn(&Sym3) -> Sym3,
    ) -> [Vec3; 4] {
        let h = self.displacement_gradient(&relative(displacement));
        let t = full(&cauchy(&h, &stress(&green_lagrange(&h))));
        let place = [0, 1, 2, 3].map(|n: usize| add(corners[n], displacement[n]));
        share_faces(&place, |area| times(&t, area))
    }

    /// Nodal forces by (4.6) and (4.7): second Piola–Kirchhoff stress times the area vectors of the undeformed faces,
    /// pushed forward by F.
    pub fn face_forces_undeformed(
        &self,
        corners: &[Vec3; 4],
        displacement: &[Vec3; 4],
        stress: impl Fn(&Sym3) -> Sym3,
    ) -> [Vec3; 4] {
        let h = self.displacement_gradient(&relative(displacement));
        let s = full(&stress(&green_lagrange(&h)));
        let f = deformation_gradient(&h);
        share_faces(corners, |area| times(&f, times(&s, area)))
    }

    /// Lumped mass of one node, kg: a quarter of the element.
    pub fn nodal_mass(&self, density: f64) -> f64 {
        0.25 * density * self.volume
    }

    /// Consistent mass between two nodes, kg: ρV/10 on the diagonal, ρV/20 off the diagonal.
    pub fn consistent_mass(&self, density: f64, a: usize, b: usize) -> f64 {
        density * self.volume * if a == b { 0.1 } else { 0.05 }
    }
}

/// Displacements of the first three nodes relative to the fourth.
#[inline(always)]
pub fn relative(displacement: &[Vec3; 4]) -> [Vec3; 3] {
    let [a, b, c, d] = *displacement;
    [sub(a, d), sub(b, d), sub(c, d)]
}

/// Distributes minus a third of each face's force to each of its nodes.
fn share_faces(corners: &[Vec3; 4], traction: impl Fn(Vec3) -> Vec3) -> [Vec3; 4] {
    let mut forces = [[0.0; 3]; 4];
    for face in FACES {
        let [a, b, c] = face.map(|n| corners[n]);
        let area = scale(cross(sub(b, a), sub(c, a)), 0.5);
        let force = traction(area);
        for node in face {
            forces[node] = add_scaled(forces[node], -1.0 / 3.0, force);
        }
    }
    forces
}
