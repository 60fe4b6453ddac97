//! Solids of rubber: implicit steps of ten-node elements with a continuous mean stress, without inertia or (with bonded
//! nodes on bodies) with it; small vibrations; a homogeneous bar; four-node elements for explicit steps.
mod attempt;
pub mod bar;
pub mod checkpoint;
pub mod driven;
pub mod explicit;
pub mod harmonic;
pub mod measures;
pub mod model;
pub mod newton;
pub mod path_following;
pub mod plan;
pub mod relaxed;
pub mod sleeve;
pub mod steps;
pub mod tangent;
pub mod tet4;
pub mod tet_forces;
pub mod vibration;
