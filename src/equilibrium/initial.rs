//! Equilibrium of the bodies and balls of an assembly: the start of a motion.
//!
//! One search over the coordinates of all bodies ([`solve_assembly`]), repeated for follower loads
//! (`FollowerLoadRounds`).

use crate::assembly::lists::{Assembly, Bearing, Body};
use crate::assembly::loads::{Drive, DrivenBody, Rotation};
use crate::assembly::mount::Mount;
use crate::assembly::static_lists::{Loaded, Place, StaticAssembly, StaticBearing, StaticBody};
use crate::ch2_housing::bearing::frequencies::ratios;
use crate::equilibrium::follower_loads::FollowerLoadRounds;
use crate::equilibrium::sections;
use crate::equilibrium::statics::{
    AssemblySolution, Condition, StaticOptions, StaticsError, solve_assembly,
};
use crate::kinematics::Pose;
use crate::kinematics::euler::quaternion;
use crate::members::connection::Connection;
use crate::motion::validity::FARTHEST;
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
    let carries_outer =
        |body: usize| assembly.bearings.iter().any(|bearing| bearing.mounts[1].body == body);
    let room = |body: usize| {
        let on = assembly.bearings.iter().filter(|bearing| bearing.mounts[0].body == body);
        let ball = on.map(|bearing| bearing.geometry.ball_radius).fold(FARTHEST, f64::min);
        if carries_outer(body) { FARTHEST } else { ball }
    };
    let bodies = assembly.bodies.iter().enumerate().map(|(index, body)| {
        let rest = &body.rest;
        let place = match body.driven() {
            None => fixed_at(rest),
            Some(race) if let Some(at) = all_prescribed(race, t) => fixed_at(&at),
            Some(race) => {
                // A race with a fixed partner is searched in the direction of its load.
                let alone = !carries_outer(index)
                    && assembly.bearings.len() == 1
                    && rest[0] == 0.0
                    && assembly.bearings[0].mounts.iter().all(Mount::is_direct)
                    && is_fixed(&assembly.bodies[assembly.bearings[0].mounts[1].body]);
                Place::Loaded(Loaded {
                    axes: None,
                    conditions: conditions(assembly, body, race, t),
                    springs: race.foundation_stiffness,
                    rest: *rest,
                    start: (!alone).then_some(*rest),
                    room: room(index),
                })
            }
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

/// Conditions on a body's coordinates at time `t`: drives, weight, rotating load.
pub fn conditions(assembly: &Assembly, body: &Body, race: &DrivenBody, t: f64) -> [Condition; 5] {
    let mut others = [0.0; 5];
    for (other, gravity) in others.iter_mut().zip(assembly.gravity) {
        *other = race.inertia.mass * gravity;
    }
    if let Some(load) = &body.rotating_load {
        for (other, force) in others.iter_mut().zip(load.force(t)) {
            *other += force;
        }
    }
    std::array::from_fn(|i| match &race.drives[i] {
        Drive::Load(profile) => Condition::Load(profile.value(t) + others[i]),
        Drive::Motion(profile) => Condition::Displacement(profile.value(t)),
    })
}

fn fixed_at(at: &[f64; 5]) -> Place {
    Place::Fixed(Pose {
        position: Vector3::new(at[0], at[1], at[2]),
        orientation: quaternion(0.0, at[3], at[4]),
    })
}

/// Coordinates of a body if all are prescribed.
fn all_prescribed(race: &DrivenBody, t: f64) -> Option<[f64; 5]> {
    let mut at = [0.0; 5];
    for (at, drive) in at.iter_mut().zip(&race.drives) {
        let Drive::Motion(profile) = drive else { return None };
        *at = profile.value(t);
    }
    Some(at)
}

/// Returns whether a body has no unknown.
pub(crate) fn is_fixed(body: &Body) -> bool {
    body.driven().is_none_or(|race| all_prescribed(race, 0.0).is_some())
}

/// Prescribed speed of a body about its own axis at `t`, rad/s; zero for a torque drive or a fixed body.
pub fn prescribed_speed(body: &Body, t: f64) -> f64 {
    match body.driven().map(|race| &race.rotation) {
        Some(Rotation::Speed(profile)) => profile.value(t),
        Some(Rotation::Torque(_)) | None => 0.0,
    }
}

/// Angle of the prescribed rotation of a body since t = 0, rad.
pub(crate) fn prescribed_angle(body: &Body, t: f64) -> f64 {
    match body.driven().map(|race| &race.rotation) {
        Some(Rotation::Speed(profile)) => profile.integral(t),
        Some(Rotation::Torque(_)) | None => 0.0,
    }
}

/// Prescribed speeds of both races of a bearing about the bearing's axis, rad/s.
pub(crate) fn race_speeds(assembly: &Assembly, bearing: &Bearing, t: f64) -> [f64; 2] {
    of_races(assembly, bearing, |body| prescribed_speed(body, t))
}

/// A value of both races about the bearing's axis.
fn of_races(assembly: &Assembly, bearing: &Bearing, of: impl Fn(&Body) -> f64) -> [f64; 2] {
    bearing.mounts.map(|mount| {
        let own = of(&assembly.bodies[mount.body]);
        if mount.reversed { -own } else { own }
    })
}

/// Speed of the ball set by pure rolling about the bearing's axis, rad/s.
pub(crate) fn orbital_speed(assembly: &Assembly, bearing: &Bearing, t: f64) -> f64 {
    rolled(bearing, race_speeds(assembly, bearing, t))
}

/// Angle of the ball set about the bearing's axis by pure rolling since t = 0, rad.
pub fn orbital_angle(assembly: &Assembly, bearing: &Bearing, t: f64) -> f64 {
    rolled(bearing, of_races(assembly, bearing, |body| prescribed_angle(body, t)))
}

/// Rotation of the ball set from those of the inner and the outer race.
fn rolled(bearing: &Bearing, [inner, outer]: [f64; 2]) -> f64 {
    let g = &bearing.geometry;
    let ratio = ratios(g.ball_count, g.ball_radius, g.pitch_radius, g.contact_angle).cage;
    // Both surfaces move past the balls: the outer race has the rest.
    if outer == 0.0 { ratio * inner } else { ratio * inner + (1.0 - ratio) * outer }
}
