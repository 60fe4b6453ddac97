//! What laws of a point compute with: one number, or one number a lane for as many points as a vector of the
//! processor holds. Written once for both, with the same bits lane by lane.
//!
//! Left to itself the compiler makes vectors of a loop over lanes only while the law in it is short.

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
    /// A constant.
    fn of(value: f64) -> Self;

    /// The same done to each lane.
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
