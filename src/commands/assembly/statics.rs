//! `bearing statics` of several bearings: one equilibrium of all bodies.

use super::{defaults, echo, name_of, plan_lines};
use crate::commands::earlier::{Writes, claimed, remove_earlier};
use crate::commands::{CommandResult, Outcome, record, remarks, results_folder, say, table};
use bearing_dynamics::output::assembly_results::{Solved, write};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::plots::{LoadZone, load_zone};
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::scene::Plot;
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::solver::static_assembly::StaticAssembly;
use bearing_dynamics::solver::statics::{AssemblySolution, StaticOptions, solve_assembly};
use serde_json::json;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// An equilibrium and everything its results folder records.
pub struct Found<'s> {
    /// Of the bearings.
    pub names: Vec<&'s str>,
    pub assembly: StaticAssembly<'static>,
    pub solution: AssemblySolution,
    pub remarks: Vec<String>,
    pub record: RunRecord,
}

/// Finds the equilibrium of a scene that took `read` s to read.
pub fn find_equilibrium(scene: &AssemblyScene, read: f64) -> Result<Found<'_>, Box<dyn Error>> {
    let assembly = scene.statics()?;
    let start = Instant::now();
    let solution = solve_assembly(&assembly, None, &StaticOptions::default())?;
    let seconds = vec![("read".into(), read), ("solve".into(), start.elapsed().as_secs_f64())];
    let remarks = remarks::of_assembly(scene, &assembly, &solution);
    let names = scene.bearings.iter().map(name_of).collect();
    let assumptions = &scene.common().assumptions;
    let plan = plan_lines(scene)?;
    let mut record = record(echo(scene)?, plan, assumptions, &defaults(scene), seconds);
    record.sections.push(("remarks".into(), json!(remarks)));
    Ok(Found { names, assembly, solution, remarks, record })
}

/// Finds the equilibrium, says it, and writes it to a folder unless it is only to be said.
pub fn run(path: &Path, scene: &AssemblyScene, out: &Option<PathBuf>, dry: bool) -> CommandResult {
    let start = Instant::now();
    let folder = match dry {
        true => None,
        false => Some(claimed(&results_folder(path, out), Writes::Statics)?),
    };
    let found = find_equilibrium(scene, start.elapsed().as_secs_f64())?;
    let Found { names, assembly, solution, remarks, record } = &found;
    say(&table::render_assembly(assembly, names, solution, remarks))?;
    let Some(folder) = folder else { return Ok(Outcome::Done) };
    remove_earlier(&folder)?;
    let mut written = Vec::new();
    if scene.common().plots.contains(&Plot::LoadZone) {
        let title = scene.common().title.clone().unwrap_or_else(|| "Bearings".into());
        for ((placed, name), state) in scene.bearings.iter().zip(names).zip(&solution.bearings) {
            let path = folder.join(format!("load_zone_{name}.svg"));
            let (heading, geometry) = (format!("{title}: {name}"), &placed.scene.geometry);
            let zone = LoadZone::new(heading, geometry, &state.balls);
            write_atomic(&path, load_zone(&zone)?.as_bytes())?;
            written.push(path);
        }
    }
    written.extend(write(&folder, &Solved { assembly, names, solution }, record)?);
    say(&format!("wrote {} files to {}\n", written.len(), folder.display()))?;
    Ok(Outcome::Done)
}
