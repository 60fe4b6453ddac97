//! Elimination order by nested dissection: each part is divided by a small separator, which is eliminated last (A.
//! George, SIAM J. Numer. Anal. 10 (1973) 345).
//!
//! The separator is searched around the middle of the part along a principal axis of its nodes' positions; a smallest
//! separator of this band is found exactly, see [`crate::numeric::sparse::separator`].

use crate::kinematics::vec3::{Vec3, dot};
use crate::numeric::sparse::graph::Graph;
use crate::numeric::sparse::minimum_degree::minimum_degree;
use crate::numeric::sparse::separator::{Cut, Side, smallest_cuts};
use nalgebra::{Matrix3, SymmetricEigen};

/// Largest part that is ordered by minimum degree instead, nodes.
const LEAF: usize = 60;
/// Fraction of the nodes on each side of the middle in which separators are searched.
const BAND: f64 = 0.12;
/// Axes are tried if their plain cut through the middle exceeds the smallest one by at most this factor.
const MAX_CUT_RATIO: f64 = 1.25;

/// Nodes in elimination order.
pub fn nested_dissection(graph: &Graph, places: &[Vec3]) -> Vec<u32> {
    let count = graph.nodes();
    let mut dissection = Dissection {
        graph,
        places,
        side: vec![Side::Outside; count],
        index: vec![0; count],
        order: Vec::with_capacity(count),
    };
    // Parts still to be ordered, last in first out; a separator is below its two parts.
    let mut waiting = vec![Part::Body((0..count as u32).collect())];
    while let Some(part) = waiting.pop() {
        match part {
            Part::Separator(nodes) => dissection.order.extend(nodes),
            Part::Body(nodes) if nodes.len() <= LEAF => dissection.leaf(nodes),
            Part::Body(nodes) => match dissection.cut(&nodes) {
                Some(cut) => {
                    waiting.push(Part::Separator(cut.separator));
                    waiting.push(Part::Body(cut.high));
                    waiting.push(Part::Body(cut.low));
                }
                None => dissection.leaf(nodes),
            },
        }
    }
    dissection.order
}

enum Part {
    Body(Vec<u32>),
    Separator(Vec<u32>),
}

struct Dissection<'a> {
    graph: &'a Graph,
    places: &'a [Vec3],
    side: Vec<Side>,
    index: Vec<u32>,
    order: Vec<u32>,
}

impl Dissection<'_> {
    fn leaf(&mut self, nodes: Vec<u32>) {
        let local = minimum_degree(&self.graph.permuted(&nodes));
        self.order.extend(local.iter().map(|at| nodes[*at as usize]));
    }

    /// Cheapest of several cuts; `None` if no cut leaves two parts.
    fn cut(&mut self, nodes: &[u32]) -> Option<Cut> {
        let mut best: Option<(f64, Cut)> = None;
        let mut tries: Vec<(usize, Vec<u32>)> = principal_axes(self.places, nodes)
            .iter()
            .map(|axis| {
                let sorted = sorted_along(self.places, nodes, *axis);
                (self.plain_size(&sorted), sorted)
            })
            .collect();
        tries.sort_by_key(|(size, _)| *size);
        let limit = MAX_CUT_RATIO * tries[0].0 as f64;
        for (_, sorted) in tries.iter().filter(|(size, _)| *size as f64 <= limit) {
            for cut in self.cuts_about(sorted) {
                let (low, high) = (cut.low.len() as f64, cut.high.len() as f64);
                if low * high == 0.0 {
                    continue;
                }
                // Cost increases with the separator and with the imbalance of the parts.
                let uneven = (low + high).powi(2) / (4.0 * low * high);
                let cost = cut.separator.len() as f64 * uneven;
                if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                    best = Some((cost, cut));
                }
            }
        }
        for node in nodes {
            self.side[*node as usize] = Side::Outside;
        }
        best.map(|(_, cut)| cut)
    }

    /// Number of nodes in the lower half adjacent to the upper half.
    fn plain_size(&mut self, sorted: &[u32]) -> usize {
        let (low, high) = sorted.split_at(sorted.len() / 2);
        low.iter().for_each(|node| self.side[*node as usize] = Side::Low);
        high.iter().for_each(|node| self.side[*node as usize] = Side::High);
        let touches = |node: &&u32| {
            self.graph.of(**node).iter().any(|o| self.side[*o as usize] == Side::High)
        };
        low.iter().filter(touches).count()
    }

    fn cuts_about(&mut self, sorted: &[u32]) -> [Cut; 2] {
        let count = sorted.len();
        let half = ((BAND * count as f64) as usize).max(1);
        let (from, to) = (count / 2 - half, (count / 2 + half).min(count - 1));
        for (at, node) in sorted.iter().enumerate() {
            self.side[*node as usize] = match at {
                at if at < from => Side::Low,
                at if at < to => Side::Band,
                _ => Side::High,
            };
        }
        // Nodes of the low side that are adjacent to the high side across the band are added to the band.
        let mut middle: Vec<u32> = sorted[from..to].to_vec();
        for node in &sorted[..from] {
            let across = |other: &u32| self.side[*other as usize] == Side::High;
            if self.graph.of(*node).iter().any(across) {
                self.side[*node as usize] = Side::Band;
                middle.push(*node);
            }
        }
        for (at, node) in (0u32..).zip(&middle) {
            self.index[*node as usize] = at;
        }
        let mut cuts = smallest_cuts(self.graph, &self.side, &self.index, &middle);
        for cut in &mut cuts {
            cut.low.extend(sorted[..from].iter().filter(|n| self.side[**n as usize] == Side::Low));
            cut.high.extend(&sorted[to..]);
        }
        cuts
    }
}

/// Principal axes of the nodes' positions, longest extent first.
fn principal_axes(places: &[Vec3], nodes: &[u32]) -> [Vec3; 3] {
    let count = nodes.len() as f64;
    let mut mean = [0.0; 3];
    for node in nodes {
        (0..3).for_each(|i| mean[i] += places[*node as usize][i] / count);
    }
    let mut moments = Matrix3::zeros();
    for node in nodes {
        let from = [0, 1, 2].map(|i: usize| places[*node as usize][i] - mean[i]);
        moments += Matrix3::from_fn(|i, j| from[i] * from[j]);
    }
    let vectors = SymmetricEigen::new(moments).eigenvectors;
    [0, 1, 2].map(|i| vectors.column(i).into_owned().into())
}

fn sorted_along(places: &[Vec3], nodes: &[u32], axis: Vec3) -> Vec<u32> {
    let mut keyed: Vec<(f64, u32)> =
        nodes.iter().map(|node| (dot(places[*node as usize], axis), *node)).collect();
    keyed.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    keyed.into_iter().map(|(_, node)| node).collect()
}
