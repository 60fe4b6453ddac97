//! Distribution of a surface's vector area to nodes: minus the nodal forces of unit pressure.

use crate::mesh::measure::{curved_face, face_normal};
use crate::mesh::tet_mesh::{Face, Order, TetMesh};
use nalgebra::Vector3;

/// ∫ Nᵢ n dA over `faces` for every node of the mesh, outward, m². Zero in sum over a closed
/// surface.
///
/// Exact for curved faces too: shape function and normal have degree two each, the rule degree five.
pub fn vector_areas(mesh: &TetMesh, faces: &[Face]) -> Vec<[f64; 3]> {
    let mut areas = vec![[0.0; 3]; mesh.nodes.len()];
    for &face in faces {
        let shares = match mesh.order() {
            Order::Linear => {
                let share = face_normal(mesh, face) / 6.0;
                [share, share, share, Vector3::zeros(), Vector3::zeros(), Vector3::zeros()]
            }
            Order::Quadratic => curved_shares(mesh, face),
        };
        for (node, share) in mesh.face_nodes(face).zip(shares) {
            for i in 0..3 {
                areas[node as usize][i] += share[i];
            }
        }
    }
    areas
}

/// ∫ Nᵢ n dA for the corners and then the middles of one six-node face, m².
fn curved_shares(mesh: &TetMesh, face: Face) -> [Vector3<f64>; 6] {
    let mut points = [Vector3::zeros(); 6];
    for (point, node) in points.iter_mut().zip(mesh.face_nodes(face)) {
        *point = mesh.point(node);
    }
    let mut sums = [Vector3::zeros(); 6];
    for (shape, area) in curved_face(&points) {
        for (sum, value) in sums.iter_mut().zip(shape) {
            *sum += area * value;
        }
    }
    sums
}
