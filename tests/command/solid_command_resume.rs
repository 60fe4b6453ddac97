//! Runs of a solid that are interrupted, killed, extended or fail.

use crate::{resume_common, solid_command_common};

use bearing_dynamics::numeric::clock::rounded;
use resume_common::{NEVER, assert_same_results, end_after, interrupted, stopped};
use solid_command_common::{Place, SHORT_RUN, column, into_folder, json, stderr, succeed};
use std::fs;

#[test]
fn interrupted_killed_and_extended_runs_end_with_the_same_bytes() {
    for method in ["central-differences", "runge-kutta"] {
        let place = Place::new();
        let numerics = |end: &str| {
            let fixed = "output_interval = \"10 us\"\nfields_interval = \"0.5 ms\"";
            format!("{SHORT_RUN}method = \"{method}\"\nend = \"{end}\"\n{fixed}\n")
        };
        let scene = place.scene("scene.toml", &numerics(NEVER));
        let (whole, parts) = (place.path("whole"), place.path("parts"));
        interrupted(into_folder("run", &scene, &parts, &["--save-every", "1"]), 100, &parts);
        let summary = json(parts.join("summary.json"));

        // Without a word about it nothing is overwritten.
        let refused = into_folder("run", &scene, &parts, &[]).output().unwrap();
        assert_eq!(refused.status.code(), Some(2));
        assert!(stderr(&refused).contains("--resume") && stderr(&refused).contains("--fresh"));
        assert_eq!(json(parts.join("summary.json")), summary);

        // Killed outright it goes on from the state kept before.
        assert_eq!(stopped(into_folder("run", &scene, &parts, &["--resume"]), 50, "-KILL").0, None);
        // As if killed in the middle of a file: gone when the next part has ended.
        let dead = u32::MAX - 1;
        for half in ["series.npy", "fields/fields_000001.vtu"] {
            let path = parts.join(half);
            let name = path.file_name().unwrap().to_string_lossy();
            fs::write(path.with_file_name(format!(".{name}.{dead}.partial")), "half").unwrap();
        }
        // Off the grid of rows.
        let scene = place.scene("scene.toml", &numerics(&end_after(&parts, 2.0035)));
        let said = succeed(into_folder("run", &scene, &parts, &["--resume"]));
        assert!(said.contains("resumed at t = "), "{said}");
        succeed(into_folder("run", &scene, &whole, &[]));
        assert_same_results(&whole, &parts);

        // A complete run goes on to a later end.
        let longer = place.scene("scene.toml", &numerics(&end_after(&parts, 1.0)));
        succeed(into_folder("run", &longer, &parts, &["--resume"]));
        succeed(into_folder("run", &longer, &whole, &["--fresh"]));
        assert_same_results(&whole, &parts);

        // Another scene does not go on from there.
        let text = numerics(NEVER).replace("20 MPa", "21 MPa");
        let other = place.scene("other.toml", &text);
        let refused = into_folder("run", &other, &parts, &["--resume"]).output().unwrap();
        assert_eq!(refused.status.code(), Some(2));
        assert!(stderr(&refused).contains("another scene"), "{}", stderr(&refused));
    }
}

#[test]
fn a_run_that_fails_says_where_and_keeps_its_state() {
    let place = Place::new();
    let numerics = "end = \"1 ms\"\noutput_interval = \"1 us\"\n";
    let text = format!("{SHORT_RUN}{numerics}").replace("20 MPa", "200 GPa");
    let scene = place.scene("scene.toml", &text);
    let out = place.path("out");
    let output = into_folder("run", &scene, &out, &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(message.contains("t = ") && message.contains("step "), "{message}");
    assert!(message.contains("the rows so far and the state at the last row"), "{message}");
    let summary = json(out.join("summary.json"));
    assert_eq!(summary["complete"], false);
    assert!(message.contains(summary["stopped_by"].as_str().unwrap()), "{message}");
    let state = json(out.join("state.json"));
    assert_eq!(state["stopped"], "failed");
    // The state keeps the bits, the summary is for people.
    let time = rounded(state["time"].as_f64().unwrap());
    assert_eq!(summary["time"]["value"].as_f64(), Some(time));
    assert_eq!(summary["output"]["rows"], column(&out, "time").len());
    // It may be looked at, and a gentler scene may take its folder.
    succeed(into_folder(
        "run",
        &place.scene("g.toml", &format!("{SHORT_RUN}{numerics}")),
        &out,
        &[],
    ));
}

/// Steps of a solid are whole: the last one may end past the end, and a complete run is then resumed as any other.
#[test]
fn a_complete_run_whose_last_step_ends_past_the_end_is_resumed() {
    let place = Place::new();
    let mut past = 0;
    for end in ["0.1001 ms", "0.1002 ms", "0.1003 ms", "0.1004 ms", "0.1005 ms", "0.1006 ms"] {
        let numerics = format!("{SHORT_RUN}end = \"{end}\"\noutput_interval = \"10 us\"\n");
        let scene = place.scene("scene.toml", &numerics);
        let out = place.path(end);
        succeed(into_folder("run", &scene, &out, &[]));
        let state = json(out.join("state.json"));
        let summary = json(out.join("summary.json"));
        let (asked, time) =
            (state["end"].as_f64().unwrap(), summary["time"]["value"].as_f64().unwrap());
        past += usize::from(time > asked);
        let rows = column(&out, "time");
        succeed(into_folder("run", &scene, &out, &["--resume"]));
        assert_eq!(column(&out, "time"), rows);
    }
    assert!(past > 0, "no end of these lies before its last step's");
}

/// Whatever decides the motion decides whether a state is gone on from.
#[test]
fn a_solid_of_another_law_does_not_go_on_from_a_state() {
    let place = Place::new();
    let scene = |from: &str, to: &str, end: &str| {
        assert!(SHORT_RUN.contains(from), "{from}");
        let text = format!("{SHORT_RUN}end = \"{end}\"\noutput_interval = \"10 us\"\n");
        place.scene("scene.toml", &text.replace(from, to))
    };
    let out = place.path("out");
    succeed(into_folder("run", &scene("100 1/s", "100 1/s", "0.1 ms"), &out, &[]));
    for (from, to) in [
        ("damping = \"100 1/s\"", "damping = \"101 1/s\""),
        ("amplitude = \"1 um\"", "amplitude = \"2 um\""),
        ("width = \"10 mm\"", "width = \"11 mm\""),
        ("[solid]", "[solid]\nmaterial = { density = \"7000 kg/m^3\" }"),
    ] {
        let other = scene(from, to, "0.2 ms");
        let refused = into_folder("run", &other, &out, &["--resume"]).output().unwrap();
        assert_eq!(refused.status.code(), Some(2), "{to}");
        assert!(stderr(&refused).contains("another scene"), "{to}: {}", stderr(&refused));
    }
    succeed(into_folder("run", &scene("100 1/s", "100 1/s", "0.2 ms"), &out, &["--resume"]));
}
