//! A `sweep` that is interrupted, killed or damaged resumes from the rows of `sweep.csv` to the same bytes.

use super::command_line_sweep::{POINTS, bytes, slow_scene, table, vary_phase};
use crate::command_line_common;

use command_line_common::{
    DEEP_GROOVE, Run, changed, command, done, files, json, read, refusal, refused, text, write,
};
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::{TempDir, tempdir};

/// Points of a block.
const BLOCK: usize = 16;

/// A sweep of the slow scene on one thread after its third block.
struct Started {
    root: TempDir,
    path: String,
    vary: String,
    out: PathBuf,
    child: Child,
}

impl Started {
    fn new() -> Started {
        let root = tempdir().unwrap();
        let path = slow_scene(root.path());
        Started::of(root, path)
    }

    fn of(root: TempDir, path: String) -> Started {
        let vary = vary_phase(POINTS);
        let out = root.path().join("out");
        let mut child = command()
            .args(["sweep", &path, "--vary", &vary, "--threads", "1", "--out", &text(&out)])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let csv = out.join("sweep.csv");
        let lines = || fs::read(&csv).map_or(0, |text| text.split(|&b| b == b'\n').count());
        let start = Instant::now();
        while lines() < 3 * BLOCK + 2 {
            assert!(start.elapsed() <= Duration::from_secs(60), "no rows");
            assert!(child.try_wait().unwrap().is_none(), "over before it could be interrupted");
            std::thread::sleep(Duration::from_millis(1));
        }
        Started { root, path, vary, out, child }
    }

    /// Sends a signal and waits for the end.
    fn stop(&mut self, signal: &str) -> Run {
        let sent =
            Command::new("sh").args(["-c", &format!("kill {signal} {}", self.child.id())]).status();
        assert!(sent.unwrap().success());
        let mut output = [String::new(), String::new()];
        use std::io::Read;
        self.child.stdout.take().unwrap().read_to_string(&mut output[0]).unwrap();
        self.child.stderr.take().unwrap().read_to_string(&mut output[1]).unwrap();
        let [stdout, stderr] = output;
        Run { code: self.child.wait().unwrap().code(), stdout, stderr }
    }

    fn csv(&self) -> PathBuf {
        self.out.join("sweep.csv")
    }

    /// The same command again, then the same sweep from the start: the same bytes.
    fn resume_and_compare(&self, kept: usize) {
        let arguments = ["sweep", &self.path, "--vary", &self.vary, "--threads", "1", "--out"];
        let [out, whole] = [text(&self.out), text(&self.root.path().join("whole"))];
        let said = done(&[&arguments[..], &[&out]].concat());
        assert!(said.starts_with(&format!("{POINTS} points ({kept} resumed) in ")), "{said}");
        let said = done(&[&arguments[..], &[&whole]].concat());
        assert!(said.starts_with(&format!("{POINTS} points in ")), "{said}");
        assert!(bytes(&self.out) == bytes(Path::new(&whole)));
        assert_eq!(table(&self.out).data().nrows(), POINTS);
        assert_eq!(json(&self.out.join("sweep.json"))["complete"], true);
        let names = ["sweep.columns.json", "sweep.csv", "sweep.json", "sweep.npy"];
        assert_eq!(files(&self.out), names, "nothing else is left");
    }
}

#[test]
fn an_interrupted_sweep_keeps_its_points_and_resumes_to_the_same_bytes() {
    for signal in ["-INT", "-TERM"] {
        let mut sweep = Started::new();
        let run = sweep.stop(signal);
        assert_eq!(run.stdout, "");
        let message = refusal(&["sweep", signal], &run);
        let kept: usize = message
            .strip_prefix("interrupted after ")
            .and_then(|rest| {
                rest.strip_suffix(&format!(
                    " of {POINTS} points, kept in {}; the same command resumes",
                    sweep.out.display()
                ))
            })
            .unwrap_or_else(|| panic!("{message}"))
            .parse()
            .unwrap();
        assert!((3 * BLOCK..POINTS).contains(&kept) && kept.is_multiple_of(BLOCK), "{kept}");
        let partial = table(&sweep.out);
        assert_eq!(partial.data().nrows(), kept);
        let summary = json(&sweep.out.join("sweep.json"));
        assert_eq!((&summary["complete"], &summary["solved"]), (&json!(false), &json!(kept)));
        sweep.resume_and_compare(kept);
        let whole = table(&sweep.out);
        for row in partial.data().rows() {
            assert_eq!(row, whole.data().row(row[0] as usize));
        }
    }
}

#[test]
fn a_killed_sweep_resumes_to_the_same_bytes() {
    let mut sweep = Started::new();
    assert_eq!(sweep.stop("-KILL").code, None);
    fs::write(sweep.out.join(".sweep.csv.4294967294.partial"), "half").unwrap();
    let rows = read(&sweep.csv()).matches('\n').count() - 1;
    sweep.resume_and_compare(rows / BLOCK * BLOCK);
}

/// A kill, or a crash of the machine, may cut the table anywhere, with or without bytes behind it that were never text.
#[test]
fn a_table_that_was_cut_anywhere_is_resumed() {
    let root = tempdir().unwrap();
    let path = write(root.path(), "a.toml", DEEP_GROOVE);
    let out = root.path().join("out");
    let (vary, out_text) = (vary_phase(2 * BLOCK + 2), text(&out));
    let run = || done(&["sweep", &path, "--vary", &vary, "--threads", "1", "--out", &out_text]);
    run();
    let whole = bytes(&out);
    let record = read(&out.join("sweep.json"));
    let unfinished = changed(&record, "\"complete\": true", "\"complete\": false");
    let csv = &whole[0];
    let cuts = (0..csv.len()).step_by(211).chain(csv.len() - 6..=csv.len());
    for (count, cut) in cuts.enumerate() {
        let rest: &[u8] = [&b""[..], b"\xff\xfe\n", b"\0\0\0\0", b"7,1\n"][count % 4];
        fs::write(out.join("sweep.csv"), [&csv[..cut], rest].concat()).unwrap();
        fs::write(out.join("sweep.json"), &unfinished).unwrap();
        let said = run();
        let rows = csv[..cut].iter().filter(|&&byte| byte == b'\n').count().saturating_sub(1);
        let kept = if rows == 2 * BLOCK + 2 { rows } else { rows / BLOCK * BLOCK };
        let resumed = if kept > 0 { format!(" ({kept} resumed)") } else { String::new() };
        assert!(said.starts_with(&format!("34 points{resumed} in ")), "cut at {cut}: {said}");
        assert!(bytes(&out) == whole, "cut at {cut}");
    }
}

/// A sweep is one of its scene's base as well.
#[test]
fn rows_of_another_base_are_refused() {
    let root = tempdir().unwrap();
    let base = slow_scene(root.path());
    let path = write(root.path(), "study.toml", "base = \"slow.json\"\n");
    let mut sweep = Started::of(root, path);
    sweep.stop("-KILL");
    fs::write(&base, changed(&read(Path::new(&base)), "\"balls\": 13", "\"balls\": 12")).unwrap();
    let said = refused(&[
        "sweep",
        &sweep.path,
        "--vary",
        &sweep.vary,
        "--threads",
        "1",
        "--out",
        &text(&sweep.out),
    ]);
    assert!(said.contains("sweep.json belongs to an unfinished sweep"), "{said}");
}

#[test]
fn rows_of_another_sweep_are_refused_until_they_are_discarded() {
    let mut sweep = Started::new();
    sweep.stop("-KILL");
    let out = text(&sweep.out);
    let rows = read(&sweep.csv());
    let (path, vary) = (sweep.path.as_str(), sweep.vary.as_str());
    let other =
        write(sweep.root.path(), "other.json", &changed(&read(Path::new(path)), "-2", "-3"));
    let short = vary_phase(3);
    for arguments in [
        vec!["sweep", &other, "--vary", vary, "--out", &out],
        vec!["sweep", path, "--vary", &short, "--out", &out],
        vec!["sweep", path, "--vary", vary, "--vary", "bearing.balls=8,9", "--out", &out],
    ] {
        let message = refused(&arguments);
        assert!(message.contains("sweep.json belongs to an unfinished sweep"), "{message}");
        assert!(message.contains("--fresh") && message.contains("--out"), "{message}");
        assert!(read(&sweep.csv()) == rows, "the rows stay");
    }
    let fresh = text(&sweep.root.path().join("fresh"));
    let said = done(&["sweep", path, "--vary", &short, "--out", &out, "--fresh"]);
    assert!(said.starts_with("3 points in "), "{said}");
    done(&["sweep", path, "--vary", &short, "--out", &fresh]);
    assert!(bytes(&sweep.out) == bytes(Path::new(&fresh)));
}
