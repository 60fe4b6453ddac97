//! Central differences on several threads with the bits of one.
//!
//! Each thread owns a range of nodes and computes every element that touches one of them, so that
//! the forces on its nodes are summed in the order in which one thread sums them; elements between
//! two ranges are computed twice. After each step the threads hand each other the displacements of
//! the nodes that others touch, with one barrier a step. A part is a solid of its own, whose foreign
//! nodes do not move by themselves.

use super::explicit::{ExplicitMethod, ExplicitSolid};
use super::labels::Labels;
use super::model::{DampedMotion, Load, Prescribed, SolidError, SolidModel, SolidProblem};
use super::tet4_blocks::Node;
use crate::mesh::tet_mesh::Elements;
use std::ops::Range;
use std::sync::{Barrier, Mutex};

/// Below this many elements a thread a barrier costs more than it brings.
pub const ELEMENTS_A_THREAD: usize = 2500;

/// A solid shared out to threads.
pub struct Team {
    parts: Vec<Part>,
}

struct Part {
    solid: ExplicitSolid,
    /// Its own nodes in the whole body; the first ones in its own numbering.
    owned: Range<usize>,
    /// Foreign nodes behind its own ones: owner, and place in what the owner hands out.
    foreign: Vec<(usize, usize)>,
    /// Own nodes that others touch, in its own numbering.
    handed_out: Vec<usize>,
}

impl Team {
    /// Shares out a solid in its present state. Solids whose damping follows their rigid motion,
    /// and Runge–Kutta, stay on one thread.
    pub fn new(solid: &ExplicitSolid, threads: usize) -> Team {
        let problem = &solid.model.problem;
        let alone = solid.method != ExplicitMethod::CentralDifferences
            || problem.damped_motion == DampedMotion::RelativeToRigid;
        let threads = if alone { 1 } else { threads.max(1) };
        let ranges = ranges(problem, threads);
        let owner = |node: usize| ranges.iter().position(|range| range.contains(&node));
        let mut parts = Vec::new();
        let mut wanted: Vec<Vec<usize>> = vec![Vec::new(); ranges.len()];
        let mut foreigners = Vec::new();
        for owned in &ranges {
            let (part, foreign) = part(solid, owned.clone());
            for node in &foreign {
                wanted[owner(*node).expect("every node has an owner")].push(*node);
            }
            parts.push(part);
            foreigners.push(foreign);
        }
        for list in &mut wanted {
            list.sort_unstable();
            list.dedup();
        }
        for (index, (part, foreign)) in parts.iter_mut().zip(foreigners).enumerate() {
            part.handed_out = wanted[index].iter().map(|node| node - part.owned.start).collect();
            part.foreign = foreign
                .into_iter()
                .map(|node| {
                    let owner = owner(node).expect("every node has an owner");
                    (owner, wanted[owner].binary_search(&node).expect("listed above"))
                })
                .collect();
        }
        Team { parts }
    }

    /// Elements computed a step, those between two ranges twice.
    pub fn elements(&self) -> usize {
        self.parts.iter().map(|part| part.solid.model.problem.elements.len()).sum()
    }

    /// Steps all parts together.
    ///
    /// # Errors
    /// A value that is not finite.
    pub fn advance(&mut self, steps: u64) -> Result<(), SolidError> {
        let count = self.parts.len();
        let barrier = Barrier::new(count);
        // Two sets in turn: while one is read the next step writes the other.
        let outboxes: [Vec<Mutex<Vec<Node>>>; 2] =
            [(); 2].map(|()| (0..count).map(|_| Mutex::new(Vec::new())).collect());
        let results: Vec<Result<(), SolidError>> = std::thread::scope(|scope| {
            let threads: Vec<_> = self
                .parts
                .iter_mut()
                .enumerate()
                .map(|(index, part)| {
                    let (barrier, outboxes) = (&barrier, &outboxes);
                    scope.spawn(move || part.advance(index, steps, barrier, outboxes))
                })
                .collect();
            threads.into_iter().map(|thread| thread.join().expect("no part panics")).collect()
        });
        results.into_iter().collect()
    }

    /// Writes the parts' state back into the whole solid.
    pub fn gather(&self, solid: &mut ExplicitSolid) {
        let first = &self.parts[0].solid;
        let taken = first.steps - solid.steps;
        for part in &self.parts {
            let own = 0..part.owned.len();
            solid.displacement[part.owned.clone()]
                .copy_from_slice(&part.solid.displacement[own.clone()]);
            solid.rate[part.owned.clone()].copy_from_slice(&part.solid.rate[own.clone()]);
            solid.external_work[part.owned.clone()]
                .copy_from_slice(&part.solid.external_work[own.clone()]);
            solid.damping_work[part.owned.clone()].copy_from_slice(&part.solid.damping_work[own]);
        }
        solid.time = first.time;
        solid.steps = first.steps;
        solid.work.evaluations += taken;
        solid.work.elements += taken * self.elements() as u64;
    }
}

impl Part {
    fn advance(
        &mut self,
        index: usize,
        steps: u64,
        barrier: &Barrier,
        outboxes: &[Vec<Mutex<Vec<Node>>>; 2],
    ) -> Result<(), SolidError> {
        let own = self.owned.len();
        // An error is kept until the end: the others wait at the barrier.
        let mut result = Ok(());
        for step in 0..steps {
            if result.is_ok() {
                result = self.solid.step(|_, _, _| {});
            }
            let boxes = &outboxes[(step % 2) as usize];
            {
                let mut outbox = boxes[index].lock().expect("no part panics");
                outbox.clear();
                outbox.extend(self.handed_out.iter().map(|node| self.solid.displacement[*node]));
            }
            barrier.wait();
            let mut last = usize::MAX;
            let mut inbox = None;
            for (node, (owner, place)) in self.foreign.iter().enumerate() {
                if *owner != last {
                    drop(inbox.take());
                    inbox = Some(boxes[*owner].lock().expect("no part panics"));
                    last = *owner;
                }
                let from = inbox.as_ref().expect("locked above");
                self.solid.displacement[own + node] = from[*place];
            }
        }
        result
    }
}

/// Ranges of nodes with about the same number of element corners each.
fn ranges(problem: &SolidProblem, threads: usize) -> Vec<Range<usize>> {
    let count = problem.nodes.len();
    let threads = threads.min(problem.elements.len().div_ceil(ELEMENTS_A_THREAD)).max(1);
    let mut corners = vec![0usize; count];
    for node in problem.elements.all_nodes() {
        corners[*node as usize] += 1;
    }
    let total: usize = corners.iter().sum();
    let mut ranges = Vec::new();
    let (mut start, mut sum) = (0, 0);
    for (node, share) in corners.iter().enumerate() {
        sum += share;
        if sum * threads >= total * (ranges.len() + 1) || node + 1 == count {
            ranges.push(start..node + 1);
            start = node + 1;
        }
    }
    ranges
}

/// The part of a solid that owns a range of nodes, and the foreign nodes it touches, ascending.
fn part(solid: &ExplicitSolid, owned: Range<usize>) -> (Part, Vec<usize>) {
    let whole = &solid.model;
    let problem = &whole.problem;
    let mine = |node: u32| owned.contains(&(node as usize));
    let touching: Vec<u32> = (0..problem.elements.len() as u32)
        .filter(|element| problem.elements.nodes(*element as usize).iter().any(|n| mine(*n)))
        .collect();
    let mut foreign: Vec<usize> = touching
        .iter()
        .flat_map(|element| problem.elements.nodes(*element as usize))
        .filter(|node| !mine(**node))
        .map(|node| *node as usize)
        .collect();
    foreign.sort_unstable();
    foreign.dedup();
    let local = |node: u32| -> u32 {
        let node = node as usize;
        if owned.contains(&node) {
            (node - owned.start) as u32
        } else {
            (owned.len() + foreign.binary_search(&node).expect("listed above")) as u32
        }
    };
    let elements = match &problem.elements {
        Elements::Linear(list) => Elements::Linear(
            touching.iter().map(|element| list[*element as usize].map(local)).collect(),
        ),
        Elements::Quadratic(list) => Elements::Quadratic(
            touching.iter().map(|element| list[*element as usize].map(local)).collect(),
        ),
    };
    let all = || owned.clone().chain(foreign.iter().copied());
    let of = |load: &Load| Load {
        forces: load
            .forces
            .iter()
            .filter(|(node, _)| mine(*node))
            .map(|(node, force)| (local(*node), *force))
            .collect(),
        profile: load.profile.clone(),
    };
    let problem = SolidProblem {
        nodes: all().map(|node| problem.nodes[node]).collect(),
        elements,
        prescribed: problem
            .prescribed
            .iter()
            .filter(|prescribed| mine(prescribed.node))
            .map(|prescribed| Prescribed { node: local(prescribed.node), ..prescribed.clone() })
            .collect(),
        loads: problem.loads.iter().map(of).collect(),
        ..problem.clone()
    };
    let labels = Labels {
        elements: touching.iter().map(|e| whole.labels.element(*e as usize)).collect(),
        nodes: all().map(|node| whole.labels.node(node)).collect(),
    };
    let mut model = SolidModel::labelled(problem, labels).expect("the whole was checked");
    for (place, node) in all().enumerate() {
        model.mass[place] = whole.mass[node];
        model.per_mass[place] = if mine(node as u32) { whole.per_mass[node] } else { [0.0; 4] };
    }
    let mut of_part = ExplicitSolid::at_rest(model, solid.method, solid.step_size, solid.limit);
    for (place, node) in all().enumerate() {
        of_part.displacement[place] = solid.displacement[node];
        if place < owned.len() {
            of_part.rate[place] = solid.rate[node];
            of_part.external_work[place] = solid.external_work[node];
            of_part.damping_work[place] = solid.damping_work[node];
        }
    }
    of_part.time = solid.time;
    of_part.steps = solid.steps;
    (Part { solid: of_part, owned, foreign: Vec::new(), handed_out: Vec::new() }, foreign)
}
