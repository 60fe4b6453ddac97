//! `state.json`: all a run needs to go on with the same bits; its rows so far are in `series.npy`.
//!
//! Numbers are written as the shortest decimal that reads back to the same bits. The series is
//! written before the state, so that it never has fewer rows than the state speaks of; it may
//! have more, and those are computed again.

use crate::output::atomic::WriteError;
use crate::output::dynamics::session::{RunRequest, Session, SessionError};
use crate::output::journal::{self, JournalError};
use crate::output::series::{Series, SeriesError};
use crate::solver::channels::ChannelGroup;
use crate::solver::clock::rounded;
use crate::solver::dynamics::checkpoint::Checkpoint;
use crate::solver::dynamics::contacts::Work;
use crate::solver::dynamics::control::Memory;
use crate::solver::dynamics::energy::Energy;
use crate::solver::dynamics::extremes::Extremes;
use crate::solver::dynamics::model::DynamicProblem;
use crate::solver::dynamics::run::{ContactTurnover, Stepping};
use crate::solver::dynamics::stability::{Cause, StepLimit};
use crate::solver::dynamics::step_watch::{Shortened, StepWatch, Stiffness};
use nalgebra::Complex;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use thiserror::Error;

pub use crate::output::journal::{SERIES, STATE, Stopped};

/// Content of `state.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateFile {
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
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub limit: Option<LimitEntry>,
    pub step_watch: StepWatchEntry,
    /// See [`Extremes::to_numbers`].
    pub extremes: Vec<f64>,
    /// When the run was to end, and the time between rows that it was asked for, s.
    pub end: f64,
    pub output_interval: f64,
    /// Zero with error control: rows then are `output_interval` apart.
    pub steps_per_row: u64,
    pub rows: usize,
    /// Wall time so far, s.
    pub seconds: f64,
    pub state: Vec<f64>,
    pub damping: Vec<f64>,
    pub was_loaded: Vec<bool>,
    /// Kinetic, contact, cage contact, gravity, foundation, ball contact, J.
    pub first_energy: [f64; 6],
    pub largest_contact_energy: f64,
    /// See [`ContactTurnover`]: sum and last, J.
    pub contact_turnover: [f64; 2],
    /// Evaluations, distance tests, loaded contacts, slices, pocket tests, guide tests,
    /// ball tests, factorisations, rejected steps.
    pub work: [u64; 9],
    /// With error control: largest overlap (m), error of the step before, smallest and largest
    /// step (s).
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub control: Option<[f64; 4]>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimitEntry {
    pub step: f64,
    /// Real and imaginary part, 1/s.
    pub eigenvalue: [f64; 2],
    /// As in [`Cause::name`].
    pub cause: String,
}

/// See [`StepWatch`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepWatchEntry {
    pub judged: u64,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub smallest: Option<f64>,
    /// Oscillation, 1/s²; decay, 1/s.
    pub stiffest: [f64; 2],
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub exceeded: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub shortened: Option<ShortenedEntry>,
}

/// See [`Shortened`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShortenedEntry {
    pub times: u64,
    pub from: f64,
    pub last: f64,
}

#[derive(Debug, Error)]
pub enum StateError {
    #[error(
        "{} belongs to another scene: only end, plots and window may change from one part of a run \
         to the next; choose another --out, or start anew (--fresh)",
        path.display()
    )]
    Scene { path: PathBuf },
    #[error("the rows beside {} are {kept} s apart, the scene now asks for {asked} s", path.display())]
    Interval { path: PathBuf, kept: f64, asked: f64 },
    #[error("{} holds a damaged state: {what}", path.display())]
    Damaged { path: PathBuf, what: &'static str },
    #[error("{} has no rows that fit the state beside it", path.display())]
    Rows { path: PathBuf },
    #[error("the run has already come to {} s, past its new end of {end} s", rounded(*time))]
    Past { time: f64, end: f64 },
    #[error("{what} is {value}; only finite numbers are kept in a state")]
    NotFinite { what: &'static str, value: f64 },
    #[error(transparent)]
    Journal(#[from] JournalError),
    #[error(transparent)]
    Series(#[from] SeriesError),
    #[error(transparent)]
    Session(#[from] SessionError),
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Sha256 of what decides every bit of a run but its length: the problem, how it is stepped, what
/// is recorded, and the version. The end is not in it, so that a run can be extended, nor the
/// output interval, which is compared by itself.
pub fn fingerprint(problem: &DynamicProblem, request: &RunRequest) -> String {
    // Debug text has every field, and the shortest decimals that tell two numbers apart.
    let RunRequest { options, channels, .. } = request;
    let groups: Vec<&str> =
        ChannelGroup::ALL.into_iter().filter(|g| channels.contains(g)).map(|g| g.name()).collect();
    let text = format!("{} {problem:?} {options:?} {groups:?}", env!("CARGO_PKG_VERSION"));
    journal::hexadecimal(Sha256::new_with_prefix(text))
}

/// Why a state is written, and what the session does not know.
#[derive(Clone, Debug)]
pub struct StateRecord {
    pub fingerprint: String,
    pub stopped: Stopped,
    pub error: Option<String>,
    /// As asked for, s.
    pub output_interval: f64,
    pub seconds: f64,
}

/// Writes `series.npy` and `state.json` of a session into its results folder.
///
/// # Errors
/// A number that is not finite (the state there stays), a file that cannot be written.
pub fn save(folder: &Path, session: &Session, record: &StateRecord) -> Result<(), StateError> {
    let (checkpoint, rows) = session.resumable();
    let span = (session.clock.end, session.clock.steps_per_row);
    let file = state_file(&checkpoint, rows, span, record);
    check_finite(&file)?;
    session.recorder.series(session.recorder.rows())?.write_npy(&folder.join(SERIES))?;
    Ok(journal::write(folder, &file)?)
}

/// Reads `state.json` of a results folder; `None` if there is none.
///
/// # Errors
/// A file that cannot be read or is no state.
pub fn read(folder: &Path) -> Result<Option<StateFile>, StateError> {
    Ok(journal::read(folder)?)
}

/// The session that goes on where `file`, read from `folder`, was written.
///
/// # Errors
/// A state of another version or scene, one that is damaged or lacks its rows, an end that has
/// already passed.
pub fn resume(
    folder: &Path,
    file: &StateFile,
    problem: DynamicProblem,
    request: &RunRequest,
) -> Result<Session, StateError> {
    let path = folder.join(STATE);
    journal::check_version(folder, &file.version)?;
    if file.fingerprint != fingerprint(&problem, request) {
        return Err(StateError::Scene { path });
    }
    if !request.accepts_interval(file.output_interval, file.end) {
        let (kept, asked) = (file.output_interval, request.output_interval);
        return Err(StateError::Interval { path, kept, asked });
    }
    check_finite(file)?;
    let checkpoint = checkpoint(file);
    let damaged = |what| StateError::Damaged { path: path.clone(), what };
    if file.limit.as_ref().is_some_and(|limit| cause(&limit.cause).is_none()) {
        return Err(damaged("its step limit has a cause that is not known"));
    }
    if !checkpoint.fits(&problem) {
        return Err(damaged("its lists have other lengths than the bearing asks for"));
    }
    if Extremes::from_numbers(&file.extremes).is_none() {
        return Err(damaged("its extremes are not as many as a bearing has"));
    }
    let by_time = file.control.is_some();
    if by_time != matches!(request.options.stepping, Stepping::Accuracy(_)) {
        return Err(damaged("error control without its sizes, or sizes without it"));
    }
    if (file.steps_per_row == 0) != by_time || file.step_size <= 0.0 {
        return Err(damaged("no step from one row to the next"));
    }
    // Written as it is so that an end that is not a number is refused as well.
    let ahead = request.end > file.time;
    if !ahead {
        return Err(StateError::Past { time: file.time, end: request.end });
    }
    let kept = RunRequest { output_interval: file.output_interval, ..request.clone() };
    let mut session = Session::from_checkpoint(problem, &kept, &checkpoint, file.steps_per_row)?;
    let series_path = folder.join(SERIES);
    let series = Series::read_npy(&series_path)?;
    if !session.restore_rows(&series, file.rows) {
        return Err(StateError::Rows { path: series_path });
    }
    Ok(session)
}

/// A checkpoint as it is written; `span` is the end of the run (s) and the steps of a row.
pub(crate) fn state_file(
    checkpoint: &Checkpoint,
    rows: usize,
    span: (f64, u64),
    record: &StateRecord,
) -> StateFile {
    let energy = &checkpoint.first_energy;
    let work = &checkpoint.work;
    let watch = &checkpoint.step_watch;
    StateFile {
        program: "bearing-dynamics".into(),
        version: env!("CARGO_PKG_VERSION").into(),
        fingerprint: record.fingerprint.clone(),
        stopped: record.stopped,
        error: record.error.clone(),
        time: checkpoint.time,
        steps: checkpoint.steps,
        step_size: checkpoint.step_size,
        limit: checkpoint.limit.map(|limit| LimitEntry {
            step: limit.step,
            eigenvalue: [limit.eigenvalue.re, limit.eigenvalue.im],
            cause: limit.cause.name().into(),
        }),
        step_watch: StepWatchEntry {
            judged: watch.judged,
            smallest: watch.smallest,
            stiffest: [watch.stiffest.oscillation, watch.stiffest.decay],
            exceeded: watch.exceeded,
            shortened: watch.shortened.map(|Shortened { times, from, last }| ShortenedEntry {
                times,
                from,
                last,
            }),
        },
        extremes: checkpoint.extremes.to_numbers(),
        end: span.0,
        output_interval: record.output_interval,
        steps_per_row: span.1,
        rows,
        seconds: record.seconds,
        state: checkpoint.state.clone(),
        damping: checkpoint.damping.clone(),
        was_loaded: checkpoint.was_loaded.clone(),
        first_energy: [
            energy.kinetic,
            energy.contact,
            energy.cage_contact,
            energy.gravity,
            energy.foundation,
            energy.ball_contact,
        ],
        largest_contact_energy: checkpoint.largest_contact_energy,
        contact_turnover: [checkpoint.contact_turnover.sum, checkpoint.contact_turnover.last],
        work: [
            work.evaluations,
            work.distance_tests,
            work.loaded_contacts,
            work.slices,
            work.pocket_tests,
            work.guide_tests,
            work.ball_tests,
            work.factorisations,
            work.rejected_steps,
        ],
        control: checkpoint.control.map(|memory| {
            [memory.displacement, memory.previous_error, memory.smallest, memory.largest]
        }),
    }
}

fn cause(name: &str) -> Option<Cause> {
    Cause::ALL.into_iter().find(|cause| cause.name() == name)
}

pub(crate) fn checkpoint(file: &StateFile) -> Checkpoint {
    let [oscillation, decay] = file.step_watch.stiffest;
    let [kinetic, contact, cage_contact, gravity, foundation, ball_contact] = file.first_energy;
    let [
        evaluations,
        distance_tests,
        loaded_contacts,
        slices,
        pocket_tests,
        guide_tests,
        ball_tests,
        factorisations,
        rejected_steps,
    ] = file.work;
    Checkpoint {
        time: file.time,
        steps: file.steps,
        step_size: file.step_size,
        limit: file.limit.as_ref().and_then(|limit| {
            Some(StepLimit {
                step: limit.step,
                eigenvalue: Complex::new(limit.eigenvalue[0], limit.eigenvalue[1]),
                cause: cause(&limit.cause)?,
            })
        }),
        step_watch: StepWatch {
            judged: file.step_watch.judged,
            smallest: file.step_watch.smallest,
            stiffest: Stiffness { oscillation, decay },
            exceeded: file.step_watch.exceeded,
            shortened: file
                .step_watch
                .shortened
                .map(|ShortenedEntry { times, from, last }| Shortened { times, from, last }),
        },
        extremes: Extremes::from_numbers(&file.extremes).unwrap_or_default(),
        state: file.state.clone(),
        damping: file.damping.clone(),
        was_loaded: file.was_loaded.clone(),
        first_energy: Energy { kinetic, contact, cage_contact, gravity, foundation, ball_contact },
        largest_contact_energy: file.largest_contact_energy,
        contact_turnover: ContactTurnover {
            sum: file.contact_turnover[0],
            last: file.contact_turnover[1],
        },
        work: Work {
            evaluations,
            distance_tests,
            loaded_contacts,
            slices,
            pocket_tests,
            guide_tests,
            ball_tests,
            factorisations,
            rejected_steps,
        },
        control: file.control.map(|[displacement, previous_error, smallest, largest]| Memory {
            displacement,
            previous_error,
            smallest,
            largest,
        }),
    }
}

/// JSON has no way to write NaN and infinity.
pub(crate) fn check_finite(file: &StateFile) -> Result<(), StateError> {
    let limit = file.limit.iter().flat_map(|l| [l.step, l.eigenvalue[0], l.eigenvalue[1]]);
    let single = [file.time, file.step_size, file.seconds, file.end, file.output_interval];
    let watch = &file.step_watch;
    let watched = watch.stiffest.into_iter().chain(watch.smallest);
    let shortened = watch.shortened.into_iter().flat_map(|s| [s.from, s.last]);
    let limit = limit.chain(watched).chain(watch.exceeded.into_iter().flatten()).chain(shortened);
    let parts: [(&'static str, Vec<f64>); 6] = [
        ("an extreme", file.extremes.clone()),
        ("a size of the error control", file.control.into_iter().flatten().collect()),
        (
            "time, step or energy",
            single
                .into_iter()
                .chain(file.first_energy)
                .chain([file.largest_contact_energy])
                .chain(file.contact_turnover)
                .collect(),
        ),
        ("a step limit", limit.collect()),
        ("an entry of the state", file.state.clone()),
        ("a damping factor", file.damping.clone()),
    ];
    for (what, values) in parts {
        if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
            return Err(StateError::NotFinite { what, value });
        }
    }
    Ok(())
}
