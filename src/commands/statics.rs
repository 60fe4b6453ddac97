//! `bearing statics SCENE`.

use super::asked::Asked;
use super::{Changes, CommandResult, assembly, solid};
use bearing_dynamics::scene::{Subject, resolve_subject};
use std::path::PathBuf;
use std::time::Instant;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json)
    scene: PathBuf,
    #[command(flatten)]
    changes: Changes,
    /// Results folder [default: results/<name of the scene>-statics]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print the results only; write no folder
    #[arg(long, conflicts_with = "out")]
    dry: bool,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let start = Instant::now();
    let Arguments { scene: path, changes, out, dry } = arguments;
    let document = changes.read(path)?;
    let asked = Asked { path, document: &document, out, dry: *dry };
    match resolve_subject(&document)? {
        Subject::Solid(solid) => solid::statics::run(&asked, &solid),
        Subject::Assembly(scene) => {
            let read = start.elapsed().as_secs_f64();
            assembly::statics::run(&asked, &scene, read)
        }
    }
}
