//! Laws of traction: spin about the contact line, sliding and rolling, slide-to-roll, frame invariance.

use super::dynamics_contacts::force_scale;

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use bearing_dynamics::members::body::Rotation;
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::state::{BodyState, Layout, SPIN, VELOCITY};
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use common::{table_4_1, table_5_3};
use dynamics::*;
use nalgebra::Vector3;

/// A preloaded bearing in its nominal position, everything at rest.
fn preloaded(law: TractionLaw) -> (DynamicProblem, Layout, Vec<f64>) {
    let mut problem = bearing(table_4_1(-10e-6), [0.0; 5], 0.0);
    problem.traction = law;
    let layout = Layout::new(8, false);
    let state = start::nominal(&problem.assembly());
    (problem, layout, state)
}

/// Moment on ball 1 about its contact line.
fn spin_moment(problem: &DynamicProblem, layout: &Layout, state: &[f64]) -> (f64, System) {
    let (system, rates) = evaluated(problem, Kernel::Simd, 0.0, state);
    let normal = Vector3::from(system.sets[0].table.contact[layout.padded].normal);
    let moment = Vector3::from(layout.ball_vector(&rates, SPIN, 0)) * problem.ball.axial;
    (moment.dot(&normal), system)
}

#[test]
fn pure_spin_of_a_ball_is_braked_by_three_eighths() {
    let law = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 1e-9 };
    let (mut problem, layout, mut state) = preloaded(law);
    let (sin, cos) = problem.ball_phase.sin_cos();
    let mut ball = layout.ball_state(&state, 0);
    ball.spin = [0.0, 40.0 * cos, 40.0 * sin];
    layout.set_ball(&mut state, 0, &ball);
    let mut errors = Vec::new();
    for slices in [15, 45, 135, 405] {
        problem.slices = slices;
        let (moment, system) = spin_moment(&problem, &layout, &state);
        let exact: f64 = [0, layout.padded]
            .map(|pair| {
                let hertz =
                    [&problem.inner_contact, &problem.outer_contact][layout.race_and_ball(pair).0];
                let load = system.sets[0].table.load[pair];
                let ellipse =
                    bearing_dynamics::ch2_housing::bearing::hertz::contact_ellipse(hertz, load);
                -3.0 * 0.07 * load * ellipse.semi_major / 8.0
            })
            .iter()
            .sum();
        assert!(exact < -0.01);
        errors.push((moment / exact - 1.0).abs());
    }
    // Slices of equal width: second order. An odd number has one slice astride the middle, where
    // the slip turns round, with an error of 1/(2n²) of 3/8 …: 5.9e-3 for fifteen.
    assert!(errors[0] <= 6e-3, "{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).ln() / 3f64.ln();
        assert!((order - 2.0).abs() <= 0.1, "{errors:?}");
    }
}

#[test]
fn slices_converge_where_the_whole_contact_slides() {
    // Rolling, sliding and spinning at once, away from the corner of pure spin.
    let (mut problem, layout, mut state) = preloaded(CONSTANT);
    let mut ball = layout.ball_state(&state, 0);
    ball.spin = [300.0, 80.0, 40.0];
    ball.velocity = [0.02, 0.1, 0.2];
    layout.set_ball(&mut state, 0, &ball);
    let mut loads = |slices: usize, across: usize| {
        problem.slices = slices;
        problem.points_across = across;
        let (_, rates) = evaluated(&problem, Kernel::Simd, 0.0, &state);
        let force = Vector3::from(layout.ball_vector(&rates, VELOCITY, 0)) * problem.ball.mass;
        let moment = Vector3::from(layout.ball_vector(&rates, SPIN, 0)) * problem.ball.axial;
        (force, moment)
    };
    let fine = loads(2001, 1);
    let errors = [15, 45, 135].map(|slices| {
        let (force, moment) = loads(slices, 1);
        (force - fine.0).norm() / fine.0.norm() + (moment - fine.1).norm() / fine.1.norm()
    });
    assert!(errors[0] <= 2e-3, "{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).ln() / 3f64.ln();
        assert!((order - 2.0).abs() <= 0.1, "{errors:?}");
    }
    // Points across: a smooth slip leaves Gauss's rule no error.
    let fine = loads(405, 40);
    let errors = [2, 3, 5].map(|across| {
        let (force, moment) = loads(405, across);
        (force - fine.0).norm() / fine.0.norm() + (moment - fine.1).norm() / fine.1.norm()
    });
    assert!(errors[0] <= 1e-5 && errors[1] <= 1e-2 * errors[0] && errors[2] <= 1e-10, "{errors:?}");
}

#[test]
fn slide_to_roll_takes_the_mean_surface_speed_through_the_contact() {
    let curve = ExponentialCurve::BOUNDARY;
    let law = TractionLaw::SlideToRoll { curve, entrainment_floor: 0.01 };
    let (mut problem, layout, _) = preloaded(law);
    let speed = 1000.0 * RPM;
    problem.inner.rotation = Rotation::Speed(Profile::Constant(speed));
    let mut state = start::nominal(&problem.assembly());
    // The ball turns in place, 1 % too fast for the outer race and against nothing else.
    let mut ball = layout.ball_state(&state, 0);
    let g = problem.geometry;
    let orbit = Vector3::from(ball.velocity).norm() / g.pitch_radius;
    let (system, _) = evaluated(&problem, Kernel::Simd, 0.0, &state);
    let overlap = system.sets[0].table.contact[layout.padded].overlap;
    let reach = g.ball_radius - 0.5 * overlap;
    let at_contact = orbit * (g.pitch_radius + reach);
    // No slip at the outer race: spin · reach equals the speed of the ball's centre.
    let rolling = -orbit * g.pitch_radius / reach;
    ball.spin = [rolling * 1.01, 0.0, 0.0];
    layout.set_ball(&mut state, 0, &ball);
    let (system, _) = evaluated(&problem, Kernel::Simd, 0.0, &state);
    let sliding = system.sets[0].table.sliding[layout.padded];
    let slip = 0.01 * rolling * reach;
    // Race and ball pass the contact at these speeds.
    let entrainment = 0.5 * (at_contact + (at_contact - slip));
    // Differences of speeds of 1 m/s.
    assert!((sliding.slip[0] - slip).abs() <= 1e-14, "{} {slip}", sliding.slip[0]);
    assert!((sliding.entrainment / entrainment - 1.0).abs() <= 1e-12);
    let s = slip.abs() / entrainment;
    let expected = (-0.1 + 22.28 * s) * (-181.46 * s).exp() + 0.1;
    let traction = system.sets[0].table.traction[layout.padded];
    let measured = Vector3::from(traction.force).norm() / system.sets[0].table.load[layout.padded];
    assert!((measured / expected - 1.0).abs() <= 1e-10, "{measured} {expected}");
    // At rest nothing is divided by zero: the floor takes over.
    let (_, layout, mut state) = preloaded(problem.traction.clone());
    problem.inner.rotation = Rotation::Speed(Profile::ZERO);
    ball.velocity = [0.0; 3];
    ball.spin = [1.0, 0.0, 0.0];
    layout.set_ball(&mut state, 0, &ball);
    let (system, rates) = evaluated(&problem, Kernel::Simd, 0.0, &state);
    assert!(rates.iter().all(|rate| rate.is_finite()));
    let sliding = system.sets[0].table.sliding[layout.padded];
    assert!((sliding.slip[0].abs() - reach).abs() <= 1e-15 && sliding.entrainment > 0.002);
}

#[test]
fn turning_the_whole_bearing_about_its_axis_changes_no_traction() {
    // Slip and entrainment are relative to the surfaces and to the travelling contact.
    let law =
        TractionLaw::SlideToRoll { curve: ExponentialCurve::BOUNDARY, entrainment_floor: 0.01 };
    for seed in 0..20 {
        let mut problem = bearing(table_5_3(), [0.0; 5], 0.0);
        problem.inner = free_race();
        problem.outer = Some(free_race());
        problem.traction = law.clone();
        let layout = Layout::new(11, false);
        let mut state = random_state(&problem, seed);
        // Parallel axes: the contact's travel is measured about each race's own.
        for at in [layout.inner(), layout.outer()] {
            state[at + QUATERNION..at + QUATERNION + 4].copy_from_slice(&[1.0, 0.0, 0.0, 0.0]);
        }
        let mut turning = state.clone();
        for (_, at) in bodies(&problem) {
            let mut body = BodyState::from_slice(&entries(&state, at));
            let orbit = Vector3::x().cross(&Vector3::from(body.position)) * 100.0;
            for i in 0..3 {
                body.velocity[i] += orbit[i];
            }
            body.spin[0] += 100.0;
            match at {
                BodyAt::Ball(layout, ball) => layout.set_ball(&mut turning, ball, &body),
                BodyAt::At(at) => turning[at..at + 13].copy_from_slice(&body.to_array()),
            }
        }
        let (still, _) = evaluated(&problem, Kernel::Simd, 0.0, &state);
        let (orbiting, _) = evaluated(&problem, Kernel::Simd, 0.0, &turning);
        assert!(!still.sets[0].table.active.is_empty());
        assert_eq!(still.sets[0].table.active, orbiting.sets[0].table.active);
        for &pair in &still.sets[0].table.active {
            let [a, b] = [&still, &orbiting]
                .map(|system| Vector3::from(system.sets[0].table.traction[pair].force));
            let load = still.sets[0].table.load[pair];
            // Speeds of 3 m/s are added and taken away again: 5e-16 of slips of 1 m/s, times the
            // slope of the friction curve (40 over the entrainment of a few tenths of a m/s).
            assert!((a - b).norm() <= 1e-12 * load, "{a} {b}");
        }
    }
}

#[test]
fn without_traction_no_ball_spin_changes() {
    for seed in 0..20 {
        let problem = bearing(table_5_3(), [0.0; 5], 0.0);
        let layout = Layout::new(11, false);
        let state = random_state(&problem, seed);
        let (system, rates) = evaluated(&problem, Kernel::Simd, 0.0, &state);
        assert!(!system.sets[0].table.active.is_empty());
        for ball in 0..layout.balls {
            let moment = Vector3::from(layout.ball_vector(&rates, SPIN, ball)) * problem.ball.axial;
            // Rounding of arm × (−load · normal).
            assert!(moment.norm() <= 1e-15 * force_scale(&system) * problem.geometry.ball_radius);
        }
    }
}
