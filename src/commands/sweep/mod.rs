//! `bearing sweep SCENE --vary key=values`: one static solution a point, one table out.
//!
//! Points are solved in chunks of fixed size. Inside a chunk each solution starts from its
//! neighbour's, so the chunk is the unit that is repeated, never split: neither the number of
//! threads nor an interruption changes a bit of the table. A finished chunk is one line of the
//! journal, from which the same command resumes.

mod grid;
pub(super) mod housings;
mod journal;
mod point;
mod report;

use super::earlier::{Writes, claimed};
use super::{CommandResult, Outcome, interruption, reach, results_folder, say};
use bearing_dynamics::output::Column;
use bearing_dynamics::output::warnings::Warning;
use bearing_dynamics::scene::{Document, Subject, resolve_subject};
use grid::Grid;
use housings::Kept;
use indicatif::{ProgressBar, ProgressStyle};
use journal::{Chunk, Journal, PointsWarned, gather};
use rayon::prelude::*;
use std::error::Error;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// Points in a chunk: enough for warm starts to pay, few enough to lose little when interrupted.
const CHUNK: usize = 64;
/// The same with a housing, where a point takes a hundred times as long.
const HOUSED_CHUNK: usize = 16;
/// Where each point takes seconds, for a bushing's springs or the shapes of a shaft of tetrahedra: a signal waits for two at most, and
/// threads have something to share.
const SLOW_CHUNK: usize = 2;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json)
    scene: PathBuf,
    /// key=a,b,c or "key=low .. high / count"; repeat it for a grid, the last key varies fastest.
    /// Without it the scene's [sweep] table counts
    #[arg(long = "vary", value_name = "KEY=VALUES")]
    vary: Vec<String>,
    /// Results folder [default: results/<name of the scene>-sweep]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Number of threads [default: all cores]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Start every point cold instead of from its neighbour
    #[arg(long)]
    cold: bool,
    /// Discard an unfinished sweep in the results folder
    #[arg(long)]
    fresh: bool,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let start = Instant::now();
    let interrupted = interruption(|| {})?;
    let document = Document::read_file(&arguments.scene)?;
    let grid = Grid::new(&document, &arguments.vary)?;
    for axis in &grid.axes {
        if let Some(note) = reach(&document, "--vary", &axis.key, &axis.key)? {
            say(&format!("note: {note}\n"))?;
        }
    }
    // A scene that cannot be solved at all is said before anything is written.
    grid.check(&document)?;
    let folder = claimed(&sweep_folder(arguments), Writes::Sweep)?;
    let first = grid.scene(&document, 0);
    let meshes = first.as_ref().map_or(Ok(Vec::new()), housings::mesh_files)?;
    let mesh: Vec<u8> = meshes.into_iter().flat_map(|(_, content)| content).collect();
    // All points agree on what the scene is of.
    let whole = || match resolve_subject(&document) {
        Ok(Subject::Assembly(scene)) => Some(*scene),
        _ => None,
    };
    let subject = first.as_ref().ok().cloned().or_else(whole);
    let columns = point::columns(&grid, subject.as_ref());
    let housed = subject.as_ref().is_some_and(|scene| scene.housing_method().is_some());
    let bushings = grid.axes.iter().any(|axis| axis.key.contains(".bushing."));
    let mut bodies = subject.iter().flat_map(|scene| &scene.bodies);
    let meshed = bodies.any(|body| body.beam.as_ref().is_some_and(|of| of.beam.mesh.is_some()));
    let size = match (bushings || meshed, housed) {
        (true, _) => SLOW_CHUNK,
        (false, true) => HOUSED_CHUNK,
        (false, false) => CHUNK,
    };
    let fingerprint = grid.fingerprint(&document, &mesh, arguments.cold);
    let points = |index| grid.chunk_range(index, size).len();
    let journal = Journal::open(&folder, &fingerprint, grid.chunks(size), points, arguments.fresh)?;
    let resumed = journal.finished();
    report::remove_earlier(&folder)?;

    let progress = progress_bar(&grid, resumed);
    let threads = arguments.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let missing = journal.missing();
    let failed: Result<(), Box<dyn Error + Send + Sync>> = pool.install(|| {
        missing.par_iter().try_for_each(|&index| {
            if interrupted.load(Ordering::Relaxed) {
                return Ok(());
            }
            let range = grid.chunk_range(index, size);
            let points = range.len() as u64;
            let chunk = solve_chunk((&document, &grid, &columns), (index, range), arguments.cold);
            progress.inc(points);
            journal.append(chunk)?;
            Ok(())
        })
    });
    failed.map_err(|error| error as Box<dyn Error>)?;
    progress.finish_and_clear();

    let chunks = journal.chunks();
    let done: usize = chunks.iter().map(|chunk| chunk.rows.len() + chunk.failures.len()).sum();
    let record = report::Record {
        threads: pool.current_num_threads(),
        seconds: start.elapsed().as_secs_f64(),
        complete: done == grid.len(),
        columns,
    };
    report::write(&folder, &document, &grid, &chunks, &record)?;
    if !record.complete {
        return Err(format!(
            "interrupted after {done} of {} points, kept in {}; the same command resumes",
            grid.len(),
            folder.display()
        )
        .into());
    }
    journal.remove()?;
    let reused = resumed.min(grid.len());
    let note = if reused > 0 { format!(" ({reused} resumed)") } else { String::new() };
    say(&format!(
        "{} points{note} in {:.2} s on {} thread{}: {}\n",
        grid.len(),
        record.seconds,
        record.threads,
        if record.threads == 1 { "" } else { "s" },
        folder.join("sweep.csv").display()
    ))?;
    if first.is_ok_and(|first| first.run().is_some()) {
        say("the statics of this scene at each point, at t = 0; its run is not swept\n")?;
    }
    for key in report::idle_keys(&grid, &record.columns, &chunks) {
        say(&format!(
            "note: {key} changes no column: points that differ in it alone are the same\n"
        ))?;
    }
    for PointsWarned { code, text, point, points } in report::warnings(&chunks) {
        let all = grid.len();
        say(&format!("warning[{code}]: {text} (point {point}, {points} of {all} in all)\n"))?;
    }
    let failures: Vec<_> = chunks.iter().flat_map(|chunk| &chunk.failures).collect();
    match failures.first() {
        None => Ok(Outcome::Done),
        Some(first) => Err(format!(
            "{} of {} points have no solution (listed in {}), the first is point {}: {}",
            failures.len(),
            grid.len(),
            folder.join("sweep.json").display(),
            first.point,
            first.message
        )
        .into()),
    }
}

/// Apart from the folder of a single solution, so that each holds one kind of results.
fn sweep_folder(arguments: &Arguments) -> PathBuf {
    results_folder(&arguments.scene, "sweep", &arguments.out)
}

fn progress_bar(grid: &Grid, resumed: usize) -> ProgressBar {
    // Hidden by itself when standard error is not a terminal.
    let bar = ProgressBar::new(grid.len() as u64);
    if let Ok(style) =
        ProgressStyle::with_template("{bar:40} {pos}/{len} points, {per_sec}, {eta} left")
    {
        bar.set_style(style);
    }
    bar.set_position(resumed as u64);
    bar
}

fn solve_chunk(
    (document, grid, header): (&Document, &Grid, &[Column]),
    (index, range): (usize, Range<usize>),
    cold: bool,
) -> Chunk {
    let mut chunk = Chunk { index, rows: Vec::new(), failures: Vec::new(), warnings: Vec::new() };
    let (mut neighbour, mut kept) = (None, Kept::default());
    for point in range {
        match point::solve(document, grid, (point, header), neighbour.as_deref(), &mut kept) {
            Ok(solved) => {
                chunk.rows.push(solved.row);
                let warned = solved.warnings.into_iter().map(|Warning { code, text }| {
                    PointsWarned { code: code.name().into(), text, point, points: 1 }
                });
                let mut here = Vec::new();
                gather(&mut here, warned);
                // Two bodies may have one code each: it is one point.
                let once = here.into_iter().map(|warned| PointsWarned { points: 1, ..warned });
                gather(&mut chunk.warnings, once);
                neighbour = if cold { None } else { solved.start_for_neighbour };
            }
            Err(message) => {
                chunk.failures.push(journal::Failure { point, message });
                neighbour = None;
            }
        }
    }
    chunk
}
