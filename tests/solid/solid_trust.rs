//! What the estimate of a mesh's error is worth.

use crate::solid_common::{cut_cubes, end_loaded};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::generate::{Ring, RingMesh, bar, ring};
use bearing_dynamics::mesh::layers::thinnest_wall;
use bearing_dynamics::mesh::tet_mesh::Order;
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::stress::nodal_stresses;
use bearing_dynamics::solids::trust::{at_most, energy_error};

/// A bar clamped at one end with a load of 1 N on the other: the mean displacement along the load, m, what the
/// estimate says is missing of it, and elements through the thinnest wall.
fn clamped(size: Vec3, cells: [usize; 3], order: Order, poisson: f64, along: Vec3) -> [f64; 3] {
    let solid = bar(size.map(|mm| 1e-3 * mm), cells).unwrap();
    let mesh = match order {
        Order::Linear => solid.mesh,
        Order::Quadratic => solid.quadratic().unwrap().mesh,
    };
    let model = SolidModel::new(end_loaded(&mesh, poisson, along)).unwrap();
    let u = equilibrium(&model, 0.0, &EquilibriumOptions::default()).unwrap().displacement;
    let work: f64 = model.problem.loads[0]
        .forces
        .iter()
        .map(|(n, f)| (0..3).map(|i| f[i] * u[*n as usize][i]).sum::<f64>())
        .sum();
    let told = energy_error(&model, &u, &nodal_stresses(&model, &u)).part();
    [work, told, thinnest_wall(&mesh.nodes, &mesh.elements, 0.1).unwrap().elements]
}

const BEND: Vec3 = [0.0, 0.0, -1.0];
const PULL: Vec3 = [1.0, 0.0, 0.0];

/// A body (mm, Poisson's ratio, direction of the load) in a fine mesh and in coarse ones, each in elements of four
/// nodes, unless they lock altogether, and of ten.
type Body = (&'static str, Vec3, f64, Vec3, [usize; 3], &'static [[usize; 3]]);

const BODIES: [Body; 7] = [
    ("bar", [100.0, 10.0, 10.0], 0.3, BEND, [30, 4, 4], &[[10, 1, 1], [10, 2, 2]]),
    (
        "bar, nearly incompressible",
        [100.0, 10.0, 10.0],
        0.499,
        BEND,
        [40, 5, 5],
        &[[10, 1, 1], [10, 2, 2]],
    ),
    ("cube", [10.0, 10.0, 10.0], 0.3, BEND, [8, 8, 8], &[[1, 1, 1], [2, 2, 2], [3, 3, 3]]),
    (
        "cube, nearly incompressible",
        [10.0, 10.0, 10.0],
        0.499,
        BEND,
        [8, 8, 8],
        &[[1, 1, 1], [2, 2, 2]],
    ),
    ("cube, pulled", [10.0, 10.0, 10.0], 0.3, PULL, [8, 8, 8], &[[1, 1, 1], [2, 2, 2], [3, 3, 3]]),
    ("slender bar", [100.0, 10.0, 2.0], 0.3, BEND, [40, 4, 2], &[[10, 1, 1], [20, 2, 1]]),
    ("pad", [5.0, 40.0, 40.0], 0.449, PULL, [4, 12, 12], &[[1, 4, 4], [2, 8, 8]]),
];

/// What is really missing lies within the band of warnings, by the elements through the thinnest wall, and the few
/// documented cases are as documented.
#[test]
fn what_a_mesh_misses_is_within_the_band_of_the_estimate() {
    let documented = [
        ("cube", [1, 1, 1], Order::Quadratic, 2.2, 13.6),
        ("cube", [1, 1, 1], Order::Linear, 10.7, 50.0),
        ("cube", [2, 2, 2], Order::Quadratic, 1.1, 3.9),
        ("bar", [10, 2, 2], Order::Linear, 37.0, 65.0),
        ("bar", [10, 2, 2], Order::Quadratic, 0.3, 0.9),
        ("bar, nearly incompressible", [10, 2, 2], Order::Quadratic, 2.6, 9.5),
        ("slender bar", [10, 1, 1], Order::Quadratic, 0.84, 2.7),
    ];
    let mut seen = 0;
    for (name, size, poisson, along, fine, meshes) in BODIES {
        let [truth, ..] = clamped(size, fine, Order::Quadratic, poisson, along);
        for cells in meshes {
            for order in [Order::Linear, Order::Quadratic] {
                if order == Order::Linear && poisson >= 0.45 {
                    continue;
                }
                let [found, told, through] = clamped(size, *cells, order, poisson, along);
                let missing = 1.0 - found / truth;
                let [low, high] = [told, (at_most(order, through) * told).min(0.99)];
                println!(
                    "{name} {cells:?} {order:?}: {told:.4} of {missing:.4}, {low:.4} to {high:.4}"
                );
                assert!(low <= missing && missing <= high, "{name} {cells:?} {order:?}");
                let fewest = *cells.iter().min().unwrap() as f64;
                assert!((through - fewest).abs() <= 1e-9, "{through} through {cells:?}");
                for (_, _, _, percent, truly) in documented
                    .iter()
                    .filter(|(body, mesh, of, ..)| *body == name && mesh == cells && *of == order)
                {
                    seen += 1;
                    // To the digits written.
                    assert!((100.0 * told / percent - 1.0).abs() <= 0.03, "{told} {percent}");
                    assert!((100.0 * missing / truly - 1.0).abs() <= 0.06, "{missing} {truly}");
                }
            }
        }
    }
    assert_eq!(seen, documented.len());
}

/// A step from one wall to another: the thin one counts, if it is no mere edge.
#[test]
fn the_thinnest_wall_is_found_and_an_edge_is_not() {
    let ring = ring(
        &Ring { inner_radius: 0.02, outer_radius: 0.03, width: 0.04 },
        &RingMesh { around: 48, radial: 3, axial: 8, radial_growth: 1.0 },
    )
    .unwrap()
    .mesh;
    let wall = thinnest_wall(&ring.nodes, &ring.elements, 0.1).unwrap();
    // Chords and cells cut askew: a fifth of an element.
    assert!((wall.elements - 3.0).abs() <= 0.6, "{wall:?}");
    assert!((wall.thickness / 0.01 - 1.0).abs() <= 0.1, "{wall:?}");
    // Irregular elements, two cells through the block.
    let shaken = cut_cubes([0.1, 0.05, 0.01], [20, 10, 2], 0.25, |inner| inner);
    let wall = thinnest_wall(&shaken.nodes, &shaken.elements, 0.1).unwrap();
    assert!((1.5..2.5).contains(&wall.elements), "{wall:?}");
    assert!((wall.thickness - 0.01).abs() <= 1e-9, "{wall:?}");
}
