//! Flexible solids of tetrahedra: what is simulated, explicit steps, the step they can take.
pub mod checkpoint;
pub mod energy;
pub mod equilibrium;
pub mod explicit;
pub mod model;
pub mod modes;
pub mod step_limit;
pub mod support;
pub mod tangent;
pub mod team;
pub mod tet10_blocks;
pub mod tet4_blocks;
