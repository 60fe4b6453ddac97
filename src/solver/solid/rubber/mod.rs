//! Solids of rubber without inertia: implicit steps of ten-node elements with a continuous mean stress, the
//! response to small vibrations, and a homogeneous bar.
pub mod bar;
pub mod error;
pub mod harmonic;
pub mod model;
pub mod newton;
pub mod prony;
pub mod sleeve;
pub mod steps;
