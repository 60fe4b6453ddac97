//! Laws that single forces and motions obey, each against its closed form.

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::frequencies::ratios;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::equilibrium::statics::solve;
use bearing_dynamics::kinematics::euler::about;
use bearing_dynamics::members::body::{Drive, RotatingLoad, Rotation};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::rigid_body::tilts_of;
use bearing_dynamics::members::state::{BODY, BodyState, Layout, Ledger, POSITION, SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{Simulation, Start};
use bearing_dynamics::motion::stability::growth;
use bearing_dynamics::motion::start;
use bearing_dynamics::numeric::profile::Profile;
use common::{table_4_1, table_5_3};
use dynamics::*;
use nalgebra::{Complex, Matrix3, Vector3};

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
    let mut state = start::nominal(&problem.assembly());
    let mut ball = layout.ball_state(&state, 0);
    ball.velocity = [0.0, speed, 0.0];
    layout.set_ball(&mut state, 0, &ball);
    let options = fixed_step(0.1e-6, Start::Nominal);
    let mut simulation = Simulation::from_state(problem, options, state, 0.0).unwrap();
    let back = (0..20_000).find_map(|_| {
        simulation.step().unwrap();
        let velocity = layout.ball_state(&simulation.state, 0).velocity[1];
        let open = simulation.system.sets[0].table.contact[layout.padded].overlap < 0.0;
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
    // At the race's own Y, pulled outwards with m e Ω² wherever that points, held back across it while
    // the race speeds up, and nothing else.
    let (speed, faster) = (300.0, 2e4);
    let mut problem = bearing(table_4_1(1e-3), [0.0; 5], speed);
    problem.inner.rotation = Rotation::Speed(Profile::Ramp {
        from: 0.0,
        to: 2.0 * speed,
        start: -speed / faster,
        duration: 2.0 * speed / faster,
    });
    let layout = Layout::new(8, false);
    let at = layout.inner();
    for angle in [0.0, 0.4, 2.5, -1.9] {
        let mut state = start::nominal(&problem.assembly());
        let mut inner = BodyState::from_slice(&state[at..]);
        inner.orientation = about(Vector3::x(), angle);
        state[at..at + BODY].copy_from_slice(&inner.to_array());
        let force = [0.0, 2e-4].map(|unbalance| {
            problem.unbalance = unbalance;
            let (_, rates) = evaluated(&problem, Kernel::Simd, 0.0, &state);
            Vector3::from_column_slice(&rates[at + VELOCITY..at + VELOCITY + 3])
                * problem.inner.inertia.mass
        });
        let expected = Vector3::new(0.0, angle.cos(), angle.sin()) * (2e-4 * speed * speed)
            + Vector3::new(0.0, angle.sin(), -angle.cos()) * (2e-4 * faster);
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
        let state = start::nominal(&problem.assembly());
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

/// Ringing of the inner race over 0.5 ms, m: how far, peak to peak, it strays from the equilibrium
/// that moves with the balls, where a steady part and a drift (without traction nothing holds the
/// balls in their orbit) do not count.
fn ringing(problem: &DynamicProblem, state: Vec<f64>) -> f64 {
    let Rotation::Speed(Profile::Constant(speed)) = problem.inner.rotation else { panic!() };
    let g = problem.geometry;
    let orbit = speed * ratios(g.ball_count, g.ball_radius, g.pitch_radius, g.contact_angle).cage;
    // Below the limit of the traction, 1.6e-7 s; some 40 rows a period of the race.
    let (step, every, rows) = (1.25e-7, 40, 100);
    let options = fixed_step(step, Start::Equilibrium);
    let mut simulation = Simulation::from_state(problem.clone(), options, state, 0.0).unwrap();
    let mut off = Vec::new();
    for _ in 0..rows {
        run(&mut simulation, every);
        let ball_phase = problem.ball_phase + orbit * simulation.time;
        let now = DynamicProblem { ball_phase, ..problem.clone() };
        let fixed = solve(&now.statics(0.0)).unwrap();
        let position = inner_state(&simulation).position;
        off.push([1, 2].map(|i| position[i] - fixed.coordinates[i]));
    }
    // Less the parabola through the rows by least squares.
    let basis = |row: usize| {
        let x = 2.0 * row as f64 / (rows - 1) as f64 - 1.0;
        Vector3::new(1.0, x, x * x)
    };
    let normal: Matrix3<f64> = (0..rows).map(|row| basis(row) * basis(row).transpose()).sum();
    let swing = |i: usize| {
        let right: Vector3<f64> = (0..rows).map(|row| basis(row) * off[row][i]).sum();
        let parabola = normal.lu().solve(&right).unwrap();
        let rest = (0..rows).map(|row| off[row][i] - parabola.dot(&basis(row)));
        let (low, high) = rest.fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
        high - low
    };
    swing(0).max(swing(1))
}

#[test]
fn a_started_bearing_moves_with_its_equilibrium() {
    // With traction balls roll on the pitch circle, not on contacts half an overlap off it: what
    // slips there pulls them into place within a millisecond.
    for (law, most) in [(0, 0.1), (2, 0.2)] {
        let loads = [0.0, 0.0, -1500.0, 0.0, 0.0];
        let problem = DynamicProblem {
            traction: traction_laws().swap_remove(law),
            ..bearing(table_4_1(-5e-6), loads, 1000.0 * RPM)
        };
        let layout = Layout::new(8, false);
        let moving = start::at_equilibrium(&problem.assembly()).unwrap();
        // In statics without traction, the race at rest but for its rotation, balls on the pitch
        // circle's orbit and spin.
        let smooth = DynamicProblem { traction: TractionLaw::None, ..problem.clone() };
        let mut resting = start::at_equilibrium(&smooth.assembly()).unwrap();
        resting[layout.inner() + VELOCITY..layout.inner() + SPIN].fill(0.0);
        let nominal = start::nominal(&problem.assembly());
        for i in 0..layout.balls {
            let ball = layout.ball_state(&resting, i);
            let rolling = layout.ball_state(&nominal, i);
            layout.set_ball(&mut resting, i, &BodyState { position: ball.position, ..rolling });
        }
        let rings = [moving, resting].map(|state| ringing(&problem, state));
        println!("law {law}: {:e} m, from rest {:e} m", rings[0], rings[1]);
        assert!(rings[1] >= 1e-10, "{rings:?}");
        assert!(rings[0] <= most * rings[1], "{rings:?}");
    }
}

/// Both races and the balls, against equilibria a moment before and after.
#[test]
fn a_start_is_as_fast_as_its_equilibrium_moves() {
    let speed = 1000.0 * RPM;
    let geometry = table_4_1(5e-6);
    let mut problem = bearing(geometry, [20.0, 0.0, -1500.0, 0.0, 0.0], speed);
    let mut outer = free_race();
    outer.rotation = Rotation::Speed(Profile::ZERO);
    outer.foundation_stiffness = [1e7, 2e7, 1.5e7, 1e4, 2e4];
    problem.outer = Some(outer);
    problem.outer_start = [0.0, 0.0, 0.0, 2e-3, -1e-3];
    problem.cage = Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace));
    // Moves the races far more than the passing of balls.
    let (phase, turning) = (0.3, 300.0);
    let rotating = |t: f64| {
        let force = Profile::Constant(500.0);
        Some(RotatingLoad { force, speed: Profile::Constant(turning), phase: phase + turning * t })
    };
    problem.rotating_load = rotating(0.0);
    let layout = Layout::new(8, true);
    let state = start::at_equilibrium(&problem.assembly()).unwrap();
    let orbital = speed * ratios(8, geometry.ball_radius, geometry.pitch_radius, 0.0).cage;
    // The cage turns with the balls, about the outer race's axis.
    let outer = BodyState::from_slice(&state[layout.outer()..]);
    let spin = BodyState::from_slice(&state[layout.cage()..]).spin;
    for i in 0..3 {
        let expected = outer.spin[i] + orbital * outer.axis()[i];
        assert!((spin[i] - expected).abs() <= 1e-12 * orbital, "{spin:?}");
    }
    let dt = 1e-5;
    let [after, before] = [dt, -dt].map(|t| {
        let ball_phase = problem.ball_phase + orbital * t;
        let moved = DynamicProblem { ball_phase, rotating_load: rotating(t), ..problem.clone() };
        start::at_equilibrium(&moved.assembly()).unwrap()
    });
    let rate = |at: usize| (after[at] - before[at]) / (2.0 * dt);
    // Races move by some 10 mm/s. Rates of the start come from equilibria 0.1 ms apart: a third of
    // the square of the load's turn, 3e-4; differences leave (orbital dt)²/6 of the balls' 1 m/s.
    let tolerance = 1e-5;
    let mut largest = [0.0f64; 2];
    for (race, at) in [layout.inner(), layout.outer()].into_iter().enumerate() {
        for i in 0..3 {
            let error = state[at + VELOCITY + i] - rate(at + i);
            largest[race] = largest[race].max(rate(at + i).abs());
            assert!(error.abs() <= tolerance, "race {race}, {i}: {error:e} of {:e}", rate(at + i));
        }
    }
    println!("races move by {largest:?} m/s");
    assert!(largest.iter().all(|speed| *speed >= 2e-3), "{largest:?}");
    let loaded: Vec<usize> =
        (0..8).filter(|ball| layout.ball_state(&state, *ball).position[2] < -0.01).collect();
    assert!(loaded.len() >= 2);
    for ball in loaded {
        for i in 0..3 {
            let found = state[layout.ball(VELOCITY + i) + ball];
            let error = found - rate(layout.ball(i) + ball);
            assert!(error.abs() <= tolerance, "ball {ball}, {i}: {error:e} of {found:e}");
        }
    }
}

#[test]
fn prescribed_tilts_are_followed_far_from_upright() {
    // A spinning race swung through both tilts, touching nothing: all its energy comes from the
    // drives. Gyroscopic moments are large, and the tilts far from the axes they are small at.
    let mut problem = bearing(table_4_1(10e-6), [0.0; 5], 0.0);
    problem.inner_contact.stiffness = 0.0;
    // Said to be so loose that such tilts do not end the run.
    problem.geometry.radial_clearance = 1.0;
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
    let first = simulation.snapshot().energy.kinetic;
    let mut turned = 0.0_f64;
    for _ in 0..2500 {
        simulation.step().unwrap();
        let snapshot = simulation.snapshot();
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
    // Said to be so loose that such tilts do not end the run.
    problem.geometry.radial_clearance = 1.0;
    problem.inner.inertia = Inertia { mass: 0.2, axial: 1e-4, transverse: 0.7e-4 };
    problem.inner.rotation = Rotation::Torque(Profile::ZERO);
    let mut simulation = simulation(&problem, 20e-6, Start::Nominal);
    let at = simulation.system.sets[0].layout.inner();
    simulation.state[at + SPIN] = 20.0;
    let first = simulation.snapshot().energy.kinetic;
    let mut largest = [0.0_f64; 2];
    for _ in 0..2000 {
        simulation.step().unwrap();
        let tilts = tilts_of(inner_state(&simulation).axis());
        let work: f64 = moments.iter().zip(tilts).map(|(moment, tilt)| moment * tilt).sum();
        let gained = simulation.snapshot().energy.kinetic - first;
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

/// From +Y towards +Z, by the integral of its speed.
#[test]
fn a_rotating_load_turns_from_y_to_z() {
    let ramp = Profile::Ramp { from: 0.0, to: 2.0, start: 0.0, duration: 1.0 };
    let load = RotatingLoad { force: Profile::Constant(3.0), speed: ramp, phase: 0.25 };
    for t in [0.0, 0.5, 1.0, 2.0] {
        // ∫ 2t dt up to 1 s, then 2 rad/s.
        let angle: f64 = 0.25 + if t <= 1.0 { t * t } else { 1.0 + 2.0 * (t - 1.0) };
        let [x, y, z] = load.force(t);
        let expected = [3.0 * angle.cos(), 3.0 * angle.sin()];
        assert!(x == 0.0 && (y - expected[0]).abs() + (z - expected[1]).abs() <= 1e-14, "{t}");
    }
}

/// A bearing turned about its own axis with its loads, tilts, foundation, gravity and balls moves as
/// before, turned; balls may be counted from any of them.
#[test]
fn a_run_turns_with_its_whole_scene() {
    let steps = 400;
    let turned = |angle: f64, tilted: bool| {
        let turn = about(Vector3::x(), angle);
        let mut problem = bearing(table_5_3(), [0.0; 5], 100.0);
        // Axial, and across: as a vector of force or place, and as one of moment or tilt.
        let across = |y: f64, z: f64| turn * Vector3::new(0.0, y, z);
        let tilted = if tilted { 1.0 } else { 0.0 };
        let (force, moment) = (across(150.0, -300.0), across(2.0, -1.0) * tilted);
        let loads = [400.0, force.y, force.z, moment.y, moment.z];
        problem.inner = race(loads, Rotation::Speed(Profile::Constant(100.0)));
        let mut outer = free_race();
        // Held at a place and at tilts that turn too, on a foundation alike in all directions.
        outer.foundation_stiffness = [2e7, 3e7, 3e7, 2e3, 2e3];
        outer.foundation_damping = [200.0, 300.0, 300.0, 0.2, 0.2];
        problem.outer = Some(outer);
        let place = across(2e-6, -3e-6);
        let tilts = tilts_of(
            (turn * about(Vector3::new(0.0, 0.6, 0.8), 1e-3 * tilted) * Vector3::x()).into(),
        );
        problem.outer_start = [1e-6, place.y, place.z, tilts[0], tilts[1]];
        problem.gravity = across(3.0, -9.0).into();
        let force = Profile::Constant(100.0);
        problem.rotating_load =
            Some(RotatingLoad { force, speed: Profile::Constant(900.0), phase: 0.4 + angle });
        problem.cage = Some(cage(&problem.geometry, Pocket::Cylindrical, Guidance::OuterRace));
        problem.traction = CONSTANT;
        problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
        problem.ball_phase = 0.1 + angle;
        problem
    };
    let ends = |problem: &DynamicProblem| {
        let mut simulation = simulation(problem, 1e-6, Start::Equilibrium);
        run(&mut simulation, steps);
        simulation
    };
    let balls = table_5_3().ball_count;
    let pitch = std::f64::consts::TAU / balls as f64;
    // Upright, what is left of both starts, sought to 1e-9 of the loads. A race that is tilted has its
    // Y axis off by half the square of the tilt from where it would be turned to, 5e-7 rad, and the
    // balls are counted from there: 1.3e-8 m on their pitch circle, and up to three times that by friction.
    let upright = [(POSITION, 1e-9), (VELOCITY, 1e-6), (SPIN, 1e-3)];
    let tilted = [(POSITION, 5e-8), (VELOCITY, 1e-4), (SPIN, 2e-2)];
    for (is_tilted, allowed, of_ledger) in [(false, upright, 1e-4), (true, tilted, 1e-3)] {
        let first_problem = turned(0.0, is_tilted);
        let first = ends(&first_problem);
        for angle in [0.7, -2.4, 3.0 * pitch] {
            let problem = turned(angle, is_tilted);
            let there = ends(&problem);
            let by = about(Vector3::x(), angle);
            let should = moved(&first_problem, &first.state, &by, &Vector3::zeros());
            for (_, at) in bodies(&problem) {
                let (a, b) = (entries(&should, at), entries(&there.state, at));
                for (component, allowed) in allowed {
                    let off = (part(&a, component) - part(&b, component)).norm();
                    assert!(off <= allowed, "{angle} {at:?} {component}: {off:e}");
                }
            }
            let booked = [&first, &there]
                .map(|of| [Ledger::Traction, Ledger::Drives].map(|entry| ledger(of, entry)));
            for (a, b) in booked[0].iter().zip(booked[1]) {
                assert!((a / b - 1.0).abs() <= of_ledger && a.abs() > 1e-6, "{booked:?}");
            }
        }
    }
    // Counted from the next ball on: the same balls by other names.
    let first = ends(&turned(0.0, true));
    let mut renamed = turned(0.0, true);
    renamed.ball_phase += pitch;
    let there = ends(&renamed);
    for ball in 0..balls {
        let [a, b] = [(&first, (ball + 1) % balls), (&there, ball)]
            .map(|(of, ball)| of.system.sets[0].layout.ball_state(&of.state, ball));
        let off = (Vector3::from(a.position) - Vector3::from(b.position)).norm();
        assert!(off <= 1e-9, "ball {ball}: {off:e}");
        let off = (Vector3::from(a.spin) - Vector3::from(b.spin)).norm();
        assert!(off <= 1e-3, "ball {ball}: {off:e}");
    }
}
