//! Start of the search for a ball's equilibrium.

use crate::members::race_position::InnerRacePosition;
use crate::members::static_ball::{
    BallContacts, BallPlane, contacts_at, inner_centre_in_plane, plane_energy,
};

/// Point from which Newton's method starts, or `None` for a ball with room on both sides.
///
/// Without body force both contacts share one line of action, from the outer race's centre of
/// curvature to the inner race's; the overlap splits on it in a fixed ratio.
pub(crate) fn starting_point(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    evaluations: &mut usize,
) -> Option<[f64; 2]> {
    let outer_room = contacts.outer.groove_radius - contacts.ball_radius;
    let inner_room = contacts.inner.groove_radius - contacts.ball_radius;
    let outer_centre = [contacts.outer.centre_axial, contacts.outer.centre_radius];
    // Point on the line that splits the overlap.
    let split = |line: [f64; 2], overlap: f64| {
        let outer_distance = outer_room + overlap * contacts.outer_share;
        [outer_centre[0] + line[0] * outer_distance, outer_centre[1] + line[1] * outer_distance]
    };
    let mut point = outer_centre;
    let mut line = [0.0, 1.0];
    let mut overlap = 0.0;
    // The second pass starts on the line itself, where the sum of distances is stationary: its error is the square of
    // the first pass's small error.
    for _ in 0..2 {
        *evaluations += 1;
        let centre = inner_centre_in_plane(plane, race, &contacts.inner, point);
        let between = [centre[0] - outer_centre[0], centre[1] - outer_centre[1]];
        let distance = libm::hypot(between[0], between[1]);
        if distance > 0.0 {
            line = [between[0] / distance, between[1] / distance];
        }
        overlap = distance - outer_room - inner_room;
        point = split(line, overlap);
    }
    // Overlaps of balls that just touch (a transition fit without load) have random signs by rounding; a few ulps of
    // the radius are no contact.
    let rounding = 16.0 * f64::EPSILON * contacts.outer.centre_radius;
    if overlap <= rounding {
        // The inner groove of a displaced race leaves the plane of the ball: the distance to it is longer, by the
        // square of that angle, than its part in the plane.
        let (inner, outer) = contacts_at(plane, race, contacts, point);
        let whole = inner.overlap + outer.overlap;
        if whole > rounding {
            overlap = whole;
            point = split(line, overlap);
        }
    }
    // A groove has its ball on one side only: a line towards the axis belongs to races too far apart.
    if overlap > rounding && line[1] > 0.0 {
        if plane.is_forceless() {
            return Some(point);
        }
        let [along, outward] = plane.body_force(point[1]);
        let squeeze =
            contacts.outer_stiffness.min(contacts.inner_stiffness) * overlap * overlap.sqrt();
        if squeeze > 100.0 * libm::hypot(along, outward) {
            return Some(point);
        }
        // The body force may exceed the contact force and decide the position.
        let resting = resting_place(plane, race, contacts, point, evaluations);
        *evaluations += 4;
        let energy = |at| plane_energy(plane, race, contacts, at).energy;
        return Some(if energy(resting) < energy(point) { resting } else { point });
    }
    if plane.is_forceless() {
        return None;
    }
    Some(resting_place(plane, race, contacts, point, evaluations))
}

/// Position of an open ball under its body force: on the outer race, on the inner race, or in the wedge between them.
/// Exact for parallel races, except for the inner race's tilt.
///
/// Newton's method needs this accurate start: a ball under its weight alone is a million times softer along the groove
/// than across it.
fn resting_place(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    middle: [f64; 2],
    evaluations: &mut usize,
) -> [f64; 2] {
    let outer_centre = [contacts.outer.centre_axial, contacts.outer.centre_radius];
    let rooms = [
        contacts.outer.groove_radius - contacts.ball_radius,
        contacts.inner.groove_radius - contacts.ball_radius,
    ];
    let stiffnesses = [contacts.outer_stiffness, contacts.inner_stiffness];
    let sink = |load: f64, stiffness: f64| libm::cbrt(load / stiffness).powi(2);
    let mut best = (f64::INFINITY, middle);
    for side in 0..2 {
        // The normal is the force's direction; centre and force depend slightly on the position.
        let mut point = middle;
        for _ in 0..4 {
            *evaluations += 1;
            let [along, outward] = plane.body_force(point[1]);
            let force = libm::hypot(along, outward);
            if force == 0.0 {
                break;
            }
            let centre = if side == 0 {
                outer_centre
            } else {
                inner_centre_in_plane(plane, race, &contacts.inner, point)
            };
            let reach = (rooms[side] + sink(force, stiffnesses[side])) / force;
            point = [centre[0] + along * reach, centre[1] + outward * reach];
        }
        *evaluations += 2;
        let there = plane_energy(plane, race, contacts, point);
        if there.energy < best.0 {
            best = (there.energy, point);
        }
    }
    if let Some(point) = wedge(plane, race, contacts, outer_centre, rooms, best.1, evaluations) {
        *evaluations += 2;
        let there = plane_energy(plane, race, contacts, point);
        if there.energy < best.0 {
            best = (there.energy, point);
        }
    }
    best.1
}

/// A ball in the wedge between both races: distances from both centres of curvature are free play plus overlap, with
/// overlaps from the balance with the body force.
fn wedge(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    outer_centre: [f64; 2],
    rooms: [f64; 2],
    start: [f64; 2],
    evaluations: &mut usize,
) -> Option<[f64; 2]> {
    let mut point = start;
    let mut overlaps = [0.0; 2];
    for _ in 0..30 {
        *evaluations += 1;
        let inner_centre = inner_centre_in_plane(plane, race, &contacts.inner, point);
        let line = [inner_centre[0] - outer_centre[0], inner_centre[1] - outer_centre[1]];
        let distance = libm::hypot(line[0], line[1]);
        let along = [line[0] / distance, line[1] / distance];
        let (outer, inner) = (rooms[0] + overlaps[0], rooms[1] + overlaps[1]);
        let foot = (outer * outer - inner * inner + distance * distance) / (2.0 * distance);
        let square = outer * outer - foot * foot;
        // Written so that NaN returns here too.
        if square.is_nan() || square <= 0.0 {
            return None;
        }
        let force = plane.body_force(point[1]);
        // Of the two corners the one in the direction of the force.
        let aside = [-along[1], along[0]];
        let sign = if force[0] * aside[0] + force[1] * aside[1] < 0.0 { -1.0 } else { 1.0 };
        let height = sign * square.sqrt();
        point = [
            outer_centre[0] + foot * along[0] + height * aside[0],
            outer_centre[1] + foot * along[1] + height * aside[1],
        ];
        let to = |centre: [f64; 2], reach: f64| {
            [(point[0] - centre[0]) / reach, (point[1] - centre[1]) / reach]
        };
        let (n, m) = (to(outer_centre, outer), to(inner_centre, inner));
        let determinant = n[0] * m[1] - n[1] * m[0];
        let loads = [
            (force[0] * m[1] - force[1] * m[0]) / determinant,
            (n[0] * force[1] - n[1] * force[0]) / determinant,
        ];
        if !(loads[0] > 0.0 && loads[1] > 0.0) {
            return None;
        }
        overlaps = [
            libm::cbrt(loads[0] / contacts.outer_stiffness).powi(2),
            libm::cbrt(loads[1] / contacts.inner_stiffness).powi(2),
        ];
    }
    Some(point)
}
