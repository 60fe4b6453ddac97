//! Studies of run time against error.

mod cage;
mod motion;
mod solids;
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
    solids::CANTILEVER_DEFLECTION,
    solids::CANTILEVER_FREQUENCY,
    solids::RING_DEFLECTION,
    solids::RING_FREQUENCY,
    solids::CAGE_DEFLECTION,
    solids::CAGE_FREQUENCY,
];
