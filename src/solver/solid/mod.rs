//! Flexible solids of tetrahedra: what is simulated, explicit steps, the step they can take.
pub mod energy;
pub mod explicit;
pub mod model;
pub mod step_limit;
pub mod tet10_blocks;
pub mod tet4_blocks;
