//! Readers of mesh files: Gmsh `.msh` 4.1 and 2.2, text and binary, and Abaqus `.inp`.
//!
//! A reader takes bytes and the file's unit of length, which neither format states.
//! Memory is allocated for data that was read, never for a count that the file announces.
//!
//! Existing crates for these formats read one version only, or no physical groups,
//! and none reports the position of an error.
pub mod abaqus;
mod abaqus_elements;
mod abaqus_lines;
mod abaqus_members;
mod abaqus_sets;
mod assemble;
mod error;
pub mod gmsh;
mod gmsh2;
mod gmsh4;
mod source;
mod used;

pub use abaqus::read_abaqus;
pub use error::{Place, Problem, ReadError};
pub use gmsh::read_gmsh;

use crate::mesh::error::six_digits;
use crate::mesh::tet_mesh::TetMesh;
use std::fmt;

/// Unit of length in a file.
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

    /// Factors to Pa and kg/m³ in the consistent system of units with this unit of length.
    fn of_materials(self) -> [f64; 2] {
        match self {
            LengthUnit::Metre => [1.0, 1.0],
            LengthUnit::Millimetre => [1e6, 1e12],
        }
    }
}

/// A mesh as read, in metres, with notes for the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    pub mesh: TetMesh,
    pub notes: Vec<Note>,
    pub numbers: FileNumbers,
    /// Materials of an input deck, in its order; the mesh does not use them.
    pub materials: Vec<DeckMaterial>,
    /// Sets of the file that are not in the mesh.
    pub unusable: Vec<Unusable>,
    /// Whether labels are equal if they differ in case alone.
    pub any_case: bool,
}

/// Kinds of sets, in the order in which a name is looked up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SetKind {
    Nodes,
    Surface,
    Elements,
}

/// A set that cannot be used, with the reason.
#[derive(Clone, Debug, PartialEq)]
pub struct Unusable {
    pub name: String,
    pub kind: SetKind,
    pub error: ReadError,
}

/// A material of an input deck, in SI units. Its numbers are assumed to be in the consistent system with the file's
/// unit of length: millimetres with N, MPa and tonnes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeckMaterial {
    pub name: String,
    /// Young's modulus, Pa, and Poisson's ratio of an isotropic *ELASTIC.
    pub elastic: Option<[f64; 2]>,
    /// Density, kg/m³.
    pub density: Option<f64>,
    /// First constants that are not read: `*HYPERELASTIC, NEO HOOKE`.
    pub unread: Option<String>,
}

/// The file's numbers in the order of the mesh: Gmsh's tags, Abaqus' labels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileNumbers {
    pub nodes: Vec<u64>,
    pub elements: Vec<u64>,
}

/// A note about something in a file that may not be intended.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// Machine parts are rarely smaller than 1 mm or larger than 10 m.
    UnlikelySize { size: f64, unit: LengthUnit },
    /// Groups of elements that may be intended as bodies of different materials.
    SeveralVolumes { names: Vec<String> },
    /// A keyword, section or kind of element that does not describe the mesh.
    Ignored { what: String, count: usize },
    /// Elements of another formulation on the same nodes.
    ReadAs { found: String, read: &'static str },
    /// Members of a set that the file does not define.
    Missing { set: String, kind: &'static str, count: usize, first: u64, place: Place },
    /// Sets that cannot be used, and that the scene does not use.
    SetsSkipped { names: Vec<String>, error: ReadError },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Note::UnlikelySize { size, unit: LengthUnit::Metre } => write!(
                f,
                "the mesh has a size of {} m with its numbers in metres; in millimetres it would be {} m",
                six_digits(*size),
                six_digits(size * 1e-3)
            ),
            Note::UnlikelySize { size, unit: LengthUnit::Millimetre } => write!(
                f,
                "the mesh has a size of {} m with its numbers in millimetres; in metres it would be {} m",
                six_digits(*size),
                six_digits(size * 1e3)
            ),
            Note::SeveralVolumes { names } => write!(
                f,
                "the file has {} volumes ({}); all become one body with the material of the scene",
                names.len(),
                names.join(", ")
            ),
            Note::Ignored { what, count } => write!(f, "{what} was skipped ({count} times)"),
            Note::ReadAs { found, read } => {
                write!(f, "elements of type {found} are read as {read}")
            }
            Note::Missing { set, kind, count, first, place } => write!(
                f,
                "set \"{set}\" has {count} members that the file does not define (first: {kind} {first}, {place}); they are \
                 left out"
            ),
            Note::SetsSkipped { names, error } => match names.len() {
                1 => write!(f, "set \"{}\" was skipped: {error}", names[0]),
                count => {
                    let first: Vec<&str> = names.iter().take(3).map(String::as_str).collect();
                    let (all, more) = (first.join("\", \""), if count > 3 { ", …" } else { "" });
                    write!(f, "{count} sets were skipped (\"{all}\"{more}); the first: {error}")
                }
            },
        }
    }
}

/// Usual sizes of machine parts, m.
const LIKELY_SIZE: std::ops::RangeInclusive<f64> = 1e-3..=10.0;

fn size_note(mesh: &TetMesh, unit: LengthUnit) -> Option<Note> {
    let size = mesh.size();
    (!LIKELY_SIZE.contains(&size)).then_some(Note::UnlikelySize { size, unit })
}
