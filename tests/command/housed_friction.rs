//! Friction in the bore of an explicit housing, as a scene asks for it: what is told, run, resumed and refused.

use crate::{housed_command_common, resume_common};

use housed_command_common::*;
use resume_common::{NEVER, assert_same_results, end_after, interrupted};
use std::fs;

/// A race free in a rough bore under loads down, along and about its axis.
fn rough(housing: &str, end: &str) -> String {
    let housing = format!("method = \"explicit\"\n{housing}");
    let run = format!(
        "[numerics]\nend = \"{end}\"\noutput_interval = \"20 us\"\nfields_interval = \"0.4 ms\"\n"
    );
    scene_text(&housing, &run).replace(
        "motion = \"5-dof\"",
        "motion = \"6-dof\"\ntorque = \"0.4 N m\"\nx = { load = \"30 N\" }",
    )
}

const GIVEN: &str = "friction = { law = \"stick-slip\" }";

#[test]
fn a_rough_bore_holds_its_race_and_tells_of_it() {
    let place = Place::new();
    let scene = place.scene("scene.toml", &rough(GIVEN, "2 ms"));
    let said = succeed(command("check", &scene, &[]));
    for part in ["friction in the bore", "coefficient 0.6, slips beyond 0.1 nm", "free"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(
        said.contains("housing.axial = free (friction supports the race along its axis)"),
        "{said}"
    );
    let said = succeed(command("plan", &scene, &[]));
    assert!(said.contains("does  friction in the bore"), "{said}");
    let out = place.path("out");
    succeed(into_folder("run", &scene, &out, &[]));
    let of = |name: &str| column(&out.join("series.csv"), name);
    // The race slips until balls and load press it down, and stays then but for its swing.
    let along = of("outer_x");
    let rows = along.len();
    let off = along[rows / 4..].iter().map(|at| (at - along[rows - 1]).abs()).fold(0.0, f64::max);
    assert!(along[rows - 1] > 1e-8 && off <= 1e-9, "{along:?}");
    let half = &of("friction_force_on_outer_x")[rows / 2..];
    let mean = half.iter().sum::<f64>() / half.len() as f64;
    // Held against 30 N; it swings on its springs.
    assert!((mean / -30.0 - 1.0).abs() <= 0.1, "{mean}");
    let heat = of("heat_friction");
    assert!(heat.windows(2).all(|pair| pair[1] >= pair[0]) && heat[rows - 1] > 0.0);
    let summary = json(out.join("summary.json"));
    let scene = &summary["scene"]["housing"]["friction"];
    assert_eq!(scene["coefficient"], 0.6, "{scene}");
}

#[test]
fn an_interrupted_run_with_friction_ends_with_the_same_bytes() {
    let place = Place::new();
    let scene = place.scene("scene.toml", &rough(GIVEN, NEVER));
    let (whole, parts) = (place.path("whole"), place.path("parts"));
    let part = into_folder("run", &scene, &parts, &["--save-every", "1"]);
    let state = interrupted(part, 150, &parts);
    let friction = &state["sound"]["checkpoint"]["Housed"][0]["solids"][0]["seats"][0]["friction"];
    assert!(!friction["springs"].as_array().unwrap().is_empty());
    let scene = place.scene("scene.toml", &rough(GIVEN, &end_after(&parts, 1.6)));
    let said = succeed(into_folder("run", &scene, &parts, &["--resume"]));
    assert!(said.contains("resumed at"), "{said}");
    succeed(into_folder("run", &scene, &whole, &[]));
    assert_same_results(&whole, &parts);
    // A state without its springs is no state.
    let mut state = json(whole.join("state.json"));
    let seat = &mut state["sound"]["checkpoint"]["Housed"][0]["solids"][0]["seats"][0];
    assert!(seat.as_object_mut().unwrap().remove("friction").is_some());
    fs::write(whole.join("state.json"), state.to_string()).unwrap();
    let longer = place.scene("longer.toml", &rough(GIVEN, NEVER));
    let output = into_folder("run", &longer, &whole, &["--resume"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("damaged"), "{}", stderr(&output));
}

#[test]
fn no_friction_is_what_it_was() {
    let place = Place::new();
    let run = |name: &str, housing: &str| {
        let text = rough(housing, "0.4 ms").replace("6-dof\"\ntorque = \"0.4 N m\"", "5-dof\"");
        let scene = place.scene(&format!("{name}.toml"), &text);
        let out = place.path(name);
        succeed(into_folder("run", &scene, &out, &[]));
        fs::read(out.join("series.csv")).unwrap()
    };
    let without = run("without", "axial = \"free\"");
    assert!(
        without
            == run(
                "zero",
                "axial = \"free\"\nfriction = { law = \"stick-slip\", coefficient = 0 }"
            )
    );
    assert!(without != run("rough", "axial = \"free\"\nfriction.law = \"stick-slip\""));
}

#[test]
fn equilibria_refuse_friction() {
    let place = Place::new();
    let scene =
        place.scene("scene.toml", &rough(GIVEN, "2 ms").replace("torque = \"0.4 N m\"", ""));
    for name in ["statics", "modes"] {
        let output = into_folder(name, &scene, &place.path(name), &[]).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{name}");
        let said = stderr(&output);
        assert!(
            said.contains("housing.friction: refused") && said.contains("bearing run"),
            "{said}"
        );
    }
}
