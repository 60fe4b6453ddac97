//! Atomic writing of files: a file is either complete or absent.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

#[derive(Debug, Error)]
#[error("cannot write {}: {source}{}", path.display(), room_text(path, source))]
pub struct WriteError {
    pub path: PathBuf,
    pub source: io::Error,
}

/// Hint for a file that could not be written because the disk is full; empty for other errors. The state to resume from is
/// in the same folder or, for fields, in the folder above.
pub fn room_text(path: &Path, source: &io::Error) -> &'static str {
    if !matches!(source.kind(), io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded) {
        return "";
    }
    let is_kept = |name: &str| path.ancestors().skip(1).take(2).any(|at| at.join(name).exists());
    if is_kept("state.json") {
        "; files written before are complete. Free disk space and continue from the last saved state with --resume \
         (interval: --save-every)"
    } else if is_kept("sweep.json") {
        "; files written before are complete. Free disk space and run the sweep again: it continues after the finished points"
    } else {
        "; files written before are complete, but there is no state to resume from. Free disk space and run again"
    }
}

/// Writes a file under a temporary name in the same folder, then renames it: an interrupted run
/// leaves either the old file or the new one.
///
/// The folder is created if it does not exist.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let failed = |source| WriteError { path: path.to_path_buf(), source };
    let name = path.file_name().ok_or_else(|| failed(io::ErrorKind::InvalidFilename.into()))?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(|source| failed(in_the_way(folder, source)))?;
    // The process id keeps two runs in the same folder from writing to the same temporary file.
    let temporary =
        folder.join(format!(".{}.{}.partial", name.to_string_lossy(), std::process::id()));
    let written = write_and_sync(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
    written.map_err(|source| {
        // A failure to remove the file is ignored: the first error is the one to report.
        let _ = fs::remove_file(&temporary);
        failed(source)
    })
}

/// Error that names the file which is in the way of a folder: the system's "File exists" does not.
fn in_the_way(folder: &Path, source: io::Error) -> io::Error {
    let file = folder.ancestors().find(|part| part.exists() && !part.is_dir());
    let Some(file) = file else { return source };
    let text = format!(
        "{} is a file, and a folder is needed there; remove it, or name another folder with --out",
        file.display()
    );
    io::Error::new(source.kind(), text)
}

/// Removes temporary files of [`write_atomic`] whose process has ended. Files that cannot be removed are left.
///
/// On systems without `/proc`, files older than an hour are removed.
pub fn remove_partials(folder: &Path) {
    let listed = Path::new("/proc/self").exists();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let Some(process) = writer_of(&name.to_string_lossy()) else { continue };
        let has_ended = if listed {
            !Path::new(&format!("/proc/{process}")).exists()
        } else {
            let written = entry.metadata().and_then(|data| data.modified()).ok();
            let age = written.and_then(|time| time.elapsed().ok());
            process != std::process::id() && age.is_some_and(|age| age.as_secs() > 3600)
        };
        if has_ended {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Process id in the name of a temporary file of [`write_atomic`].
fn writer_of(name: &str) -> Option<u32> {
    let (_, process) = name.strip_prefix('.')?.strip_suffix(".partial")?.rsplit_once('.')?;
    process.parse().ok()
}

fn write_and_sync(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}
