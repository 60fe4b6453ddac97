//! Equilibrium of one ball between two races, and its load on the races.
//!
//! The ball stays in the meridian plane of the outer race at its azimuth, where the cage keeps it; its axial and radial
//! position in that plane are the two unknowns. The energy of frictionless contacts depends on them through the
//! meridian coordinates of each race alone.

use crate::ch2_housing::bearing::contact::{
    MeridianContact, meridian_contact, normal_load, normal_stiffness, strain_energy,
};
use crate::ch2_housing::bearing::geometry::Raceway;
use crate::members::race_position::InnerRacePosition;
use crate::members::static_ball_start::starting_point;
use nalgebra::Vector3;

/// Meridian plane of the outer race with a ball, in the frame of the inner race's coordinates.
#[derive(Clone, Copy, Debug)]
pub struct BallPlane {
    /// Centre of the outer race, m.
    pub origin: Vector3<f64>,
    /// Unit vector along the outer race's axis.
    pub axial: Vector3<f64>,
    /// Unit vector from that axis towards the ball.
    pub radial: Vector3<f64>,
    /// Axial and radial part of the ball's weight, N.
    pub weight: [f64; 2],
    /// Circumferential component, which the cage carries, N.
    pub weight_around: f64,
    /// mω²: centrifugal force per distance from the axis, N/m.
    pub centrifugal: f64,
}

impl BallPlane {
    /// Axial and radial force on a ball in addition to its contacts, N.
    pub(crate) fn body_force(&self, radial: f64) -> [f64; 2] {
        [self.weight[0], self.weight[1] + self.centrifugal * radial]
    }

    pub(crate) fn is_forceless(&self) -> bool {
        self.weight == [0.0; 2] && self.centrifugal == 0.0
    }
}

/// Constants of both contacts of every ball.
#[derive(Clone, Copy, Debug)]
pub struct BallContacts {
    pub ball_radius: f64,
    pub inner: Raceway,
    pub outer: Raceway,
    /// K_H of (2.1), N/m^1.5.
    pub inner_stiffness: f64,
    pub outer_stiffness: f64,
    /// δ_outer/(δ_inner + δ_outer) of two contacts in series under the same load.
    pub outer_share: f64,
}

/// Energy, slope and curvature of one contact in the race's meridian coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactEnergy {
    contact: MeridianContact,
    load: f64,
    energy: f64,
    pub(crate) slope: [f64; 2],
    /// Second derivatives: axial–axial, axial–radial, radial–radial.
    pub(crate) curvature: [f64; 3],
}

fn contact_energy(
    axial: f64,
    radial: f64,
    raceway: &Raceway,
    ball_radius: f64,
    stiffness: f64,
) -> ContactEnergy {
    let contact = meridian_contact(axial, radial, raceway, ball_radius);
    let load = normal_load(stiffness, contact.overlap);
    if load == 0.0 {
        return ContactEnergy { contact, load, energy: 0.0, slope: [0.0; 2], curvature: [0.0; 3] };
    }
    let [na, nr] = contact.normal;
    let along = normal_stiffness(stiffness, contact.overlap);
    // The swivel stiffness of a load of constant size whose direction follows the ball.
    let across = load / contact.centre_distance;
    ContactEnergy {
        contact,
        load,
        energy: strain_energy(stiffness, contact.overlap),
        slope: [load * na, load * nr],
        curvature: [
            along * na * na + across * nr * nr,
            (along - across) * na * nr,
            along * nr * nr + across * na * na,
        ],
    }
}

/// Energy of a ball at a position in its plane on the outer race.
pub(crate) fn outer_energy(contacts: &BallContacts, position: [f64; 2]) -> ContactEnergy {
    let [axial, radial] = position;
    let BallContacts { outer, ball_radius, outer_stiffness, .. } = contacts;
    contact_energy(axial, radial, outer, *ball_radius, *outer_stiffness)
}

/// Energy of a ball on the inner race, at this relative position.
pub(crate) fn inner_energy(contacts: &BallContacts, seen: &Sighting) -> ContactEnergy {
    let BallContacts { inner, ball_radius, inner_stiffness, .. } = contacts;
    contact_energy(seen.axial, seen.radial, inner, *ball_radius, *inner_stiffness)
}

/// Position of a ball relative to the inner race.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sighting {
    /// Vector from the race's centre to the ball centre.
    pub(crate) arm: Vector3<f64>,
    pub(crate) axial: f64,
    pub(crate) radial: f64,
}

pub(crate) fn sight(plane: &BallPlane, race: &InnerRacePosition, position: [f64; 2]) -> Sighting {
    let arm = plane.origin + plane.axial * position[0] + plane.radial * position[1] - race.centre;
    let axial = race.axis.dot(&arm);
    let radial = (arm.norm_squared() - axial * axial).sqrt();
    Sighting { arm, axial, radial }
}

/// One ball in equilibrium.
#[derive(Clone, Copy, Debug)]
pub struct SettledBall {
    /// Axial and radial position in the ball's plane, m.
    pub position: [f64; 2],
    pub inner: MeridianContact,
    pub outer: MeridianContact,
    pub inner_load: f64,
    pub outer_load: f64,
    /// Contact energy minus the work of the body force, J.
    pub energy: f64,
    /// Force residual of the ball in its plane over the largest force on it; rounding when converged.
    pub unbalance: f64,
}

/// The two-dimensional energy of a ball with slope and curvature in its plane.
pub(crate) struct PlaneEnergy {
    inner: ContactEnergy,
    outer: ContactEnergy,
    pub(crate) energy: f64,
    slope: [f64; 2],
    curvature: [f64; 3],
}

pub(crate) fn plane_energy(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    position: [f64; 2],
) -> PlaneEnergy {
    let outer = outer_energy(contacts, position);
    let seen = sight(plane, race, position);
    let inner = inner_energy(contacts, &seen);
    let force = plane.body_force(position[1]);
    let mut slope = [outer.slope[0] - force[0], outer.slope[1] - force[1]];
    let mut curvature = outer.curvature;
    curvature[2] -= plane.centrifugal;
    if inner.load > 0.0 {
        // Chain rule from the meridian coordinates (axial h, radial ρ) of the inner race:
        // ρ∇ρ = arm·∇arm − h∇h, and ρ∇²ρ = ∇arm·∇arm − ∇h∇h − ∇ρ∇ρ for a plane of unit vectors.
        let h = [race.axis.dot(&plane.axial), race.axis.dot(&plane.radial)];
        let rho = [
            (seen.arm.dot(&plane.axial) - seen.axial * h[0]) / seen.radial,
            (seen.arm.dot(&plane.radial) - seen.axial * h[1]) / seen.radial,
        ];
        let [c_hh, c_hr, c_rr] = inner.curvature;
        let bend = inner.slope[1] / seen.radial;
        for i in 0..2 {
            slope[i] += inner.slope[0] * h[i] + inner.slope[1] * rho[i];
        }
        for (entry, (i, j)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
            let unit = if i == j { 1.0 } else { 0.0 };
            curvature[entry] += (c_hh - bend) * h[i] * h[j]
                + c_hr * (h[i] * rho[j] + rho[i] * h[j])
                + (c_rr - bend) * rho[i] * rho[j]
                + bend * unit;
        }
    }
    let work = plane.weight[0] * position[0]
        + (plane.weight[1] + 0.5 * plane.centrifugal * position[1]) * position[1];
    PlaneEnergy { energy: inner.energy + outer.energy - work, inner, outer, slope, curvature }
}

/// Equilibrium of the ball for a given position of the inner race.
///
/// `None` for an open ball without body force, which costs the distance test.
pub fn settle(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    evaluations: &mut usize,
) -> Option<SettledBall> {
    let start = starting_point(plane, race, contacts, evaluations)?;
    let ball = minimise(plane, race, contacts, start, evaluations);
    let unloaded = ball.inner_load == 0.0 && ball.outer_load == 0.0;
    if unloaded && plane.is_forceless() { None } else { Some(ball) }
}

/// Sum of both overlaps for a ball on the line between the groove centres, m, and the angle of that line to the outer
/// race's radial plane, rad.
pub fn overlap_of_races(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
) -> (f64, f64) {
    let outer = [contacts.outer.centre_axial, contacts.outer.centre_radius];
    let inner = inner_centre_in_plane(plane, race, &contacts.inner, outer);
    let line = [inner[0] - outer[0], inner[1] - outer[1]];
    let rooms =
        contacts.outer.groove_radius + contacts.inner.groove_radius - 2.0 * contacts.ball_radius;
    (libm::hypot(line[0], line[1]) - rooms, libm::atan2(line[0], line[1]))
}

/// Centre of curvature of the inner groove relative to the plane of a ball at `point`, m.
pub fn inner_centre_in_plane(
    plane: &BallPlane,
    race: &InnerRacePosition,
    raceway: &Raceway,
    point: [f64; 2],
) -> [f64; 2] {
    let seen = sight(plane, race, point);
    let h = [race.axis.dot(&plane.axial), race.axis.dot(&plane.radial)];
    let rho = [
        (seen.arm.dot(&plane.axial) - seen.axial * h[0]) / seen.radial,
        (seen.arm.dot(&plane.radial) - seen.axial * h[1]) / seen.radial,
    ];
    let away = [seen.axial - raceway.centre_axial, seen.radial - raceway.centre_radius];
    [point[0] - away[0] * h[0] - away[1] * rho[0], point[1] - away[0] * h[1] - away[1] * rho[1]]
}

/// Contacts of a ball at a given position with the inner and the outer race.
pub fn contacts_at(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    position: [f64; 2],
) -> (MeridianContact, MeridianContact) {
    let seen = sight(plane, race, position);
    let radius = contacts.ball_radius;
    (
        meridian_contact(seen.axial, seen.radial, &contacts.inner, radius),
        meridian_contact(position[0], position[1], &contacts.outer, radius),
    )
}

/// Newton's method on the ball's two coordinates, each step shortened until the energy falls.
fn minimise(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    start: [f64; 2],
    evaluations: &mut usize,
) -> SettledBall {
    let [along, outward] = plane.body_force(start[1]);
    let body = along.abs().max(outward.abs());
    let radius = contacts.outer.centre_radius;
    let mut position = start;
    let mut now = plane_energy(plane, race, contacts, position);
    *evaluations += 2;
    for _ in 0..60 {
        let unbalance = now.slope[0].abs().max(now.slope[1].abs());
        let scale = now.inner.load.max(now.outer.load).max(body);
        // Rounding of the overlaps.
        let noise_force = 4.0 * f64::EPSILON * radius * (now.curvature[0] + now.curvature[2]);
        if unbalance <= 1e-11 * scale + noise_force {
            break;
        }
        let step = newton_step(&now.slope, &now.curvature);
        // Quadratic convergence: one more step from here is the last, without a check.
        if unbalance <= 1e-7 * scale {
            position = [position[0] + step[0], position[1] + step[1]];
            now = plane_energy(plane, race, contacts, position);
            *evaluations += 2;
            break;
        }
        let mut fraction = 1.0;
        let mut accepted = None;
        for _ in 0..40 {
            let trial = [position[0] + fraction * step[0], position[1] + fraction * step[1]];
            let there = plane_energy(plane, race, contacts, trial);
            *evaluations += 2;
            let calmer = there.slope[0].abs().max(there.slope[1].abs()) < unbalance;
            let noise = energy_noise(scale.max(there.inner.load).max(there.outer.load), radius);
            let change = there.energy - now.energy;
            if change < -noise || (calmer && change <= noise) {
                accepted = Some((trial, there));
                break;
            }
            fraction *= 0.5;
        }
        match accepted {
            Some((trial, there)) => (position, now) = (trial, there),
            None => break,
        }
    }
    let scale = now.inner.load.max(now.outer.load).max(body);
    let noise = 4.0 * f64::EPSILON * radius * (now.curvature[0] + now.curvature[2]);
    // The load of an overlap of some ulps is rounding too, as for the weight of a ball at the height of the axis.
    let rounding_load = normal_load(contacts.outer_stiffness, 256.0 * f64::EPSILON * radius);
    let left = (now.slope[0].abs().max(now.slope[1].abs()) - noise - rounding_load).max(0.0);
    SettledBall {
        position,
        inner: now.inner.contact,
        outer: now.outer.contact,
        inner_load: now.inner.load,
        outer_load: now.outer.load,
        energy: now.energy,
        unbalance: if scale > 0.0 { left / scale } else { 0.0 },
    }
}

/// Rounding of the energy by an overlap of some ulps of the distance from the axis, J.
pub fn energy_noise(load: f64, radius: f64) -> f64 {
    16.0 * f64::EPSILON * radius * load
}

/// −H⁻¹g; if the curvature is not positive definite (no contact), a step of the free play along the force.
fn newton_step(slope: &[f64; 2], curvature: &[f64; 3]) -> [f64; 2] {
    let determinant = curvature[0] * curvature[2] - curvature[1] * curvature[1];
    let trace = curvature[0] + curvature[2];
    if determinant > 1e-14 * trace * trace && trace > 0.0 {
        return [
            -(curvature[2] * slope[0] - curvature[1] * slope[1]) / determinant,
            -(curvature[0] * slope[1] - curvature[1] * slope[0]) / determinant,
        ];
    }
    let size = libm::hypot(slope[0], slope[1]);
    [-1e-4 * slope[0] / size, -1e-4 * slope[1] / size]
}
