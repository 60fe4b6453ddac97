//! Frames that turn with bodies in linearly implicit steps.

use crate::common::table_4_1;
use crate::connected_bodies::free;
use crate::connections::kinds;
use crate::dynamics::{Noise, RPM, bearing};
use crate::dynamics_integrators::started;

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::assembly::places::Places;
use bearing_dynamics::ch2_housing::bearing::inertia::hollow_cylinder;
use bearing_dynamics::members::connection::Law;
use bearing_dynamics::members::contacts::{Kernel, Want};
use bearing_dynamics::members::state::{BODY, BodyState, ORIENTATION, SPIN};
use bearing_dynamics::motion::block_arrow::BlockArrowMatrix;
use bearing_dynamics::motion::linearised::Linearised;
use bearing_dynamics::motion::rosenbrock as ros;
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Stepping};
use bearing_dynamics::motion::system::System;
use bearing_dynamics::motion::turning_frame::TurningFrames;
use nalgebra::{Matrix2, Quaternion, UnitQuaternion, Vector2, Vector3};

fn quaternion(of: &[f64], at: usize) -> Quaternion<f64> {
    let q = &of[at + ORIENTATION..];
    Quaternion::new(q[0], q[1], q[2], q[3])
}

/// Quaternions of the bodies that turn, and nothing else, change by the turn at the spin of the step's beginning.
#[test]
fn frames_turn_with_their_bodies() {
    let assembly = Assembly::from(bearing(table_4_1(-5e-6), [0.0; 5], 1000.0 * RPM));
    let places = Places::of(&assembly);
    let mut noise = Noise(11);
    let mut random = || (0..places.state_len()).map(|_| noise.next()).collect::<Vec<f64>>();
    let (state, rates) = (random(), random());
    let body = 1;
    let mut frames = TurningFrames::new(&places, [body].into_iter());
    frames.follow(&state);
    let (time, at) = (0.7, places.body(body));
    let (mut inertial, mut in_frame, mut drift) =
        (state.clone(), rates.clone(), vec![0.0; state.len()]);
    frames.turn(time);
    frames.to_inertial(&mut inertial);
    frames.rates_to_frame(&state, &mut in_frame);
    frames.drift(time, &state, &mut drift);
    let spin = Vector3::new(state[at + SPIN], state[at + SPIN + 1], state[at + SPIN + 2]);
    let turn = UnitQuaternion::from_scaled_axis(spin * time).into_inner();
    let q = quaternion(&state, at);
    let carried = Quaternion::from_imag(spin) * q * 0.5;
    let rate = turn.conjugate() * (quaternion(&rates, at) - carried);
    for (found, wanted) in [
        (quaternion(&inertial, at), turn * q),
        (quaternion(&in_frame, at), rate),
        (quaternion(&drift, at), carried * time),
    ] {
        assert!((found - wanted).norm() <= 1e-14, "{found} {wanted}");
    }
    let turning = at + ORIENTATION..at + ORIENTATION + 4;
    for i in (0..state.len()).filter(|i| !turning.contains(i)) {
        assert_eq!((inertial[i], in_frame[i], drift[i]), (state[i], rates[i], 0.0), "{i}");
    }
}

/// A race that turns steadily is followed exactly, however long the steps.
#[test]
fn steady_turns_are_exact_in_long_steps() {
    let speed = 20_000.0 * RPM;
    let problem = bearing(table_4_1(-5e-6), [0.0, 0.0, -500.0, 0.0, 0.0], speed);
    let step = 2e-5;
    let mut simulation = started(&problem, Integrator::Rosenbrock, Stepping::Fixed(step));
    let inner = simulation.system.sets[0].layout.inner();
    let angle_before = angle(&simulation.state[inner..inner + BODY]);
    for n in 1..=50 {
        simulation.step().unwrap();
        let turned = angle(&simulation.state[inner..inner + BODY]) - angle_before;
        let error = (turned - speed * step * f64::from(n)).rem_euclid(std::f64::consts::TAU);
        let error = error.min(std::f64::consts::TAU - error);
        // The race tilts by less than 1e-9; rounding of fifty products.
        assert!(error <= 1e-12, "{n}: {error:e}");
    }
}

/// Angle about X, rad.
fn angle(body: &[f64]) -> f64 {
    let q = BodyState::from_slice(body).orientation;
    2.0 * q.i.atan2(q.w)
}

/// The matrix sees the rotation of the frames as it sees the same rotation of the bodies.
#[test]
fn frames_act_on_connections_as_their_bodies_do() {
    let assembly = Assembly {
        bodies: vec![free("one"), free("other")],
        connections: kinds(),
        ..Assembly::default()
    };
    let mut system = System::new(assembly, Kernel::Simd);
    let mut noise = Noise(23);
    let mut random = |size: f64| {
        (0..system.places.state_len()).map(|_| size * noise.next()).collect::<Vec<f64>>()
    };
    let (mut state, right, mut drift) = (random(1e-3), random(1.0), random(1.0));
    let rotations = [0, 1].map(|body| system.places.body(body) + ORIENTATION);
    let rotates = |i: usize| rotations.iter().any(|at| (*at..at + 4).contains(&i));
    for at in rotations {
        let q = UnitQuaternion::from_quaternion(
            quaternion(&state, at - ORIENTATION) + Quaternion::from_real(1.0),
        );
        state[at..at + 4].copy_from_slice(&[q.w, q.i, q.j, q.k]);
    }
    (0..drift.len()).filter(|i| !rotates(*i)).for_each(|i| drift[i] = 0.0);
    let mut linearised = Linearised::new(&system);
    system.evaluate_with(Want::ForcesAndSlopes, 0.0, &state, &mut vec![0.0; state.len()]);
    linearised.update(&system, &state);
    let mut matrix = BlockArrowMatrix::new(&system, &linearised);
    matrix.factor(&linearised, 1e-3);
    let mut solve = |drift: &[f64], right: &[f64]| {
        let mut found = vec![0.0; right.len()];
        matrix.solve(&linearised, &system.sets, &state, drift, right, &mut found);
        found
    };
    let by_frames = solve(&drift, &right);
    let moved: Vec<f64> = right.iter().zip(&drift).map(|(r, d)| r + d).collect();
    let by_bodies = solve(&vec![0.0; drift.len()], &moved);
    for i in 0..drift.len() {
        let (frames, bodies) = (by_frames[i] + drift[i], by_bodies[i]);
        let error = (frames - bodies).abs();
        assert!(error <= 1e-11 * (1.0 + bodies.abs()), "{i}: {frames} {bodies}");
    }
}

/// Two bodies that turn against each other on a torsion spring, in steps many times longer than its period, do what the
/// method's own linear algebra does of two equations without any frame.
#[test]
fn twist_between_turning_frames_is_that_of_the_method_without_frames() {
    let torsion = kinds().swap_remove(1);
    let Law::Torsion(law) = &torsion.law else { panic!("the second kind is torsion") };
    let axial = hollow_cylinder(5e-3, 20e-3, 60e-3, 7850.0).axial;
    let matrix = [[0.0, 1.0], [-2.0 * law.stiffness / axial, -2.0 * law.damping / axial]];
    let matrix = Matrix2::from_fn(|i, j| matrix[i][j]);
    let assembly = Assembly {
        bodies: vec![free("one"), free("other")],
        connections: vec![torsion],
        ..Assembly::default()
    };
    let places = Places::of(&assembly);
    let mut state = vec![0.0; places.state_len()];
    // Angles of microradians, to whose square the spring is linear.
    let spins = [3e-3, -1e-3];
    for (body, spin) in spins.into_iter().enumerate() {
        let at = BodyState { spin: [spin, 0.0, 0.0], ..BodyState::at_rest([0.0; 3]) };
        state[places.body(body)..places.body(body) + BODY].copy_from_slice(&at.to_array());
    }
    let step = 2e-3;
    let options = RunOptions {
        integrator: Integrator::Rosenbrock,
        stepping: Stepping::Fixed(step),
        energy_limit: f64::INFINITY,
        ..RunOptions::default()
    };
    let mut simulation = Simulation::from_state(assembly, options, state, 0.0).unwrap();
    let mut twist = Vector2::new(0.0, spins[0] - spins[1]);
    for n in 0..4 {
        simulation.step().unwrap();
        twist = rosenbrock_step(&matrix, step, twist);
        let [one, other] = [0, 1].map(|body| simulation.body(body).spin[0]);
        let error = (one - other - twist[1]).abs();
        assert!(error <= 1e-9 * twist[1].abs(), "{n}: {} for {}", one - other, twist[1]);
        // Nothing acts from outside: the mean stays.
        assert!((one + other - spins[0] - spins[1]).abs() <= 1e-15, "{n}: {one} {other}");
    }
}

/// One step of the linearly implicit method on y' = A y.
fn rosenbrock_step(a: &Matrix2<f64>, h: f64, y: Vector2<f64>) -> Vector2<f64> {
    let inverse = (Matrix2::identity() - a * (h * ros::GAMMA)).try_inverse().unwrap();
    let mut stages: Vec<Vector2<f64>> = Vec::new();
    for i in 0..ros::STAGES {
        let sum = |by: &[f64; 3]| -> Vector2<f64> {
            stages.iter().zip(by).map(|(k, factor)| k * *factor).sum()
        };
        let at = y + sum(&ros::ALPHA[i]) * h;
        stages.push(inverse * (a * at + a * sum(&ros::GAMMAS[i]) * h));
    }
    stages.iter().zip(ros::WEIGHTS).fold(y, |y, (k, weight)| y + k * (h * weight))
}
