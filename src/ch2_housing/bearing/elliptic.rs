//! Complete elliptic integrals in the combinations that the Hertz problem needs.
//!
//! They are computed from Carlson's symmetric integrals R_F and R_D (Carlson, Numerical Algorithms 10, 1995, 13–26). The
//! textbook form K(m) − E(m) loses all digits for nearly circular contacts; `R_D` gives the same difference without a
//! subtraction.
//!
//! The functions take the *complementary* parameter m₁ = 1 − m = (b/a)² of an ellipse with semi-axes a ≥ b, 0 < m₁ ≤ 1,
//! which keeps full precision for slender ellipses.

/// R_F(0, y, z) for y, z > 0.
fn carlson_rf0(y: f64, z: f64) -> f64 {
    let (mut x, mut y, mut z) = (0.0_f64, y, z);
    // Each duplication divides the spread of the arguments by four; the series that follows is of
    // sixth order, so a spread of 1e-3 leaves an error of about 1e-18.
    loop {
        let mean = (x + y + z) / 3.0;
        let (dx, dy, dz) = (1.0 - x / mean, 1.0 - y / mean, 1.0 - z / mean);
        if dx.abs().max(dy.abs()).max(dz.abs()) < 1e-3 {
            let e2 = dx * dy + dy * dz + dz * dx;
            let e3 = dx * dy * dz;
            let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0
                - 3.0 * e2 * e3 / 44.0
                - 5.0 * e2 * e2 * e2 / 208.0
                + 3.0 * e3 * e3 / 104.0;
            return series / mean.sqrt();
        }
        let shift = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        x = (x + shift) / 4.0;
        y = (y + shift) / 4.0;
        z = (z + shift) / 4.0;
    }
}

/// R_D(0, y, z) for y, z > 0.
fn carlson_rd0(y: f64, z: f64) -> f64 {
    let (mut x, mut y, mut z) = (0.0_f64, y, z);
    let mut sum = 0.0;
    let mut factor = 1.0;
    loop {
        let mean = (x + y + 3.0 * z) / 5.0;
        let (dx, dy, dz) = (1.0 - x / mean, 1.0 - y / mean, 1.0 - z / mean);
        if dx.abs().max(dy.abs()).max(dz.abs()) < 1e-3 {
            let e2 = dx * dy + 3.0 * dz * (dx + dy) + 3.0 * dz * dz;
            let e3 = dz * (3.0 * dx * dy + 3.0 * dz * (dx + dy) + dz * dz);
            let e4 = dz * dz * (3.0 * dx * dy + dz * (dx + dy));
            let e5 = dx * dy * dz * dz * dz;
            let series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0
                - 3.0 * e4 / 22.0
                - 9.0 * e2 * e3 / 52.0
                + 3.0 * e5 / 26.0
                - e2 * e2 * e2 / 16.0
                + 3.0 * e3 * e3 / 40.0
                + 3.0 * e2 * e4 / 20.0;
            return 3.0 * sum + factor * series / (mean * mean.sqrt());
        }
        let shift = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        sum += factor / (z.sqrt() * (z + shift));
        factor /= 4.0;
        x = (x + shift) / 4.0;
        y = (y + shift) / 4.0;
        z = (z + shift) / 4.0;
    }
}

/// K(m) = ∫₀^{π/2} dφ/√(1 − m sin²φ), as a function of m₁ = 1 − m.
///
/// ```
/// let quarter_circle = bearing_dynamics::ch2_housing::bearing::elliptic::first_kind(1.0);
/// assert!((quarter_circle - std::f64::consts::FRAC_PI_2).abs() <= 1e-15);
/// ```
pub fn first_kind(complementary: f64) -> f64 {
    carlson_rf0(complementary, 1.0)
}

/// E(m) = ∫₀^{π/2} √(1 − m sin²φ) dφ, as a function of m₁ = 1 − m.
pub fn second_kind(complementary: f64) -> f64 {
    complementary * (carlson_rd0(complementary, 1.0) + carlson_rd0(1.0, complementary)) / 3.0
}

/// D(m) = (K − E)/m = ∫₀^{π/2} sin²φ/√(1 − m sin²φ) dφ, without the subtraction.
pub fn integral_d(complementary: f64) -> f64 {
    carlson_rd0(complementary, 1.0) / 3.0
}

/// B(m) = (E − m₁K)/m = ∫₀^{π/2} cos²φ/√(1 − m sin²φ) dφ, without the subtraction.
pub fn integral_b(complementary: f64) -> f64 {
    complementary * carlson_rd0(1.0, complementary) / 3.0
}
