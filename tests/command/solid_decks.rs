//! Meshes of other programs through the command: which sets, which material, which repair.

use crate::deck_common::{Variant, decks, gmsh_files};
use crate::solid_command_common::{Place, command, into_folder, json, number, stderr, succeed};
use serde_json::Value;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;

const REPAIR: &str = "repair = [\"drop-unreferenced\"]\n";

fn mesh(file: &str, further: &str) -> String {
    format!("[solid.mesh]\nfile = \"{file}\"\nunit = \"mm\"\n{further}")
}

/// A scene that holds one end of the body and loads the other.
fn loaded(file: &str, variant: &Variant) -> String {
    let [fix, tip, end] = variant.sets;
    let further = if variant.stray { REPAIR } else { "" };
    format!(
        "{}[[solid.fixed]]\nset = \"{fix}\"\nx = true\ny = true\nz = true\n[[solid.load]]\nset = \"{end}\"\n\
         z = \"-100 N\"\n[[solid.probe]]\nname = \"tip\"\nset = \"{tip}\"\n",
        mesh(file, further)
    )
}

/// Mean displacement of the tip, m.
fn displacement(place: &Place, text: &str) -> [f64; 3] {
    let out = place.path("out");
    if out.exists() {
        fs::remove_dir_all(&out).unwrap();
    }
    let scene = place.scene("scene.toml", text);
    succeed(into_folder("statics", &scene, &out, &[]));
    let summary = json(out.join("summary.json"));
    let tip: &Value = &summary["probes"]["tip"];
    ["x", "y", "z"].map(|axis| number(&tip[axis]))
}

fn of_variant(place: &Place, variant: &Variant, ending: &str) -> [f64; 3] {
    let file = format!("body.{ending}");
    fs::write(place.path(&file), &variant.bytes).unwrap();
    displacement(place, &loaded(&file, variant))
}

fn off(found: &[f64; 3], exact: &[f64; 3]) -> f64 {
    let largest = exact.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let differences = found.iter().zip(exact).map(|(a, b)| (a - b).abs() / largest);
    differences.fold(0.0, |most, x| if most >= x { most } else { x })
}

#[test]
fn variants_of_one_body_have_one_solution() {
    let place = Place::new();
    let all = decks();
    let plain = of_variant(&place, &all[0], "inp");
    assert!(plain[2] < -1e-7, "{plain:?}");
    let bodies = all.iter().filter(|variant| {
        variant.name.starts_with("numbers: whole") && variant.name.ends_with("start: nothing")
    });
    let some = bodies.chain(all.iter().skip(1).step_by(23)).chain(all.last());
    let some = some.map(|variant| (variant, "inp"));
    let files = gmsh_files();
    let some = some.chain(files.iter().step_by(11).map(|variant| (variant, "msh")));
    for (variant, ending) in some {
        let found = of_variant(&place, variant, ending);
        assert!(off(&found, &plain) <= 1e-9, "{}: {found:?} for {plain:?}", variant.name);
    }
}

/// Mean displacement of the tip by CalculiX 2.20, m.
const CALCULIX: [f64; 3] = [-1.2857255e-8, 8.9680685e-8, -5.7272055e-7];

/// Decks that CalculiX reads as well.
const OF_BOTH: [&str; 6] = [
    "numbers: double; flat; start: nothing",
    "numbers: exponent without a letter; flat; start: heading",
    "numbers: zeros left out; flat; start: line ends of Windows",
    "sets: case of definitions",
    "sets: beyond the mesh",
    "further: mass",
];

#[test]
fn decks_of_both_have_the_solution_of_calculix() {
    let place = Place::new();
    let all = decks();
    for name in OF_BOTH {
        let variant = all.iter().find(|variant| variant.name == name).expect(name);
        let ours = of_variant(&place, variant, "inp");
        assert!(off(&ours, &CALCULIX) <= 1e-4, "{name}: {ours:?} for {CALCULIX:?}");
        if let Some(theirs) = calculix(&place, &variant.bytes) {
            assert!(off(&theirs, &CALCULIX) <= 2e-6, "{name}: {theirs:?} for {CALCULIX:?}");
        }
    }
}

/// A run of CalculiX on a deck; `None` where there is no `ccx` on the path.
fn calculix(place: &Place, deck: &[u8]) -> Option<[f64; 3]> {
    // 100 N in proportion to the area of each node.
    let forces = [(9, 2), (10, 1), (11, 1), (12, 2)];
    let forces = forces
        .map(|(node, share)| format!("{node}, 3, {:.12e}\n", -100.0 * f64::from(share) / 6.0));
    let text = String::from_utf8(deck.to_vec()).unwrap();
    let deck = format!(
        "{text}*MATERIAL, NAME=steel\n*ELASTIC\n210000., 0.3\n*SOLID SECTION, ELSET=all, MATERIAL=steel\n*BOUNDARY\nfix, 1, 3\n\
         *STEP\n*STATIC\n*CLOAD\n{}*NODE PRINT, NSET=tip\nU\n*END STEP\n",
        forces.concat()
    );
    fs::write(place.path("theirs.inp"), deck).unwrap();
    let mut ccx = Command::new("ccx");
    ccx.args(["-i", "theirs"]).current_dir(place.folder.path()).env("OMP_NUM_THREADS", "1");
    match ccx.output() {
        Ok(output) => {
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout))
        }
        Err(error) if error.kind() == ErrorKind::NotFound => return None,
        Err(error) => panic!("{error}"),
    }
    let text = fs::read_to_string(place.path("theirs.dat")).unwrap();
    let numbers = text.lines().filter_map(|line| {
        let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        numbers.ok().filter(|numbers| numbers.len() == 4)
    });
    let rows: Vec<Vec<f64>> = numbers.collect();
    assert_eq!(rows.len(), 4, "{text}");
    Some([1, 2, 3].map(|axis| 1e-3 * rows.iter().map(|row| row[axis]).sum::<f64>() / 4.0))
}

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

fn plain() -> String {
    String::from_utf8(decks()[0].bytes.clone()).unwrap()
}

fn fixed(set: &str) -> String {
    format!("[[solid.fixed]]\nset = \"{set}\"\nx = true\ny = true\nz = true\n")
}

/// What a deck writes about its material in any form raises the question that *ELASTIC raises.
#[test]
fn no_material_of_a_deck_is_passed_over_for_steel() {
    let place = Place::new();
    let given = "[solid.material]\nyoungs_modulus = \"70 GPa\"\npoisson_ratio = 0.33\n";
    for constants in [
        "*HYPERELASTIC, NEO HOOKE\n0.5, 0.01",
        "*HYPERFOAM, N=1\n1., 2., 0.",
        "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1e5, 1e4, 1e4, .3, .3, .3, 4e3, 4e3\n3e3",
        "*ELASTIC, TYPE=ORTHO\n1e5, 1e4, 1e4, .3, .3, .3, 4e3, 4e3\n3e3",
        "*elastic, type=Orthotropic\n1e5, 1e4, 1e4, .3, .3, .3, 4e3, 4e3\n3e3",
        "*ELASTIC\n<modulus>, 0.3",
        "*USER MATERIAL, CONSTANTS=2\n70000., 0.33",
        "*DEFORMATION PLASTICITY\n70000., 0.33, 200., 5., 1.",
    ] {
        let deck = format!("{}*MATERIAL, NAME=mine\n{constants}\n", plain());
        fs::write(place.path("deck.inp"), deck).unwrap();
        let keyword = constants.split(['\n', ',']).next().unwrap().to_uppercase();
        let parts = ["\"mine\"", &keyword, "no youngs_modulus and no poisson_ratio"];
        refused(&place, &mesh("deck.inp", ""), &parts);
        let said = accepted(&place, &mesh("deck.inp", given));
        assert!(said.contains("the scene's material is used, not the deck's \"mine\""), "{said}");
    }
    for constants in ["70.0D+03, 0.33", "7.0+4, .33", "70.0d3, 33.D-2", "*comment\n70000., .33"] {
        let constants = constants.replace("*comment", "** a comment");
        let deck =
            format!("{}*MATERIAL, NAME=alu\n*ELASTIC\n{constants}\n*DENSITY\n2.7D-09\n", plain());
        fs::write(place.path("deck.inp"), deck).unwrap();
        let parts =
            ["\"alu\"", "youngs_modulus = \"70 GPa\"", "poisson_ratio = 0.33", "\"2700 kg/m^3\""];
        refused(&place, &mesh("deck.inp", ""), &parts);
    }
}

/// A modulus that is usual with the other unit of length shows that the unit is wrong.
#[test]
fn a_modulus_of_another_unit_questions_the_unit() {
    let place = Place::new();
    for (young, unit, other) in [("200.E9", "mm", "\"m\""), ("208000.", "m", "\"mm\"")] {
        let deck = format!("{}*MATERIAL, NAME=mat1\n*ELASTIC\n{young}, 0.3\n", plain());
        fs::write(place.path("deck.inp"), deck).unwrap();
        let text = mesh("deck.inp", "").replace("\"mm\"", &format!("\"{unit}\""));
        let question = format!("with unit = {other} the modulus is 20");
        refused(&place, &text, &[&question, &format!("correct solid.mesh.unit to {other}")]);
        let output = command("check", &place.scene("scene.toml", &text), &[]).output().unwrap();
        let said = stderr(&output);
        assert!(said.contains("youngs_modulus = …"), "{said}");
    }
    // So does a density, and a value out of range is not proposed.
    let deck = format!("{}*MATERIAL, NAME=mat1\n*ELASTIC\n1.E20, 0.5\n*DENSITY\n7850.\n", plain());
    fs::write(place.path("deck.inp"), deck).unwrap();
    let parts = [
        "with unit = \"m\" the density is 7850 kg/m^3",
        "youngs_modulus = …, poisson_ratio = …, density = …",
    ];
    refused(&place, &mesh("deck.inp", ""), &parts);
    // Soft rubber in the right unit is no mistake.
    let deck = format!("{}*MATERIAL, NAME=rubber\n*ELASTIC\n5., 0.49\n", plain());
    fs::write(place.path("deck.inp"), deck).unwrap();
    refused(&place, &mesh("deck.inp", ""), &["youngs_modulus = \"0.005 GPa\""]);
}

/// Nodes without elements are refused with a repair that works; a set that it empties is dropped unless it is used.
#[test]
fn the_repair_of_stray_nodes_leads_to_a_mesh() {
    let place = Place::new();
    let (of_decks, of_gmsh) = (decks(), gmsh_files());
    let stray = of_decks
        .iter()
        .map(|v| (v, "inp", "point"))
        .chain(of_gmsh.iter().map(|v| (v, "msh", "physical_0_7")));
    let mut tried = 0;
    for (variant, ending, set) in stray.filter(|(variant, ..)| variant.stray) {
        tried += 1;
        let file = format!("stray.{ending}");
        fs::write(place.path(&file), &variant.bytes).unwrap();
        refused(&place, &mesh(&file, ""), &["1 nodes belong to no element", "drop-unreferenced"]);
        let said = accepted(&place, &mesh(&file, REPAIR));
        assert!(
            said.contains(&format!("belongs to an element, and they were dropped: {set}")),
            "{said}"
        );
        let used = format!("{}{}", mesh(&file, REPAIR), fixed(set));
        refused(&place, &used, &[&format!("no node of set \"{set}\""), "belongs to an element"]);
    }
    assert_eq!(tried, 2);
}

/// What cannot be read and is not used is one line; what is used is refused by its line in the file.
#[test]
fn sets_that_cannot_be_read_matter_only_if_they_are_used() {
    let place = Place::new();
    let deck =
        format!("{}*SURFACE, NAME=cut, TYPE=CUTTING SURFACE\n0., 0., 0., 1., 0., 0.\n", plain());
    fs::write(place.path("deck.inp"), &deck).unwrap();
    let line = deck.lines().position(|line| line.starts_with("*SURFACE, NAME=cut")).unwrap() + 1;
    let reason = format!("line {line}: surface of type CUTTING SURFACE is not supported");
    let said = accepted(&place, &mesh("deck.inp", &fixed("FIX")));
    assert!(said.contains(&format!("set \"cut\" was skipped: {reason}")), "{said}");
    for name in ["cut", "CUT"] {
        refused(&place, &mesh("deck.inp", &fixed(name)), &["deck.inp", &reason]);
    }
    // A set of that name by geometry is the scene's own.
    let own = "[[solid.set]]\nname = \"cut\"\nplane = \"x\"\nat = \"0 mm\"\n";
    accepted(&place, &mesh("deck.inp", &format!("{own}{}", fixed("cut"))));
}

/// Files of Gmsh 4.15.2 with parameters of nodes.
#[test]
fn parametric_files_of_gmsh_are_read() {
    let place = Place::new();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh");
    let sets = |name: &str| {
        fs::copy(data.join(name), place.path(name)).unwrap();
        let said = accepted(&place, &mesh(name, &fixed("left")));
        let lines: Vec<&str> =
            said.lines().filter(|l| l.contains("sets (nodes)") || l.contains("extent")).collect();
        lines.join("\n")
    };
    let first = sets("parametric_v41.msh");
    assert!(first.contains("left (") && first.contains("mantle ("), "{first}");
    assert_eq!(sets("parametric_v22.msh"), first);
    assert_eq!(sets("parametric_v22_binary.msh"), first);
}
