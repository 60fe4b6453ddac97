//! Generated meshes against closed forms: volumes, areas, sets, and how they converge.

use bearing_dynamics::mesh::check::{Limits, check};
use bearing_dynamics::mesh::generate::{
    Bushing, BushingMesh, Cage, CageMesh, ContactBlock, Housing, HousingMesh, Part, PillowBlock,
    RailRelief, Ring, RingMesh, Solid, bar, bushing, contact_block, graded, ring, shaft,
};
use bearing_dynamics::mesh::measure::{
    Share, least_jacobian, total_area, total_volume, tributary_areas,
};
use bearing_dynamics::mesh::quality::quality;
use bearing_dynamics::mesh::topology::surface;
use bearing_dynamics::mesh::{Elements, MeshError, Order, TetMesh};
use std::f64::consts::{PI, TAU};

/// The cage of Table 5.3; the width follows from the stated mass of 0.069 kg.
const CAGE: Cage = Cage {
    pocket_count: 11,
    pocket_radius: 6.5e-3,
    inner_radius: 29.125e-3,
    outer_radius: 33.375e-3,
    width: 18.010e-3,
    relief: None,
};
const RELIEVED: Cage =
    Cage { width: 19.97e-3, relief: Some(RailRelief { depth: 2e-3, belt_width: 12e-3 }), ..CAGE };
/// Bore for an outer race of radius 31.953 mm and thickness 3.574 mm (Table 2.2).
const BORE: f64 = 35.527e-3;
const DEPTH: f64 = 20e-3;

fn sound(solid: &Solid) -> &TetMesh {
    if let Err(faults) = check(&solid.mesh, &Limits::default()) {
        panic!("{faults}");
    }
    &solid.mesh
}

fn curved(solid: &Solid) -> TetMesh {
    let elevated = solid.quadratic().unwrap();
    assert_eq!(elevated.moved_back, 0, "no node should have to leave its surface");
    if let Err(faults) = check(&elevated.mesh, &Limits::default()) {
        panic!("{faults}");
    }
    elevated.mesh
}

fn off(found: f64, exact: f64) -> f64 {
    ((found - exact) / exact).abs()
}

/// Errors of the volume on ever finer meshes, straight and curved, and their observed orders.
fn convergence(exact: f64, meshes: &[Solid]) -> ([f64; 2], [f64; 2]) {
    let straight: Vec<f64> = meshes.iter().map(|s| off(total_volume(sound(s)), exact)).collect();
    let bent: Vec<f64> = meshes.iter().map(|s| off(total_volume(&curved(s)), exact)).collect();
    let last = meshes.len() - 1;
    let order = |errors: &[f64]| (errors[last - 1] / errors[last]).log2();
    ([straight[last], bent[last]], [order(&straight), order(&bent)])
}

#[test]
fn bar_is_exact_and_its_sets_are_its_faces() {
    let solid = bar([0.1, 0.02, 0.01], [7, 3, 2]).unwrap();
    let mesh = sound(&solid);
    assert_eq!(mesh.elements.len(), 6 * 7 * 3 * 2);
    assert_eq!(mesh.nodes.len(), 8 * 4 * 3);
    assert!(off(total_volume(mesh), 2e-5) <= 1e-14);
    let areas = [("x_low", 2e-4), ("x_high", 2e-4), ("y_low", 1e-3), ("z_high", 2e-3)];
    for (name, area) in areas {
        assert!(off(total_area(mesh, mesh.surface_set(name).unwrap()), area) <= 1e-14, "{name}");
    }
    assert!(off(total_area(mesh, &surface(mesh)), 2.0 * (2e-4 + 1e-3 + 2e-3)) <= 1e-14);
    // A cube cut along its diagonals has angles between 45° and 90°.
    let cube = quality(&bar([1.0; 3], [2, 2, 2]).unwrap().mesh);
    assert!((cube.least_dihedral.value - PI / 4.0).abs() <= 1e-12);
    assert!((cube.greatest_dihedral.value - PI / 2.0).abs() <= 1e-12);
}

#[test]
fn tributary_areas_sum_to_the_area() {
    let solid = ring(
        &Ring { inner_radius: 0.01, outer_radius: 0.02, width: 0.01 },
        &RingMesh { around: 24, radial: 3, axial: 3, radial_growth: 1.2 },
    )
    .unwrap();
    for mesh in [solid.mesh.clone(), curved(&solid)] {
        let faces = mesh.surface_set("inner").unwrap();
        for share in [Share::Consistent, Share::Positive] {
            let areas = tributary_areas(&mesh, faces, share);
            assert!(off(areas.iter().sum(), total_area(&mesh, faces)) <= 1e-13);
            let on_inner = mesh.node_set("inner").unwrap();
            for (node, &area) in areas.iter().enumerate() {
                if on_inner.binary_search(&(node as u32)).is_err() {
                    assert_eq!(area, 0.0);
                } else if share == Share::Positive || mesh.order() == Order::Linear {
                    assert!(area > 0.0, "{node}: {area}");
                }
            }
        }
    }
}

#[test]
fn contact_block_has_the_stated_sizes_and_a_fine_zone() {
    let b = 0.377e-3;
    let block =
        ContactBlock { half_width: b, cells_per_half_width: 6, depth_cells: 3, growth: 1.3 };
    let solid = contact_block(&block).unwrap();
    let mesh = sound(&solid);
    assert!(off(total_volume(mesh), 8.0 * b * 5.0 * b * b) <= 1e-12);
    let (low, high) = mesh.bounding_box();
    for (found, exact) in low.into_iter().zip([0.0, -4.0 * b, -5.0 * b]) {
        assert!((found - exact).abs() <= 1e-12 * b);
    }
    for (found, exact) in high.into_iter().zip([b, 4.0 * b, 0.0]) {
        assert!((found - exact).abs() <= 1e-12 * b);
    }
    let fine: Vec<f64> = {
        let top = mesh.node_set("z_high").unwrap();
        let mut y: Vec<f64> = top
            .iter()
            .map(|&n| mesh.nodes[n as usize])
            .filter(|p| p[0] == 0.0)
            .map(|p| p[1])
            .filter(|y| y.abs() <= 1.5 * b * (1.0 + 1e-12))
            .collect();
        y.sort_by(f64::total_cmp);
        y
    };
    assert_eq!(fine.len(), 19, "3 b in steps of b / 6");
    assert!(fine.windows(2).all(|pair| off(pair[1] - pair[0], b / 6.0) <= 1e-9));
}

#[test]
fn graded_stations_start_fine_and_end_exactly() {
    let stations = graded(1.0, 5.0, 0.1, 1.3).unwrap();
    assert_eq!((stations[0], *stations.last().unwrap()), (1.0, 5.0));
    let steps: Vec<f64> = stations.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(steps[0] <= 0.1);
    for pair in steps.windows(2) {
        assert!(off(pair[1] / pair[0], 1.3) <= 1e-9);
    }
    assert!(matches!(graded(0.0, 1.0, 0.0, 1.3), Err(MeshError::Dimension { .. })));
    assert!(matches!(graded(0.0, 1.0, 1e-12, 1.0), Err(MeshError::Dimension { .. })));
    assert!(matches!(graded(0.0, 1.0, f64::NAN, 1.0), Err(MeshError::Dimension { .. })));
}

#[test]
fn ring_volume_converges_with_the_order_of_its_elements() {
    let shape = Ring { inner_radius: 0.02, outer_radius: 0.03, width: 0.015 };
    let make =
        |n| ring(&shape, &RingMesh { around: 12 * n, radial: n, axial: n, radial_growth: 1.0 });
    let meshes = [1, 2, 4].map(|n| make(n).unwrap());
    let exact = PI * (0.03f64.powi(2) - 0.02f64.powi(2)) * 0.015;
    let (errors, orders) = convergence(exact, &meshes);
    // Chords leave h² of the area, parabolas through three points of a circle h⁴.
    assert!((orders[0] - 2.0).abs() <= 0.1, "{orders:?}");
    assert!((orders[1] - 4.0).abs() <= 0.2, "{orders:?}");
    assert!(errors[1] <= 1e-5, "{errors:?}");
    let mesh = curved(&meshes[2]);
    for (name, area) in [("inner", 2.0 * PI * 0.02 * 0.015), ("outer", 2.0 * PI * 0.03 * 0.015)] {
        assert!(off(total_area(&mesh, mesh.surface_set(name).unwrap()), area) <= 1e-5, "{name}");
    }
    let radius = |node: &u32| mesh.nodes[*node as usize][1].hypot(mesh.nodes[*node as usize][2]);
    assert!(mesh.node_set("inner").unwrap().iter().all(|n| off(radius(n), 0.02) <= 1e-12));
}

#[test]
fn shaft_has_a_layer_of_nodes_at_every_station() {
    let stations = [-0.2, -0.19, -0.05, 0.0, 0.2];
    let make = |n: usize| shaft(0.015, &stations, 0.006 / n as f64, 16 * n, 2 * n).unwrap();
    let meshes = [1, 2].map(make);
    let (errors, orders) = convergence(PI * 0.015 * 0.015 * 0.4, &meshes);
    assert!((orders[0] - 2.0).abs() <= 0.1 && (orders[1] - 4.0).abs() <= 0.2, "{orders:?}");
    assert!(errors[1] <= 5e-6, "{errors:?}");
    let mesh = &meshes[0].mesh;
    let layer = mesh.node_set("x_low").unwrap().len();
    for (index, station) in stations.iter().enumerate() {
        let nodes = mesh.node_set(&format!("station_{}", index + 1)).unwrap();
        assert_eq!(nodes.len(), layer);
        assert!(nodes.iter().all(|&n| (mesh.nodes[n as usize][0] - station).abs() <= 1e-12));
    }
    let report = quality(mesh);
    assert!(report.least_dihedral.value.to_degrees() >= 10.0, "{report:?}");
}

/// ∫∫ over a pocket's circle of the wall's thickness along the pocket's axis, by nested midpoint
/// sums in polar coordinates: written apart from the mesh.
fn pocket_volume(cage: &Cage, outer: impl Fn(f64) -> f64) -> f64 {
    let (n, m) = (400, 800);
    let mut sum = 0.0;
    for i in 0..n {
        let rho = cage.pocket_radius * (i as f64 + 0.5) / n as f64;
        for j in 0..m {
            let angle = 2.0 * PI * (j as f64 + 0.5) / m as f64;
            let (s, x) = (rho * angle.cos(), rho * angle.sin());
            let height =
                (outer(x).powi(2) - s * s).sqrt() - (cage.inner_radius.powi(2) - s * s).sqrt();
            sum += height * rho;
        }
    }
    sum * (cage.pocket_radius / n as f64) * (2.0 * PI / m as f64)
}

fn cage_meshes(cage: &Cage, sizes: &[usize]) -> Vec<Solid> {
    let make = |&n: &usize| cage.solid(&CageMesh { quarter: 4 * n, bar: 2 * n, wall: 2 * n });
    sizes.iter().map(|n| make(n).unwrap()).collect()
}

#[test]
fn literal_cage_has_the_stated_mass() {
    let pocket = pocket_volume(&CAGE, |_| CAGE.outer_radius);
    assert!(off(pocket, 567.23e-9) <= 1e-5, "{pocket:e}");
    let ring = PI * (CAGE.outer_radius.powi(2) - CAGE.inner_radius.powi(2)) * CAGE.width;
    let exact = ring - 11.0 * pocket;
    assert!(off(7850.0 * exact, 0.069) <= 1e-4, "{}", 7850.0 * exact);
    let meshes = cage_meshes(&CAGE, &[1, 2]);
    let (errors, orders) = convergence(exact, &meshes);
    assert!((orders[0] - 2.0).abs() <= 0.15, "{orders:?} {errors:?}");
    assert!(orders[1] >= 3.5, "{orders:?} {errors:?}");
    assert!(errors[1] <= 2e-5, "{errors:?}");
    let mesh = curved(&meshes[0]);
    assert!(off(7850.0 * total_volume(&mesh), 0.069) <= 1e-3);
    // Along a pocket's rim mid-side nodes lie on both cylinders.
    let pocket = mesh.node_set("pocket_1").unwrap();
    for (name, radius) in [("inner", CAGE.inner_radius), ("outer", CAGE.outer_radius)] {
        let wall = mesh.node_set(name).unwrap();
        let rim: Vec<u32> = pocket.iter().copied().filter(|n| wall.contains(n)).collect();
        assert_eq!(rim.len(), 2 * 16);
        for node in rim {
            let [x, y, z] = mesh.nodes[node as usize];
            assert!(off(y.hypot(z), radius) <= 1e-12, "{name}");
            assert!(off(x.hypot(z), CAGE.pocket_radius) <= 1e-12, "{name}");
        }
    }
}

#[test]
fn cage_sets_cover_its_surface_once() {
    for (pocket_count, cage) in
        [(11, CAGE), (11, RELIEVED), (10, Cage { pocket_count: 10, ..CAGE })]
    {
        let solid = cage.solid(&CageMesh { quarter: 4, bar: 2, wall: 2 }).unwrap();
        let mesh = sound(&solid);
        let sets: usize = mesh.surface_sets.values().map(Vec::len).sum();
        assert_eq!(sets, surface(mesh).len());
        assert_eq!(mesh.surface_sets.len(), 4 + pocket_count);
        let pockets: Vec<usize> = (1..=pocket_count)
            .map(|p| mesh.surface_set(&format!("pocket_{p}")).unwrap().len())
            .collect();
        assert!(pockets.iter().all(|&count| count == 2 * 16 * 2), "{pockets:?}");
    }
}

#[test]
fn relieved_cage_keeps_the_mass() {
    let outer = |x: f64| RELIEVED.outer_radius_at(x);
    let pocket = pocket_volume(&RELIEVED, outer);
    let n = 20_000;
    let section: f64 = (0..n)
        .map(|i| RELIEVED.width * ((i as f64 + 0.5) / n as f64 - 0.5))
        .map(|x| {
            PI * (outer(x).powi(2) - RELIEVED.inner_radius.powi(2)) * RELIEVED.width / n as f64
        })
        .sum();
    let exact = section - 11.0 * pocket;
    assert!(off(7850.0 * exact, 0.069) <= 2e-3, "{}", 7850.0 * exact);
    let errors: Vec<f64> = cage_meshes(&RELIEVED, &[1, 2])
        .iter()
        .map(|solid| off(total_volume(&solid.quadratic().unwrap().mesh), exact))
        .collect();
    // The belt's edge runs through cells: second order even with curved elements.
    assert!(errors[1] <= 0.3 * errors[0] && errors[1] <= 0.01, "{errors:?}");
}

fn housing_mesh(n: usize) -> HousingMesh {
    HousingMesh { around: 32 * n, radial: 4 * n, axial: 3 * n, radial_growth: 1.2 }
}

/// Area of a pillow block's section below and above the height of the bore's centre, both sides,
/// by integrating the half width over the height.
fn pillow_block_areas(block: &PillowBlock) -> [f64; 2] {
    let half_width = |z: f64| -> f64 {
        let height = z + block.centre_height;
        let neck = 0.5 * block.neck_width;
        let ring = (block.outer_radius.powi(2) - z * z).max(0.0).sqrt();
        let above_base = height - block.base_height;
        if above_base < 0.0 {
            0.5 * block.base_width
        } else if above_base < block.fillet_radius {
            let rest = block.fillet_radius - above_base;
            neck + block.fillet_radius - (block.fillet_radius.powi(2) - rest * rest).sqrt()
        } else if z < 0.0 {
            neck.max(ring)
        } else {
            ring
        }
    };
    let integral = |from: f64, to: f64| -> f64 {
        let n = 200_000;
        (0..n)
            .map(|i| from + (to - from) * (i as f64 + 0.5) / n as f64)
            .map(|z| 2.0 * half_width(z) * (to - from) / n as f64)
            .sum()
    };
    let half_bore = 0.5 * PI * block.bore_radius.powi(2);
    let base = -block.centre_height + block.base_height;
    [
        integral(-block.centre_height, base)
            + integral(base, base + block.fillet_radius)
            + integral(base + block.fillet_radius, 0.0)
            - half_bore,
        integral(0.0, block.outer_radius) - half_bore,
    ]
}

#[test]
fn housings_have_the_volumes_of_their_sections() {
    let block = PillowBlock::proportioned(BORE, DEPTH);
    let [below, above] = pillow_block_areas(&block);
    let (side, outer) = (0.12, 0.05);
    let cases = [
        (
            "A",
            Housing::Square { bore_radius: BORE, side, depth: DEPTH },
            side * side - PI * BORE * BORE,
        ),
        ("B", Housing::MirroredPillowBlock(block), 2.0 * below),
        ("C", Housing::PillowBlock(block), below + above),
        (
            "D",
            Housing::Annulus { bore_radius: BORE, outer_radius: outer, depth: DEPTH },
            PI * (outer * outer - BORE * BORE),
        ),
    ];
    for (name, housing, area) in cases {
        let meshes = [1, 2].map(|n| housing.solid(&housing_mesh(n)).unwrap());
        let (errors, orders) = convergence(area * DEPTH, &meshes);
        // Errors of arcs that bulge out and in cancel, more on one mesh than on the other.
        let lone_arcs = matches!(name, "A" | "D");
        assert!(orders[0] >= if lone_arcs { 1.9 } else { 1.65 }, "{name}: {orders:?} {errors:?}");
        assert!(errors[1] <= 2e-6, "{name}: {orders:?} {errors:?}");
        for solid in &meshes {
            let report = quality(&solid.mesh);
            assert!(report.aspect.value <= 6.0, "{name}: {report:?}");
            assert!(report.least_dihedral.value.to_degrees() >= 10.0, "{name}: {report:?}");
        }
        let mesh = curved(&meshes[1]);
        let bore = total_area(&mesh, mesh.surface_set("bore").unwrap());
        assert!(off(bore, 2.0 * PI * BORE * DEPTH) <= 1e-5, "{name}: {bore}");
        let held = match housing {
            Housing::Square { .. } => 4.0 * side * DEPTH,
            Housing::MirroredPillowBlock(_) => 2.0 * block.base_width * DEPTH,
            Housing::PillowBlock(_) => block.base_width * DEPTH,
            Housing::Annulus { .. } => 2.0 * PI * outer * DEPTH,
        };
        assert!(off(total_area(&mesh, mesh.surface_set("fixed").unwrap()), held) <= 1e-5, "{name}");
    }
}

#[test]
fn dimensions_that_do_not_fit_are_named() {
    let mesh = CageMesh { quarter: 4, bar: 2, wall: 2 };
    let block = PillowBlock::proportioned(BORE, DEPTH);
    let housing = |block| Housing::PillowBlock(block).solid(&housing_mesh(1)).err();
    let cases = [
        ("pocket radius", Cage { pocket_radius: 9.1e-3, ..CAGE }.solid(&mesh).err()),
        ("inner radius", Cage { outer_radius: f64::NAN, ..CAGE }.solid(&mesh).err()),
        ("width", Cage { width: -1.0, ..CAGE }.solid(&mesh).err()),
        (
            "width of the belt",
            Cage { relief: Some(RailRelief { depth: 1e-3, belt_width: 0.02 }), ..CAGE }
                .solid(&mesh)
                .err(),
        ),
        ("base height", housing(PillowBlock { base_height: 0.06, ..block })),
        ("base width", housing(PillowBlock { base_width: 0.09, ..block })),
        ("neck width", housing(PillowBlock { neck_width: 0.1, ..block })),
        ("cells around the shaft", shaft(0.01, &[0.0, 0.1], 0.01, 12, 2).err()),
        ("distance of two stations", shaft(0.01, &[0.0, 0.1, 0.1], 0.01, 16, 2).err()),
        ("size of the bar", bar([1.0, f64::INFINITY, 1.0], [1; 3]).err()),
    ];
    for (expected, error) in cases {
        match error {
            Some(MeshError::Dimension { what, .. }) => assert_eq!(what, expected),
            other => panic!("{expected}: {other:?}"),
        }
    }
}

/// Layers that are thinner than the arc of a cell is high are curved as the sleeves are, and the body keeps its volume.
#[test]
fn thin_walls_stay_round() {
    for (inner, thickness, around, radial) in
        [(60e-3, 2e-3, 12, 4), (100e-3, 1e-3, 16, 4), (71e-3, 10e-3, 16, 8), (71e-3, 10e-3, 8, 4)]
    {
        let body = Bushing { inner_diameter: inner, thickness, length: 20e-3 };
        let cells = BushingMesh { around, radial, axial: 2, grading: 2.0, part: Part::Whole };
        let made = bushing(&body, &cells).unwrap();
        let elevated = made.quadratic().unwrap();
        assert_eq!(elevated.moved_back, 0, "{body:?}, {around} around");
        let [a, b] = [0.5 * inner, 0.5 * inner + thickness];
        let exact = PI * (b * b - a * a) * 20e-3;
        // Parabolas in the place of arcs: of the fourth order in the angle of a cell, of each sleeve.
        let angle = TAU / around as f64;
        let error = total_volume(&elevated.mesh) / exact - 1.0;
        let allowed = 2.0 * angle.powi(4) / 480.0 * (b + a) / (b - a) + 1e-12;
        assert!(error.abs() <= allowed, "{body:?}, {around}: {error:e} of {allowed:e}");
        let Elements::Quadratic(elements) = &elevated.mesh.elements else { panic!("ten nodes") };
        for nodes in elements {
            let places = nodes.map(|node| elevated.mesh.point(node));
            assert!(least_jacobian(&places) > 0.0);
        }
    }
}
