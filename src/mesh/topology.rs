//! Topology of a mesh: the surface, neighbours of nodes, connected parts.

use crate::mesh::tet_mesh::{Face, TetMesh};

/// Every face of the mesh with its sorted corners, ordered by these; a face between two elements
/// occurs twice in a row.
pub fn sorted_faces(mesh: &TetMesh) -> Vec<([u32; 3], Face)> {
    let mut faces = Vec::with_capacity(4 * mesh.elements.len());
    for element in 0..mesh.elements.len() as u32 {
        for side in 0..4 {
            let face = Face { element, side };
            let mut key = mesh.face_corners(face);
            key.sort_unstable();
            faces.push((key, face));
        }
    }
    faces.sort_unstable();
    faces
}

/// Boundary faces, which belong to one element only, in the order of elements and sides.
pub fn surface(mesh: &TetMesh) -> Vec<Face> {
    let faces = sorted_faces(mesh);
    let mut free: Vec<Face> = faces
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|owners| owners.len() == 1)
        .map(|owners| owners[0].1)
        .collect();
    free.sort_unstable();
    free
}

/// Concatenated lists of different lengths: list i is `items[starts[i]..starts[i + 1]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Lists {
    pub starts: Vec<usize>,
    pub items: Vec<u32>,
}

impl Lists {
    pub fn of(&self, index: usize) -> &[u32] {
        &self.items[self.starts[index]..self.starts[index + 1]]
    }

    /// Sorts pairs (list, item) into lists without duplicates.
    fn from_pairs(mut pairs: Vec<(u32, u32)>, lists: usize) -> Lists {
        pairs.sort_unstable();
        pairs.dedup();
        let mut starts = vec![0; lists + 1];
        for &(list, _) in &pairs {
            starts[list as usize + 1] += 1;
        }
        for i in 0..lists {
            starts[i + 1] += starts[i];
        }
        Lists { starts, items: pairs.into_iter().map(|(_, item)| item).collect() }
    }
}

/// Neighbours of each node: the other nodes of its elements, ascending.
pub fn node_neighbours(mesh: &TetMesh) -> Lists {
    let mut pairs = Vec::new();
    for element in 0..mesh.elements.len() {
        let nodes = mesh.elements.nodes(element);
        for &a in nodes {
            pairs.extend(nodes.iter().filter(|&&b| b != a).map(|&b| (a, b)));
        }
    }
    Lists::from_pairs(pairs, mesh.nodes.len())
}

/// Disjoint sets (union-find).
pub(crate) struct Union(Vec<u32>);

impl Union {
    pub(crate) fn new(count: usize) -> Union {
        Union((0..count as u32).collect())
    }

    pub(crate) fn root(&mut self, mut of: u32) -> u32 {
        while self.0[of as usize] != of {
            let parent = self.0[of as usize];
            self.0[of as usize] = self.0[parent as usize];
            of = parent;
        }
        of
    }

    /// Joins two sets. The smaller root remains, so that results do not depend on the order of joins.
    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
