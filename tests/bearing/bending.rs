//! Shafts that bend: natural frequencies and whirl against the whole beam, balance, invariance, and the rigid shaft
//! as their limit.

use crate::common;
use crate::dynamics;
use crate::shafts;

use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::solver::dynamics::assembly::{Assembly, GROUND, Mobility};
use bearing_dynamics::solver::dynamics::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::solver::dynamics::contacts::Driver;
use bearing_dynamics::solver::dynamics::model::{Drive, RaceBody, Rotation};
use bearing_dynamics::solver::dynamics::run::{
    Integrator, RunOptions, Simulation, Start, Stepping,
};
use bearing_dynamics::solver::dynamics::shaft::{ElasticShaft, Section, ShaftLoad, Unbalance};
use bearing_dynamics::solver::dynamics::stability::jacobian;
use bearing_dynamics::solver::dynamics::start;
use bearing_dynamics::solver::dynamics::state::{POSITION, SPIN, VELOCITY};
use bearing_dynamics::solver::dynamics::system::System;
use bearing_dynamics::solver::mount::Mount;
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::rotor::beam::{Beam, BeamDisc, BeamMatrices, BeamSegment, STATION};
use bearing_dynamics::solver::shaft_shapes::{Kept, free_shaft};
use common::table_4_1;
use dynamics::*;
use nalgebra::{Complex, DMatrix, DVector, Schur};
use shafts::{body, seated};
use std::f64::consts::TAU;

/// 30 mm steel, 400 mm, in eight elements, with a disc.
fn beam(disc: BeamDisc, youngs_modulus: f64) -> Beam {
    let segment = BeamSegment {
        length: 0.4,
        outer_diameter: 30e-3,
        inner_diameter: 0.0,
        density: 7850.0,
        youngs_modulus,
        poisson_ratio: 0.3,
    };
    Beam { discs: vec![disc], longest_element: 0.0501, ..Beam::new(vec![segment]) }
}

const STEEL: f64 = 210e9;
const OVERHUNG: BeamDisc = BeamDisc { at: 0.4, mass: 3.0, axial: 0.02, transverse: 0.011 };
const MIDDLE: BeamDisc = BeamDisc { at: 0.2, mass: 20.0, axial: 0.09, transverse: 0.05 };

/// An assembly of the shaft alone, turning at `speed` (rad/s), its sections at `holds` (m from its end) asked for.
fn alone(beam: &Beam, kept: Kept, holds: &[f64], speed: f64) -> Assembly {
    let holds: Vec<(f64, bool)> = holds.iter().map(|at| (*at, true)).collect();
    let (rigid, shapes) = free_shaft(beam, kept, &holds).unwrap();
    let inertia = Inertia { mass: rigid.mass, axial: rigid.axial, transverse: rigid.transverse };
    let spinning = race([0.0; 5], Rotation::Speed(Profile::Constant(speed)));
    let spinning = RaceBody { inertia, ..spinning };
    Assembly {
        bodies: vec![
            body(
                "the shaft",
                Mobility::Driven(spinning.into()),
                [rigid.centre, 0.0, 0.0, 0.0, 0.0],
            ),
            body(GROUND, Mobility::Fixed, [0.0; 5]),
        ],
        shafts: vec![ElasticShaft { shapes, ..ElasticShaft::default() }],
        ..Assembly::default()
    }
}

/// From the body's centre to `at` from the shaft's end, m.
fn along(assembly: &Assembly, at: f64) -> f64 {
    at - assembly.bodies[0].rest[0]
}

fn section(assembly: &Assembly, at: f64) -> Section {
    assembly.shafts[0].shapes.section(along(assembly, at))
}

/// Puts the shaft on springs to the ground at these places (m from its end).
fn on_springs(assembly: &mut Assembly, places: &[f64], stiffness: [f64; 3]) {
    for &at in places {
        let [x, y, z] = stiffness;
        let law = SpringDashpot { stiffness: [x, y, z, 0.0, 0.0, 0.0], ..Default::default() };
        let shaft = Mount { along: along(assembly, at), ..Mount::at_centre(0) };
        let ground = Mount { along: at, ..Mount::at_centre(1) };
        assembly.connections.push(Connection {
            name: "a spring".into(),
            label: None,
            ends: [ground, shaft],
            law: Law::SpringDashpot(law),
        });
    }
}

/// Frequencies (rad/s) of the motion that `assembly` makes about its place at rest, in order.
fn frequencies(assembly: &Assembly) -> Vec<f64> {
    let state = start::nominal(assembly);
    let mut system = System::new(assembly.clone(), Driver::Plain);
    positive(jacobian(&mut system, 0.0, &state))
}

fn positive(matrix: DMatrix<f64>) -> Vec<f64> {
    let eigenvalues = Schur::new(matrix).complex_eigenvalues();
    let mut all: Vec<f64> =
        eigenvalues.iter().map(|value: &Complex<f64>| value.im).filter(|im| *im > 1.0).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// Those of the whole beam on springs across it (N/m) at these stations, turning at `speed`.
fn whole(beam: &BeamMatrices, springs: &[f64], stiffness: [f64; 2], speed: f64) -> Vec<f64> {
    let size = beam.mass.nrows();
    let mut springy = beam.stiffness.clone();
    for &at in springs {
        let first = STATION * beam.station(at).unwrap();
        for (i, stiffness) in stiffness.into_iter().enumerate() {
            springy[(first + i, first + i)] += stiffness;
        }
    }
    let inverse = beam.mass.clone().try_inverse().unwrap();
    let mut first_order = DMatrix::zeros(2 * size, 2 * size);
    first_order.view_mut((0, size), (size, size)).fill_with_identity();
    first_order.view_mut((size, 0), (size, size)).copy_from(&(-(&inverse * springy)));
    let gyroscopic = -(&inverse * &beam.gyroscopic) * speed;
    first_order.view_mut((size, size), (size, size)).copy_from(&gyroscopic);
    positive(first_order)
}

/// Shapes and rigid motions together ring at the frequencies of the whole beam, forward and backward whirl apart, also
/// where the centre of mass lies far from the middle and springs differ across; few shapes and static answers do for
/// the low ones.
#[test]
fn a_spinning_shaft_rings_as_the_whole_beam() {
    let speed = 10_000.0 * RPM;
    let holds = [0.0, 0.3];
    for (disc, stiffness) in
        [(OVERHUNG, [1e7, 4e7, 4e7]), (OVERHUNG, [1e7, 2e7, 9e7]), (MIDDLE, [1e7, 1e10, 1e10])]
    {
        let beam = beam(disc, STEEL);
        let matrices = beam.matrices(&holds).unwrap();
        let [_, y, z] = stiffness;
        let expected = whole(&matrices, &holds, [y, z], speed);
        for (kept, tolerance) in [(Kept::ALL, 2e-5), (Kept { most: 3, ..Kept::ALL }, 2e-3)] {
            let mut assembly = alone(&beam, kept, &holds, speed);
            on_springs(&mut assembly, &holds, stiffness);
            let along_axis =
                (2.0 * stiffness[0] / assembly.bodies[0].inertia().unwrap().mass).sqrt();
            let mut ours = frequencies(&assembly);
            // The motion along the axis is the rigid body's own.
            let axial = ours.iter().position(|w| (w / along_axis - 1.0).abs() < 1e-6).unwrap();
            ours.remove(axial);
            let count = assembly.shafts[0].count();
            println!("{count} shapes: {:?} for {:?}", &ours[..4], &expected[..4]);
            for (ours, expected) in ours.iter().zip(&expected).take(6) {
                assert!((ours / expected - 1.0).abs() <= tolerance, "{ours} for {expected}");
            }
            // The planes would ring alike but for the spin.
            assert!(ours[1] / ours[0] > 1.005, "{:?}", &ours[..2]);
        }
    }
}

/// What a static load bends is exact with one natural shape: the static answers do the rest.
#[test]
fn static_answers_make_few_shapes_exact_at_rest() {
    let beam = beam(MIDDLE, STEEL);
    let holds = [0.0, 0.2, 0.4];
    let load = [500.0, -1000.0, 500.0];
    let matrices = beam.matrices(&holds).unwrap();
    let deflection = |kept| {
        let mut assembly = alone(&beam, kept, &holds, 0.0);
        let mut pushes = vec![0.0; 2 * assembly.shafts[0].count()];
        let sections = holds.map(|at| section(&assembly, at));
        for (section, load) in sections.iter().zip(load) {
            for (k, push) in pushes.iter_mut().enumerate().take(assembly.shafts[0].count()) {
                *push += load * section.deflection[k];
            }
        }
        let shapes = &mut assembly.shafts[0].shapes;
        let rest = pushes.iter().zip(&shapes.frequencies).map(|(push, w)| push / (w * w));
        let rest: Vec<f64> = rest.collect();
        let at = |i: usize| -> f64 {
            sections[i].deflection.iter().zip(&rest).map(|(shape, gone)| shape * gone).sum()
        };
        at(1) - 0.5 * (at(0) + at(2))
    };
    // Held at both ends, pushed in the middle.
    let coordinates: Vec<usize> = (0..matrices.mass.nrows())
        .filter(|i| matches!(i % STATION, 0 | 3) && *i != 0 && *i != matrices.mass.nrows() - 4)
        .collect();
    let size = coordinates.len();
    let stiffness =
        DMatrix::from_fn(size, size, |i, j| matrices.stiffness[(coordinates[i], coordinates[j])]);
    let middle =
        coordinates.iter().position(|i| *i == STATION * matrices.station(0.2).unwrap()).unwrap();
    let mut force = DVector::zeros(size);
    force[middle] = -1000.0;
    let expected = stiffness.lu().solve(&force).unwrap()[middle];
    for most in [0, 1, 5] {
        let ours = deflection(Kept { most, ..Kept::ALL });
        assert!((ours / expected - 1.0).abs() <= 1e-9, "{most}: {ours:e} for {expected:e}");
    }
}

fn unbalanced(size: f64, assembly: &Assembly, at: f64) -> Unbalance {
    Unbalance { section: section(assembly, at), size, angle: 0.4 }
}

fn run(assembly: Assembly, integrator: Integrator, stepping: Stepping, end: f64) -> Simulation {
    let options =
        RunOptions { start: Start::Nominal, integrator, stepping, ..RunOptions::default() };
    let mut simulation = Simulation::new(assembly, options).unwrap();
    simulation.snapshot().unwrap();
    while simulation.time < end * (1.0 - 1e-12) {
        let step = simulation.step_size.min(end - simulation.time);
        simulation.step_by(step).unwrap();
    }
    simulation.snapshot().unwrap();
    simulation
}

/// Off the axis at a place, m.
fn off(simulation: &Simulation, at: f64) -> f64 {
    let assembly = &simulation.system.assembly;
    let section = section(assembly, at);
    let [_, y, z] = simulation.system.section_now(&simulation.state, 0, &section).state.position;
    y.hypot(z)
}

/// Far below and above its critical speed a damped rotor answers an unbalance as the linear beam does.
#[test]
fn unbalance_response_below_and_above_critical() {
    let beam = beam(MIDDLE, STEEL);
    let holds = [0.0, 0.2, 0.4];
    for (rpm, damping) in [(3000.0, 800.0), (8000.0, 800.0)] {
        let speed = rpm * RPM;
        let mut assembly = alone(&beam, Kept { most: 3, ..Kept::ALL }, &holds, speed);
        on_springs(&mut assembly, &[0.0, 0.4], [1e7, 1e9, 1e9]);
        assembly.shafts[0].damping = damping;
        let unbalance = unbalanced(1e-3, &assembly, 0.2);
        assembly.shafts[0].unbalances.push(unbalance);
        // (2.7) brakes all motion: bending and, by dashpots to the ground, the rigid part.
        let Inertia { mass, transverse, .. } = *assembly.bodies[0].inertia().unwrap();
        assembly.bodies[0].driven_mut().unwrap().foundation_damping =
            [mass, mass, mass, transverse, transverse].map(|inertia| damping * inertia);
        // The same equations of small motion: rigid shift and symmetric shapes, in a plane.
        let shaft = &assembly.shafts[0];
        let mass = assembly.bodies[0].inertia().unwrap().mass;
        let sections = [0.0, 0.4, 0.2].map(|at| section(&assembly, at));
        let size = 2 + shaft.count();
        let row = |section: &Section| {
            let rigid = [1.0, section.along];
            let all = rigid.into_iter().chain(section.deflection.iter().copied());
            DVector::from_iterator(size, all)
        };
        let Inertia { axial, transverse, .. } = *assembly.bodies[0].inertia().unwrap();
        let mut dynamic = DMatrix::<Complex<f64>>::zeros(size, size);
        // Forward whirl e^{iΩt}: gyroscopic terms count as −Ω² J beside Ω² M.
        let turns = |i: usize, j: usize| match (i, j) {
            (1, 1) => axial,
            (1, k) | (k, 1) if k > 1 => shaft.shapes.tilt_coupling[k - 2],
            (i, j) if i > 1 && j > 1 => shaft.shapes.gyroscopic[(i - 2) * shaft.count() + j - 2],
            _ => 0.0,
        };
        for i in 0..size {
            let own = [mass, transverse].get(i).copied().unwrap_or(1.0);
            let spring = if i < 2 { 0.0 } else { shaft.shapes.frequencies[i - 2].powi(2) };
            let damped = damping * own * speed;
            dynamic[(i, i)] += Complex::new(spring - speed * speed * own, damped);
            for j in 0..size {
                dynamic[(i, j)] += speed * speed * turns(i, j);
            }
        }
        for held in &sections[..2] {
            let row = row(held);
            dynamic += (&row * row.transpose() * 1e9).map(|value| Complex::new(value, 0.0));
        }
        let push = row(&sections[2]) * (1e-3 * speed * speed);
        let answer = dynamic.lu().solve(&push.map(|value| Complex::new(value, 0.0))).unwrap();
        let expected = row(&sections[2]).map(|value| Complex::new(value, 0.0)).dot(&answer).norm();
        let simulation = run(assembly, Integrator::RungeKutta, Stepping::Fixed(4e-6), 0.08);
        let ours = off(&simulation, 0.2);
        println!("{rpm} rpm: {ours:e} m, linear {expected:e} m");
        // What the start has set ringing is down to e^(−32).
        assert!((ours / expected - 1.0).abs() <= 1e-4, "{ours:e} {expected:e}");
    }
}

/// The rotor of 4.3.4 on two bearings, at a speed that rises.
fn on_bearings(speed: Profile, youngs_modulus: f64) -> Assembly {
    let beam = beam(MIDDLE, youngs_modulus);
    let mut assembly = alone(&beam, Kept { most: 4, ..Kept::ALL }, &[0.0, 0.2, 0.4], 0.0);
    assembly.bodies[0].driven_mut().unwrap().rotation = Rotation::Speed(speed);
    assembly.bodies[1].rest = [0.0; 5];
    assembly.bodies.push(body("the other outer race", Mobility::Fixed, [0.4, 0.0, 0.0, 0.0, 0.0]));
    let ends = [along(&assembly, 0.0), along(&assembly, 0.4)];
    let geometry = table_4_1(-2e-6);
    assembly.bearings = vec![
        seated(geometry, "left", ends[0], false, 1),
        seated(geometry, "right", ends[1], false, 2),
    ];
    assembly
}

fn rising(to: f64, within: f64) -> Profile {
    Profile::Ramp { from: 0.0, to, start: 0.0, duration: within }
}

/// Every integrator goes the same way through the first critical speed.
#[test]
fn all_methods_bend_a_shaft_the_same_way() {
    let mut assembly = on_bearings(rising(6000.0 * RPM, 20e-3), STEEL);
    let unbalance = unbalanced(5e-4, &assembly, 0.2);
    assembly.shafts[0].unbalances.push(unbalance);
    for bearing in &mut assembly.bearings {
        bearing.traction = CONSTANT;
    }
    let end = |integrator, stepping| {
        let simulation = run(assembly.clone(), integrator, stepping, 20e-3);
        let counts = (simulation.steps, simulation.system.work.evaluations);
        println!("{integrator:?}: {counts:?}, {:e} m", off(&simulation, 0.2));
        off(&simulation, 0.2)
    };
    let reference = end(Integrator::DormandPrince, Stepping::Accuracy(1e-5));
    assert!(reference > 5e-6, "{reference:e}");
    for (integrator, stepping) in [
        (Integrator::RungeKutta, Stepping::Fixed(4e-7)),
        (Integrator::Rosenbrock, Stepping::Accuracy(1e-4)),
    ] {
        let ours = end(integrator, stepping);
        assert!((ours / reference - 1.0).abs() <= 1e-3, "{ours:e} {reference:e}");
    }
}
