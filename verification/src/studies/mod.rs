//! Studies of run time against error.

mod cage;
mod dent;
mod housing;
pub mod motion;
mod motion_sweeps;
mod regimes;
mod rotor;
mod rubber;
pub mod solids;
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
    regimes::DEFAULT,
    solids::cantilever::DEFLECTION,
    solids::cantilever::FREQUENCY,
    solids::ring::DEFLECTION,
    solids::ring::FREQUENCY,
    solids::cage::DEFLECTION,
    solids::cage::FREQUENCY,
    housing::ORBIT,
    housing::STIFFNESS,
    rubber::RELAXED,
    rubber::SLOW,
    rubber::FAST,
    dent::DENT,
    rotor::CRITICAL_SPEED,
    rotor::MOMENT,
    rotor::RUN_UP,
];
