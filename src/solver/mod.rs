//! Solvers: what a scene needs, and equilibrium.
pub mod ball;
mod ball_start;
pub mod channels;
pub mod clock;
pub mod dense;
pub mod dynamics;
pub mod housing;
pub mod mount;
pub mod plan;
pub mod profile;
pub mod solid;
pub mod sparse;
pub mod static_assembly;
mod static_search;
mod static_start;
pub mod static_tables;
pub mod statics;
