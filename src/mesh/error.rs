//! Errors and faults of meshes. Errors of mesh files are [`ReadError`](crate::mesh::read::ReadError).
//!
//! Elements and nodes are counted from 0.

use thiserror::Error;

/// Error of an operation on a mesh.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MeshError {
    #[error("the mesh has no tetrahedra")]
    NoElements,
    #[error("{count} nodes or elements are too many; at most {max} can be numbered", max = u32::MAX)]
    TooLarge { count: usize },
    #[error("node {node} has coordinates that are not finite: {at:?}")]
    NotFinite { node: usize, at: [f64; 3] },
    #[error("element {element} names node {node}, but there are only {count} nodes")]
    NodeOutOfRange { element: usize, node: u32, count: usize },
    #[error("there is no {kind} set \"{name}\"; there are: {}", list(known))]
    NoSuchSet { kind: &'static str, name: String, known: Vec<String> },
    #[error(
        "set \"{name}\" ({region}) matches nothing: the nearest node is {:e} m away; move the region or widen its tolerance",
        six_digits(*nearest)
    )]
    EmptySet { name: String, region: String, nearest: f64 },
    #[error(
        "set \"{name}\" ({region}) matches nothing: a plane or cylinder selects faces of the mesh's surface, and none is there (but {nodes} nodes are); to select nodes inside, use a box, `low` and `high`"
    )]
    NoSurfaceThere { name: String, region: String, nodes: usize },
    #[error("{what} = {}{unit} is out of range. Allowed: {allowed}", six_digits(*value))]
    Dimension {
        what: &'static str,
        value: f64,
        /// Unit with a leading space, `" m"`, or empty.
        unit: &'static str,
        allowed: String,
    },
    #[error(
        "cell {cell} of block {block} is inverted; change the dimensions or the numbers of cells"
    )]
    InvertedCell { block: usize, cell: usize },
    #[error(
        "merging nodes within {tolerance:.5e} m would collapse element {element}, which has two nodes that close; remove the element, or remesh there"
    )]
    Collapsed { element: u64, tolerance: f64 },
    #[error("the mesh already has mid-side nodes")]
    AlreadyQuadratic,
    #[error("field \"{field}\" has {found} values, but {expected} are needed")]
    FieldLength { field: String, found: usize, expected: usize },
    #[error(
        "field \"{field}\" has the value {value} at index {index}; only finite values can be written"
    )]
    FieldNotFinite { field: String, index: usize, value: f64 },
    #[error("the name {name:?} cannot be written: {why}")]
    Name { name: String, why: &'static str },
}

/// Rounds a number to six digits, for messages.
pub(crate) fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Formats a point for messages: `(0.02, 0, -0.005) m`.
pub(crate) fn place(at: &[f64; 3]) -> String {
    let [x, y, z] = at.map(six_digits);
    format!("({x}, {y}, {z}) m")
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".to_string() } else { names.join(", ") }
}

/// A defect of a mesh found by [`check`](crate::mesh::check::check). Elements and nodes are counted
/// from 0, or have the numbers of a file after [`Fault::renumbered`].
#[derive(Clone, Debug, Error, PartialEq)]
pub enum Fault {
    #[error(
        "{count} of {of} elements are inverted or flat (worst: element {element} near {}, volume {volume:.5e} m³); if all elements are inverted, use the repair `orient`",
        place(at)
    )]
    Inverted { count: usize, of: usize, element: u64, at: [f64; 3], volume: f64 },
    #[error(
        "{count} elements are folded by their mid-side nodes (worst: element {element} near {}, least Jacobian {ratio:.5e} of the mean); move the mid-side nodes or refine there",
        place(at)
    )]
    Folded { count: usize, element: u64, at: [f64; 3], ratio: f64 },
    #[error(
        "{count} elements are slivers with an aspect ratio above {limit} (worst: element {element} near {}, aspect ratio {aspect:.4e}); remesh there",
        place(at)
    )]
    Sliver { count: usize, element: u64, at: [f64; 3], aspect: f64, limit: f64 },
    #[error(
        "{count} mid-side nodes are far from their edges (first: node {node} of element {element}, off by {off:.3} of the edge); is the node order that of another program?"
    )]
    MidSide { count: usize, element: u64, node: u64, off: f64 },
    #[error(
        "{count} pairs of nodes coincide within {tolerance:.5e} m (first: {first} and {second} at {}); the repair `merge-duplicates` merges them",
        place(at)
    )]
    DuplicateNodes { count: usize, first: u64, second: u64, at: [f64; 3], tolerance: f64 },
    #[error(
        "{count} nodes belong to no element (first: {first}); the repair `drop-unreferenced` removes them"
    )]
    UnreferencedNodes { count: usize, first: u64 },
    #[error(
        "{count} faces are shared by more than two elements or by two elements on the same side (first: element {element} near {}); elements overlap there",
        place(at)
    )]
    Overlapping { count: usize, element: u64, at: [f64; 3] },
    #[error(
        "the surface is not that of a solid: {count} edges do not belong to exactly two of its faces (first: nodes {first} and {second} near {})",
        place(at)
    )]
    NonManifold { count: usize, first: u64, second: u64, at: [f64; 3] },
    #[error(
        "the mesh encloses {count} cavities (first: {faces} faces near {}, {volume:.5e} m³); elements may be missing there",
        place(at)
    )]
    Cavity { count: usize, faces: usize, at: [f64; 3], volume: f64 },
    #[error(
        "the mesh consists of {count} bodies that share no face (elements {first} and {second}); join them or use one mesh for each"
    )]
    SeveralBodies { count: usize, first: u64, second: u64 },
    #[error("{kind} set \"{name}\" is empty")]
    EmptySet { kind: &'static str, name: String },
}

impl Fault {
    /// The fault with the element and node numbers of the file.
    pub fn renumbered(
        mut self,
        element_number: impl Fn(u64) -> u64,
        node_number: impl Fn(u64) -> u64,
    ) -> Fault {
        match &mut self {
            Fault::Inverted { element, .. }
            | Fault::Folded { element, .. }
            | Fault::Sliver { element, .. }
            | Fault::Overlapping { element, .. } => *element = element_number(*element),
            Fault::MidSide { element, node, .. } => {
                (*element, *node) = (element_number(*element), node_number(*node));
            }
            Fault::DuplicateNodes { first, second, .. }
            | Fault::NonManifold { first, second, .. } => {
                (*first, *second) = (node_number(*first), node_number(*second));
            }
            Fault::UnreferencedNodes { first, .. } => *first = node_number(*first),
            Fault::SeveralBodies { first, second, .. } => {
                (*first, *second) = (element_number(*first), element_number(*second));
            }
            Fault::Cavity { .. } | Fault::EmptySet { .. } => {}
        }
        self
    }
}
