//! Studies of run time against error.

mod statics;

use crate::pareto::Study;

/// Every study.
pub const STUDIES: &[Study] = &[statics::TOLERANCE, statics::POSITIONS];
