//! Plots of the run of a solid: energies and probes over time, spectra of the probes.

use super::bearing::{POINTS, add_series, over_time, thin};
use crate::output::plots::{Axis, Curve, PlotError, Style, XyPlot, xy};
use crate::output::spectrum::{Spectrum, WINDOW, spectrum};
use crate::output::table::RunTable;
use crate::scene::build::solid::{NamedNodes, Support};

/// Ratio to the highest peak of all components below which a component is not drawn.
const LEAST: f64 = 1e-3;
/// Ratio to a component's highest amplitude below which bins are not drawn.
const FLOOR: f64 = 1e-6;

/// File names and SVG text of the plots over time.
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
        ("energy_residual", "residual"),
        ("energy_viscous", "stored or dissipated in Maxwell elements"),
        ("energy_maxwell", "stored in Maxwell springs"),
        ("energy_dissipated", "dissipated in Maxwell dashpots"),
        ("energy_finite_strain", "finite-strain contribution"),
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

/// Plots of the support forces over time and, for probes with the name of a support, over the displacement that this
/// support prescribes.
///
/// # Errors
/// A value too large to draw.
pub fn force_plots(
    title: &str,
    table: &RunTable,
    probes: &[NamedNodes],
    supports: &[Support],
) -> Result<Vec<(String, String)>, PlotError> {
    let (mut plots, mut over, mut loops) = (Vec::new(), Vec::new(), Vec::new());
    for support in supports {
        for axis in support.axes().into_iter().map(|axis| ["x", "y", "z"][axis]) {
            let (name, column) = (&support.name, format!("reaction_{}_{axis}", support.name));
            let label = format!("{name} {axis}");
            over.extend(over_time(table, &[(&column, &label)], 1.0));
            if !probes.iter().any(|probe| probe.name == *name) {
                continue;
            }
            let Some(moved) = table.all(&format!("{name}_{axis}")) else { continue };
            let forces = table.all(&column).unwrap_or_default();
            if moved.iter().any(|x| *x != moved[0]) {
                let points = moved.iter().zip(forces).map(|(x, force)| [1e3 * x, force]);
                loops.push(Curve::new(label, thin(points.collect(), POINTS)));
            }
        }
    }
    let heading = format!("{title}: forces of the supports");
    add_series(&mut plots, "reactions.svg".into(), heading, "force", "N", over)?;
    if !loops.is_empty() {
        let plot = XyPlot {
            title: format!("{title}: force over displacement"),
            x: Axis::linear("displacement", "mm"),
            y: Axis::linear("force of the support", "N"),
            style: Style::Lines,
            curves: loops,
        };
        plots.push(("loops.svg".into(), xy(&plot)?));
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
            // A component that never moves has no spectrum.
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

/// Plot of the spectra of [`probe_spectra`]; `None` if there is nothing to draw.
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
