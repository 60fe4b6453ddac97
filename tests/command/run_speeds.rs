//! Speeds of balls that a run records: slip, and rolling without it.

use super::run_recorder::{table, to_the_end};
use crate::run_common;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::members::body::{Drive, Rotation};
use bearing_dynamics::members::state::VELOCITY;
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::session::{RunRequest, Session};
use bearing_dynamics::output::summary::{RunReport, run_summary};
use bearing_dynamics::output::table::RunTable;
use nalgebra::{Matrix3, Vector3};
use run_common::{common, complete, frictionless, request, simulation, simulation_mut, sliding};

#[test]
fn slip_is_the_difference_of_surface_speeds() {
    // Balls start rolling at the nominal contact angle. Brake ball 1 by 10 rad/s about X: its
    // outer contact then slides by 10 rad/s · r_b along the rolling direction.
    let problem = frictionless();
    let radius = problem.geometry.ball_radius;
    let mut wanted = request(1e-6, 2);
    // The brake takes energy that no ledger knows of.
    wanted.options.energy_limit = 1e9;
    let mut session = Session::start(problem.clone(), &wanted).unwrap();
    let layout = simulation(&session).system.sets[0].layout;
    let before: Vec<f64> = session.recorder.row(0).to_vec();
    simulation_mut(&mut session).state[layout.ball(10)] += 10.0;
    let snapshot = simulation_mut(&mut session).snapshot();
    session.recorder.record(session.motion.bearing().unwrap(), &snapshot);
    let at = |name: &str| {
        let columns = session.recorder.columns();
        let index = columns.iter().position(|column| column.name == name).unwrap();
        session.recorder.row(1)[index] - before[index]
    };
    // ω × n r with n = −out on the inner and +out on the outer race: out × X turned.
    let outer = at("ball_1_outer_slip_rolling");
    let inner = at("ball_1_inner_slip_rolling");
    assert!((outer - 10.0 * radius).abs() <= 0.02 * 10.0 * radius, "{outer}");
    assert!((inner + 10.0 * radius).abs() <= 0.02 * 10.0 * radius, "{inner}");
    assert_eq!(at("ball_2_outer_slip_rolling"), 0.0);
    // Spin about the outer normal, which points along the ball's radius.
    let mut session = Session::start(problem, &wanted).unwrap();
    let angle: f64 = 0.1;
    simulation_mut(&mut session).state[layout.ball(11)] += 5.0 * angle.cos();
    simulation_mut(&mut session).state[layout.ball(12)] += 5.0 * angle.sin();
    let snapshot = simulation_mut(&mut session).snapshot();
    session.recorder.record(session.motion.bearing().unwrap(), &snapshot);
    let columns = session.recorder.columns();
    let index = columns.iter().position(|c| c.name == "ball_1_outer_spin").unwrap();
    let spin = session.recorder.row(1)[index] - session.recorder.row(0)[index];
    assert!((spin - 5.0).abs() <= 0.01, "{spin}");
}

#[test]
fn slip_is_told_against_the_contact_angle_that_balls_have() {
    // Pushed along its axis with clearance, the deep-groove bearing runs at an angle far from its
    // nominal one of zero, and the axial load leaves the balls hardly any slip.
    let mut problem = DynamicProblem { geometry: common::table_4_1(20e-6), ..sliding() };
    problem.inner.drives[2] = Drive::Load(Profile::ZERO);
    problem.inner.drives[0] = Drive::Load(Profile::Constant(500.0));
    problem.inner.drives[3] = Drive::Motion(Profile::ZERO);
    problem.inner.drives[4] = Drive::Motion(Profile::ZERO);
    let options = RunOptions {
        integrator: Integrator::Rosenbrock,
        stepping: Stepping::Accuracy(1e-3),
        energy_limit: f64::INFINITY,
        ..RunOptions::default()
    };
    let wanted = RunRequest { options, end: 40e-3, output_interval: 0.1e-3, ..request(1e-6, 1) };
    let session = to_the_end(problem, &wanted);
    let table = RunTable::new(&session, 30e-3).unwrap();
    let summary = run_summary(&session, &table, &[], &RunReport::default()).unwrap();
    let of = |name: &str| summary["kinematics"][name]["value"].as_f64().unwrap();
    assert!(of("inner_contact_angle") > 10.0, "{}", summary["kinematics"]);
    // Harris: the ball set with control of either race.
    let geometry = simulation(&session).system.assembly.bearings[0].geometry;
    let gamma = geometry.ball_radius / geometry.pitch_radius;
    let [inner, outer] = ["inner_contact_angle", "outer_contact_angle"].map(|n| of(n).to_radians());
    let both = 1.0 + (inner - outer).cos();
    let control = [
        ("outer", (1.0 - gamma * inner.cos()) / both),
        ("inner", ((inner - outer).cos() - gamma * outer.cos()) / both),
    ];
    let [low, high] = [control[1].1, control[0].1].map(|ratio| ratio * of("inner_race_speed"));
    for (race, ratio) in control {
        let told = of(&format!("rolling_cage_speed_{race}_control"));
        let expected = ratio * of("inner_race_speed");
        assert!((told / expected - 1.0).abs() <= 1e-12, "{race}: {told} {expected}");
    }
    // No slip between them, and against the nearer one outside.
    let measured = of("ball_set_speed");
    let slip = 1.0 - measured / measured.clamp(low.min(high), low.max(high));
    assert!((of("ball_set_slip") - slip).abs() <= 1e-12, "{slip}");
    let nominal = 1.0 - of("ball_set_speed") / of("rolling_cage_speed_at_nominal_angle");
    assert!(nominal.abs() > 2e-3, "{nominal}");
    // A tenth of it at most: what spin leaves, and the angle of each ball beside the mean.
    assert!(of("ball_set_slip").abs() <= 0.1 * nominal.abs(), "{}", summary["kinematics"]);
    assert!(summary["kinematics"]["rolling_at"].as_str().unwrap().contains("mean contact angles"));
}

/// Balls go round the outer race's centre: what all of them have in common is no orbiting.
#[test]
fn orbital_speeds_count_from_the_moving_outer_race() {
    let mut wanted = request(1e-6, 2);
    // The push takes energy that no ledger knows of.
    wanted.options.energy_limit = 1e9;
    let mut session = Session::start(complete(), &wanted).unwrap();
    let before: Vec<f64> = session.recorder.row(0).to_vec();
    let simulation = simulation_mut(&mut session);
    let (layout, at) = (simulation.system.sets[0].layout, simulation.system.places.body(1));
    let velocity = [0.0, 0.7, -0.4];
    for (i, by) in velocity.into_iter().enumerate() {
        simulation.state[at + VELOCITY + i] += by;
        for ball in 0..layout.balls {
            simulation.state[layout.ball(VELOCITY + i) + ball] += by;
        }
    }
    let snapshot = simulation.snapshot();
    session.recorder.record(session.motion.bearing().unwrap(), &snapshot);
    for ball in 1..=layout.balls {
        let name = format!("ball_{ball}_orbital_speed");
        let index = session.recorder.columns().iter().position(|c| c.name == name).unwrap();
        let (was, is) = (before[index], session.recorder.row(1)[index]);
        // Rounding; the common velocity alone would be 0.8/0.026 of it.
        assert!((is - was).abs() <= 1e-12 * was.abs() && was > 10.0, "{name}: {was} {is}");
    }
}

/// Speed of the balls' orbits where they slip at neither contact and do not spin on one of the races, from the
/// velocities of the surfaces: contact angles (rad) and speeds (rad/s) of the inner and the outer race.
fn orbit_without_slip(ball: f64, pitch: f64, angles: [f64; 2], speeds: [f64; 2], on: usize) -> f64 {
    // Radially outwards and along the axis, from the ball's centre to its contacts.
    let normals = [[-angles[0].cos(), -angles[0].sin()], [angles[1].cos(), angles[1].sin()]];
    // Unknown: the orbit's speed, the ball's spin along the axis and along the radius.
    let row = |[r, x]: [f64; 2]| [pitch, ball * r, -ball * x];
    let surface = |side: usize| speeds[side] * (pitch + ball * normals[side][0]);
    let [r, x] = normals[on];
    let matrix =
        Matrix3::from_rows(&[row(normals[0]).into(), row(normals[1]).into(), [0.0, x, r].into()]);
    let right = Vector3::new(surface(0), surface(1), speeds[on] * x);
    matrix.lu().solve(&right).expect("two contacts")[0]
}

/// At speed balls press outwards: they touch the inner race at the larger angle, and which race they spin on counts.
#[test]
fn speeds_of_rolling_follow_from_the_velocities_at_both_contacts() {
    let mut problem = DynamicProblem { geometry: common::table_5_3(), ..frictionless() };
    problem.inner.drives = [const { Drive::Motion(Profile::ZERO) }; 5];
    problem.inner.drives[0] = Drive::Load(Profile::Constant(400.0));
    problem.inner.rotation = Rotation::Speed(Profile::Constant(2000.0));
    let mut outer = problem.inner.clone();
    outer.drives[0] = Drive::Motion(Profile::ZERO);
    outer.rotation = Rotation::Speed(Profile::Constant(-300.0));
    problem.outer = Some(outer);
    let mut wanted = request(1e-6, 20);
    wanted.options.energy_limit = f64::INFINITY;
    let session = to_the_end(problem, &wanted);
    let summary = run_summary(&session, &table(&session), &[], &RunReport::default()).unwrap();
    let of = |name: &str| summary["kinematics"][name]["value"].as_f64().unwrap();
    let degrees = ["inner_contact_angle", "outer_contact_angle"].map(of);
    assert!(degrees[0] > degrees[1] + 1.0, "{degrees:?}");
    let geometry = simulation(&session).system.assembly.bearings[0].geometry;
    let (ball, pitch) = (geometry.ball_radius, geometry.pitch_radius);
    let angles = degrees.map(f64::to_radians);
    let expected = [0, 1].map(|on| orbit_without_slip(ball, pitch, angles, [2000.0, -300.0], on));
    assert!((expected[0] / expected[1] - 1.0).abs() > 1e-4, "{expected:?}");
    for (race, expected) in ["inner", "outer"].into_iter().zip(expected) {
        let told = of(&format!("rolling_cage_speed_{race}_control"));
        // Rounding of angles in degrees.
        assert!((told / expected - 1.0).abs() <= 1e-12, "{race}: {told} {expected}");
    }
}
