//! `bearing plan SCENE`.

use super::{Changes, CommandResult, assembly, print, solid};
use bearing_dynamics::plan::Item;
use bearing_dynamics::scene::{Subject, resolve_subject};
use std::error::Error;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json); with a [numerics] table the plan is that of a run
    scene: PathBuf,
    #[command(flatten)]
    changes: Changes,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let document = arguments.changes.read(&arguments.scene)?;
    match resolve_subject(&document)? {
        Subject::Solid(solid) => solid::plan::run(&document, &solid),
        Subject::Assembly(scene) => assembly::plan::run(&document, &scene),
    }
}

pub fn print_plan(items: &[Item], notes: &[String]) -> Result<(), Box<dyn Error>> {
    items.iter().try_for_each(|item| print(&format!("{item}\n")))?;
    notes.iter().try_for_each(|line| print(&format!("{line}\n")))
}
