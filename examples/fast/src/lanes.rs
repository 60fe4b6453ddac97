//! Numbers in vector lanes: one scene in each lane.

use std::ops::{Add, Div, Mul, Neg, Sub};
use wide::{f32x8, f64x4, f64x8};

/// A vector of numbers, one for each scene.
pub trait Real:
    Copy + Send + Sync + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    const LANES: usize;
    fn splat(value: f64) -> Self;
    fn from_lanes(value: impl Fn(usize) -> f64) -> Self;
    fn lane(self, lane: usize) -> f64;
    fn root(self) -> Self;
    fn largest(self, other: Self) -> Self;
    fn smallest(self, other: Self) -> Self;
    /// `yes` in lanes where the number is positive, else `no`.
    fn positive(self, yes: Self, no: Self) -> Self;

    fn zero() -> Self {
        Self::splat(0.0)
    }
    fn size(self) -> Self {
        self.largest(-self)
    }
    /// Sine and cosine of an angle below 0.3 rad, to rounding.
    fn sin_cos_small(self) -> (Self, Self) {
        let (x2, c) = (self * self, |value: f64| Self::splat(value));
        let sin = c(1.0 / 39916800.0);
        let sin = c(1.0 / 362880.0) - x2 * sin;
        let sin = c(1.0 / 5040.0) - x2 * sin;
        let sin = c(1.0 / 120.0) - x2 * sin;
        let sin = c(1.0 / 6.0) - x2 * sin;
        let cos = c(1.0 / 3628800.0) - x2 * c(1.0 / 479001600.0);
        let cos = c(1.0 / 40320.0) - x2 * cos;
        let cos = c(1.0 / 720.0) - x2 * cos;
        let cos = c(1.0 / 24.0) - x2 * cos;
        let cos = c(0.5) - x2 * cos;
        (self - self * x2 * sin, c(1.0) - x2 * cos)
    }
}

macro_rules! real {
    ($vector:ty, $number:ty, $lanes:literal) => {
        impl Real for $vector {
            const LANES: usize = $lanes;
            #[inline(always)]
            fn splat(value: f64) -> Self {
                <$vector>::from(value as $number)
            }
            #[inline(always)]
            fn from_lanes(value: impl Fn(usize) -> f64) -> Self {
                let mut lanes = [0.0 as $number; $lanes];
                for (lane, slot) in lanes.iter_mut().enumerate() {
                    *slot = value(lane) as $number;
                }
                <$vector>::from(lanes)
            }
            #[inline(always)]
            fn lane(self, lane: usize) -> f64 {
                self.to_array()[lane] as f64
            }
            #[inline(always)]
            fn root(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn largest(self, other: Self) -> Self {
                self.fast_max(other)
            }
            #[inline(always)]
            fn smallest(self, other: Self) -> Self {
                self.fast_min(other)
            }
            #[inline(always)]
            fn positive(self, yes: Self, no: Self) -> Self {
                self.simd_gt(Self::splat(0.0)).bitselect(yes, no)
            }
        }
    };
}
real!(f64x4, f64, 4);
real!(f32x8, f32, 8);
real!(f64x8, f64, 8);

/// Scalar product; for numbers as for vector lanes.
#[inline(always)]
pub fn dot<T: Copy + Add<Output = T> + Mul<Output = T>>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub fn cross<T: Copy + Sub<Output = T> + Mul<Output = T>>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a` + `factor` · `b`.
#[inline(always)]
pub fn add<T: Copy + Add<Output = T> + Mul<Output = T>>(a: [T; 3], factor: T, b: [T; 3]) -> [T; 3] {
    [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]]
}

/// Solves `matrix` x = `right` in every lane by Cholesky's method without roots. A pivot below `floor` times its diagonal
/// is replaced by that diagonal; the second result is positive where none was.
#[inline(always)]
pub fn solve<R: Real>(matrix: &[[R; 5]; 5], right: &[R; 5], floor: f64) -> ([R; 5], R) {
    let mut l = *matrix;
    let (mut x, mut sound) = (*right, R::splat(1.0));
    for k in 0..5 {
        let whole = matrix[k][k].size().largest(R::splat(1e-12));
        let enough = l[k][k] - whole * R::splat(floor);
        sound = enough.positive(sound, R::zero());
        let pivot = R::splat(1.0) / enough.positive(l[k][k], whole);
        for i in k + 1..5 {
            let factor = l[i][k] * pivot;
            for j in k + 1..=i {
                l[i][j] = l[i][j] - factor * l[j][k];
            }
            x[i] = x[i] - factor * x[k];
        }
        for i in k + 1..5 {
            l[i][k] = l[i][k] * pivot;
        }
        x[k] = x[k] * pivot;
    }
    for k in (0..5).rev() {
        for i in k + 1..5 {
            x[k] = x[k] - l[i][k] * x[i];
        }
    }
    (x, sound)
}
