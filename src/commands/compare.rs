//! `bearing compare REFERENCE CANDIDATE`.

use super::{CommandResult, Outcome, print};
use bearing_dynamics::output::compare::tolerance::{RequestedTolerance, ToleranceClass};
use bearing_dynamics::output::compare::{Options, compare, report, to_json};
use bearing_dynamics::output::pack::{MANIFEST, PackError, RESOLVED, verify_pack};
use bearing_dynamics::output::results::pretty;
use std::error::Error;
use std::path::{Path, PathBuf};

const TOLERANCES: &str = "tolerances.json";

#[derive(clap::Args)]
pub struct Arguments {
    /// Results folder, case pack, .csv, .npy or summary.json to compare with
    reference: PathBuf,
    /// The same kind of file or folder, from the program under test
    candidate: PathBuf,
    /// Tolerance class of channels that tolerances.json does not name:
    /// f64-exact, f64-reordered, integrated or mixed
    #[arg(long, value_parser = class)]
    class: Option<ToleranceClass>,
    /// For runs of different accuracy, instead of a class: relative tolerance, as a part of each
    /// channel's largest value (components of one vector share theirs); time steps are not compared
    #[arg(long, value_name = "PART", value_parser = part, allow_negative_numbers = true, conflicts_with = "class")]
    rtol: Option<f64>,
    /// Absolute tolerance of channels with this unit, added to --rtol; repeat for more units
    #[arg(long, value_name = "UNIT=VALUE", value_parser = floor, conflicts_with = "class")]
    atol: Vec<(String, f64)>,
    /// Print the comparison as JSON
    #[arg(long)]
    json: bool,
}

fn class(name: &str) -> Result<ToleranceClass, String> {
    ToleranceClass::from_name(name)
        .ok_or_else(|| format!("unknown class; allowed are {}", names().join(", ")))
}

fn part(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(part) if part >= 0.0 && part.is_finite() => Ok(part),
        _ => Err("a part of the largest value, zero or more, such as 1e-3".into()),
    }
}

/// `m=1e-9`
fn floor(text: &str) -> Result<(String, f64), String> {
    let wrong = || format!("{text:?} is not UNIT=VALUE, as in m=1e-9");
    let (unit, value) = text.split_once('=').ok_or_else(wrong)?;
    Ok((unit.trim().to_string(), value.trim().parse().map_err(|_| wrong())?))
}

fn names() -> Vec<&'static str> {
    ToleranceClass::ALL.iter().map(|class| class.name()).collect()
}

/// Returns an error for a case pack that was changed after it was written. Its tolerances may be edited.
fn refuse_corrupt_pack(reference: &Path) -> Result<(), Box<dyn Error>> {
    if !reference.join(MANIFEST).exists() {
        if !reference.join(RESOLVED).exists() {
            return Ok(());
        }
        return Err(format!(
            "{} has the {RESOLVED} of a case pack but no {MANIFEST}, so its numbers cannot be verified; \
             get the whole pack, write it again with `bearing pack`, or name its summary.json or series.csv",
            reference.display()
        )
        .into());
    }
    match verify_pack(reference) {
        // Files are checked in the order of their names, and this one is the last.
        Err(PackError::Hash { name, .. }) if name == TOLERANCES => Ok(()),
        Err(error) => Err(format!("{}: {error}", reference.display()).into()),
        Ok(_) => Ok(()),
    }
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let given =
        (arguments.rtol.is_some() || !arguments.atol.is_empty()).then(|| RequestedTolerance {
            scale_relative: arguments.rtol.unwrap_or(0.0),
            floors: arguments.atol.clone(),
        });
    let options = Options { default_class: arguments.class, tolerances: None, given };
    refuse_corrupt_pack(&arguments.reference)?;
    let comparison = compare(&arguments.reference, &arguments.candidate, &options)?;
    print(&if arguments.json { pretty(&to_json(&comparison)) } else { report(&comparison) })?;
    Ok(if comparison.equal { Outcome::Done } else { Outcome::Different })
}
