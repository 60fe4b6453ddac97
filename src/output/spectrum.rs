//! Amplitude spectra of channels.
//!
//! The mean under a Hann window is taken out, the window laid over the rows, and amplitudes are scaled so that a
//! sine of amplitude 1 in the middle of a bin shows as 1. The window's main lobe is four bins wide
//! and its side lobes start at −31 dB; a sine between two bins shows up to 15 % (1.42 dB) low,
//! which the interpolated [peaks] correct.
//!
//! The transform has one code for all processors; its sines are the system's, so that spectra agree between
//! systems to rounding only.

use realfft::RealFftPlanner;
use std::f64::consts::TAU;

/// What every axis and summary says about the window.
pub const WINDOW: &str = "Hann";
pub const LEAKAGE: &str = "mean removed, Hann window: main lobe 4 bins wide, side lobes from -31 dB \
                           falling 18 dB an octave, a sine between two bins up to 15 % low in its \
                           bin and up to 4 % high as an interpolated peak";

/// Amplitude of the bins from 0 to half the sampling rate.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Hz.
    pub bin_width: f64,
    /// In the unit of the channel.
    pub amplitude: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Of the parabola through the logarithms of three bins, Hz.
    pub frequency: f64,
    pub amplitude: f64,
    /// Of the highest bin itself, Hz.
    pub bin_frequency: f64,
    pub bin_amplitude: f64,
}

/// Fewest rows that give a spectrum with a bin beside the main lobe of the mean.
pub const FEWEST_ROWS: usize = 8;

/// Spectrum of values `interval` seconds apart; `None` for fewer than [`FEWEST_ROWS`].
///
/// ```
/// use bearing_dynamics::output::spectrum::{peaks, spectrum};
/// let sine = |i: usize| 0.5 * (std::f64::consts::TAU * 50.0 * 1e-3 * i as f64).sin();
/// let values: Vec<f64> = (0..1000).map(sine).collect();
/// let peak = peaks(&spectrum(&values, 1e-3).unwrap(), 1, 0.0)[0];
/// assert_eq!(peak.bin_frequency, 50.0);
/// assert!((peak.amplitude - 0.5).abs() <= 1e-3);
/// ```
pub fn spectrum(values: &[f64], interval: f64) -> Option<Spectrum> {
    let count = values.len();
    if count < FEWEST_ROWS {
        return None;
    }
    // Periodic form: its transform has three lines and nothing else.
    let weight = |i: usize| 0.5 - 0.5 * libm::cos(TAU * i as f64 / count as f64);
    let weighed: f64 = values.iter().enumerate().map(|(i, value)| weight(i) * value).sum();
    let weights: f64 = (0..count).map(weight).sum();
    // Under the window: the plain mean of a broken number of periods leaves a constant, which would stand in bin 1.
    let mean = weighed / weights;
    let mut windowed: Vec<f64> =
        values.iter().enumerate().map(|(i, value)| weight(i) * (value - mean)).collect();
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(count);
    let mut lines = transform.make_output_vec();
    transform
        .process(&mut windowed, &mut lines)
        .expect("both vectors have the lengths that the planner asked for");
    // The weights add up to count/2, and a sine has half its amplitude at each sign of frequency.
    let scale = 4.0 / count as f64;
    Some(Spectrum {
        bin_width: 1.0 / (count as f64 * interval),
        amplitude: lines.iter().map(|line| scale * libm::hypot(line.re, line.im)).collect(),
    })
}

/// Peaks lower than this part of the highest beyond the first bin are not listed: so far down a window's
/// side lobes reach.
pub const LOWEST: f64 = 1e-3;

/// The `count` highest peaks, highest first: bins higher than both neighbours, not below `floor` (in the
/// unit of the channel) nor below [`LOWEST`] of the highest.
///
/// The mean has been taken out, so that what is left in its main lobe is slower than two periods of the
/// window: it is a peak in bin 1, whose frequency is no better known than that.
pub fn peaks(spectrum: &Spectrum, count: usize, floor: f64) -> Vec<Peak> {
    let bins = &spectrum.amplitude;
    if bins.len() < 3 {
        return Vec::new();
    }
    let slow = (bins[1] > bins[2]).then_some(Peak {
        frequency: spectrum.bin_width,
        amplitude: bins[1],
        bin_frequency: spectrum.bin_width,
        bin_amplitude: bins[1],
    });
    let mut found: Vec<Peak> = (2..bins.len() - 1)
        .filter(|&k| bins[k] > bins[k - 1] && bins[k] >= bins[k + 1])
        .map(|k| parabola(spectrum, k))
        .collect();
    // A drift hides nothing.
    let highest = found.iter().map(|peak| peak.amplitude).fold(0.0, f64::max);
    found.extend(slow);
    found.retain(|peak| peak.amplitude > floor.max(LOWEST * highest));
    found.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    found.truncate(count);
    found
}

fn parabola(spectrum: &Spectrum, k: usize) -> Peak {
    let bins = &spectrum.amplitude;
    // Neighbours of a sine's highest bin have a fifth of it at least: those of rounding, zero perhaps, would send the
    // parabola to infinity.
    let log = |k: usize, least: f64| libm::log(bins[k].max(least));
    let least = f64::max(0.1 * bins[k], f64::MIN_POSITIVE);
    let [a, b, c] = [k - 1, k, k + 1].map(|k| log(k, least));
    let bend = a - 2.0 * b + c;
    let shift = if bend < 0.0 { 0.5 * (a - c) / bend } else { 0.0 };
    Peak {
        frequency: (k as f64 + shift) * spectrum.bin_width,
        amplitude: libm::exp(b - 0.25 * (a - c) * shift),
        bin_frequency: k as f64 * spectrum.bin_width,
        bin_amplitude: bins[k],
    }
}
