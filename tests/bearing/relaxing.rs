//! Springs that relax: a body on Maxwell elements against the exponential of its equations, their response to
//! vibration against the complex stiffness, the steps that they allow.

use super::dynamics_integrators::rows_of;
use crate::dynamics;

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::assembly::places::Places;
use bearing_dynamics::ch2_housing::bearing::inertia::hollow_cylinder;
use bearing_dynamics::members::body::{Body, Drive, DrivenBody, Mobility, Rotation};
use bearing_dynamics::members::connection::{Connection, Law, MaxwellElement, SpringDashpot};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::state::{POSITION, VELOCITY};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Start, Stepping};
use bearing_dynamics::motion::stability::step_limit;
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use nalgebra::{DMatrix, DVector};

/// N/m left at last, and (N/m, s) of each element: of everything a bushing has, a bit.
const RELAXED: f64 = 1e6;
const ELEMENTS: [(f64, f64); 3] = [(4e6, 0.1e-3), (2e6, 2e-3), (1e6, 0.05)];

/// A bearing that nothing loads, far away in effect, with its outer race on rubber along Z: the race alone moves.
fn on_rubber(elements: &[(f64, f64)], load: Profile) -> Assembly {
    let mut assembly =
        dynamics::bearing(crate::common::table_4_1(200e-6), [0.0; 5], 0.0).assembly();
    let inertia = hollow_cylinder(10e-3, 35e-3, 42e-3, 7850.0);
    let mut race =
        DrivenBody { inertia, ..dynamics::race([0.0; 5], Rotation::Speed(Profile::ZERO)) };
    for (i, drive) in race.drives.iter_mut().enumerate() {
        *drive = if i == 2 { Drive::Load(load.clone()) } else { Drive::Motion(Profile::ZERO) };
    }
    let body = |name: &str, mobility| Body {
        name: name.into(),
        label: Some(name.into()),
        mobility,
        rest: [0.0; 5],
        rotating_load: None,
        unbalance: 0.0,
    };
    // The bearing's own races stand still, its balls float in their clearance.
    assembly.bodies[0].fix();
    assembly.bodies.push(body("block", Mobility::Driven(Box::new(race))));
    assembly.bodies.push(body("ground", Mobility::Fixed));
    let z = |stiffness: f64| [0.0, 0.0, stiffness, 0.0, 0.0, 0.0];
    let (block, ground) = (assembly.bodies.len() - 2, assembly.bodies.len() - 1);
    assembly.connections.push(Connection {
        name: "rubber".into(),
        label: None,
        ends: [Mount::at_centre(ground), Mount::at_centre(block)],
        law: Law::SpringDashpot(SpringDashpot {
            stiffness: z(RELAXED),
            maxwell: elements
                .iter()
                .map(|&(stiffness, relaxation_time)| MaxwellElement {
                    stiffness: z(stiffness),
                    relaxation_time,
                })
                .collect(),
            ..SpringDashpot::default()
        }),
    });
    assembly
}

fn mass(assembly: &Assembly) -> f64 {
    assembly.bodies[assembly.bodies.len() - 2].inertia().unwrap().mass
}

fn block(assembly: &Assembly) -> usize {
    Places::of(assembly).body(assembly.bodies.len() - 2)
}

/// x, v and the elongations after `time` from x = v = e = 0 under a constant load, N: exp(A t) of the linear
/// equations, with the load as one more constant.
fn exact(mass: f64, elements: &[(f64, f64)], load: f64, time: f64) -> DVector<f64> {
    let size = 3 + elements.len();
    let mut a = DMatrix::zeros(size, size);
    a[(0, 1)] = 1.0;
    a[(1, 0)] = -RELAXED / mass;
    a[(1, size - 1)] = load / mass;
    for (k, (stiffness, relaxation_time)) in elements.iter().enumerate() {
        a[(1, 2 + k)] = -stiffness / mass;
        a[(2 + k, 1)] = 1.0;
        a[(2 + k, 2 + k)] = -1.0 / relaxation_time;
    }
    let mut start = DVector::zeros(size);
    start[size - 1] = 1.0;
    (a * time).exp() * start
}

fn options(integrator: Integrator, stepping: Stepping) -> RunOptions {
    let start = Start::Nominal;
    RunOptions { start, integrator, stepping, energy_limit: f64::INFINITY, ..RunOptions::default() }
}

/// Error of displacement, velocity (by ω) and elongations at 2 ms over the largest displacement, and the steps.
fn error(integrator: Integrator, stepping: Stepping) -> (f64, u64, f64) {
    let load = 1000.0;
    let assembly = on_rubber(&ELEMENTS, Profile::Constant(load));
    let (mass, at) = (mass(&assembly), block(&assembly));
    let first = Places::of(&assembly).connections(&assembly)[0];
    let state = start::nominal(&assembly);
    let mut simulation =
        Simulation::from_state(assembly, options(integrator, stepping), state, 0.0).unwrap();
    let end = 2e-3;
    rows_of(&mut simulation, end, 1);
    let of = exact(mass, &ELEMENTS, load, end);
    let stiffness: f64 = RELAXED + ELEMENTS.iter().map(|element| element.0).sum::<f64>();
    let frequency = (stiffness / mass).sqrt();
    let mut error = (simulation.state[at + POSITION + 2] - of[0]).abs();
    error = error.max((simulation.state[at + VELOCITY + 2] - of[1]).abs() / frequency);
    for k in 0..ELEMENTS.len() {
        error = error.max((simulation.state[first + 6 * k + 2] - of[2 + k]).abs());
    }
    let residual = simulation.snapshot().residual;
    (error / (load / RELAXED), simulation.steps, residual / (load * load / RELAXED))
}

#[test]
fn a_body_on_rubber_moves_as_the_exponential_of_its_equations() {
    // Runge-Kutta: fourth order.
    let (coarse, ..) = error(Integrator::RungeKutta, Stepping::Fixed(20e-6));
    let (fine, _, residual) = error(Integrator::RungeKutta, Stepping::Fixed(10e-6));
    let order = (coarse / fine).log2();
    println!("rk4: {coarse:e}, {fine:e}, order {order}, residual {residual:e}");
    assert!((order - 4.0).abs() <= 0.3, "{order}");
    // (ωh)⁴/120 for ωh of 0.02.
    assert!(fine <= 2e-9, "{fine:e}");
    assert!(residual.abs() <= 2e-9, "{residual:e}");
    for integrator in [Integrator::DormandPrince, Integrator::Rosenbrock] {
        for accuracy in [1e-3, 1e-5] {
            let (error, steps, residual) = error(integrator, Stepping::Accuracy(accuracy));
            println!("{integrator:?} at {accuracy:e}: {error:e} in {steps} steps, {residual:e}");
            // Of the scale of displacements, which without a loaded contact is a millionth of a ball's radius.
            let scale = 1e-6 * 5.953e-3 / (1000.0 / RELAXED);
            assert!(error <= accuracy * scale, "{integrator:?} {accuracy:e}: {error:e}");
            assert!(residual.abs() <= 10.0 * accuracy * scale, "{residual:e}");
        }
    }
}

/// Steady vibration: x = F/(K(ω) − m ω²) with K = K∞ + Σ K iωτ/(1 + iωτ).
#[test]
fn a_vibrating_body_feels_the_complex_stiffness() {
    // Elements that have forgotten the start by the time of the look.
    let elements = &ELEMENTS[..2];
    let (force, omega) = (500.0, 2000.0);
    let load = Profile::Harmonic {
        mean: 0.0,
        amplitude: force,
        frequency: omega / std::f64::consts::TAU,
        phase: 0.0,
    };
    let assembly = on_rubber(elements, load);
    let (mass, at) = (mass(&assembly), block(&assembly));
    let one = nalgebra::Complex::new(1.0, 0.0);
    let turning = nalgebra::Complex::new(0.0, omega);
    let mut stiffness = one * (RELAXED - mass * omega * omega);
    for (k, relaxation_time) in elements {
        let turned = turning * *relaxation_time;
        stiffness += turned / (one + turned) * *k;
    }
    let answer = one * force / stiffness;
    let state = start::nominal(&assembly);
    let stepping = Stepping::Accuracy(1e-5);
    let options = options(Integrator::Rosenbrock, stepping);
    let mut simulation = Simulation::from_state(assembly, options, state, 0.0).unwrap();
    let mut worst = 0.0f64;
    for row in 0..40 {
        let end = 0.1 + f64::from(row) * 1e-4;
        rows_of(&mut simulation, end, 1);
        let phase = nalgebra::Complex::from_polar(1.0, omega * end);
        let expected = (answer * phase).im;
        worst = worst.max((simulation.state[at + POSITION + 2] - expected).abs());
    }
    println!("{:e} of {:e} m", worst / answer.norm(), answer.norm());
    // What the start has left: the slowest element forgets by exp(-0.1 s/4 ms).
    assert!(worst <= 1e-7 * answer.norm(), "{:e}", worst / answer.norm());
}

/// The step of Runge-Kutta knows the stiffness before it relaxes, and a relaxation faster than all motion.
#[test]
fn the_step_limit_knows_elements_that_have_not_relaxed() {
    let limit = |elements: &[(f64, f64)]| {
        let assembly = on_rubber(elements, Profile::ZERO);
        let mass = mass(&assembly);
        let state = start::nominal(&assembly);
        let mut system = System::new(assembly, Kernel::Simd);
        let limit = step_limit(&mut system, 0.0, &state).unwrap();
        (limit.step, limit.reason(&system.assembly), mass)
    };
    let (stiff, reason, mass) = limit(&[(1e12, 10.0)]);
    assert!(reason.starts_with("oscillation at "), "{reason}");
    let expected = 2.0 * 2f64.sqrt() / ((1e12 + RELAXED) / mass).sqrt();
    assert!((stiff / expected - 1.0).abs() <= 1e-3, "{stiff} {expected}");
    let (fast, reason, _) = limit(&[(1e3, 1e-9)]);
    assert!(reason.starts_with("decay at "), "{reason}");
    // Where classical Runge-Kutta ends on the negative axis.
    assert!((fast / 2.785_293_6e-9 - 1.0).abs() <= 1e-3, "{fast}");
}

/// A step a thousand times longer than a relaxation: the element is a dashpot K τ to the implicit method.
#[test]
fn long_implicit_steps_pass_over_fast_relaxation() {
    let load = 1000.0;
    let fast = [(1e9, 1e-8)];
    let assembly = on_rubber(&fast, Profile::Constant(load));
    let (mass, at) = (mass(&assembly), block(&assembly));
    let state = start::nominal(&assembly);
    let options = options(Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    let mut simulation = Simulation::from_state(assembly, options, state, 0.0).unwrap();
    let end = 5e-3;
    rows_of(&mut simulation, end, 1);
    let expected = exact(mass, &fast, load, end)[0];
    let error = (simulation.state[at + POSITION + 2] - expected).abs() / (load / RELAXED);
    println!("{error:e} in {} steps", simulation.steps);
    // As above, of a motion of a millimetre.
    assert!(error <= 1e-3 * 6e-6, "{error:e}");
    // Explicit ones would need two hundred thousand.
    assert!(simulation.steps <= 6000, "{}", simulation.steps);
}
