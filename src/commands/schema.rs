//! `bearing schema`.

use super::{CommandResult, Outcome, say};
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::scene::json_schema;

pub fn run() -> CommandResult {
    say(&pretty(&json_schema()))?;
    Ok(Outcome::Done)
}
