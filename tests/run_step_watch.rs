//! A step that is or becomes too long does not spoil a run: one that was given is refused, one that
//! follows from the limit is shortened.

mod run_common;

use bearing_dynamics::output::dynamics::session::{RunRequest, Session, SessionError, Status};
use bearing_dynamics::output::dynamics::summary::{RunReport, run_summary};
use bearing_dynamics::output::dynamics::table::RunTable;
use bearing_dynamics::solver::dynamics::model::DynamicProblem;
use bearing_dynamics::solver::dynamics::run::{Simulation, SimulationError, Stepping};
use run_common::{pressed, request, sliding};

/// The largest stable step at the start.
fn limit(problem: &DynamicProblem) -> f64 {
    let options = bearing_dynamics::solver::dynamics::run::RunOptions {
        stepping: Stepping::FractionOfLimit(1.0),
        ..Default::default()
    };
    Simulation::new(problem.clone(), options).unwrap().limit.unwrap().step
}

fn too_long(error: &SimulationError) -> Option<(f64, f64, f64)> {
    match error {
        SimulationError::StepTooLong { size, limit, time, .. } => Some((*size, *limit, *time)),
        _ => None,
    }
}

/// Steps until the end or an error.
fn run(session: &mut Session) -> Result<(), SimulationError> {
    while session.advance(100)? == Status::Running {}
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
    assert!(error.to_string().contains("traction onset"), "{error}");
    // A step within what the limit itself is good to is reported, one below it is not.
    for (part, warned) in [(1.05, true), (0.9, false)] {
        let session = Session::start(problem.clone(), &request(part * limit, 20)).unwrap();
        let table = RunTable::new(&session, 0.0).unwrap();
        let summary = run_summary(&session, &table, &[], &RunReport::default()).unwrap();
        let warning = &summary["step"]["warning"];
        assert_eq!(warning.is_string(), warned, "{part}: {warning}");
        assert_eq!(summary["step"]["limit_judged"], 1);
    }
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
    println!("{error}; judged {}", session.simulation.step_watch.judged);
    // Past the limit by no more than a row of looks, and in the middle of the ramp.
    assert!(size > 1.1 * limit && size < 1.2 * limit, "{size} {limit}");
    assert!(time > 300.0 * step && time < 2200.0 * step, "{time}");
    assert!(session.simulation.step_watch.judged <= 50);
    // The state is that before the step after which it was found, and a run that goes on from
    // there fails in the same place.
    let (kept, rows) = session.resumable();
    assert_eq!(kept.steps + 1, session.simulation.steps);
    let mut again =
        Session::from_checkpoint(problem.clone(), &wanted, &kept, session.steps_per_row).unwrap();
    assert!(again.recorder.restore(&session.recorder.series(rows).unwrap(), rows));
    assert_eq!(run(&mut again).unwrap_err(), error);
}

#[test]
fn a_step_that_follows_from_the_limit_is_shortened_when_the_limit_comes_down() {
    let step = 0.5 * limit(&sliding());
    let problem = pressed(step);
    let mut wanted = RunRequest { end: 3000.0 * step, ..request(step, 300) };
    wanted.options.stepping = Stepping::FractionOfLimit(0.5);
    let mut session = Session::start(problem.clone(), &wanted).unwrap();
    let first = session.simulation.step_size;
    run(&mut session).unwrap();
    let watch = session.simulation.step_watch;
    let shortened = watch.shortened.expect("the limit comes down to a tenth");
    // Each time by half or more: from half the first limit to half of a sixth of it.
    assert!((2..=4).contains(&shortened.times), "{shortened:?}");
    assert_eq!(shortened.from, first);
    assert!(shortened.last > 300.0 * step && shortened.last < 2200.0 * step, "{shortened:?}");
    assert_eq!(watch.exceeded, None);
    let last = session.simulation.step_size;
    assert!(last < 0.3 * first && last > 0.05 * first, "{first} {last}");
    // It ends below the limit of where it ends, and not needlessly far below.
    session.simulation.judge_step_now().unwrap();
    let smallest = session.simulation.step_watch.smallest.unwrap();
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
    println!("{found} {expected} {shortened:?}");
    assert!((found - expected).abs() <= 1e-6 * expected.abs(), "{found} {expected}");
    let table = RunTable::new(&session, 0.0).unwrap();
    let report = RunReport { stepping: Some(wanted.options.stepping), ..RunReport::default() };
    let summary = run_summary(&session, &table, &[], &report).unwrap();
    assert_eq!(summary["step"]["shortened"], shortened.times);
    assert_eq!(summary["step"]["largest"]["value"], first);
    assert_eq!(summary["step"]["smallest"]["value"], last);
    assert!(summary["step"]["reason"].as_str().unwrap().contains("last shortened"));
}

#[test]
fn contacts_that_stay_as_they_are_ask_for_no_jacobian() {
    let problem = sliding();
    let mut wanted = request(1e-6, 100);
    wanted.options.stepping = Stepping::FractionOfLimit(0.5);
    let mut session = Session::start(problem, &wanted).unwrap();
    run(&mut session).unwrap();
    assert_eq!(session.simulation.step_watch.judged, 0);
    assert_eq!(session.simulation.step_watch.exceeded, None);
}
