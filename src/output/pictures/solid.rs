//! Plots of a solid's run: energies and probes over time, spectra of the probes.

use super::bearing::thin;
use crate::output::plots::{Axis, Curve, PlotError, Style, XyPlot, xy};
use crate::output::series::Series;
use crate::output::spectrum::{Spectrum, WINDOW, spectrum};
use crate::output::table::RunTable;
use crate::scene::solid_problem::NamedNodes;

/// Points that are drawn of a curve.
const POINTS: usize = 1500;
/// Part of the highest peak of all that the peak of a component must reach to be drawn.
const LEAST: f64 = 1e-3;
/// Part of a component's highest amplitude below which nothing is drawn.
const FLOOR: f64 = 1e-6;

/// `[time, scale · value]` of a column.
fn over_time(series: &Series, column: &str, name: &str, scale: f64) -> Option<Curve> {
    let (times, values) = (series.column("time")?, series.column(column)?);
    let points: Vec<[f64; 2]> =
        times.iter().zip(values).map(|(t, value)| [*t, drawn(scale * value)]).collect();
    (!points.is_empty()).then(|| Curve::new(name, thin(points, POINTS)))
}

/// What is left of a motion that has died out is drawn as nothing.
fn drawn(value: f64) -> f64 {
    if value.abs() < 1e-150 { 0.0 } else { value }
}

/// Names and contents of the plots over time.
///
/// # Errors
/// A value too large to draw.
pub fn series_plots(
    title: &str,
    series: &Series,
    probes: &[NamedNodes],
) -> Result<Vec<(String, String)>, PlotError> {
    let time = || Axis::linear("time", "s");
    let energies = [
        ("energy_strain", "strain"),
        ("energy_kinetic", "kinetic"),
        ("work_external", "work of loads and supports"),
        ("work_damping", "work of damping"),
        ("energy_residual", "unaccounted for"),
    ];
    let curves = energies.iter().filter_map(|(c, name)| over_time(series, c, name, 1.0));
    let mut plots = vec![(
        "energies.svg".to_string(),
        xy(&XyPlot {
            title: format!("{title}: energies"),
            x: time(),
            y: Axis::linear("energy", "J"),
            style: Style::Lines,
            curves: curves.collect(),
        })?,
    )];
    for probe in probes {
        let curves = ["x", "y", "z"]
            .iter()
            .filter_map(|axis| over_time(series, &format!("{}_{axis}", probe.name), axis, 1e6));
        let plot = XyPlot {
            title: format!("{title}: {}", probe.name),
            x: time(),
            y: Axis::linear("displacement", "um"),
            style: Style::Lines,
            curves: curves.collect(),
        };
        plots.push((format!("probe_{}.svg", probe.name), xy(&plot)?));
    }
    Ok(plots)
}

/// Spectra of the probes' displacements over the window.
pub fn probe_spectra(table: &RunTable, probes: &[NamedNodes]) -> Vec<(String, Spectrum)> {
    let mut found = Vec::new();
    for probe in probes {
        for axis in ["x", "y", "z"] {
            let column = format!("{}_{axis}", probe.name);
            let Some(values) = table.windowed(&column) else { continue };
            // A component that never moves has none.
            if values.iter().all(|value| *value == values[0]) {
                continue;
            }
            if let Some(spectrum) = spectrum(&values, table.interval) {
                found.push((column, spectrum));
            }
        }
    }
    found
}

/// The plot of such spectra; nothing for none.
///
/// # Errors
/// A value too large to draw.
pub fn spectrum_plot(
    title: &str,
    spectra: &[(String, Spectrum)],
) -> Result<Option<(String, String)>, PlotError> {
    let peak = |spectrum: &Spectrum| spectrum.amplitude.iter().copied().fold(0.0, f64::max);
    let highest = spectra.iter().map(|(_, spectrum)| peak(spectrum)).fold(0.0, f64::max);
    let curves: Vec<Curve> = spectra
        .iter()
        .filter(|(_, spectrum)| peak(spectrum) > LEAST * highest)
        .map(|(column, spectrum)| {
            let highest = peak(spectrum);
            let bins = spectrum.amplitude.iter().enumerate().skip(1);
            let points = bins
                .filter(|(_, amplitude)| **amplitude > FLOOR * highest)
                .map(|(bin, amplitude)| [spectrum.bin_width * bin as f64, 1e6 * amplitude])
                .collect();
            Curve::new(column.as_str(), thin(points, 4 * POINTS))
        })
        .filter(|curve| !curve.points.is_empty())
        .collect();
    if curves.is_empty() {
        return Ok(None);
    }
    let plot = XyPlot {
        title: format!("{title}: spectra of the probes"),
        x: Axis::log(format!("frequency ({WINDOW} window)"), "Hz"),
        y: Axis::log("amplitude", "um"),
        style: Style::Lines,
        curves,
    };
    Ok(Some(("spectrum.svg".to_string(), xy(&plot)?)))
}
