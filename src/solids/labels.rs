//! Numbers of elements and nodes in messages.

/// Numbers of elements and nodes in the mesh file; empty lists count from 1 in the order of the problem.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Labels {
    /// By element, or empty.
    pub elements: Vec<u64>,
    /// By node, or empty; `None` for a mid-side node that the file does not have.
    pub nodes: Vec<Option<u64>>,
}

impl Labels {
    pub fn element(&self, index: usize) -> u64 {
        self.elements.get(index).copied().unwrap_or(index as u64 + 1)
    }

    pub fn node(&self, index: usize) -> Option<u64> {
        self.nodes.get(index).copied().unwrap_or(Some(index as u64 + 1))
    }

    /// For the renumbered mesh: `element` and `node` are the new numbers of the old ones.
    pub fn renumbered(self, element: &[u32], node: &[u32]) -> Labels {
        let moved = |to: &[u32], from: usize| to[from] as usize;
        let (mut elements, mut nodes) = (self.elements.clone(), self.nodes.clone());
        for (old, label) in self.elements.into_iter().enumerate() {
            elements[moved(element, old)] = label;
        }
        for (old, label) in self.nodes.into_iter().enumerate() {
            nodes[moved(node, old)] = label;
        }
        Labels { elements, nodes }
    }
}

/// Text at the beginning of a message.
pub(crate) fn node_text(label: &Option<u64>) -> String {
    match label {
        Some(number) => format!("node {number}"),
        None => "a node on an edge".to_string(),
    }
}
