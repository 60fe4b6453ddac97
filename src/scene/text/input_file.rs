//! Opening of user files.
//!
//! Only regular files up to a size limit are read: a pipe may block and a device may be endless.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use thiserror::Error;

/// Size limit of meshes and tables, bytes; enough for ten million ten-node elements.
pub const LARGEST_DATA: u64 = 4 << 30;

/// Size limit of JSON files of results, tolerances, hashes or states, bytes. A summary has some hundred
/// kilobytes.
pub const LARGEST_JSON: u64 = 16 << 20;

#[derive(Debug, Error)]
pub enum InputError {
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error("it is a folder; a file is needed")]
    Folder,
    #[error("it is a pipe, a device or a socket; copy its content into a regular file")]
    NotRegular,
    #[error("it has {}; at most {limit} bytes are allowed. Is this the right file?", size(*bytes, *limit))]
    TooLarge { bytes: u64, limit: u64 },
}

/// Size for the message. A file that grew while it was read has been read up to the limit only.
fn size(bytes: u64, limit: u64) -> String {
    if bytes > limit + 1 { format!("{bytes} bytes") } else { format!("more than {limit} bytes") }
}

impl InputError {
    pub fn is_missing(&self) -> bool {
        matches!(self, InputError::Io(error) if error.kind() == io::ErrorKind::NotFound)
    }
}

/// Opens a regular file of at most `limit` bytes. Links are followed.
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
    // The file may have been replaced in between.
    check(file.metadata()?)?;
    Ok(file)
}

/// Reads a regular file of at most `limit` bytes.
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
