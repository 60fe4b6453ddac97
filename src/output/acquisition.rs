//! Data acquisition: low-pass filter and sampling of recorded channels.

use crate::members::sensor::Acquisition;
use std::f64::consts::{PI, SQRT_2};
use std::ops::Range;

/// Equally spaced values of a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    pub values: Vec<f64>,
    /// Sampling interval, s.
    pub interval: f64,
}

/// Rows between two samples: the whole number nearest to the ratio of the rates, at least 1.
fn rows_per_sample(sampling: Option<f64>, interval: f64) -> usize {
    sampling.map_or(1, |rate| (1.0 / (rate * interval)).round().max(1.0) as usize)
}

/// Rows of a window as a sensor's converter delivers them: filtered from the first row on, then sampled from the start of
/// the window. `rows` are `interval` (s) apart up to the end of the window.
pub fn acquire(
    rows: &[f64],
    window: Range<usize>,
    interval: f64,
    acquisition: &Acquisition,
) -> Signal {
    let end = window.end.min(rows.len());
    let start = window.start.min(end);
    let every = rows_per_sample(acquisition.sampling, interval);
    let sampled = |rows: &[f64]| rows[start..end].iter().step_by(every).copied().collect();
    let values = match acquisition.low_pass {
        None => sampled(rows),
        Some(cut_off) => sampled(&low_pass(&rows[..end], interval, cut_off)),
    };
    Signal { values, interval: every as f64 * interval }
}

/// Causal Butterworth low-pass filter of order 2, advanced once per value; the values are `interval` (s) apart.
///
/// The bilinear transform of 1/(s² + √2 s + 1), prewarped so that the gain at `cut_off` (Hz, below half the rate) is
/// 1/√2. The filter starts at rest at the first value.
///
/// ```
/// use bearing_dynamics::output::acquisition::low_pass;
/// assert_eq!(low_pass(&[3.0; 4], 1e-3, 100.0)[3], 3.0);
/// ```
pub fn low_pass(values: &[f64], interval: f64, cut_off: f64) -> Vec<f64> {
    let Some(&first) = values.first() else { return Vec::new() };
    let k = libm::tan(PI * cut_off * interval);
    let per = 1.0 / (1.0 + SQRT_2 * k + k * k);
    let (gain, a, b) = (k * k * per, 2.0 * (k * k - 1.0) * per, (1.0 - SQRT_2 * k + k * k) * per);
    // Differences from the first value, so that a constant passes exactly.
    let (mut before, mut after) = ([0.0; 2], [0.0; 2]);
    let mut advance = |value: f64| {
        let x = value - first;
        let y = gain * (x + 2.0 * before[0] + before[1]) - a * after[0] - b * after[1];
        (before, after) = ([x, before[0]], [y, after[0]]);
        first + y
    };
    values.iter().map(|value| advance(*value)).collect()
}
