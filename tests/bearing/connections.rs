//! Laws that every kind of connection keeps: action and reaction, loads as slopes of an energy, power as what is
//! stored and lost, rows as differences, nothing where there is nothing.

use crate::dynamics;

use bearing_dynamics::members::connection::{
    Connection, CrossCoupling, Law, MaxwellElement, SpringDashpot, Torsion,
};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::rigid_body::{BodyKinematics, kinematics_at_mount};
use bearing_dynamics::members::state::BodyState;
use dynamics::*;
use nalgebra::{UnitQuaternion, Vector3};

/// One of every kind, all of it at work.
pub fn kinds() -> Vec<Connection> {
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

pub const SPRING: SpringDashpot = SpringDashpot {
    stiffness: [2e6, 3e6, 5e6, 40.0, 900.0, 700.0],
    damping: [200.0, 100.0, 300.0, 0.05, 0.4, 0.7],
    rest: [1e-3, -2e-3, 0.5e-3],
    wall: None,
    cross: CrossCoupling { stiffness: [0.0; 2], damping: [0.0; 2] },
    maxwell: Vec::new(),
};

/// Of a journal bearing: cross-coupled, partly circulatory.
fn crossed() -> Connection {
    let cross = CrossCoupling { stiffness: [1.3e6, -0.4e6], damping: [30.0, -170.0] };
    let law = Law::SpringDashpot(SpringDashpot { cross, ..SPRING });
    Connection { name: "cross".into(), law, ..spring() }
}

pub fn spring() -> Connection {
    kinds().remove(0)
}

/// Two bodies in any motion, turned by about `turn` rad.
pub fn pair(seed: u64, turn: f64) -> [BodyKinematics; 2] {
    let mut noise = Noise(seed);
    [(); 2].map(|()| {
        BodyKinematics::new(BodyState {
            position: noise.vector(2e-3),
            orientation: noise.turn(turn),
            velocity: noise.vector(0.5),
            spin: noise.vector(20.0),
        })
    })
}

fn ends(connection: &Connection, bodies: &[BodyKinematics; 2]) -> [BodyKinematics; 2] {
    connection.ends.map(|mount| kinematics_at_mount(&bodies[mount.body], &mount))
}

/// Elongations of its Maxwell elements, some tenths of a millimetre, a `time` after `bodies`.
fn elongated(connection: &Connection, bodies: &[BodyKinematics; 2], time: f64) -> Vec<f64> {
    let ends = ends(connection, bodies);
    let rates = connection.forces([&ends[0], &ends[1]], &[]).rates;
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
fn pull(
    connection: &Connection,
    bodies: &[BodyKinematics; 2],
) -> ([[Vector3<f64>; 2]; 2], f64, f64) {
    pull_at(connection, bodies, &elongated(connection, bodies, 0.0))
}

fn pull_at(
    connection: &Connection,
    bodies: &[BodyKinematics; 2],
    elongated: &[f64],
) -> ([[Vector3<f64>; 2]; 2], f64, f64) {
    let ends = ends(connection, bodies);
    let pull = connection.forces([&ends[0], &ends[1]], elongated);
    let on = [0, 1].map(|end| {
        let arm = Vector3::from(ends[end].motion.position)
            - Vector3::from(bodies[connection.ends[end].body].motion.position);
        let force = Vector3::from(pull.on[end].force);
        [force, Vector3::from(pull.on[end].moment) + arm.cross(&force)]
    });
    (on, pull.energy, pull.loss)
}

/// Bodies as they are after going on for a time at their velocities.
fn after(bodies: &[BodyKinematics; 2], time: f64) -> [BodyKinematics; 2] {
    bodies.map(|body| {
        let mut state = body.state;
        let by = |v: [f64; 3]| Vector3::from(v) * time;
        state.position = (Vector3::from(state.position) + by(state.velocity)).into();
        state.orientation = UnitQuaternion::from_scaled_axis(by(state.spin)) * state.orientation;
        BodyKinematics::new(state)
    })
}

#[test]
fn what_one_end_gets_the_other_gets_too() {
    for connection in kinds().into_iter().chain([crossed()]) {
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
    for connection in kinds().into_iter().chain([crossed()]) {
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
            assert!(loss < 0.0 || connection.cross().is_some());
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
                BodyKinematics::new(BodyState {
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
        let bodies = bodies.map(|body| BodyKinematics::new(body.state));
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
                        pull_at(&connection, &all.map(|body| BodyKinematics::new(body.state)), &[])
                            .0
                    };
                    let (high, low) = (load(step), load(-step));
                    for end in 0..2 {
                        for part in 0..6 {
                            let of = |of: &[[Vector3<f64>; 2]; 2]| of[end][part / 3][part % 3];
                            let slope = (of(&high) - of(&low)) / (2.0 * step);
                            let lever = |row: &bearing_dynamics::members::connection::Row,
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
    let ground = BodyKinematics::new(BodyState {
        orientation: UnitQuaternion::identity(),
        ..pair(1, 0.0)[0].state
    });
    let ground = BodyKinematics::new(BodyState {
        position: [0.0; 3],
        velocity: [0.0; 3],
        spin: [0.0; 3],
        ..ground.state
    });
    let moment = |angle: f64| {
        let spun = tilt * UnitQuaternion::from_scaled_axis(Vector3::x() * angle);
        let spin = (spun * Vector3::x() * 600.0).into();
        let state = BodyState { orientation: spun, spin, ..ground.state };
        let (on, energy, loss) = pull(&connection, &[ground, BodyKinematics::new(state)]);
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
