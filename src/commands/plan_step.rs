//! What `bearing plan` says of the steps of a run: how long, why, how many, and what would make them
//! longer.

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::motion::clocked::RunRequest;
use bearing_dynamics::motion::foretell::{FARTHEST_OFF, Foretold, WITHIN, foretell};
use bearing_dynamics::motion::simulation::{
    Integrator, RunOptions, Simulation, SimulationError, Stepping,
};
use bearing_dynamics::motion::stability::{Cause, StepLimit, step_limit};
use bearing_dynamics::motion::step_watch::TOLERATED;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::clock::{given_steps, to_digits, whole_steps};
use std::error::Error;

/// From here on a friction onset that makes steps shorter than contacts need is worth a word.
const WORTH_A_WORD: f64 = 3.0;

/// A still gentler onset is no small change of the friction law, and not proposed.
const MOST_GENTLER: f64 = 10.0;

/// The step of a run at its start, and advice where the onset of friction makes it short.
pub fn step_lines(assembly: &Assembly, request: &RunRequest) -> Vec<String> {
    let options = &request.options;
    match options.stepping {
        Stepping::Accuracy(accuracy) => adaptive(assembly, request, accuracy),
        Stepping::Fixed(step) if options.integrator != Integrator::RungeKutta => {
            vec![note("given step", &format!("{step:.3e} s: {}", steps(assembly, request, step)))]
        }
        // The start is the same; the limit does not depend on the fraction.
        Stepping::Fixed(step) => {
            let limited = RunOptions { stepping: Stepping::FractionOfLimit(1.0), ..*options };
            let (said, advice) = match Simulation::new(assembly.clone(), limited) {
                Ok(mut simulation) => match simulation.limit {
                    Some(limit) => (against(step, &limit), advice(&mut simulation, &limit)),
                    None => (NOT_STIFF.into(), None),
                },
                Err(SimulationError::NoStep) => (NOT_STIFF.into(), None),
                Err(error) => (refused(&error), None),
            };
            let said = format!("{said}; {}", steps(assembly, request, step));
            std::iter::once(note("given step", &said)).chain(advice).collect()
        }
        Stepping::FractionOfLimit(fraction) => automatic(assembly, request, fraction),
    }
}

const NOT_STIFF: &str = "no contact is stiff at the start";

pub fn note(name: &str, said: &str) -> String {
    format!("notes {name:<28} {said}")
}

pub fn refused(error: &dyn Error) -> String {
    format!("WARNING: the run will be refused: {error}")
}

fn steps(assembly: &Assembly, request: &RunRequest, step: f64) -> String {
    let RunRequest { end, output_interval, .. } = request;
    let count = given_steps(&assembly.corners(), *output_interval, *end, step);
    format!("{count} steps to t = {end} s")
}

/// How many steps, and where the number comes from.
fn foretold(assembly: &Assembly, request: &RunRequest) -> String {
    match foretell(assembly, request) {
        Err(error) => refused(&error),
        Ok(Foretold { failure: Some((at, error)), .. }) => {
            format!("WARNING: a trial ended at t = {at:.3e} s, as the run will: {error}")
        }
        Ok(found) if found.whole => {
            format!(
                "{} steps to t = {} s, counted in a trial of the whole run",
                found.steps, request.end
            )
        }
        Ok(found) => {
            let [least, most] = FARTHEST_OFF;
            let looks = match found.looks {
                2.. => format!(" at {} times of the run", found.looks),
                _ => " from the start on".into(),
            };
            let doubt = found.doubt.map_or(String::new(), |(at, error)| {
                format!("; WARNING: a look that began in equilibrium later on ended at t = {at:.3e} s: {error}")
            });
            format!(
                "about {} steps to t = {} s, from a trial of {} of them{looks}, over {:.1e} s: most runs take {} to \
                 {WITHIN} times as many, the farthest off so far took {least} and {most}{}{doubt}",
                to_digits(found.steps, 2),
                request.end,
                found.taken,
                found.covered,
                1.0 / WITHIN,
                drifting(assembly)
            )
        }
    }
}

/// What no trial sees.
fn drifting(assembly: &Assembly) -> &'static str {
    match assembly.bearings.iter().all(|bearing| bearing.cage.is_some()) {
        true => "",
        false => {
            "; balls without a cage drift, and where they come to strike one another a hundred times as many"
        }
    }
}

fn against(step: f64, limit: &StepLimit) -> String {
    let ratio = step / limit.step;
    let verdict = match ratio {
        r if r > TOLERATED => "WARNING: too long, the run will be refused",
        r if r > 1.0 => "WARNING: longer than stable",
        _ => "stable at the start",
    };
    format!(
        "{step:.3e} s is {ratio:.3} of the largest stable one at the start, {:.3e} s ({}): {verdict}",
        limit.step,
        limit.reason()
    )
}

fn automatic(assembly: &Assembly, request: &RunRequest, fraction: f64) -> Vec<String> {
    let mut simulation = match Simulation::new(assembly.clone(), request.options) {
        Ok(simulation) => simulation,
        Err(error) => return vec![note("step", &refused(&error))],
    };
    let Some(limit) = simulation.limit else { return vec![note("step", NOT_STIFF)] };
    let per_row = whole_steps(request.output_interval, simulation.step_size);
    let step = request.output_interval / per_row as f64;
    let said = format!(
        "{step:.3e} s, from {fraction} of the largest stable one at the start, {:.3e} s ({}): {}; \
         shortened on the way where contacts get stiffer",
        limit.step,
        limit.reason(),
        foretold(assembly, request)
    );
    std::iter::once(note("step", &said)).chain(advice(&mut simulation, &limit)).collect()
}

fn adaptive(assembly: &Assembly, request: &RunRequest, accuracy: f64) -> Vec<String> {
    let simulation = match Simulation::new(assembly.clone(), request.options) {
        Ok(simulation) => simulation,
        Err(error) => return vec![note("step", &refused(&error))],
    };
    let overlap = simulation.control.as_ref().map_or(0.0, |control| control.memory.displacement);
    let caged = assembly.bearings.iter().any(|bearing| bearing.cage.is_some());
    let strikes = match caged {
        true => {
            "strikes of the cage, of balls or races let it grow (21 times in 20 ms with a cage at 1000 rpm)"
        }
        false => "strikes of balls or races let it grow",
    };
    let said = format!(
        "adapts so that the error of the races' motion stays near {accuracy} of the largest overlap of a \
         contact, at the start {} of {} um, as long as nothing strikes; {strikes}; at least a step a row, the first of {:.3e} s; {}",
        to_digits(accuracy * 1e6 * overlap, 3),
        to_digits(1e6 * overlap, 5),
        simulation.step_size,
        foretold(assembly, request)
    );
    vec![note("step", &said)]
}

/// What would make the step longer, where the onset of friction makes it much shorter than contacts
/// would.
fn advice(simulation: &mut Simulation, limit: &StepLimit) -> Option<String> {
    if limit.cause != Cause::Traction {
        return None;
    }
    let gain = limit_with(simulation, TractionLaw::None)?.step / limit.step;
    if gain < WORTH_A_WORD {
        return None;
    }
    let mut said = format!(
        "the onset of friction makes the step {gain:.1} times shorter than contacts would; longer \
         steps: numerics.accuracy = 1e-3 in place of rk4"
    );
    match onset(&simulation.system, gain.min(MOST_GENTLER)) {
        Onset::Speed { key, before, speed, law } => {
            if let Some(longer) = limit_with(simulation, law) {
                said += &format!(
                    ", or {key} = \"{speed} m/s\", {} times the present one: stable up to {:.3e} s, \
                     with less friction where parts creep slower than that",
                    to_digits(speed / before, 2),
                    longer.step
                );
            }
        }
        Onset::Rolling(speed) => {
            said += &format!(
                "; a larger traction.entrainment_floor helps only above the rolling speed of \
                 {} m/s",
                to_digits(speed, 2)
            );
        }
        Onset::Shape => {}
    }
    Some(note("short step", &said))
}

fn limit_with(simulation: &Simulation, traction: TractionLaw) -> Option<StepLimit> {
    let mut assembly = simulation.system.assembly.clone();
    for bearing in &mut assembly.bearings {
        bearing.traction = traction.clone();
    }
    let mut system = System::new(assembly, RunOptions::default().driver);
    step_limit(&mut system, simulation.time, &simulation.state)
}

/// What makes the onset of friction as steep as it is.
enum Onset {
    /// A speed of the scene; `speed` and `law` are those with a gentler onset.
    Speed { key: &'static str, before: f64, speed: f64, law: TractionLaw },
    /// The speed of rolling, m/s, above the floor of the scene.
    Rolling(f64),
    /// The curve itself.
    Shape,
}

/// With an onset that is gentler by `factor`, where a speed of the scene makes it.
fn onset(system: &System, factor: f64) -> Onset {
    let (Some(bearing), Some(set)) = (system.assembly.bearings.first(), system.sets.first()) else {
        return Onset::Shape;
    };
    match &bearing.traction {
        TractionLaw::SlideToRoll { curve, entrainment_floor } => {
            let before = *entrainment_floor;
            let table = &set.table;
            let rolling = table.active.iter().map(|&pair| table.sliding[pair].entrainment.abs());
            let rolling = rolling.fold(0.0, f64::max);
            if rolling > before {
                return Onset::Rolling(rolling);
            }
            let speed = two_digits_up(factor * before);
            let law = TractionLaw::SlideToRoll { curve: *curve, entrainment_floor: speed };
            Onset::Speed { key: "traction.entrainment_floor", before, speed, law }
        }
        TractionLaw::Constant { coefficient, regularisation_speed } => {
            let (before, coefficient) = (*regularisation_speed, *coefficient);
            let speed = two_digits_up(factor * before);
            let law = TractionLaw::Constant { coefficient, regularisation_speed: speed };
            Onset::Speed { key: "traction.regularisation_speed", before, speed, law }
        }
        _ => Onset::Shape,
    }
}

/// 0.0371 → 0.038.
fn two_digits_up(value: f64) -> f64 {
    let rounded = to_digits(value, 2);
    if rounded >= value { rounded } else { to_digits(1.05 * value, 2) }
}
