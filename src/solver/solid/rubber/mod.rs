//! Solids of rubber without inertia: implicit steps of ten-node elements with a continuous mean stress, the
//! response to small vibrations, and a homogeneous bar.
pub mod bar;
pub mod checkpoint;
pub mod error;
pub mod harmonic;
pub mod measures;
pub mod model;
pub mod newton;
pub mod relaxed;
pub mod steps;
pub mod vibration;
