//! Several bearings on one rigid shaft: closed forms, balance, equilibrium and motion.

use crate::{common, dynamics};

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::geometry::BearingGeometry;
use bearing_dynamics::ch2_housing::bearing::inertia::hollow_cylinder;
use bearing_dynamics::equilibrium::initial::{at_start, static_assembly};
use bearing_dynamics::equilibrium::statics::{StaticOptions, solve_assembly};
use bearing_dynamics::members::bearing::Bearing;
use bearing_dynamics::members::body::{Body, Drive, DrivenBody, Mobility, Rotation};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::rigid_body::{BodyKinematics, kinematics_at_mount};
use bearing_dynamics::members::state::{BodyState, POSITION, SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Start, Stepping};
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use common::{table_4_1, table_5_3};
use dynamics::*;
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::TAU;

/// Puts every ball back into the plane through its outer race's axis in which statics holds it.
fn hold_azimuths(simulation: &mut Simulation) {
    let Simulation { system, state, .. } = simulation;
    for (set, bearing) in system.sets.iter().zip(&system.assembly.bearings) {
        let facing = if bearing.mounts[1].reversed { -1.0 } else { 1.0 };
        for ball in 0..set.layout.balls {
            let angle = bearing.ball_phase + TAU * ball as f64 / set.layout.balls as f64;
            let tangent = Vector3::new(0.0, -facing * angle.sin(), angle.cos());
            let mut body = set.layout.ball_state(state, ball);
            let across = |v: [f64; 3]| -> [f64; 3] {
                let v = Vector3::from(v);
                (v - tangent * tangent.dot(&v)).into()
            };
            body.position = across(body.position);
            body.velocity = across(body.velocity);
            set.layout.set_ball(state, ball, &body);
        }
    }
}

pub fn body(name: &str, mobility: Mobility, rest: [f64; 5]) -> Body {
    Body { name: name.into(), label: None, mobility, rest, rotating_load: None, unbalance: 0.0 }
}

/// A steel shaft of 30 mm, 120 mm long, under constant loads.
pub fn shaft(loads: [f64; 5], speed: f64) -> DrivenBody {
    DrivenBody {
        inertia: hollow_cylinder(0.0, 15e-3, 120e-3, 7850.0),
        ..race(loads, Rotation::Speed(Profile::Constant(speed)))
    }
}

/// A bearing of these lengths between the body at `along` and the fixed body `outer`.
pub fn seated(
    geometry: BearingGeometry,
    name: &str,
    along: f64,
    reversed: bool,
    outer: usize,
) -> Bearing {
    let alone = bearing(geometry, [0.0; 5], 0.0).assembly().bearings.remove(0);
    Bearing {
        name: Some(name.into()),
        mounts: [Mount { body: 0, along, reversed }, Mount { body: outer, along: 0.0, reversed }],
        ..alone
    }
}

/// A shaft on two angular-contact bearings back to back, 80 mm apart and preloaded by 6 µm each.
pub fn on_two(loads: [f64; 5], speed: f64) -> Assembly {
    let geometry = table_5_3();
    Assembly {
        bodies: vec![
            body("the shaft", Mobility::Driven(shaft(loads, speed).into()), [0.0; 5]),
            body("the left outer race", Mobility::Fixed, [-40e-3 - 6e-6, 0.0, 0.0, 0.0, 0.0]),
            body("the right outer race", Mobility::Fixed, [40e-3 + 6e-6, 0.0, 0.0, 0.0, 0.0]),
        ],
        bearings: vec![
            seated(geometry, "left", -40e-3, false, 1),
            seated(geometry, "right", 40e-3, true, 2),
        ],
        gravity: GRAVITY,
        ..Assembly::default()
    }
}

pub fn rates(assembly: &Assembly, state: &[f64]) -> (System, Vec<f64>) {
    let mut system = System::new(assembly.clone(), Kernel::Simd);
    let mut rates = vec![0.0; state.len()];
    system.evaluate(0.0, state, &mut rates);
    (system, rates)
}

/// Where statics stops no body and no ball is accelerated, and both bearings carry the load together.
#[test]
fn a_shaft_starts_in_equilibrium_on_both_bearings() {
    let loads = [150.0, 80.0, -600.0, 3.0, -2.0];
    let assembly = on_two(loads, 0.0);
    let state = start::at_equilibrium(&assembly).unwrap();
    let (system, rates) = rates(&assembly, &state);
    let at = system.places.body(0);
    let inertia = assembly.bodies[0].inertia().unwrap();
    for i in 0..3 {
        let force = rates[at + VELOCITY + i] * inertia.mass;
        assert!(force.abs() <= 1e-8 * 600.0, "{i}: {force:e} N");
        let moment = rates[at + SPIN + i] * inertia.transverse;
        assert!(moment.abs() <= 1e-8 * 600.0 * 40e-3, "{i}: {moment:e} N m");
    }
    let weight = inertia.mass * 9.81;
    let sum = system
        .sets
        .iter()
        .fold([0.0; 3], |sum, set| [0, 1, 2].map(|i| sum[i] + set.on_races[0].force[i]));
    for (i, applied) in [loads[0], loads[1], loads[2] - weight].into_iter().enumerate() {
        assert!((sum[i] + applied).abs() <= 1e-10 * 600.0, "{i}: {:e} N", sum[i] + applied);
    }
    // Either bearing's balls stand still but for what the cage takes, a part of 1e-5 of the load.
    for (set, bearing) in system.sets.iter().zip(&assembly.bearings) {
        for ball in 0..set.layout.balls {
            let force =
                set.layout.ball_vector(&rates, VELOCITY, ball).map(|a| a * bearing.ball.mass);
            let [_, y, z] = set.layout.ball_vector(&state, POSITION, ball);
            let outward = (force[1] * y + force[2] * z) / y.hypot(z);
            assert!(outward.abs().max(force[0].abs()) <= 1e-8 * 600.0, "{force:?}");
        }
    }
}

/// One bearing whose shaft is its inner race, and the same with the shaft's centre 70 mm away along its axis.
#[test]
fn where_a_shaft_has_its_centre_changes_nothing() {
    let geometry = table_4_1(-5e-6);
    let shifted = |along: f64| {
        let mut problem = bearing(geometry, [0.0; 5], 0.0);
        problem.traction = CONSTANT;
        problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
        let mut assembly = problem.assembly();
        assembly.bearings[0].mounts[0].along = along;
        // The same place in the world.
        assembly.bodies[1].rest[0] = along;
        // Of so much more inertia about its centre that the same turns follow.
        let race = assembly.bodies[0].driven_mut().unwrap();
        race.rotation = Rotation::Speed(Profile::Constant(300.0));
        race.drives = [0.0, 2e-6, -6e-6, 0.0, 0.0].map(|at| Drive::Motion(Profile::Constant(at)));
        let options = RunOptions {
            start: Start::Equilibrium,
            integrator: Integrator::Rosenbrock,
            stepping: Stepping::Accuracy(1e-5),
            ..RunOptions::default()
        };
        let mut simulation = Simulation::new(assembly, options).unwrap();
        while simulation.time < 2e-3 {
            simulation.step().unwrap();
        }
        simulation.snapshot();
        let [inner, outer] = simulation.system.sets[0].on_races;
        (inner.force, outer.moment, simulation.steps)
    };
    let ((near, near_moment, steps), (far, far_moment, far_steps)) = (shifted(0.0), shifted(70e-3));
    println!("{near:?} {far:?}, {steps} and {far_steps} steps");
    for i in 0..3 {
        // Positions 70 mm out are rounded at 1e-17 m, some 1e-12 of an overlap, and steps adapt to that.
        assert!((near[i] - far[i]).abs() <= 1e-5 * 500.0, "{i}: {} {}", near[i], far[i]);
        assert!((near_moment[i] - far_moment[i]).abs() <= 1e-5, "{i}");
    }
}

/// Velocities against differences of places, of a body that moves, tilts and spins.
#[test]
fn what_sits_on_a_body_moves_as_that_place_of_it() {
    const STEP: f64 = 1e-6;
    let mut body = BodyState::at_rest([1e-3, -2e-3, 3e-3]);
    body.orientation = UnitQuaternion::from_euler_angles(0.3, -0.2, 0.1);
    (body.velocity, body.spin) = ([0.5, -0.3, 0.2], [90.0, 4.0, -7.0]);
    let [place, own] = [body.position, body.axis()].map(Vector3::from);
    let [velocity, spin] = [body.velocity, body.spin].map(Vector3::from);
    let at = |t: f64| {
        let position = (place + velocity * t).into();
        let orientation = UnitQuaternion::new(spin * t) * body.orientation;
        BodyKinematics::new(BodyState { position, orientation, ..body })
    };
    for (along, reversed) in [(0.0, true), (40e-3, false), (-30e-3, true)] {
        let mount = Mount { body: 0, along, reversed };
        let [before, now, after] = [-STEP, 0.0, STEP].map(|t| kinematics_at_mount(&at(t), &mount));
        let [before, there, after] =
            [&before, &now, &after].map(|now| Vector3::from(now.state.position));
        // (ω t)² of some m/s, and rounding of mm over a step.
        let speed = (after - before) / (2.0 * STEP);
        assert!((Vector3::from(now.state.velocity) - speed).norm() <= 1e-7, "{along}");
        assert!((there - place - own * along).norm() <= 1e-17, "{along}");
        let axis = Vector3::from(now.motion.axis) * if reversed { -1.0 } else { 1.0 };
        assert!((axis - own).norm() <= 1e-15, "{reversed}");
        assert_eq!(now.state.spin, body.spin);
    }
}

/// Nothing but balls between a free shaft and two free rings: momentum and energy stay.
#[test]
fn a_free_shaft_and_its_bearings_keep_momentum_and_energy() {
    let mut assembly = on_two([0.0; 5], 0.0);
    assembly.gravity = [0.0; 3];
    assembly.bodies[0].mobility = Mobility::Driven(
        DrivenBody { rotation: Rotation::Torque(Profile::ZERO), ..shaft([0.0; 5], 0.0) }.into(),
    );
    let ring = hollow_cylinder(36e-3, 40e-3, 16e-3, 7850.0);
    for index in [1, 2] {
        assembly.bodies[index].mobility =
            Mobility::Driven(DrivenBody { inertia: ring, ..free_race() }.into());
    }
    let mut state = start::nominal(&assembly);
    let places = bearing_dynamics::assembly::places::Places::of(&assembly);
    let at = places.body(0);
    for (entry, value) in [(VELOCITY + 1, 0.02), (VELOCITY, 0.01), (SPIN, 90.0), (SPIN + 2, 0.5)] {
        state[at + entry] += value;
    }
    let (momentum, angular) = momenta(assembly.clone(), &state);
    let options = fixed_step(2e-7, Start::Nominal);
    let mut simulation = Simulation::from_state(assembly.clone(), options, state, 0.0).unwrap();
    for _ in 0..20_000 {
        simulation.step().unwrap();
    }
    let (momentum_end, angular_end) = momenta(assembly, &simulation.state);
    let snapshot = simulation.snapshot();
    let scale = momentum.norm();
    assert!((momentum_end - momentum).norm() <= 1e-11 * scale, "{momentum_end}");
    assert!((angular_end - angular).norm() <= 1e-10 * angular.norm(), "{angular_end}");
    let met = snapshot.energy.contact;
    println!("residual {:e} of {met:e} J in contacts", snapshot.residual);
    assert!(snapshot.residual.abs() <= 1e-7 * simulation.checkpoint().balance.largest_contact);
}

/// The linearly implicit method with its matrix over shaft, rings and balls goes where Runge–Kutta goes.
#[test]
fn both_methods_take_a_shaft_the_same_way() {
    let mut assembly = on_two([100.0, 0.0, -400.0, 1.0, 0.0], 1000.0 * RPM);
    for bearing in &mut assembly.bearings {
        bearing.traction = CONSTANT;
        bearing.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
    }
    let shaft = assembly.bodies[0].driven_mut().unwrap();
    shaft.drives[2] =
        Drive::Load(Profile::HalfSine { base: -400.0, peak: -600.0, start: 0.0, duration: 1e-3 });
    let end = |integrator, stepping| {
        let options =
            RunOptions { start: Start::Equilibrium, integrator, stepping, ..RunOptions::default() };
        let mut simulation = Simulation::new(assembly.clone(), options).unwrap();
        while simulation.time < 2e-3 {
            let left = 2e-3 - simulation.time;
            simulation.step_by(simulation.step_size.min(left)).unwrap();
            if left < 1e-12 {
                break;
            }
        }
        let at = simulation.system.places.body(0);
        (BodyState::from_slice(&simulation.state[at..at + 13]), simulation.steps)
    };
    let (exact, _) = end(Integrator::RungeKutta, Stepping::Fixed(1e-7));
    let mut errors = Vec::new();
    for accuracy in [1e-2, 1e-3, 1e-4] {
        let (found, steps) = end(Integrator::Rosenbrock, Stepping::Accuracy(accuracy));
        let error =
            (0..3).map(|i| (found.position[i] - exact.position[i]).abs()).fold(0.0, f64::max);
        println!("accuracy {accuracy}: {error:e} m in {steps} steps");
        errors.push(error);
    }
    // The deepest contact is some 5 µm.
    assert!(errors[1] <= 1e-3 * 5e-6 && errors[2] <= 1e-4 * 5e-6, "{errors:?}");
}

/// Names and the order of the lists are no physics.
#[test]
fn the_order_of_bodies_and_bearings_changes_nothing() {
    let loads = [100.0, 50.0, -400.0, 1.0, 0.5];
    let one = on_two(loads, 500.0 * RPM);
    let mut other = one.clone();
    // Shaft last, outer races the other way round, bearings too.
    other.bodies = vec![one.bodies[2].clone(), one.bodies[1].clone(), one.bodies[0].clone()];
    other.bearings.reverse();
    for bearing in &mut other.bearings {
        bearing.name = bearing.name.as_ref().map(|name| format!("the {name} one"));
        for mount in &mut bearing.mounts {
            mount.body = 2 - mount.body;
        }
    }
    let after = |assembly: &Assembly, shaft: usize| {
        let mut simulation =
            Simulation::new(assembly.clone(), fixed_step(1e-6, Start::Equilibrium)).unwrap();
        for _ in 0..500 {
            simulation.step().unwrap();
        }
        let at = simulation.system.places.body(shaft);
        simulation.state[at..at + 13].to_vec()
    };
    let (first, second) = (after(&one, 0), after(&other, 2));
    let largest =
        |part: std::ops::Range<usize>| first[part].iter().fold(0.0f64, |m, x| m.max(x.abs()));
    for (i, (a, b)) in first.iter().zip(&second).enumerate() {
        let scale = match i {
            0..3 => largest(0..3),
            3..7 => 1.0,
            // Of swinging through these displacements, and by the shaft's own turns.
            7..10 => 1e4 * largest(0..3),
            _ => largest(10..13),
        };
        assert!((a - b).abs() <= 1e-9 * scale, "{i}: {a:e} {b:e}");
    }
}

/// A shaft under dashpots ends where statics has it, as a bearing alone does.
#[test]
fn a_damped_shaft_settles_into_static_equilibrium() {
    let loads = [300.0, 100.0, -500.0, 2.0, -1.0];
    let mut assembly = on_two(loads, 0.0);
    assembly.gravity = [0.0; 3];
    let expected = at_start(&assembly).unwrap();
    for bearing in &mut assembly.bearings {
        bearing.damping = ContactDamping::HuntCrossley { alpha: 3.0 };
    }
    let shaft = assembly.bodies[0].driven_mut().unwrap();
    shaft.drives = loads.map(|load| {
        let (start, duration) = (0.0, 60e-3);
        Drive::Load(Profile::SmoothRamp { from: 0.8 * load, to: load, start, duration })
    });
    // As fast as those of a bearing alone for the mass and inertia that a shaft has.
    shaft.foundation_damping = [1e4, 1e4, 1e4, 8.0, 8.0];
    let mut simulation = Simulation::new(assembly, fixed_step(2e-6, Start::Equilibrium)).unwrap();
    for _ in 0..40_000 {
        simulation.step().unwrap();
        hold_azimuths(&mut simulation);
    }
    let at = simulation.system.places.body(0);
    let end = BodyState::from_slice(&simulation.state[at..at + 13]);
    let expected = &expected.coordinates[0];
    let largest = (0..3).map(|i| expected[i].abs()).fold(0.0, f64::max);
    let off = (0..3).map(|i| (end.position[i] - expected[i]).abs()).fold(0.0, f64::max);
    println!("off by {:e} of {largest:e} m", off / largest);
    assert!(off <= 1e-6 * largest, "{off:e} of {largest:e}");
}

/// Balls ride on the outer race: what stands under it carries the load, both races and all balls, and however far it
/// gives way the inner race goes along.
#[test]
fn a_soft_foundation_carries_everything_above_it() {
    let mut problem = bearing(table_4_1(-5e-6), [0.0, 0.0, -300.0, 0.0, 0.0], 0.0);
    problem.gravity = GRAVITY;
    for stiffness in [1e6, 1e4] {
        let mut outer = race([0.0; 5], Rotation::Speed(Profile::ZERO));
        outer.foundation_stiffness = [stiffness, stiffness, stiffness, 1e4, 1e4];
        problem.outer = Some(outer);
        let assembly = problem.assembly();
        let statics = static_assembly(&assembly, 0.0, &[]);
        let found = solve_assembly(&statics, None, &StaticOptions::default()).unwrap();
        let races: f64 = (0..2).map(|body| assembly.bodies[body].inertia().unwrap().mass).sum();
        let balls = problem.geometry.ball_count as f64 * problem.ball.mass;
        let (carried, sunk) = (300.0 + 9.81 * (races + balls), -found.coordinates[1][2]);
        // Statics leaves 1e-11 of its loads; the balls weigh a 500th of them.
        assert!((stiffness * sunk / carried - 1.0).abs() <= 1e-8, "{} {carried}", stiffness * sunk);
        // The softer one sinks by five ball radii; overlaps are some micrometres.
        assert!((found.coordinates[0][2] + sunk).abs() <= 20e-6, "{}", found.coordinates[0][2]);
    }
}

/// Two bearings that share nothing go as each of them goes alone, to the bit.
#[test]
fn bearings_side_by_side_go_as_each_alone() {
    let alone = |geometry, loads| {
        let mut problem = bearing(geometry, loads, 1000.0 * RPM);
        problem.gravity = GRAVITY;
        problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
        problem.assembly()
    };
    // Loose, so that contacts come and go: eight balls under a radial load, eleven under one of another direction.
    let ones = [
        alone(table_4_1(8e-6), [0.0, 0.0, -400.0, 0.0, 0.0]),
        alone(table_5_3(), [60.0, 900.0, 0.0, 0.0, 0.0]),
    ];
    let end = |assembly: &Assembly| {
        let mut simulation =
            Simulation::new(assembly.clone(), fixed_step(1e-6, Start::Nominal)).unwrap();
        for _ in 0..600 {
            simulation.step().unwrap();
        }
        (0..assembly.bodies.len())
            .map(|body| simulation.system.places.body(body))
            .map(|at| simulation.state[at..at + 13].to_vec())
            .collect::<Vec<_>>()
    };
    let [first, second] = ones.each_ref().map(&end);
    for order in [[0, 1], [1, 0]] {
        let mut both = ones[order[0]].clone();
        let offset = both.bodies.len();
        let mut other = ones[order[1]].clone();
        for (assembly, name) in [(&mut both, "one"), (&mut other, "other")] {
            assembly.bearings[0].name = Some(name.into());
        }
        for mount in &mut other.bearings[0].mounts {
            mount.body += offset;
        }
        both.bodies.extend(other.bodies);
        both.bearings.extend(other.bearings);
        let bodies = end(&both);
        let expected = order.map(|index| [&first, &second][index]);
        for (side, expected) in expected.into_iter().enumerate() {
            let own = &bodies[side * offset..][..expected.len()];
            assert_eq!(own, expected, "{order:?} {side}");
        }
    }
}
