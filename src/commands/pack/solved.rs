//! Results of a command of this program on a scene, in memory.

use super::Fallible;
use bearing_dynamics::output::json;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The command whose results are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    Statics,
    Run,
    Modes,
}

impl Kind {
    pub fn name(self) -> &'static str {
        match self {
            Kind::Statics => "statics",
            Kind::Run => "run",
            Kind::Modes => "modes",
        }
    }
}

/// Tables that are packed. Spectra and shapes of modes are not: they have no sign or phase of their own.
pub const TABLES: [&str; 3] = ["series.csv", "campbell.csv", "harmonic.csv"];

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
        let mut command = Command::new(std::env::current_exe()?);
        command.arg(kind.name()).arg(scene).arg("--out").arg(&out);
        changes.iter().for_each(|change| {
            command.arg("--set").arg(change);
        });
        let done = command.output()?;
        if !done.status.success() {
            let said = String::from_utf8_lossy(&done.stderr);
            return Err(said.trim().trim_start_matches("bearing: ").to_string().into());
        }
        let summary = json::read(&out.join("summary.json"))?;
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
