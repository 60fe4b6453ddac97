//! Starts in equilibrium: forces in balance, velocities that the loads give, refusals where nothing holds.

use super::dynamics_settling::table_3_5;
use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::equilibrium::statics::StaticsError;
use bearing_dynamics::members::body::{Drive, DrivenBody, RotatingLoad, Rotation};
use bearing_dynamics::members::state::{BodyState, Layout, SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{
    Integrator, RunOptions, Simulation, SimulationError, Start, Stepping,
};
use bearing_dynamics::motion::start;
use bearing_dynamics::numeric::profile::Profile;
use common::table_4_1;
use dynamics::*;
use nalgebra::Vector3;
use std::f64::consts::TAU;

#[test]
fn equilibrium_starts_under_all_loads() {
    // Gravity and a rotating load pull at the start too: nothing is accelerated but the rolling
    // balls, and they only towards the axis.
    let mut problem = bearing(table_3_5(), [10.0, 20.0, -100.0, 0.5, 0.2], 0.0);
    problem.gravity = GRAVITY;
    let force = Profile::Constant(250.0);
    problem.rotating_load =
        Some(RotatingLoad { force, speed: Profile::Constant(50.0), phase: 0.7 });
    let mut simulation = simulation(&problem, 1e-6, Start::Equilibrium);
    let mut rates = vec![0.0; simulation.state.len()];
    simulation.system.evaluate(0.0, &simulation.state, &mut rates);
    let at = simulation.system.sets[0].layout.inner();
    let inertia = problem.inner.inertia;
    // Statics stops at 1e-11 of the largest load, some 200 N.
    for i in 0..3 {
        assert!((rates[at + VELOCITY + i] * inertia.mass).abs() <= 1e-7);
        assert!((rates[at + SPIN + i] * inertia.transverse).abs() <= 1e-7 * 26e-3);
    }
}

/// Forces (N) and moments over the pitch radius (N) by which a race is out of balance, as the
/// equations of motion have them.
fn unbalanced(problem: &DynamicProblem, rates: &[f64], at: usize, inertia: Inertia) -> [f64; 6] {
    let pitch = problem.geometry.pitch_radius;
    std::array::from_fn(|i| match i {
        0..3 => (rates[at + VELOCITY + i] * inertia.mass).abs(),
        _ => (rates[at + SPIN + i - 3] * inertia.transverse / pitch).abs(),
    })
}

/// An outer race on springs, tilted and loaded by itself.
fn on_springs() -> DrivenBody {
    let mut outer = free_race();
    outer.rotation = Rotation::Speed(Profile::ZERO);
    outer.foundation_stiffness = [1e7, 2e7, 1.5e7, 1e4, 2e4];
    outer.foundation_damping = [500.0, 500.0, 500.0, 0.5, 0.5];
    outer.drives[1] = Drive::Load(Profile::Constant(30.0));
    outer.drives[4] = Drive::Load(Profile::Constant(-0.3));
    outer
}

#[test]
fn both_races_start_in_equilibrium() {
    // A torque keeps the rotation free, so that nothing is prescribed; all six coordinates too.
    let mut on_foundation = bearing(table_3_5(), [10.0, 20.0, -300.0, 0.5, 0.2], 0.0);
    on_foundation.gravity = GRAVITY;
    on_foundation.outer = Some(on_springs());
    on_foundation.outer_start = [1e-3, 2e-6, -5e-6, 1e-3, -5e-4];
    let mut in_rotation = on_foundation.clone();
    in_rotation.outer.as_mut().unwrap().rotation = Rotation::Torque(Profile::ZERO);
    // Held by the inner race alone, across a clearance.
    let mut hanging = bearing(table_4_1(10e-6), [0.0; 5], 0.0);
    for drive in &mut hanging.inner.drives {
        *drive = Drive::Motion(Profile::ZERO);
    }
    let mut outer = free_race();
    outer.drives[0] = Drive::Load(Profile::Constant(40.0));
    outer.drives[2] = Drive::Load(Profile::Constant(-200.0));
    hanging.outer = Some(outer);
    // Springs so soft that both races sink by far more than a ball radius.
    let mut sinking = on_foundation.clone();
    sinking.outer.as_mut().unwrap().foundation_stiffness[2] = 2e4;
    // One coordinate of the outer race given.
    let mut guided = on_foundation.clone();
    guided.outer.as_mut().unwrap().drives[2] = Drive::Motion(Profile::Constant(7e-6));
    for (name, problem) in [
        ("on foundation", on_foundation),
        ("six degrees", in_rotation),
        ("hanging", hanging),
        ("sinking", sinking),
        ("guided", guided),
    ] {
        let mut simulation = simulation(&problem, 1e-6, Start::Equilibrium);
        let layout = simulation.system.sets[0].layout;
        let mut rates = vec![0.0; simulation.state.len()];
        simulation.system.evaluate(0.0, &simulation.state, &mut rates);
        let inner = unbalanced(&problem, &rates, layout.inner(), problem.inner.inertia);
        let inertia = problem.outer.as_ref().unwrap().inertia;
        let outer = unbalanced(&problem, &rates, layout.outer(), inertia);
        println!("{name}: inner {inner:?}, outer {outer:?}");
        // Statics stops at 1e-11 of the largest load, some 300 N, or where the positions' rounding
        // (some ulps of 26 mm, times 1e8 N/m) lies: 5e-9 N.
        for force in inner.into_iter().chain(outer) {
            assert!(force <= 1e-7, "{name}: {inner:?} {outer:?}");
        }
        // And stays there, as long as something holds the balls at their azimuths as in statics.
        let start = simulation.state.clone();
        let turn = BodyState::from_slice(&start[layout.outer()..]).orientation;
        for _ in 0..2000 {
            simulation.step().unwrap();
            for ball in 0..layout.balls {
                let angle = problem.ball_phase + TAU * ball as f64 / layout.balls as f64;
                let tangent = turn * Vector3::new(0.0, -angle.sin(), angle.cos());
                let was = Vector3::from(layout.ball_state(&start, ball).position);
                let mut body = layout.ball_state(&simulation.state, ball);
                let (position, velocity) =
                    (Vector3::from(body.position), Vector3::from(body.velocity));
                body.position = (position - tangent * tangent.dot(&(position - was))).into();
                body.velocity = (velocity - tangent * tangent.dot(&velocity)).into();
                layout.set_ball(&mut simulation.state, ball, &body);
            }
        }
        for at in [layout.inner(), layout.outer()] {
            for i in 0..3 {
                let moved = (simulation.state[at + i] - start[at + i]).abs();
                // 1e-7 N on 2e4 N/m and more.
                assert!(moved <= 1e-11, "{name}: {moved} m");
            }
        }
    }
}

#[test]
fn a_race_that_nothing_holds_has_no_equilibrium() {
    let mut problem = bearing(table_4_1(-5e-6), [0.0, 0.0, -300.0, 0.0, 0.0], 0.0);
    problem.outer = Some(free_race());
    let error = Simulation::new(problem.clone(), fixed_step(1e-6, Start::Equilibrium)).err();
    assert!(
        matches!(error, Some(SimulationError::Start(StaticsError::NoEquilibrium { .. }))),
        "{error:?}"
    );
    // Without loads it stays where it was put. Under loads that cancel each other it would not: statics
    // holds the balls at their azimuths, and what that takes (some 0.1 N) is missing at the races.
    problem.inner.drives[2] = Drive::Load(Profile::ZERO);
    let start = simulation(&problem, 1e-6, Start::Equilibrium);
    assert_eq!(start.state[start.system.sets[0].layout.outer() + 2], 0.0);
}

#[test]
fn unbalance_takes_part_in_the_equilibrium_at_the_start() {
    for tilt in [0.0, 2e-3] {
        let mut problem = bearing(table_3_5(), [50.0, 0.0, -300.0, 0.0, 0.0], 3000.0 * RPM);
        problem.unbalance = 1e-3;
        problem.inner.drives[4] = Drive::Motion(Profile::Constant(tilt));
        let mut simulation = simulation(&problem, 1e-6, Start::Equilibrium);
        let mut rates = vec![0.0; simulation.state.len()];
        simulation.system.evaluate(0.0, &simulation.state, &mut rates);
        let at = simulation.system.sets[0].layout.inner();
        // 98.7 N along the race's own Y.
        for (i, force) in
            unbalanced(&problem, &rates, at, problem.inner.inertia).into_iter().take(3).enumerate()
        {
            assert!(force <= 1e-7, "{tilt}, coordinate {i}: {force} N");
        }
    }
}

/// The velocity of a start is that of its equilibrium, as far as the loads determine one.
#[test]
fn a_start_has_no_velocity_that_its_loads_do_not_give() {
    let ramp =
        |to: f64, duration: f64| Drive::Load(Profile::Ramp { from: 0.0, to, start: 0.0, duration });
    let loose = |clearance: f64| {
        let mut problem = bearing(table_4_1(clearance), [0.0; 5], 1000.0 * RPM);
        problem.ball_phase = 0.0;
        problem
    };
    // Nothing loads it at t = 0.
    let mut radial = loose(5e-6);
    radial.inner.drives[2] = ramp(-1500.0, 10e-3);
    let mut axial = loose(280e-6);
    axial.inner.drives[0] = ramp(300.0, 1e-3);
    let mut pressed = loose(5e-6);
    pressed.inner.drives[0] = ramp(200e3, 20e-3);
    // Its own weight, and a load under which it may lie to the left or to the right of a ball.
    let mut heavy = loose(20e-6);
    heavy.gravity = GRAVITY;
    let mut lying = loose(20e-6);
    lying.inner.drives[2] = Drive::Load(Profile::Constant(-100.0));
    // Nearest loads, N: none of these makes more than a few times that.
    for (name, problem, loads) in [
        ("radial ramp", radial, None),
        ("axial ramp", axial, None),
        ("strong ramp", pressed, None),
        ("weight", heavy, Some(1.0)),
        ("lying", lying, Some(100.0)),
    ] {
        let options = RunOptions {
            integrator: Integrator::Rosenbrock,
            stepping: Stepping::Accuracy(1e-3),
            energy_limit: f64::INFINITY,
            ..RunOptions::default()
        };
        let mut simulation = Simulation::new(problem, options).unwrap();
        let velocity = Vector3::from(inner_state(&simulation).velocity).norm();
        let Some(load) = loads else {
            assert_eq!(velocity, 0.0, "{name}");
            continue;
        };
        // The ball set goes round at 42 rad/s, and with it a place in 20 µm.
        assert!(velocity <= 2e-3, "{name}: {velocity} m/s");
        while simulation.time < 5e-3 {
            simulation.step().unwrap();
        }
        let races = simulation.extremes[0].races;
        let most = races[0].load.value.max(races[1].load.value);
        println!("{name}: {velocity:e} m/s, {most} N of {load} N");
        assert!(most <= 5.0 * load, "{name}: {most} N of {load} N");
    }
    // One that is determined moves as the balls pass under the load.
    let mut varying = bearing(table_3_5(), [0.0, 0.0, -1500.0, 0.0, 0.0], 1000.0 * RPM);
    varying.ball_phase = 0.1;
    let start = simulation(&varying, 1e-6, Start::Equilibrium);
    let velocity = inner_state(&start).velocity;
    assert!(velocity[1].abs() > 1e-6 && velocity[2].abs() > 1e-6, "{velocity:?}");
}

/// Nothing slides at a nominal start, whichever races turn: at both contacts a ball's surface goes with that of the race.
#[test]
fn balls_start_rolling_on_both_races() {
    for speeds in [[100.0, 0.0], [0.0, 60.0], [100.0, -60.0], [80.0, 50.0]] {
        let mut problem = bearing(table_4_1(0.0), [0.0; 5], speeds[0]);
        problem.outer = Some(race([0.0; 5], Rotation::Speed(Profile::Constant(speeds[1]))));
        let state = start::nominal(&problem.assembly());
        let layout = Layout::new(8, false);
        let radius = problem.geometry.ball_radius;
        for ball in 0..8 {
            let body = layout.ball_state(&state, ball);
            let at = Vector3::from(body.position);
            let outward = at.normalize();
            for (reach, speed) in [-radius, radius].into_iter().zip(speeds) {
                let arm = outward * reach;
                let of_ball = Vector3::from(body.velocity) + Vector3::from(body.spin).cross(&arm);
                let of_race = Vector3::x().cross(&(at + arm)) * speed;
                // Rounding of metres a second.
                assert!((of_ball - of_race).norm() <= 1e-13, "{speeds:?}: {of_ball} {of_race}");
            }
        }
    }
}
