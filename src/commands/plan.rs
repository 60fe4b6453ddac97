//! `bearing plan SCENE`.

use super::{CommandResult, assembly, solid};
use bearing_dynamics::scene::{Document, Subject, resolve_subject};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json); with a [numerics] table the plan is that of a run
    scene: PathBuf,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let document = Document::read_file(&arguments.scene)?;
    match resolve_subject(&document)? {
        Subject::Solid(solid) => solid::plan::run(&document, &solid),
        Subject::Assembly(scene) => assembly::plan::run(&document, &scene),
    }
}
