//! Studies of run time against error.

mod motion;
mod regimes;
mod solids;

use crate::pareto::Study;

/// Every study.
pub const STUDIES: &[Study] = &[regimes::DEFAULT, solids::DEFLECTION];
