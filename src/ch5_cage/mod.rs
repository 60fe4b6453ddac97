//! Chapter 5: the flexible cage, defects of raceways, and the cage's monitoring by a telemeter.

pub mod floating_frame;
pub mod node_contact;
pub mod raceway_profile;
pub mod spall;
pub mod telemeter;
pub mod telemeter_array;
