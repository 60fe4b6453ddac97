//! Chapter 5: monitoring of the cage by a telemeter, bearing defects.
pub mod raceway_profile;
pub mod spall;
pub mod telemeter;
