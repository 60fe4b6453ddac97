//! Chapter 3: elastomeric bushings, dents in races.
pub mod dent;
pub mod hysteresis;
pub mod similitude;
