//! A mesh of tetrahedra with named sets.

use crate::mesh::error::MeshError;
use crate::mesh::node_order::{SIDES, flip, side_nodes};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Order of the elements: four nodes with straight edges, or ten with a node on each edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    Linear,
    Quadratic,
}

/// Elements by their nodes, in the order of [`node_order`](crate::mesh::node_order).
#[derive(Clone, Debug, PartialEq)]
pub enum Elements {
    Linear(Vec<[u32; 4]>),
    Quadratic(Vec<[u32; 10]>),
}

impl Elements {
    pub fn len(&self) -> usize {
        match self {
            Elements::Linear(list) => list.len(),
            Elements::Quadratic(list) => list.len(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub fn order(&self) -> Order {
        match self {
            Elements::Linear(_) => Order::Linear,
            Elements::Quadratic(_) => Order::Quadratic,
        }
    }

    /// All nodes of element `index`: 4 or 10.
    pub fn nodes(&self, index: usize) -> &[u32] {
        match self {
            Elements::Linear(list) => &list[index],
            Elements::Quadratic(list) => &list[index],
        }
    }

    /// The four corner nodes of element `index`.
    pub fn corners(&self, index: usize) -> [u32; 4] {
        let nodes = self.nodes(index);
        [nodes[0], nodes[1], nodes[2], nodes[3]]
    }

    /// Nodes of all elements, concatenated.
    pub fn all_nodes(&self) -> &[u32] {
        match self {
            Elements::Linear(list) => list.as_flattened(),
            Elements::Quadratic(list) => list.as_flattened(),
        }
    }

    pub(crate) fn all_nodes_mut(&mut self) -> &mut [u32] {
        match self {
            Elements::Linear(list) => list.as_flattened_mut(),
            Elements::Quadratic(list) => list.as_flattened_mut(),
        }
    }

    /// The elements reordered as `order[0]`, `order[1]`, ….
    pub(crate) fn picked(&self, order: &[u32]) -> Elements {
        match self {
            Elements::Linear(list) => {
                Elements::Linear(order.iter().map(|&i| list[i as usize]).collect())
            }
            Elements::Quadratic(list) => {
                Elements::Quadratic(order.iter().map(|&i| list[i as usize]).collect())
            }
        }
    }

    /// Inverts element `index`, which changes the sign of its volume.
    pub(crate) fn flip(&mut self, index: usize) {
        match self {
            Elements::Linear(list) => list[index].swap(1, 2),
            Elements::Quadratic(list) => list[index] = flip(list[index]),
        }
    }
}

/// One side (0…3) of one element, with the corners of [`SIDES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Face {
    pub element: u32,
    pub side: u8,
}

/// A tetrahedral mesh: nodes, elements and named sets of them. Lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub struct TetMesh {
    pub nodes: Vec<[f64; 3]>,
    pub elements: Elements,
    pub node_sets: BTreeMap<String, Vec<u32>>,
    pub element_sets: BTreeMap<String, Vec<u32>>,
    pub surface_sets: BTreeMap<String, Vec<Face>>,
}

impl TetMesh {
    /// Creates a mesh without sets.
    ///
    /// # Errors
    /// [`MeshError::NoElements`], [`MeshError::NodeOutOfRange`] if an element refers to a missing
    /// node, [`MeshError::NotFinite`], [`MeshError::TooLarge`] above 2³² − 1 nodes.
    pub fn new(nodes: Vec<[f64; 3]>, elements: Elements) -> Result<TetMesh, MeshError> {
        if elements.is_empty() {
            return Err(MeshError::NoElements);
        }
        for count in [nodes.len(), elements.len()] {
            if u32::try_from(count).is_err() {
                return Err(MeshError::TooLarge { count });
            }
        }
        if let Some(node) = nodes.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
            return Err(MeshError::NotFinite { node, at: nodes[node] });
        }
        let per_element = elements.nodes(0).len();
        let stranger = elements.all_nodes().iter().position(|&n| n as usize >= nodes.len());
        if let Some(at) = stranger {
            return Err(MeshError::NodeOutOfRange {
                element: at / per_element,
                node: elements.all_nodes()[at],
                count: nodes.len(),
            });
        }
        Ok(TetMesh {
            nodes,
            elements,
            node_sets: BTreeMap::new(),
            element_sets: BTreeMap::new(),
            surface_sets: BTreeMap::new(),
        })
    }

    pub fn order(&self) -> Order {
        self.elements.order()
    }

    pub fn point(&self, node: u32) -> Vector3<f64> {
        Vector3::from(self.nodes[node as usize])
    }

    /// Corner positions of element `index`.
    pub fn corner_points(&self, index: usize) -> [Vector3<f64>; 4] {
        self.elements.corners(index).map(|node| self.point(node))
    }

    /// Corner nodes of a face, anticlockwise from outside.
    pub fn face_corners(&self, face: Face) -> [u32; 3] {
        let corners = self.elements.corners(face.element as usize);
        SIDES[face.side as usize].map(|local| corners[local])
    }

    /// All nodes of a face: three corners, then three mid-side nodes if the mesh has any.
    pub fn face_nodes(&self, face: Face) -> impl Iterator<Item = u32> + '_ {
        let nodes = self.elements.nodes(face.element as usize);
        side_nodes(self.order(), face.side as usize).iter().map(move |&local| nodes[local])
    }

    /// Lowest and highest coordinates.
    pub fn bounding_box(&self) -> ([f64; 3], [f64; 3]) {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for node in &self.nodes {
            for axis in 0..3 {
                low[axis] = low[axis].min(node[axis]);
                high[axis] = high[axis].max(node[axis]);
            }
        }
        (low, high)
    }

    /// Length of the bounding box's diagonal, m.
    pub fn size(&self) -> f64 {
        let (low, high) = self.bounding_box();
        (Vector3::from(high) - Vector3::from(low)).norm()
    }

    /// The mesh with all lengths multiplied by a positive `factor`.
    pub fn scaled(mut self, factor: f64) -> TetMesh {
        for node in &mut self.nodes {
            *node = node.map(|x| x * factor);
        }
        self
    }

    /// # Errors
    /// [`MeshError::NoSuchSet`] with the existing names.
    pub fn node_set(&self, name: &str) -> Result<&[u32], MeshError> {
        named(&self.node_sets, name, "node")
    }

    /// # Errors
    /// [`MeshError::NoSuchSet`] with the existing names.
    pub fn element_set(&self, name: &str) -> Result<&[u32], MeshError> {
        named(&self.element_sets, name, "element")
    }

    /// # Errors
    /// [`MeshError::NoSuchSet`] with the existing names.
    pub fn surface_set(&self, name: &str) -> Result<&[Face], MeshError> {
        named(&self.surface_sets, name, "surface")
    }

    /// Nodes of the given faces, each once, in ascending order.
    pub fn nodes_of_faces(&self, faces: &[Face]) -> Vec<u32> {
        let mut nodes: Vec<u32> = faces.iter().flat_map(|&face| self.face_nodes(face)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

fn named<'m, T>(
    sets: &'m BTreeMap<String, Vec<T>>,
    name: &str,
    kind: &'static str,
) -> Result<&'m [T], MeshError> {
    sets.get(name).map(Vec::as_slice).ok_or_else(|| MeshError::NoSuchSet {
        kind,
        name: name.to_string(),
        known: sets.keys().cloned().collect(),
    })
}
