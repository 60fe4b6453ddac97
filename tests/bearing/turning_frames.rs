//! Frames that turn with bodies in linearly implicit steps.

use crate::common::table_4_1;
use crate::connected_bodies::free;
use crate::connections::{SPRING, kinds};
use crate::dynamics::{Noise, RPM, bearing};
use crate::dynamics_integrators::started;

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::assembly::mount::Mount;
use bearing_dynamics::assembly::state::{BODY, BodyState, ORIENTATION, Places, SPIN};
use bearing_dynamics::ch2_housing::bearing::inertia::hollow_cylinder;
use bearing_dynamics::members::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::motion::rosenbrock as ros;
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Stepping};
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

/// Two bodies that rotate against each other on a torsion spring, or tilt against each other on a spring, in steps many
/// times longer than its period. They follow the linear algebra of the method for two equations without any frame.
#[test]
fn rotation_between_turning_frames_is_that_of_the_method_without_frames() {
    let inertia = hollow_cylinder(5e-3, 20e-3, 60e-3, 7850.0);
    let torsion = kinds().swap_remove(1).law;
    let Law::Torsion(of) = &torsion else { panic!("the second kind is torsion") };
    let twist = (inertia.axial, of.stiffness, of.damping);
    let spring = SpringDashpot { rest: [0.0; 3], ..SPRING };
    let tilt =
        |axis: usize| (inertia.transverse, spring.stiffness[3 + axis], spring.damping[3 + axis]);
    let (about_y, about_z) = (tilt(1), tilt(2));
    let tilting = Law::SpringDashpot(spring);
    for (axis, law, (inertia, stiffness, damping)) in
        [(0, torsion, twist), (1, tilting.clone(), about_y), (2, tilting, about_z)]
    {
        let matrix = [[0.0, 1.0], [-2.0 * stiffness / inertia, -2.0 * damping / inertia]];
        let matrix = Matrix2::from_fn(|i, j| matrix[i][j]);
        let ends = [0, 1].map(|body| Mount { body, along: 0.0, reversed: false });
        let assembly = Assembly {
            bodies: vec![free("one"), free("other")],
            connections: vec![Connection { name: "spring".into(), label: None, ends, law }],
            ..Assembly::default()
        };
        let places = Places::of(&assembly);
        let mut state = vec![0.0; places.state_len()];
        // Angles of microradians, to whose square the spring is linear.
        let spins = [3e-3, -1e-3];
        for (body, size) in spins.into_iter().enumerate() {
            let mut at = BodyState::at_rest([0.0; 3]);
            at.spin[axis] = size;
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
        let mut angle = Vector2::new(0.0, spins[0] - spins[1]);
        for n in 0..4 {
            simulation.step().unwrap();
            angle = rosenbrock_step(&matrix, step, angle);
            let [one, other] = [0, 1].map(|body| simulation.body(body).spin[axis]);
            let error = (one - other - angle[1]).abs();
            assert!(error <= 1e-9 * angle[1].abs(), "{axis} {n}: {} for {}", one - other, angle[1]);
            // Nothing acts from outside: the mean stays.
            assert!((one + other - spins[0] - spins[1]).abs() <= 1e-15, "{n}: {one} {other}");
        }
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
