//! The `bearing` command: arguments in, exit code out.
//!
//! Exit codes: 0 done, 1 compared and different, 2 could not (one clear message on stderr).
#![forbid(unsafe_code)]

mod commands;

use bearing_dynamics::output::visible::visible_line;
use clap::{Parser, Subcommand};
use commands::{Outcome, check, compare, memory, modes, pack, plan, run, schema, statics, sweep};
use std::process::ExitCode;

/// Rolling bearings on flexible supports: describe one in a text file, solve it, trust it.
#[derive(Parser)]
#[command(name = "bearing", version, after_help = "Scenes are described in docs/scene.md.")]
struct Arguments {
    /// Memory that the program may take in all, GB [default: what the machine has left]
    #[arg(long, global = true, value_name = "GB", value_parser = memory::parse_gigabytes, allow_negative_numbers = true)]
    memory: Option<f64>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Read a scene and print what was understood; solve nothing
    Check(check::Arguments),
    /// List what a solution of the scene computes, what it leaves out, and why
    Plan(plan::Arguments),
    /// A bearing or a solid in motion: step through time and write a results folder
    Run(run::Arguments),
    /// Equilibrium of a bearing (ball loads, stiffness) or of a solid (displacements, stresses)
    Statics(statics::Arguments),
    /// Natural frequencies: of a solid with its mode shapes, of bearings and what they sit on
    Modes(modes::Arguments),
    /// Solve a scene for many values of some keys, on all cores; the same command resumes it
    Sweep(sweep::Arguments),
    /// Write a case pack for other programs: scene, expected results, tolerances, hashes
    Pack(pack::Arguments),
    /// Compare two results folders or files and name the first difference
    Compare(compare::Arguments),
    /// Print the JSON Schema of scenes, or their manual
    Schema(schema::Arguments),
}

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are answers, everything else is a mistake; clap knows which.
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    memory::limit_to(arguments.memory);
    let outcome = match arguments.command {
        Command::Check(arguments) => check::run(&arguments),
        Command::Plan(arguments) => plan::run(&arguments),
        Command::Run(arguments) => run::run(&arguments),
        Command::Statics(arguments) => statics::run(&arguments),
        Command::Modes(arguments) => modes::run(&arguments),
        Command::Sweep(arguments) => sweep::run(&arguments),
        Command::Pack(arguments) => pack::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Schema(arguments) => schema::run(&arguments),
    };
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Different) => ExitCode::from(1),
        Err(error) => {
            eprintln!("bearing: {}", visible_line(&error.to_string()));
            ExitCode::from(2)
        }
    }
}
