//! Mesh files whose bores are not what they look like: straight edges, rounded coordinates, faces
//! off the cylinder. Fits are micrometres.

use crate::housed_command_common;

use bearing_dynamics::mesh::cylinder_fit::fit_cylinder;
use bearing_dynamics::mesh::generate::{Housing, HousingMesh};
use bearing_dynamics::mesh::quadratic::elevate;
use bearing_dynamics::mesh::write::write_gmsh;
use bearing_dynamics::mesh::{Order, TetMesh};
use housed_command_common::*;
use nalgebra::{UnitQuaternion, Vector3};
use serde_json::Value;
use std::fs;

const BORE: f64 = 35.527e-3;

pub fn annulus(around: usize, order: Order) -> TetMesh {
    let housing = Housing::Annulus { bore_radius: BORE, outer_radius: 50e-3, depth: 20e-3 };
    let cells = HousingMesh { around, radial: 1, axial: 2, radial_growth: 1.0 };
    let solid = housing.solid(&cells).unwrap();
    match order {
        Order::Linear => solid.mesh,
        Order::Quadratic => solid.quadratic().unwrap().mesh,
    }
}

/// A scene whose housing is this mesh, as a file.
pub fn with_mesh(place: &Place, mesh: &TetMesh, order: u32, further: &str) -> String {
    fs::write(place.path("housing.msh"), write_gmsh(mesh).unwrap()).unwrap();
    let made = RING.split("generate").nth(1).unwrap().split("order = 1").next().unwrap();
    let file = format!("file = \"housing.msh\"\nunit = \"m\"\norder = {order}");
    scene_text("", further).replace(&format!("generate{made}order = 1"), &file)
}

fn check(place: &Place, text: &str) -> (String, Value) {
    let scene = place.scene("scene.toml", text);
    let said = succeed(command("check", &scene, &[]));
    let echo = serde_json::from_str(&succeed(command("check", &scene, &["--json"]))).unwrap();
    (said, echo)
}

/// Message of a scene that must be refused with one line.
pub fn refused(place: &Place, text: &str) -> String {
    let output = command("check", &place.scene("scene.toml", text), &[]).output().unwrap();
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert_eq!(message.trim().lines().count(), 1, "{message}");
    message
}

fn seat(echo: &Value, name: &str) -> f64 {
    solids::number(&echo["seat"][name])
}

/// Places of the bore's nodes, changed.
pub fn reshaped(mut mesh: TetMesh, change: impl Fn([f64; 3]) -> [f64; 3]) -> TetMesh {
    for node in mesh.node_sets["bore"].clone() {
        let at = &mut mesh.nodes[node as usize];
        *at = change(*at);
    }
    mesh
}

/// Peak pressure (MPa) and place of the race along Z (um) in equilibrium.
fn equilibrium(place: &Place, name: &str, text: &str) -> [f64; 2] {
    let out = place.path(name);
    succeed(into_folder("statics", &place.scene("scene.toml", text), &out, &[]));
    let summary = json(out.join("summary.json"));
    let housing = &summary["housing"];
    let find = |name: &str| solids::number(&housing[name]);
    [find("peak_pressure"), solids::number(&housing["outer_race"]["z"])]
}

#[test]
fn a_four_node_file_raised_to_ten_has_a_round_bore() {
    let place = Place::new();
    let raised = with_mesh(&place, &annulus(24, Order::Linear), 2, "");
    let (said, echo) = check(&place, &raised);
    // 48 arcs of 15 degrees or less; the longest is R (1 - cos 7.5 deg) high.
    let height = 1e6 * BORE * (1.0 - (std::f64::consts::TAU / 48.0).cos());
    assert!(said.contains(&format!("up to {height:.1} um off their chords")), "{said}");
    assert!(said.contains("were put on the cylinder of radius 35.5270 mm"), "{said}");
    assert!(echo["mesh"]["notes"].to_string().contains("on the cylinder"), "{echo}");
    let plan = succeed(command("plan", &place.path("scene.toml"), &[]));
    assert!(plan.contains("on the cylinder"), "{plan}");
    // Decimal places of a file in metres, and the rounding of the fit.
    assert!((seat(&echo, "bore_radius") - BORE).abs() <= 1e-15, "{}", echo["seat"]);
    assert!(seat(&echo, "bore_out_of_round") <= 1e-15, "{}", echo["seat"]);
    assert!(echo["seat"]["caution"].is_null());
    // The generator's own ten-node mesh is round outside as well: straight edges take 3 % of the wall.
    let ours = equilibrium(&place, "raised", &raised);
    let made = scene_text("", "").replace("order = 1", "order = 2");
    let expected = equilibrium(&place, "made", &made);
    for (ours, expected) in ours.iter().zip(expected) {
        solids::assert_near(*ours, expected, 0.05);
    }
}

#[test]
fn a_bore_made_by_the_scene_is_round_as_well() {
    let place = Place::new();
    let mut mesh = annulus(24, Order::Linear);
    mesh.surface_sets.remove("bore");
    mesh.node_sets.remove("bore");
    let set = "[[solid.set]]\nname = \"bore\"\ncylinder = \"35.527 mm\"\n";
    let (said, echo) = check(&place, &with_mesh(&place, &mesh, 2, set));
    assert!(said.contains("on the cylinder"), "{said}");
    assert!(seat(&echo, "bore_out_of_round") <= 1e-15, "{}", echo["seat"]);
}

#[test]
fn straight_edges_are_refused_and_curved_ones_pass_at_any_fineness() {
    for around in [12, 24, 96] {
        let place = Place::new();
        let straight = elevate(&annulus(around, Order::Linear), &[]).unwrap().mesh;
        let message = refused(&place, &with_mesh(&place, &straight, 2, ""));
        let height = 1e6 * BORE * (1.0 - (std::f64::consts::PI / around as f64).cos());
        let figures =
            [format!("up to {height:.3} um inside"), format!("arc height of {height:.3} um")];
        for part in figures.iter().map(String::as_str).chain([
            "scene.toml:30:8: housing.bore: the element edges of \"bore\" are straight",
            "100 % of it is missing",
            "35.5270 mm",
            "Mesh.SecondOrderLinear = 0",
            "order = 2",
        ]) {
            assert!(message.contains(part), "{part}: {message}");
        }
        let curved = annulus(around, Order::Quadratic);
        let (said, echo) = check(&place, &with_mesh(&place, &curved, 2, ""));
        assert!(seat(&echo, "bore_out_of_round") <= 1e-15, "{}", echo["seat"]);
        assert!(!said.contains("caution"), "{said}");
    }
}

#[test]
fn rounded_coordinates_pass_with_a_caution_and_a_battered_bore_does_not() {
    let place = Place::new();
    // To 1e-4 mm: no node moves by more than 0.0708 um across the axis.
    let round = |x: f64| (x * 1e7).round() / 1e7;
    for order in [Order::Linear, Order::Quadratic] {
        let rounded = reshaped(annulus(24, order), |at| at.map(round));
        let nodes = if order == Order::Linear { 1 } else { 2 };
        let text = with_mesh(&place, &rounded, nodes, "");
        let (said, echo) = check(&place, &text);
        let off = seat(&echo, "bore_out_of_round");
        assert!(off > 0.02e-6 && off <= 0.0708e-6, "{off:e}");
        assert!(said.contains(&format!("{:.4} um out of round", 1e6 * off)), "{said}");
        // Penalty of the default seat: 2.5e14 N/m³.
        let load = format!("up to {:.3} MPa more", 2.5e8 * off);
        assert!(said.contains("  caution ") && said.contains(&load), "{said}");
        let out = place.path(&format!("{nodes}"));
        let solved = succeed(into_folder("statics", &place.path("scene.toml"), &out, &[]));
        assert!(solved.contains("note: caution: the bore is"), "{solved}");
        let summary = json(out.join("summary.json")).to_string();
        assert!(summary.contains("bore_out_of_round") && summary.contains(&load), "{summary}");
        // Pressed in by far more than that, the shape is small.
        let tight = text.replace("[housing]\n", "[housing]\nfit.radial = \"20 um\"\n");
        assert!(check(&place, &tight).1["seat"]["caution"].is_null());
    }
    // Every node above the axis 60 um outwards: an oval, 30 um off a shifted cylinder at most.
    let oval = reshaped(annulus(24, Order::Linear), |[x, y, z]| [x, y, z * (1.0 + 60e-6 / BORE)]);
    let message = refused(&place, &with_mesh(&place, &oval, 1, ""));
    let off = ["up to 30.0", "up to 29.9"].iter().any(|figure| message.contains(figure));
    assert!(off, "{message}");
    for part in ["scene.toml:25:2: housing.bore: nodes of \"bore\" are up to", "17.7", "IT7"] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn a_bore_out_of_centre_keeps_its_radius() {
    let place = Place::new();
    let moved = reshaped(annulus(24, Order::Linear), |[x, y, z]| [x, y + 0.3e-3, z]);
    let (_, echo) = check(&place, &with_mesh(&place, &moved, 1, ""));
    // About the race's axis its mean radius would be 0.6 um larger.
    assert!((seat(&echo, "bore_radius") - BORE).abs() <= 1e-12, "{}", echo["seat"]);
    assert!((seat(&echo, "bore_off_centre") - 0.3e-3).abs() <= 1e-12, "{}", echo["seat"]);
    assert!(seat(&echo, "bore_out_of_round") <= 1e-12, "{}", echo["seat"]);
}

#[test]
fn a_tilted_half_of_a_cylinder_is_found() {
    let turn = UnitQuaternion::from_euler_angles(0.3, 0.01, -0.02);
    let shift = Vector3::new(5e-3, 2e-3, -1e-3);
    let mut places = Vec::new();
    for i in 0..40 {
        let angle = f64::from(i) * std::f64::consts::PI / 39.0;
        for x in [-10e-3, 1e-3, 7e-3] {
            places.push(turn * Vector3::new(x, BORE * angle.cos(), BORE * angle.sin()) + shift);
        }
    }
    let found = fit_cylinder(&places, Vector3::x()).unwrap();
    assert!((found.radius - BORE).abs() <= 1e-13, "{found:?}");
    assert!((found.outside(shift) + BORE).abs() <= 1e-13, "{found:?}");
    assert!((found.axis - turn * Vector3::x()).norm() <= 1e-11, "{found:?}");
    assert!(places.iter().all(|place| found.outside(*place).abs() <= 1e-13));
    // In one plane nothing tells of a tilt.
    let ring: Vec<_> = (0..12)
        .map(|i| f64::from(i) * 0.5)
        .map(|angle| Vector3::new(0.0, BORE * angle.cos(), BORE * angle.sin()))
        .collect();
    let flat = fit_cylinder(&ring, Vector3::x()).unwrap();
    assert!((flat.radius - BORE).abs() <= 1e-13, "{flat:?}");
    assert!((flat.axis - Vector3::x()).norm() <= 1e-12, "{flat:?}");
    assert!(fit_cylinder(&ring[..2], Vector3::x()).is_none());
}

/// A pillow block as drawn, its bore somewhere and along Y, is put in its place by the scene.
#[test]
fn a_bore_anywhere_along_any_axis_is_put_in_its_place() {
    let place = Place::new();
    let mesh = annulus(24, Order::Linear);
    let printed = |text: &str| {
        let scene = place.scene("scene.toml", text);
        let said = succeed(command("statics", &scene, &["--dry"]));
        // The tables: what is said below names one of several nodes that are equal by symmetry.
        said.lines().filter(|line| line.starts_with(' ')).collect::<Vec<_>>().join("\n")
    };
    let straight = printed(&with_mesh(&place, &mesh, 1, ""));
    let origin = [0.0, 30e-3, 65e-3];
    let drawn = TetMesh {
        nodes: mesh
            .nodes
            .iter()
            .map(|[x, y, z]| [origin[0] + z, origin[1] + x, origin[2] + y])
            .collect(),
        ..mesh
    };
    let text = with_mesh(&place, &drawn, 1, "");
    let message = refused(&place, &text);
    assert!(message.contains("housing.bore"), "{message}");
    let put = text.replace(
        "unit = \"m\"",
        "unit = \"m\"\norigin = [\"0 mm\", \"30 mm\", \"65 mm\"]\naxis = \"y\"",
    );
    let moved = printed(&put);
    let mut numbers = 0;
    assert_eq!(straight.lines().count(), moved.lines().count());
    for (one, other) in straight.split_whitespace().zip(moved.split_whitespace()) {
        let (Ok(a), Ok(b)) = (one.parse::<f64>(), other.parse::<f64>()) else { continue };
        // Nodes are rounded to 1e-17 m where they lie 0.1 m off, overlaps are 1e-7 m: 1e-10, and the last
        // digit that is printed.
        assert!((a - b).abs() <= 2e-6 * a.abs().max(1.0), "{one} and {other}");
        numbers += 1;
    }
    assert!(numbers > 60, "{numbers}");
}

/// Points that a sweep has kept are those of its mesh, whatever the scene beside it says.
#[test]
fn a_sweep_does_not_go_on_in_another_mesh() {
    let place = Place::new();
    let scene = place.scene("scene.toml", &with_mesh(&place, &annulus(24, Order::Linear), 1, ""));
    let first = fs::read(place.path("housing.msh")).unwrap();
    let out = place.path("out");
    let further = ["--vary", "inner_race.z.load=-250 N .. -50 N / 3000", "--threads", "1"];
    let sweep = || into_folder("sweep", &scene, &out, &further);
    let quiet = || std::process::Stdio::null();
    let mut child = sweep().stdout(quiet()).stderr(quiet()).spawn().unwrap();
    let csv = out.join("sweep.csv");
    let start = std::time::Instant::now();
    while fs::read(&csv).map_or(0, |text| text.split(|&b| b == b'\n').count()) < 18 {
        assert!(start.elapsed().as_secs() < 60, "no rows");
        assert!(child.try_wait().unwrap().is_none(), "over before it could be killed");
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    fs::write(place.path("housing.msh"), write_gmsh(&annulus(32, Order::Linear)).unwrap()).unwrap();
    let refused = sweep().output().unwrap();
    assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
    let said = stderr(&refused);
    assert!(said.contains("sweep.json belongs to an unfinished sweep"), "{said}");
    fs::write(place.path("housing.msh"), first).unwrap();
    assert!(succeed(sweep()).contains(" resumed) in "));
}
