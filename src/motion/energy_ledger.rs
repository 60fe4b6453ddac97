//! Energy ledger of bearings in motion: initial energy, work, losses, and the residual.

use crate::assembly::ledger_watch::{LedgerWatch, MOST_OPEN};
use crate::members::state::LEDGER;
use crate::motion::energy::Energy;
use crate::motion::simulation::{Integrator, RunOptions, SimulationError, Stepping};
use crate::motion::system::System;
use serde::{Deserialize, Serialize};

/// Steps of Runge–Kutta, each a fraction of the shortest period, between two checks of the ledger. Other integrators
/// are checked after each step.
const CHECK_EVERY: u64 = 16;

/// Energy balance since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    pub first: Energy,
    /// Entries of the ledger at the start, J.
    pub before: f64,
    /// Largest contact energy at any check, J.
    pub largest_contact: f64,
    pub turnover: ContactTurnover,
    pub watch: LedgerWatch,
}

/// Energy exchanged with the contacts, as seen at the checks, J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactTurnover {
    pub sum: f64,
    /// Contact energy at the last check.
    pub last: f64,
}

/// Energies and loads at the present time.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot {
    pub time: f64,
    pub energy: Energy,
    /// Work and losses since the start, J, in the order of [`crate::members::state::Ledger`].
    pub ledger: [f64; LEDGER],
    /// Energy residual, J.
    pub residual: f64,
}

impl Balance {
    /// Balance from an evaluated state on.
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

    /// Snapshot of an evaluated state.
    pub(crate) fn snapshot(&self, system: &System, state: &[f64], time: f64) -> Snapshot {
        let (energy, ledger) = (system.energy(state), entries(system, state));
        let work = ledger.iter().sum::<f64>() - self.before;
        let residual = energy.total() - self.first.total() - work;
        Snapshot { time, energy, ledger, residual }
    }

    /// Checks an evaluated state after a number of steps.
    ///
    /// # Errors
    ///
    /// An energy residual beyond the limit in the options for too long.
    pub(crate) fn check(
        &mut self,
        (system, state): (&System, &[f64]),
        options: &RunOptions,
        time: f64,
        steps: u64,
    ) -> Result<(), SimulationError> {
        let by_steps = options.integrator == Integrator::RungeKutta;
        if options.energy_limit == f64::INFINITY || (by_steps && !steps.is_multiple_of(CHECK_EVERY))
        {
            return Ok(());
        }
        let now = self.snapshot(system, state, time);
        let turned_over = self.turned_over(&now, options);
        // Bodies that have touched nothing have rounding errors only.
        let held = now.energy.held();
        if turned_over == 0.0
            || self.watch.record(now.residual, turned_over, held, options.energy_limit)
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
        // Error control bounds the motion, and with it the relative energy of motion and of exchange with the contacts.
        // Without it contacts fail first.
        let of_motion = match options.stepping {
            Stepping::Accuracy(_) => now.energy.kinetic + self.turnover.sum,
            Stepping::Fixed(_) | Stepping::FractionOfLimit(_) => 0.0,
        };
        self.largest_contact + exchanged + of_motion
    }

    /// Checks the last state of a run with too few checks to detect a lasting residual.
    ///
    /// # Errors
    ///
    /// An energy residual beyond the limit in the options.
    pub(crate) fn at_end(
        mut self,
        last: &Snapshot,
        options: &RunOptions,
        steps: u64,
    ) -> Result<(), SimulationError> {
        let every = if options.integrator == Integrator::RungeKutta { CHECK_EVERY } else { 1 };
        let turned_over = self.turned_over(last, options);
        let is_told = steps >= u64::from(MOST_OPEN) * every || turned_over == 0.0;
        let (held, limit) = (last.energy.held(), options.energy_limit);
        if is_told || self.watch.closes(last.residual, turned_over, held, limit) {
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
