//! Studies of run time against error.

mod cage;
mod motion;
mod regimes;
mod solids;

use crate::pareto::Study;

/// Every study.
pub const STUDIES: &[Study] = &[regimes::DEFAULT, solids::DEFLECTION, cage::FLEXIBLE];
