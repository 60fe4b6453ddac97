//! Repairs of meshes, each done only on request and reported.

use crate::mesh::error::MeshError;
use crate::mesh::measure::straight_volume;
use crate::mesh::tet_mesh::TetMesh;
use std::collections::HashMap;

/// Requested repairs; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Repair {
    /// Reorient inverted elements.
    pub orient: bool,
    /// Merge nodes closer than this distance, m.
    pub merge_duplicates: Option<f64>,
    /// Remove nodes that belong to no element.
    pub drop_unreferenced: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repaired {
    pub turned_elements: usize,
    pub merged_nodes: usize,
    pub dropped_nodes: usize,
}

/// Repairs a mesh in the order merge, reorient, remove.
///
/// # Errors
/// [`MeshError::Collapsed`] if merging would join two nodes of one element.
pub fn repair(mesh: TetMesh, wanted: &Repair) -> Result<(TetMesh, Repaired), MeshError> {
    let mut mesh = mesh;
    let mut done = Repaired::default();
    if let Some(tolerance) = wanted.merge_duplicates {
        done.merged_nodes = merge(&mut mesh, tolerance)?;
    }
    if wanted.orient {
        done.turned_elements = orient(&mut mesh);
    }
    if wanted.drop_unreferenced {
        done.dropped_nodes = drop_unreferenced(&mut mesh);
    }
    Ok((mesh, done))
}

/// First node within `tolerance` of each node; the node itself if there is none before it.
///
/// Space is divided into cells, and only cells within the tolerance are searched.
pub fn coincident_nodes(nodes: &[[f64; 3]], tolerance: f64) -> Vec<u32> {
    let cell = if tolerance > 0.0 { 8.0 * tolerance } else { f64::MIN_POSITIVE };
    let index = |x: f64| (x / cell).floor() as i64;
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut first_at = Vec::with_capacity(nodes.len());
    for (node, place) in nodes.iter().enumerate() {
        let range = |axis: usize| index(place[axis] - tolerance)..=index(place[axis] + tolerance);
        let mut found: Option<u32> = None;
        for i in range(0) {
            for j in range(1) {
                for k in range(2) {
                    for &other in cells.get(&[i, j, k]).into_iter().flatten() {
                        let there = nodes[other as usize];
                        let near = (0..3).map(|a| (there[a] - place[a]) * (there[a] - place[a]));
                        if near.sum::<f64>() <= tolerance * tolerance {
                            found = Some(found.map_or(other, |best: u32| best.min(other)));
                        }
                    }
                }
            }
        }
        first_at.push(found.unwrap_or(node as u32));
        if found.is_none() {
            cells.entry(place.map(index)).or_default().push(node as u32);
        }
    }
    first_at
}

fn merge(mesh: &mut TetMesh, tolerance: f64) -> Result<usize, MeshError> {
    let first_at = coincident_nodes(&mesh.nodes, tolerance);
    for node in mesh.elements.all_nodes_mut() {
        *node = first_at[*node as usize];
    }
    for set in mesh.node_sets.values_mut() {
        set.iter_mut().for_each(|node| *node = first_at[*node as usize]);
        set.sort_unstable();
        set.dedup();
    }
    let collapsed = (0..mesh.elements.len()).find(|&element| {
        let nodes = mesh.elements.nodes(element);
        (1..nodes.len()).any(|i| nodes[..i].contains(&nodes[i]))
    });
    if let Some(element) = collapsed {
        return Err(MeshError::Collapsed { element: element as u64, tolerance });
    }
    Ok(keep_nodes(mesh, |node| first_at[node] == node as u32))
}

fn orient(mesh: &mut TetMesh) -> usize {
    let turned: Vec<bool> = (0..mesh.elements.len())
        .map(|index| straight_volume(mesh.corner_points(index)) < 0.0)
        .collect();
    for index in (0..turned.len()).filter(|&index| turned[index]) {
        mesh.elements.flip(index);
    }
    // Corners 1 and 2 are swapped, and with them sides {0, 1, 3} and {0, 2, 3}.
    for face in mesh.surface_sets.values_mut().flatten() {
        if turned[face.element as usize] {
            face.side = [0, 3, 2, 1][face.side as usize];
        }
    }
    turned.into_iter().filter(|&turned| turned).count()
}

fn drop_unreferenced(mesh: &mut TetMesh) -> usize {
    let mut used = vec![false; mesh.nodes.len()];
    for &node in mesh.elements.all_nodes() {
        used[node as usize] = true;
    }
    keep_nodes(mesh, |node| used[node])
}

/// Removes the other nodes and closes the gaps in the numbers; returns the number of removed nodes.
fn keep_nodes(mesh: &mut TetMesh, keep: impl Fn(usize) -> bool) -> usize {
    let before = mesh.nodes.len();
    let mut next = 0;
    let mut number = |node: usize| {
        keep(node).then(|| {
            next += 1;
            next - 1
        })
    };
    let new_index: Vec<Option<u32>> = (0..before).map(&mut number).collect();
    mesh.renumber_nodes(&new_index);
    before - mesh.nodes.len()
}

impl TetMesh {
    /// Renumbers node i to `new_index[i]`; nodes without a new number are removed, also from sets. No
    /// element may use them, and the new numbers must be 0, 1, … without gaps.
    pub(crate) fn renumber_nodes(&mut self, new_index: &[Option<u32>]) {
        let count = new_index.iter().flatten().count();
        let mut nodes = vec![[0.0; 3]; count];
        for (old, new) in new_index.iter().enumerate() {
            if let Some(new) = new {
                nodes[*new as usize] = self.nodes[old];
            }
        }
        self.nodes = nodes;
        for node in self.elements.all_nodes_mut() {
            *node = new_index[*node as usize].unwrap_or(*node);
        }
        for set in self.node_sets.values_mut() {
            *set = set.iter().filter_map(|&node| new_index[node as usize]).collect();
            set.sort_unstable();
        }
    }
}
