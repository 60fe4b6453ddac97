//! Element types of input decks.

use crate::mesh::read::Note;
use crate::mesh::read::abaqus_lines::Keyword;
use crate::mesh::read::assemble::RawMesh;
use crate::mesh::read::error::{Problem, ReadError};
use crate::mesh::read::source::{Source, excerpt};

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Tet(usize),
    Triangle(usize),
    Line(usize),
    /// Masses, springs, couplings, shells: no part of the body.
    Other,
}

impl Kind {
    pub fn node_count(self) -> usize {
        match self {
            Kind::Tet(count) | Kind::Triangle(count) | Kind::Line(count) => count,
            Kind::Other => 0,
        }
    }
}

/// Families of triangles; their names end with the number of nodes.
const TRIANGLES: [&str; 12] =
    ["STRI", "S", "DS", "CPS", "CPE", "CPEG", "M3D", "SFM3D", "R3D", "F3D", "DC2D", "AC2D"];

/// Kind of the elements of a keyword, with a note if they are skipped or of another formulation.
///
/// # Errors
/// Elements of a body that are not tetrahedra of four or ten nodes.
pub fn kind(source: &Source, keyword: &Keyword, raw: &mut RawMesh) -> Result<Kind, ReadError> {
    keyword.required(source, "TYPE")?;
    let name = keyword.choice("TYPE").unwrap_or_default();
    // Letters behind the number of nodes are variants: hybrid, modified, reduced.
    let plain = name.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let family = plain.trim_end_matches(|c: char| c.is_ascii_digit());
    let count = &plain[family.len()..];
    let mut tetrahedron = |count, read| {
        if name != read {
            let note = Note::ReadAs { found: excerpt(name.as_bytes()), read };
            if !raw.notes.contains(&note) {
                raw.notes.push(note);
            }
        }
        Ok(Kind::Tet(count))
    };
    match (family, count) {
        ("C3D" | "DC3D" | "AC3D", "4") => tetrahedron(4, "C3D4"),
        ("C3D" | "DC3D" | "AC3D", "10") => tetrahedron(10, "C3D10"),
        ("T3D", "2") | ("B", "31") => Ok(Kind::Line(2)),
        ("T3D", "3") | ("B", "32") => Ok(Kind::Line(3)),
        ("STRI", "65") => Ok(Kind::Triangle(6)),
        (family, "3") if TRIANGLES.contains(&family) => Ok(Kind::Triangle(3)),
        (family, "6") if TRIANGLES.contains(&family) => Ok(Kind::Triangle(6)),
        (family, _)
            if family.contains("C3D") || ["SC", "CSS", "COH3D", "Q3D"].contains(&family) =>
        {
            let found = excerpt(name.as_bytes());
            Err(source.error_at(keyword.at, Problem::ElementType { found }))
        }
        _ => {
            raw.ignore(format!("element type {}", excerpt(name.as_bytes())));
            Ok(Kind::Other)
        }
    }
}
