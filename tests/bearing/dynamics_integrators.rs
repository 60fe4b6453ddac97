//! Integrators with error estimate: their coefficients, orders, stability, and whether the accuracy
//! that is asked for is delivered.

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::body::{Drive, RotatingLoad};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::state::{
    BODY, Layout, Ledger, ORIENTATION, POSITION, SPIN, VELOCITY,
};
use bearing_dynamics::motion::error_control::{Attempt, SHARE};
use bearing_dynamics::motion::orbit_frame::OrbitFrames;
use bearing_dynamics::motion::simulation::{
    Integrator, RunOptions, Simulation, SimulationError, Stepping,
};
use bearing_dynamics::motion::{dormand_prince as dopri, rosenbrock as ros, start};
use bearing_dynamics::numeric::profile::Profile;
use common::table_4_1;
use dynamics::{
    CONSTANT, GRAVITY, Noise, RPM, bearing, bits, cage, inner_state, ledger, traction_laws,
};
use nalgebra::{UnitQuaternion, Vector3};

/// Tables 3.5 and 4.1 at 5 µm interference, 1000 rpm, 1500 N down, default friction.
pub fn rolling() -> DynamicProblem {
    let loads = [0.0, 0.0, -1500.0, 0.0, 0.0];
    DynamicProblem {
        traction: traction_laws().swap_remove(2),
        ..bearing(table_4_1(-5e-6), loads, 1000.0 * RPM)
    }
}

/// The same with Hunt–Crossley damping, under which the ringing of the start dies out.
pub fn damped() -> DynamicProblem {
    DynamicProblem { damping: ContactDamping::HuntCrossley { alpha: 0.2 }, ..rolling() }
}

/// Traction so gentle that explicit steps are bound by the contacts alone.
pub fn gentle() -> DynamicProblem {
    let traction = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 20.0 };
    DynamicProblem { traction, ..damped() }
}

pub fn started(problem: &DynamicProblem, integrator: Integrator, stepping: Stepping) -> Simulation {
    let options =
        RunOptions { integrator, stepping, energy_limit: f64::INFINITY, ..RunOptions::default() };
    Simulation::new(problem.clone(), options).unwrap()
}

/// Positions of the inner race at `rows` equal times to `end`; every step ends at most at a row.
pub fn motion(
    problem: &DynamicProblem,
    integrator: Integrator,
    stepping: Stepping,
    end: f64,
    rows: usize,
) -> (Vec<[f64; 3]>, Simulation) {
    let mut simulation = started(problem, integrator, stepping);
    (rows_of(&mut simulation, end, rows), simulation)
}

pub fn rows_of(simulation: &mut Simulation, end: f64, rows: usize) -> Vec<[f64; 3]> {
    let mut positions = Vec::new();
    for row in 1..=rows {
        let time = end * row as f64 / rows as f64;
        loop {
            let left = time - simulation.time;
            // Fixed steps divide the rows but for rounding.
            let reached = left <= simulation.step_size * (1.0 + 1e-6);
            let step = if reached { left } else { simulation.step_size.min(0.6 * left) };
            if simulation.step_by(step).unwrap() == left {
                simulation.time = time;
                break;
            }
        }
        positions.push(inner_state(simulation).position);
    }
    positions
}

fn largest_difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn coefficients_fulfil_the_order_conditions_with_any_jacobian() {
    // Hairer and Wanner, Solving ODEs II, IV.7: α, γ with the diagonal, row sums.
    let alpha = ros::ALPHA.map(|row| [row[0], row[1], row[2], 0.0]);
    let mut gamma = ros::GAMMAS.map(|row| [row[0], row[1], row[2], 0.0]);
    for (i, row) in gamma.iter_mut().enumerate() {
        row[i] = ros::GAMMA;
    }
    let sums = |of: &[[f64; 4]; 4]| of.map(|row| row.iter().sum::<f64>());
    let dot = |a: &[f64; 4], b: &[f64; 4]| (0..4).map(|i| a[i] * b[i]).sum::<f64>();
    let times = |of: &[[f64; 4]; 4], by: &[f64; 4]| of.map(|row| dot(&row, by));
    let (a, g) = (sums(&alpha), sums(&gamma));
    let second = |b: &[f64; 4]| [(dot(b, &[1.0; 4]), 1.0), (dot(b, &a), 0.5), (dot(b, &g), 0.0)];
    let b = &ros::WEIGHTS;
    let third = [
        (dot(b, &a.map(|a| a * a)), 1.0 / 3.0),
        (dot(b, &times(&alpha, &a)), 1.0 / 6.0),
        (dot(b, &times(&alpha, &g)), 0.0),
        (dot(b, &times(&gamma, &a)), 0.0),
        (dot(b, &times(&gamma, &g)), 0.0),
    ];
    // As good as the published digits are.
    for (found, wanted) in second(b).into_iter().chain(third).chain(second(&ros::EMBEDDED)) {
        assert!((found - wanted).abs() <= 5e-12, "{found} for {wanted}");
    }
    // Not of third order, or it would estimate nothing.
    assert!((dot(&ros::EMBEDDED, &a.map(|a| a * a)) - 1.0 / 3.0).abs() >= 1e-2);
    // Stiffly accurate.
    for j in 0..4 {
        assert!((b[j] - alpha[3][j] - gamma[3][j]).abs() <= 1e-15);
    }
    // Dormand and Prince: quadrature to fifth order, fourth of the difference.
    for (row, c) in dopri::A.iter().zip(dopri::C) {
        assert!((row.iter().sum::<f64>() - c).abs() <= 1e-14);
    }
    for power in 0..5 {
        let moment =
            |b: &dyn Fn(usize) -> f64| (0..7).map(|i| b(i) * dopri::C[i].powi(power)).sum::<f64>();
        let fifth = moment(&|i| if i < 6 { dopri::A[6][i] } else { 0.0 });
        assert!((fifth - 1.0 / f64::from(power + 1)).abs() <= 1e-14);
        let difference = moment(&|i| dopri::DIFFERENCE[i]).abs();
        assert!(if power < 4 { difference <= 1e-14 } else { difference >= 1e-4 });
    }
}

/// A simulation from the equilibrium start after `push` has changed its state.
fn pushed(
    problem: &DynamicProblem,
    integrator: Integrator,
    step: f64,
    push: impl Fn(&Layout, &mut [f64]),
) -> Simulation {
    let layout = Layout::new(problem.geometry.ball_count, problem.cage.is_some());
    let mut state = start::at_equilibrium(&problem.assembly()).unwrap();
    push(&layout, &mut state);
    let stepping = Stepping::Fixed(step);
    let options =
        RunOptions { integrator, stepping, energy_limit: f64::INFINITY, ..RunOptions::default() };
    Simulation::from_state(problem.clone(), options, state, 0.0).unwrap()
}

/// Largest error over 0.4 ms for each step, over that of half the step, as an order; the race, which
/// hardly swings after a start, and the balls are pushed to swing by some 50 nm.
fn orders(problem: &DynamicProblem, integrator: Integrator, steps: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let rows = |integrator, step| {
        let mut simulation = pushed(problem, integrator, step, |layout, state| {
            state[layout.inner() + VELOCITY + 2] += 3e-3;
            for ball in 0..layout.balls {
                state[layout.ball(VELOCITY + 2) + ball] -= 3e-3;
            }
        });
        rows_of(&mut simulation, 4e-4, 25)
    };
    let reference = rows(Integrator::DormandPrince, 2.5e-7);
    let error = |&step: &f64| largest_difference(&rows(integrator, step), &reference);
    let errors: Vec<f64> = steps.iter().map(error).collect();
    let orders = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    (errors, orders)
}

#[test]
fn orders_on_smooth_motion_are_three_and_five() {
    let problem = gentle();
    let (errors, found) = orders(&problem, Integrator::Rosenbrock, &[2e-6, 1e-6, 5e-7]);
    assert!(found.iter().all(|order| (order - 3.0).abs() <= 0.25), "{errors:?} {found:?}");
    let (errors, found) = orders(&problem, Integrator::DormandPrince, &[4e-6, 2e-6, 1e-6]);
    assert!(found.iter().all(|order| (order - 5.0).abs() <= 0.4), "{errors:?} {found:?}");
}

#[test]
fn tiny_steps_of_both_methods_agree_with_runge_kutta() {
    // With default traction, whose limit for explicit steps is 1.6e-7 s.
    let problem = rolling();
    let reference = motion(&problem, Integrator::RungeKutta, Stepping::Fixed(5e-8), 2e-4, 4).0;
    for (integrator, step) in [(Integrator::Rosenbrock, 5e-8), (Integrator::DormandPrince, 5e-8)] {
        let found = motion(&problem, integrator, Stepping::Fixed(step), 2e-4, 4).0;
        let error = largest_difference(&found, &reference);
        // A part 1e-6 of the overlap of 9 µm.
        assert!(error <= 1e-11, "{integrator:?} is off by {error:e} m");
    }
}

#[test]
fn steps_a_hundred_times_the_explicit_limit_are_stable() {
    let limit = 1.75e-7;
    let explicit = started(&rolling(), Integrator::RungeKutta, Stepping::FractionOfLimit(1.0));
    assert!((explicit.step_size / limit - 1.0).abs() <= 0.02, "{}", explicit.step_size);
    let step = 100.0 * limit;
    let mut simulation = started(&rolling(), Integrator::Rosenbrock, Stepping::Fixed(step));
    let start = inner_state(&simulation).position;
    for _ in 0..2000 {
        simulation.step().unwrap();
    }
    // It moves by its varying compliance, tens of nanometres.
    let now = inner_state(&simulation).position;
    let moved = largest_difference(&[now], &[start]);
    assert!(moved <= 1e-7, "{moved:e}");
}

/// Rows of the history of the blow up to 1.2 ms: later the race, thrown back, loses contacts.
const BEFORE_LOSS: usize = 20;

/// The same at 10 000 rpm: centrifugal forces, and orbits that turn by some milliradians a step.
pub fn fast() -> DynamicProblem {
    bearing(table_4_1(-5e-6), [0.0, 0.0, -1500.0, 0.0, 0.0], 10_000.0 * RPM)
}

/// Scenes of different kinds: name, problem, end.
fn scenes() -> Vec<(&'static str, DynamicProblem, f64)> {
    let mut turning = rolling();
    turning.inner.drives[2] = Drive::Load(Profile::ZERO);
    let force = Profile::Constant(250.0);
    turning.rotating_load =
        Some(RotatingLoad { force, speed: Profile::Constant(50.0 * RPM), phase: 0.3 });
    // With clearance balls enter the load zone and leave it.
    let loads = [0.0, 0.0, -300.0, 0.0, 0.0];
    let loose = bearing(table_4_1(5e-6), loads, 6000.0 * RPM);
    let parting = DynamicProblem { traction: rolling().traction, ..loose };
    let mut impact = damped();
    impact.inner.drives[2] =
        Drive::Load(Profile::HalfSine { base: -500.0, peak: -3000.0, start: 5e-4, duration: 1e-3 });
    let smooth = DynamicProblem { traction: TractionLaw::None, ..fast() };
    let geometry = table_4_1(-5e-6);
    let caged = DynamicProblem {
        cage: Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace)),
        gravity: GRAVITY,
        ..rolling()
    };
    vec![
        ("rolling", rolling(), 5e-3),
        ("10 000 rpm", smooth, 5e-3),
        // Long enough for the cage to fall on a ball and be pushed on by it.
        ("cage", caged, 2e-2),
        ("rotating load", turning, 5e-3),
        ("parting", parting, 5e-3),
        ("impact", impact, 3e-3),
    ]
}

/// How many times larger than at the start a perturbation of the race's position by 1e-12 m gets.
fn growth(problem: &DynamicProblem, end: f64, reference: &[[f64; 3]]) -> f64 {
    let mut simulation = pushed(problem, Integrator::Rosenbrock, 2.5e-7, |layout, state| {
        state[layout.inner() + POSITION + 2] += 1e-12;
    });
    largest_difference(&rows_of(&mut simulation, end, 50), reference) / 1e-12
}

#[test]
fn the_accuracy_that_is_asked_for_is_delivered() {
    let mut lines = Vec::new();
    let mut kept = true;
    for (name, problem, end) in scenes() {
        let fine = Stepping::Fixed(2.5e-7);
        let reference = motion(&problem, Integrator::Rosenbrock, fine, end, 50).0;
        // After a blow contacts are lost and made again at times that depend on all before: what
        // errors there are grow as any perturbation does, and no choice of steps prevents that.
        let thrown = name == "impact";
        let whole = if thrown { BEFORE_LOSS } else { 50 };
        let growth = growth(&problem, end, &reference);
        lines.push(format!("{name}: perturbations grow {growth:.1} times"));
        kept &= if thrown { growth >= 100.0 } else { growth <= 10.0 };
        let mut steps_before = 0;
        for accuracy in [1e-2, 1e-3, 1e-4] {
            let stepping = Stepping::Accuracy(accuracy);
            let (found, simulation) = motion(&problem, Integrator::Rosenbrock, stepping, end, 50);
            let scale = simulation.control.as_ref().unwrap().memory.displacement;
            let error = largest_difference(&found[..whole], &reference[..whole]) / scale;
            let later = largest_difference(&found, &reference) / scale;
            kept &= error <= accuracy && simulation.steps > steps_before;
            // A twentieth of the accuracy when contact is lost, grown.
            kept &= !thrown || later <= 0.05 * growth * accuracy;
            steps_before = simulation.steps;
            let work = simulation.system.work;
            assert_eq!(work.factorisations, simulation.steps + work.rejected_steps);
            lines.push(format!(
                "{name} {accuracy}: {error:.1e}, whole history {later:.1e}, {steps_before} steps, {} rejected",
                work.rejected_steps
            ));
        }
    }
    println!("{lines:#?}");
    assert!(kept, "{lines:#?}");
}

#[test]
fn drivers_give_the_same_bits_and_rejected_steps_leave_no_trace() {
    let (_, problem, end) = scenes().pop().unwrap();
    let run = |driver| {
        let stepping = Stepping::Accuracy(1e-3);
        let options = RunOptions {
            integrator: Integrator::Rosenbrock,
            stepping,
            driver,
            ..RunOptions::default()
        };
        let mut simulation = Simulation::new(problem.clone(), options).unwrap();
        while simulation.time < end {
            simulation.step().unwrap();
        }
        simulation
    };
    let (plain, lanes) = (run(Kernel::Scalar), run(Kernel::Simd));
    assert!(lanes.system.work.rejected_steps > 0);
    assert_eq!(bits(&plain.state), bits(&lanes.state));
    assert_eq!(plain.system.work, lanes.system.work);
    // A step far too long is thrown away until it is the one that was tried at once.
    let mut long = started(&problem, Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    let taken = long.step_by(1e-3).unwrap();
    assert!(taken < 1e-3 && long.system.work.rejected_steps > 0);
    let mut once = started(&problem, Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    assert_eq!(once.step_by(taken).unwrap(), taken);
    assert_eq!(bits(&long.state), bits(&once.state));
}

#[test]
fn recorded_contact_forces_hold_the_load_and_the_energy_balances() {
    let problem = damped();
    let stepping = Stepping::Accuracy(1e-3);
    let mut simulation = motion(&problem, Integrator::Rosenbrock, stepping, 5e-3, 50).1;
    let snapshot = simulation.snapshot();
    assert!(simulation.system.sets[0].on_races[0].force[2] > 0.0);
    // Newton's law for the race, whose acceleration is what the rates say, traction included.
    let at = simulation.system.sets[0].layout.inner() + 7;
    let mut rates = vec![0.0; simulation.state.len()];
    simulation.system.evaluate(simulation.time, &simulation.state.clone(), &mut rates);
    for (i, load) in [0.0, 0.0, -1500.0].into_iter().enumerate() {
        let expected = problem.inner.inertia.mass * rates[at + i];
        let sum = simulation.system.sets[0].on_races[0].force[i] + load;
        assert!((sum - expected).abs() <= 1e-9, "{sum} {expected}");
    }
    // Equilibrium but for the race's own slow motion.
    let forces = simulation.system.sets[0].on_races[0].force;
    assert!((forces[2] - 1500.0).abs() <= 1.0 && forces[1].abs() <= 1.0, "{forces:?}");
    // Traction takes energy. What is unaccounted for is far below the energy in the contacts; most of
    // it goes in the first steps, before sliding and ringing of the start have died out.
    assert!(ledger(&simulation, Ledger::Traction) < 0.0);
    let part = snapshot.residual.abs() / snapshot.energy.contact;
    assert!(part <= 5e-3, "{part:e}");
}

#[test]
fn impossible_steps_are_refused_by_name() {
    let start = |integrator, stepping| {
        let options = RunOptions { integrator, stepping, ..RunOptions::default() };
        Simulation::new(rolling(), options).err()
    };
    use Integrator::{DormandPrince, Rosenbrock, RungeKutta};
    let refused = start(RungeKutta, Stepping::Accuracy(1e-3)).unwrap();
    assert_eq!(refused, SimulationError::NoErrorEstimate);
    assert!(refused.to_string().contains("rosenbrock"));
    for integrator in [Rosenbrock, DormandPrince] {
        let refused = start(integrator, Stepping::FractionOfLimit(0.5)).unwrap();
        assert_eq!(refused, SimulationError::FractionOfOther(integrator.name()));
    }
    for accuracy in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = start(Rosenbrock, Stepping::Accuracy(accuracy)).unwrap();
        assert!(matches!(refused, SimulationError::Accuracy(_)), "{refused:?}");
    }
    assert_eq!(start(Rosenbrock, Stepping::Fixed(1e-6)), None);
}

#[test]
fn dormand_prince_delivers_its_accuracy_without_stiff_traction() {
    let problem = DynamicProblem { traction: CONSTANT, ..damped() };
    for problem in [gentle(), problem] {
        let reference = Stepping::Fixed(2.5e-7);
        let reference = motion(&problem, Integrator::Rosenbrock, reference, 2e-3, 20).0;
        let stepping = Stepping::Accuracy(1e-3);
        let (found, simulation) = motion(&problem, Integrator::DormandPrince, stepping, 2e-3, 20);
        let scale = simulation.control.as_ref().unwrap().memory.displacement;
        let error = largest_difference(&found, &reference) / scale;
        assert!(error <= 1e-3, "{error:e}");
        // Six a step: the seventh stage is the first of the next; two at the start, a snapshot none.
        let work = simulation.system.work;
        let attempts = simulation.steps + work.rejected_steps;
        assert_eq!(work.evaluations, 6 * attempts + 2);
        assert_eq!(work.factorisations, 0);
    }
}

/// Position, velocity and spin of every ball turn, its orientation and all other bodies do not.
#[test]
fn frames_turn_with_the_orbits_of_their_balls() {
    let layout = Layout::new(11, false);
    let mut noise = Noise(7);
    let mut random = || (0..layout.len()).map(|_| noise.next()).collect::<Vec<f64>>();
    let (state, rates) = (random(), random());
    let mut frames = OrbitFrames::new(&layout);
    frames.follow(&layout, &state);
    let time = 0.3;
    let (mut inertial, mut in_frame) = (state.clone(), rates.clone());
    frames.turn(time);
    frames.to_inertial(&layout, &mut inertial);
    frames.rates_to_frame(&layout, &state, &mut in_frame);
    let mut turning = vec![false; layout.len()];
    for ball in 0..layout.balls {
        let of = |list: &[f64], component| Vector3::from(layout.ball_vector(list, component, ball));
        let (x, v) = (of(&state, POSITION), of(&state, VELOCITY));
        let omega = Vector3::x() * (x.cross(&v).x / (x.y * x.y + x.z * x.z));
        let turn = UnitQuaternion::from_scaled_axis(omega * time);
        for component in [POSITION, VELOCITY, SPIN] {
            let there = turn * of(&state, component);
            let rate = of(&rates, component) - omega.cross(&of(&state, component));
            let error = (of(&inertial, component) - there).norm();
            let of_rate = (of(&in_frame, component) - turn.inverse() * rate).norm();
            // Angular velocities of random balls go up to some hundred 1/s.
            assert!(error <= 1e-12 && of_rate <= 1e-12 * (1.0 + omega.norm()), "{error} {of_rate}");
            for i in 0..3 {
                turning[layout.ball(component + i) + ball] = true;
            }
        }
    }
    for at in (0..layout.len()).filter(|at| !turning[*at]) {
        assert_eq!((inertial[at], in_frame[at]), (state[at], rates[at]), "{at}");
    }
}

/// Every error counts by its displacement: velocities over the frequency of the body on a contact at
/// the largest overlap, angles times the radius at which they are felt.
#[test]
fn errors_count_by_the_displacement_they_make() {
    let geometry = table_4_1(-5e-6);
    let mut problem = rolling();
    problem.cage = Some(cage(&geometry, Pocket::Spherical, Guidance::OuterRace));
    let cage = problem.cage.as_ref().unwrap().inertia;
    let simulation = started(&problem, Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    let control = simulation.control.as_ref().unwrap();
    let layout = simulation.system.sets[0].layout;
    let overlap = control.memory.displacement;
    let unit = SHARE * 1e-3 * overlap;
    let hertz = problem.inner_contact.stiffness.min(problem.outer_contact.stiffness);
    let frequency = |mass: f64| (1.5 * hertz * overlap.sqrt() / mass).sqrt();
    let ball = (problem.ball.mass, geometry.ball_radius);
    let hub = |mass| (mass, geometry.pitch_radius);
    let bodies = [
        (layout.ball(0) + 3, layout.padded, ball),
        (layout.inner(), 1, hub(problem.inner.inertia.mass)),
        (layout.cage(), 1, hub(cage.mass)),
    ];
    for (at, stride, (mass, arm)) in bodies {
        let wanted = |i: usize| match i {
            POSITION..ORIENTATION => Some(1.0),
            // A quaternion has half the angle.
            ORIENTATION..VELOCITY if stride == 1 => Some(2.0 * arm),
            // The orientation of a ball moves nothing.
            ORIENTATION..VELOCITY => None,
            VELOCITY..SPIN => Some(1.0 / frequency(mass)),
            _ => Some(arm / frequency(mass)),
        };
        for i in 0..BODY {
            let mut attempt = Attempt::new(simulation.state.len());
            attempt.error[at + i * stride] = -3e-9;
            let norm = control.norm(&attempt);
            let expected = wanted(i).unwrap_or(0.0) * 3e-9 / unit;
            assert!((norm - expected).abs() <= 1e-12 * expected, "{at}, {i}: {norm} {expected}");
        }
    }
}

/// One value that is not a number anywhere spoils the norm, whatever stands behind it.
#[test]
fn an_error_that_is_not_a_number_is_never_good_enough() {
    let simulation = started(&rolling(), Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    let control = simulation.control.as_ref().unwrap();
    let length = simulation.state.len();
    let layout = simulation.system.sets[0].layout;
    for at in [layout.ball(POSITION), layout.ball(VELOCITY) + 1, layout.inner() + POSITION] {
        let mut attempt = Attempt::new(length);
        attempt.error.fill(1e-15);
        assert!(control.norm(&attempt).is_finite());
        attempt.error[at] = f64::NAN;
        assert!(control.norm(&attempt).is_nan(), "entry {at}");
    }
}
