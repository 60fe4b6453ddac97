//! Plots of a run.

pub mod bearing;
pub mod solid;
