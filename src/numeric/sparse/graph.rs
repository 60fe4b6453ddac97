//! Adjacency graph of the nodes of a mesh: nodes that share an element are neighbours.

/// Neighbours of each node, ascending, without the node itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Graph {
    starts: Vec<usize>,
    neighbours: Vec<u32>,
}

impl Graph {
    /// Graph of `count` nodes from the nodes of each element, in any order, restricted to `kept` nodes.
    pub fn of_elements<'a>(
        count: usize,
        elements: impl Iterator<Item = &'a [u32]> + Clone,
        kept: impl Fn(u32) -> bool,
    ) -> Graph {
        // Counts the elements around each node first, to allocate exact sizes.
        let mut around = vec![0usize; count + 1];
        for node in elements.clone().flatten() {
            around[*node as usize + 1] += 1;
        }
        for node in 0..count {
            around[node + 1] += around[node];
        }
        let mut at = around.clone();
        let mut touching = vec![0u32; around[count]];
        for (index, nodes) in (0u32..).zip(elements.clone()) {
            for node in nodes {
                touching[at[*node as usize]] = index;
                at[*node as usize] += 1;
            }
        }
        let elements: Vec<&[u32]> = elements.collect();
        let mut starts = vec![0; count + 1];
        let mut neighbours = Vec::new();
        let mut others = Vec::new();
        for node in 0..count {
            if kept(node as u32) {
                others.clear();
                for element in &touching[around[node]..around[node + 1]] {
                    others.extend_from_slice(elements[*element as usize]);
                }
                others.sort_unstable();
                others.dedup();
                neighbours.extend(others.iter().filter(|o| **o as usize != node && kept(**o)));
            }
            starts[node + 1] = neighbours.len();
        }
        neighbours.shrink_to_fit();
        Graph { starts, neighbours }
    }

    pub fn nodes(&self) -> usize {
        self.starts.len() - 1
    }

    pub fn of(&self, node: u32) -> &[u32] {
        &self.neighbours[self.starts[node as usize]..self.starts[node as usize + 1]]
    }

    /// The graph with the nodes `order[0]`, `order[1]`, … in that order; other nodes are removed.
    pub fn permuted(&self, order: &[u32]) -> Graph {
        let mut place = vec![u32::MAX; self.nodes()];
        for (at, node) in (0u32..).zip(order) {
            place[*node as usize] = at;
        }
        let mut starts = Vec::with_capacity(order.len() + 1);
        starts.push(0);
        let mut neighbours = Vec::with_capacity(self.neighbours.len());
        for node in order {
            let from = neighbours.len();
            let others = self.of(*node).iter().map(|other| place[*other as usize]);
            neighbours.extend(others.filter(|other| *other != u32::MAX));
            neighbours[from..].sort_unstable();
            starts.push(neighbours.len());
        }
        Graph { starts, neighbours }
    }
}
