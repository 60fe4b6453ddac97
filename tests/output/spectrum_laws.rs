//! Spectra of sines that are known.

use crate::common::table_5_3;
use bearing_dynamics::members::sensor::Acquisition;
use bearing_dynamics::output::acquisition::{acquire, low_pass};
use bearing_dynamics::output::defect_lines::{lines, read_line};
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

/// |a e^{iω₁t} + b e^{iω₂t}| = √(a² + b² + 2ab cos (ω₁ − ω₂)t); what is outside the band does not count.
#[test]
fn an_envelope_is_that_of_the_lines_in_its_band() {
    let turns = |i: usize, count: f64| TAU * count * i as f64 / 600.0;
    let value = |i: usize| {
        2.0 * turns(i, 90.0).sin() + 0.8 * turns(i, 97.0).cos() + 5.0 + 3.0 * turns(i, 20.0).sin()
    };
    let values: Vec<f64> = (0..600).map(value).collect();
    let found = envelope(&values, 1e-3, [80.0 / 0.6, 110.0 / 0.6]).unwrap();
    for (i, found) in found.iter().enumerate() {
        // sin x = cos(x − π/2).
        let beat = (turns(i, 7.0) + TAU / 4.0).cos();
        let expected = (4.0f64 + 0.64 + 3.2 * beat).sqrt();
        assert!((found - expected).abs() <= 1e-12, "{i}: {found} {expected}");
    }
    // The ends of the band are in it.
    let narrow = envelope(&values, 1e-3, [90.0 / 0.6, 97.0 / 0.6]).unwrap();
    assert!(narrow.iter().zip(&found).all(|(a, b)| (a - b).abs() <= 1e-12));
    assert_eq!(envelope(&values, 1e-3, [150.1, 150.2]), None, "no bin");
    assert_eq!(envelope(&values[..7], 1e-3, [100.0, 400.0]), None, "too few rows");
}

/// The mean and half the sampling rate have no quadrature.
#[test]
fn an_envelope_has_no_mean_and_no_alternation() {
    let alternating = |i: usize| if i.is_multiple_of(2) { 4.0 } else { -2.0 };
    let values: Vec<f64> = (0..64).map(alternating).collect();
    let found = envelope(&values, 1.0, [0.0, 0.5]).unwrap();
    assert!(found.iter().all(|of| of.abs() <= 1e-14), "{found:?}");
}

/// A (1 + m cos Ωt) sin ωt has the envelope spectrum A m at Ω, and lines beside the carrier in its own.
#[test]
fn an_envelope_spectrum_shows_the_modulation() {
    let value = |i: usize| {
        let t = i as f64 * 1e-4;
        1.5 * (1.0 + 0.4 * (TAU * 25.0 * t).cos()) * (TAU * 1000.0 * t).sin()
    };
    let values: Vec<f64> = (0..4000).map(value).collect();
    let found = envelope_spectrum(&values, 1e-4, [900.0, 1100.0]).unwrap();
    let peak = peaks(&found, 2, 1e-9);
    assert_eq!((peak.len(), peak[0].bin_frequency), (1, 25.0), "{peak:?}");
    assert!((peak[0].bin_amplitude - 0.6).abs() <= 1e-12, "{peak:?}");
    let plain = spectrum(&values, 1e-4).unwrap();
    assert!(read_line(&plain, 25.0).unwrap().amplitude <= 1e-12);
}

/// A resonance of 3 kHz that is hit at each pass of a ball: the envelope has the lines of BPFO, the signal has none.
#[test]
fn a_train_of_pulses_has_its_lines_in_the_envelope() {
    let (passes, interval) = (46.3, 5e-5);
    // Uniform noise of amplitude 0.05.
    let mut seed = 1u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        0.1 * ((seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5)
    };
    let mut value = |i: usize| {
        let since = (i as f64 * interval).rem_euclid(1.0 / passes);
        (-since / 1e-3).exp() * (TAU * 3000.0 * since).sin() + noise()
    };
    let values: Vec<f64> = (0..20_000).map(&mut value).collect();
    let envelope = envelope_spectrum(&values, interval, [2000.0, 4000.0]).unwrap();
    let plain = spectrum(&values, interval).unwrap();
    for order in 1..=5 {
        let line = f64::from(order) * passes;
        let found = read_line(&envelope, line).unwrap();
        let (noise, nearest) = (found.noise.unwrap(), (line / envelope.bin_width).round() as usize);
        assert!(found.amplitude >= 20.0 * noise, "{order}: {found:?}");
        assert!(found.offset.abs() <= 1 && found.bin.abs_diff(nearest) <= 1, "{found:?}");
        let of_signal = read_line(&plain, line).unwrap();
        // √(1 + (2πkfτ)²)/(ωτ) of the envelope, a twentieth and more; the band lowers the envelope.
        let of_envelope = (1.0 + (TAU * line * 1e-3).powi(2)).sqrt() / (TAU * 3.0);
        let part = of_signal.amplitude / found.amplitude;
        assert!(part <= 1.3 * of_envelope, "{order}: {part} {of_envelope}");
        // A train of exp(−t/τ): 2fτ/√(1 + (2πkfτ)²). The band takes the onset, up to a tenth.
        let whole = 2.0 * passes * 1e-3 / (1.0 + (TAU * line * 1e-3).powi(2)).sqrt();
        let part = found.amplitude / whole;
        assert!((0.8..=1.0).contains(&part), "{order}: {part}");
    }
    // Between the lines there is none.
    let between = read_line(&envelope, 1.5 * passes).unwrap();
    assert!(between.amplitude <= 5.0 * between.noise.unwrap(), "{between:?}");
}

#[test]
fn a_line_is_read_from_the_highest_of_three_bins() {
    let mut amplitude = vec![1.0; 200];
    (amplitude[101], amplitude[102], amplitude[103]) = (7.0, 9.0, 2.0);
    amplitude[97..100].fill(40.0);
    let spectrum = Spectrum { bin_width: 0.5, amplitude };
    let read = |frequency: f64| read_line(&spectrum, frequency).unwrap();
    let found = read(50.6);
    assert_eq!((found.bin, found.offset, found.amplitude), (102, 1, 9.0));
    // Neighbours within three bins of the highest are no noise; one high line farther off changes no median.
    assert_eq!(found.noise, Some(1.0));
    let found = read(51.4);
    assert_eq!((found.bin, found.offset), (102, -1));
    assert_eq!(read(60.0).offset, 0);
    // The main lobe of the mean, the last bin, and beyond.
    for frequency in [0.0, 1.0, 99.6, 1e9, f64::NAN] {
        assert_eq!(read_line(&spectrum, frequency), None, "{frequency}");
    }
    let short = Spectrum { bin_width: 1.0, amplitude: vec![1.0; 16] };
    assert_eq!(read_line(&short, 8.0).unwrap().noise, None);
}

/// Rotating the whole bearing shifts what is counted in the scene's axes, and nothing else.
#[test]
fn defect_lines_are_kinematic() {
    let geometry = table_5_3();
    let angle = 35f64.to_radians();
    let frequency = |speeds: [f64; 2], label: &str| {
        let all = lines("", &geometry, speeds, angle);
        all.iter().find(|line| line.label() == label).map(|line| line.frequency)
    };
    let speeds = [TAU * 10.0, 0.0];
    // γ = 5.953/30 cos 35° = 0.162547.
    let gamma = 5.953 / 30.0 * angle.cos();
    for (label, expected) in [
        ("FTF", 5.0 * (1.0 - gamma)),
        ("shaft", 10.0),
        ("BPFO", 55.0 * (1.0 - gamma)),
        ("3 BPFI", 165.0 * (1.0 + gamma)),
        ("2 BSF", 10.0 * 30.0 / 5.953 * (1.0 - gamma * gamma)),
    ] {
        let found = frequency(speeds, label).unwrap();
        assert!((found / expected - 1.0).abs() <= 1e-12, "{label}: {found} {expected}");
    }
    assert_eq!(frequency(speeds, "outer race"), None, "it stands still");
    let turned = [TAU * 14.0, TAU * 4.0];
    for (label, more) in [("FTF", 4.0), ("shaft", 4.0), ("BPFO", 0.0), ("BPFI", 0.0), ("BSF", 0.0)]
    {
        let of = |speeds| frequency(speeds, label).unwrap();
        assert!((of(turned) - of(speeds) - more).abs() <= 1e-12, "{label}");
    }
    assert_eq!(frequency(turned, "outer race"), Some(4.0));
    let named = lines("left_", &geometry, speeds, angle);
    assert!(named.iter().all(|line| line.name.starts_with("left ")), "{named:?}");
}

/// |H| of a Butterworth filter of order 2 at tan-warped frequencies: 1/√(1 + w⁴).
#[test]
fn a_low_pass_has_the_gain_of_its_order() {
    let (interval, cut_off) = (1e-4, 800.0);
    for frequency in [100.0, 800.0, 3000.0] {
        let values: Vec<f64> =
            (0..10_000).map(|i| 1.0 + (TAU * frequency * i as f64 * interval).sin()).collect();
        let filtered = low_pass(&values, interval, cut_off);
        // After the transient.
        let found = read_line(&spectrum(&filtered[5000..], interval).unwrap(), frequency).unwrap();
        let warped = |f: f64| (0.5 * TAU * f * interval).tan();
        let expected = 1.0 / (1.0 + (warped(frequency) / warped(cut_off)).powi(4)).sqrt();
        assert!((found.amplitude - expected).abs() <= 1e-9, "{frequency}: {found:?} {expected}");
    }
    assert_eq!(low_pass(&[7.0; 50], interval, cut_off), [7.0; 50]);
    // Causal: a step later changes nothing before.
    let step: Vec<f64> = (0..50).map(|i| f64::from(u8::from(i >= 20))).collect();
    let found = low_pass(&step, interval, cut_off);
    assert!(found[..20].iter().all(|of| *of == 0.0) && found[20] > 0.0 && found[49] > 0.9);
}

#[test]
fn a_sensor_samples_whole_rows_of_its_window() {
    let rows: Vec<f64> = (0..100).map(f64::from).collect();
    let of = |sampling: Option<f64>| {
        acquire(&rows, 10..40, 1e-3, &Acquisition { sampling, ..Acquisition::default() })
    };
    let all = of(None);
    assert_eq!((all.values.len(), all.values[0], all.interval), (30, 10.0, 1e-3));
    // 300 Hz is every 3.33 rows.
    let third = of(Some(300.0));
    assert_eq!((third.values.len(), third.values[1], third.interval), (10, 13.0, 3e-3));
    assert_eq!(of(Some(1000.0)), all);
}
