//! Results of a run: fields during the run; tables, plots and the summary at its end.

use super::figures::{key_figures, rotation};
use super::prepared::{Fields, Prepared, SolidOf, SolutionMethod};
use crate::commands::assembly::housing::Housing;
use crate::commands::assembly::inertia::FrequencyRatio;
use crate::commands::drift::drifting;
use crate::commands::warnings::{aliased, of_run};
use bearing_dynamics::equilibrium::quasi_static_sequence::QuasiStaticSequence;
use bearing_dynamics::equilibrium::warm_started_search::WarmStartedSearch;
use bearing_dynamics::motion::integrator_choice::Choice;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::fields::bore::{bore_nodes, bore_series};
use bearing_dynamics::output::fields::{
    FOLDER, file_name, rubber_stresses, stresses, write_fields, write_list,
};
use bearing_dynamics::output::pictures::bearing::{Picture, draw, without_run_up};
use bearing_dynamics::output::pictures::solid::{
    force_plots, probe_spectra, series_plots, spectrum_plot,
};
use bearing_dynamics::output::recorder::seat::prefix;
use bearing_dynamics::output::session::{Motion, RunRequest, Session, Status};
use bearing_dynamics::output::spectrum::Spectrum;
use bearing_dynamics::output::summary::housing::{
    equilibrium_section, reduced_section, seat_section, solver_section,
};
use bearing_dynamics::output::summary::rubber::rubber_mass;
use bearing_dynamics::output::summary::solid::{field_sections, mass_section};
use bearing_dynamics::output::summary::{RunReport, write_run_results};
use bearing_dynamics::output::table::RunTable;
use bearing_dynamics::output::warnings::{Warning, lines, solid as of_solid};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::excitations::excitations;
use bearing_dynamics::scene::resolve::solid_scene::LoadKind;
use bearing_dynamics::scene::{Document, Plot, RunPlot, Scene, SolidScene};
use bearing_dynamics::solids::condensation::CondensedBore;
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

/// Sections of the summary, warnings and printed lines that depend on the kind of scene.
#[derive(Default)]
struct Extras {
    sections: Vec<(String, Value)>,
    warnings: Vec<Warning>,
    /// Lines printed after the key figures.
    lines: Vec<String>,
    files: usize,
}

/// Writes all results, and returns what to print; the state has been saved before.
pub(super) fn write_results(
    folder: &Path,
    (document, prepared): (&Document, &Prepared),
    session: &mut Session,
    (request, choice): (&RunRequest, Option<Choice>),
    stopped_by: Option<String>,
    seconds: &Seconds,
) -> Fallible<String> {
    let start = Instant::now();
    let mut extras = Extras::default();
    let table = RunTable::new(session, prepared.window_start())?;
    match prepared {
        Prepared::Bearings { lists, .. } => {
            let scene = lists.scene;
            extras.warnings = of_run(scene, session);
            if !matches!(session.motion, Motion::QuasiStaticSequence(_)) {
                extras.warnings.extend(drifting(lists.assembly()?, &table));
            }
            if scene.common().dynamics.plots.contains(&RunPlot::RunUp) {
                extras.lines.extend(without_run_up(&table).map(|why| format!("note: {why}")));
            }
            housing_results(folder, prepared, session, &table, &mut extras)?;
        }
        Prepared::Solid { .. } => {
            // After an early stop the state at the last row is not available.
            if session.status == Status::Complete {
                write_last_fields(folder, prepared, session)?;
            }
            solid_results(prepared, session, &mut extras)?;
        }
        Prepared::Rubber { .. } => {
            write_last_fields(folder, prepared, session)?;
            rubber_results(prepared, session, &mut extras)?;
        }
    }
    extras.sections.push(("warnings".into(), json!(extras.warnings)));
    let warnings = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let spectra = spectra(prepared, session, &table);
    let plots = pictures(folder, prepared, session, &table, &spectra)?;
    let mut stages = vec![
        ("read".into(), seconds.read),
        ("start".into(), seconds.start),
        ("simulate".into(), seconds.simulate),
        ("warnings".into(), warnings),
        ("plots".into(), start.elapsed().as_secs_f64()),
    ];
    stages.extend(prepared.seconds());
    let mut record = prepared.record(document, request, choice.as_ref(), stages)?;
    record.sections.append(&mut extras.sections);
    record.ran.absorb(&session.ran());
    match &session.motion {
        Motion::Solid(moving) => record.threads = moving.threads,
        Motion::Housed(housed) => record.threads = housed.threads(),
        Motion::Bearing(_) | Motion::QuasiStaticSequence(_) | Motion::Rubber(_) => {}
    }
    let (stepping, integrator) = (request.options.stepping, request.options.integrator);
    let report = RunReport {
        record,
        stopped_by,
        stepping: Some(stepping),
        integrator: Some(integrator),
        solid_stepping: match prepared {
            Prepared::Solid { steps: (_, stepping), .. } => Some(*stepping),
            Prepared::Bearings { .. } | Prepared::Rubber { .. } => None,
        },
    };
    let (written, summary) = write_run_results(folder, session, &table, &spectra, &report)?;
    let mut text = key_figures(session, &table, seconds.simulate)
        + &rotation(&summary)
        + &lines(&extras.warnings);
    for line in &extras.lines {
        text += &format!("{line}\n");
    }
    // One more for the state.
    let fields = std::fs::read_dir(folder.join(FOLDER)).map_or(0, |files| files.count() + 1);
    let files = written.len() + plots.len() + fields + extras.files + 1;
    text += &format!("wrote {files} files to {}\n", folder.display());
    Ok(text)
}

/// Writes the fields of the last row, if they were not due there.
fn write_last_fields(folder: &Path, prepared: &Prepared, session: &mut Session) -> Fallible<()> {
    let Some(row) = (session.recorder.rows() as u64).checked_sub(1) else { return Ok(()) };
    if session.clock.fields_due().is_some() {
        return Ok(());
    }
    let index = session.clock.rows_per_fields.map_or(0, |every| row / every + 1);
    write_fields_file(folder, prepared, session, index)
}

fn solid_results(prepared: &Prepared, session: &Session, extras: &mut Extras) -> Fallible<()> {
    let (Prepared::Solid { mesh, scene, .. }, Motion::Solid(moving)) = (prepared, &session.motion)
    else {
        return Ok(());
    };
    let built = &mesh.built;
    let (model, displacement) = (&moving.solid.model, session.displacement(0));
    let stress = stresses(model, &displacement);
    extras.sections.push(("mass".into(), mass_section(model, built)?));
    extras.sections.extend(field_sections(built, &displacement, &stress)?);
    extras.warnings = of_solid::of_run(session, model, &stress);
    extras.warnings.extend(cycles_between_rows(scene, session));
    Ok(())
}

fn rubber_results(prepared: &Prepared, session: &Session, extras: &mut Extras) -> Fallible<()> {
    let (Prepared::Rubber { mesh, scene, .. }, Motion::Rubber(moving)) =
        (prepared, &session.motion)
    else {
        return Ok(());
    };
    let (state, built) = (moving.solid.state(), &mesh.built);
    let stress = rubber_stresses(moving.solid.model(), state)?;
    extras.sections.push(("mass".into(), rubber_mass(&mesh.setup, built)?));
    extras.sections.extend(field_sections(built, &state.displacement, &stress)?);
    extras.warnings = of_solid::of_rubber(moving.solid.model(), &state.displacement)?;
    extras.warnings.extend(cycles_between_rows(scene, session));
    Ok(())
}

/// Warning about the fastest load or support motion of a single solid, if its rows alias it.
fn cycles_between_rows(scene: &SolidScene, session: &Session) -> Option<Warning> {
    let supports = scene.held.iter().flat_map(|support| {
        support
            .motion
            .iter()
            .flatten()
            .map(|motion| (format!("the set \"{}\"", support.set), motion))
    });
    let loads = scene.loads.iter().flat_map(|load| {
        let profiles: Vec<&Profile> = match &load.kind {
            LoadKind::Force(along) => along.iter().flatten().collect(),
            LoadKind::Pressure(profile) => vec![profile],
        };
        profiles.into_iter().map(|profile| (format!("the load on \"{}\"", load.set), profile))
    });
    let cycles = supports.chain(loads).map(|(what, profile)| (what, profile.cycles()));
    let (what, frequency) = cycles.max_by(|a, b| a.1.total_cmp(&b.1))?;
    aliased(&what, frequency, session.clock.row_interval())
}

/// Fields of the last state of housings, shafts in elements and flexible cages, tables of bore nodes, and the effect of inertia.
fn housing_results(
    folder: &Path,
    prepared: &Prepared,
    session: &mut Session,
    table: &RunTable,
    extras: &mut Extras,
) -> Fallible<()> {
    let Prepared::Bearings { lists, housings, shafts, cages, method, .. } = prepared else {
        return Ok(());
    };
    let scene = lists.scene;
    if housings.is_empty() && shafts.is_empty() && cages.is_empty() {
        return Ok(());
    }
    // After an early stop of explicit steps the state at the last row is not available.
    let is_sound =
        !matches!(method, SolutionMethod::Explicit) || session.status == Status::Complete;
    let is_sound = is_sound && session.recorder.rows() > 0;
    if is_sound {
        write_last_fields(folder, prepared, session)?;
    }
    let mut of_all = Map::new();
    for (number, housing) in housings.iter().enumerate() {
        let mut sections = Vec::new();
        match method {
            SolutionMethod::QuasiStaticSequence(bores, _) => {
                sections.extend(equilibrium(&bores[number], housing, session, number)?);
            }
            SolutionMethod::Reduced(shapes) => {
                let cut = &shapes.reductions[number].cut_off;
                sections.push(("seat".into(), seat_section(&housing.setup)?));
                let name = if housing.name.is_some() { "shapes" } else { "reduced_housing" };
                sections.push((name.into(), reduced_section(cut, &excitations(scene))?));
                let found = largest_bore_load(table, &housing.name);
                extras.warnings.extend(shapes.beyond(housings, number, found).filter(|_| is_sound));
            }
            SolutionMethod::Explicit | SolutionMethod::Rigid => {
                sections.push(("seat".into(), seat_section(&housing.setup)?));
            }
        }
        let fields = prepared.fields(session, number).filter(|_| is_sound);
        if let Some(Fields { displacement, .. }) = fields {
            let model = &housing.setup.model;
            let stress = stresses(model, &displacement);
            sections.extend(field_sections(&housing.built, &displacement, &stress)?);
            let own = match method {
                SolutionMethod::QuasiStaticSequence(..) => {
                    of_solid::of_equilibrium(model, &displacement, &stress)
                }
                _ => of_solid::of_motion(model, &stress),
            };
            extras.warnings.extend(own.into_iter().map(|of| of.named(&housing.before())));
            let nodes = bore_nodes(&session.motion, number, model);
            bore_series(&nodes)?.write_csv(&folder.join(housing.bore_file()))?;
            extras.files += 1;
        }
        match &housing.name {
            Some(name) => {
                of_all.insert(name.clone(), Value::Object(sections.into_iter().collect()));
            }
            None => extras.sections.extend(sections),
        }
    }
    if !of_all.is_empty() {
        extras.sections.push(("housings".into(), Value::Object(of_all)));
    }
    if let Motion::QuasiStaticSequence(sequence) = &session.motion {
        inertia_results(scene, sequence, housings, extras)?;
    }
    Ok(())
}

/// Largest radial force (N) and tilting moment (N m) of a housing on its race, over all rows.
fn largest_bore_load(table: &RunTable, name: &Option<String>) -> [f64; 2] {
    ["force", "moment"].map(|of| {
        let [y, z] = ["y", "z"].map(|axis| {
            let column = format!("{}housing_{of}_on_outer_{axis}", prefix(name));
            table.all(&column).unwrap_or_default()
        });
        y.iter().zip(&z).fold(0.0, |most, (y, z)| f64::max(most, y.hypot(*z)))
    })
}

fn equilibrium(
    bore: &CondensedBore,
    housing: &Housing,
    session: &Session,
    number: usize,
) -> Fallible<Option<(String, Value)>> {
    let Motion::QuasiStaticSequence(sequence) = &session.motion else { return Ok(None) };
    let Some(moment) = &sequence.latest else { return Ok(None) };
    let (state, displacement) = (&moment.solution.seats[number], sequence.displacement(number));
    let mut section = equilibrium_section(&housing.setup, bore, state, &displacement)?;
    section["solver"] = solver_section(moment)?;
    Ok(Some(("housing".into(), section)))
}

/// Effect of inertia at the latest equilibrium. An error here is only printed, so that the equilibria are kept.
fn inertia_results(
    scene: &AssemblyScene,
    sequence: &QuasiStaticSequence,
    housings: &[Housing],
    extras: &mut Extras,
) -> Fallible<()> {
    let problem = &sequence.problem;
    let mut search = WarmStartedSearch::of(&problem.seats);
    let found = problem.find(&mut search, sequence.time()).map_err(Box::from);
    let ratio = found.and_then(|at| FrequencyRatio::of(scene, problem, housings, &search, &at));
    match ratio {
        Ok(Some(ratio)) => {
            extras.sections.push(("inertia".into(), ratio.section()?));
            extras.lines.push(format!("inertia left out       {}", ratio.text()));
        }
        Ok(None) => {}
        Err(why) => extras.lines.push(format!("inertia left out       not computed: {why}")),
    }
    Ok(())
}

/// Writes the fields of the present state as file number `index`, and the list of all files.
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
                let bore = solid.has_bore.then(|| bore_nodes(motion, number, model));
                (bore, stresses(model, &displacement))
            }
            (None, Motion::Solid(moving)) => (None, stresses(&moving.solid.model, &displacement)),
            (None, Motion::Rubber(moving)) => {
                (None, rubber_stresses(moving.solid.model(), moving.solid.state())?)
            }
            _ => return Ok(()),
        };
        let path = folder.join(file_name(solid.name.unwrap_or("fields"), index as usize));
        let (mesh, velocity) = (solid.mesh, velocity.as_deref());
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

/// Requested spectra: of races and cage over the averaging window, or of the probes of a solid.
fn spectra(prepared: &Prepared, session: &Session, table: &RunTable) -> Vec<(String, Spectrum)> {
    if !prepared.has_spectra() {
        return Vec::new();
    }
    match session.motion {
        Motion::Solid(_) | Motion::Rubber(_) => probe_spectra(table, &session.recorder.probes),
        _ => table.spectra(),
    }
}

fn pictures(
    folder: &Path,
    prepared: &Prepared,
    session: &Session,
    table: &RunTable,
    spectra: &[(String, Spectrum)],
) -> Fallible<Vec<PathBuf>> {
    let title = prepared.title();
    let mut drawn = Vec::new();
    if let Prepared::Solid { scene, .. } | Prepared::Rubber { scene, .. } = prepared {
        let recorder = &session.recorder;
        if scene.draw_series {
            drawn.extend(series_plots(&title, table, &recorder.probes)?);
        }
        if scene.draw_series && matches!(session.motion, Motion::Rubber(_)) {
            drawn.extend(force_plots(&title, table, &recorder.probes, &recorder.supports)?);
        }
        drawn.extend(spectrum_plot(&title, spectra)?);
    }
    for picture in prepared.bearing().map_or_else(Vec::new, requested_pictures) {
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

fn requested_pictures(scene: &Scene) -> Vec<Picture> {
    let of_run = scene.dynamics.plots.iter().map(|plot| match plot {
        RunPlot::Orbit => Picture::Orbit,
        RunPlot::Spectrum => Picture::Spectrum,
        RunPlot::Series => Picture::Series,
        RunPlot::SlipSpin => Picture::SlipSpin,
        RunPlot::RunUp => Picture::RunUp,
    });
    let polar = scene.plots.contains(&Plot::Polar).then_some(Picture::Polar);
    of_run.chain(polar).collect()
}
