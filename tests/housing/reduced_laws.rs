//! Laws of reduced solids and their seats that hold at any instant, in any state, wherever a race sits on its body.

use crate::dynamics::{GRAVITY, Noise};
use crate::housing_common::{BORE, YOUNG};
use crate::housing_reduced::*;

use bearing_dynamics::assembly::lists::{Assembly, OUTER};
use bearing_dynamics::members::body::Drive;
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::reduced_solid::{ModalLoad, Surface, SurfaceNode};
use bearing_dynamics::members::state::{LEDGER, POSITION};
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;

/// All that can do work at once: a solid with weight, damping and a load that grows, a race that grows into its bore.
fn busy(mut assembly: Assembly) -> Assembly {
    assembly.gravity = GRAVITY;
    assembly.seats[0].radius =
        Profile::SmoothRamp { from: BORE, to: BORE + 1e-6, start: 0.0, duration: 3e-4 };
    let solid = &mut assembly.solids[0];
    solid.weight = (0..solid.count()).map(|k| 20.0 - 3.0 * k as f64).collect();
    solid.loads.push(ModalLoad {
        forces: (0..solid.count()).map(|k| 10.0 + k as f64).collect(),
        profile: Profile::SmoothRamp { from: 0.0, to: 1.0, start: 0.0, duration: 2e-4 },
    });
    assembly
}

/// Energy changes by what the ledger has, term by term of the equations, whether or not a race sits at the centre of the
/// body that carries it.
#[test]
fn the_ledger_has_what_the_energy_of_shapes_and_seats_loses() {
    let mut housing = ring(YOUNG, |model| model.problem.damping = 2000.0, 60e3, 1e-2);
    let settled = settled(&mut housing, &mounted(400.0), 0.2e-6);
    let (at_rest, state) = state_of(&settled);
    let mut noise = Noise(11);
    let shaken = shaken_state(&at_rest, &state, &mut noise);
    let at = at_rest.places.body(OUTER);
    let axis = at_rest.body_state(&shaken, OUTER).axis();
    let mut seen: Option<[f64; 3]> = None;
    for (along, reversed) in [(0.0, false), (8e-3, false), (-5e-3, true)] {
        let mut assembly = busy(settled.clone());
        let mount = Mount { body: OUTER, along, reversed };
        assembly.seats[0].race = mount;
        assembly.bearings[0].mounts[1] = mount;
        assembly.bodies[OUTER].rest[0] = -along;
        let race = assembly.bodies[OUTER].driven_mut().unwrap();
        race.drives[0] = Drive::Motion(Profile::Constant(-along * axis[0]));
        let mut state = shaken.clone();
        let mut system = System::new(assembly, Kernel::Simd);
        for (i, axis) in axis.into_iter().enumerate() {
            state[at + POSITION + i] -= along * axis;
        }
        let t = 1e-4;
        let rates = rates_of(&mut system, t, &state);
        assert!(system.seats[0].touching.len() > 5, "{}", system.seats[0].touching.len());
        // The same race in the same place.
        let force = system.seats[0].contact.force;
        for (own, same) in force.into_iter().zip(*seen.get_or_insert(force)) {
            // Places are rounded to 1e-18 m of overlaps of 1e-7 m.
            assert!((own - same).abs() <= 1e-6 * force[2].abs(), "{along}: {force:?} {seen:?}");
        }
        let ledger = system.places.ledger();
        let power: f64 = rates[ledger..ledger + LEDGER].iter().sum();
        let step = 1e-9;
        let mut energy = |by: f64| {
            let there: Vec<f64> = state.iter().zip(&rates).map(|(x, rate)| x + by * rate).collect();
            rates_of(&mut system, t + by, &there);
            system.energy(&there).total()
        };
        let slope = (energy(step) - energy(-step)) / (2.0 * step);
        println!("{along}: {slope} W, ledger {power} W");
        // Nodes that come or go within 1e-11 m; shapes, damping and growth have some watts of some thousand each.
        assert!((slope - power).abs() <= 1e-6 * power.abs(), "{along}: {slope} {power}");
    }
}

/// In a step that ends at a corner nothing sees what comes after it.
#[test]
fn no_stage_sees_loads_and_growth_of_later() {
    let mut housing = plain();
    let settled = settled(&mut housing, &mounted(400.0), 0.2e-6);
    let (_, state) = state_of(&settled);
    let mut system = System::new(busy(settled), Kernel::Simd);
    let before = rates_of(&mut system, 1e-4, &state);
    let after = rates_of(&mut system, 1.5e-4, &state);
    let (at, count) = (system.solids[0], system.assembly.solids[0].count());
    let shapes = at + count..at + 2 * count;
    assert!(before[shapes.clone()].iter().zip(&after[shapes]).all(|(a, b)| a != b));
    system.latest = 1e-4;
    assert_eq!(rates_of(&mut system, 1.5e-4, &state), before);
    // Of the solid's own load each shape feels its part.
    system.latest = f64::INFINITY;
    system.assembly.seats[0].radius = Profile::Constant(BORE + 0.2e-6);
    let [before, after] = [1e-4, 1.5e-4].map(|t| rates_of(&mut system, t, &state));
    let load = system.assembly.solids[0].loads.last().unwrap();
    let grown = load.profile.value(1.5e-4) - load.profile.value(1e-4);
    for (k, force) in load.forces.iter().enumerate() {
        let change = after[at + count + k] - before[at + count + k];
        // Rounding of accelerations some thousand times as large.
        assert!((change - force * grown).abs() <= 1e-8 * force, "{k}: {change} {}", force * grown);
    }
}

/// Rates of outer race and shapes, bearing by bearing, with shapes that have gone somewhere.
fn rates_by_bearing(assembly: &Assembly) -> Vec<Vec<f64>> {
    let mut system = System::new(assembly.clone(), Kernel::Simd);
    let mut state = start::nominal(assembly);
    for (index, solid) in assembly.solids.iter().enumerate() {
        let (at, count) = (system.solids[index], solid.count());
        for k in 0..count {
            state[at + k] = 1e-8 * (k as f64 - 1.5);
            state[at + count + k] = 1e-3 * (2.5 - k as f64);
        }
    }
    let rates = rates_of(&mut system, 0.0, &state);
    assert!(system.seats.iter().all(|seat| seat.touching.len() > 5));
    let of = |index: usize| {
        let body = system.places.body(2 * index + OUTER);
        let (at, count) = (system.solids[index], assembly.solids[index].count());
        [&rates[body..body + 13], &rates[at..at + 2 * count]].concat()
    };
    (0..assembly.solids.len()).map(of).collect()
}

/// Two housings that share nothing, each with its bearing: to the bit as each alone, whichever comes first.
#[test]
fn every_seat_is_in_its_own_solid_and_on_its_own_surface() {
    let mut first = plain();
    let mut second = ring(0.5 * YOUNG, |model| model.problem.damping = 900.0, 20e3, 1e-1);
    let mut ones = [
        settled(&mut first, &mounted(400.0), 0.2e-6),
        settled(&mut second, &mounted(-300.0), 1e-6),
    ];
    assert_ne!(ones[0].solids[0].count(), ones[1].solids[0].count());
    let alone = ones.each_ref().map(|one| rates_by_bearing(one).remove(0));
    // A further surface that nothing sits on.
    for one in &mut ones {
        let mut idle = one.solids[0].surfaces[0].clone();
        idle.nodes.iter_mut().for_each(|node| node.place[2] -= 1e-3);
        idle.shapes.iter_mut().for_each(|along| *along *= -2.0);
        one.solids[0].surfaces.insert(0, idle);
        one.seats[0].surface = 1;
    }
    for order in [[0, 1], [1, 0]] {
        let mut both = ones[order[0]].clone();
        let mut other = ones[order[1]].clone();
        assert_eq!((both.bodies.len(), both.solids.len()), (2, 1));
        for mount in &mut other.bearings[0].mounts {
            mount.body += 2;
        }
        for seat in &mut other.seats {
            seat.race.body += 2;
            seat.solid += 1;
        }
        both.bodies.extend(other.bodies);
        both.bearings.extend(other.bearings);
        both.solids.extend(other.solids);
        both.seats.extend(other.seats);
        for (found, index) in rates_by_bearing(&both).iter().zip(order) {
            assert_eq!(found, &alone[index], "{order:?}");
        }
    }
}

/// A race that has slid along its bore touches nodes up to the rim's allowance over its edge, and no farther.
#[test]
fn nodes_over_the_rim_are_touched_as_far_as_is_said() {
    let housing = plain();
    let mut assembly = seated(&housing, &mounted(0.0), Profile::Constant(BORE + 1e-6));
    let (seat, all) = (assembly.seats[0].clone(), housing.bore.nodes.len());
    let edge = housing.bore.nodes.iter().map(|node| node.arm[0]).fold(0.0, f64::max);
    let room = 0.5 * seat.width + seat.rim - edge;
    assert!(seat.rim > 0.0 && room > 0.0, "{} {room}", seat.rim);
    let (_, state) = state_of(&assembly);
    for (slid, whole) in [(0.9 * room, true), (1.1 * room, false)] {
        for way in [1.0, -1.0] {
            let race = assembly.bodies[OUTER].driven_mut().unwrap();
            race.drives[0] = Drive::Motion(Profile::Constant(way * slid));
            let mut system = System::new(assembly.clone(), Kernel::Simd);
            rates_of(&mut system, 0.0, &state);
            let touching = system.seats[0].contact.touching;
            assert_eq!(touching == all, whole, "{slid}: {touching} of {all}");
        }
    }
}

/// Which way a shape points is no physics.
#[test]
fn sizes_of_shapes_have_no_sign() {
    let node = SurfaceNode { node: 0, place: [0.0; 3], normal: [0.0, 1.0, 0.0], area: 1.0 };
    let surface = Surface { nodes: vec![node; 2], shapes: vec![-3.0, 1.0, 0.5, -0.25] };
    assert_eq!(surface.largest().collect::<Vec<_>>(), [3.0, 0.5]);
    assert_eq!(surface.by_node(), [-3.0, 0.5, 1.0, -0.25]);
    let mut along = [7.0; 2];
    surface.along_normals(&[2.0, 4.0], &mut along);
    assert_eq!(along, [-4.0, 1.0]);
}
