//! Accelerometers on bodies, against differences of where they are.

use crate::{common, dynamics};

use crate::bent_shafts::{OVERHUNG, STEEL, alone, beam, on_springs, section, unbalanced};
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::ch5_cage::telemeter::Telemeter;
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::flexible_shaft::Section;
use bearing_dynamics::members::reduced_solid::ReducedSolid;
use bearing_dynamics::members::rigid_body::BodyKinematics;
use bearing_dynamics::members::sensor::{
    Accelerometer, Acquisition, CageTelemeter, NodeAccelerometer, Sensor, SensorKind, SensorMount,
};
use bearing_dynamics::members::shaft_modes::Kept;
use bearing_dynamics::members::state::{BODY, BodyState, Layout};
use bearing_dynamics::motion::simulation::{Simulation, Start};
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use common::table_4_1;
use dynamics::*;
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::PI;

fn sensor(kind: SensorKind) -> Sensor {
    Sensor { name: "a".into(), kind, acquisition: Acquisition::default() }
}

/// A body that swings and turns about a direction that stays, at a time.
fn body(t: f64) -> BodyState {
    let about = Vector3::new(0.6, 0.0, 0.8);
    let turned = 0.4 + 9.0 * t + 25.0 * t * t;
    BodyState {
        position: [1e-3 * (30.0 * t).sin(), 2e-3 * t * t, 5e-4 * (50.0 * t).cos()],
        orientation: UnitQuaternion::from_scaled_axis(turned * about),
        velocity: [0.03 * (30.0 * t).cos(), 4e-3 * t, -0.025 * (50.0 * t).sin()],
        spin: ((9.0 + 50.0 * t) * about).into(),
    }
}

#[test]
fn an_accelerometer_feels_how_its_place_is_accelerated() {
    let sensor = Accelerometer {
        mount: SensorMount::Body(0),
        place: [0.02, 0.03, -0.01],
        direction: [0.0, 0.8, 0.6],
        fixed: false,
    };
    let fixed = Accelerometer { fixed: true, ..sensor.clone() };
    let place = |t: f64| {
        let now = body(t);
        Vector3::from(now.position) + now.orientation * Vector3::from(sensor.place)
    };
    for t in [0.0, 0.07, 0.2] {
        let step = 1e-4;
        let acceleration = (place(t + step) - 2.0 * place(t) + place(t - step)) / (step * step);
        let direction = body(t).orientation * Vector3::from(sensor.direction);
        let linear = [-0.9 * (30.0 * t).sin(), 4e-3, -1.25 * (50.0 * t).cos()];
        let turning: Vector3<f64> = 50.0 * Vector3::new(0.6, 0.0, 0.8);
        let felt = sensor.read(&BodyKinematics::new(body(t)), linear, turning.into());
        // Differences over 1e-4 s of motions of 50 1/s, and rounding of 0.04 m over 1e-8 s².
        let error = (felt - acceleration.dot(&direction)).abs();
        assert!(error <= 1e-4, "{felt} for {}, {error:e}", acceleration.dot(&direction));
        let felt = fixed.read(&BodyKinematics::new(body(t)), linear, turning.into());
        let error = (felt - acceleration.dot(&Vector3::from(sensor.direction))).abs();
        assert!(error <= 1e-4, "fixed direction: {felt}, {error:e}");
    }
}

/// Body `body` of a bearing's races in a state.
fn race_of(simulation: &Simulation, body: usize) -> BodyState {
    let layout = &simulation.system.sets[0].layout;
    BodyState::from_slice(&simulation.state[[layout.inner(), layout.outer()][body]..])
}

#[test]
fn what_a_sensor_reads_is_how_the_run_goes_on() {
    // Mean acceleration over two steps, from the velocities at their ends.
    let mut problem = bearing(table_4_1(-5e-6), [50.0, 0.0, -800.0, 0.0, 0.0], 1000.0 * RPM);
    problem.unbalance = 1e-4;
    let mut outer = free_race();
    outer.foundation_stiffness = [1e8, 1e8, 1e8, 1e4, 1e4];
    problem.outer = Some(outer);
    let places = [[0.01, 0.0, 0.03], [0.0, 0.04, 0.0]];
    let step = 1e-7;
    let mut simulation = simulation(&problem, step, Start::Nominal);
    run(&mut simulation, 500);
    let velocities = |simulation: &Simulation| {
        [0, 1].map(|body: usize| {
            let state = race_of(simulation, body);
            let arm = state.orientation * Vector3::from(places[body]);
            Vector3::from(state.velocity) + Vector3::from(state.spin).cross(&arm)
        })
    };
    let before = velocities(&simulation);
    run(&mut simulation, 1);
    simulation.snapshot();
    let felt = [0, 1].map(|body: usize| {
        Vector3::from([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|direction| {
            let mount = SensorMount::Body(body);
            let of = Accelerometer { mount, place: places[body], direction, fixed: false };
            sensor(SensorKind::Accelerometer(of)).read(
                &simulation.system,
                &simulation.state,
                simulation.rates(),
            )
        }))
    });
    let orientations = [0, 1].map(|body| race_of(&simulation, body).orientation);
    run(&mut simulation, 1);
    let behind = velocities(&simulation);
    for body in 0..2 {
        let mean = (behind[body] - before[body]) / (2.0 * step);
        let mean = orientations[body].inverse() * mean;
        assert!(mean.norm() > 1.0, "nothing is accelerated: {mean}");
        // Contacts swing at some 1e4 1/s: (1e-7 · 1e4)² over the two steps; velocities are rounded.
        let error = (felt[body] - mean).norm();
        assert!(error <= 1e-4 * mean.norm(), "body {body}: {} for {mean}", felt[body]);
    }
}

#[test]
fn a_telemeter_reads_where_the_cage_is_from_its_outer_race() {
    let mut problem = bearing(table_4_1(5e-6), [0.0; 5], 0.0);
    problem.outer = Some(free_race());
    problem.cage = Some(cage(&problem.geometry, Pocket::Cylindrical, Guidance::OuterRace));
    let layout = Layout::new(8, true);
    let circuit = Telemeter {
        radius: 0.03,
        transceiver_radius: 0.031,
        wire_radius: 2e-4,
        capacitance: 1e-10,
        resistance: [0.3; 2],
        frequency: 33e6,
    };
    let (distance, offset, runout) = (4e-3, [1e-3, -5e-4], [7e-4, 0.0]);
    let of = CageTelemeter { bearing: 0, circuit, distance, offset, runout };
    let sensor = sensor(SensorKind::Telemeter(of));
    // Put in the other way round the transceiver is on the other side, and the cage begins half a turn about Z away.
    for reversed in [false, true] {
        let mut assembly = problem.assembly();
        assembly.bearings[0].mounts.iter_mut().for_each(|mount| mount.reversed = reversed);
        let mut state = start::nominal(&problem.assembly());
        let mut put = |at: usize, position: [f64; 3], orientation: UnitQuaternion<f64>| {
            let mut body = BodyState::from_slice(&state[at..]);
            (body.position, body.orientation) = (position, orientation);
            state[at..at + BODY].copy_from_slice(&body.to_array());
        };
        let about = |axis: [f64; 3], angle: f64| {
            UnitQuaternion::from_scaled_axis(angle * Vector3::from(axis))
        };
        let round = about([0.0, 0.0, 1.0], if reversed { PI } else { 0.0 });
        put(layout.outer(), [2e-4, -1e-4, 3e-4], UnitQuaternion::identity());
        // A quarter turn takes a runout along Y to Z.
        put(layout.cage(), [-1e-4, 2e-4, 1e-4], about([1.0, 0.0, 0.0], 0.5 * PI) * round);
        let mut system = System::new(assembly, Kernel::Simd);
        let mut rates = vec![0.0; state.len()];
        system.evaluate(0.0, &state, &mut rates);
        let read = sensor.read(&system, &state, &rates);
        let along = if reversed { 3e-4 } else { -3e-4 };
        let centre = [along - 4e-3, 3e-4 - 1e-3, -2e-4 + 7e-4 + 5e-4];
        let expected = circuit.signal(centre, [1.0, 0.0, 0.0]);
        assert!((read - expected).abs() <= 1e-12, "{reversed}: {read} {expected}");
    }
}

/// Velocity of a place on a section of the shaft, whose axes are those of the section.
fn velocity_on(system: &System, state: &[f64], section: &Section, place: [f64; 3]) -> Vector3<f64> {
    let now = system.section_now(state, 0, section).state;
    let arm = now.orientation * Vector3::from(place);
    Vector3::from(now.velocity) + Vector3::from(now.spin).cross(&arm)
}

#[test]
fn an_accelerometer_on_a_flexible_shaft_feels_how_its_section_is_accelerated() {
    let mut assembly =
        alone(&beam(OVERHUNG, STEEL), Kept { most: 3, ..Kept::ALL }, &[0.0, 0.4], 300.0);
    on_springs(&mut assembly, &[0.1, 0.3], [1e6, 5e7, 3e7]);
    let unbalance = unbalanced(1e-3, &assembly, 0.4);
    assembly.shafts[0].unbalances.push(unbalance);
    assembly.shafts[0].damping = 20.0;
    let section = section(&assembly, 0.4);
    let layout = start::nominal(&assembly);
    let mut system = System::new(assembly, Kernel::Simd);
    // Amplitudes and rates of all coordinates, so that no term is zero: bent by a degree, tilted by half of one.
    let mut random = Noise(7);
    let mut state = layout;
    let body = system.places.body(0);
    let mut of = BodyState::from_slice(&state[body..]);
    of.orientation = UnitQuaternion::from_scaled_axis(Vector3::new(1.3, 6e-3, -9e-3));
    of.velocity = random.vector(0.2);
    of.spin = [300.0, 4.0, -3.0];
    state[body..body + BODY].copy_from_slice(&of.to_array());
    let (first, count) = (system.shafts[0], system.assembly.shafts[0].amplitudes());
    for k in 0..count {
        state[first + k] = 1e-3 * random.next();
        state[first + count + k] = 0.8 * random.next();
    }
    let mut rates = vec![0.0; state.len()];
    system.evaluate(0.0, &state, &mut rates);
    let place = [0.0, 0.02, 0.01];
    let step = 1e-6;
    let moved = |by: f64| -> Vec<f64> {
        state.iter().zip(&rates).map(|(of, rate)| of + by * rate).collect()
    };
    let [before, after] = [-step, step].map(|by| velocity_on(&system, &moved(by), &section, place));
    let expected = (after - before) / (2.0 * step);
    let felt =
        Vector3::from([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|direction| {
            let mount = SensorMount::Section(0, Box::new(section.clone()));
            let of = Accelerometer { mount, place, direction, fixed: true };
            sensor(SensorKind::Accelerometer(of)).read(&system, &state, &rates)
        }));
    assert!(expected.norm() > 1e3, "{expected}");
    // Third order in the rotation of the section, 0.01 rad: 1e-6 of the acceleration; differences: (300 · 1e-6)².
    let error = (felt - expected).norm();
    assert!(error <= 1e-6 * expected.norm(), "{felt} for {expected}, {error:e}");
}

#[test]
fn an_accelerometer_on_a_housing_feels_its_modes() {
    let mut assembly =
        alone(&beam(OVERHUNG, STEEL), Kept { most: 1, ..Kept::ALL }, &[0.0, 0.4], 0.0);
    assembly.solids.push(ReducedSolid {
        frequencies: vec![1000.0, 3000.0],
        weight: vec![2.0, -1.0],
        start: vec![0.0; 2],
        ..ReducedSolid::default()
    });
    assembly.gravity = [0.0, 0.0, -9.81];
    let mut system = System::new(assembly.clone(), Kernel::Simd);
    let mut state = start::nominal(&assembly);
    let first = system.solids[0];
    (state[first], state[first + 1]) = (2e-5, -1e-5);
    let mut rates = vec![0.0; state.len()];
    system.evaluate(0.0, &state, &mut rates);
    let of = |modes| NodeAccelerometer {
        bearing: 0,
        place: [0.0; 3],
        direction: [0.0, 0.0, 1.0],
        modes,
    };
    let read = |modes| sensor(SensorKind::Node(of(modes))).read(&system, &state, &rates);
    let accelerations = [rates[first + 2], rates[first + 3]];
    // q̈ = f − ω² q.
    assert!((accelerations[0] - (2.0 - 20.0)).abs() <= 1e-9, "{accelerations:?}");
    let expected = 0.3 * accelerations[0] - 0.7 * accelerations[1];
    let found = read(Some((0, vec![0.3, -0.7])));
    assert!((found - expected).abs() <= 1e-12, "{found} {expected}");
    assert!(read(None).is_nan(), "before the housing is reduced");
}
