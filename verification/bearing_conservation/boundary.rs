//! The largest stable step: predicted from the Jacobian, from a closed form, and observed.

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::motion::simulation::Simulation;
use bearing_dynamics::motion::stability::{StepLimit, step_limit};
use bearing_dynamics::motion::system::System;

use super::{deep_groove, difference, oracle, preloaded, simulation, velocities};
use crate::bearings::{self, Hertz};
use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::{self, RPM};

/// Growth of a nudge over 200 steps.
fn growth(problem: &DynamicProblem, state: &[f64], step: f64) -> Result<f64, CaseError> {
    const SIZE: f64 = 1e-8;
    let entries = velocities(problem);
    let mut nudged = state.to_vec();
    for (i, (at, unit)) in entries.iter().enumerate() {
        nudged[*at] += SIZE / unit * (1.7 * i as f64 + 0.3).sin();
    }
    let mut ends = Vec::new();
    for state in [state, &nudged] {
        let mut simulation = simulation(problem, state, step)?;
        for _ in 0..200 {
            // A run that leaves its races has grown.
            if simulation.step().is_err() {
                return Ok(f64::INFINITY);
            }
        }
        ends.push(simulation.state);
    }
    Ok(difference(&entries, &ends[0], &ends[1]) / SIZE)
}

/// Predicted limit at a state past the first slips, and the largest step at which a nudge does not
/// grow, s.
fn boundary(problem: &DynamicProblem) -> Result<(StepLimit, f64), CaseError> {
    let mut settled = Simulation::new(problem.clone(), motion::fixed_step(0.1e-6))?;
    motion::run(&mut settled, 10_000)?;
    let state = settled.state;
    let mut system = System::new(problem.clone(), Kernel::Simd);
    let limit = step_limit(&mut system, 0.0, &state)
        .ok_or_else(|| CaseError::message("nothing limits the step"))?;
    let (mut low, mut high) = (0.6 * limit.step, 1.7 * limit.step);
    for _ in 0..8 {
        let middle = (low * high).sqrt();
        // A percent above the limit a mode grows by some 3 % a step: e⁶ in 200 steps.
        if growth(problem, &state, middle)? <= 10.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok((limit, low))
}

pub(super) fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let radial = [50.0, 0.0, -1500.0, 0.0, 0.0];
    let loaded = |regularisation: Option<f64>| -> Result<DynamicProblem, CaseError> {
        let mut problem = motion::moving(&deep_groove(-5e-6), 0.1, radial, 1000.0 * RPM)?;
        if let Some(regularisation_speed) = regularisation {
            problem.traction = TractionLaw::Constant { coefficient: 0.07, regularisation_speed };
        }
        Ok(problem)
    };
    let cases = [
        ("preload", "−20 µm, races free, no traction", preloaded()?),
        ("contact", "1500 N at 1000 rpm, no traction", loaded(None)?),
        ("gentle", "the same, traction regularised below 0.05 m/s", loaded(Some(0.05))?),
        ("steep", "the same, below 0.005 m/s", loaded(Some(0.005))?),
    ];
    let mut rows = Vec::new();
    for (tag, name, problem) in cases {
        let (limit, observed) = boundary(&problem)?;
        context.check(
            Check::new(
                &format!("limit_{tag}"),
                &format!("predicted step limit: {name}"),
                "µs",
                1e6 * limit.step,
            )
            .consistency(
                1e6 * observed,
                "predicted limit against our own steps: bisection for the step at which a nudge grows over 200 steps",
            )
            .relative(
                0.02,
                "200 steps tell growth from 1 % above the limit on; the state moves on meanwhile",
            )
            .golden(GoldenTolerance { relative: 1e-4, absolute: 0.0 }),
        );
        rows.push(vec![
            name.to_string(),
            limit.reason(&problem.assembly()),
            format!("{:.3}", 1e6 * limit.step),
            format!("{:.3}", 1e6 * observed),
            format!("{:.3}", observed / limit.step),
        ]);
    }
    let columns =
        ["bearing", "what limits", "predicted, µs", "observed, µs", "observed over predicted"];
    context.table("boundary", "Largest stable step of Runge–Kutta", &columns, rows);
    closed_form(context)
}

/// The preloaded bearing at rest, whose fastest mode three coordinates describe.
fn closed_form(context: &mut CaseContext) -> Result<(), CaseError> {
    let problem = preloaded()?;
    let lengths = deep_groove(-20e-6);
    let mut system = System::new(problem.clone(), Kernel::Simd);
    let still = Simulation::new(problem.clone(), motion::fixed_step(1e-6))?;
    let limit = step_limit(&mut system, 0.0, &still.state)
        .ok_or_else(|| CaseError::message("nothing limits the step"))?;
    let bearing = bearings::oracle(&lengths, Hertz::Fit, 0.0);
    let slopes = oracle::squeezed([bearing.stiffness_inner, bearing.stiffness_outer], 20e-6);
    let ball_mass = 7850.0 * 4.0 / 3.0 * std::f64::consts::PI * bearing.ball_radius.powi(3);
    let race_mass = 7850.0 * std::f64::consts::PI * (22e-3_f64.powi(2) - 15e-3_f64.powi(2)) * 12e-3;
    let pulsation = oracle::stiffest(slopes, lengths.balls as f64, ball_mass, race_mass);
    context.check(
        Check::new(
            "limit_closed_form",
            "predicted step limit, preloaded bearing at rest",
            "µs",
            1e6 * limit.step,
        )
        .closed_form(
            1e6 * 8_f64.sqrt() / pulsation,
            "2√2/ω, ω of balls moving by cos θ between two free races, three coordinates",
        )
        .relative(
            1e-4,
            "loads across the contacts, 1e-4 of whose stiffness the closed form leaves out at most",
        ),
    );
    Ok(())
}
