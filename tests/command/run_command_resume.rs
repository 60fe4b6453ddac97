//! Runs of the command that are interrupted, killed, extended or changed, and go on.

use super::run_command::{ALL_PLOTS, code, command, run, said, scene};
use crate::command_line_common;
use crate::resume_common::{
    NEVER, assert_same_results, end_after, interrupted, signal, start, stopped, wait,
};
use crate::solid_command_common::{Place, json, stderr};

use std::fs;
use std::time::{Duration, Instant};

#[test]
fn interrupted_by_a_signal_and_resumed() {
    let place = Place::new();
    let of = |end: &str| {
        let numerics = "step = \"2 us\"\noutput_interval = \"0.4 ms\"";
        place.scene("scene.toml", &scene(&format!("end = \"{end}\"\n{numerics}"), ALL_PLOTS))
    };
    let scene = of(NEVER);
    let whole = place.path("whole");
    let parts = place.path("parts");
    interrupted(command(&scene, &parts, &[]), 60, &parts);
    let summary = json(parts.join("summary.json"));
    let rows = fs::read_to_string(parts.join("series.csv")).unwrap().lines().count() - 1;
    assert_eq!(summary["output"]["rows"], rows);
    assert!(rows > 1, "{rows}");

    // Without a word about it nothing is overwritten.
    let refused = run(&scene, &parts, &[]);
    assert_eq!(code(&refused), 2);
    assert!(stderr(&refused).contains("--resume") && stderr(&refused).contains("--fresh"));
    assert_eq!(json(parts.join("summary.json")), summary);

    // What the scene says already, given once more: the command to go on has it as it was written.
    let again = ["--resume", "--set", "numerics.step=2 us", "--set", "bearing.balls=8"];
    let (ended, message) = stopped(command(&scene, &parts, &again), 30, "-INT");
    assert_eq!(ended, Some(2));
    assert!(
        message.contains(" --set \"numerics.step=2 us\" --set \"bearing.balls=8\" --resume"),
        "{message}"
    );
    let scene = of(&end_after(&parts, 100.001));
    let output = run(&scene, &parts, &["--resume"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(String::from_utf8_lossy(&output.stdout).contains("resumed at t = "));
    assert!(!String::from_utf8_lossy(&output.stdout).contains("no trial could start"));
    assert_eq!(code(&run(&scene, &whole, &[])), 0);
    assert_same_results(&whole, &parts);
}

/// What does not let a run go on is named with what it was.
#[test]
fn a_run_that_cannot_go_on_says_what_has_changed() {
    let place = Place::new();
    let text = scene("end = \"1 ms\"\nstep = \"2 us\"", "plots = []");
    let parts = place.path("parts");
    assert_eq!(code(&run(&place.scene("scene.toml", &text), &parts, &[])), 0);
    let longer = text.replace("\"1 ms\"", "\"2 ms\"");
    for (from, to, change) in [
        ("\"-250 N\"", "\"-251 N\"", "inner_race.z"),
        ("\"1000 rpm\"", "\"1001 rpm\"", "inner_race.speed"),
        ("mass = \"20 g\"", "mass = \"21 g\"", "bearing.cage.mass was 0.02 kg, is 0.021 kg"),
    ] {
        let changed = place.scene("changed.toml", &longer.replace(from, to));
        let output = run(&changed, &parts, &["--resume"]);
        assert_eq!(code(&output), 2);
        let message = stderr(&output);
        // First what was written, then what follows from it.
        assert!(message.contains(&format!("; changed: scene.{change}")), "{message}");
    }
    assert_eq!(code(&run(&place.scene("longer.toml", &longer), &parts, &["--resume"])), 0);
}

#[test]
fn a_resumed_run_keeps_the_method_of_the_plan_and_its_reason() {
    let place = Place::new();
    let of = |end: &str| {
        let numerics = format!("end = \"{end}\"\noutput_interval = \"1 ms\"");
        place.scene("scene.toml", &scene(&numerics, "plots = []"))
    };
    let (whole, parts) = (place.path("whole"), place.path("parts"));
    interrupted(command(&of(NEVER), &parts, &[]), 60, &parts);
    let scene = of(&end_after(&parts, 100.0));
    let output = run(&scene, &parts, &["--resume"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(
        said(&output).contains("chosen: slip decay rate over contact frequency"),
        "{}",
        said(&output)
    );
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
/// An interval that follows from the end stays what it was at first, however often the end is put off.
#[test]
fn a_run_is_extended_again_and_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = |end: &str| {
        let content =
            fs::read_to_string(command_line_common::scene("settling_by_accuracy.toml")).unwrap();
        let lines = content.lines().filter(|line| !line.starts_with("output_interval"));
        let lines = lines.map(|line| match line.starts_with("end = ") {
            true => format!("end = \"{end}\"\n"),
            false => format!("{line}\n"),
        });
        command_line_common::write(
            folder.path(),
            &format!("{end}.toml"),
            &lines.collect::<String>(),
        )
    };
    let out = command_line_common::text(&folder.path().join("out"));
    command_line_common::done(&["run", &at("2 ms"), "--out", &out]);
    for end in ["4 ms", "6 ms", "7 ms"] {
        let said = command_line_common::done(&["run", &at(end), "--out", &out, "--resume"]);
        assert!(said.contains("a row every 2.0000e-6 s"), "{said}");
    }
    let shorter = command_line_common::bearing(&["run", &at("3 ms"), "--out", &out, "--resume"]);
    assert!(
        shorter.code == Some(2) && shorter.stderr.contains("has already reached 0.00"),
        "{shorter:?}"
    );
}
