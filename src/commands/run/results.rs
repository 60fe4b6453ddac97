//! What a run leaves in its folder: fields on the way; tables, plots and the summary at its end.

use super::figures::key_figures;
use super::prepared::{Fields, Prepared, SolidOf};
use crate::commands::housed::{along_course, inertia_estimate, plan::verdict, write_bore};
use crate::commands::{remarks, say};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::fields::bore::{bore_nodes, bore_series};
use bearing_dynamics::output::fields::{FOLDER, file_name, stresses, write_fields, write_list};
use bearing_dynamics::output::pictures::bearing::{Picture, draw};
use bearing_dynamics::output::pictures::solid::{probe_spectra, series_plots, spectrum_plot};
use bearing_dynamics::output::remarks as of_solid;
use bearing_dynamics::output::session::{Motion, RunRequest, Session, Status};
use bearing_dynamics::output::spectrum::Spectrum;
use bearing_dynamics::output::summary::housing::{
    equilibrium_section, inertia_section, reduced_section, seat_section,
};
use bearing_dynamics::output::summary::solid::{field_sections, mass_section};
use bearing_dynamics::output::summary::{RunReport, write_run_results};
use bearing_dynamics::output::table::RunTable;
use bearing_dynamics::scene::housing_problem::excitations;
use bearing_dynamics::scene::{Plot, RunPlot, Scene};
use bearing_dynamics::solver::dynamics::foretell::Choice;
use serde_json::{Map, Value, json};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

type Fallible<T> = Result<T, Box<dyn Error>>;

/// Wall times of the stages so far, s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Seconds {
    pub read: f64,
    pub start: f64,
    pub simulate: f64,
}

/// What the summary and a person get besides what moves.
#[derive(Default)]
struct Said {
    sections: Vec<(String, Value)>,
    remarks: Vec<String>,
    /// Lines after the figures.
    lines: Vec<String>,
    files: usize,
}

/// Everything at the end; the state is there already.
pub(super) fn write_results(
    folder: &Path,
    prepared: &Prepared,
    session: &mut Session,
    (request, choice): (&RunRequest, Option<Choice>),
    stopped_by: Option<String>,
    seconds: &Seconds,
) -> Fallible<()> {
    let start = Instant::now();
    let mut said = Said::default();
    match prepared {
        Prepared::Bearings { scene, housings, .. } => {
            if let Some(simulation) = session.motion.bearing() {
                said.remarks = remarks::of_run(scene, simulation);
                said.sections.push(("remarks".into(), json!(said.remarks)));
            }
            if !housings.is_empty() {
                housings_results(folder, prepared, session, &mut said)?;
            }
        }
        Prepared::Solid { .. } => solid_results(prepared, session, &mut said)?,
        Prepared::Housed { .. } => housing_results(folder, prepared, session, &mut said)?,
    }
    let table = RunTable::new(session, prepared.window_start())?;
    let spectra = spectra(prepared, session, &table);
    let plots = pictures(folder, prepared, session, &table, &spectra)?;
    let mut stages = vec![
        ("read".into(), seconds.read),
        ("start".into(), seconds.start),
        ("simulate".into(), seconds.simulate),
        ("plots".into(), start.elapsed().as_secs_f64()),
    ];
    if let Prepared::Housed { bore: Some((_, seconds)), .. } = prepared {
        stages.push(("condense".into(), *seconds));
    }
    let of_shapes = match prepared {
        Prepared::Housed { reduced: Some(reduced), .. } => Some(reduced.seconds),
        Prepared::Bearings { reduced: Some(reduced), .. } => Some(reduced.seconds),
        _ => None,
    };
    if let Some([condense, reduce]) = of_shapes {
        stages.extend([("condense".into(), condense), ("reduce".into(), reduce)]);
    }
    let mut record = prepared.record(request, choice.as_ref(), stages)?;
    record.sections.append(&mut said.sections);
    record.ran.absorb(&session.ran());
    match &session.motion {
        Motion::Solid(moving) => record.threads = moving.threads,
        Motion::Housed(housed) => record.threads = housed.threads(),
        Motion::Bearing(_) | Motion::Course(_) => {}
    }
    let (stepping, integrator) = (request.options.stepping, request.options.integrator);
    let report = RunReport {
        record,
        stopped_by,
        stepping: Some(stepping),
        integrator: Some(integrator),
        solid_stepping: match prepared {
            Prepared::Solid { settings, .. } => Some(settings.stepping),
            Prepared::Bearings { .. } | Prepared::Housed { .. } => None,
        },
    };
    let written = write_run_results(folder, session, &table, &spectra, &report)?;
    say(&key_figures(session, &table, seconds.simulate))?;
    for remark in &said.remarks {
        say(&format!("note: {remark}\n"))?;
    }
    for line in &said.lines {
        say(&format!("{line}\n"))?;
    }
    // State beside them.
    let fields = std::fs::read_dir(folder.join(FOLDER)).map_or(0, |files| files.count() + 1);
    let files = written.len() + plots.len() + fields + said.files + 1;
    say(&format!("wrote {files} files to {}\n", folder.display()))
}

fn solid_results(prepared: &Prepared, session: &Session, said: &mut Said) -> Fallible<()> {
    let (Prepared::Solid { mesh, .. }, Motion::Solid(moving)) = (prepared, &session.motion) else {
        return Ok(());
    };
    let built = &mesh.built;
    let (model, displacement) = (&moving.solid.model, session.displacement(0));
    let stress = stresses(model, &displacement);
    said.sections.push(("mass".into(), mass_section(model, built)?));
    said.sections.extend(field_sections(built, &displacement, &stress)?);
    said.remarks = of_solid::of_run(session, model, &stress);
    said.sections.push(("remarks".into(), json!(said.remarks)));
    Ok(())
}

/// Fields of the last state and the nodes of the bores of several housings.
fn housings_results(
    folder: &Path,
    prepared: &Prepared,
    session: &mut Session,
    said: &mut Said,
) -> Fallible<()> {
    let Prepared::Bearings { housings, reduced, .. } = prepared else { return Ok(()) };
    // Of explicit steps that stopped on the way the state at the last row is not at hand.
    let is_sound = reduced.is_some() || session.status == Status::Complete;
    let mut sections = Map::new();
    let mut remarks = Vec::new();
    if is_sound && session.recorder.rows() > 0 {
        if session.clock.fields_due().is_none() {
            let row = session.recorder.rows() as u64 - 1;
            let index = session.clock.rows_per_fields.map_or(0, |every| row / every + 1);
            write_fields_file(folder, prepared, session, index)?;
        }
        for (number, housing) in housings.iter().enumerate() {
            let Some(Fields { displacement, .. }) = prepared.fields(session, number) else { break };
            let (model, name) = (&housing.mesh.setup.model, housing.name.as_deref());
            let stress = stresses(model, &displacement);
            let mut section = Map::new();
            section.insert("seat".into(), seat_section(&housing.mesh.setup)?);
            if let Some(reduced) = reduced {
                let cut = &reduced.reductions[number].cut_off;
                section.insert("shapes".into(), reduced_section(cut, &[])?);
            }
            section.extend(field_sections(&housing.mesh.built, &displacement, &stress)?);
            sections.insert(name.unwrap_or("housing").into(), Value::Object(section));
            let own = of_solid::of_motion(model, &displacement, &stress).into_iter();
            let of = name.map_or(String::new(), |name| format!("housing {name}: "));
            remarks.extend(own.map(|remark| format!("{of}{remark}")));
            let series = bore_series(&bore_nodes(&session.motion, number, model))?;
            let file = name.map_or("bore.csv".into(), |name| format!("bore_{name}.csv"));
            series.write_csv(&folder.join(file))?;
            said.files += 1;
        }
    }
    said.sections.push(("housings".into(), Value::Object(sections)));
    said.sections.push(("housing_remarks".into(), json!(remarks)));
    said.remarks.append(&mut remarks);
    Ok(())
}

/// Fields of the last state, the nodes of the bore, and what leaving out inertia costs.
fn housing_results(
    folder: &Path,
    prepared: &Prepared,
    session: &mut Session,
    said: &mut Said,
) -> Fallible<()> {
    let Prepared::Housed { scene, mesh, bore, reduced, .. } = prepared else { return Ok(()) };
    let setup = &mesh.setup;
    // Of explicit steps that stopped on the way the state at the last row is not at hand.
    let is_sound = bore.is_some() || reduced.is_some() || session.status == Status::Complete;
    if is_sound && session.recorder.rows() > 0 {
        if session.clock.fields_due().is_none() {
            let row = session.recorder.rows() as u64 - 1;
            let index = session.clock.rows_per_fields.map_or(0, |every| row / every + 1);
            write_fields_file(folder, prepared, session, index)?;
        }
        if let Some(Fields { displacement, .. }) = prepared.fields(session, 0) {
            let stress = stresses(&setup.model, &displacement);
            said.remarks = match &session.motion {
                Motion::Course(_) => of_solid::of_equilibrium(&setup.model, &displacement, &stress),
                _ => of_solid::of_motion(&setup.model, &displacement, &stress),
            };
            if let Motion::Course(course) = &session.motion
                && let Some(moment) = &course.latest
            {
                let section =
                    equilibrium_section(setup, course.bore(), &moment.state, &displacement)?;
                said.sections.push(("housing".into(), section));
            }
            said.sections.extend(field_sections(&mesh.built, &displacement, &stress)?);
            said.sections.push(("housing_remarks".into(), json!(said.remarks)));
            write_bore(folder, &bore_nodes(&session.motion, 0, &setup.model))?;
            said.files += 1;
        }
    }
    let Some((bore, _)) = bore else {
        said.sections.push(("seat".into(), seat_section(setup)?));
        if let Some(reduced) = reduced {
            let section = reduced_section(&reduced.reduction.cut_off, &excitations(scene))?;
            said.sections.push(("reduced_housing".into(), section));
        }
        return Ok(());
    };
    // A course that was found is kept, whatever becomes of the estimate.
    let inertia = inertia_estimate(scene, setup, bore);
    let along = along_course(scene, setup, bore);
    let course = along.as_ref().ok().and_then(Option::as_ref);
    if let Ok(Some(estimate)) = &inertia {
        let section = inertia_section(estimate, &excitations(scene), course)?;
        said.sections.push(("inertia".into(), section));
        said.lines.push(format!("inertia left out       {}", verdict(scene, estimate, course)));
    }
    let failed = inertia.as_ref().err().into_iter().chain(along.as_ref().err());
    said.lines.extend(failed.map(|why| format!("inertia left out       no estimate: {why}")));
    Ok(())
}

/// The fields of the present state as file number `index`, and the list of all files.
pub(super) fn write_fields_file(
    folder: &Path,
    prepared: &Prepared,
    session: &mut Session,
    index: u64,
) -> Fallible<()> {
    let solids = prepared.solids();
    for (number, solid) in solids.iter().enumerate() {
        let Some(Fields { displacement, velocity }) = prepared.fields(session, number) else {
            return Ok(());
        };
        let (bore, stress) = match (solid.model, &session.motion) {
            (Some(model), motion) => {
                (Some(bore_nodes(motion, number, model)), stresses(model, &displacement))
            }
            (None, Motion::Solid(moving)) => (None, stresses(&moving.solid.model, &displacement)),
            _ => return Ok(()),
        };
        let path = folder.join(file_name(solid.name.unwrap_or("fields"), index as usize));
        let (mesh, velocity) = (&solid.built.mesh, velocity.as_deref());
        write_fields(&path, mesh, &displacement, velocity, &stress, bore.as_deref())?;
    }
    if solids.is_empty() {
        return Ok(());
    }
    let last = session.recorder.rows().saturating_sub(1);
    let every = session.clock.rows_per_fields.map(|every| every as usize);
    let row = |index: u64| every.map_or(last, |every| (every * index as usize).min(last));
    let first = if every.is_none() { index } else { 0 };
    let mut files: Vec<(f64, String)> = Vec::new();
    for index in first..=index {
        let time = session.row_time(row(index));
        let name = |solid: &SolidOf| file_name(solid.name.unwrap_or("fields"), index as usize);
        files.extend(solids.iter().map(|solid| (time, name(solid))));
    }
    write_list(folder, &files)?;
    Ok(())
}

/// Spectra that were asked for: of races and cage over the window, of the probes of a solid.
fn spectra(prepared: &Prepared, session: &Session, table: &RunTable) -> Vec<(String, Spectrum)> {
    if !prepared.has_spectra() {
        return Vec::new();
    }
    match session.motion {
        Motion::Solid(_) => probe_spectra(table, &session.recorder.probes),
        _ => table.spectra(),
    }
}

/// Draws what the scene asks for.
fn pictures(
    folder: &Path,
    prepared: &Prepared,
    session: &Session,
    table: &RunTable,
    spectra: &[(String, Spectrum)],
) -> Fallible<Vec<PathBuf>> {
    let title = prepared.title();
    let mut drawn = Vec::new();
    if let Prepared::Solid { scene, .. } = prepared {
        if scene.draw_series {
            drawn.extend(series_plots(&title, table, &session.recorder.probes)?);
        }
        drawn.extend(spectrum_plot(&title, spectra)?);
    }
    for picture in prepared.bearing().map_or_else(Vec::new, asked) {
        drawn.extend(draw(picture, &title, table)?);
    }
    let mut written = Vec::new();
    for (name, svg) in drawn {
        let path = folder.join(name);
        write_atomic(&path, svg.as_bytes())?;
        written.push(path);
    }
    Ok(written)
}

fn asked(scene: &Scene) -> Vec<Picture> {
    let of_run = scene.dynamics.plots.iter().map(|plot| match plot {
        RunPlot::Orbit => Picture::Orbit,
        RunPlot::Spectrum => Picture::Spectrum,
        RunPlot::Series => Picture::Series,
        RunPlot::SlipSpin => Picture::SlipSpin,
    });
    let polar = scene.plots.contains(&Plot::Polar).then_some(Picture::Polar);
    of_run.chain(polar).collect()
}
