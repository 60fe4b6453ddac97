//! The closed form of bonded bushings: its Bessel functions and its limits.

use std::f64::consts::PI;

use verification::oracles::bonded_disc::{first_kind, radial_stiffness, second_kind};

#[test]
fn bessel_functions() {
    // I₁(1), I₁′(1) = I₀(1) − I₁(1); K₁(1), K₁′(1) = −K₀(1) − K₁(1).
    let [i, di] = first_kind(1.0).map(|x| x * 1f64.exp());
    assert!((i - 0.565_159_103_992_485).abs() <= 1e-13, "{i}");
    assert!((di - (1.266_065_877_752_008 - i)).abs() <= 1e-13, "{di}");
    let [k, dk] = second_kind(1.0).map(|x| x * (-1f64).exp());
    assert!((k - 0.601_907_230_197_235).abs() <= 1e-13, "{k}");
    assert!((dk + 0.421_024_438_240_708 + k).abs() <= 1e-13, "{dk}");
}

/// Plane strain, and a disc.
#[test]
fn its_limits() {
    let (a, b) = (0.02f64, 0.04f64);
    let (sum, difference, log) = (a * a + b * b, b * b - a * a, (b / a).ln());
    let plane = 4.0 * PI * sum / (sum * log - difference);
    let long = radial_stiffness(a, b, 100.0 * b);
    assert!((long / plane - 1.0).abs() <= 1e-2, "{long} {plane}");
    let disc = 80.0 * PI * sum / (25.0 * sum * log - 9.0 * difference);
    let short = radial_stiffness(a, b, 0.01 * b);
    assert!((short / disc - 1.0).abs() <= 1e-2, "{short} {disc}");
}
