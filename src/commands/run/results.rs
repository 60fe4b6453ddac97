//! What a run leaves in its folder: fields on the way; tables, plots and the summary at its end.

use super::figures::key_figures;
use super::prepared::Prepared;
use crate::commands::housed::{along_course, inertia_estimate, plan::verdict, write_bore};
use crate::commands::{remarks, say};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::fields::bore::bore_nodes;
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
use bearing_dynamics::solver::solid::model::SolidModel;
use serde_json::{Value, json};
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
        Prepared::Bearing { scene, problem, .. } => {
            if let Some(simulation) = session.motion.bearing() {
                said.remarks = remarks::of_run(scene, problem, &simulation.extremes[0]);
                said.sections.push(("remarks".into(), json!(said.remarks)));
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
    if let Prepared::Housed { reduced: Some(reduced), .. } = prepared {
        let [condense, reduce] = reduced.seconds;
        stages.extend([("condense".into(), condense), ("reduce".into(), reduce)]);
    }
    let mut record = prepared.record(request, choice.as_ref(), stages)?;
    record.sections.append(&mut said.sections);
    if let Motion::Solid(moving) = &session.motion {
        record.threads = moving.threads;
    }
    let (stepping, integrator) = (request.options.stepping, request.options.integrator);
    let report = RunReport {
        record,
        stopped_by,
        stepping: Some(stepping),
        integrator: Some(integrator),
        solid_stepping: match prepared {
            Prepared::Solid { settings, .. } => Some(settings.stepping),
            Prepared::Bearing { .. } | Prepared::Housed { .. } => None,
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
    let (Some(built), Motion::Solid(moving)) = (prepared.built(), &session.motion) else {
        return Ok(());
    };
    let (model, displacement) = (&moving.solid.model, session.displacement());
    let stress = stresses(model, &displacement);
    said.sections.push(("mass".into(), mass_section(model, built)?));
    said.sections.extend(field_sections(built, &displacement, &stress)?);
    said.remarks = of_solid::of_run(session, model, &stress);
    said.sections.push(("remarks".into(), json!(said.remarks)));
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
        let displacement = prepared.displacement(session);
        if !displacement.is_empty() {
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
            write_bore(folder, &bore_nodes(&session.motion, &setup.model))?;
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
    let Some(built) = prepared.built() else { return Ok(()) };
    let displacement = prepared.displacement(session);
    if displacement.is_empty() {
        return Ok(());
    }
    let path = folder.join(file_name("fields", index as usize));
    let housing = match prepared {
        Prepared::Housed { mesh, .. } => Some(&mesh.setup.model),
        Prepared::Bearing { .. } | Prepared::Solid { .. } => None,
    };
    let bore = housing.map(|model: &SolidModel| bore_nodes(&session.motion, model));
    let (velocity, stress) = match &mut session.motion {
        Motion::Solid(moving) => {
            (Some(moving.solid.velocity()), stresses(&moving.solid.model, &displacement))
        }
        motion => {
            // Between kicks the rates of a housing are those of the bearing's time.
            let rates = motion.solid().map(|solid| solid.rates());
            let rates = rates.map(|rates| rates.iter().map(|v| [v[0], v[1], v[2]]).collect());
            let rates = match prepared {
                Prepared::Housed { reduced: Some(reduced), .. } => {
                    reduced.fields(motion).map(|[_, velocities]| velocities)
                }
                _ => rates,
            };
            let Some(model) = housing else { return Ok(()) };
            (rates, stresses(model, &displacement))
        }
    };
    write_fields(&path, &built.mesh, &displacement, velocity.as_deref(), &stress, bore.as_deref())?;
    let last = session.recorder.rows().saturating_sub(1);
    let every = session.clock.rows_per_fields.map(|every| every as usize);
    let row = |index: u64| every.map_or(last, |every| (every * index as usize).min(last));
    let first = if every.is_none() { index } else { 0 };
    let files: Vec<(f64, String)> = (first..=index)
        .map(|index| (session.row_time(row(index)), file_name("fields", index as usize)))
        .collect();
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
