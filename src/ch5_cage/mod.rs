//! Chapter 5: monitoring of the cage by a telemeter.
pub mod telemeter;
pub mod telemeter_array;
