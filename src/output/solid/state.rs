//! The state of a solid's run: `state.json`, with the nodes' numbers in `state-N.npy` beside it
//! (N the number of steps) and the rows so far in `series.npy`.
//!
//! The arrays are written before `state.json` names them and the older ones are removed after, so
//! that whatever moment a run is killed at, there is one whole state.

use crate::output::atomic::{WriteError, remove_partials, write_atomic};
use crate::output::journal::{self, JournalError, SERIES, STATE, Stopped};
use crate::output::series::{Series, SeriesError};
use crate::output::solid::fields::FOLDER;
use crate::output::solid::session::{Grid, Kept, SolidRunError, SolidSession, Sound};
use crate::scene::solid::SolidRun;
use crate::scene::solid_problem::SolidSetup;
use crate::solver::clock::rounded;
use crate::solver::solid::checkpoint::SolidCheckpoint;
use crate::solver::solid::explicit::SolidWork;
use crate::solver::solid::step_limit::SolidStepLimit;
use ndarray::Array2;
use ndarray_npy::WriteNpyExt;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Numbers kept for each node.
const WIDTH: usize = 8;

/// Content of `state.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidStateFile {
    pub program: String,
    pub version: String,
    /// See [`fingerprint`].
    pub fingerprint: String,
    pub stopped: Stopped,
    /// What ended a failed run.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub error: Option<String>,
    /// s.
    pub time: f64,
    pub steps: u64,
    pub step_size: f64,
    pub end: f64,
    /// As asked for, s.
    pub output_interval: f64,
    pub fields_interval: f64,
    pub steps_per_row: u64,
    pub rows_per_fields: u64,
    pub rows: usize,
    /// Wall time so far, s.
    pub seconds: f64,
    /// File with one row a node: displacement (m), rate (m/s), work of loads and of damping (J).
    pub arrays: String,
    pub limit: LimitEntry,
    /// J.
    pub first_balance: f64,
    pub turned_over: f64,
    pub largest_residual: f64,
    /// Rows on end whose ledger did not close.
    pub rows_open: u32,
    /// Force evaluations and elements in them.
    pub work: [u64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimitEntry {
    pub step: f64,
    pub frequency: f64,
    pub is_bound: bool,
    pub element: usize,
    pub element_frequency: f64,
    pub at: [f64; 3],
    pub products: usize,
}

impl LimitEntry {
    pub(crate) fn of(limit: &SolidStepLimit) -> LimitEntry {
        LimitEntry {
            step: limit.step,
            frequency: limit.frequency,
            is_bound: limit.is_bound,
            element: limit.element,
            element_frequency: limit.element_frequency,
            at: limit.at,
            products: limit.products,
        }
    }

    pub(crate) fn to_limit(self) -> SolidStepLimit {
        SolidStepLimit {
            step: self.step,
            frequency: self.frequency,
            is_bound: self.is_bound,
            element: self.element,
            element_frequency: self.element_frequency,
            at: self.at,
            products: self.products,
        }
    }
}

#[derive(Debug, Error)]
pub enum SolidStateError {
    #[error(
        "{} belongs to another scene or mesh: only end and plots may change from one part of a run \
         to the next; choose another --out, or start anew (--fresh)",
        path.display()
    )]
    Scene { path: PathBuf },
    #[error(
        "the {what} beside {} are {kept} s apart, the scene now asks for {asked} s", path.display()
    )]
    Interval { path: PathBuf, what: &'static str, kept: f64, asked: f64 },
    #[error("{} holds a damaged state: {what}", path.display())]
    Damaged { path: PathBuf, what: &'static str },
    #[error("the run has already come to {} s, past its new end of {end} s", rounded(*time))]
    Past { time: f64, end: f64 },
    #[error("cannot encode {}: {source}", path.display())]
    Encode { path: PathBuf, source: ndarray_npy::WriteNpyError },
    #[error(transparent)]
    Journal(#[from] JournalError),
    #[error(transparent)]
    Series(#[from] SeriesError),
    #[error(transparent)]
    Run(#[from] SolidRunError),
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Sha256 of what decides every bit of a run but its length: mesh, material, supports, loads,
/// start, method, step, what is recorded, and the version.
pub fn fingerprint(setup: &SolidSetup, run: &SolidRun) -> String {
    let mut hash = Sha256::new();
    let problem = &setup.problem;
    for value in problem.nodes.iter().chain(&setup.velocity).flatten() {
        hash.update(value.to_bits().to_le_bytes());
    }
    for node in problem.elements.all_nodes() {
        hash.update(node.to_le_bytes());
    }
    // Debug text has every field, and the shortest decimals that tell two numbers apart.
    let laws = (problem.material, problem.density, problem.damping, problem.damped_motion);
    let steps = (run.method, run.stepping, problem.gravity);
    hash.update(format!("{} {laws:?} {steps:?}", env!("CARGO_PKG_VERSION")));
    hash.update(format!("{:?} {:?}", problem.prescribed, problem.loads));
    hash.update(format!("{:?} {:?}", setup.probes, setup.supports));
    journal::hexadecimal(hash)
}

/// Why a state is written, and what the session does not know.
#[derive(Clone, Debug)]
pub struct SolidStateRecord {
    pub fingerprint: String,
    pub stopped: Stopped,
    pub error: Option<String>,
    /// As asked for, s.
    pub end: f64,
    pub output_interval: f64,
    pub fields_interval: f64,
    pub seconds: f64,
}

/// Writes `series.npy`, the arrays and `state.json` of a session into its results folder.
///
/// # Errors
/// A number that is not finite (the state there stays), a file that cannot be written.
pub fn save(
    folder: &Path,
    session: &SolidSession,
    record: &SolidStateRecord,
) -> Result<(), SolidStateError> {
    let sound = session.resumable();
    let checkpoint = &sound.checkpoint;
    let file = state_file(&sound, session, record);
    session.series()?.write_npy(&folder.join(SERIES))?;
    write_arrays(&folder.join(&file.arrays), checkpoint)?;
    journal::write(folder, &file)?;
    remove_partials(&folder.join(FOLDER));
    remove_arrays(folder, &file.arrays);
    Ok(())
}

/// Writes a checkpoint's nodes, one row each.
pub(crate) fn write_arrays(
    path: &Path,
    checkpoint: &SolidCheckpoint,
) -> Result<(), SolidStateError> {
    let mut values = Vec::with_capacity(WIDTH * checkpoint.rate.len());
    for (n, (u, v)) in checkpoint.displacement.iter().zip(&checkpoint.rate).enumerate() {
        values.extend([u[0], u[1], u[2], v[0], v[1], v[2]]);
        values.extend([checkpoint.external_work[n], checkpoint.damping_work[n]]);
    }
    if !values.iter().all(|value| value.is_finite()) {
        let path = path.to_path_buf();
        return Err(SolidStateError::Damaged { path, what: "a value that is not finite" });
    }
    let table = Array2::from_shape_vec((checkpoint.rate.len(), WIDTH), values)
        .expect("eight numbers for each node");
    let mut bytes = Vec::new();
    table
        .write_npy(&mut bytes)
        .map_err(|source| SolidStateError::Encode { path: path.to_path_buf(), source })?;
    Ok(write_atomic(path, &bytes)?)
}

/// Reads what [`write_arrays`] wrote for so many nodes; `file` is named in `folder`. Time, steps and
/// work stay zero.
pub(crate) fn read_arrays(
    folder: &Path,
    file: &str,
    nodes: usize,
) -> Result<SolidCheckpoint, SolidStateError> {
    let damaged = |what| SolidStateError::Damaged { path: folder.join(STATE), what };
    if file.contains(['/', '\\']) {
        return Err(damaged("its arrays lie elsewhere"));
    }
    let arrays = Series::read_npy(&folder.join(file))?;
    if arrays.data().dim() != (nodes, WIDTH) {
        return Err(damaged("its arrays have another shape than the mesh asks for"));
    }
    arrays.check_finite()?;
    let part = |from: usize| {
        let row = |row: ndarray::ArrayView1<f64>| [row[from], row[from + 1], row[from + 2], 0.0];
        arrays.data().rows().into_iter().map(row).collect()
    };
    let column = |at: usize| arrays.data().column(at).to_vec();
    Ok(SolidCheckpoint {
        displacement: part(0),
        rate: part(3),
        external_work: column(6),
        damping_work: column(7),
        ..SolidCheckpoint::default()
    })
}

/// Removes arrays of states that are not `kept`. What cannot be removed stays: it harms nothing.
pub fn remove_arrays(folder: &Path, kept: &str) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with("state-") && name.ends_with(".npy") && name != kept {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Reads `state.json` of a results folder; `None` if there is none.
///
/// # Errors
/// A file that cannot be read or is no state of a solid.
pub fn read(folder: &Path) -> Result<Option<SolidStateFile>, SolidStateError> {
    Ok(journal::read(folder)?)
}

/// The session that goes on where `file`, read from `folder`, was written.
///
/// # Errors
/// A state of another version or scene, one that is damaged or lacks its rows, an end that has
/// already passed.
pub fn resume(
    folder: &Path,
    file: &SolidStateFile,
    setup: &SolidSetup,
    run: &SolidRun,
    threads: usize,
) -> Result<SolidSession, SolidStateError> {
    let path = folder.join(STATE);
    journal::check_version(folder, &file.version)?;
    if file.fingerprint != fingerprint(setup, run) {
        return Err(SolidStateError::Scene { path });
    }
    // Intervals that follow from the end stay what they were when the run is extended.
    for (what, given, kept, asked) in [
        ("rows", run.output_given, file.output_interval, run.output_interval),
        ("fields", run.fields_given, file.fields_interval, run.fields_interval),
    ] {
        if given && kept != asked {
            return Err(SolidStateError::Interval { path, what, kept, asked });
        }
    }
    let damaged = |what| SolidStateError::Damaged { path: path.clone(), what };
    let steps_forward = file.step_size > 0.0 && file.steps_per_row > 0 && file.rows_per_fields > 0;
    if !steps_forward {
        return Err(damaged("no step from one row to the next"));
    }
    let ahead = run.end > file.time - 0.5 * file.step_size;
    if !ahead {
        return Err(SolidStateError::Past { time: file.time, end: run.end });
    }
    let arrays = read_arrays(folder, &file.arrays, setup.problem.nodes.len())?;
    let series = Series::read_npy(&folder.join(SERIES))?;
    let grid = Grid {
        step_size: file.step_size,
        steps: 0,
        steps_per_row: file.steps_per_row,
        rows_per_fields: file.rows_per_fields,
    };
    let rows = grid.rows_until(file.steps);
    if series.data().nrows() < rows {
        return Err(damaged("it has fewer rows beside it than it speaks of"));
    }
    let kept = Kept {
        checkpoint: SolidCheckpoint {
            time: file.time,
            steps: file.steps,
            work: SolidWork { evaluations: file.work[0], elements: file.work[1] },
            ..arrays
        },
        grid,
        limit: file.limit.to_limit(),
        first_balance: file.first_balance,
        turned_over: file.turned_over,
        largest_residual: file.largest_residual,
        rows_open: file.rows_open,
        values: series.data().iter().copied().collect(),
    };
    let session = SolidSession::resume(setup, run, kept, threads)?;
    if session.columns() != series.columns() {
        return Err(damaged("the rows beside it have other columns"));
    }
    Ok(session)
}

fn state_file(sound: &Sound, session: &SolidSession, record: &SolidStateRecord) -> SolidStateFile {
    let checkpoint = &sound.checkpoint;
    SolidStateFile {
        program: "bearing-dynamics".into(),
        version: env!("CARGO_PKG_VERSION").into(),
        fingerprint: record.fingerprint.clone(),
        stopped: record.stopped,
        error: record.error.clone(),
        time: checkpoint.time,
        steps: checkpoint.steps,
        step_size: session.grid.step_size,
        end: record.end,
        output_interval: record.output_interval,
        fields_interval: record.fields_interval,
        steps_per_row: session.grid.steps_per_row,
        rows_per_fields: session.grid.rows_per_fields,
        rows: session.grid.rows_until(checkpoint.steps),
        seconds: record.seconds,
        arrays: format!("state-{}.npy", checkpoint.steps),
        limit: LimitEntry::of(&session.solid.limit),
        first_balance: session.first_balance,
        turned_over: sound.turned_over,
        largest_residual: sound.largest_residual,
        rows_open: sound.rows_open,
        work: [checkpoint.work.evaluations, checkpoint.work.elements],
    }
}
