//! Solvers: what a scene needs, and equilibrium.
pub mod ball;
pub mod channels;
pub mod dynamics;
pub mod plan;
pub mod profile;
mod static_start;
pub mod statics;
