//! The matrix of a linearly implicit step against central differences of the equations of motion:
//! (1 − s J) w = r is solved with the matrix, and w put into the equation with differences for J.
//!
//! Tolerances come from what the matrix leaves out on purpose (see the documentation of
//! `linearised`). The largest part is how the direction of the normal force turns with the ball:
//! load over room in the groove, against the stiffness a part δ/(1.5 · room). Bearings here are
//! loaded so lightly that δ is some 1 µm of a room of 360 µm: 2e-3.
#![allow(clippy::needless_range_loop)] // indices are the notation of components

use crate::{common, dynamics};
mod entries;
mod point;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::kinematics::vec3::{Vec3, add, cross, dot, scale};
use bearing_dynamics::members::body::{Drive, Rotation};
use bearing_dynamics::members::contacts::{Kernel, Want};
use bearing_dynamics::members::state::{BodyState, Layout, ORIENTATION, POSITION, SPIN, VELOCITY};
use bearing_dynamics::motion::block_arrow::BlockArrowMatrix;
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use common::table_5_3;
use dynamics::*;
use nalgebra::{UnitQuaternion, Vector3};
use point::*;

/// rad/s; where gyroscopic moments, which the matrix leaves out, should not be in the way.
const SLOW: f64 = 10.0 * RPM;
const FAST: f64 = 1000.0 * RPM;

/// Light loads on the angular-contact bearing: all balls loaded, by some 10 N.
fn light(speed: f64) -> DynamicProblem {
    bearing(table_5_3(), [AXIAL, 5.0, -20.0, 0.0, 0.0], speed)
}

/// N, in the sense that closes the bearing.
const AXIAL: f64 = 100.0;

/// The start, off the steady motion by velocities up to `shake` (m/s), so that contacts slide and
/// close.
fn shaken(problem: &DynamicProblem, shake: f64, noise: &mut Noise) -> Vec<f64> {
    let layout = Layout::new(problem.geometry.ball_count, problem.cage.is_some());
    let mut state = start::at_equilibrium(&problem.assembly()).unwrap();
    let radius = problem.geometry.ball_radius;
    for ball in 0..layout.balls {
        let (fast, spin) = (noise.vector(shake), noise.vector(shake / radius));
        for i in 0..3 {
            state[layout.ball(VELOCITY + i) + ball] += fast[i];
            state[layout.ball(SPIN + i) + ball] += spin[i];
        }
    }
    state
}

/// Of a race that turns as fast as at the start, freely.
fn point(problem: &DynamicProblem, shake: f64, seed: u64) -> (Point, Noise) {
    let mut noise = Noise(seed);
    let state = shaken(problem, shake, &mut noise);
    let mut problem = problem.clone();
    problem.inner.rotation = Rotation::Torque(Profile::ZERO);
    (linearised(&problem, state), noise)
}

#[test]
fn springs_and_dashpots_are_those_of_the_contacts() {
    for damping in [ContactDamping::None, ContactDamping::HuntCrossley { alpha: 0.2 }] {
        let problem = DynamicProblem { damping, ..light(SLOW) };
        for (seed, scale) in [(1, 1e-6), (2, 1e-5)] {
            for (kind, push) in [("velocities", VELOCITIES), ("displacements", DISPLACEMENTS)] {
                let (mut point, mut noise) = point(&problem, 1e-3, seed);
                let r = point.push(push, &mut noise);
                let left = point.left_over(scale, &r);
                left.check(
                    &format!("{damping:?} {scale} {kind}"),
                    // Forces across and moments are sums in which the large parts cancel.
                    &[(Part::Normal, 1e-4), (Part::Force(0), 1e-2), (Part::Tilt(0), 2e-2)],
                );
            }
        }
    }
}

/// Foundation of the outer race as stiff and damped as the bearing.
fn founded(speed: f64) -> DynamicProblem {
    let mut problem = light(speed);
    let mut outer = free_race();
    outer.foundation_stiffness = [3e7, 5e7, 4e7, 3e4, 2e4];
    outer.foundation_damping = [3e3, 5e3, 4e3, 3.0, 2.0];
    problem.outer = Some(outer);
    problem
}

#[test]
fn a_moving_outer_race_stands_on_its_foundation() {
    let problem = founded(SLOW);
    for (seed, scale) in [(1, 1e-6), (2, 1e-5)] {
        for (kind, push) in [("velocities", VELOCITIES), ("displacements", DISPLACEMENTS)] {
            let (mut point, mut noise) = point(&problem, 1e-3, seed);
            let r = point.push(push, &mut noise);
            let left = point.left_over(scale, &r);
            let hubs = [Part::Force(0), Part::Force(1), Part::Tilt(0), Part::Tilt(1)];
            left.check(&format!("{scale} {kind}"), &hubs.map(|part| (part, 2e-2)));
        }
    }
}

#[test]
fn slopes_of_traction_are_those_of_the_contacts() {
    let laws = [CONSTANT, traction_laws().swap_remove(3), traction_laws().swap_remove(2)];
    for (index, traction) in laws.into_iter().enumerate() {
        for (seed, scale) in [(1, 1e-8), (2, 1e-7)] {
            let problem = DynamicProblem { traction: traction.clone(), ..founded(FAST) };
            let (mut point, mut noise) = point(&problem, 1e-3, seed);
            let r = point.push(VELOCITIES, &mut noise);
            let left = point.left_over(scale, &r);
            // Sums over the race are small beside their parts. How traction follows the entrainment
            // speed is left out: a part of slip over rolling speed.
            let entrainment = matches!(problem.traction, TractionLaw::SlideToRoll { .. });
            let (ball, sum) = if entrainment { (5e-2, 5e-1) } else { (5e-3, 5e-2) };
            let balls = [Part::BallSpin, Part::Rolling, Part::Transverse];
            let sums = [Part::Torque(0), Part::Torque(1)];
            let limits = balls.map(|part| (part, ball)).into_iter();
            let limits: Vec<_> = limits.chain(sums.map(|part| (part, sum))).collect();
            left.check(&format!("{index} {scale}"), &limits);
        }
    }
}

/// The race of a shaft whose centre is 70 mm away along its axis: levers count from there.
#[test]
fn a_race_away_from_the_centre_of_its_shaft_has_levers_about_it() {
    const ALONG: f64 = 70e-3;
    let limits = [
        (Part::Normal, 1e-4),
        (Part::Force(0), 1e-2),
        (Part::Tilt(0), 1e-2),
        (Part::Rolling, 2e-3),
        (Part::Transverse, 2e-3),
    ];
    for (kind, push, traction, scale, limits) in [
        ("displacements", DISPLACEMENTS, TractionLaw::None, 1e-6, &limits[..3]),
        ("velocities", VELOCITIES, CONSTANT, 1e-8, &limits[..]),
    ] {
        let mut noise = Noise(1);
        let mut problem = DynamicProblem { traction, ..light(SLOW) };
        problem.damping = ContactDamping::HuntCrossley { alpha: 0.2 };
        let mut state = shaken(&problem, 1e-3, &mut noise);
        problem.inner.rotation = Rotation::Torque(Profile::ZERO);
        let mut assembly = problem.assembly();
        assembly.bearings[0].mounts[0].along = ALONG;
        let at = Layout::new(problem.geometry.ball_count, false).inner();
        let mut body = BodyState::from_slice(&state[at..at + 13]);
        let back = body.axis().map(|part| -ALONG * part);
        body.position = add(body.position, back);
        body.velocity = add(body.velocity, cross(body.spin, back));
        state[at..at + 13].copy_from_slice(&body.to_array());
        let mut point = linearised(assembly, state);
        let r = point.push(push, &mut noise);
        point.left_over(scale, &r).check(kind, limits);
    }
}

#[test]
fn traction_follows_load_and_the_way_of_the_contact_point() {
    let steep = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 1e-3 };
    let way = Push { tangential: true, ..DISPLACEMENTS };
    // Left out: how slip changes as races tilt and, where traction hardly changes with the load, how
    // the direction of the force turns. That is as large as the rest across the rolling direction,
    // which is not judged where balls move in their grooves; it makes no moment on balls.
    let load_limits = vec![(Part::BallSpin, 5e-2), (Part::Rolling, 5e-2), (Part::Torque(0), 5e-2)];
    let way_limits = vec![
        (Part::Rolling, 5e-2),
        (Part::Torque(0), 5e-2),
        (Part::Torque(1), 5e-2),
        (Part::BallSpin, 2e-1),
    ];
    for (name, traction, push, shake, limits) in [
        ("load", CONSTANT, DISPLACEMENTS, 1e-2, load_limits),
        ("way", steep, way, 1e-5, way_limits),
    ] {
        let problem = DynamicProblem { traction, ..founded(FAST) };
        for (seed, scale) in [(1, 1e-9), (2, 1e-8)] {
            let (mut point, mut noise) = point(&problem, shake, seed);
            let r = point.push(push, &mut noise);
            let left = point.left_over(scale, &r);
            left.check(&format!("{name} {scale}"), &limits);
        }
    }
}

#[test]
fn all_moved_alike_nothing_changes() {
    let mut problem = DynamicProblem { traction: CONSTANT, ..founded(FAST) };
    let state = shaken(&problem, 1e-2, &mut Noise(5));
    // Nothing to the ground.
    problem.outer = Some(free_race());
    let point = linearised(&problem, state);
    let layout = point.system.sets[0].layout;
    let by = [0.3, -0.5, 0.8];
    let mut r = vec![0.0; layout.len()];
    for i in 0..3 {
        r[layout.ball(POSITION + i)..][..layout.balls].fill(by[i]);
        r[layout.inner() + POSITION + i] = by[i];
        r[layout.outer() + POSITION + i] = by[i];
    }
    let mut arrow = BlockArrowMatrix::new(&point.system, &point.linearised);
    arrow.factor(&point.linearised, 1e-6);
    let mut w = vec![0.0; layout.len()];
    let drift = vec![0.0; layout.len()];
    arrow.solve(&point.linearised, &point.system.sets, &point.state, &drift, &r, &mut w);
    // Normals are unit vectors to 1e-16, and accelerations of a ball that moves alone s k/m = 1e4.
    for (w, r) in w.iter().zip(&r) {
        assert!((w - r).abs() <= 1e-8, "{w} {r}");
    }
}

#[test]
fn drives_of_given_motions_do_the_work_of_the_contacts() {
    let mut problem = bearing(table_5_3(), [AXIAL, 0.0, 0.0, 0.0, 0.0], 1000.0 * RPM);
    problem.traction = CONSTANT;
    let layout = Layout::new(problem.geometry.ball_count, false);
    let state = start::at_equilibrium(&problem.assembly()).unwrap();
    // The same place, now given together with a velocity; nothing else is driven by a load.
    for i in 0..3 {
        let (from, rate) = (state[layout.inner() + POSITION + i], [1e-3, -2e-3, 3e-3][i]);
        problem.inner.drives[i] =
            Drive::Motion(Profile::Table { points: vec![[-1.0, from - rate], [1.0, from + rate]] });
    }
    for (kind, push) in [("velocities", VELOCITIES), ("displacements", DISPLACEMENTS)] {
        for scale in [1e-8, 1e-6] {
            let mut point = linearised(&problem, state.clone());
            let mut noise = Noise(3);
            let r = point.push(push, &mut noise);
            let left = point.left_over(scale, &r);
            // Velocities at 1e-6 s, where slides have turned: 4e-3; displacements tilt the race too.
            let limit = if kind == "velocities" { 1e-2 } else { 4e-2 };
            left.check(&format!("{kind} {scale}"), &[(Part::Drives, limit)]);
        }
    }
}

/// The cage against its guiding race and the ball nearest to a pocket's wall, 1 µm deep.
fn caged(
    pocket: Pocket,
    guidance: Guidance,
    friction: f64,
    speed: f64,
) -> (DynamicProblem, Vec<f64>) {
    let mut problem = founded(speed);
    problem.cage = Some(cage(&problem.geometry, pocket, guidance));
    let contacts = &mut problem.cage.as_mut().unwrap().contacts;
    contacts.friction = friction;
    contacts.regularisation_speed = 1.0;
    let gap = contacts.race_clearance;
    let layout = Layout::new(problem.geometry.ball_count, true);
    let mut state = start::at_equilibrium(&problem.assembly()).unwrap();
    let guiding = if guidance == Guidance::InnerRace { layout.inner() } else { layout.outer() };
    let race = BodyState::from_slice(&state[guiding..]);
    let at = layout.cage();
    for (i, away) in [0.0, 0.6, 0.8].into_iter().enumerate() {
        state[at + i] = race.position[i] + away * (gap + 1e-6);
    }
    // A turn of the cage takes all pockets along: until one is as deep in its ball.
    let pitch = problem.geometry.pitch_radius;
    let mut turn = 0.0;
    let mut rates = vec![0.0; layout.len()];
    for _ in 0..5 {
        let mut system = System::new(problem.clone(), Kernel::Simd);
        system.evaluate(0.0, &state, &mut rates);
        let deepest =
            system.sets[0].pockets.iter().map(|pocket| pocket.penetration).fold(-1.0, f64::max);
        turn += (1e-6 - deepest) / pitch;
        let q = race.orientation * UnitQuaternion::from_scaled_axis(Vector3::x() * turn);
        state[at + ORIENTATION..at + VELOCITY].copy_from_slice(&[q.w, q.i, q.j, q.k]);
    }
    (problem, state)
}

#[test]
fn the_cage_is_held_by_pockets_and_guides() {
    for (pocket, guidance) in
        [(Pocket::Cylindrical, Guidance::OuterRace), (Pocket::Spherical, Guidance::InnerRace)]
    {
        for (friction, speed, scale) in [(0.0, SLOW, 1e-5), (0.1, FAST, 1e-9)] {
            let (problem, state) = caged(pocket, guidance, friction, speed);
            for (kind, push) in [("velocities", VELOCITIES), ("displacements", DISPLACEMENTS)] {
                let mut point = linearised(&problem, state.clone());
                assert!(point.system.sets[0].pockets.iter().any(|pocket| pocket.normal_load > 0.0));
                assert!(point.system.sets[0].guides.iter().all(|guide| guide.normal_load > 0.0));
                let mut noise = Noise(4);
                let r = point.push(push, &mut noise);
                let left = point.left_over(scale, &r);
                // Left out: turning of the normal, depth over gap, 5e-3 in pockets and 7e-3 at guides,
                // and in sums more; how friction follows the load, so that displacements tell of
                // stiffness without friction alone; gyroscopic moments where the cage turns.
                let stiff = [
                    (Part::Force(2), 3e-2),
                    (Part::Torque(2), 3e-2),
                    (Part::Tilt(2), 1e-1),
                    (Part::Rolling, 3e-2),
                ];
                let sliding =
                    [(Part::Force(2), 1e-2), (Part::Torque(2), 1e-2), (Part::BallSpin, 3e-2)];
                let limits: &[_] = match (friction, kind) {
                    (0.0, _) => &stiff,
                    (_, "velocities") => &sliding,
                    _ => &[],
                };
                left.check(&format!("{pocket:?} {friction} {scale} {kind}"), limits);
            }
        }
    }
}
