//! A step that is or becomes too long is refused before it spoils a run.

mod run_common;

use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::output::dynamics::session::{RunRequest, Session, SessionError, Status};
use bearing_dynamics::output::dynamics::summary::{RunReport, run_summary};
use bearing_dynamics::output::dynamics::table::RunTable;
use bearing_dynamics::solver::dynamics::model::{Drive, DynamicProblem};
use bearing_dynamics::solver::dynamics::run::{Simulation, SimulationError, Stepping};
use bearing_dynamics::solver::profile::Profile;
use run_common::{frictionless, request};

/// Traction that binds the step: it decays in proportion to the load.
fn sliding() -> DynamicProblem {
    DynamicProblem {
        traction: TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.005 },
        ..frictionless()
    }
}

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
fn a_step_that_becomes_too_long_ends_the_run() {
    // Half the limit under 250 N is three times the limit under 4000 N, where the slip decays ten
    // times as fast.
    let mut problem = sliding();
    let step = 0.5 * limit(&problem);
    let duration = 2000.0 * step;
    let ramp = Profile::Ramp { from: -250.0, to: -4000.0, start: 200.0 * step, duration };
    problem.inner.drives[2] = Drive::Load(ramp);
    for stepping in [Stepping::Fixed(step), Stepping::FractionOfLimit(0.5)] {
        let mut wanted = RunRequest { end: 3000.0 * step, ..request(step, 300) };
        wanted.options.stepping = stepping;
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
            Session::from_checkpoint(problem.clone(), &wanted, &kept, session.steps_per_row)
                .unwrap();
        assert!(again.recorder.restore(&session.recorder.series(rows).unwrap(), rows));
        assert_eq!(run(&mut again).unwrap_err(), error);
    }
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
