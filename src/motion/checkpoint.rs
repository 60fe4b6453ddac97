//! Checkpoint of a simulation, from which it continues with the same bits.

use crate::assembly::lists::Assembly;
use crate::assembly::places::Places;
use crate::members::contacts::Work;
use crate::motion::energy_ledger::Balance;
use crate::motion::error_control::Memory;
use crate::motion::extremes::Extremes;
use crate::motion::simulation::{RunOptions, Simulation, SimulationError, Stepping};
use crate::motion::stability::StepLimit;
use crate::motion::step_watch::StepWatch;
use serde::{Deserialize, Serialize};

/// A simulation at the end of a step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// s.
    pub time: f64,
    pub steps: u64,
    /// s.
    pub step_size: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<StepLimit>,
    pub step_watch: StepWatch,
    /// Of each bearing.
    pub extremes: Vec<Extremes>,
    /// The whole state vector; see [`crate::members::state`].
    pub state: Vec<f64>,
    /// The ledger counts from its start.
    pub balance: Balance,
    pub work: Work,
    /// `None` without error control.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub control: Option<Memory>,
}

impl Simulation {
    pub fn checkpoint(&self) -> Checkpoint {
        let mut checkpoint = Checkpoint::default();
        self.checkpoint_into(&mut checkpoint);
        checkpoint
    }

    /// See [`Simulation::checkpoint`]; allocates nothing the second time.
    pub fn checkpoint_into(&self, checkpoint: &mut Checkpoint) {
        checkpoint.time = self.time;
        checkpoint.steps = self.steps;
        checkpoint.step_size = self.step_size;
        checkpoint.limit = self.limit;
        checkpoint.step_watch = self.step_watch;
        checkpoint.extremes.clone_from(&self.extremes);
        checkpoint.state.clone_from(&self.state);
        checkpoint.balance = self.balance;
        checkpoint.work = self.system.work;
        checkpoint.control = self.control.as_ref().map(|control| control.memory);
    }

    /// Continues from a checkpoint: the same problem and options give the same bits as an unbroken run.
    ///
    /// # Errors
    ///
    /// An invalid step size.
    ///
    /// # Panics
    ///
    /// If the checkpoint has another number of state entries.
    pub fn from_checkpoint(
        assembly: impl Into<Assembly>,
        options: RunOptions,
        checkpoint: &Checkpoint,
    ) -> Result<Simulation, SimulationError> {
        let assembly = assembly.into();
        assert_eq!(checkpoint.state.len(), Places::of(&assembly).state_len());
        let stepping = match options.stepping {
            Stepping::Accuracy(_) => options.stepping,
            Stepping::Fixed(_) | Stepping::FractionOfLimit(_) => {
                Stepping::Fixed(checkpoint.step_size)
            }
        };
        let known = RunOptions { stepping, ..options };
        let state = checkpoint.state.clone();
        let mut simulation = Simulation::from_state(assembly, known, state, checkpoint.time)?;
        simulation.options = options;
        simulation.step_size = checkpoint.step_size;
        if let (Some(control), Some(memory)) = (&mut simulation.control, checkpoint.control) {
            control.memory = memory;
        }
        simulation.steps = checkpoint.steps;
        simulation.limit = checkpoint.limit;
        simulation.step_watch = checkpoint.step_watch;
        simulation.extremes.clone_from(&checkpoint.extremes);
        simulation.take_first_rates();
        simulation.system.work = checkpoint.work;
        simulation.balance = checkpoint.balance;
        Ok(simulation)
    }
}
