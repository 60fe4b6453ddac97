//! Volumes of elements, areas of faces, and distribution of areas to nodes.

use crate::mesh::node_order::EDGES;
use crate::mesh::tet_mesh::{Elements, Face, Order, TetMesh};
use nalgebra::{Matrix3, Vector3};

/// Signed volume of a tetrahedron with straight edges, m³.
pub fn straight_volume([a, b, c, d]: [Vector3<f64>; 4]) -> f64 {
    (b - a).cross(&(c - a)).dot(&(d - a)) / 6.0
}

/// Volume of element `index`, m³; negative if it is inverted.
///
/// Exact for curved elements too: the Jacobian is cubic, and the five-point rule has degree three.
pub fn volume(mesh: &TetMesh, index: usize) -> f64 {
    match &mesh.elements {
        Elements::Linear(_) => straight_volume(mesh.corner_points(index)),
        Elements::Quadratic(list) => {
            let points = list[index].map(|node| mesh.point(node));
            let outer = |corner: usize| {
                let mut at = [1.0 / 6.0; 4];
                at[corner] = 0.5;
                jacobian(&points, at)
            };
            let corners: f64 = (0..4).map(outer).sum();
            (9.0 / 20.0 * corners - 4.0 / 5.0 * jacobian(&points, [0.25; 4])) / 6.0
        }
    }
}

/// Total volume, m³.
pub fn total_volume(mesh: &TetMesh) -> f64 {
    (0..mesh.elements.len()).map(|index| volume(mesh, index)).sum()
}

/// Jacobian determinant of the map from the unit tetrahedron to a ten-node element at the
/// barycentric coordinates `at`; six times the volume if edges are straight.
pub fn jacobian(points: &[Vector3<f64>; 10], at: [f64; 4]) -> f64 {
    // Derivatives with respect to the four barycentric coordinates; the fourth depends on the other three.
    let mut by = [Vector3::zeros(); 4];
    for corner in 0..4 {
        by[corner] += points[corner] * (4.0 * at[corner] - 1.0);
    }
    for (middle, [a, b]) in EDGES.into_iter().enumerate() {
        by[a] += points[4 + middle] * (4.0 * at[b]);
        by[b] += points[4 + middle] * (4.0 * at[a]);
    }
    Matrix3::from_columns(&[by[1] - by[0], by[2] - by[0], by[3] - by[0]]).determinant()
}

/// Smallest Jacobian of a ten-node element at corners, mid-sides and centre.
pub fn least_jacobian(points: &[Vector3<f64>; 10]) -> f64 {
    let corner = |i: usize| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 });
    let middle =
        |[a, b]: [usize; 2]| std::array::from_fn(|j| if j == a || j == b { 0.5 } else { 0.0 });
    let places = (0..4).map(corner).chain(EDGES.into_iter().map(middle)).chain([[0.25; 4]]);
    places.map(|at| jacobian(points, at)).fold(f64::INFINITY, f64::min)
}

/// Twice the area times the outward normal of a face with straight edges, m².
pub fn face_normal(mesh: &TetMesh, face: Face) -> Vector3<f64> {
    let [a, b, c] = mesh.face_corners(face).map(|node| mesh.point(node));
    (b - a).cross(&(c - a))
}

/// Distribution of a face's area to its nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    /// ∫ Nᵢ dA: the nodal forces of a unit pressure. Zero at the corners of a flat six-node face.
    Consistent,
    /// In proportion to ∫ Nᵢ² dA, the sum kept: positive at every node.
    Positive,
    /// To three nodes only: the corners of a three-node face, by ∫ Nᵢ dA, or the middles of a six-node one. The
    /// shares of a curved face's corners go to its middles such that the integral of every linear function over
    /// the face (in its own coordinates) is preserved. The middle between corners i and j then
    /// has ∫ (λᵢ + λⱼ − λₖ) dA: a third of a flat face.
    ThreeNodes,
}

/// Seven-point rule on a triangle (Radon 1948), exact to degree five: barycentric coordinates and weights.
fn triangle_rule() -> [([f64; 3], f64); 7] {
    let root = 15f64.sqrt();
    let (a, b) = ((6.0 + root) / 21.0, (6.0 - root) / 21.0);
    let (wa, wb) = ((155.0 + root) / 1200.0, (155.0 - root) / 1200.0);
    let third = 1.0 / 3.0;
    [
        ([third; 3], 9.0 / 40.0),
        ([1.0 - 2.0 * a, a, a], wa),
        ([a, 1.0 - 2.0 * a, a], wa),
        ([a, a, 1.0 - 2.0 * a], wa),
        ([1.0 - 2.0 * b, b, b], wb),
        ([b, 1.0 - 2.0 * b, b], wb),
        ([b, b, 1.0 - 2.0 * b], wb),
    ]
}

/// Shape functions and outward vector area (times the weight) at the points of [`triangle_rule`] on a
/// six-node face (corners a, b, c, middles ab, bc, ca).
pub(super) fn curved_face(points: &[Vector3<f64>; 6]) -> [([f64; 6], Vector3<f64>); 7] {
    triangle_rule().map(|([u, v, w], weight)| {
        let shape = [
            u * (2.0 * u - 1.0),
            v * (2.0 * v - 1.0),
            w * (2.0 * w - 1.0),
            4.0 * u * v,
            4.0 * v * w,
            4.0 * w * u,
        ];
        let by_u = points[0] * (4.0 * u - 1.0) + points[3] * (4.0 * v) + points[5] * (4.0 * w);
        let by_v = points[1] * (4.0 * v - 1.0) + points[3] * (4.0 * u) + points[4] * (4.0 * w);
        let by_w = points[2] * (4.0 * w - 1.0) + points[4] * (4.0 * v) + points[5] * (4.0 * u);
        (shape, (by_v - by_u).cross(&(by_w - by_u)) * (0.5 * weight))
    })
}

/// ∫ Nᵢ dA and ∫ Nᵢ² dA over a six-node face.
fn curved_shares(points: &[Vector3<f64>; 6]) -> [[f64; 2]; 6] {
    let mut sums = [[0.0; 2]; 6];
    for (shape, vector_area) in curved_face(points) {
        let area = vector_area.norm();
        for (sum, value) in sums.iter_mut().zip(shape) {
            sum[0] += value * area;
            sum[1] += value * value * area;
        }
    }
    sums
}

fn face_integrals(mesh: &TetMesh, face: Face) -> [[f64; 2]; 6] {
    match mesh.order() {
        Order::Linear => {
            let area = 0.5 * face_normal(mesh, face).norm();
            let corner = [area / 3.0, area / 6.0];
            [corner, corner, corner, [0.0; 2], [0.0; 2], [0.0; 2]]
        }
        Order::Quadratic => {
            let mut points = [Vector3::zeros(); 6];
            for (point, node) in points.iter_mut().zip(mesh.face_nodes(face)) {
                *point = mesh.point(node);
            }
            curved_shares(&points)
        }
    }
}

/// Area of one face, m²; for curved faces by a rule of degree five.
pub fn face_area(mesh: &TetMesh, face: Face) -> f64 {
    face_integrals(mesh, face).iter().map(|sum| sum[0]).sum()
}

/// Total area of faces, m².
pub fn total_area(mesh: &TetMesh, faces: &[Face]) -> f64 {
    faces.iter().map(|&face| face_area(mesh, face)).sum()
}

/// Share of every node of the mesh in the area of `faces`, m²; the sum is the total area.
pub fn tributary_areas(mesh: &TetMesh, faces: &[Face], share: Share) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.nodes.len()];
    for &face in faces {
        let sums = face_integrals(mesh, face);
        let area: f64 = sums.iter().map(|sum| sum[0]).sum();
        let squares: f64 = sums.iter().map(|sum| sum[1]).sum();
        let shares: [f64; 6] = match share {
            Share::Consistent => sums.map(|sum| sum[0]),
            Share::Positive => sums.map(|sum| sum[1] / squares * area),
            Share::ThreeNodes => three_nodes(mesh.order(), sums.map(|sum| sum[0])),
        };
        for (node, share) in mesh.face_nodes(face).zip(shares) {
            areas[node as usize] += share;
        }
    }
    areas
}

/// [`Share::ThreeNodes`] from ∫ Nᵢ dA of the six nodes of a face.
fn three_nodes(order: Order, shares: [f64; 6]) -> [f64; 6] {
    if order == Order::Linear {
        return shares;
    }
    // A linear function has at a corner the sum of its values at the two adjacent middles minus that
    // at the third.
    let [a, b, c, ab, bc, ca] = shares;
    [0.0, 0.0, 0.0, ab + a + b - c, bc + b + c - a, ca + c + a - b]
}
