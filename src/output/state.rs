//! `state.json`: everything that a run needs to resume with the same bits. The rows so far are in `series.npy`.
//!
//! Numbers are written as the shortest decimal that reads back to the same bits. The series is written before the state,
//! so that one complete state exists whenever a run is killed. The series may have more rows than the state; those are
//! computed again.

use crate::equilibrium::quasi_static_sequence::QuasiStaticFit;
use crate::motion::bonded_bushing::BondedElements;
use crate::numeric::clock::{Clock, rounded};
use crate::output::atomic::{WriteError, remove_partials, write_atomic};
use crate::output::fields::FOLDER;
use crate::output::json::JsonError;
use crate::output::series::{Series, SeriesError};
use crate::output::session::{Checkpoint, Parts, RunRequest, Session, SessionError, Sound};
use crate::scene::text::input_file::{self, InputError, LARGEST_DATA};
use crate::solids::tet4_blocks::LANES;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use serde_json::ser::Formatter;
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

pub const STATE: &str = "state.json";
pub const SERIES: &str = "series.npy";

/// Format version of `state.json`.
pub const FORM: u32 = 7;

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Why the run stood still when the state was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stopped {
    /// It did not: written on the way.
    Running,
    Interrupted,
    Failed,
    Complete,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateFile {
    pub program: String,
    pub version: String,
    /// Format version, see [`FORM`].
    pub form: u32,
    /// See [`fingerprint`].
    pub fingerprint: String,
    /// SHA-256 of `clock` and `sound`.
    pub digest: String,
    pub stopped: Stopped,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// s.
    pub time: f64,
    /// Number of steps of a bearing or a solid, of coupling steps, of equilibria, or of rows of rubber.
    pub steps: u64,
    /// End of the run as requested, s.
    pub end: f64,
    /// Wall time so far, s.
    pub seconds: f64,
    pub clock: Clock,
    pub sound: Sound,
}

#[derive(Debug, Error)]
pub enum StateError {
    #[error("cannot read {}: {source}", path.display())]
    Read { path: PathBuf, source: InputError },
    #[error("{} is not the saved state of this kind of run: {source}; start again with --fresh", path.display())]
    Json { path: PathBuf, source: serde_json::Error },
    #[error(
        "{} was written by version {found}; results of this version, {VERSION}, may not be bitwise identical; start \
         again with --fresh",
        path.display()
    )]
    Version { path: PathBuf, found: String },
    #[error(
        "{} has the format of another version of this program; finish the run with that version, or start \
         again with --fresh",
        path.display()
    )]
    Form { path: PathBuf },
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
    #[error("{} is damaged: its numbers are not those that were saved; start again with --fresh", path.display())]
    Damaged { path: PathBuf },
    #[error("{} has no rows that match its state; start again with --fresh", path.display())]
    Rows { path: PathBuf },
    #[error("the run has already reached {} s, past its new end of {end} s; choose a later end, or start again with --fresh", rounded(*time))]
    Past { time: f64, end: f64 },
    #[error("a value of the state is not finite; a state can hold finite numbers only")]
    NotFinite,
    #[error(transparent)]
    Series(#[from] SeriesError),
    #[error(transparent)]
    Session(#[from] SessionError),
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// A hash of debug text, which has every field and the shortest decimals that distinguish two numbers.
struct Hash(Sha256);

impl std::fmt::Write for Hash {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.update(text);
        Ok(())
    }
}

pub fn hexadecimal(hash: Sha256) -> String {
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Sha256 of everything that determines the bits of a run except its length: parts, time stepping, channels, version and
/// vector width. The end is excluded, so that a run can be extended, and so is the output interval, which is compared
/// separately.
pub fn fingerprint(parts: &Parts, request: &RunRequest) -> String {
    let mut hash = Hash(Sha256::new());
    hash_all(&mut hash, parts, request).expect("a hash takes any text");
    hexadecimal(hash.0)
}

fn hash_all(to: &mut Hash, parts: &Parts, request: &RunRequest) -> std::fmt::Result {
    let RunRequest { options, channels, .. } = request;
    write!(to, "{VERSION} {LANES} {channels:?} ")?;
    match parts {
        Parts::Bearing(assembly) => write!(to, "{assembly:?} {options:?}"),
        Parts::Solid(parts) => {
            let (setup, problem) = (parts.setup, &parts.setup.problem);
            write!(to, "{problem:?} {:?} {:?} ", setup.velocity, parts.method)?;
            write!(to, "{:?} {:?} {:?}", parts.stepping, setup.probes, setup.supports)
        }
        Parts::Housed(parts) => {
            write!(to, "{:?} {options:?} {:?} ", parts.assembly, parts.options)?;
            for solid in &parts.solids {
                let problem = &solid.model.problem;
                write!(to, "{:?} {problem:?} {:?} {:?} ", solid.name, solid.shaft, solid.cage)?;
            }
            write!(to, "{:?}", parts.seats)?;
            for part in &parts.bushings {
                write!(to, "{} {:?} {:?} ", part.name, part.sleeves, part.spring)?;
                match &part.elements {
                    BondedElements::Explicit { body, fraction } => {
                        write!(to, "{body:?} {fraction}")?;
                    }
                    BondedElements::Implicit { model, step } => {
                        write!(to, "{:?} {:?} {step:?}", model.problem, model.mass)?;
                    }
                }
            }
            Ok(())
        }
        Parts::QuasiStaticSequence(parts) => {
            parts.models.iter().try_for_each(|model| write!(to, "{:?}", model.problem))?;
            write!(to, "{:?}", parts.problem.assembly)?;
            parts.problem.seats.iter().try_for_each(|seat| {
                let QuasiStaticFit { name, bearing, bore, penalty, axial, radius, damping: _ } =
                    seat;
                let reach = &bore.reach;
                write!(to, "{name:?} {bearing} {penalty:?} {axial:?} {radius:?} {reach:?}")
            })
        }
        Parts::Rubber(parts) => {
            let setup = parts.setup;
            let problem = &setup.model.problem;
            write!(to, "{problem:?} {:?} {:?} {:?}", parts.stepping, setup.probes, setup.supports)
        }
    }
}

/// Data of a state that the session does not have.
#[derive(Clone, Debug)]
pub struct StateRecord {
    pub fingerprint: String,
    pub stopped: Stopped,
    pub error: Option<String>,
    pub seconds: f64,
}

/// JSON with a line for each key, of finite numbers only. NaN and infinity would become null; absent values are left out,
/// so that there is no other null.
struct FiniteJson;

impl Formatter for FiniteJson {
    fn write_null<W: ?Sized + io::Write>(&mut self, _: &mut W) -> io::Result<()> {
        Err(io::ErrorKind::InvalidData.into())
    }

    fn begin_object_key<W: ?Sized + io::Write>(
        &mut self,
        to: &mut W,
        first: bool,
    ) -> io::Result<()> {
        to.write_all(if first { b"\n" } else { b",\n" })
    }
}

fn json(value: &impl Serialize) -> Result<Vec<u8>, StateError> {
    let mut text = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut text, FiniteJson);
    value.serialize(&mut serializer).map_err(|_| StateError::NotFinite)?;
    Ok(text)
}

fn digest(clock: &Clock, sound: &Sound) -> Result<String, StateError> {
    Ok(hexadecimal(Sha256::new_with_prefix(json(&(clock, sound))?)))
}

/// Writes `series.npy` and `state.json` of a session into its results folder, and removes what killed runs left half
/// written.
///
/// # Errors
/// A number that is not finite (the existing state is kept), a file that cannot be written.
pub fn save(folder: &Path, session: &mut Session, record: &StateRecord) -> Result<(), StateError> {
    let (clock, sound) = (session.clock.clone(), session.resumable());
    let (time, steps) = match &sound.checkpoint {
        Checkpoint::Bearing(kept) => (kept.time, kept.steps),
        Checkpoint::Solid(kept, _) => (kept.time, kept.steps),
        Checkpoint::Housed(kept, _) => (kept.simulation.time, kept.exchanges),
        Checkpoint::QuasiStaticSequence(kept) => (kept.time, kept.found),
        Checkpoint::Rubber(kept, rows) => (kept.state.time, *rows),
    };
    let file = StateFile {
        program: env!("CARGO_PKG_NAME").into(),
        version: VERSION.into(),
        form: FORM,
        fingerprint: record.fingerprint.clone(),
        digest: digest(&clock, &sound)?,
        stopped: record.stopped,
        error: record.error.clone(),
        time,
        steps,
        end: clock.end,
        seconds: record.seconds,
        clock,
        sound,
    };
    let text = json(&file)?;
    session.series()?.write_npy(&folder.join(SERIES))?;
    write_atomic(&folder.join(STATE), &text)?;
    [folder, &folder.join(FOLDER)].into_iter().for_each(remove_partials);
    Ok(())
}

/// First keys of a state.
#[derive(Default, Deserialize, Serialize)]
#[serde(default)]
struct Head {
    program: Option<String>,
    form: Option<u32>,
    stopped: Option<String>,
    time: Option<f64>,
    end: Option<f64>,
}

/// The first keys of a state file, whatever its size and format version.
///
/// # Errors
/// A file that cannot be read or is not JSON.
pub fn head(path: &Path) -> Result<Value, JsonError> {
    let head: Head = serde_json::from_slice(&input_file::read(path, LARGEST_DATA)?)?;
    Ok(serde_json::to_value(head)?)
}

/// Reads `state.json` of a results folder; `None` if there is none.
///
/// # Errors
/// A file that cannot be read, is not a state, or has another format version.
pub fn read(folder: &Path) -> Result<Option<StateFile>, StateError> {
    let path = folder.join(STATE);
    let bytes = match input_file::read(&path, LARGEST_DATA) {
        Ok(bytes) => bytes,
        Err(error) if error.is_missing() => return Ok(None),
        Err(source) => return Err(StateError::Read { path, source }),
    };
    let head = serde_json::from_slice(&bytes);
    match head.and_then(|Head { form, .. }| match form {
        Some(FORM) => serde_json::from_slice(&bytes).map(Some),
        _ => Ok(None),
    }) {
        Ok(Some(file)) => Ok(Some(file)),
        Ok(None) => Err(StateError::Form { path }),
        Err(source) => Err(StateError::Json { path, source }),
    }
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
    let (path, parts, StateFile { clock, sound, .. }) = (folder.join(STATE), parts.into(), file);
    if file.version != VERSION {
        return Err(StateError::Version { path, found: file.version.clone() });
    }
    if file.fingerprint != fingerprint(&parts, request) {
        return Err(StateError::Scene { path });
    }
    if file.digest != digest(clock, sound)? {
        return Err(StateError::Damaged { path });
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
    interval("rows", Some(clock.interval), Some(request.output_interval), rows)?;
    interval("fields", clock.fields_interval, request.fields_interval, FIELDS)?;
    // The negated form also rejects an end that is NaN.
    let slack = if matches!(parts, Parts::Bearing(_)) { 0.0 } else { 0.5 * clock.step };
    let ahead = request.end > file.time - slack;
    if !ahead {
        return Err(StateError::Past { time: file.time, end: request.end });
    }
    let clock = Clock { end: request.end, ..clock.clone() };
    let path = folder.join(SERIES);
    let series = Series::read_npy(&path)?;
    Session::resume(parts, request, clock, sound.clone(), &series)?.ok_or(StateError::Rows { path })
}

/// Default numbers of rows and of field files of a run.
const ROWS: f64 = 1000.0;
const ROWS_OF_RUBBER: f64 = 100.0;
const FIELDS: f64 = 20.0;
