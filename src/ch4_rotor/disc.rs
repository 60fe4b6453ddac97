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
