//! What the studies of the bearing in motion share: a run over a window of time, how far it is off,
//! how long it took.

use std::f64::consts::TAU;
use std::time::Instant;

use bearing_dynamics::assembly::loads::DynamicProblem;
use bearing_dynamics::assembly::state::{BODY, BodyState, Layout, POSITION};
use bearing_dynamics::motion::simulation::{
    Integrator, RunOptions, Simulation, SimulationError, Stepping,
};

use crate::case::CaseError;
use crate::pareto::{ParetoContext, Point, cheapest_ways};

/// From the start in equilibrium on, `rows` equal times.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    pub end: f64,
    pub rows: usize,
}

impl Window {
    fn interval(&self) -> f64 {
        self.end / self.rows as f64
    }

    /// The longest step, not above `step`, of which a whole number goes into a row.
    pub fn fitting(&self, step: f64) -> f64 {
        self.interval() / (self.interval() / step - 1e-9).ceil()
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    pub integrator: Integrator,
    pub stepping: Stepping,
}

impl Method {
    pub fn rk4(step: f64) -> Method {
        Method { integrator: Integrator::RungeKutta, stepping: Stepping::Fixed(step) }
    }

    pub fn rosenbrock(step: f64) -> Method {
        Method { integrator: Integrator::Rosenbrock, stepping: Stepping::Fixed(step) }
    }

    pub fn accurate(integrator: Integrator, accuracy: f64) -> Method {
        Method { integrator, stepping: Stepping::Accuracy(accuracy) }
    }

    pub fn variant(&self) -> String {
        match self.stepping {
            Stepping::Fixed(step) => format!("{:.3} µs", 1e6 * step),
            Stepping::Accuracy(accuracy) => format!("accuracy {accuracy:.0e}"),
            Stepping::FractionOfLimit(fraction) => format!("{fraction} of the limit"),
        }
    }
}

/// What a run leaves.
#[derive(Clone, Debug, Default)]
pub struct History {
    /// Inner race from the outer one, m, row by row.
    pub race: Vec<[f64; 3]>,
    /// Angle that the cage has turned, rad; zero without one.
    pub cage_turn: f64,
    /// Mean over the balls of the angle they have gone round, rad.
    pub ball_turn: f64,
    pub evaluations: u64,
    pub seconds: f64,
    /// What ended it early.
    pub ended: Option<String>,
}

fn race(layout: &Layout, state: &[f64]) -> [f64; 3] {
    let (inner, outer) = (layout.inner(), layout.outer());
    [0, 1, 2].map(|i| state[inner + i] - state[outer + i])
}

/// Angles about X, rad, up to whole turns: cage, then balls.
fn angles(layout: &Layout, state: &[f64]) -> Vec<f64> {
    let cage = if layout.has_cage {
        let q = BodyState::from_slice(&state[layout.cage()..layout.cage() + BODY]).orientation;
        2.0 * q.i.atan2(q.w)
    } else {
        0.0
    };
    let outer = layout.outer();
    let azimuth = |ball| {
        let [_, y, z] = layout.ball_vector(state, POSITION, ball);
        (z - state[outer + 2]).atan2(y - state[outer + 1])
    };
    std::iter::once(cage).chain((0..layout.balls).map(azimuth)).collect()
}

/// Runs once. The time is that of the steps, without the start in equilibrium.
pub fn follow(
    problem: &DynamicProblem,
    method: Method,
    window: Window,
) -> Result<History, CaseError> {
    let options = RunOptions {
        integrator: method.integrator,
        stepping: method.stepping,
        energy_limit: f64::INFINITY,
        ..RunOptions::default()
    };
    let mut simulation = Simulation::new(problem.clone(), options)?;
    let layout = simulation.system.sets[0].layout;
    let mut history = History::default();
    let first = simulation.system.work.evaluations;
    let mut before = angles(&layout, &simulation.state);
    let start = Instant::now();
    for row in 1..=window.rows {
        if let Err(error) = advance(&mut simulation, window.interval() * row as f64) {
            history.ended = Some(error.to_string());
            break;
        }
        history.race.push(race(&layout, &simulation.state));
        let now = angles(&layout, &simulation.state);
        // A row is far less than a turn.
        let turned = |i: usize| now[i] - before[i] - TAU * ((now[i] - before[i]) / TAU).round();
        history.cage_turn += turned(0);
        history.ball_turn += (1..now.len()).map(turned).sum::<f64>() / layout.balls as f64;
        before = now;
    }
    history.seconds = start.elapsed().as_secs_f64();
    history.evaluations = simulation.system.work.evaluations - first;
    Ok(history)
}

/// Steps to `time`; a last step that would end near it ends at it.
fn advance(simulation: &mut Simulation, time: f64) -> Result<(), SimulationError> {
    loop {
        let (left, size) = (time - simulation.time, simulation.step_size);
        let reached = left <= size * (1.0 + 1e-6);
        let step = match reached {
            true => left,
            false if left < 2.0 * size => 0.5 * left.max(size),
            false => size,
        };
        if simulation.step_by(step)? == left {
            simulation.time = time;
            return Ok(());
        }
    }
}

/// Errors of a run against a reference: largest error of the race over the largest displacement,
/// the same over the largest peak-to-peak motion of a coordinate, and relative errors of the turns
/// of cage and balls, which are those of their mean speeds.
pub fn errors(found: &History, reference: &History) -> [f64; 4] {
    let (mut error, mut swing, mut displacement) = (0.0f64, 0.0f64, 0.0f64);
    for i in 0..3 {
        let values = reference.race.iter().map(|position| position[i]);
        let (low, high) =
            values.clone().fold((f64::MAX, f64::MIN), |(l, h), v| (v.min(l), v.max(h)));
        swing = swing.max(high - low);
        displacement = displacement.max(low.abs()).max(high.abs());
        for (found, value) in found.race.iter().zip(values) {
            let off = (found[i] - value).abs();
            // NaN stays.
            error = if off <= error || error.is_nan() { error } else { off };
        }
    }
    if found.race.len() != reference.race.len() {
        error = f64::INFINITY;
    }
    let relative = |found: f64, value: f64| {
        let off = (found - value).abs();
        if value == 0.0 { off } else { off / value.abs() }
    };
    let cage = relative(found.cage_turn, reference.cage_turn);
    let balls = relative(found.ball_turn, reference.ball_turn);
    [error / displacement, error / swing, cage, balls]
}

/// Runs that take less than this, s, are repeated until they have taken it, and no more than
/// [`MOST_REPEATS`] times: the fastest counts.
const LONG_ENOUGH: f64 = 0.3;
const MOST_REPEATS: usize = 15;

/// One variant, timed, as a point of a study.
pub struct Variant<'a> {
    pub series: &'a str,
    pub name: String,
    pub problem: &'a DynamicProblem,
    pub method: Method,
    /// Largest stable step of Runge–Kutta, where the method is bound by it.
    pub limit: Option<f64>,
}

/// What [`errors`] gives, in its order: head of a column.
pub const LABELS: [&str; 4] = [
    "error of the inner race over its displacement",
    "error of the inner race over its swing",
    "error of the mean speed of the cage",
    "error of the mean orbital speed of the balls",
];
/// The same as wholes in a sentence.
const WHOLES: [&str; 4] = [
    "the race's displacement",
    "the race's swing",
    "the cage's mean speed",
    "the balls' mean orbital speed",
];

/// Which of [`errors`] a study draws, and those in further columns.
pub type Measures = &'static [usize];

/// One sentence for each measure, on the points that belong to `subject`.
pub fn sentences(
    context: &mut ParetoContext,
    measures: Measures,
    subject: &str,
    belongs: impl Fn(&Point) -> bool,
) {
    for (index, measure) in measures.iter().enumerate() {
        let chosen: Vec<&Point> = context.points().iter().filter(|p| belongs(p)).collect();
        let text = cheapest_ways(chosen.iter().copied(), index, WHOLES[*measure]);
        context.sentence(format!("{subject} {text}"));
    }
}

pub fn measure(
    context: &mut ParetoContext,
    variant: &Variant,
    window: Window,
    reference: &History,
    measures: Measures,
) -> Result<History, CaseError> {
    let mut best = follow(variant.problem, variant.method, window)?;
    let (mut repeats, mut spent) = (1, best.seconds);
    while spent < LONG_ENOUGH && repeats < MOST_REPEATS && best.ended.is_none() {
        let again = follow(variant.problem, variant.method, window)?;
        spent += again.seconds;
        repeats += 1;
        if again.seconds < best.seconds {
            best = again;
        }
    }
    let beyond = beyond_limit(variant.method, variant.limit);
    if let (Some(ended), false) = (&best.ended, beyond) {
        return Err(CaseError::message(format!("{} {}: {ended}", variant.series, variant.name)));
    }
    let found = errors(&best, reference);
    let mut all: Vec<f64> = measures.iter().map(|&measure| found[measure]).collect();
    let ended = best.ended.is_some();
    let error = if ended { f64::INFINITY } else { all.remove(0) };
    let name = match ended {
        true => format!("{}, ended in row {}", variant.name, best.race.len() + 1),
        false => variant.name.clone(),
    };
    eprintln!("  {}: {name}, {:.3} s × {repeats}, error {error:.1e}", variant.series, best.seconds);
    context.push(Point {
        repeats,
        more_errors: if ended { Vec::new() } else { all },
        evaluations: Some(best.evaluations),
        unstable: beyond,
        ..Point::new(variant.series, &name, best.seconds, error)
    });
    Ok(best)
}

/// Whether a fixed step is longer than the largest stable one.
pub fn beyond_limit(method: Method, limit: Option<f64>) -> bool {
    match (method.stepping, limit) {
        (Stepping::Fixed(step), Some(limit)) => step > limit,
        _ => false,
    }
}

/// Largest stable step of Runge–Kutta throughout a window, s: where the contacts have become stiffer
/// than at the start the Jacobian is asked again.
pub fn limit(problem: &DynamicProblem, window: Window) -> Result<f64, CaseError> {
    let options = RunOptions {
        stepping: Stepping::FractionOfLimit(0.5),
        energy_limit: f64::INFINITY,
        ..RunOptions::default()
    };
    let mut simulation = Simulation::new(problem.clone(), options)?;
    while simulation.time < window.end {
        simulation.step()?;
        if let Some(step) = simulation.watch_step()? {
            simulation.shorten_step(step);
        }
    }
    simulation.step_watch.smallest.ok_or_else(|| CaseError::message("no step limit"))
}

/// How far the points of `series` are off at their best, in each measure: what a model costs in
/// accuracy at any step.
pub fn best_errors(points: &[Point], measures: Measures, series: &str) -> String {
    let best = |(index, measure): (usize, &usize)| {
        let errors = points
            .iter()
            .filter(|point| point.series == series)
            .map(|point| if index == 0 { point.error } else { point.more_errors[index - 1] });
        format!("{:.1e} of {}", errors.fold(f64::INFINITY, f64::min), WHOLES[*measure])
    };
    measures.iter().enumerate().map(best).collect::<Vec<_>>().join(", ")
}

/// What the variants of one series do from the first to the last: time and first error.
pub fn from_first_to_last(points: &[Point]) -> String {
    match points {
        [first, .., last] => format!(
            "From {} to {} the time grows by a factor of {:.1} and the error goes from {:.1e} to {:.1e}.",
            first.variant,
            last.variant,
            last.seconds / first.seconds,
            first.error,
            last.error
        ),
        _ => String::new(),
    }
}
