//! A simulation: state, time, step after step, watched.

use crate::assembly::lists::Assembly;
use crate::assembly::plan::{Stage, motion};
use crate::assembly::state::{BodyState, Ledger};
use crate::members::contacts::Kernel;
use crate::members::rigid_body::Wrench;
use crate::motion::dormand_prince;
use crate::motion::dormand_prince::DormandPrince;
use crate::motion::energy_ledger::Balance;
use crate::motion::error_control::{Attempt, Controller};
use crate::motion::extremes::Extremes;
use crate::motion::rk4::RungeKutta;
use crate::motion::rosenbrock;
use crate::motion::rosenbrock::Rosenbrock;
use crate::motion::stability::{StepLimit, step_limit};
use crate::motion::start;
use crate::motion::step_watch::{StepWatch, Stiffness, stiffness};
use crate::motion::system::System;

pub use crate::motion::energy_ledger::Snapshot;
pub use crate::motion::error::SimulationError;

/// Where a simulation starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Static equilibrium under the loads at t = 0, balls and cage rolling.
    Equilibrium,
    /// Nominal positions, balls and cage rolling at the prescribed speed.
    Nominal,
}

/// How a step is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stepping {
    /// As given, s.
    Fixed(f64),
    /// This fraction of the stability limit of Runge–Kutta at the start, and again where the limit
    /// has come down to the step.
    FractionOfLimit(f64),
    /// As long as keeps the error of the races' motion below this part of the largest overlap.
    Accuracy(f64),
}

/// What moves the state on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Classical fourth-order Runge–Kutta, as in the source; steps as given.
    RungeKutta,
    /// Explicit, of fifth order with error estimate: for bearings without stiff traction.
    DormandPrince,
    /// Linearly implicit, of third order with error estimate: contacts and traction bind no step.
    Rosenbrock,
}

impl Integrator {
    /// As scenes and results call it.
    pub fn name(self) -> &'static str {
        match self {
            Integrator::RungeKutta => "rk4",
            Integrator::DormandPrince => "dormand-prince",
            Integrator::Rosenbrock => "rosenbrock",
        }
    }
}

/// Error control gives up below this step, s; a thousandth of a period of the stiffest contact is
/// a million times longer.
const SHORTEST_STEP: f64 = 1e-14;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunOptions {
    pub start: Start,
    pub integrator: Integrator,
    pub stepping: Stepping,
    pub driver: Kernel,
    /// Energy that may go missing, as a fraction of the energy that has been turned over (largest
    /// contact energy plus all work and losses; with error control also the kinetic energy, and what
    /// went into contacts and out again from one look to the next).
    pub energy_limit: f64,
}

impl Default for RunOptions {
    fn default() -> Self {
        RunOptions {
            start: Start::Equilibrium,
            integrator: Integrator::RungeKutta,
            stepping: Stepping::FractionOfLimit(0.5),
            driver: Kernel::Simd,
            energy_limit: 0.01,
        }
    }
}

/// A simulation under way.
pub struct Simulation {
    pub system: System,
    pub state: Vec<f64>,
    pub time: f64,
    /// Of the next step, s.
    pub step_size: f64,
    pub steps: u64,
    /// What limits a step that follows from it, at the start or where it was last shortened.
    pub limit: Option<StepLimit>,
    /// How the step compares with what the contacts allow since.
    pub step_watch: StepWatch,
    /// Of each bearing, over every state that a step has led to, as far as it has been evaluated: of Runge–Kutta's that is
    /// the one before the last step, unless a snapshot was taken.
    pub extremes: Vec<Extremes>,
    /// With error control only.
    pub control: Option<Controller>,
    pub(crate) options: RunOptions,
    integrator: Stepper,
    attempt: Attempt,
    pub(crate) balance: Balance,
    pub(crate) rates: Vec<f64>,
}

enum Stepper {
    RungeKutta(RungeKutta),
    DormandPrince(DormandPrince),
    Rosenbrock(Box<Rosenbrock>),
}

/// # Errors
/// Steps that the integrator cannot choose.
fn controller(
    assembly: &Assembly,
    options: &RunOptions,
) -> Result<Option<Controller>, SimulationError> {
    match (options.integrator, options.stepping) {
        (_, Stepping::Accuracy(accuracy)) if !(accuracy > 0.0 && accuracy.is_finite()) => {
            Err(SimulationError::Accuracy(accuracy))
        }
        (Integrator::RungeKutta, Stepping::Accuracy(_)) => Err(SimulationError::NoErrorEstimate),
        (Integrator::RungeKutta, _) | (_, Stepping::Fixed(_)) => Ok(None),
        (_, Stepping::Accuracy(_)) if assembly.bearings.is_empty() => {
            Err(SimulationError::NothingToMeasure)
        }
        (Integrator::DormandPrince, Stepping::Accuracy(accuracy)) => {
            Ok(Some(Controller::new(assembly, accuracy, dormand_prince::ERROR_ORDER)))
        }
        (Integrator::Rosenbrock, Stepping::Accuracy(accuracy)) => {
            Ok(Some(Controller::new(assembly, accuracy, rosenbrock::ERROR_ORDER)))
        }
        (other, Stepping::FractionOfLimit(_)) => {
            Err(SimulationError::FractionOfOther(other.name()))
        }
    }
}

/// Tries `step` and, with error control, shorter ones until one is good enough. Returns its size
/// and the size for the next.
fn accepted(
    system: &mut System,
    control: Option<&mut Controller>,
    t: f64,
    steps: u64,
    mut step: f64,
    attempt: &mut Attempt,
    mut go: impl FnMut(&mut System, f64, &mut Attempt),
) -> Result<(f64, Option<f64>), SimulationError> {
    let Some(control) = control else {
        go(system, step, attempt);
        return Ok((step, None));
    };
    let mut was_rejected = false;
    loop {
        go(system, step, attempt);
        let norm = control.norm(attempt);
        if norm <= 1.0 {
            control.record(system);
            return Ok((step, Some(control.longer(step, norm, was_rejected))));
        }
        system.work.rejected_steps += 1;
        was_rejected = true;
        let shorter = control.shorter(step, norm);
        // Time no longer moves on.
        if t + 1e-3 * shorter == t || shorter < SHORTEST_STEP {
            return Err(SimulationError::StepVanished {
                time: t,
                step: steps + 1,
                size: step,
                error: norm,
            });
        }
        step = shorter;
    }
}

/// Every bearing's extremes take note of a state that has been evaluated.
fn see(extremes: &mut [Extremes], system: &System, time: f64) {
    for (index, extremes) in extremes.iter_mut().enumerate() {
        extremes.record(system, index, time);
    }
}

impl Simulation {
    /// # Errors
    /// No equilibrium to start from, no step, or a start that has no meaning (see [`crate::motion::validity`]).
    pub fn new(
        assembly: impl Into<Assembly>,
        options: RunOptions,
    ) -> Result<Simulation, SimulationError> {
        let assembly = assembly.into();
        let (state, searches) = match motion::start(options.start).does {
            true => (start::at_equilibrium(&assembly)?, 1),
            false => (start::nominal(&assembly), 0),
        };
        let mut simulation = Simulation::from_state(assembly, options, state, 0.0)?;
        simulation.system.ran.whole.add(Stage::StartEquilibrium, searches);
        simulation.system.tidy(0.0, &mut simulation.state);
        if options.start == Start::Equilibrium {
            simulation.watch_cages_at_start()?;
        }
        simulation.watch()?;
        Ok(simulation)
    }

    /// Goes on from a state vector at a time, without a change to any bit of it; the energy is
    /// balanced from here on.
    ///
    /// # Errors
    /// No step.
    pub fn from_state(
        assembly: impl Into<Assembly>,
        options: RunOptions,
        state: Vec<f64>,
        time: f64,
    ) -> Result<Simulation, SimulationError> {
        let mut system = System::new(assembly, options.driver);
        if let Some(error) = system.sets.iter().find_map(|set| set.no_dents.clone()) {
            return Err(error.into());
        }
        let length = state.len();
        let integrator = match options.integrator {
            Integrator::RungeKutta => Stepper::RungeKutta(RungeKutta::new(length)),
            Integrator::DormandPrince => Stepper::DormandPrince(DormandPrince::new(length)),
            Integrator::Rosenbrock => Stepper::Rosenbrock(Box::new(Rosenbrock::new(&system))),
        };
        let control = controller(&system.assembly, &options)?;
        let (mut step_size, limit) = match options.stepping {
            Stepping::Fixed(step) => (step, None),
            Stepping::FractionOfLimit(fraction) => {
                let limit = step_limit(&mut system, time, &state).ok_or(SimulationError::NoStep)?;
                (fraction * limit.step, Some(limit))
            }
            // From the overlaps, below.
            Stepping::Accuracy(_) => (1.0, None),
        };
        if !(step_size > 0.0 && step_size.is_finite()) {
            return Err(SimulationError::Step(step_size));
        }
        let mut rates = vec![0.0; state.len()];
        system.work = Default::default();
        system.ran.clear();
        system.ran.whole.add(Stage::StabilityLimit, u64::from(limit.is_some()));
        system.evaluate(time, &state, &mut rates);
        let balance = Balance::from_here(&system, &state);
        let mut extremes = vec![Extremes::default(); system.sets.len()];
        see(&mut extremes, &system, time);
        let step_watch = StepWatch {
            smallest: limit.map(|limit| limit.step),
            stiffest: if limit.is_some() { stiffness(&system) } else { Stiffness::default() },
            ..StepWatch::default()
        };
        let control = control.map(|mut control| {
            control.record(&system);
            step_size = control.first_step();
            control
        });
        let mut simulation = Simulation {
            extremes,
            control,
            integrator,
            attempt: Attempt::new(length),
            balance,
            rates,
            system,
            state,
            time,
            step_size,
            steps: 0,
            limit,
            step_watch,
            options,
        };
        simulation.take_first_rates();
        Ok(simulation)
    }

    /// How it was asked to step.
    pub fn options(&self) -> &RunOptions {
        &self.options
    }

    /// First stage at the present state, history included, for the integrators that keep it.
    pub(crate) fn take_first_rates(&mut self) {
        match &mut self.integrator {
            Stepper::RungeKutta(_) => {}
            Stepper::DormandPrince(integrator) => {
                self.system.evaluate(self.time, &self.state, &mut self.rates);
                integrator.begin(&self.rates);
            }
            Stepper::Rosenbrock(integrator) => {
                integrator.begin(&mut self.system, self.time, &self.state);
            }
        }
    }

    /// A body at the present time.
    pub fn body(&self, index: usize) -> BodyState {
        self.system.body_state(&self.state, index)
    }

    /// Lets something outside push bodies from now on; its work goes with that of foundations.
    pub fn set_outside_loads(&mut self, loads: &[(usize, Wrench)]) {
        for (body, load) in loads {
            self.system.outside[*body] = Some(*load);
        }
        self.take_first_rates();
    }

    /// One step; checks what can be checked cheaply.
    ///
    /// # Errors
    /// A value that is not finite, or a state that has lost its meaning (see [`crate::motion::validity`]): the state
    /// is that after the step.
    pub fn step(&mut self) -> Result<(), SimulationError> {
        self.step_by(self.step_size).map(|_| ())
    }

    /// One step of a given size, as for the last one before an output; with error control one that
    /// may be shorter. Returns its size.
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn step_by(&mut self, step: f64) -> Result<f64, SimulationError> {
        let step = match self.control {
            Some(_) => step.min(self.system.longest_past_dents(&self.state)),
            None => step,
        };
        let Simulation { system, state, attempt, extremes, balance, options, .. } = self;
        let mut balanced = Ok(());
        let taken = match &mut self.integrator {
            Stepper::RungeKutta(integrator) => {
                let t = self.time;
                integrator.step(system, t, step, state, |system, state| {
                    see(extremes, system, t);
                    balanced = balance.check((system, state), options, t, self.steps);
                });
                step
            }
            Stepper::DormandPrince(integrator) => {
                let t = self.time;
                let go = |system: &mut System, step, attempt: &mut Attempt| {
                    integrator.attempt(system, t, step, state, attempt);
                };
                let (taken, next) =
                    accepted(system, self.control.as_mut(), t, self.steps, step, attempt, go)?;
                self.step_size = next.unwrap_or(self.step_size);
                integrator.accept();
                std::mem::swap(state, &mut attempt.state);
                // The last stage is the step itself.
                see(extremes, system, t + taken);
                balanced = balance.check((system, state), options, t + taken, self.steps);
                taken
            }
            Stepper::Rosenbrock(integrator) => {
                let t = self.time;
                let go = |system: &mut System, step, attempt: &mut Attempt| {
                    integrator.attempt(system, t, step, state, attempt);
                };
                let (taken, next) =
                    accepted(system, self.control.as_mut(), t, self.steps, step, attempt, go)?;
                self.step_size = next.unwrap_or(self.step_size);
                std::mem::swap(state, &mut attempt.state);
                system.tidy(t + taken, state);
                integrator.accept(system, t + taken, taken, &attempt.state, state);
                see(extremes, system, t + taken);
                balanced = balance.check((system, state), options, t + taken, self.steps);
                taken
            }
        };
        self.steps += 1;
        self.time += taken;
        self.watch()?;
        balanced?;
        Ok(taken)
    }

    /// Takes the state across a `corner`, which is the present time: where given motions have it,
    /// velocities jump to what they are after it. The drives do the work of the jump, an impulse
    /// that the contacts do not feel.
    pub fn cross_corner(&mut self, corner: f64) {
        let Simulation { system, state, rates, time, .. } = self;
        if !system.assembly.jolts_at(corner) {
            system.latest = f64::INFINITY;
            self.take_first_rates();
            return;
        }
        let time = time.max(corner);
        let mut energy = |system: &mut System, state: &[f64]| {
            system.evaluate(time, state, rates);
            system.energy(state).total()
        };
        let before = energy(system, state);
        system.latest = f64::INFINITY;
        system.tidy(time, state);
        let after = energy(system, state);
        state[system.places.ledger_entry(Ledger::Drives)] += after - before;
        self.take_first_rates();
    }

    /// Loads, energies and ledger at the present state.
    pub fn snapshot(&mut self) -> Snapshot {
        self.system.evaluate(self.time, &self.state, &mut self.rates);
        see(&mut self.extremes, &self.system, self.time);
        self.balance.snapshot(&self.system, &self.state, self.time)
    }

    /// Rates of the state at the last snapshot.
    pub fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// Largest energy unaccounted for at any look, J.
    pub fn largest_residual(&self) -> f64 {
        self.balance.watch.largest_residual
    }

    /// Whether the energy of a run that is over has added up, where it was too short for the looks at it to tell.
    ///
    /// # Errors
    /// More energy unaccounted for than the options allow.
    pub fn close(&self, last: &Snapshot) -> Result<(), SimulationError> {
        self.balance.at_end(last, &self.options, self.steps)
    }
}
