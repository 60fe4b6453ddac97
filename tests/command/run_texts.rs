//! Texts of `run`, `plan`, `check` and `statics` of bearings: key figures, steps, motion; and what they are compared with.

use super::run_command::{bearing, code, run, said, scene};
use crate::solid_command_common::{Place, json, stderr};

use serde_json::Value;
use std::fs;
use std::process::Output;

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
    let default = text.replace("law = \"none\"", "law = \"slide-to-roll\"").replace(
        "speed = \"1000 rpm\"",
        "speed = { ramp = [\"0 rpm\", \"1000 rpm\"], start = \"0 s\", duration = \"1 ms\" }",
    );
    assert!(plan(&default).contains("decay at "), "{}", plan(&default));
    // The step is the one that the run takes.
    let path = place.scene("scene.toml", &default.replace("\"1 ms\"\n", "\"1 us\"\n"));
    let output = run(&path, &place.path("out"), &[]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(said(&output).contains("decay at "), "{}", said(&output));
    let adaptive = plan(&text.replace("\"rk4\"", "\"rosenbrock\""));
    assert!(
        adaptive.contains("adaptive: error of the races' motion") && adaptive.contains("0.001"),
        "{adaptive}"
    );
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
    assert!(!moving.contains("centrifugal force of the balls is neglected"), "{moving}");
    assert!(!moving.contains("the outer race is fixed"), "{moving}");
    assert!(check(&run).contains("outer race motion      fixed in space"), "{}", check(&run));
    // One of statics speaks of statics.
    let statics = check(&run.replace("[numerics]\nend = \"1 ms\"\nintegrator = \"rk4\"", ""));
    assert!(statics.contains("centrifugal force of the balls is neglected"), "{statics}");
}

/// Balls that nothing keeps apart strike each other harder than the races.
#[test]
fn the_largest_pressure_may_be_one_between_balls() {
    let place = Place::new();
    let text = r#"
defaults = "dissertation"
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
    assert!(said.contains("warning[W03-pressure-above-rating]"), "{said}");
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

/// An outer race whose places are given.
const HELD: &str = r#"x = { displacement = "0 um" }
y = { displacement = "0 um" }
z = { displacement = "0 um" }
tilt_y = { tilt = "0 deg" }
tilt_z = { tilt = "0 deg" }
"#;

/// Next to a housing the steps of all are printed once.
#[test]
fn a_bushing_in_elements_is_told_as_such() {
    let place = Place::new();
    let cells = "cells = { around = 6, radial = 2, axial = 2 }";
    let elements = format!("table = \"3.1\"\nmethod = \"explicit\"\n{cells}");
    let shipped = include_str!("../../scenes/bearing_on_bushing.toml");
    assert!(shipped.contains("table = \"3.1\""));
    let scene = place.scene("elements.toml", &shipped.replace("table = \"3.1\"", &elements));
    let scene = scene.to_str().unwrap();
    let plan = said_by(&bearing(&["plan", scene]));
    assert!(plan.contains("of the bushing mount and steps of the bearing"), "{plan}");
    assert!(!plan.contains("springs of bushing mount are off"), "{plan}");
    let spring = format!(
        "[spring.mount]\nfrom = \"ground\"\nto = \"inner_race\"\n\n[spring.mount.bushing]\n\
         inner_diameter = \"30 mm\"\nouter_diameter = \"50 mm\"\nlength = \"20 mm\"\n{elements}\n\n[numerics]"
    );
    let housed = include_str!("../../scenes/housing_impact.toml");
    let scene = place.scene("both.toml", &housed.replace("[numerics]", &spring));
    let plan = said_by(&bearing(&["plan", scene.to_str().unwrap()]));
    let steps: Vec<&str> = plan.lines().filter(|line| line.contains("coupling steps of")).collect();
    assert!(matches!(steps[..], [one] if one.contains("of the bushing mount")), "{plan}");
}

fn said_by(output: &Output) -> String {
    assert_eq!(code(output), 0, "{}", stderr(output));
    said(output)
}

/// What holds a race is named, where a spring does.
#[test]
fn a_race_on_a_spring_is_not_told_to_have_none() {
    let shipped = crate::command_line_common::scene("bearing_on_bushing.toml");
    let check = said_by(&bearing(&["check", &shipped]));
    assert!(check.contains("the moving outer race is held by spring mount"), "{check}");
    assert!(!check.contains("no spring holds"), "{check}");
}

/// `--set` is `--vary` with one value.
#[test]
fn keys_can_be_replaced_from_the_command_line() {
    let shipped = crate::command_line_common::scene("settling.toml");
    let plan = |set: &str| bearing(&["plan", &shipped, "--set", set]);
    let shorter = said_by(&plan("numerics.end=0.1 s"));
    assert!(shorter.contains("steps to t = 0.1 s"), "{shorter}");
    for (set, why) in
        [("numerics.end", "write --set"), ("numerics.ende=1 s", "ende"), ("numerics.end=1 N", "N")]
    {
        let output = plan(set);
        assert_eq!(code(&output), 2, "{set}");
        assert!(stderr(&output).contains(why), "{}", stderr(&output));
    }
}

/// A run-up over a speed that is held would be a picture of nothing: that is said, and not where something speeds up.
#[test]
fn a_run_up_at_a_speed_that_is_held_is_told_not_to_be_drawn() {
    let place = Place::new();
    let text =
        scene("end = \"1 ms\"\noutput_interval = \"10 us\"", "plots = [\"run-up\", \"series\"]");
    let rising = text.replace(
        "speed = \"1000 rpm\"",
        "speed = { ramp = [\"500 rpm\", \"1000 rpm\"], start = \"0 s\", duration = \"1 ms\" }",
    );
    for (name, text, drawn) in [("held", &text, false), ("rising", &rising, true)] {
        let out = place.path(name);
        let output = run(&place.scene(&format!("{name}.toml"), text), &out, &[]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        assert_eq!(out.join("run_up_inner_race.svg").exists(), drawn, "{name}");
        let told = said(&output);
        assert_eq!(told.matches("`run-up` draws nothing").count(), usize::from(!drawn));
        assert!(out.join("series_inner_race.svg").exists());
    }
}

/// Equilibria have ideal races and balls, so that a sequence of them is refused.
#[test]
fn dents_are_refused_in_equilibria_over_time() {
    let place = Place::new();
    let plain = include_str!("../../scenes/housing_a_rotating_load.toml");
    assert!(plain.contains("quasi-static"));
    let dent = "\n[[bearing.dent]]\nrace = \"outer\"\nangle = \"270 deg\"\ndiameter = \"500 um\"\n";
    let scene = place.scene("course.toml", &format!("{plain}{dent}"));
    let output = bearing(&["check", scene.to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(stderr(&output).contains("ideal races and balls"), "{}", stderr(&output));
}

/// An outer race that moves by itself is part of the equilibrium, as it is where a run starts.
#[test]
fn statics_of_a_moving_outer_race_are_the_start_of_its_run() {
    let place = Place::new();
    let outer = "[outer_race]\nmotion = \"5-dof\"\nz = { load = \"-1000 N\" }\n[outer_race.foundation]\n\
                 stiffness = { x = \"1e7 N/m\", y = \"1e7 N/m\", z = \"1e7 N/m\", tilt_y = \"1e4 N m/rad\", tilt_z = \"1e4 N m/rad\" }\n";
    let text = scene("end = \"20 us\"\nstep = \"2 us\"\noutput_interval = \"10 us\"", "plots = []")
        .replace(
            "gravity = [\"0 m/s^2\", \"0 m/s^2\", \"-9.80665 m/s^2\"]",
            "gravity = [\"0 m/s^2\", \"0 m/s^2\", \"0 m/s^2\"]",
        )
        .replace("[traction]", &format!("{outer}[traction]"));
    let path = place.scene("scene.toml", &text);
    let (still, moving) = (place.path("still"), place.path("moving"));
    let [path, still_text] = [&path, &still].map(|path| path.to_str().unwrap());
    let output = bearing(&["statics", path, "--out", still_text]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(code(&run(path.as_ref(), &moving, &[])), 0);
    let rows = fs::read_to_string(moving.join("series.csv")).unwrap();
    let header: Vec<&str> = rows.lines().next().unwrap().split(',').collect();
    let first: Vec<&str> = rows.lines().nth(1).unwrap().split(',').collect();
    let at = |name: &str| {
        let column = header.iter().position(|column| column.starts_with(name)).unwrap();
        first[column].parse::<f64>().unwrap()
    };
    let summary = json(still.join("summary.json"));
    // 1250 N on 1e7 N/m; balls that go round push besides, 0.04 N here.
    assert!((at("outer_z") + 125e-6).abs() <= 1e-8, "{}", at("outer_z"));
    for (body, column) in [("inner_race", "inner_z"), ("outer_race", "outer_z")] {
        let still = &summary["bodies"][body]["position"]["z"];
        assert_eq!(still["unit"], "m");
        let off = still["value"].as_f64().unwrap() - at(column);
        assert!(off.abs() <= 1e-8, "{body}: {off:e}");
    }
    let said = said(&bearing(&[
        "sweep",
        path,
        "--vary",
        "outer_race.z.load=-1000 N, 0 N",
        "--out",
        place.path("sweep").to_str().unwrap(),
    ]));
    assert!(said.contains("2 points"), "{said}");
    let table = fs::read_to_string(place.path("sweep").join("sweep.csv")).unwrap();
    let [one, other] = [1, 2].map(|row| table.lines().nth(row).unwrap().split_once(',').unwrap().1);
    assert_ne!(one.split_once(',').unwrap().1, other.split_once(',').unwrap().1);
}

/// A loose race that spins is held by nothing: there are no motions to tell, which is no error.
#[test]
fn modes_of_a_loose_race_that_spins_are_none() {
    let place = Place::new();
    let text = scene("end = \"1 ms\"", "plots = []")
        .replace("\"-5 um\"", "\"10 um\"")
        .replace("z = { load = \"-250 N\" }\n", "")
        .replace("tilt_y = { tilt = \"0.05 deg\" }\ntilt_z = { tilt = \"0 deg\" }\n", "")
        .replace("\"-9.80665 m/s^2\"", "\"0 m/s^2\"");
    let scene = place.scene("scene.toml", &text);
    let output = bearing(&["modes", scene.to_str().unwrap(), "--dry"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let said = said(&output);
    assert!(
        said.contains("not computed: the rotor has no support by a bearing load or a spring"),
        "{said}"
    );
    assert!(said.contains("warning[W01-indeterminate-position]"), "{said}");
}

/// Ratios to the shaft are those of the frequencies beside them, where the outer race turns too.
#[test]
fn frequencies_over_the_shaft_are_that() {
    let place = Place::new();
    let frequencies = |inner: f64, outer: f64| {
        let turning =
            format!("[outer_race]\nmotion = \"5-dof\"\nspeed = \"{outer} rpm\"\n{HELD}[traction]");
        let text = scene("end = \"1 ms\"", "plots = []")
            .replace("1000 rpm", &format!("{inner} rpm"))
            .replace("[traction]", &turning);
        let out = place.path("out");
        let path = place.scene("scene.toml", &text);
        let arguments = ["statics", path.to_str().unwrap(), "--out", out.to_str().unwrap()];
        let output = bearing(&arguments);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let summary = json(out.join("summary.json"));
        let all = &summary["bearings"]["bearing"]["frequencies"];
        if all.is_null() { summary["frequencies"].clone() } else { all.clone() }
    };
    for (inner, outer) in [(1000.0, 0.0), (1000.0, 400.0), (1000.0, -400.0), (0.0, 400.0)] {
        let all = frequencies(inner, outer);
        let (name, turns) =
            if inner == 0.0 { ("over_outer_race", outer) } else { ("over_shaft", inner) };
        for of in ["cage", "ball_pass_outer", "ball_pass_inner", "ball_spin"] {
            let value = |name: &str| all[of][name]["value"].as_f64();
            let expected = value("frequency").unwrap() / (turns / 60.0);
            let found = value(name).unwrap_or_else(|| panic!("{name}: {all}"));
            assert!((found / expected - 1.0).abs() <= 1e-12, "{inner} {outer} {of}: {all}");
        }
    }
}
