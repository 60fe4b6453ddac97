//! Meshes and fields into files: Abaqus/CalculiX `.inp`, Gmsh `.msh`, ParaView's `.vtu` and `.pvd`.
mod abaqus;
mod gmsh;
mod vtu;

pub use abaqus::write_abaqus;
pub use gmsh::write_gmsh;
pub use vtu::{Field, write_pvd, write_vtu};
