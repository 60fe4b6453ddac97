//! The rotor of 4.3.4 run up: by the program from its shipped scene, and by the oracle.

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::members::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::members::state::{Ledger, POSITION};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Start, Stepping};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

use crate::bearings::{self, DEEP_GROOVE, Hertz};
use crate::case::CaseError;
use crate::motion::{ROTOR_RUN_UP, RPM, changed_scene};
use crate::oracles::run_up::{Balls, Peak, RunUp, Support};
use crate::pareto::Stopwatch;

/// Text of the assumption on the ramp.
pub const RAMP_UNSTATED: (&str, &str, &str) = (
    "ramp",
    "4.3.4 does not say within which time the speed rises from 0 to 10 000 rpm: at a constant rate within 0.2 s.",
    "0.2 s",
);
/// Speed of the scene's rotor, as its text has it.
pub const SPEED: &str =
    "speed = { ramp = [\"0 rpm\", \"10000 rpm\"], start = \"0 s\", duration = \"0.2 s\" }";
/// rpm.
pub const TOP: f64 = 10_000.0;
/// Rows this far apart, s: 230 a turn at the peak.
const ROWS: f64 = 5e-5;
/// Steps of the oracle, s.
const STEP: f64 = 1e-5;
/// Balls that keep their distances and do not rattle where they carry nothing, as the oracle's: a light, soft cage without friction,
/// 0.05 mm about each ball, and damped contacts.
const CALM: [(&str, &str); 2] = [("[bearing.left]", CAGE), ("law = \"none\"\n", DAMPED)];
/// With damping in contacts.
pub const DAMPED: &str =
    "law = \"none\"\n\n[contact_damping]\nlaw = \"hunt-crossley\"\nalpha = \"1 s/m\"\n";
/// With a cage.
pub const CAGE: &str = "[bearing.cage]\npocket_radius = \"6.0 mm\"\ninner_radius = \"24 mm\"\nouter_radius = \"28 mm\"\nrace_clearance = \"0.2 mm\"\n\
                    mass = \"20 g\"\nguidance = \"outer-race\"\ncontact = { law = \"penalty\", stiffness = \"1e6 N/m\" }\nfriction = 0\n\n[bearing.left]";

/// Speed over time, s and rpm: straight between these, then it stays.
pub type QuasiStaticSequence = Vec<[f64; 2]>;

/// From rest within this time, s.
pub fn straight(ramp: f64) -> QuasiStaticSequence {
    vec![[0.0, 0.0], [ramp, TOP]]
}

/// The same rate, but from rest to the first speed, rpm, at once.
pub fn headed(ramp: f64, first: f64) -> QuasiStaticSequence {
    const HEAD: f64 = 0.03;
    vec![[0.0, 0.0], [HEAD, first], [HEAD + ramp * (1.0 - first / TOP), TOP]]
}

/// How the program takes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way<'w> {
    pub integrator: Integrator,
    pub stepping: Stepping,
    /// Whether a cage and damping calm the balls: without, they wander off in slow passages.
    pub calm: bool,
    /// Further words of the scene, changed.
    pub changes: &'w [(&'w str, &'w str)],
}

/// The shipped scene with another unbalance, kg·m, course, and words.
pub fn rotor(
    course: &QuasiStaticSequence,
    unbalance: &str,
    way: &Way,
) -> Result<Assembly, CaseError> {
    let points = course.iter().map(|[time, speed]| format!("[\"{time} s\", \"{speed} rpm\"]"));
    let speed = format!("speed = {{ table = [{}] }}", points.collect::<Vec<_>>().join(", "));
    let size = format!("size = \"{unbalance} kg m\"");
    let mut changes = vec![(SPEED, speed.as_str()), ("size = \"1e-3 kg m\"", size.as_str())];
    if way.calm {
        changes.extend(CALM);
    }
    changes.extend(way.changes);
    Ok(changed_scene(ROTOR_RUN_UP, &changes)?.assembly()?)
}

/// Springs across in place of its bearings, N/m, a soft one along.
pub fn on_pins(assembly: &mut Assembly, across: f64) {
    for bearing in std::mem::take(&mut assembly.bearings) {
        let [inner, outer] = bearing.mounts;
        let stiffness = [1e6, across, across, 0.0, 0.0, 0.0];
        let law = Law::SpringDashpot(SpringDashpot { stiffness, ..SpringDashpot::default() });
        let (name, ends) = ("a pin".into(), [outer, inner]);
        assembly.connections.push(Connection { name, label: None, ends, law });
    }
}

/// What a run-up did.
#[derive(Clone, Debug, Default)]
pub struct Done {
    /// Time, s, speed, rpm, and distance of the middle from the axis, m.
    pub rows: Vec<[f64; 3]>,
    /// The farthest of all steps.
    pub farthest: Peak,
    pub steps: u64,
    pub seconds: f64,
    /// Largest energy that no entry names, over the largest in bending and contacts and what damping took.
    pub residual: f64,
    /// How far the way from a ball to its neighbour came from an even part of the turn, rad.
    pub astray: f64,
}

impl Done {
    fn record(&mut self, time: f64, speed: f64, height: f64) {
        if height > self.farthest.height {
            self.farthest = Peak { speed, height };
        }
        if time >= ROWS * self.rows.len() as f64 {
            self.rows.push([time, speed / RPM, height]);
        }
    }

    /// Of the curve without its ripple: see [`top`].
    pub fn top(&self) -> Result<Peak, CaseError> {
        let largest =
            (0..self.rows.len()).max_by(|a, b| self.rows[*a][2].total_cmp(&self.rows[*b][2]));
        let largest = largest.ok_or_else(|| CaseError::message("no rows"))?;
        let high = |row: &[f64; 3]| row[2] >= 0.95 * self.rows[largest][2];
        let after = self.rows[largest..].iter().take_while(|row| high(row)).count();
        let before = self.rows[..largest].iter().rev().take_while(|row| high(row)).count();
        let near = &self.rows[largest - before..largest + after];
        top(&near.iter().map(|row| [row[1], row[2]]).collect::<Vec<_>>())
    }

    /// Mean distance of the middle within a time, m.
    pub fn mean(&self, from: f64, to: f64) -> f64 {
        let within = self.rows.iter().filter(|row| (from..to).contains(&row[0]));
        let (count, sum) = within.fold((0.0, 0.0), |(count, sum), row| (count + 1.0, sum + row[2]));
        sum / count
    }
}

/// Where the polynomial of fourth order that fits speeds, rpm, and heights best is highest. Eight balls make the deflection ripple by
/// a few thousandths, which moves the one farthest step along a flat peak by up to half a per cent, but not this.
pub fn top(points: &[[f64; 2]]) -> Result<Peak, CaseError> {
    let ends =
        points.iter().fold([f64::MAX, f64::MIN], |[low, high], [x, _]| [low.min(*x), high.max(*x)]);
    let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
    let legendre = |x: f64| {
        let s = x * x;
        [
            1.0,
            x,
            0.5 * (3.0 * s - 1.0),
            0.5 * x * (5.0 * s - 3.0),
            0.125 * ((35.0 * s - 30.0) * s + 3.0),
        ]
    };
    let matrix =
        DMatrix::from_fn(points.len(), 5, |row, i| legendre((points[row][0] - middle) / half)[i]);
    let heights = DVector::from_fn(points.len(), |row, _| points[row][1]);
    let found = matrix.svd(true, true).solve(&heights, 1e-12).map_err(CaseError::message)?;
    let of = |x: f64| legendre(x).iter().zip(found.iter()).map(|(a, b)| a * b).sum::<f64>();
    let places = (-5000..=5000).map(|i| f64::from(i) / 5000.0);
    let x = places.max_by(|a, b| of(*a).total_cmp(&of(*b))).unwrap_or(0.0);
    Ok(Peak { speed: RPM * (middle + half * x), height: of(x) })
}

/// To `end` s.
pub fn run_up(assembly: Assembly, way: &Way, end: f64) -> Result<Done, CaseError> {
    let options = RunOptions {
        integrator: way.integrator,
        stepping: way.stepping,
        start: Start::Nominal,
        ..RunOptions::default()
    };
    let mut simulation = Simulation::new(assembly, options)?;
    let watch = Stopwatch::start();
    simulation.snapshot();
    let (_, section) = simulation.system.assembly.shafts[0].probes[0].clone();
    let mut done = Done::default();
    let (mut next, mut stored) = (0.0, 0.0f64);
    while simulation.time < end * (1.0 - 1e-12) {
        simulation.step_by(simulation.step_size.min(end - simulation.time))?;
        let now = simulation.system.section_now(&simulation.state, 0, &section).motion;
        let height = now.position[1].hypot(now.position[2]);
        done.record(simulation.time, simulation.body(0).spin[0], height);
        if simulation.time >= next {
            next += 1e-3 * end;
            let now = simulation.snapshot();
            let energy = now.energy;
            stored = stored.max(energy.bending_kinetic + energy.bending_strain + energy.contact);
            done.residual = done.residual.max(now.residual.abs());
            done.astray = done.astray.max(astray(&simulation));
        }
    }
    let damped = simulation.snapshot().ledger[Ledger::Foundation as usize].abs();
    done.residual /= stored + damped;
    done.steps = simulation.steps;
    done.seconds = watch.seconds();
    Ok(done)
}

/// How far the way from a ball to its neighbour is from an even part of the turn, rad: the largest of all bearings.
fn astray(simulation: &Simulation) -> f64 {
    let mut largest = 0.0f64;
    for set in &simulation.system.sets {
        let balls = set.layout.balls;
        let angle = |ball: usize| {
            let [_, y, z] = set.layout.ball_vector(&simulation.state, POSITION, ball % balls);
            z.atan2(y)
        };
        for ball in 0..balls {
            let way = (angle(ball + 1) - angle(ball)).rem_euclid(TAU);
            largest = largest.max((way - TAU / balls as f64).abs());
        }
    }
    largest
}

/// The same rotor for the oracle.
pub fn oracle(course: &QuasiStaticSequence, unbalance: &str, support: Support) -> RunUp {
    RunUp {
        length: 0.4,
        radius: 15e-3,
        youngs_modulus: 210e9,
        poisson_ratio: 0.3,
        density: 7850.0,
        mass: 20.0,
        unbalance: unbalance.parse().unwrap_or(f64::NAN),
        damping: 100.0,
        speed: course.iter().map(|[time, speed]| [*time, speed * RPM]).collect(),
        support,
        step: STEP,
    }
}

/// What it does to `end` s.
pub fn followed(oracle: &RunUp, end: f64) -> Done {
    let mut done = Done::default();
    oracle.history(end, |time, speed, height| done.record(time, speed, height));
    done
}

/// Balls of its bearings, and how fast they go round, rad/s.
pub fn balls(orbit: f64) -> Support {
    let bearing = bearings::oracle(&DEEP_GROOVE, Hertz::Fit, 0.0);
    Support::Balls(Balls {
        count: DEEP_GROOVE.balls,
        ball_radius: bearing.ball_radius,
        inner: [bearing.inner[0] - bearing.inner[2], bearing.inner[2]],
        outer: [bearing.outer[0] + bearing.outer[2], bearing.outer[2]],
        stiffness: [bearing.stiffness_inner, bearing.stiffness_outer],
        phase: 0.0,
        orbit,
        mass: 7850.0 * TAU / 1.5 * bearing.ball_radius.powi(3),
    })
}
