//! Reading of JSON result files with limits. A tree takes up to a hundred times the memory of its text, so that its values
//! are counted before it is built.

use crate::scene::text::input_file;
use crate::scene::text::input_file::{InputError, LARGEST_JSON};
use serde_json::Value;
use std::path::Path;
use thiserror::Error;

/// Limit on the values, lists and tables in a file. The summary of a run of 200 balls that records everything has about
/// 10 000; 250 000 take about 100 MB.
pub const MOST_VALUES: usize = 250_000;

#[derive(Debug, Error)]
pub enum JsonError {
    #[error(transparent)]
    Input(#[from] InputError),
    #[error("it has more than {MOST_VALUES} values; store tables in .csv or .npy files")]
    TooMany,
    #[error("JSON has no NaN or Infinity, which the file contains: {0}")]
    NotFinite(serde_json::Error),
    #[error(transparent)]
    Syntax(#[from] serde_json::Error),
}

/// Reads a JSON file.
///
/// # Errors
/// [`JsonError`].
pub fn read(path: &Path) -> Result<Value, JsonError> {
    parse(&input_file::read(path, LARGEST_JSON)?)
}

/// Parses JSON text.
///
/// # Errors
/// [`JsonError`].
pub fn parse(bytes: &[u8]) -> Result<Value, JsonError> {
    if count_values(bytes) > MOST_VALUES {
        return Err(JsonError::TooMany);
    }
    let has = |word: &[u8]| bytes.windows(word.len()).any(|of| of == word);
    serde_json::from_slice(bytes).map_err(|error| match has(b"NaN") || has(b"Infinity") {
        true => JsonError::NotFinite(error),
        false => error.into(),
    })
}

/// Upper limit of the number of values in a JSON text: one, and one more for each comma and opening bracket outside
/// strings.
pub fn count_values(bytes: &[u8]) -> usize {
    let (mut count, mut in_string, mut escaped) = (1, false, false);
    for byte in bytes {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_string => escaped = true,
            b'"' => in_string = !in_string,
            b',' | b'[' | b'{' if !in_string => count += 1,
            _ => {}
        }
    }
    count
}
