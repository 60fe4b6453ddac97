//! The one way in which a file that a user names is opened.
//!
//! Only regular files are read, and up to a stated size: opening a pipe waits for ever, a device may
//! have no end.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use thiserror::Error;

/// Bytes of the largest mesh or table that is read: ten-node elements by the ten million.
pub const LARGEST_DATA: u64 = 4 << 30;

/// Bytes of the largest JSON file of results, tolerances, hashes or states. A summary has some
/// hundred kilobytes.
pub const LARGEST_JSON: u64 = 16 << 20;

#[derive(Debug, Error)]
pub enum InputError {
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error("it is a folder, and a file is needed")]
    Folder,
    #[error(
        "it is a pipe, a device or a socket; only regular files are read: copy its content into one"
    )]
    NotRegular,
    #[error("it has {}, and up to {limit} bytes are read; is this the right file?", size(*bytes, *limit))]
    TooLarge { bytes: u64, limit: u64 },
}

/// A file that grew while it was read has been read to its limit only.
fn size(bytes: u64, limit: u64) -> String {
    if bytes > limit + 1 { format!("{bytes} bytes") } else { format!("more than {limit} bytes") }
}

impl InputError {
    pub fn is_missing(&self) -> bool {
        matches!(self, InputError::Io(error) if error.kind() == io::ErrorKind::NotFound)
    }
}

/// Opens a regular file of at most `limit` bytes. Links are followed: what counts is what they
/// lead to.
///
/// # Errors
/// [`InputError`]; pipes, devices, sockets and folders are refused unopened.
pub fn open(path: &Path, limit: u64) -> Result<File, InputError> {
    let check = |data: std::fs::Metadata| match () {
        () if data.is_dir() => Err(InputError::Folder),
        () if !data.is_file() => Err(InputError::NotRegular),
        () if data.len() > limit => Err(InputError::TooLarge { bytes: data.len(), limit }),
        () => Ok(()),
    };
    check(std::fs::metadata(path)?)?;
    let file = File::open(path)?;
    // It may have been exchanged in between.
    check(file.metadata()?)?;
    Ok(file)
}

/// The content of a regular file of at most `limit` bytes.
///
/// # Errors
/// As [`open`].
pub fn read(path: &Path, limit: u64) -> Result<Vec<u8>, InputError> {
    let mut bytes = Vec::new();
    // The file may grow while it is read.
    open(path, limit)?.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        return Err(InputError::TooLarge { bytes: bytes.len() as u64, limit });
    }
    Ok(bytes)
}
