//! What `run`, `plan` and `check` say of a run: key figures, steps, remarks.

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

/// An outer race whose places are given.
pub const HELD: &str = r#"x = { displacement = "0 um" }
y = { displacement = "0 um" }
z = { displacement = "0 um" }
tilt_y = { tilt = "0 deg" }
tilt_z = { tilt = "0 deg" }
"#;

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
    // All balls alike under an axial load: J Ω (Ω − ω_o)(R/r) sin α against μ r (Q_i + Q_o).
    let fast = one_angular_contact("200 N", "15000 rpm", "[ball_forces]\ncentrifugal = true\n");
    let (radius, pitch, rpm) = (5.953e-3f64, 30e-3, std::f64::consts::PI / 30.0);
    let mass = 7850.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let orbit = |speed: f64| 0.5 * (1.0 - radius / pitch * 35f64.to_radians().cos()) * speed * rpm;
    let cases = [
        ("200 N", 15e3, 0.0),
        ("800 N", 12e3, 0.0),
        ("3000 N", 20e3, -5e3),
        ("3000 N", 20e3, 0.0),
        ("3000 N", 20e3, 10e3),
    ];
    for (load, speed, outer_speed) in cases {
        let text = fast.replace("200 N", load).replace("15000 rpm", &format!("{speed} rpm"));
        let turning = format!(
            "{text}[outer_race]\nmotion = \"5-dof\"\nspeed = \"{outer_speed} rpm\"\n{HELD}"
        );
        let turning = if outer_speed == 0.0 { text } else { turning };
        let mut summary = results(&turning);
        if outer_speed != 0.0 {
            summary["balls"] = summary["bearings"]["bearing"]["balls"].clone();
        }
        let said = remark(&summary, "no gyroscopic moment");
        let [inner, outer] = ["inner", "outer"].map(|side| &summary["balls"][0][side]);
        let angle = of(&outer["contact_angle"]).to_radians();
        // The axis of a ball that rolls on the outer race without spin there lies at Harris's angle β,
        // tan β = r sin α/(R + r cos α) against the line to the bearing's axis; ω of the ball itself in the orbit's frame,
        // where the outer race turns back.
        let (arm, up) = (pitch + radius * angle.cos(), radius * angle.sin());
        let beta = (pitch * angle.sin()).atan2(pitch * angle.cos() + radius);
        let past = orbit(speed - outer_speed);
        let own = past * arm / (radius * (angle - beta).cos());
        let moment = 0.4 * mass * radius * radius * own * (past + outer_speed * rpm) * beta.sin();
        assert!(up > 0.0 && moment > 0.0);
        let traction = 100.0 * moment / (radius * (of(&inner["load"]) + of(&outer["load"])));
        // Told to a tenth of a per cent, and to 1e-4 N mm.
        let told = number_after(&said, "traction of ");
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
    // Balls that are not alike: the ball with the largest moment need not be the one that needs most traction.
    let uneven = fast.replace("z = { displacement = \"0 um\" }", "z = { load = \"-300 N\" }");
    let summary = results(&uneven.replace("15000 rpm", "25000 rpm"));
    let said = remark(&summary, "no gyroscopic moment");
    let balls = summary["balls"].as_array().unwrap();
    let moment = |ball: &Value| {
        let sine = of(&ball["outer"]["contact_angle"]).to_radians().sin();
        0.4 * mass * radius * pitch * orbit(25e3).powi(2) * sine
    };
    let share = |ball: &Value| {
        moment(ball) / (radius * (of(&ball["inner"]["load"]) + of(&ball["outer"]["load"])))
    };
    let most = |of: &dyn Fn(&Value) -> f64| {
        let all = balls.iter().map(of).enumerate();
        all.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
    };
    let (highest, worst) = (most(&moment), most(&share));
    assert_ne!(highest.0, worst.0);
    assert!((number_after(&said, "up to ") - 1e3 * highest.1).abs() <= 0.501e-4, "{said}");
    assert!((number_after(&said, "traction of ") - 100.0 * worst.1).abs() <= 0.0501, "{said}");
    assert!(said.contains(&format!("of ball {}", worst.0 + 1)), "{said} {worst:?}");
}

/// Equilibria have races without dents: `statics` says so, a course of them is refused.
#[test]
fn equilibria_say_that_dents_are_left_out() {
    let place = Place::new();
    let dented = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/dented_race.toml");
    let output = bearing(&["statics", dented]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(said(&output).contains("dents are left out"), "{}", said(&output));
    let plain = include_str!("../../scenes/housing_a_rotating_load.toml");
    assert!(plain.contains("quasi-static"));
    let dent = "\n[[bearing.dent]]\nrace = \"outer\"\nangle = \"270 deg\"\ndiameter = \"500 um\"\n";
    let scene = place.scene("course.toml", &format!("{plain}{dent}"));
    let output = bearing(&["check", scene.to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(stderr(&output).contains("races without dents"), "{}", stderr(&output));
}

/// A hundredth of a wall is within what the springs of a bushing hold, a sixth is beyond, and the run says where that is (what `plan` says of another scene stands in the README).
#[test]
fn a_run_says_where_it_took_a_bushing_beyond_its_springs() {
    let place = Place::new();
    let shipped = crate::command_line_common::scene("bearing_on_bushing.toml");
    let out = place.path("out");
    let pushed = |load: &str| {
        let load = format!("inner_race.z.load={load}");
        let output = bearing(&[
            "run",
            &shipped,
            "--set",
            &load,
            "--set",
            "numerics.end=1 ms",
            "--set",
            "output.window_start=0 s",
            "--fresh",
            "--out",
            out.to_str().unwrap(),
        ]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let summary = json(out.join("summary.json"));
        let remarks = summary["remarks"].as_array().unwrap().iter();
        remarks.map(|said| said.as_str().unwrap().to_string()).collect::<Vec<_>>()
    };
    let within = pushed("-150 N");
    assert!(!within.iter().any(|said| said.contains("bushing")), "{within:?}");
    let beyond = pushed("-2500 N");
    let said = beyond.iter().find(|said| said.contains("bushing mount went 1.7 mm across"));
    assert!(
        said.is_some_and(|said| said.contains("off by 2 % from 1.2 mm across on")),
        "{beyond:?}"
    );
}

/// In elements a bushing has no springs to say of how far they hold; an equilibrium, which takes them nevertheless, says so.
/// Beside a housing the steps of all are told once.
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
    for command in ["statics", "modes"] {
        let said = said_by(&bearing(&[command, scene]));
        assert!(
            said.contains("bushing mount: its fitted springs stand for its elements here"),
            "{said}"
        );
    }
    let spring = format!(
        "[spring.mount]\nfrom = \"ground\"\nto = \"inner_race\"\n\n[spring.mount.bushing]\n\
         inner_diameter = \"30 mm\"\nouter_diameter = \"50 mm\"\nlength = \"20 mm\"\n{elements}\n\n[numerics]"
    );
    let housed = include_str!("../../scenes/housing_impact.toml");
    let scene = place.scene("both.toml", &housed.replace("[numerics]", &spring));
    let plan = said_by(&bearing(&["plan", scene.to_str().unwrap()]));
    let steps: Vec<&str> = plan.lines().filter(|line| line.contains("windows of")).collect();
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
        assert_eq!(told.matches("nothing is drawn for `run-up`").count(), usize::from(!drawn));
        let summary = json(out.join("summary.json"));
        let remarks = summary["remarks"].as_array().unwrap();
        let of_plot = remarks.iter().filter(|said| said.as_str().unwrap().contains("run-up"));
        assert_eq!(of_plot.count(), usize::from(!drawn), "{remarks:?}");
        assert!(out.join("series_inner_race.svg").exists());
    }
}
