//! Position of a race in an equilibrium, and its derivatives by the coordinates.

use crate::kinematics::Pose;
use crate::members::mount::Mount;
use nalgebra::{SVector, Vector3};

/// Position of the inner race and its derivatives with respect to the two tilts.
#[derive(Clone, Copy, Debug)]
pub struct InnerRacePosition {
    pub centre: Vector3<f64>,
    /// Unit vector along the race's axis: (cos λ cos ξ, sin λ, −cos λ sin ξ).
    pub axis: Vector3<f64>,
    pub(crate) axis_xi: Vector3<f64>,
    pub(crate) axis_lambda: Vector3<f64>,
    pub(crate) axis_xi_xi: Vector3<f64>,
    pub(crate) axis_xi_lambda: Vector3<f64>,
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

    /// The race at a mount of the body with these coordinates. Derivatives are by the body's tilts, without the motion
    /// of the race's centre. Its centre is relative to `origin` (m), so that no digits are lost far from the axes' own
    /// origin.
    pub fn mounted(coordinates: &SVector<f64, 5>, mount: &Mount, origin: &Vector3<f64>) -> Self {
        let mut race = InnerRacePosition::new(coordinates);
        if mount.along != 0.0 || *origin != Vector3::zeros() {
            // The axis less X: 1 − cos λ cos ξ without cancellation.
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

    /// The same race in the frame in which its present frame has the pose `axes`.
    pub fn seen_from_parent_of(mut self, axes: &Pose) -> Self {
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
    pub(crate) fn turning(&self) -> ([Vector3<f64>; 2], [Vector3<f64>; 3]) {
        let second = [self.axis_xi_xi, self.axis_xi_lambda, -self.axis];
        ([self.axis_xi, self.axis_lambda], second)
    }

    /// First (by ξ, λ) and second derivatives (ξξ, ξλ, λλ) of the centre of a race at a mount by its body's tilts, m.
    pub(crate) fn along(&self, mount: &Mount) -> ([Vector3<f64>; 2], [Vector3<f64>; 3]) {
        let by = if mount.reversed { -mount.along } else { mount.along };
        let first = [self.axis_xi * by, self.axis_lambda * by];
        (first, [self.axis_xi_xi * by, self.axis_xi_lambda * by, self.axis * -by])
    }
}
