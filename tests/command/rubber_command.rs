//! Scenes with a solid of rubber: statics, vibrations, runs that are interrupted and extended, and refusals.

use crate::housed_command_common::scene_text;
use crate::resume_common::{assert_same_results, end_after, interrupted};
use crate::solid_command_common::{
    Place, column, command, into_folder, json, shipped, stderr, succeed,
};

use bearing_dynamics::ch2_housing::elastomer::named;
use bearing_dynamics::mesh::Elements;
use bearing_dynamics::mesh::generate::{Bushing, BushingMesh, Part, bushing};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::rubber::harmonic::complex_stiffness;
use bearing_dynamics::solids::rubber::model::{RubberModel, RubberProblem, supports};
use bearing_dynamics::solids::rubber::steps::{RubberSolid, StepOptions, Stepping};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

/// A quarter of a small bushing whose inner sleeve goes 0.5 mm in 0.1 s and stays; without `[numerics]`.
pub const RUBBER: &str = r#"
[solid.mesh]
generate = "bushing"
part = "quarter"
inner_diameter = "20 mm"
outer_diameter = "36 mm"
length = "20 mm"
order = 2
cells = { around = 3, radial = 2, axial = 1, grading = 1.5 }
[solid.material]
law = "elastomer"
table = "3.1"
[[solid.fixed]]
set = "outer"
x = true
y = true
z = true
[[solid.fixed]]
set = "inner"
x = true
y = true
z = { ramp = ["0 um", "500 um"], duration = "0.1 s" }
[[solid.fixed]]
set = "x_low"
x = true
[[solid.fixed]]
set = "y_low"
y = true
[[solid.probe]]
set = "inner"
"#;

const HARMONIC: &str = "[solid.harmonic]\nset = \"inner\"\naxis = \"z\"\nfrequencies = [\"0 Hz\", \"1 Hz\", \"10 Hz\"]\n";

pub fn numerics(end: &str) -> String {
    format!(
        "{RUBBER}[numerics]\nend = \"{end}\"\noutput_interval = \"10 ms\"\nfields_interval = \"0.1 s\"\n\
         [output]\nplots = [\"series\"]\n"
    )
}

/// The same body without a scene.
fn model(moved: Profile) -> (RubberModel, Vec<u32>) {
    let body = Bushing { inner_diameter: 0.02, thickness: 0.008, length: 0.02 };
    let cells = BushingMesh { around: 3, radial: 2, axial: 1, grading: 1.5, part: Part::Quarter };
    let mesh = bushing(&body, &cells).unwrap().quadratic().unwrap().mesh;
    let held = || Some(Profile::ZERO);
    let prescribed = supports(
        &mesh,
        &[
            ("outer", [held(), held(), held()]),
            ("inner", [held(), held(), Some(moved)]),
            ("x_low", [held(), None, None]),
            ("y_low", [None, held(), None]),
        ],
    );
    let inner = mesh.node_sets["inner"].clone();
    let Elements::Quadratic(elements) = mesh.elements else { panic!("ten nodes") };
    let (nodes, material) = (mesh.nodes, named::table_3_1());
    let problem = RubberProblem { nodes, elements, material, prescribed, loads: Vec::new() };
    (RubberModel::new(problem).unwrap(), inner)
}

fn last(folder: &Path, name: &str) -> f64 {
    *column(folder, name).last().unwrap()
}

/// Values of a column of `harmonic.csv`.
fn harmonic(folder: &Path, at: usize) -> Vec<f64> {
    let text = fs::read_to_string(folder.join("harmonic.csv")).unwrap();
    text.lines().skip(1).map(|row| row.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

#[test]
fn statics_is_the_relaxed_equilibrium_and_the_answer_to_vibrations() {
    let place = Place::new();
    let scene = place.scene("scene.toml", &format!("{}{HARMONIC}", numerics("1 s")));
    let out = place.path("out");
    let said = succeed(into_folder("statics", &scene, &out, &[]));
    assert!(said.contains("relaxed") && said.contains("eta_d"), "{said}");

    let (model, _) = model(Profile::Constant(1.0));
    let answers = complex_stiffness(&model, 0.0, &[0.0, TAU, 10.0 * TAU], 1e-6).unwrap();
    for (row, answer) in answers.iter().enumerate() {
        for (at, ours) in [(1, answer.storage), (2, answer.loss)] {
            // Another numbering; what the search for the answer leaves.
            let error = (harmonic(&out, at)[row] - ours).abs();
            assert!(error <= 1e-7 * answer.storage, "{row} {at}: {error}");
        }
        let size = answer.storage.hypot(answer.loss);
        assert!((harmonic(&out, 3)[row] / size - 1.0).abs() <= 1e-6, "K_d");
        assert!((harmonic(&out, 4)[row] - answer.loss / size).abs() <= 1e-6, "eta_d");
    }
    // 0.5 mm of 8 mm: nearly the stiffness about rest; actio is reactio, but for the planes of symmetry.
    let [inner, outer] = ["inner", "outer"].map(|s| last(&out, &format!("reaction_{s}_z")));
    assert!((inner / (0.5e-3 * answers[0].storage) - 1.0).abs() <= 0.01, "{inner}");
    assert!((inner + outer).abs() <= 1e-6 * inner, "{inner} {outer}");
    let summary = json(out.join("summary.json"));
    assert_eq!(summary["harmonic"]["answers"].as_array().unwrap().len(), 3);
    assert_eq!(summary["loads_of"]["value"], 1.0);
    // At small strain the energy is half of force times way.
    let energy = summary["strain_energy"]["value"].as_f64().unwrap();
    assert!((energy / (0.5 * inner * 0.5e-3) - 1.0).abs() <= 0.01, "{energy}");
}

#[test]
fn a_run_has_the_forces_of_the_steps_and_relaxes_to_statics() {
    let place = Place::new();
    let scene = place.scene("scene.toml", &numerics("0.2 s"));
    let out = place.path("out");
    let said = succeed(into_folder("run", &scene, &out, &[]));
    assert!(said.contains("accuracy 0.001: adaptive steps"), "{said}");
    let ramp = Profile::Ramp { from: 0.0, to: 5e-4, start: 0.0, duration: 0.1 };
    let (model, inner) = model(ramp);
    let options = StepOptions { stepping: Stepping::Accuracy(1e-3), ..StepOptions::default() };
    let mut solid = RubberSolid::new(&model, options).unwrap();
    let forces = column(&out, "reaction_inner_z");
    assert_eq!(forces.len(), 21);
    for (row, force) in forces.iter().enumerate() {
        solid.advance(row as f64 * 0.01, |_| {}).unwrap();
        let ours = solid.support_force(&inner)[2];
        // Iterations end at 1e-9 of the largest force of a node.
        assert!((force - ours).abs() <= 1e-6 * ours.abs(), "{row}: {force} {ours}");
    }
    // What is put in is held by the network, or was taken by Maxwell elements.
    let [held, put_in, taken] =
        ["energy_strain", "work_external", "energy_viscous"].map(|name| column(&out, name));
    for row in 0..forces.len() {
        assert!((held[row] + taken[row] - put_in[row]).abs() <= 1e-12 * put_in[20], "{row}");
        assert!(taken[row] >= 0.0, "{row}");
    }
    // Of that springs hold a part and dashpots took another; strains of 6 % add a tenth of their own, and the ledger closes
    // but for the length of steps (accuracy 1e-3).
    let [springs, lost, beyond, residual] =
        ["energy_maxwell", "energy_dissipated", "energy_finite_strain", "energy_residual"]
            .map(|name| column(&out, name));
    for row in 0..forces.len() {
        let sum = held[row] + springs[row] + lost[row] + beyond[row] - put_in[row];
        assert!(beyond[row].abs() <= 0.1 * taken[20], "{row}: {}", beyond[row]);
        assert!((residual[row] - sum).abs() <= 1e-12 * put_in[20], "{row}");
        assert!(
            residual[row].abs() <= 0.01 * taken[20],
            "{row}: {} of {}",
            residual[row],
            taken[20]
        );
        assert!(row == 0 || (springs[row] > 0.0 && lost[row] > lost[row - 1]), "{row}");
    }
    assert!(lost[20] > springs[20], "held since t = 0.1 s: {} {}", lost[20], springs[20]);
    let energy = &json(out.join("summary.json"))["energy"];
    for (name, column) in [("energy_dissipated", &lost), ("energy_residual", &residual)] {
        assert_eq!(energy[name]["value"], column[20], "{name}");
    }
    // By straight lines between rows: the force of a ramp bends little.
    let ways = column(&out, "inner_z");
    let work: f64 = (1..forces.len())
        .map(|row| 0.5 * (forces[row] + forces[row - 1]) * (ways[row] - ways[row - 1]))
        .sum();
    assert!((put_in[20] / work - 1.0).abs() <= 0.01, "{} {work}", put_in[20]);
    // Drawn, and in fields.
    for name in ["reactions.svg", "loops.svg", "energies.svg", "fields/fields_000002.vtu"] {
        assert!(out.join(name).is_file(), "{name}");
    }

    // The slowest element takes 10 s: e⁻⁹ of a stiffness that was some times the relaxed one.
    let long =
        numerics("90 s").replace("10 ms", "10 s").replace("0.1 s\"\n[output]", "90 s\"\n[output]");
    let scene = place.scene("long.toml", &long);
    let (run, still) = (place.path("long"), place.path("still"));
    succeed(into_folder("run", &scene, &run, &[]));
    succeed(into_folder("statics", &scene, &still, &[]));
    let [late, relaxed] = [&run, &still].map(|folder| last(folder, "reaction_inner_z"));
    assert!((late / relaxed - 1.0).abs() <= 2e-4, "{late} {relaxed}");
    let [late, relaxed] = [&run, &still].map(|folder| json(folder.join("summary.json")));
    let stress = |of: &serde_json::Value| of["largest"]["von_mises_of_nodes"]["value"].as_f64();
    assert!((stress(&late).unwrap() / stress(&relaxed).unwrap() - 1.0).abs() <= 1e-3);
}

#[test]
fn interrupted_killed_and_extended_runs_of_rubber_end_with_the_same_bytes() {
    let place = Place::new();
    // Rows at which steps end on the way, before, at and behind the corner.
    let of = |end: &str| numerics(end).replace("\"10 ms\"", "\"7 ms\"");
    let scene = place.scene("scene.toml", &of("100 s"));
    let (whole, parts) = (place.path("whole"), place.path("parts"));
    interrupted(into_folder("run", &scene, &parts, &["--save-every", "1"]), 200, &parts);
    let scene = place.scene("scene.toml", &of(&end_after(&parts, 4000.0)));
    let said = succeed(into_folder("run", &scene, &parts, &["--resume"]));
    assert!(said.contains("resumed at t = "), "{said}");
    succeed(into_folder("run", &scene, &whole, &[]));
    assert_same_results(&whole, &parts);
    // A complete run goes on to a later end.
    let longer = place.scene("scene.toml", &of(&end_after(&parts, 100.0)));
    succeed(into_folder("run", &longer, &parts, &["--resume"]));
    succeed(into_folder("run", &longer, &whole, &["--fresh"]));
    assert_same_results(&whole, &parts);
    // Another rubber does not go on from there, nor does a damaged state.
    let text = of("100 s").replace("table = \"3.1\"", "table = \"2.3\"");
    let refused =
        into_folder("run", &place.scene("o.toml", &text), &parts, &["--resume"]).output().unwrap();
    assert!(stderr(&refused).contains("another scene"), "{}", stderr(&refused));
    let mut state = json(parts.join("state.json"));
    state["sound"]["checkpoint"]["Rubber"][0]["state"]["history"].as_array_mut().unwrap().pop();
    fs::write(parts.join("state.json"), state.to_string()).unwrap();
    let longer = place.scene("scene.toml", &of("100 s"));
    let refused = into_folder("run", &longer, &parts, &["--resume"]).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("damaged"), "{}", stderr(&refused));
    assert!(stderr(&refused).contains("--fresh"), "{}", stderr(&refused));
}

#[test]
fn what_does_not_fit_rubber_is_refused() {
    let place = Place::new();
    let law = "law = \"elastomer\"\n";
    let table = "table = \"3.1\"\n";
    let numerics = "[numerics]\nend = \"1 ms\"\n";
    let with = |further: &'static str| (law, format!("{law}{further}\n"));
    let behind = |further: &str| ("[[solid.probe]]", format!("{further}\n[[solid.probe]]"));
    let cases: Vec<(&str, (&str, String), &[&str])> = vec![
        (
            "check",
            with("youngs_modulus = \"1 GPa\""),
            &["solid.material.youngs_modulus", "\"linear-elastic\""],
        ),
        ("check", (law, String::new()), &["solid.material.table", "law = \"elastomer\""]),
        (
            "check",
            (table, String::new()),
            &["solid.material.rubber_modulus", "no `table`", "0.647 MPa"],
        ),
        ("check", (table, "table = \"3.2\"\n".into()), &["solid.material.table", "\"3.2\"", "3.1"]),
        ("check", ("order = 2", "order = 1".into()), &["solid.mesh.order", "lock", "order = 2"]),
        (
            "check",
            with("rubber_modulus = \"-1 MPa\""),
            &["solid.material.rubber_modulus", "1e-6 MPa"],
        ),
        ("check", with("rubber_modulus = \"1 mm\""), &["solid.material.rubber_modulus", "length"]),
        ("check", with("chain = 0"), &["solid.material.chain", "Allowed"]),
        (
            "check",
            with("chain = 0.9\nchain_force = \"inverse-langevin\""),
            &["solid.material.chain", "Allowed: more than 1", "fully extended"],
        ),
        ("check", with("bulk_ratio = 100\nbulk_modulus = \"60 MPa\""), &["together with"]),
        (
            "check",
            with("bulk_modulus = \"0.6 MPa\""),
            &["solid.material.bulk_modulus", "less than C_R", "at least C_R"],
        ),
        (
            "check",
            with("bulk_modulus = \"1e9 MPa\""),
            &["solid.material.bulk_modulus", "at most a million times C_R"],
        ),
        (
            "check",
            behind("[[solid.material.maxwell]]\ngamma = 1\nrelaxation_time = \"1e-310 s\""),
            &["relaxation_time", "Allowed: from 1e-15 s"],
        ),
        ("check", (table, "table = \"3.3\"\n".into()), &["\"3.3\"", "use one of these words"]),
        ("check", behind("[[solid.material.maxwel]]\ngamma = 1"), &["did you mean", "maxwell`"]),
        (
            "check",
            (
                "set = \"outer\"\nx = true\ny = true\nz = true",
                format!("set = \"outer\"\nx = true\n{HARMONIC}"),
            ),
            &["solid.harmonic.axis", "no set but \"inner\" is fixed along z"],
        ),
        ("check", behind("[[solid.material.maxwell]]\ngamma = 1"), &["relaxation_time", "missing"]),
        (
            "check",
            behind("[[solid.material.maxwell]]\ngamma = -1\nrelaxation_time = \"1 s\""),
            &["gamma", "Allowed"],
        ),
        (
            "check",
            behind("[[solid.material.maxwell]]\ngamma = 1\nrelaxation_time = \"0 s\""),
            &["relaxation_time", "Allowed"],
        ),
        ("check", behind("[solid]\ndamping = \"77 1/s\""), &["solid.damping", "linear-elastic"]),
        ("check", behind("[solid]\nspin = \"77 rpm\""), &["solid.spin", "linear-elastic"]),
        ("check", behind("[modes]\ncount = 3"), &["modes", "linear-elastic"]),
        (
            "check",
            behind("[numerics]\nend = \"1 ms\"\nmethod = \"runge-kutta\""),
            &["numerics.method", "linear-elastic"],
        ),
        (
            "check",
            behind("[numerics]\nend = \"1 ms\"\nstep_fraction = 0.5"),
            &["numerics.step_fraction", "linear-elastic"],
        ),
        (
            "check",
            ("outer_diameter = \"36 mm\"", "outer_diameter = \"20 mm\"".into()),
            &["solid.mesh.outer_diameter", "inner diameter"],
        ),
        ("check", ("radial = 2", "radial = 3".into()), &["solid.mesh.cells.radial", "even"]),
        (
            "check",
            ("grading = 1.5", "grading = 0.5".into()),
            &["solid.mesh.cells.grading", "Allowed"],
        ),
        (
            "check",
            behind("[solid.harmonic]\nset = \"inner\"\naxis = \"z\""),
            &["solid.harmonic.frequencies", "missing"],
        ),
        (
            "check",
            behind("[solid.harmonic]\nset = \"inner\"\nfrequencies = [\"1 Hz\"]"),
            &["solid.harmonic.axis", "missing"],
        ),
        (
            "check",
            behind("[solid.harmonic]\nset = \"ends\"\naxis = \"z\"\nfrequencies = [\"1 Hz\"]"),
            &["solid.harmonic.set", "\"ends\" is not fixed along z", "inner"],
        ),
        (
            "check",
            behind("[solid.harmonic]\nset = \"inner\"\naxis = \"x\"\nfrequencies = [\"1 Hz\"]"),
            &["solid.harmonic.axis", "also belong to \"x_low\", which fixes them along x"],
        ),
        (
            "check",
            ("set = \"x_low\"\nx = true", "set = \"x_low\"\ny = true".into()),
            &["solid.mesh.part", "\"x_low\" is not fixed along x", "whole"],
        ),
        (
            "check",
            ("set = \"y_low\"\ny = true", "set = \"y_low\"\nx = true".into()),
            &["solid.mesh.part", "\"y_low\" is not fixed along y"],
        ),
        (
            "check",
            behind(
                "[solid.harmonic]\nset = \"inner\"\naxis = \"z\"\nfrequencies = [\"2 Hz\", \"1 Hz\"]",
            ),
            &["solid.harmonic.frequencies", "increasing"],
        ),
        (
            "run",
            ("[[solid.fixed]]\nset = \"outer\"\nx = true\ny = true\nz = true\n", numerics.into()),
            &["free to move along z"],
        ),
        ("modes", (law, law.into()), &["no natural modes", "[solid.harmonic]"]),
        ("sweep", (law, law.into()), &["this takes a bearing, and the scene has a solid"]),
    ];
    for (name, (from, to), needles) in cases {
        assert!(RUBBER.contains(from), "{from}");
        let mut text = RUBBER.replacen(from, &to, 1);
        if name == "run" {
            text = text.replacen(&to, "", 1) + numerics;
            text =
                text.replace("z = { ramp = [\"0 um\", \"500 um\"], duration = \"0.1 s\" }\n", "");
        }
        let scene = place.scene("scene.toml", &text);
        let further: &[&str] =
            if name == "sweep" { &["--vary", "solid.material.chain=8, 9"] } else { &[] };
        let output = command(name, &scene, further).output().unwrap();
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{to}: {message}");
        for needle in needles {
            assert!(message.contains(needle), "{to}: {needle} is not in: {message}");
        }
    }
    // A file says what elements it has only when it is read.
    fs::copy(shipped("meshes/bar.msh"), place.path("bar.msh")).unwrap();
    let file = "[solid.mesh]\nfile = \"bar.msh\"\nunit = \"mm\"\n";
    let rubber = "[solid.material]\nlaw = \"elastomer\"\ntable = \"3.1\"\n";
    let scene = place.scene("f.toml", &[file, rubber].concat());
    let output = command("check", &scene, &[]).output().unwrap();
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("four-node elements") && message.contains("order = 2"), "{message}");
    let scene = place.scene("f.toml", &[file, "order = 2\n", rubber].concat());
    succeed(command("check", &scene, &[]));
    // Rubber's keys in a solid of another law, and rubber in the place of a housing.
    let elastic = RUBBER.replace(law, "").replace(table, "") + HARMONIC;
    let output = command("check", &place.scene("e.toml", &elastic), &[]).output().unwrap();
    assert!(stderr(&output).contains("solid.harmonic"), "{}", stderr(&output));
    let housed = scene_text(
        "method = \"quasi-static\"",
        "[solid.material]\nlaw = \"elastomer\"\ntable = \"3.1\"",
    );
    let output = command("check", &place.scene("h.toml", &housed), &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("a housing of rubber is not built"), "{}", stderr(&output));
}

#[test]
fn check_and_plan_say_what_rubber_it_is() {
    let place = Place::new();
    let text = RUBBER.replace("table = \"3.1\"", "rubber_modulus = \"0.5 MPa\"");
    let text = text.replace("around = 3", "around = 8");
    let scene = place.scene(
        "scene.toml",
        &format!("{text}[solid]\ngravity = [\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]\n"),
    );
    let said = succeed(command("check", &scene, &[]));
    for part in [
        "C_R 0.5 MPa",
        "bulk modulus 50 MPa",
        "0 Maxwell elements",
        "bulk_ratio = 100",
        "1100 kg/m^3",
    ] {
        assert!(said.contains(part), "{part} is not in {said}");
    }
    // A quarter of π/4 (36² − 20²) mm² × 20 mm.
    let echo = succeed(command("check", &scene, &["--json"]));
    let echo: serde_json::Value = serde_json::from_str(&echo).unwrap();
    assert_eq!(echo["scene"]["solid"]["material"]["law"], "elastomer");
    let volume = echo["mesh"]["volume"]["value"].as_f64().unwrap();
    let exact = 0.25 * 0.25 * std::f64::consts::PI * (0.036f64.powi(2) - 0.02f64.powi(2)) * 0.02;
    // Ten-node elements follow the sleeves to the fourth order of 22.5 degrees, their four points to the second.
    assert!((volume / exact - 1.0).abs() <= 1e-3, "{volume} {exact}");
    let refused = command("statics", &scene, &["--memory", "0.001"]).output().unwrap();
    let refused = stderr(&refused);
    assert!(refused.contains("a coarser mesh") && !refused.contains("order = 1"), "{refused}");
    let other = place.scene("t.toml", &RUBBER.replace("\"3.1\"", "\"2.3\""));
    let said = succeed(command("check", &other, &[]));
    for part in [
        "C_R 0.324 MPa, N 8, bulk modulus 32.4 MPa",
        "14 Maxwell elements",
        "Table 2.3 prints none",
    ] {
        assert!(said.contains(part), "{part} is not in {said}");
    }
    // The weight is a load.
    let said = succeed(command("statics", &scene, &["--dry"]));
    let loads = said.lines().find(|line| line.starts_with("loads, N")).unwrap();
    let weight: f64 = loads.split_whitespace().last().unwrap().parse().unwrap();
    assert!((weight / (-9.81 * 1100.0 * volume) - 1.0).abs() <= 1e-4, "{loads}");
    let said = succeed(command("plan", &scene, &[]));
    for part in ["skips Maxwell elements", "does  loads", "skips implicit steps", "skips modes"] {
        assert!(said.contains(part), "{part} is not in {said}");
    }
}
