//! `bearing check SCENE`.

use super::{CommandResult, assembly, solid};
use bearing_dynamics::scene::{Document, Subject, resolve_subject};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json)
    scene: PathBuf,
    /// Print everything that was understood, in SI-based units, as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let Arguments { scene: path, json } = arguments;
    let document = Document::read_file(path)?;
    match resolve_subject(&document)? {
        Subject::Solid(solid) => solid::check::run(path, &document, &solid, *json),
        Subject::Assembly(scene) => assembly::check::run(path, &document, *scene, *json),
    }
}
