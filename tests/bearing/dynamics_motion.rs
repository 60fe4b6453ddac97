//! Laws of whole motions: free tops, energy, order of the integrator, prescribed histories.

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::members::body::{Drive, Rotation};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::rigid_body::tilts_of;
use bearing_dynamics::members::state::{BodyState, Layout, Ledger, POSITION, SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{Simulation, Start};
use bearing_dynamics::motion::stability::step_limit;
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use common::{table_4_1, table_5_3};
use dynamics::*;
use nalgebra::{UnitQuaternion, Vector3};

/// Largest residual of the ledger seen over `steps` steps, checked every `every`.
fn largest_residual(simulation: &mut Simulation, steps: usize, every: usize) -> (f64, f64) {
    let (mut residual, mut strain) = (0.0_f64, 0.0_f64);
    for step in 0..steps {
        simulation.step().unwrap();
        if (step + 1) % every == 0 {
            let snapshot = simulation.snapshot();
            residual = residual.max(snapshot.residual.abs());
            strain = strain.max(snapshot.energy.contact);
        }
    }
    (residual, strain)
}

/// A body turning freely: 10⁵ steps against the closed solution.
fn check_top(simulation: &mut Simulation, at: usize, inertia: &Inertia, steps: usize) {
    let body = |simulation: &Simulation| BodyState::from_slice(&simulation.state[at..]);
    let momentum_of = |body: &BodyState| {
        let (axis, spin) = (Vector3::from(body.axis()), Vector3::from(body.spin));
        spin * inertia.transverse + axis * ((inertia.axial - inertia.transverse) * axis.dot(&spin))
    };
    let energy_of = |body: &BodyState| 0.5 * momentum_of(body).dot(&Vector3::from(body.spin));
    let first = body(simulation);
    let (energy, momentum) = (energy_of(&first), momentum_of(&first));
    run(simulation, steps);
    let last = body(simulation);
    // ω h = 5e-3: Runge–Kutta damps a rotation by (ω h)⁶/144 a step, 1e-11 over 10⁵ steps; what
    // is left is rounding.
    assert!((energy_of(&last) / energy - 1.0).abs() <= 1e-9);
    assert!((momentum_of(&last) - momentum).norm() <= 1e-9 * momentum.norm());
    // In inertial axes the axis and the spin go round the angular momentum at L/It.
    let turned = |rate: f64, about: Vector3<f64>| {
        UnitQuaternion::from_scaled_axis(about * (rate * simulation.time))
    };
    let round = turned(1.0 / inertia.transverse, momentum);
    let spin = round * Vector3::from(first.spin);
    let speed = spin.norm();
    // The phase falls behind by (ω h)⁵/120 a step, 3e-9 over all.
    assert!((Vector3::from(last.spin) - spin).norm() <= 1e-8 * speed);
    let axis = round * Vector3::from(first.axis());
    assert!((Vector3::from(last.axis()) - axis).norm() <= 1e-8);
    // In the body's axes the spin goes round the body's own axis at (Ia − It)/It · ω_a.
    let own_axis = first.orientation.inverse() * Vector3::from(first.axis());
    let along = Vector3::from(first.spin).dot(&Vector3::from(first.axis()));
    let rate = (inertia.axial - inertia.transverse) / inertia.transverse * along;
    let in_body = |body: &BodyState| body.orientation.inverse() * Vector3::from(body.spin);
    let expected = turned(rate, own_axis) * in_body(&first);
    assert!((in_body(&last) - expected).norm() <= 1e-8 * speed);
}

#[test]
fn a_free_inner_race_is_a_top() {
    // So much clearance that nothing touches.
    let mut problem = bearing(table_4_1(10e-3), [0.0; 5], 0.0);
    problem.inner = free_race();
    let inertia = problem.inner.inertia;
    let mut simulation = simulation(&problem, 1e-5, Start::Nominal);
    let at = simulation.system.sets[0].layout.inner();
    simulation.state[at + SPIN..at + SPIN + 3].copy_from_slice(&[480.0, 10.0, -15.0]);
    check_top(&mut simulation, at, &inertia, 100_000);
    assert_eq!(simulation.system.work.loaded_contacts, 0);
}

#[test]
fn a_free_cage_is_a_top() {
    let geometry = table_4_1(10e-3);
    let mut problem = bearing(geometry, [0.0; 5], 0.0);
    let mut body = cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace);
    body.contacts.pocket_radius = 1.0;
    body.contacts.race_clearance = 1.0;
    let inertia = body.inertia;
    problem.cage = Some(body);
    let mut simulation = simulation(&problem, 1e-5, Start::Nominal);
    let at = simulation.system.sets[0].layout.cage();
    simulation.state[at + SPIN..at + SPIN + 3].copy_from_slice(&[300.0, 200.0, -250.0]);
    check_top(&mut simulation, at, &inertia, 100_000);
}

/// A preloaded bearing, both races free, that never loses a contact: smooth motion.
fn smooth() -> DynamicProblem {
    let mut problem = bearing(table_4_1(-20e-6), [0.0; 5], 0.0);
    problem.inner = free_race();
    problem.outer = Some(free_race());
    problem
}

fn smooth_start(problem: &DynamicProblem) -> Vec<f64> {
    let layout = Layout::new(problem.geometry.ball_count, problem.cage.is_some());
    let mut state = start::nominal(&problem.assembly());
    let at = layout.inner();
    state[at + VELOCITY..at + VELOCITY + 3].copy_from_slice(&[0.02, 0.05, -0.04]);
    state[at + SPIN..at + SPIN + 3].copy_from_slice(&[200.0, 1.0, -2.0]);
    state
}

/// Largest difference of velocities (m/s) and spins × ball radius at the end of `time`.
fn difference(problem: &DynamicProblem, a: &[f64], b: &[f64]) -> f64 {
    let mut largest = 0.0_f64;
    for (_, at) in bodies(problem) {
        let (a, b) = (entries(a, at), entries(b, at));
        let velocity = (part(&a, VELOCITY) - part(&b, VELOCITY)).norm();
        let spin = (part(&a, SPIN) - part(&b, SPIN)).norm() * problem.geometry.ball_radius;
        largest = largest.max(velocity).max(spin);
    }
    largest
}

fn run_from(problem: &DynamicProblem, state: &[f64], step: f64, time: f64) -> Simulation {
    let options = fixed_step(step, Start::Nominal);
    let mut simulation =
        Simulation::from_state(problem.clone(), options, state.to_vec(), 0.0).unwrap();
    run(&mut simulation, (time / step).round() as usize);
    simulation
}

#[test]
fn smooth_motion_converges_with_order_four() {
    // Without traction, and with the one law that is smooth where the slip turns round: κ u/|u| of
    // the others has a term |u| u, or the floor of the entrainment.
    for law in [0, 1] {
        let mut problem = smooth();
        problem.traction = traction_laws()[law].clone();
        let state = smooth_start(&problem);
        let time = 0.2e-3;
        let reference = run_from(&problem, &state, 0.015625e-6, time);
        let steps = [0.5e-6, 0.25e-6, 0.125e-6];
        let errors = steps.map(|step| {
            let end = run_from(&problem, &state, step, time);
            let work = end.system.work;
            assert_eq!(work.loaded_contacts, 2 * 8 * work.evaluations, "a contact opened");
            difference(&problem, &end.state, &reference.state)
        });
        let orders = [0, 1].map(|i| (errors[i] / errors[i + 1]).log2());
        println!("law {law}: errors {errors:?}, orders {orders:?}");
        // The reference is eight times finer than the finest run: 8⁻⁴ of its error. The order
        // comes down to 4 from above, since the next term is of fifth order in ωh = 0.15 … 0.04.
        assert!((orders[1] - 4.0).abs() <= 0.1, "law {law}: {errors:?} {orders:?}");
    }
}

#[test]
fn making_and_breaking_contact_costs_order() {
    // K δ^{3/2} has a kink in its slope where a contact begins: within the step that crosses it
    // the force is off by h^{3/2}, the velocity by h^{5/2}. The next steps see smooth motion
    // again, so that a fixed number of makes and breaks leaves an error of order 5/2, whose size
    // depends on where in its step each crossing falls. The mean over many starts shows the order.
    let mut problem = bearing(table_4_1(10e-6), [0.0; 5], 0.0);
    problem.inner = free_race();
    let layout = Layout::new(8, false);
    let steps = [1e-6, 0.5e-6, 0.25e-6, 0.125e-6];
    let starts = 24;
    let mut logs = [0.0; 4];
    for seed in 0..starts {
        let mut state = start::nominal(&problem.assembly());
        let velocity = Noise(seed).vector(0.2);
        let at = layout.inner();
        state[at + VELOCITY..at + VELOCITY + 3].copy_from_slice(&velocity);
        let time = 0.15e-3;
        let reference = run_from(&problem, &state, 0.015625e-6, time);
        let work = reference.system.work;
        let loaded = work.loaded_contacts as f64 / work.evaluations as f64;
        assert!(loaded > 0.1 && loaded < 15.0, "{loaded} of 16 contacts loaded");
        for (log, step) in logs.iter_mut().zip(steps) {
            let end = run_from(&problem, &state, step, time);
            *log += difference(&problem, &end.state, &reference.state).log2() / starts as f64;
        }
    }
    // Least-squares slope over three halvings.
    let order = (3.0 * (logs[0] - logs[3]) + logs[1] - logs[2]) / 10.0;
    println!("errors with make and break {:?}, order {order}", logs.map(f64::exp2));
    // The phases are random: over 24 starts the order scatters by about 0.2.
    assert!((order - 2.5).abs() <= 0.4, "{order}");
}

#[test]
fn frictionless_energy_drifts_by_the_order_of_the_step() {
    let problem = smooth();
    let state = smooth_start(&problem);
    let mut system = System::new(problem.clone(), Kernel::Simd);
    let pulsation = step_limit(&mut system, 0.0, &state).unwrap().eigenvalue.norm();
    let time = 300.0 / pulsation;
    let drifts = [0.2, 0.1, 0.05].map(|angle| {
        let step = angle / pulsation;
        let options = fixed_step(step, Start::Nominal);
        let mut simulation =
            Simulation::from_state(problem.clone(), options, state.clone(), 0.0).unwrap();
        let (residual, strain) =
            largest_residual(&mut simulation, (time / step).round() as usize, 1);
        residual / strain
    });
    let orders = [0, 1].map(|i| (drifts[i] / drifts[i + 1]).log2());
    println!("energy drift at ωh = 0.2, 0.1, 0.05: {drifts:?}, orders {orders:?}");
    // The amplitude of an oscillation shrinks by (ω h)⁶/144 a step: fifth order over a time. After
    // 300 rad of the stiffest mode at ω h = 0.05: 300 · 2 · 0.05⁵/144 = 1.3e-6 of the energy in
    // that mode, which is a small part of the preload's.
    assert!(drifts[2] <= 1e-6, "{drifts:?}");
    assert!(orders.iter().all(|order| (order - 5.0).abs() <= 0.3), "{orders:?}");
}

#[test]
fn a_short_run_turns_with_the_frame() {
    for (seed, law) in [(3, 0), (4, 1), (5, 2)] {
        let geometry = table_5_3();
        let mut problem = bearing(geometry, [0.0; 5], 0.0);
        problem.inner = free_race();
        problem.outer = Some(free_race());
        problem.cage = Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace));
        problem.traction = traction_laws()[law].clone();
        problem.gravity = GRAVITY;
        let state = random_state(&problem, seed);
        let mut noise = Noise(seed);
        let (turn, by) = (noise.turn(1.5), Vector3::from(noise.vector(0.57)));
        let mut other = problem.clone();
        other.gravity = (turn * Vector3::from(GRAVITY)).into();
        let (step, time) = (1e-6, 1e-4);
        let here = run_from(&problem, &state, step, time);
        let there = run_from(&other, &moved(&problem, &state, &turn, &by), step, time);
        let turned = moved(&problem, &here.state, &turn, &by);
        // Rounding of a position at 1 m (1e-16 m) on contacts of 1e8 N/m: 2e-8 N on a ball of
        // 7 g for 1e-4 s is 3e-10 m/s, beside speeds of about 1 m/s.
        let off = difference(&problem, &turned, &there.state);
        println!("seed {seed}: velocities off by {off} m/s");
        assert!(off <= 1e-9, "{off}");
        for (_, at) in bodies(&problem) {
            let (a, b) = (entries(&turned, at), entries(&there.state, at));
            // 1e-9 of the distance travelled at 1 m/s, and the rounding of the position itself.
            assert!((part(&a, POSITION) - part(&b, POSITION)).norm() <= 1e-13 + 2e-15);
        }
    }
}

#[test]
fn a_free_bearing_keeps_its_momentum() {
    let geometry = table_4_1(-5e-6);
    let mut problem = bearing(geometry, [0.0; 5], 0.0);
    problem.inner = free_race();
    problem.outer = Some(free_race());
    problem.cage = Some(cage(&geometry, Pocket::Spherical, Guidance::InnerRace));
    problem.traction = CONSTANT;
    problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
    let state = random_state(&problem, 11);
    let (momentum, angular) = momenta(&problem, &state);
    let end = run_from(&problem, &state, 0.5e-6, 1e-3);
    let (momentum_end, angular_end) = momenta(&problem, &end.state);
    // Linear momentum is a linear invariant and kept to rounding (2000 steps of 1e-16 of loads of
    // 5000 N); angular momentum is quadratic, so that Runge–Kutta keeps it to its own order.
    let scale = 0.2;
    assert!((momentum_end - momentum).norm() <= 1e-13 * scale, "{}", momentum_end - momentum);
    let size = angular.norm();
    assert!((angular_end - angular).norm() <= 1e-6 * size, "{} {size}", angular_end - angular);
}

#[test]
fn lost_kinetic_energy_is_in_the_ledger() {
    // Everything that takes energy at once, nothing that gives any.
    let geometry = table_4_1(-5e-6);
    let mut problem = bearing(geometry, [0.0; 5], 0.0);
    problem.inner = free_race();
    problem.cage = Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace));
    problem.traction = CONSTANT;
    problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
    let layout = Layout::new(8, true);
    let mut state = start::nominal(&problem.assembly());
    let at = layout.inner();
    state[at + SPIN] = 500.0;
    state[at + VELOCITY + 2] = 0.05;
    let mut simulation =
        Simulation::from_state(problem.clone(), fixed_step(0.5e-6, Start::Nominal), state, 0.0)
            .unwrap();
    let before = simulation.snapshot().energy;
    let (residual, _) = largest_residual(&mut simulation, 8000, 50);
    let after = simulation.snapshot();
    let lost = before.total() - after.energy.total();
    let booked = -after.ledger.iter().sum::<f64>();
    println!("lost {lost} J, booked {booked} J, residual {residual}");
    assert!(lost > 0.02 * before.kinetic);
    for entry in [Ledger::Traction, Ledger::ContactDamping, Ledger::CageFriction] {
        assert!(ledger(&simulation, entry) < 0.0, "{entry:?}");
    }
    // Cage contacts open and close with a corner in their force: second order in the step.
    assert!(residual <= 1e-5 * before.kinetic, "{residual} of {}", before.kinetic);
}

#[test]
fn prescribed_histories_are_followed_and_their_work_is_booked() {
    let profiles = [
        Profile::Harmonic { mean: 1e-6, amplitude: 4e-6, frequency: 400.0, phase: 0.2 },
        Profile::SmoothRamp { from: 0.0, to: 10e-6, start: 0.2e-3, duration: 2e-3 },
        Profile::Harmonic { mean: 0.0, amplitude: 3e-6, frequency: 300.0, phase: 1.0 },
        Profile::Harmonic { mean: 0.0, amplitude: 5e-4, frequency: 250.0, phase: 0.3 },
        Profile::SmoothRamp { from: 0.0, to: 1e-3, start: 0.0, duration: 2.5e-3 },
    ];
    let speed = Profile::SmoothRamp { from: 300.0, to: 600.0, start: 0.0, duration: 3e-3 };
    // Each coordinate alone, and all together; the others are held by a foundation.
    let choices = [0b00001, 0b00010, 0b00100, 0b01000, 0b10000, 0b01010, 0b11111];
    for choice in choices {
        let mut problem = bearing(table_4_1(-20e-6), [0.0; 5], 0.0);
        problem.traction = CONSTANT;
        problem.inner.rotation = Rotation::Speed(speed.clone());
        problem.inner.foundation_stiffness = [1e6, 1e6, 1e6, 1e2, 1e2];
        for (i, profile) in profiles.iter().enumerate() {
            if choice & (1 << i) != 0 {
                problem.inner.drives[i] = Drive::Motion(profile.clone());
            }
        }
        let steps = [0.5e-6, 0.25e-6];
        let residuals = steps.map(|step| {
            let mut simulation = simulation(&problem, step, Start::Equilibrium);
            let (residual, _) =
                largest_residual(&mut simulation, (3e-3 / step).round() as usize, 10);
            let inner = inner_state(&simulation);
            let t = simulation.time;
            let tilts = tilts_of(inner.axis());
            for (i, profile) in profiles.iter().enumerate() {
                if choice & (1 << i) != 0 {
                    let value = if i < 3 { inner.position[i] } else { tilts[i - 3] };
                    // Tilts pass through a quaternion: some 2⁻⁵³.
                    let error = (value - profile.value(t)).abs();
                    assert!(error <= if i < 3 { 0.0 } else { 1e-15 }, "{i}: {error}");
                }
            }
            let along = Vector3::from(inner.spin).dot(&Vector3::from(inner.axis()));
            assert!((along / speed.value(t) - 1.0).abs() <= 1e-15);
            let turned = simulation.snapshot();
            let scale = turned.ledger.iter().map(|entry| entry.abs()).sum::<f64>();
            residual / scale
        });
        println!("choice {choice:05b}: residuals {residuals:?}");
        // Fourth order in the step, down to rounding of energies of 20 J over works of 20 J.
        assert!(residuals[1] <= 1e-7, "{choice:05b}: {residuals:?}");
        assert!(
            residuals[0] / residuals[1] >= 12.0 || residuals[1] <= 1e-11,
            "{choice:05b}: {residuals:?}"
        );
    }
}
