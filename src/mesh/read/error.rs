//! What is wrong with a file, and where.

use crate::mesh::error::MeshError;
use std::fmt;
use thiserror::Error;

/// Where in a file: a line (from 1) of text, a byte (from 0) of binary data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Line(usize),
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(line) => write!(f, "line {line}"),
            Place::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// A file that cannot be read as a mesh.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{place}: {problem}")]
pub struct ReadError {
    pub place: Place,
    pub problem: Problem,
}

#[derive(Clone, Debug, Error, PartialEq)]
pub enum Problem {
    #[error("the file is empty")]
    Empty,
    #[error("this is not a {expected} file: it starts with {found:?}")]
    OtherFormat { expected: &'static str, found: String },
    #[error("format version {found:?} is not read; save the mesh as version 4.1 or 2.2")]
    Version { found: String },
    #[error("the file ends within {what}; it was cut off, get a whole copy")]
    Truncated { what: String },
    #[error("{found:?} is not {what}")]
    Number { found: String, what: &'static str },
    #[error(
        "the file claims {claimed} {what}, for which the {left} bytes that follow cannot do; the file is damaged or cut off"
    )]
    Count { what: &'static str, claimed: u64, left: usize },
    #[error(
        "{expected} was expected here and {found:?} was found; the counts before it may be wrong"
    )]
    Expected { expected: String, found: String },
    #[error("the file has no {section} section")]
    MissingSection { section: &'static str },
    #[error("elements of type {found} are not read; {}", in_place_of(found))]
    ElementType { found: String },
    #[error(
        "{this} nodes an element here and {first} before; a mesh has elements of one order only"
    )]
    MixedOrders { first: usize, this: usize },
    #[error("{kind} {tag} is defined twice")]
    Duplicate { kind: &'static str, tag: u64 },
    #[error("element {element} names node {node}, which the file does not define")]
    UnknownNode { element: u64, node: u64 },
    #[error("element {element} has node {node} twice")]
    RepeatedNode { element: u64, node: u64 },
    #[error("set \"{set}\" names {kind} {tag}, which the file does not define")]
    UnknownMember { set: String, kind: &'static str, tag: u64 },
    #[error(
        "the sets have more members than a file of {length} bytes can mean; ranges or groups repeat too much"
    )]
    TooManyMembers { length: usize },
    #[error("set \"{name}\" is not defined before it is used")]
    UnknownSet { name: String },
    #[error("set \"{set}\" has a face on nodes {nodes:?} that is no side of a tetrahedron")]
    LooseFace { set: String, nodes: [u64; 3] },
    #[error("{what} is not read; {hint}")]
    Unsupported { what: String, hint: &'static str },
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// What to mesh with in place of a type of elements.
fn in_place_of(found: &str) -> &'static str {
    match found.trim_end_matches(['H', 'M', 'T', 'E']) {
        "C3D10" => {
            "write C3D10: elements of ten nodes here do not lock where rubber keeps its volume"
        }
        "C3D4" => "write C3D4, or mesh with ten nodes for rubber",
        _ => "mesh with tetrahedra of four or ten nodes",
    }
}
