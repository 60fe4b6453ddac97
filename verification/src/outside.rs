//! Programs of others that cases hold ours against, and what a run without them leaves out.

use std::process::Command;

use crate::case::Case;

/// A program that a case runs where it is installed.
#[derive(Clone, Copy, Debug)]
pub struct Outside {
    pub case: &'static str,
    /// On the path; answers to `-v`.
    pub program: &'static str,
    pub install: &'static str,
    /// What the case lacks without it.
    pub leaves_out: &'static str,
    /// Environment variable with which its absence is an error.
    pub require: &'static str,
}

pub const OUTSIDE: [Outside; 1] = [Outside {
    case: "calculix_comparison",
    program: "ccx",
    install: "apt-get install calculix-ccx",
    leaves_out: "CalculiX was not run anew; its kept output alone was compared with",
    require: "REQUIRE_CALCULIX",
}];

/// One line for each program that one of `selected` would run and that is not there.
///
/// # Errors
/// In words, where such a program is required.
pub fn skipped(selected: &[Case]) -> Result<Vec<String>, String> {
    let mut lines = Vec::new();
    for outside in &OUTSIDE {
        let Outside { case, program, install, leaves_out, require } = outside;
        let is_wanted = selected.iter().any(|selected| selected.id == *case);
        if !is_wanted || Command::new(program).arg("-v").output().is_ok() {
            continue;
        }
        let said = format!("{case}: no {program} on the path ({install}): {leaves_out}");
        if std::env::var_os(require).is_some() {
            return Err(format!("{said}, which {require} forbids"));
        }
        lines.push(format!("SKIPPED {said}"));
    }
    Ok(lines)
}
