//! Pictures of surfaces and of what presses on them.

use bearing_dynamics::mesh::generate::{Ring, RingMesh, bar, ring};
use verification::contact_picture::{Panel, contact_picture, outline};
use verification::solids::Vec3;
use verification::surface_picture::{SurfacePicture, surface_picture};

#[test]
fn an_arrow_for_each_force_that_shows() {
    let body = Ring { inner_radius: 0.03, outer_radius: 0.04, width: 0.01 };
    let cells = RingMesh { around: 12, radial: 1, axial: 1, radial_growth: 1.0 };
    let mesh = ring(&body, &cells).unwrap().mesh;
    // Front and back of the bore at the same place, another place, and a node without force.
    let at = |x: f64, y: f64, z: f64| {
        let far = |p: &Vec3| (p[0] - x).abs() + (p[1] - y).abs() + (p[2] - z).abs();
        mesh.nodes.iter().position(|p| far(p) < 1e-9).unwrap() as u32
    };
    let forces = vec![
        (at(-0.005, 0.03, 0.0), [0.0, 2.0, 0.0]),
        (at(0.005, 0.03, 0.0), [0.0, 1.0, 0.0]),
        (at(0.005, 0.0, 0.03), [0.0, 0.0, 1.0]),
        (at(0.005, -0.03, 0.0), [0.0; 3]),
    ];
    let displacement = vec![[0.0; 3]; mesh.nodes.len()];
    let panel = Panel { title: "ring".into(), displacement, forces, mesh: &mesh };
    assert_eq!(outline(&mesh).len(), 24);
    let svg = contact_picture(&[panel], 1);
    assert_eq!(svg.matches("Z\" fill=").count(), 2);
    assert!(svg.contains("longest arrow: 3.0 N") && !svg.contains("NaN"));
}

#[test]
fn a_cube_shows_three_of_its_sides() {
    let mesh = bar([1.0, 1.0, 1.0], [1, 1, 1]).unwrap().quadratic().unwrap().mesh;
    let values: Vec<f64> = mesh.nodes.iter().map(|x| x[2]).collect();
    let moved = vec![[0.1, 0.0, 0.0]; values.len()];
    let mut picture = SurfacePicture {
        mesh: &mesh,
        displacement: &[],
        values: &values,
        label: "height, m",
        azimuth: 30.0,
        elevation: 20.0,
    };
    let svg = surface_picture(&picture);
    // Three sides of two faces of four triangles, and the empty path of edges.
    assert_eq!(svg.matches("<path d=").count(), 3 * 2 * 4);
    assert!(svg.contains(">-0.50<") && svg.contains(">0.50<") && !svg.contains("NaN"));
    picture.displacement = &moved;
    // Twelve edges of two parts each show behind.
    assert_eq!(surface_picture(&picture).split("d=\"").nth(1).unwrap().matches('M').count(), 24);
}
