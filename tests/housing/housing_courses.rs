//! Quasi-static courses of a bearing and its housing, and what their inertia would come to.

use super::housing_assembly::{fit, loads, search, solve};
use crate::housing_common;

use bearing_dynamics::ch2_housing::bearing::inertia::{Inertia, hollow_cylinder};
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::solver::dynamics::model::RotatingLoad;
use bearing_dynamics::solver::housing::bore_equilibrium::{BoreError, Fit};
use bearing_dynamics::solver::housing::course_inertia::{
    CourseInertia, CourseLooks, SeatLooks, course_inertia,
};
use bearing_dynamics::solver::housing::housed::{HousedSearch, HousedState, OUTER, lists, moving};
use bearing_dynamics::solver::housing::inertia::{
    InertiaEstimate, Mode, estimate, housing_mass, modes,
};
use bearing_dynamics::solver::housing::quasi_static::{Course, history};
use bearing_dynamics::solver::housing::true_distances::solve_with_true_distances;
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::statics::{Condition, StaticsError};
use housing_common::*;
use std::cell::Cell;
use std::f64::consts::{FRAC_PI_4, TAU};

fn one_turn(points: usize) -> Course {
    let speed = 50.0 / 60.0 * TAU;
    Course {
        times: (0..=points).map(|i| 1.2 * i as f64 / points as f64).collect(),
        conditions: [0; 5].map(|_| Profile::ZERO),
        rotating_load: Some(RotatingLoad {
            force: Profile::Constant(250.0),
            speed: Profile::Constant(speed),
            phase: 0.0,
        }),
        shaft_speed: Profile::ZERO,
        interference: Profile::ZERO,
        weight: [0.0; 3],
        centrifugal: false,
    }
}

/// In a ring, under a load that goes round, the eight balls meet it alike in every eighth of a turn.
#[test]
fn a_turning_load_in_a_ring() {
    let bore = condensed(&RING, &COARSE, Order::Quadratic, YOUNG);
    let problem = bearing(loads([0.0; 5]));
    let fit = fit(0.0);
    let moments = history(&mut search(&bore), &problem, &fit, &one_turn(8)).unwrap();
    let radii: Vec<f64> =
        moments.iter().map(|m| m.state.bore.pose[0].hypot(m.state.bore.pose[1])).collect();
    for (i, (moment, radius)) in moments.iter().zip(&radii).enumerate() {
        assert!(moment.state.residual <= 1e-9);
        // What the mesh's own lack of symmetry leaves.
        assert!((radius / radii[0] - 1.0).abs() <= 5e-3, "{radii:?}");
        let direction = libm::atan2(moment.state.bore.pose[1], moment.state.bore.pose[0]);
        let off = (direction - FRAC_PI_4 * i as f64).rem_euclid(TAU);
        assert!(off.min(TAU - off) <= 5e-3, "{i}: {off}");
    }
    assert!((radii[8] / radii[0] - 1.0).abs() <= 1e-7, "{radii:?}");
}

/// In steel the path does not know how fast it is gone, and an interference grown in stays.
#[test]
fn rate_and_history_do_not_matter() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let problem = bearing(loads([0.0; 5]));
    let fit = fit(0.0);
    let paths = [0.01, 0.1, 1.0].map(|duration| {
        let mut course = one_turn(1);
        course.rotating_load = None;
        let ramp = |from, to, start: f64, length: f64| Profile::Ramp {
            from,
            to,
            start: start * duration,
            duration: length * duration,
        };
        course.interference = ramp(0.0, 1e-6, 0.0, 0.2);
        course.conditions[2] = ramp(0.0, -250.0, 0.2, 0.8);
        course.times = (0..=5).map(|i| 0.2 * f64::from(i) * duration).collect();
        let moments = history(&mut search(&bore), &problem, &fit, &course).unwrap();
        moments.iter().map(|moment| moment.state.bore.pose[1]).collect::<Vec<f64>>()
    });
    let last = paths[0][5];
    for path in &paths[1..] {
        for (one, other) in path.iter().zip(&paths[0]) {
            assert!((one - other).abs() <= 1e-9 * last.abs(), "{paths:?}");
        }
    }
    let grown = Fit { radius: fit.radius + 1e-6, ..fit };
    let mut pushed = problem.clone();
    pushed.conditions[2] = Condition::Load(-250.0);
    let at_once = solve(&bore, &grown, &pushed);
    assert!((at_once.bore.pose[1] / last - 1.0).abs() <= 1e-8);
}

#[test]
fn balls_roll_with_the_cage() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let problem = bearing(loads([0.0; 5]));
    let fit = fit(0.0);
    let mut course = one_turn(2);
    course.shaft_speed = Profile::Constant(10.0);
    course.centrifugal = true;
    let moments = history(&mut search(&bore), &problem, &fit, &course).unwrap();
    let gamma = problem.geometry.ball_radius / problem.geometry.pitch_radius;
    for moment in &moments {
        let should = 0.5 * (1.0 - gamma) * 10.0 * moment.time;
        assert!((moment.ball_phase - should).abs() <= 1e-12);
    }
    let sums = moments[0]
        .state
        .bearing
        .balls
        .iter()
        .map(|ball| (ball.outer.normal_load, ball.inner.normal_load));
    assert!(sums.clone().all(|(outer, inner)| outer > inner), "{sums:?}");
}

/// With both races of these masses, the inner one free.
fn estimate_of(search: &HousedSearch, state: &HousedState, races: [Inertia; 2]) -> InertiaEstimate {
    let housing = housing_mass(search.bore(), OUTER);
    estimate(&state.stiffness, &moving(races, [true; 5]), &[housing])
}

/// Heavy bodies swing slowly: on one spring with the square root of stiffness over mass. The housing
/// is soft, so that the slowest swing is that of both races in it.
#[test]
fn inertia_of_races_that_outweigh_the_housing() {
    let bore = condensed(&RING, &COARSE, Order::Linear, 1e-4 * YOUNG);
    let problem = bearing(loads([0.0, 0.0, -2.5, 0.0, 0.0]));
    let fit = fit(5e-6);
    let mut search = search(&bore);
    let state = search.solve(&problem, &fit, [0.0; 3]).unwrap();
    let steel = hollow_cylinder(32e-3, 35.5e-3, 20e-3, 7850.0);
    let of = |factor: f64| {
        let mut inner = steel;
        inner.mass *= factor;
        inner.transverse *= factor;
        estimate_of(&search, &state, [inner, steel])
    };
    let (one, hundred) = (of(1.0), of(1e4));
    assert!(one.lowest > 50.0 && one.lowest < 1e4, "{one:?}");
    assert!(one.housing_share > 0.0, "{one:?}");
    // The inner race on bearing and housing in series, a matrix of its own.
    let k = state.bearing.stiffness;
    let mut soft = k.try_inverse().unwrap();
    let give = state.bore.stiffness.try_inverse().unwrap();
    for i in 0..4 {
        for j in 0..4 {
            soft[(1 + i, 1 + j)] += give[(i, j)];
        }
    }
    let masses = [1.0, 1.0, 1.0, 0.0, 0.0].map(|m: f64| m * 1e4 * steel.mass);
    let turning = 1e4 * steel.transverse;
    let root = nalgebra::Vector5::from_fn(|i, _| if i < 3 { masses[i] } else { turning }.sqrt());
    let swings = nalgebra::Matrix5::from_fn(|i, j| root[i] * soft[(i, j)] * root[j]);
    let slowest = swings.symmetric_eigenvalues().max();
    let should = 1.0 / slowest.sqrt() / TAU;
    assert!((hundred.lowest / should - 1.0).abs() <= 1e-3, "{} {should}", hundred.lowest);
    let half = hundred.error_at(0.5 * hundred.lowest);
    assert!((half - 0.25).abs() <= 1e-12);
}

/// A load that goes round in a soft ring which never lets go: a circle, slow against its natural motion.
fn circle(turn: f64, damping: f64, corners: Vec<f64>) -> CourseInertia {
    let bore = condensed(&RING, &COARSE, Order::Linear, 1e-2 * YOUNG);
    let fit = fit(5e-6);
    let steel = hollow_cylinder(32e-3, 35.5e-3, 20e-3, 7850.0);
    let bodies = moving([steel; 2], [false, true, true, true, true]);
    let seats = vec![SeatLooks { race: OUTER, natural: Vec::new(), damping }];
    let looks = CourseLooks { start: 0.0, end: turn, count: 360, corners, bodies, seats };
    let found = course_inertia(&looks, &mut search(&bore).search, |search, time| {
        let angle = TAU * time / turn;
        let problem = bearing(loads([0.0, 2.5 * angle.cos(), 2.5 * angle.sin(), 0.0, 0.0]));
        search.solve(&lists(&problem, &bore, Penalty::default(), &fit, [0.0; 3]))
    });
    found.unwrap()[OUTER]
}

#[test]
fn inertia_along_a_circle_is_that_of_one_mass_on_a_spring() {
    let (slow, fast) = (circle(0.2, 0.0, Vec::new()), circle(0.1, 0.0, Vec::new()));
    for (found, turn) in [(&slow, 0.2), (&fast, 0.1)] {
        let ratio = 1.0 / (turn * found.frequency);
        assert!(ratio < 0.1 && found.kinks == 0, "{found:?}");
        // The other natural motions take some of it, and a period is not nothing of a turn.
        let steady = found.steady / (ratio * ratio * found.swing);
        assert!((0.8..=1.3).contains(&steady), "{steady} {found:?}");
        // Sizes are added: of two equal modes across up to √2, and of the races against each other.
        let start = found.start / (ratio * found.swing);
        assert!((0.9..=2.1).contains(&start), "{start} {found:?}");
        assert_eq!(found.ringing, found.start);
        let bound = found.start + 2.0 * found.steady;
        assert!((found.bound / bound - 1.0).abs() <= 1e-12, "{found:?}");
    }
    // First and second power of the speed.
    assert!((fast.start / slow.start - 2.0).abs() <= 1e-3, "{slow:?} {fast:?}");
    assert!((fast.steady / slow.steady - 4.0).abs() <= 0.2, "{slow:?} {fast:?}");
    // A corner of the load is a kink, though nothing jumps at this one but by what an interval turns.
    let cornered = circle(0.1, 0.0, vec![0.05]);
    assert_eq!(cornered.kinks, 1);
    assert!(cornered.largest_kink > 0.0 && cornered.largest_kink < 0.1 * fast.start);
    // Damping takes the start's ringing before the corner adds to it.
    let damped = circle(0.1, 1e4, vec![0.05]);
    assert!(damped.bound < cornered.bound, "{damped:?}");
    // So little that start and corner together are the most. Mass-proportional, of the housing's part p of what rings: by
    // half of α p, as a swing on a dashpot.
    let damping = 0.2;
    let gently = circle(0.1, damping, vec![0.05]);
    let left = (gently.bound - 2.0 * gently.steady - gently.largest_kink) / gently.start;
    let bore = condensed(&RING, &COARSE, Order::Linear, 1e-2 * YOUNG);
    let mut search = search(&bore);
    let problem = bearing(loads([0.0, 2.5, 0.0, 0.0, 0.0]));
    let state = search.solve(&problem, &fit(5e-6), [0.0; 3]).unwrap();
    let steel = hollow_cylinder(32e-3, 35.5e-3, 20e-3, 7850.0);
    let bodies = moving([steel; 2], [false, true, true, true, true]);
    let found = modes(&state.stiffness, &bodies, &[housing_mass(search.bore(), OUTER)]);
    let off = |mode: &Mode| (mode.square.sqrt() / TAU / gently.frequency - 1.0).abs();
    let rings = found.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
    assert!(off(rings) <= 1e-6 && rings.housings[0] > 0.0, "{rings:?} {gently:?}");
    let decay = -left.ln() / 0.05;
    let should = 0.5 * damping * rings.housings[0];
    // Of a part in a thousand that is left out of 1, to rounding of 1e-13.
    assert!((decay / should - 1.0).abs() <= 1e-6, "{decay} {should}");
}

/// Balls are where the shaft has rolled them, not where its present speed would have: a shaft that runs up has turned
/// by half of that.
#[test]
fn balls_roll_with_a_shaft_that_runs_up() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let problem = bearing(loads([0.0; 5]));
    let mut course = one_turn(3);
    course.shaft_speed = Profile::Ramp { from: 0.0, to: 12.0, start: 0.0, duration: 1.2 };
    let moments = history(&mut search(&bore), &problem, &fit(0.0), &course).unwrap();
    let gamma = problem.geometry.ball_radius / problem.geometry.pitch_radius;
    for moment in &moments {
        let should = problem.ball_phase + 0.5 * (1.0 - gamma) * 5.0 * moment.time * moment.time;
        // Rounding.
        assert!((moment.ball_phase - should).abs() <= 1e-12, "{} {should}", moment.ball_phase);
    }
}

/// The estimate's coordinates are places and tilts: what a race has about its own axis takes no part. A race hard to tilt
/// swings slowly about either axis across.
#[test]
fn inertia_about_the_axis_is_no_inertia_of_tilts() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let problem = bearing(loads([0.0, 0.0, -2.5, 0.0, 0.0]));
    let mut search = search(&bore);
    let state = search.solve(&problem, &fit(5e-6), [0.0; 3]).unwrap();
    let steel = hollow_cylinder(32e-3, 35.5e-3, 20e-3, 7850.0);
    let of = |axial: f64, transverse: f64| {
        let mut outer = steel;
        outer.axial *= axial;
        outer.transverse *= transverse;
        estimate_of(&search, &state, [steel, outer])
    };
    assert_eq!(of(1e6, 1.0), of(1.0, 1.0));
    // So heavy that it tilts by itself: a quarter of the frequency for sixteen times the inertia.
    let ratio = of(1.0, 1e6).lowest / of(1.0, 16e6).lowest;
    assert!((ratio - 4.0).abs() <= 1e-3, "{ratio}");
}

/// Distances that do not stay from round to round are no equilibrium to start from.
#[test]
fn distances_that_do_not_settle_are_an_error() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let problem = bearing(loads([0.0, 0.0, -2.5, 0.0, 0.0]));
    let still = lists(&problem, &bore, Penalty::default(), &fit(5e-6), [0.0; 3]);
    let round = Cell::new(0);
    let ended = solve_with_true_distances(&still, |_, state| {
        round.set(round.get() + 1);
        vec![1e-9 * f64::from(round.get() % 2); state.loads.len()]
    });
    let Err(StaticsError::Seat { source, .. }) = ended else { panic!("{ended:?}") };
    assert_eq!(source, BoreError::FarAcross { rounds: round.get() as usize });
    assert!(solve_with_true_distances(&still, |_, state| vec![0.0; state.loads.len()]).is_ok());
}
