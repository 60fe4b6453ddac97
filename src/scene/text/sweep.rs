//! Values of a sweep: lists `5 um, 0 um, -5 um` and ranges `0 deg .. 45 deg / 91`.

use crate::scene::error::{Problem, shortened};
use crate::scene::tables::keys;
use crate::scene::tables::keys::{Key, Kind, Leads};
use crate::scene::text::items::which_item;
use crate::scene::text::tree::{Node, Value};
use crate::scene::text::units::{parse_number, parse_quantity, plain};
use crate::scene::text::value::{ValueError, check_bare};

#[derive(Clone, Debug, PartialEq)]
pub struct SweepAxis {
    /// Path with the name of a named table: `bearing.left.clearance.radial`.
    pub key: String,
    pub values: SweepValues,
}

#[derive(Clone, Debug, PartialEq)]
pub enum SweepValues {
    List(Vec<String>),
    /// `count` evenly spaced values from `low` to `high`, both included, in `unit`.
    Range {
        low: f64,
        high: f64,
        unit: String,
        count: usize,
    },
}

/// Limit of values in one axis; more are taken for a mistake.
const MOST_VALUES: usize = 10_000_000;

impl SweepAxis {
    pub fn len(&self) -> usize {
        match &self.values {
            SweepValues::List(list) => list.len(),
            SweepValues::Range { count, .. } => *count,
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Value at `index` as `Document::set` takes it; `None` past the end.
    pub fn value(&self, index: usize) -> Option<String> {
        match &self.values {
            SweepValues::List(list) => list.get(index).cloned(),
            SweepValues::Range { low, high, unit, count } => (index < *count).then(|| {
                let number = range_value(*low, *high, index, *count);
                if unit.is_empty() { plain(number) } else { format!("{} {unit}", plain(number)) }
            }),
        }
    }
}

/// Value at `index` of a range; exact at both ends.
fn range_value(low: f64, high: f64, index: usize, count: usize) -> f64 {
    if index + 1 == count {
        return high;
    }
    let value = low + (high - low) * index as f64 / (count - 1) as f64;
    // Rounded to 15 digits: 0.05, not 0.049999999999999996.
    format!("{value:.14e}").parse().unwrap_or(value)
}

pub(crate) fn axis_of_node(
    path: &str,
    key_offset: usize,
    node: &Node,
) -> Result<SweepAxis, ValueError> {
    let leads = keys::find_named(path).ok_or_else(|| (key_offset, unknown_key(path)))?;
    let key = leads.key;
    let items = match &node.value {
        Value::Text(text) => {
            return axis_of_text(path, &leads, text)
                .map_err(|problem| (node.offset, problem).into());
        }
        Value::List(items) => items,
        other => {
            let problem = Problem::WrongKind {
                expected: "a list of values, or a range in quotes".to_string(),
                found: other.description().to_string(),
                advice: format!("write \"{path}\" = [{}]", key.example()),
            };
            return Err((node.offset, problem).into());
        }
    };
    refuse_unsweepable(path, &leads).map_err(|problem| (key_offset, problem))?;
    if items.is_empty() {
        return Err((node.offset, bad(&"[]", "the list is empty")).into());
    }
    let mut values = Vec::new();
    for item in items {
        let text = match &item.value {
            Value::Text(text) => text.trim().to_string(),
            Value::Number(text) => text.clone(),
            Value::Boolean(value) => value.to_string(),
            other => {
                return Err((item.offset, bad(&other.description(), "not a single value")).into());
            }
        };
        check_bare(key, &text).map_err(|problem| (item.offset, problem))?;
        values.push(text);
    }
    Ok(SweepAxis { key: path.to_string(), values: SweepValues::List(values) })
}

/// Axis from one text: a comma-separated list, or a range `low .. high / count`.
pub(crate) fn axis_of_text(path: &str, leads: &Leads, text: &str) -> Result<SweepAxis, Problem> {
    refuse_unsweepable(path, leads)?;
    let key = leads.key;
    let values = match text.split_once("..") {
        Some((low, rest)) => range(key, text, low, rest)?,
        None => {
            let items: Vec<String> = text.split(',').map(|item| item.trim().to_string()).collect();
            if items.iter().any(String::is_empty) {
                return Err(bad(&text, "an entry is empty"));
            }
            for item in &items {
                check_bare(key, item)?;
            }
            SweepValues::List(items)
        }
    };
    Ok(SweepAxis { key: path.to_string(), values })
}

fn range(key: &'static Key, text: &str, low: &str, rest: &str) -> Result<SweepValues, Problem> {
    // The last "/" precedes the count: units such as rad/s have one too.
    let Some((high, count)) = rest.rsplit_once('/') else {
        return Err(bad(&text, "no number of values after \"/\""));
    };
    let count = count.trim();
    let in_range = |count: &usize| (2..=MOST_VALUES).contains(count);
    let Some(count) = count.parse::<usize>().ok().filter(in_range) else {
        let reason = format!("the number of values must be a whole number from 2 to {MOST_VALUES}");
        return Err(bad(&text, &reason));
    };
    check_bare(key, low)?;
    check_bare(key, high)?;
    let unusable = |_| bad(&text, "the ends are not numbers");
    let dimension = match key.kind {
        Kind::Quantity(dimension, _) | Kind::Profile(dimension, _) => Some(dimension),
        Kind::Either(kinds) => kinds.iter().find_map(|kind| match kind {
            Kind::Quantity(dimension, _) => {
                parse_quantity(low, *dimension).is_ok().then_some(*dimension)
            }
            _ => None,
        }),
        _ => None,
    };
    match (key.kind, dimension) {
        (_, Some(dimension)) => {
            let low = parse_quantity(low, dimension).map_err(unusable)?;
            let high = parse_quantity(high, dimension).map_err(unusable)?;
            let unit = low.unit.to_string();
            let high =
                if high.scale == low.scale { high.number } else { high.si / low.scale.factor() };
            Ok(SweepValues::Range { low: low.number, high, unit, count })
        }
        (Kind::Number(_) | Kind::Integer { .. } | Kind::Either(_), None) => {
            let low = parse_number(low).map_err(unusable)?;
            let high = parse_number(high).map_err(unusable)?;
            let whole = |index| range_value(low, high, index, count).fract() == 0.0;
            if matches!(key.kind, Kind::Integer { .. }) && !whole(1) {
                return Err(bad(&text, "the values in between are not whole numbers"));
            }
            Ok(SweepValues::Range { low, high, unit: String::new(), count })
        }
        _ => Err(bad(&text, "only numbers have a range")),
    }
}

fn refuse_unsweepable(path: &str, leads: &Leads) -> Result<(), Problem> {
    match leads.key.kind {
        _ if leads.key.in_list() && leads.item.is_none() => Err(which_item(path)),
        Kind::Text
        | Kind::Choices(_)
        | Kind::Vector(..)
        | Kind::Quantities(..)
        | Kind::QuantityList(..)
        | Kind::TrueOrProfile(..) => Err(Problem::NotSweepable),
        _ => Ok(()),
    }
}

fn bad(written: &dyn std::fmt::Display, reason: &str) -> Problem {
    let written = format!("\"{}\"", shortened(&written.to_string()));
    Problem::BadSweep { written, reason: reason.to_string() }
}

/// Problem of an unknown dotted key on the command line or in `[sweep]`.
pub(crate) fn unknown_key(path: &str) -> Problem {
    if keys::find_table(path).is_some() {
        let inside =
            keys::children(path).iter().map(|name| format!("{path}.{name}")).collect::<Vec<_>>();
        return Problem::UnknownKey { nearest: None, allowed: inside.join(", ") };
    }
    // The key is searched without the table's name, and reported with it.
    let (plain, name) = keys::without_name(path);
    let (table, key) = plain.rsplit_once('.').unwrap_or(("", &plain));
    let nearest =
        keys::nearest_key(table, key).map(|nearest| match (name, nearest.split_once('.')) {
            (Some(name), Some((top, rest))) if plain.split('.').next() == Some(top) => {
                Some(format!("{top}.{name}.{rest}"))
                    // The second part need not be a name.
                    .filter(|named| named != path)
                    .unwrap_or(nearest)
            }
            _ => nearest,
        });
    let allowed = "a dotted key such as bearing.clearance.radial".to_string();
    Problem::UnknownKey { nearest, allowed }
}
