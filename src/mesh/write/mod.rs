//! Writers of meshes and fields: Abaqus/CalculiX `.inp`, Gmsh `.msh`, ParaView's `.vtu` and `.pvd`.
mod abaqus;
mod gmsh;
mod vtu;

pub use abaqus::write_abaqus;
pub use gmsh::write_gmsh;
pub use vtu::{Field, write_pvd, write_vtu};

/// Returns whether XML 1.0 (production 2) allows this character.
pub fn is_xml_character(c: char) -> bool {
    matches!(c, '\t' | '\n' | '\r' | ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..)
}
