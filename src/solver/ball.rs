//! Equilibrium of one ball between two races, and what the races feel of it.
//!
//! The ball stays in the meridian plane of the outer race at its azimuth (the cage keeps it
//! there); its axial and radial position in that plane are the two unknowns. Frictionless contacts
//! make the energy depend on them through the meridian coordinates of each race alone.

use super::ball_start::starting_point;
use super::mount::Mount;
use crate::ch2_housing::bearing::contact::{
    MeridianContact, meridian_contact, normal_load, normal_stiffness, strain_energy,
};
use crate::ch2_housing::bearing::geometry::Raceway;
use crate::kinematics::Pose;
use nalgebra::{SMatrix, SVector, Vector3};

/// The outer race's meridian plane that holds a ball, in the frame of the inner race's coordinates.
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
    /// Its part along the circumference, which the cage takes, N.
    pub weight_around: f64,
    /// mω²: centrifugal force per distance from the axis, N/m.
    pub centrifugal: f64,
}

impl BallPlane {
    /// Axial and radial part of what acts on a ball besides its contacts, N.
    pub(super) fn body_force(&self, radial: f64) -> [f64; 2] {
        [self.weight[0], self.weight[1] + self.centrifugal * radial]
    }

    pub(super) fn is_forceless(&self) -> bool {
        self.weight == [0.0; 2] && self.centrifugal == 0.0
    }
}

/// What both contacts of every ball have in common.
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

/// Position of the inner race and its derivatives with respect to the two tilts.
#[derive(Clone, Copy, Debug)]
pub struct InnerRacePosition {
    pub centre: Vector3<f64>,
    /// Unit vector along the race's axis: (cos λ cos ξ, sin λ, −cos λ sin ξ).
    pub axis: Vector3<f64>,
    axis_xi: Vector3<f64>,
    axis_lambda: Vector3<f64>,
    axis_xi_xi: Vector3<f64>,
    axis_xi_lambda: Vector3<f64>,
}

impl InnerRacePosition {
    /// From x, y, z (m), tilt_y = ξ, tilt_z = λ (rad), the Euler angles of (2.16) with η = 0.
    pub fn new(coordinates: &SVector<f64, 5>) -> Self {
        let (sin_xi, cos_xi) = libm::sincos(coordinates[3]);
        let (sin_lambda, cos_lambda) = libm::sincos(coordinates[4]);
        InnerRacePosition {
            centre: Vector3::new(coordinates[0], coordinates[1], coordinates[2]),
            axis: Vector3::new(cos_lambda * cos_xi, sin_lambda, -cos_lambda * sin_xi),
            axis_xi: Vector3::new(-cos_lambda * sin_xi, 0.0, -cos_lambda * cos_xi),
            axis_lambda: Vector3::new(-sin_lambda * cos_xi, cos_lambda, sin_lambda * sin_xi),
            axis_xi_xi: Vector3::new(-cos_lambda * cos_xi, 0.0, cos_lambda * sin_xi),
            axis_xi_lambda: Vector3::new(sin_lambda * sin_xi, 0.0, sin_lambda * cos_xi),
        }
    }

    /// The race that sits at a mount of the body with these coordinates. Derivatives are by the body's
    /// tilts, and leave out how these move the race's centre.
    /// Its centre counts from `origin` (m), so that far from the axes' own origin no digits are lost.
    pub fn mounted(coordinates: &SVector<f64, 5>, mount: &Mount, origin: &Vector3<f64>) -> Self {
        let mut race = InnerRacePosition::new(coordinates);
        if mount.along != 0.0 || *origin != Vector3::zeros() {
            // The axis less X: 1 − cos λ cos ξ without a difference of numbers near one.
            let half = |angle: f64| libm::sin(0.5 * angle).powi(2);
            let (xi, lambda) = (half(coordinates[3]), half(coordinates[4]));
            let shortening = 2.0 * (xi + lambda) - 4.0 * xi * lambda;
            let off = Vector3::new(-shortening, race.axis.y, race.axis.z);
            race.centre += (Vector3::x() * mount.along - origin) + off * mount.along;
        }
        if mount.reversed {
            let turned = [
                &mut race.axis,
                &mut race.axis_xi,
                &mut race.axis_lambda,
                &mut race.axis_xi_xi,
                &mut race.axis_xi_lambda,
            ];
            turned.into_iter().for_each(|vector| *vector = -*vector);
        }
        race
    }

    /// The same race, seen from the frame in which its present one stands at `axes`.
    pub(super) fn seen_from_parent_of(mut self, axes: &Pose) -> Self {
        self.centre = axes.point_to_parent(&self.centre);
        let turned = [
            &mut self.axis,
            &mut self.axis_xi,
            &mut self.axis_lambda,
            &mut self.axis_xi_xi,
            &mut self.axis_xi_lambda,
        ];
        turned.into_iter().for_each(|vector| *vector = axes.orientation * *vector);
        self
    }

    /// First (by ξ, λ) and second derivatives (ξξ, ξλ, λλ) of the race's axis by its body's tilts.
    pub(super) fn turning(&self) -> ([Vector3<f64>; 2], [Vector3<f64>; 3]) {
        let second = [self.axis_xi_xi, self.axis_xi_lambda, -self.axis];
        ([self.axis_xi, self.axis_lambda], second)
    }

    /// First (by ξ, λ) and second derivatives (ξξ, ξλ, λλ) of the centre of a race at a mount by its body's
    /// tilts, m.
    pub(super) fn along(&self, mount: &Mount) -> ([Vector3<f64>; 2], [Vector3<f64>; 3]) {
        let by = if mount.reversed { -mount.along } else { mount.along };
        let first = [self.axis_xi * by, self.axis_lambda * by];
        (first, [self.axis_xi_xi * by, self.axis_xi_lambda * by, self.axis * -by])
    }
}

/// Energy, slope and curvature of one contact in the race's meridian coordinates.
#[derive(Clone, Copy, Debug)]
struct ContactEnergy {
    contact: MeridianContact,
    load: f64,
    energy: f64,
    slope: [f64; 2],
    /// Second derivatives: axial–axial, axial–radial, radial–radial.
    curvature: [f64; 3],
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
    // A load that keeps its size while its direction follows the ball: the swivel stiffness.
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

/// Where the inner race sees a ball.
#[derive(Clone, Copy, Debug)]
struct Sighting {
    /// From the race's centre to the ball centre.
    arm: Vector3<f64>,
    axial: f64,
    radial: f64,
}

fn sight(plane: &BallPlane, race: &InnerRacePosition, position: [f64; 2]) -> Sighting {
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
    /// Unbalanced force on the ball in its plane over the largest force on it; rounding when it
    /// has settled.
    pub unbalance: f64,
}

/// The two-dimensional energy of a ball with slope and curvature in its plane.
pub(super) struct PlaneEnergy {
    inner: ContactEnergy,
    outer: ContactEnergy,
    pub(super) energy: f64,
    slope: [f64; 2],
    curvature: [f64; 3],
}

pub(super) fn plane_energy(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    position: [f64; 2],
) -> PlaneEnergy {
    let outer = contact_energy(
        position[0],
        position[1],
        &contacts.outer,
        contacts.ball_radius,
        contacts.outer_stiffness,
    );
    let seen = sight(plane, race, position);
    let inner = contact_energy(
        seen.axial,
        seen.radial,
        &contacts.inner,
        contacts.ball_radius,
        contacts.inner_stiffness,
    );
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

/// Finds the ball's equilibrium for a given position of the inner race.
///
/// `None` when the ball has room and nothing pushes it: such a ball costs the distance test.
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

/// Overlap of both contacts together for a ball on the line between the groove centres, m, and the
/// angle of that line to the outer race's radial plane, rad.
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

/// The inner groove's centre of curvature as the ball at `point` sees it in its own plane, m.
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

/// Contacts of a ball at a given place with the inner and the outer race.
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
        // What rounding of the overlaps leaves; below that there is nothing to gain.
        let noise_force = 4.0 * f64::EPSILON * radius * (now.curvature[0] + now.curvature[2]);
        if unbalance <= 1e-11 * scale + noise_force {
            break;
        }
        let step = newton_step(&now.slope, &now.curvature);
        // Newton's error falls as its square: one more step from here is the last, unseen.
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
    // A load of an overlap of some ulps is rounding too: the weight of a ball beside the axis.
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

/// What rounding of an overlap (some ulps of the distance from the axis) does to the energy, J.
pub fn energy_noise(load: f64, radius: f64) -> f64 {
    16.0 * f64::EPSILON * radius * load
}

/// −H⁻¹g; where the curvature does not hold the ball (no contact), a step of its room's size
/// along the force instead.
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

/// Loads a ball puts on the inner race's five coordinates and their derivative, after the ball has
/// found its equilibrium: adds ∂V/∂q and ∂²V/∂q² with the ball's coordinates condensed out. Returns the force
/// on the race, N.
pub fn add_to_race(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    ball: &SettledBall,
    gradient: &mut SVector<f64, 5>,
    stiffness: &mut SMatrix<f64, 5, 5>,
) -> Vector3<f64> {
    if ball.inner_load == 0.0 {
        return Vector3::zeros();
    }
    let (slope, curvature) = race_and_ball_derivatives(plane, race, contacts, ball.position);
    let outer = contact_energy(
        ball.position[0],
        ball.position[1],
        &contacts.outer,
        contacts.ball_radius,
        contacts.outer_stiffness,
    );
    let (uu, uv, vv) = (
        curvature[(5, 5)] + outer.curvature[0],
        curvature[(5, 6)] + outer.curvature[1],
        curvature[(6, 6)] + outer.curvature[2] - plane.centrifugal,
    );
    let determinant = uu * vv - uv * uv;
    for i in 0..5 {
        gradient[i] += slope[i];
        let (iu, iv) = (curvature[(i, 5)], curvature[(i, 6)]);
        // Row of H_qu H_uu⁻¹.
        let (fu, fv) = ((iu * vv - iv * uv) / determinant, (iv * uu - iu * uv) / determinant);
        for j in i..5 {
            let condensed = curvature[(i, j)] - fu * curvature[(j, 5)] - fv * curvature[(j, 6)];
            stiffness[(i, j)] += condensed;
            if j > i {
                stiffness[(j, i)] += condensed;
            }
        }
    }
    Vector3::new(-slope[0], -slope[1], -slope[2])
}

/// First and second derivatives of the inner contact's energy with respect to the race's five
/// coordinates and the ball's two.
fn race_and_ball_derivatives(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
    position: [f64; 2],
) -> (SVector<f64, 7>, SMatrix<f64, 7, 7>) {
    let seen = sight(plane, race, position);
    let inner = contact_energy(
        seen.axial,
        seen.radial,
        &contacts.inner,
        contacts.ball_radius,
        contacts.inner_stiffness,
    );
    let (a, w) = (&race.axis, &seen.arm);
    let (h, rho) = (seen.axial, seen.radial);
    // h = a·w, and ρ² = w·w − h²; `half` is the gradient of w·w/2.
    let dh = SVector::<f64, 7>::from([
        -a.x,
        -a.y,
        -a.z,
        race.axis_xi.dot(w),
        race.axis_lambda.dot(w),
        a.dot(&plane.axial),
        a.dot(&plane.radial),
    ]);
    let half = SVector::<f64, 7>::from([
        -w.x,
        -w.y,
        -w.z,
        0.0,
        0.0,
        w.dot(&plane.axial),
        w.dot(&plane.radial),
    ]);
    let dr = (half - dh * h) / rho;
    let slope = dh * inner.slope[0] + dr * inner.slope[1];

    let [c_hh, c_hr, c_rr] = inner.curvature;
    let bend = inner.slope[1] / rho;
    let mut curvature = SMatrix::<f64, 7, 7>::zeros();
    for i in 0..7 {
        for j in i..7 {
            curvature[(i, j)] = (c_hh - bend) * dh[i] * dh[j]
                + c_hr * (dh[i] * dr[j] + dr[i] * dh[j])
                + (c_rr - bend) * dr[i] * dr[j];
        }
    }
    // ∇²(w·w/2) times V_ρ/ρ.
    for i in 0..3 {
        curvature[(i, i)] += bend;
        curvature[(i, 5)] -= bend * plane.axial[i];
        curvature[(i, 6)] -= bend * plane.radial[i];
    }
    curvature[(5, 5)] += bend;
    curvature[(6, 6)] += bend;
    // ∇²h times V_h − h V_ρ/ρ.
    let turn = inner.slope[0] - h * bend;
    for i in 0..3 {
        curvature[(i, 3)] -= turn * race.axis_xi[i];
        curvature[(i, 4)] -= turn * race.axis_lambda[i];
    }
    curvature[(3, 3)] += turn * race.axis_xi_xi.dot(w);
    curvature[(3, 4)] += turn * race.axis_xi_lambda.dot(w);
    curvature[(4, 4)] -= turn * h;
    curvature[(3, 5)] += turn * race.axis_xi.dot(&plane.axial);
    curvature[(3, 6)] += turn * race.axis_xi.dot(&plane.radial);
    curvature[(4, 5)] += turn * race.axis_lambda.dot(&plane.axial);
    curvature[(4, 6)] += turn * race.axis_lambda.dot(&plane.radial);
    (slope, curvature)
}
