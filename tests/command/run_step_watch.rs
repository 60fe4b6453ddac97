//! A step that is or becomes too long does not spoil a run: one that was given is refused, one that
//! follows from the limit is shortened.

use crate::{dynamics, run_common};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::body::Drive;
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::motion::simulation::{Simulation, SimulationError, Stepping};
use bearing_dynamics::motion::stability::step_limit;
use bearing_dynamics::motion::system::System;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::session::{RunRequest, Session, SessionError, Status};
use bearing_dynamics::output::summary::{RunReport, run_summary};
use bearing_dynamics::output::table::RunTable;
use bearing_dynamics::plan::Stage;
use dynamics::{RPM, bearing, traction_laws};
use run_common::{common::table_4_1, of_steps, resumable, simulation, simulation_mut};
use run_common::{pressed, request, sliding};

/// The largest stable step at the start.
fn limit(problem: &DynamicProblem) -> f64 {
    let options = bearing_dynamics::motion::simulation::RunOptions {
        stepping: Stepping::FractionOfLimit(1.0),
        ..Default::default()
    };
    Simulation::new(problem.clone(), options).unwrap().limit.unwrap().step
}

/// The largest stable step of a simulation as it stands.
fn limit_of(simulation: &Simulation) -> f64 {
    let mut system = System::new(simulation.system.assembly.clone(), Kernel::Simd);
    step_limit(&mut system, simulation.time, &simulation.state).unwrap().step
}

fn too_long(error: &SimulationError) -> Option<(f64, f64, f64)> {
    match error {
        SimulationError::StepTooLong { size, limit, time, .. } => Some((*size, *limit, *time)),
        _ => None,
    }
}

/// How often the limit was computed.
fn judged(session: &Session) -> u64 {
    simulation(session).system.ran.whole.of(Stage::StabilityLimit)
}

/// Steps until the end or an error.
fn run(session: &mut Session) -> Result<(), SimulationError> {
    while session.advance(100).map_err(of_steps)? == Status::Running {}
    Ok(())
}

#[test]
fn a_given_step_above_the_limit_is_refused_at_the_start() {
    // 1.5 times the limit: the slips swing to and fro for good, and the ledger balances.
    let problem = sliding();
    let limit = limit(&problem);
    let wanted = request(1.5 * limit, 20);
    let error = Session::start(problem.clone(), &wanted).err();
    let Some(SessionError::Simulation(error)) = error else { panic!("{error:?}") };
    let (size, found, time) = too_long(&error).unwrap_or_else(|| panic!("{error}"));
    assert_eq!((size, time), (1.5 * limit, 0.0));
    assert!((found / limit - 1.0).abs() <= 1e-6, "{found} {limit}");
    assert!(error.to_string().contains("decay at "), "{error}");
    // A step within what the limit itself is good to is not.
    let session = Session::start(problem.clone(), &request(1.05 * limit, 20)).unwrap();
    assert_eq!(judged(&session), 1);
}

#[test]
fn a_given_step_that_becomes_too_long_ends_the_run() {
    // Half the limit under 250 N is three times the limit under 4000 N, where the slip decays ten
    // times as fast.
    let step = 0.5 * limit(&sliding());
    let problem = pressed(step);
    let wanted = RunRequest { end: 3000.0 * step, ..request(step, 300) };
    let mut session = Session::start(problem.clone(), &wanted).unwrap();
    let error = run(&mut session).unwrap_err();
    let (size, limit, time) = too_long(&error).unwrap_or_else(|| panic!("{error}"));
    println!("{error}; judged {}", judged(&session));
    // Past the limit by no more than a row of looks, and in the middle of the ramp.
    assert!(size > 1.1 * limit && size < 1.2 * limit, "{size} {limit}");
    assert!(time > 300.0 * step && time < 2200.0 * step, "{time}");
    assert!(judged(&session) <= 50);
    // The state is that before the step after which it was found, and a run that goes on from
    // there fails in the same place.
    let (kept, rows) = resumable(&mut session);
    assert_eq!(kept.steps + 1, simulation(&session).steps);
    let (clock, sound) = (session.clock.clone(), session.resumable());
    let series = session.recorder.series(rows).unwrap();
    let mut again = Session::resume(problem.clone(), &wanted, clock, sound, &series)
        .unwrap()
        .expect("its own rows");
    assert_eq!(run(&mut again).unwrap_err(), error);
}

#[test]
fn a_step_that_follows_from_the_limit_is_shortened_when_the_limit_comes_down() {
    let step = 0.5 * limit(&sliding());
    let problem = pressed(step);
    let mut wanted = RunRequest { end: 3000.0 * step, ..request(step, 300) };
    wanted.options.stepping = Stepping::FractionOfLimit(0.5);
    let mut session = Session::start(problem.clone(), &wanted).unwrap();
    let first = simulation(&session).step_size;
    run(&mut session).unwrap();
    let shortened = simulation(&session).step_watch.shortened;
    // Each time by a third or more: from half the first limit to half of a tenth of it.
    assert!((3..=6).contains(&shortened), "{shortened}");
    let last = simulation(&session).step_size;
    assert!(last < 0.3 * first && last > 0.05 * first, "{first} {last}");
    // It ends below the limit of where it ends, and not needlessly far below.
    simulation_mut(&mut session).judge_step_now().unwrap();
    let smallest = simulation(&session).step_watch.smallest.unwrap();
    assert!(last <= smallest && last >= 0.25 * smallest, "{last} {smallest}");
    // Rows stay where they were asked for.
    assert_eq!(session.recorder.rows(), 301);
    for row in 0..=300 {
        let time = session.recorder.row(row)[0];
        assert!((time - 10.0 * row as f64 * step).abs() <= 1e-6 * step, "row {row}: {time}");
    }
    // And the motion is that of a run which took short steps from the start: within 1e-6 of what
    // the load moves, where half the limit itself is good to 1e-7.
    let mut fine = RunRequest { ..wanted.clone() };
    fine.options.stepping = Stepping::Fixed(last);
    fine.output_interval = wanted.output_interval;
    let mut reference = Session::start(problem, &fine).unwrap();
    run(&mut reference).unwrap();
    let column = |session: &Session| {
        let columns = session.recorder.columns();
        let z = columns.iter().position(|column| column.name == "inner_z").unwrap();
        session.recorder.row(session.recorder.rows() - 1)[z]
    };
    let (found, expected) = (column(&session), column(&reference));
    println!("{found} {expected} {shortened}");
    assert!((found - expected).abs() <= 1e-6 * expected.abs(), "{found} {expected}");
    let table = RunTable::new(&session, 0.0).unwrap();
    let report = RunReport { stepping: Some(wanted.options.stepping), ..RunReport::default() };
    let summary = run_summary(&session, &table, &[], &report).unwrap();
    assert_eq!(summary["step"]["shortened"], shortened);
    assert_eq!(summary["step"]["size"]["value"], last);
    assert!(summary["step"]["reason"].as_str().unwrap().contains("last shortened"));
}

#[test]
fn contacts_that_stay_as_they_are_ask_for_no_jacobian() {
    // Without traction none; with it the schedule's 16, 32, … 512 and, at whole rows, 1024.
    for (problem, expected) in
        [(DynamicProblem { traction: TractionLaw::None, ..sliding() }, 0), (sliding(), 7)]
    {
        let mut wanted = request(1e-6, 100);
        wanted.options.stepping = Stepping::FractionOfLimit(0.5);
        let mut session = Session::start(problem, &wanted).unwrap();
        run(&mut session).unwrap();
        // And once at the start.
        assert_eq!(judged(&session), expected + 1);
        assert_eq!(simulation(&session).step_watch.shortened, 0);
    }
}

/// Under axial load balls roll with spin. A start keeps their slip off the steep onset of traction; it
/// comes back there at once, and the limit is a third of what it was.
#[test]
fn slip_that_comes_back_to_its_onset_shortens_the_step_and_refuses_a_given_one() {
    let loads = [1000.0, 0.0, -100.0, 0.0, 0.0];
    let problem = DynamicProblem {
        traction: traction_laws().swap_remove(2),
        ..bearing(table_4_1(-5e-6), loads, 3000.0 * RPM)
    };
    let at_start = limit(&problem);
    let mut wanted = request(1e-6, 100);
    wanted.end = 1e-3;
    wanted.options.energy_limit = 0.01;
    wanted.options.stepping = Stepping::FractionOfLimit(0.5);
    let mut session = Session::start(problem.clone(), &wanted).unwrap();
    run(&mut session).unwrap();
    let now = limit_of(simulation(&session));
    assert!(now < 0.5 * at_start, "{at_start} {now}");
    assert!(simulation(&session).step_size <= 0.76 * now, "{now}");
    let snapshot = simulation_mut(&mut session).snapshot();
    assert!(snapshot.residual.abs() <= 1e-6, "{}", snapshot.residual);
    // 0.9 of the limit at the start is far above that of a moment later.
    wanted.options.stepping = Stepping::Fixed(0.9 * at_start);
    wanted.options.energy_limit = f64::INFINITY;
    let mut session = Session::start(problem, &wanted).unwrap();
    let error = run(&mut session).unwrap_err();
    assert!(too_long(&error).is_some(), "{error}");
}

/// Where contacts are damped strongly the limit falls faster than stiffness and damping grow.
#[test]
fn a_damped_contact_that_is_pressed_harder_shortens_the_step() {
    let mut problem = bearing(table_4_1(-5e-6), [0.0; 5], 0.0);
    problem.damping = ContactDamping::HuntCrossley { alpha: 3.0 };
    problem.inner.drives[0] =
        Drive::Load(Profile::Ramp { from: 250.0, to: 2500.0, start: 0.0, duration: 5e-3 });
    for i in [3, 4] {
        problem.inner.drives[i] = Drive::Motion(Profile::ZERO);
    }
    let mut wanted = request(2e-6, 100);
    wanted.end = 5e-3;
    wanted.options.energy_limit = 0.01;
    wanted.options.stepping = Stepping::FractionOfLimit(0.5);
    let mut session = Session::start(problem, &wanted).unwrap();
    run(&mut session).unwrap();
    let now = limit_of(simulation(&session));
    assert!(simulation(&session).step_size <= 0.8 * now, "{now}");
    assert!(simulation(&session).step_watch.shortened > 0);
}
