//! Euler angles in the sequence 1-2-3 about body-fixed axes, equation (2.16).
//!
//! The state of a body is a unit quaternion; Euler angles are for input and output.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Orientation (body to inertial). Its matrix is the transpose of (2.16), which maps components in the inertial frame
/// to components in the body-fixed frame.
///
/// `eta` (about X), `xi` (about the once-turned Y) and `lambda` (about the twice-turned Z) in rad.
pub fn quaternion(eta: f64, xi: f64, lambda: f64) -> UnitQuaternion<f64> {
    about(Vector3::x(), eta) * about(Vector3::y(), xi) * about(Vector3::z(), lambda)
}

/// Rotation by an angle (rad) about a unit vector. Uses sine and cosine of `libm`, because the system's differ between
/// processors.
pub fn about(axis: Vector3<f64>, angle: f64) -> UnitQuaternion<f64> {
    let (sin, cos) = libm::sincos(0.5 * angle);
    UnitQuaternion::new_unchecked(Quaternion::from_parts(cos, axis * sin))
}

/// Euler angles `(eta, xi, lambda)` in rad of an orientation; `xi` is in [-π/2, π/2].
///
/// At `xi = ±π/2` the first and third axis coincide and `eta` is set to zero.
pub fn angles(orientation: &UnitQuaternion<f64>) -> (f64, f64, f64) {
    let rotation = orientation.to_rotation_matrix();
    let m = rotation.matrix();
    let xi = libm::asin(m[(0, 2)].clamp(-1.0, 1.0));
    if libm::hypot(m[(0, 0)], m[(0, 1)]) < 1e-12 {
        return (0.0, xi, libm::atan2(m[(1, 0)], m[(1, 1)]));
    }
    let eta = libm::atan2(-m[(1, 2)], m[(2, 2)]);
    let lambda = libm::atan2(-m[(0, 1)], m[(0, 0)]);
    (eta, xi, lambda)
}
