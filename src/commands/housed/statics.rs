//! `bearing statics` of a bearing in its housing: one equilibrium at t = 0.

use super::super::remarks as bearing_remarks;
use super::{
    Prepared, condensed, equilibrium_at, estimate_at, plan, prepare, record, say_notes, search,
    write_bore,
};
use crate::commands::earlier::{Writes, claimed, remove_earlier};
use crate::commands::solid::say_remarks;
use crate::commands::{CommandResult, Outcome, pictures, results_folder, say, table};
use bearing_dynamics::output::course::outer_place;
use bearing_dynamics::output::fields::bore::condensed_nodes;
use bearing_dynamics::output::fields::{file_name, stresses, write_fields, write_list};
use bearing_dynamics::output::recorder::seat::SeatRow;
use bearing_dynamics::output::remarks;
use bearing_dynamics::output::results::write_static_results;
use bearing_dynamics::output::summary::housing::{
    PEAK_PRESSURE, equilibrium_section, inertia_section,
};
use bearing_dynamics::output::summary::solid::field_sections;
use bearing_dynamics::scene::Document;
use bearing_dynamics::scene::Plot;
use bearing_dynamics::scene::housing::HousedScene;
use bearing_dynamics::scene::housing_problem::excitations;
use bearing_dynamics::solver::housing::bore_equilibrium::POSE_NAMES;
use bearing_dynamics::solver::housing::condensed::CondensedBore;
use bearing_dynamics::solver::housing::housed::HousedState;
use bearing_dynamics::solver::plan::tally::Ran;
use serde_json::json;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

pub fn run(
    path: &Path,
    document: &Document,
    scene: &HousedScene,
    out: &Option<PathBuf>,
    dry: bool,
) -> CommandResult {
    let folder = match dry {
        true => None,
        false => Some(claimed(&results_folder(path, out), Writes::Statics)?),
    };
    let prepared = prepare(document, scene)?;
    let Prepared { built, setup, mesh_seconds } = &prepared;
    let start = Instant::now();
    let bore = condensed(&prepared)?;
    let condense_seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let mut search = search(scene, &bore);
    let (problem, state) = equilibrium_at(scene, setup, &mut search, 0.0)?;
    let inertia = estimate_at(scene, &problem, &search, &state);
    let solve_seconds = start.elapsed().as_secs_f64();
    let displacement = bore.displacement(&state.bore.loads);
    let stress = stresses(&setup.model, &displacement);
    let largest = stress.cell_von_mises.iter().copied().fold(0.0, f64::max);

    say_notes(&prepared)?;
    let bearing_notes = bearing_remarks::of_statics(&scene.bearing, &problem, &state.bearing);
    say(&table::render(&state.bearing, &bearing_notes))?;
    say(&housing_table(&bore, &state, largest))?;
    let remarks = remarks::of_equilibrium(&setup.model, &displacement, &stress);
    say_remarks(&remarks)?;
    if let Some(estimate) = &inertia {
        say(&format!("note: {}\n", plan::verdict(scene, estimate, None)))?;
    }
    let Some(folder) = folder else { return Ok(Outcome::Done) };
    remove_earlier(&folder)?;
    let seconds = vec![
        ("mesh".into(), *mesh_seconds),
        ("condense".into(), condense_seconds),
        ("solve".into(), solve_seconds),
    ];
    let mut record = record(scene, plan::items_of_statics(scene, &prepared)?, seconds)?;
    record.ran.clone_from(&state.ran);
    record.ran.absorb(&Ran { solids: vec![bore.ran], ..Ran::default() });
    record.sections = crate::commands::echo::sections(&scene.bearing, &problem)?;
    record
        .sections
        .push(("housing".into(), equilibrium_section(setup, &bore, &state, &displacement)?));
    record.sections.extend(field_sections(built, &displacement, &stress)?);
    record.sections.push(("housing_remarks".into(), json!(remarks)));
    if let Some(estimate) = &inertia {
        record
            .sections
            .push(("inertia".into(), inertia_section(estimate, &excitations(scene), None)?));
    }
    let mut drawn = scene.bearing.clone();
    // The other plots move the bearing on, which would move the outer race.
    drawn.plots.retain(|plot| *plot == Plot::LoadZone);
    let mut written = pictures::write(&folder, &drawn, &problem, &state.bearing)?;
    let nodes = condensed_nodes(&setup.model, &bore, &state.bore);
    written.push(write_bore(&folder, &nodes)?);
    let file = file_name("fields", 0);
    let fields = folder.join(&file);
    write_fields(&fields, &built.mesh, &displacement, None, &stress, Some(&nodes))?;
    written.push(fields);
    written.push(write_list(&folder, &[(0.0, file)])?);
    written.extend(write_static_results(&folder, &state.bearing, &record)?);
    say(&format!("wrote {} files to {}\n", written.len(), folder.display()))?;
    Ok(Outcome::Done)
}

/// The outer race in its bore, as a person reads it.
fn housing_table(bore: &CondensedBore, state: &HousedState, von_mises: f64) -> String {
    let mut text = "\nouter race      displacement, tilt      of the housing\n".to_string();
    let seat = SeatRow::of_equilibrium(bore, &state.bore);
    let place = outer_place(bore, state);
    let loads = [seat.force[1], seat.force[2], seat.moment[1], seat.moment[2]];
    for (i, name) in POSE_NAMES.iter().enumerate() {
        let (value, unit, load_unit) = if i < 2 {
            (1e6 * place[1 + i], "um ", "N")
        } else {
            (place[1 + i].to_degrees(), "deg", "N m")
        };
        let _ = writeln!(text, "  {name:<10} {value:>16.6} {unit} {:>18.6} {load_unit}", loads[i]);
    }
    let stiffness = |i: usize| 1e-6 * state.bore.stiffness[(i, i)];
    let _ = writeln!(
        text,
        "housing stiffness {:.4} N/um along y, {:.4} N/um along z\n\
         {} of {} bore nodes touch, penetration up to {:.6} um, pressure up to {:.4} MPa, von Mises \
         stress up to {:.4} MPa\n\
         this pressure is {PEAK_PRESSURE}\n\
         {} iterations, {} changes of contact, unbalanced part of the load {:.1e}",
        stiffness(0),
        stiffness(1),
        seat.touching,
        bore.sizes.kept,
        1e6 * seat.deepest,
        1e-6 * seat.peak_pressure,
        1e-6 * von_mises,
        state.iterations,
        state.contact_changes,
        state.residual
    );
    text
}
