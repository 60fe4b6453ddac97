//! Time series of a run for its summary and plots.

use crate::assembly::lists::Assembly;
use crate::numeric::clock::to_digits;
use crate::output::series::{Series, SeriesError};
use crate::output::session::Session;
use crate::output::spectrum::{Spectrum, spectrum};
use std::ops::Range;

/// All rows of a run, and the window for means and spectra.
#[derive(Clone, Debug)]
pub struct RunTable {
    pub series: Series,
    /// Output interval, s.
    pub interval: f64,
    /// Rows of the window, at equal intervals; empty before the run reaches it.
    pub window: Range<usize>,
    /// Column prefix of each bearing; empty for a single bearing.
    pub bearings: Vec<String>,
    /// Races, cages, other bodies and probes that may have columns.
    pub bodies: Vec<Moving>,
    pub sensors: Vec<(String, String)>,
}

/// Names of a body in columns and plots.
#[derive(Clone, Debug, PartialEq)]
pub struct Moving {
    /// Column prefix, such as `left_inner`.
    pub column: String,
    /// Title, such as "left inner race".
    pub title: String,
    pub speed: String,
}

impl Moving {
    fn of(column: String, title: String) -> Moving {
        let speed = format!("{column}_speed");
        Moving { column, title, speed }
    }
}

/// Bodies of the bearings with these prefixes, then labelled bodies, then probes.
fn moving(bearings: &[String], assembly: Option<&Assembly>) -> Vec<Moving> {
    let mut bodies = Vec::new();
    for prefix in bearings {
        for (part, title) in [("inner", "inner race"), ("outer", "outer race"), ("cage", "cage")] {
            let title = format!("{}{title}", prefix.replace('_', " "));
            bodies.push(Moving::of(format!("{prefix}{part}"), title));
        }
    }
    let Some(assembly) = assembly else { return bodies };
    let labels = assembly.bodies.iter().filter_map(|body| body.label.clone());
    bodies.extend(labels.map(|label| Moving::of(label.clone(), label)));
    for shaft in &assembly.shafts {
        let Some(label) = &assembly.bodies[shaft.body].label else { continue };
        bodies.extend(shaft.probes.iter().map(|(name, _)| Moving {
            column: format!("{label}_{name}"),
            title: format!("{label} at {name}"),
            speed: format!("{label}_speed"),
        }));
    }
    bodies
}

/// Rounded time of row number `row`, s; rows on the grid are `interval` (s) apart.
pub fn readable(row: usize, time: f64, interval: f64) -> f64 {
    let on_grid = row as f64 * interval;
    to_digits(if (time - on_grid).abs() <= 1e-6 * interval { on_grid } else { time }, 12)
}

impl RunTable {
    /// Table of all rows; the window starts at `window_start` (s) and ends with the run.
    ///
    /// # Errors
    /// Never for the columns of a session.
    pub fn new(session: &Session, window_start: f64) -> Result<RunTable, SeriesError> {
        let series = session.series()?;
        let interval = session.clock.row_interval();
        let end = session.rows_on_grid();
        // A start within rounding of a row includes this row.
        let from = window_start - 1e-6 * interval;
        let times = series.data().column(0);
        let start = times.iter().position(|time| *time >= from).map_or(end, |row| row.min(end));
        let assembly = session.motion.assembly();
        let bearings: Vec<String> = match assembly {
            Some(assembly) => assembly.bearings.iter().map(|bearing| bearing.prefix()).collect(),
            None => vec![String::new()],
        };
        let bodies = moving(&bearings, assembly);
        let sensors = assembly.map_or(&[][..], |assembly| &assembly.sensors).iter();
        let sensors = sensors.map(|of| (of.name.clone(), of.column().0)).collect();
        Ok(RunTable { series, interval, window: start..end, bearings, bodies, sensors })
    }

    /// Time of a row, s; of rows on the grid computed from their number, so that the rounding
    /// of many steps does not appear.
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

    /// Columns of work and heat that are not zero throughout.
    pub fn works(&self) -> Vec<String> {
        let names = self.series.columns().iter().map(|column| &column.name);
        let of = |name: &&String| {
            let kind = |kind| name.starts_with(kind) || name.contains(&format!("_{kind}"));
            let done = || self.all(name).is_some_and(|all| all.iter().any(|done| *done != 0.0));
            (kind("work_") || kind("heat_")) && done()
        };
        names.filter(of).cloned().collect()
    }

    pub fn unit(&self, channel: &str) -> &str {
        let found = self.series.columns().iter().find(|column| column.name == channel);
        found.map_or("", |column| column.unit.as_str())
    }

    /// Spectra of the recorded displacements of all bodies and of the sensors over the window.
    pub fn spectra(&self) -> Vec<(String, Spectrum)> {
        let of = |channel: String| {
            let values = self.windowed(&channel)?;
            Some((channel, spectrum(&values, self.interval)?))
        };
        let channels = self
            .bodies
            .iter()
            .flat_map(|body| ["x", "y", "z"].map(|axis| format!("{}_{axis}", body.column)));
        let sensors = self.sensors.iter().map(|(_, column)| column.clone());
        channels.chain(sensors).filter_map(of).collect()
    }
}
