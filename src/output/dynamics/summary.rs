//! `summary.json` of a run, and the folder around it.

use crate::ch2_housing::bearing::ball_contact::peak_pressure;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::contact_ellipse;
use crate::output::atomic::write_atomic;
use crate::output::dynamics::session::{Session, Status};
use crate::output::dynamics::table::RunTable;
use crate::output::results::{ResultsError, RunRecord, insert_record, pretty, quantity};
use crate::output::series::{Column, Series, columns_path};
use crate::output::spectrum::{LEAKAGE, LOWEST, Spectrum, WINDOW, peaks};
use crate::output::state::SERIES;
use crate::solver::clock::rounded;
use crate::solver::dynamics::assembly::{BallMeeting, Bearing};
use crate::solver::dynamics::control::SHARE;
use crate::solver::dynamics::extremes::Extreme;
use crate::solver::dynamics::run::{Integrator, Stepping};
use ndarray::Array2;
use serde_json::{Map, Value, json};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// Peaks listed of each spectrum.
const PEAKS: usize = 8;

/// What a summary needs beside the session and its table.
#[derive(Clone, Debug, Default)]
pub struct RunReport {
    pub record: RunRecord,
    /// What ended the run before its end, if anything did.
    pub stopped_by: Option<String>,
    /// How the steps were to be chosen, as the scene has it.
    pub stepping: Option<Stepping>,
    pub integrator: Option<Integrator>,
    /// Whether spectra were asked for.
    pub spectra: bool,
}

/// Writes `series.csv`, `series.npy`, `spectrum.csv` if asked for, and `summary.json`; returns
/// the files.
///
/// # Errors
/// A value that is not finite, a file that cannot be written.
pub fn write_run_results(
    folder: &Path,
    session: &Session,
    table: &RunTable,
    report: &RunReport,
) -> Result<Vec<PathBuf>, ResultsError> {
    let spectra = if report.spectra { table.spectra() } else { Vec::new() };
    let summary = run_summary(session, table, &spectra, report)?;
    let [csv, npy, json] = ["series.csv", SERIES, "summary.json"].map(|name| folder.join(name));
    readable_times(table)?.write_csv(&csv)?;
    table.series.write_npy(&npy)?;
    let mut written = vec![csv, columns_path(&npy), npy];
    if let Some(series) = spectrum_series(table, &spectra)? {
        let path = folder.join("spectrum.csv");
        series.write_csv(&path)?;
        written.push(path);
    }
    write_atomic(&json, pretty(&summary).as_bytes())?;
    written.push(json);
    Ok(written)
}

/// The table with the times of its rows as people write them.
fn readable_times(table: &RunTable) -> Result<Series, ResultsError> {
    let mut data = table.series.data().clone();
    for (row, time) in data.column_mut(0).iter_mut().enumerate() {
        *time = table.time(row);
    }
    Ok(Series::new(table.series.columns().to_vec(), data)?)
}

/// One row a bin: frequency, then the amplitude of each channel.
fn spectrum_series(
    table: &RunTable,
    spectra: &[(&'static str, Spectrum)],
) -> Result<Option<Series>, ResultsError> {
    let Some((_, first)) = spectra.first() else { return Ok(None) };
    let mut columns = vec![Column::new("frequency", "Hz")];
    columns.extend(spectra.iter().map(|(name, _)| Column::new(*name, table.unit(name))));
    let bins = first.amplitude.len();
    let data = Array2::from_shape_fn((bins, columns.len()), |(bin, column)| match column {
        0 => bin as f64 * first.bin_width,
        _ => spectra[column - 1].1.amplitude[bin],
    });
    Ok(Some(Series::new(columns, data)?))
}

/// Content of `summary.json`.
///
/// # Errors
/// A value that is not finite, a `null` in a further section, a section name used twice.
pub fn run_summary(
    session: &Session,
    table: &RunTable,
    spectra: &[(&'static str, Spectrum)],
    report: &RunReport,
) -> Result<Value, ResultsError> {
    let simulation = &session.simulation;
    let complete = session.status == Status::Complete;
    let mut summary = Map::new();
    summary.insert("kind".into(), json!("run"));
    summary.insert("complete".into(), json!(complete));
    if let Some(reason) = &report.stopped_by {
        summary.insert("stopped_by".into(), json!(reason));
    }
    summary.insert("end".into(), quantity("end", session.end, "s")?);
    summary.insert("time".into(), quantity("time", last_time(table), "s")?);
    summary.insert("step".into(), step(session, report)?);
    summary.insert("output".into(), output(session, table)?);
    let work = &simulation.system.work;
    summary.insert(
        "work".into(),
        json!({
            "steps": simulation.steps,
            "evaluations": work.evaluations,
            "distance_tests": work.distance_tests,
            "loaded_contacts": work.loaded_contacts,
            "slices": work.slices,
            "pocket_tests": work.pocket_tests,
            "guide_tests": work.guide_tests,
            "ball_tests": work.ball_tests,
            "factorisations": work.factorisations,
            "rejected_steps": work.rejected_steps,
        }),
    );
    if let Some(energy) = energy(table)? {
        summary.insert("energy".into(), energy);
    }
    summary.insert("extremes".into(), extremes(session)?);
    summary.insert("final".into(), final_values(table)?);
    if table.window.is_empty() {
        let note = "the run has not come to the window yet";
        summary.insert("window".into(), json!({ "rows": 0, "note": note }));
    } else {
        summary.insert("window".into(), window(table)?);
        if let Some(kinematics) = kinematics(session, table)? {
            summary.insert("kinematics".into(), kinematics);
        }
    }
    if !spectra.is_empty() {
        summary.insert(
            "spectra".into(),
            spectra_section(table, spectra, spectral_floor(session, spectra, report))?,
        );
    }
    insert_record(&mut summary, &report.record)?;
    Ok(Value::Object(summary))
}

fn last_time(table: &RunTable) -> f64 {
    table.series.data().nrows().checked_sub(1).map_or(0.0, |last| table.time(last))
}

fn step(session: &Session, report: &RunReport) -> Result<Value, ResultsError> {
    let simulation = &session.simulation;
    let size = simulation.step_size;
    let mut step = Map::new();
    if let Some(integrator) = report.integrator {
        step.insert("method".into(), json!(integrator.name()));
    }
    if let (Some(control), Some(Stepping::Accuracy(accuracy))) =
        (&simulation.control, report.stepping)
    {
        let memory = &control.memory;
        step.insert("accuracy".into(), json!(accuracy));
        step.insert("accepted".into(), json!(simulation.steps));
        step.insert("rejected".into(), json!(simulation.system.work.rejected_steps));
        step.insert("smallest".into(), quantity("smallest", memory.smallest, "s")?);
        step.insert("largest".into(), quantity("largest", memory.largest, "s")?);
        step.insert("scale".into(), quantity("largest overlap", memory.displacement, "m")?);
        step.insert("reason".into(), json!("error control: as long as the accuracy allows"));
        return Ok(Value::Object(step));
    }
    step.insert("size".into(), quantity("step", size, "s")?);
    let reason = match (&simulation.limit, report.stepping) {
        (Some(limit), Some(Stepping::FractionOfLimit(fraction))) => {
            step.insert("stability_limit".into(), quantity("limit", limit.step, "s")?);
            let watch = &simulation.step_watch;
            let when = match watch.shortened {
                None => "at the start".into(),
                Some(shortened) => {
                    step.insert("shortened".into(), json!(shortened.times));
                    step.insert("largest".into(), quantity("step", shortened.from, "s")?);
                    step.insert("smallest".into(), quantity("step", size, "s")?);
                    format!("at t = {} s, where it was last shortened", rounded(shortened.last))
                }
            };
            format!(
                "{fraction} of the stability limit {when}, shortened to a whole number of steps an \
                 output interval; {}",
                limit.reason()
            )
        }
        (Some(limit), _) => limit.reason(),
        (None, _) => "given".into(),
    };
    step.insert("reason".into(), json!(reason));
    let watch = &simulation.step_watch;
    step.insert("limit_judged".into(), json!(watch.judged));
    if let Some(smallest) = watch.smallest {
        step.insert("smallest_stability_limit".into(), quantity("limit", smallest, "s")?);
    }
    if let Some([ratio, time]) = watch.exceeded {
        let warning = format!(
            "the step is {ratio:.3} times the largest stable one at t = {} s; take a shorter one",
            rounded(time)
        );
        step.insert("warning".into(), json!(warning));
    }
    Ok(Value::Object(step))
}

fn output(session: &Session, table: &RunTable) -> Result<Value, ResultsError> {
    Ok(json!({
        "interval": quantity("interval", table.interval, "s")?,
        "steps_per_row": session.steps_per_row,
        "rows": table.series.data().nrows(),
        "rows_at_equal_intervals": session.rows_on_grid(),
    }))
}

/// The ledger at the last row: where the energy is, what went in and out, what is missing.
pub(crate) fn energy(table: &RunTable) -> Result<Option<Value>, ResultsError> {
    let Some(last) = table.series.data().nrows().checked_sub(1) else { return Ok(None) };
    let mut terms = Map::new();
    for (index, column) in table.series.columns().iter().enumerate() {
        if column.name.starts_with("energy_") || column.name.starts_with("work_") {
            let value = table.series.data()[(last, index)];
            terms.insert(column.name.clone(), quantity(&column.name, value, &column.unit)?);
        }
    }
    if terms.is_empty() {
        return Ok(None);
    }
    if let Some(residuals) = table.all("energy_residual") {
        let largest = residuals.iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
        terms.insert("largest_residual".into(), quantity("largest_residual", largest, "J")?);
    }
    Ok(Some(Value::Object(terms)))
}

pub(crate) fn final_values(table: &RunTable) -> Result<Value, ResultsError> {
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

/// Mean, extremes and peak-to-peak amplitude of every channel over the window.
pub(crate) fn window(table: &RunTable) -> Result<Value, ResultsError> {
    let rows = table.window.clone();
    let mut channels = Map::new();
    for column in &table.series.columns()[1..] {
        let values = table.windowed(&column.name).unwrap_or_default();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let entry = |value: f64| quantity(&column.name, value, &column.unit);
        channels.insert(
            column.name.clone(),
            json!({
                "mean": entry(mean)?,
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

/// Speeds of the ball set over that of the inner race, the outer one at rest, where balls roll without slip at
/// the middle of both contacts. With one contact angle it is (1 - γ cos α)/2, γ = r/R. With two the ball's own axis
/// decides: it spins on the inner race only, (1 - γ cos α_i)/(1 + cos(α_i - α_o)), on the outer one only,
/// (cos(α_i - α_o) - γ cos α_o)/(1 + cos(α_i - α_o)), or on both in between. In this order: outer control, inner control.
fn rolling_ratios(geometry: &BearingGeometry, [inner, outer]: [f64; 2]) -> [f64; 2] {
    let gamma = geometry.ball_radius / geometry.pitch_radius;
    let between = libm::cos(inner - outer);
    [1.0 - gamma * libm::cos(inner), between - gamma * libm::cos(outer)]
        .map(|ratio| ratio / (1.0 + between))
}

/// A section for each bearing under its name, or that of the only one itself.
fn each_bearing(
    session: &Session,
    of: impl Fn(usize, &Bearing) -> Result<Option<Value>, ResultsError>,
) -> Result<Option<Value>, ResultsError> {
    let mut named = Map::new();
    for (index, bearing) in session.simulation.system.assembly.bearings.iter().enumerate() {
        let section = of(index, bearing)?;
        match (&bearing.name, section) {
            (None, section) => return Ok(section),
            (Some(name), Some(section)) => {
                named.insert(name.clone(), section);
            }
            (Some(_), None) => {}
        }
    }
    Ok((!named.is_empty()).then_some(Value::Object(named)))
}

/// Mean speeds over the window beside those of pure rolling at the contact angles that the balls had.
fn kinematics(session: &Session, table: &RunTable) -> Result<Option<Value>, ResultsError> {
    each_bearing(session, |_, bearing| kinematics_of(bearing, table))
}

fn kinematics_of(bearing: &Bearing, table: &RunTable) -> Result<Option<Value>, ResultsError> {
    let (geometry, prefix) = (&bearing.geometry, bearing.prefix());
    let mean = |channel: &str| {
        let values = table.windowed(&format!("{prefix}{channel}"))?;
        Some(values.iter().sum::<f64>() / values.len() as f64)
    };
    let Some(inner) = mean("inner_speed").filter(|speed| *speed != 0.0) else { return Ok(None) };
    let outer = mean("outer_speed").unwrap_or(0.0);
    let nominal = geometry.contact_angle;
    let actual = ["mean_inner_contact_angle", "mean_outer_contact_angle"].map(mean);
    let (angles, named) = match actual {
        [Some(inner), Some(outer)] => (
            [inner.to_radians(), outer.to_radians()],
            "the mean contact angles over the window, balls by their load",
        ),
        _ => (
            [nominal; 2],
            "the nominal contact angle, since the channels `orbits` are not recorded",
        ),
    };
    let speeds_at = |angles: [f64; 2]| {
        rolling_ratios(geometry, angles).map(|ratio| ratio * inner + (1.0 - ratio) * outer)
    };
    let [outer_control, inner_control] = speeds_at(angles);
    let (low, high) = (outer_control.min(inner_control), outer_control.max(inner_control));
    let mut section = Map::new();
    let speed = |value: f64| quantity("speed", value, "rad/s");
    let frequency = |value: f64| quantity("frequency", value / TAU, "Hz");
    let angle = |value: f64| quantity("contact angle", value.to_degrees(), "deg");
    section.insert("inner_race_speed".into(), speed(inner)?);
    section.insert("inner_race_frequency".into(), frequency(inner)?);
    section.insert("rolling_at".into(), json!(named));
    section.insert("inner_contact_angle".into(), angle(angles[0])?);
    section.insert("outer_contact_angle".into(), angle(angles[1])?);
    section.insert("nominal_contact_angle".into(), angle(nominal)?);
    section.insert("rolling_cage_speed_outer_control".into(), speed(outer_control)?);
    section.insert("rolling_cage_frequency_outer_control".into(), frequency(outer_control)?);
    section.insert("rolling_cage_speed_inner_control".into(), speed(inner_control)?);
    section.insert("rolling_cage_frequency_inner_control".into(), frequency(inner_control)?);
    let at_nominal = speeds_at([nominal; 2])[0];
    section.insert("rolling_cage_speed_at_nominal_angle".into(), speed(at_nominal)?);
    let of = "against the nearer of outer and inner control; zero between them";
    section.insert("slip_is".into(), json!(of));
    let orbital: Option<Vec<f64>> =
        (1..=geometry.ball_count).map(|ball| mean(&format!("ball_{ball}_orbital_speed"))).collect();
    let balls = orbital.map(|speeds| speeds.iter().sum::<f64>() / speeds.len() as f64);
    for (name, measured) in [("ball_set", balls), ("cage", mean("cage_speed"))] {
        let Some(measured) = measured else { continue };
        section.insert(format!("{name}_speed"), speed(measured)?);
        section.insert(format!("{name}_frequency"), frequency(measured)?);
        let rolling = measured.clamp(low, high);
        if rolling != 0.0 {
            let slip = 1.0 - measured / rolling;
            section.insert(format!("{name}_slip"), quantity("slip", slip, "1")?);
        }
    }
    Ok(Some(Value::Object(section)))
}

/// Largest values over all steps, whatever rows were written.
fn extremes(session: &Session) -> Result<Value, ResultsError> {
    let sections =
        each_bearing(session, |index, bearing| extremes_of(session, index, bearing).map(Some))?;
    Ok(sections.unwrap_or_default())
}

fn extremes_of(session: &Session, index: usize, bearing: &Bearing) -> Result<Value, ResultsError> {
    let extremes = &session.simulation.extremes[index];
    let mut section = Map::new();
    for (name, extreme) in
        [("inner_race_farthest", extremes.farthest), ("races_farthest_apart", extremes.apart)]
    {
        let entry = json!({
            "distance": quantity(name, extreme.value, "m")?,
            "time": quantity("time", extreme.time, "s")?,
        });
        section.insert(name.into(), entry);
    }
    let contacts = [("inner_race", &bearing.inner_contact), ("outer_race", &bearing.outer_contact)];
    for ((name, contact), race) in contacts.into_iter().zip(&extremes.races) {
        let load = race.load.value;
        let at = |extreme: &Extreme| -> Result<[(&'static str, Value); 2], ResultsError> {
            Ok([("ball", json!(extreme.ball + 1)), ("time", quantity("time", extreme.time, "s")?)])
        };
        let mut largest = Map::new();
        largest.insert("load".into(), quantity("load", load, "N")?);
        let pressure = contact_ellipse(contact, load).peak_pressure;
        largest.insert("peak_pressure".into(), quantity("pressure", pressure, "Pa")?);
        largest.extend(at(&race.load)?.map(|(key, value)| (key.to_string(), value)));
        let mut edge = Map::new();
        let angle = |value: f64| quantity("angle", value.to_degrees(), "deg");
        edge.insert("ellipse_reaches".into(), angle(race.edge.value)?);
        edge.insert("contact_angle".into(), angle(race.edge_angle)?);
        edge.extend(at(&race.edge)?.map(|(key, value)| (key.to_string(), value)));
        section
            .insert(name.into(), json!({ "largest_load": largest, "farthest_from_bottom": edge }));
    }
    if let Some(law) =
        bearing.ball_contact.filter(|_| bearing.ball_meeting() == BallMeeting::Tested)
    {
        let (between, balls) = (&extremes.between_balls, bearing.geometry.ball_count);
        let pressure = peak_pressure(&law, bearing.geometry.ball_radius, between.value);
        let largest = json!({
            "load": quantity("load", between.value, "N")?,
            "peak_pressure": quantity("pressure", pressure, "Pa")?,
            "balls": [between.ball + 1, (between.ball + 1) % balls + 1],
            "time": quantity("time", between.time, "s")?,
        });
        section.insert("between_balls".into(), json!({ "largest_load": largest }));
    }
    section.insert("of".into(), json!("every accepted step, whatever rows were written"));
    Ok(Value::Object(section))
}

/// Peaks below this, m, say nothing: 1e-4 of the highest of all channels; what error control lets pass in
/// a single step.
fn spectral_floor(
    session: &Session,
    spectra: &[(&'static str, Spectrum)],
    report: &RunReport,
) -> f64 {
    let bins = spectra.iter().flat_map(|(_, spectrum)| spectrum.amplitude.iter().skip(1));
    let highest = bins.fold(0.0f64, |highest, bin| highest.max(*bin));
    let allowed = match (&session.simulation.control, report.stepping) {
        (Some(control), Some(Stepping::Accuracy(accuracy))) => {
            SHARE * accuracy * control.memory.displacement
        }
        _ => 0.0,
    };
    allowed.max(1e-4 * highest)
}

fn spectra_section(
    table: &RunTable,
    spectra: &[(&'static str, Spectrum)],
    floor: f64,
) -> Result<Value, ResultsError> {
    let mut channels = Map::new();
    let bin_width = spectra.first().map_or(0.0, |(_, spectrum)| spectrum.bin_width);
    for (name, spectrum) in spectra {
        let unit = table.unit(name);
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
        channels.insert((*name).into(), json!({ "peaks": found? }));
    }
    Ok(json!({
        "window": WINDOW,
        "leakage": LEAKAGE,
        "rows": table.window.len(),
        "bin_width": quantity("bin_width", bin_width, "Hz")?,
        "lowest_peak": quantity("lowest peak", floor, "m")?,
        "lowest_peak_of_highest": LOWEST,
        "channels": channels,
    }))
}
