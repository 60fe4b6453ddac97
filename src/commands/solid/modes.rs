//! `bearing modes`: natural frequencies and mode shapes of a solid.

use super::{plan, prepare, print_mesh_notes, record};
use crate::commands::asked::Asked;
use crate::commands::earlier::{Writes, remove_earlier};
use crate::commands::memory::within;
use crate::commands::rubber::plan::NO_MODES;
use crate::commands::{CommandResult, Outcome, print};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::fields::{file_name, write_list, write_mode};
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::summary::solid as summary;
use bearing_dynamics::output::warnings::{lines, solid::of_modes};
use bearing_dynamics::scene::SolidScene;
use bearing_dynamics::scene::resolve::solid_scene::Law;
use bearing_dynamics::solids::memory;
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::modes::{ModeOptions, modes_over};
use bearing_dynamics::solids::tangent::Unknowns;
use serde_json::json;
use std::fmt::Write;
use std::time::Instant;

pub fn run(asked: &Asked, scene: &SolidScene) -> CommandResult {
    if let Law::Elastomer(_) = &scene.law {
        return Err(format!(
            "{}: {NO_MODES}; with [solid.harmonic] `bearing statics` computes its response to vibrations",
            asked.path.display()
        )
        .into());
    }
    let folder = asked.folder(Writes::Modes)?;
    let prepared = prepare(asked.document, scene)?;
    let (built, setup) = (&prepared.built, &prepared.setup);
    let start = Instant::now();
    let model = SolidModel::labelled(setup.problem.clone(), setup.labels.clone())?;
    let options = ModeOptions { mass: scene.mode_mass, ..ModeOptions::new(scene.mode_count) };
    let unknowns = Unknowns::new(&model);
    let needed = memory::modes(&unknowns, scene.mode_count);
    let found = within(&needed, "", || modes_over(&model, &unknowns, &options))??;
    let seconds = vec![
        ("mesh".into(), prepared.mesh_seconds),
        ("solve".into(), start.elapsed().as_secs_f64()),
    ];
    let mut record =
        record(asked.document, scene, plan::items(scene, &prepared, plan::Of::Modes), seconds);
    record.ran.solids = vec![found.ran];
    let (mut summary, series) = summary::modes(&model, built, &found, &record)?;
    let warnings = of_modes(&model, &found);
    summary["warnings"] = json!(warnings);
    print_mesh_notes(built)?;
    let mut text = "mode        frequency, Hz\n".to_string();
    for (index, mode) in found.modes.iter().enumerate() {
        // Rigid-body modes come first.
        let rigid = if index < prepared.free.count {
            "  rigid-body mode, zero except for rounding"
        } else {
            ""
        };
        let _ = writeln!(text, "{:>4} {:>20.6}{rigid}", index + 1, mode.frequency);
    }
    print(&text)?;
    print(&lines(&warnings))?;
    let Some(folder) = folder else { return Ok(Outcome::Done) };
    remove_earlier(&folder)?;
    let mut steps = Vec::new();
    for (index, mode) in found.modes.iter().enumerate() {
        let file = file_name("mode", index + 1);
        write_mode(&folder.join(&file), &built.mesh, &mode.shape)?;
        steps.push((mode.frequency, file));
    }
    write_list(&folder, &steps)?;
    series.write_csv(&folder.join("series.csv"))?;
    series.write_npy(&folder.join("series.npy"))?;
    write_atomic(&folder.join("summary.json"), pretty(&summary).as_bytes())?;
    print(&format!("wrote {} files to {}\n", steps.len() + 5, folder.display()))?;
    Ok(Outcome::Done)
}
