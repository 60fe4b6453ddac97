//! Renumbering for memory locality: reverse Cuthill–McKee for nodes (George and Liu 1981), elements ordered
//! by their lowest node.

use crate::mesh::tet_mesh::TetMesh;
use crate::mesh::topology::{Lists, node_neighbours};

#[derive(Clone, Debug, PartialEq)]
pub struct Renumbered {
    pub mesh: TetMesh,
    /// New number of each old node.
    pub node: Vec<u32>,
    /// New number of each old element.
    pub element: Vec<u32>,
}

/// Renumbers nodes and elements, including sets.
pub fn reverse_cuthill_mckee(mesh: TetMesh) -> Renumbered {
    let mut mesh = mesh;
    let order = cuthill_mckee(&node_neighbours(&mesh));
    let last = order.len() as u32;
    let mut node = vec![0; order.len()];
    for (position, &old) in order.iter().enumerate() {
        node[old as usize] = last - 1 - position as u32;
    }
    let new_index: Vec<Option<u32>> = node.iter().copied().map(Some).collect();
    mesh.renumber_nodes(&new_index);

    let mut by_node: Vec<u32> = (0..mesh.elements.len() as u32).collect();
    by_node.sort_by_key(|&index| {
        let mut nodes = mesh.elements.nodes(index as usize).to_vec();
        nodes.sort_unstable();
        (nodes, index)
    });
    mesh.elements = mesh.elements.picked(&by_node);
    let mut element = vec![0; by_node.len()];
    for (new, &old) in by_node.iter().enumerate() {
        element[old as usize] = new as u32;
    }
    for set in mesh.element_sets.values_mut() {
        set.iter_mut().for_each(|index| *index = element[*index as usize]);
        set.sort_unstable();
    }
    for set in mesh.surface_sets.values_mut() {
        set.iter_mut().for_each(|face| face.element = element[face.element as usize]);
        set.sort_unstable();
    }
    Renumbered { mesh, node, element }
}

/// Nodes in breadth-first order, neighbours by degree, each connected part from a peripheral node.
fn cuthill_mckee(neighbours: &Lists) -> Vec<u32> {
    let count = neighbours.starts.len() - 1;
    let degree = |node: u32| neighbours.of(node as usize).len();
    let mut by_degree: Vec<u32> = (0..count as u32).collect();
    by_degree.sort_by_key(|&node| (degree(node), node));
    let mut placed = vec![false; count];
    let mut order = Vec::with_capacity(count);
    for start in by_degree {
        if placed[start as usize] {
            continue;
        }
        let mut next = order.len();
        let root = peripheral_node(neighbours, start);
        placed[root as usize] = true;
        order.push(root);
        while next < order.len() {
            let node = order[next];
            next += 1;
            let from = order.len();
            for &other in neighbours.of(node as usize) {
                if !placed[other as usize] {
                    placed[other as usize] = true;
                    order.push(other);
                }
            }
            order[from..].sort_by_key(|&other| (degree(other), other));
        }
    }
    order
}

/// A pseudo-peripheral node: moves to a farthest node until the depth no longer increases.
fn peripheral_node(neighbours: &Lists, start: u32) -> u32 {
    let (mut root, mut greatest) = (start, 0);
    loop {
        let (last_level, depth) = levels(neighbours, root);
        if depth <= greatest {
            return root;
        }
        let least =
            last_level.iter().min_by_key(|&&node| (neighbours.of(node as usize).len(), node));
        (root, greatest) = (*least.unwrap_or(&root), depth);
    }
}

/// Nodes farthest from `root`, and their distance in edges.
fn levels(neighbours: &Lists, root: u32) -> (Vec<u32>, usize) {
    let mut seen = vec![false; neighbours.starts.len() - 1];
    seen[root as usize] = true;
    let (mut level, mut depth) = (vec![root], 0);
    loop {
        let mut next = Vec::new();
        for &node in &level {
            for &other in neighbours.of(node as usize) {
                if !seen[other as usize] {
                    seen[other as usize] = true;
                    next.push(other);
                }
            }
        }
        if next.is_empty() {
            return (level, depth);
        }
        (level, depth) = (next, depth + 1);
    }
}
