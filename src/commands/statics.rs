//! `bearing statics SCENE`.

use super::earlier::{Writes, claimed, remove_earlier};
use super::solve::solve_scene;
use super::{CommandResult, Outcome, pictures, results_folder, say, table};
use bearing_dynamics::output::results::write_static_results;
use bearing_dynamics::scene::{Document, Subject, resolve_subject};
use std::path::PathBuf;
use std::time::Instant;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json)
    scene: PathBuf,
    /// Results folder [default: results/<name of the scene>]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print the results only; write no folder
    #[arg(long, conflicts_with = "out")]
    dry: bool,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let start = Instant::now();
    let document = Document::read_file(&arguments.scene)?;
    let scene = match resolve_subject(&document)? {
        Subject::Solid(solid) => {
            let Arguments { scene, out, dry } = arguments;
            return super::solid::statics::run(scene, &document, &solid, out, *dry);
        }
        Subject::Housed(housed) => {
            let Arguments { scene, out, dry } = arguments;
            return super::housed::statics::run(scene, &document, &housed, out, *dry);
        }
        Subject::Assembly(assembly) => {
            let Arguments { scene, out, dry } = arguments;
            return super::assembly::statics::run(scene, &document, &assembly, out, *dry);
        }
        Subject::Bearing(scene) => *scene,
    };
    let folder = match arguments.dry {
        true => None,
        false => Some(claimed(&results_folder(&arguments.scene, &arguments.out), Writes::Statics)?),
    };
    let solved = solve_scene(&scene, start.elapsed().as_secs_f64())?;
    // Nothing computed is lost if a file cannot be written.
    say(&table::render(&solved.solution, &solved.remarks))?;
    let Some(folder) = folder else { return Ok(Outcome::Done) };
    let mut record = solved.record;
    remove_earlier(&folder)?;
    let start = Instant::now();
    let mut written = pictures::write(&folder, &scene, &solved.problem, &solved.solution)?;
    record.seconds.push(("plots".into(), start.elapsed().as_secs_f64()));
    written.extend(write_static_results(&folder, &solved.solution, &record)?);
    say(&format!("wrote {} files to {}\n", written.len(), folder.display()))?;
    Ok(Outcome::Done)
}
