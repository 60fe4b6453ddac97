//! Violent motions; errors.

use crate::{common, dynamics};

use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::members::body::{Drive, Rotation};
use bearing_dynamics::members::state::{Layout, Ledger, VELOCITY};
use bearing_dynamics::motion::simulation::{RunOptions, Simulation, SimulationError, Start};
use bearing_dynamics::motion::start;
use bearing_dynamics::numeric::profile::Profile;
use common::{table_4_1, table_5_3};
use dynamics::*;

#[test]
fn a_50_g_impact_on_the_foundation_passes() {
    // Half a sine of 50 g on the outer race's mass and all it carries, 1 ms.
    let mut problem = bearing(table_4_1(-5e-6), [0.0; 5], 1000.0 * RPM);
    problem.traction = CONSTANT;
    let mut outer = free_race();
    outer.rotation = Rotation::Speed(Profile::ZERO);
    outer.foundation_stiffness = [1e7, 1e7, 1e7, 1e4, 1e4];
    outer.foundation_damping = [500.0, 500.0, 500.0, 0.5, 0.5];
    let carried = outer.inertia.mass + problem.inner.inertia.mass + 8.0 * problem.ball.mass;
    let peak = 50.0 * 9.81 * carried;
    let impact = Profile::HalfSine { base: 0.0, peak, start: 0.5e-3, duration: 1e-3 };
    outer.drives[2] = Drive::Load(impact);
    problem.outer = Some(outer);
    let mut simulation = simulation(&problem, 1e-6, Start::Equilibrium);
    let at = simulation.system.sets[0].layout.outer();
    let (mut highest, mut residual, mut strain) = (0.0_f64, 0.0_f64, 0.0_f64);
    for step in 0..6000 {
        simulation.step().unwrap();
        highest = highest.max(simulation.state[at + 2]);
        if step % 20 == 0 {
            let snapshot = simulation.snapshot();
            residual = residual.max(snapshot.residual.abs());
            strain = strain.max(snapshot.energy.contact + snapshot.energy.foundation);
        }
    }
    println!("impact: {highest:e} m, residual {residual:e} of {strain:e} J");
    // A half sine slow beside the foundation (0.2 ms) lifts it by the static F/k and half as much
    // again at most.
    assert!((0.8..1.8).contains(&(highest / (peak / 1e7))), "{}", highest / (peak / 1e7));
    assert!(ledger(&simulation, Ledger::Drives) > 0.0);
    assert!(ledger(&simulation, Ledger::Foundation) < 0.0);
    assert!(residual <= 1e-4 * strain, "{residual} of {strain}");
}

#[test]
fn clearance_is_lost_and_comes_back() {
    // The inner race is moved across a clearance of 10 µm and 5 µm beyond on either side.
    let mut problem = bearing(table_4_1(10e-6), [0.0; 5], 0.0);
    let history = Profile::Harmonic { mean: 0.0, amplitude: 15e-6, frequency: 500.0, phase: 0.0 };
    problem.inner.drives[2] = Drive::Motion(history);
    let mut simulation = simulation(&problem, 0.5e-6, Start::Nominal);
    let (mut changes, mut was_loaded, mut peak, mut residual) = (0, false, 0.0_f64, 0.0_f64);
    for _ in 0..8000 {
        simulation.step().unwrap();
        let snapshot = simulation.snapshot();
        let loaded = simulation.system.sets[0].table.active.len() > 2;
        changes += usize::from(loaded != was_loaded);
        was_loaded = loaded;
        peak = peak.max(snapshot.energy.contact);
        residual = residual.max(snapshot.residual.abs());
    }
    println!("{changes} changes, residual {residual:e} of {peak:e} J");
    assert!(changes >= 6, "{changes}");
    // Each make or break costs (ω h)^(5/2) of a contact's energy.
    assert!(residual <= 1e-4 * peak, "{residual} of {peak}");
}

#[test]
fn a_cage_collision_conserves_momentum_and_energy() {
    // A cage thrown against its guide and the balls at 2 m/s, races free, nothing lost.
    let geometry = table_4_1(-5e-6);
    let mut problem = bearing(geometry, [0.0; 5], 0.0);
    problem.inner = free_race();
    problem.outer = Some(free_race());
    let mut body = cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace);
    body.contacts.friction = 0.0;
    problem.cage = Some(body);
    let layout = Layout::new(8, true);
    let mut state = start::nominal(&problem.assembly());
    let at = layout.cage();
    state[at + VELOCITY..at + VELOCITY + 3].copy_from_slice(&[0.5, 2.0, -1.0]);
    let (momentum, angular) = momenta(&problem, &state);
    let options = fixed_step(0.25e-6, Start::Nominal);
    let mut simulation = Simulation::from_state(problem.clone(), options, state, 0.0).unwrap();
    let first = simulation.snapshot().energy.total();
    let mut peak = 0.0_f64;
    for _ in 0..4000 {
        simulation.step().unwrap();
        let cage =
            simulation.system.sets[0].pockets.iter().chain(&simulation.system.sets[0].guides);
        peak = peak.max(cage.map(|contact| contact.normal_load).fold(0.0, f64::max));
    }
    let snapshot = simulation.snapshot();
    let (momentum_end, angular_end) = momenta(&problem, &simulation.state);
    println!("cage hit with {peak} N, energy off by {:e} of {first}", snapshot.residual);
    assert!(peak > 100.0, "{peak}");
    assert!((momentum_end - momentum).norm() <= 1e-12 * momentum.norm());
    assert!((angular_end - angular).norm() <= 1e-6 * geometry.pitch_radius * momentum.norm());
    // Linear contact: the force has a corner, and the energy of a crossing is off by (ω h)² of the
    // energy at that depth, 1e-4 of a collision's 1e-3 … of the whole.
    assert!(snapshot.residual.abs() <= 1e-5 * first, "{} of {first}", snapshot.residual);
}

#[test]
fn ten_thousand_rpm_with_traction_and_cage_keeps_its_balance() {
    let geometry = table_5_3();
    let mut problem = bearing(geometry, [445.0, 0.0, -100.0, 0.0, 0.0], 10_000.0 * RPM);
    problem.cage = Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace));
    problem.traction = CONSTANT;
    problem.gravity = GRAVITY;
    let mut simulation = simulation(&problem, 2e-6, Start::Equilibrium);
    for _ in 0..6000 {
        simulation.step().unwrap();
    }
    let snapshot = simulation.snapshot();
    let turned: f64 = snapshot.ledger.iter().map(|entry| entry.abs()).sum();
    println!("10 000 rpm: residual {:e} of {turned:e} J", snapshot.residual);
    assert!(snapshot.residual.abs() <= 1e-3 * turned, "{snapshot:?}");
}

#[test]
fn a_ball_forced_out_is_a_typed_error() {
    // The grooves have no shoulders: a load that bends no steel on earth is needed. Contacts are far too deep
    // before a ball is out.
    let problem = bearing(table_4_1(-5e-6), [1e7, 0.0, 0.0, 0.0, 0.0], 0.0);
    let options = fixed_step(1e-7, Start::Nominal);
    let mut simulation = Simulation::new(problem.clone(), options).unwrap();
    let error = (0..20_000).find_map(|_| simulation.step().err());
    assert!(
        matches!(&error, Some(SimulationError::Inside { other, .. }) if other.ends_with(" race")),
        "{error:?}"
    );
    // A ball that flies off between two steps.
    let layout = Layout::new(8, false);
    let mut state = start::nominal(&problem.assembly());
    state[layout.ball(VELOCITY) + 2] = 1.1e7 * problem.geometry.ball_radius;
    let mut simulation = Simulation::from_state(problem, options, state, 0.0).unwrap();
    match simulation.step().err() {
        Some(SimulationError::BallOutside { ball, time, step, distance, ball_radius }) => {
            assert_eq!(ball, "ball 3");
            assert!(distance > ball_radius);
            assert_eq!(step, simulation.steps);
            assert_eq!(time, simulation.time);
            assert!(simulation.state.iter().all(|value| value.is_finite()));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_step_far_beyond_the_limit_is_a_typed_error() {
    let problem = bearing(table_4_1(-5e-6), [0.0, 0.0, -500.0, 0.0, 0.0], 1000.0 * RPM);
    let options = RunOptions { energy_limit: 0.01, ..fixed_step(60e-6, Start::Equilibrium) };
    let mut simulation = Simulation::new(problem, options).unwrap();
    let error = (0..2000).find_map(|_| simulation.step().err());
    assert!(
        matches!(
            error,
            Some(
                SimulationError::Energy { .. }
                    | SimulationError::BallOutside { .. }
                    | SimulationError::NotFinite { .. }
            )
        ),
        "{error:?}"
    );
}

#[test]
fn energy_that_goes_missing_is_a_typed_error() {
    // Below the limit but coarse (ω h = 1.4): Runge–Kutta damps what the loads set swinging.
    let problem = bearing(table_4_1(-5e-6), [0.0, 0.0, -500.0, 0.0, 0.0], 1000.0 * RPM);
    let options = RunOptions { energy_limit: 0.01, ..fixed_step(6e-6, Start::Nominal) };
    let mut simulation = Simulation::new(problem, options).unwrap();
    let error = (0..500).find_map(|_| simulation.step().err());
    match error {
        Some(SimulationError::Energy { residual, turned_over, limit, .. }) => {
            assert!(residual < 0.0 && -residual > limit * turned_over);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_value_that_is_not_finite_is_named() {
    let problem = bearing(table_4_1(-5e-6), [0.0, 0.0, -500.0, 0.0, 0.0], 1000.0 * RPM);
    let mut simulation = simulation(&problem, 1e-6, Start::Equilibrium);
    let at = simulation.system.sets[0].layout.inner();
    simulation.state[at + VELOCITY + 1] = f64::NAN;
    let error = (0..3).find_map(|_| simulation.step().err());
    assert!(matches!(error, Some(SimulationError::NotFinite { .. })), "{error:?}");
    let error = Simulation::new(problem, fixed_step(f64::NAN, Start::Equilibrium)).err();
    assert!(matches!(error, Some(SimulationError::Step(_))), "{error:?}");
}
