//! Runs of the scene, their lines, and pictures of spectra.

use bearing_dynamics::output::defect_lines::{LineReading, read_line};
use bearing_dynamics::output::plots::{Axis, Curve, Mark, Style, XyPlot, xy_marked};
use bearing_dynamics::output::spectrum::Spectrum;
use bearing_dynamics::output::table::RunTable;

use crate::cage_bearing::spall_sensors;
use crate::case::CaseError;
use crate::context::CaseContext;
use crate::motion::{done, request};

/// A run of the scene as a user has it: its rows and spectra over the window.
pub struct Taken {
    pub table: RunTable,
    pub spectra: Vec<(String, Spectrum)>,
    pub interval: f64,
}

pub fn take(keys: &[(&str, &str)]) -> Result<Taken, CaseError> {
    let scene = spall_sensors(keys)?;
    let run = scene.run().ok_or_else(|| CaseError::message("no end"))?;
    let (window_start, interval) = (run.window_start, run.output_interval);
    let session = done(scene.assembly()?, &request(&scene)?)?;
    let table = RunTable::new(&session, window_start)?;
    Ok(Taken { spectra: table.spectra(), table, interval })
}

impl Taken {
    pub fn spectrum(&self, channel: &str) -> Result<&Spectrum, CaseError> {
        let found = self.spectra.iter().find(|(name, _)| name == channel);
        found.map(|(_, of)| of).ok_or_else(|| CaseError::message(format!("no spectrum {channel}")))
    }

    pub fn accelerations(&self, sensor: &str) -> Result<&Spectrum, CaseError> {
        self.spectrum(&format!("{sensor}_acceleration"))
    }
}

pub fn reading(of: &Spectrum, frequency: f64) -> Result<LineReading, CaseError> {
    read_line(of, frequency).ok_or_else(|| CaseError::message("a line beyond the spectrum"))
}

/// Amplitudes of lines 1, 2… of a frequency.
pub fn amplitudes(of: &Spectrum, frequency: f64, count: u32) -> Result<Vec<f64>, CaseError> {
    (1..=count).map(|n| Ok(reading(of, f64::from(n) * frequency)?.amplitude)).collect()
}

/// The same over the noise around.
pub fn over_noise(of: &Spectrum, frequency: f64, count: u32) -> Result<Vec<f64>, CaseError> {
    let ratio = |n| {
        let LineReading { amplitude, noise, .. } = reading(of, f64::from(n) * frequency)?;
        Ok(amplitude / noise.unwrap_or(f64::NAN))
    };
    (1..=count).map(ratio).collect()
}

/// NaN if there is one.
pub fn smallest(values: &[f64]) -> f64 {
    values.iter().fold(f64::INFINITY, |a, b| if a.is_nan() || *b >= a { a } else { *b })
}

pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

pub fn ratios(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a / b).collect()
}

pub fn figures(
    context: &mut CaseContext,
    main: &Taken,
    telemeters: &Taken,
    bpfo: f64,
) -> Result<(), CaseError> {
    let curve = |name: &str, of: &Spectrum, scale: f64| {
        let bins = of
            .amplitude
            .iter()
            .enumerate()
            .skip(1)
            .map(|(k, a)| [k as f64 * of.bin_width, scale * a]);
        Curve::new(name, bins.take_while(|[f, _]| *f < 600.0).collect())
    };
    let mut draw = |name: &str, title: &str, y: (&str, &str), curves: Vec<Curve>, caption: &str| {
        let line = |n: u32| Mark { at: f64::from(n) * bpfo, label: format!("{n} BPFO") };
        let marks: Vec<Mark> = (1..=4).map(line).collect();
        let plot = XyPlot {
            title: title.into(),
            x: Axis::linear("frequency", "Hz"),
            y: Axis::log(y.0, y.1),
            style: Style::Lines,
            curves,
        };
        context.figure(name, xy_marked(&plot, &marks)?, caption);
        Ok::<(), CaseError>(())
    };
    for (name, sensors, caption) in [
        ("at_0_90", ["at_90", "at_0"], "As Fig. 5.32."),
        ("at_45", ["at_45", "at_minus_45"], "As Fig. 5.33."),
    ] {
        let mut curves = Vec::new();
        for sensor in sensors {
            curves.push(curve(sensor, main.accelerations(sensor)?, 1.0));
        }
        draw(name, "Accelerometers on the outer race", ("acceleration", "m/s²"), curves, caption)?;
    }
    let curves = vec![
        curve("offset along Z", telemeters.spectrum("telemeter_z_reflection")?, 1.0),
        curve("offset along Y", telemeters.spectrum("telemeter_y_reflection")?, 1.0),
    ];
    draw("telemeter", "Telemeter", ("reflection", "1"), curves, "As Fig. 5.30.")?;
    let curves = vec![
        curve("z", main.spectrum("outer_z")?, 1e9),
        curve("y", main.spectrum("outer_y")?, 1e9),
    ];
    draw("outer_race", "Outer race", ("displacement", "nm"), curves, "Spectrum of Fig. 5.34.")
}
