//! `summary.json` of a run, with sections for its parts, and the tables.

mod bearing;
mod friction;
pub mod housing;
pub mod rubber;
pub mod solid;

use crate::members::sensor::Acquisition;
use crate::motion::error_control::SHARE;
use crate::motion::simulation::{Integrator, Simulation, Stepping};
use crate::numeric::clock::rounded;
use crate::output::atomic::write_atomic;
use crate::output::defect_lines::{
    BearingLines, DefectLine, NOISE_BINS, lines_for, overlap, read_line,
};
use crate::output::results::{ResultsError, RunRecord, insert_record, pretty, quantity};
use crate::output::series::{Column, Series, columns_path};
use crate::output::session::{Motion, Session, Status};
use crate::output::spectrum::{LEAKAGE, LOWEST, Spectrum, WINDOW, peaks};
use crate::output::state::SERIES;
use crate::output::table::{RunTable, SensorChannel};
use crate::solids::explicit::SolidStepping;
use ndarray::Array2;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

type Part = Result<Value, ResultsError>;

/// Number of peaks listed for each spectrum.
const PEAKS: usize = 8;

/// Data of a summary in addition to the session and its table.
#[derive(Clone, Debug, Default)]
pub struct RunReport {
    pub record: RunRecord,
    /// Reason why the run stopped before its end; `None` if it did not.
    pub stopped_by: Option<String>,
    /// Step control as requested by the scene.
    pub stepping: Option<Stepping>,
    pub integrator: Option<Integrator>,
    pub solid_stepping: Option<SolidStepping>,
}

/// Writes `series.csv`, `series.npy`, `spectrum.csv` if there are spectra, and `summary.json`;
/// returns the files.
///
/// # Errors
/// A value that is not finite, a file that cannot be written.
pub fn write_run_results(
    folder: &Path,
    session: &Session,
    table: &RunTable,
    spectra: &[(String, Spectrum)],
    report: &RunReport,
) -> Result<(Vec<PathBuf>, Value), ResultsError> {
    let summary = run_summary(session, table, spectra, report)?;
    let [csv, npy, json] = ["series.csv", SERIES, "summary.json"].map(|name| folder.join(name));
    match session.motion {
        // These times are not sums of many steps, and need no rounding.
        Motion::Housed(_) | Motion::QuasiStaticSequence(_) | Motion::Rubber(_) => {
            table.series.write_csv(&csv)?
        }
        Motion::Bearing(_) | Motion::Solid(_) => readable_times(table)?.write_csv(&csv)?,
    }
    table.series.write_npy(&npy)?;
    let mut written = vec![csv, columns_path(&npy), npy];
    for (name, series) in spectrum_series(table, spectra)? {
        let path = folder.join(name);
        series.write_csv(&path)?;
        written.push(path);
    }
    write_atomic(&json, pretty(&summary).as_bytes())?;
    written.push(json);
    Ok((written, summary))
}

fn readable_times(table: &RunTable) -> Result<Series, ResultsError> {
    let mut data = table.series.data().clone();
    for (row, time) in data.column_mut(0).iter_mut().enumerate() {
        *time = table.time(row);
    }
    Ok(Series::new(table.series.columns().to_vec(), data)?)
}

/// Files with one row per bin: frequency, then amplitudes. `spectrum.csv` has all channels with the bins of the first one,
/// every other channel a file of its own.
fn spectrum_series(
    table: &RunTable,
    spectra: &[(String, Spectrum)],
) -> Result<Vec<(String, Series)>, ResultsError> {
    let Some((_, first)) = spectra.first() else { return Ok(Vec::new()) };
    let bins = |of: &Spectrum| (of.amplitude.len(), of.bin_width);
    let (common, own): (Vec<_>, Vec<_>) =
        spectra.iter().partition(|(_, of)| bins(of) == bins(first));
    let mut files = vec![("spectrum.csv".to_string(), spectra_together(table, &common)?)];
    for of in own {
        files.push((format!("spectrum_{}.csv", of.0), spectra_together(table, &[of])?));
    }
    Ok(files)
}

/// Spectra with the same bins.
fn spectra_together(
    table: &RunTable,
    spectra: &[&(String, Spectrum)],
) -> Result<Series, ResultsError> {
    let first = &spectra[0].1;
    let mut columns = vec![Column::new("frequency", "Hz")];
    columns.extend(spectra.iter().map(|(name, _)| Column::new(name.clone(), table.unit(name))));
    let bins = first.amplitude.len();
    let data = Array2::from_shape_fn((bins, columns.len()), |(bin, column)| match column {
        0 => bin as f64 * first.bin_width,
        _ => spectra[column - 1].1.amplitude[bin],
    });
    Ok(Series::new(columns, data)?)
}

/// Content of `summary.json`.
///
/// # Errors
/// A value that is not finite, a `null` in a further section, a section name used twice.
pub fn run_summary(
    session: &Session,
    table: &RunTable,
    spectra: &[(String, Spectrum)],
    report: &RunReport,
) -> Result<Value, ResultsError> {
    let motion = &session.motion;
    let complete = session.status == Status::Complete && report.stopped_by.is_none();
    let mut summary = Map::new();
    let kind = match motion {
        Motion::Solid(_) => "run of a solid",
        Motion::Rubber(_) => "run of a solid of rubber",
        _ => "run",
    };
    summary.insert("kind".into(), json!(kind));
    if let Some(method) = housing::method(motion) {
        summary.insert("housing_method".into(), json!(method));
    }
    summary.insert("complete".into(), json!(complete));
    if let Some(reason) = &report.stopped_by {
        summary.insert("stopped_by".into(), json!(reason));
    }
    summary.insert("end".into(), quantity("end", session.clock.end, "s")?);
    summary.insert("time".into(), quantity("time", time(session, table), "s")?);
    summary.insert("output".into(), output(session, table)?);
    let work = match motion {
        Motion::Bearing(simulation) => bearing::work(simulation),
        Motion::Solid(moving) => solid::work(&moving.solid),
        Motion::Rubber(moving) => rubber::work(moving),
        Motion::Housed(housed) => housing::work(housed),
        Motion::QuasiStaticSequence(sequence) => {
            let effort = &sequence.effort;
            let residual = quantity("residual", effort.largest_residual, "1")?;
            summary.insert("largest_unbalanced_part_of_load".into(), residual);
            json!({
                "equilibria": session.recorder.rows(),
                "iterations": effort.iterations,
                "contact_changes": effort.contact_changes,
            })
        }
    };
    summary.insert("work".into(), work);
    let step = match motion {
        Motion::Bearing(simulation) => Some(bearing::step(simulation, report)?),
        Motion::Solid(moving) => Some(solid::step(&moving.solid, report)?),
        Motion::Housed(housed) => Some(housing::step(housed)?),
        Motion::Rubber(moving) => Some(rubber::step(moving)?),
        Motion::QuasiStaticSequence(_) => None,
    };
    if let Some(step) = step {
        summary.insert("step".into(), step);
    }
    // A quasi-static sequence has energy columns, but no energy balance.
    if let Some(energy) =
        energy(session, table)?.filter(|_| !matches!(motion, Motion::QuasiStaticSequence(_)))
    {
        summary.insert("energy".into(), energy);
    }
    if let Some(simulation) = motion.bearing() {
        summary.insert("extremes".into(), bearing::extremes(simulation)?);
    }
    summary.insert("final".into(), final_values(table)?);
    if table.window.is_empty() {
        let note = "the run has not reached the window yet";
        summary.insert("window".into(), json!({ "rows": 0, "note": note }));
    } else {
        summary.insert("window".into(), window(table)?);
        if let Some(simulation) = motion.bearing()
            && let Some(kinematics) = bearing::kinematics(simulation, table)?
        {
            summary.insert("kinematics".into(), kinematics);
        }
        if let Some(simulation) = motion.bearing()
            && let Some(friction) = friction::friction(simulation, table)?
        {
            summary.insert("friction".into(), friction);
        }
    }
    if !spectra.is_empty() {
        let section = match motion {
            Motion::Solid(_) | Motion::Rubber(_) => solid::spectra_section(spectra)?,
            _ => spectra_section(table, spectra, spectral_floor(session, table, spectra, report))?,
        };
        summary.insert("spectra".into(), section);
    }
    insert_record(&mut summary, &report.record)?;
    Ok(Value::Object(summary))
}

/// Time of the last row; of a single solid, which may stop between rows, the present time.
fn time(session: &Session, table: &RunTable) -> f64 {
    if let Motion::Solid(moving) = &session.motion {
        return rounded(moving.solid.time);
    }
    table.series.data().nrows().checked_sub(1).map_or(0.0, |last| table.time(last))
}

fn output(session: &Session, table: &RunTable) -> Result<Value, ResultsError> {
    let mut section = json!({
        "interval": quantity("interval", table.interval, "s")?,
        "steps_per_row": session.clock.steps_per_row,
        "rows": table.series.data().nrows(),
        "rows_at_equal_intervals": session.rows_on_grid(),
    });
    if let Some(rows) = session.clock.rows_per_fields {
        let interval = table.interval * rows as f64;
        section["fields_interval"] = quantity("fields interval", interval, "s")?;
    }
    Ok(section)
}

/// Energy balance at the last row: energies, works and the residual.
fn energy(session: &Session, table: &RunTable) -> Result<Option<Value>, ResultsError> {
    let Some(last) = table.series.data().nrows().checked_sub(1) else { return Ok(None) };
    let mut terms = Map::new();
    for (index, column) in table.series.columns().iter().enumerate() {
        let own = unprefixed(&column.name, &session.motion);
        if own.starts_with("energy_") || own.starts_with("work_") {
            let value = table.series.data()[(last, index)];
            terms.insert(column.name.clone(), quantity(&column.name, value, &column.unit)?);
        }
    }
    if terms.is_empty() {
        return Ok(None);
    }
    if let Some(residuals) = table.all("energy_residual") {
        // Includes the checks between rows.
        let looked = session.motion.bearing().map_or(0.0, Simulation::largest_residual);
        let largest = residuals.iter().fold(looked, |largest, value| largest.max(value.abs()));
        terms.insert("largest_residual".into(), quantity("largest_residual", largest, "J")?);
    }
    if session.motion.is_balanced_whole() {
        let watch = &session.watch;
        let (residual, turned_over) = (watch.largest_residual, watch.turned_over);
        let part = if turned_over > 0.0 { residual / turned_over } else { 0.0 };
        if matches!(session.motion, Motion::Solid(_)) {
            terms.insert("at_start".into(), quantity("energy", watch.first, "J")?);
        }
        terms.insert("turned_over".into(), quantity("energy", turned_over, "J")?);
        terms.insert("largest_residual".into(), quantity("energy", residual, "J")?);
        terms.insert("largest_residual_part".into(), quantity("part", part, "1")?);
    }
    Ok(Some(Value::Object(terms)))
}

/// Name of a column without the name of its solid, fit or bushing.
fn unprefixed<'n>(column: &'n str, motion: &Motion) -> &'n str {
    let Motion::Housed(housed) = motion else { return column };
    let solids = housed.solids.iter().map(|part| &part.name);
    let seats = housed.seats().map(|seat| &seat.seat.name);
    let bushings = housed.bushings.iter().map(|bushing| &bushing.name);
    let mut names = solids.chain(seats).flatten().chain(bushings);
    let own = |name: &String| column.strip_prefix(name.as_str())?.strip_prefix('_');
    names.find_map(own).unwrap_or(column)
}

fn final_values(table: &RunTable) -> Result<Value, ResultsError> {
    let mut values = Map::new();
    if let Some(last) = table.series.data().nrows().checked_sub(1) {
        for (index, column) in table.series.columns().iter().enumerate() {
            let value = table.series.data()[(last, index)];
            let value = if index == 0 { table.time(last) } else { value };
            values.insert(column.name.clone(), quantity(&column.name, value, &column.unit)?);
        }
    }
    Ok(Value::Object(values))
}

/// Mean, RMS about the mean, extremes and peak-to-peak amplitude of every channel over the window.
fn window(table: &RunTable) -> Result<Value, ResultsError> {
    let rows = table.window.clone();
    let mut channels = Map::new();
    for column in &table.series.columns()[1..] {
        let values = table.windowed(&column.name).unwrap_or_default();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
        let rms = (square / values.len() as f64).sqrt();
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let entry = |value: f64| quantity(&column.name, value, &column.unit);
        channels.insert(
            column.name.clone(),
            json!({
                "mean": entry(mean)?,
                "rms": entry(rms)?,
                "smallest": entry(low)?,
                "largest": entry(high)?,
                "peak_to_peak": entry(high - low)?,
            }),
        );
    }
    Ok(json!({
        "start": quantity("start", table.time(rows.start), "s")?,
        "end": quantity("end", table.time(rows.end - 1), "s")?,
        "rows": rows.len(),
        "channels": channels,
    }))
}

/// Peaks of a sensor below this fraction of its mean magnitude are rounding.
const SENSOR_ROUNDING: f64 = 1e-9;

/// Displacement amplitude below which peaks are not significant, m: 1e-4 of the highest of all bodies, or the error that
/// error control allows in a single step.
fn spectral_floor(
    session: &Session,
    table: &RunTable,
    spectra: &[(String, Spectrum)],
    report: &RunReport,
) -> f64 {
    let displacements = spectra.iter().filter(|(name, _)| table.unit(name) == "m");
    let bins = displacements.flat_map(|(_, spectrum)| spectrum.amplitude.iter().skip(1));
    let highest = bins.fold(0.0f64, |highest, bin| highest.max(*bin));
    let allowed = match (session.motion.bearing().and_then(|s| s.control.as_ref()), report.stepping)
    {
        (Some(control), Some(Stepping::Accuracy(accuracy))) => {
            SHARE * accuracy * control.memory.displacement
        }
        _ => 0.0,
    };
    allowed.max(1e-4 * highest)
}

fn spectra_section(
    table: &RunTable,
    spectra: &[(String, Spectrum)],
    floor: f64,
) -> Result<Value, ResultsError> {
    let mut channels = Map::new();
    let bin_width = spectra.first().map_or(0.0, |(_, spectrum)| spectrum.bin_width);
    let lines = table.defect_lines();
    for (name, spectrum) in spectra {
        let unit = table.unit(name);
        let sensor = table.sensor(name);
        let column = sensor.map_or(name, |of| &of.column);
        // The rounding of a sensor is proportional to its mean magnitude.
        let magnitude =
            || table.windowed(column).into_iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
        let floor = if unit == "m" { floor } else { SENSOR_ROUNDING * magnitude() };
        let found: Result<Vec<Value>, ResultsError> = peaks(spectrum, PEAKS, floor)
            .into_iter()
            .map(|peak| {
                Ok(json!({
                    "frequency": quantity("frequency", peak.frequency, "Hz")?,
                    "amplitude": quantity("amplitude", peak.amplitude, unit)?,
                    "bin_frequency": quantity("frequency", peak.bin_frequency, "Hz")?,
                    "bin_amplitude": quantity("amplitude", peak.bin_amplitude, unit)?,
                }))
            })
            .collect();
        let mut channel = json!({ "peaks": found? });
        if let Some(sensor) = sensor {
            acquisition(&mut channel, table, sensor, (name, spectrum))?;
        }
        let at_lines = line_readings(&lines, (name, spectrum), unit)?;
        if !at_lines.is_empty() {
            channel["lines"] = Value::Object(at_lines);
        }
        channels.insert(name.clone(), channel);
    }
    let mut section = json!({
        "window": WINDOW,
        "leakage": LEAKAGE,
        "rows": table.window.len(),
        "bin_width": quantity("bin_width", bin_width, "Hz")?,
        "lowest_peak": quantity("lowest peak", floor, "m")?,
        "lowest_peak_of_highest": LOWEST,
        "channels": channels,
    });
    if !lines.is_empty() {
        section["lines"] = lines_section(&lines)?;
    }
    Ok(section)
}

/// Adds what a sensor's spectrum was made from, where it is not the recorded column.
fn acquisition(
    channel: &mut Value,
    table: &RunTable,
    sensor: &SensorChannel,
    (name, spectrum): (&str, &Spectrum),
) -> Result<(), ResultsError> {
    let Acquisition { sampling, low_pass, envelope_band } = sensor.acquisition;
    if sampling.is_some()
        && let Some(signal) = table.acquired(sensor)
    {
        channel["sampling"] = quantity("sampling", 1.0 / signal.interval, "Hz")?;
        channel["samples"] = json!(signal.values.len());
        channel["bin_width"] = quantity("bin_width", spectrum.bin_width, "Hz")?;
    }
    if let Some(cut_off) = low_pass {
        channel["low_pass"] = quantity("low_pass", cut_off, "Hz")?;
        channel["filter"] = json!("causal Butterworth of order 2, once per output row");
    }
    if let Some(band) = envelope_band.filter(|_| *name == *sensor.envelope()) {
        let [low, high] = band.map(|frequency| quantity("envelope_band", frequency, "Hz"));
        channel["envelope_band"] = json!([low?, high?]);
        channel["envelope"] = json!("magnitude of the analytic signal in the band");
    }
    Ok(())
}

/// Amplitudes of a spectrum at the defect lines of its bearing, or of all bearings.
fn line_readings(
    lines: &[BearingLines],
    (name, spectrum): (&str, &Spectrum),
    unit: &str,
) -> Result<Map<String, Value>, ResultsError> {
    let mut readings = Map::new();
    let own: Vec<&DefectLine> = lines_for(lines, name).collect();
    for line in &own {
        let Some(found) = read_line(spectrum, line.frequency) else { continue };
        let bin_frequency = found.bin as f64 * spectrum.bin_width;
        let mut reading = json!({
            "amplitude": quantity("amplitude", found.amplitude, unit)?,
            "bin_frequency": quantity("frequency", bin_frequency, "Hz")?,
            "bins_from_nearest": found.offset,
        });
        if let Some(noise) = found.noise {
            reading["median_around"] = quantity("amplitude", noise, unit)?;
        }
        let near = |other: &&&DefectLine| {
            **other != *line && overlap(line.frequency, other.frequency, spectrum.bin_width)
        };
        let near: Vec<String> = own.iter().filter(near).map(|other| other.label()).collect();
        if !near.is_empty() {
            reading["not_separated_from"] = json!(near);
        }
        readings.insert(line.label(), reading);
    }
    Ok(readings)
}

/// Frequencies of the defect lines, and the means from which they follow.
fn lines_section(lines: &[BearingLines]) -> Result<Value, ResultsError> {
    let mut bearings = Vec::new();
    for of in lines {
        let mut frequencies = Map::new();
        for line in &of.lines {
            frequencies.insert(line.label(), quantity("frequency", line.frequency, "Hz")?);
        }
        let mut bearing = json!({
            "inner_race_speed": quantity("speed", of.speeds[0], "rad/s")?,
            "outer_race_speed": quantity("speed", of.speeds[1], "rad/s")?,
            "change_of_speed": quantity("change", of.speed_change, "1")?,
            "contact_angle": quantity("contact angle", of.contact_angle.to_degrees(), "deg")?,
            "contact_angle_is": of.angle_is,
            "frequencies": frequencies,
        });
        if let Some(name) = of.prefix.strip_suffix('_') {
            bearing["bearing"] = json!(name);
        }
        bearings.push(bearing);
    }
    Ok(json!({
        "are": "kinematic frequencies of pure rolling at the mean speeds over the window",
        "amplitude_is": "highest of the bin nearest to the line and its two neighbours; bins_from_nearest is its distance from the nearest",
        "median_around_is": format!(
            "median amplitude of up to {NOISE_BINS} bins on each side, without the three next to the line"
        ),
        "bearings": bearings,
    }))
}
