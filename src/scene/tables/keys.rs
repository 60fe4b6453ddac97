//! The key table: every key of a scene with its kind, range, default and meaning.
//!
//! The reader, the refusal of unknown keys, `docs/scene.md` and the JSON Schema follow this table.

use crate::scene::tables::{assembly, bearing, dynamics, housing, sensor, shaft, solid};
use crate::scene::text::units::{Dimension, parse_quantity};
use std::collections::HashMap;
use std::sync::LazyLock;

/// Allowed interval of a number, in `unit` (empty for a plain number).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub low: f64,
    pub high: f64,
    /// The bounds themselves are allowed.
    pub low_included: bool,
    pub high_included: bool,
    pub unit: &'static str,
}

impl Range {
    /// Returns whether `value`, in SI for a quantity of `dimension`, is in the interval; false for NaN.
    pub fn contains(&self, value: f64, dimension: Option<Dimension>) -> bool {
        let unit = dimension.and_then(|dimension| dimension.find(self.unit));
        let scale = unit.map_or(1.0, |unit| unit.scale.factor());
        let (low, high) = (self.low * scale, self.high * scale);
        let above = if self.low_included { value >= low } else { value > low };
        let below = if self.high_included { value <= high } else { value < high };
        above && below
    }
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let gap = if self.unit.is_empty() { "" } else { " " };
        let low = if self.low_included { "from" } else { "more than" };
        let high = if self.high_included { "to" } else { "to less than" };
        let number = crate::scene::text::units::plain;
        write!(
            f,
            "{low} {}{gap}{unit} {high} {}{gap}{unit}",
            number(self.low),
            number(self.high),
            unit = self.unit
        )
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Text,
    Boolean,
    Integer {
        low: i64,
        high: i64,
    },
    Choice(&'static [&'static str]),
    /// A list of distinct words of this list.
    Choices(&'static [&'static str]),
    Number(Range),
    /// A string of a number and a unit.
    Quantity(Dimension, Range),
    /// A list of three quantities along X, Y and Z.
    Vector(Dimension, Range),
    /// A quantity, or a table that describes it over time.
    Profile(Dimension, Range),
    /// A plain number or quantity of one of these kinds; another key selects which.
    Either(&'static [Kind]),
    /// A list of quantities, strictly increasing.
    Quantities(Dimension, Range),
    /// A list of quantities in any order, one for each of several equal parts.
    QuantityList(Dimension, Range),
    /// `true` for fixed at zero, or a profile.
    TrueOrProfile(Dimension, Range),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Need {
    Required,
    Optional,
    /// Required, defaulted or refused depending on other keys, as the text states.
    Depends(&'static str),
    /// `value` if absent; the reason is shown with the results.
    Default {
        value: &'static str,
        reason: &'static str,
    },
    /// Value and reason in each set of defaults.
    BySet {
        dissertation: (&'static str, &'static str),
        engineering: (&'static str, &'static str),
    },
}

/// Key of the units of numbers without one.
pub const UNITS: &str = "units";
pub const SI: &str = "SI";

/// Key that chooses the set of defaults.
pub const DEFAULTS: &str = "defaults";
pub const DEFAULT_SETS: &[&str] = &["engineering", "dissertation"];

impl Need {
    /// Default value and its reason in a set of defaults.
    pub fn default_in(self, set: &str) -> Option<(&'static str, &'static str)> {
        match self {
            Need::Default { value, reason } => Some((value, reason)),
            Need::BySet { dissertation, .. } if set == "dissertation" => Some(dissertation),
            Need::BySet { engineering, .. } => Some(engineering),
            Need::Required | Need::Optional | Need::Depends(_) => None,
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Key {
    pub path: &'static str,
    pub kind: Kind,
    pub need: Need,
    /// Keys of one table with the same non-empty group exclude each other. A key that may also be a
    /// table excludes that table's keys of its group.
    pub group: &'static str,
    pub doc: &'static str,
    /// Advice for a value outside the range.
    pub hint: &'static str,
    /// Path of a key that chooses a kind, law or method, and those of its words that use this key.
    pub only: Option<(&'static str, &'static [&'static str])>,
    /// Example value without quotes; empty for the usual one of its kind.
    example: &'static str,
}

impl Key {
    pub(crate) const fn new(path: &'static str, kind: Kind, need: Need, doc: &'static str) -> Key {
        Key { path, kind, need, group: "", doc, hint: "", only: None, example: "" }
    }

    pub(crate) const fn group(mut self, group: &'static str) -> Key {
        self.group = group;
        self
    }

    pub(crate) const fn hint(mut self, hint: &'static str) -> Key {
        self.hint = hint;
        self
    }

    pub(crate) const fn only(
        mut self,
        choice: &'static str,
        words: &'static [&'static str],
    ) -> Key {
        self.only = Some((choice, words));
        self
    }

    pub(crate) const fn example_of(mut self, example: &'static str) -> Key {
        self.example = example;
        self
    }

    /// Path of the table that contains the key.
    pub fn table(&self) -> &'static str {
        self.path.rsplit_once('.').map_or("", |(table, _)| table)
    }

    /// The key's own name, without its table.
    pub fn name(&self) -> &'static str {
        self.path.rsplit_once('.').map_or(self.path, |(_, name)| name)
    }

    /// Returns whether the key belongs to a list of tables and so has no single value.
    pub fn in_list(&self) -> bool {
        find_table(self.table()).is_some_and(|table| table.list)
    }

    /// The other keys of the same exclusive group.
    pub fn rivals(&'static self) -> impl Iterator<Item = &'static Key> {
        KEYS.iter().filter(|other| {
            !self.group.is_empty()
                && other.group == self.group
                && other.path != self.path
                && (other.table() == self.table()
                    || other.table() == self.path
                    || other.path == self.table())
        })
    }

    /// Usual unit of the key's values: that of its example, or of its bounds.
    pub fn usual_unit(&self, dimension: Dimension, range: Range) -> &'static str {
        let of = |example: &'static str| Some(parse_quantity(example, dimension).ok()?.unit);
        let unit = of(self.example).or_else(|| of(usual(dimension, range)));
        unit.unwrap_or(range.unit)
    }

    /// Example value in TOML syntax.
    pub fn example(&self) -> String {
        let or = |usual: &'static str| if self.example.is_empty() { usual } else { self.example };
        match self.kind {
            Kind::Text => "\"...\"".to_string(),
            Kind::Boolean => "true".to_string(),
            Kind::Integer { .. } => or("8").to_string(),
            Kind::Choice(choices) => format!("\"{}\"", choices[0]),
            Kind::Choices(choices) => format!("[\"{}\"]", choices[0]),
            Kind::Number(_) => or("0.3").to_string(),
            Kind::Quantity(dimension, range) | Kind::Profile(dimension, range) => {
                format!("\"{}\"", or(usual(dimension, range)))
            }
            Kind::Either(_) => or("0.1").to_string(),
            Kind::QuantityList(dimension, range) => {
                format!("[\"{0}\", \"{0}\"]", or(usual(dimension, range)))
            }
            Kind::Quantities(dimension, range) => {
                format!("[\"{}\", \"100 {}\"]", or(usual(dimension, range)), range.unit)
            }
            Kind::TrueOrProfile(..) => "true".to_string(),
            Kind::Vector(dimension, range) => {
                format!("[\"0 {0}\", \"0 {0}\", \"{1}\"]", range.unit, or(usual(dimension, range)))
            }
        }
    }
}

fn usual(dimension: Dimension, range: Range) -> &'static str {
    let small = dimension == Dimension::Length && range.unit == "um";
    if small { "5 um" } else { dimension.usual() }
}

pub(crate) const fn open(low: f64, high: f64, unit: &'static str) -> Range {
    Range { low, high, low_included: false, high_included: false, unit }
}

pub(crate) const fn closed(low: f64, high: f64, unit: &'static str) -> Range {
    Range { low, high, low_included: true, high_included: true, unit }
}

/// More than `low`, up to `high`.
pub(crate) const fn above(low: f64, high: f64, unit: &'static str) -> Range {
    Range { low, high, low_included: false, high_included: true, unit }
}

/// A table of a scene, with an example.
#[derive(Clone, Copy)]
pub struct Table {
    pub path: &'static str,
    pub doc: &'static str,
    pub example: &'static str,
    /// True for a list of tables, `[[path]]`.
    pub list: bool,
}

pub(crate) const fn table(path: &'static str, doc: &'static str, example: &'static str) -> Table {
    Table { path, doc, example, list: false }
}

pub(crate) const fn list_table(
    path: &'static str,
    doc: &'static str,
    example: &'static str,
) -> Table {
    Table { path, doc, example, list: true }
}

/// Every key, in the order of the reference.
pub static KEYS: &[Key] = &ALL_KEYS;

/// Every table, in the order of the reference. `assumptions` and `sweep` have user-defined keys.
pub static TABLES: &[Table] = &ALL_TABLES;

const PARTS: [&[Key]; 7] = [
    bearing::KEYS,
    dynamics::KEYS,
    assembly::KEYS,
    shaft::KEYS,
    solid::KEYS,
    housing::KEYS,
    sensor::KEYS,
];
const TABLE_PARTS: [&[Table]; 7] = [
    bearing::TABLES,
    dynamics::TABLES,
    assembly::TABLES,
    shaft::TABLES,
    solid::TABLES,
    housing::TABLES,
    sensor::TABLES,
];

static ALL_KEYS: [Key; count(&PARTS)] = joined(&PARTS, bearing::KEYS[0]);
static ALL_TABLES: [Table; count(&TABLE_PARTS)] = joined(&TABLE_PARTS, bearing::TABLES[0]);

const fn count<T>(parts: &[&[T]]) -> usize {
    let mut sum = 0;
    let mut part = 0;
    while part < parts.len() {
        sum += parts[part].len();
        part += 1;
    }
    sum
}

/// All rows of the parts in one array, initialised with `first`.
const fn joined<T: Copy, const N: usize>(parts: &[&[T]], first: T) -> [T; N] {
    let mut all = [first; N];
    let (mut at, mut part) = (0, 0);
    while part < parts.len() {
        let mut i = 0;
        while i < parts[part].len() {
            all[at] = parts[part][i];
            at += 1;
            i += 1;
        }
        part += 1;
    }
    all
}

static INDEX: LazyLock<HashMap<&'static str, usize>> =
    LazyLock::new(|| KEYS.iter().enumerate().map(|(i, key)| (key.path, i)).collect());

/// Row of the key with this dotted path.
pub fn find(path: &str) -> Option<(usize, &'static Key)> {
    INDEX.get(path).map(|&i| (i, &KEYS[i]))
}

/// Tables that may occur several times, each with a name: `[bearing.left]`. All of them inherit the keys
/// of the table without a name.
pub const NAMED: [&str; 8] =
    ["bearing", "inner_race", "outer_race", "body", "spring", "housing", "solid", "sensor"];

/// Tables of [`NAMED`] with names of their own; all others use the names of bearings.
pub const OWN_NAMES: [&str; 3] = ["body", "spring", "sensor"];

/// The table whose names a table of [`NAMED`] uses.
pub(crate) fn kind_of_names(table: &'static str) -> &'static str {
    if OWN_NAMES.contains(&table) { table } else { "bearing" }
}

/// Key that a dotted path refers to.
#[derive(Clone, Copy, Debug)]
pub struct Leads<'p> {
    pub row: usize,
    pub key: &'static Key,
    /// Name of the table: `left` of `bearing.left.clearance.radial`.
    pub name: Option<&'p str>,
    /// Index in a list of tables, counted from 1: 2 of `body.shaft.beam.disc.2.mass`.
    pub item: Option<usize>,
}

/// Finds the key of a path with or without a table name and an index in a list.
pub fn find_named(path: &str) -> Option<Leads<'_>> {
    let mut parts: Vec<&str> = path.split('.').collect();
    let is_number = |part: &&str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    let at = parts.iter().position(is_number);
    let item = match at {
        Some(at) => Some(parts.remove(at).parse().ok()?),
        None => None,
    };
    // The key's name directly follows the index in a list.
    let fits = |key: &Key, parts: usize| at.is_none_or(|at| key.in_list() && at == parts - 1);
    if let Some((row, key)) = find(&parts.join(".")).filter(|(_, key)| fits(key, parts.len())) {
        return Some(Leads { row, key, name: None, item });
    }
    if parts.len() < 3 || !NAMED.contains(&parts[0]) {
        return None;
    }
    let count = parts.len();
    let name = parts.remove(1);
    let (row, key) = find(&parts.join(".")).filter(|(_, key)| fits(key, count))?;
    Some(Leads { row, key, name: Some(name), item })
}

/// Splits a table name from a path: `spring.stiffness` and `mount` from `spring.mount.stiffness`.
pub fn without_name(path: &str) -> (String, Option<&str>) {
    let parts: Vec<&str> = path.split('.').collect();
    match parts[..] {
        [table, name, _, ..]
            if NAMED.contains(&table)
                && !children(table).contains(&name)
                && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_') =>
        {
            ([&[table], &parts[2..]].concat().join("."), Some(name))
        }
        _ => (path.to_string(), None),
    }
}

pub fn find_table(path: &str) -> Option<&'static Table> {
    TABLES.iter().find(|table| table.path == path)
}

/// Names of the keys and tables directly inside the table `path` (empty for the top).
pub fn children(path: &str) -> Vec<&'static str> {
    let mut names = Vec::new();
    let paths = KEYS.iter().map(|key| key.path).chain(TABLES.iter().map(|table| table.path));
    for known in paths {
        let inside = match path {
            "" => Some(known),
            _ => known.strip_prefix(path).and_then(|rest| rest.strip_prefix('.')),
        };
        let name = inside.and_then(|rest| rest.split('.').next());
        if let Some(name) = name.filter(|name| !names.contains(name)) {
            names.push(name);
        }
    }
    names
}

/// Common synonyms of keys.
const OTHER_WORDS: [(&str, &str); 6] = [
    ("force", "load"),
    ("couple", "moment"),
    ("angle", "tilt"),
    ("rotation", "tilt"),
    ("rpm", "speed"),
    ("velocity", "speed"),
];

/// The key or table that was probably meant by the unknown key `name` of the table `path`: a similar one
/// of the same table, else one of the same or nearly the same name in another table.
pub fn nearest_key(path: &str, name: &str) -> Option<String> {
    let dotted = |name: &str| match path {
        "" => name.to_string(),
        _ => format!("{path}.{name}"),
    };
    if let Some(sibling) = nearest(name, children(path).into_iter(), 0.6) {
        return Some(dotted(sibling));
    }
    let other = OTHER_WORDS.iter().find(|(word, _)| word.eq_ignore_ascii_case(name));
    if let Some((_, own)) = other.filter(|(_, own)| children(path).contains(own)) {
        return Some(dotted(own));
    }
    let last = name.rsplit('.').next().unwrap_or(name);
    let elsewhere = nearest(last, KEYS.iter().map(Key::name), 0.8).or_else(|| {
        let tables = TABLES.iter().filter_map(|table| table.path.rsplit('.').next());
        nearest(last, tables, 0.8)
    });
    // Of several keys with that name, take the most similar whole path.
    let full = dotted(name);
    let found = elsewhere.and_then(|name| {
        let known = || KEYS.iter().map(|key| key.path).chain(TABLES.iter().map(|table| table.path));
        let is_name = move |path: &&str| path.rsplit('.').next() == Some(name);
        let same_name = || known().filter(is_name);
        // Prefer keys under the same top-level table.
        let top = |path: &str| path.split('.').next().unwrap_or_default().to_string();
        let same_top = same_name().filter(|path| top(path) == top(&full));
        nearest(&full, same_top, 0.0).or_else(|| nearest(&full, same_name(), 0.0))
    });
    found.map(str::to_string)
}

/// The candidate most similar to `word` (ignoring case); `None` if all are below `similarity` (0 to 1).
pub fn nearest<'c>(
    word: &str,
    candidates: impl Iterator<Item = &'c str>,
    similarity: f64,
) -> Option<&'c str> {
    // Bounds the time of the comparison; a mistyped key is not this long.
    if word.len() > 60 {
        return None;
    }
    let word = word.to_lowercase();
    let mut best: Option<(&str, f64)> = None;
    for candidate in candidates {
        let alike = strsim::normalized_damerau_levenshtein(&word, &candidate.to_lowercase());
        if alike >= similarity && best.is_none_or(|(_, most)| alike > most) {
            best = Some((candidate, alike));
        }
    }
    best.map(|(candidate, _)| candidate)
}
