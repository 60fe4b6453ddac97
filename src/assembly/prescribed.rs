//! Speeds, angles and loads of bodies at a time.

use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::frequencies::ratios;
use crate::members::bearing::Bearing;
use crate::members::body::{
    Body, Condition, Drive, DrivenBody, prescribed_angle, prescribed_speed,
};

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
