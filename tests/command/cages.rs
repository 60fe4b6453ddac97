//! Cages at the command line: their three forms resume to the same bytes, and hard cases end right or with one error.

use crate::command_line_common::{bearing, changed, done, json, read, refusal, scene, text, write};
use crate::resume_common::assert_same_results;
use std::path::Path;
use tempfile::tempdir;

/// The scene of 5.4.1, speeding up so that balls strike the cage, with these changes.
fn struck(changes: &[(&str, &str)], end: &str) -> String {
    let mut content = read(Path::new(&scene("cage_600rpm.toml")));
    let usual = [
        (
            "[\"0 rpm\", \"600 rpm\"], start = \"0 s\", duration = \"0.3 s\"",
            "[\"1200 rpm\", \"1500 rpm\"], start = \"0 s\", duration = \"1 ms\"",
        ),
        ("integrator = \"rk4\"", "integrator = \"rosenbrock\"\naccuracy = 0.01"),
        ("output_interval = \"10 us\"", "output_interval = \"20 us\""),
        ("end = \"3.12144 s\"", end),
        ("window_start = \"0.5 s\"", "window_start = \"0 s\""),
        ("plots = [\"orbit\", \"spectrum\", \"series\"]", "plots = []"),
    ];
    for (from, to) in usual.iter().chain(changes) {
        content = changed(&content, from, to);
    }
    content
}

const END: &str = "end = \"2 ms\"";
const HALF: &str = "end = \"1.5 ms\"";
const LAW: &str = "law = \"penalty\", stiffness = \"2e8 N/m\" }";

fn cage(body: &str) -> String {
    format!(
        "law = \"penalty\", at = \"nodes\", stiffness = \"2e8 N/m\" }}\nbody = \"{body}\"\nmesh = {{ quarter = 2, bar = 1, wall = 1 }}"
    )
}

#[test]
fn each_form_of_a_cage_resumes_to_the_same_bytes_and_runs_as_planned() {
    let root = tempdir().unwrap();
    for (body, more) in [("rigid", ""), ("reduced", "\ncorrections = false"), ("explicit", "")] {
        let keys = cage(body) + more;
        let whole = write(root.path(), &format!("{body}.toml"), &struck(&[(LAW, &keys)], END));
        let half = write(root.path(), &format!("{body}_half.toml"), &struck(&[(LAW, &keys)], HALF));
        let [out, halves] =
            ["out", "halves"].map(|name| root.path().join(format!("{body}_{name}")));
        done(&["run", &whole, "--out", &text(&out)]);
        done(&["run", &half, "--out", &text(&halves)]);
        done(&["run", &whole, "--out", &text(&halves), "--resume"]);
        assert_same_results(&out, &halves);
        let summary = json(&out.join("summary.json"));
        for stage in summary["stages"].as_array().unwrap() {
            let does = stage["does"].as_bool().unwrap();
            let ran = stage["ran"].as_u64();
            assert!(ran.is_none_or(|ran| (ran > 0) == does), "{body}: {stage}");
        }
        let rows = read(&out.join("series.csv"));
        let names: Vec<&str> = rows.lines().next().unwrap().split(',').collect();
        let largest =
            names.iter().enumerate().filter(|(_, name)| name.contains("pocket_load")).map(
                |(i, _)| {
                    rows.lines()
                        .skip(1)
                        .map(|row| row.split(',').nth(i).unwrap().trim().parse::<f64>().unwrap())
                        .fold(0.0, f64::max)
                },
            );
        assert!(largest.fold(0.0, f64::max) > 10.0, "no ball has struck the {body} cage");
        if body != "rigid" {
            assert!(out.join("fields/cage_000000.vtu").is_file(), "{body}");
        }
    }
}

/// A run that ends well, or one clear error with exit code 2.
#[test]
fn hard_cages_run_or_say_what_is_wrong() {
    let root = tempdir().unwrap();
    let clearance = "race_clearance = \"0.200 mm\"";
    let pocket = "pocket_radius = \"6.500 mm\"";
    let soft = "law = \"penalty\", stiffness = \"2e5 N/m\" }";
    let stiff = "law = \"penalty\", stiffness = \"2e11 N/m\" }";
    let nodes =
        |stiffness: &str| cage("reduced").replace("2e8", stiffness) + "\ncorrections = false";
    let (soft_nodes, stiff_nodes) = (nodes("2e5"), nodes("2e11"));
    let fast = ("[\"1200 rpm\", \"1500 rpm\"]", "[\"15000 rpm\", \"15100 rpm\"]");
    let reduced = nodes("2e8");
    let fine = reduced.replace("quarter = 2, bar = 1, wall = 1", "quarter = 3, bar = 2, wall = 2");
    let cases: [(&str, Vec<(&str, &str)>); 12] = [
        ("no clearance", vec![(clearance, "race_clearance = \"0 mm\"")]),
        (
            "no clearance of a coarse mesh, refused",
            vec![(clearance, "race_clearance = \"0 mm\""), (LAW, &reduced)],
        ),
        ("tight pockets", vec![(pocket, "pocket_radius = \"5.954 mm\"")]),
        (
            "tight pockets of a coarse mesh, refused",
            vec![(pocket, "pocket_radius = \"5.954 mm\""), (LAW, &reduced)],
        ),
        ("no clearance, reduced", vec![(clearance, "race_clearance = \"0 mm\""), (LAW, &fine)]),
        ("soft", vec![(LAW, soft)]),
        ("stiff", vec![(LAW, stiff)]),
        ("soft, reduced", vec![(LAW, &soft_nodes)]),
        ("stiff, reduced", vec![(LAW, &stiff_nodes)]),
        ("fast", vec![fast]),
        ("fast, reduced", vec![fast, (LAW, &reduced)]),
        (
            "pockets beside the balls",
            vec![(pocket, "pocket_radius = \"6.500 mm\"\npocket_pitch_radius = \"29.500 mm\"")],
        ),
    ];
    for (name, changes) in cases {
        let path = write(root.path(), "hard.toml", &struck(&changes, END));
        let out = root.path().join(name);
        let run = bearing(&["run", &path, "--out", &text(&out)]);
        if name.ends_with("refused") {
            let said = refusal(&[name], &run);
            assert!(said.contains("the cage does not fit at the start"), "{name}: {said}");
            continue;
        }
        assert_eq!(run.code, Some(0), "{name}: {run:?}");
        let energy = &json(&out.join("summary.json"))["final"];
        let of = |key: &str| energy[key]["value"].as_f64().unwrap();
        let work =
            of("work_drives").abs() + of("work_traction").abs() + of("work_cage_friction").abs();
        let lost = of("energy_residual").abs();
        assert!(lost <= 1e-3 * work, "{name}: {lost} J of {work} J");
    }
}
