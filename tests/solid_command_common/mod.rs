//! Scenes with a solid alone, and the command that takes them.
#![allow(dead_code)]

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub const YOUNG: f64 = 210e9;
pub const DENSITY: f64 = 7850.0;

pub struct Place {
    pub folder: tempfile::TempDir,
}

impl Place {
    pub fn new() -> Place {
        Place { folder: tempfile::tempdir().unwrap() }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn scene(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, text).unwrap();
        path
    }
}

pub fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

pub fn command(name: &str, scene: &Path, further: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bearing"));
    command.arg(name).arg(scene).args(further);
    command
}

pub fn into_folder(name: &str, scene: &Path, out: &Path, further: &[&str]) -> Command {
    let mut command = command(name, scene, further);
    command.arg("--out").arg(out);
    command
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub fn succeed(mut command: Command) -> String {
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

pub fn json(path: PathBuf) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

pub fn number(value: &Value) -> f64 {
    value["value"].as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

pub fn assert_near(ours: f64, expected: f64, relative: f64) {
    let error = (ours / expected - 1.0).abs();
    assert!(error <= relative, "{ours:e} is {error:e} off {expected:e}");
}

/// A column of a run's `series.csv`.
pub fn column(folder: &Path, name: &str) -> Vec<f64> {
    column_of(&folder.join("series.csv"), name)
}

/// A column of a `.csv` file.
pub fn column_of(path: &Path, name: &str) -> Vec<f64> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let header = lines.next().unwrap();
    let at = header.split(',').position(|head| head.starts_with(&format!("{name} [")));
    let at = at.unwrap_or_else(|| panic!("{name} is not in {header}"));
    lines.map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

/// A steel bar of 40 × 10 × 10 mm.
pub fn bar(order: u8, further: &str) -> String {
    format!(
        r#"
[solid.mesh]
generate = "bar"
length = "40 mm"
width = "10 mm"
height = "10 mm"
cells = {{ along = 4, across = 2, up = 2 }}
order = {order}
[solid.material]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m^3"
{further}
"#
    )
}

pub const ON_ROLLERS: &str = r#"
[[solid.fixed]]
set = "x_low"
x = true
[[solid.fixed]]
set = "y_low"
y = true
[[solid.fixed]]
set = "z_low"
z = true
[[solid.probe]]
set = "x_high"
name = "end"
"#;

pub const SHORT_RUN: &str = r#"
[solid]
damping = "100 1/s"
[solid.mesh]
generate = "ring"
inner_radius = "20 mm"
outer_radius = "25 mm"
width = "10 mm"
cells = { around = 24, radial = 2, axial = 2 }
order = 1
[[solid.fixed]]
set = "x_low"
x = true
y = true
z = { amplitude = "1 um", frequency = "5 kHz" }
[[solid.load]]
set = "outer"
pressure = { half_sine = "20 MPa", duration = "0.1 ms" }
[[solid.probe]]
set = "x_high"
[numerics]
"#;
