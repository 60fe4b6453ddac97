//! What a run records is what its bodies do.

use crate::run_common;

use bearing_dynamics::output::recorder::Recorder;
use bearing_dynamics::output::session::{RunRequest, Session, SessionError, Status};
use bearing_dynamics::output::summary::{RunReport, run_summary};
use bearing_dynamics::output::table::RunTable;
use bearing_dynamics::solver::channels::ChannelGroup;
use bearing_dynamics::solver::dynamics::model::{Drive, DynamicProblem, Rotation};
use bearing_dynamics::solver::dynamics::run::{Integrator, RunOptions, Stepping};
use bearing_dynamics::solver::dynamics::state::{POSITION, VELOCITY};
use bearing_dynamics::solver::profile::Profile;
use nalgebra::{Matrix3, Vector3};
use run_common::{
    common, complete, frictionless, jolted, request, simulation, simulation_mut, sliding,
};

fn to_the_end(problem: DynamicProblem, request: &RunRequest) -> Session<'static> {
    let mut session = Session::start(problem, request).unwrap();
    while session.advance(1000).unwrap() == Status::Running {}
    session
}

fn table(session: &Session) -> RunTable {
    RunTable::new(session, 0.0).unwrap()
}

fn column(session: &Session, name: &str) -> Vec<f64> {
    table(session).all(name).unwrap_or_else(|| panic!("no channel {name}"))
}

#[test]
fn rows_lie_on_whole_steps_and_the_run_ends_at_its_end() {
    let wanted = request(1e-6, 20);
    let session = to_the_end(frictionless(), &wanted);
    let times = column(&session, "time");
    assert_eq!((times.len(), session.rows_on_grid()), (22, 21));
    assert_eq!(times[21], wanted.end);
    for (row, time) in times[..21].iter().enumerate() {
        // 200 sums of 1e-6, each rounded to 1e-20 at most.
        assert!((time - 1e-5 * row as f64).abs() <= 1e-17, "row {row}: {time}");
    }
    assert_eq!(simulation(&session).steps, 204);
    // An end on a row: no row is off the grid.
    let session = to_the_end(frictionless(), &RunRequest { end: 2e-4, ..wanted });
    assert_eq!((session.recorder.rows(), session.rows_on_grid()), (21, 21));
    assert_eq!((simulation(&session).steps, simulation(&session).time), (200, 2e-4));
}

#[test]
fn a_given_step_rounds_the_interval_and_a_derived_step_fits_it() {
    let given = RunRequest { output_interval: 1.234e-5, ..request(1e-6, 5) };
    let session = Session::start(frictionless(), &given).unwrap();
    assert_eq!((session.clock.steps_per_row, simulation(&session).step_size), (12, 1e-6));
    let stepping = Stepping::FractionOfLimit(0.5);
    let derived =
        RunRequest { options: RunOptions { stepping, ..RunOptions::default() }, ..given.clone() };
    let session = Session::start(frictionless(), &derived).unwrap();
    let limit = simulation(&session).limit.unwrap().step;
    assert!(simulation(&session).step_size <= 0.5 * limit);
    assert!((session.clock.row_interval() / 1.234e-5 - 1.0).abs() <= 1e-15);
    let finer = RunRequest { output_interval: 1e-9, ..given };
    assert_eq!(Session::start(frictionless(), &finer).unwrap().clock.steps_per_row, 1);
}

#[test]
fn what_makes_no_run_is_refused() {
    let start = |request: RunRequest| Session::start(frictionless(), &request).err().unwrap();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let wanted = request(1e-6, 5);
        assert!(matches!(start(RunRequest { end: bad, ..wanted.clone() }), SessionError::End(_)));
        let wanted = RunRequest { output_interval: bad, ..wanted };
        assert!(matches!(start(wanted), SessionError::Interval(_)));
    }
    let rows = usize::MAX / 64;
    let error =
        Recorder::new(&frictionless().assembly().into(), &[]).with_room(rows).err().unwrap();
    assert!(matches!(error, SessionError::Memory { .. }));
}

#[test]
fn no_row_asks_for_more_memory() {
    let mut session = Session::start(complete(), &request(1e-6, 30)).unwrap();
    let room = session.recorder.capacity();
    while session.advance(50).unwrap() == Status::Running {}
    assert_eq!(session.recorder.rows(), 32);
    assert_eq!(session.recorder.capacity(), room);
}

#[test]
fn only_what_is_asked_for_is_there() {
    let names = |problem: &DynamicProblem, groups: &[ChannelGroup]| {
        let recorder = Recorder::new(&problem.clone().into(), groups);
        recorder.columns().iter().map(|column| column.name.clone()).collect::<Vec<_>>()
    };
    // The ledger is always kept, and without friction, cage and gravity it is short.
    let ledger = [
        "time",
        "energy_kinetic",
        "energy_contact",
        "energy_ball_contact",
        "work_ball_friction",
        "work_drives",
        "energy_residual",
    ];
    assert_eq!(names(&frictionless(), &[]), ledger);
    let cage = [ChannelGroup::Cage, ChannelGroup::Pockets];
    assert_eq!(names(&frictionless(), &cage), ledger, "there is no cage");
    let with_cage = names(&complete(), &cage);
    assert!(with_cage.contains(&"cage_guide_load".to_string()));
    assert!(with_cage.contains(&"ball_8_pocket_load".to_string()));
    assert!(!with_cage.iter().any(|name| name.contains("slip") || name.contains("inner")));
    let races = names(&complete(), &[ChannelGroup::Races]);
    assert!(races.contains(&"outer_velocity_z".to_string()));
    let default = names(&complete(), &ChannelGroup::DEFAULT);
    assert!(!default.iter().any(|name| name.contains("slip")));
    assert_eq!(names(&complete(), &[ChannelGroup::Slip]).len() - names(&complete(), &[]).len(), 48);
}

#[test]
fn channels_are_the_bodies_motion() {
    let session = to_the_end(complete(), &request(1e-6, 30));
    let last = |name: &str| *column(&session, name).last().unwrap();
    let (layout, state) = (simulation(&session).system.sets[0].layout, &simulation(&session).state);
    let at = |body: usize, entry: usize| state[body + entry];
    for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
        assert_eq!(last(&format!("inner_{axis}")), at(layout.inner(), i));
        assert_eq!(last(&format!("inner_velocity_{axis}")), at(layout.inner(), 7 + i));
        assert_eq!(last(&format!("outer_{axis}")), at(layout.outer(), i));
        assert_eq!(last(&format!("cage_{axis}")), at(layout.cage(), i));
    }
    // The shaft is driven at 104.72 rad/s about an axis that barely tilts.
    assert!((last("inner_speed") - 104.72).abs() <= 1e-12 * 104.72);
    for ball in 1..=8 {
        let part = |component: usize| state[layout.ball(component) + ball - 1];
        let (y, z) = (part(1) - at(layout.outer(), 1), part(2) - at(layout.outer(), 2));
        let off = last(&format!("ball_{ball}_angle")).to_radians() - z.atan2(y);
        let turns = off / std::f64::consts::TAU;
        assert!((turns - turns.round()).abs() <= 1e-12, "ball {ball}: {turns}");
    }
    // Loads of the balls on a race against the sum of its contact forces, which with traction of a
    // tenth at most lies within a tenth of the vector sum of the normal loads.
    let sum = |race: &str| {
        (1..=8).fold([0.0; 2], |[y, z], ball| {
            let load = last(&format!("ball_{ball}_{race}_load"));
            let angle = last(&format!("ball_{ball}_angle")).to_radians();
            [y + load * angle.cos(), z + load * angle.sin()]
        })
    };
    for (race, sign) in [("inner", -1.0), ("outer", 1.0)] {
        let [y, z] = sum(race);
        let force = ["y", "z"].map(|axis| last(&format!("contact_force_on_{race}_{axis}")));
        let error = (force[0] - sign * y).hypot(force[1] - sign * z);
        assert!(error <= 0.15 * y.hypot(z), "{race}: {force:?} against {y} {z}");
    }
}

#[test]
fn angles_count_turns() {
    // One row every 100 deg of orbit and more: wrapped angles alone would not tell the turns.
    let mut problem = frictionless();
    let speed = 30_000.0 * std::f64::consts::PI / 30.0;
    problem.inner.rotation = Rotation::Speed(Profile::Constant(speed));
    let mut wanted = request(5e-7, 1);
    wanted.end = 12e-3;
    wanted.output_interval = 1.5e-3;
    wanted.options.energy_limit = 1.0;
    let session = to_the_end(problem, &wanted);
    let angles = column(&session, "ball_1_angle");
    let speeds = column(&session, "ball_1_orbital_speed");
    let swept = (angles[8] - angles[0]).to_radians();
    let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
    // Seconds × mean speed, of 14 rad; turns are 6.28 rad apart.
    assert!(swept > 10.0, "{swept}");
    assert!((swept - 12e-3 * mean).abs() <= 0.05 * swept, "{swept} against {}", 12e-3 * mean);
}

#[test]
fn slip_is_the_difference_of_surface_speeds() {
    // Balls start rolling at the nominal contact angle. Brake ball 1 by 10 rad/s about X: its
    // outer contact then slides by 10 rad/s · r_b along the rolling direction.
    let problem = frictionless();
    let radius = problem.geometry.ball_radius;
    let mut wanted = request(1e-6, 2);
    // The brake takes energy that no ledger knows of.
    wanted.options.energy_limit = 1e9;
    let mut session = Session::start(problem.clone(), &wanted).unwrap();
    let layout = simulation(&session).system.sets[0].layout;
    let before: Vec<f64> = session.recorder.row(0).to_vec();
    simulation_mut(&mut session).state[layout.ball(10)] += 10.0;
    let snapshot = simulation_mut(&mut session).snapshot().unwrap();
    session.recorder.record(session.motion.bearing().unwrap(), &snapshot);
    let at = |name: &str| {
        let columns = session.recorder.columns();
        let index = columns.iter().position(|column| column.name == name).unwrap();
        session.recorder.row(1)[index] - before[index]
    };
    // ω × n r with n = −out on the inner and +out on the outer race: out × X turned.
    let outer = at("ball_1_outer_slip_rolling");
    let inner = at("ball_1_inner_slip_rolling");
    assert!((outer - 10.0 * radius).abs() <= 0.02 * 10.0 * radius, "{outer}");
    assert!((inner + 10.0 * radius).abs() <= 0.02 * 10.0 * radius, "{inner}");
    assert_eq!(at("ball_2_outer_slip_rolling"), 0.0);
    // Spin about the outer normal, which points along the ball's radius.
    let mut session = Session::start(problem, &wanted).unwrap();
    let angle: f64 = 0.1;
    simulation_mut(&mut session).state[layout.ball(11)] += 5.0 * angle.cos();
    simulation_mut(&mut session).state[layout.ball(12)] += 5.0 * angle.sin();
    let snapshot = simulation_mut(&mut session).snapshot().unwrap();
    session.recorder.record(session.motion.bearing().unwrap(), &snapshot);
    let columns = session.recorder.columns();
    let index = columns.iter().position(|c| c.name == "ball_1_outer_spin").unwrap();
    let spin = session.recorder.row(1)[index] - session.recorder.row(0)[index];
    assert!((spin - 5.0).abs() <= 0.01, "{spin}");
}

#[test]
fn the_window_starts_on_its_row() {
    let session = to_the_end(frictionless(), &request(1e-6, 20));
    let rows = |start: f64| RunTable::new(&session, start).unwrap().window;
    assert_eq!(rows(0.0), 0..21);
    // 5e-5 s is row 5 but for rounding; a bit later is row 6.
    assert_eq!(rows(5e-5), 5..21);
    assert_eq!(rows(5.1e-5), 6..21);
    assert!(rows(1.0).is_empty());
}

#[test]
fn steps_end_at_corners_and_are_even_between_them() {
    let problem = jolted();
    let wanted = RunRequest { end: 0.2e-3, ..request(1e-6, 20) };
    let mut session = Session::start(problem.clone(), &wanted).unwrap();
    let mut times = vec![0.0];
    while session.advance(1).unwrap() == Status::Running {
        times.push(simulation(&session).time);
    }
    times.push(simulation(&session).time);
    let corners = problem.assembly().corners();
    assert_eq!(corners.len(), 6);
    for corner in corners {
        assert!(times.contains(&corner), "no step ends at {corner}");
    }
    let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (shortest, longest) =
        steps.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), step| (a.min(*step), b.max(*step)));
    println!("{} steps of {shortest:e} to {longest:e} s", steps.len());
    assert!(longest <= 1e-6 * (1.0 + 1e-6), "{longest}");
    // The shortest way between corners and rows is 0.3 µs, 5.3 µs in 6 steps the next.
    let odd = steps.iter().filter(|step| **step < 0.8e-6).count();
    assert!(odd <= 3 && shortest >= 0.29e-6, "{odd} short steps, {shortest} s");
    // Rows are where they would be without corners.
    let rows = column(&session, "time");
    assert_eq!((rows.len(), session.rows_on_grid()), (21, 21));
    for (row, time) in rows.iter().enumerate() {
        assert!((time - 1e-5 * row as f64).abs() <= 1e-17, "row {row}: {time}");
    }
}

#[test]
fn the_work_of_a_jolt_is_in_the_ledger() {
    // Velocity of the inner race jumps by tens of mm/s: 1e-4 J each, and more than the contacts
    // store. Without corners in the given motion the residual is what a step of 1 µs leaves.
    let runs = [
        (Integrator::RungeKutta, Stepping::Fixed(1e-6)),
        (Integrator::DormandPrince, Stepping::Accuracy(1e-3)),
        (Integrator::Rosenbrock, Stepping::Accuracy(1e-3)),
    ];
    for (integrator, stepping) in runs {
        let mut wanted = RunRequest { end: 0.2e-3, ..request(1e-6, 20) };
        wanted.options.integrator = integrator;
        wanted.options.stepping = stepping;
        let session = to_the_end(jolted(), &wanted);
        let mass = simulation(&session).system.assembly.bodies[0].inertia().unwrap().mass;
        let speed = 3e-6 / (0.08e-3 - 0.0341e-3);
        let jump: f64 = 0.5 * mass * speed * speed;
        let residual = column(&session, "energy_residual");
        let worst = residual.iter().fold(0.0_f64, |worst, value| worst.max(value.abs()));
        println!("{integrator:?}: a jump makes {jump:e} J, residual {worst:e} J");
        assert!(worst <= 1e-3 * jump, "{integrator:?}: {worst} of {jump}");
    }
}

/// A pulse shorter than a row: 9 kN for 20 µs in a row of 1 ms.
fn struck() -> DynamicProblem {
    let mut problem = frictionless();
    let pulse = Profile::HalfSine { base: -250.0, peak: -9000.0, start: 0.33e-3, duration: 60e-6 };
    problem.inner.drives[2] = Drive::Load(pulse);
    problem
}

#[test]
fn extremes_are_of_every_step_whatever_the_rows() {
    for (integrator, stepping) in [
        (Integrator::RungeKutta, Stepping::Fixed(1e-6)),
        (Integrator::DormandPrince, Stepping::Accuracy(1e-3)),
        (Integrator::Rosenbrock, Stepping::Accuracy(1e-3)),
    ] {
        let options = RunOptions { integrator, stepping, ..RunOptions::default() };
        let wanted = |output_interval: f64| RunRequest {
            options,
            end: 1e-3,
            output_interval,
            ..request(1e-6, 1)
        };
        // A row a step: what the rows say is what the steps say.
        let fine = to_the_end(struck(), &wanted(1e-6));
        let of_rows = |what: &str, session: &Session| {
            let channels = (1..=8).map(|ball| column(session, &format!("ball_{ball}_{what}_load")));
            channels.flatten().fold(0.0, f64::max)
        };
        for (side, what) in ["inner", "outer"].into_iter().enumerate() {
            let most = simulation(&fine).extremes[0].races[side].load.value;
            // Steps of error control end between rows as well, half a microsecond from a peak of 50 kHz.
            assert!(most >= of_rows(what, &fine));
            let race = simulation(&fine).extremes[0].races[side];
            assert!(
                most <= 1.01 * of_rows(what, &fine),
                "{integrator:?} {race:?} {}",
                of_rows(what, &fine)
            );
        }
        // Two rows: they show nothing of the pulse, the extremes all of it.
        let coarse = to_the_end(struck(), &wanted(1e-3));
        let [of_fine, of_coarse] =
            [&fine, &coarse].map(|session| simulation(session).extremes[0].races[0].load);
        assert!(of_coarse.value >= 1.5 * of_rows("inner", &coarse), "{of_coarse:?}");
        match integrator {
            // But for rounding of the times at which the pulse is read.
            Integrator::RungeKutta => {
                let off = of_coarse.value / of_fine.value - 1.0;
                assert!(off.abs() <= 1e-10 && of_coarse.ball == of_fine.ball, "{of_coarse:?}");
                assert!((of_coarse.time - of_fine.time).abs() <= 1e-15, "{of_coarse:?}");
            }
            // Other steps, the same motion.
            _ => assert!((of_coarse.value / of_fine.value - 1.0).abs() <= 1e-2, "{of_coarse:?}"),
        }
        let far = |session: &Session| {
            let of = |axis: &str| column(session, &format!("inner_{axis}"));
            let [x, y, z] = ["x", "y", "z"].map(of);
            let all = x.iter().zip(&y).zip(&z).map(|((x, y), z)| (x * x + y * y + z * z).sqrt());
            all.fold(0.0, f64::max)
        };
        let farthest = simulation(&coarse).extremes[0].farthest.value;
        assert!((farthest / far(&fine) - 1.0).abs() <= 1e-2, "{farthest} {}", far(&fine));
        assert!(farthest >= 1.2 * far(&coarse));
    }
}

/// Value and time of an extreme belong to one state.
#[test]
fn an_extreme_has_the_time_of_its_state() {
    for (integrator, stepping) in [
        (Integrator::RungeKutta, Stepping::Fixed(1e-6)),
        (Integrator::DormandPrince, Stepping::Accuracy(1e-3)),
        (Integrator::Rosenbrock, Stepping::Accuracy(1e-3)),
    ] {
        let options = RunOptions { integrator, stepping, ..RunOptions::default() };
        let wanted = RunRequest { options, end: 1e-3, output_interval: 1e-3, ..request(1e-6, 1) };
        let mut session = Session::start(struck(), &wanted).unwrap();
        let at = simulation(&session).system.sets[0].layout.inner() + POSITION;
        let (mut farthest, mut when) = (0.0f64, 0.0);
        loop {
            let [x, y, z] = [0, 1, 2].map(|i| simulation(&session).state[at + i]);
            let distance = (x * x + y * y + z * z).sqrt();
            if distance > farthest {
                (farthest, when) = (distance, simulation(&session).time);
            }
            if session.advance(1).unwrap() == Status::Complete {
                break;
            }
        }
        let found = simulation(&session).extremes[0].farthest;
        // Rounding of a sum of three squares, and of the time at which a step ends.
        assert!((found.value / farthest - 1.0).abs() <= 1e-14, "{integrator:?} {found:?}");
        assert!((found.time - when).abs() <= 1e-15, "{integrator:?} {found:?} {when}");
    }
}

#[test]
fn slip_is_told_against_the_contact_angle_that_balls_have() {
    // Pushed along its axis with clearance, the deep-groove bearing runs at an angle far from its
    // nominal one of zero, and the axial load leaves the balls hardly any slip.
    let mut problem = DynamicProblem { geometry: common::table_4_1(20e-6), ..sliding() };
    problem.inner.drives[2] = Drive::Load(Profile::ZERO);
    problem.inner.drives[0] = Drive::Load(Profile::Constant(500.0));
    problem.inner.drives[3] = Drive::Motion(Profile::ZERO);
    problem.inner.drives[4] = Drive::Motion(Profile::ZERO);
    let options = RunOptions {
        integrator: Integrator::Rosenbrock,
        stepping: Stepping::Accuracy(1e-3),
        energy_limit: f64::INFINITY,
        ..RunOptions::default()
    };
    let wanted = RunRequest { options, end: 40e-3, output_interval: 0.1e-3, ..request(1e-6, 1) };
    let session = to_the_end(problem, &wanted);
    let table = RunTable::new(&session, 30e-3).unwrap();
    let summary = run_summary(&session, &table, &[], &RunReport::default()).unwrap();
    let of = |name: &str| summary["kinematics"][name]["value"].as_f64().unwrap();
    assert!(of("inner_contact_angle") > 10.0, "{}", summary["kinematics"]);
    // Harris: the ball set with control of either race.
    let geometry = simulation(&session).system.assembly.bearings[0].geometry;
    let gamma = geometry.ball_radius / geometry.pitch_radius;
    let [inner, outer] = ["inner_contact_angle", "outer_contact_angle"].map(|n| of(n).to_radians());
    let both = 1.0 + (inner - outer).cos();
    let control = [
        ("outer", (1.0 - gamma * inner.cos()) / both),
        ("inner", ((inner - outer).cos() - gamma * outer.cos()) / both),
    ];
    let [low, high] = [control[1].1, control[0].1].map(|ratio| ratio * of("inner_race_speed"));
    for (race, ratio) in control {
        let told = of(&format!("rolling_cage_speed_{race}_control"));
        let expected = ratio * of("inner_race_speed");
        assert!((told / expected - 1.0).abs() <= 1e-12, "{race}: {told} {expected}");
    }
    // No slip between them, and against the nearer one outside.
    let measured = of("ball_set_speed");
    let slip = 1.0 - measured / measured.clamp(low.min(high), low.max(high));
    assert!((of("ball_set_slip") - slip).abs() <= 1e-12, "{slip}");
    let nominal = 1.0 - of("ball_set_speed") / of("rolling_cage_speed_at_nominal_angle");
    assert!(nominal.abs() > 2e-3, "{nominal}");
    // A tenth of it at most: what spin leaves, and the angle of each ball beside the mean.
    assert!(of("ball_set_slip").abs() <= 0.1 * nominal.abs(), "{}", summary["kinematics"]);
    assert!(summary["kinematics"]["rolling_at"].as_str().unwrap().contains("mean contact angles"));
}

/// Balls go round the outer race's centre: what all of them have in common is no orbiting.
#[test]
fn orbital_speeds_count_from_the_moving_outer_race() {
    let mut wanted = request(1e-6, 2);
    // The push takes energy that no ledger knows of.
    wanted.options.energy_limit = 1e9;
    let mut session = Session::start(complete(), &wanted).unwrap();
    let before: Vec<f64> = session.recorder.row(0).to_vec();
    let simulation = simulation_mut(&mut session);
    let (layout, at) = (simulation.system.sets[0].layout, simulation.system.places.body(1));
    let velocity = [0.0, 0.7, -0.4];
    for (i, by) in velocity.into_iter().enumerate() {
        simulation.state[at + VELOCITY + i] += by;
        for ball in 0..layout.balls {
            simulation.state[layout.ball(VELOCITY + i) + ball] += by;
        }
    }
    let snapshot = simulation.snapshot().unwrap();
    session.recorder.record(session.motion.bearing().unwrap(), &snapshot);
    for ball in 1..=layout.balls {
        let name = format!("ball_{ball}_orbital_speed");
        let index = session.recorder.columns().iter().position(|c| c.name == name).unwrap();
        let (was, is) = (before[index], session.recorder.row(1)[index]);
        // Rounding; the common velocity alone would be 0.8/0.026 of it.
        assert!((is - was).abs() <= 1e-12 * was.abs() && was > 10.0, "{name}: {was} {is}");
    }
}

/// The largest energy that was missing is that of all rows, not of the last one.
#[test]
fn the_summary_tells_the_largest_residual_of_all_rows() {
    // What the steps leave changes its sign between the third row and the fourth.
    let wanted = RunRequest { end: 30e-6, ..request(1e-6, 3) };
    let session = to_the_end(jolted(), &wanted);
    let summary = run_summary(&session, &table(&session), &[], &RunReport::default()).unwrap();
    let of = |name: &str| summary["energy"][name]["value"].as_f64().unwrap();
    let rows = column(&session, "energy_residual");
    let largest = rows.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    assert_eq!(of("energy_residual"), rows[rows.len() - 1]);
    assert_eq!(of("largest_residual"), largest);
    assert!(largest > rows[rows.len() - 1].abs(), "{rows:?}");
}

/// Speed of the balls' orbits where they slip at neither contact and do not spin on one of the races, from the
/// velocities of the surfaces: contact angles (rad) and speeds (rad/s) of the inner and the outer race.
fn orbit_without_slip(ball: f64, pitch: f64, angles: [f64; 2], speeds: [f64; 2], on: usize) -> f64 {
    // Radially outwards and along the axis, from the ball's centre to its contacts.
    let normals = [[-angles[0].cos(), -angles[0].sin()], [angles[1].cos(), angles[1].sin()]];
    // Unknown: the orbit's speed, the ball's spin along the axis and along the radius.
    let row = |[r, x]: [f64; 2]| [pitch, ball * r, -ball * x];
    let surface = |side: usize| speeds[side] * (pitch + ball * normals[side][0]);
    let [r, x] = normals[on];
    let matrix =
        Matrix3::from_rows(&[row(normals[0]).into(), row(normals[1]).into(), [0.0, x, r].into()]);
    let right = Vector3::new(surface(0), surface(1), speeds[on] * x);
    matrix.lu().solve(&right).expect("two contacts")[0]
}

/// At speed balls press outwards: they touch the inner race at the larger angle, and which race they spin on counts.
#[test]
fn speeds_of_rolling_follow_from_the_velocities_at_both_contacts() {
    let mut problem = DynamicProblem { geometry: common::table_5_3(), ..frictionless() };
    problem.inner.drives = [const { Drive::Motion(Profile::ZERO) }; 5];
    problem.inner.drives[0] = Drive::Load(Profile::Constant(400.0));
    problem.inner.rotation = Rotation::Speed(Profile::Constant(2000.0));
    let mut outer = problem.inner.clone();
    outer.drives[0] = Drive::Motion(Profile::ZERO);
    outer.rotation = Rotation::Speed(Profile::Constant(-300.0));
    problem.outer = Some(outer);
    let mut wanted = request(1e-6, 20);
    wanted.options.energy_limit = f64::INFINITY;
    let session = to_the_end(problem, &wanted);
    let summary = run_summary(&session, &table(&session), &[], &RunReport::default()).unwrap();
    let of = |name: &str| summary["kinematics"][name]["value"].as_f64().unwrap();
    let degrees = ["inner_contact_angle", "outer_contact_angle"].map(of);
    assert!(degrees[0] > degrees[1] + 1.0, "{degrees:?}");
    let geometry = simulation(&session).system.assembly.bearings[0].geometry;
    let (ball, pitch) = (geometry.ball_radius, geometry.pitch_radius);
    let angles = degrees.map(f64::to_radians);
    let expected = [0, 1].map(|on| orbit_without_slip(ball, pitch, angles, [2000.0, -300.0], on));
    assert!((expected[0] / expected[1] - 1.0).abs() > 1e-4, "{expected:?}");
    for (race, expected) in ["inner", "outer"].into_iter().zip(expected) {
        let told = of(&format!("rolling_cage_speed_{race}_control"));
        // Rounding of angles in degrees.
        assert!((told / expected - 1.0).abs() <= 1e-12, "{race}: {told} {expected}");
    }
}
