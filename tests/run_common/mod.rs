//! Small bearings in motion.
#![allow(dead_code)]

pub(crate) use crate::common;

use bearing_dynamics::assembly::bearing_alone::{CageBody, DynamicProblem};
use bearing_dynamics::ch2_housing::bearing::ball_contact::{BallContactLaw, equal_spheres};
use bearing_dynamics::ch2_housing::bearing::cage::{CageContacts, CageForce, Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::inertia::{self, Inertia};
use bearing_dynamics::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use bearing_dynamics::members::body::{Condition, Drive, DrivenBody, Rotation};
use bearing_dynamics::motion::checkpoint::Checkpoint as BearingCheckpoint;
use bearing_dynamics::motion::simulation::{RunOptions, Simulation, SimulationError, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::session::{Checkpoint, RunRequest, Session, SessionError};
use bearing_dynamics::plan::channels::ChannelGroup;

/// Table 4.1's bearing under 250 N down, at 1000 rpm, no traction, no cage, fixed outer race.
pub fn frictionless() -> DynamicProblem {
    let geometry = common::table_4_1(-3e-6);
    let mut conditions = common::FREE;
    conditions[2] = Condition::Load(-250.0);
    let statics = common::problem(geometry, conditions);
    let mut drives = [const { Drive::Load(Profile::ZERO) }; 5];
    drives[2] = Drive::Load(Profile::Constant(-250.0));
    DynamicProblem {
        geometry,
        inner_contact: statics.inner_contact,
        outer_contact: statics.outer_contact,
        ball: inertia::ball(geometry.ball_radius, 7850.0),
        inner: race(drives, Rotation::Speed(Profile::Constant(104.72))),
        outer: None,
        outer_start: [0.0; 5],
        cage: None,
        ball_phase: 0.1,
        traction: TractionLaw::None,
        slices: 15,
        points_across: 1,
        differential_sliding: false,
        damping: ContactDamping::None,
        raceway_profiles: Vec::new(),
        ball_deviations: Vec::new(),
        ball_contact: Some(BallContactLaw {
            stiffness: equal_spheres(210e9 / 0.91, geometry.ball_radius),
            friction: 0.1,
            regularisation_speed: 0.01,
        }),
        gravity: [0.0; 3],
        rotating_load: None,
        unbalance: 0.0,
    }
}

pub fn race(drives: [Drive; 5], rotation: Rotation) -> DrivenBody {
    DrivenBody {
        inertia: Inertia { mass: 0.2, axial: 5e-5, transverse: 4e-5 },
        drives,
        rotation,
        foundation_stiffness: [0.0; 5],
        foundation_damping: [0.0; 5],
    }
}

pub fn cage() -> CageBody {
    let (inner, outer, length) = (23.5e-3, 28.5e-3, 12e-3);
    CageBody {
        inertia: inertia::hollow_cylinder(inner, outer, length, 1400.0),
        contacts: CageContacts {
            pocket: Pocket::Cylindrical,
            pocket_radius: 6.1e-3,
            pocket_pitch_radius: 26e-3,
            guidance: Guidance::OuterRace,
            ring: [inner, outer],
            guide_radius: outer,
            race_clearance: 0.1e-3,
            length,
            force: CageForce::Penalty { stiffness: 1e6 },
            friction: 0.1,
            regularisation_speed: 0.05,
        },
    }
}

/// Everything at once: traction, a cage, gravity, an outer race on springs, contact history.
pub fn complete() -> DynamicProblem {
    let free = [const { Drive::Load(Profile::ZERO) }; 5];
    let mut outer = race(free, Rotation::Speed(Profile::ZERO));
    outer.foundation_stiffness = [1e7, 1e7, 1e7, 1e4, 1e4];
    outer.foundation_damping = [200.0, 200.0, 200.0, 0.2, 0.2];
    DynamicProblem {
        cage: Some(cage()),
        outer: Some(outer),
        gravity: [0.0, 0.0, -9.81],
        // With a gentle onset, so that a step of 1 µs is well below its limit.
        traction: TractionLaw::SlideToRoll {
            curve: ExponentialCurve { b: 4.0, c: 30.0, d: 0.1 },
            entrainment_floor: 0.01,
        },
        slices: 5,
        points_across: 1,
        differential_sliding: false,
        damping: ContactDamping::HuntCrossley { alpha: 0.9 },
        unbalance: 1e-4,
        ..frictionless()
    }
}

/// [`complete`] with room between its parts: balls part from the races and hit them again, and each
/// time the speed of approach becomes history.
pub fn rattling() -> DynamicProblem {
    let geometry = common::table_4_1(3e-6);
    DynamicProblem { geometry, damping: ContactDamping::HuntCrossley { alpha: 0.3 }, ..complete() }
}

/// The inner race's motion given, with corners off every grid of steps and rows, two of them in one
/// row and one on a row; a load with another corner.
pub fn jolted() -> DynamicProblem {
    let mut problem = frictionless();
    let points = vec![[0.0, 0.0], [0.0317e-3, 1e-6], [0.0341e-3, 1e-6], [0.08e-3, -2e-6]];
    problem.inner.drives[2] = Drive::Motion(Profile::Table { points });
    let tilts = Profile::Ramp { from: 0.0, to: 5e-5, start: 0.0553e-3, duration: 0.05e-3 };
    problem.inner.drives[3] = Drive::Motion(tilts);
    let load = Profile::Ramp { from: 0.0, to: 100.0, start: 0.0, duration: 0.1234e-3 };
    problem.inner.drives[0] = Drive::Load(load);
    problem
}

/// [`frictionless`] with traction that binds the step: it decays in proportion to the load.
pub fn sliding() -> DynamicProblem {
    DynamicProblem {
        traction: TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 0.005 },
        ..frictionless()
    }
}

/// [`sliding`] under a load that grows sixteenfold, after 200 steps and within 2000 of them.
pub fn pressed(step: f64) -> DynamicProblem {
    let mut problem = sliding();
    let (start, duration) = (200.0 * step, 2000.0 * step);
    let ramp = Profile::Ramp { from: -250.0, to: -4000.0, start, duration };
    problem.inner.drives[2] = Drive::Load(ramp);
    problem
}

/// `rows` output intervals of ten steps and a bit, so that the last step is a shortened one.
pub fn request(step: f64, rows: usize) -> RunRequest {
    RunRequest {
        options: RunOptions { stepping: Stepping::Fixed(step), ..RunOptions::default() },
        end: step * (10.0 * rows as f64 + 3.4),
        output_interval: 10.0 * step,
        fields_interval: None,
        channels: ChannelGroup::ALL.to_vec(),
    }
}

/// The bearing that a session moves.
pub fn simulation<'s>(session: &'s Session) -> &'s Simulation {
    session.motion.bearing().expect("a bearing moves")
}

pub fn simulation_mut<'s>(session: &'s mut Session) -> &'s mut Simulation {
    session.motion.bearing_mut().expect("a bearing moves")
}

/// What ended the steps of a bearing.
pub fn of_steps(error: SessionError) -> SimulationError {
    match error {
        SessionError::Simulation(error) => error,
        other => panic!("{other}"),
    }
}

/// What a bearing goes on from, and its rows.
pub fn resumable(session: &mut Session) -> (BearingCheckpoint, usize) {
    let sound = session.resumable();
    match sound.checkpoint {
        Checkpoint::Bearing(kept) => (*kept, sound.rows),
        other => panic!("{other:?}"),
    }
}
