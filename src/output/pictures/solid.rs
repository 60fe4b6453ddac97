//! Plots of a solid's run: energies and probes over time, spectra of the probes.

use super::bearing::{POINTS, add_series, over_time, thin};
use crate::output::plots::{Axis, Curve, PlotError, Style, XyPlot, xy};
use crate::output::spectrum::{Spectrum, WINDOW, spectrum};
use crate::output::table::RunTable;
use crate::scene::solid_problem::NamedNodes;

/// Part of the highest peak of all that the peak of a component must reach to be drawn.
const LEAST: f64 = 1e-3;
/// Part of a component's highest amplitude below which nothing is drawn.
const FLOOR: f64 = 1e-6;

/// Names and contents of the plots over time.
///
/// # Errors
/// A value too large to draw.
pub fn series_plots(
    title: &str,
    table: &RunTable,
    probes: &[NamedNodes],
) -> Result<Vec<(String, String)>, PlotError> {
    let energies = [
        ("energy_strain", "strain"),
        ("energy_kinetic", "kinetic"),
        ("work_external", "work of loads and supports"),
        ("work_damping", "work of damping"),
        ("energy_residual", "unaccounted for"),
    ];
    let mut plots = Vec::new();
    let curves = over_time(table, &energies, 1.0);
    let heading = format!("{title}: energies");
    add_series(&mut plots, "energies.svg".into(), heading, "energy", "J", curves)?;
    for NamedNodes { name, .. } in probes {
        let columns = ["x", "y", "z"].map(|axis| (format!("{name}_{axis}"), axis));
        let columns = columns.each_ref().map(|(column, axis)| (column.as_str(), *axis));
        let curves = over_time(table, &columns, 1e6);
        let (file, heading) = (format!("probe_{name}.svg"), format!("{title}: {name}"));
        add_series(&mut plots, file, heading, "displacement", "um", curves)?;
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
