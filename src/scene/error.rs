//! Errors of scenes. Every message states the position, the problem, the allowed values and a hint.

use crate::scene::text::units::Dimension;
use std::fmt;
use thiserror::Error;

/// Position in the input: file name, and line and column, if any, counted from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    pub file: String,
    pub line_and_column: Option<(usize, usize)>,
}

impl Place {
    /// The file as a whole.
    pub fn file(name: &str) -> Place {
        Place { file: name.to_string(), line_and_column: None }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line_and_column {
            Some((line, column)) => write!(f, "{}:{line}:{column}", self.file),
            None => write!(f, "{}", self.file),
        }
    }
}

/// First error of a scene.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{place}: {}{problem}", prefix(key))]
pub struct SceneError {
    pub place: Place,
    /// Dotted key; empty for the file as a whole.
    pub key: String,
    pub problem: Box<Problem>,
}

fn prefix(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!("{}: ", shortened(key)) }
}

impl Problem {
    /// A length that is not more or less than another one, m.
    pub(crate) fn order(
        value: f64,
        relation: &str,
        (other_name, other): (&str, f64),
        hint: &str,
    ) -> Problem {
        let (value, other) = (mm(value), mm(other));
        Problem::Contradiction(format!(
            "{value} is not {relation} {other_name}, {other}. Allowed: {relation} {other}. Hint: {hint}"
        ))
    }

    /// A time (s) after the end of a run, or not before it.
    pub(crate) fn after_the_end(value: f64, end: f64, may_be_equal: bool) -> Problem {
        let (value, end) = (nine_digits(value), nine_digits(end));
        let [relation, allowed] =
            if may_be_equal { ["after", "up to"] } else { ["not before", "less than"] };
        Problem::Contradiction(format!(
            "a time of {value} s is {relation} the end of the run, {end} s. Allowed: {allowed} {end} s. Hint: check the \
             units of both"
        ))
    }

    /// Refused for a reason, which may end with a hint.
    pub(crate) fn refused(reason: impl Into<String>) -> Problem {
        Problem::Refused { reason: reason.into() }
    }
}

impl SceneError {
    pub(crate) fn new(place: Place, key: &str, problem: Problem) -> SceneError {
        SceneError { place, key: key.to_string(), problem: Box::new(problem) }
    }
}

/// A text from the user's file for a message: at most 60 characters, without control characters.
pub(crate) fn shortened(text: &str) -> String {
    const LONGEST: usize = 60;
    let mut short: String =
        text.chars().take(LONGEST).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().nth(LONGEST).is_some() {
        short.push('…');
    }
    short
}

fn tables(count: usize) -> String {
    match count {
        0 => "no tables".to_string(),
        1 => "one table".to_string(),
        _ => format!("{count} tables"),
    }
}

fn numbers(count: usize) -> String {
    match count {
        0 => "nothing".to_string(),
        1 => "1".to_string(),
        _ => format!("1 to {count}"),
    }
}

fn meant(nearest: &Option<String>, otherwise: &str) -> String {
    match nearest {
        Some(nearest) => format!("did you mean `{nearest}`?"),
        None => otherwise.to_string(),
    }
}

fn or_check(advice: &str) -> &str {
    if advice.is_empty() { "check the number and its unit" } else { advice }
}

fn hint(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!(". Hint: {text}") }
}

/// Problem of a scene. Lengths in m; `written` is the value as written in the file.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Problem {
    #[error("there is no such file. Hint: check the path and the folder you are in")]
    NoSuchFile,
    #[error("this is a folder. Hint: name a .toml or .json file inside it")]
    IsFolder,
    #[error("this is not a regular file. Hint: give a .toml or .json file")]
    NotRegularFile,
    #[error("cannot be read: {reason}. Hint: check the file's permissions")]
    Unreadable { reason: String },
    #[error(
        "has {bytes} bytes. Allowed: up to {limit} bytes. Hint: a scene is a few kilobytes; \
         is this the right file?"
    )]
    TooLarge { bytes: u64, limit: u64 },
    #[error(
        "unknown kind of scene file. Allowed: a name that ends in .toml or .json. Hint: rename it"
    )]
    UnknownFormat,
    #[error("the file is empty. Hint: the smallest scene has a [bearing] table, see docs/scene.md")]
    Empty,
    #[error("not valid UTF-8 from here on. Hint: save the file as UTF-8{0}", if *.utf16 { " (it looks like UTF-16)" } else { "" })]
    NotUtf8 { utf16: bool },
    #[error("a NUL byte. Hint: this is not a text file, or it is damaged")]
    NulByte,
    #[error(
        "nested deeper than {limit} levels. Allowed: up to {limit}. Hint: a scene needs four; check for unclosed brackets and long dotted keys"
    )]
    TooDeep { limit: usize },
    #[error("not valid {format}: {message}{}", hint(.advice))]
    Syntax { format: &'static str, message: String, advice: &'static str },
    #[error(
        "a scene is a table of keys, found {found}. Hint: start with {{ \"bearing\": {{ ... }} }}"
    )]
    NotATable { found: &'static str },
    #[error("unknown key. Allowed here: {allowed}. Hint: {}", meant(.nearest, "see docs/scene.md"))]
    UnknownKey { nearest: Option<String>, allowed: String },
    #[error("the key is given twice. Hint: keep one of them")]
    DuplicateKey,
    #[error("expected {expected}, found {found}{}", hint(.advice))]
    WrongKind { expected: String, found: String, advice: String },
    #[error(
        "{written} has no unit, but this is {}. Allowed units: {}. Hint: write for instance \"{number} {suggested}\"",
        .dimension.name(), .dimension.unit_list()
    )]
    MissingUnit { written: String, number: String, dimension: Dimension, suggested: &'static str },
    #[error(
        "{written}: `{unit}` is a unit of {}, but this is {}. Allowed units: {}. Hint: use one of them",
        article(.belongs_to), .dimension.name(), .dimension.unit_list()
    )]
    WrongUnit { written: String, unit: String, belongs_to: Dimension, dimension: Dimension },
    #[error(
        "{written}: unknown unit `{unit}` for {}. Allowed units: {}. Hint: {}",
        .dimension.name(), .dimension.unit_list(), meant(.nearest, "use one of them; capitals matter")
    )]
    UnknownUnit { written: String, unit: String, dimension: Dimension, nearest: Option<String> },
    #[error(
        "{written} has a unit, but this is a plain number. Allowed: {allowed}. Hint: leave out the unit"
    )]
    UnitOnPlainNumber { written: String, allowed: String },
    #[error("{written} is not {wanted}. Allowed: {allowed}. Hint: write for instance {example}")]
    NotANumber { written: String, wanted: &'static str, allowed: String, example: String },
    #[error(
        "{written} has a comma. Allowed: {allowed}. Hint: write a decimal point, as in \"20.047 mm\""
    )]
    DecimalComma { written: String, allowed: String },
    #[error(
        "{written} is NaN, infinite or too large. Allowed: {allowed}. Hint: write a decimal number"
    )]
    NotFinite { written: String, allowed: String },
    #[error("{written} is outside the allowed range. Allowed: {allowed}. Hint: {}", or_check(.advice))]
    OutOfRange { written: String, allowed: String, advice: &'static str },
    #[error("unknown value {written}. Allowed: {}. Hint: {}", quoted_list(.allowed), meant(.nearest, "use one of these words"))]
    UnknownChoice { written: String, nearest: Option<String>, allowed: &'static [&'static str] },
    #[error("{written} appears twice in the list. Hint: keep one")]
    RepeatedChoice { written: String },
    #[error(
        "expected a list of three values along X, Y and Z, found {found}. Hint: write for instance {example}"
    )]
    NotThreeValues { found: usize, example: String },

    #[error(
        "{written} is not larger than the entry before it. Allowed: strictly increasing values. Hint: put the \
         entries in order"
    )]
    NotIncreasing { written: String },

    #[error("missing{because}. Hint: add {example}")]
    Missing { because: String, example: String },
    #[error("given together with `{rival}`. Allowed: exactly one of the two. Hint: {advice}")]
    Exclusive { rival: String, advice: String },
    #[error("refused: {reason}{}", if .reason.contains(". Hint: ") { "" } else { ". Hint: leave it out" })]
    Refused { reason: String },

    /// A contradiction of sizes, times or masses, with what is allowed and a hint.
    #[error("{0}")]
    Contradiction(String),

    #[error("not a list or range of values: {written}{}. Hint: write \"5 um, 0 um\" or \"0 deg .. 45 deg / 91\"", because(.reason))]
    BadSweep { written: String, reason: String },
    #[error(
        "this key cannot be varied. Hint: vary a number, a quantity or a choice, such as bearing.clearance.radial"
    )]
    NotSweepable,
    #[error(
        "this key is in a list of tables. Hint: give the number of the table, counted from 1, as in {example}"
    )]
    WhichItem { example: String },
    #[error(
        "this list has {}. Allowed: {}. Hint: {}",
        tables(*.count), numbers(*.count), if *.count == 0 { "write the list in the scene" } else { "check the number" }
    )]
    NoSuchItem { count: usize },
}

fn because(reason: &str) -> String {
    if reason.is_empty() { String::new() } else { format!(" ({reason})") }
}

fn article(dimension: &Dimension) -> &'static str {
    let name = dimension.name();
    name.split_once(' ').map_or(name, |(_, noun)| noun)
}

fn quoted_list(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    quoted.join(", ")
}

/// A length in mm to nine digits, enough to show what was written.
pub(crate) fn mm(metres: f64) -> String {
    format!("{} mm", nine_digits(metres * 1e3))
}

pub(crate) fn um(metres: f64) -> String {
    format!("{} um", nine_digits(metres * 1e6))
}

fn nine_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    crate::scene::text::units::plain(rounded)
}
