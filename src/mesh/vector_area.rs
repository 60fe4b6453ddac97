//! What part of a surface's vector area each node carries: minus the nodal forces of unit pressure.

use crate::mesh::measure::{curved_face, face_normal};
use crate::mesh::tet_mesh::{Face, Order, TetMesh};
use nalgebra::Vector3;

/// ∫ Nᵢ n dA over `faces` for every node of the mesh, outward, m². Zero in sum over a closed
/// surface.
///
/// Exact, for curved faces too: shape function and normal are of degree two each, the rule of five.
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

/// The same for the corners and then the middles of one six-node face.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::generate::{Ring, RingMesh, ring};
    use crate::mesh::measure::total_area;
    use crate::mesh::topology::surface;

    /// A closed surface has none, a flat end its area times its normal, in both orders.
    #[test]
    fn vector_areas_close() {
        let shape = Ring { inner_radius: 0.02, outer_radius: 0.03, width: 0.01 };
        let cells = RingMesh { around: 16, radial: 2, axial: 2, radial_growth: 1.3 };
        let solid = ring(&shape, &cells).unwrap();
        for mesh in [solid.mesh.clone(), solid.quadratic().unwrap().mesh] {
            let sum = |faces: &[Face]| {
                let areas = vector_areas(&mesh, faces);
                areas.iter().fold([0.0; 3], |s, a| [s[0] + a[0], s[1] + a[1], s[2] + a[2]])
            };
            let end = &mesh.surface_sets["x_high"];
            let area = total_area(&mesh, end);
            // Sums of some hundred terms of the size of the area.
            let small = 1e-14 * area;
            let [x, y, z] = sum(end);
            assert!((x - area).abs() <= 100.0 * small, "{x} {area}");
            assert!(y.abs() <= 100.0 * small && z.abs() <= 100.0 * small, "{y} {z}");
            for component in sum(&surface(&mesh)) {
                assert!(component.abs() <= 1000.0 * small, "{component}");
            }
        }
    }
}
