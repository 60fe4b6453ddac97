//! Chapter 5: monitoring of the cage by a telemeter.
pub mod telemeter;
