//! Number type of material laws and kinematics: one number, or a SIMD vector with one number per lane. Both give the
//! same bits per lane.
//!
//! Explicit SIMD types are used because the compiler vectorises loops over lanes only for short loop bodies.

use std::ops::{Add, Div, Mul, Neg, Sub};
use wide::{f64x4, f64x8};

pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Constant value in every lane.
    fn of(value: f64) -> Self;

    /// Applies a function to each lane.
    fn each(self, of: impl Fn(f64) -> f64) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn of(value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn each(self, of: impl Fn(f64) -> f64) -> f64 {
        of(self)
    }
}

impl Number for f64x4 {
    #[inline(always)]
    fn of(value: f64) -> f64x4 {
        f64x4::splat(value)
    }

    #[inline(always)]
    fn each(self, of: impl Fn(f64) -> f64) -> f64x4 {
        let mut lanes = self.to_array();
        for lane in &mut lanes {
            *lane = of(*lane);
        }
        f64x4::new(lanes)
    }
}

impl Number for f64x8 {
    #[inline(always)]
    fn of(value: f64) -> f64x8 {
        f64x8::splat(value)
    }

    #[inline(always)]
    fn each(self, of: impl Fn(f64) -> f64) -> f64x8 {
        let mut lanes = self.to_array();
        for lane in &mut lanes {
            *lane = of(*lane);
        }
        f64x8::new(lanes)
    }
}
