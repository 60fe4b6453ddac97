//! `bearing statics` of several bearings: one equilibrium of all bodies.

use super::{defaults, echo, name_of, plan_lines};
use crate::commands::earlier::{Writes, claimed, remove_earlier};
use crate::commands::{CommandResult, Outcome, record, remarks, results_folder, say, table};
use bearing_dynamics::output::assembly_results::{Solved, write};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::plots::{LoadZone, load_zone};
use bearing_dynamics::scene::Plot;
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::solver::statics::{StaticOptions, solve_assembly};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Finds the equilibrium, says it, and writes it to a folder unless it is only to be said.
pub fn run(path: &Path, scene: &AssemblyScene, out: &Option<PathBuf>, dry: bool) -> CommandResult {
    let start = Instant::now();
    let folder = match dry {
        true => None,
        false => Some(claimed(&results_folder(path, out), Writes::Statics)?),
    };
    let assembly = scene.statics()?;
    let read = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let solution = solve_assembly(&assembly, None, &StaticOptions::default())?;
    let seconds = vec![("read".into(), read), ("solve".into(), start.elapsed().as_secs_f64())];
    let remarks = remarks::of_assembly(scene, &assembly, &solution);
    let names: Vec<&str> = scene.bearings.iter().map(name_of).collect();
    let solved = Solved { assembly: &assembly, names: &names, solution: &solution };
    say(&table::render_assembly(&assembly, &names, &solution, &remarks))?;
    let Some(folder) = folder else { return Ok(Outcome::Done) };
    let assumptions = &scene.common().assumptions;
    let mut record = record(echo(scene)?, plan_lines(scene)?, assumptions, &defaults(scene), seconds);
    record.sections.push(("remarks".into(), json!(remarks)));
    remove_earlier(&folder)?;
    let mut written = Vec::new();
    if scene.common().plots.contains(&Plot::LoadZone) {
        let title = scene.common().title.clone().unwrap_or_else(|| "Bearings".into());
        for ((placed, name), state) in scene.bearings.iter().zip(&names).zip(&solution.bearings) {
            let path = folder.join(format!("load_zone_{name}.svg"));
            let zone = LoadZone::new(format!("{title}: {name}"), &placed.scene.geometry, &state.balls);
            write_atomic(&path, load_zone(&zone)?.as_bytes())?;
            written.push(path);
        }
    }
    written.extend(write(&folder, &solved, &record)?);
    say(&format!("wrote {} files to {}\n", written.len(), folder.display()))?;
    Ok(Outcome::Done)
}
