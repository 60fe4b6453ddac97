//! Checkpoint of a solid in explicit steps, from which it continues with the same bits.

use crate::solids::explicit::{ExplicitSolid, SolidWork};
use crate::solids::tet4_blocks::Node;
use serde::{Deserialize, Serialize};

/// A solid at the end of a step, as plain numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SolidCheckpoint {
    /// s.
    pub time: f64,
    pub steps: u64,
    pub displacement: Vec<Node>,
    /// At `time` for Runge–Kutta; half a step before it for central differences.
    pub rate: Vec<Node>,
    /// Work on each node, J.
    pub external_work: Vec<f64>,
    pub damping_work: Vec<f64>,
    pub work: SolidWork,
    /// History stresses of rubber, Pa; empty for an elastic solid.
    pub memory: Vec<f64>,
    /// Energy dissipated by dashpots, and work of stresses beyond the law of small strain, if counted, J.
    pub dissipated: f64,
    pub beyond: f64,
}

impl ExplicitSolid {
    pub fn checkpoint(&self) -> SolidCheckpoint {
        let mut checkpoint = SolidCheckpoint::default();
        self.checkpoint_into(&mut checkpoint);
        checkpoint
    }

    /// See [`ExplicitSolid::checkpoint`]; allocates nothing the second time, except for rubber.
    pub fn checkpoint_into(&self, checkpoint: &mut SolidCheckpoint) {
        checkpoint.time = self.time;
        checkpoint.steps = self.steps;
        checkpoint.displacement.clone_from(&self.displacement);
        checkpoint.rate.clone_from(&self.rate);
        checkpoint.external_work.clone_from(&self.external_work);
        checkpoint.damping_work.clone_from(&self.damping_work);
        checkpoint.work = self.work;
        if let Some(rubber) = &self.rubber {
            checkpoint.memory = rubber.memory();
            checkpoint.dissipated = rubber.dissipated;
            checkpoint.beyond = rubber.beyond;
        }
    }

    /// Continues from a checkpoint of the same problem, method and step.
    ///
    /// # Panics
    ///
    /// If the checkpoint has another number of nodes or history stresses.
    pub fn restore(&mut self, checkpoint: &SolidCheckpoint) {
        let nodes = self.displacement.len();
        assert_eq!((checkpoint.displacement.len(), checkpoint.rate.len()), (nodes, nodes));
        let work = (checkpoint.external_work.len(), checkpoint.damping_work.len());
        assert_eq!(work, (nodes, nodes));
        self.time = checkpoint.time;
        self.steps = checkpoint.steps;
        self.displacement.clone_from(&checkpoint.displacement);
        self.rate.clone_from(&checkpoint.rate);
        self.external_work.clone_from(&checkpoint.external_work);
        self.damping_work.clone_from(&checkpoint.damping_work);
        self.work = checkpoint.work;
        if let Some(rubber) = &mut self.rubber {
            rubber.remember(&checkpoint.memory);
            rubber.dissipated = checkpoint.dissipated;
            rubber.beyond = checkpoint.beyond;
        }
    }
}
