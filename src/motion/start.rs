//! Start of a simulation: rolling in equilibrium, or in nominal positions.

use crate::assembly::lists::Assembly;
use crate::assembly::places::Places;
use crate::assembly::prescribed::{orbital_speed, race_speeds};
use crate::assembly::section_attachments::SectionAttachments;
use crate::ch2_housing::bearing::cage::Guidance;
use crate::equilibrium::initial::at_start;
use crate::equilibrium::statics::StaticsError;
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, norm, scale, sub};
use crate::members::bearing::Bearing;
use crate::members::body::{Drive, prescribed_speed};
use crate::members::rigid_body;
use crate::members::rigid_body::BodyKinematics;
use crate::members::section_attachment::kinematics_at_attachment;
use crate::members::state::{BODY, BodyState, Layout};
use crate::motion::rolling_velocity;
use crate::motion::rolling_velocity::Rates;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// State vector in equilibrium of all bodies under the loads at t = 0, with balls and cages rolling and all velocities
/// those of the moving equilibrium (see [`rolling_velocity`]). Rotating bodies are at rest for the equilibrium itself
/// (see [`at_start`]).
///
/// Bodies in solids start at their rest positions, the others in equilibrium with them; solids start at rest as in
/// their `start`.
///
/// # Errors
///
/// No equilibrium under the loads at t = 0.
pub fn at_equilibrium(assembly: &Assembly) -> Result<Vec<f64>, StaticsError> {
    if !assembly.solids.is_empty() {
        let held = at_equilibrium(&assembly.with_seats_fixed())?;
        return Ok(with_solids(assembly, &held));
    }
    let now = at_start(assembly)?;
    let rates = rolling_velocity::rates(assembly, &now);
    let bodies: Vec<[f64; 5]> =
        (0..assembly.bodies.len()).map(|body| now.place(assembly, body)).collect();
    let positions: Vec<Vec<Vec3>> = now
        .bearings
        .iter()
        .map(|bearing| bearing.balls.iter().map(|ball| ball.position.into()).collect())
        .collect();
    Ok(fill(assembly, &bodies, Some((&positions, &now.amplitudes)), &rates))
}

/// State vector with all bodies in nominal positions, balls and cages rolling at the given speeds; loads act suddenly.
pub fn nominal(assembly: &Assembly) -> Vec<f64> {
    let place = |body: &crate::members::body::Body| {
        let mut at = body.rest;
        if let Some(race) = body.driven() {
            for (coordinate, drive) in at.iter_mut().zip(&race.drives) {
                if let Drive::Motion(profile) = drive {
                    *coordinate = profile.value(0.0);
                }
            }
        }
        at
    };
    let bodies: Vec<[f64; 5]> = assembly.bodies.iter().map(place).collect();
    with_solids(assembly, &fill(assembly, &bodies, None, &Rates::rest(assembly)))
}

/// Inserts solids into a state without them, before the ledger.
fn with_solids(assembly: &Assembly, state: &[f64]) -> Vec<f64> {
    let places = Places::of(assembly);
    let mut whole = vec![0.0; places.state_len()];
    let bodies = places.body(assembly.bodies.len());
    whole[..bodies].copy_from_slice(&state[..bodies]);
    let bent = Places::of(&assembly.with_seats_fixed()).shafts(assembly);
    for ((shaft, from), to) in assembly.shafts.iter().zip(bent).zip(places.shafts(assembly)) {
        whole[to..to + shaft.entries()].copy_from_slice(&state[from..from + shaft.entries()]);
    }
    for (solid, at) in assembly.solids.iter().zip(places.solids(assembly)) {
        whole[at..at + solid.start.len()].copy_from_slice(&solid.start);
    }
    whole
}

/// Positions of a bearing's balls on the pitch circle of its outer race.
fn on_pitch_circle(bearing: &Bearing, outer: &BodyKinematics) -> Vec<Vec3> {
    let g = &bearing.geometry;
    let turn = outer.state.orientation;
    let position = |ball: usize| {
        let angle = bearing.ball_phase + TAU * ball as f64 / g.ball_count as f64;
        let (sin, cos) = libm::sincos(angle);
        let local = Vector3::new(0.0, g.pitch_radius * cos, g.pitch_radius * sin);
        add(outer.state.position, (turn * local).into())
    };
    (0..g.ball_count).map(position).collect()
}

/// Positions of the balls of each bearing, amplitudes of each shaft.
type Known<'k> = (&'k [Vec<Vec3>], &'k [Vec<f64>]);

/// The state with bodies at these coordinates; `None`: balls on their pitch circles and straight shafts.
fn fill(assembly: &Assembly, bodies: &[[f64; 5]], known: Option<Known>, rates: &Rates) -> Vec<f64> {
    let places = Places::of(assembly);
    let mut state = vec![0.0; places.state_len()];
    let write = |state: &mut [f64], at: usize, body: &BodyState| {
        state[at..at + BODY].copy_from_slice(&body.to_array());
    };
    let mut now = Vec::with_capacity(bodies.len());
    for (index, (body, at)) in assembly.bodies.iter().zip(bodies).enumerate() {
        let moved = moving(at, &rates.bodies[index], prescribed_speed(body, 0.0));
        write(&mut state, places.body(index), &moved);
        now.push(BodyKinematics::new(moved));
    }
    let shafts = places.shafts(assembly);
    for (index, (shaft, at)) in assembly.shafts.iter().zip(&shafts).enumerate() {
        let (gone, speed) = state[*at..*at + shaft.entries()].split_at_mut(shaft.amplitudes());
        if let Some((_, amplitudes)) = known {
            gone.copy_from_slice(&amplitudes[index]);
        }
        speed.copy_from_slice(&rates.shafts[index]);
    }
    let mut holds = SectionAttachments::new(assembly, &now);
    holds.place(assembly, &shafts, &now, &state);
    for (index, (bearing, layout)) in assembly.bearings.iter().zip(Layout::of(assembly)).enumerate()
    {
        let [inner, outer] = [0, 1].map(|side| {
            let mount = &bearing.mounts[side];
            kinematics_at_attachment(&holds.bearings[index][side], &now[mount.body], mount)
        });
        let orbital_speed = orbital_speed(assembly, bearing, 0.0);
        let at_rest = on_pitch_circle(bearing, &outer);
        let positions = known.map_or(&at_rest, |(positions, _)| &positions[index]);
        // Rotation with the tilts of the outer race, not about its axis.
        let axis = outer.motion.axis;
        let [_, outer_speed] = race_speeds(assembly, bearing, 0.0);
        let tilting = if outer_speed == 0.0 {
            outer.state.spin
        } else {
            add_scaled(outer.state.spin, -outer_speed, axis)
        };
        if layout.has_cage {
            let mut cage = outer.state;
            if let Some(law) = &bearing.cage {
                if law.contacts.guidance == Guidance::InnerRace {
                    (cage.position, cage.orientation) =
                        (inner.state.position, inner.state.orientation);
                }
                let along: Vec<f64> =
                    positions.iter().map(|at| dot(sub(*at, cage.position), axis)).collect();
                cage.position = add_scaled(cage.position, among(&along, law.room(bearing)), axis);
            }
            cage.spin = add_scaled(tilting, orbital_speed, axis);
            write(&mut state, layout.cage(), &cage);
        }
        for (ball, position) in positions.iter().enumerate() {
            let mut body = BodyState::at_rest(*position);
            let from_axis = sub(*position, outer.motion.position);
            let outward = add_scaled(from_axis, -dot(from_axis, axis), axis);
            let with_outer = add(outer.motion.velocity, cross(tilting, from_axis));
            let [along, away] = rates.balls[index][ball];
            let own = add_scaled(scale(axis, along), away / norm(outward), outward);
            body.velocity = add(cross(scale(axis, orbital_speed), outward), add(with_outer, own));
            body.spin = rolling_spin(bearing, [&inner, &outer], outer_speed, &body, outward);
            layout.set_ball(&mut state, ball, &body);
        }
        // Lanes beyond the last ball hold a ball in the groove that is never evaluated.
        for ball in layout.balls..layout.padded {
            layout.set_ball(&mut state, ball, &BodyState::at_rest(positions[0]));
        }
    }
    state
}

/// Position of a cage along its axis from the middle of its bearing (m) for these axial positions of the balls: in the
/// middle if all balls have room there, otherwise among the balls, as in an angular-contact bearing loaded the wrong
/// way.
fn among(balls: &[f64], room: f64) -> f64 {
    let least = balls.iter().copied().fold(f64::INFINITY, f64::min);
    let most = balls.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if most.max(-least) <= room { 0.0 } else { 0.5 * (least + most) }
}

/// A race at x, y, z, tilt_y, tilt_z, with these coordinates changing at `rates`, rotating at `speed`.
fn moving(at: &[f64; 5], rates: &[f64; 5], speed: f64) -> BodyState {
    let now = rigid_body::fixed(at);
    let mut body = now.state;
    let axis = body.axis();
    let [e2, e3] = now.tilt_directions;
    body.velocity = [rates[0], rates[1], rates[2]];
    let tilting = add_scaled(scale(e2, rates[3] * now.cos_lambda), rates[4], e3);
    body.spin = add_scaled(tilting, speed, axis);
    body
}

/// Spin without slip on both races, about the meridian direction across the line from the outer to the inner contact.
fn rolling_spin(
    bearing: &Bearing,
    [inner, outer]: [&BodyKinematics; 2],
    outer_speed: f64,
    ball: &BodyState,
    outward: Vec3,
) -> Vec3 {
    let angle = bearing.geometry.contact_angle;
    let axis = outer.motion.axis;
    let out = scale(outward, 1.0 / norm(outward));
    let (sin, cos) = libm::sincos(angle);
    let normal = add_scaled(scale(out, cos), sin, axis);
    let tangent = cross(axis, out);
    let roll_axis = cross(tangent, normal);
    let radius = bearing.geometry.ball_radius;
    let inner_point = scale(normal, -radius);
    let surface = |race: &BodyKinematics, point: Vec3| {
        let arm = sub(add(ball.position, point), race.motion.position);
        dot(add(race.motion.velocity, cross(race.motion.spin, arm)), tangent)
    };
    let mut difference = surface(inner, inner_point);
    if outer_speed != 0.0 {
        difference -= surface(outer, scale(inner_point, -1.0));
    }
    // Centre plus spin × arm on either side: half of the difference of the surface velocities.
    let half_difference = 0.5 * difference;
    let per_spin = dot(cross(roll_axis, inner_point), tangent);
    scale(roll_axis, half_difference / per_spin)
}
