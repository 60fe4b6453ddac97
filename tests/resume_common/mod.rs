//! Runs of the command that are interrupted, and folders that must be the same.
#![allow(dead_code)]

use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Every file of two folders to the byte, but for wall times.
pub fn assert_same_results(expected: &Path, found: &Path) {
    let names = |folder: &Path| {
        let list = |folder: PathBuf, before: &str| {
            let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
            let files = entries.filter(|entry| entry.path().is_file());
            let names =
                files.map(|entry| format!("{before}{}", entry.file_name().to_string_lossy()));
            names.collect::<Vec<_>>()
        };
        let mut names = list(folder.to_path_buf(), "");
        if folder.join("fields").is_dir() {
            names.extend(list(folder.join("fields"), "fields/"));
        }
        names.sort();
        names
    };
    assert_eq!(names(expected), names(found));
    for name in names(expected) {
        let [a, b] = [expected, found].map(|folder| folder.join(&name));
        if ["summary.json", "state.json"].contains(&name.as_str()) {
            let [a, b] = [a, b].map(|path| without_seconds(&path));
            assert_eq!(a.to_string(), b.to_string(), "{name}");
        } else {
            assert!(fs::read(a).unwrap() == fs::read(b).unwrap(), "{name} differs");
        }
    }
}

fn without_seconds(path: &Path) -> Value {
    let mut tree: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    assert!(tree.as_object_mut().unwrap().remove("seconds").is_some(), "{}", path.display());
    tree
}

/// An end that no run reaches before its signal comes, however long that takes on a busy machine.
pub const NEVER: &str = "10 s";

/// An end, to the nanosecond, so many milliseconds after where the run in a folder stopped.
pub fn end_after(folder: &Path, milliseconds: f64) -> String {
    let state: Value =
        serde_json::from_slice(&fs::read(folder.join("state.json")).unwrap()).unwrap();
    format!("{:.6} ms", 1e3 * state["time"].as_f64().unwrap() + milliseconds)
}

/// Starts a run and waits until it steps.
pub fn start(mut command: Command) -> Child {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.as_mut().unwrap());
    let mut line = String::new();
    while !line.contains("a row every") {
        line.clear();
        if lines.read_line(&mut line).unwrap() == 0 {
            panic!("it ended before it stepped: {}", wait(child).1);
        }
    }
    child
}

/// Starts a run and sends it a signal so many milliseconds after its first step; its code and what it said.
pub fn stopped(command: Command, after: u64, name: &str) -> (Option<i32>, String) {
    let child = start(command);
    std::thread::sleep(Duration::from_millis(after));
    signal(&child, name);
    wait(child)
}

/// Starts a run into a folder, interrupts it so many milliseconds after its first step, and reads the state that it left.
pub fn interrupted(command: Command, after: u64, folder: &Path) -> Value {
    let (code, message) = stopped(command, after, "-TERM");
    assert_eq!(code, Some(2), "{message}");
    assert!(message.contains("interrupted at t = ") && message.contains("--resume"), "{message}");
    let read = |name: &str| -> Value {
        serde_json::from_slice(&fs::read(folder.join(name)).unwrap()).unwrap()
    };
    let (state, summary) = (read("state.json"), read("summary.json"));
    assert_eq!(state["stopped"], "interrupted");
    assert_eq!(
        (&summary["complete"], &summary["stopped_by"]),
        (&false.into(), &"interrupted".into())
    );
    state
}

pub fn signal(child: &Child, name: &str) {
    let id = child.id().to_string();
    assert!(Command::new("kill").args([name, &id]).status().unwrap().success());
}

pub fn wait(mut child: Child) -> (Option<i32>, String) {
    let mut text = String::new();
    child.stderr.as_mut().unwrap().read_to_string(&mut text).unwrap();
    (child.wait().unwrap().code(), text)
}
