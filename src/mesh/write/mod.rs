//! Meshes and fields into files: Abaqus/CalculiX `.inp`, ParaView's `.vtu` and `.pvd`.
mod abaqus;
mod vtu;

pub use abaqus::write_abaqus;
pub use vtu::{Field, write_pvd, write_vtu};
