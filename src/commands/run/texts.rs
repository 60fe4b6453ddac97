//! Texts on the steps of a run: before, during and after it.

use super::prepared::{Prepared, SolutionMethod};
use bearing_dynamics::motion::bonded_bushing::{BondedBushing, BondedRubber};
use bearing_dynamics::motion::coupling::CoupledMotion;
use bearing_dynamics::motion::explicit_solid::SteppedSolid;
use bearing_dynamics::motion::integrator_choice::Choice;
use bearing_dynamics::motion::simulation::{Integrator, Simulation, Stepping as BearingStepping};
use bearing_dynamics::numeric::clock::{Clock, given_steps, rounded};
use bearing_dynamics::output::session::{Motion, MovingRubber, RunRequest, Session};
use bearing_dynamics::output::state::StateFile;
use bearing_dynamics::solids::explicit::ExplicitSolid;
use bearing_dynamics::solids::rubber::steps::Stepping;

/// Time step, its limit, the number of steps, and the time of a resumed state.
pub(super) fn announcement(
    session: &Session,
    prepared: &Prepared,
    request: &RunRequest,
    choice: Option<&Choice>,
    kept: Option<&StateFile>,
) -> String {
    let clock = &session.clock;
    let mut text = match (&session.motion, prepared) {
        (Motion::Bearing(simulation), prepared) => {
            let steps = of_bearing(simulation, clock, request, choice);
            match prepared {
                Prepared::Bearings {
                    housings, method: SolutionMethod::Reduced(shapes), ..
                } => shapes.text(housings) + &steps,
                _ => steps,
            }
        }
        (Motion::Solid(moving), _) => of_solid(&moving.solid, clock),
        (Motion::Rubber(moving), _) => of_rubber(moving, clock),
        (Motion::Housed(housed), _) => of_housed(housed, clock, request),
        (
            Motion::QuasiStaticSequence(_),
            Prepared::Bearings {
                method: SolutionMethod::QuasiStaticSequence(bores, seconds), ..
            },
        ) => {
            let unknowns: usize = bores.iter().map(|bore| bore.sizes.unknowns).sum();
            let kept: usize = bores.iter().map(|bore| bore.sizes.kept).sum();
            let count = clock.last.unwrap_or(0);
            format!(
                "{unknowns} unknowns condensed onto {kept} bore nodes in {seconds:.2} s\n\
                 {count} equilibria to t = {} s, a row every {:.4e} s\n",
                rounded(count.saturating_sub(1) as f64 * clock.interval),
                clock.interval
            )
        }
        (Motion::QuasiStaticSequence(_), _) => String::new(),
    };
    if let Some(file) = kept {
        let (time, name) = (rounded(file.time), step_name(session));
        text += &format!("resumed at t = {time} s, {name} {}\n", file.steps);
    }
    text
}

fn of_bearing(
    simulation: &Simulation,
    clock: &Clock,
    request: &RunRequest,
    choice: Option<&Choice>,
) -> String {
    let integrator = request.options.integrator.name();
    if let BearingStepping::Accuracy(accuracy) = request.options.stepping {
        let by_plan = choice.map_or(String::new(), |choice| format!("chosen: {}\n", choice.reason));
        return format!(
            "{integrator}, accuracy {accuracy}: adaptive steps, the first of {:.4e} s\n\
             to t = {} s, a row every {:.4e} s\n{by_plan}",
            simulation.step_size, clock.end, clock.interval
        );
    }
    let reason = match &simulation.limit {
        Some(limit) => format!(
            "{} (stable up to {:.4e} s)",
            limit.reason(&simulation.system.assembly),
            limit.step
        ),
        None => match simulation.step_watch.smallest {
            Some(limit) => {
                format!("given ({:.3} of the largest stable one)", simulation.step_size / limit)
            }
            None => "given".into(),
        },
    };
    let method = match request.options.integrator {
        Integrator::RungeKutta => String::new(),
        other => format!("{}, ", other.name()),
    };
    let text = format!("{method}step {:.4e} s: {reason}\n", simulation.step_size);
    let steps = given_steps(&clock.corners, clock.row_interval(), clock.end, clock.step);
    text + &format!("{steps} steps to t = {} s, {}\n", clock.end, rows(clock, "steps"))
}

fn of_solid(solid: &ExplicitSolid, clock: &Clock) -> String {
    let limit = &solid.limit;
    let [x, y, z] = limit.at.map(|at| 1e3 * at);
    let steps = clock.last.unwrap_or(0);
    format!(
        "step {:.4e} s, {:.3} of the stability limit {:.4e} s{}; the limiting element, {}, is at x {x:.3}, \
         y {y:.3}, z {z:.3} mm\n{steps} steps to t = {} s, {}, fields every {} rows\n",
        clock.step,
        clock.step / limit.step,
        limit.step,
        if limit.is_bound { " (a safe bound: the iteration did not converge)" } else { "" },
        solid.model.labels.element(limit.element),
        rounded(steps as f64 * clock.step),
        rows(clock, "steps"),
        clock.rows_per_fields.unwrap_or(0)
    )
}

fn of_rubber(moving: &MovingRubber, clock: &Clock) -> String {
    let steps = match moving.stepping {
        Stepping::Accuracy(accuracy) => format!("accuracy {accuracy}: adaptive steps"),
        Stepping::Fixed(step) => format!("steps of {step:.4e} s"),
    };
    let rows = clock.last.unwrap_or(0);
    format!(
        "implicit, {steps}, at least one a row; {} unknowns\nto t = {} s, a row every {:.4e} s, fields every {} rows\n",
        moving.solid.model().unknowns.count,
        rounded(rows as f64 * clock.interval),
        clock.interval,
        clock.rows_per_fields.unwrap_or(0)
    )
}

fn of_housed(housed: &CoupledMotion, clock: &Clock, request: &RunRequest) -> String {
    let coupling_steps = clock.last.unwrap_or(0);
    let by_accuracy = match request.options.stepping {
        BearingStepping::Accuracy(accuracy) => format!(
            "{}, accuracy {accuracy}: adaptive steps of the bearing; coupling steps and the steps of solids are fixed\n",
            request.options.integrator.name()
        ),
        _ => String::new(),
    };
    let mut solids: Vec<String> = housed.solids.iter().map(of_solid_in_coupling_step).collect();
    solids.extend(housed.bushings.iter().map(of_bushing_in_coupling_step));
    let fits: String = housed
        .seats()
        .map(|fit| {
            let (tested, outside_range) = fit.counts();
            let of = fit.seat.suffix();
            format!("{tested} bore nodes{of} near the race, {outside_range} too far for contact\n")
        })
        .collect();
    format!(
        "coupling step {:.4e} s, {}; bearing steps up to {:.4e} s\n{by_accuracy}{fits}{coupling_steps} coupling steps to t = {} s, {}\n",
        housed.coupling_step,
        solids.join("; "),
        housed.simulation.step_size,
        rounded(coupling_steps as f64 * housed.coupling_step),
        rows(clock, "coupling steps")
    )
}

fn of_solid_in_coupling_step(part: &SteppedSolid) -> String {
    let limit = &part.solid.limit;
    let [x, y, z] = limit.at.map(|at| 1e3 * at);
    let steps = match part.steps {
        1 => "one step".into(),
        count => format!("{count} steps"),
    };
    let of = part.name.as_ref().map_or(String::new(), |name| format!(" {name}"));
    let what = part.kind();
    let of = if of.strip_prefix(' ') == Some(what) { String::new() } else { of };
    format!(
        "{steps} of the {what}{of} in it; limit of the {what} {:.4e} s, its limiting element, {}, at x {x:.3}, \
         y {y:.3}, z {z:.3} mm",
        limit.step,
        part.solid.model.labels.element(limit.element),
    )
}

fn of_bushing_in_coupling_step(bushing: &BondedBushing) -> String {
    let steps = match bushing.steps {
        1 => "one step".into(),
        count => format!("{count} steps"),
    };
    let name = &bushing.name;
    match &bushing.rubber {
        BondedRubber::Explicit(solid) => format!(
            "{steps} of the bushing {name} in it (explicit, {} elements of four nodes; limit {:.4e} s)",
            solid.model.problem.elements.len(),
            solid.limit.step
        ),
        BondedRubber::Implicit(solid) => format!(
            "{steps} of the bushing {name} in it (implicit, {} elements of ten nodes, {} unknowns)",
            solid.model().problem.elements.len(),
            solid.model().unknowns.count
        ),
    }
}

/// Output interval, and the requested one if it was rounded.
fn rows(clock: &Clock, of: &str) -> String {
    let (interval, asked) = (clock.row_interval(), clock.interval);
    let off = if (interval / asked - 1.0).abs() > 1e-9 {
        format!(" ({asked} s requested, rounded to whole {of})")
    } else {
        String::new()
    };
    format!("a row every {} {of} = {interval:.4e} s{off}", clock.steps_per_row)
}

fn step_name(session: &Session) -> &'static str {
    match session.motion {
        Motion::Bearing(_) | Motion::Solid(_) => "step",
        Motion::Housed(_) => "coupling step",
        Motion::QuasiStaticSequence(_) => "equilibrium",
        Motion::Rubber(_) => "row",
    }
}

pub(super) fn place(session: &Session) -> String {
    let (time, done) = (rounded(session.motion.time()), session.motion.done());
    let counted = match session.motion {
        Motion::Bearing(_) | Motion::Solid(_) => "steps",
        Motion::Housed(_) => "coupling steps",
        Motion::QuasiStaticSequence(_) => "equilibria",
        Motion::Rubber(_) => "rows",
    };
    format!("t = {time} s of {} s, after {done} {counted}", session.clock.end)
}

pub(super) fn progress(session: &Session) -> String {
    let (time, end) = (session.motion.time(), session.clock.end);
    let name = step_name(session);
    match (&session.motion, session.clock.last) {
        (Motion::QuasiStaticSequence(_) | Motion::Rubber(_), Some(all)) => {
            format!("{name} {} of {all}", session.motion.done())
        }
        (Motion::Bearing(simulation), _) => {
            format!("t = {time:.5} of {end} s, {name} {:.2e} s", simulation.step_size)
        }
        _ => format!("t = {time:.5e} of {end:.3e} s, {name} {:.2e} s", session.clock.step),
    }
}
