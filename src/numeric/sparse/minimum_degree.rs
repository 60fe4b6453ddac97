//! Elimination order by approximate minimum degree (faer).

use crate::numeric::sparse::graph::Graph;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// Nodes in elimination order.
pub fn minimum_degree(graph: &Graph) -> Vec<u32> {
    let count = graph.nodes();
    let mut starts = Vec::with_capacity(count + 1);
    starts.push(0usize);
    let mut rows = Vec::new();
    for node in 0..count as u32 {
        rows.extend(graph.of(node).iter().filter(|other| **other < node).map(|o| *o as usize));
        rows.push(node as usize);
        starts.push(rows.len());
    }
    let upper = SymbolicSparseColMatRef::new_checked(count, count, &starts, None, &rows);
    let (mut forward, mut inverse) = (vec![0usize; count], vec![0usize; count]);
    let mut memory = MemBuffer::new(amd::order_maybe_unsorted_scratch::<usize>(count, rows.len()));
    let found = amd::order_maybe_unsorted(
        &mut forward,
        &mut inverse,
        upper,
        amd::Control::default(),
        MemStack::new(&mut memory),
    );
    match found {
        Ok(_) => forward.into_iter().map(|node| node as u32).collect(),
        // Fails only on index overflow, which cannot occur with u32 nodes in a usize; any order is valid.
        Err(_) => (0..count as u32).collect(),
    }
}
