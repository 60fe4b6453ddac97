//! States in which a run must end or never starts: a race or a cage that has left its bearing, parts inside
//! each other, a bearing that nothing holds.

use super::dynamics_balls::options;
use crate::{common, dynamics};
use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::members::bearing::{HERTZ_SCALE, cage_room, gap_in_pockets};
use bearing_dynamics::members::body::{Drive, FARTHEST};
use bearing_dynamics::members::state::{BodyState, Layout, POSITION};
use bearing_dynamics::motion::simulation::{
    Integrator, RunOptions, Simulation, SimulationError, Start, Stepping,
};
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::validity::race_limit;
use bearing_dynamics::numeric::profile::Profile;
use common::{table_4_1, table_5_3};
use dynamics::*;
use nalgebra::{UnitQuaternion, Vector3};

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

/// A race that lies askew has left its bearing where its pitch circle is out along the axis, wherever its centre is.
#[test]
fn a_race_that_tilts_out_of_its_bearing_ends_the_run() {
    let problem = bearing(table_4_1(5e-6), [0.0; 5], 0.0);
    let (pitch, tilt) = (problem.geometry.pitch_radius, 0.4f64);
    let layout = Layout::new(8, false);
    let mut state = start::nominal(&problem.assembly());
    let mut body = BodyState::from_slice(&state[layout.inner()..]);
    body.orientation = UnitQuaternion::from_scaled_axis(tilt * Vector3::y());
    state[layout.inner()..layout.inner() + 13].copy_from_slice(&body.to_array());
    let options = options(Integrator::RungeKutta, Stepping::Fixed(1e-12));
    let mut simulation = Simulation::from_state(problem.clone(), options, state, 0.0).unwrap();
    let error = simulation.step().unwrap_err();
    let SimulationError::RaceLeft { way, distance, allowed, .. } = error else { panic!("{error}") };
    assert_eq!((way, allowed), ("along its axis", race_limit(&problem.geometry)));
    // A step of 1e-12 s moves nothing.
    assert!((distance - pitch * tilt.sin()).abs() <= 1e-12, "{distance}");
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
    assert!(text.contains("too large: z of the inner race by -0.0015 m"), "{text}");
}

/// A load that comes later, on races that nothing holds.
#[test]
fn a_bearing_that_nothing_holds_ends_where_it_flies_to() {
    let mut problem = bearing(table_4_1(10e-6), [0.0; 5], 0.0);
    problem.outer = Some(free_race());
    let ramp = |to: f64| Profile::Ramp { from: 0.0, to, start: 0.0, duration: 1e-3 };
    problem.inner.drives[2] = Drive::Load(ramp(1000.0));
    let options = options(Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    let begun = |problem: &DynamicProblem, start: Start| {
        Simulation::new(problem.clone(), RunOptions { start, ..options })
    };
    for start in [Start::Nominal, Start::Equilibrium] {
        let mut flying = begun(&problem, start).unwrap();
        let error = loop {
            match flying.step() {
                Ok(()) => assert!(flying.time < 0.1),
                Err(error) => break error,
            }
        };
        let is_clear = matches!(
            error,
            SimulationError::FlownOff { coordinate: "z", .. } | SimulationError::RaceLeft { .. }
        );
        assert!(is_clear, "{error}");
    }
    // Both races a metre off together.
    for (off, ends) in [(0.999 * FARTHEST, false), (1.001 * FARTHEST, true)] {
        let state = both_off(&problem, off);
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
    // What is given takes a bearing along, as far as it has come by then.
    let (far, late) = (1.5 * FARTHEST, 3.0);
    let mut carried = problem.clone();
    carried.inner.drives[1] =
        Drive::Motion(Profile::Ramp { from: 0.0, to: far, start: 0.0, duration: 2.0 });
    let state = both_off(&carried, far);
    Simulation::from_state(carried, options, state, late).unwrap().step().unwrap();
}

/// The nominal state, moved along Y with both races and all balls.
fn both_off(problem: &DynamicProblem, off: f64) -> Vec<f64> {
    let layout = Layout::new(8, false);
    let mut state = start::nominal(&problem.assembly());
    for ball in 0..8 {
        let mut body = layout.ball_state(&state, ball);
        body.position[1] += off;
        layout.set_ball(&mut state, ball, &body);
    }
    state[layout.inner() + POSITION + 1] += off;
    state[layout.outer() + POSITION + 1] += off;
    state
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
    assert_eq!(simulation.snapshot().energy.cage_contact, 0.0);
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
