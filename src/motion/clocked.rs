//! Steps of a bearing by the clock of its run.

use crate::assembly::lists::Assembly;
use crate::motion::simulation::{RunOptions, Simulation, SimulationError, Stepping};
use crate::motion::step_watch::CHECK_EVERY;
use crate::numeric::clock::{Clock, whole_steps};
use crate::plan::channels::ChannelGroup;

/// Settings of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRequest {
    /// Step control and energy limit.
    pub options: RunOptions,
    /// s.
    pub end: f64,
    /// Requested time between rows, s.
    pub output_interval: f64,
    /// Requested time between files of fields, s; `None`: only at the end.
    pub fields_interval: Option<f64>,
    pub channels: Vec<ChannelGroup>,
}

/// Events at the end of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Arrival {
    /// A row is due.
    pub row: bool,
    /// The run is at its end.
    pub completes: bool,
}

/// A bearing at the start of its run, and the clock of the run.
///
/// A step that follows from the stability limit is shortened so that a whole number of steps makes an output interval;
/// with a prescribed step the interval is rounded to whole steps.
///
/// # Errors
///
/// No equilibrium at the start; an invalid step or one that is too long.
pub fn start(
    assembly: impl Into<Assembly>,
    request: &RunRequest,
) -> Result<(Simulation, Clock), SimulationError> {
    let mut simulation = Simulation::new(assembly, request.options)?;
    let interval = request.output_interval;
    let (step, steps_per_row) = match request.options.stepping {
        Stepping::FractionOfLimit(_) => {
            let steps = whole_steps(interval, simulation.step_size);
            (interval / steps as f64, steps)
        }
        Stepping::Fixed(step) => {
            simulation.judge_step_now()?;
            (step, (interval / step).round().max(1.0) as u64)
        }
        Stepping::Accuracy(_) => (0.0, 0),
    };
    if steps_per_row > 0 {
        simulation.step_size = step;
    }
    let corners = simulation.system.assembly.corners();
    let clock =
        Clock { end: request.end, interval, step, steps_per_row, corners, ..Clock::default() };
    Ok((simulation, clock))
}

/// Takes one step, up to the next event.
///
/// # Errors
///
/// See [`Simulation::step`].
pub fn step(simulation: &mut Simulation, clock: &Clock) -> Result<Arrival, SimulationError> {
    let stop = clock.next_stop(simulation.time, simulation.step_size);
    if let Some(corner) = stop.corner {
        simulation.system.latest = corner.next_down();
    }
    let taken = simulation.step_by(stop.size);
    if !matches!(taken, Ok(taken) if taken == stop.size) {
        simulation.system.latest = f64::INFINITY;
        return taken.map(|_| Arrival::default());
    }
    simulation.time = stop.at.unwrap_or(simulation.time);
    if let Some(corner) = stop.corner {
        simulation.cross_corner(corner);
    }
    Ok(Arrival { row: stop.row, completes: stop.completes })
}

/// Compares the step with the stability limit of the contacts, every few steps. A step that follows from the limit is
/// shortened, unless the run is complete: resuming continues from before its last step.
///
/// # Errors
///
/// A prescribed step that has become too long.
pub fn watch(
    simulation: &mut Simulation,
    clock: &mut Clock,
    is_complete: bool,
) -> Result<(), SimulationError> {
    if !simulation.steps.is_multiple_of(CHECK_EVERY) {
        return Ok(());
    }
    if let Some(step) = simulation.watch_step()?.filter(|_| !is_complete) {
        clock.shorten(step);
        simulation.shorten_step(clock.step);
    }
    Ok(())
}
