//! `bearing statics SCENE`.

use super::solve::solve_scene;
use super::{CommandResult, Outcome, pictures, results_folder, say, table};
use bearing_dynamics::output::results::write_static_results;
use bearing_dynamics::scene;
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
    let scene = scene::read_file(&arguments.scene)?;
    let solved = solve_scene(&scene, start.elapsed().as_secs_f64())?;
    say(&table::render(&solved.solution))?;
    if arguments.dry {
        return Ok(Outcome::Done);
    }
    let folder = results_folder(&arguments.scene, &arguments.out);
    let mut record = solved.record;
    let start = Instant::now();
    let mut written = pictures::write(&folder, &scene, &solved.problem, &solved.solution)?;
    record.seconds.push(("plots".into(), start.elapsed().as_secs_f64()));
    written.extend(write_static_results(&folder, &solved.solution, &record)?);
    say(&format!("wrote {} files to {}\n", written.len(), folder.display()))?;
    Ok(Outcome::Done)
}
