//! Amplitude spectra of channels.
//!
//! The mean weighted by a Hann window is removed, the window is applied, and amplitudes are scaled so that a
//! sine of amplitude 1 in the middle of a bin appears as 1. The window's main lobe is four bins wide
//! and its side lobes start at −31 dB. A sine between two bins appears up to 15 % (1.42 dB) low,
//! which the interpolated [peaks] correct.
//!
//! The transform uses the same code on all processors, but the sines of the system, so that spectra agree between
//! systems to rounding only.

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Name of the window, for axes and summaries.
pub const WINDOW: &str = "Hann";
/// Width of the window's main lobe, bins.
pub const MAIN_LOBE: usize = 4;
/// Highest side lobe of the window, dB.
pub const SIDE_LOBES: i32 = -31;
pub const LEAKAGE: &str = "Hann-weighted mean removed, Hann window: main lobe 4 bins wide, side lobes from -31 dB \
                           falling 18 dB an octave, a sine between two bins up to 15 % low in its \
                           bin and up to 4 % high as an interpolated peak";

/// Amplitudes of the bins from 0 to half the sampling rate.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Bin width, Hz.
    pub bin_width: f64,
    /// Amplitudes in the unit of the channel.
    pub amplitude: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Frequency at the maximum of a parabola through the logarithms of three bins, Hz.
    pub frequency: f64,
    pub amplitude: f64,
    /// Frequency of the highest bin, Hz.
    pub bin_frequency: f64,
    pub bin_amplitude: f64,
}

/// Smallest number of rows of a spectrum: it has a bin outside the main lobe of the mean.
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
    // In its periodic form the window's transform has three lines only.
    let weight = |i: usize| 0.5 - 0.5 * libm::cos(TAU * i as f64 / count as f64);
    let weighed: f64 = values.iter().enumerate().map(|(i, value)| weight(i) * value).sum();
    let weights: f64 = (0..count).map(weight).sum();
    // The plain mean over a fractional number of periods would leave a constant, which appears in bin 1.
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

/// Number of bins of a spectrum whose envelope has a spectrum: of a single sine the envelope is constant.
const FEWEST_BAND_BINS: usize = 2;

/// Envelope of values `interval` seconds apart in a band (Hz): magnitude of the analytic signal.
///
/// The discrete Fourier transform of all values is multiplied by 1 from the first to the second frequency of the band
/// (both included) and by 0 elsewhere, then transformed back in phase and in quadrature. The values continue periodically
/// beyond both ends, so that about one reciprocal bandwidth at each end is not meaningful. The mean and half the sampling
/// rate are never in the band.
///
/// `None` for fewer than [`FEWEST_ROWS`] values, or fewer than two bins in the band.
///
/// ```
/// use bearing_dynamics::output::spectrum::envelope;
/// use std::f64::consts::TAU;
/// // A carrier of 100 Hz whose amplitude varies by half at 5 Hz.
/// let amplitude = |t: f64| 2.0 + (TAU * 5.0 * t).cos();
/// let time = |i: usize| i as f64 * 1e-3;
/// let values: Vec<f64> = (0..1000).map(|i| amplitude(time(i)) * (TAU * 100.0 * time(i)).sin()).collect();
/// let found = envelope(&values, 1e-3, [80.0, 120.0]).unwrap();
/// assert!((0..1000).all(|i| (found[i] - amplitude(time(i))).abs() <= 1e-12));
/// ```
pub fn envelope(values: &[f64], interval: f64, [low, high]: [f64; 2]) -> Option<Vec<f64>> {
    let count = values.len();
    if count < FEWEST_ROWS {
        return None;
    }
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, back) = (planner.plan_fft_forward(count), planner.plan_fft_inverse(count));
    let mut input = values.to_vec();
    let mut lines = forward.make_output_vec();
    forward.process(&mut input, &mut lines).ok()?;
    // Frequencies within rounding of a bin include it.
    let bin = |frequency: f64| frequency * count as f64 * interval;
    let kept = ((bin(low) - 1e-6).ceil().max(1.0) as usize)..=((bin(high) + 1e-6).floor() as usize);
    let is_kept = |k: usize| kept.contains(&k) && 2 * k < count;
    if (0..lines.len()).filter(|k| is_kept(*k)).count() < FEWEST_BAND_BINS {
        return None;
    }
    // A quarter period later: times −i.
    let quadrature = |line: &Complex<f64>| Complex::new(line.im, -line.re);
    let turned = lines.iter().map(quadrature).collect::<Vec<_>>();
    let [in_phase, in_quadrature] = [lines, turned].map(|mut lines| {
        let none = |(k, line): (usize, &mut Complex<f64>)| {
            if !is_kept(k) {
                *line = Complex::new(0.0, 0.0);
            }
        };
        lines.iter_mut().enumerate().for_each(none);
        let mut part = back.make_output_vec();
        back.process(&mut lines, &mut part).ok().map(|()| part)
    });
    let parts = in_phase?.into_iter().zip(in_quadrature?);
    Some(parts.map(|(x, y)| libm::hypot(x, y) / count as f64).collect())
}

/// Amplitude spectrum of the [`envelope`] in a band (Hz).
pub fn envelope_spectrum(values: &[f64], interval: f64, band: [f64; 2]) -> Option<Spectrum> {
    spectrum(&envelope(values, interval, band)?, interval)
}

/// Peaks below this fraction of the highest peak beyond the first bin are not listed: side lobes of the window reach
/// this level.
pub const LOWEST: f64 = 1e-3;

/// The `count` highest peaks, highest first: bins higher than both neighbours, not below `floor` (in the
/// unit of the channel) nor below [`LOWEST`] of the highest.
///
/// A component slower than two periods per window is listed as a peak in bin 1. Its frequency is not known more accurately.
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
    // The peak in bin 1 is excluded, so that a drift does not hide other peaks.
    let highest = found.iter().map(|peak| peak.amplitude).fold(0.0, f64::max);
    found.extend(slow);
    found.retain(|peak| peak.amplitude > floor.max(LOWEST * highest));
    found.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    found.truncate(count);
    found
}

fn parabola(spectrum: &Spectrum, k: usize) -> Peak {
    let bins = &spectrum.amplitude;
    // The neighbours of a sine's highest bin have at least a fifth of its amplitude. The lower limit prevents an unbounded
    // result for neighbours that are rounding, or zero.
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
