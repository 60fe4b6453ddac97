//! Scenes with a solid that are refused, meshes that are repaired only when asked, and every generator.

use crate::solid_command_common;

use bearing_dynamics::solids::modes::ModeError;
use serde_json::Value;
use solid_command_common::{ON_ROLLERS, Place, bar, command, number, shipped, stderr, succeed};
use std::fs;
use std::path::Path;

#[test]
fn meshes_from_files_are_repaired_only_when_asked() {
    let place = Place::new();
    fs::copy(shipped("meshes/bar.msh"), place.path("bar.msh")).unwrap();
    // Two corners of the first tetrahedron exchanged turn it inside out.
    let text = fs::read_to_string(place.path("bar.msh")).unwrap();
    let at = text.find("\n3 1 4 ").expect("the block of tetrahedra");
    let line_start = at + 1 + text[at + 1..].find('\n').unwrap() + 1;
    let line_end = line_start + text[line_start..].find('\n').unwrap();
    let words: Vec<&str> = text[line_start..line_end].split_whitespace().collect();
    let turned = [words[0], words[1], words[3], words[2], words[4]].join(" ");
    let broken = format!("{}{turned}{}", &text[..line_start], &text[line_end..]);
    fs::write(place.path("broken.msh"), broken).unwrap();
    let scene = |name: &str, further: &str| {
        let text = format!("[solid.mesh]\nfile = \"{name}\"\nunit = \"mm\"\n{further}");
        place.scene("scene.toml", &text)
    };
    let output = command("check", &scene("broken.msh", ""), &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("1 of 1798 elements are inverted"), "{}", stderr(&output));
    let said = succeed(command("check", &scene("broken.msh", "repair = [\"orient\"]\n"), &[]));
    assert!(said.contains("1 elements turned"), "{said}");
    // In metres it would be a hundred of them: said, not refused.
    let said = succeed(command(
        "check",
        &place.scene("m.toml", "[solid.mesh]\nfile = \"bar.msh\"\nunit = \"m\"\n"),
        &[],
    ));
    assert!(said.contains("in millimetres it would be"), "{said}");
    // An Abaqus file, its order raised.
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh");
    fs::copy(data.join("box_o1.inp"), place.path("box.inp")).unwrap();
    let said = succeed(command("check", &scene("box.inp", "order = 2\n"), &[]));
    assert!(said.contains("elements of 10"), "{said}");
}

#[test]
fn every_generator_makes_a_solid() {
    let place = Place::new();
    let cases = [
        (
            "block",
            "half_width = \"0.1 mm\"\ncells = { per_half_width = 2, deep = 1, growth = 1.3 }",
        ),
        (
            "shaft",
            "radius = \"10 mm\"\nstations = [\"0 mm\", \"30 mm\", \"80 mm\"]\ncells = { along = 8, around = 8, radial = 1 }",
        ),
        (
            "shaft",
            "radius = \"10 mm\"\nlength = \"80 mm\"\ncells = { along = 8, around = 8, radial = 1 }",
        ),
        (
            "cage",
            "pockets = 8\npocket_radius = \"6.1 mm\"\ninner_radius = \"24 mm\"\nouter_radius = \"28 mm\"\nwidth = \"16 mm\"\nrelief = { depth = \"0.5 mm\", belt_width = \"13 mm\" }\ncells = { quarter = 2, bar = 1, wall = 1 }",
        ),
        (
            "housing-a",
            "bore_radius = \"26 mm\"\nside = \"80 mm\"\ndepth = \"15 mm\"\ncells = { around = 16, radial = 2, axial = 1 }",
        ),
        (
            "housing-b",
            "bore_radius = \"26 mm\"\ndepth = \"15 mm\"\ncells = { around = 16, radial = 2, axial = 1 }",
        ),
        (
            "housing-c",
            "bore_radius = \"26 mm\"\ndepth = \"15 mm\"\nouter_radius = \"37 mm\"\ncells = { around = 16, radial = 2, axial = 1 }",
        ),
        (
            "housing-d",
            "bore_radius = \"26 mm\"\nouter_radius = \"37 mm\"\ndepth = \"15 mm\"\ncells = { around = 16, radial = 2, axial = 1, growth = 1.2 }",
        ),
    ];
    for (generator, dimensions) in cases {
        for order in [1, 2] {
            let text = format!(
                "[solid.mesh]\ngenerate = \"{generator}\"\norder = {order}\n{dimensions}\n"
            );
            let scene = place.scene("scene.toml", &text);
            let said = succeed(command("check", &scene, &[]));
            assert!(said.contains("a valid scene"), "{generator}: {said}");
            if generator == "shaft" {
                let summary = succeed(command("check", &scene, &["--json"]));
                let echo: Value = serde_json::from_str(&summary).unwrap();
                assert_eq!(number(&echo["mesh"]["high"]["x"]), 0.08);
            }
        }
    }
}

/// A scene that is refused with all of these words, by `check` already.
fn refused(place: &Place, text: &str, parts: &[&str]) {
    let output = command("check", &place.scene("refused.toml", text), &[]).output().unwrap();
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    for part in parts {
        assert!(said.contains(part), "{part} is not in {said}");
    }
}

fn accepted(place: &Place, text: &str) -> String {
    succeed(command("check", &place.scene("accepted.toml", text), &[]))
}

const CLAMPED: &str = "[[solid.fixed]]\nset = \"x_low\"\nx = true\ny = true\nz = true\n";

#[test]
fn loads_that_supports_take_are_told() {
    let place = Place::new();
    let load = |set: &str| format!("[[solid.load]]\nset = \"{set}\"\nz = \"-100 N\"\n");
    let parts = ["solid.load.set", "\"x_low\" is fixed along z", "Load another set"];
    refused(&place, &bar(1, &format!("{CLAMPED}{}", load("x_low"))), &parts);
    let pressure = "[[solid.load]]\nset = \"x_low\"\npressure = \"1 MPa\"\n";
    refused(&place, &bar(1, &format!("{CLAMPED}{pressure}")), &["fixed along x"]);
    let said = accepted(&place, &bar(1, &format!("{CLAMPED}{}", load("x_high"))));
    assert!(!said.contains("the support carries it"), "{said}");
    // The upper edge of an end of two cells has a quarter of it.
    let roof = "[[solid.fixed]]\nset = \"z_high\"\nz = true\n";
    let said = accepted(&place, &bar(1, &format!("{roof}{}", load("x_high"))));
    assert!(said.contains("25 % of the load on set \"x_high\""), "{said}");
}

#[test]
fn probes_outside_the_body_or_with_endless_names_are_refused_at_once() {
    let place = Place::new();
    let probe = |name: &str, x: &str| {
        let at = format!("[\"{x}\", \"5 mm\", \"5 mm\"]");
        bar(1, &format!("{CLAMPED}[[solid.probe]]\nname = \"{name}\"\nat = {at}\n"))
    };
    refused(
        &place,
        &probe("far", "400 mm"),
        &["solid.probe.at", "360.0", "outside the body", "0.040000"],
    );
    let said = accepted(&place, &probe("near", "42 mm"));
    assert!(said.contains("probe \"near\" is at the nearest node"), "{said}");
    assert!(!accepted(&place, &probe("exact", "40 mm")).contains("nearest node"));
    let long = "n".repeat(200);
    refused(&place, &probe(&long, "40 mm"), &["solid.probe.name", "200 letters", "120"]);
}

#[test]
fn materials_of_decks_are_not_skipped_for_steel() {
    let place = Place::new();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh");
    let deck = fs::read_to_string(data.join("box_o1.inp")).unwrap();
    let scene = |elastic: &str, density: &str, further: &str| {
        let material = format!("*MATERIAL, NAME=ALU\n*ELASTIC\n{elastic}\n*DENSITY\n{density},\n");
        fs::write(place.path("deck.inp"), format!("{deck}\n{material}")).unwrap();
        format!("[solid.mesh]\nfile = \"deck.inp\"\nunit = \"mm\"\n{further}")
    };
    let aluminium = ("70000., 0.33", "2.7e-9");
    let parts = [
        "\"ALU\"",
        "steel would be used in their place",
        "youngs_modulus = \"70 GPa\"",
        "0.33",
        "\"2700 kg/m^3\"",
    ];
    refused(&place, &scene(aluminium.0, aluminium.1, ""), &parts);
    let named = "[solid.material]\nyoungs_modulus = \"68 GPa\"\npoisson_ratio = 0.33\ndensity = \"2700 kg/m^3\"\n";
    let said = accepted(&place, &scene(aluminium.0, aluminium.1, named));
    // Both numbers, and which one counts; what agrees is not held against it.
    assert!(said.contains("the scene's material is used, not the deck's"), "{said}");
    assert!(said.contains("youngs_modulus 68 GPa is used, not 70 GPa; the deck has"), "{said}");
    let said = accepted(&place, &scene("68000., 0.33", "2.7e-9", named));
    assert!(!said.contains("not the deck's"), "{said}");
    // Steel by default is steel.
    let said = accepted(&place, &scene("210000., 0.3", "7.85e-9", ""));
    assert!(!said.contains("not the deck's"), "{said}");
    // What the scene does name is not called missing.
    let elastic = "[solid.material]\nyoungs_modulus = \"70 GPa\"\npoisson_ratio = 0.33\n";
    let parts =
        ["The scene gives no density, so that", "in its place: density 7850 kg/m^3", "2700 kg/m^3"];
    refused(&place, &scene(aluminium.0, aluminium.1, elastic), &parts);
    let density = "[solid.material]\ndensity = \"2700 kg/m^3\"\n";
    let parts =
        ["no youngs_modulus and no poisson_ratio", "youngs_modulus 210 GPa, poisson_ratio 0.3"];
    refused(&place, &scene(aluminium.0, aluminium.1, density), &parts);
}

/// Two tetrahedra of one face, in Gmsh's version 2.2, each in a volume of its own.
const TWO_VOLUMES: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"hub\"\n3 2 \"rim\"\n\
$EndPhysicalNames\n$Nodes\n5\n1 0 0 0\n2 10 0 0\n3 0 10 0\n4 0 0 10\n5 10 10 10\n$EndNodes\n\
$Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 2 2 2 3 4 5\n$EndElements\n";

#[test]
fn several_volumes_of_one_material_are_told() {
    let place = Place::new();
    let text = "[solid.mesh]\nfile = \"two.msh\"\nunit = \"mm\"\n";
    fs::write(place.path("two.msh"), TWO_VOLUMES).unwrap();
    let said = accepted(&place, text);
    assert!(said.contains("2 volumes (hub, rim)") && said.contains("one body"), "{said}");
    let one = TWO_VOLUMES.replace("\n2 4 2 2 2", "\n2 4 2 1 2");
    fs::write(place.path("two.msh"), one.replace("2\n3 1 \"hub\"\n3 2 \"rim\"", "1\n3 1 \"hub\""))
        .unwrap();
    assert!(!accepted(&place, text).contains("volumes"));
    fs::write(place.path("two.msh"), TWO_VOLUMES.replace("$Nodes\n5", "$Nodes\n-5")).unwrap();
    refused(&place, text, &["line 10", "\"-5\" is not a count of nodes (a whole number"]);
}

#[test]
fn a_file_in_place_of_a_folder_is_named() {
    let place = Place::new();
    fs::write(place.path("taken"), "mine").unwrap();
    let out = place.path("taken");
    let output =
        solid_command_common::into_folder("statics", &shipped("deep_groove_tilt.toml"), &out, &[])
            .output()
            .unwrap();
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("taken is a file; move it away, or choose another --out"), "{said}");
    assert_eq!(fs::read_to_string(place.path("taken")).unwrap(), "mine");
}

#[test]
fn modes_that_do_not_settle_say_what_to_ask_for() {
    let error = ModeError::NotConverged { found: 5, wanted: 12, vectors: 240 }.to_string();
    for part in ["lowest 5 of the 12 natural modes", "modes.count", "Poisson's ratio"] {
        assert!(error.contains(part), "{part} is not in {error}");
    }
}

/// A plan estimates memory; what does not fit is refused before anything is factorised.
#[test]
fn factors_that_do_not_fit_are_refused() {
    let place = Place::new();
    let scene = place.scene("scene.toml", &bar(2, ON_ROLLERS));
    let little = ["--memory", "0.001"];
    let said = succeed(command("plan", &scene, &[]));
    for part in ["memory of statics", "memory of modes", "of memory, "] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(!said.contains("REFUSED"), "{said}");
    let said = succeed(command("plan", &scene, &little));
    assert!(said.contains("REFUSED: only 1 MB available"), "{said}");
    for name in ["statics", "modes"] {
        let output = command(name, &scene, &little).arg("--dry").output().unwrap();
        let error = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{error}");
        let start = format!("{name} of ");
        for part in
            [&start, "GB of memory", "Allowed: 0.001 GB (--memory)", "coarser mesh", "order = 1"]
        {
            assert!(error.contains(part), "{part}: {error}");
        }
        assert!(output.stdout.is_empty());
        succeed(command(name, &scene, &["--dry", "--memory", "1"]));
    }
    for wrong in ["0", "-3", "much", "NaN", "inf"] {
        let given = format!("--memory={wrong}");
        let output = command("statics", &scene, &[&given, "--dry"]).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("--memory"), "{}", stderr(&output));
    }
}

/// Meshes may be far longer than tables of results: comments make this one of 17 MiB.
#[test]
fn long_meshes_are_read() {
    let place = Place::new();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh");
    let deck = fs::read_to_string(data.join("box_o1.inp")).unwrap();
    let comment = format!("** {}\n", "-".repeat(1020));
    fs::write(place.path("long.inp"), deck + &comment.repeat(17 << 10)).unwrap();
    let said = accepted(&place, "[solid.mesh]\nfile = \"long.inp\"\nunit = \"mm\"\n");
    assert!(said.contains("elements of 4"), "{said}");
}

/// Two rows, at the start and at the end.
#[test]
fn an_interval_may_be_as_long_as_the_run() {
    let place = Place::new();
    for key in ["output_interval", "fields_interval"] {
        let numerics = format!("{CLAMPED}[numerics]\nend = \"1 ms\"\n{key} = \"1 ms\"\n");
        accepted(&place, &bar(1, &numerics));
    }
}
