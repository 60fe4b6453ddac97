//! Results folder of the natural modes of bodies: `summary.json`, and `series.csv` with one row per mode.

use crate::assembly::lists::Assembly;
use crate::equilibrium::lists::StaticAssembly;
use crate::equilibrium::quasi_static_limit::{Mode, MovingBody};
use crate::equilibrium::statics::COORDINATE_NAMES;
use crate::output::assembly_results::key;
use crate::output::results::{ResultsError, RunRecord, insert_record, quantity, write_results};
use crate::output::series::{Column, Series};
use ndarray::Array2;
use serde_json::{Map, Value, json};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// Natural frequency of a mode, Hz; 0 without a restoring force.
pub fn frequency(mode: &Mode) -> f64 {
    mode.square.max(0.0).sqrt() / TAU
}

/// Names of the coordinates of a mode, such as `shaft_z`. `housings` holds the column prefix and the number of modes of each
/// housing.
pub fn names(
    still: &StaticAssembly,
    bodies: &[MovingBody],
    moving: &Assembly,
    housings: &[(String, usize)],
) -> Vec<String> {
    let of = |of: &MovingBody| {
        let body = key(&still.bodies[of.body].name);
        COORDINATE_NAMES.map(|name| format!("{body}_{name}"))
    };
    let mut names: Vec<String> = bodies.iter().flat_map(of).collect();
    for shaft in &moving.shafts {
        let body = key(&moving.bodies[shaft.body].name);
        for along in ["y", "z"] {
            names.extend((1..=shaft.count()).map(|k| format!("{body}_bending_{k}_{along}")));
        }
        let stretches = shaft.amplitudes() - 2 * shaft.count();
        names.extend((1..=stretches).map(|k| format!("{body}_stretch_{k}")));
    }
    for (before, count) in housings {
        names.extend((1..=*count).map(|k| format!("{before}housing_mode_{k}")));
    }
    names
}

/// Writes summary and table and returns the files. Modes have unit modal mass: m and rad over √kg.
///
/// # Errors
/// A value that is not finite, a file that cannot be written.
pub fn write(
    folder: &Path,
    names: &[String],
    modes: &[Mode],
    record: &RunRecord,
) -> Result<Vec<PathBuf>, ResultsError> {
    let mut columns = vec![Column::new("mode", "1"), Column::new("frequency", "Hz")];
    columns.extend(names.iter().map(|name| Column::new(name.clone(), "1/kg^0.5")));
    let data = Array2::from_shape_fn((modes.len(), columns.len()), |(row, column)| match column {
        0 => (row + 1) as f64,
        1 => frequency(&modes[row]),
        _ => modes[row].shape[column - 2],
    });
    let series = Series::new(columns, data)?;
    let entry = |(index, mode): (usize, &Mode)| -> Result<Value, ResultsError> {
        let mut entry = json!({
            "mode": index + 1,
            "frequency": quantity("frequency", frequency(mode), "Hz")?,
            "moves_most": names[moves_most(mode)],
        });
        if !mode.housings.is_empty() {
            entry["housings_share"] = quantity("share", mode.housings.iter().sum(), "1")?;
        }
        Ok(entry)
    };
    let list: Result<Vec<Value>, _> = modes.iter().enumerate().map(entry).collect();
    let mut summary = Map::new();
    summary.insert("kind".into(), json!("natural modes of bodies"));
    summary.insert("modes".into(), json!(list?));
    insert_record(&mut summary, record)?;
    write_results(folder, &series, &Value::Object(summary))
}

/// Index of the coordinate with the largest share of the kinetic energy.
pub fn moves_most(mode: &Mode) -> usize {
    let energy = |i: &usize| mode.shape[*i] * mode.momentum[*i];
    let all = 0..mode.shape.len();
    all.max_by(|a, b| energy(a).total_cmp(&energy(b))).unwrap_or(0)
}
