//! Flexible solids of tetrahedra: explicit steps, equilibrium, modes, stresses, condensation and reduction; rubber in
//! [`rubber`].

pub mod bore_equilibrium;
pub mod checkpoint;
pub mod condensation;
pub mod contact;
pub mod energy;
pub mod equilibrium;
pub mod error;
pub mod explicit;
pub mod labels;
pub mod memory;
pub mod model;
pub mod modes;
pub mod newton;
pub mod plan;
pub mod rigid_motion;
pub mod rubber;
pub mod runge_kutta;
pub mod step_limit;
pub mod stress;
pub mod support;
pub mod tangent;
pub mod tet10_blocks;
pub mod tet4_blocks;
pub mod threads;
pub mod trust;
