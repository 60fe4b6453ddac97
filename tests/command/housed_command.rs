//! Commands on a bearing in its housing: statics, courses of equilibria, explicit steps, plan and check.

use crate::housed_command_common;

use housed_command_common::*;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Named columns of a table.
fn columns<const N: usize>(path: &Path, names: [&str; N]) -> [Vec<f64>; N] {
    names.map(|name| column(path, name))
}

fn value(of: &Value) -> f64 {
    of["value"].as_f64().unwrap_or(f64::NAN)
}

#[test]
fn a_rigid_housing_touches_no_mesh() {
    let place = Place::new();
    // A mesh that is not there: nobody looks.
    let gone = RING.replace("generate = \"housing-d\"", "file = \"gone.msh\"\nunit = \"mm\"");
    let keys = ["bore_radius", "outer_radius", "depth", "cells", "order"];
    let gone: String = gone
        .lines()
        .filter(|line| !keys.iter().any(|key| line.starts_with(key)))
        .map(|line| format!("{line}\n"))
        .collect();
    let rigid = format!("{BEARING}{RACES}[housing]\nmethod = \"rigid\"\n{gone}");
    let rigid = place.scene("rigid.toml", &rigid);
    let fixed = place.scene("fixed.toml", &format!("{BEARING}{RACES}").replace("5-dof", "fixed"));
    for scene in [&rigid, &fixed] {
        let out = place.path(&scene.file_stem().unwrap().to_string_lossy());
        succeed(into_folder("statics", scene, &out, &[]));
    }
    let series = |name: &str| fs::read(place.path(name).join("series.csv")).unwrap();
    assert!(series("rigid") == series("fixed"), "the same to the byte");
    let [said, other] = [&rigid, &fixed].map(|scene| succeed(command("plan", scene, &[])));
    assert!(said.contains("notes housing") && said.contains("no mesh is read"), "{said}");
    let items = |said: &str| {
        let items = said.lines().filter(|line| !line.starts_with("notes"));
        items.map(str::to_string).collect::<Vec<_>>()
    };
    assert_eq!(items(&said), items(&other));
    let said = succeed(command("check", &rigid, &[]));
    assert!(said.contains("the outer race is fixed; the housing's mesh is not read"), "{said}");
    // With another method the mesh is missed.
    let text = fs::read_to_string(&rigid).unwrap().replace("rigid", "quasi-static");
    let output = command("statics", &place.scene("soft.toml", &text), &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("gone.msh"), "{}", stderr(&output));
}

#[test]
fn statics_balances_bearing_and_housing() {
    let place = Place::new();
    // Of nine loose balls none is on the line of the load, and the inner race comes over a saddle.
    for (name, fit, balls, clearance) in [
        ("tight", "2 um", "8", "-4 um"),
        ("loose", "-1 um", "8", "-4 um"),
        ("loose_balls", "-1 um", "9", "6 um"),
    ] {
        let text = scene_text(&format!("fit.radial = \"{fit}\""), "")
            .replace("balls = 8", &format!("balls = {balls}"))
            .replace("\"-4 um\"", &format!("\"{clearance}\""));
        let scene = place.scene("scene.toml", &text);
        let out = place.path(name);
        let said = succeed(into_folder("statics", &scene, &out, &[]));
        assert!(said.contains("housing stiffness"), "{said}");
        let summary = json(out.join("summary.json"));
        let housing = &summary["housing"];
        let force = value(&housing["force_on_outer"]["z"]);
        assert!((force - 250.0).abs() <= 1e-7 * 250.0, "{force}");
        let touching = housing["nodes_touching"].as_u64().unwrap();
        let kept = housing["condensed"]["kept"].as_u64().unwrap();
        assert_eq!(kept, 24 * 3);
        if name == "tight" {
            assert_eq!(touching, kept, "all round");
        } else {
            assert!(touching > 0 && touching < kept / 2, "{touching}");
            // Loose, it falls through its clearance and then some.
            assert!(value(&housing["outer_race"]["z"]) < -1e-6);
        }
        let [x, y, z] = columns(&out.join("bore.csv"), ["force_x", "force_y", "force_z"]);
        let [y, z] = [y, z].map(|forces| forces.iter().sum::<f64>());
        assert!(x.iter().all(|force| *force == 0.0));
        assert!(y.abs() <= 1e-6 * 250.0 && (z + 250.0).abs() <= 1e-6 * 250.0, "{y} {z}");
        let fields = fs::read(out.join("fields/fields_000000.vtu")).unwrap();
        let fields = String::from_utf8_lossy(&fields);
        for field in ["displacement", "von_mises", "contact_force", "contact_pressure"] {
            assert!(fields.contains(&format!("\"{field}\"")), "{field}");
        }
        assert!(value(&summary["largest"]["von_mises_of_elements"]) > 0.0);
    }
}

#[test]
fn weights_rest_on_the_housing() {
    let place = Place::new();
    let gravity = "[ball_forces]\ngravity = [\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]\n\
                   [inner_race.inertia]\nmass = \"2 kg\"\naxial = \"1e-4 kg m^2\"\ntransverse = \"1e-4 kg m^2\"\n\
                   [outer_race.inertia]\nmass = \"3 kg\"\naxial = \"1e-3 kg m^2\"\ntransverse = \"1e-3 kg m^2\"\n";
    let scene = place.scene("scene.toml", &scene_text("fit.radial = \"2 um\"", gravity));
    let out = place.path("out");
    succeed(into_folder("statics", &scene, &out, &[]));
    let force = value(&json(out.join("summary.json"))["housing"]["force_on_outer"]["z"]);
    // Eight steel balls; their size follows from the clearance.
    let radius: f64 = 0.5 * (31.953e-3 - 20.047e-3 + 4e-6);
    let balls = 8.0 * 7850.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let expected = 250.0 + 9.81 * (2.0 + 3.0 + balls);
    assert!((force / expected - 1.0).abs() <= 1e-6, "{force} {expected}");
}

#[test]
fn equilibria_over_time_are_those_of_statics() {
    let place = Place::new();
    let run = "[numerics]\nend = \"1 ms\"\noutput_interval = \"0.25 ms\"\n";
    let ramp = "z = { load = { ramp = [\"0 N\", \"-250 N\"], duration = \"1 ms\" } }";
    let text = scene_text("fit.radial = \"2 um\"", run).replace("z = { load = \"-250 N\" }", ramp);
    let course = place.scene("course.toml", &text);
    let still = place.scene("still.toml", &scene_text("fit.radial = \"2 um\"", ""));
    let (out, at_end) = (place.path("course"), place.path("still"));
    let said = succeed(into_folder("run", &course, &out, &[]));
    assert!(said.contains("5 equilibria to t = 0.001 s"), "{said}");
    assert!(said.contains("inertia left out       (f/f_n)² = "), "{said}");
    succeed(into_folder("statics", &still, &at_end, &[]));
    let series = out.join("series.csv");
    let [z, inner, force] = columns(&series, ["outer_z", "inner_z", "housing_force_on_outer_z"]);
    assert_eq!(z.len(), 5);
    let summary = json(at_end.join("summary.json"));
    let expected = value(&summary["housing"]["outer_race"]["z"]);
    assert!((z[4] / expected - 1.0).abs() <= 1e-6, "{z:?} {expected}");
    let expected = value(&summary["inner_race"]["position"]["z"]);
    assert!((inner[4] / expected - 1.0).abs() <= 1e-6, "{inner:?} {expected}");
    for (row, force) in force.iter().enumerate() {
        assert!((force - 62.5 * row as f64).abs() <= 1e-6 * 250.0, "{force}");
    }
    // Interference: all nodes touch from the start.
    let touching = column(&series, "bore_nodes_touching");
    assert!(touching.iter().all(|count| *count == 72.0), "{touching:?}");
    let summary = json(out.join("summary.json"));
    assert_eq!(summary["complete"], Value::Bool(true));
    assert!(out.join("bore.csv").exists() && out.join("fields.pvd").exists());
    // What is complete goes on from before its last equilibrium, and changes nothing.
    let before = std::fs::read(&series).unwrap();
    let said = succeed(into_folder("run", &course, &out, &["--resume"]));
    assert!(said.contains("resumed at t = 0.00075 s, equilibrium 4"), "{said}");
    assert!(std::fs::read(&series).unwrap() == before);
}

#[test]
fn a_fit_grows_in() {
    let place = Place::new();
    let run = "[numerics]\nend = \"4 ms\"\noutput_interval = \"1 ms\"\n";
    let housing = "fit.diametral = \"10 um\"\nfit_ramp = \"2 ms\"";
    let text = scene_text(housing, run).replace("\"-250 N\"", "\"0 N\"");
    let out = place.path("out");
    succeed(into_folder("run", &place.scene("scene.toml", &text), &out, &[]));
    let pressure = column(&out.join("series.csv"), "bore_peak_pressure");
    // Rounding of radii.
    assert!(pressure[0] <= 1e-9 * pressure[2], "{pressure:?}");
    // Half way at half time, then it stays.
    assert!((pressure[1] / pressure[2] - 0.5).abs() <= 1e-3, "{pressure:?}");
    assert!((pressure[3] / pressure[2] - 1.0).abs() <= 1e-9, "{pressure:?}");
    let summary = json(out.join("summary.json"));
    assert!((value(&summary["housing"]["seat"]["interference"]) - 5e-6).abs() <= 1e-18);
}

/// A load that grows slowly against all frequencies, in a housing that is damped.
fn settled(method: &str) -> String {
    let run = "[numerics]\nend = \"4 ms\"\noutput_interval = \"0.1 ms\"\n";
    let ramp = "z = { load = { smooth_ramp = [\"0 N\", \"-250 N\"], duration = \"2.5 ms\" } }";
    let housing = format!("method = \"{method}\"\nfit.radial = \"2 um\"\nfit_ramp = \"0.5 ms\"");
    let law = "[contact_damping]\nlaw = \"hunt-crossley\"\nalpha = \"2 s/m\"\n";
    scene_text(&housing, &format!("{law}{run}"))
        .replace("z = { load = \"-250 N\" }", ramp)
        .replace("77 1/s", "4000 1/s")
}

#[test]
fn explicit_steps_settle_in_the_equilibrium() {
    let place = Place::new();
    let series = ["quasi-static", "explicit"].map(|method| {
        let out = place.path(method);
        let scene = place.scene(&format!("{method}.toml"), &settled(method));
        succeed(into_folder("run", &scene, &out, &[]));
        out.join("series.csv")
    });
    for name in ["outer_z", "inner_z", "housing_force_on_outer_z", "bore_peak_pressure"] {
        let [still, moving] = series.each_ref().map(|path| column(path, name));
        assert_eq!(still.len(), moving.len());
        // The last rows swing a little about the equilibrium.
        let mean = moving[36..].iter().sum::<f64>() / (moving.len() - 36) as f64;
        let error = mean / still[still.len() - 1] - 1.0;
        println!("{name}: {error:.1e}");
        assert!(error.abs() <= 0.005, "{name}: {mean} {}", still[still.len() - 1]);
    }
    let summary = json(place.path("explicit").join("summary.json"));
    let part = value(&summary["energy"]["largest_residual_part"]);
    assert!(part <= 1e-4, "{part}");
    let work = &summary["work"];
    assert_eq!(work["bore_nodes_in_reach"].as_u64(), Some(72));
    assert!(work["housing_steps"].as_u64() >= work["windows"].as_u64());
}

#[test]
fn plan_and_check_say_what_is_chosen_and_offered() {
    let place = Place::new();
    let slow = scene_text("fit.radial = \"2 um\"", "[numerics]\nend = \"1 s\"\n");
    let said = succeed(command("plan", &place.scene("slow.toml", &slow), &[]));
    for part in
        ["does  quasi-static housing", "unknowns onto 72 of 72 bore nodes", "explicit instead"]
    {
        assert!(said.contains(part), "{part}: {said}");
    }
    let blow = "z = { load = { half_sine = \"-500 N\", duration = \"0.2 ms\" } }";
    let fast = |method: &str| {
        let housing = format!("method = \"{method}\"\nfit.radial = \"2 um\"\nwidth = \"10 mm\"");
        scene_text(&housing, "[numerics]\nend = \"1 ms\"\n")
            .replace("z = { load = \"-250 N\" }", blow)
            .replace("axial = 2 }", "axial = 4 }")
    };
    let said = succeed(command("plan", &place.scene("fast.toml", &fast("quasi-static")), &[]));
    // Two of five layers of nodes lie beside a race half as wide as the bore.
    assert!(said.contains("72 of 120 bore nodes; left out are 48 not under the race"), "{said}");
    let said = succeed(command("plan", &place.scene("explicit.toml", &fast("explicit")), &[]));
    let tested = "at the start 72 bore nodes tested for contact, 0 too far away";
    for part in ["does  explicit housing", "coupling steps of", tested] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(said.contains("memory of condensing"), "{said}");
    // It factorises nothing: a limit far below what factors need refuses a run by equilibria alone.
    let little = ["--memory", "0.001"];
    let said = succeed(command("plan", &place.path("explicit.toml"), &little));
    assert!(said.contains("coupling steps of") && said.contains("REFUSED"), "{said}");
    let out = place.path("out");
    let output = into_folder("run", &place.path("slow.toml"), &out, &little).output().unwrap();
    let error = stderr(&output);
    assert_eq!(output.status.code(), Some(2));
    for part in ["condensing the housing of", "GB of memory", "(--memory)", "explicit steps"] {
        assert!(error.contains(part), "{part}: {error}");
    }
    let said = succeed(command("check", &place.scene("slow.toml", &slow), &[]));
    for part in [
        "housing.width = 20 mm (the bearing's length)",
        "housing.axial = fixed",
        "housing.contact.stiffness = 2.5e14 N/m^3",
        "interference +2.0000 um radial = +4.0000 um diametral",
        "as coarse as a test needs",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(!said.contains("foundation"), "{said}");
    let echo = succeed(command("check", &place.scene("slow.toml", &slow), &["--json"]));
    let echo: Value = serde_json::from_str(&echo).unwrap();
    assert_eq!(echo["scene"]["housing"]["method"], "quasi-static");
    assert_eq!(echo["scene"]["solid"]["mesh"]["generate"], "housing-d");
}

/// The scenes that are shipped, each run as its method says.
#[test]
fn shipped_scenes_run() {
    let place = Place::new();
    let run = |name: &str| {
        let out = place.path(name);
        let said = succeed(into_folder("run", &shipped(&format!("{name}.toml")), &out, &[]));
        (said, out.join("series.csv"), json(out.join("summary.json")))
    };
    let radii = |y: &[f64], z: &[f64]| -> Vec<f64> {
        y.iter().zip(z).map(|(y, z)| libm::hypot(*y, *z)).collect()
    };
    let spread = |radii: &[f64]| {
        let low = radii.iter().copied().fold(f64::INFINITY, f64::min);
        radii.iter().copied().fold(0.0, f64::max) / low
    };
    // 2.4.2: the orbit in housing A is nearly a circle, that in housing C is not.
    let (_, series, _) = run("housing_a_rotating_load");
    let [y, z] = columns(&series, ["outer_y", "outer_z"]);
    let a = spread(&radii(&y, &z));
    assert!(a <= 1.2, "{a}");
    let (_, series, _) = run("housing_c_tet10");
    let [y, z] = columns(&series, ["outer_y", "outer_z"]);
    let c = spread(&radii(&y, &z));
    assert!(c >= 2.0 * a, "{c} {a}");
    // Upwards it gives way more than downwards.
    let [up, down] = [z.iter().copied().fold(0.0, f64::max), z.iter().copied().fold(0.0, f64::min)];
    assert!(up > -down, "{up} {down}");
    // 2.4.1: all round, from the start of the load to its end.
    let (_, series, summary) = run("interference_fit");
    let touching = column(&series, "bore_nodes_touching");
    let kept = summary["housing"]["condensed"]["kept"].as_f64().unwrap();
    assert_eq!(touching.last().copied(), Some(kept));
    // 2.4.3: balls and race swing after the blow.
    let (said, series, summary) = run("housing_impact");
    assert!(said.contains("bore nodes near the race"), "{said}");
    let force = column(&series, "contact_force_on_outer_z");
    assert!(force.iter().copied().fold(0.0, f64::min) < -400.0, "{force:?}");
    assert!(value(&summary["energy"]["largest_residual_part"]) <= 1e-4);
}

/// A bore is described only where the results beside it have one.
#[test]
fn results_without_a_bore_leave_none_of_earlier_ones() {
    let place = Place::new();
    let out = place.path("out");
    let tables = |method: &str| {
        let scene = place.scene("scene.toml", &scene_text(&format!("method = \"{method}\""), ""));
        succeed(into_folder("statics", &scene, &out, &[]));
        ["bore.csv", "fields.pvd", "series.csv"].map(|name| out.join(name).exists())
    };
    assert_eq!(tables("quasi-static"), [true; 3]);
    assert_eq!(tables("rigid"), [false, false, true]);
}

/// Elements of the ring are shared, contacts with the race are not; the state of one goes on on the other.
#[test]
fn explicit_housings_take_threads_and_keep_their_bits() {
    let place = Place::new();
    let numerics = "[numerics]\nend = \"END\"\noutput_interval = \"2 us\"";
    let text = |end: &str| {
        // 5760 elements: enough for two threads.
        let fine = "around = 80, radial = 3, axial = 4";
        scene_text(
            "method = \"explicit\"\nfit.radial = \"1 um\"\nfit_ramp = \"2 us\"",
            &numerics.replace("END", end),
        )
        .replace("around = 24, radial = 1, axial = 2", fine)
    };
    let scene = place.scene("scene.toml", &text("20 us"));
    let [one, two] = ["one", "two"].map(|name| place.path(name));
    succeed(into_folder("run", &scene, &one, &[]));
    let first = place.scene("first.toml", &text("10 us"));
    succeed(into_folder("run", &first, &two, &[]));
    succeed(into_folder("run", &scene, &two, &["--threads", "2", "--resume"]));
    let summary = |folder: &Path| json(folder.join("summary.json"));
    assert_eq!(summary(&two)["threads"], 2);
    let elements = |folder: &Path| summary(folder)["work"]["elements_evaluated"].as_u64().unwrap();
    assert!(elements(&two) > elements(&one), "elements between two threads are computed by both");
    assert!(column(&one.join("series.csv"), "bore_nodes_touching").iter().any(|n| *n > 0.0));
    for name in ["series.csv", "bore.csv"] {
        assert!(fs::read(one.join(name)).unwrap() == fs::read(two.join(name)).unwrap(), "{name}");
    }
}
