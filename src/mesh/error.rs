//! What can be wrong with a mesh, in numbers and places. What can be wrong with a file is
//! [`ReadError`](crate::mesh::read::ReadError).
//!
//! Elements and nodes are counted from 0.

use thiserror::Error;

/// A request that cannot be met.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MeshError {
    #[error("the mesh has no tetrahedra")]
    NoElements,
    #[error("{count} nodes or elements are more than the {max} that can be numbered", max = u32::MAX)]
    TooLarge { count: usize },
    #[error("node {node} is not at a finite place: {at:?}")]
    NotFinite { node: usize, at: [f64; 3] },
    #[error("element {element} names node {node}, but there are only {count} nodes")]
    NodeOutOfRange { element: usize, node: u32, count: usize },
    #[error("no {kind} set is called \"{name}\"; there are: {}", list(known))]
    NoSuchSet { kind: &'static str, name: String, known: Vec<String> },
    #[error(
        "set \"{name}\" ({region}) matches nothing: the nearest node is {nearest:e} m away; move the region or widen its tolerance"
    )]
    EmptySet { name: String, region: String, nearest: f64 },
    #[error("{what} = {value} is outside {allowed}")]
    Dimension { what: &'static str, value: f64, allowed: String },
    #[error(
        "cell {cell} of block {block} is turned inside out: these dimensions leave no room for this mesh"
    )]
    Tangled { block: usize, cell: usize },
    #[error("the mesh has mid-side nodes already")]
    AlreadyQuadratic,
    #[error("field \"{field}\" has {found} values where {expected} are needed")]
    FieldLength { field: String, found: usize, expected: usize },
    #[error("field \"{field}\" holds {value} at index {index}; only finite values can be written")]
    FieldNotFinite { field: String, index: usize, value: f64 },
    #[error("the name {name:?} cannot be written: {why}")]
    Name { name: String, why: &'static str },
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".to_string() } else { names.join(", ") }
}

/// A defect of a mesh found by [`check`](crate::mesh::check::check).
#[derive(Clone, Debug, Error, PartialEq)]
pub enum Fault {
    #[error(
        "{count} of {of} elements are inverted or flat (worst: element {element} near {at:?}, volume {volume:e} m³); where the whole mesh is turned, the repair `orient` helps"
    )]
    Inverted { count: usize, of: usize, element: u32, at: [f64; 3], volume: f64 },
    #[error(
        "{count} elements have a folded side although their corners are in order (worst: element {element} near {at:?}, least Jacobian {ratio:e} of the mean); move the mid-side nodes or refine there"
    )]
    Folded { count: usize, element: u32, at: [f64; 3], ratio: f64 },
    #[error(
        "{count} elements are slivers beyond aspect {limit} (worst: element {element} near {at:?}, aspect {aspect:.4e}); remesh there"
    )]
    Sliver { count: usize, element: u32, at: [f64; 3], aspect: f64, limit: f64 },
    #[error(
        "{count} mid-side nodes lie far from their edges (first: node {node} of element {element}, off by {off:.3} of the edge); is this another program's node order?"
    )]
    MidSide { count: usize, element: u32, node: u32, off: f64 },
    #[error(
        "{count} pairs of nodes share a place within {tolerance:e} m (first: {first} and {second} at {at:?}); the repair `merge_duplicates` joins them"
    )]
    DuplicateNodes { count: usize, first: u32, second: u32, at: [f64; 3], tolerance: f64 },
    #[error(
        "{count} nodes belong to no element (first: {first}); the repair `drop_unreferenced` removes them"
    )]
    UnreferencedNodes { count: usize, first: u32 },
    #[error(
        "{count} faces are shared by more than two elements or lie on the same side of two (first: element {element} near {at:?}); elements overlap there"
    )]
    Overlapping { count: usize, element: u32, at: [f64; 3] },
    #[error(
        "the surface is not closed like a solid's: {count} edges are shared by other than two of its faces (first: nodes {first} and {second} near {at:?})"
    )]
    NonManifold { count: usize, first: u32, second: u32, at: [f64; 3] },
    #[error(
        "the mesh encloses {count} cavities (first: {faces} faces near {at:?}, {volume:e} m³); elements may be missing there"
    )]
    Cavity { count: usize, faces: usize, at: [f64; 3], volume: f64 },
    #[error(
        "the mesh falls into {count} bodies that share no face (elements {first} and {second}); join them or read them one by one"
    )]
    SeveralBodies { count: usize, first: u32, second: u32 },
    #[error("{kind} set \"{name}\" is empty")]
    EmptySet { kind: &'static str, name: String },
}
