//! `bearing schema`.

use super::{CommandResult, Outcome, print};
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::scene::json_schema;
use bearing_dynamics::scene::tables::manual::reference_markdown;

#[derive(clap::Args)]
pub struct Arguments {
    /// Print the manual of scenes (docs/scene.md), every key with its range and default
    #[arg(long)]
    manual: bool,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let text = if arguments.manual { reference_markdown() } else { pretty(&json_schema()) };
    print(&text)?;
    Ok(Outcome::Done)
}
