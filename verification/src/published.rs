//! Numbers printed in the source, in other books and by other programs, read from a case's `published.toml`.

use std::collections::HashSet;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A number as the source prints it, in the unit it prints.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedValue {
    pub id: String,
    pub quantity: String,
    pub value: f64,
    /// As printed; `"1"` for a pure number.
    pub unit: String,
    /// Table, figure or section; of an outside number also the book or program.
    pub source: String,
    /// Absent for a number of the dissertation.
    pub kind: Option<Outside>,
    pub note: Option<String>,
    /// One unit of the last printed place (0.001 for 6.423).
    pub rounding: Option<f64>,
    /// Set where the source states a limit ("less than 4 %") and not a value.
    pub bound: Option<Bound>,
}

/// What prints a number that is not of the dissertation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outside {
    Book,
    OtherProgram,
}

/// The kind of limit a source states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bound {
    AtMost,
    AtLeast,
}

/// All published numbers of one case, in file order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Published {
    values: Vec<PublishedValue>,
}

#[derive(Debug, Error, PartialEq)]
pub enum PublishedError {
    #[error("published.toml is not what the reader expects: {0}")]
    Syntax(String),
    #[error("published.toml: id `{0}` appears twice")]
    DuplicateId(String),
    #[error("published.toml: `{field}` of value `{id}` is empty")]
    Empty { id: String, field: &'static str },
    #[error("published.toml: value `{id}` is {value}, which is not finite")]
    NotFinite { id: String, value: f64 },
    #[error("published.toml: rounding {rounding} of value `{id}` is not a positive number")]
    Rounding { id: String, rounding: f64 },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    value: Vec<PublishedValue>,
}

impl Published {
    /// Read the text of a `published.toml`.
    ///
    /// # Errors
    /// Text that is not TOML of the expected form, an id used twice, an empty field, a number
    /// that is not finite.
    pub fn parse(text: &str) -> Result<Published, PublishedError> {
        let file: File =
            toml::from_str(text).map_err(|error| PublishedError::Syntax(error.to_string()))?;
        let mut seen = HashSet::new();
        for entry in &file.value {
            let id = entry.id.clone();
            for (field, text) in [
                ("id", &entry.id),
                ("quantity", &entry.quantity),
                ("unit", &entry.unit),
                ("source", &entry.source),
            ] {
                if text.trim().is_empty() {
                    return Err(PublishedError::Empty { id, field });
                }
            }
            if !entry.value.is_finite() {
                return Err(PublishedError::NotFinite { id, value: entry.value });
            }
            if let Some(rounding) = entry.rounding
                && !(rounding > 0.0 && rounding.is_finite())
            {
                return Err(PublishedError::Rounding { id, rounding });
            }
            if !seen.insert(id.clone()) {
                return Err(PublishedError::DuplicateId(id));
            }
        }
        Ok(Published { values: file.value })
    }

    pub fn values(&self) -> &[PublishedValue] {
        &self.values
    }

    pub fn get(&self, id: &str) -> Option<&PublishedValue> {
        self.values.iter().find(|entry| entry.id == id)
    }

    /// The same numbers with one of them replaced; used to show that each one matters.
    pub fn with(&self, id: &str, value: f64) -> Published {
        let mut altered = self.clone();
        for entry in &mut altered.values {
            if entry.id == id {
                entry.value = value;
            }
        }
        altered
    }
}
