//! The time series of a run as its summary and its plots look at it.

use crate::output::series::{Series, SeriesError};
use crate::output::session::Session;
use crate::output::spectrum::{Spectrum, spectrum};
use crate::solver::clock::to_digits;
use std::ops::Range;

/// All rows of a run, and which of them means and spectra are taken over.
#[derive(Clone, Debug)]
pub struct RunTable {
    pub series: Series,
    /// Time between rows, s.
    pub interval: f64,
    /// Rows of the window, at equal intervals; empty while the run has not come there.
    pub window: Range<usize>,
}

/// Channels whose spectra are drawn and searched for peaks, as far as they are recorded.
pub const SPECTRAL_CHANNELS: [&str; 9] = [
    "inner_x", "inner_y", "inner_z", "outer_x", "outer_y", "outer_z", "cage_x", "cage_y", "cage_z",
];

/// Time of row number `row` as people write it, s; rows on the grid are `interval` (s) apart.
pub fn readable(row: usize, time: f64, interval: f64) -> f64 {
    let on_grid = row as f64 * interval;
    to_digits(if (time - on_grid).abs() <= 1e-6 * interval { on_grid } else { time }, 12)
}

impl RunTable {
    /// The window starts at `window_start` (s) and ends with the run.
    ///
    /// # Errors
    /// Never for a session's own columns.
    pub fn new(session: &Session, window_start: f64) -> Result<RunTable, SeriesError> {
        let series = session.series()?;
        let interval = session.clock.row_interval();
        let end = session.rows_on_grid();
        // A start that lies on a row but for rounding takes that row.
        let from = window_start - 1e-6 * interval;
        let times = series.data().column(0);
        let start = times.iter().position(|time| *time >= from).map_or(end, |row| row.min(end));
        Ok(RunTable { series, interval, window: start..end })
    }

    /// Time of a row as people write it, s: of rows on the grid by their number, so that the rounding
    /// of many steps does not show.
    pub fn time(&self, row: usize) -> f64 {
        readable(row, self.series.data()[(row, 0)], self.interval)
    }

    /// Values of a channel in the window, or `None` if it is not recorded.
    pub fn windowed(&self, channel: &str) -> Option<Vec<f64>> {
        let values = self.series.column(channel)?;
        Some(self.window.clone().map(|row| values[row]).collect())
    }

    /// All values of a channel, or `None` if it is not recorded.
    pub fn all(&self, channel: &str) -> Option<Vec<f64>> {
        Some(self.series.column(channel)?.to_vec())
    }

    pub fn unit(&self, channel: &str) -> &str {
        let found = self.series.columns().iter().find(|column| column.name == channel);
        found.map_or("", |column| column.unit.as_str())
    }

    /// Spectra of the [`SPECTRAL_CHANNELS`] over the window.
    pub fn spectra(&self) -> Vec<(String, Spectrum)> {
        let of = |channel: &'static str| {
            Some((channel.to_string(), spectrum(&self.windowed(channel)?, self.interval)?))
        };
        SPECTRAL_CHANNELS.into_iter().filter_map(of).collect()
    }
}
