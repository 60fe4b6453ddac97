//! The journal of an unfinished sweep: a header line, then one line a finished chunk.

use bearing_dynamics::output::WriteError;
use bearing_dynamics::scene::text::input_file;
use bearing_dynamics::scene::text::input_file::InputError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::error::Error;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Chunk {
    pub index: usize,
    /// Rows of the table, in order of their points.
    pub rows: Vec<Vec<f64>>,
    pub failures: Vec<Failure>,
    /// On solved points, one of each code.
    pub warnings: Vec<PointsWarned>,
}

/// A warning on one or more points.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PointsWarned {
    pub code: String,
    /// On the first point.
    pub text: String,
    pub point: usize,
    /// Number of points with this code.
    pub points: usize,
}

/// Adds warnings on points, those of a code to the first of it.
pub fn gather(warnings: &mut Vec<PointsWarned>, more: impl IntoIterator<Item = PointsWarned>) {
    for warned in more {
        match warnings.iter_mut().find(|first| first.code == warned.code) {
            Some(first) => first.points += warned.points,
            None => warnings.push(warned),
        }
    }
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Failure {
    pub point: usize,
    pub message: String,
}

#[derive(Serialize, Deserialize)]
struct Header {
    sweep: String,
}

/// Finished chunks in memory and on disk.
pub struct Journal {
    path: PathBuf,
    expected: usize,
    open: Mutex<Open>,
}

struct Open {
    file: File,
    chunks: BTreeMap<usize, Chunk>,
}

impl Journal {
    /// Opens the journal in `folder`, with the chunks an earlier run left there; `points` is how many
    /// points a chunk has.
    pub fn open(
        folder: &Path,
        fingerprint: &str,
        expected: usize,
        points: impl Fn(usize) -> usize,
        fresh: bool,
    ) -> Result<Journal, Box<dyn Error>> {
        let path = folder.join("sweep.journal");
        let chunks = match fresh {
            true => BTreeMap::new(),
            false => read(&path, fingerprint, expected, points)?,
        };
        // Written anew, so that a line cut off by the interruption is gone.
        let mut text = header(fingerprint)? + "\n";
        for chunk in chunks.values() {
            text += &(serde_json::to_string(chunk)? + "\n");
        }
        bearing_dynamics::output::write_atomic(&path, text.as_bytes())?;
        let file = OpenOptions::new()
            .append(true)
            .open(&path)
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        Ok(Journal { path, expected, open: Mutex::new(Open { file, chunks }) })
    }

    /// Adds a chunk, on disk before anything else.
    pub fn append(&self, chunk: Chunk) -> Result<(), Box<dyn Error + Send + Sync>> {
        let line = serde_json::to_string(&chunk)? + "\n";
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        open.file
            .write_all(line.as_bytes())
            .map_err(|source| WriteError { path: self.path.clone(), source })?;
        open.chunks.insert(chunk.index, chunk);
        Ok(())
    }

    /// Number of points already there.
    pub fn finished(&self) -> usize {
        self.chunks().iter().map(|chunk| chunk.rows.len() + chunk.failures.len()).sum()
    }

    /// Chunks still to be solved.
    pub fn missing(&self) -> Vec<usize> {
        let open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        (0..self.expected).filter(|index| !open.chunks.contains_key(index)).collect()
    }

    /// Finished chunks in order.
    pub fn chunks(&self) -> Vec<Chunk> {
        let open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        open.chunks.values().cloned().collect()
    }

    /// Removes the file; the table has everything.
    pub fn remove(self) -> Result<(), Box<dyn Error>> {
        Ok(std::fs::remove_file(&self.path)
            .map_err(|error| format!("cannot remove {}: {error}", self.path.display()))?)
    }
}

fn header(fingerprint: &str) -> Result<String, serde_json::Error> {
    serde_json::to_string(&Header { sweep: fingerprint.into() })
}

fn read(
    path: &Path,
    fingerprint: &str,
    expected: usize,
    points: impl Fn(usize) -> usize,
) -> Result<BTreeMap<usize, Chunk>, Box<dyn Error>> {
    let mut chunks = BTreeMap::new();
    let unreadable = |error: InputError| format!("cannot read {}: {error}", path.display());
    // As long as the sweep has come.
    let file = match input_file::open(path, u64::MAX) {
        Err(error) if error.is_missing() => return Ok(chunks),
        other => other.map_err(unreadable)?,
    };
    // Bytes: what a crash leaves at the end need not be text.
    let mut lines = BufReader::new(file).split(b'\n');
    let first = lines.next().transpose().map_err(|e| unreadable(e.into()))?.unwrap_or_default();
    let same = serde_json::from_slice::<Header>(&first).is_ok_and(|h| h.sweep == fingerprint);
    if !same && header(fingerprint)?.as_bytes().starts_with(&first) {
        // Cut off before anything was kept.
        return Ok(chunks);
    }
    if !same {
        return Err(format!(
            "{} belongs to an unfinished sweep of another scene or of other values; finish that one, \
             choose another --out, or discard it with --fresh",
            path.display()
        )
        .into());
    }
    for line in lines {
        // A line that does not parse was cut off; its chunk is solved again.
        let line = line.map_err(|error| unreadable(error.into()))?;
        let Ok(chunk) = serde_json::from_slice::<Chunk>(&line) else { continue };
        let is_whole = |chunk: &Chunk| {
            chunk.rows.len() + chunk.failures.len() == points(chunk.index)
                && chunk.rows.iter().all(|row| row.len() == chunk.rows[0].len())
        };
        if chunk.index < expected && is_whole(&chunk) {
            chunks.insert(chunk.index, chunk);
        }
    }
    Ok(chunks)
}
