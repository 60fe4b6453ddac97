//! `bearing compare REFERENCE CANDIDATE`.

use super::{CommandResult, Outcome, say};
use bearing_dynamics::output::compare::tolerance::ToleranceClass;
use bearing_dynamics::output::compare::{Options, compare, report, to_json};
use bearing_dynamics::output::pack::{MANIFEST, PackError, verify_pack};
use bearing_dynamics::output::results::pretty;
use std::error::Error;
use std::path::{Path, PathBuf};

const TOLERANCES: &str = "tolerances.json";

#[derive(clap::Args)]
pub struct Arguments {
    /// Results folder, case pack, .csv, .npy or summary.json to compare with
    reference: PathBuf,
    /// The same kind of thing, from the program under test
    candidate: PathBuf,
    /// Tolerance class of channels that tolerances.json does not name:
    /// f64-exact, f64-reordered or mixed
    #[arg(long, value_parser = class)]
    class: Option<ToleranceClass>,
    /// Print the comparison as JSON
    #[arg(long)]
    json: bool,
}

fn class(name: &str) -> Result<ToleranceClass, String> {
    ToleranceClass::from_name(name)
        .ok_or_else(|| format!("no such class; there are {}", names().join(", ")))
}

fn names() -> Vec<&'static str> {
    ToleranceClass::ALL.iter().map(|class| class.name()).collect()
}

/// A case pack must be the one that was written. Its tolerances may be edited.
fn refuse_corrupt_pack(reference: &Path) -> Result<(), Box<dyn Error>> {
    if !reference.join(MANIFEST).exists() {
        return Ok(());
    }
    match verify_pack(reference) {
        // The manifest is checked in the order of names, in which this file is the last.
        Err(PackError::Hash { name, .. }) if name == TOLERANCES => Ok(()),
        Err(error) => Err(format!("{}: {error}", reference.display()).into()),
        Ok(_) => Ok(()),
    }
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let options = Options { default_class: arguments.class, tolerances: None };
    refuse_corrupt_pack(&arguments.reference)?;
    let comparison = compare(&arguments.reference, &arguments.candidate, &options)?;
    say(&if arguments.json { pretty(&to_json(&comparison)) } else { report(&comparison) })?;
    Ok(if comparison.equal { Outcome::Done } else { Outcome::Different })
}
