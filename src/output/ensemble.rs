//! Results of an ensemble of runs: statistics of each channel over the window of each run, and their spread over the runs.

use crate::output::results::{ResultsError, program, quantity, write_results};
use crate::output::series::{Column, Series};
use ndarray::Array2;
use serde_json::{Map, Value, json};
use std::path::Path;

/// Statistics of a channel over the window of a run, as in its summary.
pub const STATISTICS: [&str; 4] = ["mean", "rms", "smallest", "largest"];

/// A channel of a run with its [`STATISTICS`].
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    pub name: String,
    pub unit: String,
    pub values: [f64; 4],
}

/// Channels of a run from its `summary.json`; `None` if the run has not reached its window.
pub fn channels(summary: &Value) -> Option<Vec<Channel>> {
    let of = |(name, entry): (&String, &Value)| {
        let mut values = [0.0; 4];
        for (value, statistic) in values.iter_mut().zip(STATISTICS) {
            *value = entry[statistic]["value"].as_f64()?;
        }
        let unit = entry["mean"]["unit"].as_str()?.to_string();
        Some(Channel { name: name.clone(), unit, values })
    };
    summary["window"]["channels"].as_object()?.iter().map(of).collect()
}

/// Spread of a quantity over the runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    pub mean: f64,
    /// Standard deviation of the sample; 0 for a single run.
    pub deviation: f64,
    pub smallest: f64,
    pub largest: f64,
}

impl Spread {
    /// Spread of values; NaN without any.
    pub fn of(values: &[f64]) -> Spread {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let deviation = (square / values.len().saturating_sub(1).max(1) as f64).sqrt();
        let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Spread { mean, deviation, smallest, largest }
    }
}

/// A run of an ensemble: its number and varied keys, and its channels.
pub struct Run {
    pub start: Vec<f64>,
    pub channels: Vec<Channel>,
}

/// Writes `series.csv` and `.npy` with a row for each run, and `summary.json` with the spread of each statistic. All runs have the
/// same channels; `start` are the columns before these.
///
/// # Errors
/// A value that is not finite, a name used twice, a file that cannot be written.
pub fn write(folder: &Path, start: &[Column], runs: &[Run]) -> Result<(), ResultsError> {
    let first = runs.first().map_or(&[][..], |run| &run.channels);
    let mut columns = start.to_vec();
    let mut spreads = Map::new();
    for (index, channel) in first.iter().enumerate() {
        let mut spread_of_channel = Map::new();
        for (statistic, name) in STATISTICS.iter().enumerate() {
            columns.push(Column::new(format!("{}_{name}", channel.name), &channel.unit));
            let values: Vec<f64> =
                runs.iter().map(|run| run.channels[index].values[statistic]).collect();
            let Spread { mean, deviation, smallest, largest } = Spread::of(&values);
            let entry = |value| quantity(&channel.name, value, &channel.unit);
            let spread = json!({
                "mean": entry(mean)?,
                "deviation": entry(deviation)?,
                "smallest": entry(smallest)?,
                "largest": entry(largest)?,
            });
            spread_of_channel.insert(name.to_string(), spread);
        }
        spreads.insert(channel.name.clone(), Value::Object(spread_of_channel));
    }
    let row = |run: &Run| {
        let values = run.channels.iter().flat_map(|channel| channel.values);
        run.start.iter().copied().chain(values).collect::<Vec<f64>>()
    };
    let rows: Vec<f64> = runs.iter().flat_map(row).collect();
    let table = Array2::from_shape_vec((runs.len(), columns.len()), rows)
        .expect("each run has a value for each column");
    let summary = json!({
        "program": program(),
        "kind": "sweep of runs",
        "runs": runs.len(),
        "channels": spreads,
    });
    write_results(folder, &Series::new(columns, table)?, &summary)?;
    Ok(())
}
