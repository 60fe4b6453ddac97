//! Loads and fields on meshes of solids, and the crest of a curve below a contact.

use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::generate::{Ring, RingMesh, bar, ring};
use bearing_dynamics::mesh::topology::surface;
use verification::pressed_block::crest;
use verification::solids::{Vec3, body_force, field_error, largest, mesh_of, surface_force};

fn total(forces: &[(u32, Vec3)]) -> Vec3 {
    [0, 1, 2].map(|i: usize| forces.iter().map(|(_, f)| f[i]).sum())
}

#[test]
fn what_is_not_a_number_stays() {
    assert!(largest([1.0, f64::NAN, 2.0]).is_nan());
    assert_eq!(largest([1.0, 3.0, 2.0]), 3.0);
}

#[test]
fn loads_add_up() {
    let solid = bar([0.3, 0.2, 0.1], [2, 2, 1]).unwrap();
    for order in [Order::Linear, Order::Quadratic] {
        let mesh = mesh_of(&solid, order).unwrap();
        // ∫x² dV over the bar: 0.3³/3 · 0.2 · 0.1.
        let force = total(&body_force(&mesh, |x| [x[0] * x[0], 1.0, 0.0]));
        assert!((force[0] / 1.8e-4 - 1.0).abs() <= 1e-13);
        assert!((force[1] / 6e-3 - 1.0).abs() <= 1e-13);
        // A pressure on a closed surface has no sum.
        let closed = total(&surface_force(&mesh, &surface(&mesh), |_, n| n));
        assert!(closed.iter().all(|f| f.abs() <= 1e-16), "{closed:?}");
        let exact = |x: Vec3| [x[1], 2.0 * x[0], 0.0];
        let field: Vec<Vec3> = mesh.nodes.iter().map(|x| exact(*x)).collect();
        assert!(field_error(&mesh, &field, exact) <= 1e-14);
    }
}

#[test]
fn pressure_on_a_curved_face() {
    let (r, b) = (0.05, 0.02);
    let body = Ring { inner_radius: r, outer_radius: 0.06, width: b };
    let cells = RingMesh { around: 24, radial: 1, axial: 1, radial_growth: 1.0 };
    let mesh = mesh_of(&ring(&body, &cells).unwrap(), Order::Quadratic).unwrap();
    let inner = mesh.surface_set("inner").unwrap();
    // Σ|f| in radial direction is pressure times area; normals of the bore point to the axis.
    let force = surface_force(&mesh, inner, |_, n| n);
    let inwards: f64 = force
        .iter()
        .map(|(node, f)| {
            let [_, y, z] = mesh.nodes[*node as usize];
            -(f[1] * y + f[2] * z) / y.hypot(z)
        })
        .sum();
    let area = std::f64::consts::TAU * r * b;
    // Quadratic edges of 15° leave 2e-5 of the circle.
    assert!((inwards / area - 1.0).abs() <= 2e-4, "{inwards} {area}");
}

#[test]
fn crest_of_a_cubic_is_its_own() {
    // Upright at 0.7, where it is 2; bends up further on.
    let curve: Vec<[f64; 2]> = (0..40)
        .map(|i| {
            let x = 0.05 * f64::from(i);
            let s: f64 = x - 0.7;
            [x, 2.0 - s * s + 0.4 * s * s * s]
        })
        .collect();
    let [at, height] = crest(&curve, [0.4, 1.2]);
    assert!((at - 0.7).abs() <= 1e-9 && (height - 2.0).abs() <= 1e-9, "{at} {height}");
}
