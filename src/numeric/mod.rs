//! Numerical tools independent of bearings: time profiles, run clock, dense and sparse symmetric matrices, small eigenvalue
//! problems.

pub mod clock;
pub mod dense;
pub mod profile;
pub mod ritz;
pub mod sparse;
