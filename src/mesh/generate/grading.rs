//! Stations along a line: uniform or graded.

use crate::mesh::error::MeshError;
use crate::mesh::generate::{between, divisions, ratio_between};

/// `count` + 1 evenly spaced stations from `from` to `to`, both ends exact.
pub fn uniform(from: f64, to: f64, count: usize) -> Vec<f64> {
    let count = count.max(1);
    let station = |i: usize| {
        if i == count { to } else { from + (to - from) * (i as f64 / count as f64) }
    };
    (0..=count).map(station).collect()
}

/// Stations from `from` to `to` whose first step is at most `first` and whose steps grow by
/// `growth` each; all are scaled so that the last one ends exactly at `to`.
///
/// # Errors
/// [`MeshError::Dimension`] for a first step that is not positive, a growth below 1, or too many
/// steps.
pub fn graded(from: f64, to: f64, first: f64, growth: f64) -> Result<Vec<f64>, MeshError> {
    between("first step", first, 0.0, f64::INFINITY)?;
    ratio_between("growth of steps", growth, 0.999_999, 100.0)?;
    let length = (to - from).abs();
    between("length to be divided", length, 0.0, f64::INFINITY)?;
    divisions("number of first steps in the length", (length / first).ceil() as usize, 0)?;
    let (mut steps, mut sum) = (vec![first], first);
    // A step that ends within rounding error of the end is the last one.
    while sum < length * (1.0 - 1e-12) {
        let step = steps[steps.len() - 1] * growth.max(1.0);
        steps.push(step);
        sum += step;
    }
    let (mut stations, mut reached) = (vec![from], 0.0);
    for step in &steps[..steps.len() - 1] {
        reached += step;
        stations.push(from + (to - from) * (reached / sum));
    }
    stations.push(to);
    Ok(stations)
}

/// Joins runs of stations, the end of each being the start of the next.
pub fn joined(runs: &[Vec<f64>]) -> Vec<f64> {
    let mut all: Vec<f64> = Vec::new();
    for run in runs {
        let skip = usize::from(!all.is_empty());
        all.extend(&run[skip.min(run.len())..]);
    }
    all
}
