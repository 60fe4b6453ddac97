//! `bearing check` of a bearing in its housing: nothing that a run uses is left unsaid.

use crate::housed_command_common;

use housed_command_common::*;
use serde_json::{Value, json};

const RUN: &str = "[numerics]\nend = \"1 ms\"\noutput_interval = \"0.02 ms\"\n\
                   fields_interval = \"0.2 ms\"\n";

/// What `check` says, as text and as JSON.
fn checked(place: &Place, text: &str) -> (String, Value) {
    let scene = place.scene("scene.toml", text);
    let said = succeed(command("check", &scene, &[]));
    let echo = succeed(command("check", &scene, &["--json"]));
    (said, serde_json::from_str(&echo).unwrap())
}

/// Lines of the text that start with a label, without it.
fn lines(said: &str, label: &str) -> Vec<String> {
    let found = said.lines().filter_map(|line| {
        let (before, after) = line.split_at_checked(25)?;
        (before.trim() == label).then(|| after.to_string())
    });
    found.collect()
}

#[test]
fn numerics_output_assumptions_and_defaults_are_echoed() {
    let place = Place::new();
    for method in ["quasi-static", "explicit"] {
        let housing = format!("method = \"{method}\"\nfit.radial = \"2 um\"");
        let (said, echo) = checked(&place, &scene_text(&housing, RUN));
        let numerics = &echo["scene"]["numerics"];
        assert_eq!(numerics["end"], 0.001);
        assert_eq!(numerics["fields_interval"], 2e-4);
        let explicit = method == "explicit";
        assert_eq!(echo["numerics"]["integrator"] == "rk4", explicit, "{echo}");
        // As many assumptions and defaults as the text for people has, and the same.
        for (label, notes) in [("assumption", "assumptions"), ("default", "defaults")] {
            let notes = echo[notes].as_array().unwrap();
            let text = |name: &str, note: &Value| note[name].as_str().unwrap().to_string();
            let expected: Vec<String> = notes
                .iter()
                .map(|note| match label {
                    "assumption" => format!("{}: {}", text("name", note), text("text", note)),
                    _ => format!(
                        "{} = {} ({})",
                        text("key", note),
                        text("value", note),
                        text("reason", note)
                    ),
                })
                .collect();
            assert!(!expected.is_empty());
            assert_eq!(lines(&said, label), expected);
        }
        let fields = lines(&said, "fields");
        assert!(
            fields[0].starts_with("every 0.0002 s: 6 files, about ") && fields.len() == 1,
            "{fields:?}"
        );
        let motion = if explicit { "inner race motion" } else { "motion" };
        assert_eq!(lines(&said, motion).len(), 1, "{said}");
        assert_eq!(lines(&said, "steps").len(), usize::from(explicit), "{said}");
        // The summary of a run repeats the scene.
        let scene = place.scene("scene.toml", &scene_text(&housing, RUN));
        let out = place.path(method);
        succeed(into_folder("run", &scene, &out, &[]));
        assert_eq!(json(out.join("summary.json"))["scene"], echo["scene"]);
    }
}

#[test]
fn what_cannot_be_drawn_or_recorded_is_refused() {
    let place = Place::new();
    let (_, echo) = checked(&place, &scene_text("", ""));
    assert!(echo["numerics"].is_null(), "nothing runs");
    for (key, output, run) in [
        ("output.plots", "plots = [\"polar\"]", ""),
        ("output.plots", "plots = [\"moment-tilt\"]", ""),
        ("output.plots", "plots = [\"moment-tilt\"]", RUN),
        ("output.plots", "plots = [\"orbit\", \"slip-spin\"]", RUN),
        ("output.channels", "channels = [\"races\", \"pockets\"]", RUN),
    ] {
        let text = scene_text("", &format!("{run}[output]\n{output}"));
        let output = command("check", &place.scene("scene.toml", &text), &[]).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        let message = stderr(&output);
        assert!(message.contains(key) && message.contains("equilibria"), "{message}");
    }
    // In explicit steps both are drawn.
    let plots = "[output]\nplots = [\"polar\", \"slip-spin\"]\nchannels = [\"loads\"]";
    let text = scene_text("method = \"explicit\"", &format!("{RUN}{plots}"));
    let (_, echo) = checked(&place, &text);
    assert_eq!(echo["scene"]["output"]["plots"], json!(["polar", "slip-spin"]));
    let out = place.path("out");
    succeed(into_folder("run", &place.scene("scene.toml", &text), &out, &[]));
    for name in ["polar.svg", "slip.svg", "spin.svg"] {
        assert!(out.join(name).exists(), "{name}");
    }
}

/// Rings that are rigid, a race beside its seat: said before anything is solved, and kept in the summary.
#[test]
fn fits_and_seats_are_not_taken_in_silence() {
    let place = Place::new();
    let noted = |housing: &str| checked(&place, &scene_text(housing, "")).0;
    let tight = noted("fit.radial = \"5 um\"");
    assert!(tight.contains("the races are rigid") && tight.contains("5.000 um"), "{tight}");
    // E t δ/(r R) of a ring of 3.574 mm: 210 GPa × 3.574 mm × 5 µm / (33.74 mm × 35.527 mm).
    assert!(tight.contains("3.574 mm") && tight.contains("3.131 MPa"), "{tight}");
    assert!(!tight.contains("are beside the bore"), "{tight}");
    let loose = noted("fit.radial = \"-1 um\"");
    assert!(!loose.contains("rigid"), "{loose}");
    let wide = noted("fit.radial = \"-1 um\"\nwidth = \"30 mm\"");
    assert!(wide.contains("width of 30.0000 mm, 10.0000 mm are beside the bore"), "{wide}");
    let scene = place.scene("tight.toml", &scene_text("fit.radial = \"5 um\"", ""));
    let out = place.path("tight");
    let said = succeed(into_folder("statics", &scene, &out, &[]));
    assert!(said.contains("this pressure is from a single node"), "{said}");
    let summary = solids::json(out.join("summary.json"));
    let notes = summary["mesh"]["notes"].to_string();
    assert!(notes.contains("the races are rigid"), "{notes}");
    let pressure = summary["housing"]["seat"]["peak_pressure_note"].as_str().unwrap();
    assert!(pressure.starts_with("from a single node"), "{pressure}");
}

/// Fields come with rows: what interval that makes, how many files and how large they are is known before the run.
#[test]
fn files_of_fields_are_foretold() {
    let place = Place::new();
    let of = |interval: &str| {
        let numerics = format!(
            "[numerics]\nend = \"0.1 ms\"\noutput_interval = \"0.02 ms\"\nfields_interval = \"{interval}\"\n"
        );
        let text = scene_text("method = \"quasi-static\"\nfit.radial = \"2 um\"", &numerics);
        let (said, _) = checked(&place, &text);
        let scene = place.path("scene.toml");
        let plan = succeed(command("plan", &scene, &[]));
        let told = lines(&said, "fields").remove(0);
        assert!(plan.contains(&told), "{told}: {plan}");
        let out = place.path("out");
        succeed(into_folder("run", &scene, &out, &["--fresh"]));
        let files: Vec<u64> = std::fs::read_dir(out.join("fields"))
            .unwrap()
            .map(|file| file.unwrap().metadata().unwrap().len())
            .collect();
        let number = |before: &str| {
            let rest = told.split(before).nth(1).unwrap_or_else(|| panic!("{before}: {told}"));
            rest.split(' ').next().unwrap().parse::<f64>().unwrap()
        };
        assert_eq!(number("s: "), files.len() as f64, "{told}");
        let megabytes = 1e-6 * files.iter().sum::<u64>() as f64;
        assert!((number("about ") / megabytes - 1.0).abs() <= 0.1, "{told}: {megabytes}");
        told
    };
    let short = of("1 us");
    assert!(short.starts_with("every 0.00002 s: 6 files"), "{short}");
    assert!(short.contains("shorter than the time between rows"), "{short}");
    for (interval, files) in [("0.04 ms", 4), ("0.05 ms", 3), ("0.02 ms", 6)] {
        let told = of(interval);
        assert!(told.contains(&format!(": {files} files")) && !told.contains("shorter"), "{told}");
    }
    // Many are worth a warning.
    let numerics =
        "[numerics]\nend = \"1 s\"\noutput_interval = \"0.02 ms\"\nfields_interval = \"1 us\"\n";
    let text = scene_text("method = \"quasi-static\"\nfit.radial = \"2 um\"", numerics);
    let told = lines(&checked(&place, &text).0, "fields").remove(0);
    assert!(
        told.contains("50001 files") && told.contains("WARNING: this is a large amount"),
        "{told}"
    );
}

#[test]
fn other_commands_say_what_they_take() {
    let place = Place::new();
    let scene = place
        .scene("scene.toml", &scene_text("fit.radial = \"1 um\"", "[numerics]\nend = \"1 ms\"\n"));
    let output = command("sweep", &scene, &["--vary", "housing.method=rigid,explicit"]).output();
    let output = output.unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("sweep the two by themselves"), "{}", stderr(&output));
    // Without an end there is nothing to run, but an equilibrium.
    let still = place.scene("still.toml", &scene_text("", ""));
    let output = command("run", &still, &[]).output().unwrap();
    assert!(stderr(&output).contains("a run needs `end`"), "{}", stderr(&output));
    succeed(command("statics", &still, &["--dry"]));
}
