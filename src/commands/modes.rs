//! `bearing modes SCENE`.

use super::CommandResult;
use bearing_dynamics::scene::{Document, Subject, resolve_subject};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json) with a [solid] table
    scene: PathBuf,
    /// Results folder [default: results/<name of the scene>-modes]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print the frequencies only; write no folder
    #[arg(long, conflicts_with = "out")]
    dry: bool,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let Arguments { scene, out, dry } = arguments;
    let document = Document::read_file(scene)?;
    let subject = resolve_subject(&document)?;
    match subject {
        Subject::Solid(solid) => super::solid::modes::run(scene, &document, &solid, out, *dry),
        Subject::Assembly(of) if of.housing_method().is_some() => Err(format!(
            "{}: modes takes a solid by itself, and the scene holds a bearing in a housing; write the \
             [solid] tables alone into a scene of their own for the housing's modes, or look at \
             `bearing plan` for the lowest frequency of bearing and housing",
            scene.display()
        )
        .into()),
        Subject::Assembly(_) => Err(format!(
            "{}: modes takes a solid by itself, and the scene holds a bearing; `bearing statics` \
             gives a bearing's stiffness",
            scene.display()
        )
        .into()),
    }
}
