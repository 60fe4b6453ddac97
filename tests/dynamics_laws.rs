//! Laws that single forces and motions obey, each against its closed form.

mod common;
#[path = "common/dynamics.rs"]
mod dynamics;

use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::kinematics::euler::about;
use bearing_dynamics::solver::dynamics::contacts::Driver;
use bearing_dynamics::solver::dynamics::model::{Drive, Rotation};
use bearing_dynamics::solver::dynamics::race::tilts_of;
use bearing_dynamics::solver::dynamics::run::{Simulation, Start};
use bearing_dynamics::solver::dynamics::stability::growth;
use bearing_dynamics::solver::dynamics::start;
use bearing_dynamics::solver::dynamics::state::{BODY, BodyState, Layout, Ledger, SPIN, VELOCITY};
use bearing_dynamics::solver::profile::Profile;
use common::{table_4_1, table_5_3};
use dynamics::*;
use nalgebra::{Complex, Vector3};

#[test]
fn hunt_and_crossley_lose_alpha_times_the_speed() {
    // One ball thrown onto the outer race. m v dv/(1 + λ v) = −K δ^{3/2} dδ with λ = (3/2) α has
    // the first integral λ v − ln(1 + λ v), equal before and after.
    let (alpha, speed) = (0.3, 0.3);
    let lambda = 1.5 * alpha;
    let integral = |v: f64| lambda * v - (lambda * v).ln_1p();
    let (mut low, mut high) = (0.0, speed);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if integral(-middle) < integral(speed) { low = middle } else { high = middle }
    }
    let exact = low / speed;
    let mut problem = bearing(table_4_1(100e-6), [0.0; 5], 0.0);
    problem.damping = ContactDamping::HuntCrossley { alpha };
    problem.inner.drives = std::array::from_fn(|_| Drive::Motion(Profile::ZERO));
    problem.ball_phase = 0.0;
    let layout = Layout::new(8, false);
    let mut state = start::nominal(&problem, &layout);
    let mut ball = layout.ball_state(&state, 0);
    ball.velocity = [0.0, speed, 0.0];
    layout.set_ball(&mut state, 0, &ball);
    let options = fixed_step(0.1e-6, Start::Nominal);
    let mut simulation = Simulation::from_state(problem, options, state, 0.0).unwrap();
    let back = (0..20_000).find_map(|_| {
        simulation.step().unwrap();
        let velocity = layout.ball_state(&simulation.state, 0).velocity[1];
        let open = simulation.system.table.contact[layout.padded].overlap < 0.0;
        (open && velocity < 0.0).then_some(-velocity)
    });
    let ratio = back.unwrap() / speed;
    println!("restitution {ratio}, exact {exact}, first order {}", 1.0 - alpha * speed);
    // Some hundred steps of a smooth force.
    assert!((ratio - exact).abs() <= 1e-4);
    // Hunt and Crossley's own result: e = 1 − α v to first order in α v.
    assert!((ratio - (1.0 - alpha * speed)).abs() <= (alpha * speed).powi(2));
}

#[test]
fn an_unbalance_is_a_mass_on_the_race() {
    // At the race's own Y, pulled outwards with m e Ω² wherever that points, and nothing else.
    let speed = 300.0;
    let mut problem = bearing(table_4_1(1e-3), [0.0; 5], speed);
    let layout = Layout::new(8, false);
    let at = layout.inner();
    for angle in [0.0, 0.4, 2.5, -1.9] {
        let mut state = start::nominal(&problem, &layout);
        let mut inner = BodyState::from_slice(&state[at..]);
        inner.orientation = about(Vector3::x(), angle);
        state[at..at + BODY].copy_from_slice(&inner.to_array());
        let force = [0.0, 2e-4].map(|unbalance| {
            problem.unbalance = unbalance;
            let (_, rates, _) = evaluated(&problem, Driver::Lanes, 0.0, &state);
            Vector3::from_column_slice(&rates[at + VELOCITY..at + VELOCITY + 3])
                * problem.inner.inertia.mass
        });
        let expected = Vector3::new(0.0, angle.cos(), angle.sin()) * (2e-4 * speed * speed);
        let error = (force[1] - force[0] - expected).norm();
        assert!(error <= 1e-13 * expected.norm(), "{angle}: {error} N");
    }
}

#[test]
fn a_start_rolls_without_slip() {
    let speed = 1000.0 * RPM;
    for geometry in [table_4_1(-5e-6), table_5_3()] {
        let problem = bearing(geometry, [0.0; 5], speed);
        let layout = Layout::new(geometry.ball_count, false);
        let state = start::nominal(&problem, &layout);
        let (sin, cos) = geometry.contact_angle.sin_cos();
        for i in 0..layout.balls {
            let ball = layout.ball_state(&state, i);
            let centre = Vector3::from(ball.position);
            let out = Vector3::new(0.0, centre.y, centre.z).normalize();
            let normal = out * cos + Vector3::x() * sin;
            let surface = |side: f64| {
                let arm = normal * (side * geometry.ball_radius);
                let ours = Vector3::from(ball.velocity) + Vector3::from(ball.spin).cross(&arm);
                (ours, centre + arm)
            };
            let race_speed = speed * geometry.pitch_radius;
            let (outer, _) = surface(1.0);
            assert!(outer.norm() <= 1e-14 * race_speed, "slips on the outer race: {outer}");
            let (inner, point) = surface(-1.0);
            let slip = inner - Vector3::new(speed, 0.0, 0.0).cross(&point);
            assert!(slip.norm() <= 1e-14 * race_speed, "slips on the inner race: {slip}");
        }
    }
}

#[test]
fn prescribed_tilts_are_followed_far_from_upright() {
    // A spinning race swung through both tilts, touching nothing: all its energy comes from the
    // drives. Gyroscopic moments are large, and the tilts far from the axes they are small at.
    let mut problem = bearing(table_4_1(10e-6), [0.0; 5], 0.0);
    problem.inner_contact.stiffness = 0.0;
    problem.inner.inertia = Inertia { mass: 0.2, axial: 1e-4, transverse: 0.7e-4 };
    // From rest, so that the balls stay where they are.
    problem.inner.rotation = Rotation::Speed(Profile::Harmonic {
        mean: 0.0,
        amplitude: 240.0,
        frequency: 30.0,
        phase: 0.0,
    });
    let tilt = |amplitude: f64, frequency: f64, phase: f64| {
        Drive::Motion(Profile::Harmonic { mean: 0.1, amplitude, frequency, phase })
    };
    problem.inner.drives[3] = tilt(0.5, 20.0, 0.3);
    problem.inner.drives[4] = tilt(0.4, 27.0, 1.1);
    let mut simulation = simulation(&problem, 20e-6, Start::Nominal);
    let first = simulation.snapshot().unwrap().energy.kinetic;
    let mut turned = 0.0_f64;
    for _ in 0..2500 {
        simulation.step().unwrap();
        let snapshot = simulation.snapshot().unwrap();
        let kinetic = snapshot.energy.kinetic;
        turned = turned.max((kinetic - first).abs());
        let work = ledger(&simulation, Ledger::Drives);
        // Fourth order of ω h = 5e-3, over ten swings.
        assert!((kinetic - first - work).abs() <= 1e-9 * first, "{kinetic} {first} {work}");
    }
    assert!(turned > 0.1 * first, "{turned} of {first}");
    assert_eq!(simulation.system.work.loaded_contacts, 0);
}

#[test]
fn a_tilting_moment_does_work_on_its_tilt() {
    // Moments on the tilts are conjugate to them: what they put into a race that touches nothing is
    // moment times tilt, also where the axes of both tilts are far from those of space.
    let moments = [0.05, 0.08];
    let mut problem = bearing(table_4_1(10e-6), [0.0, 0.0, 0.0, moments[0], moments[1]], 0.0);
    problem.inner_contact.stiffness = 0.0;
    problem.inner.inertia = Inertia { mass: 0.2, axial: 1e-4, transverse: 0.7e-4 };
    problem.inner.rotation = Rotation::Torque(Profile::ZERO);
    let mut simulation = simulation(&problem, 20e-6, Start::Nominal);
    let at = simulation.system.layout.inner();
    simulation.state[at + SPIN] = 20.0;
    let first = simulation.snapshot().unwrap().energy.kinetic;
    let mut largest = [0.0_f64; 2];
    for _ in 0..2000 {
        simulation.step().unwrap();
        let tilts = tilts_of(inner_state(&simulation).axis());
        let work: f64 = moments.iter().zip(tilts).map(|(moment, tilt)| moment * tilt).sum();
        let gained = simulation.snapshot().unwrap().energy.kinetic - first;
        // Fourth order of ω h = 1e-3, over 2000 steps.
        assert!((gained - work).abs() <= 1e-10, "{gained} J for {work} J");
        for (largest, tilt) in largest.iter_mut().zip(tilts) {
            *largest = largest.max(tilt.abs());
        }
    }
    println!("tilts up to {largest:?}");
    assert!(largest.iter().all(|tilt| *tilt > 0.25), "{largest:?}");
}

#[test]
fn a_step_grows_as_the_exponential_to_fourth_order() {
    // z⁵/120 is the first term that is missing.
    for z in [Complex::new(-0.1, 0.0), Complex::new(0.0, 0.1), Complex::new(0.05, -0.08)] {
        let error = growth(z) - z.exp().norm();
        assert!(error.abs() <= 1.1 * z.norm().powi(5) / 120.0, "{z}: {error}");
    }
    // Classical limits on both axes: 2√2 and the root 2.785 293 563 405 282 of R = 1.
    for edge in [Complex::new(0.0, 8f64.sqrt()), Complex::new(-2.785293563405282, 0.0)] {
        assert!((growth(edge) - 1.0).abs() <= 1e-13, "{edge}: {}", growth(edge));
        assert!(growth(edge * 0.99) < 1.0 && growth(edge * 1.01) > 1.0);
    }
}
