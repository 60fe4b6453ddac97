//! Position and orientation of a rigid body.

use nalgebra::{UnitQuaternion, Vector3};

/// Position and orientation of a body frame in its parent frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Origin of the body frame in the parent frame, m.
    pub position: Vector3<f64>,
    /// Orientation, body to parent.
    pub orientation: UnitQuaternion<f64>,
}

impl Pose {
    pub fn identity() -> Self {
        Pose { position: Vector3::zeros(), orientation: UnitQuaternion::identity() }
    }

    /// Transforms a point from the body frame to the parent frame, m.
    pub fn point_to_parent(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.position + self.orientation * point
    }

    /// Transforms a point from the parent frame to the body frame, m.
    pub fn point_to_body(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.orientation.inverse_transform_vector(&(point - self.position))
    }

    /// Transforms this pose from the frame `parent` to the frame in which `parent` is expressed.
    pub fn seen_from_parent_of(&self, parent: &Pose) -> Pose {
        Pose {
            position: parent.point_to_parent(&self.position),
            orientation: parent.orientation * self.orientation,
        }
    }

    /// Transforms this pose to `frame`; both are expressed in the same parent frame.
    pub fn relative_to(&self, frame: &Pose) -> Pose {
        Pose {
            position: frame.point_to_body(&self.position),
            orientation: frame.orientation.inverse() * self.orientation,
        }
    }
}
