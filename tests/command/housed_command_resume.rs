//! Explicit runs of a bearing in its housing that are interrupted, killed, extended or fail.

use crate::{housed_command_common, resume_common};

use housed_command_common::*;
use resume_common::{NEVER, assert_same_results, end_after, interrupted, stopped};

/// A blow; the rows lie on a grid that windows divide.
fn blow(end: &str, further: &str) -> String {
    let housing =
        format!("method = \"explicit\"\nfit.radial = \"1 um\"\nfit_ramp = \"0.1 ms\"\n{further}");
    let run = format!(
        "[numerics]\nend = \"{end}\"\noutput_interval = \"20 us\"\nfields_interval = \"0.4 ms\"\n"
    );
    let pulse =
        "z = { load = { half_sine = \"-500 N\", start = \"0.2 ms\", duration = \"0.4 ms\" } }";
    scene_text(&housing, &run).replace("z = { load = \"-250 N\" }", pulse)
}

#[test]
fn interrupted_killed_and_extended_runs_end_with_the_same_bytes() {
    let place = Place::new();
    let scene = place.scene("scene.toml", &blow(NEVER, ""));
    let (whole, parts) = (place.path("whole"), place.path("parts"));
    let part = into_folder("run", &scene, &parts, &["--save-every", "1"]);
    assert!(interrupted(part, 150, &parts)["time"].as_f64().unwrap() > 0.0);
    // It is not written over.
    let output = into_folder("run", &scene, &parts, &[]).output().unwrap();
    assert!(stderr(&output).contains("--resume"), "{}", stderr(&output));
    // Killed on the way, it goes on from what was kept last.
    let part = into_folder("run", &scene, &parts, &["--resume", "--save-every", "1"]);
    assert_eq!(stopped(part, 100, "-KILL").0, None);
    let scene = place.scene("scene.toml", &blow(&end_after(&parts, 1.6), ""));
    let said = succeed(into_folder("run", &scene, &parts, &["--resume"]));
    assert!(said.contains("resumed at"), "{said}");
    succeed(into_folder("run", &scene, &whole, &[]));
    assert_same_results(&whole, &parts);
    // To a later end.
    let (longer, extended) = (place.path("longer"), whole);
    let scene = place.scene("scene.toml", &blow(&end_after(&parts, 0.4), ""));
    succeed(into_folder("run", &scene, &longer, &[]));
    succeed(into_folder("run", &scene, &extended, &["--resume"]));
    assert_same_results(&longer, &extended);
    // Of another scene it is refused.
    let other = place.scene("other.toml", &blow(NEVER, "coupling_phase = 0.2"));
    let output = into_folder("run", &other, &longer, &["--resume"]).output().unwrap();
    assert!(stderr(&output).contains("another scene"), "{}", stderr(&output));
}

#[test]
fn interrupted_and_extended_courses_end_with_the_same_bytes() {
    let place = Place::new();
    let numerics = |end: &str| {
        let run = format!(
            "[numerics]\nend = \"{end}\"\noutput_interval = \"10 us\"\nfields_interval = \"2 ms\"\n"
        );
        let pulse =
            "z = { load = { half_sine = \"-500 N\", start = \"0.2 ms\", duration = \"130 ms\" } }";
        scene_text("fit.radial = \"-2 um\"", &run).replace("z = { load = \"-250 N\" }", pulse)
    };
    let scene = place.scene("scene.toml", &numerics(NEVER));
    let (whole, parts) = (place.path("whole"), place.path("parts"));
    interrupted(into_folder("run", &scene, &parts, &["--save-every", "1"]), 60, &parts);
    let output = into_folder("run", &scene, &parts, &[]).output().unwrap();
    assert!(stderr(&output).contains("--resume"), "{}", stderr(&output));
    let scene = place.scene("scene.toml", &numerics(&end_after(&parts, 50.0)));
    let said = succeed(into_folder("run", &scene, &parts, &["--resume"]));
    assert!(said.contains("resumed at"), "{said}");
    succeed(into_folder("run", &scene, &whole, &[]));
    assert_same_results(&whole, &parts);
    // To a later end.
    let longer = place.path("longer");
    let scene = place.scene("scene.toml", &numerics(&end_after(&parts, 2.0)));
    succeed(into_folder("run", &scene, &longer, &[]));
    succeed(into_folder("run", &scene, &whole, &["--resume"]));
    assert_same_results(&longer, &whole);
    // Of another scene it is refused.
    let other = numerics(NEVER).replace("-500 N", "-400 N");
    let other = place.scene("other.toml", &other);
    let output = into_folder("run", &other, &longer, &["--resume"]).output().unwrap();
    assert!(stderr(&output).contains("another scene"), "{}", stderr(&output));
}

#[test]
fn a_run_that_fails_keeps_its_last_row() {
    let place = Place::new();
    // Nothing holds the race along its axis, and a force pulls it out of a narrow seat.
    let text = blow("4 ms", "axial = \"free\"\nwidth = \"10 mm\"")
        .replace("axial = 2 }", "axial = 4 }")
        .replace("[traction]", "x = { load = \"1500 N\" }\n[traction]");
    let scene = place.scene("scene.toml", &text);
    let out = place.path("out");
    let output = into_folder("run", &scene, &out, &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(message.contains("has left its bore") && message.contains("t = "), "{message}");
    let state = json(out.join("state.json"));
    assert_eq!(state["stopped"], "failed");
    let rows = column(&out.join("series.csv"), "outer_x");
    assert_eq!(state["sound"]["rows"].as_u64(), Some(rows.len() as u64));
    assert!(*rows.last().unwrap() > 1e-3, "{rows:?}");
    let summary = json(out.join("summary.json"));
    assert_eq!(summary["complete"], false);
    assert!(summary["stopped_by"].as_str().unwrap().contains("left its bore"));
}
