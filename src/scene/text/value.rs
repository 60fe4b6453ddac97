//! Checks a written value against its row of the key table: kind, unit and range.

use crate::numeric::profile::Profile;
use crate::scene::error::{Problem, shortened};
use crate::scene::resolve::profile;
use crate::scene::tables::keys::{Key, Kind, Range, nearest};
use crate::scene::text::sweep::SweepAxis;
use crate::scene::text::tree::{Node, Value};
use crate::scene::text::units::{Dimension, QuantityProblem, parse_number, parse_quantity};

/// A value that its key accepts; quantities in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Checked {
    Text(String),
    Boolean(bool),
    Integer(i64),
    Number(f64),
    Vector([f64; 3]),
    Choice(&'static str),
    Choices(Vec<&'static str>),
    /// A profile that is written as a table; a constant one is a `Number`.
    Profile(Profile),
    /// Index of the kind in [`Kind::Either`], and the value.
    Either(usize, f64),
    Quantities(Vec<f64>),
    /// A key varied by `[sweep]`.
    Axis(SweepAxis),
}

impl Checked {
    pub fn text(&self) -> Option<&str> {
        if let Checked::Text(text) = self { Some(text) } else { None }
    }

    pub fn boolean(&self) -> Option<bool> {
        if let Checked::Boolean(value) = self { Some(*value) } else { None }
    }

    pub fn choice(&self) -> Option<&'static str> {
        if let Checked::Choice(word) = self { Some(word) } else { None }
    }

    pub fn number(&self) -> Option<f64> {
        match self {
            Checked::Number(value) => Some(*value),
            Checked::Integer(value) => Some(*value as f64),
            _ => None,
        }
    }

    pub fn vector(&self) -> Option<[f64; 3]> {
        if let Checked::Vector(value) = self { Some(*value) } else { None }
    }

    /// A quantity over time; a plain one is constant, and `true` is zero.
    pub fn profile(&self) -> Option<Profile> {
        match self {
            Checked::Number(value) => Some(Profile::Constant(*value)),
            Checked::Boolean(true) => Some(Profile::ZERO),
            Checked::Profile(profile) => Some(profile.clone()),
            _ => None,
        }
    }
}

impl From<f64> for Checked {
    fn from(value: f64) -> Checked {
        Checked::Number(value)
    }
}

impl From<String> for Checked {
    fn from(text: String) -> Checked {
        Checked::Text(text)
    }
}

impl From<bool> for Checked {
    fn from(value: bool) -> Checked {
        Checked::Boolean(value)
    }
}

impl From<&'static str> for Checked {
    fn from(word: &'static str) -> Checked {
        Checked::Choice(word)
    }
}

/// A problem and the offset of the element of a list or profile that has it.
#[derive(Debug)]
pub struct ValueError {
    pub offset: usize,
    /// Key inside the profile, empty elsewhere.
    pub within: String,
    pub problem: Problem,
}

impl From<(usize, Problem)> for ValueError {
    fn from((offset, problem): (usize, Problem)) -> ValueError {
        ValueError { offset, within: String::new(), problem }
    }
}

/// Checks a value. `in_si`: a number without a unit is a quantity in SI.
pub fn check(key: &'static Key, node: &Node, in_si: bool) -> Result<Checked, ValueError> {
    let here = |problem| ValueError::from((node.offset, problem));
    match (key.kind, &node.value) {
        (Kind::Text, Value::Text(text)) => Ok(Checked::Text(text.clone())),
        (Kind::Boolean, Value::Boolean(value)) => Ok(Checked::Boolean(*value)),
        (Kind::Integer { low, high }, Value::Number(text)) => {
            integer(key, text, low, high).map(Checked::Integer).map_err(here)
        }
        (Kind::Choice(choices), Value::Text(text)) => {
            choice(text, choices).map(Checked::Choice).map_err(here)
        }
        (Kind::Choices(choices), Value::List(items)) => choice_list(items, choices, key),
        (Kind::Number(range), Value::Number(text)) => {
            number(key, text, range).map(Checked::Number).map_err(here)
        }
        (
            Kind::Quantity(dimension, range)
            | Kind::Profile(dimension, range)
            | Kind::TrueOrProfile(dimension, range),
            Value::Text(_) | Value::Number(_),
        ) => quantity(key, &node.value, dimension, range, in_si).map(Checked::Number).map_err(here),
        (Kind::Vector(dimension, range), Value::List(items)) => {
            let wrong_length =
                || Problem::NotThreeValues { found: items.len(), example: key.example() };
            let [x, y, z] = items.as_slice() else {
                return Err(here(wrong_length()));
            };
            let component = |item: &Node| match &item.value {
                Value::Text(_) | Value::Number(_) => {
                    quantity(key, &item.value, dimension, range, in_si)
                        .map_err(|p| (item.offset, p))
                }
                other => Err((item.offset, wrong_kind(key, other))),
            };
            Ok(Checked::Vector([component(x)?, component(y)?, component(z)?]))
        }
        (Kind::TrueOrProfile(..), Value::Boolean(value)) => Ok(Checked::Boolean(*value)),
        (
            Kind::Profile(dimension, range) | Kind::TrueOrProfile(dimension, range),
            Value::Table(entries),
        ) => profile::read(key, (dimension, range), entries, node.offset, in_si)
            .map(Checked::Profile),
        (Kind::Quantities(dimension, range), Value::List(items)) => {
            quantities(key, items, node.offset, (dimension, range), [true, in_si])
        }
        (Kind::QuantityList(dimension, range), Value::List(items)) => {
            quantities(key, items, node.offset, (dimension, range), [false, in_si])
        }
        (Kind::Either(kinds), Value::Text(_) | Value::Number(_)) => {
            either(key, kinds, &node.value).map_err(here)
        }
        (_, other) => Err(here(wrong_kind(key, other))),
    }
}

/// Checks a value given as bare text, as on the command line: `8`, `5 um`, `true`, `exact`.
pub fn check_bare(key: &'static Key, text: &str) -> Result<Checked, Problem> {
    let text = text.trim();
    let value = match key.kind {
        Kind::Integer { .. } | Kind::Number(_) => Value::Number(text.to_string()),
        Kind::Boolean | Kind::TrueOrProfile(..) => match text {
            "true" => Value::Boolean(true),
            "false" => Value::Boolean(false),
            _ => Value::Text(text.to_string()),
        },
        Kind::Either(_) if parse_number(text).is_ok() => Value::Number(text.to_string()),
        _ => Value::Text(text.to_string()),
    };
    check(key, &Node { value, offset: 0 }, false).map_err(|error| error.problem)
}

/// The default of the key table in a set of defaults.
pub fn default_in(key: &'static Key, set: &str) -> Option<Checked> {
    let (value, _) = key.need.default_in(set)?;
    match key.kind {
        // The default of all vectors and lists of words is `none`.
        Kind::Vector(..) => Some(Checked::Vector([0.0; 3])),
        Kind::Choices(words) => Some(Checked::Choices(
            words.iter().copied().filter(|w| value.split(", ").any(|v| v == *w)).collect(),
        )),
        _ => check_bare(key, value).ok(),
    }
}

fn either(key: &Key, kinds: &'static [Kind], value: &Value) -> Result<Checked, Problem> {
    let mut first_problem = None;
    for (index, kind) in kinds.iter().enumerate() {
        let taken = match (kind, value) {
            (Kind::Number(range), Value::Number(text)) => number(key, text, *range),
            (Kind::Quantity(dimension, range), Value::Text(_)) => {
                quantity(key, value, *dimension, *range, false)
            }
            _ => continue,
        };
        match taken {
            Ok(value) => return Ok(Checked::Either(index, value)),
            // If the unit belongs to another of the kinds, that kind decides.
            Err(Problem::WrongUnit { .. } | Problem::UnknownUnit { .. }) => {}
            Err(problem) => first_problem = first_problem.or(Some(problem)),
        }
    }
    Err(first_problem.unwrap_or_else(|| wrong_kind(key, value)))
}

fn quantities(
    key: &Key,
    items: &[Node],
    offset: usize,
    (dimension, range): (Dimension, Range),
    [increasing, in_si]: [bool; 2],
) -> Result<Checked, ValueError> {
    let mut values: Vec<f64> = Vec::new();
    for item in items {
        let value =
            quantity(key, &item.value, dimension, range, in_si).map_err(|p| (item.offset, p))?;
        if increasing && values.last().is_some_and(|last| value <= *last) {
            let written = shown(&item.value);
            return Err((item.offset, Problem::NotIncreasing { written }).into());
        }
        values.push(value);
    }
    if values.is_empty() {
        return Err((offset, wrong_kind(key, &Value::Other("an empty list"))).into());
    }
    Ok(Checked::Quantities(values))
}

fn expected(kind: Kind) -> String {
    match kind {
        Kind::Text => "a text in quotes".to_string(),
        Kind::Boolean => "true or false".to_string(),
        Kind::Integer { low, high } => format!("a whole number from {low} to {high}"),
        Kind::Choice(choices) => format!("one of {}", quoted(choices)),
        Kind::Choices(choices) => format!("a list of words from {}", quoted(choices)),
        Kind::Number(range) => format!("a plain number, {range}"),
        Kind::Quantity(dimension, range) => format!("{} with its unit, {range}", dimension.name()),
        Kind::Vector(dimension, _) => {
            format!("a list of three values with units, each {}", dimension.name())
        }
        Kind::Profile(dimension, range) => {
            format!("{} with its unit, {range}, or a profile of it over time", dimension.name())
        }
        Kind::Either(kinds) => {
            kinds.iter().map(|kind| expected(*kind)).collect::<Vec<_>>().join(", or ")
        }
        Kind::Quantities(dimension, _) => {
            format!("a list of increasing values with units, each {}", dimension.name())
        }
        Kind::QuantityList(dimension, _) => {
            format!("a list of values with units, each {}", dimension.name())
        }
        Kind::TrueOrProfile(dimension, range) => {
            format!(
                "true, or {} with its unit, {range}, or a profile of it over time",
                dimension.name()
            )
        }
    }
}

fn wrong_kind(key: &Key, found: &Value) -> Problem {
    // A choice that looks like a number, written without quotes.
    let meant = match (key.kind, found) {
        (Kind::Choice(choices), Value::Number(text)) => choices.iter().find(|word| **word == text),
        _ => None,
    };
    let example = meant.map_or_else(|| key.example(), |word| format!("\"{word}\""));
    Problem::WrongKind {
        expected: expected(key.kind),
        found: described(found),
        advice: format!("write {} = {example}", key.name()),
    }
}

pub(crate) fn described(found: &Value) -> String {
    match found {
        Value::Text(_) => format!("the text {}", shown(found)),
        Value::Number(_) => format!("the number {}", shown(found)),
        other => shown(other),
    }
}

/// A value as written in the file.
pub(crate) fn shown(value: &Value) -> String {
    match value {
        Value::Text(text) => format!("\"{}\"", shortened(text)),
        Value::Number(text) => shortened(text),
        Value::Boolean(value) => value.to_string(),
        other => other.description().to_string(),
    }
}

pub(crate) fn quoted(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    quoted.join(", ")
}

fn integer(key: &Key, text: &str, low: i64, high: i64) -> Result<i64, Problem> {
    let allowed = format!("a whole number from {low} to {high}");
    let written = shortened(text);
    let value = match text.parse::<i64>() {
        Ok(value) => value,
        Err(_) => match parse_number(text) {
            // Out of any range.
            Ok(value) if value.fract() == 0.0 && value.abs() > 1e15 => i64::MAX,
            Err(QuantityProblem::NotFinite) => return Err(Problem::NotFinite { written, allowed }),
            _ => {
                let example = key.example();
                return Err(Problem::NotANumber {
                    written,
                    wanted: "a whole number",
                    allowed,
                    example,
                });
            }
        },
    };
    if (low..=high).contains(&value) {
        Ok(value)
    } else {
        Err(Problem::OutOfRange { written, allowed, advice: key.hint })
    }
}

fn choice(text: &str, choices: &'static [&'static str]) -> Result<&'static str, Problem> {
    choices.iter().find(|choice| **choice == text).copied().ok_or_else(|| Problem::UnknownChoice {
        written: format!("\"{}\"", shortened(text)),
        nearest: meant(text, choices),
        allowed: choices,
    })
}

/// The choice most similar to `text`; `None` if two are equally similar.
fn meant(text: &str, choices: &'static [&'static str]) -> Option<String> {
    let first = nearest(text, choices.iter().copied(), 0.5);
    let last = nearest(text, choices.iter().rev().copied(), 0.5);
    first.filter(|_| first == last).map(str::to_string)
}

fn choice_list(
    items: &[Node],
    choices: &'static [&'static str],
    key: &Key,
) -> Result<Checked, ValueError> {
    let mut chosen = Vec::new();
    for item in items {
        let Value::Text(text) = &item.value else {
            return Err((item.offset, wrong_kind(key, &item.value)).into());
        };
        let word = choice(text, choices).map_err(|problem| (item.offset, problem))?;
        if chosen.contains(&word) {
            let written = format!("\"{word}\"");
            return Err((item.offset, Problem::RepeatedChoice { written }).into());
        }
        chosen.push(word);
    }
    Ok(Checked::Choices(chosen))
}

fn number(key: &Key, text: &str, range: Range) -> Result<f64, Problem> {
    let written = shortened(text);
    let value =
        parse_number(text).map_err(|problem| refused(key, problem, &written, range, None))?;
    in_range(key, value, written, range, None)
}

pub(crate) fn quantity(
    key: &Key,
    value: &Value,
    dimension: Dimension,
    range: Range,
    in_si: bool,
) -> Result<f64, Problem> {
    let (written, of) = (shown(value), Some(dimension));
    let si = match value {
        Value::Number(text) if in_si => parse_number(text),
        Value::Text(text) | Value::Number(text) => {
            parse_quantity(text, dimension).map(|quantity| quantity.si)
        }
        _ => return Err(wrong_kind(key, value)),
    };
    let si = si.map_err(|problem| refused(key, problem, &written, range, of))?;
    in_range(key, si, written, range, of)
}

/// Problem of a text that is no plain number, or no quantity of a dimension.
fn refused(
    key: &Key,
    problem: QuantityProblem,
    written: &str,
    range: Range,
    dimension: Option<Dimension>,
) -> Problem {
    let (written, allowed) = (written.to_string(), range.to_string());
    match (problem, dimension) {
        (QuantityProblem::NotFinite, _) => Problem::NotFinite { written, allowed },
        (QuantityProblem::DecimalComma, _) => Problem::DecimalComma { written, allowed },
        (QuantityProblem::NoUnit { number }, Some(dimension)) => {
            let (number, suggested) = (shortened(&number), key.usual_unit(dimension, range));
            Problem::MissingUnit { written, number, dimension, suggested }
        }
        (QuantityProblem::WrongDimension { unit, belongs_to }, Some(dimension)) => {
            Problem::WrongUnit { written, unit, belongs_to, dimension }
        }
        (QuantityProblem::UnknownUnit { unit, nearest, .. }, Some(dimension)) => {
            let (unit, nearest) = (shortened(&unit), nearest.map(str::to_string));
            Problem::UnknownUnit { written, unit, dimension, nearest }
        }
        (QuantityProblem::WrongDimension { .. } | QuantityProblem::UnknownUnit { .. }, None) => {
            Problem::UnitOnPlainNumber { written, allowed }
        }
        (QuantityProblem::NoNumber | QuantityProblem::NoUnit { .. }, of) => {
            let wanted = if of.is_some() { "a number with a unit" } else { "a number" };
            Problem::NotANumber { written, wanted, allowed, example: key.example() }
        }
    }
}

fn in_range(
    key: &Key,
    value: f64,
    written: String,
    range: Range,
    dimension: Option<Dimension>,
) -> Result<f64, Problem> {
    match range.contains(value, dimension) {
        true => Ok(value),
        false => Err(Problem::OutOfRange { written, allowed: range.to_string(), advice: key.hint }),
    }
}
