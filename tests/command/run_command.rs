//! `bearing run` as a user meets it: results folder, signals, errors, comparison.

use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Table 4.1's bearing at 1000 rpm under 250 N, with a cage but without friction between balls
/// and races.
fn scene(numerics: &str, output: &str) -> String {
    format!(
        r#"
title = "Run"
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

const ALL_PLOTS: &str = r#"plots = ["orbit", "spectrum", "series", "slip-spin", "polar"]
window_start = "0.1 ms""#;

struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new() -> Place {
        Place { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn scene(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, text).unwrap();
        path
    }
}

fn command(scene: &Path, out: &Path, further: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bearing"));
    command.arg("run").arg(scene).arg("--out").arg(out).args(further);
    command
}

fn run(scene: &Path, out: &Path, further: &[&str]) -> Output {
    command(scene, out, further).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("it was not killed")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn json(path: PathBuf) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// Every file of two folders to the byte, but for wall times.
fn assert_same_results(expected: &Path, found: &Path) {
    let names = |folder: &Path| {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    };
    assert_eq!(names(expected), names(found));
    for name in names(expected) {
        let [a, b] = [expected, found].map(|folder| folder.join(&name));
        if name.ends_with(".json") && name != "series.columns.json" {
            let [mut a, mut b] = [a, b].map(json);
            for tree in [&mut a, &mut b] {
                assert!(tree.as_object_mut().unwrap().remove("seconds").is_some(), "{name}");
            }
            assert_eq!(a.to_string(), b.to_string(), "{name}");
        } else {
            assert!(fs::read(a).unwrap() == fs::read(b).unwrap(), "{name} differs");
        }
    }
}

fn signal(child: &Child, name: &str) {
    let id = child.id().to_string();
    assert!(Command::new("kill").args([name, &id]).status().unwrap().success());
}

/// Starts a run and waits until it steps.
fn start(mut command: Command) -> Child {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.as_mut().unwrap());
    let mut line = String::new();
    while !line.contains("a row every") {
        line.clear();
        assert!(lines.read_line(&mut line).unwrap() > 0, "it ended before it stepped");
    }
    child
}

fn wait(mut child: Child) -> (Option<i32>, String) {
    let mut text = String::new();
    child.stderr.as_mut().unwrap().read_to_string(&mut text).unwrap();
    (child.wait().unwrap().code(), text)
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
    assert_eq!(summary["motion"]["cage"]["contact_law"], "penalty");
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
fn interrupted_by_a_signal_and_resumed() {
    let place = Place::new();
    // A second or so, whatever the machine: the signal comes in the middle.
    let numerics = "end = \"800.001 ms\"\nstep = \"2 us\"\noutput_interval = \"0.4 ms\"";
    let scene = place.scene("scene.toml", &scene(numerics, ALL_PLOTS));
    let whole = place.path("whole");
    let parts = place.path("parts");
    let mut child = start(command(&scene, &parts, &[]));
    std::thread::sleep(Duration::from_millis(60));
    signal(&child, "-TERM");
    let (code_of_part, message) = wait(child);
    assert_eq!(code_of_part, Some(2), "{message}");
    assert!(message.contains("interrupted at t = ") && message.contains("--resume"), "{message}");
    let summary = json(parts.join("summary.json"));
    assert_eq!(summary["complete"], false);
    assert_eq!(summary["stopped_by"], "interrupted");
    let rows = fs::read_to_string(parts.join("series.csv")).unwrap().lines().count() - 1;
    assert_eq!(summary["output"]["rows"], rows);
    assert!(rows > 1 && rows < 2000, "{rows}");

    // Without a word about it nothing is overwritten.
    let refused = run(&scene, &parts, &[]);
    assert_eq!(code(&refused), 2);
    assert!(stderr(&refused).contains("--resume") && stderr(&refused).contains("--fresh"));
    assert_eq!(json(parts.join("summary.json")), summary);

    child = start(command(&scene, &parts, &["--resume"]));
    std::thread::sleep(Duration::from_millis(30));
    signal(&child, "-INT");
    assert_eq!(wait(child).0, Some(2));
    let output = run(&scene, &parts, &["--resume"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(String::from_utf8_lossy(&output.stdout).contains("resumed at t = "));
    assert!(!String::from_utf8_lossy(&output.stdout).contains("no trial could start"));
    assert_eq!(code(&run(&scene, &whole, &[])), 0);
    assert_same_results(&whole, &parts);
}

#[test]
fn killed_outright_it_goes_on_from_the_last_state_kept() {
    let place = Place::new();
    let numerics = "end = \"1000 s\"\nstep = \"2 us\"\noutput_interval = \"1 ms\"";
    let endless = place.scene("scene.toml", &scene(numerics, "plots = []"));
    let (whole, parts) = (place.path("whole"), place.path("parts"));
    let child = start(command(&endless, &parts, &["--save-every", "1"]));
    let begun = Instant::now();
    while !parts.join("state.json").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "no state is kept");
        std::thread::sleep(Duration::from_millis(20));
    }
    signal(&child, "-KILL");
    assert_eq!(wait(child).0, None);
    assert_eq!(json(parts.join("state.json"))["stopped"], "running");
    // A run of another length goes on from there.
    let time = json(parts.join("state.json"))["time"].as_f64().unwrap();
    let numerics = numerics.replace("1000 s", &format!("{:.3} ms", 1e3 * time + 2.0005));
    let shorter = place.scene("shorter.toml", &scene(&numerics, "plots = []"));
    let output = run(&shorter, &parts, &["--resume"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(code(&run(&shorter, &whole, &[])), 0);
    assert_same_results(&whole, &parts);
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
    let numbers = state["bearing"]["state"].as_array().unwrap();
    assert!(numbers.len() > 13 * 8 && numbers.iter().all(Value::is_number));
    let step = format!("step {},", state["steps"].as_u64().unwrap() + 1);
    assert!(message.contains(&step), "{message}");
    let rows = state["rows"].as_u64().unwrap();
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

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn bearing(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bearing")).args(arguments).output().unwrap()
}

#[test]
fn a_run_ends_with_its_key_figures_and_times_are_short() {
    let place = Place::new();
    let numerics = "end = \"2 ms\"\nstep = \"2 us\"\noutput_interval = \"10 us\"";
    let scene = place.scene("scene.toml", &scene(numerics, ""));
    let out = place.path("out");
    let output = run(&scene, &out, &[]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let said = said(&output);
    let summary = json(out.join("summary.json"));
    // The figures are those of the table.
    let mean = |axis: &str| {
        let channel = &summary["window"]["channels"][format!("inner_{axis}")]["mean"];
        format!("{:.6}", 1e6 * channel["value"].as_f64().unwrap())
    };
    let line = ["x", "y", "z"].map(mean).join(", ");
    for part in [line.as_str(), "largest ball load", "energy unaccounted for", "1000 in "] {
        assert!(said.contains(part), "{part} is not in {said}");
    }
    // 10 µs times a row number, which 1e-5 + 1e-5 + … is not.
    let series = fs::read_to_string(out.join("series.csv")).unwrap();
    for (row, line) in series.lines().skip(1).enumerate() {
        let time = line.split(',').next().unwrap();
        let parsed: f64 = time.parse().unwrap();
        assert!(time.len() <= 7, "row {row}: {time}");
        assert!((parsed - 1e-5 * row as f64).abs() <= 1e-15, "row {row}: {time}");
    }
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
fn the_plan_says_how_long_the_steps_are_and_what_makes_them_short() {
    let place = Place::new();
    let plan = |text: &str| {
        let path = place.scene("scene.toml", text);
        let output = bearing(&["plan", path.to_str().unwrap()]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        said(&output)
    };
    // Without friction the contacts bind the step.
    let text = scene("end = \"1 ms\"\nintegrator = \"rk4\"", "");
    let free = plan(&text);
    for part in ["of the largest stable one at the start", "contact", "steps to t = 0.001 s"] {
        assert!(free.contains(part), "{part} is not in {free}");
    }
    assert!(!free.contains("short step"), "{free}");
    // From rest the floor of the friction law does, and ten times the floor takes ten times the step.
    let default = text.replace("law = \"none\"", "law = \"slide-to-roll\"").replace(
        "speed = \"1000 rpm\"",
        "speed = { ramp = [\"0 rpm\", \"1000 rpm\"], start = \"0 s\", duration = \"1 ms\" }",
    );
    let short = plan(&default);
    for part in [
        "traction onset",
        "short step",
        "accuracy = 1e-3",
        "entrainment_floor = \"0.1 m/s\", 10 times",
    ] {
        assert!(short.contains(part), "{part} is not in {short}");
    }
    let number = |text: &str, before: &str| -> f64 {
        let rest = text.split(before).nth(1).unwrap_or_else(|| panic!("{before} in {text}"));
        rest.split(' ').next().unwrap().parse().unwrap()
    };
    let limit = number(&short, "one at the start, ");
    let longer = number(&short, "stable up to ");
    assert!((longer / limit - 10.0).abs() <= 0.1, "{limit} {longer}");
    // The step is the one that the run takes.
    let path = place.scene("scene.toml", &default.replace("\"1 ms\"\n", "\"1 us\"\n"));
    let output = run(&path, &place.path("out"), &[]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(said(&output).contains("traction onset"), "{}", said(&output));
    let adaptive = plan(&text.replace("\"rk4\"", "\"rosenbrock\""));
    assert!(adaptive.contains("adapts so that") && adaptive.contains("0.001"), "{adaptive}");
}

#[test]
fn check_tells_of_the_motion_of_a_run() {
    let place = Place::new();
    let check = |text: &str| {
        let path = place.scene("scene.toml", text);
        said(&bearing(&["check", path.to_str().unwrap()]))
    };
    let run = scene("end = \"1 ms\"\nintegrator = \"rk4\"", "");
    let moving = check(&run.replace("[traction]", "[outer_race]\nmotion = \"5-dof\"\n[traction]"));
    assert!(moving.contains("to t = 0.001 s by rk4"), "{moving}");
    assert!(moving.contains("5 of 6 coordinates follow from loads"), "{moving}");
    assert!(!moving.contains("centrifugal force of the balls is left out"), "{moving}");
    assert!(!moving.contains("the outer race is fixed"), "{moving}");
    assert!(check(&run).contains("outer race motion      fixed in space"), "{}", check(&run));
    // One of statics speaks of statics.
    let statics = check(&run.replace("[numerics]\nend = \"1 ms\"\nintegrator = \"rk4\"", ""));
    assert!(statics.contains("centrifugal force of the balls is left out"), "{statics}");
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
        assert!(message.contains("there are: ") && message.contains(" m/s,"), "{message}");
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

/// A single bearing with an axial load and nothing else free, and what follows its races.
fn one_angular_contact(load: &str, speed: &str, rest: &str) -> String {
    format!(
        r#"
[bearing]
kind = "angular-contact"
balls = 11
pitch_radius = "30 mm"
contact_angle = "35 deg"
clearance = {{ radial = "0 um" }}
inner_race = {{ groove_radius = "6.6 mm" }}
outer_race = {{ groove_radius = "6.6 mm" }}
ball = {{ radius = "5.953 mm" }}
[inner_race]
x = {{ load = "{load}" }}
y = {{ displacement = "0 um" }}
z = {{ displacement = "0 um" }}
tilt_y = {{ tilt = "0 deg" }}
tilt_z = {{ tilt = "0 deg" }}
speed = "{speed}"
{rest}"#
    )
}

/// What statics says of an equilibrium a run says of its steps, on the terminal and in its summary.
#[test]
fn a_run_has_the_remarks_of_statics() {
    let place = Place::new();
    let remarks = |text: &str| -> [Vec<String>; 2] {
        let path = place.scene("scene.toml", text);
        let out = place.path("out");
        let output = run(&path, &out, &["--fresh"]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let notes = |output: &Output| -> Vec<String> {
            let said = said(output);
            said.lines().filter_map(|line| line.strip_prefix("note: ").map(String::from)).collect()
        };
        let written = &json(out.join("summary.json"))["remarks"];
        let found = notes(&output);
        assert_eq!(*written, serde_json::json!(found));
        [found, notes(&bearing(&["statics", path.to_str().unwrap(), "--dry"]))]
    };
    let short = scene("end = \"0.1 ms\"", "");
    assert_eq!(remarks(&short), [Vec::<String>::new(), Vec::new()]);
    let has = |text: &str, part: &str| {
        for notes in remarks(text) {
            assert!(notes.iter().any(|note| note.contains(part)), "{part} is not in {notes:?}");
        }
    };
    let pressed = short.replace("\"-250 N\"", "\"-100 kN\"");
    has(&pressed, "MPa");
    has(&pressed, "above the 4200 MPa at which ISO 76");
    // A shoulder hardly higher than the groove, and a tilt that lets the balls climb.
    let low = short
        .replace("bore_radius", "shoulder_radius = \"20.1 mm\", bore_radius")
        .replace("0.05 deg", "0.3 deg");
    has(&low, "past the shoulder, which ends at");
    has(&low, "as given");
    // Nothing but the sixth coordinate holds an angular-contact bearing pushed the wrong way.
    let single = &one_angular_contact("-445 N", "600 rpm", "[numerics]\nend = \"0.5 ms\"\n");
    has(single, "loaded at a negative contact angle");
    has(single, "the centres of the races are 1.49");
    // Equilibrium alone leaves out what the balls' own spin asks for.
    let fast = format!("{single}[ball_forces]\ncentrifugal = true\n");
    let fast = fast.replace("-445 N", "200 N").replace("600 rpm", "15000 rpm");
    let [of_run, of_statics] = remarks(&fast);
    let gyroscopic =
        |notes: &[String]| notes.iter().any(|note| note.contains("no gyroscopic moment"));
    assert!(gyroscopic(&of_statics) && !gyroscopic(&of_run), "{of_run:?} {of_statics:?}");
    let slow = fast.replace("15000 rpm", "600 rpm");
    assert!(!gyroscopic(&remarks(&slow)[1]));
}

/// Balls that nothing keeps apart strike each other harder than the races.
#[test]
fn the_largest_pressure_may_be_one_between_balls() {
    let place = Place::new();
    let text = r#"
[bearing]
kind = "deep-groove"
balls = 12
ball_phase = "17 deg"
clearance = { radial = "10 um", through = "inner-race" }
inner_race = { groove_radius = "6.1 mm" }
outer_race = { radius = "31.953 mm", groove_radius = "6.31 mm" }
ball = { radius = "5.95 mm" }
[inner_race]
x = { displacement = "0 um" }
y = { displacement = "0 um" }
z = { displacement = "0 um" }
tilt_y = { tilt = "0 deg" }
tilt_z = { tilt = "0 deg" }
[ball_forces]
gravity = ["0 m/s^2", "0 m/s^2", "-1000 m/s^2"]
[traction]
law = "none"
[numerics]
end = "6 ms"
start = "nominal"
"#;
    let (path, out) = (place.scene("scene.toml", text), place.path("out"));
    let output = run(&path, &out, &[]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let summary = json(out.join("summary.json"));
    let largest = &summary["extremes"]["between_balls"]["largest_load"];
    let of = |value: &Value| value["value"].as_f64().unwrap_or_else(|| panic!("{value}"));
    // Hertz, E* = E/(2 (1 - ν²)), R = r/2: p = (6 F E*²/(π³ R²))^(1/3).
    let (modulus, half) = (105e9 / 0.91, 0.5 * 5.95e-3);
    let cube = 6.0 * of(&largest["load"]) * modulus * modulus
        / (std::f64::consts::PI.powi(3) * half * half);
    let pressure = cube.cbrt();
    assert!((of(&largest["peak_pressure"]) / pressure - 1.0).abs() <= 1e-9, "{largest} {pressure}");
    let races = ["inner_race", "outer_race"]
        .map(|race| of(&summary["extremes"][race]["largest_load"]["peak_pressure"]));
    assert!(races.iter().all(|race| *race < pressure), "{races:?} {pressure}");
    let said = said(&output);
    let told = number_after(&said, "note: a contact pressure of ");
    assert!(
        (told - 1e-6 * pressure).abs() <= 0.501 && said.contains("MPa between two balls at"),
        "{said}"
    );
    let told = number_after(&said, "largest between balls  ");
    assert!((told - of(&largest["load"])).abs() <= 0.501e-6, "{said}");
}

/// A number behind some words of a text.
fn number_after(text: &str, words: &str) -> f64 {
    let at = text.find(words).unwrap_or_else(|| panic!("{words:?} is not in {text}"));
    let rest = &text[at + words.len()..];
    let end = rest.find(|c: char| !"0123456789.-e".contains(c)).unwrap_or(rest.len());
    rest[..end].parse().unwrap_or_else(|_| panic!("no number behind {words:?} in {text}"))
}

/// The numbers in remarks are those of the balls that they name.
#[test]
fn remarks_tell_numbers_of_the_results() {
    let place = Place::new();
    let results = |text: &str| {
        let path = place.scene("scene.toml", text);
        let out = place.path("statics");
        let arguments = ["statics", path.to_str().unwrap(), "--out", out.to_str().unwrap()];
        let output = bearing(&arguments);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        json(out.join("summary.json"))
    };
    let remark = |summary: &Value, part: &str| {
        let remarks = summary["remarks"].as_array().unwrap().iter();
        let mut found = remarks.filter_map(|r| r.as_str().filter(|r| r.contains(part)));
        found.next().unwrap_or_else(|| panic!("{part}: {}", summary["remarks"])).to_string()
    };
    let of = |value: &Value| value["value"].as_f64().unwrap_or_else(|| panic!("{value}"));
    // A contact past the shoulder of either race: told to a tenth of a degree.
    let short = scene("end = \"0.1 ms\"", "").replace("0.05 deg", "0.3 deg");
    for (race, own, shoulder) in [
        ("inner", "bore_radius", "shoulder_radius = \"20.1 mm\", bore_radius"),
        (
            "outer",
            "groove_radius = \"6.310 mm\"",
            "groove_radius = \"6.310 mm\", shoulder_radius = \"31.9 mm\"",
        ),
    ] {
        let summary = results(&short.replace(own, shoulder));
        let said = remark(&summary, "past the shoulder");
        assert!(said.contains(&format!("with the {race} race")), "{said}");
        let ball = number_after(&said, "the contact of ball ") as usize;
        let exact = of(&summary["balls"][ball - 1][race]["contact_angle"]).abs();
        let told = number_after(&said, "(contact angle ");
        assert!((told - exact).abs() <= 0.0501, "{said} {exact}");
    }
    // All balls alike under an axial load: J Ω² (R/r) sin α against μ r (Q_i + Q_o).
    let fast = one_angular_contact("200 N", "15000 rpm", "[ball_forces]\ncentrifugal = true\n");
    let (radius, pitch, rpm) = (5.953e-3f64, 30e-3, std::f64::consts::PI / 30.0);
    let mass = 7850.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let orbit = |speed: f64| 0.5 * (1.0 - radius / pitch * 35f64.to_radians().cos()) * speed * rpm;
    for (load, speed) in [("200 N", 15e3), ("800 N", 12e3)] {
        let text = fast.replace("200 N", load).replace("15000 rpm", &format!("{speed} rpm"));
        let summary = results(&text);
        let said = remark(&summary, "no gyroscopic moment");
        let [inner, outer] = ["inner", "outer"].map(|side| &summary["balls"][0][side]);
        let angle = of(&outer["contact_angle"]).to_radians();
        // The axis of a ball that rolls on the outer race without spin there lies at Harris's angle β,
        // tan β = r sin α/(R + r cos α) against the line to the bearing's axis; ω of the ball itself in the orbit's frame.
        let (arm, up) = (pitch + radius * angle.cos(), radius * angle.sin());
        let beta = (pitch * angle.sin()).atan2(pitch * angle.cos() + radius);
        let own = orbit(speed) * arm / (radius * (angle - beta).cos());
        let moment = 0.4 * mass * radius * radius * own * orbit(speed) * beta.sin();
        assert!(up > 0.0 && moment > 0.0);
        let traction = 100.0 * moment / (radius * (of(&inner["load"]) + of(&outer["load"])));
        // Told to a tenth of a per cent, and to 1e-4 N mm.
        let told = number_after(&said, "which takes traction of ");
        assert!((told - traction).abs() <= 0.0501, "{said} {traction}");
        let told = number_after(&said, "up to ");
        assert!((told - 1e3 * moment).abs() <= 0.501e-4, "{said} {moment}");
        if load == "800 N" {
            // As a program of Harris's formulas had it.
            assert!((told - 63.68).abs() <= 0.006, "{said}");
        }
    }
    // Left out, centrifugal force is told: m Ω² R beside the largest load.
    let summary = results(&fast.replace("centrifugal = true", "centrifugal = false"));
    let said = remark(&summary, "is left out");
    let force = mass * orbit(15e3).powi(2) * pitch;
    let told = number_after(&said, "of a ball at this speed, ");
    assert!((told - force).abs() <= 0.501e-3, "{said} {force}");
    let largest = of(&summary["balls"][0]["outer"]["load"]);
    let told = number_after(&said, "is left out: ");
    assert!((told - 100.0 * force / largest).abs() <= 0.0501, "{said} {largest}");
    let slow = fast.replace("centrifugal = true", "centrifugal = false").replace("15000", "600");
    let summary = results(&slow);
    let remarks = summary["remarks"].as_array().unwrap();
    assert!(remarks.iter().all(|r| !r.as_str().unwrap().contains("is left out")), "{remarks:?}");
}
