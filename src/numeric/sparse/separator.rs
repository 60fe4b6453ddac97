//! Smallest vertex separators by Menger's theorem: as many nodes as node-disjoint paths between the two sides (maximum
//! flow by Dinic's method, node capacity one).

use crate::numeric::sparse::graph::Graph;
use std::collections::VecDeque;

/// Side of a node in a cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Not in the part.
    Outside,
    Low,
    /// May be in the separator.
    Band,
    High,
}

const NONE: u32 = u32::MAX;
/// The merged low and high sides as ends of a path.
const LOW: u32 = u32::MAX - 1;
const HIGH: u32 = u32::MAX - 2;

/// Smallest separator, and the band's nodes on its low and high side.
pub struct Cut {
    pub separator: Vec<u32>,
    pub low: Vec<u32>,
    pub high: Vec<u32>,
}

/// Maximum flow of one search; arrays over the nodes of the band, numbered by `index`.
struct Flow<'a> {
    graph: &'a Graph,
    side: &'a [Side],
    index: &'a [u32],
    band: &'a [u32],
    /// Previous and next node on the path through a node; [`NONE`] without a path.
    before: Vec<u32>,
    after: Vec<u32>,
    touches_low: Vec<bool>,
    touches_high: Vec<bool>,
    /// Distance of the entrance (even) and exit (odd) of each node from the low side.
    level: Vec<u32>,
    /// Next neighbour to try from each end.
    tried: Vec<u32>,
}

/// Smallest separators of `band`, whose nodes are numbered by `index`, between low and high side: the one nearest to
/// the low side and the one nearest to the high side.
pub fn smallest_cuts(graph: &Graph, side: &[Side], index: &[u32], band: &[u32]) -> [Cut; 2] {
    let touches = |of: Side| -> Vec<bool> {
        let at = |node: &u32| graph.of(*node).iter().any(|other| side[*other as usize] == of);
        band.iter().map(at).collect()
    };
    let mut flow = Flow {
        graph,
        side,
        index,
        band,
        before: vec![NONE; band.len()],
        after: vec![NONE; band.len()],
        touches_low: touches(Side::Low),
        touches_high: touches(Side::High),
        level: Vec::new(),
        tried: Vec::new(),
    };
    while flow.levels() {
        flow.tried = vec![0; 2 * band.len()];
        for start in 0..band.len() as u32 {
            if flow.touches_low[start as usize] && flow.before[start as usize] != LOW {
                flow.augment(start);
            }
        }
    }
    // After the last search `level` marks the ends reachable from the low side.
    let reached = std::mem::take(&mut flow.level);
    let near_low = flow.cut(
        |entrance, exit| match (entrance, exit) {
            (true, true) => Side::Low,
            (true, false) => Side::Band,
            _ => Side::High,
        },
        &reached,
    );
    let reaching = flow.reaching_high();
    let near_high = flow.cut(
        |entrance, exit| match (entrance, exit) {
            (true, true) => Side::High,
            (false, true) => Side::Band,
            _ => Side::Low,
        },
        &reaching,
    );
    [near_low, near_high]
}

impl Flow<'_> {
    /// Neighbour number `which` of a node, or [`NONE`] if it is not in the band.
    fn neighbour(&self, at: u32, which: usize) -> Option<u32> {
        self.graph.of(self.band[at as usize]).get(which).map(|node| {
            match self.side[*node as usize] {
                Side::Band => self.index[*node as usize],
                _ => NONE,
            }
        })
    }

    fn cut(&self, place: impl Fn(bool, bool) -> Side, level: &[u32]) -> Cut {
        let mut cut = Cut { separator: Vec::new(), low: Vec::new(), high: Vec::new() };
        for (at, node) in self.band.iter().enumerate() {
            let marked = |end: usize| level[2 * at + end] != u32::MAX;
            match place(marked(0), marked(1)) {
                Side::Low => cut.low.push(*node),
                Side::High => cut.high.push(*node),
                _ => cut.separator.push(*node),
            }
        }
        cut
    }

    /// Breadth-first search from the low side; returns whether the high side is reached.
    fn levels(&mut self) -> bool {
        self.level = vec![u32::MAX; 2 * self.band.len()];
        let mut queue = VecDeque::new();
        for at in 0..self.band.len() {
            // Also where a path already starts: the low side has unlimited capacity.
            if self.touches_low[at] {
                self.level[2 * at] = 0;
                queue.push_back(2 * at as u32);
            }
        }
        let mut reached = false;
        while let Some(end) = queue.pop_front() {
            let (at, exit) = (end / 2, end % 2 == 1);
            let next = self.level[end as usize] + 1;
            let mut visit = |level: &mut Vec<u32>, end: u32| {
                if level[end as usize] == u32::MAX {
                    level[end as usize] = next;
                    queue.push_back(end);
                }
            };
            let (before, after) = (self.before[at as usize], self.after[at as usize]);
            if exit {
                reached |= self.touches_high[at as usize] && after != HIGH;
                if before != NONE {
                    visit(&mut self.level, 2 * at);
                }
                for node in self.graph.of(self.band[at as usize]) {
                    if self.side[*node as usize] == Side::Band {
                        visit(&mut self.level, 2 * self.index[*node as usize]);
                    }
                }
            } else if before == NONE {
                visit(&mut self.level, 2 * at + 1);
            } else if before != LOW {
                visit(&mut self.level, 2 * before + 1);
            }
        }
        reached
    }

    /// Depth-first search along increasing levels from the entrance of `start`; adds a path if it finds one.
    fn augment(&mut self, start: u32) -> bool {
        // Ends of the path: entrances even, exits odd.
        let mut path = vec![2 * start];
        while let Some(&end) = path.last() {
            let (at, exit) = ((end / 2) as usize, end % 2 == 1);
            let rising =
                |flow: &Self, to: u32| flow.level[to as usize] == flow.level[end as usize] + 1;
            let mut onward = None;
            if exit {
                if self.touches_high[at] && self.after[at] != HIGH {
                    self.add_path(&path);
                    return true;
                }
                loop {
                    let which = self.tried[end as usize];
                    self.tried[end as usize] += 1;
                    // First its own entrance, to reverse an existing path.
                    let to = if which == 0 {
                        (self.before[at] != NONE).then_some(2 * at as u32)
                    } else {
                        match self.neighbour(at as u32, which as usize - 1) {
                            None => break,
                            Some(NONE) => None,
                            Some(other) if other == self.after[at] => None,
                            Some(other) => Some(2 * other),
                        }
                    };
                    if let Some(to) = to.filter(|to| rising(self, *to)) {
                        onward = Some(to);
                        break;
                    }
                }
            } else if self.tried[end as usize] == 0 {
                self.tried[end as usize] = 1;
                let to = match self.before[at] {
                    NONE => Some(2 * at as u32 + 1),
                    LOW => None,
                    before => Some(2 * before + 1),
                };
                onward = to.filter(|to| rising(self, *to));
            }
            match onward {
                Some(to) => path.push(to),
                None => {
                    path.pop();
                }
            }
        }
        false
    }

    /// Adds a path from the low side to an exit adjacent to the high side.
    fn add_path(&mut self, path: &[u32]) {
        // Reversed links are removed first, so that new links are kept.
        let mut add = vec![(LOW, path[0] / 2)];
        let mut drop = Vec::new();
        for pair in path.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            match (from % 2, to % 2) {
                (1, 0) if from / 2 != to / 2 => add.push((from / 2, to / 2)),
                (0, 1) if from / 2 != to / 2 => drop.push((to / 2, from / 2)),
                _ => {}
            }
        }
        add.push((path[path.len() - 1] / 2, HIGH));
        for (from, to) in drop {
            self.after[from as usize] = NONE;
            self.before[to as usize] = NONE;
        }
        for (from, to) in add {
            if from != LOW {
                self.after[from as usize] = to;
            }
            if to != HIGH {
                self.before[to as usize] = from;
            }
        }
    }

    /// Marks ends from which the high side is reachable by 0.
    fn reaching_high(&self) -> Vec<u32> {
        let mut marks = vec![u32::MAX; 2 * self.band.len()];
        let mut stack = Vec::new();
        for at in 0..self.band.len() {
            if self.touches_high[at] {
                marks[2 * at + 1] = 0;
                stack.push(2 * at as u32 + 1);
            }
        }
        while let Some(end) = stack.pop() {
            let (at, exit) = (end / 2, end % 2 == 1);
            let mut visit = |end: u32| {
                if marks[end as usize] == u32::MAX {
                    marks[end as usize] = 0;
                    stack.push(end);
                }
            };
            let (before, after) = (self.before[at as usize], self.after[at as usize]);
            if exit {
                // Reached from its own entrance, or by reversing the link to the next node.
                if before == NONE {
                    visit(2 * at);
                }
                if after != NONE && after != HIGH {
                    visit(2 * after);
                }
            } else {
                if before != NONE {
                    visit(2 * at + 1);
                }
                for node in self.graph.of(self.band[at as usize]) {
                    if self.side[*node as usize] == Side::Band {
                        visit(2 * self.index[*node as usize] + 1);
                    }
                }
            }
        }
        marks
    }
}
