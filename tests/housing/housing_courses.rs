//! Quasi-static courses of a bearing and its housing, and their lowest natural frequency.

use super::housing_assembly::{fit, loads, search, solve};
use crate::housed::{
    HousedSearch, HousedState, OUTER, QuasiStaticSequence, history, lists, moving,
};
use crate::housing_common;

use bearing_dynamics::ch2_housing::bearing::inertia::{Inertia, hollow_cylinder};
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::equilibrium::exact_gap_iteration::solve_with_true_distances;
use bearing_dynamics::equilibrium::quasi_static_limit::{housing_mass, lowest_frequency};
use bearing_dynamics::equilibrium::statics::StaticsError;
use bearing_dynamics::members::body::{Condition, RotatingLoad};
use bearing_dynamics::mesh::Order;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::bore_equilibrium::{BoreError, Fit};
use housing_common::*;
use std::cell::Cell;
use std::f64::consts::{FRAC_PI_4, TAU};

fn one_turn(points: usize) -> QuasiStaticSequence {
    let speed = 50.0 / 60.0 * TAU;
    QuasiStaticSequence {
        times: (0..=points).map(|i| 1.2 * i as f64 / points as f64).collect(),
        conditions: [0; 5].map(|_| Profile::ZERO),
        rotating_load: Some(RotatingLoad {
            force: Profile::Constant(250.0),
            speed: Profile::Constant(speed),
            phase: 0.0,
        }),
        shaft_speed: Profile::ZERO,
        interference: Profile::ZERO,
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

/// With both races of these masses, the inner one free.
fn lowest(search: &HousedSearch, young: f64, state: &HousedState, races: [Inertia; 2]) -> f64 {
    let model = model_of(&mesh_of(&RING, &COARSE, Order::Linear), young);
    let housing = housing_mass(search.bore(), &model, OUTER);
    lowest_frequency(&state.stiffness, &moving(races, [true; 5]), &[housing]).unwrap()
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
        lowest(&search, 1e-4 * YOUNG, &state, [inner, steel])
    };
    let (one, hundred) = (of(1.0), of(1e4));
    let bodies = moving([steel; 2], [true; 5]);
    let massless = lowest_frequency(&state.stiffness, &bodies, &[]).unwrap();
    assert!(one > 50.0 && one < massless && massless < 1e4, "{one} {massless}");
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
    assert!((hundred / should - 1.0).abs() <= 1e-3, "{hundred} {should}");
}

/// The coordinates are places and tilts: what a race has about its own axis takes no part. A race hard to tilt
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
        lowest(&search, YOUNG, &state, [steel, outer])
    };
    assert_eq!(of(1e6, 1.0), of(1.0, 1.0));
    // So heavy that it tilts by itself: a quarter of the frequency for sixteen times the inertia.
    let ratio = of(1.0, 1e6) / of(1.0, 16e6);
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
