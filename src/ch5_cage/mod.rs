//! Chapter 5: the flexible cage and its monitoring by a telemeter.

pub mod floating_frame;
pub mod node_contact;
pub mod telemeter;
