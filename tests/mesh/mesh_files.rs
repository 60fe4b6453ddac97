//! Files that Gmsh wrote, read back; files of our own; and files that are wrong, each refused with
//! what, where and what to do.

use bearing_dynamics::mesh::check::{Limits, check};
use bearing_dynamics::mesh::generate::{Ring, RingMesh, bar, ring};
use bearing_dynamics::mesh::measure::{total_area, total_volume};
use bearing_dynamics::mesh::read::{
    LengthUnit, Loaded, Note, Place, Problem, ReadError, read_abaqus, read_gmsh,
};
use bearing_dynamics::mesh::topology::surface;
use bearing_dynamics::mesh::write::{write_abaqus, write_gmsh};
use bearing_dynamics::mesh::{Face, MeshError, Order, TetMesh};
use std::f64::consts::PI;
use std::fs;
use std::path::PathBuf;

fn data(name: &str) -> Vec<u8> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh").join(name);
    fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn read(name: &str) -> Loaded {
    let reader = if name.ends_with(".inp") { read_abaqus } else { read_gmsh };
    reader(&data(name), LengthUnit::Millimetre).unwrap_or_else(|error| panic!("{name}: {error}"))
}

const FORMS: [&str; 5] = ["v41.msh", "v41_binary.msh", "v22.msh", "v22_binary.msh", ".inp"];

fn file(body: &str, order: usize, form: &str) -> String {
    let join = if form.starts_with('.') { "" } else { "_" };
    format!("{body}_o{order}{join}{form}")
}

fn off(found: f64, exact: f64) -> f64 {
    ((found - exact) / exact).abs()
}

fn sound(mesh: &TetMesh, name: &str) {
    if let Err(faults) = check(mesh, &Limits::default()) {
        panic!("{name}: {faults}");
    }
}

#[test]
fn a_box_from_gmsh_in_every_form() {
    for order in [1, 2] {
        for form in FORMS {
            let name = file("box", order, form);
            let Loaded { mesh, notes, .. } = read(&name);
            assert_eq!(notes, [], "{name}");
            sound(&mesh, &name);
            let (nodes, kind) =
                if order == 1 { (40, Order::Linear) } else { (207, Order::Quadratic) };
            assert_eq!((mesh.nodes.len(), mesh.elements.len()), (nodes, 90), "{name}");
            assert_eq!(mesh.order(), kind);
            // Text forms print 16 digits, the input deck 14.
            assert!(off(total_volume(&mesh), 6e-6) <= 1e-12, "{name}");
            let whole = 2.0 * (6e-4 + 3e-4 + 2e-4);
            assert!(off(total_area(&mesh, &surface(&mesh)), whole) <= 1e-12, "{name}");
            for (set, x) in [("clamped", 0.0), ("loaded", 30e-3)] {
                let faces = mesh.surface_set(set).unwrap();
                assert!(off(total_area(&mesh, faces), 2e-4) <= 1e-12, "{name}");
                let at_x = |&&n: &&u32| (mesh.nodes[n as usize][0] - x).abs() <= 1e-12;
                let nodes = mesh.node_set(set).unwrap();
                assert_eq!(nodes.iter().filter(at_x).count(), nodes.len(), "{name}");
                assert_eq!(nodes, mesh.nodes_of_faces(faces), "{name}");
            }
            let body = if form == ".inp" { "steel_body" } else { "steel body" };
            assert_eq!(mesh.element_set(body).unwrap().len(), 90, "{name}");
            let corner = mesh.node_set("corner").unwrap();
            assert_eq!(corner.len(), 1);
            let place = mesh.nodes[corner[0] as usize];
            assert!(place.iter().zip([0.0, 0.0, 0.01]).all(|(a, b)| (a - b).abs() <= 1e-15));
        }
    }
}

#[test]
fn a_ring_from_gmsh_in_every_form() {
    let exact = PI * (0.02f64.powi(2) - 0.012f64.powi(2)) * 0.01;
    for form in FORMS {
        let name = file("ring", 1, form);
        let Loaded { mesh, .. } = read(&name);
        sound(&mesh, &name);
        assert!(off(total_volume(&mesh), 8031.238064854431 * 1e-9) <= 1e-12, "{name}");

        let name = file("ring", 2, form);
        let Loaded { mesh, .. } = read(&name);
        sound(&mesh, &name);
        // Mid-side nodes on the cylinders: 20 chords' error of the straight mesh all but gone.
        assert!(off(total_volume(&mesh), exact) <= 1e-3, "{name}: {}", total_volume(&mesh) / exact);
        let bore = mesh.surface_set("bore").unwrap();
        assert!(off(total_area(&mesh, bore), 2.0 * PI * 0.012 * 0.01) <= 2e-3, "{name}");
        let radius = |&n: &u32| mesh.nodes[n as usize][1].hypot(mesh.nodes[n as usize][2]);
        assert!(mesh.node_set("bore").unwrap().iter().all(|n| off(radius(n), 0.012) <= 1e-12));
    }
}

#[test]
fn all_forms_of_a_mesh_are_the_same_mesh() {
    for (body, order) in [("box", 1), ("box", 2), ("ring", 1), ("ring", 2)] {
        let first = read(&file(body, order, FORMS[0])).mesh;
        for form in &FORMS[1..4] {
            let other = read(&file(body, order, form)).mesh;
            assert_eq!(first.elements, other.elements, "{body} {order} {form}");
            assert_eq!(first.node_sets, other.node_sets, "{body} {order} {form}");
            assert_eq!(first.surface_sets, other.surface_sets, "{body} {order} {form}");
            let farthest = first.nodes.iter().flatten().zip(other.nodes.iter().flatten());
            assert!(farthest.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) <= 1e-16);
        }
    }
}

#[test]
fn an_input_deck_of_ours_reads_back() {
    let solid = ring(
        &Ring { inner_radius: 0.01, outer_radius: 0.02, width: 0.01 },
        &RingMesh { around: 10, radial: 2, axial: 2, radial_growth: 1.0 },
    )
    .unwrap();
    for mut mesh in [solid.mesh.clone(), solid.quadratic().unwrap().mesh] {
        mesh.element_sets.insert("some".into(), vec![3, 5, 9]);
        let text = write_abaqus(&mesh).unwrap();
        let mut back = read_abaqus(text.as_bytes(), LengthUnit::Metre).unwrap().mesh;
        assert_eq!(back.node_sets.remove("all_nodes").unwrap().len(), mesh.nodes.len());
        assert_eq!(back.element_sets.remove("all_elements").unwrap().len(), mesh.elements.len());
        // CalculiX reads 20 characters a number: at worst the seventeenth digit is lost.
        for (found, exact) in back.nodes.as_flattened().iter().zip(mesh.nodes.as_flattened()) {
            assert!((found - exact).abs() <= 1e-16 * mesh.size().max(1.0), "{found:e} {exact:e}");
        }
        let numbers = text.lines().flat_map(|line| line.split(", "));
        assert!(numbers.filter(|word| word.parse::<f64>().is_ok()).all(|word| word.len() <= 20));
        back.nodes = mesh.nodes.clone();
        assert_eq!(back, mesh);
        // What was read can be written and read again without any change.
        let once = read_abaqus(text.as_bytes(), LengthUnit::Metre).unwrap().mesh;
        let text = write_abaqus(&once).unwrap();
        assert_eq!(read_abaqus(text.as_bytes(), LengthUnit::Metre).unwrap().mesh, once);
    }
    let mut mesh = solid.mesh;
    mesh.node_sets.insert("two words".into(), vec![0]);
    assert!(matches!(write_abaqus(&mesh), Err(MeshError::Name { .. })));
}

#[test]
fn gmsh_files_of_our_own() {
    let body = Ring { inner_radius: 0.0312, outer_radius: 0.0371, width: 0.0123 };
    let cells = RingMesh { around: 9, radial: 2, axial: 2, radial_growth: 1.3 };
    let solid = ring(&body, &cells).unwrap();
    for mut mesh in [solid.mesh.clone(), solid.quadratic().unwrap().mesh] {
        let count = mesh.elements.len() as u32;
        // Sets that overlap: the corner is in both, as are elements in the middle.
        mesh.node_sets.insert("some nodes".into(), vec![0, 3, 7]);
        mesh.node_sets.insert("corner".into(), vec![0]);
        mesh.element_sets.insert("front".into(), (0..2 * count / 3).collect());
        mesh.element_sets.insert("back".into(), (count / 3..count).collect());
        let text = write_gmsh(&mesh).unwrap();
        let Loaded { mesh: back, notes, .. } =
            read_gmsh(text.as_bytes(), LengthUnit::Metre).unwrap();
        assert_eq!(notes, []);
        assert_eq!((&back.nodes, &back.node_sets), (&mesh.nodes, &mesh.node_sets));
        // Elements come entity by entity: front alone, back alone, both; sets keep their members.
        assert_eq!(back.elements.len(), mesh.elements.len());
        let members = |mesh: &TetMesh, name: &str| {
            let set = mesh.element_set(name).unwrap();
            let mut nodes: Vec<_> = set.iter().map(|e| mesh.elements.nodes(*e as usize)).collect();
            nodes.sort_unstable();
            nodes.concat()
        };
        for name in ["front", "back"] {
            assert_eq!(members(&back, name), members(&mesh, name));
        }
        assert_eq!(back.surface_sets.len(), mesh.surface_sets.len());
        for (name, faces) in &mesh.surface_sets {
            let nodes = |mesh: &TetMesh, faces: &[Face]| {
                let of = |face: &Face| {
                    let mut nodes: Vec<u32> = mesh.face_nodes(*face).collect();
                    nodes.sort_unstable();
                    nodes
                };
                let mut faces: Vec<_> = faces.iter().map(of).collect();
                faces.sort_unstable();
                faces
            };
            assert_eq!(nodes(&back, &back.surface_sets[name]), nodes(&mesh, faces), "{name}");
        }
        // What was read can be written and read again without any change.
        let again = write_gmsh(&back).unwrap();
        assert_eq!(read_gmsh(again.as_bytes(), LengthUnit::Metre).unwrap().mesh, back);
    }
    let refused = |change: fn(&mut TetMesh)| {
        let mut mesh = solid.mesh.clone();
        change(&mut mesh);
        assert!(matches!(write_gmsh(&mesh), Err(MeshError::Name { .. })));
    };
    refused(|mesh| drop(mesh.node_sets.insert("a \"quote\"".into(), vec![0])));
    refused(|mesh| drop(mesh.node_sets.insert("inner".into(), vec![0])));
}

/// One tetrahedron and its sets, as a person would type them.
const DECK: &str = "*Heading
 a tetrahedron
*Node, nset=everything
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
7, 0., 0., 1.
**
*Element, type=C3D4, elset=body
11, 1, 2,
3, 7
*Nset, nset=base, generate
1, 3, 1
*Nset, nset=more
base, 7
*Elset, elset=again
body
*Surface, name=floor, type=ELEMENT
body, S1
*Surface, name=skin
again,
*Material, name=steel
*Elastic
210e9, 0.3
";

fn deck(from: &str, to: &str) -> ReadError {
    assert!(DECK.contains(from), "{from}");
    let text = DECK.replacen(from, to, 1);
    read_abaqus(text.as_bytes(), LengthUnit::Metre).expect_err("this deck is wrong")
}

#[test]
fn a_typed_input_deck() {
    let Loaded { mesh, notes, numbers, .. } =
        read_abaqus(DECK.as_bytes(), LengthUnit::Metre).unwrap();
    assert_eq!(mesh.node_set("everything").unwrap(), [0, 1, 2, 3]);
    assert_eq!(mesh.node_set("base").unwrap(), [0, 1, 2]);
    assert_eq!(mesh.node_set("more").unwrap(), [0, 1, 2, 3]);
    assert_eq!(mesh.surface_set("skin").unwrap().len(), 4);
    let floor = mesh.surface_set("floor").unwrap();
    assert_eq!((floor.len(), mesh.node_set("floor").unwrap()), (1, &[0, 1, 2][..]));
    let said: Vec<String> = notes.iter().map(Note::to_string).collect();
    assert_eq!((numbers.nodes, numbers.elements), (vec![1, 2, 3, 7], vec![11]));
    assert_eq!(said, ["*ELASTIC was skipped (1 times)", "*MATERIAL was skipped (1 times)"]);
}

/// In files of version 2 a negative physical number stands for an element turned round: of the same group.
#[test]
fn negative_groups_of_gmsh_are_the_same_groups() {
    let text = String::from_utf8(data("box_o1_v22.msh")).unwrap();
    let line = "\n2 2 2 2 1 2 1 22\n";
    assert!(text.contains(line));
    let turned = text.replacen(line, "\n2 2 2 -2 1 2 1 22\n", 1);
    let [own, other] = [&text, &turned].map(|text| {
        let Loaded { mesh, .. } = read_gmsh(text.as_bytes(), LengthUnit::Metre).unwrap();
        mesh.surface_set("clamped").unwrap().to_vec()
    });
    assert_eq!(own, other);
}

/// A surface of elements without sides is their free faces: not the one between two.
#[test]
fn a_surface_of_elements_without_sides_is_what_lies_outside() {
    let text = DECK.replacen("7, 0., 0., 1.\n", "7, 0., 0., 1.\n8, 1., 1., 1.\n", 1).replacen(
        "3, 7\n",
        "3, 7\n12, 2, 3, 7, 8\n",
        1,
    );
    let Loaded { mesh, .. } = read_abaqus(text.as_bytes(), LengthUnit::Metre).unwrap();
    let skin = mesh.surface_set("skin").unwrap();
    assert_eq!((mesh.element_sets["again"].len(), skin.len()), (2, 6));
}

/// Triangles and lines that a set of elements names, among tetrahedra or alone, are its surface and its nodes.
#[test]
fn sets_of_a_deck_may_name_lines_and_triangles() {
    let further = "*Element, type=T3D2, elset=edge\n21, 2, 7\n*Element, type=B31\n22, 3, 7\n\
                   *Element, type=S3, elset=sail\n31, 1, 2, 7\n*Elset, elset=mixed\n11, 22\n*Elset, elset=all\nsail, 22\n*Material, name=steel\n";
    let text = DECK.replacen("*Material, name=steel\n", further, 1);
    let Loaded { mesh, .. } = read_abaqus(text.as_bytes(), LengthUnit::Metre).unwrap();
    assert_eq!(mesh.node_set("edge").unwrap(), [1, 3]);
    assert_eq!(mesh.node_set("mixed").unwrap(), [2, 3]);
    assert_eq!(mesh.surface_set("sail").unwrap().len(), 1);
    assert_eq!(mesh.node_set("sail").unwrap(), [0, 1, 3]);
    assert_eq!(mesh.surface_set("all").unwrap(), mesh.surface_set("sail").unwrap());
    assert_eq!(mesh.node_set("all").unwrap(), [0, 1, 2, 3]);
    let of_elements: Vec<&str> = mesh.element_sets.keys().map(String::as_str).collect();
    assert_eq!(of_elements, ["again", "body", "mixed"]);
}

/// Lines behind the first are a material's constants at other temperatures.
#[test]
fn a_deck_has_the_constants_of_its_first_temperature() {
    let constants = "210e9, 0.3, 20.\n180e9, 0.35, 400.\n*Density\n7850., 20.\n7700., 400.\n";
    let text = DECK.replacen("210e9, 0.3\n", constants, 1);
    let Loaded { materials, .. } = read_abaqus(text.as_bytes(), LengthUnit::Metre).unwrap();
    assert_eq!(materials.len(), 1);
    assert_eq!((materials[0].elastic, materials[0].density), (Some([210e9, 0.3]), Some(7850.0)));
}

/// Fault of a set that is used.
fn fault_of(set: &str, from: &str, to: &str) -> ReadError {
    assert!(DECK.contains(from), "{from}");
    let text = DECK.replacen(from, to, 1);
    let read = || read_abaqus(text.as_bytes(), LengthUnit::Metre).unwrap();
    // Unused, it is skipped with one line.
    let mut unused = read();
    unused.use_sets(&[]).unwrap();
    let skipped = |note: &&Note| matches!(note, Note::SetsSkipped { names, .. } if names.iter().any(|name| name.eq_ignore_ascii_case(set)));
    assert_eq!(unused.notes.iter().filter(skipped).count(), 1, "{:?}", unused.notes);
    read().use_sets(&[set]).expect_err("this set is wrong")
}

#[test]
fn wrong_input_decks_are_placed() {
    let line =
        |error: &ReadError, expected| assert_eq!(error.place, Place::Line(expected), "{error}");
    for wrong in ["2, 1., nan, 0.", "2, 1., 1D, 0.", "2, 1., x, 0.", "2, 1., 1e999, 0.", "2, inf"] {
        let error = deck("2, 1., 0., 0.", wrong);
        assert!(matches!(error.problem, Problem::Number { .. }), "{error}");
        line(&error, 5);
    }
    let error = deck("7, 0., 0., 1.", "3, 0., 0., 1.");
    assert_eq!(error.problem, Problem::Duplicate { kind: "node", tag: 3 });
    line(&error, 7);
    let error = deck("3, 7\n", "3, 8\n");
    assert_eq!(error.problem, Problem::UnknownNode { element: 11, node: 8 });
    line(&error, 10);
    let error = deck("3, 7\n", "\n");
    assert!(matches!(error.problem, Problem::Truncated { .. }), "{error}");
    let error = deck("3, 7\n", "3, 3\n");
    assert_eq!(error.problem, Problem::RepeatedNode { element: 11, node: 3 });
    for found in ["C3D8", "C3D20R", "C3D6", "SC6R"] {
        let error = deck("C3D4", found);
        assert!(matches!(error.problem, Problem::ElementType { .. }), "{error}");
        line(&error, 9);
        let said = error.to_string();
        assert!(said.contains(&format!("{found} are not supported; mesh with tetra")), "{said}");
    }
    let error = deck("C3D4", "S4");
    assert!(matches!(error.problem, Problem::NoTetrahedra { .. }), "{error}");
    assert!(!error.to_string().contains("Gmsh"), "{error}");
    let error =
        deck("*Nset, nset=base", "*Element, type=C3D10\n12,1,2,3,7,1,2,3,7,1,2\n*Nset, nset=base");
    assert_eq!(error.problem, Problem::MixedOrders { first: 4, this: 10 });
    for (from, to) in [
        ("*Heading", "*Include, input=other.inp"),
        ("*Heading", "*Node, input=other.inp"),
        ("*Heading", "*Part, name=a\n*End Part\n*Part, name=b"),
        ("*Heading", "*Instance, name=a, part=b\n1., 0., 0."),
        ("*Node", "*Part, name=a\n*End Part\n*Assembly\n*Node"),
    ] {
        let error = deck(from, to);
        assert!(matches!(error.problem, Problem::Unsupported { .. }), "{error}");
    }
}

#[test]
fn wrong_sets_of_decks_are_placed_if_they_are_used() {
    let at =
        |error: &ReadError, expected| assert_eq!(error.place, Place::Line(expected), "{error}");
    let error = fault_of("more", "base, 7", "bas, 7");
    assert_eq!(error.problem, Problem::UnknownSet { name: "bas".into() });
    at(&error, 15);
    let error = fault_of("more", "nset=more", "nset=more, instance=p-1");
    assert_eq!(error.problem, Problem::UnknownSet { name: "P-1".into() });
    for wrong in ["1, 3, 0", "3, 1, 1", "1, a", "1, -3"] {
        let error = fault_of("base", "1, 3, 1", wrong);
        assert!(matches!(error.problem, Problem::Number { .. }), "{error}");
        at(&error, 13);
    }
    let error = fault_of("floor", "body, S1", "body, S5");
    assert!(matches!(error.problem, Problem::Number { .. }), "{error}");
    at(&error, 19);
    let error = fault_of("floor", "type=ELEMENT", "type=cutting surface");
    assert!(matches!(error.problem, Problem::Unsupported { .. }), "{error}");
    at(&error, 18);
    let error = fault_of("more", "base, 7", "8, 9");
    assert_eq!(error.problem, Problem::NoMembers { set: "more".into() });
    at(&error, 14);
    let error = fault_of(
        "loose",
        "*Surface, name=floor",
        "*Element, type=S3, elset=loose\n12, 1, 2, 9\n*Surface, name=floor",
    );
    assert!(matches!(error.problem, Problem::LooseFace { .. }), "{error}");
    at(&error, 18);
    let error =
        fault_of("a", "*Nset, nset=more", "*Nset, nset=a\nb\n*Nset, nset=b\na\n*Nset, nset=more");
    assert!(matches!(error.problem, Problem::Circular { .. }), "{error}");
    // A node set and a surface of one name and other nodes.
    let error = fault_of("floor", "nset=more", "nset=Floor");
    assert!(matches!(error.problem, Problem::TwoSets { .. }), "{error}");
    // A name may be written in any case, and is then found.
    let mut loaded = read_abaqus(DECK.as_bytes(), LengthUnit::Metre).unwrap();
    loaded.use_sets(&["FLOOR", "Base", "more"]).unwrap();
    assert_eq!(loaded.mesh.node_set("Base").unwrap(), [0, 1, 2]);
    assert_eq!(loaded.mesh.surface_set("FLOOR").unwrap().len(), 1);
}

/// Members that the deck does not define are left out with a line of their own, however far a range goes.
#[test]
fn members_beyond_the_mesh_are_left_out() {
    for (from, to, set, nodes) in [
        ("base, 7", "base, 8, 9", "more", vec![0, 1, 2]),
        ("1, 3, 1", "2, 4000000000, 1", "base", vec![1, 2, 3]),
        ("1, 3, 1", "1, 18446744073709551615, 2", "base", vec![0, 2, 3]),
    ] {
        let text = DECK.replacen(from, to, 1);
        let Loaded { mesh, notes, .. } = read_abaqus(text.as_bytes(), LengthUnit::Metre).unwrap();
        assert_eq!(mesh.node_set(set).unwrap(), nodes);
        let noted = notes.iter().any(|note| {
            matches!(note, Note::Missing { set, count: 2, first: 8, place: Place::Line(15), .. } if set == "more")
        });
        assert_eq!(noted, to.starts_with("base"), "{notes:?}");
    }
}

/// A set that names itself is as it was; sets that repeat others use no memory without limit.
#[test]
fn sets_cannot_grow_without_limit() {
    let doubling = DECK.replacen("base, 7", &format!("base, 7\n{}", "more, more\n".repeat(60)), 1);
    let mesh = read_abaqus(doubling.as_bytes(), LengthUnit::Metre).unwrap().mesh;
    assert_eq!(mesh.node_set("more").unwrap(), [0, 1, 2, 3]);
    let nodes: String = (10..2000).map(|node| format!("{node}\n")).collect();
    let sets: String = (0..500).map(|set| format!("*nset,nset={set}a\ne\n")).collect();
    let text = format!("{}*node,nset=e\n{nodes}{sets}", DECK);
    let error = read_abaqus(text.as_bytes(), LengthUnit::Metre).unwrap_err();
    assert!(matches!(error.problem, Problem::TooManyMembers { .. }), "{error}");
    // A chain of sets is no stack without end.
    let chain: String = (0..30_000).map(|i| format!("*nset,nset=c{i}\nc{}\n", i + 1)).collect();
    let mut loaded = read_abaqus(format!("{DECK}{chain}").as_bytes(), LengthUnit::Metre).unwrap();
    assert!(matches!(loaded.use_sets(&["c0"]).unwrap_err().problem, Problem::Circular { .. }));
}

/// Elements of another formulation on the same nodes.
#[test]
fn variants_of_tetrahedra_are_read_with_a_note() {
    for found in ["C3D4H", "DC3D4", "c3d4t"] {
        let text = DECK.replacen("C3D4", found, 1);
        let notes = read_abaqus(text.as_bytes(), LengthUnit::Metre).unwrap().notes;
        let note = Note::ReadAs { found: found.to_uppercase(), read: "C3D4" };
        assert_eq!(notes.iter().filter(|other| **other == note).count(), 1, "{notes:?}");
    }
    let text = String::from_utf8(data("box_o2.inp")).unwrap();
    for found in ["C3D10MH", "C3D10M", "C3D10H", "C3D10HS", "C3D10I"] {
        let text = text.replace("type=C3D10", &format!("type={found}"));
        assert!(text.contains(found));
        let mesh = read_abaqus(text.as_bytes(), LengthUnit::Millimetre).unwrap().mesh;
        assert_eq!(mesh, read("box_o2.inp").mesh, "{found}");
    }
}

fn gmsh_error(bytes: &[u8]) -> ReadError {
    read_gmsh(bytes, LengthUnit::Millimetre).expect_err("this file is wrong")
}

fn box_text(from: &str, to: &str) -> ReadError {
    let text = String::from_utf8(data("box_o1_v41.msh")).unwrap();
    assert!(text.contains(from), "{from}");
    gmsh_error(text.replacen(from, to, 1).as_bytes())
}

#[test]
fn wrong_gmsh_files_are_placed() {
    assert_eq!(gmsh_error(b" \n").problem, Problem::Empty);
    assert!(matches!(gmsh_error(b"solid cube").problem, Problem::OtherFormat { .. }));
    let error = box_text("4.1 0 8", "4 0 8");
    assert_eq!(
        (error.place, error.problem),
        (Place::Line(2), Problem::Version { found: "4".into() })
    );
    let error = box_text("$Elements", "$Other");
    assert!(
        matches!(error.problem, Problem::Truncated { .. } | Problem::MissingSection { .. }),
        "{error}"
    );
    let error = box_text("$EndNodes", "17\n$EndNodes");
    assert!(matches!(error.problem, Problem::Expected { .. }), "{error}");
    // A header that claims two thousand million nodes.
    let text = String::from_utf8(data("box_o1_v41.msh")).unwrap();
    let counts = text.lines().skip_while(|line| *line != "$Nodes").nth(1).unwrap().to_string();
    let claim = counts.replacen(" 40 ", " 2000000000 ", 1);
    assert_ne!(counts, claim);
    let error = box_text(&counts, &claim);
    assert!(matches!(error.problem, Problem::Count { claimed: 2_000_000_000, .. }), "{error}");
    // A lie that the file is long enough for.
    let error = box_text(&counts, &counts.replacen(" 40 ", " 41 ", 1));
    assert!(matches!(error.problem, Problem::Expected { .. }), "{error}");
    for (name, count) in [("box_o1_v22.msh", "\n40\n"), ("box_o1_v22_binary.msh", "\n40\n")] {
        let bytes = data(name);
        let at = bytes.windows(4).position(|w| w == count.as_bytes()).unwrap();
        let longer = [&bytes[..at], b"\n2000000000\n", &bytes[at + 4..]].concat();
        let error = gmsh_error(&longer);
        assert!(matches!(error.problem, Problem::Count { claimed: 2_000_000_000, .. }), "{error}");
    }
}

/// Every cut of a file must be refused, and say that it was cut or what is missing.
#[test]
fn truncated_files_are_refused() {
    for form in FORMS {
        let bytes = data(&file("box", 1, form));
        let reader = if form == ".inp" { read_abaqus } else { read_gmsh };
        let whole = reader(&bytes, LengthUnit::Millimetre).unwrap();
        let end = bytes.trim_ascii_end().len();
        for length in 0..end {
            match reader(&bytes[..length], LengthUnit::Millimetre) {
                Err(error) => assert!(!error.to_string().contains('\n'), "{error:?}"),
                // An input deck has no end mark: cut within its last sets it is whole but for them.
                Ok(part) => {
                    assert_eq!(form, ".inp", "{length} of {end} bytes");
                    assert_eq!(part.mesh.nodes, whole.mesh.nodes);
                }
            }
        }
    }
}

#[test]
fn binary_counts_are_not_believed() {
    let bytes = data("box_o1_v41_binary.msh");
    let start = bytes.windows(6).position(|w| w == b"$Nodes").unwrap() + 7;
    for (offset, count) in [(0, u64::MAX), (8, 2_000_000_000), (8, u64::MAX / 2)] {
        let mut wrong = bytes.clone();
        wrong[start + offset..start + offset + 8].copy_from_slice(&count.to_le_bytes());
        let error = gmsh_error(&wrong);
        assert!(
            matches!(error.problem, Problem::Count { claimed, .. } if claimed == count),
            "{error}"
        );
        assert!(matches!(error.place, Place::Byte(_)));
    }
}

#[test]
fn millimetres_read_as_metres_are_noticed() {
    let loaded = read_gmsh(&data("box_o1_v41.msh"), LengthUnit::Metre).unwrap();
    let said = loaded.notes[0].to_string();
    assert!(said.contains("size of 37.4166 m") && said.contains("0.0374166 m"), "{said}");
    let small = write_abaqus(&bar([0.1, 0.01, 0.01], [4, 1, 1]).unwrap().mesh).unwrap();
    let loaded = read_abaqus(small.as_bytes(), LengthUnit::Millimetre).unwrap();
    assert!(matches!(loaded.notes[..], [Note::UnlikelySize { .. }]), "{:?}", loaded.notes);
}

/// Nodes of a file may come with their parameters on the entity: one on a curve, two on a surface, three in a
/// volume.
#[test]
fn parameters_of_nodes_are_passed_over() {
    let text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 1 1 1\n\
        1 0 0 0 1 0 0 0 0\n1 0 0 0 1 1 0 0 0\n1 0 0 0 1 1 1 1 7 0\n$EndEntities\n\
        $Nodes\n3 4 1 4\n\
        1 1 1 2\n1\n2\n0 0 0 0.1\n1 0 0 0.9\n\
        2 1 1 1\n3\n0 1 0 0.5 0.6\n\
        3 1 1 1\n4\n0 0 1 0.2 0.3 0.4\n$EndNodes\n\
        $Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n";
    let mesh = read_gmsh(text.as_bytes(), LengthUnit::Metre).unwrap().mesh;
    let places = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(mesh.nodes, places);
    assert_eq!(mesh.elements.len(), 1);
}

/// As Abaqus writes labels that are no plain words.
#[test]
fn names_in_quotes_are_names() {
    let text = DECK
        .replace("nset=more", "nset=\"more nodes\"")
        .replace("nset=base,", "nset = \"base\" ,")
        .replace("\nbase, 7", "\n\"base\", 7")
        .replace("name=floor", "name=\"floor\"");
    let mesh = read_abaqus(text.as_bytes(), LengthUnit::Metre).unwrap().mesh;
    assert_eq!(mesh.node_set("more nodes").unwrap(), [0, 1, 2, 3]);
    assert_eq!(mesh.node_set("base").unwrap(), [0, 1, 2]);
    assert_eq!(mesh.surface_set("floor").unwrap().len(), 1);
}
