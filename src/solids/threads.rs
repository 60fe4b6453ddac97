//! Several threads with the bits of one: within a solid, and one solid in parallel with another.
//!
//! Each part of a solid owns a range of nodes and computes every element with one of them, so that forces on its nodes
//! are summed in the order of a single thread; elements between two ranges are computed twice. One thread does the rest
//! of a step, contacts and the motion of nodes.

use crate::mesh::tet_mesh::Elements;
use crate::solids::explicit::ExplicitSolid;
use crate::solids::labels::Labels;
use crate::solids::model::{SolidModel, SolidProblem};
use crate::solids::tet4_blocks::Node;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::ops::Range;
use std::sync::Arc;

/// Number of elements a thread below which sharing costs more than it gains.
pub const ELEMENTS_A_THREAD: usize = 2500;

/// Threads that work is shared out to.
#[derive(Clone, Debug, Default)]
pub struct WorkerPool {
    /// `None` for one thread.
    pool: Option<Arc<ThreadPool>>,
}

impl WorkerPool {
    /// With this number of threads; one if the system refuses.
    pub fn new(threads: usize) -> WorkerPool {
        let pool = (threads > 1).then(|| ThreadPoolBuilder::new().num_threads(threads).build());
        WorkerPool { pool: pool.and_then(Result::ok).map(Arc::new) }
    }

    pub fn threads(&self) -> usize {
        self.pool.as_ref().map_or(1, |pool| pool.current_num_threads())
    }

    /// Runs the same on each item of a list.
    ///
    /// # Errors
    ///
    /// The first error in the order of the list.
    pub fn each<T: Send, E: Send>(
        &self,
        list: &mut [T],
        go: impl Fn(&mut T) -> Result<(), E> + Sync,
    ) -> Result<(), E> {
        let Some(pool) = self.pool.as_ref().filter(|_| list.len() > 1) else {
            return list.iter_mut().try_for_each(go);
        };
        let mut errors: Vec<Option<E>> = list.iter().map(|_| None).collect();
        pool.scope(|scope| {
            for (one, error) in list.iter_mut().zip(&mut errors) {
                let go = &go;
                scope.spawn(move |_| *error = go(one).err());
            }
        });
        errors.into_iter().flatten().next().map_or(Ok(()), Err)
    }
}

/// The force loop of a solid, shared by threads.
#[derive(Debug)]
pub(crate) struct Partition {
    workers: WorkerPool,
    parts: Vec<Part>,
}

#[derive(Debug)]
struct Part {
    model: SolidModel,
    /// Range of its own nodes in the whole body; the first ones in its own numbering.
    owned: Range<usize>,
    /// Nodes of other parts, following its own ones; indices in the whole body, ascending.
    foreign: Vec<usize>,
    displacement: Vec<Node>,
    force: Vec<Node>,
}

impl ExplicitSolid {
    /// Evaluates the elements in this number of parts on a thread pool, with the same bits; in fewer parts for few
    /// elements, and in one for rubber.
    pub fn share(&mut self, workers: &WorkerPool, parts: usize) {
        let parts = if self.rubber.is_some() { 1 } else { parts };
        let ranges = ranges(&self.model.problem, parts);
        self.team = (ranges.len() > 1).then(|| Partition {
            workers: workers.clone(),
            parts: ranges.into_iter().map(|owned| part(&self.model, owned)).collect(),
        });
    }

    /// Elements computed a step; those between two parts count twice.
    pub fn elements_a_step(&self) -> usize {
        let whole = || self.model.problem.elements.len();
        self.team.as_ref().map_or_else(whole, |team| {
            team.parts.iter().map(|part| part.model.problem.elements.len()).sum()
        })
    }
}

impl Partition {
    /// Adds the forces of all elements to `forces` (N).
    pub fn add_internal_forces(&mut self, displacement: &[Node], forces: &mut [Node]) {
        let mut left = forces;
        let mut work = Vec::with_capacity(self.parts.len());
        for part in &mut self.parts {
            let (own, others) = left.split_at_mut(part.owned.len());
            work.push((part, own));
            left = others;
        }
        let done: Result<(), ()> = self.workers.each(&mut work, |(part, own)| {
            part.evaluate(displacement);
            for (sum, force) in own.iter_mut().zip(&part.force) {
                for i in 0..4 {
                    sum[i] += force[i];
                }
            }
            Ok(())
        });
        debug_assert!(done.is_ok());
    }
}

impl Part {
    /// The forces on its nodes; those on foreign ones lack what is not its own.
    fn evaluate(&mut self, displacement: &[Node]) {
        let own = self.owned.len();
        self.displacement[..own].copy_from_slice(&displacement[self.owned.clone()]);
        for (here, node) in self.displacement[own..].iter_mut().zip(&self.foreign) {
            *here = displacement[*node];
        }
        self.force.fill([0.0; 4]);
        self.model.add_internal_forces(&self.displacement, &mut self.force);
    }
}

/// Ranges of nodes with about the same number of element corners each.
fn ranges(problem: &SolidProblem, parts: usize) -> Vec<Range<usize>> {
    let count = problem.nodes.len();
    let parts = parts.min(problem.elements.len().div_ceil(ELEMENTS_A_THREAD)).max(1);
    let mut corners = vec![0usize; count];
    for node in problem.elements.all_nodes() {
        corners[*node as usize] += 1;
    }
    let total: usize = corners.iter().sum();
    let mut ranges = Vec::new();
    let (mut start, mut sum) = (0, 0);
    for (node, share) in corners.iter().enumerate() {
        sum += share;
        if sum * parts >= total * (ranges.len() + 1) || node + 1 == count {
            ranges.push(start..node + 1);
            start = node + 1;
        }
    }
    ranges
}

/// The part of a solid that owns a range of nodes.
fn part(whole: &SolidModel, owned: Range<usize>) -> Part {
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
    let all: Vec<usize> = owned.clone().chain(foreign.iter().copied()).collect();
    let problem = SolidProblem {
        nodes: all.iter().map(|node| problem.nodes[*node]).collect(),
        elements,
        prescribed: Vec::new(),
        loads: Vec::new(),
        ..problem.clone()
    };
    let labels = Labels {
        elements: touching.iter().map(|e| whole.labels.element(*e as usize)).collect(),
        nodes: all.iter().map(|node| whole.labels.node(*node)).collect(),
    };
    let model = SolidModel::labelled(problem, labels).expect("the whole was checked");
    let still = vec![[0.0; 4]; all.len()];
    Part { model, owned, foreign, displacement: still.clone(), force: still }
}
