//! Order of the integration: four on smooth motion, five halves where contacts make and break.

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::body::Rotation;
use bearing_dynamics::members::state::{Layout, VELOCITY};
use bearing_dynamics::motion::start;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};

use super::{difference, oracle, order, preloaded, preloaded_start, simulation, velocities};
use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;
use crate::motion;

/// State after `time`, and contacts loaded on the mean (of 16).
fn end(
    problem: &DynamicProblem,
    state: &[f64],
    step: f64,
    time: f64,
) -> Result<(Vec<f64>, f64), CaseError> {
    let mut simulation = simulation(problem, state, step)?;
    motion::run(&mut simulation, (time / step).round() as usize)?;
    let work = simulation.system.work;
    Ok((simulation.state, work.loaded_contacts as f64 / work.evaluations as f64))
}

const FINEST: f64 = 0.015625e-6;

pub(super) fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let steps = [0.5e-6, 0.25e-6, 0.125e-6, 0.0625e-6];
    let laws = [
        ("frictionless", "without traction", TractionLaw::None),
        (
            "traction",
            "with traction",
            TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.05 },
        ),
    ];
    let mut curves = Vec::new();
    for (tag, name, law) in laws {
        let mut problem = preloaded()?;
        problem.traction = law;
        let state = preloaded_start(&problem);
        let entries = velocities(&problem);
        let (reference, loaded) = end(&problem, &state, FINEST, 0.2e-3)?;
        let mut errors = Vec::new();
        for step in steps {
            errors.push(difference(&entries, &end(&problem, &state, step, 0.2e-3)?.0, &reference));
        }
        context.check(
            Check::new(
                &format!("smooth_contacts_{tag}"),
                &format!("contacts loaded, {name}"),
                "1",
                loaded,
            )
            .consistency(
                16.0,
                "our run against all contacts of 8 balls: a condition of the check after it, smooth motion",
            )
            .absolute(0.0, "one opening would show"),
        );
        context.check(
            Check::new(
                &format!("order_{tag}"),
                &format!("order of Runge–Kutta on smooth motion, {name}"),
                "1",
                order(errors[2], errors[3]),
            )
            .closed_form(
                4.0,
                "classical fourth-order Runge–Kutta; errors against a step of 1/64 µs",
            )
            .absolute(0.1, "the next order adds 1 % at ωh = 0.03, the reference's own error 0.1 %"),
        );
        curves.push(Curve::new(format!("smooth, {name}"), pairs(&steps, &errors)));
    }
    make_and_break(context, &mut curves)?;
    let guide = |name: &str, from: [f64; 2], order: f64| {
        Curve::new(name, vec![from, [0.125 * from[0], from[1] * 0.125_f64.powf(order)]])
    };
    let first = |curves: &[Curve], i: usize| curves[i].points[0];
    let fourth = guide("order 4", [first(&curves, 0)[0], 0.4 * first(&curves, 0)[1]], 4.0);
    let half = guide("order 5/2", [first(&curves, 2)[0], 2.0 * first(&curves, 2)[1]], 2.5);
    curves.extend([fourth, half]);
    let svg = xy(&XyPlot {
        title: "Error of velocities over the step".into(),
        x: Axis::log("step", "µs"),
        y: Axis::log("error", "m/s"),
        style: Style::LinesAndMarkers,
        curves,
    })?;
    context.figure(
        "orders",
        svg,
        "Smooth motion for 0.2 ms, and a bearing with 10 µm clearance whose contacts make and break for 0.15 ms (mean of the \
         logarithms over 24 starts), against runs with a step of 1/64 µs.",
    );
    Ok(())
}

fn pairs(steps: &[f64], errors: &[f64]) -> Vec<[f64; 2]> {
    steps.iter().zip(errors).map(|(step, error)| [1e6 * step, *error]).collect()
}

/// Least-squares slope of log₂ errors over three halvings.
fn slope(logs: &[f64; 4]) -> f64 {
    (3.0 * (logs[0] - logs[3]) + logs[1] - logs[2]) / 10.0
}

/// Numbers in [−1, 1] that fill the interval evenly.
fn spread(index: usize) -> f64 {
    2.0 * (0.618_033_988_749_894_9 * (index + 1) as f64).fract() - 1.0
}

fn make_and_break(context: &mut CaseContext, curves: &mut Vec<Curve>) -> Result<(), CaseError> {
    const STARTS: usize = 24;
    let mut problem = motion::moving(&super::deep_groove(10e-6), 0.1, [0.0; 5], 0.0)?;
    problem.inner = motion::race([0.0; 5], Rotation::Torque(Profile::ZERO));
    let layout = Layout::new(problem.geometry.ball_count, false);
    let entries = velocities(&problem);
    let steps = [1e-6, 0.5e-6, 0.25e-6, 0.125e-6];
    let (mut logs, mut loaded) = ([0.0; 4], 0.0);
    for seed in 0..STARTS {
        let mut state = start::nominal(&problem.assembly());
        for i in 0..3 {
            state[layout.inner() + VELOCITY + i] = 0.2 * spread(3 * seed + i);
        }
        let (reference, contacts) = end(&problem, &state, FINEST, 0.15e-3)?;
        loaded += contacts / STARTS as f64;
        for (log, step) in logs.iter_mut().zip(steps) {
            let error = difference(&entries, &end(&problem, &state, step, 0.15e-3)?.0, &reference);
            *log += error.log2() / STARTS as f64;
        }
    }
    context.check(
        Check::new("order_make_break", "order where contacts make and break, 24 starts", "1", slope(&logs))
            .closed_form(2.5, "the force has a corner like δ^(3/2): off by h^(3/2) in the step that crosses it, its impulse by h^(5/2)")
            .absolute(0.4, "where in its step a crossing falls is chance: over 24 starts the order scatters by 0.2"),
    );
    let bounces = [0.1, 0.05, 0.025, 0.0125].map(oracle::bounce_error_log2);
    context.check(
        Check::new(
            "order_make_break_oracle",
            "order where contacts open and close, against one bounce",
            "1",
            slope(&logs),
        )
        .independent(
            slope(&bounces),
            "a mass that bounces off a 3/2-power spring by a Runge–Kutta of its own, 400 bounces",
        )
        .absolute(0.4, "as above; the bounces' own order scatters by 0.1"),
    );
    context.check(
        Check::new(
            "contacts_make_break",
            "contacts loaded on the mean, 10 µm clearance",
            "1",
            loaded,
        )
        .consistency(
            16.0,
            "our run against all contacts of 8 balls: a condition of the check before",
        )
        .at_most(1.0, "contacts do open"),
    );
    context.finding(
        "five_halves",
        format!(
            "Where a contact begins or ends the force K δ^(3/2) has a corner in its slope. The step that crosses it has \
             a wrong velocity of order h^(5/2); the steps after it see smooth motion again. A fixed number of crossings \
             leaves an error of order 5/2, with a factor that depends on where in its step each falls. Measured {:.2}; \
             one bounce of a mass on such a spring, {:.2}. Fourth order is for motions whose contacts stay closed.",
            slope(&logs),
            slope(&bounces)
        ),
    );
    curves.push(Curve::new("contacts make and break", pairs(&steps, &logs.map(f64::exp2))));
    Ok(())
}
