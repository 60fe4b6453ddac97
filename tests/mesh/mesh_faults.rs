//! Bad meshes: each fault found, named and placed; each repair done only when asked for. And what
//! holds for good ones: scale, numbering, sets.

use bearing_dynamics::mesh::check::{Limits, check, faults};
use bearing_dynamics::mesh::generate::{Ring, RingMesh, Solid, bar, ring};
use bearing_dynamics::mesh::measure::{total_area, total_volume, volume};
use bearing_dynamics::mesh::numbering::reverse_cuthill_mckee;
use bearing_dynamics::mesh::quadratic::elevate;
use bearing_dynamics::mesh::quality::quality;
use bearing_dynamics::mesh::repair::{Repair, Repaired, coincident_nodes, repair};
use bearing_dynamics::mesh::select::{Region, nodes_in};
use bearing_dynamics::mesh::topology::{node_neighbours, surface};
use bearing_dynamics::mesh::{Elements, Fault, MeshError, Surface, TetMesh};
use proptest::prelude::*;
use std::collections::BTreeSet;

fn cube(n: usize) -> TetMesh {
    bar([0.1; 3], [n; 3]).unwrap().mesh
}

fn tets(mesh: &mut TetMesh) -> &mut Vec<[u32; 4]> {
    match &mut mesh.elements {
        Elements::Linear(list) => list,
        Elements::Quadratic(_) => panic!("not linear"),
    }
}

/// A mesh without sets, which would name elements that a test removes.
fn bare(mesh: &TetMesh, change: impl Fn(&mut Vec<[u32; 4]>)) -> TetMesh {
    let mut copy = mesh.clone();
    change(tets(&mut copy));
    TetMesh::new(copy.nodes, copy.elements).unwrap()
}

fn found(mesh: &TetMesh) -> Vec<Fault> {
    faults(mesh, &Limits::default())
}

fn asked(mesh: TetMesh, wanted: Repair) -> (TetMesh, Repaired) {
    repair(mesh, &wanted).unwrap()
}

#[test]
fn an_inverted_element_is_named_and_turned_when_asked() {
    let mut mesh = cube(3);
    tets(&mut mesh)[17].swap(0, 1);
    match &found(&mesh)[..] {
        [Fault::Inverted { count: 1, of: 162, element: 17, volume, .. }] => assert!(*volume < 0.0),
        other => panic!("{other:?}"),
    }
    let said = check(&mesh, &Limits::default()).unwrap_err().to_string();
    assert!(said.contains("element 17") && said.contains("`orient`"), "{said}");
    let (same, done) = asked(mesh.clone(), Repair::default());
    assert_eq!((same, done), (mesh.clone(), Repaired::default()), "nothing without being asked");
    let (mesh, done) = asked(mesh, Repair { orient: true, ..Repair::default() });
    assert_eq!(done, Repaired { turned_elements: 1, ..Repaired::default() });
    assert_eq!(found(&mesh), []);
}

#[test]
fn a_mesh_turned_inside_out_is_turned_back_with_its_surfaces() {
    for quadratic in [false, true] {
        let good = cube(2);
        let good = if quadratic { elevate(&good, &[]).unwrap().mesh } else { good };
        // A mirror image: every element is inverted, the surfaces stay where they are.
        let mut mirrored = good.clone();
        for node in &mut mirrored.nodes {
            node[0] = -node[0];
        }
        let all = good.elements.len();
        assert!(matches!(found(&mirrored)[0], Fault::Inverted { count, .. } if count == all));
        let (turned, done) = asked(mirrored, Repair { orient: true, ..Repair::default() });
        assert_eq!(done.turned_elements, all);
        assert_eq!(found(&turned), []);
        assert!((total_volume(&turned) / 1e-3 - 1.0).abs() <= 1e-14);
        for (name, faces) in &turned.surface_sets {
            assert_eq!(turned.nodes_of_faces(faces), turned.node_sets[name], "{name}");
        }
    }
}

#[test]
fn slivers_are_measured() {
    let mesh = |height: f64| {
        let nodes = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.9, 0.0], [0.5, 0.3, height]];
        TetMesh::new(nodes, Elements::Linear(vec![[0, 1, 2, 3]])).unwrap()
    };
    match &found(&mesh(2e-5))[..] {
        [Fault::Sliver { count: 1, element: 0, aspect, .. }] => {
            assert!((1e4..1e5).contains(aspect))
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(found(&mesh(0.8)), []);
    let limits = Limits { aspect: f64::INFINITY, ..Limits::default() };
    assert_eq!(faults(&mesh(2e-5), &limits), [], "a person may allow it");
    assert!(matches!(found(&mesh(0.0))[0], Fault::Inverted { .. }), "flat is no element");
}

#[test]
fn a_missing_element_is_a_cavity_and_a_missing_layer_two_bodies() {
    let mesh = cube(4);
    let inner = |i: &usize| {
        let inside =
            |p: &[f64; 3]| p[0] > 0.02 && p[0] < 0.08 && p[1].abs() < 0.04 && p[2].abs() < 0.04;
        mesh.corner_points(*i).iter().all(|p| inside(&<[f64; 3]>::from(*p)))
    };
    let middle = (0..mesh.elements.len()).find(inner).unwrap();
    let hollow = bare(&mesh, |list| {
        list.remove(middle);
    });
    match &found(&hollow)[..] {
        [Fault::Cavity { count: 1, faces: 4, volume, .. }] => {
            assert!((volume / (1e-3 / 384.0) - 1.0).abs() <= 1e-9);
        }
        other => panic!("{other:?}"),
    }
    let limits = Limits { cavities: 1, ..Limits::default() };
    assert_eq!(faults(&hollow, &limits), [], "a person may mean it");

    let parted = bare(&mesh, |list| {
        let keep = |tet: &[u32; 4]| {
            let x = tet.map(|n| mesh.nodes[n as usize][0]);
            x.iter().all(|x| *x < 0.03) || x.iter().all(|x| *x > 0.045)
        };
        list.retain(keep);
    });
    assert!(found(&parted).iter().any(|f| matches!(f, Fault::SeveralBodies { count: 2, .. })));
    assert_eq!(faults(&parted, &Limits { bodies: 2, ..Limits::default() }), []);
}

#[test]
fn surfaces_that_are_not_a_solids() {
    // Two elements joined along an edge alone.
    let nodes = vec![
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, -1.0],
    ];
    let mesh = TetMesh::new(nodes, Elements::Linear(vec![[0, 1, 2, 3], [0, 1, 4, 5]])).unwrap();
    let all = found(&mesh);
    assert!(
        all.iter().any(|f| matches!(f, Fault::NonManifold { first: 0, second: 1, .. })),
        "{all:?}"
    );
    // The same element twice.
    let twice = bare(&cube(2), |list| list.push(list[5]));
    let all = found(&twice);
    assert!(all.iter().any(|f| matches!(f, Fault::Overlapping { .. })), "{all:?}");
    // Two elements on the same side of a face.
    let nodes = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.1, 0.1, 2.0]];
    let mesh = TetMesh::new(nodes, Elements::Linear(vec![[0, 1, 2, 3], [0, 1, 2, 4]])).unwrap();
    let all = found(&mesh);
    assert!(all.iter().any(|f| matches!(f, Fault::Overlapping { count: 1, .. })), "{all:?}");
}

#[test]
fn duplicate_and_unreferenced_nodes() {
    // Two halves that touch without sharing nodes, and two nodes of no element.
    let left = cube(2);
    let offset = left.nodes.len() as u32;
    let mut nodes = left.nodes.clone();
    nodes.extend(left.nodes.iter().map(|&[x, y, z]| [x + 0.1 + 1e-12, y, z]));
    nodes.extend([[5.0, 0.0, 0.0], [6.0, 0.0, 0.0]]);
    let mut list = tets(&mut left.clone()).clone();
    list.extend(list.clone().iter().map(|tet| tet.map(|n| n + offset)));
    let mut mesh = TetMesh::new(nodes, Elements::Linear(list)).unwrap();
    mesh.add_node_set("seam", &Region::On { surface: Surface::plane(0, 0.1), tolerance: 1e-9 })
        .unwrap();
    assert_eq!(mesh.node_sets["seam"].len(), 18);
    let all = found(&mesh);
    assert!(all.iter().any(|f| matches!(f, Fault::DuplicateNodes { count: 9, .. })), "{all:?}");
    assert!(all.iter().any(|f| matches!(f, Fault::UnreferencedNodes { count: 2, first: 54 })));
    assert!(all.iter().any(|f| matches!(f, Fault::SeveralBodies { count: 2, .. })));

    let wanted = Repair { merge_duplicates: Some(1e-9), drop_unreferenced: true, orient: false };
    let (whole, done) = asked(mesh.clone(), wanted);
    assert_eq!(done, Repaired { merged_nodes: 9, dropped_nodes: 2, turned_elements: 0 });
    assert_eq!(found(&whole), []);
    assert_eq!((whole.nodes.len(), whole.node_sets["seam"].len()), (45, 9));
    assert!((total_volume(&whole) / 2e-3 - 1.0).abs() <= 1e-10);
    let only_merged = asked(mesh.clone(), Repair { drop_unreferenced: false, ..wanted }).0;
    assert_eq!(only_merged.nodes.len(), 47);
    let error = repair(mesh, &Repair { merge_duplicates: Some(0.06), ..wanted }).unwrap_err();
    assert!(error.to_string().contains("would collapse"), "{error}");
}

/// Along every axis, wherever two nodes lie among the cells that the search goes through.
#[test]
fn nodes_are_one_up_to_the_tolerance_and_no_farther() {
    const TOLERANCE: f64 = 1e-6;
    for k in 0..40 {
        let at = [0.37, -0.9, 1.3].map(|part| part * f64::from(k) * TOLERANCE);
        for (axis, side) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)] {
            for (part, first) in [(0.99, 0), (1.01, 1), (5.0, 1)] {
                let mut other = at;
                other[axis] += side * part * TOLERANCE;
                let found = coincident_nodes(&[at, other], TOLERANCE);
                assert_eq!(found, [0, first], "{part} from {at:?} along {axis}");
            }
        }
    }
}

#[test]
fn another_programs_node_order_and_folded_sides_are_seen() {
    let good = elevate(&cube(2), &[]).unwrap().mesh;
    let mut swapped = good.clone();
    let mut folded = good.clone();
    if let Elements::Quadratic(list) = &mut swapped.elements {
        list.iter_mut().for_each(|nodes| nodes.swap(8, 9));
    }
    assert!(found(&swapped).iter().any(|f| matches!(f, Fault::MidSide { .. })));
    if let Elements::Quadratic(list) = &folded.elements {
        let [corner, middle] = [list[3][0], list[3][4]].map(|n| n as usize);
        folded.nodes[middle] = folded.nodes[corner];
    }
    assert!(
        found(&folded).iter().any(|f| matches!(f, Fault::Folded { .. })),
        "{:?}",
        found(&folded)
    );
    assert_eq!(elevate(&good, &[]).unwrap_err(), MeshError::AlreadyQuadratic);
}

#[test]
fn elevation_never_inverts_an_element() {
    // A ring so coarse and thin that the arcs bulge through it.
    let shape = Ring { inner_radius: 0.0195, outer_radius: 0.02, width: 0.02 };
    let counts = RingMesh { around: 6, radial: 1, axial: 1, radial_growth: 1.0 };
    let Solid { mesh, curved } = ring(&shape, &counts).unwrap();
    let elevated = elevate(&mesh, &curved).unwrap();
    assert!(elevated.moved_back > 0);
    let wrong = found(&elevated.mesh);
    assert!(
        !wrong.iter().any(|f| matches!(f, Fault::Folded { .. } | Fault::Inverted { .. })),
        "{wrong:?}"
    );
    assert!((0..elevated.mesh.elements.len()).all(|i| volume(&elevated.mesh, i) > 0.0));
}

#[test]
fn sets_that_match_nothing_say_how_far_off_they_are() {
    let mut mesh = cube(2);
    let region = Region::On { surface: Surface::plane(0, 0.11), tolerance: 1e-6 };
    match mesh.add_node_set("end", &region) {
        Err(MeshError::EmptySet { nearest, .. }) => {
            assert!((nearest / 0.009999 - 1.0).abs() <= 1e-9)
        }
        other => panic!("{other:?}"),
    }
    let boundary = surface(&mesh);
    let rim = Surface::about_x(0.2);
    assert!(matches!(
        mesh.add_surface_set("rim", &boundary, &rim, 1e-6),
        Err(MeshError::EmptySet { .. })
    ));
    let error = mesh.node_set("x_lo").unwrap_err().to_string();
    assert!(error.contains("x_low, y_high"), "{error}");
    assert!(matches!(mesh.surface_set("none"), Err(MeshError::NoSuchSet { .. })));
    mesh.element_sets.insert("nothing".into(), Vec::new());
    assert!(matches!(&found(&mesh)[..], [Fault::EmptySet { kind: "element", .. }]));
}

#[test]
fn a_box_selects_the_nodes_within() {
    let mesh = cube(4);
    let corner = Region::Box { low: [0.0, -0.05, -0.05], high: [0.03, 0.0, 0.0] };
    assert_eq!(nodes_in(&mesh, &corner).len(), 2 * 3 * 3);
}

#[test]
fn meshes_that_cannot_be_are_refused() {
    let nodes = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let new = |nodes: &[[f64; 3]], list| TetMesh::new(nodes.to_vec(), Elements::Linear(list));
    let outside = MeshError::NodeOutOfRange { element: 0, node: 3, count: 3 };
    assert_eq!(new(&nodes, vec![[0, 1, 2, 3]]), Err(outside));
    assert_eq!(new(&nodes, Vec::new()), Err(MeshError::NoElements));
    let wild = [nodes, vec![[0.0, f64::NAN, 0.0]]].concat();
    assert!(matches!(new(&wild, vec![[0, 1, 2, 3]]), Err(MeshError::NotFinite { node: 3, .. })));
}

/// Largest difference of node numbers within an element.
fn bandwidth(mesh: &TetMesh) -> u32 {
    let span = |index: usize| {
        let nodes = mesh.elements.nodes(index);
        nodes.iter().max().unwrap() - nodes.iter().min().unwrap()
    };
    (0..mesh.elements.len()).map(span).max().unwrap()
}

#[test]
fn renumbering_keeps_the_body_and_narrows_the_band() {
    let shape = Ring { inner_radius: 0.02, outer_radius: 0.03, width: 0.015 };
    let counts = RingMesh { around: 40, radial: 3, axial: 3, radial_growth: 1.0 };
    let solid = ring(&shape, &counts).unwrap();
    for mesh in [solid.mesh.clone(), solid.quadratic().unwrap().mesh] {
        let sorted = reverse_cuthill_mckee(mesh.clone());
        let new = &sorted.mesh;
        assert!(bandwidth(new) * 2 < bandwidth(&mesh), "{} {}", bandwidth(new), bandwidth(&mesh));
        for (old, &to) in sorted.node.iter().enumerate() {
            assert_eq!(mesh.nodes[old], new.nodes[to as usize]);
        }
        for (old, &to) in sorted.element.iter().enumerate() {
            let moved: Vec<u32> =
                mesh.elements.nodes(old).iter().map(|&n| sorted.node[n as usize]).collect();
            assert_eq!(moved, new.elements.nodes(to as usize));
        }
        for (name, faces) in &new.surface_sets {
            let area = total_area(&mesh, &mesh.surface_sets[name]);
            assert!((total_area(new, faces) / area - 1.0).abs() <= 1e-12, "{name}");
            assert_eq!(new.nodes_of_faces(faces), new.node_sets[name], "{name}");
        }
        let lowest = |i: usize| new.elements.nodes(i).iter().min().copied();
        assert!((1..new.elements.len()).all(|i| lowest(i - 1) <= lowest(i)));
        assert_eq!(reverse_cuthill_mckee(mesh.clone()).mesh, *new, "the same every time");
    }
}

#[test]
fn neighbours_share_an_element() {
    let mesh = cube(3);
    let neighbours = node_neighbours(&mesh);
    for node in 0..mesh.nodes.len() as u32 {
        let through: BTreeSet<u32> = (0..mesh.elements.len())
            .map(|element| mesh.elements.nodes(element))
            .filter(|nodes| nodes.contains(&node))
            .flatten()
            .copied()
            .filter(|&other| other != node)
            .collect();
        assert!(through.iter().eq(neighbours.of(node as usize)), "{node}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Measures of quality and the faults found do not depend on the unit of length.
    #[test]
    fn quality_is_free_of_scale(
        scale in prop::sample::select(vec![1e-3, 1e3, 0.7]),
        shifts in prop::collection::vec(-0.012f64..0.012, 64 * 3),
    ) {
        let mut mesh = cube(3);
        for (node, shift) in mesh.nodes.iter_mut().zip(shifts.chunks(3)) {
            for axis in 0..3 {
                node[axis] += shift[axis];
            }
        }
        let (before, after) = (quality(&mesh), quality(&mesh.clone().scaled(scale)));
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs();
        prop_assert!(same(before.aspect.value, after.aspect.value));
        prop_assert!(same(before.radius_ratio.value, after.radius_ratio.value));
        prop_assert!(same(before.least_dihedral.value, after.least_dihedral.value));
        prop_assert!(same(before.greatest_dihedral.value, after.greatest_dihedral.value));
        prop_assert!(same(before.total_volume * scale.powi(3), after.total_volume));
        prop_assert_eq!(before.aspect.element, after.aspect.element);
        let names = |mesh: &TetMesh| found(mesh).iter().map(std::mem::discriminant).collect::<Vec<_>>();
        prop_assert_eq!(names(&mesh), names(&mesh.clone().scaled(scale)));
    }
}
