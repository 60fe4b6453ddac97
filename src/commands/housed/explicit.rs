//! `bearing run` of a bearing in its housing in explicit steps.

use super::{
    Prepared, parts, plan, prepare, record, request, run_settings, run_table, say_notes, started,
    write_bore,
};
use crate::commands::earlier::{Writes, claimed, refuse_half_way, remove_earlier};
use crate::commands::run::{Arguments, no_run, pictures};
use crate::commands::solid::say_remarks;
use crate::commands::{CommandResult, Outcome, results_folder, say};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::housed::fields::write_housing_fields;
use bearing_dynamics::output::housed::session::{HousedRunError, HousedSession, Progress};
use bearing_dynamics::output::housed::state::{self, HousedParts, HousedRequest, HousedStateFile};
use bearing_dynamics::output::housed::summary::{
    PEAK_PRESSURE, field_sections, run_summary, seat_section,
};
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::solid::fields::{file_name, stresses, write_list};
use bearing_dynamics::output::solid::remarks;
use bearing_dynamics::output::state::{StateRecord, Stopped};
use bearing_dynamics::scene::Document;
use bearing_dynamics::scene::housing::HousedScene;
use bearing_dynamics::solver::clock::rounded;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Elements evaluated between two looks at signals and clock: some milliseconds.
const ELEMENTS_AT_ONCE: usize = 200_000;

/// How the stepping ended.
enum End {
    Complete,
    Interrupted,
    Failed(HousedRunError),
}

pub fn run(
    arguments: &Arguments,
    document: &Document,
    scene: &HousedScene,
    begun: Instant,
) -> CommandResult {
    let settings = run_settings(&arguments.scene, scene)?;
    let folder = results_folder(&arguments.scene, &arguments.out);
    let folder = claimed(&folder, Writes::Run { fresh: arguments.fresh })?;
    let kept = kept_state(arguments, &folder)?;
    let prepared = prepare(document, scene)?;
    let Prepared { built, setup, .. } = &prepared;
    let parts = parts(scene, setup, &settings)?;
    let request = request(scene, &settings);
    let fingerprint = state::fingerprint(&parts, &request);
    let read_seconds = begun.elapsed().as_secs_f64();

    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = interrupted.clone();
    ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed))?;

    let start = Instant::now();
    let mut session = open(&folder, parts, &request, kept.as_ref())?;
    let start_seconds = start.elapsed().as_secs_f64();
    let kept = kept.as_ref().map(|file| &file.bearing);
    let record_of = StateRecord {
        fingerprint,
        stopped: Stopped::Running,
        error: None,
        output_interval: kept.map_or(request.output_interval, |file| file.output_interval),
        seconds: kept.map_or(0.0, |file| file.seconds),
    };
    say_notes(&prepared)?;
    say(&announcement(&session))?;
    if let Some(file) = kept {
        say(&format!("resumed at t = {} s, row {}\n", rounded(file.time), file.rows))?;
    }

    let start = Instant::now();
    let mut writer =
        Writer { folder: &folder, prepared: &prepared, end: settings.end, record: &record_of };
    if kept.is_none() && request.fields_interval.is_some() {
        writer.fields(&mut session, 0)?;
    }
    let every = Duration::from_secs(arguments.save_every);
    let end = simulate(&mut session, &mut writer, &interrupted, every)?;
    let seconds = record_of.seconds + start.elapsed().as_secs_f64();
    let (stopped, stopped_by) = match &end {
        End::Complete => (Stopped::Complete, None),
        End::Interrupted => (Stopped::Interrupted, Some("interrupted".to_string())),
        End::Failed(error) => (Stopped::Failed, Some(error.to_string())),
    };
    let error = stopped_by.clone().filter(|_| stopped == Stopped::Failed);
    // The state first: whatever goes wrong with plots and tables, the run is not lost.
    let last = StateRecord { stopped, error, seconds, ..record_of.clone() };
    state::save(&folder, &session, settings.end, &last)?;

    let start = Instant::now();
    let mut sections = vec![("seat".to_string(), seat_section(setup)?)];
    let mut remarks = Vec::new();
    if stopped == Stopped::Complete {
        let rows = session.grid.rows;
        // One file more unless the last one is due there anyway.
        if !rows.is_multiple_of(session.grid.rows_per_fields) {
            let regular = (rows / session.grid.rows_per_fields) as usize;
            let index = if request.fields_interval.is_some() { regular + 1 } else { 0 };
            writer.fields(&mut session, index)?;
        }
        let displacement = session.displacement();
        let stress = stresses(&setup.model, &displacement);
        sections.extend(field_sections(built, &displacement, &stress)?);
        remarks = remarks::of_motion(&setup.model, &displacement, &stress);
        sections.push(("housing_remarks".into(), json!(remarks)));
        write_bore(&folder, &session.bore_nodes())?;
    }
    let table = run_table(session.series()?, session.interval(), settings.window_start);
    let written = pictures(&folder, &scene.bearing, &table)?;
    table.series.write_csv(&folder.join("series.csv"))?;
    table.series.write_npy(&folder.join("series.npy"))?;
    let seconds_of = vec![
        ("read".into(), read_seconds),
        ("start".into(), start_seconds),
        ("simulate".into(), seconds),
        ("plots".into(), start.elapsed().as_secs_f64()),
    ];
    let mut record = record(scene, plan::lines(scene, &prepared)?, seconds_of)?;
    record.sections = sections;
    let summary = run_summary(&session, settings.end, &table, stopped_by.as_deref(), &record)?;
    write_atomic(&folder.join("summary.json"), pretty(&summary).as_bytes())?;
    say(&figures(&session, seconds))?;
    say_remarks(&remarks)?;
    say(&format!("wrote series, summary and {} plots to {}\n", written.len(), folder.display()))?;
    outcome(arguments, &folder, &session, end)
}

fn outcome(
    arguments: &Arguments,
    folder: &Path,
    session: &HousedSession,
    end: End,
) -> CommandResult {
    match end {
        End::Complete => Ok(Outcome::Done),
        End::Interrupted => Err(format!(
            "interrupted at t = {} s, after {} windows; what there is up to the last row is in {}. To \
             go on: bearing run {} --out {} --resume",
            rounded(session.housed.time()),
            session.housed.exchanges,
            folder.display(),
            arguments.scene.display(),
            folder.display(),
        )
        .into()),
        End::Failed(error) => Err(format!(
            "{error}; the rows so far and the state at the last row are in {}",
            folder.display()
        )
        .into()),
    }
}

/// The state to go on from, if that was asked for; what an earlier run left is removed otherwise.
fn kept_state(
    arguments: &Arguments,
    folder: &Path,
) -> Result<Option<HousedStateFile>, Box<dyn Error>> {
    if arguments.resume {
        return Ok(Some(state::read(folder)?.ok_or_else(|| no_run(folder))?));
    }
    if !arguments.fresh {
        refuse_half_way(folder)?;
    }
    remove_earlier(folder)?;
    Ok(None)
}

fn open(
    folder: &Path,
    parts: HousedParts,
    request: &HousedRequest,
    kept: Option<&HousedStateFile>,
) -> Result<HousedSession, Box<dyn Error>> {
    if let Some(file) = kept {
        return Ok(state::resume(folder, file, parts, request)?);
    }
    let (housed, windows) = started(parts, request.output_interval)?;
    let grid = request.grid(request.output_interval, windows);
    Ok(HousedSession::start(housed, grid, &request.channels, request.energy_limit)?)
}

fn announcement(session: &HousedSession) -> String {
    let housed = &session.housed;
    let limit = &housed.solid.limit;
    let [x, y, z] = limit.at.map(|at| 1e3 * at);
    let (tested, out_of_reach) = housed.counts();
    format!(
        "window {:.4e} s, {} of the housing in it; limit of the housing {:.4e} s, its fastest element, {}, \
         at x {x:.3}, y {y:.3}, z {z:.3} mm; bearing steps up to {:.4e} s\n\
         {tested} bore nodes in reach, {out_of_reach} out of it\n\
         {} windows to t = {} s, a row every {} windows = {:.4e} s\n",
        housed.window,
        if housed.solid_steps == 1 {
            "one step".into()
        } else {
            format!("{} steps", housed.solid_steps)
        },
        limit.step,
        housed.solid.model.labels.element(limit.element),
        housed.bearing.step_size,
        session.windows(),
        rounded(session.windows() as f64 * housed.window),
        session.grid.windows_per_row,
        session.interval()
    )
}

/// What a run writes on the way.
struct Writer<'w> {
    folder: &'w Path,
    prepared: &'w Prepared,
    end: f64,
    record: &'w StateRecord,
}

impl Writer<'_> {
    /// The fields of the present state as file number `index`, and the list of all files.
    fn fields(&mut self, session: &mut HousedSession, index: usize) -> Result<(), Box<dyn Error>> {
        let Prepared { built, setup, .. } = self.prepared;
        let displacement = session.displacement();
        let stress = stresses(&setup.model, &displacement);
        // Between kicks the rates of the housing are those of the bearing's time.
        let rates: Vec<[f64; 3]> =
            session.housed.solid.rates().iter().map(|v| [v[0], v[1], v[2]]).collect();
        let first = if session.grid.rows_per_fields == u64::MAX { index } else { 0 };
        let path = self.folder.join(file_name("fields", index));
        let bore = session.bore_nodes();
        write_housing_fields(&path, &built.mesh, &displacement, Some(&rates), &stress, &bore)?;
        let time = |index: usize| {
            let rows = session.grid.rows_per_fields.saturating_mul(index as u64);
            rows.min(session.grid.rows) as f64 * session.interval()
        };
        let files: Vec<(f64, String)> =
            (first..=index).map(|index| (time(index), file_name("fields", index))).collect();
        write_list(self.folder, &files)?;
        Ok(())
    }

    fn state(&self, session: &HousedSession, since: Instant) -> Result<(), Box<dyn Error>> {
        let seconds = self.record.seconds + since.elapsed().as_secs_f64();
        let record = StateRecord { seconds, ..self.record.clone() };
        Ok(state::save(self.folder, session, self.end, &record)?)
    }
}

/// Windows until the end, a signal or an error; keeps a state every now and then.
fn simulate(
    session: &mut HousedSession,
    writer: &mut Writer,
    interrupted: &AtomicBool,
    save_every: Duration,
) -> Result<End, Box<dyn Error>> {
    let all = session.windows();
    // Hidden by itself when standard error is not a terminal.
    let bar = ProgressBar::new(all);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}, {eta} left") {
        bar.set_style(style);
    }
    bar.set_position(session.housed.exchanges);
    bar.reset_eta();
    let start = Instant::now();
    let mut saved = start;
    let elements = session.housed.solid.model.problem.elements.len() * session.housed.solid_steps;
    let at_once = (ELEMENTS_AT_ONCE / elements).max(1) as u64;
    let end = loop {
        match session.advance(at_once) {
            Ok(Progress::Complete) => break End::Complete,
            Ok(Progress::Fields(index)) => writer.fields(session, index)?,
            Ok(Progress::Running) => {}
            Err(error) => break End::Failed(error),
        }
        if interrupted.load(Ordering::Relaxed) {
            break End::Interrupted;
        }
        if saved.elapsed() >= save_every {
            writer.state(session, start)?;
            saved = Instant::now();
        }
        if !bar.is_hidden() {
            let housed = &session.housed;
            bar.set_position(housed.exchanges);
            bar.set_message(format!(
                "t = {:.5e} of {:.3e} s, window {:.2e} s",
                housed.time(),
                writer.end,
                housed.window
            ));
        }
    };
    bar.finish_and_clear();
    Ok(end)
}

/// The few numbers that the run ends with.
fn figures(session: &HousedSession, seconds: f64) -> String {
    let mut text = String::new();
    let Ok(series) = session.series() else { return text };
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "{label:<22} {value}");
    };
    let largest = |name: &str| {
        series.column(name).map_or(0.0, |values| values.iter().fold(0.0f64, |a, b| a.max(b.abs())))
    };
    line(
        "outer race, farthest",
        format!(
            "{:.6} um along y, {:.6} um along z",
            1e6 * largest("outer_y"),
            1e6 * largest("outer_z")
        ),
    );
    line(
        "bore",
        format!(
            "penetration up to {:.6} um, pressure up to {:.4} MPa, {PEAK_PRESSURE}",
            1e6 * largest("bore_deepest_penetration"),
            1e-6 * largest("bore_peak_pressure")
        ),
    );
    let watch = session.watch;
    line(
        "energy unaccounted for",
        format!(
            "{:.3e} J at most, of {:.3e} J turned over",
            watch.largest_residual, watch.turned_over
        ),
    );
    line(
        "windows",
        format!(
            "{} in {seconds:.2} s; {} steps of the housing, {} of the bearing",
            session.housed.exchanges, session.housed.solid.steps, session.housed.bearing.steps
        ),
    );
    text
}
