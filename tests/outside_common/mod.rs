//! Programs of others that some tests need. A test that goes without says so: on standard error, which
//! the harness shows of failing tests alone, and in `target/skipped.txt`, which `make test` prints last.
#![allow(dead_code)]

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The Python that has VTK: `PYTHON` if set, else `python3`. `None` if there is no such one; then the
/// skip of `test` has been written down.
///
/// # Panics
/// Without VTK where `REQUIRE_VTK` is set, as in `.ci/run`.
pub fn python_with_vtk(test: &str) -> Option<String> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let has_vtk = Command::new(&python).args(["-c", "import vtk"]).output();
    if has_vtk.is_ok_and(|output| output.status.success()) {
        return Some(python);
    }
    let why = format!("{python} has no vtk: pip install vtk, or PYTHON=… for one that has it");
    assert!(std::env::var_os("REQUIRE_VTK").is_none(), "{test}: {why}, as REQUIRE_VTK asks");
    let line = format!("SKIPPED test {test}: {why}\n");
    eprint!("{line}");
    write_down(&skipped_file(), &line);
    None
}

/// `skipped.txt` of the target folder.
pub fn skipped_file() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("skipped.txt")
}

/// Adds a line at once, so that tests that run side by side keep theirs whole.
pub fn write_down(file: &Path, line: &str) {
    let mut file = OpenOptions::new().create(true).append(true).open(file).unwrap();
    file.write_all(line.as_bytes()).unwrap();
}
