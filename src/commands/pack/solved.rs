//! Results of a command of this program on a scene, in memory.

use super::Fallible;
use super::neighbours::has_beams;
use crate::commands::sweep::housings::MeshFiles;
use bearing_dynamics::output::json;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The command whose results are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    Statics,
    Run,
    Modes,
    Sweep,
}

impl Kind {
    pub fn name(self) -> &'static str {
        match self {
            Kind::Statics => "statics",
            Kind::Run => "run",
            Kind::Modes => "modes",
            Kind::Sweep => "sweep",
        }
    }
}

/// Tables that are packed. Spectra and shapes of modes are not: they have no sign or phase of their own.
pub const TABLES: [&str; 4] = ["series.csv", "campbell.csv", "harmonic.csv", "sweep.csv"];

/// Summary and tables of a results folder.
pub struct Solved {
    pub summary: Value,
    pub folder: tempfile::TempDir,
}

impl Solved {
    /// Solves the scene, with changes of its keys, in a process of its own.
    pub fn of(kind: Kind, scene: &Path, changes: &[String]) -> Fallible<Solved> {
        let folder = tempfile::tempdir()?;
        let out = folder.path().join("results");
        let scene_text = scene.to_string_lossy();
        let solve = [kind.name(), &scene_text, "--out", &out.to_string_lossy()];
        let summary = match kind {
            Kind::Sweep => {
                let checked = bearing(&["check", &scene_text, "--json"], changes)?;
                let scene = serde_json::from_slice::<Value>(&checked)?["scene"].take();
                bearing(&solve, changes)?;
                // Only a sweep of runs has one.
                let summary = out.join("summary.json");
                let mut summary = match summary.exists() {
                    true => json::read(&summary)?,
                    false => json!({}),
                };
                summary["scene"] = scene;
                summary
            }
            _ => {
                bearing(&solve, changes)?;
                let mut summary = json::read(&out.join("summary.json"))?;
                if kind == Kind::Modes && has_beams(&summary["scene"]) {
                    keep_low_modes(&mut summary);
                }
                summary
            }
        };
        Ok(Solved { summary, folder })
    }

    /// The same for a scene as JSON, with the files that it refers to.
    pub fn again(kind: Kind, scene: &Value, files: &[(String, Vec<u8>)]) -> Fallible<Solved> {
        let copy = tempfile::tempdir()?;
        for (name, content) in files {
            let path = copy.path().join(name);
            path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
            std::fs::write(path, content)?;
        }
        let path = copy.path().join("scene.json");
        std::fs::write(&path, scene.to_string())?;
        Solved::of(kind, &path, &[])
    }

    /// Returns whether the results are those of runs.
    pub fn is_of_runs(&self, kind: Kind) -> bool {
        kind == Kind::Run || self.summary["kind"] == "sweep of runs"
    }

    pub fn results(&self) -> PathBuf {
        self.folder.path().join("results")
    }

    /// Tables of this kind of result: names and contents.
    pub fn tables(&self, kind: Kind) -> Fallible<Vec<(String, Vec<u8>)>> {
        let mut tables = Vec::new();
        for name in TABLES {
            let path = self.results().join(name);
            // Those of modes are their shapes.
            let packed = path.exists() && !(kind == Kind::Modes && name == "series.csv");
            if packed {
                tables.push((name.to_string(), std::fs::read(path)?));
            }
        }
        Ok(tables)
    }
}

/// Mesh of the solid, `mesh.msh`, or of the housings, `mesh.NAME.msh` if their bearings have names: as it is solved, with all
/// sets, in m, in the coordinates of the scene.
pub fn meshes(scene: &Path, changes: &[String], files: &MeshFiles) -> Fallible<MeshFiles> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("mesh.msh");
    bearing(&["check", &scene.to_string_lossy(), "--mesh", &path.to_string_lossy()], changes)?;
    let mut meshes = MeshFiles::new();
    for entry in std::fs::read_dir(folder.path())? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if files.iter().any(|(taken, _)| *taken == name) {
            return Err(format!(
                "{name} is the name that a pack gives to the mesh as solved; rename the file"
            )
            .into());
        }
        meshes.push((name, std::fs::read(entry.path())?));
    }
    meshes.sort();
    Ok(meshes)
}

/// Share of the highest frequency of a shaft up to which its modes are packed: those above have errors of the component
/// modes, and of the elements of usual programs, which grow with the square of the frequency.
const LOW: f64 = 0.05;

/// Removes the high ones of the modes of a shaft, without rotation and with it.
fn keep_low_modes(summary: &mut Value) {
    let frequency = |mode: &Value| mode["frequency"]["value"].as_f64().unwrap_or(0.0);
    let modes = summary["modes"].as_array().into_iter().flatten();
    let highest = modes.map(frequency).fold(0.0, f64::max);
    for list in ["/modes", "/rotor/whirl"] {
        if let Some(modes) = summary.pointer_mut(list).and_then(Value::as_array_mut) {
            modes.retain(|mode| frequency(mode) <= LOW * highest);
        }
    }
}

/// Output of this program.
fn bearing(arguments: &[&str], changes: &[String]) -> Fallible<Vec<u8>> {
    let changes = changes.iter().flat_map(|change| ["--set", change]);
    let all = arguments.iter().copied().chain(changes);
    let done = Command::new(std::env::current_exe()?).args(all).output()?;
    if !done.status.success() {
        let said = String::from_utf8_lossy(&done.stderr);
        return Err(said.trim().trim_start_matches("bearing: ").to_string().into());
    }
    Ok(done.stdout)
}
