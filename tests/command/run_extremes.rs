//! Extremes of a run are those of every step, with the times of their states.

use super::run_recorder::{column, table, to_the_end};
use crate::run_common;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::members::body::Drive;
use bearing_dynamics::members::state::POSITION;
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, SimulationError, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::session::{RunRequest, Session, SessionError, Status};
use bearing_dynamics::output::summary::{RunReport, run_summary};
use run_common::{frictionless, jolted, request, simulation};

/// Every integrator, with the stepping it is used with.
const METHODS: [(Integrator, Stepping); 3] = [
    (Integrator::RungeKutta, Stepping::Fixed(1e-6)),
    (Integrator::DormandPrince, Stepping::Accuracy(1e-3)),
    (Integrator::Rosenbrock, Stepping::Accuracy(1e-3)),
];

/// A pulse shorter than a row: 9 kN for 20 µs in a row of 1 ms.
fn struck() -> DynamicProblem {
    let mut problem = frictionless();
    let pulse = Profile::HalfSine { base: -250.0, peak: -9000.0, start: 0.33e-3, duration: 60e-6 };
    problem.inner.drives[2] = Drive::Load(pulse);
    problem
}

#[test]
fn extremes_are_of_every_step_whatever_the_rows() {
    for (integrator, stepping) in METHODS {
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
    for (integrator, stepping) in METHODS {
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

/// The largest energy that was missing is that of all rows and looks, not of the last row.
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
    // 30 steps: looks at the first and after 16, between rows.
    let looked = simulation(&session).largest_residual();
    assert_eq!(of("largest_residual"), largest.max(looked));
    assert!(looked > largest, "{looked:e} {largest:e}");
    assert!(largest > rows[rows.len() - 1].abs(), "{rows:?}");
}

/// Where a run ends for its energy, if it does: time, energy missing and turned over.
fn ended(energy_limit: f64, rows: f64) -> Option<[f64; 3]> {
    let options =
        RunOptions { stepping: Stepping::Fixed(6e-6), energy_limit, ..RunOptions::default() };
    let wanted = RunRequest { options, end: 6e-3, output_interval: rows, ..request(6e-6, 1) };
    let mut session = Session::start(struck(), &wanted).unwrap();
    loop {
        match session.advance(1) {
            Ok(Status::Complete) => return None,
            Ok(_) => {}
            Err(SessionError::Simulation(SimulationError::Energy {
                residual,
                turned_over,
                time,
                ..
            })) => return Some([time, residual, turned_over]),
            Err(other) => panic!("{other}"),
        }
    }
}

/// Steps of a sixth of the fastest period lose a part of what a pulse brings: more of it is open than some limits allow and
/// less than others, whatever rows are written.
#[test]
fn what_may_go_missing_does_not_hang_on_rows() {
    let mut found = Vec::new();
    for energy_limit in [1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0] {
        let [fine, coarse, two] = [6e-6, 96e-6, 6e-3].map(|rows| ended(energy_limit, rows));
        for other in [coarse, two] {
            match (fine, other) {
                (None, None) => {}
                // But for rounding of the times at which the pulse is read.
                (Some(fine), Some(other)) => {
                    for (a, b) in fine.into_iter().zip(other) {
                        assert!((a / b - 1.0).abs() <= 1e-9, "{energy_limit}: {fine:?} {other:?}");
                    }
                }
                _ => panic!("{energy_limit}: {fine:?} {other:?}"),
            }
        }
        found.push(fine.is_some());
    }
    assert!(found.contains(&true) && found.contains(&false), "{found:?}");
}
