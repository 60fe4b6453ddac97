//! `bearing check SCENE`.

use super::check_mesh::MeshFile;
use super::{Changes, CommandResult, Outcome, assembly, echo, print, solid};
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::visible::visible_line;
use bearing_dynamics::scene::{Assumption, DefaultUsed, Document, Subject, resolve_subject};
use serde_json::Value;
use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json)
    scene: PathBuf,
    #[command(flatten)]
    changes: Changes,
    /// Print the scene with its defaults, and what follows from it, as JSON
    #[arg(long)]
    json: bool,
    /// Write the mesh of the solid, or of each housing, with its sets to a new file: Gmsh .msh, Abaqus .inp or ParaView .vtu
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let Arguments { scene: path, changes, json, mesh } = arguments;
    let mesh = mesh.as_deref().map(MeshFile::of).transpose()?;
    // JSON output has no notes.
    let document = if *json { changes.read_quietly(path)?.0 } else { changes.read(path)? };
    match resolve_subject(&document)? {
        Subject::Solid(solid) => solid::check::run(&document, &solid, *json, mesh),
        Subject::Assembly(scene) => assembly::check::run(&document, *scene, *json, mesh),
    }
}

/// Prints the scene, what follows from it, assumptions and defaults as JSON.
pub fn print_json(
    document: &Document,
    mut echo: Value,
    assumptions: &[Assumption],
    defaults: &[DefaultUsed],
) -> CommandResult {
    echo["scene"] = document.written_out(defaults);
    for (name, notes) in echo::notes(assumptions, defaults) {
        echo[name] = notes;
    }
    print(&pretty(&echo))?;
    Ok(Outcome::Done)
}

/// Prints a label and its value.
pub type Line<'a> = dyn FnMut(&str, String) + 'a;

/// Prints the resolved scene, one line each: title, bases, `lines`, defaults and assumptions.
pub fn print_lines(
    document: &Document,
    title: &Option<String>,
    lines: impl FnOnce(&mut Line),
    assumptions: &[Assumption],
    defaults: &[DefaultUsed],
) -> Result<(), Box<dyn Error>> {
    let mut text = format!("{}: a valid scene\n", visible_line(document.name()));
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "  {label:<22} {}", visible_line(&value));
    };
    if let Some(title) = title {
        line("title", title.clone());
    }
    for (name, _) in document.bases() {
        line("base", name);
    }
    lines(&mut line);
    for used in echo::reported(defaults) {
        line("default", format!("{} = {} ({})", used.key, used.value, used.reason));
    }
    for assumption in assumptions {
        line("assumption", format!("{}: {}", assumption.name, assumption.text));
    }
    print(&text)
}
