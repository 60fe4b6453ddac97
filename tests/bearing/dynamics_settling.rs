//! What the moving bearing comes to rest in, and what it means over a turn, against statics.

use crate::{common, dynamics};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::frequencies::ratios;
use bearing_dynamics::ch2_housing::bearing::geometry::BearingGeometry;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::equilibrium::statics::solve;
use bearing_dynamics::members::body::{Drive, Rotation};
use bearing_dynamics::members::rigid_body::tilts_of;
use bearing_dynamics::members::state::{BodyState, Layout, POSITION, SPIN, VELOCITY};
use bearing_dynamics::motion::simulation::{Simulation, Start};
use bearing_dynamics::numeric::profile::Profile;
use common::{table_4_1, table_5_3};
use dynamics::*;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Tables 2.2 and 3.5 with 5 µm interference.
pub fn table_3_5() -> BearingGeometry {
    table_4_1(-5e-6)
}

/// Puts every ball back into the plane through the outer race's axis in which statics holds it.
fn hold_azimuths(simulation: &mut Simulation) {
    let layout = simulation.system.sets[0].layout;
    for ball in 0..layout.balls {
        let angle = simulation.system.assembly.bearings[0].ball_phase
            + TAU * ball as f64 / layout.balls as f64;
        let tangent = Vector3::new(0.0, -angle.sin(), angle.cos());
        let mut body = layout.ball_state(&simulation.state, ball);
        let across = |v: [f64; 3]| -> [f64; 3] {
            let v = Vector3::from(v);
            (v - tangent * tangent.dot(&v)).into()
        };
        body.position = across(body.position);
        body.velocity = across(body.velocity);
        layout.set_ball(&mut simulation.state, ball, &body);
    }
}

#[test]
fn a_damped_bearing_settles_into_static_equilibrium() {
    let deep = table_3_5();
    let angular = table_5_3();
    let cases = [
        (deep, [0.0, 0.0, -500.0, 0.0, 0.0]),
        (deep, [200.0, 300.0, -300.0, 0.0, 0.0]),
        (deep, [100.0, 0.0, -200.0, 2.0, -1.0]),
        (angular, [445.0, 0.0, 0.0, 0.0, 0.0]),
        (angular, [800.0, 100.0, -200.0, 0.0, 0.0]),
        (angular, [800.0, 0.0, -100.0, 1.5, 1.0]),
    ];
    for (geometry, loads) in cases {
        let expected = solve(&bearing(geometry, loads, 0.0).statics(0.0)).unwrap();
        // From the equilibrium of 0.8 of the load; slowly beside the balls' swing across their
        // grooves (above 5e3 rad/s): it moves no contact along its normal, so that without friction
        // nothing damps it.
        let mut problem = bearing(geometry, loads, 0.0);
        problem.inner.drives = loads.map(|load| {
            let (start, duration) = (0.0, 60e-3);
            Drive::Load(Profile::SmoothRamp { from: 0.8 * load, to: load, start, duration })
        });
        problem.damping = ContactDamping::HuntCrossley { alpha: 3.0 };
        // For the same reason contact damping hardly reaches the race's softest modes; dashpots
        // do, and hold nothing up.
        problem.inner.foundation_damping = [1e3, 1e3, 1e3, 0.2, 0.2];
        let mut simulation = simulation(&problem, 2e-6, Start::Equilibrium);
        for _ in 0..40_000 {
            simulation.step().unwrap();
            hold_azimuths(&mut simulation);
        }
        let inner = inner_state(&simulation);
        let tilts = tilts_of(inner.axis());
        let pitch = geometry.pitch_radius;
        let there = [
            inner.position[0],
            inner.position[1],
            inner.position[2],
            tilts[0] * pitch,
            tilts[1] * pitch,
        ];
        let scale = [1.0, 1.0, 1.0, pitch, pitch];
        let largest =
            (0..5).map(|i| (expected.coordinates[i] * scale[i]).abs()).fold(0.0, f64::max);
        let mut worst = 0.0_f64;
        for i in 0..5 {
            worst = worst.max((there[i] - expected.coordinates[i] * scale[i]).abs());
        }
        for (ball, at) in expected.balls.iter().enumerate() {
            let here =
                simulation.system.sets[0].layout.ball_vector(&simulation.state, POSITION, ball);
            // An unloaded ball may be anywhere in its room.
            if at.outer.normal_load > 0.0 {
                worst = worst.max((Vector3::from(here) - at.position).norm());
            }
        }
        let speed = Vector3::from(inner.velocity).norm();
        println!("{loads:?}: off by {:e} of {largest:e} m, still {speed:e} m/s", worst / largest);
        // 20 ms after the last change of load.
        assert!(worst <= 1e-6 * largest, "{loads:?}: {worst} of {largest}");
    }
}

/// Mean position of the inner race (m) over whole ball pitches, or moment on it (N·m) where its
/// position is given; and the same by statics with centrifugal force at the same ball angles.
struct Means {
    dynamic: [f64; 3],
    fixed: [f64; 3],
    seconds: f64,
}

fn means(problem: &DynamicProblem, step: f64, settle_pitches: usize, pitches: usize) -> Means {
    let clock = std::time::Instant::now();
    let g = problem.geometry;
    let layout = Layout::new(g.ball_count, false);
    let azimuth = |state: &[f64], ball: usize| {
        let [_, y, z] = layout.ball_vector(state, POSITION, ball);
        z.atan2(y)
    };
    let Rotation::Speed(Profile::Constant(speed)) = problem.inner.rotation else { panic!() };
    let orbit = speed * ratios(g.ball_count, g.ball_radius, g.pitch_radius, g.contact_angle).cage;
    let pitch_time = TAU / g.ball_count as f64 / orbit;
    let every = (pitch_time / step / 100.0).round() as usize;
    // A pitch is a hundred samples exactly.
    let (step, steps) = (pitch_time / (100 * every) as f64, 100 * every);
    let mut simulation = simulation(problem, step, Start::Equilibrium);
    run(&mut simulation, settle_pitches * steps);
    let (mut dynamic, mut fixed) = ([0.0; 3], [0.0; 3]);
    let samples = 100 * pitches;
    for _ in 0..samples {
        run(&mut simulation, every);
        simulation.snapshot();
        let set = &simulation.system.sets[0];
        // Mean deviation of the balls from equal spacing, and their mean speed of orbit.
        let (mut phase, mut orbit) = (0.0, 0.0);
        let first = azimuth(&simulation.state, 0);
        for ball in 0..layout.balls {
            let nominal = first + TAU * ball as f64 / layout.balls as f64;
            let off = azimuth(&simulation.state, ball) - nominal;
            phase += (off - TAU * (off / TAU).round()) / layout.balls as f64;
            let position = layout.ball_vector(&simulation.state, POSITION, ball);
            let velocity = layout.ball_vector(&simulation.state, VELOCITY, ball);
            let around = position[1] * velocity[2] - position[2] * velocity[1];
            orbit += around / (position[1].powi(2) + position[2].powi(2)) / layout.balls as f64;
        }
        let mut still = problem.statics(simulation.time);
        still.orbital_speed = orbit;
        let (ours, theirs) = if matches!(problem.inner.drives[3], Drive::Motion(_)) {
            // Everything is given: each ball stands alone, and at its own angle.
            let mut moment = Vector3::zeros();
            for ball in 0..layout.balls {
                still.ball_phase = azimuth(&simulation.state, ball);
                let alone = solve(&still).unwrap().balls[0];
                moment += alone.position.cross(&alone.inner.force_on_race);
            }
            (set.on_races[0].moment, [moment[0], moment[1], moment[2]])
        } else {
            still.ball_phase = first + phase;
            let at = solve(&still).unwrap().coordinates;
            (set.races[0].state.position, [at[0], at[1], at[2]])
        };
        for i in 0..3 {
            dynamic[i] += ours[i] / samples as f64;
            fixed[i] += theirs[i] / samples as f64;
        }
    }
    Means { dynamic, fixed, seconds: clock.elapsed().as_secs_f64() }
}

fn rotating(loads: [f64; 5]) -> DynamicProblem {
    let mut problem = bearing(table_3_5(), loads, 1000.0 * RPM);
    problem.traction = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.05 };
    problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
    problem
}

#[test]
fn the_mean_of_a_turning_bearing_is_static() {
    for load in [250.0, 1500.0] {
        let means = means(&rotating([0.0, 0.0, -load, 0.0, 0.0]), 2.5e-6, 1, 2);
        let error = means.dynamic[2] / means.fixed[2] - 1.0;
        println!("{load} N: {:?} {:?} {error:e}, {} s", means.dynamic, means.fixed, means.seconds);
        assert!(error.abs() <= 1e-3, "{load} N: {error}");
    }
}

#[test]
fn the_mean_moment_of_a_tilted_turning_bearing_is_static() {
    let mut problem = rotating([0.0; 5]);
    let tilt = 0.15f64.to_radians();
    for (i, value) in [0.0, 0.0, 0.0, tilt, 0.0].into_iter().enumerate() {
        problem.inner.drives[i] = Drive::Motion(Profile::Constant(value));
    }
    let means = means(&problem, 2.5e-6, 1, 2);
    let error = means.dynamic[1] / means.fixed[1] - 1.0;
    println!("tilt: {:?} {:?} {error:e}, {} s", means.dynamic, means.fixed, means.seconds);
    assert!(error.abs() <= 1e-3, "{error}");
}

#[test]
fn centrifugal_force_loads_the_outer_race_at_10_000_rpm() {
    let mut problem = rotating([0.0, 0.0, -100.0, 0.0, 0.0]);
    problem.inner.rotation = Rotation::Speed(Profile::Constant(10_000.0 * RPM));
    let mut simulation = simulation(&problem, 2e-6, Start::Equilibrium);
    run(&mut simulation, 1000);
    let layout = simulation.system.sets[0].layout;
    let g = problem.geometry;
    let (mut difference, mut expected, samples) = (0.0, 0.0, 2000);
    for _ in 0..samples {
        run(&mut simulation, 1);
        simulation.snapshot();
        for ball in 0..layout.balls {
            let table = &simulation.system.sets[0].table;
            difference += table.load[layout.padded + ball] - table.load[ball];
            let body = layout.ball_state(&simulation.state, ball);
            let speed = Vector3::from(body.velocity).norm();
            expected += problem.ball.mass * speed * speed / g.pitch_radius;
        }
    }
    let error = difference / expected - 1.0;
    let mean = difference / (samples * layout.balls) as f64;
    println!("centrifugal force {mean} N a ball, off by {error:e}");
    // m Ω² R with Ω = 0.3855 of the shaft: 29 N.
    assert!(mean > 20.0);
    // The mean over 4 ms leaves the ends of the oscillations, a few µN·s of 0.1 N·s.
    assert!(error.abs() <= 2e-3, "{error}");
}

/// Ratio of the cage's speed to the inner race's after `time`, from balls and cage at rest on an
/// inner race at full speed.
fn cage_speed_from_rest(law: TractionLaw, time: f64) -> f64 {
    let geometry = table_5_3();
    let speed = 1000.0 * RPM;
    let mut problem = bearing(geometry, [445.0, 0.0, 0.0, 0.0, 0.0], 0.0);
    problem.cage = Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace));
    problem.traction = law;
    problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
    let start = simulation(&problem, 2e-6, Start::Equilibrium).state;
    problem.inner.rotation = Rotation::Speed(Profile::Constant(speed));
    let options = fixed_step(2e-6, Start::Nominal);
    let mut simulation = Simulation::from_state(problem.clone(), options, start, 0.0).unwrap();
    run(&mut simulation, (time / 2e-6) as usize);
    let at = simulation.system.sets[0].layout.cage();
    let cage = BodyState::from_slice(&simulation.state[at..]);
    Vector3::from(cage.spin).dot(&Vector3::from(cage.axis())) / speed
}

#[test]
fn the_cage_is_driven_by_traction_alone() {
    let law = |coefficient| TractionLaw::Constant { coefficient, regularisation_speed: 0.05 };
    assert_eq!(cage_speed_from_rest(TractionLaw::None, 4e-3), 0.0);
    let speeds = [0.0, 0.005, 0.02, 0.08].map(|c| cage_speed_from_rest(law(c), 4e-3));
    println!("cage over shaft after 4 ms: {speeds:?}");
    assert_eq!(speeds[0], 0.0);
    assert!(speeds.windows(2).all(|pair| pair[1] > 1.2 * pair[0]), "{speeds:?}");
}

#[test]
fn cage_slip_grows_as_traction_falls() {
    let geometry = table_5_3();
    let speed = 1000.0 * RPM;
    let rolling = ratios(11, geometry.ball_radius, geometry.pitch_radius, geometry.contact_angle);
    let slips = [0.1, 0.02, 0.004].map(|coefficient| {
        let mut problem = bearing(geometry, [445.0, 0.0, 0.0, 0.0, 0.0], speed);
        let mut body = cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace);
        // Weight and friction far above the real ones, so that the drag shows within 30 ms.
        body.contacts.friction = 0.3;
        problem.cage = Some(body);
        problem.gravity = [0.0, 0.0, -981.0];
        problem.traction = TractionLaw::Constant { coefficient, regularisation_speed: 0.05 };
        problem.damping = ContactDamping::HuntCrossley { alpha: 0.3 };
        let mut simulation = simulation(&problem, 2e-6, Start::Equilibrium);
        run(&mut simulation, 10_000);
        let at = simulation.system.sets[0].layout.cage();
        let angle = |simulation: &Simulation| {
            let layout = simulation.system.sets[0].layout;
            (0..layout.balls)
                .map(|ball| {
                    let [_, y, z] = layout.ball_vector(&simulation.state, POSITION, ball);
                    let [_, v, w] = layout.ball_vector(&simulation.state, VELOCITY, ball);
                    (y * w - z * v) / (y * y + z * z) / layout.balls as f64
                })
                .sum::<f64>()
        };
        let (mut cage, mut balls, samples) = (0.0, 0.0, 50);
        for _ in 0..samples {
            run(&mut simulation, 100);
            cage += simulation.state[at + SPIN] / samples as f64;
            balls += angle(&simulation) / samples as f64;
        }
        let slip = 1.0 - cage / (rolling.cage * speed);
        println!(
            "κ {coefficient}: cage slip {slip:e}, balls {}",
            1.0 - balls / rolling.cage / speed
        );
        slip
    });
    assert!(slips[0] < 0.02 && slips.windows(2).all(|pair| pair[1] > 2.0 * pair[0]), "{slips:?}");
}
