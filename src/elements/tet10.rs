//! Ten-node tetrahedron: quadratic displacements, no locking in bending.
//!
//! Node order as in VTK and Abaqus: four corners, then the middles of the edges 1–2, 2–3, 3–1, 1–4, 2–4, 3–4. Four
//! quadrature points for the stiffness, exact for straight edges under linear stress.

use super::ElementError;
use crate::kinematics::number::Number;
use crate::kinematics::strain::{
    Mat3, Sym3, determinant, first_piola_kirchhoff, full, green_lagrange, green_lagrange_change,
    times,
};
use crate::kinematics::vec3::{Vec3, add_scaled, cross, scale};

/// Corners of the edge of each mid-edge node, from node 5 on.
pub const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Quadrature points of the stiffness.
pub const POINTS: usize = 4;

/// Quadrature point in the undeformed state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<T = f64> {
    /// ∂N/∂X of the ten nodes, 1/m.
    pub gradients: [[T; 3]; 10],
    /// Integration weight, m³.
    pub volume: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tet10 {
    pub points: [Point; POINTS],
}

// (5 − √5)/20 and (5 + 3√5)/20.
const NEAR: f64 = 0.138_196_601_125_010_5;
const FAR: f64 = 0.585_410_196_624_968_5;

/// Weights that extrapolate linearly from the four quadrature points to barycentric coordinates `l`.
pub fn from_points(l: &[f64; 4]) -> [f64; POINTS] {
    l.map(|coordinate| (coordinate - NEAR) / (FAR - NEAR))
}

/// Barycentric coordinates of quadrature point `point` of the four-point rule of degree 2.
pub fn stiffness_rule(point: usize) -> [f64; 4] {
    let mut coordinates = [NEAR; 4];
    coordinates[point] = FAR;
    coordinates
}

/// Shape functions at barycentric coordinates.
pub fn shape_functions(l: &[f64; 4]) -> [f64; 10] {
    let mut n = [0.0; 10];
    for i in 0..4 {
        n[i] = l[i] * (2.0 * l[i] - 1.0);
    }
    for (i, [a, b]) in EDGES.into_iter().enumerate() {
        n[4 + i] = 4.0 * l[a] * l[b];
    }
    n
}

/// Derivatives of the shape functions by the second, third and fourth barycentric coordinate, with the first one
/// dependent.
fn shape_derivatives(l: &[f64; 4]) -> [Vec3; 10] {
    let mut by_coordinate = [[0.0; 4]; 10];
    for i in 0..4 {
        by_coordinate[i][i] = 4.0 * l[i] - 1.0;
    }
    for (i, [a, b]) in EDGES.into_iter().enumerate() {
        by_coordinate[4 + i][a] = 4.0 * l[b];
        by_coordinate[4 + i][b] = 4.0 * l[a];
    }
    by_coordinate.map(|d| [d[1] - d[0], d[2] - d[0], d[3] - d[0]])
}

/// Gradients of the shape functions and the Jacobian determinant at barycentric coordinates `l`.
fn gradients_at(nodes: &[Vec3; 10], l: &[f64; 4]) -> ([Vec3; 10], f64) {
    let derivatives = shape_derivatives(l);
    // Columns of the Jacobian: ∂X/∂ξ.
    let mut map = [[0.0; 3]; 3];
    for (node, derivative) in nodes.iter().zip(&derivatives) {
        for k in 0..3 {
            map[k] = add_scaled(map[k], derivative[k], *node);
        }
    }
    let det = determinant(&map);
    let per = 1.0 / det;
    // Rows of the inverse, transposed: ∂ξ/∂X.
    let inverse = [
        scale(cross(map[1], map[2]), per),
        scale(cross(map[2], map[0]), per),
        scale(cross(map[0], map[1]), per),
    ];
    let gradients = derivatives.map(|d| {
        let mut g = scale(inverse[0], d[0]);
        g = add_scaled(g, d[1], inverse[1]);
        add_scaled(g, d[2], inverse[2])
    });
    (gradients, det)
}

impl Tet10 {
    /// Element from its undeformed nodes, m; edges may be curved.
    ///
    /// # Errors
    /// If the Jacobian determinant is not positive at a quadrature point or a corner.
    pub fn new(nodes: &[Vec3; 10]) -> Result<Tet10, ElementError> {
        for corner in 0..4 {
            let mut l = [0.0; 4];
            l[corner] = 1.0;
            let determinant = gradients_at(nodes, &l).1;
            if !(determinant > 0.0 && determinant.is_finite()) {
                return Err(ElementError::Folded { point: POINTS + corner, determinant });
            }
        }
        let mut points = [Point { gradients: [[0.0; 3]; 10], volume: 0.0 }; POINTS];
        for (point, at) in points.iter_mut().enumerate() {
            let (gradients, determinant) = gradients_at(nodes, &stiffness_rule(point));
            if !(determinant > 0.0 && determinant.is_finite()) {
                return Err(ElementError::Folded { point, determinant });
            }
            *at = Point { gradients, volume: determinant / 24.0 };
        }
        Ok(Tet10 { points })
    }

    /// Displacement gradient at a quadrature point.
    #[inline(always)]
    pub fn displacement_gradient(&self, point: usize, displacement: &[Vec3; 10]) -> Mat3 {
        self.points[point].displacement_gradient(displacement)
    }

    /// Forces on the nodes, −∫P ∂N/∂X dV, N.
    #[inline(always)]
    pub fn nodal_forces(
        &self,
        displacement: &[Vec3; 10],
        stress: impl Fn(&Sym3) -> Sym3,
    ) -> [Vec3; 10] {
        let mut forces = [[0.0; 3]; 10];
        for point in &self.points {
            point.add_forces(displacement, &stress, &mut forces);
        }
        forces
    }

    /// Linearised change of the nodal forces for a change of the displacements; see
    /// [`super::tet4::Tet4::force_change`].
    #[inline(always)]
    pub fn force_change(
        &self,
        displacement: &[Vec3; 10],
        change: &[Vec3; 10],
        stress: impl Fn(&Sym3) -> Sym3,
    ) -> [Vec3; 10] {
        let mut forces = [[0.0; 3]; 10];
        for point in &self.points {
            let h = point.displacement_gradient(displacement);
            let dh = point.displacement_gradient(change);
            let s = full(&stress(&green_lagrange(&h)));
            let mut dp = first_piola_kirchhoff(&h, &stress(&green_lagrange_change(&h, &dh)));
            for i in 0..3 {
                for j in 0..3 {
                    dp[i][j] += dh[i][0] * s[0][j] + dh[i][1] * s[1][j] + dh[i][2] * s[2][j];
                }
            }
            point.add_forces_of(&dp, &mut forces);
        }
        forces
    }

    /// m³.
    pub fn volume(&self) -> f64 {
        self.points.iter().map(|point| point.volume).sum()
    }
}

/// For one element, or one element per SIMD lane.
impl<T: Number> Point<T> {
    #[inline(always)]
    pub fn displacement_gradient(&self, displacement: &[[T; 3]; 10]) -> Mat3<T> {
        let mut h = [[T::of(0.0); 3]; 3];
        for n in 0..10 {
            for i in 0..3 {
                for j in 0..3 {
                    h[i][j] = h[i][j] + displacement[n][i] * self.gradients[n][j];
                }
            }
        }
        h
    }

    /// Adds this point's contribution to the nodal forces.
    #[inline(always)]
    pub fn add_forces(
        &self,
        displacement: &[[T; 3]; 10],
        stress: &impl Fn(&Sym3<T>) -> Sym3<T>,
        forces: &mut [[T; 3]; 10],
    ) {
        let h = self.displacement_gradient(displacement);
        self.add_forces_of(&first_piola_kirchhoff(&h, &stress(&green_lagrange(&h))), forces);
    }

    #[inline(always)]
    fn add_forces_of(&self, p: &Mat3<T>, forces: &mut [[T; 3]; 10]) {
        let mut scaled = *p;
        for i in 0..3 {
            for j in 0..3 {
                scaled[i][j] = scaled[i][j] * -self.volume;
            }
        }
        for n in 0..10 {
            let force = times(&scaled, self.gradients[n]);
            for i in 0..3 {
                forces[n][i] = forces[n][i] + force[i];
            }
        }
    }
}

/// Consistent masses between the nodes, kg: ρ∫NᵢNⱼ dV by a rule of degree 5, exact for straight
/// edges (the products are of degree 4).
pub fn consistent_mass(nodes: &[Vec3; 10], density: f64) -> [[f64; 10]; 10] {
    let mut mass = [[0.0; 10]; 10];
    for (l, weight) in mass_rule() {
        let n = shape_functions(&l);
        let share = density * weight * gradients_at(nodes, &l).1 / 6.0;
        for i in 0..10 {
            for j in 0..10 {
                mass[i][j] += share * n[i] * n[j];
            }
        }
    }
    mass
}

/// Lumped masses, kg: the diagonal of the consistent matrix, scaled to the mass of the element (Hinton, Rock and
/// Zienkiewicz). All are positive, unlike row sums, which are negative at corners. For straight edges a corner has 1/36
/// and a mid-edge node 4/27 of the element's mass.
pub fn lumped_mass(nodes: &[Vec3; 10], density: f64) -> [f64; 10] {
    let consistent = consistent_mass(nodes, density);
    let total: f64 = consistent.iter().flatten().sum();
    let trace: f64 = (0..10).map(|i| consistent[i][i]).sum();
    std::array::from_fn(|i| consistent[i][i] * total / trace)
}

/// Keast's fifteen points of degree 5 (Keast 1986, rule 6), barycentric; weights sum to 1.
pub fn mass_rule() -> [([f64; 4], f64); 15] {
    let root = 15f64.sqrt();
    let mut rule = [([0.25; 4], 16.0 / 135.0); 15];
    let mut at = 1;
    for sign in [1.0, -1.0] {
        let near = (7.0 - sign * root) / 34.0;
        let far = (13.0 + 3.0 * sign * root) / 34.0;
        let weight = (2665.0 + sign * 14.0 * root) / 37800.0;
        for i in 0..4 {
            let mut l = [near; 4];
            l[i] = far;
            rule[at] = (l, weight);
            at += 1;
        }
    }
    let (a, b) = ((10.0 - 2.0 * root) / 40.0, (10.0 + 2.0 * root) / 40.0);
    for [i, j] in EDGES {
        let mut l = [a; 4];
        l[i] = b;
        l[j] = b;
        rule[at] = (l, 10.0 / 189.0);
        at += 1;
    }
    rule
}
