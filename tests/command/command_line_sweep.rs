//! `sweep`: the table does not depend on threads or interruptions, and no point is
//! lost or mislabelled.

use crate::command_line_common;

use bearing_dynamics::output::series::Series;
use command_line_common::{
    ANGULAR_CONTACT, DEEP_GROOVE, bearing, changed, done, files, json, read, refusal, refused,
    scene, text, write,
};
use ndarray::Array1;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use tempfile::tempdir;

pub const POINTS: usize = 4_000;

/// A bearing that takes its time, about a second for all points on one thread: thirteen balls with
/// forces on them, in a tilted outer race.
pub fn slow_scene(folder: &Path) -> String {
    let scene = read(Path::new(&scene("misaligned_radial.json")));
    write(folder, "slow.json", &changed(&scene, "\"balls\": 8", "\"balls\": 13"))
}

pub fn vary_phase(count: usize) -> String {
    format!("bearing.ball_phase=0 deg .. 20 deg / {count}")
}

pub fn column(table: &Series, name: &str) -> Array1<f64> {
    table.column(name).unwrap_or_else(|| panic!("column {name}")).to_owned()
}

pub fn table(folder: &Path) -> Series {
    let csv = Series::read_csv(&folder.join("sweep.csv")).unwrap();
    assert!(csv == Series::read_npy(&folder.join("sweep.npy")).unwrap());
    csv
}

/// Both forms of the table, to the byte.
pub fn bytes(folder: &Path) -> [Vec<u8>; 3] {
    ["sweep.csv", "sweep.npy", "sweep.columns.json"]
        .map(|name| fs::read(folder.join(name)).unwrap())
}

#[test]
fn the_table_does_not_depend_on_the_number_of_threads() {
    let root = tempdir().unwrap();
    let path = slow_scene(root.path());
    // Not a multiple of the block.
    let vary = vary_phase(1000);
    let sweep = |threads: &[&str], name: &str| {
        let out = root.path().join(name);
        let out_text = text(&out);
        done(&[&["sweep", &path, "--vary", &vary, "--out", &out_text], threads].concat());
        bytes(&out)
    };
    let one = sweep(&["--threads", "1"], "one");
    for threads in ["2", "3", "16"] {
        assert!(one == sweep(&["--threads", threads], threads), "{threads} threads");
        let summary = json(&root.path().join(threads).join("sweep.json"));
        assert_eq!(summary["threads"].to_string(), threads);
    }
    assert!(one == sweep(&[], "default"));
}

/// A sweep has the warnings of `statics`: codes in each row, and each code once with the number of its points.
#[test]
fn warnings_on_points_are_counted() {
    let root = tempdir().unwrap();
    let path = write(root.path(), "scene.toml", DEEP_GROOVE);
    let out = root.path().join("out");
    let vary = "inner_race.z.load=-1 N, -500 N, -20 kN, -30 kN, -40 kN";
    let said = done(&["sweep", &path, "--vary", vary, "--out", &text(&out), "--threads", "1"]);
    let rows = column(&table(&out), "warnings").to_vec();
    let mut points = 0;
    for (point, load) in ["-1 N", "-500 N", "-20 kN", "-30 kN", "-40 kN"].into_iter().enumerate() {
        let alone = root.path().join(format!("alone_{point}"));
        let set = format!("inner_race.z.load={load}");
        done(&["statics", &path, "--set", &set, "--out", &text(&alone)]);
        let warnings = json(&alone.join("summary.json"))["warnings"].as_array().unwrap().clone();
        let codes = warnings.iter().map(|warning| warning["code"].as_str().unwrap());
        let mut numbers: Vec<f64> = codes.map(|code| code[1..3].parse().unwrap()).collect();
        numbers.sort_by(f64::total_cmp);
        points += numbers.len();
        assert_eq!(rows[point], numbers.iter().fold(0.0, |all, one| 100.0 * all + one), "{load}");
    }
    let all = json(&out.join("sweep.json"))["warnings"].as_array().unwrap().clone();
    let pressure = all.iter().find(|warning| warning["code"] == "W03-pressure-above-rating");
    let pressure = pressure.expect("30 kN on this bearing dent it");
    assert_eq!((&pressure["point"], &pressure["points"]), (&json!(3), &json!(2)), "{pressure}");
    assert_eq!(pressure["at"], json!(["inner_race.z.load = -30 kN"]));
    assert!(
        said.contains("warning[W03-pressure-above-rating]")
            && said.contains("(2 of 5 points, the first is point 3)"),
        "{said}"
    );
    let counted: u64 = all.iter().map(|warning| warning["points"].as_u64().unwrap()).sum();
    assert_eq!(counted, points as u64);
}

/// A race beside the middle of its bearing makes an assembly of it, whose table has other columns: no row stands under another's header.
#[test]
fn rows_with_other_columns_are_no_rows() {
    let root = tempdir().unwrap();
    let path = write(root.path(), "scene.toml", DEEP_GROOVE);
    let out = root.path().join("out");
    let vary = "bearing.inner_at=0 mm .. 5 mm / 6";
    let run = bearing(&["sweep", &path, "--vary", vary, "--out", &text(&out)]);
    assert_eq!(run.code, Some(2), "{}", run.stderr);
    assert!(run.stderr.contains("5 of 6 points") && run.stderr.contains("other columns"));
    let sweep = table(&out);
    assert_eq!(column(&sweep, "point").to_vec(), [0.0]);
    let alone = root.path().join("alone");
    let vary = "bearing.inner_at=1 mm .. 5 mm / 5";
    done(&["sweep", &path, "--vary", vary, "--out", &text(&alone)]);
    assert_eq!(column(&table(&alone), "point").len(), 5);
}

/// Points of a shaft report what `bearing statics` reports of their scenes: position, stiffness, forces and codes.
#[test]
fn a_point_of_an_assembly_is_the_statics_of_its_scene() {
    let root = tempdir().unwrap();
    let out = root.path().join("out");
    let shipped = scene("shaft_back_to_back.toml");
    let keys = ["body.shaft.z.load", "bearing.left.balls"];
    let points = [["-500 N", "11"], ["-900 N", "11"], ["-2 kN", "10"]];
    let vary = [0, 1].map(|i| format!("{}={}", keys[i], points.map(|point| point[i]).join(", ")));
    let varied = ["--vary", &vary[0], "--vary", &vary[1]];
    done(&[&["sweep", &shipped, "--together", "--out", &text(&out)][..], &varied].concat());
    let sweep = table(&out);
    assert_eq!(column(&sweep, "point").to_vec(), [0.0, 1.0, 2.0]);
    for (point, values) in points.iter().enumerate() {
        let alone = root.path().join(point.to_string());
        let set = [0, 1].map(|i| format!("{}={}", keys[i], values[i]));
        let how = ["--set", &set[0], "--set", &set[1], "--set", "output.plots=[]"];
        done(&[&["statics", &shipped, "--out", &text(&alone)][..], &how].concat());
        let summary: Value =
            serde_json::from_str(&fs::read_to_string(alone.join("summary.json")).unwrap()).unwrap();
        for (name, at) in [
            ("shaft_stiffness_z", "/stiffness/matrix/2/2"),
            ("left_force_on_inner_x", "/bearings/left/inner_race/contact_force/x/value"),
            ("right_force_on_inner_z", "/bearings/right/inner_race/contact_force/z/value"),
        ] {
            let value =
                summary.pointer(at).and_then(Value::as_f64).unwrap_or_else(|| panic!("{at}"));
            let cell = column(&sweep, name)[point];
            assert!((cell - value).abs() <= 1e-12 * value.abs(), "{name}: {cell} {value}");
        }
        let mut numbers: Vec<f64> = summary["warnings"]
            .as_array()
            .unwrap()
            .iter()
            .map(|warning| warning["code"].as_str().unwrap()[1..3].parse().unwrap())
            .collect();
        numbers.sort_by(f64::total_cmp);
        numbers.dedup();
        let codes = numbers.iter().fold(0.0, |codes, number| 100.0 * codes + number);
        assert_eq!(column(&sweep, "warnings")[point], codes);
    }
    let message = refused(&[
        "sweep",
        &shipped,
        "--together",
        "--vary",
        &vary[0],
        "--vary",
        "bearing.left.balls=11",
    ]);
    assert!(message.contains("has 3 values") && message.contains("has 1"), "{message}");
}

/// A loose ring that buckles to one side: every point reports it, whatever its neighbours.
#[test]
fn every_point_reports_the_saddle_that_it_left() {
    let root = tempdir().unwrap();
    let scene = "[bearing]\nkind = \"deep-groove\"\nballs = 9\nball_phase = \"-90 deg\"\npitch_radius = \"19.25 mm\"\n\
                 clearance = { radial = \"20 um\" }\ninner_race = { conformity = 0.515 }\nouter_race = { conformity = 0.525 }\n\
                 ball = { diameter = \"7.938 mm\" }\n[inner_race]\nz = { load = \"-2 kN\" }\n";
    let path = write(root.path(), "scene.toml", scene);
    let out = root.path().join("out");
    let vary =
        ["inner_race.z.load=-2000 N .. -2400 N / 5", "bearing.clearance.radial=19 um .. 22 um / 4"];
    done(&["sweep", &path, "--vary", vary[0], "--vary", vary[1], "--out", &text(&out)]);
    let codes = column(&table(&out), "warnings").to_vec();
    assert!(codes.len() == 20 && codes.iter().all(|code| *code == 2.0), "{codes:?}");
}

#[test]
fn a_grid_runs_through_its_last_key_fastest_and_solves_what_it_says() {
    let root = tempdir().unwrap();
    let base = format!(
        "{DEEP_GROOVE}[inner_race]\nx = {{ load = \"100 N\" }}\nz = {{ load = \"-1 kN\" }}\n\
         tilt_y = {{ tilt = \"0 deg\" }}\ntilt_z = {{ tilt = \"0 deg\" }}\n"
    );
    let path = write(root.path(), "scene.toml", &base);
    let out = root.path().join("out");
    done(&[
        "sweep",
        &path,
        "--vary",
        "bearing.hertz=hamrock-brewe,exact",
        "--vary",
        // Other units than the first, and the minus sign of a typeset table.
        "inner_race.z.load = -1 kN, -1500 N, \u{2212}2e-3 MN",
        "--vary",
        "bearing.balls=8,9",
        "--out",
        &text(&out),
    ]);
    let table = table(&out);
    let header: Vec<String> = table.columns()[..5].iter().map(|column| column.header()).collect();
    assert_eq!(
        header,
        [
            "point [1]",
            "bearing.hertz [choice]",
            "inner_race.z.load [kN]",
            "bearing.balls [1]",
            "x [um]"
        ]
    );
    assert_eq!(
        json(&out.join("sweep.json"))["axes"],
        json!([
            { "key": "bearing.hertz", "count": 2, "unit": "choice",
              "choices": ["hamrock-brewe", "exact"] },
            { "key": "inner_race.z.load", "count": 3, "unit": "kN" },
            { "key": "bearing.balls", "count": 2, "unit": "1" },
        ])
    );
    let mut rows = table.data().rows().into_iter();
    let mut point = 0.0;
    for (choice, hertz) in ["hamrock-brewe", "exact"].iter().enumerate() {
        for load in [-1.0, -1.5, -2.0] {
            for balls in [8.0, 9.0] {
                let row = rows.next().unwrap();
                let axes: Vec<f64> = row.iter().take(4).copied().collect();
                assert_eq!(axes, [point, choice as f64, load, balls]);
                point += 1.0;
                let same = base
                    .replacen("balls = 8", &format!("balls = {balls}\nhertz = \"{hertz}\""), 1)
                    .replacen("\"-1 kN\"", &format!("\"{load} kN\""), 1);
                let same = write(root.path(), "point.toml", &same);
                let results = root.path().join("results");
                done(&["statics", &same, "--out", &text(&results)]);
                let summary = json(&results.join("summary.json"));
                let number = |at: &str| summary.pointer(at).unwrap()["value"].as_f64().unwrap();
                let cell = |name: &str| row[column_index(&table, name)];
                for (name, value, scale) in [
                    ("x", 1e6 * number("/inner_race/position/x"), 10.0),
                    ("z", 1e6 * number("/inner_race/position/z"), 10.0),
                    ("load_z", number("/inner_race/loads/z"), 1e3),
                    ("stiffness_z", number("/stiffness/z/z"), 1e8),
                    ("largest_inner_load", number("/load_zone/largest_inner_load"), 1e3),
                    (
                        "loaded_balls",
                        summary["load_zone"]["balls_loaded_inner"].as_f64().unwrap(),
                        1.0,
                    ),
                ] {
                    // Both are the same search; the table is rounded like the summary.
                    assert!((cell(name) - value).abs() <= 1e-12 * scale, "{name} {value} {row}");
                }
            }
        }
    }
    assert!(rows.next().is_none());
}

fn column_index(table: &Series, name: &str) -> usize {
    table.columns().iter().position(|column| column.name == name).unwrap()
}

#[test]
fn ranges_meet_both_ends_and_the_scene_may_hold_the_sweep() {
    let root = tempdir().unwrap();
    let out = root.path().join("out");
    let path = scene("varying_compliance.toml");
    assert!(done(&["sweep", &path, "--out", &text(&out)]).starts_with("364 points in "));
    let whole = table(&out);
    let phase = column(&whole, "bearing.ball_phase");
    assert!((0..364).all(|point| phase[point] == (point % 91) as f64 * 0.5));
    let clearance = column(&whole, "bearing.clearance.radial");
    assert!((0..364).all(|point| clearance[point] == [5.0, 0.0, -5.0, -10.0][point / 91]));
    // One pitch on, the same bearing stands there again, with the balls numbered anew.
    for (name, scale) in [("y", 10.0), ("z", 10.0), ("largest_inner_load", 1e3)] {
        let values = column(&whole, name);
        for start in [0, 91, 182, 273] {
            let difference = (values[start] - values[start + 90]).abs();
            assert!(difference <= 1e-9 * scale, "{name}: {difference}");
        }
    }
    // The command line goes before the scene.
    let arguments = ["sweep", &path, "--vary", "bearing.ball_phase=0 rad .. 0.1 rad / 3"];
    done(&[&arguments[..], &["--out", &text(&out)]].concat());
    let phase = table(&out);
    assert_eq!(phase.columns()[1].header(), "bearing.ball_phase [rad]");
    assert_eq!(column(&phase, "bearing.ball_phase").to_vec(), [0.0, 0.05, 0.1]);
}

#[test]
fn points_without_a_solution_are_listed_and_all_others_kept() {
    let root = tempdir().unwrap();
    let out = root.path().join("out");
    let held = "[inner_race]\ny = { displacement = \"0 um\" }\nz = { displacement = \"0 um\" }\n\
                tilt_y = { tilt = \"0 deg\" }\ntilt_z = { tilt = \"0 deg\" }\n\
                x = { load = \"445 N\" }\n";
    let path = write(root.path(), "scene.toml", &format!("{ANGULAR_CONTACT}{held}"));
    // Key, values, which of them fail, why.
    let cases: [(&str, &[&str], &[usize], &str); 4] = [
        ("inner_race.x.load", &["400 N", "1000 MN", "-400 N", "500 N"], &[1], "no equilibrium"),
        ("inner_race.x.load", &["1000 MN", "400 N", "1000 MN"], &[0, 2], "no equilibrium"),
        ("bearing.outer_race.groove_radius", &["6.6 mm", "5 mm", "7 mm"], &[1], "does not fit"),
        ("bearing.outer_race.groove_radius", &["5 mm", "1 m", "7 mm"], &[0, 1], "Allowed: "),
    ];
    for (key, values, failing, why) in cases {
        let vary = format!("{key}={}", values.join(", "));
        let arguments = ["sweep", &path, "--vary", &vary, "--out", &text(&out)];
        let run = bearing(&arguments);
        let message = refusal(&arguments, &run);
        let start = format!(
            "{} of {} points have no solution (listed in {}), the first is point {}: ",
            failing.len(),
            values.len(),
            out.join("sweep.json").display(),
            failing[0]
        );
        assert!(message.starts_with(&start) && message.contains(why), "{message}");
        assert!(run.stdout.starts_with(&format!("{} points in ", values.len())), "{}", run.stdout);
        let summary = json(&out.join("sweep.json"));
        assert_eq!(
            (&summary["complete"], &summary["points"]),
            (&json!(true), &json!(values.len()))
        );
        let listed = summary["failures"].as_array().unwrap();
        assert_eq!(listed.len(), failing.len());
        for (failure, &point) in listed.iter().zip(failing) {
            assert_eq!(failure["point"], point);
            assert_eq!(failure["at"], json!([format!("{key} = {}", values[point])]));
            assert!(failure["message"].as_str().unwrap().contains(why), "{failure}");
        }
        let kept: Vec<f64> =
            (0..values.len()).filter(|point| !failing.contains(point)).map(|p| p as f64).collect();
        let table = table(&out);
        assert_eq!(column(&table, "point").to_vec(), kept);
        assert!(table.data().iter().all(|value| value.is_finite()));
        assert!(!out.join("sweep.journal").exists());
    }
}

#[test]
fn a_sweep_that_makes_no_sense_is_refused_before_anything_is_written() {
    let root = tempdir().unwrap();
    let out = text(&root.path().join("out"));
    let path = scene("deep_groove_tilt.toml");
    let cases: [(&[&str], &str); 13] = [
        (&[], "nothing to vary"),
        (&["bearing.ball_phase"], "no '='"),
        (&["bearing.ball_fase=1 deg"], "did you mean `bearing.ball_phase`"),
        (&["bearing=1"], "unknown key"),
        (&["bearing.ball_phase=1"], "has no unit"),
        (&["bearing.ball_phase=1 mm"], "unit of length"),
        (&["bearing.ball_phase="], "an entry is empty"),
        (&["bearing.ball_phase=0 deg .. 1 deg / 0"], "whole number from 2"),
        (&["bearing.hertz=hamrok"], "\"hamrock-brewe\", \"exact\""),
        (&["title=a"], "title"),
        (&["bearing.balls=8", "bearing.balls=9"], "varied twice"),
        (
            &["bearing.clearance.radial=1 um, 2 um", "bearing.clearance.diametral=1 um, 2 um"],
            "exclude each other",
        ),
        (&["bearing.outer_race.groove_radius=5 mm, 5.5 mm"], "does not fit a ball"),
    ];
    for (axes, part) in cases {
        let varied = axes.iter().flat_map(|axis| ["--vary", axis]);
        let arguments: Vec<&str> =
            ["sweep", &path, "--out", &out].into_iter().chain(varied).collect();
        let message = refused(&arguments);
        assert!(message.contains(part), "{part}: {message}");
    }
    let many = "bearing.ball_phase=0 deg .. 1 deg / 10000000";
    let loads = "inner_race.z.load=0 N .. 1 N / 10000000";
    let arguments = ["sweep", &path, "--vary", many, "--vary", loads, "--out", &out];
    assert!(refused(&arguments).contains("more than 100000000 points"));
    assert!(!root.path().join("out").exists());
}

#[test]
fn a_new_sweep_replaces_the_table_of_an_older_one() {
    let root = tempdir().unwrap();
    let out = root.path().join("out");
    let path = scene("deep_groove_tilt.toml");
    let sweep = |values: &str| {
        let vary = format!("bearing.balls={values}");
        done(&["sweep", &path, "--vary", &vary, "--out", &text(&out)]);
        table(&out).data().nrows()
    };
    assert_eq!((sweep("7, 8, 9"), sweep("8")), (3, 1));
    assert_eq!(files(&out).len(), 4);
}

#[cfg(target_os = "linux")]
#[test]
fn a_terminal_is_shown_the_progress_and_a_pipe_is_not() {
    let root = tempdir().unwrap();
    let path = slow_scene(root.path());
    let out = text(&root.path().join("out"));
    let vary = vary_phase(POINTS);
    // `script` gives the command a terminal.
    let line = format!(
        "'{}' sweep '{path}' --vary '{vary}' --threads 1 --out '{out}'",
        env!("CARGO_BIN_EXE_bearing")
    );
    let run = Command::new("script")
        .args(["-q", "-e", "-c", &line, "/dev/null"])
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let shown = String::from_utf8_lossy(&run.stdout);
    assert!(run.status.success(), "{shown}");
    let progress: Vec<&str> =
        shown.split('\r').filter(|line| line.contains(&format!("/{POINTS} points, "))).collect();
    assert!(progress.len() >= 3 && progress.iter().all(|line| line.contains("left")), "{shown}");
    // A file is no terminal: nothing but the last line, and warnings.
    let said = done(&["sweep", &path, "--vary", &vary_phase(200), "--out", &out]);
    assert_eq!(said.lines().filter(|line| !line.starts_with("warning[")).count(), 1, "{said}");
}

/// The record of a sweep says how it was made.
#[test]
fn the_record_has_what_a_reader_needs() {
    let root = tempdir().unwrap();
    let out = root.path().join("out");
    let path = scene("deep_groove_moment.toml");
    done(&["sweep", &path, "--out", &text(&out), "--threads", "2"]);
    let Value::Object(record) = json(&out.join("sweep.json")) else { panic!() };
    assert_eq!(record["scene"], path);
    assert_eq!(record["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(record["threads"], 2);
    assert!(record["seconds"].as_f64().unwrap() > 0.0);
}

#[test]
fn a_sweep_of_a_scene_with_a_run_says_that_it_is_one_of_statics() {
    let root = tempdir().unwrap();
    let out = text(&root.path().join("sweep"));
    let vary = ["--vary", "bearing.ball_phase=0 deg, 5 deg", "--out", &out];
    for (name, has_run) in [("settling.toml", true), ("deep_groove_tilt.toml", false)] {
        let said = done(&[&["sweep", &scene(name), "--fresh"], &vary[..]].concat());
        assert_eq!(said.contains("--of runs sweeps its run"), has_run, "{said}");
    }
}
