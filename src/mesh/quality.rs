//! Mesh quality: aspect ratio, radius ratio and dihedral angles, each with its worst element.
//!
//! Measures are those of the straight tetrahedron through the corners; all but lengths and volumes are
//! dimensionless.

use crate::mesh::measure::{straight_volume, volume};
use crate::mesh::node_order::{EDGES, SIDES};
use crate::mesh::tet_mesh::TetMesh;
use nalgebra::Vector3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    pub value: f64,
    pub element: u32,
}

/// Quality of a mesh. Lengths in m, angles in rad.
#[derive(Clone, Debug, PartialEq)]
pub struct Quality {
    pub node_count: usize,
    pub element_count: usize,
    pub total_volume: f64,
    pub least_volume: Worst,
    /// Largest aspect ratio, longest edge / (2√6 · radius of the inscribed sphere): 1 for a regular tetrahedron.
    pub aspect: Worst,
    /// Least radius ratio, 3 · inscribed / circumscribed radius: 1 for a regular tetrahedron, 0 for a flat one.
    pub radius_ratio: Worst,
    pub least_dihedral: Worst,
    pub greatest_dihedral: Worst,
    pub shortest_edge: Worst,
    pub longest_edge: f64,
}

/// Measures of one tetrahedron.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    pub aspect: f64,
    pub radius_ratio: f64,
    pub least_dihedral: f64,
    pub greatest_dihedral: f64,
    pub shortest_edge: f64,
    pub longest_edge: f64,
}

/// Measures of the tetrahedron with these corners; the aspect ratio of a flat one is infinite.
pub fn shape(points: [Vector3<f64>; 4]) -> Shape {
    let lengths = EDGES.map(|[a, b]| (points[b] - points[a]).norm());
    let shortest_edge = lengths.into_iter().fold(f64::INFINITY, f64::min);
    let longest_edge = lengths.into_iter().fold(0.0, f64::max);
    let volume = straight_volume(points).abs();
    let normals = SIDES.map(|[a, b, c]| (points[b] - points[a]).cross(&(points[c] - points[a])));
    let area: f64 = normals.iter().map(|n| 0.5 * n.norm()).sum();
    let inscribed = 3.0 * volume / area;
    // 24 · volume · circumscribed radius = square root of a product over opposite edges (Crelle).
    let [p, q, r] = [lengths[0] * lengths[5], lengths[1] * lengths[3], lengths[2] * lengths[4]];
    let product = (p + q + r) * (p + q - r) * (p - q + r) * (q + r - p);
    let circumscribed = product.max(0.0).sqrt() / (24.0 * volume);
    let (mut least_dihedral, mut greatest_dihedral) = (f64::INFINITY, 0.0f64);
    for a in 0..4 {
        for b in a + 1..4 {
            // The angle between outward normals is the supplement of the dihedral angle.
            let sine = normals[a].cross(&normals[b]).norm();
            let angle = libm::atan2(sine, -normals[a].dot(&normals[b]));
            least_dihedral = least_dihedral.min(angle);
            greatest_dihedral = greatest_dihedral.max(angle);
        }
    }
    Shape {
        aspect: longest_edge / (2.0 * 6f64.sqrt() * inscribed),
        radius_ratio: if volume > 0.0 { 3.0 * inscribed / circumscribed } else { 0.0 },
        least_dihedral,
        greatest_dihedral,
        shortest_edge,
        longest_edge,
    }
}

/// Quality of `mesh`, which has at least one element.
pub fn quality(mesh: &TetMesh) -> Quality {
    let least = || Worst { value: f64::INFINITY, element: 0 };
    let greatest = || Worst { value: f64::NEG_INFINITY, element: 0 };
    let mut report = Quality {
        node_count: mesh.nodes.len(),
        element_count: mesh.elements.len(),
        total_volume: 0.0,
        least_volume: least(),
        aspect: greatest(),
        radius_ratio: least(),
        least_dihedral: least(),
        greatest_dihedral: greatest(),
        shortest_edge: least(),
        longest_edge: 0.0,
    };
    for index in 0..mesh.elements.len() {
        let element = index as u32;
        let lower = |worst: &mut Worst, value: f64| {
            if value < worst.value {
                *worst = Worst { value, element };
            }
        };
        // The aspect ratio of a flat element is 0/0; it counts as the worst.
        let higher = |worst: &mut Worst, value: f64| {
            let value = if value.is_nan() { f64::INFINITY } else { value };
            if value > worst.value {
                *worst = Worst { value, element };
            }
        };
        let volume = volume(mesh, index);
        let shape = shape(mesh.corner_points(index));
        report.total_volume += volume;
        lower(&mut report.least_volume, volume);
        higher(&mut report.aspect, shape.aspect);
        lower(&mut report.radius_ratio, shape.radius_ratio);
        lower(&mut report.least_dihedral, shape.least_dihedral);
        higher(&mut report.greatest_dihedral, shape.greatest_dihedral);
        lower(&mut report.shortest_edge, shape.shortest_edge);
        report.longest_edge = report.longest_edge.max(shape.longest_edge);
    }
    report
}
