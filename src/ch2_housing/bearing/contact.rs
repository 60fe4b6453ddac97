//! Contact of a ball with a raceway groove: overlap and normal load (2.1).
//!
//! A raceway is a torus. In the meridian plane through the ball centre, the ball touches a circular arc from inside, so
//! the overlap depends only on the ball's axial and radial position. The contact angle follows from both.

use super::geometry::Raceway;
use crate::kinematics::Pose;
use nalgebra::Vector3;

/// Normal load F_N = K_H δ^{3/2} in N of an overlap δ in m, equations (2.1), (4.1) and (5.1).
///
/// ```
/// use bearing_dynamics::ch2_housing::bearing::contact::normal_load;
/// assert_eq!(normal_load(4e10, 1e-4), 4e10 * 1e-4 * 1e-4_f64.sqrt());
/// assert_eq!(normal_load(4e10, -1e-6), 0.0); // a gap has no load
/// ```
#[doc(alias = "2.1")]
#[doc(alias = "4.1")]
#[doc(alias = "5.1")]
#[inline]
pub fn normal_load(stiffness: f64, overlap: f64) -> f64 {
    // NaN passes through, so that it is caught instead of becoming a missing contact.
    if overlap <= 0.0 { 0.0 } else { stiffness * overlap * overlap.sqrt() }
}

/// Slope dF_N/dδ = (3/2) K_H δ^{1/2} of (2.1), N/m.
#[inline]
pub fn normal_stiffness(stiffness: f64, overlap: f64) -> f64 {
    if overlap <= 0.0 { 0.0 } else { 1.5 * stiffness * overlap.sqrt() }
}

/// Energy (2/5) K_H δ^{5/2} stored in a contact, J.
#[inline]
pub fn strain_energy(stiffness: f64, overlap: f64) -> f64 {
    if overlap <= 0.0 { 0.0 } else { 0.4 * stiffness * overlap * overlap * overlap.sqrt() }
}

/// Contact of a ball with a groove in the meridian plane of the race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeridianContact {
    /// δ, m; negative is a gap.
    pub overlap: f64,
    /// Distance of the ball centre from the groove's centre of curvature, m.
    pub centre_distance: f64,
    /// Unit vector from the groove's centre of curvature to the ball centre: axial, radial part.
    pub normal: [f64; 2],
}

/// Contact of a ball whose centre is at `axial`, `radial` (m) in the race's frame.
#[inline]
pub fn meridian_contact(
    axial: f64,
    radial: f64,
    raceway: &Raceway,
    ball_radius: f64,
) -> MeridianContact {
    let from_centre = [axial - raceway.centre_axial, radial - raceway.centre_radius];
    let centre_distance =
        (from_centre[0] * from_centre[0] + from_centre[1] * from_centre[1]).sqrt();
    // On the centre of curvature the direction is undefined but there is no contact, because a groove is wider than its
    // ball: any unit vector will do.
    let normal = if centre_distance > 0.0 {
        [from_centre[0] / centre_distance, from_centre[1] / centre_distance]
    } else {
        [0.0, 1.0]
    };
    let overlap = centre_distance - (raceway.groove_radius - ball_radius);
    MeridianContact { overlap, centre_distance, normal }
}

/// Force of a race on a ball in any position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrooveForce {
    /// δ, m; negative is a gap.
    pub overlap: f64,
    /// N.
    pub normal_load: f64,
    /// Force on the ball, N; the race takes the opposite force on the same line of action through the ball centre.
    pub force_on_ball: Vector3<f64>,
}

/// Normal force between a ball and a race, in the common frame of `ball_centre` and the race's pose.
///
/// `stiffness` is K_H in N/m^1.5. The race's rotation about its own axis has no influence.
pub fn groove_force(
    ball_centre: &Vector3<f64>,
    race: &Pose,
    raceway: &Raceway,
    ball_radius: f64,
    stiffness: f64,
) -> GrooveForce {
    let axis = race.orientation * Vector3::x();
    let arm = ball_centre - race.position;
    let axial = axis.dot(&arm);
    let radial_arm = arm - axis * axial;
    let radial = radial_arm.norm();
    let contact = meridian_contact(axial, radial, raceway, ball_radius);
    let load = normal_load(stiffness, contact.overlap);
    let normal = axis * contact.normal[0] + radial_arm * (contact.normal[1] / radial);
    // A ball on the race's axis has no radial direction, but is far from any groove.
    let force_on_ball = if load == 0.0 { Vector3::zeros() } else { normal * -load };
    GrooveForce { overlap: contact.overlap, normal_load: load, force_on_ball }
}

/// Damping in a normal contact. The dissertation specifies none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactDamping {
    None,
    /// Hunt and Crossley (1975): F = K δ^{3/2}(1 + (3/2) α δ̇) with α in s/m.
    HuntCrossley {
        alpha: f64,
    },
}

/// Geometry and stiffness of the contact between a ball and one race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaceLaw {
    /// Circle of the groove's centres of curvature in the race's frame, m.
    pub centre_axial: f64,
    pub centre_radius: f64,
    /// Groove radius minus ball radius, m.
    pub room: f64,
    /// K_H, N/m^1.5.
    pub stiffness: f64,
    /// Semi-major axis of the contact ellipse divided by √δ, m^0.5.
    pub semi_major_factor: f64,
    /// Ratio of the semi-major to the semi-minor axis.
    pub ellipticity: f64,
    /// Depth of the pressed surface below the tangent plane, divided by the square of the distance from the rolling
    /// plane, 1/m: half the mean curvature of ball and groove. Zero without differential sliding.
    pub half_curvature: f64,
    /// Side of the circle on which the groove has material: +1 outside (outer race), −1 inside (inner race).
    pub outward: f64,
}

/// Normal contact of one ball with one race, in inertial axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RaceContact {
    /// δ, m; negative is a gap.
    pub overlap: f64,
    /// Unit vector from the groove's centre of curvature through the ball centre.
    pub normal: [f64; 3],
    /// Unit vector from the race's axis to the ball.
    pub outward: [f64; 3],
    /// dδ/dt, m/s.
    pub closing_speed: f64,
}

/// Overlap and its rate. `arm` and `velocity` are the position (m) and velocity (m/s) of the ball centre relative to
/// the race's centre.
#[inline(always)]
pub fn race_contact(
    arm: [f64; 3],
    velocity: [f64; 3],
    axis: [f64; 3],
    spin: [f64; 3],
    law: &RaceLaw,
) -> RaceContact {
    use crate::kinematics::vec3::{add_scaled, cross, dot, scale, sub};
    let axial = dot(axis, arm);
    let across = add_scaled(arm, -axial, axis);
    let radial = dot(across, across).sqrt();
    let outward = scale(across, 1.0 / radial);
    let from_axial = axial - law.centre_axial;
    let from_radial = radial - law.centre_radius;
    // Beyond 90° the groove walls continue straight, so that no groove encloses its ball. NaN passes through.
    let from_radial = if law.outward * from_radial < 0.0 { 0.0 } else { from_radial };
    let distance = (from_axial * from_axial + from_radial * from_radial).sqrt();
    let per_distance = 1.0 / if distance > 0.0 { distance } else { 1.0 };
    let normal =
        add_scaled(scale(axis, from_axial * per_distance), from_radial * per_distance, outward);
    let relative = sub(velocity, cross(spin, arm));
    RaceContact {
        overlap: distance - law.room,
        normal,
        outward,
        closing_speed: dot(normal, relative),
    }
}

/// Normal load with damping, N: K δ^{3/2} (1 + `factor` δ̇), never negative.
#[inline(always)]
pub fn damped_load(stiffness: f64, overlap: f64, closing_speed: f64, factor: f64) -> f64 {
    let elastic = normal_load(stiffness, overlap);
    let share = 1.0 + factor * closing_speed;
    elastic * if share < 0.0 { 0.0 } else { share }
}
