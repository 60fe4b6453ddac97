//! Bodies that connections join: momentum and books in motion, equilibria, the bound on the step.

use crate::connections::{SPRING, kinds, pair, spring};
use crate::{dynamics, shafts};

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::assembly::places::Places;
use bearing_dynamics::ch2_housing::bearing::inertia::hollow_cylinder;
use bearing_dynamics::equilibrium::initial::at_start;
use bearing_dynamics::equilibrium::lists::{Loaded, Place, StaticAssembly, StaticBody};
use bearing_dynamics::equilibrium::statics::{
    Determinacy, StaticOptions, StaticsError, solve_assembly,
};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::body::{Body, Condition, Drive, DrivenBody, Mobility, Rotation};
use bearing_dynamics::members::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::rigid_body;
use bearing_dynamics::members::rigid_body::kinematics_at_mount;
use bearing_dynamics::members::state::{POSITION, SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{Simulation, SimulationError, Start};
use bearing_dynamics::motion::stability::step_limit;
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use dynamics::*;
use nalgebra::Vector3;

fn body(name: &str, mobility: Mobility) -> Body {
    shafts::body(name, mobility, [0.0; 5])
}

pub fn free(name: &str) -> Body {
    let inertia = hollow_cylinder(5e-3, 20e-3, 60e-3, 7850.0);
    let rotation = Rotation::Torque(Profile::ZERO);
    body(name, Mobility::Driven(DrivenBody { inertia, ..race([0.0; 5], rotation) }.into()))
}

/// Two free bodies on a spring: momentum to rounding, and what is lost is booked.
#[test]
fn two_bodies_on_a_spring_keep_momentum_and_book_their_loss() {
    for connection in kinds() {
        let assembly = Assembly {
            bodies: vec![free("one"), free("other")],
            connections: vec![connection],
            ..Assembly::default()
        };
        let places = Places::of(&assembly);
        let mut state = vec![0.0; places.state_len()];
        for (index, now) in pair(3, 0.1).iter().enumerate() {
            let at = places.body(index);
            state[at..at + 13].copy_from_slice(&now.state.to_array());
        }
        let before = momenta(assembly.clone(), &state);
        let options = fixed_step(0.5e-6, Start::Nominal);
        let mut simulation = Simulation::from_state(assembly.clone(), options, state, 0.0).unwrap();
        for _ in 0..4000 {
            simulation.step().unwrap();
        }
        let snapshot = simulation.snapshot();
        let end = momenta(assembly, &simulation.state);
        assert!((end.0 - before.0).norm() <= 1e-12 * before.0.norm());
        assert!((end.1 - before.1).norm() <= 1e-10 * before.1.norm(), "{} {}", end.1, before.1);
        let lost: f64 = snapshot.ledger.iter().sum();
        println!("lost {lost} J, residual {:e} J", snapshot.residual);
        assert!(lost < -1.0);
        // Runge-Kutta at ωh of 0.05 to 0.1: (ωh)⁵/120 a step of what swings, for four thousand of them that die out.
        assert!(snapshot.residual.abs() <= 1e-5 * lost.abs(), "{:e}", snapshot.residual);
    }
}

/// A connection of no stiffness and no damping is none, to the bit.
#[test]
fn nothing_is_left_of_a_connection_of_zeros() {
    let mut with =
        bearing(crate::common::table_4_1(-5e-6), [0.0, 0.0, -300.0, 0.0, 0.0], 100.0).assembly();
    let without = with.clone();
    let ends = [Mount { body: 0, along: 0.02, reversed: false }, Mount::at_centre(1)];
    let law = Law::SpringDashpot(SpringDashpot::default());
    with.connections.push(Connection { name: "nothing".into(), label: None, ends, law });
    assert!(with.connections[0].is_void());
    let end = |assembly: &Assembly| {
        let mut simulation =
            Simulation::new(assembly.clone(), fixed_step(1e-6, Start::Equilibrium)).unwrap();
        for _ in 0..200 {
            simulation.step().unwrap();
        }
        simulation.state.iter().map(|value| (value + 0.0).to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(end(&with), end(&without));
}

/// Where statics puts a body between springs nothing accelerates it.
#[test]
fn a_body_on_springs_stands_where_its_load_is_carried() {
    let mut connection = spring();
    connection.ends = [Mount::at_centre(1), Mount { body: 0, along: 0.01, reversed: false }];
    let loads = [200.0, -100.0, 300.0, 1.5, -2.0];
    let held = Place::Fixed(Pose::identity());
    let loaded = Loaded {
        axes: None,
        conditions: loads.map(Condition::Load),
        springs: [0.0; 5],
        rest: [0.0; 5],
        start: Some([0.0; 5]),
        room: 1.0,
    };
    let named = |name: &str, place| StaticBody { name: name.into(), place };
    let statics = StaticAssembly {
        bodies: vec![named("body", Place::Loaded(loaded)), named("ground", held)],
        connections: vec![connection.clone()],
        ..StaticAssembly::default()
    };
    let found = solve_assembly(&statics, None, &StaticOptions::default()).unwrap();
    let mut moved = free("body");
    let race = moved.driven_mut().unwrap();
    *race = DrivenBody {
        inertia: race.inertia,
        ..dynamics::race(loads, Rotation::Speed(Profile::ZERO))
    };
    let assembly = Assembly {
        bodies: vec![moved, body("ground", Mobility::Fixed)],
        connections: vec![connection.clone()],
        ..Assembly::default()
    };
    let state = start::at_equilibrium(&assembly).unwrap();
    let at = bearing_dynamics::members::rigid_body::fixed(&found.coordinates[0].into());
    assert_eq!(state[..13], at.state.to_array());
    // A wall thinner than the way across ends search and motion.
    let ends = [rigid_body::fixed(&[0.0; 5]), kinematics_at_mount(&at, &connection.ends[1])];
    let [.., across] = connection.extension([&ends[0], &ends[1]]);
    let walled = |wall: f64| {
        let mut assembly = assembly.clone();
        let Law::SpringDashpot(law) = &mut assembly.connections[0].law else { panic!("springs") };
        law.wall = Some(wall);
        assembly
    };
    assert!(start::at_equilibrium(&walled(1.01 * across)).is_ok());
    let thin = walled(0.99 * across);
    let refused = start::at_equilibrium(&thin).unwrap_err();
    assert!(matches!(refused, StaticsError::ThroughWall { .. }), "{refused}");
    let ended = Simulation::new(thin, fixed_step(1e-6, Start::Nominal)).map(|_| ()).unwrap_err();
    assert!(matches!(ended, SimulationError::ThroughWall { .. }), "{ended}");
    // Without its spring nothing holds it.
    let mut loose = assembly.clone();
    loose.connections.clear();
    let error = start::at_equilibrium(&loose).unwrap_err();
    assert!(matches!(error, StaticsError::NoEquilibrium { .. }), "{error}");
    let mut system = System::new(assembly.clone(), Kernel::Simd);
    let mut rates = vec![0.0; state.len()];
    system.evaluate(0.0, &state, &mut rates);
    let inertia = assembly.bodies[0].inertia().unwrap();
    // Statics turns by Euler angles without spin (2.16), a motion without speed about its own axis: a moment about
    // the axis works on the tilt about Y by the sine of the other one.
    let section = kinematics_at_mount(&system.bodies[0], &assembly.connections[0].ends[1]);
    let pull = assembly.connections[0].forces([&system.bodies[1], &section], &[]);
    let about_axis = Vector3::from(pull.on[1].moment).dot(&Vector3::from(section.motion.axis));
    let allowed = 1e-9 + (about_axis * found.coordinates[0][4]).abs();
    for i in 0..3 {
        assert!((rates[VELOCITY + i] * inertia.mass).abs() <= 1e-8 * 300.0, "{i}");
        let moment = rates[SPIN + i] * inertia.transverse;
        assert!(moment.abs() <= 1.01 * allowed, "{i}: {moment:e} of {allowed:e}");
    }
    assert!(state[POSITION].abs() > 1e-5);
}

/// The step of a stiff spring between bodies is bound by it, and said so.
#[test]
fn a_stiff_connection_binds_the_step() {
    let connection = spring();
    for (spring, expected) in [(true, "oscillation at "), (false, "decay at ")] {
        let assembly = on_two_bodies(connection.clone(), spring);
        let state = start::nominal(&assembly);
        let mut system = System::new(assembly.clone(), Kernel::Simd);
        let limit = step_limit(&mut system, 0.0, &state).unwrap();
        let reason = limit.reason(&assembly);
        assert!(reason.starts_with(expected), "{reason}");
        assert!(assembly.bodies.iter().any(|body| reason.contains(&body.name)), "{reason}");
        // The period of two masses on the spring, 2.83/ω of Runge-Kutta.
        if spring {
            let mass = assembly.bodies[0].inertia().unwrap().mass;
            let expected = 2.0 * 2f64.sqrt() / (STIFF * 2.0 / mass).sqrt();
            assert!((limit.step / expected - 1.0).abs() <= 1e-3, "{} {expected}", limit.step);
        }
    }
}

/// N/m.
const STIFF: f64 = 1e12;

/// Two free bodies and, far softer, a bearing between the first and the ground.
fn on_two_bodies(mut connection: Connection, spring: bool) -> Assembly {
    let mut assembly = bearing(crate::common::table_4_1(-5e-6), [0.0; 5], 0.0).assembly();
    assembly.bodies = vec![free("one"), assembly.bodies[1].clone(), free("other")];
    connection.ends = [Mount::at_centre(0), Mount::at_centre(2)];
    connection.law = Law::SpringDashpot(match spring {
        true => SpringDashpot { stiffness: [STIFF, 0.0, 0.0, 0.0, 0.0, 0.0], ..Default::default() },
        false => SpringDashpot { damping: [0.0, 0.0, 1e7, 0.0, 0.0, 0.0], ..Default::default() },
    });
    assembly.connections = vec![connection];
    assembly
}

/// Six springs hold a body as well as springs to the ground do; a torsion spring holds it against twist alone, which is
/// no coordinate of statics.
#[test]
fn what_a_connection_holds_is_determinate() {
    let loaded = Loaded {
        axes: None,
        conditions: [200.0, -100.0, 300.0, 1.5, -2.0].map(Condition::Load),
        springs: [0.0; 5],
        rest: [0.0; 5],
        start: Some([0.0; 5]),
        room: 1.0,
    };
    let named = |name: &str, place| StaticBody { name: name.into(), place };
    let mut statics = StaticAssembly {
        bodies: vec![
            named("body", Place::Loaded(loaded)),
            named("ground", Place::Fixed(Pose::identity())),
        ],
        connections: vec![spring()],
        ..StaticAssembly::default()
    };
    statics.connections[0].ends = [Mount::at_centre(1), Mount::at_centre(0)];
    let found = solve_assembly(&statics, None, &StaticOptions::default()).unwrap();
    assert_eq!(found.determinacy, Determinacy::Determinate);
    // Stretched by 1e-4 m and 1e-3 rad, so that each spring by itself is right to a hundredth.
    let rest = SPRING.rest;
    for (i, load) in [200.0, -100.0, 300.0].into_iter().enumerate() {
        let stretch = found.coordinates[0][i] - rest[i];
        assert!((stretch * SPRING.stiffness[i] / load - 1.0).abs() <= 1e-2, "{i}: {stretch}");
    }
}

/// A wheel held along its axis, and across it by a spring at arm's length, is tilted by its unbalance by λ = G cos² λ; each round
/// goes the way that is left times λ tan λ/(1 + λ tan λ). A start is found where that is small, and refused where rounds do not
/// settle.
#[test]
fn a_pull_that_turns_with_the_tilt_it_makes_is_followed_or_refused() {
    let (arm, speed, size) = (0.05, 300.0, 1e-2);
    let pull = size * speed * speed;
    let start = |turning: f64| {
        let law = SpringDashpot {
            stiffness: [0.0, 1e9, 1e9, 0.0, turning, turning],
            ..SpringDashpot::default()
        };
        let mut connection = spring();
        connection.ends = [1, 0].map(|body| Mount { along: arm, ..Mount::at_centre(body) });
        connection.law = Law::SpringDashpot(law);
        let mut wheel = free("wheel");
        wheel.unbalance = size;
        let race = wheel.driven_mut().unwrap();
        race.rotation = Rotation::Speed(Profile::Constant(speed));
        race.drives[0] = Drive::Motion(Profile::ZERO);
        at_start(&Assembly {
            bodies: vec![wheel, body("ground", Mobility::Fixed)],
            connections: vec![connection],
            ..Assembly::default()
        })
    };
    for gain in [0.1, 0.4] {
        let found = start(pull * arm / gain).unwrap();
        let tilt = found.coordinates[0][4].abs();
        let expected = gain * tilt.cos().powi(2);
        // The search stops at 1e-11 of the load.
        assert!((tilt / expected - 1.0).abs() <= 1e-9, "{gain}: {tilt} {expected}");
    }
    let refused = start(pull * arm / 1.7).unwrap_err();
    assert_eq!(refused, StaticsError::Unbalanced { body: "wheel".into() });
    assert!(refused.to_string().contains("numerics.start"), "{refused}");
}
