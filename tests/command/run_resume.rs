//! A run that was interrupted ends with the same bytes as one that was not.

use super::run_extremes::crowded;
use crate::run_common;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::members::body::Drive;
use bearing_dynamics::motion::simulation::{Integrator, SimulationError, Start, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::session::{Checkpoint, RunRequest, Session, Status};
use bearing_dynamics::output::state::{
    self, StateError, StateRecord, Stopped, fingerprint, read, resume, save,
};
use bearing_dynamics::output::summary::{RunReport, run_summary, write_run_results};
use bearing_dynamics::output::table::RunTable;
use run_common::{
    complete, frictionless, jolted, of_steps, pressed, rattling, request, resumable, simulation,
    simulation_mut,
};
use serde_json::Value;
use std::fs;
use std::path::Path;

const STEP: f64 = 1e-6;

fn record(problem: &DynamicProblem, request: &RunRequest, stopped: Stopped) -> StateRecord {
    StateRecord {
        fingerprint: fingerprint(&problem.clone().into(), request),
        stopped,
        error: None,
        seconds: 0.0,
    }
}

/// Runs to the end, writes everything, as the command does.
fn finish(folder: &Path, problem: &DynamicProblem, request: &RunRequest, mut session: Session) {
    while session.advance(7).unwrap() == Status::Running {}
    write(folder, problem, request, &mut session, Stopped::Complete);
}

fn write(
    folder: &Path,
    problem: &DynamicProblem,
    request: &RunRequest,
    session: &mut Session,
    stopped: Stopped,
) {
    let table = RunTable::new(session, 0.0).unwrap();
    write_run_results(folder, session, &table, &table.spectra(), &RunReport::default()).unwrap();
    save(folder, session, &record(problem, request, stopped)).unwrap();
}

fn go_on(folder: &Path, problem: &DynamicProblem, request: &RunRequest) -> Session<'static> {
    let file = read(folder).unwrap().expect("a state was written");
    resume(folder, &file, problem.clone(), request).unwrap()
}

fn assert_same_files(expected: &Path, found: &Path) {
    let mut names: Vec<_> =
        fs::read_dir(expected).unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert!(names.len() >= 5, "{names:?}");
    for name in names {
        let [a, b] = [expected, found].map(|folder| fs::read(folder.join(&name)).unwrap());
        assert!(a == b, "{} differs", name.display());
    }
}

#[test]
fn interrupted_anywhere_the_files_are_the_same() {
    let folder = tempfile::tempdir().unwrap();
    use Integrator::{DormandPrince, Rosenbrock, RungeKutta};
    for (name, problem, integrator, start) in [
        ("complete", complete(), RungeKutta, Start::Equilibrium),
        ("rosenbrock", complete(), Rosenbrock, Start::Equilibrium),
        ("dormand-prince", rattling(), DormandPrince, Start::Nominal),
        ("rattling", rattling(), RungeKutta, Start::Nominal),
        ("frictionless", frictionless(), RungeKutta, Start::Equilibrium),
        ("jolted", jolted(), RungeKutta, Start::Equilibrium),
    ] {
        let mut request = request(STEP, 40);
        request.options.start = start;
        request.options.integrator = integrator;
        // On a row, off a row, before the first row, twice, within the last steps.
        let stops = [vec![200], vec![137], vec![3], vec![55, 56, 333], vec![403]];
        interrupt(folder.path(), name, &problem, &request, &stops);
    }
}

#[test]
fn with_error_control_the_files_are_the_same_too() {
    let folder = tempfile::tempdir().unwrap();
    for (name, problem, integrator, start) in [
        ("rosenbrock", complete(), Integrator::Rosenbrock, Start::Equilibrium),
        ("rattling", rattling(), Integrator::Rosenbrock, Start::Nominal),
        ("dormand-prince", frictionless(), Integrator::DormandPrince, Start::Equilibrium),
    ] {
        let mut request = request(STEP, 40);
        request.options.start = start;
        request.options.integrator = integrator;
        request.options.stepping = Stepping::Accuracy(1e-3);
        // At least a step a row, and a last one off the grid.
        let stops = [vec![1], vec![3, 4, 17], vec![40]];
        interrupt(folder.path(), name, &problem, &request, &stops);
        // A shorter run that is extended has the bits of the long one.
        let short = RunRequest { end: 123.4 * STEP, ..request.clone() };
        let parts = folder.path().join(format!("{name} extended"));
        finish(&parts, &problem, &short, Session::start(problem.clone(), &short).unwrap());
        let session = go_on(&parts, &problem, &request);
        finish(&parts, &problem, &request, session);
        assert_same_files(&folder.path().join(name), &parts);
    }
}

/// Runs as a whole and with each list of stops; all files must be the same.
fn interrupt(
    folder: &Path,
    name: &str,
    problem: &DynamicProblem,
    request: &RunRequest,
    stops: &[Vec<u64>],
) {
    let whole = folder.join(name);
    finish(&whole, problem, request, Session::start(problem.clone(), request).unwrap());
    for stops in stops {
        let parts = folder.join(format!("{name} {stops:?}"));
        let mut session = Session::start(problem.clone(), request).unwrap();
        let mut steps = 0;
        for &stop in stops {
            assert_eq!(session.advance(stop - steps).unwrap(), Status::Running);
            steps = stop;
            write(&parts, problem, request, &mut session, Stopped::Interrupted);
            session = go_on(&parts, problem, request);
            assert_eq!(simulation(&session).steps, steps);
        }
        finish(&parts, problem, request, session);
        assert_same_files(&whole, &parts);
    }
}

#[test]
fn where_the_step_was_shortened_the_files_are_the_same_too() {
    let folder = tempfile::tempdir().unwrap();
    let step = 4e-7;
    let problem = pressed(step);
    let mut long = RunRequest { end: 2000.0 * step, ..request(10.0 * step, 20) };
    long.options.stepping = Stepping::FractionOfLimit(0.5);
    // Where the step is shortened first, in the middle of a row.
    let mut session = Session::start(problem.clone(), &long).unwrap();
    while simulation(&session).step_watch.shortened == 0 {
        assert_eq!(session.advance(1).unwrap(), Status::Running);
    }
    let (at, time) = (simulation(&session).steps, simulation(&session).time);
    println!("shortened after step {at}, at t = {time} s");
    let stops = [vec![at - 1], vec![at], vec![at + 1], vec![at - 16, at + 16], vec![at + 100]];
    interrupt(folder.path(), "shortened", &problem, &long, &stops);
    // A run that ends close to there and is extended.
    for (index, end) in [time - 0.2 * step, time, time + 0.2 * step].into_iter().enumerate() {
        let short = RunRequest { end, ..long.clone() };
        let parts = folder.path().join(format!("extended {index}"));
        finish(&parts, &problem, &short, Session::start(problem.clone(), &short).unwrap());
        let session = go_on(&parts, &problem, &long);
        finish(&parts, &problem, &long, session);
        assert_same_files(&folder.path().join("shortened"), &parts);
    }
}

#[test]
fn an_extended_run_has_the_bits_of_a_long_one() {
    let folder = tempfile::tempdir().unwrap();
    let problem = complete();
    let long = request(STEP, 30);
    let short = RunRequest { end: 123.4 * STEP, ..long.clone() };
    let [at_once, extended] = ["at once", "extended"].map(|name| folder.path().join(name));
    finish(&at_once, &problem, &long, Session::start(problem.clone(), &long).unwrap());
    finish(&extended, &problem, &short, Session::start(problem.clone(), &short).unwrap());
    let short_end = *go_on(&extended, &problem, &short).recorder.row(12).first().unwrap();
    assert!((short_end - 120.0 * STEP).abs() <= 1e-3 * STEP, "the shortened step is in the state");
    let session = go_on(&extended, &problem, &long);
    finish(&extended, &problem, &long, session);
    assert_same_files(&at_once, &extended);
    // A complete run that is resumed computes its last step once more and changes nothing.
    let session = go_on(&extended, &problem, &long);
    finish(&extended, &problem, &long, session);
    assert_same_files(&at_once, &extended);
}

/// A load that jumps: the step after it begins with what comes after it, in a run that goes on as in one that
/// starts there.
#[test]
fn interrupted_where_a_load_jumps_the_files_are_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let corner = 0.0123e-3;
    let mut problem = frictionless();
    let jump = Profile::Ramp { from: -250.0, to: -750.0, start: corner, duration: 0.0 };
    problem.inner.drives[2] = Drive::Load(jump);
    for integrator in [Integrator::DormandPrince, Integrator::Rosenbrock] {
        let mut request = request(STEP, 4);
        request.options.integrator = integrator;
        request.options.stepping = Stepping::Accuracy(1e-3);
        let mut session = Session::start(problem.clone(), &request).unwrap();
        while simulation(&session).time < corner {
            session.advance(1).unwrap();
        }
        assert_eq!(simulation(&session).time, corner);
        let steps = simulation(&session).steps;
        interrupt(folder.path(), integrator.name(), &problem, &request, &[vec![steps]]);
    }
}

/// Names and values of all numbers below a value.
fn numbers(name: &str, of: &Value, all: &mut Vec<(String, f64)>) {
    match of {
        Value::Object(map) => {
            map.iter().for_each(|(key, of)| numbers(&format!("{name}/{key}"), of, all))
        }
        Value::Array(list) => list.iter().for_each(|of| numbers(name, of, all)),
        _ => all.extend(of.as_f64().map(|value| (name.to_string(), value))),
    }
}

/// Extremes that have all occurred before a run is interrupted, of balls that touch too, are those of the unbroken run.
#[test]
fn extremes_before_an_interruption_stay() {
    let folder = tempfile::tempdir().unwrap();
    // Losses: what comes later is less.
    let damping = ContactDamping::HuntCrossley { alpha: 3.0 };
    let problem = DynamicProblem { gravity: [0.0; 3], damping, ..crowded() };
    for integrator in [Integrator::RungeKutta, Integrator::Rosenbrock] {
        let step = 0.25e-6;
        let mut request = RunRequest { end: 1.5e-3, output_interval: 0.1e-3, ..request(step, 1) };
        request.options.start = Start::Nominal;
        request.options.integrator = integrator;
        if integrator == Integrator::Rosenbrock {
            request.options.stepping = Stepping::Accuracy(1e-3);
        }
        let extremes = |mut session: Session| {
            while session.advance(1000).unwrap() == Status::Running {}
            let table = RunTable::new(&session, 0.0).unwrap();
            let summary = run_summary(&session, &table, &[], &RunReport::default()).unwrap();
            let mut all = Vec::new();
            numbers("", &summary["extremes"], &mut all);
            all
        };
        let whole = extremes(Session::start(problem.clone(), &request).unwrap());
        println!("{whole:?}");
        let times = whole.iter().filter(|(name, _)| name.ends_with("/time/value"));
        let last = times.clone().map(|(_, time)| *time).fold(0.0, f64::max);
        assert!(times.count() == 7 && last < 0.9 * request.end, "{whole:?}");
        assert!(whole.iter().all(|(_, value)| *value > 0.0), "{whole:?}");
        let mut session = Session::start(problem.clone(), &request).unwrap();
        while simulation(&session).time <= last {
            assert_eq!(session.advance(1).unwrap(), Status::Running);
        }
        write(folder.path(), &problem, &request, &mut session, Stopped::Interrupted);
        assert_eq!(extremes(go_on(folder.path(), &problem, &request)), whole);
    }
}

#[test]
fn a_state_of_something_else_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (problem, wanted) = (frictionless(), request(STEP, 10));
    assert!(read(folder).unwrap().is_none());
    let mut session = Session::start(problem.clone(), &wanted).unwrap();
    session.advance(25).unwrap();
    write(folder, &problem, &wanted, &mut session, Stopped::Interrupted);
    let file = read(folder).unwrap().unwrap();
    let try_with = |file: &state::StateFile, problem: DynamicProblem, request: &RunRequest| {
        resume(folder, file, problem, request).err().expect("it is refused")
    };

    let mut heavier = problem.clone();
    heavier.inner.inertia.mass = f64::from_bits(heavier.inner.inertia.mass.to_bits() + 1);
    assert!(matches!(try_with(&file, heavier, &wanted), StateError::Scene { .. }));
    let mut fewer = wanted.clone();
    fewer.channels.pop();
    assert!(matches!(try_with(&file, problem.clone(), &fewer), StateError::Scene { .. }));
    let earlier = RunRequest { end: 20.0 * STEP, ..wanted.clone() };
    assert!(matches!(try_with(&file, problem.clone(), &earlier), StateError::Past { .. }));
    let nowhere = RunRequest { end: f64::NAN, ..wanted.clone() };
    assert!(matches!(try_with(&file, problem.clone(), &nowhere), StateError::Past { .. }));
    let older = state::StateFile { version: "0.0.0".into(), ..file.clone() };
    assert!(matches!(try_with(&older, problem.clone(), &wanted), StateError::Version { .. }));
    let mut cut = file.clone();
    let Checkpoint::Bearing(kept) = &mut cut.sound.checkpoint else { panic!("a bearing") };
    kept.state.pop();
    assert!(matches!(try_with(&cut, problem.clone(), &wanted), StateError::Damaged { .. }));
    let mut more_rows = file.clone();
    more_rows.sound.rows = 4;
    assert!(matches!(try_with(&more_rows, problem.clone(), &wanted), StateError::Damaged { .. }));
    let first = Session::start(problem.clone(), &wanted).unwrap();
    first.series().unwrap().write_npy(&folder.join(state::SERIES)).unwrap();
    assert!(matches!(try_with(&file, problem.clone(), &wanted), StateError::Rows { .. }));
    // The file itself.
    let text = fs::read_to_string(folder.join(state::STATE)).unwrap();
    let now = format!("\"form\":{}", state::FORM);
    assert!(text.contains(&now));
    fs::write(folder.join(state::STATE), text.replace(&now, "\"form\":4")).unwrap();
    assert!(matches!(read(folder), Err(StateError::Form { .. })));
    fs::write(folder.join(state::STATE), &text[..text.len() / 2]).unwrap();
    assert!(matches!(read(folder), Err(StateError::Json { .. })));
}

#[test]
fn numbers_come_back_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let (problem, wanted) = (complete(), request(STEP, 10));
    let mut session = Session::start(problem.clone(), &wanted).unwrap();
    session.advance(42).unwrap();
    // What decimal text could lose: signed zero, the smallest and the largest numbers.
    let odd = [-0.0, f64::from_bits(1), f64::MAX, f64::MIN_POSITIVE, 0.1 + 0.2, 1e23];
    let ledger = simulation(&session).system.places.ledger();
    simulation_mut(&mut session).state[ledger..ledger + odd.len()].copy_from_slice(&odd);
    save(folder.path(), &mut session, &record(&problem, &wanted, Stopped::Running)).unwrap();
    let back = go_on(folder.path(), &problem, &wanted);
    let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    let (a, b) = (simulation(&session).checkpoint(), simulation(&back).checkpoint());
    assert_eq!(bits(&a.state), bits(&b.state));
    assert_eq!(a, b);
    let rows = session.recorder.rows();
    assert_eq!(rows, back.recorder.rows());
    for row in 0..rows {
        assert_eq!(bits(session.recorder.row(row)), bits(back.recorder.row(row)));
    }
    // What JSON cannot hold is not written, and the state that is there stays.
    let before = fs::read(folder.path().join(state::STATE)).unwrap();
    simulation_mut(&mut session).state[ledger] = f64::NAN;
    let refused = save(folder.path(), &mut session, &record(&problem, &wanted, Stopped::Running));
    assert!(matches!(refused, Err(StateError::NotFinite)));
    assert_eq!(fs::read(folder.path().join(state::STATE)).unwrap(), before);
}

#[test]
fn a_run_that_fails_keeps_the_state_before_the_failing_step() {
    let folder = tempfile::tempdir().unwrap();
    let (problem, wanted) = (frictionless(), request(STEP, 10));
    let mut session = Session::start(problem.clone(), &wanted).unwrap();
    session.advance(33).unwrap();
    let before = simulation(&session).checkpoint();
    // Shoot ball 3 out of its races.
    let layout = simulation(&session).system.sets[0].layout;
    simulation_mut(&mut session).state[layout.ball(7) + 2] = 1e7;
    let thrown = simulation(&session).checkpoint();
    let error = of_steps(session.advance(50).unwrap_err());
    let SimulationError::BallOutside { ball, step, .. } = &error else { panic!("{error}") };
    assert_eq!((ball.as_str(), *step), ("ball 3", 34));
    let (kept, rows) = resumable(&mut session);
    assert_eq!((kept.steps, rows), (33, 4));
    assert_eq!(kept, thrown);
    assert_ne!(kept, before);
    let failed = StateRecord {
        error: Some(error.to_string()),
        ..record(&problem, &wanted, Stopped::Failed)
    };
    save(folder.path(), &mut session, &failed).unwrap();
    let file = read(folder.path()).unwrap().unwrap();
    assert_eq!((file.stopped, file.steps, file.sound.rows), (Stopped::Failed, 33, 4));
    assert!(file.error.unwrap().contains("ball 3"));
}
