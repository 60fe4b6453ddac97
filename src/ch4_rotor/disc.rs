//! Rigid discs and rings on a shaft, and what they do to its bending: mass, both inertias, the gyroscopic moment,
//! the force of an unbalance.

use nalgebra::{Matrix2, Vector2};
use std::f64::consts::PI;

/// Of a body of revolution about its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// kg.
    pub mass: f64,
    /// About the axis (polar), kg·m².
    pub axial: f64,
    /// About a diameter, kg·m².
    pub transverse: f64,
}

impl Inertia {
    /// A ring, or a disc where `inner_diameter` is zero. m, kg/m³.
    pub fn of_ring(outer_diameter: f64, inner_diameter: f64, width: f64, density: f64) -> Inertia {
        let [a2, b2] = [outer_diameter, inner_diameter].map(|d| 0.25 * d * d);
        let mass = density * PI * (a2 - b2) * width;
        Inertia {
            mass,
            axial: 0.5 * mass * (a2 + b2),
            transverse: mass * (0.25 * (a2 + b2) + width * width / 12.0),
        }
    }
}

/// Gyroscopic matrix over (turn_y, turn_z) per rad/s of spin about X: moments Ω J (θ̇_z, −θ̇_y) turn the axis of a disc of
/// axial inertia J = `axial`, kg·m².
pub fn gyroscopic(axial: f64) -> Matrix2<f64> {
    Matrix2::new(0.0, axial, -axial, 0.0)
}

/// Force (y, z) on the shaft of an unbalance (kg·m) that stands at `angle` (rad from Y towards Z) while the shaft turns
/// at `spin` (rad/s) and gains `spin_up` (rad/s²): ω² outwards, and ω̇ back along the circumference.
pub fn unbalance_force(unbalance: f64, angle: f64, spin: f64, spin_up: f64) -> Vector2<f64> {
    let [c, s] = [libm::cos(angle), libm::sin(angle)];
    (Vector2::new(c, s) * (spin * spin) - Vector2::new(-s, c) * spin_up) * unbalance
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disc of 0.1 m and 20 mm, a thin hoop, and the unbalance against the acceleration of its place by differences.
    #[test]
    fn rings_and_unbalance() {
        let disc = Inertia::of_ring(0.1, 0.0, 0.02, 7850.0);
        let mass = 7850.0 * PI * 0.0025 * 0.02;
        assert!((disc.mass / mass - 1.0).abs() <= 1e-14);
        assert!((disc.axial / (mass * 0.0025 / 2.0) - 1.0).abs() <= 1e-14);
        assert!((disc.transverse / (mass * (0.0025 / 4.0 + 0.0004 / 12.0)) - 1.0).abs() <= 1e-14);
        let hoop = Inertia::of_ring(1.0, 0.999, 1e-9, 1.0);
        assert!((hoop.axial / (2.0 * hoop.transverse) - 1.0).abs() <= 1e-12);

        let [speed, gain, t, h] = [30.0, 200.0, 0.4, 1e-4];
        let turn = |t: f64| 0.3 + speed * t + 0.5 * gain * t * t;
        let place = |t: f64| Vector2::new(turn(t).cos(), turn(t).sin());
        let acceleration = (place(t + h) - place(t) * 2.0 + place(t - h)) / (h * h);
        let force = unbalance_force(1e-3, turn(t), speed + gain * t, gain);
        // Second differences miss by h²/12 of the fourth derivative, (110 rad/s)⁴: 1e-5 of ω².
        assert!((force + acceleration * 1e-3).norm() <= 2e-5 * force.norm());
    }
}
