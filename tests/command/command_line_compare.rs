//! `pack` and `compare` on what the solver really writes.

use crate::command_line_common;

use command_line_common::{bearing, changed, done, read, refused, scene, text, write};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::{TempDir, tempdir};

/// A scene with every kind of result: loads and displacements, tilted outer race, forces on the
/// balls, three plots.
const SCENE: &str = "misaligned_radial.json";

/// Scene, its pack and its results folder.
fn packed() -> (TempDir, String, PathBuf, PathBuf) {
    let root = tempdir().unwrap();
    let path = write(root.path(), "scene.json", &read(Path::new(&scene(SCENE))));
    let [pack, results] = ["pack", "results"].map(|name| root.path().join(name));
    done(&["pack", &path, "--out", &text(&pack)]);
    done(&["statics", &path, "--out", &text(&results)]);
    (root, path, pack, results)
}

/// Runs `compare`, which must find a difference, and returns what it says.
fn different(reference: &Path, candidate: &Path) -> String {
    let arguments = ["compare", &text(reference), &text(candidate)];
    let run = bearing(&arguments);
    assert!(run.code == Some(1) && run.stderr.is_empty(), "{run:#?}");
    assert!(run.stdout.starts_with("different: "), "{}", run.stdout);
    run.stdout
}

#[test]
fn a_pack_equals_the_results_of_its_own_scene() {
    let (_root, _, pack, results) = packed();
    let said = done(&["compare", &text(&pack), &text(&results)]);
    assert!(said.starts_with("equal: "), "{said}");
    let packed_scene = text(&pack.join("scene.json"));
    done(&["statics", &packed_scene, "--out", &text(&results)]);
    done(&["compare", &text(&pack), &text(&results), "--class", "f64-exact"]);
    let printed = done(&["compare", &text(&pack), &text(&results), "--json"]);
    let outcome: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(outcome["equal"], true);
    // 23 columns × 8 balls, and the summary.
    assert!(outcome["checked"].as_u64().unwrap() > 23 * 8 + 200, "{}", outcome["checked"]);
    // A pack written over an older one is the new one.
    done(&["pack", &packed_scene, "--out", &text(&pack)]);
    done(&["compare", &text(&pack), &text(&results)]);
}

#[test]
fn another_scene_differs_and_the_channel_is_named() {
    let (root, path, pack, results) = packed();
    let given = read(Path::new(&path));
    // Less than 1e-10 of the load moves nothing by more than 1e-9; a millinewton does.
    for (load, equal) in [("-2000.0000001 N", true), ("-2000.001 N", false)] {
        let other = changed(&given, "\"-2 kN\"", &format!("\"{load}\""));
        let other = write(root.path(), "other.json", &other);
        done(&["statics", &other, "--out", &text(&results)]);
        if equal {
            done(&["compare", &text(&pack), &text(&results)]);
            continue;
        }
        let said = different(&pack, &results);
        assert!(said.contains("\nfirst divergence: series.csv, "), "{said}");
        assert!(said.contains(" (f64-reordered): "), "{said}");
        let listed = bearing(&["compare", &text(&pack), &text(&results), "--json"]).stdout;
        let listed: Value = serde_json::from_str(&listed).unwrap();
        for channel in ["inner_load", "inner_race.loads.z"] {
            let mut all = listed["channels"].as_array().unwrap().iter();
            let own = all.find(|of| of["channel"] == channel).unwrap();
            assert!(own["differing"].as_u64().unwrap() > 0, "{own}");
        }
        let files = ["series.csv", "summary.json"].map(|name| {
            let said = different(&pack.join(name), &results.join(name));
            said.lines().nth(1).unwrap().to_string()
        });
        assert!(files[0].contains("series.csv"), "{files:?}");
        assert!(files[1].contains("summary.json"), "{files:?}");
    }
    // Another title is another scene, and no number.
    let other = write(root.path(), "other.json", &changed(&given, "radial load", "load"));
    let titled = root.path().join("titled");
    done(&["statics", &other, "--out", &text(&titled)]);
    done(&["statics", &path, "--out", &text(&results)]);
    let said = different(&results, &titled);
    assert!(said.contains("scene.title"), "{said}");
}

#[test]
fn a_pack_that_is_not_as_written_is_no_reference() {
    let (_root, _, pack, results) = packed();
    let compare = |out: &Path| refused(&["compare", &text(&pack), &text(out)]);
    let names = ["series.csv", "summary.json", "resolved.json", "scene.json", "README.txt"];
    for name in names {
        let path = pack.join(name);
        let whole = fs::read(&path).unwrap();
        let mut flipped = whole.clone();
        let at = whole.len() / 2;
        flipped[at] ^= 1;
        for bytes in [&flipped[..], &whole[..at], b""] {
            fs::write(&path, bytes).unwrap();
            let message = compare(&results);
            assert!(message.contains(name) && message.contains(&text(&pack)), "{message}");
        }
        fs::remove_file(&path).unwrap();
        assert!(compare(&results).contains(name));
        fs::write(&path, whole).unwrap();
        done(&["compare", &text(&pack), &text(&results)]);
    }
    let manifest = pack.join("manifest.json");
    let whole = read(&manifest);
    fs::write(&manifest, &whole[..whole.len() / 2]).unwrap();
    assert!(compare(&results).contains("manifest.json"));
    fs::write(&manifest, whole).unwrap();
    // The user may set other tolerances, if they make sense.
    let tolerances = pack.join("tolerances.json");
    fs::write(&tolerances, r#"{"class": "mixed"}"#).unwrap();
    done(&["compare", &text(&pack), &text(&results)]);
    fs::write(&tolerances, r#"{"class": "loose"}"#).unwrap();
    assert!(compare(&results).contains("tolerances.json"));
}

#[test]
fn what_cannot_be_compared_is_named() {
    let (root, path, pack, results) = packed();
    let empty = root.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let [pack_text, results_text, empty] = [&pack, &results, &empty].map(|path| text(path));
    let csv = text(&results.join("series.csv"));
    let summary = text(&results.join("summary.json"));
    let broken = write(root.path(), "broken.csv", "load [N]\nmuch\n");
    let nowhere = text(&root.path().join("nowhere"));
    for (reference, candidate, part) in [
        (&nowhere, &results_text, "nowhere"),
        (&results_text, &nowhere, "nowhere"),
        (&empty, &results_text, "empty is not a results folder"),
        (&results_text, &empty, "empty is not a results folder"),
        (&pack_text, &empty, "empty is not a results folder"),
        (&csv, &summary, "different kinds"),
        (&csv, &results_text, "different kinds"),
        (&csv, &broken, "is not a number"),
        (&pack_text, &csv, "different kinds"),
        (&text(&results.join("polar.svg")), &csv, "only .csv, .npy, .json"),
    ] {
        let message = refused(&["compare", reference, candidate]);
        assert!(message.contains(part), "{message}");
    }
    let misused = |arguments: &[&str], part: &str| {
        let run = bearing(arguments);
        assert!(run.code == Some(2) && run.stderr.contains(part), "{run:#?}");
        let value = arguments.last().unwrap();
        assert!(run.stderr.contains(&format!("invalid value '{value}'")), "{run:#?}");
    };
    let negative = ["compare", &results_text, &results_text, "--rtol", "-1"];
    misused(&negative, "zero or more, such as 1e-3");
    for seconds in ["-3", "0", "1.5"] {
        misused(&["run", &path, "--save-every", seconds], "whole seconds, 1 or more, such as 30");
    }
    // A pack is not written into a folder with something else in it.
    let message = refused(&["pack", &path, "--out", &results_text]);
    assert!(message.contains("results of another kind (static solution)"), "{message}");
    let notes = root.path().join("notes");
    fs::create_dir(&notes).unwrap();
    fs::write(notes.join("notes.txt"), "mine").unwrap();
    let message = refused(&["pack", &path, "--out", &text(&notes)]);
    assert!(message.contains("holds notes.txt"), "{message}");
}

/// What is not there is said to be missing, and results of different kinds to be of different kinds.
#[test]
fn what_cannot_be_compared_is_told_why() {
    let root = tempdir().unwrap();
    let path = write(root.path(), "scene.toml", &read(Path::new(&scene("settling.toml"))));
    let [still, moving] = ["still", "moving"].map(|name| text(&root.path().join(name)));
    let numerics = "end = \"0.1 ms\"\nstep = \"2 us\"\noutput_interval = \"10 us\"";
    let other = super::run_command::scene(numerics, "plots = []");
    let other = write(root.path(), "moving.toml", &other);
    done(&["statics", &path, "--out", &still]);
    done(&["run", &other, "--out", &moving]);
    let nowhere = [text(&root.path().join("nowhere")), text(&root.path().join("none"))];
    let missing = |one: &str, other: &str| refused(&["compare", one, other]);
    for (one, other) in [(&nowhere[0], &nowhere[1]), (&nowhere[0], &still), (&still, &nowhere[0])] {
        let message = missing(one, other);
        assert!(message.contains("nowhere does not exist; check the path"), "{message}");
    }
    let message = missing(&moving, &still);
    let said =
        format!("{moving} holds a run, {still} holds an equilibrium: results of different kinds");
    assert!(message.starts_with(&said), "{message}");
}
