//! Balls that no cage keeps apart: their contact against Hertz's closed form, momentum, energy, and
//! what it costs where nothing is near; states in which a run must end; random scenes.

use crate::common;
use crate::dynamics;
mod random_scenes;

use bearing_dynamics::ch2_housing::bearing::ball_contact::{ball_contact, peak_pressure};
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::traction::Motion;
use bearing_dynamics::solver::dynamics::assembly::{BallMeeting, gap_in_pockets};
use bearing_dynamics::solver::dynamics::bounds::{FARTHEST, HERTZ_SCALE, cage_room, race_limit};
use bearing_dynamics::solver::dynamics::contacts::Driver;
use bearing_dynamics::solver::dynamics::model::{Drive, DynamicProblem};
use bearing_dynamics::solver::dynamics::run::{
    Integrator, RunOptions, Simulation, SimulationError, Start, Stepping,
};
use bearing_dynamics::solver::dynamics::stability::{Cause, step_limit};
use bearing_dynamics::solver::dynamics::start;
use bearing_dynamics::solver::dynamics::state::{Layout, Ledger, POSITION};
use bearing_dynamics::solver::dynamics::step_watch::stiffness;
use bearing_dynamics::solver::dynamics::system::System;
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::statics::StaticsError;
use common::{full_complement, table_4_1, table_5_3};
use dynamics::*;
use nalgebra::Vector3;

/// Races held far from the balls, so that nothing but the balls meet.
fn loose() -> DynamicProblem {
    let mut problem = bearing(table_4_1(200e-6), [0.0; 5], 0.0);
    for drive in &mut problem.inner.drives {
        *drive = Drive::Motion(Profile::ZERO);
    }
    problem.ball_phase = 0.0;
    problem
}

/// Balls 1 and 2 a micrometre apart on the pitch circle, as `motions` has them.
fn two_balls(problem: &DynamicProblem, motions: [Motion; 2]) -> Vec<f64> {
    let layout = Layout::new(problem.geometry.ball_count, false);
    let mut state = start::nominal(&problem.assembly());
    let geometry = &problem.geometry;
    let half = ((geometry.ball_radius + 0.5e-6) / geometry.pitch_radius).asin();
    for (ball, (sign, motion)) in [-1.0, 1.0].into_iter().zip(motions).enumerate() {
        // About the azimuth of 22.5°, halfway between the places of both: along e.
        let (sin, cos) = (std::f64::consts::PI / 8.0 + sign * half).sin_cos();
        let mut body = layout.ball_state(&state, ball);
        body.position = [0.0, geometry.pitch_radius * cos, geometry.pitch_radius * sin];
        body.velocity = motion.velocity;
        body.spin = motion.spin;
        layout.set_ball(&mut state, ball, &body);
    }
    state
}

/// From ball 1 to ball 2.
fn line() -> Vector3<f64> {
    let (sin, cos) = (std::f64::consts::PI / 8.0).sin_cos();
    Vector3::new(0.0, -sin, cos)
}

fn options(integrator: Integrator, stepping: Stepping) -> RunOptions {
    RunOptions { integrator, stepping, energy_limit: f64::INFINITY, ..RunOptions::default() }
}

const ALL: [(Integrator, Stepping); 3] = [
    (Integrator::RungeKutta, Stepping::Fixed(0.1e-6)),
    (Integrator::DormandPrince, Stepping::Accuracy(1e-5)),
    (Integrator::Rosenbrock, Stepping::Accuracy(1e-5)),
];

#[test]
fn an_impact_head_on_is_that_of_hertz() {
    let problem = loose();
    // Hertz (1881): two spheres with E* = E/(2(1 − ν²)), R = r/2, m* = m/2.
    let (modulus, radius) = (210e9 / (2.0 * 0.91), 0.5 * problem.geometry.ball_radius);
    let stiffness = 4.0 / 3.0 * modulus * radius.sqrt();
    let mass = 0.5 * problem.ball.mass;
    let speed: f64 = 0.2;
    let deepest = (5.0 * mass * speed * speed / (4.0 * stiffness)).powf(0.4);
    let force = stiffness * deepest.powf(1.5);
    // (4/5) √π Γ(2/5)/Γ(9/10).
    let duration = 2.943_275 * deepest / speed;
    for (integrator, stepping) in ALL {
        let along = (line() * 0.5 * speed).into();
        let away = (line() * -0.5 * speed).into();
        let moving = |velocity| Motion { velocity, ..Motion::default() };
        let state = two_balls(&problem, [moving(along), moving(away)]);
        let mut simulation =
            Simulation::from_state(problem.clone(), options(integrator, stepping), state, 0.0)
                .unwrap();
        // Overlaps before and after a step, with the instant between them where it is zero.
        let gap = |simulation: &Simulation| {
            let layout = simulation.system.sets[0].layout;
            let [a, b] = [0, 1].map(|ball| layout.ball_vector(&simulation.state, POSITION, ball));
            2.0 * problem.geometry.ball_radius - (Vector3::from(a) - Vector3::from(b)).norm()
        };
        let (mut before, mut time) = (gap(&simulation), 0.0);
        let (mut begins, mut ends, mut peak) = (0.0, 0.0, 0.0f64);
        while simulation.time < 2e-4 {
            let step = simulation.step_size.min(0.5e-6);
            simulation.step_by(step).unwrap();
            let now = gap(&simulation);
            let crossed = time + (simulation.time - time) * before / (before - now);
            if before < 0.0 && now >= 0.0 {
                begins = crossed;
            }
            if before >= 0.0 && now < 0.0 {
                ends = crossed;
            }
            simulation.snapshot().unwrap();
            peak = peak.max(simulation.system.sets[0].meetings[0].normal_load);
            (before, time) = (now, simulation.time);
        }
        println!("{integrator:?}: {peak} N of {force} N, {} s of {duration} s", ends - begins);
        // Looked at every 0.5 µs of 49: the force is flat at its peak, to (π · 0.25/49)²/2 of itself.
        assert!((peak / force - 1.0).abs() <= 2e-4, "{peak} {force}");
        // Crossings are interpolated, where the force begins with the power 3/2 of the overlap; Γ to seven
        // digits.
        assert!(((ends - begins) / duration - 1.0).abs() <= 1e-6, "{} {duration}", ends - begins);
        let velocity =
            |ball| simulation.system.sets[0].layout.ball_state(&simulation.state, ball).velocity;
        // Equal masses exchange their velocities.
        for i in 0..3 {
            // Steps of an accuracy of 1e-5.
            assert!((velocity(0)[i] - away[i]).abs() <= 1e-5 * speed);
            assert!((velocity(1)[i] - along[i]).abs() <= 1e-5 * speed);
        }
    }
}

#[test]
fn an_oblique_impact_with_friction_keeps_momentum_and_books_what_it_loses() {
    let problem = loose();
    let line = line();
    let one = Motion {
        velocity: (line * 0.1 + Vector3::new(0.03, 0.0, 0.0)).into(),
        spin: [30.0, 5.0, -8.0],
        ..Motion::default()
    };
    let other = Motion { spin: [40.0, -3.0, 2.0], ..Motion::default() };
    for (integrator, stepping) in ALL {
        let state = two_balls(&problem, [one, other]);
        let before = momenta(&problem, &state);
        let mut simulation =
            Simulation::from_state(problem.clone(), options(integrator, stepping), state, 0.0)
                .unwrap();
        let first = simulation.snapshot().unwrap().energy.total();
        let mut met = false;
        while simulation.time < 2e-4 {
            simulation.step().unwrap();
            met |= simulation.system.sets[0].meetings[0].normal_load > 0.0;
        }
        assert!(met);
        let after = momenta(&problem, &simulation.state);
        let size = 0.1 * problem.ball.mass;
        let moment = problem.geometry.pitch_radius * size;
        // Rounding of a thousand steps; angular momentum as well as the orbit's curvature is followed.
        assert!((after.0 - before.0).norm() <= 1e-11 * size, "{}", (after.0 - before.0).norm());
        assert!((after.1 - before.1).norm() <= 1e-6 * moment);
        let snapshot = simulation.snapshot().unwrap();
        let lost = ledger(&simulation, Ledger::BallFriction);
        println!("{integrator:?}: lost {lost} of {first} J, residual {}", snapshot.residual);
        // Friction 0.1 at 0.4 m/s over the impulse of m v = 0.7 mN s.
        assert!(lost < -1e-2 * first && lost > -first, "{lost} of {first}");
        // Measured: 1e-8 to 1.4e-7, by the ledger's rule of second order in short steps.
        assert!(snapshot.residual.abs() <= 1e-6 * -lost, "{} of {lost}", snapshot.residual);
        assert_eq!(ledger(&simulation, Ledger::CageFriction), 0.0);
    }
}

#[test]
fn balls_that_are_apart_make_no_difference_to_any_bit() {
    let mut problem = bearing(table_4_1(-5e-6), [50.0, 0.0, -500.0, 0.0, 0.0], 1000.0 * RPM);
    problem.traction = CONSTANT;
    let geometry = problem.geometry;
    let mut caged = problem.clone();
    caged.cage = Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace));
    for problem in [problem, caged] {
        for (integrator, stepping) in ALL {
            let [with, without] = [problem.ball_contact, None].map(|ball_contact| {
                let problem = DynamicProblem { ball_contact, ..problem.clone() };
                let mut simulation =
                    Simulation::new(problem, options(integrator, stepping)).unwrap();
                run(&mut simulation, 100);
                simulation
            });
            assert_eq!(bits(&with.state), bits(&without.state));
            let (mut work, expected) = (with.system.work, without.system.work);
            // A cage keeps its balls apart: no test at all.
            let tests = if problem.cage.is_some() { 0 } else { 8 * work.evaluations };
            assert_eq!((work.ball_tests, expected.ball_tests), (tests, 0));
            work.ball_tests = 0;
            assert_eq!(work, expected);
        }
    }
}

#[test]
fn only_pockets_that_hold_the_balls_apart_spare_the_test() {
    let meeting = |problem: &DynamicProblem| problem.assembly().bearings[0].ball_meeting();
    for geometry in [table_4_1(-5e-6), table_5_3()] {
        let mut problem = bearing(geometry, [0.0; 5], 0.0);
        assert_eq!(meeting(&problem), BallMeeting::Tested);
        problem.cage = Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace));
        let BallMeeting::KeptApart { gap } = meeting(&problem) else { panic!("{problem:?}") };
        // Less than in the middle of the pockets, where the play of both is left.
        let chord =
            2.0 * geometry.pitch_radius * (std::f64::consts::PI / geometry.ball_count as f64).sin();
        assert!(gap > 0.0 && gap < chord - 2.0 * geometry.ball_radius - 2.0 * 0.2e-3, "{gap}");
        // Pockets so wide that two balls can meet in them.
        let free = 0.5 * chord - geometry.ball_radius;
        problem.cage.as_mut().unwrap().contacts.pocket_radius = geometry.ball_radius + free;
        assert_eq!(meeting(&problem), BallMeeting::Tested);
        problem.ball_contact = None;
        assert_eq!(meeting(&problem), BallMeeting::NoLaw);
    }
}

#[test]
fn the_step_limit_knows_the_contact_between_balls() {
    let mut problem = loose();
    // Without friction nothing decays, and the two swing against each other: ω² = 2 k/m.
    let overlap = 2e-6;
    let still = two_balls(&problem, [Motion::default(); 2]);
    let pressed = |problem: &DynamicProblem| {
        let layout = Layout::new(problem.geometry.ball_count, false);
        let mut state = still.clone();
        // From a gap of 1 µm.
        for (ball, sign) in [(0, 1.0), (1, -1.0)] {
            for i in 0..3 {
                state[layout.ball(POSITION + i) + ball] +=
                    sign * line()[i] * 0.5 * (overlap + 1e-6);
            }
        }
        state
    };
    let law = problem.ball_contact.unwrap();
    let radius = problem.geometry.ball_radius;
    let swing = (2.0 * 1.5 * law.stiffness * overlap.sqrt() / problem.ball.mass).sqrt();
    let load = law.stiffness * overlap * overlap.sqrt();
    let (mass, inertia) = (problem.ball.mass, problem.ball.axial);
    let slide = 2.0 * (1.0 / mass + radius * radius / inertia) * law.friction * load
        / law.regularisation_speed;
    for friction in [0.0, law.friction] {
        problem.ball_contact.as_mut().unwrap().friction = friction;
        let state = pressed(&problem);
        let mut system = System::new(problem.clone(), Driver::Lanes);
        let limit = step_limit(&mut system, 0.0, &state).unwrap();
        println!("{}: {} s", limit.reason(), limit.step);
        system.evaluate(0.0, &state, &mut vec![0.0; state.len()]);
        let found = stiffness(&system);
        // Where the stability region of Runge–Kutta ends: on the imaginary axis, to a growth of 1e-6 a
        // step, at 2.83; on the real one at 2.785.
        let (expected, cause) = if friction == 0.0 {
            (8.0_f64.sqrt() / swing, Cause::BallContact)
        } else {
            (2.785_293_563 / slide, Cause::BallFriction)
        };
        assert_eq!(limit.cause, cause);
        // The overlap shortens the arm by 1e-4 of itself; differences are good to 1e-4.
        assert!((limit.step / expected - 1.0).abs() <= 1e-3, "{} {expected}", limit.step);
        assert!((found.oscillation / (swing * swing) - 1.0).abs() <= 1e-9);
        let decay = if friction == 0.0 { 0.0 } else { slide };
        assert!((found.decay - decay).abs() <= 1e-9 * slide);
    }
}

#[test]
fn a_groove_does_not_close_over_its_ball() {
    // The inner race 0.4 mm off: farther from the ball on the other side than its groove is wide.
    let mut problem = bearing(table_4_1(5e-6), [0.0; 5], 0.0);
    problem.ball_phase = 0.0;
    let layout = Layout::new(8, false);
    let mut state = start::nominal(&problem.assembly());
    state[layout.inner() + POSITION + 1] = -0.4e-3;
    let (system, ..) = evaluated(&problem, Driver::Plain, 0.0, &state);
    let contact = system.sets[0].table.contact[0];
    assert!(contact.overlap < 0.0, "{contact:?}");
    // Walls go on straight: an axial offset of the ball meets them at the groove's half width.
    let room = problem.geometry.inner.groove_radius - problem.geometry.ball_radius;
    state[layout.ball(POSITION)] = room + 1e-6;
    let (system, ..) = evaluated(&problem, Driver::Plain, 0.0, &state);
    let contact = system.sets[0].table.contact[0];
    assert!((contact.overlap - 1e-6).abs() <= 1e-15, "{contact:?}");
    assert_eq!(contact.normal, [1.0, 0.0, 0.0]);
}

/// The error that ends a run.
fn ends(problem: DynamicProblem, stepping: Stepping, most: usize) -> SimulationError {
    let integrator = match stepping {
        Stepping::Accuracy(_) => Integrator::Rosenbrock,
        _ => Integrator::RungeKutta,
    };
    let options = RunOptions { start: Start::Nominal, ..options(integrator, stepping) };
    let mut simulation = Simulation::new(problem, options).unwrap();
    let error = (0..most).find_map(|_| simulation.step().err());
    let error = error.unwrap_or_else(|| panic!("still going at {} s", simulation.time));
    assert!(simulation.state.iter().all(|value| value.is_finite()));
    error
}

#[test]
fn a_race_that_leaves_its_bearing_ends_the_run() {
    // Three balls gathered above the inner race, which falls out between them.
    let mut problem = bearing(table_4_1(5e-6), [0.0, 0.0, -20.0, 0.0, 0.0], 0.0);
    problem.geometry.ball_count = 3;
    let layout = Layout::new(3, false);
    let mut state = start::nominal(&problem.assembly());
    for (ball, degrees) in [60.0_f64, 90.0, 120.0].into_iter().enumerate() {
        let mut body = layout.ball_state(&state, ball);
        let (sin, cos) = degrees.to_radians().sin_cos();
        let pitch = problem.geometry.pitch_radius;
        body.position = [0.0, pitch * cos, pitch * sin];
        layout.set_ball(&mut state, ball, &body);
    }
    let accuracy = options(Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    let mut simulation = Simulation::from_state(problem.clone(), accuracy, state, 0.0).unwrap();
    let error = (0..200_000).find_map(|_| simulation.step().err()).unwrap();
    let SimulationError::RaceLeft { bearing: of, way, distance, allowed, time, step } = error
    else {
        panic!("{error}")
    };
    let radius = problem.geometry.ball_radius;
    assert_eq!(of, "the bearing");
    assert_eq!((way, allowed), ("across its axis", race_limit(&problem.geometry)));
    assert!(allowed > radius && allowed < 1.3 * radius, "{allowed}");
    assert!(distance > allowed, "{distance}");
    assert_eq!((time, step), (simulation.time, simulation.steps));
    // An angular-contact bearing drawn apart: its balls are in the way of a race that comes back.
    let mut drawn = bearing(table_5_3(), [0.0; 5], 0.0);
    let way = Profile::Ramp { from: 0.0, to: -8e-3, start: 0.0, duration: 0.05 };
    drawn.inner.drives[0] = Drive::Motion(way);
    let error = ends(drawn, Stepping::Accuracy(1e-3), 200_000);
    assert!(
        matches!(&error, SimulationError::Inside { other, .. } if other == "the inner race"),
        "{error}"
    );
    // Right at once where the state is such.
    let problem = bearing(table_4_1(5e-6), [0.0; 5], 0.0);
    let layout = Layout::new(8, false);
    for (entry, named) in [(0, "along its axis"), (2, "across its axis")] {
        let mut state = start::nominal(&problem.assembly());
        state[layout.inner() + entry] = 52e-3;
        let options = options(Integrator::RungeKutta, Stepping::Fixed(1e-12));
        let mut simulation = Simulation::from_state(problem.clone(), options, state, 0.0).unwrap();
        let error = simulation.step().unwrap_err();
        assert!(matches!(error, SimulationError::RaceLeft { way, .. } if way == named), "{error}");
        assert!(error.to_string().contains("the inner race has left the bearing at t = "));
    }
}

/// What counts is how far the races are from each other, not where in the world they are.
#[test]
fn a_bearing_far_from_the_origin_has_not_come_apart() {
    let mut problem = bearing(table_4_1(5e-6), [0.0; 5], 0.0);
    let far = 52e-3;
    problem.outer_start[1] = far;
    assert!(far > race_limit(&problem.geometry));
    let layout = Layout::new(8, false);
    let mut state = start::nominal(&problem.assembly());
    let y = layout.inner() + POSITION + 1;
    state[y] = far;
    let options = options(Integrator::RungeKutta, Stepping::Fixed(1e-12));
    let started =
        |state: &[f64]| Simulation::from_state(problem.clone(), options, state.to_vec(), 0.0);
    started(&state).unwrap().step().unwrap();
    // The inner race left behind at the origin.
    state[y] = 0.0;
    let error = started(&state).unwrap().step().unwrap_err();
    let SimulationError::RaceLeft { way, distance, .. } = error else { panic!("{error}") };
    assert_eq!(way, "across its axis");
    // A step of 1e-12 s moves nothing.
    assert!((distance - far).abs() <= 1e-12, "{distance}");
}

#[test]
fn parts_inside_each_other_end_the_run() {
    let layout = Layout::new(8, true);
    let mut problem = bearing(table_4_1(-5e-6), [0.0; 5], 0.0);
    problem.ball_contact = None;
    problem.cage = Some(cage(&problem.geometry, Pocket::Cylindrical, Guidance::OuterRace));
    problem.ball_phase = 0.0;
    let radius = problem.geometry.ball_radius;
    let deep = 1.01 * HERTZ_SCALE * radius;
    let nominal = start::nominal(&problem.assembly());
    // What is moved, by how much, and who is named.
    let contacts = problem.cage.as_ref().unwrap().contacts;
    let pocket = contacts.pocket_radius - radius + deep;
    let guide = contacts.race_clearance + deep;
    let room = problem.geometry.outer.groove_radius - radius;
    let cases: [(usize, f64, [&str; 2]); 4] = [
        // Ball 1 along X in the outer groove, where the ball and the pocket are in the way too.
        (layout.ball(POSITION), room + deep, ["ball 1", "the inner race"]),
        (layout.ball(POSITION + 1), deep, ["ball 1", "the outer race"]),
        (layout.cage(), pocket, ["ball 1", "the cage"]),
        (layout.cage() + 1, guide, ["the cage", "its guiding race"]),
    ];
    for (entry, by, names) in cases {
        let mut state = nominal.clone();
        state[entry] += by;
        if names[1] == "its guiding race" {
            // Pockets that do not mind.
            problem.cage.as_mut().unwrap().contacts.pocket_radius = 2.0 * radius;
        }
        let options = options(Integrator::RungeKutta, Stepping::Fixed(1e-12));
        let mut simulation = Simulation::from_state(problem.clone(), options, state, 0.0).unwrap();
        let error = simulation.step().unwrap_err();
        let SimulationError::Inside { one, other, depth, allowed, time, step, .. } = error else {
            panic!("{error}")
        };
        assert_eq!([one.as_str(), other.as_str()], names);
        assert_eq!((allowed, step), (HERTZ_SCALE * radius, 1));
        assert!(depth > allowed && time > 0.0);
    }
    // Balls that run into each other without a law for it.
    problem.cage = None;
    let body = |ball: usize, speed: f64| {
        let mut body = Layout::new(8, false).ball_state(&start::nominal(&problem.assembly()), ball);
        let [_, y, z] = body.position;
        body.velocity = [0.0, -z * speed, y * speed];
        body
    };
    let mut state = start::nominal(&problem.assembly());
    Layout::new(8, false).set_ball(&mut state, 7, &body(7, 400.0));
    let options = options(Integrator::RungeKutta, Stepping::Fixed(1e-6));
    let mut simulation = Simulation::from_state(problem.clone(), options, state, 0.0).unwrap();
    let error = (0..20_000).find_map(|_| simulation.step().err()).unwrap();
    let text = error.to_string();
    assert!(text.starts_with("ball 8 is ") && text.contains(" m inside ball 1 at t = "), "{text}");
    assert!(text.contains("(ball_contact.law) or a cage"), "{text}");
    assert!(!text.contains("numerics.step"), "{text}");
    // A given place that is too much, from the outset.
    let mut problem = bearing(table_4_1(-5e-6), [0.0; 5], 0.0);
    problem.inner.drives[2] = Drive::Motion(Profile::Constant(-1.5e-3));
    let error = Simulation::new(problem, fixed_step(1e-9, Start::Nominal)).err().unwrap();
    let text = error.to_string();
    assert!(matches!(error, SimulationError::Inside { step: 0, .. }), "{text}");
    assert!(text.contains("too much: z of the inner race by -0.0015 m"), "{text}");
}

/// A load that comes later, on races that nothing holds.
#[test]
fn a_bearing_that_nothing_holds_is_refused_or_ends_where_it_flies_to() {
    let mut problem = bearing(table_4_1(10e-6), [0.0; 5], 0.0);
    problem.outer = Some(free_race());
    let ramp = |to: f64| Profile::Ramp { from: 0.0, to, start: 0.0, duration: 1e-3 };
    problem.inner.drives[2] = Drive::Load(ramp(1000.0));
    let options = options(Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    let begun = |problem: &DynamicProblem, start: Start| {
        Simulation::new(problem.clone(), RunOptions { start, ..options })
    };
    let error = begun(&problem, Start::Equilibrium).err().unwrap();
    let SimulationError::Start(StaticsError::Unheld { body, coordinate, load, time }) = &error
    else {
        panic!("{error}")
    };
    // A sixteenth of the ramp.
    assert_eq!((body.as_str(), *coordinate, *load, *time), ("the outer race", "z", 62.5, 62.5e-6));
    assert!(error.to_string().contains("6.250e1 N at t = 0.0000625 s"), "{error}");
    // In nominal positions it may begin; it is held by a spring, a given coordinate, or a load that balances.
    begun(&problem, Start::Nominal).unwrap();
    let held: [&dyn Fn(&mut DynamicProblem); 3] = [
        &|p| p.outer.as_mut().unwrap().foundation_stiffness[2] = 1e8,
        &|p| p.outer.as_mut().unwrap().drives[2] = Drive::Motion(Profile::ZERO),
        &|p| p.outer.as_mut().unwrap().drives[2] = Drive::Load(ramp(-1000.0)),
    ];
    for hold in held {
        let mut held = problem.clone();
        hold(&mut held);
        begun(&held, Start::Equilibrium).unwrap();
    }
    // Both races a metre off together.
    let layout = Layout::new(8, false);
    for (off, ends) in [(0.999 * FARTHEST, false), (1.001 * FARTHEST, true)] {
        let mut state = start::nominal(&problem.assembly());
        for ball in 0..8 {
            let mut body = layout.ball_state(&state, ball);
            body.position[1] += off;
            layout.set_ball(&mut state, ball, &body);
        }
        state[layout.inner() + POSITION + 1] += off;
        state[layout.outer() + POSITION + 1] += off;
        let mut moved = Simulation::from_state(problem.clone(), options, state, 0.0).unwrap();
        match moved.step() {
            Ok(()) => assert!(!ends),
            Err(SimulationError::FlownOff {
                body, coordinate, distance, allowed, step, ..
            }) => {
                assert!(ends && (distance - off).abs() <= 1e-6, "{distance}");
                let found = (body.as_str(), coordinate, allowed, step);
                assert_eq!(found, ("the outer race", "y", FARTHEST, 1));
            }
            Err(error) => panic!("{error}"),
        }
    }
}

/// Round pockets do not hold a cage across its axis: its ring ends what it may go, and with it what the
/// pockets keep between balls.
#[test]
fn a_cage_that_leaves_its_bearing_ends_the_run() {
    let mut problem = bearing(table_4_1(5e-6), [0.0; 5], 0.0);
    problem.ball_phase = 0.0;
    let geometry = problem.geometry;
    let mut body = cage(&geometry, Pocket::Cylindrical, Guidance::Balls);
    body.contacts.ring = [24e-3, 28e-3];
    let law = body.contacts;
    problem.cage = Some(body);
    // To the bottom of the outer groove, and a tenth of a ball radius.
    let room = cage_room(&geometry, &law);
    let expected = 31.953e-3 - 28e-3 + 0.1 * geometry.ball_radius;
    assert!((room - expected).abs() <= 1e-12, "{room} {expected}");
    let gap = gap_in_pockets(&geometry, &law).unwrap();
    // The cage as far as it may go towards the plane between two pockets, their balls as far in and as close to
    // that plane as they may be.
    let half = std::f64::consts::PI / 8.0;
    let (sin, cos) = half.sin_cos();
    let aside = law.pocket_radius - 0.9 * geometry.ball_radius;
    let inmost = geometry.pitch_radius - 0.5 * geometry.ball_radius;
    let distance_at = |off: f64| {
        // Along the pocket: |off (cos, sin) + ρ (1, 0) + aside (0, 1)| = inmost.
        let across = off * sin + aside;
        let along = (inmost * inmost - across * across).sqrt() - off * cos;
        2.0 * (along * sin - aside * cos)
    };
    let apart = distance_at(room) - 2.0 * geometry.ball_radius;
    let centred = distance_at(0.0) - 2.0 * geometry.ball_radius;
    println!("gap {gap:e}, farthest off {apart:e}, centred {centred:e}");
    assert!(gap > 0.0 && gap <= apart && gap < centred - 2e-3, "{gap} {apart} {centred}");
    // Farther than that a run does not go.
    let layout = Layout::new(8, true);
    for (off, ends) in [(0.999 * room, false), (1.001 * room, true)] {
        let mut state = start::nominal(&problem.assembly());
        state[layout.cage() + POSITION + 1] += off;
        // Balls where their pockets are.
        for ball in 0..8 {
            let mut body = layout.ball_state(&state, ball);
            let angle = std::f64::consts::TAU * ball as f64 / 8.0;
            let across = off * angle.sin();
            let along = (geometry.pitch_radius.powi(2) - across * across).sqrt();
            body.position = [
                0.0,
                along * angle.cos() + across * angle.sin(),
                along * angle.sin() - across * angle.cos(),
            ];
            layout.set_ball(&mut state, ball, &body);
        }
        let options = options(Integrator::RungeKutta, Stepping::Fixed(1e-12));
        let mut moved = Simulation::from_state(problem.clone(), options, state, 0.0).unwrap();
        match moved.step() {
            Ok(()) => assert!(!ends),
            Err(SimulationError::CageLeft { body, distance, allowed, step, .. }) => {
                assert!(ends && (distance - off).abs() <= 1e-9, "{distance}");
                assert_eq!((body.as_str(), allowed, step), ("the cage", room, 1));
            }
            Err(error) => panic!("{off}: {error}"),
        }
    }
}

/// Statics knows no cage: pushed the wrong way, all balls of an angular-contact bearing go to one side, and
/// the cage with them; balls that go to both sides leave it no place.
#[test]
fn a_cage_starts_among_the_balls_or_not_at_all() {
    let geometry = table_5_3();
    let mut problem = bearing(geometry, [-445.0, 0.0, 0.0, 0.0, 0.0], 600.0 * RPM);
    for i in 1..5 {
        problem.inner.drives[i] = Drive::Motion(Profile::ZERO);
    }
    problem.cage = Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace));
    let options = options(Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    let mut simulation = Simulation::new(problem.clone(), options).unwrap();
    let layout = simulation.system.sets[0].layout;
    let along = simulation.state[layout.cage()];
    let ball = layout.ball_vector(&simulation.state, POSITION, 0)[0];
    println!("the cage at {along:e} m, ball 1 at {ball:e} m");
    // 0.2 mm of room in a pocket.
    assert!(ball.abs() > 0.5e-3 && (along - ball).abs() <= 1e-9, "{along} {ball}");
    assert_eq!(simulation.snapshot().unwrap().energy.cage_contact, 0.0);
    // The other way it stays in the middle.
    problem.inner.drives[0] = Drive::Load(Profile::Constant(445.0));
    let simulation = Simulation::new(problem, options).unwrap();
    assert_eq!(simulation.state[layout.cage()], 0.0);
    // Tilted, with pockets that leave the balls two micrometres.
    let mut tilted = bearing(table_4_1(20e-6), [0.0; 5], 600.0 * RPM);
    for (i, at) in [0.0, 0.0, 0.0, 1f64.to_radians(), 0.0].into_iter().enumerate() {
        tilted.inner.drives[i] = Drive::Motion(Profile::Constant(at));
    }
    let mut body = cage(&tilted.geometry, Pocket::Cylindrical, Guidance::OuterRace);
    body.contacts.pocket_radius = tilted.geometry.ball_radius + 2e-6;
    tilted.cage = Some(body);
    let error = Simulation::new(tilted, options).err().unwrap();
    let SimulationError::CageInTheWay { cage, other, depth, allowed } = &error else {
        panic!("{error}")
    };
    println!("{error}");
    assert!(cage == "the cage" && other.starts_with("ball "), "{error}");
    assert!(depth > allowed && *depth < 1e-3 && *allowed > 0.0, "{error}");
}

#[test]
fn a_full_complement_runs_with_its_ledger_closed() {
    for (balls, gap) in [(13, 1e-6), (8, 0.1e-6)] {
        let geometry = full_complement(balls, gap, 5e-6);
        let mut problem = bearing(geometry, [0.0, 0.0, -200.0, 0.0, 0.0], 6000.0 * RPM);
        problem.traction = traction_laws().swap_remove(2);
        problem.gravity = GRAVITY;
        let options = options(Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
        let mut simulation = Simulation::new(problem, options).unwrap();
        let (mut met, mut deepest) = (0, 0.0f64);
        let law = ball_law(&geometry);
        while simulation.time < 10e-3 {
            simulation.step().unwrap();
            let meetings = &simulation.system.sets[0].meetings;
            met += meetings.iter().filter(|meeting| meeting.normal_load > 0.0).count();
            deepest = meetings.iter().map(|meeting| meeting.overlap).fold(deepest, f64::max);
        }
        // The extremes know the largest load, and Hertz its pressure: (6 F E*²/(π³ R²))^(1/3).
        let most = simulation.extremes[0].between_balls;
        let expected = law.stiffness * deepest * deepest.sqrt();
        assert!((most.value - expected).abs() <= 1e-12 * expected, "{} {expected}", most.value);
        assert!(most.time > 0.0 && most.time <= simulation.time && most.ball < balls);
        let (modulus, half) = (0.5 * 210e9 / (1.0 - 0.09), 0.5 * geometry.ball_radius);
        let cube =
            6.0 * most.value * modulus * modulus / (std::f64::consts::PI.powi(3) * half * half);
        let pressure = peak_pressure(&law, geometry.ball_radius, most.value);
        assert!((pressure - cube.cbrt()).abs() <= 1e-12 * pressure, "{pressure} {}", cube.cbrt());
        let snapshot = simulation.snapshot().unwrap();
        let turned: f64 = snapshot.ledger.iter().map(|entry| entry.abs()).sum();
        println!(
            "{balls} balls: {} steps, {met} meetings, deepest {deepest:e} m, residual {:e} of {turned:e} J",
            simulation.steps, snapshot.residual
        );
        assert!(met > 100);
        assert!(deepest < 0.1 * HERTZ_SCALE * geometry.ball_radius, "{deepest}");
        // Measured: 2e-7 and 2e-6; ten times that for other roundings of so many impacts.
        assert!(snapshot.residual.abs() <= 2e-5 * turned, "{} of {turned}", snapshot.residual);
    }
}

#[test]
fn the_law_is_the_gradient_of_its_energy_and_acts_on_both_alike() {
    let law = ball_law(&table_4_1(0.0));
    let radius = 5.953e-3;
    let at = |distance: f64| {
        let other = Motion {
            position: [0.3 * distance, -0.4 * distance, 0.866_025_403_784_438_6 * distance],
            ..Motion::default()
        };
        ball_contact(&law, radius, &Motion::default(), &other)
    };
    assert_eq!(at(2.0 * radius * 1.000_001), None);
    let contact = at(2.0 * radius - 3e-6).unwrap();
    assert!(
        (contact.normal_load - law.stiffness * contact.overlap.powf(1.5)).abs()
            <= 1e-12 * contact.normal_load
    );
    assert!((contact.overlap - 3e-6).abs() <= 1e-15);
    assert_eq!(contact.slip, [0.0; 3]);
    let spinning = |spin| Motion { spin, ..Motion::default() };
    let other = Motion { position: [0.0, 2.0 * radius - 3e-6, 0.0], ..spinning([200.0, 0.0, 0.0]) };
    let rolling = ball_contact(&law, radius, &spinning([200.0, 0.0, 0.0]), &other).unwrap();
    // Both surfaces run against each other: −2 ω r along Z, and the friction pushes back.
    let speed = 2.0 * 200.0 * (radius - 1.5e-6);
    assert!((rolling.slip[2] + speed).abs() <= 1e-12 * speed, "{:?}", rolling.slip);
    assert!(
        (rolling.force[2] - law.friction * rolling.normal_load).abs() <= 1e-4 * rolling.force[2]
    );
    assert!((rolling.power + rolling.force[2] * speed).abs() <= 1e-9 * -rolling.power);
}
