//! The `bearing` command as a user starts it.
#![allow(dead_code)]

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Exit code and what was printed.
#[derive(Debug)]
pub struct Run {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl From<Output> for Run {
    fn from(output: Output) -> Run {
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8 output");
        Run { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }
}

/// The command, ready to be started. A backtrace, should there be one, is asked for and so seen.
pub fn command() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bearing"));
    command.stdin(Stdio::null()).env("RUST_BACKTRACE", "1").env_remove("RAYON_NUM_THREADS");
    command
}

pub fn bearing(arguments: &[&str]) -> Run {
    command().args(arguments).output().expect("the command starts").into()
}

/// Runs the command, which must succeed and say nothing on standard error but, on a slow machine, what takes long.
pub fn done(arguments: &[&str]) -> String {
    let run = bearing(arguments);
    let waits = run.stderr.lines().all(|line| line.ends_with('…'));
    assert!(run.code == Some(0) && waits, "bearing {arguments:?}: {run:#?}");
    run.stdout
}

/// Runs the command, which must refuse with one line of the program's own on standard error and
/// nothing on standard output.
pub fn refused(arguments: &[&str]) -> String {
    let run = bearing(arguments);
    assert_eq!(run.stdout, "", "bearing {arguments:?}");
    refusal(arguments, &run)
}

/// The message of a run that ended with exit code 2, whatever it had printed before.
pub fn refusal(arguments: &[&str], run: &Run) -> String {
    assert_eq!(run.code, Some(2), "bearing {arguments:?}: {run:#?}");
    let message = run.stderr.strip_prefix("bearing: ").and_then(|rest| rest.strip_suffix('\n'));
    let message = message.unwrap_or_else(|| panic!("bearing {arguments:?}: {:?}", run.stderr));
    assert!(!message.contains('\n') && message.len() > 10, "{message:?}");
    // Folders of tests may end in anything.
    for trace in ["panicked", "RUST_BACKTRACE", "Err(", "Error {", " src/", "/src/"] {
        assert!(!message.contains(trace), "{message:?}");
    }
    message.to_string()
}

/// A file of the repository's `scenes/`.
pub fn scene(name: &str) -> String {
    text(&scenes().join(name))
}

pub fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

/// A path as an argument.
pub fn text(path: &Path) -> String {
    path.to_str().expect("a path in UTF-8").to_string()
}

pub fn write(folder: &Path, name: &str, content: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, content).expect("the test's folder is writable");
    text(&path)
}

pub fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

pub fn json(path: &Path) -> Value {
    serde_json::from_str(&read(path)).expect("JSON")
}

/// `text` with `from`, which must occur in it once, replaced.
pub fn changed(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from:?} in {text}");
    text.replacen(from, to, 1)
}

/// Names of the files in a folder, sorted.
pub fn files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Scenes of bearings that have an equilibrium: those of a solid, of a shaft that bends, which is there in a run only, and on another
/// scene have tests of their own (`solid_command`, `scene_shaft`, `scenes_on_bases`).
pub fn bearing_scenes() -> Vec<String> {
    let mut names = files(&scenes());
    names.retain(|name| {
        let path = scene(name);
        let words = ["[solid", ".beam]", "\nbase = "];
        let other = |text: String| words.iter().any(|word| text.contains(word));
        Path::new(&path).is_file() && !other(read(Path::new(&path)))
    });
    assert!(names.len() >= 8, "{names:?}");
    names
}

/// The bearing of Table 4.1 without loads and without a title.
pub const DEEP_GROOVE: &str = r#"defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 8
clearance = { radial = "-5 um" }
[bearing.inner_race]
radius = "20.047 mm"
groove_radius = "6.013 mm"
[bearing.outer_race]
radius = "31.953 mm"
groove_radius = "6.310 mm"
[bearing.ball]
radius = "5.953 mm"
"#;

/// The bearing of Table 5.3.
pub const ANGULAR_CONTACT: &str = r#"defaults = "dissertation"
[bearing]
kind = "angular-contact"
balls = 11
pitch_radius = "30 mm"
contact_angle = "35 deg"
ball.radius = "5.953 mm"
inner_race.groove_radius = "6.6 mm"
outer_race.groove_radius = "6.6 mm"
"#;
