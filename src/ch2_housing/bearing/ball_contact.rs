//! Contact of two balls that no cage keeps apart: Hertz's law for equal spheres, with friction.
//!
//! The source's bearings keep their balls apart; without a cage they run into each other, and in a
//! full complement they touch all the time. Two rolling balls slide on each other at twice their
//! surface speed, so that friction is Coulomb's, rounded off as elsewhere.

use super::contact::normal_load;
use super::slices::Motion;
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, norm, scale, sub};

/// How two balls push and rub.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallContactLaw {
    /// K of F = K δ^{3/2}, N/m^1.5.
    pub stiffness: f64,
    /// Coulomb coefficient, rounded off below `regularisation_speed` (m/s).
    pub friction: f64,
    pub regularisation_speed: f64,
}

/// K = (4/3) E* √R of two equal spheres of a `radius` (m), N/m^1.5: with the relative radius
/// R = radius/2 and E* = E'/2, where `modulus` (Pa) is E' = E/(1 − ν²) of the balls.
pub fn equal_spheres(modulus: f64, radius: f64) -> f64 {
    4.0 / 3.0 * (0.5 * modulus) * (0.5 * radius).sqrt()
}

/// Largest pressure between two balls of a `radius` (m) under a load (N), Pa: p = 3F/(2π a²) with a² = R δ,
/// R = radius/2 and δ = (F/K)^{2/3}.
pub fn peak_pressure(law: &BallContactLaw, radius: f64, load: f64) -> f64 {
    if load <= 0.0 {
        return 0.0;
    }
    let overlap = libm::pow(libm::cbrt(load / law.stiffness), 2.0);
    1.5 * load / (std::f64::consts::PI * 0.5 * radius * overlap)
}

/// Two neighbouring balls, inertial axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BallContact {
    /// δ, m; zero where the balls are apart.
    pub overlap: f64,
    /// N.
    pub normal_load: f64,
    /// Unit vector from the first ball to the second.
    pub normal: Vec3,
    /// From the first ball's centre to the contact point; the second one's arm is the opposite.
    pub arm: Vec3,
    /// Normal force and friction on the second ball; the first feels the opposite.
    pub force: Vec3,
    /// Sliding of the second ball over the first, m/s.
    pub slip: Vec3,
    /// Power of the friction, W, ≤ 0.
    pub power: f64,
}

/// Whether balls of a `radius` (m) are clear of each other, from their centres; NaN is not, and is found later.
#[inline]
pub fn are_apart(radius: f64, one: Vec3, other: Vec3) -> bool {
    let between = sub(other, one);
    dot(between, between) >= 4.0 * radius * radius
}

/// Contact of two balls of a `radius` (m); `None` where they are apart.
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
    // The overlap is shared in halves.
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
