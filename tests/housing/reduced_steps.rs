//! Reduced housings in steps: energy, the matrix of an implicit step, the limit of explicit ones, error control.

#![allow(clippy::needless_range_loop)] // indices are the notation of components

use super::housing_reduced::{mounted, options, plain, rates_of, ring, settled, state_of};
use crate::{dynamics, housing_common};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::assembly::lists::{Assembly, INNER, OUTER};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::members::body::{Body, Drive, Mobility};
use bearing_dynamics::members::contacts::Want;
use bearing_dynamics::members::housing_fit::Seat;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::reduced_solid::{ModalLoad, ReducedSolid};
use bearing_dynamics::members::state::{POSITION, VELOCITY};
use bearing_dynamics::motion::block_arrow::BlockArrowMatrix;
use bearing_dynamics::motion::error_control::{Attempt, Controller, SHARE};
use bearing_dynamics::motion::linearised::Linearised;
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Stepping};
use bearing_dynamics::motion::stability::{growth, jacobian, step_limit};
use bearing_dynamics::numeric::profile::Profile;
use dynamics::*;
use housing_common::{BORE, YOUNG};
use nalgebra::Complex;

fn energy_closes(integrator: Integrator, stepping: Stepping, most: f64) {
    let mut housing = ring(YOUNG, |model| model.problem.damping = 2000.0, 60e3, 1e-2);
    let mut problem = mounted(0.0);
    problem.damping = ContactDamping::HuntCrossley { alpha: 1.0 };
    problem.inner.drives[2] =
        Drive::Load(Profile::HalfSine { base: 0.0, peak: -500.0, start: 1e-4, duration: 3e-4 });
    // It grows into its fit meanwhile.
    let mut assembly = settled(&mut housing, &problem, 0.0);
    assembly.seats[0].radius =
        Profile::SmoothRamp { from: BORE, to: BORE + 1e-6, start: 0.0, duration: 3e-4 };
    let count = assembly.solids[0].count();
    assembly.solids[0].loads.push(ModalLoad {
        forces: vec![0.01; count],
        profile: Profile::SmoothRamp { from: 0.0, to: 1.0, start: 0.0, duration: 2e-4 },
    });
    let mut simulation = Simulation::new(assembly, options(integrator, stepping)).unwrap();
    let (mut worst, mut seen) = (0.0f64, 0.0f64);
    while simulation.time < 6e-4 {
        for _ in 0..20 {
            simulation.step().unwrap();
        }
        let now = simulation.snapshot();
        let energy = now.energy;
        seen = seen.max(energy.solid_strain + energy.solid_kinetic + energy.seat);
        worst = if now.residual.abs() <= worst { worst } else { now.residual.abs() };
    }
    println!("{}: {worst:.2e} J of {seen:.2e} J in housing and seat", integrator.name());
    assert!(worst <= most * seen, "{worst:e} of {seen:e}");
}

/// Under a blow, while the race grows into its fit, with a load on the solid and both kinds of damping: what is missing
/// against what housing and seat hold.
#[test]
fn the_energy_of_a_blow_balances() {
    // Measured: 2e-11, 8e-9 and 7e-5; long implicit steps balance the work of what grows roughly.
    energy_closes(Integrator::RungeKutta, Stepping::FractionOfLimit(0.1), 1e-9);
    energy_closes(Integrator::DormandPrince, Stepping::Accuracy(1e-4), 1e-6);
    energy_closes(Integrator::Rosenbrock, Stepping::Accuracy(1e-4), 5e-4);
}

/// The matrix of an implicit step against differences of the equations of motion.
#[test]
fn the_matrix_is_the_slope_of_the_equations() {
    // In a tight fit more nodes touch than there are shapes, and the matrix is that of the shapes; in a loose one with shapes up
    // to high frequencies it is that of the nodes.
    for (interference, modes_to, by_shapes) in [(0.5e-6, 60e3, true), (-0.4e-6, 100e3, false)] {
        let mut housing = ring(YOUNG, |model| model.problem.damping = 3000.0, modes_to, 1e-2);
        let alone = settled(&mut housing, &mounted(400.0), interference);
        let mut more = alone.clone();
        // As if the other race, and one that does not move, were in the same bore: every seat of a solid is in one matrix.
        let seat = alone.seats[0].clone();
        more.bodies[INNER].rest = more.bodies[OUTER].rest;
        more.bodies.push(Body { mobility: Mobility::Fixed, ..more.bodies[OUTER].clone() });
        for body in [INNER, more.bodies.len() - 1] {
            more.seats.push(Seat { race: Mount::at_centre(body), ..seat.clone() });
        }
        for assembly in [alone, more] {
            is_the_slope(&assembly, by_shapes);
        }
    }
}

fn is_the_slope(assembly: &Assembly, by_shapes: bool) {
    let (mut system, state) = state_of(assembly);
    let mut first = vec![0.0; state.len()];
    system.evaluate_with(Want::ForcesAndSlopes, 0.0, &state, &mut first);
    let touching: Vec<usize> = system.seats.iter().map(|seat| seat.touching.len()).collect();
    let count = assembly.solids[0].count();
    println!("{touching:?} {count}");
    assert!(touching.iter().all(|nodes| *nodes > 5), "{touching:?}");
    assert_eq!(touching.iter().sum::<usize>() > count, by_shapes, "{touching:?} {count}");
    let mut linearised = Linearised::new(&system);
    linearised.update(&system, &state);
    let mut arrow = BlockArrowMatrix::new(&system, &linearised);
    let (at, bodies) = (system.solids[0], [OUTER, INNER].map(|body| system.places.body(body)));
    let mut noise = Noise(11);
    for h in [1e-7, 3e-6] {
        arrow.factor(&linearised, h);
        for displaced in [false, true] {
            let mut r = vec![0.0; state.len()];
            let size: Vec<f64> = assembly.solids[0].surfaces[0].largest().collect();
            let entry = if displaced { 0 } else { count };
            for k in 0..count {
                r[at + entry + k] = noise.next() / size[k];
            }
            let place = if displaced { POSITION } else { VELOCITY };
            for body in bodies {
                for (i, v) in noise.vector(1.0).into_iter().enumerate().skip(1) {
                    r[body + place + i] = v;
                }
            }
            let drift = vec![0.0; state.len()];
            let mut w = vec![0.0; state.len()];
            arrow.solve(&linearised, &system.sets, &state, &drift, &r, &mut w);
            // w − h J w = r, J w by differences along w.
            let scale = w[at..at + count].iter().zip(&size).map(|(w, s)| (w * s).abs());
            let step = 1e-10 / scale.fold(1e-9, f64::max).max(w[bodies[0] + 2].abs());
            let there = |sign: f64| -> Vec<f64> {
                state.iter().zip(&w).map(|(s, w)| s + sign * step * w).collect()
            };
            let [plus, minus] = [1.0, -1.0].map(|sign| {
                let rates = rates_of(&mut system, 0.0, &there(sign));
                let there = system.seats.iter().map(|seat| seat.touching.len());
                assert!(there.eq(touching.iter().copied()), "a node that only just touches");
                rates
            });
            let (mut worst, mut largest) = (0.0f64, 0.0f64);
            for entry in (at..at + 2 * count)
                .chain(bodies.into_iter().flat_map(|body| [1, 2].map(|i| body + VELOCITY + i)))
            {
                let change = h * (plus[entry] - minus[entry]) / (2.0 * step);
                let error = (w[entry] - change - r[entry]).abs();
                largest = largest.max(change.abs());
                worst = if error <= worst { worst } else { error };
            }
            println!("h {h:e}, {displaced}: {:.1e} of {largest:.1e}", worst / largest);
            // Left out: normals that turn, overlap over radius, and how balls' normals do. Measured: 1.3e-5.
            assert!(worst <= 1e-4 * largest, "{worst:e} of {largest:e}");
        }
    }
}

/// Against a step limit from its own Jacobian: the fastest of seat and shapes sets it.
#[test]
fn runge_kutta_knows_the_seat_and_the_shapes() {
    let mut housing = plain();
    let assembly = settled(&mut housing, &mounted(400.0), 1e-6);
    let (mut system, state) = state_of(&assembly);
    let limit = step_limit(&mut system, 0.0, &state).unwrap();
    let jacobian = jacobian(&mut system, 0.0, &state);
    let fastest = jacobian.complex_eigenvalues().iter().map(|v| v.norm()).fold(0.0, f64::max);
    assert!((limit.eigenvalue.norm() / fastest - 1.0).abs() <= 1e-6);
    let top = assembly.solids[0].frequencies.iter().copied().fold(0.0, f64::max);
    assert!(fastest > top, "the seat adds to the stiffest shape: {fastest:e} {top:e}");
    let reason = limit.reason(&system.assembly);
    assert!(reason.starts_with("oscillation at "), "{reason}");
    assert!((growth(Complex::new(0.0, fastest) * limit.step) - 1.0).abs() <= 1e-5);
    // Above it a run blows up or is refused, below it goes on.
    let run = |step: f64| {
        let options = RunOptions {
            energy_limit: f64::INFINITY,
            ..options(Integrator::RungeKutta, Stepping::Fixed(step))
        };
        let mut simulation = Simulation::new(assembly.clone(), options).unwrap();
        (0..4000).try_for_each(|_| simulation.step()).is_ok_and(|()| {
            let held = simulation.snapshot().energy;
            held.solid_kinetic < held.contact
        })
    };
    assert!(run(0.9 * limit.step));
    assert!(!run(1.2 * limit.step));
}

/// No solid and no seat: not a bit, not a count.
#[test]
fn empty_lists_change_nothing() {
    let problem = DynamicProblem { outer: None, ..mounted(400.0) };
    let alone = problem.assembly();
    let mut with = alone.clone();
    with.solids.push(ReducedSolid { name: "nothing".into(), ..ReducedSolid::default() });
    let run = |assembly: Assembly| {
        let options = options(Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
        let mut simulation = Simulation::new(assembly, options).unwrap();
        (0..200).for_each(|_| simulation.step().unwrap());
        (bits(&simulation.state), simulation.system.work)
    };
    assert_eq!(run(alone), run(with));
}

#[test]
fn error_control_sees_the_shapes() {
    let mut housing = plain();
    let assembly = settled(&mut housing, &mounted(400.0), 0.5e-6);
    let (system, state) = state_of(&assembly);
    let mut control = Controller::new(&assembly, 1e-3, 5.0);
    control.record(&system);
    let (at, count) = (system.solids[0], assembly.solids[0].count());
    let reach: Vec<f64> = assembly.solids[0].surfaces[0].largest().collect();
    let mut attempt = Attempt::new(state.len());
    assert_eq!(control.norm(&attempt), 0.0);
    for k in 0..count {
        // So much of the scale of displacements at the bore is what a step may miss.
        attempt.error[at + k] = SHARE * 1e-3 * control.memory.displacement / reach[k];
        assert!((control.norm(&attempt) - 1.0).abs() <= 1e-9, "{k}");
        attempt.error[at + k] = 0.0;
        attempt.error[at + count + k] = f64::NAN;
        assert!(control.norm(&attempt).is_nan(), "{k}");
        attempt.error[at + count + k] = 0.0;
    }
}
