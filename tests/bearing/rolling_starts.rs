//! Starts in which balls roll, whichever race turns.

use super::shafts::{on_two, rates};
use crate::{common, dynamics};

use bearing_dynamics::ch2_housing::bearing::inertia::hollow_cylinder;
use bearing_dynamics::equilibrium::initial::static_assembly;
use bearing_dynamics::members::body::{Drive, DrivenBody, Mobility, Rotation};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::state::{POSITION, SPIN, VELOCITY};
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use common::table_5_3;
use dynamics::*;
use nalgebra::Vector3;

/// Whichever race turns, and whichever way round the bearing sits, balls and cage begin by rolling: surfaces at the
/// contacts move alike.
#[test]
fn a_start_rolls_whichever_race_turns() {
    let speed = 3000.0 * RPM;
    for (inner, outer) in [(speed, 0.0), (0.0, speed), (speed, -0.4 * speed), (speed, speed)] {
        for reversed in [false, true] {
            let geometry = table_5_3();
            let mut problem = bearing(geometry, [500.0, 0.0, 0.0, 0.0, 0.0], inner);
            problem.traction = CONSTANT;
            let mut ring = race([0.0; 5], Rotation::Speed(Profile::Constant(outer)));
            ring.drives = [const { Drive::Motion(Profile::ZERO) }; 5];
            problem.outer = Some(ring);
            let mut assembly = problem.assembly();
            for mount in &mut assembly.bearings[0].mounts {
                mount.reversed = reversed;
            }
            if reversed {
                let shaft = assembly.bodies[0].driven_mut().unwrap();
                shaft.drives[0] = Drive::Load(Profile::Constant(-500.0));
            }
            let state = start::nominal(&assembly);
            let (system, _) = rates(&assembly, &state);
            let set = &system.sets[0];
            let [axis_of, turning] = [&set.races[1], &set.races[0]].map(|race| race.motion.axis[0]);
            assert_eq!(axis_of, turning);
            let facing = if reversed { -1.0 } else { 1.0 };
            for ball in 0..set.layout.balls {
                let vector =
                    |component| Vector3::from(set.layout.ball_vector(&state, component, ball));
                let (place, velocity, spin) = (vector(POSITION), vector(VELOCITY), vector(SPIN));
                // At the nominal contact angle, from the outer to the inner contact.
                let outward = Vector3::new(0.0, place.y, place.z).normalize();
                let angle = geometry.contact_angle;
                let normal = outward * angle.cos() + Vector3::x() * (facing * angle.sin());
                for (side, speed) in [(1.0, outer), (-1.0, inner)] {
                    let arm = normal * (side * geometry.ball_radius);
                    let of_ball = velocity + spin.cross(&arm);
                    let of_race = (Vector3::x() * speed).cross(&(place + arm));
                    let slip = (of_ball - of_race).norm();
                    // Rounding of speeds of some metres a second.
                    assert!(slip <= 1e-12 * 20.0, "{inner} {outer} {reversed}: {slip:e} m/s");
                }
                // Balls go with the mean of both surfaces.
                let orbit = place.cross(&velocity).x / (place.y * place.y + place.z * place.z);
                let lever = geometry.ball_radius * angle.cos() / geometry.pitch_radius;
                let mean = 0.5 * ((1.0 - lever) * inner + (1.0 + lever) * outer);
                assert!((orbit - mean).abs() <= 1e-12 * speed, "{orbit} {mean}");
            }
        }
    }
}

/// Balls that roll without slip go round at the mean of both races' speeds, each by its radius at the contact,
/// about the world's axis: whichever way round their bearing is put in, and with turning outer races too.
#[test]
fn balls_roll_between_two_turning_races_whichever_way_their_bearing_faces() {
    let geometry = table_5_3();
    let gamma = geometry.ball_radius * geometry.contact_angle.cos() / geometry.pitch_radius;
    for outer in [0.0, -130.0] {
        let inner = 300.0;
        let mut assembly = on_two([0.0; 5], inner);
        let ring = hollow_cylinder(36e-3, 40e-3, 16e-3, 7850.0);
        for body in &mut assembly.bodies[1..] {
            let drives = body.rest.map(|at| Drive::Motion(Profile::Constant(at)));
            let turns = race([0.0; 5], Rotation::Speed(Profile::Constant(outer)));
            let turns = DrivenBody { inertia: ring, drives, ..turns };
            body.mobility = Mobility::Driven(turns.into());
        }
        let expected = 0.5 * (1.0 - gamma) * inner + 0.5 * (1.0 + gamma) * outer;
        let state = start::nominal(&assembly);
        let system = System::new(assembly.clone(), Kernel::Simd);
        for set in &system.sets {
            for ball in 0..set.layout.balls {
                let [_, y, z] = set.layout.ball_vector(&state, POSITION, ball);
                let [_, v, w] = set.layout.ball_vector(&state, VELOCITY, ball);
                let speed = (y * w - z * v) / (y * y + z * z);
                // Rounding.
                assert!((speed / expected - 1.0).abs() <= 1e-12, "{speed} {expected}");
            }
        }
        // What presses them outwards in statics.
        for bearing in &static_assembly(&assembly, 0.0, &[]).bearings {
            let pressed = assembly.bearings[0].ball.mass * expected * expected;
            assert!(
                (bearing.centrifugal / pressed - 1.0).abs() <= 1e-12,
                "{}",
                bearing.centrifugal
            );
        }
    }
}
