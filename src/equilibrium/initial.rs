//! Equilibrium of the bodies and balls of an assembly: the start of a motion.
//!
//! One search over the coordinates of all bodies ([`solve_assembly`]), repeated for follower loads
//! (`FollowerLoadRounds`).

use crate::assembly::bearing_alone::DynamicProblem;
use crate::assembly::lists::{Assembly, INNER};
use crate::assembly::prescribed::{conditions, orbital_speed};
use crate::equilibrium::follower_loads::FollowerLoadRounds;
use crate::equilibrium::lists::{Loaded, Place, StaticAssembly, StaticBearing, StaticBody};
use crate::equilibrium::sections;
use crate::equilibrium::statics::{
    AssemblySolution, StaticOptions, StaticProblem, StaticsError, solve_assembly,
};
use crate::kinematics::Pose;
use crate::kinematics::euler::quaternion;
use crate::members::body::{DrivenBody, FARTHEST, all_prescribed, is_fixed};
use crate::members::connection::Connection;
use crate::members::mount::Mount;
use nalgebra::{SVector, Vector3};

type Five = SVector<f64, 5>;

/// Positions of all bodies and balls in equilibrium, in the world.
pub type Equilibrium = AssemblySolution;

impl Equilibrium {
    /// Position (m) and tilts (rad) of a body.
    pub fn place(&self, assembly: &Assembly, body: usize) -> [f64; 5] {
        let of = &assembly.bodies[body];
        if of.moves() { self.coordinates[body].into() } else { of.rest }
    }
}

/// Equilibrium under the loads at t = 0. Rotating forces have their direction at that time: the rotating load its
/// phase, an unbalance the body's own Y. Traction, if there is any, holds rolling balls in their orbit.
///
/// # Errors
///
/// No equilibrium.
pub fn at_start(assembly: &Assembly) -> Result<Equilibrium, StaticsError> {
    at(assembly, 0.0, &[], None)
}

/// Equilibrium under the loads at `t`, with the balls of each bearing advanced by `turned` (rad; empty for none),
/// searched from a known one `near` it.
///
/// # Errors
///
/// No equilibrium.
pub(crate) fn at(
    assembly: &Assembly,
    t: f64,
    turned: &[f64],
    near: Option<&Equilibrium>,
) -> Result<Equilibrium, StaticsError> {
    let mut plain = static_assembly(assembly, t, turned);
    let options = StaticOptions::default();
    if let Some(near) = near {
        bend(&mut plain, near);
    }
    let mut near = near.map(|near| near.coordinates.clone());
    let tilts = near.clone().unwrap_or_else(|| given(&plain));
    let mut following = FollowerLoadRounds::new(assembly, &plain, t, tilts);
    let mut rounds = 0;
    loop {
        let mut found = search(&following.loaded(&plain), near.as_deref(), &options)?;
        impose_prescribed(assembly, t, &mut found);
        bend(&mut plain, &found);
        if following.follow(&plain, &found, options.tolerance) {
            return Ok(found);
        }
        rounds += 1;
        if rounds == following.rounds() {
            return following.unsettled().map_or(Ok(found), Err);
        }
        near = Some(found.coordinates);
    }
}

/// Starts the search from the amplitudes of a solution.
fn bend(still: &mut StaticAssembly, known: &Equilibrium) {
    let shafts = still.shafts.iter_mut().zip(&known.amplitudes);
    shafts.for_each(|(shaft, amplitudes)| shaft.start.clone_from(amplitudes));
}

/// From known positions, or a cold start.
fn search(
    loaded: &StaticAssembly,
    near: Option<&[Five]>,
    options: &StaticOptions,
) -> Result<Equilibrium, StaticsError> {
    if near.is_some()
        && let Ok(found) = solve_assembly(loaded, near, options)
    {
        return Ok(found);
    }
    solve_assembly(loaded, None, options)
}

/// Replaces prescribed coordinates by their exact values, without the rounding of a pose.
fn impose_prescribed(assembly: &Assembly, t: f64, found: &mut Equilibrium) {
    for (coordinates, body) in found.coordinates.iter_mut().zip(&assembly.bodies) {
        if let Some(at) = body.driven().and_then(|race| all_prescribed(race, t)) {
            *coordinates = at.into();
        }
    }
}

/// Coordinates as far as they are prescribed.
fn given(assembly: &StaticAssembly) -> Vec<Five> {
    let of = |body: &StaticBody| match &body.place {
        Place::Fixed(_) | Place::Section(_) => Five::zeros(),
        Place::Loaded(loaded) => Five::from_fn(|i, _| loaded.prescribed(i).unwrap_or(0.0)),
    };
    assembly.bodies.iter().map(of).collect()
}

/// The static problem of an assembly at time `t`; a rotating load has its present direction, unbalance is omitted.
pub fn static_assembly(assembly: &Assembly, t: f64, turned: &[f64]) -> StaticAssembly<'static> {
    let bodies = assembly.bodies.iter().enumerate().map(|(index, body)| {
        let rest = &body.rest;
        let place = match body.driven() {
            None => fixed_at(rest),
            Some(race) => match all_prescribed(race, t) {
                Some(at) => fixed_at(&at),
                None => Place::Loaded(loaded(assembly, index, race, t)),
            },
        };
        StaticBody { name: body.name.clone(), place }
    });
    let bearings = assembly.bearings.iter().enumerate().map(|(index, bearing)| StaticBearing {
        name: bearing.name.clone(),
        geometry: bearing.geometry,
        inner_contact: bearing.inner_contact,
        outer_contact: bearing.outer_contact,
        mounts: bearing.mounts,
        azimuths: bearing
            .geometry
            .azimuths(bearing.ball_phase + turned.get(index).copied().unwrap_or(0.0)),
        weight: Vector3::from(assembly.gravity) * bearing.ball.mass,
        centrifugal: bearing.ball.mass * orbital_speed(assembly, bearing, t).powi(2),
    });
    let mut still = StaticAssembly {
        bodies: bodies.collect(),
        bearings: bearings.collect(),
        connections: assembly.connections.iter().map(Connection::conservative).collect(),
        ..StaticAssembly::default()
    };
    sections::add(assembly, t, &mut still);
    still
}

/// Gives bodies with five prescribed coordinates loads and stiffness of their own, as results of statics have them;
/// the start of a motion needs neither.
pub fn add_reactions(assembly: &Assembly, t: f64, still: &mut StaticAssembly) {
    for (index, (body, of)) in still.bodies.iter_mut().zip(&assembly.bodies).enumerate() {
        if let (Place::Fixed(_), Some(race)) = (&body.place, of.driven()) {
            body.place = Place::Loaded(loaded(assembly, index, race, t));
        }
    }
}

/// A driven body, with springs and room.
fn loaded(assembly: &Assembly, index: usize, race: &DrivenBody, t: f64) -> Loaded {
    let body = &assembly.bodies[index];
    let carries_outer = assembly.bearings.iter().any(|bearing| bearing.mounts[1].body == index);
    let on = assembly.bearings.iter().filter(|bearing| bearing.mounts[0].body == index);
    let ball = on.map(|bearing| bearing.geometry.ball_radius).fold(FARTHEST, f64::min);
    // A race with a fixed partner is searched in the direction of its load.
    let alone = !carries_outer
        && assembly.bearings.len() == 1
        && body.rest[0] == 0.0
        && assembly.bearings[0].mounts.iter().all(Mount::is_direct)
        && is_fixed(&assembly.bodies[assembly.bearings[0].mounts[1].body]);
    Loaded {
        axes: None,
        conditions: conditions(assembly, body, race, t),
        springs: race.foundation_stiffness,
        rest: body.rest,
        start: (!alone).then_some(body.rest),
        room: if carries_outer { FARTHEST } else { ball },
    }
}

fn fixed_at(at: &[f64; 5]) -> Place {
    Place::Fixed(Pose {
        position: Vector3::new(at[0], at[1], at[2]),
        orientation: quaternion(0.0, at[3], at[4]),
    })
}

impl DynamicProblem {
    /// The bearing at time `t` with its outer race fixed at its start; a rotating load has its present direction,
    /// unbalance is omitted.
    pub fn statics(&self, t: f64) -> StaticProblem {
        let assembly = self.assembly();
        let [x, y, z, xi, lambda] = self.outer_start;
        StaticProblem {
            geometry: self.geometry,
            inner_contact: self.inner_contact,
            outer_contact: self.outer_contact,
            ball_phase: self.ball_phase,
            ball_mass: self.ball.mass,
            gravity: Vector3::from(self.gravity),
            orbital_speed: orbital_speed(&assembly, &assembly.bearings[0], t),
            frame: Pose::identity(),
            outer_pose: Pose {
                position: Vector3::new(x, y, z),
                orientation: quaternion(0.0, xi, lambda),
            },
            conditions: conditions(&assembly, &assembly.bodies[INNER], &self.inner, t),
        }
    }
}
