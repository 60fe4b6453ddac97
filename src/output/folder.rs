//! Exclusive access to a results folder, and checks of its content.
//!
//! A command claims its folder before it computes anything: the folder exists and is writable, no other process of this
//! program writes to it, and its content may be replaced. The lock is a system lock on the folder itself: it leaves no
//! file and ends with the process.

use crate::output::atomic::remove_partials;
use crate::output::fields::FOLDER as FIELDS;
use crate::output::json::{self, JsonError};
use crate::output::pack::{MANIFEST, RESOLVED};
use crate::output::state::{self, STATE};
use serde_json::Value;
use std::fs::{self, File, TryLockError};
use std::io;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Results folder that only this process writes to, until it is dropped. A folder that was created for it and is still
/// empty is then removed.
#[derive(Debug)]
pub struct ResultsFolder {
    path: PathBuf,
    /// Created folders, innermost first.
    made: Vec<PathBuf>,
    /// False if the file system cannot lock.
    pub locked: bool,
    _lock: File,
}

#[derive(Debug, Error)]
pub enum FolderError {
    #[error(
        "cannot make the results folder {}: {} is a file; move it away, or choose another --out",
        folder.display(), file.display()
    )]
    FileInTheWay { folder: PathBuf, file: PathBuf },
    #[error(
        "cannot make the results folder {}: {source}; choose another --out", folder.display()
    )]
    Make { folder: PathBuf, source: io::Error },
    #[error(
        "cannot write to the results folder {}: {source}; choose another --out, or check permissions \
         and free disk space",
        folder.display()
    )]
    Write { folder: PathBuf, source: io::Error },
    #[error(
        "another bearing process is writing to {}; wait until it ends, or choose another --out",
        folder.display()
    )]
    Busy { folder: PathBuf },
    #[error(
        "{} holds {file}, but no results of this program; choose another --out, new or empty",
        folder.display()
    )]
    NotEmpty { folder: PathBuf, file: String },
    #[error(
        "{} was not written by this program ({reason}) and is not replaced; move it away, or choose \
         another --out",
        file.display()
    )]
    Foreign { file: PathBuf, reason: String },
}

impl Deref for ResultsFolder {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.path
    }
}

impl Drop for ResultsFolder {
    fn drop(&mut self) {
        // Only empty folders can be removed; folders that cannot be removed are left.
        for folder in &self.made {
            if fs::remove_dir(folder).is_err() {
                break;
            }
        }
    }
}

/// Creates the folder if necessary, locks it, checks that it is writable, and removes partial files of killed
/// processes.
///
/// # Errors
/// All of [`FolderError`] except [`FolderError::Foreign`] and [`FolderError::NotEmpty`].
pub fn claim(path: &Path) -> Result<ResultsFolder, FolderError> {
    let mut made = Vec::new();
    let (lock, locked) = loop {
        made.extend(make(path)?);
        let failed = |source| FolderError::Make { folder: path.to_path_buf(), source };
        let handle = match handle(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            other => other.map_err(failed)?,
        };
        let locked = match handle.try_lock() {
            Ok(()) => true,
            Err(TryLockError::WouldBlock) => {
                return Err(FolderError::Busy { folder: path.to_path_buf() });
            }
            Err(TryLockError::Error(_)) => false,
        };
        // Another process may have removed its empty folder between opening and locking.
        if is_at(&handle, path) {
            break (handle, locked);
        }
    };
    let folder = ResultsFolder { path: path.to_path_buf(), made, locked, _lock: lock };
    let write = |source| FolderError::Write { folder: path.to_path_buf(), source };
    // The name is that of a partial file, so that a leftover is removed later.
    let probe = path.join(format!(".probe.{}.partial", std::process::id()));
    File::create(&probe).and_then(|_| fs::remove_file(&probe)).map_err(write)?;
    if locked {
        remove_partials(path);
    }
    Ok(folder)
}

/// Creates a folder and its parents; returns the new ones, innermost first.
fn make(path: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let folder = || path.to_path_buf();
    let missing: Vec<PathBuf> = path
        .ancestors()
        .filter(|above| !above.as_os_str().is_empty())
        .take_while(|above| !above.exists())
        .map(Path::to_path_buf)
        .collect();
    let in_the_way = path.ancestors().find(|above| above.exists() && !above.is_dir());
    if let Some(file) = in_the_way {
        return Err(FolderError::FileInTheWay { folder: folder(), file: file.to_path_buf() });
    }
    fs::create_dir_all(path).map_err(|source| FolderError::Make { folder: folder(), source })?;
    Ok(missing)
}

#[cfg(unix)]
fn handle(folder: &Path) -> io::Result<File> {
    File::open(folder)
}

/// Returns whether a path still leads to an opened folder.
#[cfg(unix)]
fn is_at(handle: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |data: fs::Metadata| (data.dev(), data.ino());
    let opened = handle.metadata().map(place);
    matches!((opened, fs::metadata(path).map(place)), (Ok(a), Ok(b)) if a == b)
}

/// Handle of a file in the folder, on systems where folders cannot be opened.
#[cfg(not(unix))]
fn handle(folder: &Path) -> io::Result<File> {
    File::options().create(true).truncate(false).write(true).open(folder.join(".lock"))
}

#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FolderContent {
    Nothing,
    Run,
    /// Other results, by the `kind` of their summary.
    Results(String),
    Sweep,
    Pack,
}

/// Tables that a command replaces. They belong to this program if one of its records is in the same folder.
const TABLES: [&str; 7] = [
    "series.csv",
    "series.npy",
    "spectrum.csv",
    "bore.csv",
    "harmonic.csv",
    "sweep.csv",
    "sweep.npy",
];

/// Kind of the results in a folder, from the records of this program.
///
/// # Errors
/// [`FolderError::Foreign`] for a file that a command would replace and that another program wrote;
/// [`FolderError::NotEmpty`] for a folder with other files and no results.
pub fn content(folder: &Path) -> Result<FolderContent, FolderError> {
    let there = |name: &str| folder.join(name).exists();
    let foreign = |name: &str, reason: &str| FolderError::Foreign {
        file: folder.join(name),
        reason: reason.to_string(),
    };
    let record = |name: &str, read: fn(&Path) -> Result<Value, JsonError>| {
        let file = folder.join(name);
        match fs::symlink_metadata(&file) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            _ => match read(&file) {
                Ok(record) if is_own(&record) => Ok(Some(record)),
                Ok(_) => Err(foreign(name, "it names another program, or none")),
                Err(error) => Err(foreign(name, &error.to_string())),
            },
        }
    };
    // Only packs have a resolved scene; a partial one has no manifest yet.
    if there(RESOLVED) || json::read(&folder.join(MANIFEST)).is_ok_and(|manifest| is_own(&manifest))
    {
        return Ok(FolderContent::Pack);
    }
    let state = record(STATE, state::head)?;
    let (summary, sweep) = (record("summary.json", json::read)?, record("sweep.json", json::read)?);
    if sweep.is_some() {
        return Ok(FolderContent::Sweep);
    }
    if state.is_some() {
        return Ok(FolderContent::Run);
    }
    if let Some(summary) = summary {
        return Ok(match summary["kind"].as_str().unwrap_or("results") {
            kind if kind.starts_with("run") => FolderContent::Run,
            kind => FolderContent::Results(kind.to_string()),
        });
    }
    // A process killed between its tables and its record leaves the column names or the list of fields.
    if there("series.columns.json") || there("fields.pvd") {
        return Ok(FolderContent::Nothing);
    }
    match TABLES.iter().find(|name| there(name)) {
        Some(name) => Err(foreign(name, "no record of this program is in the folder")),
        None => match other_file(folder) {
            Some(file) => Err(FolderError::NotEmpty { folder: folder.to_path_buf(), file }),
            None => Ok(FolderContent::Nothing),
        },
    }
}

/// A file or folder that this program does not write before its records.
fn other_file(folder: &Path) -> Option<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.find(|name| {
        let known =
            name.ends_with(".svg") || name.ends_with(".partial") || name.starts_with("shard-");
        !known && ![".lock", FIELDS, "curve.csv"].contains(&name.as_str())
    })
}

/// Returns whether a record names this program: in a table in summaries, one level deeper in runs with a
/// housing, as a string in other records.
fn is_own(record: &Value) -> bool {
    let name = env!("CARGO_PKG_NAME");
    [&record["program"], &record["program"]["name"], &record["bearing"]["program"]]
        .into_iter()
        .any(|found| found == name)
}
