//! `bearing sweep SCENE --vary key=values`: one equilibrium or run for each point of a grid, one table for all.
//!
//! Each point is solved as `bearing statics` solves its scene. Neither the number of threads nor an interruption changes a
//! bit of the table.

mod grid;
pub(super) mod housings;
mod point;
mod report;
mod runs;
mod shard;
mod table;

use super::earlier::{Writes, claimed};
use super::{Changes, CommandResult, Outcome, interruption, print, reach, results_folder};
use bearing_dynamics::output::Column;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::{Document, Subject, resolve_subject};
use grid::Grid;
use housings::Kept;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use shard::Shard;
use std::error::Error;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use table::Table;

/// Points that one thread solves before they are written.
const BLOCK: usize = 16;
/// The same if points take seconds and share nothing: with springs fitted to a bushing, or modes of a shaft of tetrahedra.
const SLOW_BLOCK: usize = 2;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json)
    scene: PathBuf,
    /// key=a,b,c or "key=low .. high / count"; repeat it for a grid, the last key varies fastest.
    /// Without it the scene's [sweep] table counts
    #[arg(long = "vary", value_name = "KEY=VALUES")]
    vary: Vec<String>,
    /// What to compute at each point: equilibria, or runs in folders of their own [default: sweep.of of the scene]
    #[arg(long, value_enum)]
    of: Option<Of>,
    #[command(flatten)]
    changes: Changes,
    /// Results folder [default: results/<name of the scene>-sweep]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Number of threads [default: all cores]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Vary all keys together, value by value, instead of every combination
    #[arg(long)]
    together: bool,
    /// Solve one part of the points, in a folder of its own: i/n with i from 0 [default: the task of a Slurm array]
    #[arg(long, value_name = "I/N")]
    shard: Option<String>,
    /// Join the shards in the results folder to the table of the whole sweep
    #[arg(long, conflicts_with = "shard")]
    merge: bool,
    /// Discard an unfinished sweep in the results folder
    #[arg(long)]
    fresh: bool,
}

impl Arguments {
    /// The part of the points that is solved; the whole to merge its parts.
    fn shard(&self) -> Result<Shard, Box<dyn Error>> {
        if self.merge { Ok(Shard::WHOLE) } else { Shard::of(self.shard.as_deref()) }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Of {
    Statics,
    Runs,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let start = Instant::now();
    let interrupted = interruption(|| {})?;
    let document = arguments.changes.read(&arguments.scene)?;
    let grid = Grid::new(&document, &arguments.vary, arguments.together)?;
    for axis in &grid.axes {
        if let Some(note) = reach(&document, "--vary", &axis.key, &axis.key)? {
            print(&format!("note: {note}\n"))?;
        }
    }
    let by_scene = if document.sweeps_runs() { Of::Runs } else { Of::Statics };
    if arguments.of.unwrap_or(by_scene) == Of::Runs {
        return runs::run(arguments, &document, &grid, &interrupted);
    }
    // A scene that cannot be solved at all is said before anything is written.
    grid.check(&document)?;
    let shard = arguments.shard()?;
    let folder = claimed(&shard.folder(&sweep_folder(arguments)), Writes::Sweep)?;
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
    let block = block_size(&grid, subject.as_ref());
    let hash = grid.hash(&document, &mesh);
    let table = if arguments.merge {
        let shards = shard::all_of(&folder, "statics", &hash)?;
        Table::merged(&folder, &grid, columns, &shards)?
    } else {
        Table::open(&folder, (&document, &grid, &hash), columns, arguments.fresh)?
    };
    let points = shard.len(&grid, block);
    let all = shard.blocks(&grid, block).filter(|_| !arguments.merge);
    let blocks: Vec<_> = all.filter(|points| !table.has_all(points)).collect();
    let open: usize = blocks.iter().map(Range::len).sum();
    let resumed = if arguments.merge { 0 } else { points - open };

    let progress = progress_bar(points, resumed);
    let threads = arguments.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let header = table.columns.clone();
    let table = Mutex::new(table);
    let solved: Result<(), Box<dyn Error + Send + Sync>> = pool.install(|| {
        blocks.into_par_iter().try_for_each(|points| {
            if interrupted.load(Ordering::Relaxed) {
                return Ok(());
            }
            let count = points.len() as u64;
            let (rows, failures) = solve_block(&document, &grid, &header, points);
            progress.inc(count);
            table.lock().unwrap_or_else(PoisonError::into_inner).append(rows, failures)
        })
    });
    solved.map_err(|error| error as Box<dyn Error>)?;
    progress.finish_and_clear();

    let table = table.into_inner().unwrap_or_else(PoisonError::into_inner);
    let (threads, seconds) = (pool.current_num_threads(), start.elapsed().as_secs_f64());
    report::write(&folder, (&document, &grid, &hash), &table, (points, threads, seconds))?;
    if table.done() < points {
        return Err(format!(
            "interrupted after {} of {points} points, kept in {}; the same command resumes",
            table.done(),
            folder.display()
        )
        .into());
    }
    let note = match (arguments.merge, resumed) {
        (true, _) => " (merged)".to_string(),
        (false, 0) => String::new(),
        (false, resumed) => format!(" ({resumed} resumed)"),
    };
    print(&format!(
        "{points} points{note} in {seconds:.2} s on {threads} thread{}: {}\n",
        if threads == 1 { "" } else { "s" },
        folder.join("sweep.csv").display()
    ))?;
    if first.is_ok_and(|first| first.run().is_some()) {
        print("the statics of this scene at each point, at t = 0; --of runs sweeps its run\n")?;
    }
    for warned in report::warnings(&table) {
        let (name, title, points) = (warned.entry.name, warned.entry.title, warned.points);
        print(&format!(
            "warning[{name}]: {title} ({points} of {} points, the first is point {})\n",
            table.done(),
            warned.point
        ))?;
    }
    match table.failures.iter().next() {
        None => Ok(Outcome::Done),
        Some((point, message)) => Err(format!(
            "{} of {points} points have no solution (listed in {}), the first is point {point}: {message}",
            table.failures.len(),
            folder.join("sweep.json").display()
        )
        .into()),
    }
}

fn block_size(grid: &Grid, scene: Option<&AssemblyScene>) -> usize {
    let bushings = grid.axes.iter().any(|axis| axis.key.contains(".bushing."));
    let mut bodies = scene.iter().flat_map(|scene| &scene.bodies);
    let meshed = bodies.any(|body| body.beam.as_ref().is_some_and(|of| of.beam.mesh.is_some()));
    if bushings || meshed { SLOW_BLOCK } else { BLOCK }
}

/// Apart from the folder of a single solution, so that each holds one kind of results.
fn sweep_folder(arguments: &Arguments) -> PathBuf {
    results_folder(&arguments.scene, "sweep", &arguments.out)
}

fn progress_bar(points: usize, resumed: usize) -> ProgressBar {
    // Hidden by itself when standard error is not a terminal.
    let bar = ProgressBar::new(points as u64);
    if let Ok(style) =
        ProgressStyle::with_template("{bar:40} {pos}/{len} points, {per_sec}, {eta} left")
    {
        bar.set_style(style);
    }
    bar.set_position(resumed as u64);
    bar
}

/// Rows of solved points, and messages of points without a solution.
type Solved = (Vec<Vec<f64>>, Vec<(usize, String)>);

fn solve_block(
    document: &Document,
    grid: &Grid,
    header: &[Column],
    points: Range<usize>,
) -> Solved {
    let (mut rows, mut failures) = (Vec::new(), Vec::new());
    let mut kept = Kept::default();
    for point in points {
        match point::solve(document, grid, (point, header), &mut kept) {
            Ok(row) => rows.push(row),
            Err(message) => failures.push((point, message)),
        }
    }
    (rows, failures)
}
