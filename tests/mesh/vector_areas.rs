//! Areas of closed surfaces.

use bearing_dynamics::mesh::generate::{Ring, RingMesh, ring};
use bearing_dynamics::mesh::measure::total_area;
use bearing_dynamics::mesh::tet_mesh::Face;
use bearing_dynamics::mesh::topology::surface;
use bearing_dynamics::mesh::vector_area::*;

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
