//! Time series of a run for its summary and plots.

use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::members::sensor::Acquisition;
use crate::numeric::clock::to_digits;
use crate::output::acquisition::{Signal, acquire};
use crate::output::defect_lines::{BearingLines, lines};
use crate::output::series::{Series, SeriesError};
use crate::output::session::Session;
use crate::output::spectrum::{Spectrum, envelope_spectrum, spectrum};
use std::ops::Range;

/// A mean speed below this one, rad/s, is rounding: one turn in two hundred years.
const LEAST_SPEED: f64 = 1e-9;

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
    pub sensors: Vec<SensorChannel>,
    /// Geometry of each bearing.
    pub geometries: Vec<BearingGeometry>,
}

/// A sensor, its column and its data acquisition.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorChannel {
    pub name: String,
    pub column: String,
    pub acquisition: Acquisition,
}

impl SensorChannel {
    /// Name of the channel of its envelope in spectra.
    pub fn envelope(&self) -> String {
        format!("{}_envelope", self.column)
    }

    /// Recorded quantity, such as `acceleration`.
    pub fn quantity(&self) -> &str {
        self.column.strip_prefix(self.name.as_str()).map_or("", |of| of.trim_start_matches('_'))
    }
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

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
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
        let sensors = sensors
            .map(|of| SensorChannel {
                name: of.name.clone(),
                column: of.column().0,
                acquisition: of.acquisition,
            })
            .collect();
        let geometries = assembly
            .map_or(&[][..], |assembly| &assembly.bearings)
            .iter()
            .map(|bearing| bearing.geometry)
            .collect();
        let window = start..end;
        Ok(RunTable { series, interval, window, bearings, bodies, sensors, geometries })
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

    /// Sensor whose spectrum, or whose envelope's spectrum, has this name.
    pub fn sensor(&self, channel: &str) -> Option<&SensorChannel> {
        self.sensors.iter().find(|of| of.column == channel || of.envelope() == channel)
    }

    /// Unit of a channel, also of the envelope of a sensor's.
    pub fn unit(&self, channel: &str) -> &str {
        let channel = self.sensor(channel).map_or(channel, |of| &of.column);
        let found = self.series.columns().iter().find(|column| column.name == channel);
        found.map_or("", |column| column.unit.as_str())
    }

    /// Values of a sensor over the window, filtered and sampled; `None` if it is not recorded.
    pub fn acquired(&self, sensor: &SensorChannel) -> Option<Signal> {
        let rows = self.all(&sensor.column)?;
        Some(acquire(&rows, self.window.clone(), self.interval, &sensor.acquisition))
    }

    /// Mean speeds of the inner and the outer race of a bearing over the window, rad/s; zero below 1e-9 rad/s.
    pub fn race_speeds(&self, prefix: &str) -> Option<[f64; 2]> {
        let speed = |side: &str| {
            let mean = mean(&self.windowed(&format!("{prefix}{side}_speed"))?);
            Some(if mean.abs() < LEAST_SPEED { 0.0 } else { mean })
        };
        Some([speed("inner")?, speed("outer").unwrap_or(0.0)])
    }

    /// Defect lines of each bearing at its mean speeds over the window; bearings whose races have no recorded speed, or
    /// stand still, have none.
    pub fn defect_lines(&self) -> Vec<BearingLines> {
        let of = |(prefix, geometry): (&String, &BearingGeometry)| {
            let windowed = |channel: &str| self.windowed(&format!("{prefix}{channel}"));
            let inner = windowed("inner_speed").filter(|of| !of.is_empty())?;
            let outer = windowed("outer_speed").unwrap_or_else(|| vec![0.0; inner.len()]);
            let speeds = self.race_speeds(prefix)?;
            let relative = inner.iter().zip(&outer).map(|(inner, outer)| inner - outer);
            let (low, high) = relative
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), of| (a.min(of), b.max(of)));
            let mean_relative = (speeds[0] - speeds[1]).abs();
            if mean_relative.is_nan() || mean_relative < LEAST_SPEED {
                return None;
            }
            let angle = |side: &str| {
                let mean = mean(&windowed(&format!("mean_{side}_contact_angle"))?).to_radians();
                Some(mean).filter(|angle| angle.is_finite())
            };
            let (contact_angle, angle_is) = match (angle("inner"), angle("outer")) {
                (Some(inner), Some(outer)) => (
                    0.5 * (inner + outer),
                    "mean of both contact angles over the window, weighted by ball load",
                ),
                _ => (
                    geometry.contact_angle,
                    "nominal, because the channels `orbits` are not recorded",
                ),
            };
            Some(BearingLines {
                prefix: prefix.clone(),
                speeds,
                speed_change: (high - low) / mean_relative,
                contact_angle,
                angle_is,
                lines: lines(prefix, geometry, speeds, contact_angle),
            })
        };
        self.bearings.iter().zip(&self.geometries).filter_map(of).collect()
    }

    /// Spectra of the recorded displacements of all bodies, of the sensors and of their envelopes over the window.
    pub fn spectra(&self) -> Vec<(String, Spectrum)> {
        let of = |channel: String| {
            let values = self.windowed(&channel)?;
            Some((channel, spectrum(&values, self.interval)?))
        };
        let channels = self
            .bodies
            .iter()
            .flat_map(|body| ["x", "y", "z"].map(|axis| format!("{}_{axis}", body.column)));
        let mut spectra: Vec<(String, Spectrum)> = channels.filter_map(of).collect();
        for sensor in &self.sensors {
            let Some(Signal { values, interval }) = self.acquired(sensor) else { continue };
            let own = spectrum(&values, interval).map(|of| (sensor.column.clone(), of));
            let band = sensor.acquisition.envelope_band;
            let envelope = band.and_then(|band| envelope_spectrum(&values, interval, band));
            spectra.extend(own.into_iter().chain(envelope.map(|of| (sensor.envelope(), of))));
        }
        spectra
    }
}
