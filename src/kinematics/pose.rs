//! Position and orientation of a rigid body.

use nalgebra::{UnitQuaternion, Vector3};

/// Where a body-fixed frame sits in its parent frame.
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

    /// A point given in the body frame, in the parent frame, m.
    pub fn point_to_parent(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.position + self.orientation * point
    }

    /// A point given in the parent frame, in the body frame, m.
    pub fn point_to_body(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.orientation.inverse_transform_vector(&(point - self.position))
    }

    /// This pose, given in the frame `parent`, expressed in the frame in which `parent` is given.
    pub fn seen_from_parent_of(&self, parent: &Pose) -> Pose {
        Pose {
            position: parent.point_to_parent(&self.position),
            orientation: parent.orientation * self.orientation,
        }
    }

    /// This pose expressed in `frame`, both being given in the same parent frame.
    pub fn relative_to(&self, frame: &Pose) -> Pose {
        Pose {
            position: frame.point_to_body(&self.position),
            orientation: frame.orientation.inverse() * self.orientation,
        }
    }
}
