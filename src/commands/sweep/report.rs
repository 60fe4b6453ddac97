//! What a sweep leaves behind: `sweep.csv`, the same as `.npy`, and `sweep.json`.

use super::grid::Grid;
use super::journal::Chunk;
use super::point::columns;
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::{Series, write_atomic};
use bearing_dynamics::scene::{Document, SweepAxis};
use ndarray::Array2;
use serde_json::json;
use std::error::Error;
use std::path::Path;

pub struct Record {
    pub threads: usize,
    pub seconds: f64,
    pub complete: bool,
}

/// The unit in which an axis is written: that of its first value, or `choice` for words.
pub fn unit_of(axis: &SweepAxis) -> String {
    match axis.value(0).as_deref().map(split) {
        Some(Some((_, unit))) if unit.is_empty() => "1".into(),
        Some(Some((_, unit))) => unit.into(),
        _ => "choice".into(),
    }
}

/// Number of an axis's value in [`unit_of`] the axis; words are numbered from 0 in `sweep.json`.
pub fn number_of(axis: &SweepAxis, index: usize) -> f64 {
    let unit = unit_of(axis);
    let plain = if unit == "1" { "" } else { unit.as_str() };
    match axis.value(index).as_deref().and_then(split) {
        Some((number, own)) if own == plain => number,
        _ => index as f64,
    }
}

/// Number and unit of a quantity as written.
fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let end = (0..=text.len())
        .rev()
        .filter(|&end| text.is_char_boundary(end))
        .find(|&end| text[..end].trim_end().parse::<f64>().is_ok_and(f64::is_finite))?;
    Some((text[..end].trim_end().parse().ok()?, text[end..].trim()))
}

pub fn write(
    folder: &Path,
    document: &Document,
    grid: &Grid,
    chunks: &[Chunk],
    record: &Record,
) -> Result<(), Box<dyn Error>> {
    let columns = columns(grid);
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
    let failures: Vec<_> = chunks
        .iter()
        .flat_map(|chunk| &chunk.failures)
        .map(|failure| {
            let at: Vec<_> = grid
                .axes
                .iter()
                .zip(grid.indices(failure.point))
                .map(|(axis, index)| {
                    format!("{} = {}", axis.key, axis.value(index).unwrap_or_default())
                })
                .collect();
            json!({ "point": failure.point, "at": at, "message": failure.message })
        })
        .collect();
    let summary = json!({
        "program": env!("CARGO_PKG_NAME"),
        "version": env!("CARGO_PKG_VERSION"),
        "scene": document.name(),
        "axes": axes,
        "points": grid.len(),
        "solved": series.data().nrows(),
        "complete": record.complete,
        "failures": failures,
        "threads": record.threads,
        "seconds": record.seconds,
    });
    write_atomic(&folder.join("sweep.json"), pretty(&summary).as_bytes())?;
    Ok(())
}
