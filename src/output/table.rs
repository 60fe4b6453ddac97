//! The time series of a run as its summary and its plots look at it.

use crate::assembly::lists::Assembly;
use crate::numeric::clock::to_digits;
use crate::output::series::{Series, SeriesError};
use crate::output::session::Session;
use crate::output::spectrum::{Spectrum, spectrum};
use std::ops::Range;

/// All rows of a run, and which of them means and spectra are taken over.
#[derive(Clone, Debug)]
pub struct RunTable {
    pub series: Series,
    /// Time between rows, s.
    pub interval: f64,
    /// Rows of the window, at equal intervals; empty while the run has not come there.
    pub window: Range<usize>,
    /// Before the names of columns of each bearing: nothing where there is one only.
    pub bearings: Vec<String>,
    /// Races, cages, other bodies and sections of those that bend, as far as they may have columns.
    pub bodies: Vec<Moving>,
    /// Name and column of each sensor.
    pub sensors: Vec<(String, String)>,
}

/// A body as its columns and pictures name it.
#[derive(Clone, Debug, PartialEq)]
pub struct Moving {
    /// Columns begin with it, `left_inner`.
    pub column: String,
    /// "left inner race".
    pub title: String,
    /// Column of the speed that it spins at.
    pub speed: String,
}

impl Moving {
    fn of(column: String, title: String) -> Moving {
        let speed = format!("{column}_speed");
        Moving { column, title, speed }
    }
}

/// Bodies of the bearings with these prefixes, then those with labels, then sections that are watched.
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
        bodies.extend(shaft.watched.iter().map(|(name, _)| Moving {
            column: format!("{label}_{name}"),
            title: format!("{label} at {name}"),
            speed: format!("{label}_speed"),
        }));
    }
    bodies
}

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

    /// Columns of work and heat in which anything was done.
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

    /// Spectra of the displacements of all bodies and of what sensors read over the window, as far as they are recorded.
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
