//! The `bearing` command.
//!
//! Exit codes: 0 success, 1 compared results differ, 2 failure (one message on stderr).
#![forbid(unsafe_code)]

mod commands;

use bearing_dynamics::output::visible::visible_line;
use clap::{Parser, Subcommand};
use commands::{
    Outcome, check, compare, conform, memory, modes, pack, plan, run, schema, statics, sweep,
};
use std::process::ExitCode;

/// Simulate rolling bearings on flexible supports, described in a text file
#[derive(Parser)]
#[command(name = "bearing", version, after_help = "Scenes are described in docs/scene.md.")]
struct Arguments {
    /// Total memory that the program may use, GB [default: available memory]
    #[arg(long, global = true, value_name = "GB", value_parser = memory::parse_gigabytes, allow_negative_numbers = true)]
    memory: Option<f64>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Check a scene and print how it is interpreted, without solving
    Check(check::Arguments),
    /// List what a solution of the scene computes, what it omits, and why
    Plan(plan::Arguments),
    /// Simulate a bearing or a solid over time and write a results folder
    Run(run::Arguments),
    /// Compute the equilibrium of a bearing (ball loads, stiffness) or a solid (displacements, stresses)
    Statics(statics::Arguments),
    /// Compute natural frequencies and modes of a solid, or of bearings and their supports
    Modes(modes::Arguments),
    /// Solve a scene for many values of some keys, on all cores; repeat the command to resume
    Sweep(sweep::Arguments),
    /// Write a case pack for other programs: scene, expected results, tolerances, hashes
    Pack(pack::Arguments),
    /// Compare two results folders or files and report the first difference
    Compare(compare::Arguments),
    /// Run a program on a set of case packs and compare its results
    Conform(conform::Arguments),
    /// Print the JSON Schema of scenes, or their reference manual
    Schema(schema::Arguments),
}

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Clap also returns help and version as errors; they exit with 0.
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
        Command::Conform(arguments) => conform::run(&arguments),
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
