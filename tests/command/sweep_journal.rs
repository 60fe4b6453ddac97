//! A `sweep` that is interrupted, killed or damaged goes on from its journal to the same bytes.

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

/// Points of a chunk, as the journal keeps them.
const CHUNK: usize = 64;

/// A sweep of the slow scene on one thread that has come past its third chunk.
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
        let journal = out.join("sweep.journal");
        let lines = || fs::read(&journal).map_or(0, |text| text.split(|&b| b == b'\n').count());
        let start = Instant::now();
        // The header, three chunks and the empty rest after the last line break.
        while lines() < 5 {
            assert!(start.elapsed() <= Duration::from_secs(60), "no journal");
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

    fn journal(&self) -> PathBuf {
        self.out.join("sweep.journal")
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
        assert_eq!(files(&self.out), names, "the journal is gone, and nothing else is left");
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
        assert!((3 * CHUNK..POINTS).contains(&kept) && kept.is_multiple_of(CHUNK), "{kept}");
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
    // As if the end had come in the middle of a line, whether it did or not.
    let journal = read(&sweep.journal());
    let complete = journal.rfind('\n').unwrap();
    let last = journal[..complete].rfind('\n').unwrap();
    fs::write(sweep.journal(), &journal[..(last + complete) / 2]).unwrap();
    fs::write(sweep.out.join(".sweep.journal.4294967294.partial"), "half").unwrap();
    let chunks = journal[..last].lines().count() - 1;
    assert!(chunks >= 2);
    sweep.resume_and_compare(chunks * CHUNK);
}

/// A kill, or a crash of the machine, may cut the journal anywhere: in its last record or in its header,
/// with or without what was never text behind it. `JOURNAL_CUTS=all` cuts at every byte of the record.
#[test]
fn a_journal_that_was_cut_anywhere_is_resumed() {
    let root = tempdir().unwrap();
    let path = write(root.path(), "a.toml", DEEP_GROOVE);
    // The last chunk has two points, so that its record is short.
    let points = CHUNK + 2;
    let vary = vary_phase(points);
    let sweep = |out: &Path| {
        ["sweep", &path, "--vary", &vary, "--threads", "1", "--out", &text(out)].map(str::to_string)
    };
    let run = |out: &Path| {
        let arguments = sweep(out);
        done(&arguments.each_ref().map(String::as_str))
    };
    let whole = root.path().join("whole");
    run(&whole);
    // The journal of this sweep, caught before it is over.
    let out = root.path().join("out");
    let journal = out.join("sweep.journal");
    let mut kept = Vec::new();
    for _ in 0..200 {
        let arguments = sweep(&out);
        let mut child = command().args(&arguments).stdout(Stdio::null()).spawn().unwrap();
        while child.try_wait().unwrap().is_none() {
            let lines = |bytes: &[u8]| bytes.iter().filter(|&&b| b == b'\n').count();
            if let Ok(bytes) = fs::read(&journal)
                && bytes.ends_with(b"\n")
                && lines(&bytes) == 3
            {
                kept = bytes;
            }
        }
        if !kept.is_empty() {
            break;
        }
    }
    assert!(!kept.is_empty(), "the sweep was never seen half way");
    let ends: Vec<usize> = (0..kept.len()).filter(|&at| kept[at] == b'\n').collect();
    let last = ends[1] + 1;
    // The end, where numbers, brackets and the break are, and some bytes before; all of them on request.
    let step = if std::env::var("JOURNAL_CUTS").is_ok_and(|all| all == "all") { 1 } else { 29 };
    let inside =
        (last..kept.len()).filter(|at| kept.len() - at < 6 || (at - last).is_multiple_of(step));
    let cuts = inside.chain([0, 1, ends[0] / 2, ends[0], ends[0] + 1]);
    for (count, cut) in cuts.enumerate() {
        let rest: &[u8] = [&b""[..], b"\xff\xfe\n", b"\0\0\0\0"][count % 3];
        fs::create_dir_all(&out).unwrap();
        fs::write(&journal, [&kept[..cut], if cut > ends[0] { rest } else { b"" }].concat())
            .unwrap();
        let said = run(&out);
        assert!(said.starts_with(&format!("{} points", points)), "cut at {cut}: {said}");
        assert!(bytes(&out) == bytes(&whole), "cut at {cut}");
        assert!(!journal.exists());
        fs::remove_file(out.join("sweep.json")).unwrap();
    }
}

/// A sweep is one of its scene's base as well.
#[test]
fn the_journal_of_another_base_is_refused() {
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
    assert!(said.contains("sweep.journal belongs to an unfinished sweep"), "{said}");
}

#[test]
fn the_journal_of_another_sweep_is_refused_until_it_is_discarded() {
    let mut sweep = Started::new();
    sweep.stop("-KILL");
    let out = text(&sweep.out);
    let journal = read(&sweep.journal());
    let (path, vary) = (sweep.path.as_str(), sweep.vary.as_str());
    let other =
        write(sweep.root.path(), "other.json", &changed(&read(Path::new(path)), "-2", "-3"));
    let short = vary_phase(3);
    for arguments in [
        vec!["sweep", &other, "--vary", vary, "--out", &out],
        vec!["sweep", path, "--vary", &short, "--out", &out],
        vec!["sweep", path, "--vary", vary, "--out", &out, "--cold"],
        vec!["sweep", path, "--vary", vary, "--vary", "bearing.balls=8,9", "--out", &out],
    ] {
        let message = refused(&arguments);
        assert!(message.contains("sweep.journal belongs to an unfinished sweep"), "{message}");
        assert!(message.contains("--fresh") && message.contains("--out"), "{message}");
        assert!(read(&sweep.journal()) == journal, "the journal stays as it was");
    }
    fs::write(sweep.journal(), "not a journal\n").unwrap();
    assert!(refused(&["sweep", path, "--vary", &short, "--out", &out]).contains("--fresh"));
    let fresh = text(&sweep.root.path().join("fresh"));
    let said = done(&["sweep", path, "--vary", &short, "--out", &out, "--fresh"]);
    assert!(said.starts_with("3 points in "), "{said}");
    done(&["sweep", path, "--vary", &short, "--out", &fresh]);
    assert!(bytes(&sweep.out) == bytes(Path::new(&fresh)));
    assert!(!sweep.journal().exists());
}
