//! Symbolic Cholesky factorisation of the stiffness of a mesh.
//!
//! Elimination works on nodes; each has up to three unknowns with the same neighbours. Columns of the factor with the
//! same rows form one dense block (a supernode); wide blocks are divided into panels.

use crate::numeric::sparse::graph::Graph;
use std::ops::Range;

/// Maximum number of unknowns in a panel, enough for dense products to run at full speed. Narrower panels store less of
/// the empty upper triangle of the diagonal blocks.
const PANEL: usize = 128;
/// Two supernodes are merged if the result has at most this many unknowns and this fraction of zeros.
const MERGE: [(usize, f64); 4] = [(8, 1.0), (24, 0.5), (72, 0.1), (usize::MAX, 0.05)];

const NONE: u32 = u32::MAX;

/// Adjacent columns of the factor as one dense block with all their rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// First unknown.
    pub first: usize,
    pub columns: usize,
    /// Rows just below the diagonal block that belong to the same supernode.
    pub inner: usize,
    /// The other rows, in [`Elimination::rows`].
    pub outer: Range<usize>,
    /// Index of the first value in the factor.
    pub values: usize,
}

impl Panel {
    /// Total number of rows, including those of the diagonal block.
    pub fn height(&self) -> usize {
        self.columns + self.inner + self.outer.len()
    }

    pub fn stored(&self) -> usize {
        self.height() * self.columns
    }

    /// Multiply–add operations caused by the panel's columns: for each column, the square of the number of rows from
    /// the diagonal on.
    pub fn operations(&self) -> f64 {
        (0..self.columns).map(|column| ((self.height() - column) as f64).powi(2)).sum()
    }
}

/// Structure of a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Elimination {
    pub panels: Vec<Panel>,
    /// Row unknowns below the supernodes, ascending for each.
    pub rows: Vec<u32>,
    /// Number of values stored in the factor.
    pub fill: usize,
    /// Multiply–add operations of a factorisation.
    pub operations: f64,
    /// Largest update product between two panels, values.
    pub most_products: usize,
    pub unknowns: usize,
}

/// Structure of a factor and its elimination order.
pub struct Ordered {
    pub order: Vec<u32>,
    pub elimination: Elimination,
}

/// Symbolic factorisation of the nodes in `order`, each with `weight` unknowns. Nodes of one supernode are made
/// adjacent, which does not change the fill.
pub fn analyse(graph: &Graph, order: &[u32], weight: impl Fn(u32) -> usize) -> Ordered {
    let permuted = graph.permuted(order);
    let weights: Vec<usize> = order.iter().map(|node| weight(*node)).collect();
    let parent = tree(&permuted);
    let counts = column_counts(&permuted, &parent, &weights);
    let post = postorder(&parent, &counts);
    let order: Vec<u32> = post.iter().map(|at| order[*at as usize]).collect();
    let mut place = vec![0u32; post.len()];
    for (at, old) in (0u32..).zip(&post) {
        place[*old as usize] = at;
    }
    let parent: Vec<u32> = post
        .iter()
        .map(|old| match parent[*old as usize] {
            NONE => NONE,
            parent => place[parent as usize],
        })
        .collect();
    let counts: Vec<usize> = post.iter().map(|old| counts[*old as usize]).collect();
    let weights: Vec<usize> = post.iter().map(|old| weights[*old as usize]).collect();
    let permuted = graph.permuted(&order);
    let bounds = supernodes(&parent, &counts, &weights);
    let elimination = structure(&permuted, &parent, &weights, &bounds);
    Ordered { order, elimination }
}

/// Parent of each node in the elimination tree: the first later node in its column of the factor.
fn tree(graph: &Graph) -> Vec<u32> {
    let count = graph.nodes();
    let mut parent = vec![NONE; count];
    let mut ancestor = vec![NONE; count];
    for node in 0..count as u32 {
        for other in graph.of(node).iter().take_while(|other| **other < node) {
            let mut at = *other;
            loop {
                let above = std::mem::replace(&mut ancestor[at as usize], node);
                if above == node {
                    break;
                }
                if above == NONE {
                    parent[at as usize] = node;
                    break;
                }
                at = above;
            }
        }
    }
    parent
}

/// Number of unknowns in the first column of each node, including its own.
fn column_counts(graph: &Graph, parent: &[u32], weights: &[usize]) -> Vec<usize> {
    let mut counts = weights.to_vec();
    let mut seen = vec![NONE; weights.len()];
    for node in 0..weights.len() as u32 {
        seen[node as usize] = node;
        for other in graph.of(node).iter().take_while(|other| **other < node) {
            let mut at = *other;
            while seen[at as usize] != node {
                seen[at as usize] = node;
                counts[at as usize] += weights[node as usize];
                at = parent[at as usize];
            }
        }
    }
    counts
}

/// Children before parents, the longest child last, because it can be merged with its parent.
fn postorder(parent: &[u32], counts: &[usize]) -> Vec<u32> {
    let count = parent.len();
    let mut by_length: Vec<u32> = (0..count as u32).collect();
    by_length.sort_by_key(|node| counts[*node as usize]);
    let (mut first, mut next) = (vec![NONE; count], vec![NONE; count]);
    let mut roots = Vec::new();
    // Each child is inserted at the front, so that the longest one is first.
    for node in by_length {
        match parent[node as usize] {
            NONE => roots.push(node),
            parent => {
                next[node as usize] = first[parent as usize];
                first[parent as usize] = node;
            }
        }
    }
    // Reverse postorder: parents before children, longest first.
    let mut reversed = Vec::with_capacity(count);
    let mut stack = Vec::new();
    for root in roots {
        stack.push(root);
        while let Some(node) = stack.pop() {
            reversed.push(node);
            let from = stack.len();
            let mut child = first[node as usize];
            while child != NONE {
                stack.push(child);
                child = next[child as usize];
            }
            stack[from..].reverse();
        }
    }
    reversed.reverse();
    reversed
}

/// Adjacent nodes in one dense block.
struct Supernode {
    first: usize,
    columns: usize,
    /// Number of rows below its columns.
    below: usize,
    /// Number of stored zeros.
    zeros: usize,
}

/// First node of each supernode, and the number of nodes at the end. Nodes with one pattern are grouped first; then
/// children are merged with parents if few zeros are stored, because short columns are slow.
fn supernodes(parent: &[u32], counts: &[usize], weights: &[usize]) -> Vec<usize> {
    let mut exact: Vec<Supernode> = Vec::new();
    for node in 0..parent.len() {
        let (columns, below) = (weights[node], counts[node] - weights[node]);
        match exact.last_mut() {
            Some(s) if parent[node - 1] as usize == node && s.below == columns + below => {
                (s.columns, s.below) = (s.columns + columns, below);
            }
            _ => exact.push(Supernode { first: node, columns, below, zeros: 0 }),
        }
    }
    let ends: Vec<usize> = exact.iter().skip(1).map(|s| s.first).chain([parent.len()]).collect();
    let mut merged: Vec<Supernode> = Vec::new();
    for (mut newest, end) in exact.into_iter().zip(ends) {
        while let Some(child) = merged.last() {
            let above = parent[newest.first - 1];
            if !(newest.first..end).contains(&(above as usize)) {
                break;
            }
            let columns = child.columns + newest.columns;
            let new_zeros = (newest.columns + newest.below - child.below) * child.columns;
            let zeros = child.zeros + newest.zeros + new_zeros;
            let stored = (columns * (columns + 1) / 2 + newest.below * columns) as f64;
            let bearable =
                |(most, part): &(usize, f64)| columns <= *most && zeros as f64 <= part * stored;
            if new_zeros > 0 && !MERGE.iter().any(bearable) {
                break;
            }
            newest = Supernode { first: child.first, columns, below: newest.below, zeros };
            merged.pop();
        }
        merged.push(newest);
    }
    merged.iter().map(|one| one.first).chain([parent.len()]).collect()
}

fn structure(graph: &Graph, parent: &[u32], weights: &[usize], bounds: &[usize]) -> Elimination {
    let count = weights.len();
    let mut first_unknown = Vec::with_capacity(count + 1);
    first_unknown.push(0);
    for weight in weights {
        first_unknown.push(first_unknown[first_unknown.len() - 1] + weight);
    }
    let supernodes = bounds.len() - 1;
    let mut of_node = vec![0u32; count];
    for s in 0..supernodes {
        of_node[bounds[s]..bounds[s + 1]].fill(s as u32);
    }
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); supernodes];
    let mut below: Vec<Vec<u32>> = vec![Vec::new(); supernodes];
    let mut seen = vec![NONE; count];
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    let (mut fill, mut operations) = (0usize, 0.0);
    for s in 0..supernodes {
        let nodes = bounds[s]..bounds[s + 1];
        let mut found = Vec::new();
        let mut take = |node: u32, found: &mut Vec<u32>| {
            if node as usize >= nodes.end && seen[node as usize] != s as u32 {
                seen[node as usize] = s as u32;
                found.push(node);
            }
        };
        for node in nodes.clone() {
            graph.of(node as u32).iter().for_each(|other| take(*other, &mut found));
        }
        for child in std::mem::take(&mut children[s]) {
            let of_child = std::mem::take(&mut below[child as usize]);
            of_child.iter().for_each(|other| take(*other, &mut found));
        }
        found.sort_unstable();
        if parent[nodes.end - 1] != NONE {
            children[of_node[parent[nodes.end - 1] as usize] as usize].push(s as u32);
        }
        let outer_start = rows.len();
        for node in &found {
            let node = *node as usize;
            rows.extend((first_unknown[node] as u32)..(first_unknown[node + 1] as u32));
        }
        below[s] = found;
        let outer = outer_start..rows.len();
        let (from, to) = (first_unknown[nodes.start], first_unknown[nodes.end]);
        let parts = (to - from).div_ceil(PANEL).max(1);
        let mut first = from;
        for part in 0..parts {
            let end = from + (to - from) * (part + 1) / parts;
            let panel = Panel {
                first,
                columns: end - first,
                inner: to - end,
                outer: outer.clone(),
                values: fill,
            };
            fill += panel.stored();
            operations += panel.operations();
            panels.push(panel);
            first = end;
        }
    }
    rows.shrink_to_fit();
    let unknowns = first_unknown[count];
    let most_products = most_products(&panels, &rows, unknowns);
    Elimination { panels, rows, fill, operations, most_products, unknowns }
}

/// Maximum over all pairs of panels of the remaining rows times the rows within one panel.
fn most_products(panels: &[Panel], rows: &[u32], unknowns: usize) -> usize {
    let mut owner = vec![0u32; unknowns];
    for (index, panel) in (0u32..).zip(panels) {
        owner[panel.first..panel.first + panel.columns].fill(index);
    }
    let mut most = 0;
    for panel in panels {
        let outer = &rows[panel.outer.clone()];
        let mut done = 0;
        for within in outer.chunk_by(|a, b| owner[*a as usize] == owner[*b as usize]) {
            most = most.max((outer.len() - done) * within.len());
            done += within.len();
        }
    }
    most
}
