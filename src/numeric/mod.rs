//! Numerical tools independent of bearings: time profiles, run clock, dense and sparse symmetric matrices.

pub mod clock;
pub mod dense;
pub mod profile;
pub mod sparse;
