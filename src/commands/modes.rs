//! `bearing modes SCENE`.

use super::asked::Asked;
use super::{Changes, CommandResult, assembly, solid};
use bearing_dynamics::scene::{Subject, resolve_subject};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json)
    scene: PathBuf,
    #[command(flatten)]
    changes: Changes,
    /// Results folder [default: results/<name of the scene>-modes]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print the frequencies only; write no folder
    #[arg(long, conflicts_with = "out")]
    dry: bool,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let Arguments { scene: path, changes, out, dry } = arguments;
    let document = changes.read(path)?;
    let asked = Asked { path, document: &document, out, dry: *dry };
    match resolve_subject(&document)? {
        Subject::Solid(solid) => solid::modes::run(&asked, &solid),
        Subject::Assembly(scene) => assembly::modes::run(&asked, &scene),
    }
}
