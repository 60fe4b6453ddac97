//! Start of the search for a static equilibrium, and its first trust radius.

use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::{HertzContact, series_stiffness};
use crate::members::static_ball::BallContacts;
use nalgebra::{SVector, Vector3};

pub(crate) fn ball_contacts(
    geometry: &BearingGeometry,
    inner_contact: &HertzContact,
    outer_contact: &HertzContact,
) -> BallContacts {
    let (inner, outer) = (inner_contact.stiffness, outer_contact.stiffness);
    // Equal loads: δ_outer/δ_inner = (K_inner/K_outer)^{2/3}.
    let ratio = libm::cbrt(inner / outer).powi(2);
    BallContacts {
        ball_radius: geometry.ball_radius,
        inner: geometry.inner,
        outer: geometry.outer,
        inner_stiffness: inner,
        outer_stiffness: outer,
        outer_share: ratio / (1.0 + ratio),
    }
}

/// First trust radius, m: the clearance, and the overlap by a force (N) and a moment (N·m) on a bearing and by its
/// preload.
pub(crate) fn step_scale(
    geometry: &BearingGeometry,
    contacts: &BallContacts,
    force: f64,
    moment: f64,
) -> f64 {
    let total = force + moment / geometry.pitch_radius;
    let stiffness = series_stiffness(contacts.inner_stiffness, contacts.outer_stiffness);
    let overlap = libm::cbrt(total / stiffness).powi(2);
    let room = geometry.radial_clearance.abs();
    // A bearing with preload or without load needs a step of visible size too: 1e-4 ball radii.
    4.0 * (overlap + room).max(1e-4 * contacts.ball_radius)
}

/// Cold start: the position under the axial load alone, if there is one, plus the radial displacement under the radial
/// load alone at this clearance (Stribeck's estimate: the most loaded ball carries 5 F/(Z cos α)).
pub(crate) fn guess(
    geometry: &BearingGeometry,
    contacts: &BallContacts,
    loads: &[f64; 5],
    origin: &Vector3<f64>,
) -> SVector<f64, 5> {
    let stiffness = series_stiffness(contacts.inner_stiffness, contacts.outer_stiffness);
    let balls = geometry.ball_count as f64;
    let mut start = SVector::zeros();
    for i in 0..3 {
        start[i] = origin[i];
    }
    let radial = libm::hypot(loads[1], loads[2]);
    if loads[0].abs() > 0.1 * radial {
        start[0] += axial_position(contacts, loads[0] / balls, stiffness);
    }
    if radial > 0.0 {
        let cos_angle = libm::cos(geometry.contact_angle);
        let overlap =
            libm::cbrt(5.0 * radial / (balls * cos_angle * stiffness)).powi(2) / cos_angle;
        let shift = geometry.radial_clearance.max(0.0) + overlap;
        start[1] += shift * loads[1] / radial;
        start[2] += shift * loads[2] / radial;
    }
    start
}

/// Axial position at which every ball carries the same axial force (N a ball).
fn axial_position(contacts: &BallContacts, force: f64, stiffness: f64) -> f64 {
    let room =
        contacts.inner.groove_radius + contacts.outer.groove_radius - 2.0 * contacts.ball_radius;
    let axial = contacts.inner.centre_axial - contacts.outer.centre_axial;
    let radial = contacts.inner.centre_radius - contacts.outer.centre_radius;
    let force_at = |x: f64| {
        let distance = libm::hypot(axial + x, radial);
        let overlap = (distance - room).max(0.0);
        stiffness * overlap * overlap.sqrt() * (axial + x) / distance
    };
    // The force is monotonic on either side of its zero range; a coarse bisection suffices.
    let (mut low, mut high) = (-room - axial, room - axial);
    let reach = 4.0 * room;
    if force > 0.0 {
        low = -axial;
        high = reach;
    } else {
        high = high.min(-axial);
        low = low.min(-reach);
    }
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if force_at(middle) < force { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
