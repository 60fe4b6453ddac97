//! `bearing compare REFERENCE CANDIDATE`: comparison of results, with the first place where they differ.
//!
//! The arguments are two `.csv`, two `.npy` (or one of each), two `.json` files, or two folders. Of folders,
//! every `.csv` and `.npy` file and `summary.json` of the reference are compared. A file, channel or row that
//! is missing in the candidate, another unit, NaN or infinity on either side are differences. Additional
//! files and channels of the candidate are listed and are no difference; additional rows are one. A folder
//! without any of these files, two folders without a common file, and a `.json` file without named values are
//! an error.
//!
//! Strings, booleans and bare integers must be equal; numbers may differ by their [`tolerance`]. Names in
//! [`IGNORED_NAMES`], names that start with [`IGNORED_PREFIX`], and [`PROGRAM_NAME`] are never compared. Fields
//! in `.vtu` files are not compared either, and the report lists them.
//!
//! Two more things are no difference. The candidate may lack a `.npy` file if both sides have the `.csv` file of the
//! same name. In every class but `f64-exact`, the position of a ball that carries no load in the reference is not
//! compared: see [`unloaded`].
//!
//! Runs of different accuracy are compared with a [`RequestedTolerance`]. Channels on the time stepping are then not
//! compared: see [`is_about_steps`].
pub mod channels;
mod judge;
pub mod report;
pub mod tolerance;
pub mod unloaded;

use crate::output::fields;
use crate::output::json::{self, JsonError};
use crate::output::series::SeriesError;
use crate::scene::tables::keys;
use channels::{Content, MOST_NAME_BYTES, name_columns_as};
use judge::Judge;
use std::path::{Path, PathBuf};
use thiserror::Error;
use tolerance::{RequestedTolerance, ToleranceClass, ToleranceError, Tolerances};

pub use report::{report, to_json};

pub const IGNORED_NAMES: [&str; 2] = ["version", "threads"];
pub const PROGRAM_NAME: &str = "program.name";
/// Values whose name, or the name of a part above them, starts with this are never compared (wall time).
pub const IGNORED_PREFIX: &str = "seconds";

/// Share of its channel's scale below which a value counts as zero in [`Spread`].
pub const SMALL: f64 = 1e-6;

#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Class of channels that the tolerances do not name; takes precedence over the one in the file.
    pub default_class: Option<ToleranceClass>,
    /// Replaces the `tolerances.json` in the reference folder.
    pub tolerances: Option<Tolerances>,
    /// Tolerances for results of different accuracy; takes precedence over both classes.
    pub given: Option<RequestedTolerance>,
}

#[derive(Debug, Error)]
pub enum CompareError {
    #[error("cannot read {}: {source}", path.display())]
    Read { path: PathBuf, source: std::io::Error },
    #[error("cannot read {} as JSON: {source}", path.display())]
    Json { path: PathBuf, source: JsonError },
    #[error(
        "{}: the names of its values are longer than {MOST_NAME_BYTES} bytes in total",
        path.display()
    )]
    Names { path: PathBuf },
    #[error(transparent)]
    Series(#[from] SeriesError),
    #[error(transparent)]
    Tolerance(#[from] ToleranceError),
    #[error("{} does not exist; check the path and the folder you are in", path.display())]
    Missing { path: PathBuf },
    #[error(
        "{} holds {of_reference}, {} holds {of_candidate}: results of different kinds cannot be compared",
        reference.display(), candidate.display()
    )]
    OtherKinds {
        reference: PathBuf,
        candidate: PathBuf,
        of_reference: &'static str,
        of_candidate: &'static str,
    },
    #[error("{}: only .csv, .npy, .json files and folders can be compared", path.display())]
    UnknownKind { path: PathBuf },
    #[error("{} and {} hold different kinds of results", reference.display(), candidate.display())]
    KindMismatch { reference: PathBuf, candidate: PathBuf },
    #[error(
        "{} holds nothing to compare: only the program's name, version and run time",
        reference.display()
    )]
    NothingToCompare { reference: PathBuf },
    #[error(
        "{} is not a results folder: it has no summary.json, .csv or .npy file", path.display()
    )]
    NoResults { path: PathBuf },
    #[error(
        "{} and {} have no file of the same name: the first has {}, the \
         second {}",
        reference.display(), candidate.display(), of_reference.join(", "), of_candidate.join(", ")
    )]
    NoCommonFile {
        reference: PathBuf,
        candidate: PathBuf,
        of_reference: Vec<String>,
        of_candidate: Vec<String>,
    },
    #[error("{} holds no named values: results are a JSON object with content", path.display())]
    NoValues { path: PathBuf },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    pub equal: bool,
    pub checked: usize,
    /// Number of differences of any kind.
    pub differing: usize,
    /// The first difference: files by name with tables first, rows before columns, a tree in file order.
    pub first_divergence: Option<Divergence>,
    /// In the order of the reference.
    pub channels: Vec<ChannelResult>,
    /// `file: channel` of the values not compared, by name or by class.
    pub ignored: Vec<String>,
    /// Tags of the tolerances of which a file of the candidate has no channel.
    pub unclaimed: Vec<String>,
    /// `file: channel` of the channels that only the candidate has.
    pub only_in_candidate: Vec<String>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct ChannelResult {
    pub file: String,
    pub channel: String,
    pub unit: String,
    /// Name of its [`ToleranceClass`], or `given` for a [`RequestedTolerance`].
    pub class: &'static str,
    pub checked: usize,
    pub differing: usize,
    /// Largest ratio of difference to tolerance; `None` for strings and integers.
    pub worst: Option<Worst>,
    pub spread: Spread,
}

/// Size of a channel's differences, from which tolerances are measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// Differences that are none of two numbers: texts, counts, missing values, units, NaN.
    pub unlike: usize,
    /// Scale of the channel: its largest |reference|, shared by the components of one vector.
    pub scale: f64,
    pub largest: f64,
    /// Largest difference of values below [`SMALL`] of the scale.
    pub of_small: f64,
    /// Largest difference of the others, over |reference|.
    pub relative: f64,
}

impl Spread {
    fn add(&mut self, reference: f64, difference: f64) {
        // `max` would lose a NaN.
        if !difference.is_finite() {
            self.unlike += 1;
            return;
        }
        self.largest = self.largest.max(difference);
        if reference.abs() <= SMALL * self.scale {
            self.of_small = self.of_small.max(difference);
        } else {
            self.relative = self.relative.max(difference / reference.abs());
        }
    }

    /// The larger of each.
    pub fn or(self, other: Spread) -> Spread {
        Spread {
            unlike: self.unlike.max(other.unlike),
            scale: self.scale.max(other.scale),
            largest: self.largest.max(other.largest),
            of_small: self.of_small.max(other.of_small),
            relative: self.relative.max(other.relative),
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    pub place: String,
    pub difference: f64,
    pub allowed: f64,
    /// difference / allowed; infinite if the tolerance is zero or a value is not finite.
    pub ratio: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Divergence {
    pub file: String,
    /// Empty for a missing file.
    pub channel: String,
    pub unit: String,
    /// Row of a table, from 1; position in a tree.
    pub row: usize,
    /// `row 3 (time = 0.2 s, ball 3)` in a table (rows from 1), the path in a tree; empty for a
    /// missing file or column.
    pub place: String,
    pub kind: DivergenceKind,
}

#[derive(Clone, Debug, PartialEq)]
pub enum DivergenceKind {
    /// Beyond tolerance, or not finite on at least one side.
    Value {
        reference: f64,
        candidate: f64,
        difference: f64,
        allowed: f64,
    },
    /// A string, integer, boolean or another kind of value, as text.
    Exact {
        reference: String,
        candidate: String,
    },
    Unit {
        reference: String,
        candidate: String,
    },
    Length {
        reference: usize,
        candidate: usize,
    },
    MissingFile,
    MissingChannel,
    /// An element that the reference's list does not have.
    OnlyInCandidate,
}

/// Compares two files or two folders.
///
/// # Errors
/// A file that cannot be read or is not valid, invalid tolerances, an empty reference.
/// A difference is not an error: see [`Comparison::equal`].
pub fn compare(
    reference: &Path,
    candidate: &Path,
    options: &Options,
) -> Result<Comparison, CompareError> {
    let mut tolerances = options.tolerances.clone().unwrap_or_default();
    if options.default_class == Some(ToleranceClass::Ignored) {
        return Err(ToleranceError::IgnoredByDefault.into());
    }
    for path in [reference, candidate] {
        let found = std::fs::metadata(path);
        if found.is_err_and(|error| error.kind() == std::io::ErrorKind::NotFound) {
            return Err(CompareError::Missing { path: path.to_path_buf() });
        }
    }
    let mut only_in_candidate = Vec::new();
    let pairs = if reference.is_dir() && candidate.is_dir() {
        let default = reference.join("tolerances.json");
        if options.tolerances.is_none() && default.exists() {
            tolerances = Tolerances::read(&default)?;
        }
        refuse_other_kinds(reference, candidate)?;
        let named = |name: String| (reference.join(&name), candidate.join(&name), name);
        let [names, more] = common_folders(reference, candidate)?;
        only_in_candidate = more;
        names.into_iter().map(named).collect()
    } else if reference.is_dir() != candidate.is_dir() {
        return Err(mismatch(reference, candidate));
    } else {
        let name = reference.file_name().map(|name| name.to_string_lossy().into_owned());
        vec![(reference.to_path_buf(), candidate.to_path_buf(), name.unwrap_or_default())]
    };
    tolerances.check()?;
    if let Some(given) = &options.given {
        given.check()?;
    }

    let mut judge = Judge::new(&tolerances, options);
    judge.only_in_candidate = only_in_candidate;
    let has_fields = |path: &Path| path.join(fields::FOLDER).is_dir();
    let without = match [reference, candidate].map(has_fields) {
        [false, false] => None,
        [true, true] => Some(""),
        [true, false] => Some("; the candidate has none"),
        [false, true] => Some("; the reference has none"),
    };
    if let Some(without) = without {
        judge.file = fields::FOLDER.into();
        judge.leave_out(&format!("fields in .vtu files are not compared{without}"));
    }
    for (reference_file, candidate_file, name) in pairs {
        judge.file = name;
        let expected = channels::read(&reference_file)?;
        // Only inside folders: a file named on the command line must exist.
        if candidate.is_dir() && !candidate_file.exists() {
            judge.note_names(&expected);
            if is_given_as_csv(&reference_file) && is_given_as_csv(&candidate_file) {
                judge.leave_out("not in the candidate, which has the table as .csv");
                continue;
            }
            judge.diverge((0, 0), "", "", String::new(), DivergenceKind::MissingFile);
            judge.finish_file();
            continue;
        }
        match (expected, channels::read(&candidate_file)?) {
            (Content::Table(expected), Content::Table(found)) => {
                let found = name_columns_as(found, &candidate_file, &expected)?;
                judge.tables(&expected, &found);
            }
            (Content::Tree(expected), Content::Tree(found)) => judge.trees(&expected, &found),
            _ => return Err(mismatch(&reference_file, &candidate_file)),
        }
        judge.finish_file();
    }
    judge.finish(reference)
}

/// Rejects folders of different kinds, such as a run and an equilibrium, where every channel would be missing.
fn refuse_other_kinds(reference: &Path, candidate: &Path) -> Result<(), CompareError> {
    let kind = |folder: &Path| {
        let summary = json::read(&folder.join("summary.json")).ok()?;
        let kind = summary["kind"].as_str()?;
        let kinds: [(&str, &'static str); 3] =
            [("run", "a run"), ("static", "an equilibrium"), ("modes", "natural modes")];
        kinds.into_iter().find(|(word, _)| kind.contains(word)).map(|(_, name)| name)
    };
    match (kind(reference), kind(candidate)) {
        (Some(of_reference), Some(of_candidate)) if of_reference != of_candidate => {
            let (reference, candidate) = (reference.to_path_buf(), candidate.to_path_buf());
            Err(CompareError::OtherKinds { reference, candidate, of_reference, of_candidate })
        }
        _ => Ok(()),
    }
}

/// Files of the reference folder, at least one of which the candidate has, and the additional files of the candidate; a `.npy`
/// file is not additional if the reference has its table as `.csv`.
fn common_folders(reference: &Path, candidate: &Path) -> Result<[Vec<String>; 2], CompareError> {
    let [of_reference, of_candidate] = [known_files(reference)?, known_files(candidate)?];
    for (path, files) in [(reference, &of_reference), (candidate, &of_candidate)] {
        if files.is_empty() {
            return Err(CompareError::NoResults { path: path.to_path_buf() });
        }
    }
    if of_reference.iter().any(|name| of_candidate.contains(name)) {
        let is_new = |name: &&String| {
            let is_other_form = name.ends_with(".npy") && is_given_as_csv(&candidate.join(name));
            !of_reference.contains(name) && !is_other_form
        };
        let more = of_candidate.iter().filter(is_new).map(|name| format!("{name}: whole file"));
        let more = more.collect();
        return Ok([of_reference, more]);
    }
    let (reference, candidate) = (reference.to_path_buf(), candidate.to_path_buf());
    Err(CompareError::NoCommonFile { reference, candidate, of_reference, of_candidate })
}

/// True for a `.npy` file next to the `.csv` file of the same table.
fn is_given_as_csv(path: &Path) -> bool {
    path.extension().is_some_and(|kind| kind == "npy") && path.with_extension("csv").exists()
}

fn mismatch(reference: &Path, candidate: &Path) -> CompareError {
    CompareError::KindMismatch {
        reference: reference.to_path_buf(),
        candidate: candidate.to_path_buf(),
    }
}

/// Names of the files of a folder that are compared: tables first, then `summary.json`.
pub fn known_files(folder: &Path) -> Result<Vec<String>, CompareError> {
    let failed = |source| CompareError::Read { path: folder.to_path_buf(), source };
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name().to_string_lossy().into_owned();
        let partial = name.starts_with('.');
        if !partial && (name.ends_with(".csv") || name.ends_with(".npy") || name == "summary.json")
        {
            names.push(name);
        }
    }
    names.sort_by_key(|name| (name == "summary.json", name.clone()));
    Ok(names)
}

/// True for a channel that is not compared because of its name; see [`IGNORED_NAMES`], [`IGNORED_PREFIX`] and
/// [`PROGRAM_NAME`]. Of the scene, which one may write in several ways, the title is compared.
pub fn is_ignored_by_name(channel: &str) -> bool {
    let mut parts = channel.split('.').map(|part| part.trim_end_matches("[]"));
    parts.clone().any(|part| part.starts_with(IGNORED_PREFIX))
        || channel == PROGRAM_NAME
        || (channel.starts_with("scene.") && channel != "scene.title")
        || parts.next_back().is_some_and(|last| IGNORED_NAMES.contains(&last))
}

/// True for a channel that records the default of a scene key. A scene that writes the same value explicitly lacks this
/// channel but has the same results.
pub fn is_default_of_key(channel: &str) -> bool {
    let key = channel.strip_prefix("assumptions.");
    key.is_some_and(|key| keys::find_named(key).is_some() || keys::find_table(key).is_some())
}

/// True for a channel about the time stepping rather than the motion: it differs between runs of different accuracy.
pub fn is_about_steps(channel: &str) -> bool {
    const SECTIONS: [&str; 5] = ["step", "work", "plan", "stages", "assumptions"];
    const LAST: [&str; 3] = ["steps_per_row", "energy_residual", "largest_residual"];
    let mut parts = channel.split('.').map(|part| part.trim_end_matches("[]"));
    let of_residual = parts.clone().any(|part| LAST.contains(&part));
    // The time steps decide which of several nearly equal values is the largest.
    let place = channel.starts_with("extremes.")
        && [".time", ".ball", ".contact_angle"].iter().any(|last| channel.ends_with(last));
    of_residual
        || place
        || channel == "scene.title"
        || parts.next().is_some_and(|first| SECTIONS.contains(&first))
}
