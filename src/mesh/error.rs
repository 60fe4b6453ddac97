//! What can be wrong with a mesh, in numbers and places. What can be wrong with a file is
//! [`ReadError`](crate::mesh::read::ReadError).
//!
//! Elements and nodes are counted from 0.

use thiserror::Error;

/// A request that cannot be met.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MeshError {
    #[error(
        "the mesh has no tetrahedra; in Gmsh give the volume a physical group too, or save all elements"
    )]
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
        "set \"{name}\" ({region}) matches nothing: the nearest node is {:e} m away; move the region or widen its tolerance",
        six_digits(*nearest)
    )]
    EmptySet { name: String, region: String, nearest: f64 },
    #[error(
        "set \"{name}\" ({region}) matches nothing: a plane or cylinder selects the surface of the mesh only, and none of its faces lies there ({nodes} nodes do); for nodes inside take a box, `low` and `high`"
    )]
    NoSurfaceThere { name: String, region: String, nodes: usize },
    #[error("{what} = {}{unit} is outside {allowed}", six_digits(*value))]
    Dimension {
        what: &'static str,
        value: f64,
        /// As it follows a number: `" m"`, or nothing.
        unit: &'static str,
        allowed: String,
    },
    #[error(
        "cell {cell} of block {block} is turned inside out: these dimensions leave no room for this mesh"
    )]
    Tangled { block: usize, cell: usize },
    #[error(
        "joining nodes within {tolerance:.5e} m would collapse element {element}, two of whose nodes lie so close; take the element out, or remesh there"
    )]
    Collapsed { element: u64, tolerance: f64 },
    #[error("the mesh has mid-side nodes already")]
    AlreadyQuadratic,
    #[error("field \"{field}\" has {found} values where {expected} are needed")]
    FieldLength { field: String, found: usize, expected: usize },
    #[error("field \"{field}\" holds {value} at index {index}; only finite values can be written")]
    FieldNotFinite { field: String, index: usize, value: f64 },
    #[error("the name {name:?} cannot be written: {why}")]
    Name { name: String, why: &'static str },
}

/// A number to six digits, enough to find a place by.
pub(crate) fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// A place as messages have it: `(0.02, 0, -0.005) m`.
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
        "{count} of {of} elements are inverted or flat (worst: element {element} near {}, volume {volume:.5e} m³); where the whole mesh is turned, the repair `orient` helps",
        place(at)
    )]
    Inverted { count: usize, of: usize, element: u64, at: [f64; 3], volume: f64 },
    #[error(
        "{count} elements have a folded side although their corners are in order (worst: element {element} near {}, least Jacobian {ratio:.5e} of the mean); move the mid-side nodes or refine there",
        place(at)
    )]
    Folded { count: usize, element: u64, at: [f64; 3], ratio: f64 },
    #[error(
        "{count} elements are slivers beyond aspect {limit} (worst: element {element} near {}, aspect {aspect:.4e}); remesh there",
        place(at)
    )]
    Sliver { count: usize, element: u64, at: [f64; 3], aspect: f64, limit: f64 },
    #[error(
        "{count} mid-side nodes lie far from their edges (first: node {node} of element {element}, off by {off:.3} of the edge); is this another program's node order?"
    )]
    MidSide { count: usize, element: u64, node: u64, off: f64 },
    #[error(
        "{count} pairs of nodes share a place within {tolerance:.5e} m (first: {first} and {second} at {}); the repair `merge-duplicates` joins them",
        place(at)
    )]
    DuplicateNodes { count: usize, first: u64, second: u64, at: [f64; 3], tolerance: f64 },
    #[error(
        "{count} nodes belong to no element (first: {first}); the repair `drop-unreferenced` removes them"
    )]
    UnreferencedNodes { count: usize, first: u64 },
    #[error(
        "{count} faces are shared by more than two elements or lie on the same side of two (first: element {element} near {}); elements overlap there",
        place(at)
    )]
    Overlapping { count: usize, element: u64, at: [f64; 3] },
    #[error(
        "the surface is not closed like a solid's: {count} edges are shared by other than two of its faces (first: nodes {first} and {second} near {})",
        place(at)
    )]
    NonManifold { count: usize, first: u64, second: u64, at: [f64; 3] },
    #[error(
        "the mesh encloses {count} cavities (first: {faces} faces near {}, {volume:.5e} m³); elements may be missing there",
        place(at)
    )]
    Cavity { count: usize, faces: usize, at: [f64; 3], volume: f64 },
    #[error(
        "the mesh falls into {count} bodies that share no face (elements {first} and {second}); join them or read them one by one"
    )]
    SeveralBodies { count: usize, first: u64, second: u64 },
    #[error("{kind} set \"{name}\" is empty")]
    EmptySet { kind: &'static str, name: String },
}

impl Fault {
    /// With other numbers of elements and nodes: those of the file that they came from.
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
