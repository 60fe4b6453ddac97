//! The energy ledger of bearings in motion: what was there at the start, what has come and gone, and whether it adds up.

use crate::assembly::ledger_watch::{LedgerWatch, MOST_OPEN};
use crate::assembly::state::LEDGER;
use crate::motion::energy::Energy;
use crate::motion::simulation::{Integrator, RunOptions, SimulationError, Stepping};
use crate::motion::system::System;

/// Steps of Runge–Kutta, a fraction of the shortest period each, from one look at the ledger to the next. The others are
/// looked at after each of their steps.
const LOOK_EVERY: u64 = 16;

/// Energy since the start, whatever rows are written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    pub first: Energy,
    /// What the ledger already held then, J.
    pub before: f64,
    /// At any look, J.
    pub largest_contact: f64,
    pub turnover: ContactTurnover,
    pub watch: LedgerWatch,
}

/// Energy that went into contacts and out again, as far as looks have seen it, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactTurnover {
    pub sum: f64,
    /// At the last look.
    pub last: f64,
}

/// Everything that outputs are made of, at the present time.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot {
    pub time: f64,
    pub energy: Energy,
    /// Work and losses since the start, J, in the order of [`crate::assembly::state::Ledger`].
    pub ledger: [f64; LEDGER],
    /// Energy unaccounted for, J.
    pub residual: f64,
}

impl Balance {
    /// From a state that has been evaluated.
    pub(crate) fn from_here(system: &System, state: &[f64]) -> Balance {
        let first = system.energy(state);
        let contact = first.contact + first.ball_contact;
        Balance {
            first,
            before: entries(system, state).iter().sum(),
            largest_contact: contact,
            turnover: ContactTurnover { sum: 0.0, last: contact },
            watch: LedgerWatch::default(),
        }
    }

    /// Of a state that has been evaluated.
    pub(crate) fn snapshot(&self, system: &System, state: &[f64], time: f64) -> Snapshot {
        let (energy, ledger) = (system.energy(state), entries(system, state));
        let work = ledger.iter().sum::<f64>() - self.before;
        let residual = energy.total() - self.first.total() - work;
        Snapshot { time, energy, ledger, residual }
    }

    /// Looks at a state that has been evaluated in the step after so many others.
    ///
    /// # Errors
    /// More energy unaccounted for than the options allow, for too long.
    pub(crate) fn check(
        &mut self,
        (system, state): (&System, &[f64]),
        options: &RunOptions,
        time: f64,
        steps: u64,
    ) -> Result<(), SimulationError> {
        let by_steps = options.integrator == Integrator::RungeKutta;
        if options.energy_limit == f64::INFINITY || (by_steps && !steps.is_multiple_of(LOOK_EVERY))
        {
            return Ok(());
        }
        let now = self.snapshot(system, state, time);
        let turned_over = self.turned_over(&now, options);
        // Bodies that nothing has touched have what rounding leaves.
        if turned_over == 0.0 || self.watch.record(now.residual, turned_over, options.energy_limit)
        {
            return Ok(());
        }
        Err(self.unaccounted(now.residual, options, time, steps + 1))
    }

    /// Energy held or exchanged so far, J, the present state included.
    fn turned_over(&mut self, now: &Snapshot, options: &RunOptions) -> f64 {
        let contact = now.energy.contact + now.energy.ball_contact;
        self.largest_contact = self.largest_contact.max(contact);
        self.turnover.sum += (contact - self.turnover.last).abs();
        self.turnover.last = contact;
        let exchanged: f64 = now.ledger.iter().map(|entry| entry.abs()).sum();
        // Error control keeps the motion, and with it a part of the energy of all motion and of all that
        // passes through the contacts; steps that are too long for the contacts it does not take.
        // Without it contacts are the first to go.
        let of_motion = match options.stepping {
            Stepping::Accuracy(_) => now.energy.kinetic + self.turnover.sum,
            Stepping::Fixed(_) | Stepping::FractionOfLimit(_) => 0.0,
        };
        self.largest_contact + exchanged + of_motion
    }

    /// Of a run that ends before so many looks that one too many could have been open: its last state alone.
    ///
    /// # Errors
    /// More energy unaccounted for than the options allow.
    pub(crate) fn at_end(
        mut self,
        last: &Snapshot,
        options: &RunOptions,
        steps: u64,
    ) -> Result<(), SimulationError> {
        let every = if options.integrator == Integrator::RungeKutta { LOOK_EVERY } else { 1 };
        let turned_over = self.turned_over(last, options);
        let is_told = steps >= u64::from(MOST_OPEN) * every || turned_over == 0.0;
        if is_told || self.watch.closes(last.residual, turned_over, options.energy_limit) {
            return Ok(());
        }
        Err(self.unaccounted(last.residual, options, last.time, steps))
    }

    fn unaccounted(
        &self,
        residual: f64,
        options: &RunOptions,
        time: f64,
        step: u64,
    ) -> SimulationError {
        let (turned_over, limit) = (self.watch.turned_over, options.energy_limit);
        SimulationError::Energy { residual, turned_over, time, step, limit }
    }
}

fn entries(system: &System, state: &[f64]) -> [f64; LEDGER] {
    let at = system.places.ledger();
    std::array::from_fn(|i| state[at + i])
}
