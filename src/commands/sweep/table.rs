//! Rows of a sweep: in memory, and at the end of `sweep.csv` as soon as their block is solved.
//!
//! An interrupted sweep resumes from the rows in `sweep.csv`. `sweep.json` has the hash of the scene and the grid they belong to.

use super::grid::Grid;
use super::report;
use bearing_dynamics::output::series::SeriesError;
use bearing_dynamics::output::{Column, Series, json, write_atomic};
use bearing_dynamics::scene::Document;
use ndarray::Array2;
use serde_json::Value;
use std::collections::BTreeMap;
use std::error::Error;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};

pub struct Table {
    pub columns: Vec<Column>,
    /// Rows by point.
    pub rows: BTreeMap<usize, Vec<f64>>,
    /// Messages of points without a solution, by point.
    pub failures: BTreeMap<usize, String>,
    path: PathBuf,
    file: File,
}

impl Table {
    /// Opens `sweep.csv` in `folder`, with the rows of an unfinished sweep of the same hash.
    pub fn open(
        folder: &Path,
        (document, grid, hash): (&Document, &Grid, &str),
        columns: Vec<Column>,
        fresh: bool,
    ) -> Result<Table, Box<dyn Error>> {
        let path = folder.join("sweep.csv");
        let earlier = earlier(folder, ("statics", hash), fresh)?;
        let unfinished = earlier.filter(|earlier| earlier["complete"] == false);
        let rows = match &unfinished {
            Some(_) => kept_rows(&path, &columns, grid.len())?,
            None => BTreeMap::new(),
        };
        // The old table goes before the new record is there, so that no row is taken for one of another sweep.
        report::remove_tables(folder, unfinished.is_none())?;
        if unfinished.is_none() {
            report::write_record(folder, &report::started(document, grid, ("statics", hash)))?;
        }
        write_atomic(&path, series(&columns, rows.values())?.to_csv()?.as_bytes())?;
        let file = OpenOptions::new().append(true).open(&path);
        let file = file.map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        Ok(Table { columns, rows, failures: BTreeMap::new(), path, file })
    }

    /// The table of all shards of a sweep, in `folder`.
    ///
    /// # Errors
    /// A shard that cannot be read, a point that is in no shard or in two.
    pub fn merged(
        folder: &Path,
        grid: &Grid,
        columns: Vec<Column>,
        shards: &[PathBuf],
    ) -> Result<Table, Box<dyn Error>> {
        let (mut rows, mut failures) = (BTreeMap::new(), BTreeMap::new());
        let mut points = Vec::new();
        for shard in shards {
            let own = kept_rows(&shard.join("sweep.csv"), &columns, grid.len())?;
            let missed = super::shard::failures(shard)?;
            points.extend(own.keys().chain(missed.keys()));
            rows.extend(own);
            failures.extend(missed);
        }
        super::shard::check_points(&points, grid)?;
        let path = folder.join("sweep.csv");
        let file = OpenOptions::new().append(true).create(true).open(&path);
        let file = file.map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        Ok(Table { columns, rows, failures, path, file })
    }

    /// Number of points solved or found to have no solution.
    pub fn done(&self) -> usize {
        self.rows.len() + self.failures.len()
    }

    pub fn has_all(&self, points: &Range<usize>) -> bool {
        self.rows.range(points.clone()).count() == points.len()
    }

    /// Adds the points of a block, on disk first.
    pub fn append(
        &mut self,
        rows: Vec<Vec<f64>>,
        failures: Vec<(usize, String)>,
    ) -> Result<(), Box<dyn Error + Send + Sync>> {
        let text = series(&self.columns, rows.iter())?.to_csv()?;
        let lines = text.split_once('\n').map_or("", |(_, lines)| lines);
        self.file.write_all(lines.as_bytes()).map_err(|source| {
            bearing_dynamics::output::WriteError { path: self.path.clone(), source }
        })?;
        self.rows.extend(rows.into_iter().map(|row| (row[0] as usize, row)));
        self.failures.extend(failures);
        Ok(())
    }

    /// The table in the order of its points.
    pub fn series(&self) -> Result<Series, SeriesError> {
        series(&self.columns, self.rows.values())
    }
}

/// Record of an earlier sweep with this hash in the folder; `None` if there is none, or it is discarded.
///
/// # Errors
/// A sweep of the other kind, or an unfinished one with another hash.
pub fn earlier(
    folder: &Path,
    (of, hash): (&str, &str),
    fresh: bool,
) -> Result<Option<Value>, Box<dyn Error>> {
    let path = folder.join("sweep.json");
    if !path.exists() {
        return Ok(None);
    }
    let found = json::read(&path)?;
    let kind = found["of"].as_str().unwrap_or("statics");
    if kind != of {
        let folder = folder.display();
        let message = format!("{folder} holds a sweep of {kind}; name another folder with --out");
        return Err(message.into());
    }
    if found["hash"] == hash || fresh || found["complete"] == true {
        return Ok(Some(found).filter(|found| found["hash"] == hash && !fresh));
    }
    Err(format!(
        "{} belongs to an unfinished sweep of another scene or of other values; finish that one, \
         choose another --out, or discard it with --fresh",
        path.display()
    )
    .into())
}

fn series<'a>(
    columns: &[Column],
    rows: impl Iterator<Item = &'a Vec<f64>>,
) -> Result<Series, SeriesError> {
    let flat: Vec<f64> = rows.flatten().copied().collect();
    let shape = (flat.len() / columns.len(), columns.len());
    let table = Array2::from_shape_vec(shape, flat).expect("each row has a value for each column");
    Series::new(columns.to_vec(), table)
}

/// Whole rows of `sweep.csv`. A line that an interruption cut off, or that is no row, is left out.
fn kept_rows(
    path: &Path,
    columns: &[Column],
    points: usize,
) -> Result<BTreeMap<usize, Vec<f64>>, Box<dyn Error>> {
    let bytes = match std::fs::read(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(BTreeMap::new()),
        other => other.map_err(|error| format!("cannot read {}: {error}", path.display()))?,
    };
    let text = String::from_utf8_lossy(&bytes);
    let whole = text.rsplit_once('\n').map_or("", |(whole, _)| whole);
    let rows = whole.lines().skip(1).filter_map(|line| {
        let row: Vec<f64> = line.split(',').map(str::parse).collect::<Result<_, _>>().ok()?;
        let is_row = row.len() == columns.len() && row[0] < points as f64;
        is_row.then(|| (row[0] as usize, row))
    });
    Ok(rows.collect())
}
