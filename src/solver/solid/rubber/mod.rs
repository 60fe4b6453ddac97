//! Solids of rubber without inertia: implicit steps of ten-node elements with a continuous mean stress, the
//! response to small vibrations, and a homogeneous bar. With inertia: four-node elements for explicit steps.
pub mod bar;
pub mod checkpoint;
pub mod error;
pub mod explicit;
pub mod harmonic;
pub mod holds;
pub mod measures;
pub mod model;
pub mod newton;
pub mod prony;
pub mod relaxed;
pub mod sleeve;
pub mod steps;
pub mod tangent;
pub mod tet4;
pub mod tet_forces;
pub mod vibration;
