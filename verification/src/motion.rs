//! Bearings in motion for the cases, and the independent statics at the angles their balls have.

use std::f64::consts::TAU;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::ball_contact::{BallContactLaw, equal_spheres};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::frequencies::ratios;
use bearing_dynamics::ch2_housing::bearing::geometry::Material;
use bearing_dynamics::ch2_housing::bearing::hertz::HertzError;
use bearing_dynamics::ch2_housing::bearing::inertia;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::members::body::{Condition, Drive, DrivenBody, Rotation};
use bearing_dynamics::members::rigid_body::tilts_of;
use bearing_dynamics::members::state::{BodyState, POSITION, VELOCITY};
use bearing_dynamics::motion::simulation::{RunOptions, Simulation, SimulationError, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::series::Series;
use bearing_dynamics::output::session::{HousedParts, Parts, RunRequest, Session, Status};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::bushing::{BushingElements, take_bushings};
use bearing_dynamics::scene::build::shaft::take_shafts;
use bearing_dynamics::scene::{Document, Format, Subject, resolve_subject};

use crate::bearings::{self, Hertz, Lengths};
use crate::case::CaseError;
use crate::oracles::statics::OracleBearing;

/// rad/s in one revolution a minute.
pub const RPM: f64 = TAU / 60.0;

/// Text of the assumption on the races' inertia, which no table states.
pub const RACE_INERTIA: (&str, &str, &str) = (
    "race_inertia",
    "No table states the races' masses. The inner race is taken as a steel ring of 15 and 22 mm radius, 12 mm \
     wide. Slow motions do not depend on it.",
    "0.077 kg",
);

/// Shipped scenes of chapter 4.
pub const ROTOR_IN_ELEMENTS: &str = include_str!("../../scenes/rotor_in_elements.toml");
pub const ROTOR_IN_PILLOW_BLOCKS: &str = include_str!("../../scenes/rotor_in_pillow_blocks.toml");
pub const ROTOR_RUN_UP: &str = include_str!("../../scenes/rotor_run_up.toml");
pub const RACE_IN_ROUGH_BORE: &str = include_str!("../../scenes/race_in_rough_bore.toml");
pub const SPINNING_DISC: &str = include_str!("../../scenes/spinning_disc.toml");

/// An inner race of [`RACE_INERTIA`] under constant loads.
pub fn race(loads: [f64; 5], rotation: Rotation) -> DrivenBody {
    DrivenBody {
        inertia: inertia::hollow_cylinder(15e-3, 22e-3, 12e-3, Material::STEEL.density),
        drives: loads.map(|load| Drive::Load(Profile::Constant(load))),
        rotation,
        foundation_stiffness: [0.0; 5],
        foundation_damping: [0.0; 5],
    }
}

/// The bearing with constant loads on an inner race of constant speed (rad/s): outer race fixed, no
/// cage, no traction, no damping, no gravity. Balls touch as in a scene that says nothing of it.
pub fn moving(
    lengths: &Lengths,
    ball_phase: f64,
    loads: [f64; 5],
    speed: f64,
) -> Result<DynamicProblem, HertzError> {
    let still = bearings::problem(lengths, Hertz::Fit, ball_phase, loads.map(Condition::Load))?;
    Ok(DynamicProblem {
        geometry: still.geometry,
        inner_contact: still.inner_contact,
        outer_contact: still.outer_contact,
        ball: inertia::ball(still.geometry.ball_radius, Material::STEEL.density),
        inner: race(loads, Rotation::Speed(Profile::Constant(speed))),
        outer: None,
        outer_start: [0.0; 5],
        cage: None,
        ball_phase,
        traction: TractionLaw::None,
        slices: 15,
        points_across: 1,
        differential_sliding: false,
        damping: ContactDamping::None,
        raceway_profiles: Vec::new(),
        ball_deviations: Vec::new(),
        ball_contact: Some(BallContactLaw {
            stiffness: equal_spheres(
                Material::STEEL.youngs_modulus / (1.0 - Material::STEEL.poisson_ratio.powi(2)),
                still.geometry.ball_radius,
            ),
            friction: 0.1,
            regularisation_speed: 0.01,
        }),
        gravity: [0.0; 3],
        rotating_load: None,
        unbalance: 0.0,
    })
}

/// A shipped scene of bearings with these words changed. Words that are not there are an error: no case computes what it
/// does not say.
pub fn changed_scene(shipped: &str, changes: &[(&str, &str)]) -> Result<AssemblyScene, CaseError> {
    let mut text = shipped.to_string();
    for (from, to) in changes {
        if !text.contains(from) {
            return Err(CaseError::message(format!("no {from:?} in the scene")));
        }
        text = text.replace(from, to);
    }
    match resolve_subject(&Document::read_str(&text, Format::Toml, "changed.toml")?)? {
        Subject::Assembly(scene) => Ok(*scene),
        _ => Err(CaseError::message("no bearing in the scene")),
    }
}

/// What the scene asks of its run.
pub fn request(scene: &AssemblyScene) -> Result<RunRequest, CaseError> {
    let run = scene.run().ok_or_else(|| CaseError::message("no end"))?;
    Ok(RunRequest {
        options: run.options,
        end: run.end,
        output_interval: run.output_interval,
        fields_interval: None,
        channels: run.channels.clone(),
    })
}

/// A session to its end.
pub fn done<'p>(
    parts: impl Into<Parts<'p>>,
    request: &RunRequest,
) -> Result<Session<'p>, CaseError> {
    let mut session = Session::start(parts, request)?;
    while session.advance(1000)? != Status::Complete {}
    Ok(session)
}

/// A column of a table.
pub fn column(series: &Series, name: &str) -> Result<Vec<f64>, CaseError> {
    let column = series.column(name);
    Ok(column.ok_or_else(|| CaseError::message(format!("no column {name}")))?.to_vec())
}

/// Columns of the run of a scene, its bushings as springs or in elements, its shafts reduced or in elements.
pub fn ran(scene: &AssemblyScene, names: &[&str]) -> Result<Vec<Vec<f64>>, CaseError> {
    let (request, mut assembly) = (request(scene)?, scene.assembly()?);
    let bushings = take_bushings(scene, &mut assembly)?;
    let shafts = take_shafts(scene, &mut assembly)?;
    let series = match bushings.is_empty() && shafts.is_empty() {
        true => done(assembly, &request)?.series()?,
        false => {
            let shafts = shafts.into_iter().map(|shaft| shaft.part).collect();
            let bushings = bushings.iter().map(BushingElements::part).collect();
            let parts = HousedParts::without_housings(assembly, shafts, bushings, &request.options);
            done(Parts::Housed(Box::new(parts)), &request)?.series()?
        }
    };
    names.iter().map(|name| column(&series, name)).collect()
}

/// Runge–Kutta with a fixed step; the balance of energy is left to the case.
pub fn fixed_step(step: f64) -> RunOptions {
    RunOptions {
        stepping: Stepping::Fixed(step),
        energy_limit: f64::INFINITY,
        ..RunOptions::default()
    }
}

pub fn run(simulation: &mut Simulation, steps: usize) -> Result<(), SimulationError> {
    for _ in 0..steps {
        simulation.step()?;
    }
    Ok(())
}

/// Orbital speed of the balls over the inner race's, by pure rolling.
pub fn cage_ratio(problem: &DynamicProblem) -> f64 {
    let g = &problem.geometry;
    ratios(g.ball_count, g.ball_radius, g.pitch_radius, g.contact_angle).cage
}

/// Where the balls are about the bearing's axis, and how fast they go round.
#[derive(Clone, Debug)]
pub struct BallSet {
    /// rad, from +Y towards +Z.
    pub azimuths: Vec<f64>,
    /// rad/s.
    pub speeds: Vec<f64>,
    pub mass: f64,
}

impl BallSet {
    pub fn of(simulation: &Simulation) -> BallSet {
        let layout = simulation.system.sets[0].layout;
        let (mut azimuths, mut speeds) = (Vec::new(), Vec::new());
        for ball in 0..layout.balls {
            let [_, y, z] = layout.ball_vector(&simulation.state, POSITION, ball);
            let [_, v, w] = layout.ball_vector(&simulation.state, VELOCITY, ball);
            azimuths.push(z.atan2(y));
            speeds.push((y * w - z * v) / (y * y + z * z));
        }
        BallSet { azimuths, speeds, mass: simulation.system.assembly.bearings[0].ball.mass }
    }

    /// How far each ball is ahead of its even place behind ball 1, rad.
    pub fn ahead(&self) -> Vec<f64> {
        let count = self.azimuths.len() as f64;
        let off = |(ball, azimuth): (usize, &f64)| {
            let off = azimuth - self.azimuths[0] - TAU * ball as f64 / count;
            off - TAU * (off / TAU).round()
        };
        self.azimuths.iter().enumerate().map(off).collect()
    }

    /// The independent solver's bearing with each ball at its angle, under centrifugal force.
    pub fn oracle(&self, lengths: &Lengths) -> OracleBearing {
        let mut bearing = bearings::oracle(lengths, Hertz::Fit, self.azimuths[0]);
        bearing.ahead = self.ahead();
        let square = self.speeds.iter().map(|speed| speed * speed).sum::<f64>();
        bearing.centrifugal = self.mass * square / self.speeds.len() as f64;
        bearing
    }
}

/// x, y, z (m) and both tilts (rad) of the inner race.
pub fn inner_coordinates(simulation: &Simulation) -> [f64; 5] {
    let inner =
        BodyState::from_slice(&simulation.state[simulation.system.sets[0].layout.inner()..]);
    let [x, y, z] = inner.position;
    let [tilt_y, tilt_z] = tilts_of(inner.axis());
    [x, y, z, tilt_y, tilt_z]
}
