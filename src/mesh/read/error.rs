//! Errors of mesh files, with positions.

use crate::mesh::error::MeshError;
use std::fmt;
use thiserror::Error;

/// Position in a file: a line (from 1) of text, a byte (from 0) of binary data.
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

/// Error of reading a mesh file.
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
    #[error("this is not {expected} file: it starts with {found:?}")]
    OtherFormat { expected: &'static str, found: String },
    #[error("format version {found:?} is not supported; save the mesh as version 4.1 or 2.2")]
    Version { found: String },
    #[error("the file ends within {what}; it is truncated")]
    Truncated { what: String },
    #[error("{found:?} is not {what}")]
    Number { found: String, what: &'static str },
    #[error(
        "the file announces {claimed} {what}, but only {left} bytes follow; the file is damaged or truncated"
    )]
    Count { what: &'static str, claimed: u64, left: usize },
    #[error(
        "expected {expected}, found {found:?}; the counts given earlier in the file may be wrong"
    )]
    Expected { expected: String, found: String },
    #[error("the file has no {section} section")]
    MissingSection { section: &'static str },
    #[error(
        "elements of type {found} are not supported; mesh with tetrahedra of four or ten nodes"
    )]
    ElementType { found: String },
    #[error(
        "elements with {this} nodes here and {first} nodes before; a mesh has elements of one order only"
    )]
    MixedOrders { first: usize, this: usize },
    #[error("{kind} {tag} is defined twice")]
    Duplicate { kind: &'static str, tag: u64 },
    #[error("element {element} refers to node {node}, which the file does not define")]
    UnknownNode { element: u64, node: u64 },
    #[error("element {element} has node {node} twice")]
    RepeatedNode { element: u64, node: u64 },
    #[error("set \"{set}\" refers to {kind} {tag}, which the file does not define")]
    UnknownMember { set: String, kind: &'static str, tag: u64 },
    #[error(
        "the sets have more members than a file of {length} bytes can define; check for repeated ranges or groups"
    )]
    TooManyMembers { length: usize },
    #[error("the file has no set or instance \"{name}\"")]
    UnknownSet { name: String },
    #[error("set \"{set}\" has no member in the mesh")]
    NoMembers { set: String },
    #[error("set \"{set}\" contains itself, or sets within each other too many times")]
    Circular { set: String },
    #[error(
        "\"{set}\" is the name of two sets with different nodes (*NSET, *ELSET or *SURFACE); rename one of them"
    )]
    TwoSets { set: String },
    #[error("the file has no tetrahedra; {advice}")]
    NoTetrahedra { advice: &'static str },
    #[error("set \"{set}\" has a face with nodes {nodes:?} that is not a side of a tetrahedron")]
    LooseFace { set: String, nodes: [u64; 3] },
    #[error("{what} is not supported; {hint}")]
    Unsupported { what: String, hint: &'static str },
    #[error(transparent)]
    Mesh(#[from] MeshError),
}
