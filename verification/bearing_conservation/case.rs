//! What a bearing in motion conserves, and how closely the integration in time keeps it.

use bearing_dynamics::assembly::bearing_alone::{CageBody, DynamicProblem};
use bearing_dynamics::ch2_housing::bearing::cage::{CageContacts, CageForce, Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::inertia;
use bearing_dynamics::members::body::Rotation;
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::state::{BodyState, Layout, SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{RunOptions, Simulation, Start};
use bearing_dynamics::motion::stability::step_limit;
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};

use crate::bearings::{DEEP_GROOVE, Lengths};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::motion;

mod boundary;
mod oracle;
mod orders;
mod slices;

pub const CASE: Case = Case {
    id: "bearing_conservation",
    title: "Conservation, order of the integration, step boundary",
    section: "4.2.1.2, 2.2.1",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let (name, text, default) = motion::RACE_INERTIA;
    context.assumption(name, text, default);
    tops(context)?;
    energy_drift(context)?;
    orders::run(context)?;
    slices::run(context)?;
    boundary::run(context)
}

fn deep_groove(clearance: f64) -> Lengths {
    Lengths { clearance, ..DEEP_GROOVE }
}

/// A preloaded bearing, both races free, that never loses a contact.
fn preloaded() -> Result<DynamicProblem, CaseError> {
    let free = || motion::race([0.0; 5], Rotation::Torque(Profile::ZERO));
    let mut problem = motion::moving(&deep_groove(-20e-6), 0.1, [0.0; 5], 0.0)?;
    problem.inner = free();
    problem.outer = Some(free());
    Ok(problem)
}

/// Races pushed and turning, balls in their nominal places.
fn preloaded_start(problem: &DynamicProblem) -> Vec<f64> {
    let layout = Layout::new(problem.geometry.ball_count, false);
    let mut state = start::nominal(&problem.assembly());
    let at = layout.inner();
    state[at + VELOCITY..at + VELOCITY + 3].copy_from_slice(&[0.02, 0.05, -0.04]);
    state[at + SPIN..at + SPIN + 3].copy_from_slice(&[200.0, 1.0, -2.0]);
    state
}

fn simulation(problem: &DynamicProblem, state: &[f64], step: f64) -> Result<Simulation, CaseError> {
    let options = motion::fixed_step(step);
    Ok(Simulation::from_state(problem.clone(), options, state.to_vec(), 0.0)?)
}

/// Velocities and spins of all moving bodies: entry of the state vector, and what makes it m/s.
fn velocities(problem: &DynamicProblem) -> Vec<(usize, f64)> {
    let layout = Layout::new(problem.geometry.ball_count, false);
    let radius = problem.geometry.ball_radius;
    let mut entries = Vec::new();
    for i in 0..3 {
        for ball in 0..layout.balls {
            entries.push((layout.ball(VELOCITY + i) + ball, 1.0));
            entries.push((layout.ball(SPIN + i) + ball, radius));
        }
        let outer = problem.outer.is_some().then(|| layout.outer());
        for at in [Some(layout.inner()), outer].into_iter().flatten() {
            entries.push((at + VELOCITY + i, 1.0));
            entries.push((at + SPIN + i, radius));
        }
    }
    entries
}

/// Largest difference of velocities, and of spins times the ball radius, m/s. NaN stays.
fn difference(entries: &[(usize, f64)], a: &[f64], b: &[f64]) -> f64 {
    let apart = |&(at, unit): &(usize, f64)| unit * (a[at] - b[at]).abs();
    entries.iter().map(apart).fold(0.0, |most, x| if most >= x { most } else { x })
}

/// log₂ of the ratio over the halving of the step.
fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

/// Inner race and cage turn freely for 10⁵ steps.
fn tops(context: &mut CaseContext) -> Result<(), CaseError> {
    const STEPS: usize = 100_000;
    // So much clearance everywhere that nothing touches.
    let mut problem = motion::moving(&deep_groove(10e-3), 0.1, [0.0; 5], 0.0)?;
    problem.inner = motion::race([0.0; 5], Rotation::Torque(Profile::ZERO));
    let (inner, outer, length, density) = (23.5e-3, 28.5e-3, 15e-3, 1400.0);
    problem.cage = Some(CageBody {
        inertia: inertia::hollow_cylinder(inner, outer, length, density),
        contacts: CageContacts {
            pocket: Pocket::Cylindrical,
            pocket_radius: 1.0,
            pocket_pitch_radius: 26e-3,
            guidance: Guidance::OuterRace,
            ring: [inner, outer],
            guide_radius: outer,
            race_clearance: 1.0,
            length,
            force: CageForce::Penalty { stiffness: 1e7 },
            friction: 0.1,
            regularisation_speed: 0.01,
        },
    });
    let options = RunOptions { start: Start::Nominal, ..motion::fixed_step(1e-5) };
    let mut simulation = Simulation::new(problem, options)?;
    let layout = simulation.system.sets[0].layout;
    let bodies = [
        (
            "race",
            "inner race",
            layout.inner(),
            oracle::Top::ring(15e-3, 22e-3, 12e-3, 7850.0),
            [480.0, 10.0, -15.0],
        ),
        (
            "cage",
            "cage",
            layout.cage(),
            oracle::Top::ring(inner, outer, length, density),
            [300.0, 200.0, -250.0],
        ),
    ];
    for (_, _, at, _, spin) in bodies {
        simulation.state[at + SPIN..at + SPIN + 3].copy_from_slice(&spin);
    }
    motion::run(&mut simulation, STEPS)?;
    for (tag, name, at, top, spin) in bodies {
        let axis = [1.0, 0.0, 0.0];
        let body = BodyState::from_slice(&simulation.state[at..]);
        let (last_axis, last_spin) = (body.axis(), body.spin);
        let apart =
            |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
        let size = |v: [f64; 3]| apart(v, [0.0; 3]);
        let rate = size(top.momentum(axis, spin)) / top.transverse;
        let drift = top.energy(last_axis, last_spin) / top.energy(axis, spin) - 1.0;
        context.check(
            Check::new(&format!("top_energy_{tag}"), &format!("energy drift of the free {name} over 1e5 steps"), "1", drift)
                .closed_form(0.0, "a free body keeps its energy; inertia of a ring by separate code")
                .absolute(
                    3e-11,
                    "Runge–Kutta damps a rotation by (ωh)⁶/144 a step: 1e-11 over all at ωh = 5e-3; the rest is rounding",
                ),
        );
        let (start_momentum, momentum) =
            (top.momentum(axis, spin), top.momentum(last_axis, last_spin));
        context.check(
            Check::new(
                &format!("top_momentum_{tag}"),
                &format!("drift of the free {name}'s angular momentum vector"),
                "1",
                apart(momentum, start_momentum) / size(start_momentum),
            )
            .closed_form(0.0, "a free body keeps its angular momentum")
            .absolute(3e-11, "as the energy"),
        );
        let (axis_then, spin_then) = top.later(axis, spin, simulation.time);
        context.check(
            Check::new(
                &format!("top_motion_{tag}"),
                &format!("axis and spin of the free {name} after 1 s, {:.0} rad of precession", rate),
                "1",
                apart(last_axis, axis_then).max(apart(last_spin, spin_then) / size(spin)),
            )
            .closed_form(0.0, "both go round the angular momentum L at L/It")
            .absolute(2e-8, "the phase falls behind by (ωh)⁵/120 a step, 3e-9 at ωh = 5e-3 and 1e-8 at 6e-3; rounding"),
        );
    }
    context.work("loaded contacts of the free bodies", simulation.system.work.loaded_contacts);
    Ok(())
}

/// Strain plus kinetic energy of the preloaded bearing over 300 rad of its stiffest mode.
fn energy_drift(context: &mut CaseContext) -> Result<(), CaseError> {
    let problem = preloaded()?;
    let state = preloaded_start(&problem);
    let mut system = System::new(problem.clone(), Kernel::Simd);
    let pulsation = step_limit(&mut system, 0.0, &state)
        .ok_or_else(|| CaseError::message("no contact is stiff"))?
        .eigenvalue
        .norm();
    let angles = [0.4, 0.2, 0.1, 0.05];
    let mut drifts = Vec::new();
    for angle in angles {
        let step = angle / pulsation;
        let mut simulation = simulation(&problem, &state, step)?;
        let (mut residual, mut strain) = (0.0_f64, 0.0_f64);
        for _ in 0..(300.0 / angle) as usize {
            simulation.step()?;
            // Nothing drives and nothing brakes: what is missing is the method's.
            let snapshot = simulation.snapshot();
            residual = residual.max(snapshot.residual.abs());
            strain = strain.max(snapshot.energy.contact);
        }
        drifts.push(residual / strain);
    }
    context.check(
        Check::new("energy_drift", "strain plus kinetic energy drift over peak strain energy, ωh = 0.05", "1", drifts[3])
            .closed_form(0.0, "without friction and damping energy is conserved")
            .absolute(
                1e-6,
                "Runge–Kutta damps an oscillation by (ωh)⁶/72 of its energy a step: 1.3e-6 over 300 rad of the oscillating part of the energy",
            ),
    );
    for (i, pair) in drifts.windows(2).enumerate().skip(1) {
        context.check(
            Check::new(
                &format!("energy_order_{i}"),
                &format!("order of the energy drift from ωh = {} to {}", angles[i], angles[i + 1]),
                "1",
                order(pair[0], pair[1]),
            )
            .closed_form(5.0, "(ωh)⁶/72 a step is fifth order over a time")
            .absolute(0.05, "slower modes and the next order, 0.007"),
        );
    }
    let points = |values: &[f64]| -> Vec<[f64; 2]> {
        angles.iter().zip(values).map(|(angle, value)| [*angle, *value]).collect()
    };
    let guide = angles.map(|angle| drifts[3] * (angle / 0.05_f64).powi(5));
    let svg = xy(&XyPlot {
        title: "Energy drift of a frictionless bearing over 300 rad".into(),
        x: Axis::log("pulsation of the stiffest mode × step", "rad"),
        y: Axis::log("drift over peak strain energy", "1"),
        style: Style::LinesAndMarkers,
        curves: vec![
            Curve::new("Runge–Kutta", points(&drifts)),
            Curve::new("fifth order", points(&guide)),
        ],
    })?;
    context.figure(
        "energy_drift_over_step",
        svg,
        "Preloaded bearing (−20 µm), both races free, pushed and turning.",
    );
    Ok(())
}
