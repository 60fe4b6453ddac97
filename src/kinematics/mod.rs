//! Rigid-body positions and orientations: poses, unit quaternions, Euler angles 1-2-3 (2.16).
pub mod euler;
pub mod pose;

pub use pose::Pose;
