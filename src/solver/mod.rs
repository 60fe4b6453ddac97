//! Solvers: what a scene needs, and equilibrium.
pub mod ball;
pub mod plan;
mod static_start;
pub mod statics;
