//! Shafts that bend: natural frequencies and whirl against the whole beam, balance, invariance, and the rigid shaft
//! as their limit.

use crate::bent_shafts::{
    MIDDLE, OFF_MIDDLE, OVERHUNG, STEEL, alone, along, beam, loaded, off, on_bearings, on_springs,
    rising, run, section, unbalanced,
};
use crate::dynamics;

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::inertia::{Inertia, hollow_cylinder};
use bearing_dynamics::members::beam::{BeamMatrices, STATION};
use bearing_dynamics::members::body::{Drive, DrivenBody, Mobility, Rotation};
use bearing_dynamics::members::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::flexible_shaft::{ElasticShaft, Section, ShaftSteps};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::rigid_body;
use bearing_dynamics::members::shaft_modes::{Kept, ShaftShapes};
use bearing_dynamics::members::state::{SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{Integrator, Simulation, Start, Stepping};
use bearing_dynamics::motion::stability::jacobian;
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::plan::counts::Counts;
use bearing_dynamics::plan::{Stage, Subject};
use dynamics::*;
use nalgebra::{Complex, DMatrix, DVector, Vector3};

/// The eigenvalue (rad/s) of the motion about its place at rest that is nearest to `frequency`, by inverse iteration.
fn nearest(motion: &DMatrix<Complex<f64>>, frequency: f64) -> Complex<f64> {
    let size = motion.nrows();
    let shift = Complex::new(0.0, frequency * (1.0 + 1e-4));
    let factors = (motion - DMatrix::identity(size, size) * shift).lu();
    let mut vector =
        DVector::from_fn(size, |i, _| Complex::new(1.0 + (i as f64).sin(), (i as f64).cos()));
    let mut growth = Complex::new(1.0, 0.0);
    for _ in 0..30 {
        let next = factors.solve(&vector).unwrap();
        growth = vector.dotc(&next) / vector.dotc(&vector);
        vector = &next / Complex::new(next.norm(), 0.0);
    }
    shift + growth.inv()
}

/// Frequencies (rad/s) of the whole beam on springs across it (N/m) at these stations, turning at `speed`, in order: with
/// z = (√M q̇, Lᵀ q) and K = L Lᵀ the motion is skew-symmetric.
fn whole(beam: &BeamMatrices, springs: &[f64], stiffness: [f64; 2], speed: f64) -> Vec<f64> {
    let size = beam.mass.nrows();
    let mut springy = beam.stiffness.clone();
    for &at in springs {
        let first = STATION * beam.station(at).unwrap();
        for (i, stiffness) in stiffness.into_iter().enumerate() {
            springy[(first + i, first + i)] += stiffness;
        }
    }
    let mass = beam.mass.clone().cholesky().unwrap().l();
    let over = |of: &DMatrix<f64>| mass.solve_lower_triangular(of).unwrap();
    let springs = over(&springy.cholesky().unwrap().l());
    let gyroscopic = over(&over(&beam.gyroscopic).transpose()).transpose() * speed;
    let mut skew = DMatrix::zeros(2 * size, 2 * size);
    skew.view_mut((0, 0), (size, size)).copy_from(&(-gyroscopic));
    skew.view_mut((0, size), (size, size)).copy_from(&-&springs);
    skew.view_mut((size, 0), (size, size)).copy_from(&springs.transpose());
    let squares = (skew.transpose() * &skew).symmetric_eigenvalues();
    let mut all: Vec<f64> = squares.iter().map(|square| square.sqrt()).collect();
    all.sort_by(f64::total_cmp);
    // Each is there twice.
    all.chunks(2).map(|pair| pair[0]).collect()
}

/// Shapes and rigid motions together ring at the frequencies of the whole beam, forward and backward whirl apart, also
/// where the centre of mass lies far from the middle and springs differ across; few shapes and static answers do for
/// the low ones.
#[test]
fn a_spinning_shaft_rings_as_the_whole_beam() {
    let speed = 10_000.0 * RPM;
    let holds = [0.0, 0.2];
    for (disc, stiffness) in [(OVERHUNG, [1e7, 2e7, 9e7]), (OFF_MIDDLE, [1e7, 1e10, 1e10])] {
        let beam = beam(disc, STEEL);
        let matrices = beam.matrices(&holds).unwrap();
        let [_, y, z] = stiffness;
        let expected = whole(&matrices, &holds, [y, z], speed);
        // All shapes differ by what the differences of the Jacobian lose, three by what they leave out.
        for (kept, count, tolerance) in
            [(Kept::ALL, 6, 1e-7), (Kept { most: 3, ..Kept::ALL }, 4, 1e-4)]
        {
            let mut assembly = alone(&beam, kept, &holds, speed);
            on_springs(&mut assembly, &holds, stiffness);
            let state = start::nominal(&assembly);
            let mut system = System::new(assembly.clone(), Kernel::Scalar);
            let mut motion = jacobian(&mut system, 0.0, &state);
            // It counts turns from axes that stand still; against a spinning body they go round.
            let turn = 9;
            motion[(turn + 1, turn + 2)] -= speed;
            motion[(turn + 2, turn + 1)] += speed;
            let motion = motion.map(|value| Complex::new(value, 0.0));
            for expected in expected.iter().take(count) {
                let ours = nearest(&motion, *expected);
                assert!((ours.im / expected - 1.0).abs() <= tolerance, "{ours} for {expected}");
                // Nothing damps.
                assert!(ours.re.abs() <= 1e-4 * expected, "{ours}");
            }
            // The planes would ring alike but for the spin.
            assert!(expected[1] / expected[0] > 1.001, "{:?}", &expected[..2]);
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

/// The force of a mass that goes round faster and faster: minus mass times acceleration, outwards and backwards.
#[test]
fn an_unbalance_pushes_as_its_mass_is_accelerated() {
    const SIZE: f64 = 2e-3;
    let (t, faster) = (0.02, 5e3);
    let mut assembly = alone(&beam(MIDDLE, STEEL), Kept { most: 2, ..Kept::ALL }, &[0.1], 0.0);
    assembly.bodies[0].driven_mut().unwrap().rotation = Rotation::Speed(rising(0.1 * faster, 0.1));
    let unbalance = unbalanced(SIZE, &assembly, 0.1);
    let angle = unbalance.angle;
    assembly.shafts[0].unbalances.push(unbalance);
    let mut state = start::nominal(&assembly);
    let mut system = System::new(assembly.clone(), Kernel::Scalar);
    let at = system.places.body(0);
    state[at + SPIN] = faster * t;
    let mut rates = vec![0.0; state.len()];
    system.evaluate(t, &state, &mut rates);
    let mass = assembly.bodies[0].inertia().unwrap().mass;
    let (sin, cos) = angle.sin_cos();
    let squared = (faster * t) * (faster * t);
    let expected = [cos * squared + sin * faster, sin * squared - cos * faster];
    for (i, expected) in expected.into_iter().enumerate() {
        let found = mass * rates[at + VELOCITY + 1 + i];
        assert!((found - SIZE * expected).abs() <= 1e-12 * SIZE * squared, "{found} {expected}");
    }
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

/// The shaft and two rings as free bodies; nothing but balls, and springs between shaft and rings, joins them.
fn free_together() -> Assembly {
    let mut assembly = on_bearings(Profile::ZERO, STEEL);
    let shaft = assembly.bodies[0].driven_mut().unwrap();
    shaft.rotation = Rotation::Torque(Profile::ZERO);
    let ring = hollow_cylinder(36e-3, 40e-3, 16e-3, 7850.0);
    for index in [1, 2] {
        assembly.bodies[index].mobility =
            Mobility::Driven(DrivenBody { inertia: ring, ..free_race() }.into());
    }
    for (ring, at) in [(1, 0.1), (2, 0.35)] {
        let along = [along(&assembly, at), at - assembly.bodies[ring].rest[0]];
        let law = SpringDashpot {
            stiffness: [1e5, 2e6, 3e6, 0.0, 50.0, 80.0],
            damping: [10.0; 6],
            ..SpringDashpot::default()
        };
        let ends = [0, 1].map(|i| Mount { along: along[i], ..Mount::at_centre([0, ring][i]) });
        let (name, law) = ("a spring".into(), Law::SpringDashpot(law));
        assembly.connections.push(Connection { name, label: None, ends, law });
    }
    assembly
}

/// What the shaft gives its bearings and its springs it has lost: momentum to rounding, angular momentum but for what
/// goes with the square of bending, energy to the error of the steps.
#[test]
fn a_free_bending_shaft_keeps_momentum_and_energy() {
    let assembly = free_together();
    let mut state = start::nominal(&assembly);
    let places = bearing_dynamics::assembly::places::Places::of(&assembly);
    let at = places.body(0);
    for (entry, value) in [(VELOCITY + 1, 0.02), (VELOCITY, 0.01), (SPIN, 300.0), (SPIN + 2, 0.3)] {
        state[at + entry] += value;
    }
    let (momentum, angular) = with_bending(&assembly, &state);
    let options = fixed_step(2e-7, Start::Nominal);
    let mut simulation = Simulation::from_state(assembly.clone(), options, state, 0.0).unwrap();
    for _ in 0..20_000 {
        simulation.step().unwrap();
    }
    let (momentum_end, angular_end) = with_bending(&assembly, &simulation.state);
    let snapshot = simulation.snapshot();
    let bent = snapshot.energy.bending_strain + snapshot.energy.bending_kinetic;
    let lost = [(momentum_end - momentum).norm() / momentum.norm()];
    let turned = (angular_end - angular).norm() / angular.norm();
    println!(
        "momentum {:e}, angular {turned:e}, residual {:e} J of {:e} J, in bending {bent:e} J",
        lost[0],
        snapshot.residual,
        snapshot.energy.total(),
    );
    assert!(lost[0] <= 1e-11);
    // Tilts and turns of sections are below 1e-3 here: their squares.
    assert!(turned <= 1e-6, "{turned:e}");
    assert!(bent > 1e-6, "nothing bends: {bent:e} J");
    assert!(snapshot.residual.abs() <= 1e-4 * bent, "{:e} of {bent:e} J", snapshot.residual);
}

/// Momenta of all bodies and, of bending, Ω g·a e₂ + Ω g·b e₃ and the whirl about the axis.
fn with_bending(assembly: &Assembly, state: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
    let (momentum, mut angular) = momenta(assembly.clone(), state);
    let mut system = System::new(assembly.clone(), Kernel::Scalar);
    let mut rates = vec![0.0; state.len()];
    system.evaluate(0.0, state, &mut rates);
    let (shaft, body) = (&assembly.shafts[0], &system.bodies[0]);
    let bent = system.bent(state, 0);
    let count = shaft.count();
    let spin = Vector3::from(body.motion.spin).dot(&Vector3::from(body.motion.axis));
    let [e2, e3] = body.tilt_directions.map(Vector3::from);
    for k in 0..count {
        let [a, b, u, v] = [0, 1, 2, 3].map(|part| bent[part * count + k]);
        let tilted = shaft.shapes.tilt_coupling[k] * spin;
        angular += (e2 * a + e3 * b) * tilted + Vector3::from(body.motion.axis) * (a * v - b * u);
    }
    (momentum, angular)
}

/// A shaft that hardly bends moves as the rigid one, whose load acts at the same place.
#[test]
fn a_stiff_shaft_moves_as_a_rigid_one() {
    let speed = Profile::Constant(2000.0 * RPM);
    let mut stiff = on_bearings(speed, 1e6 * STEEL);
    let (at, load) = (0.25, [300.0, -800.0]);
    loaded(&mut stiff, at, load);
    let mut rigid = stiff.clone();
    rigid.shafts.clear();
    let arm = along(&stiff, at);
    let shaft = rigid.bodies[0].driven_mut().unwrap();
    let ramp = |to: f64| Profile::Ramp { from: 0.0, to, start: 0.0, duration: 2e-3 };
    let [y, z] = load;
    for (drive, load) in shaft.drives.iter_mut().zip([0.0, y, z, -arm * z, arm * y]) {
        *drive = Drive::Load(ramp(load));
    }
    let at_end = |assembly: Assembly| {
        let simulation = run(assembly, Integrator::Rosenbrock, Stepping::Accuracy(1e-4), 4e-3);
        let [left, right] =
            [0, 1].map(|bearing| simulation.system.race_of(&simulation.state, bearing, 0).motion);
        [left.position[1], left.position[2], right.position[1], right.position[2], left.axis[2]]
    };
    let (ours, expected) = (at_end(stiff), at_end(rigid));
    println!("{ours:?} {expected:?}");
    for (index, (ours, expected)) in ours.into_iter().zip(expected).enumerate() {
        // Races go some micrometres, and tilt by them over the span.
        let scale = if index < 4 { 5e-6 } else { 5e-6 / 0.4 };
        assert!((ours - expected).abs() <= 2e-3 * scale, "{index}: {ours:e} {expected:e}");
    }
}

/// Everything turned about the axis by a ball pitch: so is the answer.
#[test]
fn turning_everything_about_the_axis_turns_the_answer() {
    let turn = std::f64::consts::TAU / 8.0;
    let (sin, cos) = turn.sin_cos();
    let answer = |turned: bool| {
        let mut assembly = on_bearings(Profile::Constant(3000.0 * RPM), STEEL);
        let [y, z] = [200.0, -500.0];
        let load = if turned { [cos * y - sin * z, sin * y + cos * z] } else { [y, z] };
        loaded(&mut assembly, 0.13, load);
        let mut unbalance = unbalanced(3e-4, &assembly, 0.3);
        unbalance.angle += if turned { turn } else { 0.0 };
        assembly.shafts[0].unbalances.push(unbalance);
        let step = Stepping::Fixed(1e-6);
        let simulation = run(assembly, Integrator::RungeKutta, step, 4e-3);
        let section = section(&simulation.system.assembly, 0.2);
        simulation.system.section_now(&simulation.state, 0, &section).motion
    };
    let (plain, turned) = (answer(false), answer(true));
    let [_, y, z] = plain.position;
    let expected = [cos * y - sin * z, sin * y + cos * z];
    let off = y.hypot(z);
    println!("{off:e} m off, turned {:?}, expected {expected:?}", turned.position);
    assert!(off > 1e-6);
    for (i, expected) in expected.into_iter().enumerate() {
        // Rounding of 4000 steps on springs that keep their energy.
        assert!((turned.position[1 + i] - expected).abs() <= 1e-9 * off, "{i}");
    }
}

/// Damping that spins with the material brakes below the critical speed and drives the whirl above it; the books are
/// kept of both.
#[test]
fn internal_damping_feeds_the_whirl_above_the_critical_speed() {
    let beam = beam(MIDDLE, STEEL);
    for (rpm, grows) in [(3000.0, false), (8000.0, true)] {
        let mut assembly = alone(&beam, Kept { most: 3, ..Kept::ALL }, &[0.0, 0.2, 0.4], rpm * RPM);
        on_springs(&mut assembly, &[0.0, 0.4], [1e7, 1e9, 1e9]);
        assembly.shafts[0].internal_damping = 3000.0;
        let mut state = start::nominal(&assembly);
        let at = bearing_dynamics::assembly::places::Places::of(&assembly).body(0);
        state[at + VELOCITY + 1] = 1e-3;
        let options = fixed_step(1e-6, Start::Nominal);
        let mut simulation = Simulation::from_state(assembly, options, state, 0.0).unwrap();
        let mut largest = [0.0f64; 2];
        while simulation.time < 0.1 {
            simulation.step().unwrap();
            let late = usize::from(simulation.time > 0.05);
            largest[late] = largest[late].max(off(&simulation, 0.2));
        }
        let snapshot = simulation.snapshot();
        println!("{rpm} rpm: {largest:?} m, residual {:e} J", snapshot.residual);
        assert_eq!(largest[1] > largest[0], grows, "{rpm} rpm: {largest:?}");
        let turned: f64 = snapshot.ledger.iter().map(|entry| entry.abs()).sum();
        assert!(snapshot.residual.abs() <= 1e-5 * turned, "{:e}, {turned:e}", snapshot.residual);
    }
}

/// Each evaluation does what the plan says, so often.
#[test]
fn a_plan_counts_what_bending_does() {
    let mut assembly = on_bearings(Profile::Constant(100.0), STEEL);
    loaded(&mut assembly, 0.13, [0.0, -100.0]);
    assembly.shafts[0].damping = 10.0;
    let unbalance = unbalanced(3e-4, &assembly, 0.3);
    assembly.shafts[0].unbalances.push(unbalance);
    let mut simulation = Simulation::new(assembly, fixed_step(1e-6, Start::Nominal)).unwrap();
    let before = simulation.system.ran.clone();
    let evaluations = simulation.system.work.evaluations;
    for _ in 0..10 {
        simulation.step().unwrap();
    }
    let evaluations = simulation.system.work.evaluations - evaluations;
    for (stage, each) in [(Stage::Reduced, 1), (Stage::Loads, 2), (Stage::Damping, 1)] {
        let of = Subject::Body(0);
        let ran = simulation.system.ran.of(stage, of) - before.of(stage, of);
        assert_eq!(ran, each * evaluations, "{stage:?}");
        let items = simulation.system.plan.iter();
        let mut items = items.filter(|item| item.stage == stage && item.subject == of);
        assert!(items.any(|item| item.does && item.cost == Some(each)), "{stage:?}");
    }
}

/// Stretching turns with the shaft and does not change as it turns: what damps it inside and outside add up.
#[test]
fn stretching_is_damped_inside_and_outside() {
    let [frequency, gone, speed] = [3e3, 2e-6, 5e-3];
    let [outside, inside] = [40.0, 700.0];
    let shapes = ShaftShapes { stretch_frequencies: vec![frequency], ..ShaftShapes::default() };
    let shaft = ElasticShaft {
        shapes,
        damping: outside,
        internal_damping: inside,
        ..ElasticShaft::default()
    };
    let body = rigid_body::fixed(&[0.0; 5]);
    let mut rates = [0.0; 2];
    let steps = ShaftSteps { loads: false, damping: true };
    let entries = [gone, speed];
    let mut ran = Counts::default();
    let done = shaft.rates(steps, 0.0, Some(0.0), (&body, &entries), &mut rates, &mut ran);
    let pushed = -frequency * frequency * gone - (outside + inside) * speed;
    // Rounding.
    assert!((rates[1] / pushed - 1.0).abs() <= 1e-14 && rates[0] == speed, "{rates:?} {pushed}");
    let lost = -(outside + inside) * speed * speed;
    assert!((done.damped / lost - 1.0).abs() <= 1e-14, "{done:?} {lost}");
}
