//! Bodies with an unbalance that a torque turns, against closed forms and equations of their own.

use crate::bent_shafts::{MIDDLE, OVERHUNG, STEEL, alone, beam, on_springs, section, unbalanced};
use crate::common::table_4_1;
use crate::connected_bodies::free;
use crate::dynamics::{CONSTANT, bearing, fixed_step};

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::members::body::{Drive, DrivenBody, Rotation};
use bearing_dynamics::members::flexible_shaft::Unbalance;
use bearing_dynamics::members::shaft_modes::Kept;
use bearing_dynamics::members::state::{BodyState, Ledger};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Start, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use nalgebra::{Matrix3, Vector3};

/// A free body with this unbalance under a constant torque, N·m.
fn turned(torque: f64, unbalance: f64) -> Assembly {
    let mut body = free("the rotor");
    body.unbalance = unbalance;
    let race = body.driven_mut().unwrap();
    race.rotation = Rotation::Torque(Profile::Constant(torque));
    Assembly { bodies: vec![body], ..Assembly::default() }
}

fn race(assembly: &mut Assembly) -> &mut DrivenBody {
    assembly.bodies[0].driven_mut().unwrap()
}

fn body(simulation: &Simulation) -> BodyState {
    simulation.system.body_state(&simulation.state, 0)
}

fn run(assembly: &Assembly, step: f64, steps: usize) -> Simulation {
    let mut simulation =
        Simulation::new(assembly.clone(), fixed_step(step, Start::Nominal)).unwrap();
    for _ in 0..steps {
        simulation.step().unwrap();
    }
    simulation
}

/// Nothing holds it: it turns about its centre of mass, which stays, with the inertia about that.
#[test]
fn a_free_rotor_turns_about_its_centre_of_mass() {
    let (torque, unbalance) = (0.3, 3e-3);
    let mut assembly = turned(torque, unbalance);
    let inertia = race(&mut assembly).inertia;
    let eccentricity = unbalance / inertia.mass;
    let about_mass = inertia.axial - unbalance * eccentricity;
    // A tenth of the inertia, so that a missing part is seen.
    assert!(about_mass <= 0.95 * inertia.axial);
    let simulation = run(&assembly, 2e-5, 2000);
    let t = simulation.time;
    let (rate, angle) = (torque / about_mass, 0.5 * torque / about_mass * t * t);
    let now = body(&simulation);
    assert!((now.spin[0] / (rate * t) - 1.0).abs() <= 1e-9, "{} {}", now.spin[0], rate * t);
    let expected = [eccentricity * (1.0 - angle.cos()), -eccentricity * angle.sin()];
    for (found, expected) in now.position[1..].iter().zip(expected) {
        // Runge-Kutta at turns of 0.002 rad a step: what rounds off in 2000 of them.
        assert!((found - expected).abs() <= 1e-9 * eccentricity, "{found} {expected}");
    }
}

/// y, z and the angle with their rates: Lagrange's equations of a body of mass m − μ on the axis and a particle μ beside
/// it, solved together.
struct Oracle {
    mass: f64,
    axial: f64,
    unbalance: f64,
    torque: f64,
    stiffness: [f64; 2],
    damping: [f64; 2],
    weight: f64,
}

impl Oracle {
    fn rates(&self, x: &[f64; 6]) -> [f64; 6] {
        let [y, z, angle, vy, vz, spin] = *x;
        let (sin, cos) = angle.sin_cos();
        let u = self.unbalance;
        #[rustfmt::skip]
        let masses = Matrix3::new(
            self.mass, 0.0, -u * sin,
            0.0, self.mass, u * cos,
            -u * sin, u * cos, self.axial,
        );
        let forces = Vector3::new(
            u * spin * spin * cos - self.stiffness[0] * y - self.damping[0] * vy,
            u * spin * spin * sin
                - self.stiffness[1] * z
                - self.damping[1] * vz
                - self.mass * self.weight,
            self.torque - u * self.weight * cos,
        );
        let [a, b, c] = masses.try_inverse().map(|inverse| inverse * forces).unwrap().into();
        [vy, vz, spin, a, b, c]
    }

    fn integrate(&self, step: f64, steps: usize) -> [f64; 6] {
        let mut x = [0.0; 6];
        let ahead = |x: &[f64; 6], k: &[f64; 6], by: f64| std::array::from_fn(|i| x[i] + by * k[i]);
        for _ in 0..steps {
            let k1 = self.rates(&x);
            let k2 = self.rates(&ahead(&x, &k1, 0.5 * step));
            let k3 = self.rates(&ahead(&x, &k2, 0.5 * step));
            let k4 = self.rates(&ahead(&x, &k3, step));
            x = std::array::from_fn(|i| {
                x[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])
            });
        }
        x
    }
}

const STIFFNESS: [f64; 2] = [2e5, 3e5];
const WEIGHT: f64 = 9.81;

/// A rotor on springs, and what it is by the other equations.
fn laval(torque: f64, unbalance: f64) -> (Assembly, Oracle) {
    let mut assembly = turned(torque, unbalance);
    assembly.gravity = [0.0, 0.0, -WEIGHT];
    let race = race(&mut assembly);
    let damping = [12.0, 15.0];
    race.foundation_stiffness = [1e5, STIFFNESS[0], STIFFNESS[1], 1e3, 1e3];
    race.foundation_damping = [0.0, damping[0], damping[1], 0.0, 0.0];
    let (mass, axial) = (race.inertia.mass, race.inertia.axial);
    let oracle =
        Oracle { mass, axial, unbalance, torque, stiffness: STIFFNESS, damping, weight: WEIGHT };
    (assembly, oracle)
}

/// Through both critical speeds by a strong torque, caught at the first by a weak one (Sommerfeld), an unbalance that no
/// approximation for a small one would do for; speeds, angles and places as the other equations have them.
#[test]
fn a_run_up_by_a_torque_is_that_of_lagranges_equations() {
    let critical = |i: usize, mass: f64| (STIFFNESS[i] / mass).sqrt();
    // Torque (N m), unbalance (kg m), time (s), whether it passes.
    let cases = [(2.0, 1e-4, 0.1, true), (0.12, 2e-4, 1.2, false), (3.0, 1e-3, 0.05, false)];
    for (torque, unbalance, end, passes) in cases {
        let (assembly, oracle) = laval(torque, unbalance);
        let steps = (end / 1e-5_f64).round() as usize;
        let simulation = run(&assembly, 1e-5, steps);
        let expected = oracle.integrate(0.5e-5, 2 * steps);
        let now = body(&simulation);
        let spin = now.spin[0];
        println!("{torque} N m: {spin} rad/s by {}", expected[5]);
        assert!((spin / expected[5] - 1.0).abs() <= 1e-7, "{torque}: {spin} {}", expected[5]);
        for (i, found) in now.position[1..].iter().enumerate() {
            assert!((found - expected[i]).abs() <= 1e-9, "{torque}: {found} {}", expected[i]);
        }
        assert_eq!(spin > critical(1, oracle.mass), passes, "{spin}");
        let alone = torque * end / oracle.axial;
        assert!(passes || spin <= 1.02 * critical(1, oracle.mass) && alone >= 2.0 * spin);
    }
}

/// Error control, whose matrix knows nothing of it, against small steps of Runge-Kutta, in a bearing.
#[test]
fn linearly_implicit_steps_take_an_unbalance_under_a_torque_as_others_do() {
    let mut problem = bearing(table_4_1(-5e-6), [0.0, 0.0, -200.0, 0.0, 0.0], 0.0);
    problem.traction = CONSTANT;
    problem.inner.rotation = Rotation::Torque(Profile::Constant(5.0));
    problem.unbalance = 1e-3;
    let end = 6e-3;
    let motion = |integrator, stepping| {
        let options = RunOptions { integrator, stepping, ..RunOptions::default() };
        let mut simulation = Simulation::new(problem.clone(), options).unwrap();
        while simulation.time < end * (1.0 - 1e-12) {
            let step = simulation.step_size.min(end - simulation.time);
            simulation.step_by(step).unwrap();
        }
        simulation
    };
    let fine = motion(Integrator::RungeKutta, Stepping::Fixed(0.5e-6));
    let by_matrix = motion(Integrator::Rosenbrock, Stepping::Accuracy(1e-3));
    let (expected, found) = (body(&fine), body(&by_matrix));
    println!("{} steps: {} by {}", by_matrix.steps, found.spin[0], expected.spin[0]);
    assert!(by_matrix.steps <= fine.steps / 3, "{}", by_matrix.steps);
    assert!((found.spin[0] / expected.spin[0] - 1.0).abs() <= 1e-4);
    for i in 1..3 {
        // A few times the accuracy asked for, of overlaps of some 10 um.
        let error = (found.position[i] - expected.position[i]).abs();
        assert!(error <= 5e-8, "{error:e}");
    }
}

/// Its axis held: a pendulum that a torque turns, I φ̈ = T + u g·τ.
#[test]
fn a_held_rotor_is_a_pendulum() {
    let mut assembly = turned(0.02, 1e-2);
    assembly.gravity = [0.0, 0.0, -WEIGHT];
    let race = race(&mut assembly);
    race.drives = std::array::from_fn(|_| Drive::Motion(Profile::ZERO));
    let inertia = race.inertia;
    let simulation = run(&assembly, 1e-5, 20_000);
    let (mut angle, mut spin, step) = (0.0_f64, 0.0_f64, 1e-6);
    let push = |angle: f64| (0.02 - 1e-2 * WEIGHT * angle.cos()) / inertia.axial;
    // Leapfrog, of second order.
    for _ in 0..200_000 {
        let middle = spin + 0.5 * step * push(angle);
        angle += step * middle;
        spin = middle + 0.5 * step * push(angle);
    }
    let found = body(&simulation).spin[0];
    assert!((found - spin).abs() <= 1e-6 * spin.abs(), "{found} {spin}");
    // What the torque did is all the energy there is.
    let mut simulation = simulation;
    let snapshot = simulation.snapshot();
    let done = snapshot.ledger[Ledger::Drives as usize];
    assert!(snapshot.residual.abs() <= 1e-9 * done.abs(), "{:e} {done}", snapshot.residual);
}

/// Shafts that bend, two unbalances along them and one at the centre, damping of either kind, weight: drives have done what
/// the torque has, to the last of it, and the momentum of what nothing holds stays.
#[test]
fn bent_shafts_under_a_torque_close_their_books() {
    for (disc, held) in [(OVERHUNG, false), (MIDDLE, true), (OVERHUNG, true)] {
        let torque = 20.0;
        let mut assembly =
            alone(&beam(disc, STEEL), Kept { most: 3, ..Kept::ALL }, &[0.0, 0.4], 0.0);
        race(&mut assembly).rotation = Rotation::Torque(Profile::Constant(torque));
        if held {
            on_springs(&mut assembly, &[0.05, 0.35], [1e6, 2e7, 1e7]);
            assembly.gravity = [0.0, 0.0, -WEIGHT];
            assembly.shafts[0].damping = 40.0;
            assembly.shafts[0].internal_damping = 20.0;
        }
        assembly.bodies[0].unbalance = 4e-3;
        assembly.shafts[0].unbalances =
            vec![unbalanced(5e-3, &assembly, 0.1), unbalanced(2e-3, &assembly, 0.4)];
        let mut simulation =
            Simulation::new(assembly.clone(), fixed_step(2e-6, Start::Nominal)).unwrap();
        let (mut spin, mut momentum, mut work) = (0.0, Vector3::zeros(), 0.0);
        let mut most: f64 = 0.0;
        for _ in 0..20_000 {
            simulation.step().unwrap();
            let now = body(&simulation);
            let step = simulation.step_size;
            work += 0.5 * step * torque * (spin + now.spin[0]);
            spin = now.spin[0];
            let system = &simulation.system;
            momentum = Vector3::from(now.velocity) * race(&mut assembly).inertia.mass;
            let forward = |of: &BodyState, angle: f64| -> Vector3<f64> {
                of.orientation * Vector3::new(0.0, -angle.sin(), angle.cos())
            };
            let mut swings = forward(&now, 0.0) * (4e-3 * spin);
            for unbalance in &assembly.shafts[0].unbalances {
                let here = system.section_now(&simulation.state, 0, &unbalance.section).state;
                swings += forward(&here, unbalance.angle) * (unbalance.size * spin);
            }
            most = most.max(swings.norm());
            momentum += swings;
        }
        let snapshot = simulation.snapshot();
        let done = snapshot.ledger[Ledger::Drives as usize];
        println!("{spin} rad/s, {done} J, residual {:e} J, {momentum}", snapshot.residual);
        // Trapezoids of a speed that shakes by some 1e-3 of itself.
        assert!((done / work - 1.0).abs() <= 1e-5, "{done} {work}");
        // Bending is linear: the spin of a section is the rate of its orientation but for the square of its turn.
        assert!(snapshot.residual.abs() <= 1e-9 * done, "{:e} of {done}", snapshot.residual);
        if !held {
            assert!(momentum.norm() <= 1e-5 * most, "{momentum} of {most}");
        }
    }
}

/// Free fall along the axis turns and tilts nothing.
#[test]
fn a_rotor_that_falls_along_its_axis_does_not_tilt() {
    let mut assembly = turned(0.3, 1e-3);
    assembly.gravity = [-WEIGHT, 0.0, 0.0];
    let falling = body(&run(&assembly, 2e-5, 1000));
    assembly.gravity = [0.0; 3];
    let floating = body(&run(&assembly, 2e-5, 1000));
    assert!(falling.spin[1].abs() + falling.spin[2].abs() <= 1e-12, "{:?}", falling.spin);
    assert!((falling.spin[0] - floating.spin[0]).abs() <= 1e-12 * floating.spin[0]);
    let fallen = 0.5 * WEIGHT * 0.02 * 0.02;
    assert!((falling.position[0] + fallen).abs() <= 1e-12, "{}", falling.position[0]);
}

/// A stiff shaft driven by a torque, N·m, under its weight, with unbalances: size, kg·m, angle, rad, and distance from its
/// end, m.
fn stiff(torque: f64, unbalances: &[(f64, f64, f64)]) -> Assembly {
    let kept = Kept { most: 2, ..Kept::ALL };
    let mut assembly = alone(&beam(MIDDLE, 100.0 * STEEL), kept, &[], 0.0);
    assembly.gravity = [0.0, 0.0, -WEIGHT];
    race(&mut assembly).rotation = Rotation::Torque(Profile::Constant(torque));
    assembly.shafts[0].unbalances = unbalances
        .iter()
        .map(|&(size, angle, at)| Unbalance { section: section(&assembly, at), size, angle })
        .collect();
    assembly
}

/// Its axis fixed, a stiff shaft is a pendulum of all its unbalances, I φ̈ = T − g Σ u cos(φ + α), with the energy of their
/// weight g Σ u sin(φ + α).
#[test]
fn unbalances_along_a_stiff_shaft_are_a_pendulum() {
    let (torque, unbalances) = (2.0, [(5e-3, 0.4, 0.1), (4e-3, 2.1, 0.3), (2e-3, -1.0, 0.4)]);
    let mut assembly = stiff(torque, &unbalances);
    race(&mut assembly).drives = std::array::from_fn(|_| Drive::Motion(Profile::ZERO));
    let inertia = race(&mut assembly).inertia;
    let mut simulation = Simulation::new(assembly, fixed_step(5e-6, Start::Nominal)).unwrap();
    let first = simulation.snapshot().energy.gravity;
    let (mut angle, mut spin, step) = (0.0_f64, 0.0_f64, 5e-6);
    let sum = |of: &dyn Fn(f64) -> f64| -> f64 {
        unbalances.iter().map(|(size, ahead, _)| WEIGHT * size * of(*ahead)).sum()
    };
    let push = |angle: f64| (torque - sum(&|ahead| (angle + ahead).cos())) / inertia.axial;
    for _ in 0..60_000 {
        simulation.step().unwrap();
        // Leapfrog, of second order.
        let middle = spin + 0.5 * step * push(angle);
        angle += step * middle;
        spin = middle + 0.5 * step * push(angle);
    }
    let found = body(&simulation).spin[0];
    let snapshot = simulation.snapshot();
    let (gravity, risen) = (
        snapshot.energy.gravity - first,
        sum(&|ahead| (angle + ahead).sin()) - sum(&|ahead| ahead.sin()),
    );
    println!("{found} {spin} rad/s, {angle} rad, {gravity} {risen} J");
    // Weight is a twentieth of the torque. A shaft a hundred times as stiff as steel bends by less than a nanometre.
    assert!(angle > 0.5 && (found / spin - 1.0).abs() <= 1e-7, "{found} {spin}");
    assert!((gravity / risen - 1.0).abs() <= 1e-6, "{gravity} {risen}");
    let done = snapshot.ledger[Ledger::Drives as usize];
    assert!(snapshot.residual.abs() <= 1e-9 * done, "{:e} of {done}", snapshot.residual);
}

/// An unbalance at the middle of a stiff shaft on springs moves it as the same unbalance of its body does.
#[test]
fn an_unbalance_at_the_centre_of_a_stiff_shaft_is_that_of_its_body() {
    let (torque, unbalance) = (3.0, 2e-2);
    let motion = |of_body: bool| {
        let along: &[(f64, f64, f64)] = if of_body { &[] } else { &[(unbalance, 0.0, 0.2)] };
        let mut assembly = stiff(torque, along);
        on_springs(&mut assembly, &[0.05, 0.35], [1e6, 2e5, 3e5]);
        assembly.bodies[0].unbalance = if of_body { unbalance } else { 0.0 };
        let mut simulation = Simulation::new(assembly, fixed_step(5e-6, Start::Nominal)).unwrap();
        let first = simulation.snapshot().energy.gravity;
        for _ in 0..40_000 {
            simulation.step().unwrap();
        }
        let gravity = simulation.snapshot().energy.gravity - first;
        let now = body(&simulation);
        [now.spin[0], now.position[1], now.position[2], gravity]
    };
    let [of_shaft, of_body] = [false, true].map(motion);
    println!("{of_shaft:?} {of_body:?}");
    // The shaft bends by some 1e-11 m under its unbalance, one part in 1e8 of the 20 mm of its mass.
    for (i, tolerance) in
        [1e-6 * of_body[0], 1e-10, 1e-10, 1e-6 * unbalance * WEIGHT].into_iter().enumerate()
    {
        let error = (of_shaft[i] - of_body[i]).abs();
        assert!(error <= tolerance, "{i}: {of_shaft:?} {of_body:?}");
    }
    // It has turned by half a radian, and the weight has done work.
    assert!(of_body[3].abs() >= 0.1 * unbalance * WEIGHT, "{of_body:?}");
}
