//! Spectra of sines that are known.

use bearing_dynamics::output::spectrum::*;
use std::f64::consts::TAU;

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
    let value = |i: usize| sizes.iter().map(|(turns, size)| size * (turns * part(i)).sin()).sum();
    let values: Vec<f64> = (0..512).map(value).collect();
    let spectrum = spectrum(&values, 1.0).unwrap();
    let listed = |floor: f64| -> Vec<f64> {
        peaks(&spectrum, 8, floor).iter().map(|p| (512.0 * p.bin_frequency).round()).collect()
    };
    assert_eq!(listed(0.0), [20.0, 60.0]);
    assert_eq!(listed(1e-2), [20.0]);
    assert!(listed(2.0).is_empty());
}
