//! A sweep of runs: a run a point, with the bits of `bearing run`, interrupted or not.

use crate::command_line_common::{
    command, done, files, json, read, refusal, refused, scene, text, write,
};
use bearing_dynamics::output::Series;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::tempdir;

/// A cage that falls on its land while the shaft starts to turn, from three positions of the balls.
fn study(folder: &Path) -> String {
    let base = scene("cage_600rpm.toml");
    let numerics = "integrator = \"rosenbrock\"\naccuracy = 1e-5\nend = \"12 ms\"\noutput_interval = \"0.1 ms\"";
    let sweep = "of = \"runs\"\n\"bearing.ball_phase\" = \"0 deg .. 0.02 deg / 3\"";
    let output = "plots = []\nwindow_start = \"8 ms\"";
    let words = format!(
        "base = \"{base}\"\n[numerics]\n{numerics}\n[output]\n{output}\n[sweep]\n{sweep}\n"
    );
    write(folder, "study.toml", &words)
}

fn point(out: &Path, point: usize) -> PathBuf {
    out.join(format!("point-{point}"))
}

/// Starts the sweep on one thread, and interrupts it once its first point is complete.
fn interrupt(path: &str, out: &Path, signal: &str) -> crate::command_line_common::Run {
    let mut child = command()
        .args(["sweep", path, "--threads", "1", "--out", &text(out)])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while !point(out, 1).join("state.json").exists() && !point(out, 1).is_dir() {
        assert!(start.elapsed() <= Duration::from_secs(60), "no second point");
        assert!(child.try_wait().unwrap().is_none(), "over before it could be interrupted");
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(Duration::from_millis(20));
    let sent = Command::new("sh").args(["-c", &format!("kill {signal} {}", child.id())]).status();
    assert!(sent.unwrap().success());
    child.wait_with_output().unwrap().into()
}

#[test]
fn points_have_the_bits_of_single_runs_after_an_interruption() {
    let folder = tempdir().unwrap();
    let path = study(folder.path());
    let out = folder.path().join("out");
    let run = interrupt(&path, &out, "-INT");
    let message = refusal(&["sweep"], &run);
    // Half a second a point: a busy machine may be late by one.
    let complete = (1..=2).find(|kept| {
        let expected = format!("interrupted after {kept} of 3 points, kept in {}", out.display());
        message.starts_with(&expected)
    });
    let complete = complete.unwrap_or_else(|| panic!("{message}"));
    let state = json(&point(&out, complete).join("state.json"));
    assert_eq!(state["stopped"], "interrupted");
    assert_eq!(json(&out.join("sweep.json"))["complete"], false);
    let first = fs::metadata(point(&out, 0).join("series.npy")).unwrap().modified().unwrap();

    let said = done(&["sweep", &path, "--threads", "2", "--out", &text(&out)]);
    assert!(said.starts_with("3 runs in "), "{said}");
    let again = fs::metadata(point(&out, 0).join("series.npy")).unwrap().modified().unwrap();
    assert_eq!(first, again, "a complete point is not run again");
    assert_eq!(json(&out.join("sweep.json"))["complete"], true);

    let table = Series::read_npy(&out.join("series.npy")).unwrap();
    assert_eq!(table.data().nrows(), 3);
    for (index, phase) in ["0 deg", "0.01 deg", "0.02 deg"].iter().enumerate() {
        let single = folder.path().join(format!("single-{index}"));
        let set = format!("bearing.ball_phase={phase}");
        done(&["run", &path, "--set", &set, "--out", &text(&single)]);
        for name in ["series.csv", "series.npy", "series.columns.json"] {
            let [a, b] = [single.join(name), point(&out, index).join(name)];
            assert!(fs::read(a).unwrap() == fs::read(b).unwrap(), "{name} of point {index}");
        }
        assert_eq!(files(&single), files(&point(&out, index)));
        check_row(&table, index, &single);
    }
    check_spread(&table, &out);
}

/// Statistics of the rows from 8 ms on.
fn check_row(table: &Series, index: usize, single: &Path) {
    let series = Series::read_npy(&single.join("series.npy")).unwrap();
    let of = |name: &str| table.column(&format!("cage_z_{name}")).unwrap()[index];
    let all = series.column("cage_z").unwrap().to_vec();
    let window = &all[80..];
    assert_eq!(window.len(), 41);
    let mean = window.iter().sum::<f64>() / 41.0;
    let rms = (window.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / 41.0).sqrt();
    assert!((of("mean") - mean).abs() <= 1e-15 && (of("rms") - rms).abs() <= 1e-15);
    assert!(rms > 1e-6, "it moves");
    assert_eq!(of("smallest"), window.iter().copied().fold(f64::INFINITY, f64::min));
    assert_eq!(of("largest"), window.iter().copied().fold(f64::NEG_INFINITY, f64::max));
    assert_eq!(table.column("bearing.ball_phase").unwrap()[index], 0.01 * index as f64);
}

fn check_spread(table: &Series, out: &Path) {
    let means = table.column("cage_z_mean").unwrap().to_vec();
    let spread = &json(&out.join("summary.json"))["channels"]["cage_z"]["mean"];
    let of = |name: &str| spread[name]["value"].as_f64().unwrap();
    let mean = means.iter().sum::<f64>() / 3.0;
    let square: f64 = means.iter().map(|value| (value - mean).powi(2)).sum();
    assert!((of("mean") - mean).abs() <= 1e-18);
    assert!((of("deviation") - (square / 2.0).sqrt()).abs() <= 1e-18 && of("deviation") > 0.0);
    assert_eq!(of("largest"), means.iter().copied().fold(f64::NEG_INFINITY, f64::max));
    assert_eq!(spread["mean"]["unit"], "m");
}

#[test]
fn a_point_that_fails_is_listed_and_the_others_go_on() {
    let folder = tempdir().unwrap();
    let path = study(folder.path());
    let out = text(&folder.path().join("out"));
    let vary = ["--vary", "bearing.balls=30, 11"];
    let run = crate::command_line_common::bearing(
        &[&["sweep", &path, "--out", &out][..], &vary].concat(),
    );
    let message = refusal(&["sweep"], &run);
    assert!(message.starts_with("1 of 2 runs failed") && message.contains("30 balls"), "{message}");
    let record = json(&folder.path().join("out/sweep.json"));
    assert_eq!((&record["complete"], &record["failures"][0]["point"]), (&true.into(), &0.into()));
    assert_eq!(read(&folder.path().join("out/series.csv")).lines().count(), 2);
    assert_eq!(
        read(&folder.path().join("out/series.csv")).lines().nth(1).unwrap()[..7],
        *"1.0,11."
    );

    for (arguments, why) in [
        (&["--of", "statics"][..], "holds a sweep of runs"),
        (&["--vary", "numerics.end=1 ms, 2 ms"], "output.window_start"),
        (&["--vary", "bearing.balls=30, 31"], "30 balls"),
    ] {
        let said = refused(&[&["sweep", &path, "--out", &out], arguments].concat());
        assert!(said.contains(why), "{said}");
    }
    // Another grid replaces the runs of a finished one, and says so.
    let said = done(&["sweep", &path, "--out", &out, "--vary", "bearing.balls=11"]);
    assert!(said.starts_with("the earlier results in "), "{said}");
    assert!(!Path::new(&out).join("point-1").exists());
}
