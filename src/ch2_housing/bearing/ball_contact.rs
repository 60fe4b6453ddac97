//! Ball–ball contact in a bearing without a cage: Hertz's law for equal spheres, with friction.
//!
//! The dissertation has no ball–ball contact. Two rolling balls slide on each other at twice their surface speed, so
//! friction is regularised Coulomb friction.

use super::contact::normal_load;
use super::slices::Motion;
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, norm, scale, sub};

/// Normal and friction law of a ball–ball contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallContactLaw {
    /// K of F = K δ^{3/2}, N/m^1.5.
    pub stiffness: f64,
    /// Coulomb coefficient, regularised below `regularisation_speed` (m/s).
    pub friction: f64,
    pub regularisation_speed: f64,
}

/// K = (4/3) E* √R of two equal spheres of a `radius` (m), N/m^1.5: with the relative radius
/// R = radius/2 and E* = E'/2, where `modulus` (Pa) is E' = E/(1 − ν²) of the balls.
pub fn equal_spheres(modulus: f64, radius: f64) -> f64 {
    4.0 / 3.0 * (0.5 * modulus) * (0.5 * radius).sqrt()
}

/// Peak Hertz pressure between two balls of `radius` (m) under `load` (N), Pa: p = 3F/(2π a²) with a² = R δ,
/// R = radius/2 and δ = (F/K)^{2/3}.
pub fn peak_pressure(law: &BallContactLaw, radius: f64, load: f64) -> f64 {
    if load <= 0.0 {
        return 0.0;
    }
    let overlap = libm::pow(libm::cbrt(load / law.stiffness), 2.0);
    1.5 * load / (std::f64::consts::PI * 0.5 * radius * overlap)
}

/// Contact of two neighbouring balls, inertial axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BallContact {
    /// δ, m; zero where the balls are apart.
    pub overlap: f64,
    /// N.
    pub normal_load: f64,
    /// Unit vector from the first ball to the second.
    pub normal: Vec3,
    /// Vector from the first ball's centre to the contact point, m; the second ball's arm is its negative.
    pub arm: Vec3,
    /// Normal force and friction on the second ball, N; the first ball takes the opposite force.
    pub force: Vec3,
    /// Sliding velocity of the second ball over the first, m/s.
    pub slip: Vec3,
    /// Power of the friction, W, ≤ 0.
    pub power: f64,
}

/// Returns whether two balls of `radius` (m) do not touch, from their centres (m); `false` for NaN, which is caught
/// later.
#[inline]
pub fn are_apart(radius: f64, one: Vec3, other: Vec3) -> bool {
    let between = sub(other, one);
    dot(between, between) >= 4.0 * radius * radius
}

/// Contact of two balls of `radius` (m); `None` if they do not touch.
#[inline]
pub fn ball_contact(
    law: &BallContactLaw,
    radius: f64,
    one: &Motion,
    other: &Motion,
) -> Option<BallContact> {
    if are_apart(radius, one.position, other.position) {
        return None;
    }
    let between = sub(other.position, one.position);
    let distance = norm(between);
    let overlap = 2.0 * radius - distance;
    let load = normal_load(law.stiffness, overlap);
    let normal = scale(between, 1.0 / distance);
    // The overlap is shared equally.
    let arm = scale(normal, radius - 0.5 * overlap);
    let on_other = sub(other.velocity, cross(other.spin, arm));
    let on_one = add(one.velocity, cross(one.spin, arm));
    let relative = sub(on_other, on_one);
    let slip = add_scaled(relative, -dot(relative, normal), normal);
    let speed = norm(slip);
    let u0 = law.regularisation_speed;
    let per_speed = law.friction * load / (speed * speed + u0 * u0).sqrt();
    Some(BallContact {
        overlap,
        normal_load: load,
        normal,
        arm,
        force: add_scaled(scale(normal, load), -per_speed, slip),
        slip,
        power: -per_speed * speed * speed,
    })
}
