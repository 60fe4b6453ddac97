//! `bearing statics` of a solid.

use super::{Prepared, plan, prepare, print_mesh_notes, record};
use crate::commands::asked::Asked;
use crate::commands::earlier::{Writes, remove_earlier};
use crate::commands::memory::within;
use crate::commands::{CommandResult, Outcome, print, rubber};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::mesh::TetMesh;
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::fields::{Stresses, file_name, stresses, write_fields, write_list};
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::series::Series;
use bearing_dynamics::output::summary::solid as summary;
use bearing_dynamics::output::warnings::{lines, solid::of_equilibrium};
use bearing_dynamics::scene::SolidScene;
use bearing_dynamics::scene::resolve::solid_scene::Law;
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium_over};
use bearing_dynamics::solids::memory;
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::tangent::Unknowns;
use serde_json::{Value, json};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Alternative without matrix factors.
const INSTEAD: &str = ", explicit steps with damping until the body rests (`bearing run`)";

pub fn run(asked: &Asked, scene: &SolidScene) -> CommandResult {
    if let Law::Elastomer(rubber) = &scene.law {
        return rubber::statics::run(asked, scene, rubber);
    }
    let folder = asked.folder(Writes::Statics)?;
    let prepared = prepare(asked.document, scene)?;
    let Prepared { built, setup, free, mesh_seconds } = &prepared;
    if free.count > 0 {
        return Err(format!(
            "{}: the body is free to move {}, and statics needs supports; add [[solid.fixed]], or \
             use `bearing run`",
            asked.path.display(),
            free.names()
        )
        .into());
    }
    let start = Instant::now();
    let model = SolidModel::labelled(setup.problem.clone(), setup.labels.clone())?;
    let unknowns = Unknowns::new(&model);
    let options = EquilibriumOptions::default();
    let needed = memory::statics(&unknowns);
    let solution = within(&needed, INSTEAD, || equilibrium_over(&model, unknowns, 0.0, &options))??;
    let solve_seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let stress = stresses(&model, &solution.displacement);
    let stress_seconds = start.elapsed().as_secs_f64();
    let seconds = vec![
        ("mesh".into(), *mesh_seconds),
        ("solve".into(), solve_seconds),
        ("stresses".into(), stress_seconds),
    ];
    let mut record =
        record(asked.document, scene, plan::items(scene, &prepared, plan::Of::Statics), seconds);
    record.ran.solids = vec![solution.ran];
    let (mut summary, series) =
        summary::statics(&model, setup, built, &solution, &stress, &record)?;
    let warnings = of_equilibrium(&model, &solution.displacement, &stress);
    summary["warnings"] = json!(warnings);
    print_mesh_notes(built)?;
    print(&table(&summary))?;
    print(&lines(&warnings))?;
    let Some(folder) = folder else { return Ok(Outcome::Done) };
    write(&folder, &built.mesh, &solution.displacement, &stress, &series)?;
    write_atomic(&folder.join("summary.json"), pretty(&summary).as_bytes())?;
    print(&format!("wrote {} files to {}\n", WRITTEN + 1, folder.display()))?;
    Ok(Outcome::Done)
}

/// Number of files of [`write`].
pub const WRITTEN: usize = 5;

/// Writes fields and tables of an equilibrium over earlier ones. The summary is written last, because it marks a
/// folder as complete.
pub fn write(
    folder: &Path,
    mesh: &TetMesh,
    displacement: &[Vec3],
    stress: &Stresses,
    series: &Series,
) -> Result<(), Box<dyn Error>> {
    remove_earlier(folder)?;
    let file = file_name("fields", 0);
    write_fields(&folder.join(&file), mesh, displacement, None, stress, None)?;
    write_list(folder, &[(0.0, file)])?;
    series.write_csv(&folder.join("series.csv"))?;
    Ok(series.write_npy(&folder.join("series.npy"))?)
}

/// Printed table of loads, reactions and largest values.
pub fn table(summary: &Value) -> String {
    let number = |at: &Value| at["value"].as_f64().unwrap_or(f64::NAN);
    let axes = |at: &Value, scale: f64| {
        let part = |axis: &str| match at[axis]["value"].as_f64() {
            Some(value) => format!("{:>16.6}", scale * value),
            None => format!("{:>16}", "-"),
        };
        ["x", "y", "z"].map(part).concat()
    };
    let mut text = format!("{:<28}{:>16}{:>16}{:>16}\n", "", "x", "y", "z");
    let mut line = |name: &str, values: String| {
        let _ = writeln!(text, "{name:<28}{values}");
    };
    line("loads, N", axes(&summary["loads"], 1.0));
    line("reactions, N", axes(&summary["reactions"], 1.0));
    for (part, unit, scale) in [("supports", "N", 1.0), ("probes", "um", 1e6)] {
        for (name, entry) in summary[part].as_object().into_iter().flatten() {
            line(&format!("  {name}, {unit}"), axes(entry, scale));
        }
    }
    let largest = &summary["largest"];
    let value = |of: &str| number(&largest[of]);
    let _ = writeln!(
        text,
        "largest displacement {:.6} um; von Mises stress up to {:.4} MPa in elements, {:.4} MPa \
         at nodes",
        1e6 * value("displacement"),
        1e-6 * value("von_mises_of_elements"),
        1e-6 * value("von_mises_of_nodes")
    );
    text
}
