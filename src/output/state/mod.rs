//! `state.json`: everything that a run needs to resume with the same bits, in one section per part. Long arrays
//! are in `state-N.npy` (N is the number of steps), the rows so far in `series.npy`.
//!
//! Numbers are written as the shortest decimal that reads back to the same bits. Series and arrays are
//! written before the state that names them, and older arrays are removed afterwards, so that one complete state exists
//! whenever a run is killed. The series may have more rows than the state; those are computed again.

pub mod arrays;
pub mod bearing_entry;
pub mod entries;
pub mod friction_entry;
pub mod rubber_entry;

pub use crate::output::journal::{SERIES, STATE, Stopped};

use crate::assembly::lists::Assembly;
use crate::equilibrium::quasi_static_sequence::QuasiStaticFit;
use crate::motion::coupled_checkpoint::SteppedCheckpoint;
use crate::motion::simulation::Stepping;
use crate::numeric::clock::{Clock, rounded};
use crate::output::atomic::{WriteError, remove_partials};
use crate::output::fields::FOLDER;
use crate::output::journal::{self, JournalError};
use crate::output::series::{Series, SeriesError};
use crate::output::session::{
    Checkpoint, LedgerWatch, Parts, RunRequest, Session, SessionError, Sound,
};
use crate::plan::channels::ChannelGroup;
use crate::plan::counts::StageCounts;
use crate::plan::{Stage, Subject};
use crate::solids::model::SolidProblem;
use arrays::{remove_arrays, write_arrays};
use bearing_entry::BearingEntry;
use entries::{ExchangeEntry, SequenceEntry, SolidEntry};
use rubber_entry::{RubberEntry, hash_bushing, hash_rubber};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Format version of `state.json`.
pub const FORM: u32 = 6;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateFile {
    pub program: String,
    pub version: String,
    /// Format version, see [`FORM`].
    pub form: u32,
    /// See [`fingerprint`].
    pub fingerprint: String,
    pub stopped: Stopped,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub error: Option<String>,
    /// s.
    pub time: f64,
    /// Number of steps of a bearing or a solid, of coupling steps, or of equilibria.
    pub steps: u64,
    pub rows: usize,
    /// End of the run, output interval and fields interval as requested, s.
    pub end: f64,
    pub output_interval: f64,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub fields_interval: Option<f64>,
    /// Time step, s; zero with error control, where rows are `output_interval` apart.
    pub step: f64,
    pub steps_per_row: u64,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub rows_per_fields: Option<u64>,
    /// Wall time so far, s.
    pub seconds: f64,
    /// Of runs with a solid: initial energy balance, energy exchanged, largest residual, J, and the number of consecutive rows
    /// whose balance did not close.
    pub ledger: ([f64; 3], u32),
    /// Number of executions of each stage: its name, the numbers of its subject, the count.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub stages: Vec<(String, [usize; 2], u64)>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub bearing: Option<Box<BearingEntry>>,
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub solids: Vec<SolidEntry>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub exchange: Option<ExchangeEntry>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub sequence: Option<SequenceEntry>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub rubber: Option<RubberEntry>,
}

#[derive(Debug, Error)]
pub enum StateError {
    #[error(
        "{} belongs to another scene or mesh: only end, plots and coupling_step may change when a run is resumed \
         (housing.fit_ramp defaults to a tenth of the end: write it explicitly); choose \
         another --out, or start again with --fresh",
        path.display()
    )]
    Scene { path: PathBuf },
    #[error(
        "the {what} in {} are {} s apart, but the scene asks for {} s; write the interval of the earlier run, or start \
         again with --fresh", path.display(), rounded(*kept), rounded(*asked)
    )]
    Interval { path: PathBuf, what: &'static str, kept: f64, asked: f64 },
    #[error("{} is damaged: {what}; start again with --fresh", path.display())]
    Damaged { path: PathBuf, what: &'static str },
    #[error("{} has no rows that match its state; start again with --fresh", path.display())]
    Rows { path: PathBuf },
    #[error("the run has already reached {} s, past its new end of {end} s; choose a later end, or start again with --fresh", rounded(*time))]
    Past { time: f64, end: f64 },
    #[error("{what} is {value}; a state can hold finite numbers only")]
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

/// Sha256 of everything that determines the bits of a run except its length: parts, time stepping, channels and version.
/// The end is excluded, so that a run can be extended, and so is the output interval, which is compared separately.
pub fn fingerprint(parts: &Parts, request: &RunRequest) -> String {
    // Debug text has every field, and the shortest decimals that distinguish two numbers.
    let channels = &request.channels;
    let groups: Vec<&str> =
        ChannelGroup::ALL.into_iter().filter(|g| channels.contains(g)).map(|g| g.name()).collect();
    let mut hash = Sha256::new_with_prefix(format!("{} {groups:?}", env!("CARGO_PKG_VERSION")));
    match parts {
        Parts::Bearing(assembly) => hash_bearing(&mut hash, assembly, request),
        Parts::Solid(parts) => {
            let setup = parts.setup;
            hash_solid(&mut hash, &setup.problem);
            for value in setup.velocity.iter().flatten() {
                hash.update(value.to_bits().to_le_bytes());
            }
            hash.update(format!("{:?} {:?}", parts.method, parts.stepping));
            hash.update(format!("{:?} {:?}", setup.probes, setup.supports));
        }
        Parts::Housed(parts) => {
            hash_bearing(&mut hash, &parts.assembly, request);
            for solid in &parts.solids {
                hash.update(format!("{:?}", solid.name));
                hash_solid(&mut hash, &solid.model.problem);
                if let Some(shaft) = &solid.shaft {
                    hash.update(format!("{shaft:?}"));
                }
                if let Some(cage) = &solid.cage {
                    hash.update(format!("{cage:?}"));
                }
            }
            // Keeps the fingerprint of frictionless bores independent of the friction field.
            let seats = format!("{:?}", parts.seats).replace(", friction: None", "");
            hash.update(format!("{seats} {:?}", parts.options));
            parts.bushings.iter().for_each(|bushing| hash_bushing(&mut hash, bushing));
        }
        Parts::QuasiStaticSequence(parts) => {
            parts.models.iter().for_each(|model| hash_solid(&mut hash, &model.problem));
            hash.update(format!("{:?}", parts.problem.assembly));
            for QuasiStaticFit { name, bearing, bore, penalty, axial, radius, damping: _ } in
                &parts.problem.seats
            {
                hash.update(format!("{name:?} {bearing} {penalty:?} {axial:?} {radius:?}"));
                hash.update(format!("{:?}", bore.reach));
            }
        }
        Parts::Rubber(parts) => hash_rubber(&mut hash, parts),
    }
    journal::hexadecimal(hash)
}

fn hash_bearing(hash: &mut Sha256, assembly: &Assembly, request: &RunRequest) {
    hash.update(format!("{assembly:?} {:?}", request.options));
}

fn hash_solid(hash: &mut Sha256, solid: &SolidProblem) {
    for value in solid.nodes.iter().flatten() {
        hash.update(value.to_bits().to_le_bytes());
    }
    for node in solid.elements.all_nodes() {
        hash.update(node.to_le_bytes());
    }
    let laws = (solid.material, solid.density, solid.damping, solid.damped_motion, solid.gravity);
    hash.update(format!("{laws:?} {:?} {:?}", solid.prescribed, solid.loads));
}

/// Data of a state that the session does not have.
#[derive(Clone, Debug)]
pub struct StateRecord {
    pub fingerprint: String,
    pub stopped: Stopped,
    pub error: Option<String>,
    pub seconds: f64,
}

/// Writes `series.npy`, arrays and `state.json` of a session into its results folder.
///
/// # Errors
/// A number that is not finite (the existing state is kept), a file that cannot be written.
pub fn save(folder: &Path, session: &mut Session, record: &StateRecord) -> Result<(), StateError> {
    let sound = session.resumable();
    let file = state_file(&sound, &session.clock, record);
    check_finite(&file)?;
    session.series()?.write_npy(&folder.join(SERIES))?;
    let arrays = write_arrays(folder, &sound.checkpoint, file.steps)?;
    journal::write(folder, &file)?;
    remove_partials(&folder.join(FOLDER));
    remove_arrays(folder, &arrays.unwrap_or_default());
    Ok(())
}

/// Reads `state.json` of a results folder; `None` if there is none.
///
/// # Errors
/// A file that cannot be read, is not a state, or has another format version.
pub fn read(folder: &Path) -> Result<Option<StateFile>, StateError> {
    Ok(journal::read(folder, FORM)?)
}

/// Session that continues from the state `file`, read from `folder`.
///
/// # Errors
/// A state of another version or scene, a damaged state or one without its rows, an end that has
/// already passed.
pub fn resume<'p>(
    folder: &Path,
    file: &StateFile,
    parts: impl Into<Parts<'p>>,
    request: &RunRequest,
) -> Result<Session<'p>, StateError> {
    let (path, parts) = (folder.join(STATE), parts.into());
    journal::check_version(folder, &file.version)?;
    if file.fingerprint != fingerprint(&parts, request) {
        return Err(StateError::Scene { path });
    }
    let interval = |what, kept: Option<f64>, asked: Option<f64>, parts: f64| {
        // Default intervals, which depend on the end, are kept when the run is extended.
        if kept == asked || asked == Some(request.end / parts) {
            return Ok(());
        }
        let [kept, asked] = [kept, asked].map(|interval| interval.unwrap_or(f64::INFINITY));
        Err(StateError::Interval { path: path.clone(), what, kept, asked })
    };
    let rows = if matches!(parts, Parts::Rubber(_)) { ROWS_OF_RUBBER } else { ROWS };
    interval("rows", Some(file.output_interval), Some(request.output_interval), rows)?;
    interval("fields", file.fields_interval, request.fields_interval, FIELDS)?;
    check_finite(file)?;
    let damaged = |what| StateError::Damaged { path: path.clone(), what };
    let checkpoint = entries::checkpoint(folder, file, &parts).map_err(|error| match error {
        entries::Refused::Damaged(what) => damaged(what),
        entries::Refused::Series(error) => error.into(),
    })?;
    let has_control = file.bearing.as_ref().is_some_and(|bearing| bearing.control.is_some());
    let asks_control = matches!(request.options.stepping, Stepping::Accuracy(_));
    if has_control != (asks_control && file.bearing.is_some()) {
        return Err(damaged("error control without its values, or values without it"));
    }
    let by_time = has_control && file.exchange.is_none();
    let steps_forward = (file.step > 0.0) != by_time && (file.steps_per_row > 0) != by_time;
    if !steps_forward || file.rows_per_fields == Some(0) {
        return Err(damaged("the step from one row to the next is invalid"));
    }
    let clock = Clock {
        end: request.end,
        interval: file.output_interval,
        step: file.step,
        steps_per_row: file.steps_per_row,
        fields_interval: file.fields_interval,
        rows_per_fields: file.rows_per_fields,
        ..Clock::default()
    };
    // The negated form also rejects an end that is NaN.
    let slack = if matches!(parts, Parts::Bearing(_)) { 0.0 } else { 0.5 * file.step };
    let ahead = request.end > file.time - slack;
    if !ahead {
        return Err(StateError::Past { time: file.time, end: request.end });
    }
    let [first, turned_over, largest_residual] = file.ledger.0;
    let watch = LedgerWatch { first, turned_over, largest_residual, open: file.ledger.1 };
    let ran = ran(file).ok_or_else(|| damaged("an unknown stage"))?;
    let sound = Sound { checkpoint, watch, rows: file.rows, ran };
    let series_path = folder.join(SERIES);
    let series = Series::read_npy(&series_path)?;
    Session::resume(parts, request, clock, sound, &series)?
        .ok_or(StateError::Rows { path: series_path })
}

/// Default numbers of rows and of field files of a run.
const ROWS: f64 = 1000.0;
const ROWS_OF_RUBBER: f64 = 100.0;
const FIELDS: f64 = 20.0;

fn state_file(sound: &Sound, clock: &Clock, record: &StateRecord) -> StateFile {
    let watch = &sound.watch;
    let (time, steps) = entries::place(&sound.checkpoint);
    let mut file = StateFile {
        program: "bearing-dynamics".into(),
        version: env!("CARGO_PKG_VERSION").into(),
        form: FORM,
        fingerprint: record.fingerprint.clone(),
        stopped: record.stopped,
        error: record.error.clone(),
        time,
        steps,
        rows: sound.rows,
        end: clock.end,
        output_interval: clock.interval,
        fields_interval: clock.fields_interval,
        step: clock.step,
        steps_per_row: clock.steps_per_row,
        rows_per_fields: clock.rows_per_fields,
        seconds: record.seconds,
        ledger: ([watch.first, watch.turned_over, watch.largest_residual], watch.open),
        stages: stages(&sound.ran),
        bearing: None,
        solids: Vec::new(),
        exchange: None,
        sequence: None,
        rubber: None,
    };
    match &sound.checkpoint {
        Checkpoint::Bearing(kept) => file.bearing = Some(Box::new(BearingEntry::of(kept))),
        Checkpoint::Solid(kept, limit) => file.solids = vec![SolidEntry::of(kept, limit, steps)],
        Checkpoint::Housed(kept, coupling_steps) => {
            file.bearing = Some(Box::new(BearingEntry::of(&kept.simulation)));
            let solids = kept.solids.iter().zip(&coupling_steps.solids);
            let entry = |(part, (_, limit)): (&SteppedCheckpoint, &(_, _))| {
                SolidEntry::of(&part.solid, limit, steps)
            };
            file.solids = solids.map(entry).collect();
            file.exchange = Some(ExchangeEntry::of(kept, coupling_steps));
        }
        Checkpoint::QuasiStaticSequence(kept) => file.sequence = Some(SequenceEntry::of(kept)),
        Checkpoint::Rubber(kept, _) => file.rubber = Some(RubberEntry::of(kept, steps)),
    }
    file
}

fn stages(ran: &StageCounts) -> Vec<(String, [usize; 2], u64)> {
    let entry = |(stage, subject, count): (Stage, Subject, u64)| {
        (format!("{stage:?}"), subject.numbers(), count)
    };
    ran.list().into_iter().map(entry).collect()
}

/// Upper limit on the index of a subject.
const MOST_SUBJECTS: usize = 100_000;

/// Number of executions of each stage; `None` for an unknown stage or subject.
fn ran(file: &StateFile) -> Option<StageCounts> {
    let mut ran = StageCounts::default();
    for (name, numbers, count) in &file.stages {
        let stage = Stage::ALL.into_iter().find(|stage| format!("{stage:?}") == *name)?;
        let subject = Subject::from_numbers(*numbers).filter(|_| numbers[1] < MOST_SUBJECTS)?;
        ran.add(stage, subject, *count);
    }
    Some(ran)
}

/// Rejects NaN and infinity, which JSON cannot represent.
fn check_finite(file: &StateFile) -> Result<(), StateError> {
    let single = [file.time, file.step, file.seconds, file.end, file.output_interval];
    let single = single.into_iter().chain(file.ledger.0).chain(file.fields_interval);
    let mut parts = vec![("time, step or energy", single.collect())];
    if let Some(bearing) = &file.bearing {
        parts.extend(bearing.numbers());
    }
    if let Some(rubber) = &file.rubber {
        parts.push(("a step or a stress", rubber.numbers()));
    }
    if let Some(exchange) = &file.exchange {
        parts.push(("a coupling value of bodies and solids", exchange.numbers()));
    }
    for (what, values) in parts {
        if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
            return Err(StateError::NotFinite { what, value });
        }
    }
    Ok(())
}
