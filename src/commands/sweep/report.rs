//! What a sweep leaves behind: `sweep.csv`, the same as `.npy`, and `sweep.json`.

use super::grid::Grid;
use super::journal::{Chunk, PointsWarned, gather};
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::{Column, Series, write_atomic};
use bearing_dynamics::scene::tables::keys;
use bearing_dynamics::scene::tables::keys::Kind;
use bearing_dynamics::scene::text::units::{parse_number, parse_quantity};
use bearing_dynamics::scene::{Document, SweepAxis};
use ndarray::Array2;
use serde_json::json;
use std::collections::HashMap;
use std::error::Error;
use std::path::Path;

pub struct Record {
    pub threads: usize,
    pub seconds: f64,
    pub complete: bool,
    pub columns: Vec<Column>,
}

/// The unit in which an axis is written: that of its first value, or `choice` for words.
pub fn unit_of(axis: &SweepAxis) -> String {
    let text = axis.value(0).unwrap_or_default();
    match kind_of(axis) {
        Some(Kind::Quantity(dimension, _) | Kind::Profile(dimension, _)) => {
            parse_quantity(&text, dimension).map_or(String::new(), |first| first.unit.into())
        }
        Some(Kind::Integer { .. } | Kind::Number(_)) => "1".into(),
        _ => "choice".into(),
    }
}

/// Number of an axis's value in [`unit_of`] the axis; words are numbered from 0 in `sweep.json`.
pub fn number_of(axis: &SweepAxis, index: usize) -> f64 {
    let text = axis.value(index).unwrap_or_default();
    match kind_of(axis) {
        Some(Kind::Quantity(dimension, _) | Kind::Profile(dimension, _)) => {
            let first = axis.value(0).unwrap_or_default();
            match (parse_quantity(&text, dimension), parse_quantity(&first, dimension)) {
                (Ok(value), Ok(first)) if value.scale == first.scale => value.number,
                (Ok(value), Ok(first)) => value.si / first.scale.factor(),
                // Values are checked when the axis is read.
                _ => f64::NAN,
            }
        }
        Some(Kind::Integer { .. } | Kind::Number(_)) => parse_number(&text).unwrap_or(f64::NAN),
        _ => index as f64,
    }
}

fn kind_of(axis: &SweepAxis) -> Option<Kind> {
    keys::find_named(&axis.key).map(|leads| leads.key.kind)
}

/// Removes the table of an earlier sweep, which would pass for this one's until that is written.
pub fn remove_earlier(folder: &Path) -> Result<(), Box<dyn Error>> {
    for name in ["sweep.json", "sweep.csv", "sweep.npy", "sweep.columns.json"] {
        let path = folder.join(name);
        if path.is_file() {
            std::fs::remove_file(&path)
                .map_err(|error| format!("cannot replace {}: {error}", path.display()))?;
        }
    }
    Ok(())
}

/// Warnings on points, each code once.
pub fn warnings(chunks: &[Chunk]) -> Vec<PointsWarned> {
    let mut warnings = Vec::new();
    gather(&mut warnings, chunks.iter().flat_map(|chunk| chunk.warnings.iter().cloned()));
    warnings
}

/// Differences below this part of the largest number in its unit are what a search for an equilibrium leaves.
const ALIKE: f64 = 1e-9;

/// Varied keys that change nothing: points that differ in one of them alone have the same rows but for rounding.
pub fn idle_keys(grid: &Grid, columns: &[Column], chunks: &[Chunk]) -> Vec<String> {
    let first = 1 + grid.axes.len();
    let results: Vec<usize> =
        (first..columns.len()).filter(|&i| columns[i].name != "warnings").collect();
    let rows = || chunks.iter().flat_map(|chunk| &chunk.rows);
    let mut largest: HashMap<&str, f64> = HashMap::new();
    for row in rows() {
        for &i in &results {
            let most = largest.entry(columns[i].unit.as_str()).or_default();
            *most = most.max(row[i].abs());
        }
    }
    let alike = |a: &[f64], b: &[f64]| {
        results.iter().all(|&i| (a[i] - b[i]).abs() <= ALIKE * largest[columns[i].unit.as_str()])
    };
    let of_point: HashMap<usize, &[f64]> = rows().map(|row| (row[0] as usize, &row[..])).collect();
    let is_idle = |axis: usize| {
        let stride: usize = grid.axes[axis + 1..].iter().map(SweepAxis::len).product();
        let mut pairs = of_point.iter().filter_map(|(point, row)| {
            let next = grid.indices(*point)[axis] + 1 < grid.axes[axis].len();
            of_point.get(&(point + stride)).filter(|_| next).map(|other| (row, other))
        });
        let some = pairs.next();
        some.is_some_and(|(a, b)| alike(a, b)) && pairs.all(|(a, b)| alike(a, b))
    };
    let idle = (0..grid.axes.len()).filter(|&axis| is_idle(axis));
    idle.map(|axis| grid.axes[axis].key.clone()).collect()
}

/// The varied keys of a point with their values.
fn values(grid: &Grid, point: usize) -> Vec<String> {
    let axes = grid.axes.iter().zip(grid.indices(point));
    axes.map(|(axis, index)| format!("{} = {}", axis.key, axis.value(index).unwrap_or_default()))
        .collect()
}

pub fn write(
    folder: &Path,
    document: &Document,
    grid: &Grid,
    chunks: &[Chunk],
    record: &Record,
) -> Result<(), Box<dyn Error>> {
    let columns = record.columns.clone();
    let width = columns.len();
    let flat: Vec<f64> = chunks.iter().flat_map(|chunk| &chunk.rows).flatten().copied().collect();
    let table = Array2::from_shape_vec((flat.len() / width, width), flat)?;
    let series = Series::new(columns, table)?;
    series.write_csv(&folder.join("sweep.csv"))?;
    series.write_npy(&folder.join("sweep.npy"))?;
    let axes: Vec<_> = grid
        .axes
        .iter()
        .map(|axis| {
            let mut entry = json!({ "key": axis.key, "count": axis.len(), "unit": unit_of(axis) });
            if unit_of(axis) == "choice" {
                let names: Vec<_> = (0..axis.len()).filter_map(|i| axis.value(i)).collect();
                entry["choices"] = json!(names);
            }
            entry
        })
        .collect();
    let failures = chunks.iter().flat_map(|chunk| &chunk.failures).map(|failure| {
        json!({ "point": failure.point, "at": values(grid, failure.point), "message": failure.message })
    });
    let warnings = warnings(chunks).into_iter().map(|PointsWarned { code, text, point, points }| {
        json!({ "code": code, "text": text, "point": point, "at": values(grid, point), "points": points })
    });
    let summary = json!({
        "program": env!("CARGO_PKG_NAME"),
        "version": env!("CARGO_PKG_VERSION"),
        "scene": document.name(),
        "axes": axes,
        "points": grid.len(),
        "solved": series.data().nrows(),
        "complete": record.complete,
        "failures": failures.collect::<Vec<_>>(),
        "warnings": warnings.collect::<Vec<_>>(),
        "threads": record.threads,
        "seconds": record.seconds,
    });
    write_atomic(&folder.join("sweep.json"), pretty(&summary).as_bytes())?;
    Ok(())
}
