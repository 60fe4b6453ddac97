//! Scenes without any symmetry (`tests/data/asymmetric`): every number of their summaries and rows, compared with
//! `golden/asymmetric`; each run in two halves gives the rows of the whole one, and does what its plan says.
//!
//! The scenes of `scenes/` are symmetric, at the origin and loaded along one axis, so that a lost sign or a swapped
//! index goes unseen in them. Here every key has a value of its own. Laws and cases judge what is right; this test
//! only sees that a number changed. To accept a change: `make golden CASE=asymmetric REASON="…"`.

use crate::command_line_common::{changed, done, files, json, read, text, write};
use bearing_dynamics::output::npy;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Allowed relative difference. Another processor's order of sums changes less than 1e-9 in these short runs.
const DIFFERENCE: f64 = 1e-6;

/// A column below this part of the largest value of its unit is rounding error.
const ROUNDING: f64 = 1e-11;

/// Rounding error of a fact that is zero.
const ZERO: f64 = 1e-12;

/// Facts that are nearly zero: their sizes agree within this factor.
const NEARLY_ZERO: [&str; 4] = ["residual", "unaccounted", "unbalanced", "out_of_round"];
const FACTOR: f64 = 1e3;

/// Parts of the summary that repeat the scene or depend on the machine.
const SKIPPED: [&str; 10] =
    ["plan", "stages", "final", "timings", "run", "program", "version", "scene", "echo", "seconds"];

/// Numbers by their place and name.
type Numbers = BTreeMap<String, BTreeMap<String, f64>>;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Every number of a summary; those of one place together.
fn facts(of: &Value, place: &str, name: &str, to: &mut Numbers) {
    let below = format!("{place} {name}");
    match of {
        Value::Object(entries) if entries.contains_key("value") && entries.contains_key("unit") => {
            facts(&entries["value"], place, name, to);
        }
        Value::Object(entries) => {
            let kept = entries.iter().filter(|(key, _)| !SKIPPED.contains(&key.as_str()));
            kept.for_each(|(key, value)| facts(value, &below, key, to));
        }
        Value::Array(list) => {
            let numbered = list.iter().enumerate();
            numbered.for_each(|(i, value)| facts(value, &below, &i.to_string(), to));
        }
        Value::Number(number) => {
            let number = number.as_f64().expect("a number");
            to.entry(place.into()).or_default().insert(name.into(), number);
        }
        _ => {}
    }
}

/// Of each column of rows the largest value, and a sum with weights by row, so that it sees rows that change places.
fn columns(out: &Path, to: &mut Numbers) {
    let rows = npy::parse(&fs::read(out.join("series.npy")).unwrap()).unwrap();
    let names = json(&out.join("series.columns.json"));
    let names = names.as_array().expect("a list of columns");
    assert_eq!(rows.ncols(), names.len());
    let largest = |column: usize| rows.column(column).iter().fold(0.0f64, |a, v| a.max(v.abs()));
    for (i, column) in names.iter().enumerate() {
        let alike = (0..names.len()).filter(|j| names[*j]["unit"] == column["unit"]);
        let floor = ROUNDING * alike.map(largest).fold(0.0, f64::max);
        let values = rows.column(i);
        let weighted = values.iter().enumerate().map(|(row, v)| v * (1.0 + (row % 7) as f64));
        let (largest, sum) = (largest(i), weighted.sum());
        let kept = if largest <= floor { [0.0; 2] } else { [largest, sum] };
        let entry = ["largest", "sum"].map(String::from).into_iter().zip(kept).collect();
        to.insert(format!("column {}", column["name"].as_str().expect("a name")), entry);
    }
}

/// A run to half of its end, then resumed to its end, has the rows of the unbroken run.
fn resumes(file: &Path, whole: &str, folder: &Path) {
    let content = read(file);
    let end = content.lines().find_map(|line| line.strip_prefix("end = \"")).expect("an end");
    let (value, unit) = end.split_once('"').expect("a text").0.split_once(' ').expect("a unit");
    let half = format!("{} {unit}", 0.5 * value.parse::<f64>().expect("a number"));
    let half = changed(&content, &format!("end = \"{end}"), &format!("end = \"{half}\""));
    let half = write(folder, "half.toml", &half);
    let out = folder.join("halves");
    done(&["run", &half, "--out", &text(&out)]);
    let printed = done(&["run", &text(file), "--out", &text(&out), "--resume"]);
    assert!(printed.contains("resumed at"), "{printed}");
    let resumed = read(&out.join("series.csv"));
    let differ = whole.lines().zip(resumed.lines()).find(|(one, other)| one != other);
    assert!(differ.is_none() && whole.len() == resumed.len(), "{}: {differ:?}", file.display());
}

/// The plan of a run names the stages that ran, and no other.
fn keeps_its_plan(summary: &Value) {
    let list = |key: &str| summary[key].as_array().expect("a list").clone();
    let (plan, stages) = (list("plan"), list("stages"));
    let planned = plan.iter().filter(|line| line.as_str().expect("a line").starts_with("does "));
    let done = stages.iter().filter(|stage| stage["does"] == true).count();
    assert!(planned.count() == done && done >= 2, "{plan:?} {stages:?}");
    for stage in stages {
        let ran = stage["ran"].as_u64().expect("a count") > 0;
        assert_eq!(ran, stage["does"] == true, "{stage}");
    }
}

/// All numbers that the commands in the scene's first line give.
fn numbers(file: &Path) -> Numbers {
    let content = read(file);
    let first = content.lines().next().and_then(|line| line.strip_prefix("# commands: "));
    let mut all = Numbers::new();
    for command in first.expect("commands").split(", ") {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        done(&[command, &text(file), "--out", &text(&out)]);
        let summary = json(&out.join("summary.json"));
        let mut found = Numbers::new();
        facts(&summary, "facts", "all", &mut found);
        if command == "run" {
            columns(&out, &mut found);
            // The plan of a bushing in elements does not list its impulses, supports and Maxwell elements.
            if !file.ends_with("bushings.toml") {
                keeps_its_plan(&summary);
            }
            resumes(file, &read(&out.join("series.csv")), folder.path());
        }
        all.extend(found.into_iter().map(|(place, of)| (format!("{command} {place}"), of)));
    }
    all
}

fn alike(place: &str, name: &str, before: f64, now: f64) -> bool {
    if NEARLY_ZERO.iter().any(|word| place.contains(word) || name.contains(word)) {
        let [smaller, larger] = [before.abs().min(now.abs()), before.abs().max(now.abs())];
        return larger <= FACTOR * smaller + ZERO;
    }
    (before - now).abs() <= DIFFERENCE * before.abs() + ZERO
}

/// A line a place, so that a change of one number is a change of one line.
fn written(reason: &str, numbers: &Numbers) -> String {
    let mut file = format!("{{\n\"reason\": {},\n\"numbers\": {{", Value::from(reason));
    for (i, (place, of)) in numbers.iter().enumerate() {
        let rounded = |v: &f64| format!("{v:.9e}").parse::<f64>().expect("a number");
        let of: BTreeMap<_, _> = of.iter().map(|(name, v)| (name, rounded(v))).collect();
        let (comma, of) = (if i == 0 { "" } else { "," }, serde_json::to_string(&of).unwrap());
        write!(file, "{comma}\n{}: {of}", Value::from(place.as_str())).unwrap();
    }
    file + "\n}\n}\n"
}

fn check(scene: &str) {
    let now = numbers(&folder("tests/data/asymmetric").join(scene).with_extension("toml"));
    let golden = folder("golden/asymmetric").join(scene).with_extension("json");
    if let Ok(reason) = std::env::var("GOLDEN_REASON") {
        assert!(reason.trim().len() >= 10, "a reason for new numbers: {reason:?}");
        fs::write(golden, written(&reason, &now)).unwrap();
        return;
    }
    let before: Numbers = serde_json::from_value(json(&golden)["numbers"].clone()).unwrap();
    let mut different = Vec::new();
    for (place, of) in &before {
        for (name, before) in of {
            match now.get(place).and_then(|of| of.get(name)) {
                Some(now) if alike(place, name, *before, *now) => {}
                now => different.push(format!("{place} {name}: {before} became {now:?}")),
            }
        }
    }
    assert!(different.is_empty(), "{} differences:\n{}", different.len(), different.join("\n"));
}

macro_rules! scenes {
    ($($name:ident),*) => {
        $(#[test]
        fn $name() {
            check(stringify!($name));
        })*

        #[test]
        fn every_asymmetric_scene_is_tested() {
            let names = [$(stringify!($name)),*];
            assert_eq!(files(&folder("tests/data/asymmetric")), names.map(|name| format!("{name}.toml")));
            assert_eq!(files(&folder("golden/asymmetric")), names.map(|name| format!("{name}.json")));
        }
    };
}

scenes!(
    angular_reversed,
    bushings,
    deep_groove,
    housing_quasi_static,
    housings_explicit,
    housings_reduced,
    shaft_and_hub,
    solid_bar
);
