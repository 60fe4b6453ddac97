//! Contents of compared files: tables of numbers, and trees of named values.

use crate::output::compare::CompareError;
use crate::output::json;
use crate::output::series::{Series, columns_path};
use serde_json::Value;
use std::path::Path;

pub enum Content {
    Table(Series),
    Tree(Vec<Leaf>),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Leaf {
    /// Path with indices counted from 0: `balls[2].inner.load`.
    pub path: String,
    /// Path without indices: `balls[].inner.load`.
    pub channel: String,
    pub unit: String,
    pub value: LeafValue,
}

#[derive(Clone, Debug, PartialEq)]
pub enum LeafValue {
    Real(f64),
    Integer(i128),
    /// A string, bool, null, empty list or empty table, as JSON text.
    Text(String),
}

impl LeafValue {
    pub fn as_real(&self) -> Option<f64> {
        match self {
            LeafValue::Real(value) => Some(*value),
            LeafValue::Integer(value) => Some(*value as f64),
            LeafValue::Text(_) => None,
        }
    }
}

impl std::fmt::Display for LeafValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            LeafValue::Real(value) => write!(f, "{value:?}"),
            LeafValue::Integer(value) => write!(f, "{value}"),
            LeafValue::Text(text) => f.write_str(text),
        }
    }
}

/// Reads `.csv`, `.npy` or `.json`.
pub fn read(path: &Path) -> Result<Content, CompareError> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("csv") => Ok(Content::Table(Series::read_csv(path)?)),
        Some("npy") => Ok(Content::Table(Series::read_npy(path)?)),
        Some("json") => {
            let tree = json::read(path)
                .map_err(|source| CompareError::Json { path: path.to_path_buf(), source })?;
            if tree.as_object().is_none_or(|map| map.is_empty()) {
                return Err(CompareError::NoValues { path: path.to_path_buf() });
            }
            let leaves =
                leaves(&tree).ok_or_else(|| CompareError::Names { path: path.to_path_buf() })?;
            Ok(Content::Tree(leaves))
        }
        _ => Err(CompareError::UnknownKind { path: path.to_path_buf() }),
    }
}

/// Names the columns of a `.npy` file without a columns file like those of the reference, by position.
pub fn name_columns_as(
    candidate: Series,
    path: &Path,
    reference: &Series,
) -> Result<Series, CompareError> {
    let unnamed = path.extension().is_some_and(|e| e == "npy") && !columns_path(path).exists();
    if unnamed && candidate.columns().len() == reference.columns().len() {
        return Ok(Series::new(reference.columns().to_vec(), candidate.data().clone())?);
    }
    Ok(candidate)
}

/// Limit on the total size of all paths and channels of a tree, bytes. Every value repeats the names of the parts above
/// it, so that a long name above many values would need much memory.
pub const MOST_NAME_BYTES: usize = 32 << 20;

/// Values of a tree in file order; `None` if their names take more than [`MOST_NAME_BYTES`].
pub fn leaves(tree: &Value) -> Option<Vec<Leaf>> {
    let mut found = Vec::new();
    let mut room = MOST_NAME_BYTES;
    collect(tree, "", "", &mut room, &mut found)?;
    Some(found)
}

fn collect(
    value: &Value,
    path: &str,
    channel: &str,
    room: &mut usize,
    found: &mut Vec<Leaf>,
) -> Option<()> {
    *room = room.checked_sub(path.len() + channel.len())?;
    let below = |parent: &str, key: &str| match parent {
        "" => key.to_string(),
        _ => format!("{parent}.{key}"),
    };
    let mut push = |unit: &str, value: LeafValue| {
        found.push(Leaf { path: path.into(), channel: channel.into(), unit: unit.into(), value });
    };
    match value {
        Value::Object(map) if map.is_empty() => push("", LeafValue::Text("{}".into())),
        Value::Array(items) if items.is_empty() => push("", LeafValue::Text("[]".into())),
        Value::Object(map) => {
            let own = quantity(value);
            if let Some((real, unit)) = own {
                push(unit, LeafValue::Real(real));
            }
            // What stands next to value and unit, such as the place of a largest value.
            let is_own = |key: &str| own.is_some() && ["value", "unit"].contains(&key);
            for (key, item) in map.iter().filter(|(key, _)| !is_own(key)) {
                collect(item, &below(path, key), &below(channel, key), room, found)?;
            }
        }
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                let (path, channel) = (format!("{path}[{index}]"), format!("{channel}[]"));
                collect(item, &path, &channel, room, found)?;
            }
        }
        Value::Number(number) => push(
            "",
            match number.as_i128() {
                Some(integer) => LeafValue::Integer(integer),
                None => LeafValue::Real(number.as_f64().unwrap_or(f64::NAN)),
            },
        ),
        Value::String(_) | Value::Bool(_) | Value::Null => {
            push("", LeafValue::Text(value.to_string()));
        }
    }
    Some(())
}

/// Value and unit of an object with `"value"` and `"unit"`. A `null` value is read as NaN.
fn quantity(value: &Value) -> Option<(f64, &str)> {
    let map = value.as_object()?;
    let unit = map.get("unit")?.as_str()?;
    match map.get("value")? {
        Value::Number(number) => Some((number.as_f64().unwrap_or(f64::NAN), unit)),
        Value::Null => Some((f64::NAN, unit)),
        _ => None,
    }
}
