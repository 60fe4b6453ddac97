//! Rigid-body positions and orientations: poses, unit quaternions, Euler angles 1-2-3 (2.16).
pub mod euler;
pub mod number;
pub mod pose;
pub mod strain;
pub mod vec3;

pub use pose::Pose;
