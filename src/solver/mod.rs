//! Solvers: what a scene needs, and equilibrium.
pub mod statics;
