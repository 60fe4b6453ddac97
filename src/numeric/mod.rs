//! Numerical tools that know no bearing: profiles over time, the clock of a run, dense and sparse symmetric matrices.

pub mod clock;
pub mod dense;
pub mod profile;
pub mod sparse;
