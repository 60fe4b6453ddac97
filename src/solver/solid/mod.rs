//! Flexible solids of tetrahedra: what is simulated, explicit steps and the step they can take,
//! equilibrium, natural modes, stresses, how far they can be trusted, contact with a rigid cylinder.
pub mod checkpoint;
pub mod contact;
pub mod energy;
pub mod equilibrium;
pub mod equilibrium_error;
pub mod explicit;
pub mod labels;
pub mod memory;
pub mod model;
pub mod modes;
pub mod rigid_motion;
pub mod rubber;
mod runge_kutta;
pub mod step_limit;
pub mod stress;
pub mod support;
pub mod tangent;
pub mod team;
pub mod tet10_blocks;
pub mod tet4_blocks;
pub mod trust;
