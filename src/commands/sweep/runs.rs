//! A sweep of runs: each point a run in a folder of its own, one table of their statistics.
//!
//! A point is what `bearing run` makes of its scene, on one thread. An interrupted sweep resumes its unfinished points from their
//! saved states and skips those whose summary is complete.

use super::grid::Grid;
use super::housings::{mesh_files, solid_mesh_files};
use super::shard;
use super::{Arguments, point, progress_bar, report, sweep_folder, table};
use crate::commands::earlier::{Writes, claimed, remove_earlier};
use crate::commands::run::{End, check_end, run_silently};
use crate::commands::{CommandResult, Outcome, print};
use bearing_dynamics::output::ensemble::{self, Channel};
use bearing_dynamics::output::folder::claim;
use bearing_dynamics::output::{fields, json};
use bearing_dynamics::scene::{Document, Subject, resolve_subject};
use rayon::prelude::*;
use serde_json::json;
use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// A point after its run: statistics of its channels, or its error.
type Ran = Result<Vec<Channel>, String>;

pub fn run(
    arguments: &Arguments,
    document: &Document,
    grid: &Grid,
    interrupted: &AtomicBool,
) -> CommandResult {
    let start = Instant::now();
    let subject = |point| -> Result<Subject, Box<dyn Error>> {
        let document = grid.document(document, point)?;
        let subject = resolve_subject(&document)?;
        check_end(Path::new(document.name()), &subject)?;
        Ok(subject)
    };
    grid.check_any(|point| subject(point).map(|_| ()))?;
    let shard = arguments.shard()?;
    let folder = claimed(&shard.folder(&sweep_folder(arguments)), Writes::Sweep)?;
    let meshes = match subject(0) {
        Ok(Subject::Assembly(scene)) => mesh_files(&scene)?,
        Ok(Subject::Solid(scene)) => solid_mesh_files(std::iter::once(&*scene))?,
        Err(_) => Vec::new(),
    };
    let mesh: Vec<u8> = meshes.into_iter().flat_map(|(_, content)| content).collect();
    let hash = grid.hash(document, &mesh);
    let of = ("runs", hash.as_str());
    if arguments.merge {
        return merge(&folder, document, grid, of);
    }
    if table::earlier(&folder, of, arguments.fresh)?.is_none() && remove_points(&folder)? {
        print(&format!("the earlier results in {} are replaced\n", folder.display()))?;
    }
    report::write_record(&folder, &report::started(document, grid, of))?;

    let own: Vec<usize> = shard.blocks(grid, 1).map(|block| block.start).collect();
    let progress = progress_bar(own.len(), 0);
    let threads = arguments.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let ran: BTreeMap<usize, Ran> = pool.install(|| {
        // One after the other, as threads become free.
        let points = own.par_iter().copied().with_max_len(1);
        let ran = points.filter_map(|point| {
            let ran = run_point(document, grid, (point, &folder), interrupted);
            progress.inc(1);
            Some((point, ran.map_err(|error| error.to_string()).transpose()?))
        });
        ran.collect()
    });
    progress.finish_and_clear();

    let (runs, failures) = sorted(ran, grid);
    let done = runs.len() + failures.len();
    ensemble::write(&folder, &point::start_of_columns(grid), &runs)?;
    write_record(&folder, (document, grid, of), &failures, done == own.len())?;
    if done < own.len() {
        return Err(format!(
            "interrupted after {done} of {} points, kept in {}; the same command resumes",
            own.len(),
            folder.display()
        )
        .into());
    }
    let (threads, seconds) = (pool.current_num_threads(), start.elapsed().as_secs_f64());
    print(&format!(
        "{} runs in {seconds:.2} s on {threads} thread{}: {}\n",
        runs.len(),
        if threads == 1 { "" } else { "s" },
        folder.join("series.csv").display()
    ))?;
    match failures.iter().next() {
        None => Ok(Outcome::Done),
        Some((point, message)) => Err(format!(
            "{} of {} runs failed (listed in {}), the first is point {point}: {message}",
            failures.len(),
            own.len(),
            folder.join("sweep.json").display()
        )
        .into()),
    }
}

/// Runs in the order of their points, and messages of those that failed or have other channels.
fn sorted(ran: BTreeMap<usize, Ran>, grid: &Grid) -> (Vec<ensemble::Run>, BTreeMap<usize, String>) {
    let mut failures = BTreeMap::new();
    let mut runs: Vec<ensemble::Run> = Vec::new();
    for (point, ran) in ran {
        match ran.and_then(|channels| alike(channels, runs.first())) {
            Ok(channels) => {
                runs.push(ensemble::Run { start: point::start_of_row(grid, point), channels });
            }
            Err(message) => drop(failures.insert(point, message)),
        }
    }
    (runs, failures)
}

fn write_record(
    folder: &Path,
    (document, grid, of): (&Document, &Grid, (&str, &str)),
    failures: &BTreeMap<usize, String>,
    complete: bool,
) -> Result<(), Box<dyn Error>> {
    let mut record = report::started(document, grid, of);
    record["complete"] = json!(complete);
    record["failures"] = report::failures(grid, failures);
    Ok(report::write_record(folder, &record)?)
}

/// The table of the runs of all shards.
fn merge(folder: &Path, document: &Document, grid: &Grid, of: (&str, &str)) -> CommandResult {
    let mut ran: BTreeMap<usize, Ran> = BTreeMap::new();
    let mut points = Vec::new();
    for shard in shard::all_of(folder, of.0, of.1)? {
        let missed = shard::failures(&shard)?;
        for entry in std::fs::read_dir(&shard)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let Some(Ok(point)) = name.strip_prefix("point-").map(str::parse) else { continue };
            points.push(point);
            let channels = || ensemble::channels(&json::read(&path.join("summary.json")).ok()?);
            let own = match missed.get(&point) {
                Some(message) => Err(message.clone()),
                None => Ok(channels().ok_or_else(|| format!("{}: no statistics", path.display()))?),
            };
            ran.insert(point, own);
        }
    }
    shard::check_points(&points, grid)?;
    let (runs, failures) = sorted(ran, grid);
    ensemble::write(folder, &point::start_of_columns(grid), &runs)?;
    write_record(folder, (document, grid, of), &failures, true)?;
    print(&format!("{} runs merged: {}\n", runs.len(), folder.join("series.csv").display()))?;
    Ok(Outcome::Done)
}

fn point_folder(folder: &Path, point: usize) -> PathBuf {
    folder.join(format!("point-{point}"))
}

/// Runs a point, or reads its summary if it is complete; `None` if it was interrupted.
fn run_point(
    document: &Document,
    grid: &Grid,
    (point, folder): (usize, &Path),
    interrupted: &AtomicBool,
) -> Result<Option<Vec<Channel>>, Box<dyn Error>> {
    let path = point_folder(folder, point).join("summary.json");
    let is_complete = || json::read(&path).is_ok_and(|summary| summary["complete"] == true);
    if !is_complete() {
        if interrupted.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let folder = claim(&point_folder(folder, point))?;
        match run_silently(&grid.document(document, point)?, &folder, interrupted)? {
            End::Complete => {}
            End::Interrupted(_) => return Ok(None),
            End::Failed(error) => return Err(error.into()),
        }
    }
    let channels = ensemble::channels(&json::read(&path)?);
    Ok(Some(channels.ok_or("the run ends before its window, output.window_start")?))
}

/// The channels of a run, which must be those of the first run.
fn alike(channels: Vec<Channel>, first: Option<&ensemble::Run>) -> Ran {
    let names = |of: &[Channel]| of.iter().map(|channel| channel.name.clone()).collect::<Vec<_>>();
    match first {
        Some(first) if names(&first.channels) != names(&channels) => {
            Err("its channels are not those of the first run; sweep it by itself".into())
        }
        _ => Ok(channels),
    }
}

/// Removes the runs of an earlier sweep, and returns whether it was written to its end; other files are kept.
fn remove_points(folder: &Path) -> Result<bool, Box<dyn Error>> {
    for entry in std::fs::read_dir(folder)?.flatten() {
        let name = entry.file_name();
        let number = name.to_str().and_then(|name| name.strip_prefix("point-"));
        if number.is_some_and(|number| number.parse::<usize>().is_ok()) {
            let path = entry.path();
            remove_earlier(&path)?;
            // Left if they hold other files.
            for folder in [path.join(fields::FOLDER), path] {
                let _ = std::fs::remove_dir(folder);
            }
        }
    }
    remove_earlier(folder)
}
