//! `bearing run` as a user meets it: results folder, signals, errors, comparison.

use crate::resume_common::assert_same_results;
use crate::solid_command_common::{Place, json, stderr};

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Table 4.1's bearing at 1000 rpm under 250 N, with a cage but without friction between balls
/// and races.
pub fn scene(numerics: &str, output: &str) -> String {
    format!(
        r#"
title = "Run"
defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 8
clearance = {{ radial = "-5 um" }}
inner_race = {{ radius = "20.047 mm", groove_radius = "6.013 mm", bore_radius = "15 mm" }}
outer_race = {{ radius = "31.953 mm", groove_radius = "6.310 mm" }}
[bearing.cage]
pocket_radius = "6.1 mm"
inner_radius = "23.5 mm"
outer_radius = "28.5 mm"
race_clearance = "0.1 mm"
mass = "20 g"
guidance = "outer-race"
length = "12 mm"
contact = {{ law = "penalty", stiffness = "1e6 N/m" }}
[inner_race]
z = {{ load = "-250 N" }}
tilt_y = {{ tilt = "0.05 deg" }}
tilt_z = {{ tilt = "0 deg" }}
speed = "1000 rpm"
[ball_forces]
gravity = ["0 m/s^2", "0 m/s^2", "-9.80665 m/s^2"]
[traction]
law = "none"
[numerics]
{numerics}
[output]
{output}
"#
    )
}

pub const ALL_PLOTS: &str = r#"plots = ["orbit", "spectrum", "series", "slip-spin", "polar"]
window_start = "0.1 ms""#;

pub fn command(scene: &Path, out: &Path, further: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bearing"));
    command.arg("run").arg(scene).arg("--out").arg(out).args(further);
    command
}

pub fn run(scene: &Path, out: &Path, further: &[&str]) -> Output {
    command(scene, out, further).output().unwrap()
}

pub fn code(output: &Output) -> i32 {
    output.status.code().expect("it was not killed")
}

pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

pub fn bearing(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bearing")).args(arguments).output().unwrap()
}

#[test]
fn a_run_leaves_a_results_folder() {
    let place = Place::new();
    let numerics = "end = \"4.05 ms\"\nstep = \"2 us\"\noutput_interval = \"13.2 us\"";
    let scene = place.scene("scene.toml", &scene(numerics, ALL_PLOTS));
    let out = place.path("out");
    let output = run(&scene, &out, &["--threads", "2"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(stderr(&output), "", "quiet when piped");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    // 13.2 µs are no whole number of 2 µs steps.
    for part in ["step 2.0000e-6 s: given", "rounded to whole steps", "a row every 7 steps"] {
        assert!(said.contains(part), "{part} is not in {said}");
    }
    for name in [
        "orbit_cage.svg",
        "orbit_inner_race.svg",
        "polar.svg",
        "series.columns.json",
        "series.csv",
        "series.npy",
        "series_energy.svg",
        "series_work.svg",
        "slip.svg",
        "spectrum.csv",
        "spectrum_cage.svg",
        "spin.svg",
        "state.json",
        "summary.json",
    ] {
        assert!(out.join(name).exists(), "{name}");
    }
    let summary = json(out.join("summary.json"));
    assert_eq!(summary["complete"], true);
    assert_eq!(summary["time"]["value"], 4.05e-3);
    assert_eq!(summary["work"]["steps"], 2025);
    assert_eq!(summary["step"]["size"]["unit"], "s");
    assert!(summary["body_inertia"]["the cage"]["mass"]["value"].as_f64().unwrap() > 0.0);
    for part in ["assumptions", "plan", "scene", "energy", "kinematics", "window", "spectra"] {
        assert!(!summary[part].is_null(), "{part}");
    }
    // The shaft's speed and what pure rolling makes of it: (1 − r_b/r_p)/2 with the table's radii.
    let shaft = summary["kinematics"]["inner_race_frequency"]["value"].as_f64().unwrap();
    assert!((shaft - 1000.0 / 60.0).abs() <= 1e-9, "{shaft}");
    let rolling =
        summary["kinematics"]["rolling_cage_frequency_outer_control"]["value"].as_f64().unwrap();
    let expected = shaft * 0.5 * (1.0 - 5.9555 / 26.0);
    assert!((rolling - expected).abs() <= 2e-3, "{rolling} {expected}");

    // The same scene once more, and with another load: compare names time and channel.
    let again = place.path("again");
    assert_eq!(code(&run(&scene, &again, &[])), 0);
    assert_same_results(&out, &again);
    let text = fs::read_to_string(&scene).unwrap();
    let other = place.scene(
        "other.toml",
        &text.replace(
            "\"1000 rpm\"",
            "{ table = [[\"0 s\", \
        \"1000 rpm\"], [\"2 ms\", \"1000 rpm\"], [\"3 ms\", \"1001 rpm\"]] }",
        ),
    );
    let different = place.path("different");
    let output = run(&other, &different, &[]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let compare = |a: &Path, b: &Path| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bearing"));
        let output = command.arg("compare").arg(a).arg(b).output().unwrap();
        (code(&output), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    assert_eq!(compare(&out, &again).0, 0);
    let (code, report) = compare(&out, &different);
    assert_eq!(code, 1);
    let first = report.lines().find(|line| line.contains("time = ")).expect("a time is named");
    assert!(first.contains("time = 0.0020"), "the speeds part after 2 ms: {first}");
    assert!(report.contains("inner_") || report.contains("energy_"), "{report}");
}

#[test]
fn a_run_that_fails_says_where_and_keeps_its_state() {
    let place = Place::new();
    let numerics = "end = \"10 ms\"\nstep = \"6 us\"\noutput_interval = \"60 us\"\n\
        start = \"nominal\"\nenergy_limit = 1e-7";
    let scene = place.scene("scene.toml", &scene(numerics, "plots = [\"series\"]"));
    let out = place.path("out");
    let output = run(&scene, &out, &[]);
    assert_eq!(code(&output), 2);
    let message = stderr(&output);
    assert!(message.contains("t = ") && message.contains("step "), "{message}");
    assert!(message.contains("state before that step"), "{message}");
    let state = json(out.join("state.json"));
    assert_eq!(state["stopped"], "failed");
    assert!(message.contains(state["error"].as_str().unwrap()));
    let summary = json(out.join("summary.json"));
    assert_eq!((&summary["complete"], &summary["stopped_by"]), (&false.into(), &state["error"]));
    // It stands before the step that the message names.
    let named = message.split("step ").nth(1).unwrap();
    let named: u64 =
        named.chars().take_while(char::is_ascii_digit).collect::<String>().parse().unwrap();
    assert_eq!(state["steps"].as_u64().unwrap() + 1, named, "{message}");
    // Going on fails in the same place; starting anew needs no flag.
    let again = run(&scene, &out, &["--resume"]);
    assert_eq!((code(&again), stderr(&again)), (2, message.clone()));
    assert_eq!(stderr(&run(&scene, &out, &[])), message);
}

/// Table 4.1's bearing with 5 µm of clearance, without a cage, run up to 6000 rpm under 20 N.
fn cageless(law: &str) -> String {
    format!(
        r#"
defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 8
clearance = {{ radial = "5 um" }}
inner_race = {{ radius = "20.047 mm", groove_radius = "6.013 mm", bore_radius = "15 mm" }}
outer_race = {{ radius = "31.953 mm", groove_radius = "6.310 mm" }}
[inner_race]
z = {{ load = "-20 N" }}
speed = {{ ramp = ["0 rpm", "6000 rpm"], start = "5 ms", duration = "20 ms" }}
[ball_contact]
law = "{law}"
[numerics]
end = "20 ms"
integrator = "rosenbrock"
accuracy = 1e-3
[output]
plots = []
"#
    )
}

#[test]
fn balls_without_a_cage_touch_or_end_the_run() {
    let place = Place::new();
    let passing = place.scene("passing.toml", &cageless("none"));
    let out = place.path("passing");
    let output = run(&passing, &out, &[]);
    let message = stderr(&output);
    assert_eq!(code(&output), 2, "{message}");
    assert!(message.contains(" m inside ball ") && message.contains(" step "), "{message}");
    let state = json(out.join("state.json"));
    assert_eq!(state["stopped"], "failed");
    assert!(message.contains(state["error"].as_str().unwrap()), "{message}");
    assert_eq!(json(out.join("summary.json"))["complete"], false);

    let touching = place.scene("touching.toml", &cageless("hertz"));
    let out = place.path("touching");
    let output = run(&touching, &out, &[]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let summary = json(out.join("summary.json"));
    assert_eq!(summary["complete"], true);
    let energy = |name: &str| summary["energy"][name]["value"].as_f64().unwrap();
    // They have met, lost energy by their friction, and the ledger is closed.
    let turned = energy("work_drives").abs() + energy("work_traction").abs();
    assert!(energy("work_ball_friction") < -1e-4 * turned, "{}", energy("work_ball_friction"));
    // Measured over 0.2 s: 4e-5 of the energy turned over.
    assert!(energy("largest_residual") <= 1e-3 * turned, "{}", energy("largest_residual"));
    let defaults = summary["defaults"].to_string() + &summary["assumptions"].to_string();
    assert!(defaults.contains("ball_contact.friction"), "{defaults}");
}

#[test]
fn a_ball_forced_into_another_part_is_named_and_the_state_before_it_kept() {
    let place = Place::new();
    // Grooves have no shoulders: it takes a load that no steel bears.
    let thrust =
        r#"x = { load = { smooth_ramp = ["0 N", "1e9 N"], start = "0 s", duration = "0.5 ms" } }"#;
    let numerics = "end = \"5 ms\"\nstep = \"0.2 us\"\noutput_interval = \"20 us\"";
    let text = scene(numerics, "plots = []").replace(r#"z = { load = "-250 N" }"#, thrust);
    assert!(text.contains(thrust));
    let scene = place.scene("scene.toml", &text);
    let out = place.path("out");
    let output = run(&scene, &out, &[]);
    assert_eq!(code(&output), 2);
    let message = stderr(&output);
    assert!(message.contains("bearing: ball ") && message.contains(" m inside the "), "{message}");
    let state = json(out.join("state.json"));
    assert_eq!(state["stopped"], "failed");
    assert!(message.contains(state["error"].as_str().unwrap()), "{message}");
    // The last good state: numbers, of a step before the one that failed, with the rows so far.
    let numbers = state["sound"]["checkpoint"]["Bearing"]["state"].as_array().unwrap();
    assert!(numbers.len() > 13 * 8 && numbers.iter().all(Value::is_number));
    let step = format!("step {},", state["steps"].as_u64().unwrap() + 1);
    assert!(message.contains(&step), "{message}");
    let rows = state["sound"]["rows"].as_u64().unwrap();
    assert!(rows >= 2, "{rows} rows");
    let series = fs::read_to_string(out.join("series.csv")).unwrap();
    assert_eq!(series.lines().count() as u64, rows + 1);
    assert_eq!(json(out.join("summary.json"))["complete"], false);
    // It is a state to go on from: the same step fails again.
    assert_eq!(stderr(&run(&scene, &out, &["--resume"])), message);
}

#[test]
fn what_cannot_be_run_is_said_before_anything_is_written() {
    let place = Place::new();
    let out = place.path("out");
    let numerics = "end = \"1 ms\"\nstep = \"2 us\"";
    let text = scene(numerics, "channels = [\"races\", \"lodas\"]");
    let output = run(&place.scene("a.toml", &text), &out, &[]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("lodas") && stderr(&output).contains("loads"));
    let text = scene(numerics, "").replace("end = \"1 ms\"\n", "");
    let output = run(&place.scene("b.toml", &text), &out, &[]);
    assert_eq!(code(&output), 2);
    let message = stderr(&output);
    assert!(message.contains("b.toml:") && message.contains("numerics.end"), "{message}");
    let plan = bearing(&["plan", place.path("b.toml").to_str().unwrap()]);
    assert_eq!((code(&plan), stderr(&plan)), (2, message));
    let text = text.replace("[numerics]\nstep = \"2 us\"", "");
    let output = run(&place.scene("d.toml", &text), &out, &[]);
    assert!(stderr(&output).contains("d.toml: numerics.end"), "{}", stderr(&output));
    let text = scene("end = \"1000 s\"\nstep = \"1 ns\"\noutput_interval = \"1 ns\"", "");
    let output = run(&place.scene("c.toml", &text), &out, &[]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("more than 0.8 GB"), "{}", stderr(&output));
    let checked = bearing(&["check", place.path("c.toml").to_str().unwrap()]);
    assert_eq!((code(&checked), stderr(&checked)), (2, stderr(&output)));
    assert!(!out.join("state.json").exists() && !out.join("summary.json").exists());
}

#[test]
fn folders_that_hold_something_else_are_neither_resumed_nor_overwritten() {
    let place = Place::new();
    let scene = place.scene("scene.toml", &scene("end = \"0.1 ms\"\nstep = \"2 us\"", ""));
    let (nowhere, held) = (place.path("nowhere"), place.path("held"));
    let output = run(&scene, &nowhere, &["--resume"]);
    assert_eq!(code(&output), 2);
    let message = stderr(&output);
    assert!(message.contains("nowhere holds no run") && message.contains("without --resume"));
    assert!(!nowhere.exists());
    let paths = [scene.to_str().unwrap(), held.to_str().unwrap()];
    assert_eq!(code(&bearing(&["statics", paths[0], "--out", paths[1]])), 0);
    let before = fs::read(held.join("summary.json")).unwrap();
    let output = run(&scene, &held, &[]);
    assert_eq!(code(&output), 2);
    let message = stderr(&output);
    assert!(message.contains("static solution") && message.contains("--fresh"), "{message}");
    assert_eq!(fs::read(held.join("summary.json")).unwrap(), before);
    assert_eq!(code(&run(&scene, &held, &["--resume"])), 2);
    assert_eq!(code(&run(&scene, &held, &["--fresh"])), 0);
    assert_eq!(json(held.join("summary.json"))["kind"], "run");
    assert!(!held.join("load_zone.svg").exists(), "what statics drew is gone");
}

#[test]
fn runs_of_different_accuracy_are_compared_with_given_tolerances() {
    let place = Place::new();
    let folder = |name: &str, numerics: &str| {
        let numerics = format!("end = \"1 ms\"\noutput_interval = \"20 us\"\n{numerics}");
        let path = place.scene(&format!("{name}.toml"), &scene(&numerics, ""));
        let out = place.path(name);
        let output = run(&path, &out, &[]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        out.to_str().unwrap().to_string()
    };
    let fine = folder("fine", "step = \"0.5 us\"");
    let coarse = folder("coarse", "step = \"1 us\"");
    let compare = |further: &[&str]| {
        let output = bearing(&[&["compare", fine.as_str(), coarse.as_str()], further].concat());
        (code(&output), said(&output), stderr(&output))
    };
    assert_eq!(compare(&[]).0, 1, "their steps differ");
    let (found, report, _) = compare(&["--rtol", "1e-2", "--atol", "m=1e-8"]);
    assert_eq!(found, 0, "{report}");
    let (found, report, _) = compare(&["--rtol", "1e-13"]);
    assert_eq!(found, 1, "{report}");
    assert!(report.contains("(given)"), "{report}");
    for wrong in [&["--rtol", "-1"][..], &["--atol", "m"], &["--rtol", "1", "--class", "mixed"]] {
        assert_eq!(compare(wrong).0, 2, "{wrong:?}");
    }
    for unit in ["mm/s", "parsecs"] {
        let (found, _, message) = compare(&["--rtol", "1e-2", "--atol", &format!("{unit}=1e9")]);
        assert_eq!(found, 2, "{unit}");
        assert!(message.contains(&format!("the unit {unit:?}")), "{message}");
        assert!(message.contains("units are: ") && message.contains(" m/s,"), "{message}");
    }
}

#[test]
fn a_cage_that_overlaps_a_race_is_refused() {
    let place = Place::new();
    let refused = |old: &str, new: &str, parts: &[&str]| {
        let text = scene("end = \"1 ms\"", "");
        assert!(text.contains(old));
        let path = place.scene("scene.toml", &text.replace(old, new));
        let output = bearing(&["check", path.to_str().unwrap()]);
        assert_eq!(code(&output), 2);
        let message = stderr(&output);
        for part in parts {
            assert!(message.contains(part), "{part} is not in {message}");
        }
    };
    let outer = ["bearing.cage.outer_radius", "less than", "31.953 mm"];
    refused("outer_radius = \"28.5 mm\"", "outer_radius = \"32 mm\"", &outer);
    let inner = ["bearing.cage.inner_radius", "more than", "20.047 mm"];
    refused("inner_radius = \"23.5 mm\"", "inner_radius = \"20 mm\"", &inner);
    let land = ["bearing.cage.race_clearance", "less than", "31.953 mm"];
    refused("race_clearance = \"0.1 mm\"", "race_clearance = \"4 mm\"", &land);
    let pocket = ["bearing.cage.pocket_radius", "5.95"];
    refused("pocket_radius = \"6.1 mm\"", "pocket_radius = \"5.9 mm\"", &pocket);
}
