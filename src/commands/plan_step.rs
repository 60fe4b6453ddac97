//! Time step of a run in its plan: length, stability limit, and number of steps.

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::motion::clocked::RunRequest;
use bearing_dynamics::motion::simulation::{
    Integrator, RunOptions, Simulation, SimulationError, Stepping,
};
use bearing_dynamics::motion::stability::StepLimit;
use bearing_dynamics::motion::step_watch::TOLERATED;
use bearing_dynamics::numeric::clock::{given_steps, to_digits, whole_steps};
use std::error::Error;

pub fn step_line(assembly: &Assembly, request: &RunRequest) -> String {
    let options = &request.options;
    match options.stepping {
        Stepping::Accuracy(accuracy) => adaptive(assembly, request, accuracy),
        Stepping::Fixed(step) if options.integrator != Integrator::RungeKutta => {
            note("given step", &format!("{step:.3e} s: {}", steps(assembly, request, step)))
        }
        // The stability limit does not depend on the fraction.
        Stepping::Fixed(step) => {
            let limited = RunOptions { stepping: Stepping::FractionOfLimit(1.0), ..*options };
            let text = match Simulation::new(assembly.clone(), limited) {
                Ok(simulation) => simulation
                    .limit
                    .map_or(NOT_STIFF.into(), |limit| relative_to_limit(assembly, step, &limit)),
                Err(SimulationError::NoStep) => NOT_STIFF.into(),
                Err(error) => refused(&error),
            };
            note("given step", &format!("{text}; {}", steps(assembly, request, step)))
        }
        Stepping::FractionOfLimit(fraction) => automatic(assembly, request, fraction),
    }
}

const NOT_STIFF: &str = "no contact is stiff at the start";

pub fn note(name: &str, text: &str) -> String {
    format!("notes {name:<28} {text}")
}

pub fn refused(error: &dyn Error) -> String {
    format!("the run will be refused: {error}")
}

fn steps(assembly: &Assembly, request: &RunRequest, step: f64) -> String {
    let RunRequest { end, output_interval, .. } = request;
    let count = given_steps(&assembly.corners(), *output_interval, *end, step);
    format!("{count} steps to t = {end} s")
}

fn relative_to_limit(assembly: &Assembly, step: f64, limit: &StepLimit) -> String {
    let ratio = step / limit.step;
    let verdict = match ratio {
        r if r > TOLERATED => "too long, the run will be refused",
        r if r > 1.0 => "longer than stable",
        _ => "stable at the start",
    };
    format!(
        "{step:.3e} s is {ratio:.3} of the largest stable one at the start, {:.3e} s ({}): {verdict}",
        limit.step,
        limit.reason(assembly)
    )
}

fn automatic(assembly: &Assembly, request: &RunRequest, fraction: f64) -> String {
    let simulation = match Simulation::new(assembly.clone(), request.options) {
        Ok(simulation) => simulation,
        Err(error) => return note("step", &refused(&error)),
    };
    let Some(limit) = &simulation.limit else { return note("step", NOT_STIFF) };
    let per_row = whole_steps(request.output_interval, simulation.step_size);
    let step = request.output_interval / per_row as f64;
    let text = format!(
        "{step:.3e} s, from {fraction} of the largest stable one at the start, {:.3e} s ({}): {}, more if contacts \
         get stiffer and shorten it",
        limit.step,
        limit.reason(assembly),
        steps(assembly, request, step)
    );
    note("step", &text)
}

fn adaptive(assembly: &Assembly, request: &RunRequest, accuracy: f64) -> String {
    let simulation = match Simulation::new(assembly.clone(), request.options) {
        Ok(simulation) => simulation,
        Err(error) => return note("step", &refused(&error)),
    };
    let overlap = simulation.control.as_ref().map_or(0.0, |control| control.memory.displacement);
    let text = format!(
        "adaptive: error of the races' motion near {accuracy} of the largest contact overlap, at the start {} of {} um; \
         first step {:.3e} s, no step longer than the output interval",
        to_digits(accuracy * 1e6 * overlap, 3),
        to_digits(1e6 * overlap, 5),
        simulation.step_size
    );
    note("step", &text)
}
