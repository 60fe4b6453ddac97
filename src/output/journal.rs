//! The file that a run goes on from: its name, why the run stood still, how it is read and written.

use crate::output::atomic::{WriteError, remove_partials, write_atomic};
use crate::output::results::pretty;
use crate::scene::text::input_file;
use crate::scene::text::input_file::{InputError, LARGEST_JSON};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use thiserror::Error;

pub const STATE: &str = "state.json";
pub const SERIES: &str = "series.npy";

/// Why the run stood still when the state was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stopped {
    /// It did not: written on the way.
    Running,
    Interrupted,
    Failed,
    Complete,
}

#[derive(Debug, Error)]
pub enum JournalError {
    #[error("cannot read {}: {source}", path.display())]
    Read { path: PathBuf, source: InputError },
    #[error("{} is not the saved state of this kind of run: {source}; start again with --fresh", path.display())]
    Json { path: PathBuf, source: serde_json::Error },
    #[error(
        "{} was written by version {found}; results of this version, {}, may not be bitwise identical; start \
         again with --fresh",
        path.display(), env!("CARGO_PKG_VERSION")
    )]
    Version { path: PathBuf, found: String },
    #[error(
        "{} has the format of another version of this program; finish the run with that version, or start \
         again with --fresh",
        path.display()
    )]
    Form { path: PathBuf },
}

/// Reads `state.json` of a results folder, of the given form; `None` if there is none.
///
/// # Errors
/// A file that cannot be read, is of another form, or is the state of something else.
pub fn read<T: DeserializeOwned>(folder: &Path, form: u32) -> Result<Option<T>, JournalError> {
    /// All that is looked at first.
    #[derive(Deserialize)]
    struct Head {
        form: Option<u32>,
    }
    let path = folder.join(STATE);
    match input_file::read(&path, LARGEST_JSON) {
        Ok(bytes) => {
            let json = |source| JournalError::Json { path: path.clone(), source };
            let head: Head = serde_json::from_slice(&bytes).map_err(json)?;
            if head.form != Some(form) {
                return Err(JournalError::Form { path: path.clone() });
            }
            serde_json::from_slice(&bytes).map(Some).map_err(json)
        }
        Err(error) if error.is_missing() => Ok(None),
        Err(source) => Err(JournalError::Read { path, source }),
    }
}

/// Refuses a state of another version.
///
/// # Errors
/// [`JournalError::Version`].
pub fn check_version(folder: &Path, found: &str) -> Result<(), JournalError> {
    if found == env!("CARGO_PKG_VERSION") {
        return Ok(());
    }
    Err(JournalError::Version { path: folder.join(STATE), found: found.to_string() })
}

/// Writes `state.json`, and removes what killed runs left half written in the folder.
///
/// # Errors
/// A file that cannot be written.
pub fn write<T: Serialize>(folder: &Path, state: &T) -> Result<(), WriteError> {
    let value = serde_json::to_value(state).expect("a state is plain JSON");
    write_atomic(&folder.join(STATE), pretty(&value).as_bytes())?;
    remove_partials(folder);
    Ok(())
}

/// A hash as text.
pub fn hexadecimal(hash: Sha256) -> String {
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
