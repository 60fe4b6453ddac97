//! Contacts of a flexible cage by its nodes (5.3.2): nodes of a pocket with their ball, nodes of the rails with the land
//! of the guiding race.

use crate::kinematics::vec3::{Vec3, add_scaled, cross, dot, norm, scale, sub};

/// Contact of one node: force on the *other* body, ball or race, at the node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeContact {
    /// Δd of (5.8), m.
    pub penetration: f64,
    /// N.
    pub normal_load: f64,
    /// Normal force and friction, N.
    pub force: Vec3,
    /// Power of the friction, W, ≤ 0.
    pub power: f64,
}

/// Penetration of a node at `arm` from the ball's centre, m, and the unit vector of the force on the ball.
pub fn depth_in_ball(arm: Vec3, ball_radius: f64) -> (f64, Vec3) {
    let distance = norm(arm);
    (ball_radius - distance, scale(arm, -1.0 / distance))
}

/// Penetration of a node into the land of a race, m, and the unit vector of the force on the race. `arm` is the node's
/// position from the race's centre, `axis` the race's axis; `outward` is 1 for a land around the cage and −1 for one
/// inside it.
pub fn depth_in_land(arm: Vec3, axis: Vec3, radius: f64, outward: f64) -> (f64, Vec3) {
    let across = add_scaled(arm, -dot(arm, axis), axis);
    let distance = norm(across);
    (outward * (distance - radius), scale(across, outward / distance))
}

/// Coulomb friction of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    pub coefficient: f64,
    /// Regularised below this speed, m/s.
    pub regularisation_speed: f64,
    /// Largest friction over sliding speed, N·s/m.
    pub most_per_speed: f64,
}

/// Force (5.8) at a node, F_n = K Δd n, with Coulomb friction.
/// `sliding` is the velocity of the other body's surface relative to the node, m/s.
#[doc(alias = "5.8")]
pub fn node_contact(
    stiffness: f64,
    friction: Friction,
    (penetration, push): (f64, Vec3),
    sliding: Vec3,
) -> NodeContact {
    let normal_load = stiffness * penetration;
    let slip = add_scaled(sliding, -dot(sliding, push), push);
    let speed_squared = dot(slip, slip);
    let Friction { coefficient, regularisation_speed, most_per_speed } = friction;
    let per_speed = coefficient * normal_load
        / (speed_squared + regularisation_speed * regularisation_speed).sqrt();
    let per_speed = if per_speed > most_per_speed { most_per_speed } else { per_speed };
    NodeContact {
        penetration,
        normal_load,
        force: add_scaled(scale(push, normal_load), -per_speed, slip),
        power: -per_speed * speed_squared,
    }
}

/// Velocity of a rigid body's point at `point`, m/s.
pub fn surface_velocity(position: Vec3, velocity: Vec3, spin: Vec3, point: Vec3) -> Vec3 {
    add_scaled(velocity, 1.0, cross(spin, sub(point, position)))
}
