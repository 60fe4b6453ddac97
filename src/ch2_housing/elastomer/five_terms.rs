//! DEV S of the five-term chain for explicit time steps: branch-free, for one element or one element per SIMD lane.
//!
//! Same expressions as [`super::eight_chain`]. A strain with det C ≤ 0 gives a meaningless value instead of an error;
//! the time stepper monitors the volume ratio.

use super::eight_chain::{ChainPull, EightChain, SERIES};
use crate::kinematics::number::Number;
use crate::kinematics::strain::{Sym3, determinant, double_dot, full};

/// 2 ∂W/∂Ī₁ as a polynomial in Ī₁, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiveTerms([f64; 5]);

impl FiveTerms {
    /// Polynomial of a network; `None` unless it uses [`ChainPull::FiveTerms`].
    pub fn of(network: &EightChain) -> Option<FiveTerms> {
        if network.pull != ChainPull::FiveTerms {
            return None;
        }
        let mut scale = 2.0 * network.modulus;
        let mut coefficients = [0.0; 5];
        for (k, series) in SERIES.into_iter().enumerate() {
            coefficients[k] = (k + 1) as f64 * series * scale;
            scale /= network.locking;
        }
        Some(FiveTerms(coefficients))
    }

    /// DEV S (2.12), Pa.
    #[inline(always)]
    pub fn isochoric_stress<T: Number>(&self, e: &Sym3<T>) -> Sym3<T> {
        let one = T::of(1.0);
        let third = (e[0] + e[1] + e[2]) * T::of(1.0 / 3.0);
        let d = [e[0] - third, e[1] - third, e[2] - third, e[3], e[4], e[5]];
        let mean = one + T::of(2.0) * third;
        let per_mean = one / mean;
        let double = T::of(2.0) * per_mean;
        let s = [
            d[0] * double,
            d[1] * double,
            d[2] * double,
            d[3] * double,
            d[4] * double,
            d[5] * double,
        ];
        // det C = mean³ (1 − q).
        let q = T::of(0.5) * double_dot(&s, &s) - determinant(&full(&s));
        let rest = one - q;
        let y = inverse_cube_root(rest);
        let root = rest * y * y;
        let excess = T::of(3.0) * q * y / (one + root + root * root);
        let x = T::of(3.0) + excess;
        let [a, b, c, f, g] = self.0.map(T::of);
        let slope = a + x * (b + x * (c + x * (f + x * g)));
        // C⁻¹ = (1 + s)⁻¹/mean; its product with dev E is symmetric because both have the same principal axes.
        let m = [one + s[0], one + s[1], one + s[2]];
        let inverse = [
            m[1] * m[2] - s[4] * s[4],
            m[2] * m[0] - s[5] * s[5],
            m[0] * m[1] - s[3] * s[3],
            s[4] * s[5] - m[2] * s[3],
            s[5] * s[3] - m[0] * s[4],
            s[3] * s[4] - m[1] * s[5],
        ];
        // 2 C_R slope · J^(−2/3) · 2 dev E C⁻¹, with J^(−2/3) = y/mean and 2 dev E/mean = s.
        let factor = slope * y * per_mean / rest;
        let (s, c) = (full(&s), full(&inverse));
        let entry = |i: usize, j: usize| {
            factor * (s[i][0] * c[0][j] + s[i][1] * c[1][j] + s[i][2] * c[2][j])
        };
        [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)]
    }
}

/// x^(−1/3) for x > 0, to 4e-16: initial guess from a third of the exponent, then Newton's method.
#[inline(always)]
pub fn inverse_cube_root<T: Number>(x: T) -> T {
    // 2⁵², whose last bits are units; the constant limits the error of the initial guess to ±4 %.
    const UNITS: f64 = 4_503_599_627_370_496.0;
    let mut y = x.each(|x| {
        let high = f64::from_bits(UNITS.to_bits() | (x.to_bits() >> 32)) - UNITS;
        let guess = UNITS + (THIRDS - high * (1.0 / 3.0));
        f64::from_bits(guess.to_bits() << 32)
    });
    for _ in 0..4 {
        y = y * ((T::of(4.0) - x * (y * y * y)) * T::of(1.0 / 3.0));
    }
    y
}

/// Upper half of the bits of x^(−1/3), extrapolated linearly to zero bits of x.
const THIRDS: f64 = 1_430_180_000.0;
