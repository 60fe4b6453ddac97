//! Files of a sweep: `sweep.csv`, the same as `.npy`, and `sweep.json`.

use super::grid::Grid;
use super::table::Table;
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::warnings::{Entry, TABLE};
use bearing_dynamics::output::{WriteError, write_atomic};
use bearing_dynamics::scene::tables::keys;
use bearing_dynamics::scene::tables::keys::Kind;
use bearing_dynamics::scene::text::units::{parse_number, parse_quantity};
use bearing_dynamics::scene::{Document, SweepAxis};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

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

/// Removes the tables of an earlier sweep; `csv` too if its rows are not resumed.
pub fn remove_tables(folder: &Path, csv: bool) -> Result<(), Box<dyn Error>> {
    let tables = ["sweep.npy", "sweep.columns.json", "sweep.csv"];
    for path in tables[..if csv { 3 } else { 2 }].iter().map(|name| folder.join(name)) {
        if path.is_file() {
            std::fs::remove_file(&path)
                .map_err(|error| format!("cannot replace {}: {error}", path.display()))?;
        }
    }
    Ok(())
}

/// A warning on one or more points.
pub struct PointsWarned {
    pub entry: &'static Entry,
    /// The first point.
    pub point: usize,
    pub points: usize,
}

/// Warnings in the column `warnings`, each code once.
pub fn warnings(table: &Table) -> Vec<PointsWarned> {
    let mut warnings: BTreeMap<usize, PointsWarned> = BTreeMap::new();
    for (&point, row) in &table.rows {
        let mut codes = row.last().copied().unwrap_or_default() as u64;
        while codes > 0 {
            let number = (codes % 100) as usize;
            codes /= 100;
            let first = PointsWarned { entry: &TABLE[number - 1], point, points: 0 };
            warnings.entry(number).or_insert(first).points += 1;
        }
    }
    warnings.into_values().collect()
}

/// The varied keys of a point with their values.
fn values(grid: &Grid, point: usize) -> Vec<String> {
    let axes = grid.axes.iter().zip(grid.indices(point));
    axes.map(|(axis, index)| format!("{} = {}", axis.key, axis.value(index).unwrap_or_default()))
        .collect()
}

/// Points that failed, with their messages.
pub fn failures(grid: &Grid, failures: &BTreeMap<usize, String>) -> Value {
    let entry = |(&point, message): (&usize, &String)| json!({ "point": point, "at": values(grid, point), "message": message });
    failures.iter().map(entry).collect()
}

/// `sweep.json` of a sweep without a point yet.
pub fn started(document: &Document, grid: &Grid, (of, hash): (&str, &str)) -> Value {
    let axes = grid.axes.iter().map(|axis| {
        let mut entry = json!({ "key": axis.key, "count": axis.len(), "unit": unit_of(axis) });
        if unit_of(axis) == "choice" {
            let names: Vec<_> = (0..axis.len()).filter_map(|i| axis.value(i)).collect();
            entry["choices"] = json!(names);
        }
        entry
    });
    json!({
        "program": env!("CARGO_PKG_NAME"),
        "version": env!("CARGO_PKG_VERSION"),
        "scene": document.name(),
        "of": of,
        "hash": hash,
        "axes": axes.collect::<Vec<_>>(),
        "points": grid.len(),
        "complete": false,
    })
}

pub fn write_record(folder: &Path, record: &Value) -> Result<(), WriteError> {
    write_atomic(&folder.join("sweep.json"), pretty(record).as_bytes())
}

/// Writes the table in the order of its points, and the record last; with so many `points` it is complete.
pub fn write(
    folder: &Path,
    (document, grid, hash): (&Document, &Grid, &str),
    table: &Table,
    (points, threads, seconds): (usize, usize, f64),
) -> Result<(), Box<dyn Error>> {
    let series = table.series()?;
    series.write_csv(&folder.join("sweep.csv"))?;
    series.write_npy(&folder.join("sweep.npy"))?;
    let warnings = warnings(table).into_iter().map(|PointsWarned { entry, point, points }| {
        json!({
            "code": entry.name, "text": entry.title, "point": point, "at": values(grid, point), "points": points
        })
    });
    let mut record = started(document, grid, ("statics", hash));
    record["solved"] = json!(table.rows.len());
    record["complete"] = json!(table.done() == points);
    record["failures"] = failures(grid, &table.failures);
    record["warnings"] = warnings.collect();
    record["threads"] = json!(threads);
    record["seconds"] = json!(seconds);
    Ok(write_record(folder, &record)?)
}
