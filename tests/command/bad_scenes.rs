//! Scenes that are refused (`tests/data/bad`), one a kind of mistake: one message each.
//!
//! The first line of a file names the command, then the parts of its message: the place, the key, and the allowed
//! values or the key meant instead. Most files have a correct scene of `tests/data/bad/base` as their base.

use crate::command_line_common::{bearing, done, files, read, refusal, text};
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/bad")
}

#[test]
fn every_bad_scene_has_one_clear_message() {
    let names = files(&folder()).into_iter().filter(|name| name.ends_with(".toml"));
    let mut faults = Vec::new();
    for name in names {
        let file = folder().join(&name);
        let content = read(&file);
        let first = content.lines().next().and_then(|line| line.strip_prefix("# "));
        let mut parts = first.expect("a comment").split(" | ");
        let command = parts.next().expect("a command");
        let place = text(&file);
        let out = tempfile::tempdir().unwrap();
        let mut arguments = vec![command, &place];
        let out = text(out.path());
        if command != "check" {
            arguments.extend(["--out", &out]);
        }
        let run = bearing(&arguments);
        if run.code != Some(2) {
            faults.push(format!("{name}: {run:?}"));
            continue;
        }
        let message = refusal(&arguments, &run);
        let missing: Vec<&str> = parts.filter(|part| !message.contains(part)).collect();
        if !missing.is_empty() || message.len() > 600 {
            faults.push(format!("{name}: no {missing:?} in {message:?}"));
        }
    }
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn their_bases_are_correct() {
    let folder = folder().join("base");
    for name in files(&folder) {
        done(&["check", &text(&folder.join(name))]);
    }
}
