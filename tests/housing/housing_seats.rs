//! Laws of races in flexible bores as members of the one search for an equilibrium, one of them or several.

use crate::housing_common;

use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::equilibrium::lists::{
    Loaded, Place, StaticAssembly, StaticBearing, StaticBody, StaticSeat,
};
use bearing_dynamics::equilibrium::statics::{AssemblySolution, StaticOptions, solve_assembly};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::kinematics::euler::{about, quaternion};
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::solids::bore_equilibrium::{Axial, BoreSearch, BoreState, Fit};
use bearing_dynamics::solids::condensation::CondensedBore;
use housing_common::*;
use nalgebra::{DMatrix, SVector, UnitQuaternion, Vector3};
use std::f64::consts::PI;

fn fit(interference: f64) -> Fit {
    Fit { radius: BORE + interference, axial: Axial::Fixed }
}

/// Fit, pose (m, rad) and how many of the nodes touch: none, some, all, some under tilts.
const CONFIGURATIONS: [(&str, f64, [f64; 4]); 4] = [
    ("open", -1e-5, [1e-6, -2e-6, 0.0, 0.0]),
    ("partly open", 1e-6, [2e-6, -4e-6, 1e-5, -2e-5]),
    ("closed", 2e-5, [1e-6, -2e-6, 1e-5, 2e-5]),
    ("tilted", -1e-6, [1e-6, -1e-6, 6e-4, -4e-4]),
];

#[test]
fn the_load_of_a_seat_is_the_slope_of_its_energy_and_its_stiffness_that_of_its_load() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    for (name, interference, pose) in CONFIGURATIONS {
        let mut search = BoreSearch::new(&bore, Penalty::default());
        let fit = fit(interference);
        let here = search.answer(&fit, pose).unwrap();
        let touching = search.touching().len();
        let all = bore.nodes.len();
        let should = match name {
            "open" => touching == 0,
            "closed" => touching == all,
            _ => touching > 0 && touching < all,
        };
        assert!(should, "{name}: {touching} of {all}");
        for i in 0..4 {
            // Small beside the overlaps; energies lose digits of a difference, loads of rounding.
            let metres = |k: usize| if k < 2 { 1.0 } else { BORE };
            let step = 1e-9 / metres(i);
            let mut at = |sign: f64| {
                let mut moved = pose;
                moved[i] += sign * step;
                search.answer(&fit, moved).unwrap()
            };
            let (low, high) = (at(-1.0), at(1.0));
            let slope = (high.energy - low.energy) / (2.0 * step);
            let size = here.load.amax().max(1e-3);
            assert!(
                (slope - here.load[i]).abs() <= 1e-4 * size * metres(i),
                "{name} {i}: {slope} {}",
                here.load[i]
            );
            for j in 0..4 {
                let slope = (high.load[j] - low.load[j]) / (2.0 * step);
                let scale = here.stiffness[(0, 0)].max(1.0) * metres(i) * metres(j);
                // A node that comes or goes within a nanometre.
                assert!(
                    (slope - here.stiffness[(j, i)]).abs() <= 2e-2 * scale,
                    "{name} {i} {j}: {slope} {}",
                    here.stiffness[(j, i)]
                );
            }
        }
        assert!((here.stiffness - here.stiffness.transpose()).amax() == 0.0);
        // Action and reaction: what the race puts on the bore is the sum over its nodes.
        let state = search.at_pose(&fit, pose).unwrap();
        let energy = state.elastic_energy + state.contact_energy;
        assert!((energy - here.energy).abs() <= 1e-9 * energy, "{energy} {}", here.energy);
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for (node, (_, on)) in bore.nodes.iter().zip(bore.nodal_forces(&state.loads)) {
            force += Vector3::from(on);
            moment += Vector3::from(node.arm).cross(&Vector3::from(on));
        }
        let sum = [force.y, force.z, moment.y, moment.z];
        let size = state.loads.iter().sum::<f64>().max(1e-30);
        for (sum, load) in sum.into_iter().zip(here.load.iter()) {
            assert!((sum - load).abs() <= 1e-13 * size, "{name}: {sum} {load}");
        }
    }
}

const HALF: f64 = 60e-3;

/// A shaft on two bearings in two equal housings, the right half the left one turned by half a turn about Z; the whole
/// turned and moved by `world`.
fn two_housings<'b>(
    bore: &'b CondensedBore,
    interference: f64,
    loads: [f64; 5],
    world: &Pose,
) -> StaticAssembly<'b> {
    let single = bearing([Condition::Load(0.0); 5]);
    let in_world = |position: Vector3<f64>, orientation: UnitQuaternion<f64>| {
        Pose { position, orientation }.seen_from_parent_of(world)
    };
    let places = [
        in_world(Vector3::new(-HALF, 0.0, 0.0), UnitQuaternion::identity()),
        in_world(Vector3::new(HALF, 0.0, 0.0), about(Vector3::z(), PI)),
    ];
    let named = |name: &str, place| StaticBody { name: name.into(), place };
    let free = |axes: Pose, conditions: [Condition; 5], room: f64| {
        let (axes, springs, rest) = (Some(Box::new(axes)), [0.0; 5], [0.0; 5]);
        Place::Loaded(Loaded { axes, conditions, springs, rest, start: Some([0.0; 5]), room })
    };
    let none = Condition::Load(0.0);
    let race = [Condition::Displacement(0.0), none, none, none, none];
    let sides = ["left", "right"];
    let bearings = [0, 1].map(|side| StaticBearing {
        name: Some(sides[side].into()),
        geometry: single.geometry,
        inner_contact: single.inner_contact,
        outer_contact: single.outer_contact,
        mounts: [
            Mount { body: 0, along: [-HALF, HALF][side], reversed: side == 1 },
            Mount::at_centre(1 + side),
        ],
        azimuths: single.geometry.azimuths(0.1),
        weight: Vector3::zeros(),
        centrifugal: 0.0,
    });
    let seats = [0, 1].map(|side| StaticSeat {
        name: Some(sides[side].into()),
        mount: Mount::at_centre(1 + side),
        nominal: places[side],
        bore,
        penalty: Penalty::default(),
        fit: fit(interference),
    });
    StaticAssembly {
        bodies: vec![
            named("the shaft", free(*world, loads.map(Condition::Load), BORE)),
            named("the left outer race", free(places[0], race, BORE)),
            named("the right outer race", free(places[1], race, BORE)),
        ],
        bearings: bearings.into(),
        seats: seats.into(),
        ..StaticAssembly::default()
    }
}

fn solve(assembly: &StaticAssembly) -> AssemblySolution {
    solve_assembly(assembly, None, &StaticOptions::default()).unwrap()
}

/// Across the shaft in the world, N, and about the shaft's centre, N·m.
fn wrench(
    assembly: &StaticAssembly,
    side: usize,
    state: &BoreState,
) -> (Vector3<f64>, Vector3<f64>) {
    let nominal = &assembly.seats[side].nominal;
    let [y, z, about_y, about_z] = state.load;
    let force = nominal.orientation * Vector3::new(0.0, y, z);
    let moment = nominal.orientation * Vector3::new(0.0, about_y, about_z);
    let centre = nominal.point_to_parent(&Vector3::new(0.0, state.pose[0], state.pose[1]));
    (force, moment + centre.cross(&force))
}

#[test]
fn two_housings_share_the_loads_of_a_shaft() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    for interference in [-1e-6, 0.0, 5e-6] {
        let loads = [30.0, 120.0, -500.0, 4.0, -3.0];
        let assembly = two_housings(&bore, interference, loads, &Pose::identity());
        let found = solve(&assembly);
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for (side, state) in found.seats.iter().enumerate() {
            let (of_one, about_centre) = wrench(&assembly, side, state);
            force += of_one;
            moment += about_centre;
        }
        // Statics leaves 1e-11, and rounding of places 1e-10.
        for (i, should) in [120.0, -500.0].into_iter().enumerate() {
            assert!((force[1 + i] - should).abs() <= 1e-9 * 500.0, "{interference:e}: {force}");
        }
        // Loads act at the shaft's own centre, which has moved, and their moments are about its own axes.
        let q = &found.coordinates[0];
        let centre = Vector3::new(q[0], q[1], q[2]);
        let third = quaternion(0.0, q[3], q[4]) * Vector3::z();
        let applied = Vector3::new(30.0, 120.0, -500.0);
        let about_shaft = moment - centre.cross(&applied);
        assert!((about_shaft.y - 4.0).abs() <= 1e-5 * 4.0, "{about_shaft}");
        assert!((about_shaft.dot(&third) + 3.0).abs() <= 1e-5 * 4.0, "{about_shaft}");
    }
}

#[test]
fn equal_halves_carry_equal_loads() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    for interference in [-1e-6, 0.0, 5e-6] {
        let found = solve(&two_housings(
            &bore,
            interference,
            [0.0, 0.0, -500.0, 0.0, 0.0],
            &Pose::identity(),
        ));
        let [left, right] = [0, 1].map(|side| &found.seats[side]);
        assert!((left.load[1] + 250.0).abs() <= 1e-8 * 250.0, "{:?}", left.load);
        // The same in each one's own axes.
        let size = left.pose[0].hypot(left.pose[1]);
        for i in 0..4 {
            let metres = if i < 2 { 1.0 } else { BORE };
            let apart = metres * (left.pose[i] - right.pose[i]).abs();
            assert!(apart <= 1e-8 * size, "{i}: {:?} {:?}", left.pose, right.pose);
        }
        assert_eq!(left.touching, right.touching);
    }
}

/// With the right outer race held where it came to stand, the left half stays what it was.
#[test]
fn a_race_held_where_its_bore_holds_it_changes_nothing() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let loads = [0.0, 120.0, -500.0, 4.0, -3.0];
    let both = two_housings(&bore, 2e-6, loads, &Pose::identity());
    let found = solve(&both);
    let mut one = both.clone();
    let [x, y, z, xi, lambda] = found.coordinates[2].into();
    let own = Pose { position: Vector3::new(x, y, z), orientation: quaternion(0.0, xi, lambda) };
    one.bodies[2].place = Place::Fixed(own.seen_from_parent_of(&both.seats[1].nominal));
    one.seats.truncate(1);
    let alone = solve(&one);
    let size = found.coordinates[1].fixed_rows::<3>(0).norm();
    for body in 0..2 {
        for i in 0..5 {
            let metres = if i < 3 { 1.0 } else { BORE };
            let apart = metres * (alone.coordinates[body][i] - found.coordinates[body][i]).abs();
            assert!(apart <= 1e-8 * size, "{body} {i}: {apart:e}");
        }
    }
    assert!((alone.seats[0].load[1] - found.seats[0].load[1]).abs() <= 1e-8 * 250.0);
}

/// Turned about the shaft and moved along it, and turned about no axis of its own.
#[test]
fn turning_shaft_and_housings_changes_nothing_of_what_they_see() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let loads = [20.0, 120.0, -500.0, 4.0, -3.0];
    let here = solve(&two_housings(&bore, 1e-6, loads, &Pose::identity()));
    for turn in [Vector3::new(0.7, 0.0, 0.0), Vector3::new(0.8, 1.6, -0.9)] {
        let orientation = UnitQuaternion::from_scaled_axis(turn);
        let world = Pose { position: Vector3::new(0.02, -0.01, 0.03), orientation };
        let there = solve(&two_housings(&bore, 1e-6, loads, &world));
        for body in 0..3 {
            let size = here.coordinates[body].fixed_rows::<3>(0).norm();
            for i in 0..5 {
                let metres = if i < 3 { 1.0 } else { BORE };
                let apart = here.coordinates[body][i] - there.coordinates[body][i];
                // Rounding of places centimetres away: 1e-18 m of micrometres, along soft tilts a hundredfold.
                assert!(metres * apart.abs() <= 1e-8 * size, "{body} {i}: {apart:e}");
            }
        }
    }
}

/// All bodies held at coordinates with nothing of symmetry, a mount away from its body's centre the wrong way round:
/// what the lists say of stiffness is the slope of what they say of loads.
#[test]
fn the_stiffness_of_the_lists_is_the_slope_of_their_loads() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    for interference in [2e-6, 1.5e-5] {
        let orientation = UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -0.2, 0.5));
        let world = Pose { position: Vector3::zeros(), orientation };
        let mut assembly = two_housings(&bore, interference, [0.0; 5], &world);
        // The right race sits on a sleeve that has its centre elsewhere.
        let away =
            Pose { position: Vector3::new(8e-3, 0.0, 0.0), orientation: about(Vector3::z(), PI) };
        let nominal = assembly.seats[1].nominal;
        let Place::Loaded(sleeve) = &mut assembly.bodies[2].place else { unreachable!() };
        sleeve.axes = Some(Box::new(away.seen_from_parent_of(&nominal)));
        let mount = Mount { body: 2, along: 8e-3, reversed: true };
        assembly.seats[1].mount = mount;
        assembly.bearings[1].mounts[1] = mount;
        let at = [
            [1e-6, 3e-6, -6e-6, 2e-5, -1e-5],
            [0.0, 2e-6, -3e-6, 1e-5, 2e-5],
            [1e-6, -1e-6, -3e-6, 2e-4, -1e-4],
        ];
        let loads = |assembly: &StaticAssembly, at: &[[f64; 5]; 3]| {
            let mut held = assembly.clone();
            for (body, at) in held.bodies.iter_mut().zip(at) {
                let Place::Loaded(body) = &mut body.place else { unreachable!() };
                body.conditions = at.map(Condition::Displacement);
            }
            solve(&held)
        };
        let here = loads(&assembly, &at);
        let whole = |found: &AssemblySolution| -> SVector<f64, 15> {
            SVector::from_fn(|i, _| found.loads[i / 5][i % 5])
        };
        let metres = |i: usize| if i % 5 < 3 { 1.0 } else { BORE };
        let mut differences = DMatrix::zeros(15, 15);
        for i in 0..15 {
            let step = 1e-10 / metres(i);
            let moved = |sign: f64| {
                let mut at = at;
                at[i / 5][i % 5] += sign * step;
                whole(&loads(&assembly, &at))
            };
            let slope = (moved(1.0) - moved(-1.0)) / (2.0 * step);
            differences.set_column(i, &slope);
        }
        // Of bearings alone: a seat is far stiffer.
        let size = here.stiffness[(2, 2)];
        for i in 0..15 {
            for j in 0..15 {
                let apart = (differences[(i, j)] - here.stiffness[(i, j)]).abs();
                let part = apart / (size * metres(i) * metres(j));
                // Half of a difference's own error; forces are a part of 1e-4 of the stiffness times a radius.
                assert!(part <= 1e-6, "{interference:e} {i} {j}: {part:e}");
            }
        }
        assert!((&here.stiffness - here.stiffness.transpose()).amax() <= 1e-9 * size);
    }
}

/// A seat that the race does not reach, and one whose nodes are as good as without springs, are as if they were left out.
#[test]
fn a_seat_without_contact_is_left_out() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let mut assembly = two_housings(&bore, 0.0, [0.0, 100.0, -300.0, 1.0, -2.0], &Pose::identity());
    for body in &mut assembly.bodies[1..] {
        let Place::Loaded(body) = &mut body.place else { unreachable!() };
        body.springs = [0.0, 2e8, 3e8, 1e5, 1e5];
    }
    let mut without = assembly.clone();
    without.seats.clear();
    let without = solve(&without);
    let (mut wide, mut soft) = (assembly.clone(), assembly);
    wide.seats.iter_mut().for_each(|seat| seat.fit = fit(-1e-4));
    // Of some 1e9 N/m nothing that a difference of loads would show.
    soft.seats.iter_mut().for_each(|seat| seat.penalty = Penalty::PerNode(1e-9));
    for assembly in [&wide, &soft] {
        let found = solve(assembly);
        for (with, without) in found.coordinates.iter().zip(&without.coordinates) {
            let apart = (with - without).amax();
            assert!(apart <= 1e-10 * without.amax(), "{apart:e}");
        }
        assert!(found.seats.iter().all(|seat| seat.load[1].abs() <= 1e-11));
    }
}

/// A message of one of several names its bearing once.
#[test]
fn a_race_that_its_bore_cannot_hold_is_named_by_its_bearing() {
    let bore = condensed(&RING, &COARSE, Order::Linear, YOUNG);
    let mut assembly = two_housings(&bore, 1e-6, [0.0; 5], &Pose::identity());
    let Place::Loaded(race) = &mut assembly.bodies[2].place else { panic!("it is loaded") };
    race.conditions[2] = Condition::Load(-1e7);
    let error = solve_assembly(&assembly, None, &StaticOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("the outer race of bearing right in its bore: "), "{error}");
}
