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

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(count: usize, frequency: f64, amplitude: f64) -> Vec<f64> {
        (0..count).map(|i| 3.0 + amplitude * (TAU * frequency * i as f64 + 0.7).sin()).collect()
    }

    #[test]
    fn a_sine_in_a_bin_has_its_amplitude_and_frequency() {
        let spectrum = spectrum(&sine(1000, 0.05, 2.0), 1.0).unwrap();
        let peak = peaks(&spectrum, 3, 0.0)[0];
        assert_eq!((spectrum.amplitude.len(), peak.bin_frequency), (501, 0.05));
        assert!((peak.bin_amplitude - 2.0).abs() <= 1e-12, "{peak:?}");
        assert!((peak.frequency - 0.05).abs() <= 1e-12, "{peak:?}");
        // Hann: half the amplitude in both neighbours, nothing farther out, no mean left.
        for (bin, expected) in [(0, 0.0), (1, 0.0), (48, 0.0), (49, 1.0), (51, 1.0), (52, 0.0)] {
            let error = (spectrum.amplitude[bin] - expected).abs();
            assert!(error <= 1e-12, "bin {bin}: {error}");
        }
    }

    /// Between two bins of nothing a bin of rounding is no larger than it is.
    #[test]
    fn a_bin_between_zeros_is_no_peak_beyond_itself() {
        let mut amplitude = vec![0.0; 64];
        (amplitude[20], amplitude[21], amplitude[40]) = (1e-14, 3e-16, 2.0);
        let found = peaks(&Spectrum { bin_width: 1.0, amplitude }, 4, 0.0);
        assert_eq!((found.len(), found[0].bin_frequency), (1, 40.0), "{found:?}");
        assert!(found[0].amplitude <= 2.0 * 1.2, "{found:?}");
    }

    #[test]
    fn interpolation_finds_sines_between_bins() {
        // Bias of the parabola under this window, largest between two bins: with W(1/2) = 0.8488
        // and W(3/2) = 0.1698 of the window's transform its top lies at
        // 0.8488 (0.8488/0.1698)^(1/8) = 1.038.
        for count in [999, 1000, 1024] {
            for part in [0.1, 0.25, 0.5, 0.8] {
                let frequency = (40.0 + part) / count as f64;
                let spectrum = spectrum(&sine(count, frequency, 0.3), 1.0).unwrap();
                let peak = peaks(&spectrum, 1, 0.0)[0];
                let bins = (peak.frequency - frequency).abs() * count as f64;
                assert!(bins <= 0.02, "{count} {part}: {bins} bins");
                let error = (peak.amplitude / 0.3 - 1.0).abs();
                assert!(error <= 0.0385, "{count} {part}: {error}");
                assert!((peak.bin_frequency - frequency).abs() * count as f64 <= 0.500_001);
                // W(1/2) = 8/(3π), less what leaks from the negative frequency.
                assert!(peak.bin_amplitude >= 0.3 * 0.8487, "{peak:?}");
            }
        }
    }

    #[test]
    fn bins_are_those_of_the_definition() {
        // The discrete Fourier transform as a plain sum.
        let values: Vec<f64> = (0..37).map(|i| ((i * i * 7) % 23) as f64).collect();
        let weight = |i: usize| 0.5 - 0.5 * (TAU * i as f64 / 37.0).cos();
        let sum = |of: &dyn Fn(usize) -> f64| (0..37).map(of).sum::<f64>();
        let mean = sum(&|i| weight(i) * values[i]) / sum(&weight);
        let spectrum = spectrum(&values, 0.5).unwrap();
        assert!((spectrum.bin_width - 1.0 / 18.5).abs() <= 1e-15);
        for (k, amplitude) in spectrum.amplitude.iter().enumerate() {
            let (mut re, mut im, mut weights) = (0.0, 0.0, 0.0);
            for (i, value) in values.iter().enumerate() {
                let turn = TAU * i as f64 / 37.0;
                let weight = 0.5 - 0.5 * turn.cos();
                weights += weight;
                re += weight * (value - mean) * (turn * k as f64).cos();
                im += weight * (value - mean) * (turn * k as f64).sin();
            }
            let error = (amplitude - 2.0 * re.hypot(im) / weights).abs();
            assert!(error <= 1e-12, "bin {k}: {error}");
        }
    }

    #[test]
    fn too_few_rows_have_no_spectrum_and_a_constant_no_peak() {
        assert_eq!(spectrum(&[1.0; 7], 1.0), None);
        assert!(peaks(&spectrum(&[1.0; 64], 1.0).unwrap(), 5, 0.0).is_empty());
    }

    #[test]
    fn what_is_slower_than_the_window_is_a_peak() {
        // Once in the window with amplitude 3, and ten times with 0.5.
        let values = |slow: f64| -> Vec<f64> {
            let part = |i: usize| TAU * i as f64 / 512.0;
            (0..512).map(|i| 3.0 * (slow * part(i)).sin() + 0.5 * (10.0 * part(i)).sin()).collect()
        };
        let found = peaks(&spectrum(&values(1.0), 1.0).unwrap(), 8, 0.0);
        assert_eq!(found.len(), 2, "{found:?}");
        assert_eq!(found[0].bin_frequency, 1.0 / 512.0);
        assert!((found[0].bin_amplitude - 3.0).abs() <= 1e-12, "{found:?}");
        assert!((found[1].amplitude - 0.5).abs() <= 1e-3, "{found:?}");
        // Slower still: it is listed, and first.
        let found = peaks(&spectrum(&values(0.4), 1.0).unwrap(), 8, 0.0);
        assert_eq!(found[0].bin_frequency, 1.0 / 512.0, "{found:?}");
    }

    /// Five periods and a half leave no constant, which would be a peak where nothing moves.
    #[test]
    fn a_broken_number_of_periods_leaves_no_constant() {
        for periods in [5.5, 5.25, 17.06] {
            let sine = |i: usize| 1.2 + (TAU * periods * i as f64 / 800.0 + 0.4).sin();
            let values: Vec<f64> = (0..800).map(sine).collect();
            let found = spectrum(&values, 1e-4).unwrap();
            // What a Hann window leaves of a line d bins away: below 2/(π d³).
            for bin in 0..2 {
                let away: f64 = periods - bin as f64;
                let allowed = 2.0 / (std::f64::consts::PI * away.powi(3));
                assert!(
                    found.amplitude[bin] <= allowed,
                    "{periods}, {bin}: {:e}",
                    found.amplitude[bin]
                );
            }
        }
    }

    #[test]
    fn peaks_end_at_the_floor_and_at_a_thousandth_of_the_highest() {
        let part = |i: usize| TAU * i as f64 / 512.0;
        let sizes = [(20.0, 1.0), (60.0, 2e-3), (100.0, 5e-4), (140.0, 1e-12)];
        let value =
            |i: usize| sizes.iter().map(|(turns, size)| size * (turns * part(i)).sin()).sum();
        let values: Vec<f64> = (0..512).map(value).collect();
        let spectrum = spectrum(&values, 1.0).unwrap();
        let listed = |floor: f64| -> Vec<f64> {
            peaks(&spectrum, 8, floor).iter().map(|p| (512.0 * p.bin_frequency).round()).collect()
        };
        assert_eq!(listed(0.0), [20.0, 60.0]);
        assert_eq!(listed(1e-2), [20.0]);
        assert!(listed(2.0).is_empty());
    }
}
