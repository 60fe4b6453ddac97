//! `bearing plan SCENE`.

use super::solve::plan_lines;
use super::{CommandResult, Outcome, say};
use bearing_dynamics::scene::{self, statics::static_problem};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json)
    scene: PathBuf,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let scene = scene::read_file(&arguments.scene)?;
    let problem = static_problem(&scene)?;
    say(&plan_lines(&problem).iter().map(|line| format!("{line}\n")).collect::<String>())?;
    Ok(Outcome::Done)
}
