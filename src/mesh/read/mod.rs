//! Meshes from files: Gmsh `.msh` 4.1 and 2.2, text and binary, and Abaqus `.inp`.
//!
//! A reader takes bytes and the length unit the file was written in, which neither format states.
//! It never trusts a count in a file: memory follows what was read, not what was announced.
//!
//! Own code, because the crates for these formats read one version each, or no physical groups,
//! and none of them reports where a file is wrong.
pub mod abaqus;
mod abaqus_lines;
mod assemble;
mod error;
pub mod gmsh;
mod gmsh2;
mod gmsh4;
mod source;

pub use abaqus::read_abaqus;
pub use error::{Place, Problem, ReadError};
pub use gmsh::read_gmsh;

use crate::mesh::tet_mesh::TetMesh;
use std::fmt;

/// The unit of the numbers in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthUnit {
    Metre,
    Millimetre,
}

impl LengthUnit {
    fn in_metres(self) -> f64 {
        match self {
            LengthUnit::Metre => 1.0,
            LengthUnit::Millimetre => 1e-3,
        }
    }

    /// Of a stress (Pa) and a density (kg/m³) in a consistent set with this unit of length.
    fn of_materials(self) -> [f64; 2] {
        match self {
            LengthUnit::Metre => [1.0, 1.0],
            LengthUnit::Millimetre => [1e6, 1e12],
        }
    }
}

/// A mesh as read, in metres, and what a person should know about the reading.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    pub mesh: TetMesh,
    pub notes: Vec<Note>,
    pub numbers: FileNumbers,
    /// Of an input deck, in its order; the mesh takes none of them.
    pub materials: Vec<DeckMaterial>,
}

/// A material as an input deck has it, in SI units: its numbers are taken as a consistent set with the file's
/// unit of length, so that millimetres go with N, MPa and tonnes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeckMaterial {
    pub name: String,
    /// Young's modulus, Pa, and Poisson's ratio, of *ELASTIC for isotropic solids.
    pub elastic: Option<[f64; 2]>,
    /// kg/m³.
    pub density: Option<f64>,
}

/// Numbers of the file's own, in the order of the mesh: Gmsh's tags, Abaqus' labels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileNumbers {
    pub nodes: Vec<u64>,
    pub elements: Vec<u64>,
}

/// Something in a file that is no error and perhaps not meant.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// Machine parts are rarely smaller than 1 mm or larger than 10 m.
    UnlikelySize { size: f64, unit: LengthUnit },
    /// Groups of elements that may be meant as bodies of several materials.
    SeveralVolumes { names: Vec<String> },
    /// A part of the file that says nothing about the mesh: keyword or section.
    Ignored { what: String, count: usize },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Note::UnlikelySize { size, unit: LengthUnit::Metre } => write!(
                f,
                "the mesh is {size:.4e} m across when its numbers are metres; as millimetres it would be {:.4e} m",
                size * 1e-3
            ),
            Note::UnlikelySize { size, unit: LengthUnit::Millimetre } => write!(
                f,
                "the mesh is {size:.4e} m across when its numbers are millimetres; as metres it would be {:.4e} m",
                size * 1e3
            ),
            Note::SeveralVolumes { names } => write!(
                f,
                "the file has {} volumes ({}): all become one body of the one material of the scene",
                names.len(),
                names.join(", ")
            ),
            Note::Ignored { what, count } => write!(f, "{what} was skipped ({count} times)"),
        }
    }
}

/// Sizes of machine parts, m.
const LIKELY_SIZE: std::ops::RangeInclusive<f64> = 1e-3..=10.0;

fn size_note(mesh: &TetMesh, unit: LengthUnit) -> Option<Note> {
    let size = mesh.size();
    (!LIKELY_SIZE.contains(&size)).then_some(Note::UnlikelySize { size, unit })
}
