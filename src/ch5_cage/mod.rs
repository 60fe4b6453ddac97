//! Chapter 5: the cage and what watches it. Laws of the telemeter on a cage.
pub mod telemeter;
