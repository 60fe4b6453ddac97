//! Laws of a bearing, from written numbers.

use crate::command_line_common::{done, json, read, text, write};
use crate::housed_command_common;
use serde_json::Value;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;
use tempfile::tempdir;

pub const BALL: f64 = 7.938e-3;
pub const CONFORMITY: [f64; 2] = [0.515, 0.525];

/// With these keys of the ball, and the rest of the scene.
pub fn scene(ball: &str, rest: &str) -> String {
    let [inner, outer] = CONFORMITY;
    format!(
        "[bearing]\nkind = \"deep-groove\"\nballs = 9\nball_phase = \"7 deg\"\npitch_radius = \"19.25 mm\"\n\
         clearance = {{ radial = \"10 um\" }}\ninner_race = {{ conformity = {inner} }}\nouter_race = {{ conformity = {outer} }}\n\
         ball = {{ diameter = \"{BALL} m\"{ball} }}\n{rest}"
    )
}

/// Rows of a table under their names without units.
fn rows(folder: &Path) -> Vec<BTreeMap<String, f64>> {
    let table = read(&folder.join("series.csv"));
    let mut lines = table.lines();
    let names: Vec<String> = lines
        .next()
        .unwrap()
        .split(',')
        .map(|name| name.split(' ').next().unwrap().into())
        .collect();
    let row = |line: &str| {
        let cells = line.split(',').map(|cell| cell.parse().unwrap());
        names.iter().cloned().zip(cells).collect()
    };
    lines.map(row).collect()
}

/// Runs a command on a scene; returns its summary and its rows.
pub fn found(command: &str, content: &str) -> (Value, Vec<BTreeMap<String, f64>>) {
    let root = tempdir().unwrap();
    let path = write(root.path(), "scene.toml", content);
    let out = root.path().join("out");
    done(&[command, &path, "--out", &text(&out)]);
    (json(&out.join("summary.json")), rows(&out))
}

const GRAVITY: [f64; 3] = [3.0, -20.0, -90.0];

fn heavy(rest: &str) -> String {
    let [x, y, z] = GRAVITY;
    let heavy = ", material = { density = \"19 g/cm^3\" }";
    scene(heavy, rest)
        + &format!("[ball_forces]\ngravity = [\"{x} m/s^2\", \"{y} m/s^2\", \"{z} m/s^2\"]\n")
}

/// Forces on both races and moments about their centres, summed up from the table of the balls: a contact force passes
/// through the centre of its ball.
fn moments_are_those_of_the_balls(summary: &Value, balls: &[BTreeMap<String, f64>]) {
    let vector = |of: &Value| ["x", "y", "z"].map(|axis| of[axis]["value"].as_f64().unwrap());
    let at = |ball: &BTreeMap<String, f64>, name: &str| {
        ["x", "y", "z"].map(|axis| ball[&format!("{name}_{axis}")])
    };
    // A bearing alone has its races at the top, its outer race at the origin.
    let races = summary.pointer("/bearings/bearing").unwrap_or(summary);
    for race in ["inner", "outer"] {
        let of = &races[format!("{race}_race")];
        let centre = of.get("centre").or(of.get("position")).map_or([0.0; 3], vector);
        let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
        for ball in balls {
            let (place, own) = (at(ball, "position"), at(ball, &format!("{race}_force_on_race")));
            let arm: [f64; 3] = [0, 1, 2].map(|i| place[i] - centre[i]);
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                force[i] += own[i];
                moment[i] += arm[j] * own[k] - arm[k] * own[j];
            }
        }
        for (found, expected) in [("contact_force", force), ("contact_moment", moment)] {
            for (found, expected) in vector(&of[found]).into_iter().zip(expected) {
                // Ball loads of 50 N at 20 mm, to the last digits.
                assert!((found - expected).abs() <= 1e-8, "{race}: {of} {force:?} {moment:?}");
            }
        }
    }
}

/// Along its orbit a ball is held by its contacts, its weight and its cage, whichever way the bearing is mounted.
#[test]
fn written_forces_balance_on_each_ball() {
    let mass = 4.0 / 3.0 * PI * (0.5 * BALL).powi(3) * 19e3;
    for reversed in ["false", "true"] {
        let content = heavy("[inner_race]\nx = { load = \"30 N\" }\nz = { load = \"-50 N\" }\n");
        let content = content.replace("balls = 9", &format!("balls = 9\nreversed = {reversed}"));
        let (summary, balls) = found("statics", &content);
        let mut largest = 0.0f64;
        moments_are_those_of_the_balls(&summary, &balls);
        for ball in &balls {
            let azimuth = ball["azimuth"].to_radians();
            let along = [0.0, -azimuth.sin(), azimuth.cos()];
            // Forces of the ball on both races, less its weight.
            let taken = |i: usize, axis: &str| {
                let on = |race: &str| ball[&format!("{race}_force_on_race_{axis}")];
                along[i] * (on("inner") + on("outer") - mass * GRAVITY[i])
            };
            let sum = taken(0, "x") + taken(1, "y") + taken(2, "z");
            largest = largest.max(sum.abs());
            // Nine digits of loads of 50 N.
            assert!((ball["cage_force"] - sum).abs() <= 1e-9, "{reversed}: {ball:?} {sum}");
        }
        assert!(largest > 0.3, "{largest}");
    }
}

/// Balls roll by the relative speed of both races: the friction torque is the power that is lost over it, the same for a
/// speed of either race and of either sign.
#[test]
fn friction_torque_depends_on_the_relative_speed() {
    let torque = |inner: f64, outer: f64| {
        let held = ["x", "y", "z"].map(|axis| format!("{axis} = {{ displacement = \"0 mm\" }}\n"));
        let (summary, _) = found(
            "run",
            &scene(
                "",
                &format!(
                    "[inner_race]\nspeed = \"{inner} rpm\"\nx = {{ load = \"500 N\" }}\nz = {{ load = \"-200 N\" }}\n\
                     [outer_race]\nmotion = \"5-dof\"\nspeed = \"{outer} rpm\"\n{}tilt_y = {{ tilt = \"0 deg\" }}\ntilt_z = {{ tilt = \"0 deg\" }}\n\
                     [numerics]\nend = \"4 ms\"\noutput_interval = \"20 us\"\naccuracy = 1e-4\n[output]\nplots = []\nwindow_start = \"2 ms\"\n",
                    held.concat()
                ),
            ),
        );
        let [torque, power] =
            ["torque", "power_loss"].map(|of| summary["friction"][of]["value"].as_f64().unwrap());
        let speed = (inner - outer).abs() * PI / 30.0;
        // Rounding of a mean over the rows.
        assert!((torque * speed / power - 1.0).abs() <= 1e-9, "{inner} {outer}: {torque} {power}");
        assert!(power > 0.0, "{inner} {outer}: {power}");
        torque
    };
    let still = torque(300.0, 0.0);
    for (inner, outer) in
        [(400.0, 100.0), (-200.0, -500.0), (-300.0, 0.0), (0.0, 300.0), (-400.0, -100.0)]
    {
        let turning = torque(inner, outer);
        // Another way of the balls past the load.
        assert!((turning / still - 1.0).abs() <= 0.02, "{inner} {outer}: {turning} {still}");
    }
}

/// Loaded balls are counted race by race: thrown outwards they leave the inner one.
#[test]
fn loaded_balls_are_those_of_each_race() {
    let (summary, balls) = found(
        "statics",
        &scene(
            "",
            "[inner_race]\nspeed = \"12000 rpm\"\ntilt_y = { tilt = \"0 deg\" }\ntilt_z = { tilt = \"0 deg\" }\n\
             z = { load = \"-200 N\" }\n[ball_forces]\ncentrifugal = true\n",
        ),
    );
    let counts = ["inner", "outer"].map(|race| {
        let loads: Vec<f64> = balls.iter().map(|ball| ball[&format!("{race}_load")]).collect();
        let most = loads.iter().copied().fold(0.0, f64::max);
        let counted = loads.iter().filter(|load| **load > 0.0 && **load >= 0.01 * most).count();
        let zone = &summary["load_zone"];
        assert_eq!(zone[&format!("balls_loaded_{race}")], counted, "{race}: {zone} {loads:?}");
        counted
    });
    assert!(counts[0] < 5 && counts[1] == 9, "{counts:?}");
}

/// A run that stands still reaches as far up its grooves as the equilibrium: contact angle and half the ellipse, in degrees.
#[test]
fn a_run_reaches_as_far_up_its_grooves_as_the_equilibrium() {
    let content = scene(
        "",
        "[inner_race]\nx = { load = \"500 N\" }\n[traction]\nlaw = \"none\"\n\
         [numerics]\nend = \"10 us\"\noutput_interval = \"1 us\"\nstart = \"equilibrium\"\n[output]\nplots = []\n",
    );
    let (summary, _) = found("run", &content);
    let (_, balls) = found("statics", &content);
    for (race, conformity) in ["inner", "outer"].into_iter().zip(CONFORMITY) {
        let reach = &summary["extremes"][format!("{race}_race")]["farthest_from_bottom"];
        let value = |key: &str| reach[key]["value"].as_f64().unwrap();
        let angle = balls[0][&format!("{race}_contact_angle")];
        let half = balls[0][&format!("{race}_semi_major")] / (conformity * BALL);
        assert!((value("contact_angle") - angle).abs() <= 1e-6 * angle, "{race}: {reach}");
        let expected = angle + half.to_degrees();
        assert!((value("ellipse_reaches") - expected).abs() <= 1e-6 * expected, "{race}: {reach}");
    }
}

/// A point of a sweep is the equilibrium of the scene with its keys set: numbers, and every code of a warning.
#[test]
fn a_point_of_a_sweep_is_its_own_equilibrium() {
    let root = tempdir().unwrap();
    let overloaded = scene("", "[inner_race]\nspeed = \"20000 rpm\"\nx = { load = \"-30 kN\" }\n[ball_forces]\ncentrifugal = false\n")
        .replace("kind = \"deep-groove\"", "kind = \"angular-contact\"\ncontact_angle = \"15 deg\"")
        .replace("clearance = { radial = \"10 um\" }\n", "");
    let housed =
        housed_command_common::scene_text("method = \"quasi-static\"\nfit.radial = \"1 um\"\n", "");
    let held = scene(
        "",
        &format!(
            "{FOUNDATION}[inner_race]\nx = {{ displacement = \"3 um\" }}\ny = {{ displacement = \"0 mm\" }}\n\
             z = {{ displacement = \"0 mm\" }}\ntilt_y = {{ tilt = \"0.01 deg\" }}\ntilt_z = {{ tilt = \"0 deg\" }}\n"
        ),
    );
    let cases = [
        (held, "inner_race.z.displacement", ["-25 um", "-30 um"], 0),
        (overloaded, "inner_race.x.load", ["-20 kN", "-30 kN"], 3),
        (housed, "solid.material.youngs_modulus", ["100 GPa", "205 GPa"], 0),
    ];
    for (number, (content, key, values, codes)) in cases.into_iter().enumerate() {
        let path = write(root.path(), &format!("scene{number}.toml"), &content);
        let out = root.path().join(format!("sweep{number}"));
        let varied = format!("{key}={}", values.join(", "));
        let other = "output.plots=[]";
        done(&["sweep", &path, "--vary", &varied, "--set", other, "--out", &text(&out)]);
        let table = read(&out.join("sweep.csv"));
        let names: Vec<&str> = table
            .lines()
            .next()
            .unwrap()
            .split(',')
            .map(|name| name.split(' ').next().unwrap())
            .collect();
        let mut places = Vec::new();
        for (row, value) in table.lines().skip(1).zip(values) {
            let row: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
            let cell = |name: &str| row[names.iter().position(|of| *of == name).unwrap()];
            let own = root.path().join("own");
            let _ = std::fs::remove_dir_all(&own);
            done(&["statics", &path, "--out", &text(&own), "--set", &format!("{key}={value}")]);
            let summary = json(&own.join("summary.json"));
            let inner = inner_race(&summary);
            let of_body = names.contains(&"inner_race_load_x");
            let own = |name: &str| match of_body {
                true => cell(&format!("inner_race_{name}")),
                false => cell(name),
            };
            let position = &inner["position"];
            for axis in ["x", "y", "z"] {
                let expected = position[axis]["value"].as_f64().unwrap();
                let found = 1e-6 * own(axis);
                // Another start of the same search; a millionth of a micrometre.
                let close = (found - expected).abs() <= 1e-9 * expected.abs() + 1e-12;
                assert!(close, "{key} {axis}: {found} {expected}");
            }
            let loads = ["load_x", "load_y", "load_z", "moment_y", "moment_z"];
            let keys = ["x", "y", "z", "tilt_y", "tilt_z"];
            for (column, key) in loads.iter().zip(keys) {
                let expected = inner["loads"][key]["value"].as_f64().unwrap();
                // Hundreds of newtons from another start.
                let close = (own(column) - expected).abs() <= 1e-6 * (1.0 + expected.abs());
                assert!(close, "{key}={value} {column}: {} {expected}", own(column));
            }
            places.push(["x", "y", "z"].map(own));
            let warnings = summary["warnings"].as_array().unwrap();
            let mut numbers: Vec<u32> = warnings
                .iter()
                .map(|of| of["code"].as_str().unwrap()[1..3].parse().unwrap())
                .collect();
            numbers.sort_unstable();
            numbers.dedup();
            let expected = numbers.iter().fold(0.0, |all, code| 100.0 * all + f64::from(*code));
            assert_eq!(cell("warnings"), expected, "{key}={value}: {warnings:?}");
            assert!(value != values[1] || numbers.len() >= codes, "{numbers:?}");
        }
        assert_ne!(places[0], places[1], "{key}");
    }
}

/// The part of a summary on the inner race.
fn inner_race(summary: &Value) -> &Value {
    summary.pointer("/bodies/inner_race").unwrap_or(&summary["inner_race"])
}

const FOUNDATION: &str = "[outer_race]\nmotion = \"5-dof\"\n[outer_race.foundation]\nstiffness = { x = \"2e7 N/m\", y = \"3e7 N/m\", \
    z = \"5e7 N/m\", tilt_y = \"1e5 N m/rad\", tilt_z = \"2e5 N m/rad\" }\n";

/// The loads of a prescribed position bring the inner race back there, also through what its outer race stands on.
#[test]
fn loads_of_a_prescribed_position_lead_back_to_it() {
    let keys = ["x", "y", "z", "tilt_y", "tilt_z"];
    let conditions = |name: &str, values: [f64; 5], units: [&str; 2]| {
        let of = |i: usize| {
            format!("{} = {{ {name} = \"{:e} {}\" }}\n", keys[i], values[i], units[i / 3])
        };
        (0..5).map(of).collect::<String>()
    };
    let standing = scene("", FOUNDATION);
    let housed = housed_command_common::scene_text("method = \"quasi-static\"", "");
    let loads =
        &housed_command_common::RACES[..housed_command_common::RACES.find("[outer_race]").unwrap()];
    let housed = housed.replace(loads, "");
    assert!(!housed.contains("[inner_race]"));
    for content in [standing, housed] {
        let there: [f64; 5] = [6e-5, 6e-6, -2.8e-5, 7e-5, -5e-5];
        let tilts = [there[0], there[1], there[2], there[3].to_degrees(), there[4].to_degrees()];
        let inner = "[inner_race]\n".to_owned() + &conditions("displacement", tilts, ["m", "deg"]);
        let inner = inner
            .replace("tilt_y = { displacement", "tilt_y = { tilt")
            .replace("tilt_z = { displacement", "tilt_z = { tilt");
        let given = format!("{content}{inner}");
        let (summary, _) = found("statics", &given);
        let loads = keys.map(|key| inner_race(&summary)["loads"][key]["value"].as_f64().unwrap());
        assert!(loads[2] < -100.0, "{loads:?}");
        let inner = "[inner_race]\n".to_owned()
            + &conditions("load", loads, ["N", "N m"])
                .replace("tilt_y = { load", "tilt_y = { moment")
                .replace("tilt_z = { load", "tilt_z = { moment");
        let (summary, _) = found("statics", &format!("{content}{inner}"));
        for (key, at) in keys.iter().zip(there) {
            let of = &inner_race(&summary)["position"][key];
            let scale = if of["unit"] == "deg" { 1f64.to_radians() } else { 1.0 };
            let position = scale * of["value"].as_f64().unwrap();
            assert!(
                (position - at).abs() <= 1e-7 * at.abs(),
                "{key}: {position:e} {at:e} {loads:?}"
            );
        }
    }
}

/// A ball has a load where both races squeeze it, and nowhere else, down to the last 1e-10 of a load. The inner groove
/// of a displaced race leaves the plane of a ball; that decides for a ball on the verge of contact.
#[test]
fn a_ball_has_a_load_where_its_races_squeeze_it() {
    let mut squeezed = 0;
    for step in -20..20 {
        let position = -38.49395525844975 - 5e-4 * f64::from(step);
        let content = format!(
            "[bearing]\nkind = \"deep-groove\"\nballs = 9\nball_phase = \"35.20833333333333 deg\"\n\
             clearance = {{ radial = \"3.333333333333335 um\", through = \"outer-race\" }}\nball = {{ radius = \"3.969 mm\" }}\n\
             inner_race = {{ radius = \"15.281 mm\", groove_radius = \"4.12776 mm\" }}\n\
             outer_race = {{ radius = \"23.224 mm\", groove_radius = \"4.12776 mm\" }}\n[inner_race]\n\
             x = {{ displacement = \"0 um\" }}\ny = {{ displacement = \"0.15685908301188556 um\" }}\nz = {{ displacement = \"{position} um\" }}\n\
             tilt_y = {{ tilt = \"0 deg\" }}\ntilt_z = {{ tilt = \"0 deg\" }}\n"
        );
        for ball in found("statics", &content).1 {
            let room = ball["inner_approach"] + ball["outer_approach"];
            let loaded = ball["inner_load"] > 0.0 && ball["outer_load"] > 0.0;
            assert_eq!(loaded, room > 1e-16, "{position}: {ball:?}");
            squeezed += u32::from(loaded);
        }
    }
    // Four balls in all of 40 positions, the ninth in some.
    assert!((161..200).contains(&squeezed), "{squeezed}");
}
