//! Laws of the telemeter on a cage, against formulas of other forms.

use bearing_dynamics::ch5_cage::telemeter::{
    Telemeter, copper_resistance, mutual_inductance, natural_frequency, self_inductance,
};
use std::f64::consts::{PI, TAU};

/// K and E by the arithmetic-geometric mean.
fn elliptic(k: f64) -> [f64; 2] {
    let (mut a, mut b, mut c) = (1.0, (1.0 - k * k).sqrt(), k);
    let (mut sum, mut power) = (0.5 * c * c, 1.0);
    for _ in 0..8 {
        (a, b, c) = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        sum += power * c * c;
        power *= 2.0;
    }
    let first = PI / (2.0 * a);
    [first, first * (1.0 - sum)]
}

/// Maxwell's formula for loops about one axis.
fn coaxial(a: f64, b: f64, distance: f64) -> f64 {
    let k = (4.0 * a * b / ((a + b).powi(2) + distance * distance)).sqrt();
    let [first, second] = elliptic(k);
    4e-7 * PI * (a * b).sqrt() * ((2.0 / k - k) * first - 2.0 / k * second)
}

/// Neumann's formula, by equal steps round both loops.
fn neumann(a: f64, b: f64, centre: [f64; 3], axes: [[f64; 3]; 2], steps: usize) -> f64 {
    let [first, second] = axes;
    let step = TAU / steps as f64;
    let mut sum = 0.0;
    for i in 0..steps {
        let (sin, cos) = (i as f64 * step).sin_cos();
        let from = [0.0, a * cos, a * sin];
        let along = [0.0, -a * sin, a * cos];
        for j in 0..steps {
            let (sin, cos) = ((j as f64 + 0.5) * step).sin_cos();
            let at = |i: usize| centre[i] + b * (cos * first[i] + sin * second[i]);
            let way = |i: usize| b * (cos * second[i] - sin * first[i]);
            let apart: f64 = (0..3).map(|i| (at(i) - from[i]).powi(2)).sum::<f64>().sqrt();
            sum += (0..3).map(|i| along[i] * way(i)).sum::<f64>() / apart;
        }
    }
    1e-7 * sum * step * step
}

#[test]
fn loops_about_one_axis_have_maxwells_inductance() {
    for (a, b, distance) in [
        (31.25e-3, 31.25e-3, 3e-3),
        (31.25e-3, 31.25e-3, 1.78e-3),
        (0.02, 0.05, 0.01),
        (0.01, 0.03, 0.2),
    ] {
        let ours = mutual_inductance(a, b, [distance, 0.0, 0.0], [1.0, 0.0, 0.0]);
        let exact = coaxial(a, b, distance);
        // Maxwell's form loses digits of loops far apart.
        assert!((ours / exact - 1.0).abs() <= 1e-10, "{a} {b} {distance}: {ours:e} for {exact:e}");
    }
}

#[test]
fn loops_anywhere_have_neumanns_inductance() {
    let (sin, cos) = 0.3f64.sin_cos();
    let tilted = ([cos, sin, 0.0], [[-sin, cos, 0.0], [0.0, 0.0, 1.0]]);
    let (s, c) = 0.7f64.sin_cos();
    let turned = ([c * cos, sin, s * cos], [[-sin * c, cos, -sin * s], [-s, 0.0, c]]);
    let straight = ([1.0, 0.0, 0.0], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    for (a, b, centre, (axis, axes)) in [
        (31.25e-3, 31.25e-3, [8e-3, 1.27e-3, 0.0], straight),
        (31.25e-3, 28e-3, [9e-3, -3e-3, 5e-3], straight),
        (0.02, 0.03, [0.04, 0.005, -0.01], tilted),
        (0.02, 0.015, [-0.03, 0.02, 0.01], turned),
    ] {
        let ours = mutual_inductance(a, b, centre, axis);
        let double = neumann(a, b, centre, axes, 800);
        assert!((ours / double - 1.0).abs() <= 1e-9, "{centre:?}: {ours:e} for {double:e}");
    }
}

#[test]
fn either_loop_may_be_the_first() {
    let one = mutual_inductance(0.03, 0.02, [0.01, 0.004, 0.003], [1.0, 0.0, 0.0]);
    let other = mutual_inductance(0.02, 0.03, [-0.01, -0.004, -0.003], [1.0, 0.0, 0.0]);
    assert!((one / other - 1.0).abs() <= 1e-11, "{one:e} {other:e}");
}

/// The telemeter of 5.2 with what is assumed of it.
fn telemeter(frequency: f64) -> Telemeter {
    let (radius, wire_radius, capacitance) = (31.25e-3, 0.15e-3, 100e-12);
    let natural = natural_frequency(radius, wire_radius, capacitance);
    let resistance = copper_resistance(radius, wire_radius, natural);
    Telemeter {
        radius,
        transceiver_radius: radius,
        wire_radius,
        capacitance,
        resistance: [resistance; 2],
        frequency: frequency * natural,
    }
}

#[test]
fn circuits_are_those_of_their_parts() {
    // 4π·10⁻⁷ · 31.25 mm · (ln(8 · 31.25/0.15) − 2).
    let inductance = self_inductance(31.25e-3, 0.15e-3);
    assert!((inductance - 4e-7 * PI * 31.25e-3 * ((5000f64 / 3.0).ln() - 2.0)).abs() <= 1e-18);
    let natural = natural_frequency(31.25e-3, 0.15e-3, 100e-12);
    assert!(((TAU * natural).powi(2) * inductance * 100e-12 - 1.0).abs() <= 1e-12);
    // (R/r) √(π f μ₀ ρ).
    let expected = 31.25 / 0.15 * (PI * natural * 4e-7 * PI * 1.68e-8).sqrt();
    let resistance = copper_resistance(31.25e-3, 0.15e-3, natural);
    assert!((resistance / expected - 1.0).abs() <= 1e-12, "{resistance} {expected}");

    // Kirchhoff's equations of both loops at one volt: the impedance is that over the current.
    for (frequency, mutual) in [(1.0, 5e-8), (0.9, 8e-8), (1.05, 0.0)] {
        let of = telemeter(frequency);
        let w = TAU * of.frequency;
        let [r, x] = of.impedance(mutual);
        // Z I = 1, in the second loop 0 = Z₁ I₁ + jωM I.
        let (z1r, z1x) = (of.resistance[0], w * inductance - 1.0 / (w * of.capacitance));
        let square = r * r + x * x;
        let current = [r / square, -x / square];
        let square = z1r * z1r + z1x * z1x;
        // I₁ = −jωM I/Z₁.
        let driven = [w * mutual * current[1], -w * mutual * current[0]];
        let second = [
            (driven[0] * z1r + driven[1] * z1x) / square,
            (driven[1] * z1r - driven[0] * z1x) / square,
        ];
        let voltage = [
            of.resistance[1] * current[0] - w * inductance * current[1] - w * mutual * second[1],
            of.resistance[1] * current[1] + w * inductance * current[0] + w * mutual * second[0],
        ];
        assert!((voltage[0] - 1.0).abs() <= 1e-10 && voltage[1].abs() <= 1e-10, "{voltage:?}");
        // What does not come back is what both resistances take: 4·50 R/|Z + 50|².
        let taken = 1.0 - of.reflection(mutual).powi(2);
        let expected = 200.0 * r / ((r + 50.0).powi(2) + x * x);
        assert!((taken - expected).abs() <= 1e-12 && taken > 0.0, "{taken} {expected}");
    }
}
