//! Euler angles in the sequence 1-2-3 about body-fixed axes, equation (2.16).
//!
//! The state of a body is a unit quaternion; Euler angles are for input and output.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Orientation (body to inertial) whose matrix is the transpose of (2.16), which takes the components of a vector in
/// the inertial frame to those in the body-fixed frame.
///
/// `eta` (about X), `xi` (about the once-turned Y) and `lambda` (about the twice-turned Z) in rad.
pub fn quaternion(eta: f64, xi: f64, lambda: f64) -> UnitQuaternion<f64> {
    about(Vector3::x(), eta) * about(Vector3::y(), xi) * about(Vector3::z(), lambda)
}

/// Rotation by an angle (rad) about a unit vector.
///
/// Sine and cosine are `libm`'s: the system's differ between processors.
pub fn about(axis: Vector3<f64>, angle: f64) -> UnitQuaternion<f64> {
    let (sin, cos) = libm::sincos(0.5 * angle);
    UnitQuaternion::new_unchecked(Quaternion::from_parts(cos, axis * sin))
}

/// Euler angles `(eta, xi, lambda)` in rad of an orientation; `xi` lies in [-π/2, π/2].
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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    /// (2.16) as it is printed.
    fn inertial_to_body(eta: f64, xi: f64, lambda: f64) -> Matrix3<f64> {
        let (sin_eta, cos_eta) = libm::sincos(eta);
        let (sin_xi, cos_xi) = libm::sincos(xi);
        let (sin_lambda, cos_lambda) = libm::sincos(lambda);
        Matrix3::new(
            cos_xi * cos_lambda,
            cos_eta * sin_lambda + sin_eta * sin_xi * cos_lambda,
            sin_eta * sin_lambda - cos_eta * sin_xi * cos_lambda,
            -cos_xi * sin_lambda,
            cos_eta * cos_lambda - sin_eta * sin_xi * sin_lambda,
            sin_eta * cos_lambda + cos_eta * sin_xi * sin_lambda,
            sin_xi,
            -sin_eta * cos_xi,
            cos_eta * cos_xi,
        )
    }

    #[test]
    fn matrix_of_2_16_is_the_transpose_of_the_quaternion() {
        let (eta, xi, lambda) = (0.3, -0.7, 1.1);
        let printed = inertial_to_body(eta, xi, lambda);
        let rotation = quaternion(eta, xi, lambda).to_rotation_matrix();
        assert!((printed - rotation.matrix().transpose()).amax() <= 4.0 * f64::EPSILON);
    }

    #[test]
    fn angles_invert_the_quaternion_also_at_the_pole() {
        for given in [(0.3, -0.7, 1.1), (-2.0, 1.2, -3.0), (0.0, 0.0, 0.0)] {
            let (eta, xi, lambda) = angles(&quaternion(given.0, given.1, given.2));
            let error = (eta - given.0).abs() + (xi - given.1).abs() + (lambda - given.2).abs();
            assert!(error <= 1e-14, "{given:?} came back as {:?}", (eta, xi, lambda));
        }
        let pole = quaternion(0.4, std::f64::consts::FRAC_PI_2, 0.2);
        let (eta, xi, lambda) = angles(&pole);
        assert!(pole.angle_to(&quaternion(eta, xi, lambda)) <= 1e-7);
    }
}
