//! Chapter 3: elastomeric bushings.
pub mod hysteresis;
pub mod similitude;
