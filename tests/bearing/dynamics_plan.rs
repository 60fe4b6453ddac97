//! Leaving a part out equals running it with zero parameters; drivers and restarts change no bit;
//! the work done is counted.

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::cage::{CageForce, Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::geometry::{BearingGeometry, ClearanceThrough};
use bearing_dynamics::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use bearing_dynamics::members::body::{Drive, RotatingLoad, Rotation};
use bearing_dynamics::members::contacts::{Kernel, Work};
use bearing_dynamics::members::state::{BODY, Layout, Ledger, SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{RunOptions, Simulation, Start};
use bearing_dynamics::numeric::profile::Profile;
use common::{table_4_1, table_5_3};
use dynamics::*;
use nalgebra::Vector3;

/// Table 4.1's bearing with as many balls, on a larger circle where that does not hold them.
fn with_balls(balls: usize) -> BearingGeometry {
    let (pitch, ball) = (26e-3 * f64::max(1.0, balls as f64 / 12.0), 5.953e-3);
    BearingGeometry::deep_groove(balls, pitch - ball, 6.013e-3, pitch + ball, 6.310e-3, ball)
        .with_radial_clearance(-5e-6, ClearanceThrough::Ball)
}

/// A bearing at work: radial load, speed, damping, traction.
fn at_work(balls: usize, law: usize) -> DynamicProblem {
    let mut problem = bearing(with_balls(balls), [50.0, 0.0, -800.0, 0.0, 0.0], 1000.0 * RPM);
    problem.traction = traction_laws()[law].clone();
    problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
    problem
}

const STEP: f64 = 1e-6;

fn after(problem: &DynamicProblem, steps: usize) -> Simulation {
    let mut simulation = simulation(problem, STEP, Start::Equilibrium);
    run(&mut simulation, steps);
    simulation
}

/// Balls, races and ledger of a state; no cage.
fn without_cage(layout: &Layout, state: &[f64]) -> Vec<f64> {
    let mut all = state[..layout.cage()].to_vec();
    all.extend(&state[layout.ledger()..]);
    all
}

/// Bits, with both zeros the same.
fn value_bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| (value + 0.0).to_bits()).collect()
}

/// Both problems end in the same state, bit for bit.
fn check_twins(one: &DynamicProblem, other: &DynamicProblem) {
    let ends = [one, other].map(|problem| {
        let end = after(problem, 300);
        without_cage(&end.system.sets[0].layout, &end.state)
    });
    assert!(ends[0].iter().any(|value| *value != 0.0));
    assert_eq!(value_bits(&ends[0]), value_bits(&ends[1]));
}

#[test]
fn no_cage_equals_a_cage_that_touches_nothing() {
    let one = at_work(8, 1);
    for guidance in [Guidance::Balls, Guidance::InnerRace, Guidance::OuterRace] {
        let mut other = one.clone();
        let mut body = cage(&one.geometry, Pocket::Cylindrical, guidance);
        body.contacts.pocket_radius = 1.0;
        body.contacts.race_clearance = 1.0;
        other.cage = Some(body);
        check_twins(&one, &other);
    }
}

#[test]
fn no_cage_equals_a_cage_of_no_stiffness() {
    let one = at_work(8, 1);
    for force in [CageForce::Penalty { stiffness: 0.0 }, CageForce::Hertz { stiffness: 0.0 }] {
        let mut other = one.clone();
        let mut body = cage(&one.geometry, Pocket::Spherical, Guidance::OuterRace);
        body.contacts.force = force;
        // Moved aside, so that balls lie in the walls of their pockets and the ring in its guide.
        body.contacts.pocket_radius = one.geometry.ball_radius + 10e-6;
        body.contacts.race_clearance = 10e-6;
        other.cage = Some(body);
        let mut touching = simulation(&other, STEP, Start::Equilibrium);
        let at = touching.system.sets[0].layout.cage();
        touching.state[at..at + 3].copy_from_slice(&[0.1e-3, 0.1e-3, 0.0]);
        run(&mut touching, 300);
        assert!(touching.system.sets[0].pockets.iter().all(|pocket| pocket.penetration > 0.0));
        assert!(touching.system.sets[0].guides.iter().all(|guide| guide.penetration > 0.0));
        let end = after(&one, 300);
        let ends =
            [&end, &touching].map(|end| without_cage(&end.system.sets[0].layout, &end.state));
        assert_eq!(value_bits(&ends[0]), value_bits(&ends[1]));
    }
}

#[test]
fn a_cage_without_friction_turns_no_ball() {
    for pocket in [Pocket::Cylindrical, Pocket::Spherical] {
        let mut problem = at_work(8, 0);
        let mut body = cage(&problem.geometry, pocket, Guidance::OuterRace);
        body.contacts.friction = 0.0;
        body.contacts.pocket_radius = problem.geometry.ball_radius + 50e-6;
        problem.cage = Some(body);
        let mut simulation = simulation(&problem, STEP, Start::Equilibrium);
        let layout = simulation.system.sets[0].layout;
        let at = layout.cage() + VELOCITY;
        simulation.state[at..at + 3].copy_from_slice(&[0.5, -0.3, 0.4]);
        let spins = |state: &[f64]| -> Vec<Vector3<f64>> {
            (0..8).map(|ball| layout.ball_vector(state, SPIN, ball).into()).collect()
        };
        let before = spins(&simulation.state);
        let mut largest = 0.0_f64;
        for _ in 0..300 {
            simulation.step().unwrap();
            let loads = simulation.system.sets[0].pockets.iter().map(|pocket| pocket.normal_load);
            largest = loads.fold(largest, f64::max);
        }
        assert!(largest > 10.0, "no ball was hit: {largest} N");
        assert_eq!(ledger(&simulation, Ledger::CageFriction), 0.0);
        // What is left is rounding of arm × (load · normal): 1e-16 of 800 N on 6 mm turn a ball of
        // 1e-7 kg m² by 5e-9 rad/s², for 0.3 ms.
        for (spin, first) in spins(&simulation.state).iter().zip(&before) {
            assert!((spin - first).norm() <= 1e-11, "{}", spin - first);
        }
    }
}

#[test]
fn no_traction_equals_a_coefficient_of_zero() {
    let one = at_work(8, 0);
    let flat = ExponentialCurve { b: 0.0, c: 100.0, d: 0.0 };
    let zeros = [
        TractionLaw::SlideToRoll { curve: flat, entrainment_floor: 0.01 },
        TractionLaw::SlipSpeed { curve: flat },
        TractionLaw::Constant { coefficient: 0.0, regularisation_speed: 0.05 },
    ];
    for traction in zeros {
        let mut other = one.clone();
        other.traction = traction;
        check_twins(&one, &other);
    }
}

#[test]
fn no_damping_equals_a_factor_of_zero() {
    let mut one = at_work(8, 1);
    one.damping = ContactDamping::None;
    let mut other = one.clone();
    other.damping = ContactDamping::HuntCrossley { alpha: 0.0 };
    check_twins(&one, &other);
}

#[test]
fn loads_of_zero_equal_none() {
    let one = at_work(8, 1);
    let mut other = one.clone();
    other.gravity = [0.0, -0.0, 0.0];
    other.rotating_load =
        Some(RotatingLoad { force: Profile::ZERO, speed: Profile::Constant(100.0), phase: 0.3 });
    other.inner.foundation_stiffness = [0.0; 5];
    check_twins(&one, &other);
    // Gravity on a bearing of weightless force: it does act when it is there.
    other.gravity = GRAVITY;
    let ends = [&one, &other].map(|problem| after(problem, 10).state);
    assert_ne!(value_bits(&ends[0]), value_bits(&ends[1]));
}

#[test]
fn a_fixed_outer_race_equals_one_held_by_drives() {
    let mut one = at_work(8, 1);
    one.outer_start = [1e-6, -2e-6, 3e-6, 1e-4, -2e-4];
    let mut other = one.clone();
    let mut outer = free_race();
    outer.rotation = Rotation::Speed(Profile::ZERO);
    outer.drives = one.outer_start.map(|value| Drive::Motion(Profile::Constant(value)));
    other.outer = Some(outer);
    let [fixed, held] = [&one, &other].map(|problem| after(problem, 300));
    // Tilts pass through an angle and back at every evaluation: their last bits (1e-20 rad on an
    // arm of 26 mm) differ from those of an orientation made once. The overlaps of some 1e-6 m see
    // 1e-17 m of the balls' positions at most.
    assert!(difference(&one, &fixed.state, &held.state) <= 1e-10);
    // Without tilts there is nothing to round: the same bits.
    one.outer_start = [1e-6, -2e-6, 3e-6, 0.0, 0.0];
    let outer = other.outer.as_mut().unwrap();
    outer.drives = one.outer_start.map(|value| Drive::Motion(Profile::Constant(value)));
    other.outer_start = one.outer_start;
    let ends = [&one, &other].map(|problem| {
        let end = after(problem, 300);
        let mut all = end.state.clone();
        // The outer race's own entries only mean something if it moves.
        let at = end.system.sets[0].layout.outer();
        all[at..at + BODY].fill(0.0);
        all
    });
    assert_eq!(value_bits(&ends[0]), value_bits(&ends[1]));
}

/// Largest difference of velocities, m/s.
fn difference(problem: &DynamicProblem, a: &[f64], b: &[f64]) -> f64 {
    let layout = Layout::new(problem.geometry.ball_count, false);
    (0..layout.balls)
        .map(|ball| {
            let [a, b] = [a, b].map(|state| Vector3::from(layout.ball_state(state, ball).velocity));
            (a - b).norm()
        })
        .fold(0.0, f64::max)
}

#[test]
fn both_drivers_run_with_the_same_bits() {
    for law in 0..4 {
        for balls in [7, 8, 9, 11, 16] {
            // Sixteen balls of this size need a wider pitch.
            let mut problem = at_work(balls, law);
            problem.points_across = 1 + law % 3;
            problem.cage = Some(cage(&problem.geometry, Pocket::Cylindrical, Guidance::OuterRace));
            problem.gravity = GRAVITY;
            let ends = [Kernel::Scalar, Kernel::Simd].map(|driver| {
                let options = RunOptions { driver, ..fixed_step(STEP, Start::Equilibrium) };
                let mut simulation = Simulation::new(problem.clone(), options).unwrap();
                run(&mut simulation, 200);
                (simulation.state, simulation.system.work)
            });
            assert_eq!(bits(&ends[0].0), bits(&ends[1].0), "law {law}, {balls} balls");
            assert_eq!(ends[0].1, ends[1].1);
        }
    }
}

#[test]
fn simulations_side_by_side_have_the_bits_of_one_alone() {
    // A simulation is one thread's work; what others do beside it changes nothing.
    let problems = [at_work(8, 1), at_work(11, 2), at_work(9, 3)];
    let alone: Vec<_> = problems.iter().map(|problem| bits(&after(problem, 200).state)).collect();
    for (problem, expected) in problems.iter().zip(&alone) {
        std::thread::scope(|scope| {
            let runs = [0; 4].map(|_| scope.spawn(|| bits(&after(problem, 200).state)));
            for run in runs {
                assert_eq!(&run.join().unwrap(), expected);
            }
        });
    }
}

#[test]
fn going_on_from_a_state_changes_no_bit() {
    for law in 0..4 {
        let mut problem = at_work(8, law);
        problem.cage = Some(cage(&problem.geometry, Pocket::Spherical, Guidance::InnerRace));
        problem.outer = Some(free_race());
        problem.outer.as_mut().unwrap().foundation_stiffness = [1e8, 1e8, 1e8, 1e4, 1e4];
        problem.inner.drives[3] = Drive::Motion(Profile::Constant(1e-4));
        let mut through = after(&problem, 150);
        let options = fixed_step(STEP, Start::Nominal);
        let (state, time) = (through.state.clone(), through.time);
        let mut resumed = Simulation::from_state(problem, options, state, time).unwrap();
        let missing = through.snapshot().residual;
        run(&mut through, 150);
        run(&mut resumed, 150);
        assert_eq!(bits(&through.state), bits(&resumed.state), "law {law}");
        // The energy is balanced from the restart on; rounding of energies of 20 J.
        let since = through.snapshot().residual - missing;
        let residual = resumed.snapshot().residual;
        assert!((residual - since).abs() <= 1e-13, "{residual} J against {since} J");
    }
}

#[test]
fn work_is_counted_exactly() {
    let steps = 50;
    // Preloaded: all sixteen contacts are closed at every evaluation.
    let mut problem = bearing(table_4_1(-20e-6), [0.0; 5], 1000.0 * RPM);
    problem.traction = CONSTANT;
    let evaluations = 4 * steps + 1;
    let closed = Work {
        evaluations,
        distance_tests: 2 * 8 * evaluations,
        loaded_contacts: 16 * evaluations,
        slices: 15 * 16 * evaluations,
        pocket_tests: 0,
        guide_tests: 0,
        ball_tests: 8 * evaluations,
        factorisations: 0,
        rejected_steps: 0,
    };
    assert_eq!(after(&problem, steps as usize).system.work, closed);
    // No traction: no slices.
    problem.traction = TractionLaw::None;
    assert_eq!(after(&problem, steps as usize).system.work, Work { slices: 0, ..closed });
    // A cage guided by a race: a test a ball and one at each end; by the balls: no guide.
    for (guidance, guide_tests) in [(Guidance::OuterRace, 2), (Guidance::Balls, 0)] {
        problem.cage = Some(cage(&problem.geometry, Pocket::Cylindrical, guidance));
        let expected = Work {
            slices: 0,
            pocket_tests: 8 * evaluations,
            guide_tests: guide_tests * evaluations,
            // Pockets keep the balls apart.
            ball_tests: 0,
            ..closed
        };
        assert_eq!(after(&problem, steps as usize).system.work, expected);
    }
    // Idle pairs: a distance test and nothing more.
    let mut idle = bearing(table_4_1(100e-6), [0.0; 5], 1000.0 * RPM);
    idle.traction = CONSTANT;
    for (i, drive) in idle.inner.drives.iter_mut().enumerate() {
        *drive = Drive::Motion(Profile::Constant(if i == 2 { 1e-6 } else { 0.0 }));
    }
    let mut simulation = simulation(&idle, STEP, Start::Nominal);
    run(&mut simulation, steps as usize);
    let first = simulation.system.work;
    assert_eq!(first.distance_tests, 16 * evaluations);
    // Balls that orbit in clearance fly outwards until they touch; not within 50 µs at this speed
    // (½ · 43 m/s² · (50 µs)² = 0.05 µm of 50 µm).
    assert_eq!((first.loaded_contacts, first.slices), (0, 0));
    assert_eq!(table_5_3().ball_count, 11);
}
