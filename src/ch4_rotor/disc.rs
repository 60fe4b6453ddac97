//! Rigid discs and rings on a shaft: mass, inertia, gyroscopic moment and unbalance force.

use nalgebra::{Matrix2, Vector2};
use std::f64::consts::PI;

/// Mass and inertia of a body of revolution about its centre.
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
    /// Ring, or disc if `inner_diameter` is zero. Dimensions in m, density in kg/m³.
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

/// Gyroscopic matrix over (turn_y, turn_z) per rad/s of spin about X: moments Ω J (θ̇_z, −θ̇_y) for a disc of axial
/// inertia J = `axial`, kg·m².
pub fn gyroscopic(axial: f64) -> Matrix2<f64> {
    Matrix2::new(0.0, axial, -axial, 0.0)
}

/// Force (y, z) on the shaft, N, of an unbalance (kg·m) at `angle` (rad from Y towards Z) for the speed `spin` (rad/s)
/// and the acceleration `spin_up` (rad/s²): ω² radially outwards, ω̇ tangentially backwards.
pub fn unbalance_force(unbalance: f64, angle: f64, spin: f64, spin_up: f64) -> Vector2<f64> {
    let [c, s] = [libm::cos(angle), libm::sin(angle)];
    (Vector2::new(c, s) * (spin * spin) - Vector2::new(-s, c) * spin_up) * unbalance
}
