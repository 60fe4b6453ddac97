//! `bearing run` of a solid: step after step, and the folder it leaves.

use super::{Prepared, plan, prepare, record, say_mesh_notes, say_remarks, title};
use crate::commands::earlier::{Writes, claimed, refuse_half_way, remove_earlier};
use crate::commands::run::{Arguments, no_run};
use crate::commands::{CommandResult, Outcome, results_folder, say};
use bearing_dynamics::mesh::TetMesh;
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::solid::fields::{file_name, stresses, write_fields, write_list};
use bearing_dynamics::output::solid::pictures::{probe_spectra, series_plots, spectrum_plot};
use bearing_dynamics::output::solid::session::{Progress, SolidRunError, SolidSession};
use bearing_dynamics::output::solid::state::{self, SolidStateFile, SolidStateRecord};
use bearing_dynamics::output::solid::{remarks, summary};
use bearing_dynamics::output::state::Stopped;
use bearing_dynamics::scene::solid::SolidRun;
use bearing_dynamics::scene::{Document, SolidScene};
use bearing_dynamics::solver::clock::rounded;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Elements evaluated between two looks at signals and clock: some milliseconds.
const ELEMENTS_AT_ONCE: u64 = 200_000;

/// How the stepping ended.
enum End {
    Complete,
    Interrupted,
    Failed(SolidRunError),
}

pub fn run(
    arguments: &Arguments,
    document: &Document,
    scene: &SolidScene,
    begun: Instant,
) -> CommandResult {
    let Some(settings) = scene.run else {
        let scene = arguments.scene.display();
        return Err(format!("{scene}: a run needs `end` in [numerics]").into());
    };
    let folder = results_folder(&arguments.scene, &arguments.out);
    let folder = claimed(&folder, Writes::Run { fresh: arguments.fresh })?;
    let prepared = prepare(document, scene)?;
    let Prepared { built, setup, .. } = &prepared;
    let kept = kept_state(arguments, &folder)?;
    let read_seconds = begun.elapsed().as_secs_f64();

    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = interrupted.clone();
    ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed))?;

    let start = Instant::now();
    let threads = usize::from(arguments.threads);
    let mut session = match &kept {
        Some(file) => state::resume(&folder, file, setup, &settings, threads)?,
        None => SolidSession::start(setup, &settings, threads)?,
    };
    let start_seconds = start.elapsed().as_secs_f64();
    let kept = kept.as_ref();
    let state = SolidStateRecord {
        fingerprint: state::fingerprint(setup, &settings),
        stopped: Stopped::Running,
        error: None,
        end: settings.end,
        output_interval: kept.map_or(settings.output_interval, |file| file.output_interval),
        fields_interval: kept.map_or(settings.fields_interval, |file| file.fields_interval),
        seconds: kept.map_or(0.0, |file| file.seconds),
    };
    say_mesh_notes(built)?;
    say(&announcement(&session, &settings, kept))?;

    let start = Instant::now();
    if kept.is_none() {
        write_state_fields(&folder, &built.mesh, &mut session, 0)?;
    }
    let every = Duration::from_secs(arguments.save_every);
    let end = simulate(&mut session, &folder, &built.mesh, &state, &interrupted, every)?;
    let seconds = state.seconds + start.elapsed().as_secs_f64();
    let (stopped, stopped_by) = match &end {
        End::Complete => (Stopped::Complete, None),
        End::Interrupted => (Stopped::Interrupted, Some("interrupted".to_string())),
        End::Failed(error) => (Stopped::Failed, Some(error.to_string())),
    };
    let error = stopped_by.clone().filter(|_| stopped == Stopped::Failed);
    // The state first: whatever goes wrong with plots and tables, the run is not lost.
    state::save(&folder, &session, &SolidStateRecord { stopped, error, seconds, ..state })?;

    let start = Instant::now();
    if stopped == Stopped::Failed {
        // What the failed step left is not written; the rows and the state before it are.
        session.solid.restore(&session.resumable().checkpoint);
    }
    let series = session.series()?;
    let interval = session.grid.interval();
    let spectra = match scene.draw_spectrum {
        true => probe_spectra(&series, &session.probes, session.rows_on_grid(), interval),
        false => Vec::new(),
    };
    let mut plots = Vec::new();
    if scene.draw_series {
        plots.extend(series_plots(&title(scene), &series, &session.probes)?);
    }
    plots.extend(spectrum_plot(&title(scene), &spectra)?);
    for (name, svg) in &plots {
        write_atomic(&folder.join(name), svg.as_bytes())?;
    }
    session.readable_series()?.write_csv(&folder.join("series.csv"))?;
    series.write_npy(&folder.join("series.npy"))?;
    let seconds = vec![
        ("read".into(), read_seconds),
        ("start".into(), start_seconds),
        ("simulate".into(), seconds),
        ("plots".into(), start.elapsed().as_secs_f64()),
    ];
    let mut record = record(scene, plan::lines(scene, &prepared), seconds)?;
    record.threads = threads;
    let stress = stresses(&session.solid.model, &session.displacement());
    let reason = stopped_by.as_deref();
    let mut summary = summary::run(&session, &settings, built, &stress, &spectra, reason, &record)?;
    let remarks = remarks::of_run(&session, &stress);
    summary["remarks"] = json!(remarks);
    write_atomic(&folder.join("summary.json"), pretty(&summary).as_bytes())?;
    say_remarks(&remarks)?;
    say(&format!(
        "wrote series, fields, summary and {} plots to {}\n",
        plots.len(),
        folder.display()
    ))?;
    outcome(arguments, &folder, &session, &settings, end)
}

fn outcome(
    arguments: &Arguments,
    folder: &Path,
    session: &SolidSession,
    settings: &SolidRun,
    end: End,
) -> CommandResult {
    match end {
        End::Complete => Ok(Outcome::Done),
        End::Interrupted => Err(format!(
            "interrupted at t = {} s of {} s, after {} steps; what there is so far is in {}. To \
             go on: bearing run {} --out {} --resume",
            rounded(session.solid.time),
            settings.end,
            session.solid.steps,
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
) -> Result<Option<SolidStateFile>, Box<dyn Error>> {
    if arguments.resume {
        return Ok(Some(state::read(folder)?.ok_or_else(|| no_run(folder))?));
    }
    if !arguments.fresh {
        refuse_half_way(folder)?;
    }
    remove_earlier(folder)?;
    Ok(None)
}

fn announcement(
    session: &SolidSession,
    settings: &SolidRun,
    kept: Option<&SolidStateFile>,
) -> String {
    let (solid, grid) = (&session.solid, &session.grid);
    let limit = &solid.limit;
    let [x, y, z] = limit.at.map(|at| 1e3 * at);
    let mut text = format!(
        "step {:.4e} s, {:.3} of the stability limit {:.4e} s{}; the fastest element, {}, lies at x {x:.3}, \
         y {y:.3}, z {z:.3} mm\n",
        grid.step_size,
        grid.step_size / limit.step,
        limit.step,
        if limit.is_bound { " (a safe bound: the search for it did not settle)" } else { "" },
        solid.model.labels.element(limit.element)
    );
    let (interval, asked) = (grid.interval(), settings.output_interval);
    let off = if kept.is_none() && (interval / asked - 1.0).abs() > 1e-9 {
        format!(" ({asked} s asked for, rounded to whole steps)")
    } else {
        String::new()
    };
    text += &format!(
        "{} steps to t = {} s, a row every {} steps = {interval:.4e} s{off}, fields every {} \
         rows\n",
        grid.steps,
        rounded(grid.steps as f64 * grid.step_size),
        grid.steps_per_row,
        grid.rows_per_fields
    );
    if let Some(file) = kept {
        text += &format!("resumed at t = {} s, step {}\n", rounded(file.time), file.steps);
    }
    text
}

/// Writes the fields of the present state as file number `index`, and the list of all files.
fn write_state_fields(
    folder: &Path,
    mesh: &TetMesh,
    session: &mut SolidSession,
    index: usize,
) -> Result<(), Box<dyn Error>> {
    let displacement = session.displacement();
    let velocity = session.solid.velocity();
    let stress = stresses(&session.solid.model, &displacement);
    let path = folder.join(file_name("fields", index));
    write_fields(&path, mesh, &displacement, Some(&velocity), &stress)?;
    let rows = session.grid.rows_per_fields as usize;
    let files: Vec<(f64, String)> = (0..=index)
        .map(|index| (session.row_time(index * rows), file_name("fields", index)))
        .collect();
    write_list(folder, &files)?;
    Ok(())
}

/// Steps until the end, a signal or an error; keeps a state every now and then.
fn simulate(
    session: &mut SolidSession,
    folder: &Path,
    mesh: &TetMesh,
    state: &SolidStateRecord,
    interrupted: &AtomicBool,
    save_every: Duration,
) -> Result<End, Box<dyn Error>> {
    let bar = progress_bar(session);
    let start = Instant::now();
    let mut saved = start;
    let at_once = (ELEMENTS_AT_ONCE / mesh.elements.len() as u64).max(1);
    let end = loop {
        match session.advance(at_once) {
            Ok(Progress::Complete) => break End::Complete,
            Ok(Progress::Fields(index)) => write_state_fields(folder, mesh, session, index)?,
            Ok(Progress::Running) => {}
            Err(error) => break End::Failed(error),
        }
        if interrupted.load(Ordering::Relaxed) {
            break End::Interrupted;
        }
        if saved.elapsed() >= save_every {
            let seconds = state.seconds + start.elapsed().as_secs_f64();
            state::save(folder, session, &SolidStateRecord { seconds, ..state.clone() })?;
            saved = Instant::now();
        }
        if !bar.is_hidden() {
            bar.set_position(session.solid.steps);
            bar.set_message(format!(
                "t = {:.5e} of {:.3e} s, step {:.2e} s",
                session.solid.time, state.end, session.grid.step_size
            ));
        }
    };
    bar.finish_and_clear();
    Ok(end)
}

fn progress_bar(session: &SolidSession) -> ProgressBar {
    // Hidden by itself when standard error is not a terminal.
    let bar = ProgressBar::new(session.grid.steps);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}, {eta} left") {
        bar.set_style(style);
    }
    bar.set_position(session.solid.steps);
    bar.reset_eta();
    bar
}
