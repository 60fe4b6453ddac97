//! Studies of run time against error.

mod cage;
mod motion;
mod statics;
mod varying_compliance;

use crate::pareto::Study;

/// Every study.
pub const STUDIES: &[Study] = &[
    statics::TOLERANCE,
    statics::POSITIONS,
    varying_compliance::STEP,
    varying_compliance::INTEGRATOR,
    varying_compliance::SLICES,
    varying_compliance::HERTZ,
    cage::STEP,
    cage::INTEGRATOR,
    cage::SLICES,
    cage::HERTZ,
    cage::CONTACT,
];
