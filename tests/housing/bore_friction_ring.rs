//! Friction in the bore of a ring that gives way: what one gets from the other, and the ledger.

use super::bore_friction::{LAW, STIFFNESS, TIGHT, rigid};
use crate::housing_exchange;

use bearing_dynamics::ch2_housing::bore_contact::{Cylinder, Frame, Penalty};
use bearing_dynamics::ch4_rotor::bore_friction::BoreFriction;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::body::Rotation;
use bearing_dynamics::members::state::{SPIN, VELOCITY};
use bearing_dynamics::motion::bore_friction::{Pressed, SeatFriction};
use bearing_dynamics::motion::coupling::CoupledMotion;
use bearing_dynamics::motion::race_in_bore::Seat;
use bearing_dynamics::numeric::profile::Profile;
use housing_exchange::*;
use nalgebra::{UnitQuaternion, Vector3};

fn snapshot_parts(housed: &mut CoupledMotion) -> [f64; 3] {
    let snapshot = housed.snapshot().unwrap();
    let friction = snapshot.solids[0].seats[0].friction;
    [friction.stored, friction.heat, friction.load_work]
}

/// Bits of everything that moves.
fn bits_of(housed: &CoupledMotion) -> Vec<u64> {
    let solid = &housed.solids[0].solid;
    let nodes = solid.displacement.iter().chain(solid.rates()).flatten();
    housed.simulation.state.iter().chain(nodes).map(|value| value.to_bits()).collect()
}

/// Nothing is held: a race flies along and turns in a free ring, and both come to move together.
#[test]
fn what_friction_gives_the_ring_it_takes_from_the_race() {
    let (model, nodes) = housing(false, 0.0);
    let mut problem = mounted([0.0; 5]);
    problem.outer.as_mut().unwrap().rotation = Rotation::Torque(Profile::ZERO);
    let tight = Profile::Constant(RADIUS + TIGHT);
    let seat = Seat { radius: tight, friction: Some(LAW), ..seat(nodes, f64::INFINITY) };
    let mut housed = joined(problem, model, seat, &rated(0.8, 0.0625, 2e-6)).unwrap();
    let at = housed.simulation.system.sets[0].layout.outer();
    for (entry, value) in [(VELOCITY, 0.05), (VELOCITY + 2, 0.02), (SPIN, 3.0), (SPIN + 1, 2.0)] {
        housed.simulation.state[at + entry] = value;
    }
    let before = (total_momentum(&mut housed), total_angular_momentum(&housed));
    let mut largest = [0.0f64; 2];
    let (mut handed, mut slid, mut worst) = (0.0f64, 0, 0.0f64);
    housed.divide(1.0).unwrap();
    for step in 0..3000 {
        housed.advance().unwrap();
        let now = (total_momentum(&mut housed), total_angular_momentum(&housed));
        let errors = [
            (now.0 - before.0).norm() / before.0.norm(),
            (now.1 - before.1).norm() / before.1.norm(),
        ];
        for (largest, error) in largest.iter_mut().zip(errors) {
            *largest = if error <= *largest { *largest } else { error };
        }
        if step % 50 == 0 {
            let snapshot = housed.snapshot().unwrap();
            let friction = &snapshot.solids[0].seats[0].friction;
            slid = slid.max(friction.slipping);
            handed = handed.max(only(&housed).impulse[0].abs());
            let part = snapshot.residual.abs() / snapshot.turned_over;
            worst = if part <= worst { worst } else { part };
        }
    }
    println!("momenta {:e} {:e}, {slid} nodes slid, residual {worst:.1e}", largest[0], largest[1]);
    assert!(handed > 0.1 * before.0.norm() && slid > 0, "{handed:e} {slid}");
    assert!(largest.iter().all(|error| *error <= 1e-9), "{largest:?}");
    // Thrown about between race and ring: with coupling steps four times as long, 7e-3, and 1.4e-2 without friction.
    assert!(worst <= 1e-3, "{worst:e}");
}

/// A blow on a race that lies loose in its bore and is pulled along it: stored, lost and carried energies add up.
#[test]
fn the_energy_of_a_blow_with_friction_balances() {
    let run = |phase: f64| {
        let (model, nodes) = housing(true, 77.0);
        let mut problem = blow(mounted([60.0, 0.0, -250.0, 0.0, 0.0]));
        problem.outer.as_mut().unwrap().rotation = Rotation::Torque(Profile::Constant(0.5));
        let seat = Seat { friction: Some(LAW), ..seat(nodes, f64::INFINITY) };
        let mut housed = joined(problem, model, seat, &rated(0.8, phase, 2e-6)).unwrap();
        let (mut worst, mut heat, mut most) = (0.0f64, 0.0, 0.0f64);
        while housed.time() < 2e-3 {
            for _ in 0..50 {
                housed.advance().unwrap();
            }
            let snapshot = housed.snapshot().unwrap();
            let friction = snapshot.solids[0].seats[0].friction;
            assert!(friction.heat >= heat, "heat does not come back");
            (heat, most) = (friction.heat, snapshot.turned_over);
            let part = snapshot.residual.abs() / snapshot.turned_over;
            worst = if part <= worst { worst } else { part };
        }
        let of = snapshot_parts(&mut housed);
        println!("phase {phase}: residual {worst:.1e}, heat {:.1e} of {most:.1e} J, {of:?}", heat);
        (worst, heat / most)
    };
    let [(coarse, part), (fine, _)] = [run(0.25), run(0.125)];
    assert!(part > 1e-3, "{part:e}");
    assert!(coarse <= 1e-3 && fine <= 0.5 * coarse.max(1e-6), "{coarse:e} {fine:e}");
}

#[test]
fn a_coefficient_of_zero_is_no_friction_bit_for_bit() {
    let run = |friction| {
        let (model, nodes) = housing(true, 77.0);
        let seat = Seat { friction, ..seat(nodes, 10e-6) };
        let problem = blow(mounted([0.0, 30.0, -250.0, 0.3, 0.0]));
        let mut housed = joined(problem, model, seat, &options()).unwrap();
        for _ in 0..3000 {
            housed.advance().unwrap();
        }
        let snapshot = housed.snapshot().unwrap();
        let pulls = only(&housed).friction.as_ref().map_or(0, |of| of.updates);
        (bits_of(&housed), snapshot.residual.to_bits(), snapshot.turned_over.to_bits(), pulls)
    };
    let zero = run(Some(BoreFriction { coefficient: 0.0, ..LAW }));
    let none = run(None);
    assert!(zero.3 > 0 && none.3 == 0, "it ran");
    assert!((zero.0, zero.1, zero.2) == (none.0, none.1, none.2));
    // It would notice.
    assert!(run(Some(LAW)).0 != run(None).0);
}

/// Race and bore turned and moved together: the same loads along the race's axes, the same springs.
#[test]
fn a_motion_of_both_together_stretches_nothing() {
    let (_, nodes) = rigid();
    let cylinder = Cylinder { radius: RADIUS + TIGHT, width: 1.2 * WIDTH };
    let penalty = Penalty::PerArea(STIFFNESS);
    let run = |turned: bool| {
        let mut friction = SeatFriction::new(LAW, nodes.len());
        let mut loads = Vec::new();
        for step in 0..40 {
            let part = f64::from(step) / 40.0;
            let pose = if turned {
                let turn = Vector3::new(0.9, -0.4, 0.6) * part;
                Pose {
                    position: Vector3::new(3e-3, -2e-3, 1e-3) * part,
                    orientation: UnitQuaternion::from_scaled_axis(turn),
                }
            } else {
                Pose::identity()
            };
            // Of the bore in the race's axes: some of its nodes slip in the end.
            let along = Vector3::new(2e-7 * part, 3e-8 * part, 0.0);
            let about =
                UnitQuaternion::from_scaled_axis(Vector3::new(3e-6 * part, 0.0, 1e-6 * part));
            let displacement: Vec<[f64; 4]> = {
                let most = nodes.iter().map(|node| node.node).max().unwrap();
                let mut all = vec![[0.0; 4]; most as usize + 1];
                for node in &nodes {
                    let place = Vector3::from(node.place);
                    let there = pose.point_to_parent(&(about * place + along)) - place;
                    all[node.node as usize][..3].copy_from_slice(there.as_slice());
                }
                all
            };
            let mut forces = vec![[0.0; 4]; displacement.len()];
            let frame = Frame::new(&pose);
            let pressed = Pressed {
                cylinder: &cylinder,
                frame: &frame,
                penalty,
                nodes: &nodes,
                displacement: &displacement,
            };
            friction.step(&pressed, &mut forces);
            let seen = |v| pose.orientation.inverse() * Vector3::from(v);
            loads.push((
                seen(friction.sum.force),
                seen(friction.sum.moment),
                friction.sum.slipping,
            ));
        }
        (loads, friction.sum.heat)
    };
    let (here, there) = (run(false), run(true));
    let size = here.0.iter().map(|(force, ..)| force.norm()).fold(0.0, f64::max);
    assert!(here.0[39].2 > 0 && here.0[5].2 == 0, "{:?}", here.0[39]);
    for (a, b) in here.0.iter().zip(&there.0) {
        // Turned places are rounded by 1e-17 m beside stretches of 1e-7 m.
        assert!((a.0 - b.0).norm() <= 1e-8 * size, "{a:?} {b:?}");
        assert!((a.1 - b.1).norm() <= 1e-8 * size * RADIUS, "{a:?} {b:?}");
        assert_eq!(a.2, b.2);
    }
    assert!((here.1 / there.1 - 1.0).abs() <= 1e-8);
}
