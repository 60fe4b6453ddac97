//! Chapter 3: elastomeric bushings and raceway dents.
pub mod dent;
pub mod hysteresis;
pub mod similitude;
