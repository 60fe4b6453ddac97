//! Solvers: what a scene needs, and equilibrium.
pub mod ball;
mod ball_start;
pub mod channels;
pub mod clock;
pub mod dense;
pub mod dynamics;
pub mod housing;
pub mod plan;
pub mod profile;
pub mod solid;
pub mod sparse;
mod static_search;
mod static_start;
pub mod statics;
