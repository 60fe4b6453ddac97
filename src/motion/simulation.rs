//! A simulation: the state, its integration in time, and the checks of each step.

use crate::assembly::lists::Assembly;
use crate::members::body::Body;
use crate::members::contacts::Kernel;
use crate::members::rigid_body::Wrench;
use crate::members::state::{BodyState, Ledger};
use crate::motion::dormand_prince::DormandPrince;
use crate::motion::energy_ledger::Balance;
use crate::motion::error_control::{Attempt, Controller};
use crate::motion::extremes::Extremes;
use crate::motion::rk4::RungeKutta;
use crate::motion::rosenbrock::Rosenbrock;
use crate::motion::stability::{StepLimit, step_limit};
use crate::motion::step_watch::{StepWatch, Stiffness, stiffness};
use crate::motion::system::System;
use crate::motion::{dormand_prince, plan as motion, rosenbrock, start};
use crate::plan::Stage;

pub use crate::motion::energy_ledger::Snapshot;
pub use crate::motion::error::SimulationError;

/// Start of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Static equilibrium under the loads at t = 0, balls and cage rolling.
    Equilibrium,
    /// Nominal positions, balls and cage rolling at the prescribed speed.
    Nominal,
}

/// Choice of the step size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stepping {
    /// Fixed step, s.
    Fixed(f64),
    /// This fraction of the stability limit of Runge–Kutta at the start, chosen again when the limit falls to the step.
    FractionOfLimit(f64),
    /// Error control: the error of the races' motion stays below this fraction of the largest overlap.
    Accuracy(f64),
}

/// Integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Classical fourth-order Runge–Kutta, as in the source; without error control.
    RungeKutta,
    /// Explicit, fifth order with error estimate: for bearings without stiff traction.
    DormandPrince,
    /// Linearly implicit, third order with error estimate: neither contacts nor traction limit the step.
    Rosenbrock,
}

impl Integrator {
    /// Name in scenes and results.
    pub fn name(self) -> &'static str {
        match self {
            Integrator::RungeKutta => "rk4",
            Integrator::DormandPrince => "dormand-prince",
            Integrator::Rosenbrock => "rosenbrock",
        }
    }
}

/// Error control fails below this step, s: a millionth of a thousandth of a period of the stiffest contact.
const SHORTEST_STEP: f64 = 1e-14;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunOptions {
    pub start: Start,
    pub integrator: Integrator,
    pub stepping: Stepping,
    pub driver: Kernel,
    /// Largest energy residual, as a fraction of the energy turned over: largest contact energy plus all work and
    /// losses; with error control also the kinetic energy and the energy exchanged with the contacts between two
    /// checks.
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

/// A simulation at the present time.
pub struct Simulation {
    pub system: System,
    pub state: Vec<f64>,
    pub time: f64,
    /// Size of the next step, s.
    pub step_size: f64,
    pub steps: u64,
    /// Stability limit at the start, or when the step was last shortened; `None` if the step does not follow from it.
    pub limit: Option<StepLimit>,
    /// Contact stiffness since then.
    pub step_watch: StepWatch,
    /// Extremes of each bearing over the evaluated states: for Runge–Kutta the last step is missing unless a snapshot
    /// was taken.
    pub extremes: Vec<Extremes>,
    /// `None` without error control.
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
///
/// A choice of step that the integrator does not offer.
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

/// Tries `step` and, with error control, shorter ones until the error is accepted. Returns its size and the size of the
/// next step.
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
        // Time would not advance.
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

/// Records the evaluated state in the extremes of each bearing.
fn record_extremes(extremes: &mut [Extremes], system: &System, time: f64) {
    for (index, extremes) in extremes.iter_mut().enumerate() {
        extremes.record(system, index, time);
    }
}

impl Simulation {
    /// # Errors
    ///
    /// No equilibrium at the start, an invalid step, or an invalid start (see [`crate::motion::validity`]).
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

    /// Continues from a state vector at a time, with the same bits; the energy balance starts here.
    ///
    /// # Errors
    ///
    /// An invalid step.
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
            // The overlaps set it, below.
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
        record_extremes(&mut extremes, &system, time);
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

    /// Options of the run.
    pub fn options(&self) -> &RunOptions {
        &self.options
    }

    /// Evaluates the first stage at the present state, history included, for integrators that keep it.
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

    /// State of a body at the present time.
    pub fn body(&self, index: usize) -> BodyState {
        self.system.body_state(&self.state, index)
    }

    /// Sets the external loads on bodies for the steps to come; their work counts as that of foundations.
    pub fn set_outside_loads(&mut self, loads: &[(usize, Wrench)]) {
        for (body, load) in loads {
            self.system.outside[*body] = Some(*load);
        }
        self.take_first_rates();
    }

    /// Takes one step.
    ///
    /// # Errors
    ///
    /// A non-finite value or an invalid state (see [`crate::motion::validity`]); the state is that after the step.
    pub fn step(&mut self) -> Result<(), SimulationError> {
        self.step_by(self.step_size).map(|_| ())
    }

    /// Takes one step of at most a given size, as before an output; exactly that size without error control. Returns
    /// its size.
    ///
    /// # Errors
    ///
    /// See [`Simulation::step`].
    pub fn step_by(&mut self, step: f64) -> Result<f64, SimulationError> {
        let step = match self.control {
            Some(_) => step.min(self.system.longest_past_profiles(&self.state)),
            None => step,
        };
        let Simulation { system, state, attempt, extremes, balance, options, .. } = self;
        let mut balanced = Ok(());
        let taken = match &mut self.integrator {
            Stepper::RungeKutta(integrator) => {
                let t = self.time;
                integrator.step(system, t, step, state, |system, state| {
                    record_extremes(extremes, system, t);
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
                // The last stage is the new state.
                record_extremes(extremes, system, t + taken);
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
                record_extremes(extremes, system, t + taken);
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

    /// Takes the state across a `corner` at the present time: velocities of prescribed motions jump to their values
    /// after it. The drives do the work of the jump, an impulse that the contacts do not feel.
    pub fn cross_corner(&mut self, corner: f64) {
        if self.system.assembly.jolts_at(corner) {
            self.jump(self.time.max(corner), |system| system.latest = f64::INFINITY);
        } else {
            self.system.latest = f64::INFINITY;
            self.take_first_rates();
        }
    }

    /// Changes loads and prescribed motions of bodies at the present time; positions and velocities may jump. The
    /// drives do the work of the jump.
    pub fn change_drives(&mut self, change: impl FnOnce(&mut [Body])) {
        self.jump(self.time, |system| change(&mut system.assembly.bodies));
    }

    fn jump(&mut self, time: f64, change: impl FnOnce(&mut System)) {
        let Simulation { system, state, rates, .. } = self;
        let mut energy = |system: &mut System, state: &[f64]| {
            system.evaluate(time, state, rates);
            system.energy(state).total()
        };
        let before = energy(system, state);
        change(system);
        system.tidy(time, state);
        let after = energy(system, state);
        state[system.places.ledger_entry(Ledger::Drives)] += after - before;
        self.take_first_rates();
    }

    /// Loads, energies and ledger at the present time.
    pub fn snapshot(&mut self) -> Snapshot {
        self.system.evaluate(self.time, &self.state, &mut self.rates);
        record_extremes(&mut self.extremes, &self.system, self.time);
        self.balance.snapshot(&self.system, &self.state, self.time)
    }

    /// Rates of the state at the last snapshot.
    pub fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// Largest energy residual at any check, J.
    pub fn largest_residual(&self) -> f64 {
        self.balance.watch.largest_residual
    }

    /// Checks the energy balance at the end of a run that is too short for the checks within it.
    ///
    /// # Errors
    ///
    /// An energy residual beyond the limit in the options.
    pub fn close(&self, last: &Snapshot) -> Result<(), SimulationError> {
        self.balance.at_end(last, &self.options, self.steps)
    }
}
