//! What a run books as gained and lost against the integral of its powers, by every integrator.

use super::dynamics_integrators::{fast, gentle, motion, rolling};
use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::assembly::lists::INNER;
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::body::{Drive, RotatingLoad, Rotation};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::state::Ledger;
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Stepping};
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use common::table_4_1;
use dynamics::{bearing, cage, evaluated, free_race, ledger, random_state};

/// Losses of the three methods at the same small steps.
#[test]
fn losses_agree_between_the_methods() {
    let stepping = Stepping::Fixed(1e-6);
    let lost =
        [Integrator::RungeKutta, Integrator::DormandPrince, Integrator::Rosenbrock].map(|method| {
            let simulation = motion(&gentle(), method, stepping, 1e-3, 10).1;
            [Ledger::Traction, Ledger::ContactDamping].map(|entry| ledger(&simulation, entry))
        });
    for other in &lost[1..] {
        for (reference, found) in lost[0].iter().zip(other) {
            assert!(*reference < 0.0, "{lost:?}");
            // The trapezoidal rule of Rosenbrock's losses: (ωh)²/12 with ω of some 1e5 1/s.
            assert!((found / reference - 1.0).abs() <= 2e-3, "{lost:?}");
        }
    }
}

/// Races that are moved on from outside: the drives' work closes the balance, and balls follow as under one profile.
#[test]
fn drives_may_change_within_a_run() {
    let placed = |z: f64| {
        let mut problem = bearing(table_4_1(-5e-6), [0.0; 5], 0.0);
        let at = [0.0, 0.0, z, 0.0, 0.0];
        problem.inner.drives = at.map(|at| Drive::Motion(Profile::Constant(at)));
        problem.inner.rotation = Rotation::Speed(Profile::Constant(100.0));
        problem
    };
    let options = RunOptions { stepping: Stepping::Fixed(2e-7), ..RunOptions::default() };
    let mut moved = Simulation::new(placed(0.0), options).unwrap();
    let before = moved.snapshot();
    moved.change_drives(|bodies| {
        bodies[INNER].driven_mut().unwrap().drives[2] = Drive::Motion(Profile::Constant(-2e-6));
    });
    let state = {
        let mut state = Simulation::new(placed(0.0), options).unwrap().state;
        System::new(placed(-2e-6), Kernel::Simd).tidy(0.0, &mut state);
        state
    };
    let mut begun = Simulation::from_state(placed(-2e-6), options, state, 0.0).unwrap();
    for _ in 0..500 {
        moved.step().unwrap();
        begun.step().unwrap();
    }
    let all_but_the_ledger = begun.system.places.ledger();
    assert_eq!(moved.state[..all_but_the_ledger], begun.state[..all_but_the_ledger]);
    let after = moved.snapshot();
    let work = after.ledger[Ledger::Drives as usize] - before.ledger[Ledger::Drives as usize];
    // Displaced by two fifths of the overlap, balls take up energy of the size of what they held.
    assert!(work.abs() >= 0.1 * before.energy.contact, "{work:e} of {:e} J", before.energy.contact);
    // Integrated to (ωh)⁴; the jump itself has no error.
    assert!(after.residual.abs() <= 1e-6 * work.abs(), "{:e} of {work:e} J", after.residual);
}

const ENTRIES: [Ledger; 5] = [
    Ledger::Traction,
    Ledger::ContactDamping,
    Ledger::CageFriction,
    Ledger::Foundation,
    Ledger::Drives,
];

/// Everything that takes or gives energy at once, and contacts that open and close.
fn everything() -> (DynamicProblem, Vec<f64>) {
    let harmonic = |mean: f64, amplitude: f64, phase: f64| Profile::Harmonic {
        mean,
        amplitude,
        frequency: 900.0,
        phase,
    };
    let mut problem = bearing(table_4_1(-5e-6), [0.0; 5], 0.0);
    problem.inner.drives = std::array::from_fn(|i| match i {
        3 => Drive::Motion(harmonic(0.0, 1e-3, 0.3)),
        4 => Drive::Load(harmonic(0.5, 0.5, 0.1)),
        _ => Drive::Load(harmonic(200.0, 100.0, i as f64)),
    });
    problem.inner.rotation = Rotation::Torque(harmonic(0.1, 0.05, 0.3));
    let mut outer = free_race();
    outer.rotation = Rotation::Speed(harmonic(50.0, 20.0, 0.7));
    outer.foundation_stiffness = [1e7, 2e7, 3e7, 1e3, 2e3];
    outer.foundation_damping = [1e3, 2e3, 3e3, 1.0, 2.0];
    problem.outer = Some(outer);
    problem.cage = Some(cage(&problem.geometry, Pocket::Cylindrical, Guidance::OuterRace));
    problem.traction = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.5 };
    problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
    let turning = Profile::Constant(100.0);
    problem.rotating_load =
        Some(RotatingLoad { force: turning.clone(), speed: turning, phase: 0.4 });
    problem.unbalance = 1e-4;
    let mut state = random_state(&problem, 17);
    System::new(problem.clone(), Kernel::Simd).tidy(0.0, &mut state);
    (problem, state)
}

/// What a run books, and ∫ power dt and ∫ |power| dt by trapezoids between its own steps; powers as
/// `each_entry_of_the_ledger_is_the_power_of_its_forces` proves them.
fn booked_and_summed(
    integrator: Integrator,
    stepping: Stepping,
    end: f64,
) -> ([f64; 5], [f64; 5], [f64; 5], u64) {
    let (problem, state) = everything();
    let options =
        RunOptions { integrator, stepping, energy_limit: f64::INFINITY, ..RunOptions::default() };
    let mut simulation = Simulation::from_state(problem.clone(), options, state, 0.0).unwrap();
    let powers = |simulation: &Simulation| {
        let (system, rates) = evaluated(&problem, Kernel::Simd, simulation.time, &simulation.state);
        ENTRIES.map(|entry| rates[system.sets[0].layout.ledger_entry(entry)])
    };
    let (mut sums, mut sizes) = ([0.0; 5], [0.0; 5]);
    let mut before = powers(&simulation);
    while simulation.time < end * (1.0 - 1e-9) {
        let left = end - simulation.time;
        let step = simulation.step_by(simulation.step_size.min(left)).unwrap();
        let after = powers(&simulation);
        for i in 0..5 {
            sums[i] += 0.5 * step * (before[i] + after[i]);
            sizes[i] += 0.5 * step * (before[i].abs() + after[i].abs());
        }
        before = after;
    }
    (ENTRIES.map(|entry| ledger(&simulation, entry)), sums, sizes, simulation.steps)
}

/// At steps that resolve all motion every method books every entry as the sum of its powers.
#[test]
fn each_entry_of_the_ledger_is_the_integral_of_its_power() {
    for method in [Integrator::RungeKutta, Integrator::DormandPrince, Integrator::Rosenbrock] {
        let (booked, sums, sizes, _) = booked_and_summed(method, Stepping::Fixed(0.05e-6), 0.1e-3);
        println!("{method:?}: booked {booked:?}, summed {sums:?}");
        for (i, entry) in ENTRIES.iter().enumerate() {
            let part = (booked[i] - sums[i]).abs() / sizes[i];
            // (ωh)²/12 of the trapezoids, with ω of 5e5 1/s where contacts close and creep; kinks of
            // cage contacts that open and close once or twice are of the same order.
            assert!(sizes[i] > 1e-6 && part <= 3e-4, "{method:?} {entry:?}: {part:e} of {sizes:?}");
        }
    }
}

/// However long its steps, the implicit method books each loss by its powers at their ends, and no
/// stage between them, where slidings are known badly.
#[test]
fn losses_of_long_implicit_steps_are_those_of_their_ends() {
    for stepping in [Stepping::Accuracy(1e-3), Stepping::Accuracy(1e-2), Stepping::Fixed(2e-6)] {
        let (booked, sums, sizes, steps) =
            booked_and_summed(Integrator::Rosenbrock, stepping, 0.3e-3);
        println!("{stepping:?}: {steps} steps, booked {booked:?}, summed {sums:?}");
        for (i, entry) in ENTRIES[..3].iter().enumerate() {
            // Rounding of the sums.
            let part = (booked[i] - sums[i]).abs() / sizes[i];
            assert!(sizes[i] > 1e-6 && part <= 1e-12, "{stepping:?} {entry:?}: {part:e}");
        }
    }
}

/// Balls on their orbits and the turning race hold a thousand times the energy of the contacts, and
/// none of it is lost or made in steps that turn by milliradians.
#[test]
fn long_steps_keep_the_energy_of_turning() {
    for (accuracy, allowed) in [(1e-2, 1e-5), (1e-3, 1e-6)] {
        let stepping = Stepping::Accuracy(accuracy);
        let mut simulation = motion(&fast(), Integrator::Rosenbrock, stepping, 2e-2, 20).1;
        let snapshot = simulation.snapshot();
        let part = snapshot.residual.abs() / snapshot.energy.kinetic;
        // Measured: 2e-6 and 6e-8; with stages along tangents 9e-4 and 3e-6.
        assert!(part <= allowed, "{accuracy}: {part:e}");
    }
}

/// A drive that holds the speed against stiff traction does hardly any work: what balls gain and lose.
/// The ledger closes far below what the contacts hold.
#[test]
fn long_steps_keep_the_ledger_of_a_drive() {
    for (accuracy, allowed) in [(1e-2, 1e-3), (1e-3, 5e-4)] {
        let stepping = Stepping::Accuracy(accuracy);
        let mut simulation = motion(&rolling(), Integrator::Rosenbrock, stepping, 2e-2, 50).1;
        let snapshot = simulation.snapshot();
        let part = snapshot.residual.abs() / snapshot.energy.contact;
        // Measured: 1e-4 and 7e-5; without the drift of the balls' frames in the matrix 9e-3 and 2e-3.
        assert!(part <= allowed, "{accuracy}: {part:e}");
    }
}

/// The watchdog lets runs through whose motion is right, with its usual limit.
#[test]
fn error_controlled_runs_pass_the_energy_watchdog() {
    for (name, problem) in [("frictionless, 10 000 rpm", fast()), ("rolling", rolling())] {
        for accuracy in [1e-2, 1e-3] {
            let stepping = Stepping::Accuracy(accuracy);
            let options = RunOptions {
                integrator: Integrator::Rosenbrock,
                stepping,
                ..RunOptions::default()
            };
            let mut simulation = Simulation::new(problem.clone(), options).unwrap();
            while simulation.time < 20e-3 {
                let taken = simulation.step();
                assert!(taken.is_ok(), "{name}, {accuracy}, {} s: {taken:?}", simulation.time);
            }
        }
    }
}
