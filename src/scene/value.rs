//! One written value against its row of the key table: kind, unit and range.

use crate::scene::error::{Problem, shortened};
use crate::scene::keys::{Key, Kind, Range, nearest};
use crate::scene::tree::{Node, Value};
use crate::scene::units::{Dimension, QuantityProblem, parse_number, parse_quantity};

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
}

/// A problem and, inside a list, the offset of the element that has it.
pub type ValueError = (usize, Problem);

/// Checks `node` against `key`.
pub fn check(key: &'static Key, node: &Node) -> Result<Checked, ValueError> {
    let here = |problem| (node.offset, problem);
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
        (Kind::Quantity(dimension, range), Value::Text(_) | Value::Number(_)) => {
            quantity(key, &node.value, dimension, range).map(Checked::Number).map_err(here)
        }
        (Kind::Vector(dimension, range), Value::List(items)) => {
            let wrong_length =
                || Problem::NotThreeValues { found: items.len(), example: key.example() };
            let [x, y, z] = items.as_slice() else {
                return Err(here(wrong_length()));
            };
            let component = |item: &Node| match &item.value {
                Value::Text(_) | Value::Number(_) => {
                    quantity(key, &item.value, dimension, range).map_err(|p| (item.offset, p))
                }
                other => Err((item.offset, wrong_kind(key, other))),
            };
            Ok(Checked::Vector([component(x)?, component(y)?, component(z)?]))
        }
        (_, other) => Err(here(wrong_kind(key, other))),
    }
}

/// Checks a value given as bare text, as on the command line: `8`, `5 um`, `true`, `exact`.
pub fn check_bare(key: &'static Key, text: &str) -> Result<Checked, Problem> {
    let text = text.trim();
    let value = match key.kind {
        Kind::Integer { .. } | Kind::Number(_) => Value::Number(text.to_string()),
        Kind::Boolean => match text {
            "true" => Value::Boolean(true),
            "false" => Value::Boolean(false),
            _ => Value::Text(text.to_string()),
        },
        Kind::Vector(..) | Kind::Choices(_) => return Err(Problem::NotSweepable),
        Kind::Text | Kind::Choice(_) | Kind::Quantity(..) => Value::Text(text.to_string()),
    };
    check(key, &Node { value, offset: 0 }).map_err(|(_, problem)| problem)
}

fn wrong_kind(key: &Key, found: &Value) -> Problem {
    let expected = match key.kind {
        Kind::Text => "a text in quotes".to_string(),
        Kind::Boolean => "true or false".to_string(),
        Kind::Integer { low, high } => format!("a whole number from {low} to {high}"),
        Kind::Choice(choices) => format!("one of {}", quoted(choices)),
        Kind::Choices(choices) => format!("a list out of {}", quoted(choices)),
        Kind::Number(range) => format!("a plain number, {range}"),
        Kind::Quantity(dimension, range) => format!("{} with its unit, {range}", dimension.name()),
        Kind::Vector(dimension, _) => {
            format!("a list of three values with units, each {}", dimension.name())
        }
    };
    let found = match found {
        Value::Text(text) => format!("the text \"{}\"", shortened(text)),
        Value::Number(text) => format!("the number {}", shortened(text)),
        Value::Boolean(value) => value.to_string(),
        other => other.description().to_string(),
    };
    let advice = format!("write {} = {}", key.name(), key.example());
    Problem::WrongKind { expected, found, advice }
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
            // So large that it is out of range whatever it is.
            Ok(value) if value.fract() == 0.0 && value.abs() > 1e15 => i64::MAX,
            Err(QuantityProblem::NotFinite) => return Err(Problem::NotFinite { written, allowed }),
            _ => {
                let example = key.example();
                return Err(Problem::NotANumber {
                    written,
                    unit_too: ", or not a whole one",
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
        nearest: nearest(text, choices.iter().copied(), 0.5).map(str::to_string),
        allowed: choices,
    })
}

fn choice_list(
    items: &[Node],
    choices: &'static [&'static str],
    key: &Key,
) -> Result<Checked, ValueError> {
    let mut chosen = Vec::new();
    for item in items {
        let Value::Text(text) = &item.value else {
            return Err((item.offset, wrong_kind(key, &item.value)));
        };
        let word = choice(text, choices).map_err(|problem| (item.offset, problem))?;
        if chosen.contains(&word) {
            let written = format!("\"{word}\"");
            return Err((item.offset, Problem::RepeatedChoice { written }));
        }
        chosen.push(word);
    }
    Ok(Checked::Choices(chosen))
}

fn number(key: &Key, text: &str, range: Range) -> Result<f64, Problem> {
    let written = shortened(text);
    let allowed = range.to_string();
    let value = parse_number(text).map_err(|problem| match problem {
        QuantityProblem::NotFinite => Problem::NotFinite { written: written.clone(), allowed },
        QuantityProblem::DecimalComma => {
            Problem::DecimalComma { written: written.clone(), allowed }
        }
        QuantityProblem::WrongDimension { .. } | QuantityProblem::UnknownUnit { .. } => {
            Problem::UnitOnPlainNumber { written: written.clone(), allowed }
        }
        QuantityProblem::NoNumber | QuantityProblem::NoUnit { .. } => Problem::NotANumber {
            written: written.clone(),
            unit_too: "",
            allowed,
            example: key.example(),
        },
    })?;
    in_range(key, value, &written, range, None)
}

fn quantity(key: &Key, value: &Value, dimension: Dimension, range: Range) -> Result<f64, Problem> {
    let (text, written) = match value {
        Value::Text(text) => (text, format!("\"{}\"", shortened(text))),
        Value::Number(text) => (text, shortened(text)),
        other => return Err(wrong_kind(key, other)),
    };
    let allowed = || range.to_string();
    match parse_quantity(text, dimension) {
        Ok(quantity) => in_range(key, quantity.si, &written, range, Some(dimension)),
        Err(problem) => Err(match problem {
            QuantityProblem::NoUnit { number } => Problem::MissingUnit {
                written,
                number: shortened(&number),
                dimension,
                suggested: range.unit,
            },
            QuantityProblem::NoNumber => Problem::NotANumber {
                written,
                unit_too: " with a unit",
                allowed: allowed(),
                example: key.example(),
            },
            QuantityProblem::DecimalComma => Problem::DecimalComma { written, allowed: allowed() },
            QuantityProblem::NotFinite => Problem::NotFinite { written, allowed: allowed() },
            QuantityProblem::WrongDimension { unit, belongs_to } => {
                Problem::WrongUnit { written, unit, belongs_to, dimension }
            }
            QuantityProblem::UnknownUnit { unit, nearest, .. } => Problem::UnknownUnit {
                written,
                unit: shortened(&unit),
                dimension,
                nearest: nearest.map(str::to_string),
            },
        }),
    }
}

fn in_range(
    key: &Key,
    value: f64,
    written: &str,
    range: Range,
    dimension: Option<Dimension>,
) -> Result<f64, Problem> {
    if range.contains(value, dimension) {
        Ok(value)
    } else {
        let written = written.to_string();
        Err(Problem::OutOfRange { written, allowed: range.to_string(), advice: key.hint })
    }
}
