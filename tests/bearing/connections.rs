//! Laws that every kind of connection keeps: action and reaction, loads as slopes of an energy, power as what is
//! stored and lost, rows as differences, nothing where there is nothing.

use crate::dynamics;

use bearing_dynamics::ch2_housing::bearing::inertia::hollow_cylinder;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::solver::dynamics::assembly::{Assembly, Body, Mobility};
use bearing_dynamics::solver::dynamics::connection::{
    Connection, Law, MaxwellElement, SpringDashpot, Torsion,
};
use bearing_dynamics::solver::dynamics::contacts::Driver;
use bearing_dynamics::solver::dynamics::held::check_held;
use bearing_dynamics::solver::dynamics::model::{RaceBody, Rotation};
use bearing_dynamics::solver::dynamics::race::{RaceNow, mounted};
use bearing_dynamics::solver::dynamics::run::{Simulation, Start};
use bearing_dynamics::solver::dynamics::stability::step_limit;
use bearing_dynamics::solver::dynamics::start;
use bearing_dynamics::solver::dynamics::state::{BodyState, POSITION, Places, SPIN, VELOCITY};
use bearing_dynamics::solver::dynamics::system::System;
use bearing_dynamics::solver::mount::Mount;
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::static_assembly::{Loaded, Place, StaticAssembly, StaticBody};
use bearing_dynamics::solver::statics::{
    Condition, Determinacy, StaticOptions, StaticsError, solve_assembly,
};
use dynamics::*;
use nalgebra::{UnitQuaternion, Vector3};

/// One of every kind, all of it at work.
fn kinds() -> Vec<Connection> {
    // Turns mean something as long as the axes do not point against each other.
    let ends = [
        Mount { body: 0, along: 0.03, reversed: false },
        Mount { body: 1, along: -0.02, reversed: false },
    ];
    let torsion = Law::Torsion(Torsion { stiffness: 800.0, damping: 0.5 });
    vec![
        Connection { name: "spring".into(), label: None, ends, law: Law::SpringDashpot(SPRING) },
        Connection { name: "torsion".into(), label: None, ends, law: torsion },
        Connection { name: "rubber".into(), label: None, ends, law: Law::SpringDashpot(rubber()) },
    ]
}

/// A spring that relaxes fast and slowly.
fn rubber() -> SpringDashpot {
    let element = |share: f64, relaxation_time| MaxwellElement {
        stiffness: SPRING.stiffness.map(|stiffness| share * stiffness),
        relaxation_time,
    };
    SpringDashpot { maxwell: vec![element(3.0, 0.2e-3), element(0.7, 20e-3)], ..SPRING }
}

const SPRING: SpringDashpot = SpringDashpot {
    stiffness: [2e6, 3e6, 5e6, 40.0, 900.0, 700.0],
    damping: [200.0, 100.0, 300.0, 0.05, 0.4, 0.7],
    rest: [1e-3, -2e-3, 0.5e-3],
    maxwell: Vec::new(),
};

fn spring() -> Connection {
    kinds().remove(0)
}

/// Two bodies in any motion, turned by about `turn` rad.
fn pair(seed: u64, turn: f64) -> [RaceNow; 2] {
    let mut noise = Noise(seed);
    [(); 2].map(|()| {
        RaceNow::new(BodyState {
            position: noise.vector(2e-3),
            orientation: noise.turn(turn),
            velocity: noise.vector(0.5),
            spin: noise.vector(20.0),
        })
    })
}

fn ends(connection: &Connection, bodies: &[RaceNow; 2]) -> [RaceNow; 2] {
    connection.ends.map(|mount| mounted(&bodies[mount.body], &mount))
}

/// Elongations of its Maxwell elements, some tenths of a millimetre, a `time` after `bodies`.
fn elongated(connection: &Connection, bodies: &[RaceNow; 2], time: f64) -> Vec<f64> {
    let ends = ends(connection, bodies);
    let rates = connection.pull([&ends[0], &ends[1]], &[]).rates;
    let elements = connection.maxwell().iter().enumerate();
    let of = |(k, element): (usize, &MaxwellElement)| {
        let relaxation_time = element.relaxation_time;
        (0..6).map(move |i| {
            let here = 1e-4 * (1.0 + i as f64 - 2.5 * k as f64);
            here + time * (rates[i] - here / relaxation_time)
        })
    };
    elements.flat_map(of).collect()
}

/// Loads about the centres of the bodies, energy and loss.
fn pull(connection: &Connection, bodies: &[RaceNow; 2]) -> ([[Vector3<f64>; 2]; 2], f64, f64) {
    pull_at(connection, bodies, &elongated(connection, bodies, 0.0))
}

fn pull_at(
    connection: &Connection,
    bodies: &[RaceNow; 2],
    elongated: &[f64],
) -> ([[Vector3<f64>; 2]; 2], f64, f64) {
    let ends = ends(connection, bodies);
    let pull = connection.pull([&ends[0], &ends[1]], elongated);
    let on = [0, 1].map(|end| {
        let arm = Vector3::from(ends[end].motion.position)
            - Vector3::from(bodies[connection.ends[end].body].motion.position);
        let force = Vector3::from(pull.on[end].force);
        [force, Vector3::from(pull.on[end].moment) + arm.cross(&force)]
    });
    (on, pull.energy, pull.loss)
}

/// Bodies as they are after going on for a time at their velocities.
fn after(bodies: &[RaceNow; 2], time: f64) -> [RaceNow; 2] {
    bodies.map(|body| {
        let mut state = body.state;
        let by = |v: [f64; 3]| Vector3::from(v) * time;
        state.position = (Vector3::from(state.position) + by(state.velocity)).into();
        state.orientation = UnitQuaternion::from_scaled_axis(by(state.spin)) * state.orientation;
        RaceNow::new(state)
    })
}

#[test]
fn what_one_end_gets_the_other_gets_too() {
    for connection in kinds() {
        for seed in 0..50 {
            let bodies = pair(seed, 1.5);
            let ([first, second], ..) = pull(&connection, &bodies);
            assert!((first[0] + second[0]).norm() <= 1e-13 * first[0].norm());
            let at = |body: usize| Vector3::from(bodies[body].motion.position);
            // About the origin.
            let moments = first[1] + at(0).cross(&first[0]) + second[1] + at(1).cross(&second[0]);
            assert!(moments.norm() <= 1e-12 * (first[1].norm() + second[1].norm()), "{moments}");
        }
    }
}

#[test]
fn power_goes_into_the_store_or_is_lost() {
    for connection in kinds() {
        for seed in 0..50 {
            let bodies = pair(seed, 1.0);
            let (on, _, loss) = pull(&connection, &bodies);
            let power: f64 = on
                .iter()
                .zip(&bodies)
                .map(|([force, moment], body)| {
                    force.dot(&Vector3::from(body.motion.velocity))
                        + moment.dot(&Vector3::from(body.motion.spin))
                })
                .sum();
            let time = 1e-7;
            let stored = |time: f64| {
                let elongated = elongated(&connection, &bodies, time);
                pull_at(&connection, &after(&bodies, time), &elongated).1
            };
            let rate = (stored(time) - stored(-time)) / (2.0 * time);
            let size = on.iter().zip(&bodies).map(|([force, moment], body)| {
                force.norm() * Vector3::from(body.motion.velocity).norm()
                    + moment.norm() * Vector3::from(body.motion.spin).norm()
            });
            let size: f64 = size.sum();
            // (time × turning rate)² of a second derivative, and rounding of energies over the time.
            let error = (power + rate - loss).abs();
            assert!(error <= 1e-7 * size, "{power} {rate} {loss}: {error:e} of {size:e}");
            assert!(loss < 0.0);
        }
    }
}

#[test]
fn all_turned_and_moved_alike_loads_turn_with_it() {
    for connection in kinds() {
        for seed in 0..20 {
            let bodies = pair(seed, 1.5);
            let mut noise = Noise(1000 + seed);
            let (turn, shift) = (noise.turn(2.0), Vector3::from(noise.vector(0.3)));
            let moved = bodies.map(|body| {
                let state = body.state;
                let rotate = |v: [f64; 3]| -> [f64; 3] { (turn * Vector3::from(v)).into() };
                RaceNow::new(BodyState {
                    position: (turn * Vector3::from(state.position) + shift).into(),
                    orientation: turn * state.orientation,
                    velocity: rotate(state.velocity),
                    spin: rotate(state.spin),
                })
            });
            let ((here, energy, loss), (there, energy_there, loss_there)) =
                (pull(&connection, &bodies), pull(&connection, &moved));
            for (here, there) in here.iter().flatten().zip(there.iter().flatten()) {
                // Places 0.3 m out, rounded at 5e-17 m, against stretches of millimetres.
                assert!((turn * here - there).norm() <= 1e-11 * there.norm().max(1.0));
            }
            assert!((energy - energy_there).abs() <= 1e-11 * energy);
            assert!((loss - loss_there).abs() <= 1e-11 * loss.abs());
        }
    }
}

/// Rows against differences of loads, of unturned ends at rest, where nothing is left out.
#[test]
fn rows_are_the_slopes_of_loads() {
    for connection in kinds() {
        let mut bodies = pair(7, 0.0);
        for body in &mut bodies {
            body.state.velocity = [0.0; 3];
            body.state.spin = [0.0; 3];
        }
        // No load at rest, so that no row is bent by one.
        let mut connection = connection;
        let at = ends(&connection, &bodies);
        if let Law::SpringDashpot(law) = &mut connection.law {
            law.rest = [0, 1, 2].map(|i| at[1].motion.position[i] - at[0].motion.position[i]);
        }
        // The second end is put in the other way round: half a turn about Z between the two.
        connection.ends[1].reversed = false;
        let bodies = bodies.map(|body| RaceNow::new(body.state));
        let at = ends(&connection, &bodies);
        let rows = connection.rows([&at[0], &at[1]]);
        for moved in 0..2 {
            for direction in 0..6 {
                for rate in [false, true] {
                    let step = if rate { 1e-3 } else { 1e-8 };
                    let load = |by: f64| {
                        let mut all = bodies;
                        let state = &mut all[moved].state;
                        match (rate, direction) {
                            (false, 0..3) => state.position[direction] += by,
                            (false, _) => {
                                let mut turn = [0.0; 3];
                                turn[direction - 3] = by;
                                state.orientation = UnitQuaternion::from_scaled_axis(turn.into())
                                    * state.orientation;
                            }
                            (true, 0..3) => state.velocity[direction] += by,
                            (true, _) => state.spin[direction - 3] += by,
                        }
                        pull_at(&connection, &all.map(|body| RaceNow::new(body.state)), &[]).0
                    };
                    let (high, low) = (load(step), load(-step));
                    for end in 0..2 {
                        for part in 0..6 {
                            let of = |of: &[[Vector3<f64>; 2]; 2]| of[end][part / 3][part % 3];
                            let slope = (of(&high) - of(&low)) / (2.0 * step);
                            let lever =
                                |row: &bearing_dynamics::solver::dynamics::connection::Row,
                                 end: usize,
                                 part: usize| {
                                    let arm = Vector3::from(at[end].motion.position)
                                        - Vector3::from(bodies[end].motion.position);
                                    let [linear, turning] = row.on[end].map(Vector3::from);
                                    let turning = turning + arm.cross(&linear);
                                    if part < 3 { linear[part] } else { turning[part - 3] }
                                };
                            let expected: f64 = rows
                                .iter()
                                .map(|row| {
                                    let weight = if rate { row.damping } else { row.stiffness };
                                    -weight * lever(row, end, part) * lever(row, moved, direction)
                                })
                                .sum();
                            let size = if rate { 300.0 } else { 5e6 };
                            let error = (slope - expected).abs();
                            assert!(
                                error <= 1e-6 * size,
                                "{moved} {direction} {rate} on {end} {part}: {slope} {expected}"
                            );
                        }
                    }
                }
            }
        }
    }
}

fn body(name: &str, mobility: Mobility) -> Body {
    Body {
        name: name.into(),
        label: None,
        mobility,
        rest: [0.0; 5],
        rotating_load: None,
        unbalance: 0.0,
    }
}

fn free(name: &str) -> Body {
    let inertia = hollow_cylinder(5e-3, 20e-3, 60e-3, 7850.0);
    let rotation = Rotation::Torque(Profile::ZERO);
    body(name, Mobility::Driven(RaceBody { inertia, ..race([0.0; 5], rotation) }.into()))
}

/// What springs about Y and Z do to a shaft depends on how its axis lies, not on how far it has spun; nor do its dashpots feel the
/// spin.
#[test]
fn a_shaft_that_spins_on_turning_springs_feels_its_tilt_alone() {
    let mut law = SPRING;
    (law.stiffness[3], law.damping[3], law.rest) = (0.0, 0.0, [0.0; 3]);
    let ends = [Mount::at_centre(0), Mount::at_centre(1)];
    let connection =
        Connection { name: "bed".into(), label: None, ends, law: Law::SpringDashpot(law) };
    let tilt = UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.03, -0.02));
    let ground = RaceNow::new(BodyState {
        orientation: UnitQuaternion::identity(),
        ..pair(1, 0.0)[0].state
    });
    let ground = RaceNow::new(BodyState {
        position: [0.0; 3],
        velocity: [0.0; 3],
        spin: [0.0; 3],
        ..ground.state
    });
    let moment = |angle: f64| {
        let spun = tilt * UnitQuaternion::from_scaled_axis(Vector3::x() * angle);
        let spin = (spun * Vector3::x() * 600.0).into();
        let state = BodyState { orientation: spun, spin, ..ground.state };
        let (on, energy, loss) = pull(&connection, &[ground, RaceNow::new(state)]);
        (on[1][1], energy, loss)
    };
    let (still, energy, _) = moment(0.0);
    for angle in [0.5, 2.0, 3.1, 4.0, 6.0, 100.0] {
        let (there, stored, loss) = moment(angle);
        assert!((there - still).norm() <= 1e-11 * still.norm(), "{angle}: {there} {still}");
        assert!(
            (stored - energy).abs() <= 1e-11 * energy && loss.abs() <= 1e-9,
            "{angle}: {loss:e}"
        );
    }
    // To the third order of the tilt.
    let expected = Vector3::new(0.0, -900.0 * 0.03, 700.0 * 0.02);
    let across = Vector3::new(0.0, still.y, still.z);
    assert!((across - expected).norm() <= 1e-3 * expected.norm(), "{still}");
}

/// Two free bodies on a spring: momentum to rounding, and what is lost is booked.
#[test]
fn two_bodies_on_a_spring_keep_momentum_and_book_their_loss() {
    for connection in kinds() {
        let assembly = Assembly {
            bodies: vec![free("one"), free("other")],
            connections: vec![connection],
            ..Assembly::default()
        };
        let places = Places::of(&assembly);
        let mut state = vec![0.0; places.state_len()];
        for (index, now) in pair(3, 0.1).iter().enumerate() {
            let at = places.body(index);
            state[at..at + 13].copy_from_slice(&now.state.to_array());
        }
        let before = momenta(assembly.clone(), &state);
        let options = fixed_step(0.5e-6, Start::Nominal);
        let mut simulation = Simulation::from_state(assembly.clone(), options, state, 0.0).unwrap();
        for _ in 0..4000 {
            simulation.step().unwrap();
        }
        let snapshot = simulation.snapshot().unwrap();
        let end = momenta(assembly, &simulation.state);
        assert!((end.0 - before.0).norm() <= 1e-12 * before.0.norm());
        assert!((end.1 - before.1).norm() <= 1e-10 * before.1.norm(), "{} {}", end.1, before.1);
        let lost: f64 = snapshot.ledger.iter().sum();
        println!("lost {lost} J, residual {:e} J", snapshot.residual);
        assert!(lost < -1.0);
        // Runge-Kutta at ωh of 0.05 to 0.1: (ωh)⁵/120 a step of what swings, for four thousand of them that die out.
        assert!(snapshot.residual.abs() <= 1e-5 * lost.abs(), "{:e}", snapshot.residual);
    }
}

/// A connection of no stiffness and no damping is none, to the bit.
#[test]
fn nothing_is_left_of_a_connection_of_zeros() {
    let mut with =
        bearing(crate::common::table_4_1(-5e-6), [0.0, 0.0, -300.0, 0.0, 0.0], 100.0).assembly();
    let without = with.clone();
    let ends = [Mount { body: 0, along: 0.02, reversed: false }, Mount::at_centre(1)];
    let law = Law::SpringDashpot(SpringDashpot::default());
    with.connections.push(Connection { name: "nothing".into(), label: None, ends, law });
    assert!(with.connections[0].is_void());
    let end = |assembly: &Assembly| {
        let mut simulation =
            Simulation::new(assembly.clone(), fixed_step(1e-6, Start::Equilibrium)).unwrap();
        for _ in 0..200 {
            simulation.step().unwrap();
        }
        simulation.state.iter().map(|value| (value + 0.0).to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(end(&with), end(&without));
}

/// Where statics puts a body between springs nothing accelerates it.
#[test]
fn a_body_on_springs_stands_where_its_load_is_carried() {
    let mut connection = spring();
    connection.ends = [Mount::at_centre(1), Mount { body: 0, along: 0.01, reversed: false }];
    let loads = [200.0, -100.0, 300.0, 1.5, -2.0];
    let held = Place::Held(Pose::identity());
    let loaded = Loaded {
        axes: None,
        conditions: loads.map(Condition::Load),
        springs: [0.0; 5],
        rest: [0.0; 5],
        start: Some([0.0; 5]),
        room: 1.0,
    };
    let named = |name: &str, place| StaticBody { name: name.into(), place };
    let statics = StaticAssembly {
        bodies: vec![named("body", Place::Loaded(loaded)), named("ground", held)],
        connections: vec![connection.clone()],
        ..StaticAssembly::default()
    };
    let found = solve_assembly(&statics, None, &StaticOptions::default()).unwrap();
    let mut moved = free("body");
    let race = moved.driven_mut().unwrap();
    *race =
        RaceBody { inertia: race.inertia, ..dynamics::race(loads, Rotation::Speed(Profile::ZERO)) };
    let assembly = Assembly {
        bodies: vec![moved, body("ground", Mobility::Fixed)],
        connections: vec![connection],
        ..Assembly::default()
    };
    let state = start::at_equilibrium(&assembly).unwrap();
    let at = bearing_dynamics::solver::dynamics::race::fixed(&found.coordinates[0].into());
    assert_eq!(state[..13], at.state.to_array());
    // Without its spring nothing holds it.
    let mut loose = assembly.clone();
    loose.connections.clear();
    let error = start::at_equilibrium(&loose).unwrap_err();
    assert!(matches!(error, StaticsError::NoEquilibrium { .. }), "{error}");
    assert!(check_held(&assembly).is_ok());
    assert!(matches!(check_held(&loose), Err(StaticsError::Unheld { .. })));
    let mut system = System::new(assembly.clone(), Driver::Lanes);
    let mut rates = vec![0.0; state.len()];
    system.evaluate(0.0, &state, &mut rates);
    let inertia = assembly.bodies[0].inertia().unwrap();
    // Statics turns by Euler angles without spin (2.16), a motion without speed about its own axis: a moment about
    // the axis works on the tilt about Y by the sine of the other one.
    let section = mounted(&system.bodies[0], &assembly.connections[0].ends[1]);
    let pull = assembly.connections[0].pull([&system.bodies[1], &section], &[]);
    let about_axis = Vector3::from(pull.on[1].moment).dot(&Vector3::from(section.motion.axis));
    let allowed = 1e-9 + (about_axis * found.coordinates[0][4]).abs();
    for i in 0..3 {
        assert!((rates[VELOCITY + i] * inertia.mass).abs() <= 1e-8 * 300.0, "{i}");
        let moment = rates[SPIN + i] * inertia.transverse;
        assert!(moment.abs() <= 1.01 * allowed, "{i}: {moment:e} of {allowed:e}");
    }
    assert!(state[POSITION].abs() > 1e-5);
}

/// The step of a stiff spring between bodies is bound by it, and said so.
#[test]
fn a_stiff_connection_binds_the_step_by_name() {
    let connection = spring();
    for (spring, expected) in
        [(true, "spring between bodies: oscillation"), (false, "dashpot between bodies: motion")]
    {
        let assembly = on_two_bodies(connection.clone(), spring);
        let state = start::nominal(&assembly);
        let mut system = System::new(assembly.clone(), Driver::Lanes);
        let limit = step_limit(&mut system, 0.0, &state).unwrap();
        assert!(limit.reason().starts_with(expected), "{}", limit.reason());
        // Nothing was taken out for good.
        assert_eq!(system.assembly, assembly);
        // The period of two masses on the spring, 2.83/ω of Runge-Kutta.
        if spring {
            let mass = assembly.bodies[0].inertia().unwrap().mass;
            let expected = 2.0 * 2f64.sqrt() / (STIFF * 2.0 / mass).sqrt();
            assert!((limit.step / expected - 1.0).abs() <= 1e-3, "{} {expected}", limit.step);
        }
    }
}

/// N/m.
const STIFF: f64 = 1e12;

/// Two free bodies and, far softer, a bearing between the first and the ground.
fn on_two_bodies(mut connection: Connection, spring: bool) -> Assembly {
    let mut assembly = bearing(crate::common::table_4_1(-5e-6), [0.0; 5], 0.0).assembly();
    assembly.bodies = vec![free("one"), assembly.bodies[1].clone(), free("other")];
    connection.ends = [Mount::at_centre(0), Mount::at_centre(2)];
    connection.law = Law::SpringDashpot(match spring {
        true => SpringDashpot { stiffness: [STIFF, 0.0, 0.0, 0.0, 0.0, 0.0], ..Default::default() },
        false => SpringDashpot { damping: [0.0, 0.0, 1e7, 0.0, 0.0, 0.0], ..Default::default() },
    });
    assembly.connections = vec![connection];
    assembly
}

/// Six springs hold a body as well as springs to the ground do; a torsion spring holds it against twist alone, which is
/// no coordinate of statics.
#[test]
fn what_a_connection_holds_is_determinate() {
    let loaded = Loaded {
        axes: None,
        conditions: [200.0, -100.0, 300.0, 1.5, -2.0].map(Condition::Load),
        springs: [0.0; 5],
        rest: [0.0; 5],
        start: Some([0.0; 5]),
        room: 1.0,
    };
    let named = |name: &str, place| StaticBody { name: name.into(), place };
    let mut statics = StaticAssembly {
        bodies: vec![
            named("body", Place::Loaded(loaded)),
            named("ground", Place::Held(Pose::identity())),
        ],
        connections: vec![spring()],
        ..StaticAssembly::default()
    };
    statics.connections[0].ends = [Mount::at_centre(1), Mount::at_centre(0)];
    let found = solve_assembly(&statics, None, &StaticOptions::default()).unwrap();
    assert_eq!(found.determinacy, Determinacy::Determinate);
    // Stretched by 1e-4 m and 1e-3 rad, so that each spring by itself is right to a hundredth.
    let rest = SPRING.rest;
    for (i, load) in [200.0, -100.0, 300.0].into_iter().enumerate() {
        let stretch = found.coordinates[0][i] - rest[i];
        assert!((stretch * SPRING.stiffness[i] / load - 1.0).abs() <= 1e-2, "{i}: {stretch}");
    }
}
