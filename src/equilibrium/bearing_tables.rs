//! Results of each bearing in an equilibrium, ball by ball.

use crate::ch2_housing::bearing::contact::MeridianContact;
use crate::ch2_housing::bearing::hertz::{HertzContact, contact_ellipse};
use crate::equilibrium::lists::StaticBearing;
use crate::equilibrium::model::{BearingModel, Evaluation, Model};
use crate::equilibrium::statics::{BallState, ContactState};
use crate::members::race_position::InnerRacePosition;
use crate::members::static_ball::{BallPlane, SettledBall, contacts_at, inner_centre_in_plane};
use nalgebra::Vector3;

/// One bearing in equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct BearingState {
    /// Sum of contact forces on each race (inner, outer) and their moments about its centre, in the frame of
    /// the assembly, N and N·m.
    pub forces: [Vector3<f64>; 2],
    pub moments: [Vector3<f64>; 2],
    /// Centres of both races, m.
    pub centres: [Vector3<f64>; 2],
    pub balls: Vec<BallState>,
}

pub(crate) fn bearing_state(model: &Model, here: &Evaluation, index: usize) -> BearingState {
    let bearing = &model.assembly.bearings[index];
    let of = &model.bearings[index];
    let race = model.race(index, 0, &here.at);
    let planes = here.planes(model, index);
    let mut forces = [Vector3::zeros(); 2];
    let mut moments = [Vector3::zeros(); 2];
    let mut balls = Vec::with_capacity(planes.len());
    for ((plane, azimuth), settled) in planes.iter().zip(&of.azimuths).zip(&here.balls[index]) {
        let ball = ball_state(bearing, of, plane, *azimuth, &race, settled.as_ref());
        forces[0] += ball.inner.force_on_race;
        forces[1] += ball.outer.force_on_race;
        moments[0] += (ball.position - race.centre).cross(&ball.inner.force_on_race);
        moments[1] += (ball.position - plane.origin).cross(&ball.outer.force_on_race);
        balls.push(BallState { position: ball.position + of.origin, ..ball });
    }
    let outer = planes.first().map_or(Vector3::zeros(), |plane| plane.origin);
    BearingState { forces, moments, centres: [race.centre + of.origin, outer + of.origin], balls }
}

fn ball_state(
    bearing: &StaticBearing,
    of: &BearingModel,
    plane: &BallPlane,
    azimuth: f64,
    race: &InnerRacePosition,
    settled: Option<&SettledBall>,
) -> BallState {
    let contacts = &of.contacts;
    // An unloaded ball may be anywhere in its free play; it is shown in the middle.
    let in_plane = match settled {
        Some(ball) => ball.position,
        None => middle_of_room(of, plane, race),
    };
    let position = plane.origin + plane.axial * in_plane[0] + plane.radial * in_plane[1];
    let (inner_contact, outer_contact) = contacts_at(plane, race, contacts, in_plane);
    let (inner_load, outer_load) =
        settled.map_or((0.0, 0.0), |ball| (ball.inner_load, ball.outer_load));
    let arm = position - race.centre;
    let radial = (arm - race.axis * race.axis.dot(&arm)).normalize();
    let inner_normal = race.axis * inner_contact.normal[0] + radial * inner_contact.normal[1];
    let outer_normal =
        plane.axial * outer_contact.normal[0] + plane.radial * outer_contact.normal[1];
    let inner_angle = libm::atan2(-inner_contact.normal[0], -inner_contact.normal[1]);
    let outer_angle = libm::atan2(outer_contact.normal[0], outer_contact.normal[1]);
    let inner = contact_state(
        &bearing.inner_contact,
        &inner_contact,
        inner_load,
        inner_angle,
        inner_normal,
    );
    let outer = contact_state(
        &bearing.outer_contact,
        &outer_contact,
        outer_load,
        outer_angle,
        outer_normal,
    );
    let around = plane.axial.cross(&plane.radial);
    let contact_force = (inner.force_on_race + outer.force_on_race).dot(&around);
    let cage_force = contact_force - plane.weight_around;
    BallState { azimuth, position, inner, outer, cage_force }
}

fn middle_of_room(of: &BearingModel, plane: &BallPlane, race: &InnerRacePosition) -> [f64; 2] {
    let contacts = &of.contacts;
    let outer = [contacts.outer.centre_axial, contacts.outer.centre_radius];
    let inner = inner_centre_in_plane(plane, race, &contacts.inner, outer);
    let outer_room = contacts.outer.groove_radius - contacts.ball_radius;
    let inner_room = contacts.inner.groove_radius - contacts.ball_radius;
    let share = outer_room / (outer_room + inner_room);
    [outer[0] + share * (inner[0] - outer[0]), outer[1] + share * (inner[1] - outer[1])]
}

fn contact_state(
    hertz: &HertzContact,
    contact: &MeridianContact,
    normal_load: f64,
    contact_angle: f64,
    normal: Vector3<f64>,
) -> ContactState {
    let ellipse = contact_ellipse(hertz, normal_load);
    ContactState {
        normal_load,
        approach: contact.overlap,
        contact_angle,
        semi_major: ellipse.semi_major,
        semi_minor: ellipse.semi_minor,
        peak_pressure: ellipse.peak_pressure,
        force_on_race: normal * normal_load,
    }
}
