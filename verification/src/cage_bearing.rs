//! The bearing of Table 5.3 with its cage, in motion, for the cases that look at the cage's speed.

use std::f64::consts::{PI, TAU};

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::body::{Drive, Rotation};
use bearing_dynamics::members::state::{BODY, BodyState, Layout, POSITION};
use bearing_dynamics::motion::clocked::{self, RunRequest};
use bearing_dynamics::motion::simulation::{
    Integrator, RunOptions, Simulation, SimulationError, Start, Stepping,
};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::cage::add_cage_nodes;
use bearing_dynamics::scene::build::motion::dynamic_problem;
use bearing_dynamics::scene::{self, Document, Format, Subject, resolve_subject};

use crate::bearings::{self, ANGULAR_CONTACT, Hertz, Lengths};
use crate::case::CaseError;
use crate::oracles::hertz;
use crate::oracles::rolling::{RollingBall, RollingContact};
use crate::oracles::statics::{Known, OracleBearing, OracleContact};

/// The cage watched by the telemeter.
pub const CAGE_TELEMETER: &str = include_str!("../../scenes/cage_telemeter.toml");
/// The run of section 5.4.1.
pub const CAGE_600RPM: &str = include_str!("../../scenes/cage_600rpm.toml");
/// The spall of section 5.4.3 and the sensors of 5.4.4.
const SPALL_SENSORS: &str = include_str!("../../scenes/spall_sensors.toml");
/// Time between two samples, s.
pub const INTERVAL: f64 = 1e-5;

/// As in the scene, kg/m³.
const STEEL_DENSITY: f64 = 7850.0;

/// How all these runs step. The step divides [`INTERVAL`]; halving it moves the speed of the ball
/// set by 1e-6 of itself.
fn options() -> (RunOptions, u64) {
    let steps_per_sample = 2;
    let options = RunOptions {
        start: Start::Equilibrium,
        integrator: Integrator::Rosenbrock,
        stepping: Stepping::Fixed(INTERVAL / steps_per_sample as f64),
        ..RunOptions::default()
    };
    (options, steps_per_sample)
}

/// The scene of sections 5.4.3 and 5.4.4 with these keys set, as `--set` does.
///
/// # Errors
/// A scene that no longer reads, or a key that it does not take.
pub fn spall_sensors(keys: &[(&str, &str)]) -> Result<AssemblyScene, CaseError> {
    // The name leads to the scene's base.
    let name = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/spall_sensors.toml");
    let mut document = Document::read_str(SPALL_SENSORS, Format::Toml, name)?;
    for (key, value) in keys {
        document.set(key, value)?;
    }
    match resolve_subject(&document)? {
        Subject::Assembly(scene) => Ok(*scene),
        _ => Err(CaseError::message("no bearing in the scene")),
    }
}

/// The scene of section 5.4.1 with the inner race at a constant speed (rad/s): balls and cage
/// start at rolling speed.
///
/// # Errors
/// A scene that no longer reads.
pub fn rolling(speed: f64) -> Result<DynamicProblem, CaseError> {
    let mut problem =
        dynamic_problem(&scene::read_str(CAGE_600RPM, Format::Toml, "cage_600rpm.toml")?)?;
    problem.inner.rotation = Rotation::Speed(Profile::Constant(speed));
    Ok(problem)
}

/// The same with the inner race taken from one speed (rad/s), at which balls and cage roll, to
/// another within `duration` (s).
///
/// # Errors
/// As [`rolling`].
pub fn speeding_up(from: f64, to: f64, duration: f64) -> Result<DynamicProblem, CaseError> {
    let mut problem = rolling(from)?;
    let ramp = Profile::SmoothRamp { from, to, start: 0.0, duration };
    problem.inner.rotation = Rotation::Speed(ramp);
    Ok(problem)
}

/// The friction curve between balls and races times `level`.
pub fn scale_traction(problem: &mut DynamicProblem, level: f64) {
    if let TractionLaw::SlideToRoll { curve, .. } = &mut problem.traction {
        curve.b *= level;
        curve.d *= level;
    }
}

/// Another axial load on the outer race (N), and the inner race held where it balances.
pub fn set_load(problem: &mut DynamicProblem, load: f64) {
    let mut known = [Known::Value(0.0); 5];
    known[0] = Known::Load(load);
    let held = bearings::oracle(&ANGULAR_CONTACT, Hertz::Fit, 0.0).solve(&known, None);
    problem.inner.drives[0] = Drive::Motion(Profile::Constant(held.coordinates[0]));
    if let Some(outer) = &mut problem.outer {
        outer.drives[0] = Drive::Load(Profile::Constant(-load));
    }
}

/// Angles turned since the first sample, rad, and where the cage is, sample by sample.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    pub shaft: Vec<f64>,
    pub cage: Vec<f64>,
    /// Mean over the balls of their azimuths.
    pub balls: Vec<f64>,
    /// Centre of the cage from the outer race's, y and z, m.
    pub cage_centre: Vec<[f64; 2]>,
    /// Largest energy residual over the kinetic energy at the end; of runs with error control.
    pub residual: f64,
    /// Root mean square of all pocket loads, N.
    pub pocket_rms: f64,
    /// Orientation of the cage about X, rad; as `cage`, but from where it started.
    first_cage_angle: f64,
    pub steps: u64,
}

impl Motion {
    fn turned(angles: &[f64]) -> f64 {
        angles.last().copied().unwrap_or(f64::NAN)
    }

    /// Turns of the cage over those of the shaft.
    pub fn cage_ratio(&self) -> f64 {
        Motion::turned(&self.cage) / Motion::turned(&self.shaft)
    }

    /// Turns of the ball set over those of the shaft.
    pub fn ball_ratio(&self) -> f64 {
        Motion::turned(&self.balls) / Motion::turned(&self.shaft)
    }

    /// Largest change of the angle between cage and ball set, rad.
    pub fn cage_play(&self) -> f64 {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (cage, balls) in self.cage.iter().zip(&self.balls) {
            low = low.min(cage - balls);
            high = high.max(cage - balls);
        }
        high - low
    }

    /// How far cage and ball set can turn against each other within the pockets, rad. It holds for
    /// an eccentric cage too, since that moves opposite pockets by opposite amounts.
    pub fn largest_play(problem: &DynamicProblem) -> f64 {
        let gap = problem
            .cage
            .as_ref()
            .map_or(f64::NAN, |cage| cage.contacts.pocket_radius - problem.geometry.ball_radius);
        2.0 * gap / problem.geometry.pitch_radius
    }

    /// Turns of the cage's centre about the outer race's axis.
    pub fn whirl(&self) -> f64 {
        let angle = |w: &[[f64; 2]]| {
            let ([y, z], [v, u]) = (w[0], w[1]);
            (y * u - z * v).atan2(y * v + z * u)
        };
        self.cage_centre.windows(2).map(angle).sum::<f64>() / TAU
    }

    /// Lateral displacement (y, m) of a point that is fixed to the cage at `radius`.
    pub fn point_displacement(&self, radius: f64) -> Vec<f64> {
        let point = |(angle, centre): (&f64, &[f64; 2])| {
            centre[0] + radius * (self.first_cage_angle + angle).cos()
        };
        self.cage.iter().zip(&self.cage_centre).map(point).collect()
    }
}

/// Runs for `settle` seconds, then takes `samples` samples [`INTERVAL`] apart.
///
/// # Errors
/// What the simulation's watchdog and its energy ledger find.
pub fn simulate(
    problem: DynamicProblem,
    settle: f64,
    samples: usize,
) -> Result<Motion, SimulationError> {
    let (options, steps_per_sample) = options();
    let mut simulation = Simulation::new(problem, options)?;
    for _ in 0..(settle / INTERVAL).round() as u64 * steps_per_sample {
        simulation.step()?;
    }
    let mut recording = Recording::new(&simulation);
    for sample in 0..samples {
        if sample > 0 {
            for _ in 0..steps_per_sample {
                simulation.step()?;
            }
        }
        recording.take(&simulation);
    }
    // Fails if energy went missing.
    simulation.snapshot();
    Ok(Motion { steps: simulation.steps, ..recording.motion })
}

/// Samples of the cage's motion.
struct Recording {
    motion: Motion,
    last: Angles,
}

impl Recording {
    fn new(simulation: &Simulation) -> Recording {
        let last = Angles::of(&simulation.system.sets[0].layout, &simulation.state);
        Recording { motion: Motion { first_cage_angle: last.cage, ..Motion::default() }, last }
    }

    fn take(&mut self, simulation: &Simulation) {
        let Recording { motion, last } = self;
        let (state, layout) = (&simulation.state, simulation.system.sets[0].layout);
        let outer = layout.outer();
        // Where there is no cage the outer race stands in for it.
        let cage = if layout.has_cage { layout.cage() } else { outer };
        let now = Angles::of(&layout, state);
        let push = |to: &mut Vec<f64>, by: f64| to.push(to.last().copied().unwrap_or(0.0) + by);
        push(&mut motion.shaft, shortest(now.shaft - last.shaft));
        push(&mut motion.cage, shortest(now.cage - last.cage));
        let balls: f64 = now.balls.iter().zip(&last.balls).map(|(a, b)| shortest(a - b)).sum();
        push(&mut motion.balls, balls / now.balls.len() as f64);
        motion.cage_centre.push([1, 2].map(|i| state[cage + i] - state[outer + i]));
        let pockets = &simulation.system.sets[0].pockets;
        let square: f64 = pockets.iter().map(|of| of.normal_load * of.normal_load).sum();
        let count = motion.cage_centre.len() as f64;
        let mean = square / pockets.len().max(1) as f64;
        let before = motion.pocket_rms * motion.pocket_rms;
        motion.pocket_rms = (before + (mean - before) / count).sqrt();
        *last = now;
    }
}

/// The scene of section 5.4.1 with a cage that touches by its nodes, with more lines of [bearing.cage], at a speed over
/// time (rad/s).
///
/// # Errors
/// A scene that no longer reads, a cage without modes.
pub fn with_nodes(lines: &str, speed: Profile) -> Result<Assembly, CaseError> {
    let keys = format!(
        "law = \"penalty\", at = \"nodes\", stiffness = \"2e8 N/m\" }}\ncorrections = false\n{lines}"
    );
    let text = CAGE_600RPM.replace("law = \"penalty\", stiffness = \"2e8 N/m\" }", &keys);
    let scene = scene::read_str(&text, Format::Toml, "cage_600rpm.toml")?;
    let mut problem = dynamic_problem(&scene)?;
    problem.inner.rotation = Rotation::Speed(speed);
    let mut all = problem.assembly();
    add_cage_nodes(&mut all, [&scene.dynamics].into_iter())
        .map_err(|error| CaseError::message(error.to_string()))?;
    Ok(all)
}

/// Runs with error control for `settle` seconds, then takes `samples` samples `interval` seconds apart.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_by_accuracy(
    assembly: Assembly,
    accuracy: f64,
    settle: f64,
    interval: f64,
    samples: usize,
) -> Result<Motion, SimulationError> {
    let options = RunOptions {
        integrator: Integrator::Rosenbrock,
        stepping: Stepping::Accuracy(accuracy),
        // At the first impacts of a start from rest little energy has been turned over.
        // Cases check the ledger themselves; without a limit it would not be looked at between rows.
        energy_limit: 1.0,
        ..RunOptions::default()
    };
    let end = settle + interval * samples as f64;
    let (output_interval, fields_interval, channels) = (interval, None, Vec::new());
    let request = RunRequest { options, end, output_interval, fields_interval, channels };
    let (mut simulation, mut clock) = clocked::start(assembly, &request)?;
    clock.count_row(0.0);
    let mut recording: Option<Recording> = None;
    while recording.as_ref().is_none_or(|of| of.motion.shaft.len() < samples) {
        let arrival = clocked::step(&mut simulation, &clock)?;
        if !arrival.row {
            continue;
        }
        clock.count_row(simulation.time);
        if simulation.time > settle - 0.5 * interval {
            recording.get_or_insert_with(|| Recording::new(&simulation)).take(&simulation);
        }
    }
    let residual = simulation.largest_residual() / simulation.snapshot().energy.kinetic;
    let motion = recording.map_or_else(Motion::default, |of| of.motion);
    Ok(Motion { steps: simulation.steps, residual, ..motion })
}

/// Angles about X at one instant, rad, each up to whole turns.
struct Angles {
    shaft: f64,
    cage: f64,
    balls: Vec<f64>,
}

impl Angles {
    fn of(layout: &Layout, state: &[f64]) -> Angles {
        let about_x = |at: usize| {
            let q = BodyState::from_slice(&state[at..at + BODY]).orientation;
            2.0 * q.i.atan2(q.w)
        };
        let outer = layout.outer();
        let azimuth = |ball| {
            let [_, y, z] = layout.ball_vector(state, POSITION, ball);
            (z - state[outer + 2]).atan2(y - state[outer + 1])
        };
        Angles {
            shaft: about_x(layout.inner()),
            cage: if layout.has_cage { about_x(layout.cage()) } else { 0.0 },
            balls: (0..layout.balls).map(azimuth).collect(),
        }
    }
}

fn shortest(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// Pure rolling of the loaded, orbiting ball set, by independent solvers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling {
    /// Orbit over shaft speed.
    pub ratio: f64,
    /// The same if the balls did not spin on the outer race, and on the inner one.
    pub race_control: [f64; 2],
    /// Contact angles, inner and outer, rad.
    pub angles: [f64; 2],
}

/// What kinematics say of `problem` at a shaft speed (rad/s): equilibrium of inner race, balls with
/// centrifugal force, and outer race on its foundation; then rolling at the contact points that
/// result. The balls' weight, 0.1 % of their load at 445 N, is left out, and so is the cage.
///
/// # Errors
/// A problem that is not a variant of the scene.
pub fn kinematics(problem: &DynamicProblem, shaft_speed: f64) -> Result<Rolling, CaseError> {
    let variant = || CaseError::message("not a variant of the scene of 5.4.1");
    let outer = problem.outer.as_ref().ok_or_else(variant)?;
    let (Drive::Motion(held), Drive::Load(push)) = (&problem.inner.drives[0], &outer.drives[0])
    else {
        return Err(variant());
    };
    let TractionLaw::SlideToRoll { curve, .. } = &problem.traction else { return Err(variant()) };
    let (held, push) = (held.value(0.0), push.value(0.0));
    let lengths = &ANGULAR_CONTACT;
    let ball_radius = lengths.ball_radius;
    let mass = STEEL_DENSITY * 4.0 / 3.0 * PI * ball_radius.powi(3);
    let orbit = nominal_ratio() * shaft_speed;
    let bearing = OracleBearing {
        centrifugal: mass * orbit * orbit,
        ..bearings::oracle(lengths, Hertz::Fit, 0.0)
    };
    // The outer race is `moved` from its rest: bearing + push = k · moved.
    let at = |moved: f64| [held - moved, 0.0, 0.0, 0.0, 0.0];
    let excess = |moved: f64| {
        let (_, loads, _) = bearing.evaluate(&at(moved));
        loads[0] + push - outer.foundation_stiffness[0] * moved
    };
    let (mut low, mut high) = (-5e-6, 5e-6);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
    let (_, _, balls) = bearing.evaluate(&at(0.5 * (low + high)));
    let ball = balls[0];
    let modulus = hertz::effective_modulus(210e9, 0.3, 210e9, 0.3);
    let touching = |contact: OracleContact, groove: f64, sign: f64| {
        let race = lengths.pitch_radius / lengths.contact_angle.cos() - sign * ball_radius;
        let radii = hertz::ball_on_race(ball_radius, race, groove, sign);
        let ellipse = hertz::hamrock_brewe(radii, contact.load, modulus);
        RollingContact {
            arm: ball_radius - 0.5 * contact.approach,
            angle: contact.angle,
            load: contact.load,
            semi_axis: ellipse.semi_axis_transverse,
        }
    };
    let rolling = RollingBall {
        orbit_radius: ball.position[1],
        inner: touching(ball.inner, lengths.inner_groove_radius, 1.0),
        outer: touching(ball.outer, lengths.outer_groove_radius, -1.0),
    };
    let friction = |s: f64| (curve.b * s - curve.d) * (-curve.c * s).exp() + curve.d;
    Ok(Rolling {
        ratio: rolling.orbit_ratio(rolling.balanced_roll(friction)),
        race_control: rolling.race_control().map(|roll| rolling.orbit_ratio(roll)),
        angles: [ball.inner.angle, ball.outer.angle],
    })
}

/// Cage over shaft by pure rolling at the nominal contact angle.
pub fn nominal_ratio() -> f64 {
    let Lengths { ball_radius, pitch_radius, contact_angle, .. } = ANGULAR_CONTACT;
    0.5 * (1.0 - ball_radius / pitch_radius * contact_angle.cos())
}
