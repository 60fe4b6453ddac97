//! Laws of the telemeter on a cage, against formulas of other forms.

use crate::dynamics::Noise;
use bearing_dynamics::ch5_cage::telemeter::{
    Telemeter, copper_resistance, mutual_inductance, natural_frequency, self_inductance,
};
use bearing_dynamics::ch5_cage::telemeter_array::{
    ArrayError, CageLoop, TelemeterArray, Transceiver,
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

/// Twelve small transceivers around the cage, 3 mm beside the plane of its loops, every second one radial.
fn array(loops: Vec<CageLoop>) -> TelemeterArray {
    let transceiver = |i: usize| {
        let (sin, cos) = (TAU * i as f64 / 12.0 + 0.1).sin_cos();
        let radius = if i.is_multiple_of(2) { 28e-3 } else { 36e-3 };
        let axis = if i.is_multiple_of(2) { [1.0, 0.0, 0.0] } else { [0.0, cos, sin] };
        Transceiver { centre: [3e-3, radius * cos, radius * sin], axis }
    };
    TelemeterArray { loops, transceivers: (0..12).map(transceiver).collect() }
}

fn loop_at(radius: f64, centre: [f64; 3]) -> CageLoop {
    let natural = natural_frequency(radius, 0.15e-3, 100e-12);
    let circuit = Telemeter {
        radius,
        transceiver_radius: 8e-3,
        frequency: natural,
        resistance: [radius, 8e-3].map(|radius| copper_resistance(radius, 0.15e-3, natural)),
        ..telemeter(1.0)
    };
    CageLoop { circuit, centre }
}

const POSE: [f64; 6] = [1e-4, -2e-4, 1.5e-4, 0.02, -4e-3, 3e-3];

/// The great loop, and a small one off its centre.
fn two_loops() -> TelemeterArray {
    array(vec![loop_at(31.25e-3, [0.0; 3]), loop_at(10e-3, [0.0, 22e-3, 0.0])])
}

#[test]
fn two_loops_give_all_coordinates_of_a_cage() {
    let array = two_loops();
    let found = array.estimate(&array.readings(&POSE), [0.0; 6]).unwrap();
    for (i, (found, expected)) in found.pose.iter().zip(POSE).enumerate() {
        assert!((found - expected).abs() <= 1e-9, "{i}: {found:e} for {expected:e}");
    }
    assert!(found.residual <= 1e-12 && found.iterations <= 20, "{found:?}");
    let of = found.observability;
    assert!((15.0..30.0).contains(&of.condition), "{of:?}");
}

/// Errors of the readings appear in the coordinates as the observability states, and no more than by the condition number.
#[test]
fn errors_of_readings_grow_as_stated() {
    let array = two_loops();
    let exact = array.readings(&POSE);
    let of = array.observability(&POSE).unwrap();
    // Uniform in ±√3: standard deviation 1.
    let deviation = 1e-7;
    let mut noise = Noise(3);
    let draws = 40;
    let mut squares = [0.0; 6];
    for _ in 0..draws {
        let errors: Vec<f64> =
            exact.iter().map(|_| deviation * 3f64.sqrt() * noise.next()).collect();
        let readings: Vec<f64> = exact.iter().zip(&errors).map(|(of, error)| of + error).collect();
        let found = array.estimate(&readings, POSE).unwrap().pose;
        let scales = [31.25e-3, 31.25e-3, 31.25e-3, 1.0, 1.0, 1.0];
        let scaled = |i: usize| (found[i] - POSE[i]) / scales[i];
        let error = (0..6).map(|i| scaled(i).powi(2)).sum::<f64>().sqrt();
        let of_readings = errors.iter().map(|of| of * of).sum::<f64>().sqrt();
        // |δu| ≤ |δr|/σ₆ = κ |δr|/σ₁, and a percent for what is not linear.
        let bound = of.condition * of_readings / of.singular_values[0];
        assert!(error <= 1.01 * bound, "{error:e} {bound:e}");
        (0..6).for_each(|i| squares[i] += (found[i] - POSE[i]).powi(2));
    }
    for (i, (square, gain)) in squares.iter().zip(&of.noise_gain).enumerate() {
        let found = (square / draws as f64).sqrt();
        let expected = deviation * gain;
        // A standard deviation of 40 draws has an error of 11 %.
        assert!((found / expected - 1.0).abs() <= 0.4, "{i}: {found:e} for {expected:e}");
    }
}

/// A circle turned about its own axis is the same circle: one loop leaves one combination open.
#[test]
fn one_loop_never_gives_all_coordinates() {
    // Centred: the rotation of the cage. With a runout towards +Y: the rotation together with a displacement along Z.
    let nominal = [0.0; 6];
    for (runout, blind) in [(0.0, &[3][..]), (1e-3, &[2, 3])] {
        let array = array(vec![loop_at(31.25e-3, [0.0, runout, 0.0])]);
        let of = array.observability(&nominal).unwrap();
        assert_eq!(of.condition, f64::INFINITY, "{of:?}");
        for i in 0..6 {
            assert_eq!(of.noise_gain[i].is_infinite(), blind.contains(&i), "{runout} {i}: {of:?}");
        }
        let moved = [0.0, 0.0, -0.01 * runout, 0.01, 0.0, 0.0];
        let (one, other) = (array.readings(&moved), array.readings(&nominal));
        let apart = one.iter().zip(&other);
        let apart = apart.fold(0.0f64, |most, (one, other)| most.max((one - other).abs()));
        // The rotation moves the centre by 0.01²/2 of the runout.
        assert!(apart <= 1e-5, "{apart:e}");
        // The five others are found; the rotation keeps its start.
        let pose = [1e-4, -1e-4, 5e-5, 0.0, 3e-3, -2e-3];
        let found = array.estimate(&array.readings(&pose), nominal).unwrap();
        assert!(found.residual <= 1e-12, "{found:?}");
        if runout == 0.0 {
            let others = [0, 1, 2, 4, 5].map(|i| (found.pose[i] - pose[i]).abs());
            let worst = others.into_iter().fold(0.0, f64::max);
            assert!(worst <= 1e-8, "{found:?}");
        }
    }
}

#[test]
fn an_array_refuses_what_it_cannot_solve() {
    let array = two_loops();
    let readings = array.readings(&POSE);
    assert_eq!(
        array.estimate(&readings[1..], POSE),
        Err(ArrayError::OtherCount { found: 23, wanted: 24 })
    );
    let few = TelemeterArray { transceivers: array.transceivers[..2].to_vec(), ..array.clone() };
    assert_eq!(few.estimate(&few.readings(&POSE), POSE), Err(ArrayError::TooFew { found: 4 }));
    let not_finite = array.estimate(&[f64::NAN; 24], POSE);
    assert!(matches!(not_finite, Err(ArrayError::NotFinite { .. })), "{not_finite:?}");
}
