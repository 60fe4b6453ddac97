//! Extremes of a run are those of every step, with the times of their states.

use super::run_recorder::{column, table, to_the_end};
use crate::run_common;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::hertz::contact_ellipse;
use bearing_dynamics::members::body::Drive;
use bearing_dynamics::members::state::{BodyState, POSITION};
use bearing_dynamics::motion::simulation::{
    Integrator, RunOptions, Simulation, SimulationError, Start, Stepping,
};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::session::{RunRequest, Session, SessionError, Status};
use bearing_dynamics::output::summary::{RunReport, run_summary};
use nalgebra::Vector3;
use run_common::{common, frictionless, jolted, request, simulation};
use serde_json::Value;

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

/// Balls that nearly fill the bearing, under strong gravity, with a pulse of the radial load and a later one of the axial load.
pub fn crowded() -> DynamicProblem {
    let geometry = common::full_complement(9, 4e-6, 5e-6);
    let conditions = common::FREE;
    let statics = common::problem(geometry, conditions);
    let mut problem = DynamicProblem {
        geometry,
        inner_contact: statics.inner_contact,
        outer_contact: statics.outer_contact,
        gravity: [0.0, 500.0, -2000.0],
        ..frictionless()
    };
    let pulse = |peak: f64, start: f64, duration: f64| {
        Drive::Load(Profile::HalfSine { base: 0.0, peak, start, duration })
    };
    problem.inner.drives[0] = pulse(-2500.0, 0.4e-3, 0.2e-3);
    problem.inner.drives[2] = pulse(-9000.0, 0.05e-3, 0.2e-3);
    problem.inner.drives[3] = Drive::Motion(Profile::ZERO);
    problem.inner.drives[4] = Drive::Motion(Profile::ZERO);
    problem
}

/// A largest value, its ball and its time, s.
#[derive(Clone, Copy, Debug, Default)]
struct Most(f64, usize, f64);

impl Most {
    fn take(&mut self, value: f64, ball: usize, time: f64) {
        if value > self.0 {
            *self = Most(value, ball, time);
        }
    }
}

/// Extremes from the positions of all bodies: ball loads on both races, farthest ends of contact ellipses with their contact
/// angles, the load between balls, and the displacement of the inner race.
#[derive(Debug, Default)]
struct Seen {
    loads: [Most; 2],
    edges: [Most; 2],
    angles: [f64; 2],
    between: Most,
    distance: Most,
}

impl Seen {
    fn record(&mut self, problem: &DynamicProblem, now: &Simulation) {
        let (layout, geometry) = (now.system.sets[0].layout, &problem.geometry);
        let places: Vec<Vector3<f64>> = (0..layout.balls)
            .map(|ball| layout.ball_state(&now.state, ball).position.into())
            .collect();
        let inner = BodyState::from_slice(&now.state[layout.inner()..]).position;
        let centres = [Vector3::from(inner), Vector3::zeros()];
        self.distance.take(centres[0].norm(), 0, now.time);
        let races =
            [(&geometry.inner, &problem.inner_contact), (&geometry.outer, &problem.outer_contact)];
        for (side, (race, contact)) in races.into_iter().enumerate() {
            for (ball, place) in places.iter().enumerate() {
                // No race tilts: its axis is X.
                let arm = place - centres[side];
                let bottom = Vector3::new(0.0, arm.y, arm.z).normalize() * race.centre_radius;
                let away = arm - bottom;
                let overlap = away.norm() - (race.groove_radius - geometry.ball_radius);
                if overlap <= 0.0 {
                    continue;
                }
                let load = contact.stiffness * overlap.powf(1.5);
                self.loads[side].take(load, ball, now.time);
                // Lightly loaded contacts do not count.
                if load < 0.01 * self.loads[side].0 {
                    continue;
                }
                let angle = (away.x.abs() / away.norm()).asin();
                let reach = angle + contact_ellipse(contact, load).semi_major / race.groove_radius;
                if reach > self.edges[side].0 {
                    self.angles[side] = angle;
                }
                self.edges[side].take(reach, ball, now.time);
            }
        }
        let law = problem.ball_contact.expect("balls touch");
        for ball in 0..places.len() {
            let next = places[(ball + 1) % places.len()];
            let overlap = 2.0 * geometry.ball_radius - (next - places[ball]).norm();
            self.between.take(law.stiffness * overlap.max(0.0).powf(1.5), ball, now.time);
        }
    }
}

/// Each extreme of the summary is the largest value of all steps, with the ball and the time that it belongs to.
#[test]
fn extremes_have_the_balls_and_times_of_their_values() {
    for (integrator, stepping) in METHODS {
        let options =
            RunOptions { integrator, stepping, start: Start::Nominal, ..RunOptions::default() };
        let wanted = RunRequest { options, end: 1e-3, output_interval: 1e-3, ..request(1e-6, 1) };
        let problem = crowded();
        let mut session = Session::start(problem.clone(), &wanted).unwrap();
        let mut seen = Seen::default();
        seen.record(&problem, simulation(&session));
        loop {
            let status = session.advance(1).unwrap();
            seen.record(&problem, simulation(&session));
            if status == Status::Complete {
                break;
            }
        }
        let summary = run_summary(&session, &table(&session), &[], &RunReport::default()).unwrap();
        let extremes = &summary["extremes"];
        let number = |of: &Value| of["value"].as_f64().unwrap_or_else(|| panic!("{of}"));
        println!("{integrator:?} {seen:?}");
        // Overlaps of some 10 um from positions of 30 mm, each rounded to 3e-18 m or so.
        let same = |of: &Value, key: &str, most: &Most, scale: f64| {
            let (value, time) = (number(&of[key]) * scale, number(&of["time"]));
            let error = (value / most.0 - 1.0).abs();
            assert!(error <= 1e-9 && time == most.2, "{integrator:?} {key}: {of} {most:?}");
        };
        same(&extremes["inner_race_farthest"], "distance", &seen.distance, 1.0);
        same(&extremes["races_farthest_apart"], "distance", &seen.distance, 1.0);
        let (degree, mut apart) = (1f64.to_radians(), 0);
        for (side, race) in ["inner_race", "outer_race"].into_iter().enumerate() {
            let [load, edge] =
                ["largest_load", "farthest_from_bottom"].map(|what| &extremes[race][what]);
            same(load, "load", &seen.loads[side], 1.0);
            same(edge, "ellipse_reaches", &seen.edges[side], degree);
            let error = (number(&edge["contact_angle"]) * degree / seen.angles[side] - 1.0).abs();
            assert!(error <= 1e-9, "{integrator:?} {race}: {edge} {seen:?}");
            assert_eq!(load["ball"], seen.loads[side].1 + 1, "{load} {seen:?}");
            assert_eq!(edge["ball"], seen.edges[side].1 + 1, "{edge} {seen:?}");
            assert_ne!(load["time"], edge["time"]);
            apart += usize::from(load["ball"] != edge["ball"]);
        }
        // Not always of one ball, so that one is not taken for the other.
        assert!(apart > 0, "{extremes}");
        let between = &extremes["between_balls"]["largest_load"];
        same(between, "load", &seen.between, 1.0);
        let first = seen.between.1;
        assert_eq!(between["balls"], serde_json::json!([first + 1, (first + 1) % 9 + 1]));
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
