//! `bearing compare REFERENCE CANDIDATE`: does the candidate agree, and where does it first depart?
//!
//! Compared are two `.csv`, two `.npy` (or one of each), two `.json` files, or two folders: then
//! every `.csv` and `.npy` file and `summary.json` of the reference. A file, channel or row that
//! is missing in the candidate, another unit, NaN or infinity on either side: all are
//! differences. What only the candidate has is listed and does no harm, except further rows.
//!
//! Strings, booleans and bare integers must be equal; numbers may differ by their
//! [tolerance](tolerance). Never compared, because they say how and not what: names in
//! [`IGNORED_NAMES`] and those that start with [`IGNORED_PREFIX`].
pub mod channels;
pub mod report;
pub mod tolerance;

use crate::output::series::{Series, SeriesError};
use channels::{Content, Leaf, LeafValue, name_columns_as};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};
use thiserror::Error;
use tolerance::{Tolerance, ToleranceClass, ToleranceError, Tolerances};

pub use report::{report, to_json};

/// Parts and columns with these names are never compared.
pub const IGNORED_NAMES: [&str; 2] = ["version", "threads"];
/// Nor those whose name, or the name of a part above them, starts with this (wall time).
pub const IGNORED_PREFIX: &str = "seconds";

/// What the user may choose.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Class of channels that the tolerances do not name; goes before the one in the file.
    pub default_class: Option<ToleranceClass>,
    /// Used instead of the `tolerances.json` in the reference folder.
    pub tolerances: Option<Tolerances>,
}

#[derive(Debug, Error)]
pub enum CompareError {
    #[error("cannot read {}: {source}", path.display())]
    Read {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{} is not JSON: {source}", path.display())]
    Json {
        path: PathBuf,
        source: serde_json::Error,
    },
    #[error(transparent)]
    Series(#[from] SeriesError),
    #[error(transparent)]
    Tolerance(#[from] ToleranceError),
    #[error("{}: only .csv, .npy, .json files and folders are compared", path.display())]
    UnknownKind { path: PathBuf },
    #[error("{} and {} hold different kinds of results", reference.display(), candidate.display())]
    KindMismatch {
        reference: PathBuf,
        candidate: PathBuf,
    },
    #[error("{} holds nothing to compare", reference.display())]
    NothingToCompare { reference: PathBuf },
}

/// Outcome of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    pub equal: bool,
    /// Values compared.
    pub checked: usize,
    /// Differences found, of any kind.
    pub differing: usize,
    /// The earliest: files by name with tables first, rows before columns, a tree as written.
    pub first_divergence: Option<Divergence>,
    /// In the order of the reference.
    pub channels: Vec<ChannelResult>,
    /// `file: channel` of what was left out, by name or by class.
    pub ignored: Vec<String>,
    /// `file: channel` of what only the candidate has.
    pub only_in_candidate: Vec<String>,
}

/// One channel of one file.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelResult {
    pub file: String,
    pub channel: String,
    pub unit: String,
    pub class: ToleranceClass,
    pub checked: usize,
    pub differing: usize,
    /// The largest difference measured by what is allowed; `None` for strings and integers.
    pub worst: Option<Worst>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    pub place: String,
    pub difference: f64,
    pub allowed: f64,
    /// difference / allowed; infinite where nothing is allowed or a value is not finite.
    pub ratio: f64,
}

/// One place where the candidate departs from the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Divergence {
    pub file: String,
    /// Empty for a missing file.
    pub channel: String,
    pub unit: String,
    /// `row 3 (time = 0.2 s, ball 3)` in a table (rows from 1), the path in a tree; empty for a
    /// missing file or column.
    pub place: String,
    pub kind: DivergenceKind,
}

#[derive(Clone, Debug, PartialEq)]
pub enum DivergenceKind {
    /// Beyond tolerance, or not finite on one side at least.
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
    /// Rows of a table.
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
/// A file that cannot be read or makes no sense, tolerances that cannot be used, a reference with
/// nothing in it. A difference is no error: see [`Comparison::equal`].
pub fn compare(
    reference: &Path,
    candidate: &Path,
    options: &Options,
) -> Result<Comparison, CompareError> {
    let mut tolerances = options.tolerances.clone().unwrap_or_default();
    if options.default_class == Some(ToleranceClass::Ignored) {
        return Err(ToleranceError::IgnoredByDefault.into());
    }
    let pairs = if reference.is_dir() && candidate.is_dir() {
        let beside = reference.join("tolerances.json");
        if options.tolerances.is_none() && beside.exists() {
            tolerances = Tolerances::read(&beside)?;
        }
        let named = |name: String| (reference.join(&name), candidate.join(&name), name);
        known_files(reference)?.into_iter().map(named).collect()
    } else if reference.is_dir() != candidate.is_dir() {
        // A path that does not exist is named as such rather than as a file among folders.
        for path in [reference, candidate] {
            std::fs::metadata(path).map_err(|source| CompareError::Read {
                path: path.to_path_buf(),
                source,
            })?;
        }
        return Err(mismatch(reference, candidate));
    } else {
        let name = reference
            .file_name()
            .map(|name| name.to_string_lossy().into_owned());
        vec![(
            reference.to_path_buf(),
            candidate.to_path_buf(),
            name.unwrap_or_default(),
        )]
    };
    tolerances.check()?;

    let mut judge = Judge::new(&tolerances, options.default_class);
    for (reference_file, candidate_file, name) in pairs {
        judge.file = name;
        let expected = channels::read(&reference_file)?;
        // Only inside folders: a file named on the command line must exist.
        if candidate.is_dir() && !candidate_file.exists() {
            judge.note_names(&expected);
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

fn mismatch(reference: &Path, candidate: &Path) -> CompareError {
    CompareError::KindMismatch {
        reference: reference.to_path_buf(),
        candidate: candidate.to_path_buf(),
    }
}

/// Names of the files of a folder that are compared: tables first, then `summary.json`.
pub fn known_files(folder: &Path) -> Result<Vec<String>, CompareError> {
    let failed = |source| CompareError::Read {
        path: folder.to_path_buf(),
        source,
    };
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let name = entry
            .map_err(failed)?
            .file_name()
            .to_string_lossy()
            .into_owned();
        let partial = name.starts_with('.');
        if !partial && (name.ends_with(".csv") || name.ends_with(".npy") || name == "summary.json")
        {
            names.push(name);
        }
    }
    names.sort_by_key(|name| (name == "summary.json", name.clone()));
    Ok(names)
}

/// A channel that is left out by name; see [`IGNORED_NAMES`] and [`IGNORED_PREFIX`].
pub fn is_ignored_by_name(channel: &str) -> bool {
    let mut parts = channel.split('.').map(|part| part.trim_end_matches("[]"));
    parts.clone().any(|part| part.starts_with(IGNORED_PREFIX))
        || parts
            .next_back()
            .is_some_and(|last| IGNORED_NAMES.contains(&last))
}

/// What the components of one vector have in common: `loads.x` and `loads.y` share `loads.`.
fn vector_stem(channel: &str) -> &str {
    for component in ["tilt_y", "tilt_z", "x", "y", "z"] {
        if let Some(stem) = channel.strip_suffix(component)
            && (stem.is_empty() || stem.ends_with(['.', '_']))
        {
            return stem;
        }
    }
    channel
}

/// Position of a difference: row (or place in the tree) and column; 0 comes before all rows.
type Order = (usize, usize);

struct Judge<'a> {
    tolerances: &'a Tolerances,
    default_class: Option<ToleranceClass>,
    unused: BTreeSet<&'a str>,
    file: String,
    earliest_in_file: Option<(Order, Divergence)>,
    first: Option<Divergence>,
    differing: usize,
    channels: Vec<ChannelResult>,
    ignored: Vec<String>,
    only_in_candidate: Vec<String>,
}

impl<'a> Judge<'a> {
    fn new(tolerances: &'a Tolerances, default_class: Option<ToleranceClass>) -> Self {
        Judge {
            tolerances,
            default_class,
            unused: tolerances.channels.keys().map(String::as_str).collect(),
            file: String::new(),
            earliest_in_file: None,
            first: None,
            differing: 0,
            channels: Vec::new(),
            ignored: Vec::new(),
            only_in_candidate: Vec::new(),
        }
    }

    fn finish_file(&mut self) {
        let earliest = self
            .earliest_in_file
            .take()
            .map(|(_, divergence)| divergence);
        if self.first.is_none() {
            self.first = earliest;
        }
    }

    fn finish(self, reference: &Path) -> Result<Comparison, CompareError> {
        if let Some(channel) = self.unused.first() {
            return Err(ToleranceError::Unused {
                channel: channel.to_string(),
            }
            .into());
        }
        let checked = self.channels.iter().map(|channel| channel.checked).sum();
        if checked == 0 && self.differing == 0 {
            return Err(CompareError::NothingToCompare {
                reference: reference.to_path_buf(),
            });
        }
        Ok(Comparison {
            equal: self.differing == 0,
            checked,
            differing: self.differing,
            first_divergence: self.first,
            channels: self.channels,
            ignored: self.ignored,
            only_in_candidate: self.only_in_candidate,
        })
    }

    /// Ticks off the tolerances that a file makes use of.
    fn note_names(&mut self, content: &Content) {
        let names: Vec<&str> = match content {
            Content::Table(series) => series.columns().iter().map(|c| c.name.as_str()).collect(),
            Content::Tree(leaves) => leaves.iter().map(|leaf| leaf.channel.as_str()).collect(),
        };
        for name in names {
            if let Some((used, _)) = self.tolerances.entry(name) {
                self.unused.remove(used);
            }
        }
    }

    /// Opens a channel, or notes that it is not compared.
    fn open(&mut self, channel: &str, unit: &str) -> Option<Tolerance> {
        if let Some((used, _)) = self.tolerances.entry(channel) {
            self.unused.remove(used);
        }
        let (class, tolerance) = self
            .tolerances
            .of_channel(channel, unit, self.default_class);
        let tolerance = tolerance.filter(|_| !is_ignored_by_name(channel));
        if tolerance.is_none() {
            self.ignored.push(format!("{}: {channel}", self.file));
            return None;
        }
        self.channels.push(ChannelResult {
            file: self.file.clone(),
            channel: channel.to_string(),
            unit: unit.to_string(),
            class,
            checked: 0,
            differing: 0,
            worst: None,
        });
        tolerance
    }

    fn diverge(
        &mut self,
        order: Order,
        channel: &str,
        unit: &str,
        place: String,
        kind: DivergenceKind,
    ) {
        self.differing += 1;
        if self
            .earliest_in_file
            .as_ref()
            .is_none_or(|(earliest, _)| order < *earliest)
        {
            let divergence = Divergence {
                file: self.file.clone(),
                channel: channel.to_string(),
                unit: unit.to_string(),
                place,
                kind,
            };
            self.earliest_in_file = Some((order, divergence));
        }
    }

    /// Compares two numbers of channel number `index` in `self.channels`.
    fn real(
        &mut self,
        index: usize,
        order: Order,
        place: &dyn Fn() -> String,
        reference: f64,
        candidate: f64,
        (tolerance, scale): (Tolerance, f64),
    ) {
        let difference = (candidate - reference).abs();
        let allowed = tolerance.allowed(reference, scale);
        let finite = reference.is_finite() && candidate.is_finite();
        let same_bits = reference.to_bits() == candidate.to_bits();
        let within = match tolerance.is_exact() {
            true => finite && same_bits,
            false => finite && difference <= allowed,
        };
        let ratio = match (finite, difference == 0.0) {
            (true, true) => 0.0,
            (true, false) => difference / allowed,
            (false, _) => f64::INFINITY,
        };
        let result = &mut self.channels[index];
        result.checked += 1;
        if result
            .worst
            .as_ref()
            .is_none_or(|worst| ratio > worst.ratio)
        {
            result.worst = Some(Worst {
                place: place(),
                difference,
                allowed,
                ratio,
            });
        }
        if !within {
            result.differing += 1;
            let (channel, unit) = (result.channel.clone(), result.unit.clone());
            let kind = DivergenceKind::Value {
                reference,
                candidate,
                difference,
                allowed,
            };
            self.diverge(order, &channel, &unit, place(), kind);
        }
    }

    fn tables(&mut self, reference: &Series, candidate: &Series) {
        let (rows, found_rows) = (reference.data().nrows(), candidate.data().nrows());
        let mut scales: HashMap<(&str, &str), f64> = HashMap::new();
        for (column, values) in reference.columns().iter().zip(reference.data().columns()) {
            let scale = scales
                .entry((vector_stem(&column.name), &column.unit))
                .or_default();
            *scale = values.iter().fold(*scale, larger_finite);
        }
        let label = |row: usize| row_label(reference, row);
        for (position, column) in reference.columns().iter().enumerate() {
            let (name, unit) = (column.name.as_str(), column.unit.as_str());
            let Some(tolerance) = self.open(name, unit) else {
                continue;
            };
            let index = self.channels.len() - 1;
            let found = candidate
                .columns()
                .iter()
                .position(|other| other.name == name);
            let kind = match found.map(|found| &candidate.columns()[found].unit) {
                None => Some(DivergenceKind::MissingChannel),
                Some(other) if other != unit => Some(DivergenceKind::Unit {
                    reference: unit.into(),
                    candidate: other.clone(),
                }),
                Some(_) => None,
            };
            if let Some(kind) = kind {
                self.channels[index].differing += 1;
                self.diverge((0, position), name, unit, String::new(), kind);
                continue;
            }
            let scale = scales[&(vector_stem(name), unit)];
            let values = candidate.column(name).expect("the column was found above");
            for (row, (&expected, &value)) in reference
                .data()
                .column(position)
                .iter()
                .zip(values)
                .enumerate()
            {
                let order = (row + 1, position);
                self.real(
                    index,
                    order,
                    &|| label(row),
                    expected,
                    value,
                    (tolerance, scale),
                );
            }
            if rows != found_rows {
                let shorter = rows.min(found_rows);
                let kind = DivergenceKind::Length {
                    reference: rows,
                    candidate: found_rows,
                };
                self.channels[index].differing += 1;
                let place = format!("row {}", shorter + 1);
                self.diverge((shorter + 1, position), name, unit, place, kind);
            }
        }
        for column in candidate.columns() {
            if reference.column(&column.name).is_none() {
                self.only_in_candidate
                    .push(format!("{}: {}", self.file, column.name));
            }
        }
    }

    fn trees(&mut self, reference: &[Leaf], candidate: &[Leaf]) {
        let found: HashMap<&str, &Leaf> = candidate
            .iter()
            .map(|leaf| (leaf.path.as_str(), leaf))
            .collect();
        let mut scales: HashMap<(&str, &str), f64> = HashMap::new();
        for leaf in reference {
            if let Some(value) = leaf.value.as_real() {
                let scale = scales
                    .entry((vector_stem(&leaf.channel), &leaf.unit))
                    .or_default();
                *scale = larger_finite(*scale, &value);
            }
        }
        // Channel → its number in `self.channels` and its tolerance, `None` if it is left out.
        let mut opened: BTreeMap<&str, Option<(usize, Tolerance)>> = BTreeMap::new();
        for (position, leaf) in reference.iter().enumerate() {
            let channel = leaf.channel.as_str();
            if !opened.contains_key(channel) {
                let tolerance = self.open(channel, &leaf.unit);
                opened.insert(channel, tolerance.map(|t| (self.channels.len() - 1, t)));
            }
            let Some((index, tolerance)) = opened[channel] else {
                continue;
            };
            let order = (position + 1, 0);
            let place = || tree_label(&leaf.path);
            let Some(other) = found.get(leaf.path.as_str()) else {
                self.channels[index].differing += 1;
                let kind = DivergenceKind::MissingChannel;
                self.diverge(order, channel, &leaf.unit, place(), kind);
                continue;
            };
            if let Some(kind) = self.unlike(leaf, other) {
                self.channels[index].checked += 1;
                self.channels[index].differing += 1;
                self.diverge(order, channel, &leaf.unit, place(), kind);
                continue;
            }
            match (&leaf.value, other.value.as_real()) {
                (LeafValue::Real(expected), Some(value)) => {
                    let scale = scales[&(vector_stem(channel), leaf.unit.as_str())];
                    self.real(index, order, &place, *expected, value, (tolerance, scale));
                }
                _ => self.channels[index].checked += 1,
            }
        }
        self.further_leaves(reference, candidate, &opened);
    }

    /// A difference that is none of numbers: unit, kind of value, string, integer.
    fn unlike(&self, reference: &Leaf, candidate: &Leaf) -> Option<DivergenceKind> {
        if reference.unit != candidate.unit {
            let (reference, candidate) = (reference.unit.clone(), candidate.unit.clone());
            return Some(DivergenceKind::Unit {
                reference,
                candidate,
            });
        }
        let same = match (&reference.value, &candidate.value) {
            (LeafValue::Real(_), other) => other.as_real().is_some(),
            (LeafValue::Integer(expected), LeafValue::Real(value)) => *expected as f64 == *value,
            (expected, value) => expected == value,
        };
        (!same).then(|| DivergenceKind::Exact {
            reference: reference.value.to_string(),
            candidate: candidate.value.to_string(),
        })
    }

    /// A list that is longer in the candidate is a difference; a further channel is only listed.
    fn further_leaves(
        &mut self,
        reference: &[Leaf],
        candidate: &[Leaf],
        opened: &BTreeMap<&str, Option<(usize, Tolerance)>>,
    ) {
        let known: HashSet<&str> = reference.iter().map(|leaf| leaf.path.as_str()).collect();
        let mut listed = HashSet::new();
        for leaf in candidate
            .iter()
            .filter(|leaf| !known.contains(leaf.path.as_str()))
        {
            match opened.get(leaf.channel.as_str()) {
                Some(Some((index, _))) => {
                    self.channels[*index].differing += 1;
                    let order = (reference.len() + 1, 0);
                    let place = tree_label(&leaf.path);
                    let kind = DivergenceKind::OnlyInCandidate;
                    self.diverge(order, &leaf.channel, &leaf.unit, place, kind);
                }
                Some(None) => {}
                None if listed.insert(leaf.channel.as_str()) => {
                    self.only_in_candidate
                        .push(format!("{}: {}", self.file, leaf.channel));
                }
                None => {}
            }
        }
    }
}

fn larger_finite(largest: f64, value: &f64) -> f64 {
    match value.is_finite() {
        true => largest.max(value.abs()),
        false => largest,
    }
}

/// `row 3 (time = 0.2 s, ball 3)`.
fn row_label(series: &Series, row: usize) -> String {
    let mut known = Vec::new();
    for column in series.columns() {
        let value = || {
            series
                .column(&column.name)
                .map_or(f64::NAN, |values| values[row])
        };
        match column.name.as_str() {
            "time" => known.push(format!("time = {} {}", value(), column.unit)),
            "ball" | "element" | "node" => known.push(format!("{} {}", column.name, value())),
            _ => {}
        }
    }
    match known.is_empty() {
        true => format!("row {}", row + 1),
        false => format!("row {} ({})", row + 1, known.join(", ")),
    }
}

/// `balls[2].inner.load (ball 3)`.
fn tree_label(path: &str) -> String {
    let ball = path
        .strip_prefix("balls[")
        .and_then(|rest| rest.split_once(']'))
        .and_then(|(index, _)| index.parse::<usize>().ok());
    match ball {
        Some(index) => format!("{path} (ball {})", index + 1),
        None => path.to_string(),
    }
}
