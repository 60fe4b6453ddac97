//! Rows and windows of a run lie where they are asked for, and channels are what its bodies do.

use crate::run_common;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::members::body::Rotation;
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::recorder::Recorder;
use bearing_dynamics::output::session::{RunRequest, Session, SessionError, Status};
use bearing_dynamics::output::table::RunTable;
use bearing_dynamics::plan::channels::ChannelGroup;
use run_common::{complete, frictionless, jolted, request, simulation};

pub fn to_the_end(problem: DynamicProblem, request: &RunRequest) -> Session<'static> {
    let mut session = Session::start(problem, request).unwrap();
    while session.advance(1000).unwrap() == Status::Running {}
    session
}

pub fn table(session: &Session) -> RunTable {
    RunTable::new(session, 0.0).unwrap()
}

pub fn column(session: &Session, name: &str) -> Vec<f64> {
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
