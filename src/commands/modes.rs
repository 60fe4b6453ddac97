//! `bearing modes SCENE`.

use super::asked::Asked;
use super::{CommandResult, assembly, solid};
use bearing_dynamics::scene::{Document, Subject, resolve_subject};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json)
    scene: PathBuf,
    /// Results folder [default: results/<name of the scene>-modes]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print the frequencies only; write no folder
    #[arg(long, conflicts_with = "out")]
    dry: bool,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let Arguments { scene: path, out, dry } = arguments;
    let document = Document::read_file(path)?;
    let asked = Asked { path, document: &document, out, dry: *dry };
    match resolve_subject(&document)? {
        Subject::Solid(solid) => solid::modes::run(&asked, &solid),
        Subject::Assembly(scene) => assembly::modes::run(&asked, &scene),
    }
}
