//! Planes, cylinders and cones for nodes.

use crate::mesh::error::{place, six_digits};
use nalgebra::Vector3;
use std::fmt;

/// An unbounded surface. Lengths in m; directions need not have unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    Plane {
        point: [f64; 3],
        normal: [f64; 3],
    },
    Cylinder {
        point: [f64; 3],
        axis: [f64; 3],
        radius: f64,
    },
    /// A cone with radius `radius` at `point` that grows by `slope` per metre along the axis.
    Cone {
        point: [f64; 3],
        axis: [f64; 3],
        radius: f64,
        slope: f64,
    },
}

/// A point in the coordinates of a surface of revolution.
pub(crate) struct Polar {
    /// Unit vectors along the axis and in radial direction.
    axis: Vector3<f64>,
    pub outward: Vector3<f64>,
    pub along: f64,
    pub radius: f64,
}

pub(crate) fn polar(point: [f64; 3], axis: [f64; 3], place: Vector3<f64>) -> Polar {
    let axis = Vector3::from(axis).normalize();
    let offset = place - Vector3::from(point);
    let along = offset.dot(&axis);
    let radial = offset - axis * along;
    let radius = radial.norm();
    Polar { axis, outward: if radius > 0.0 { radial / radius } else { radial }, along, radius }
}

impl Surface {
    /// A cylinder about the X axis, the axis of every bearing.
    pub fn about_x(radius: f64) -> Surface {
        Surface::Cylinder { point: [0.0; 3], axis: [1.0, 0.0, 0.0], radius }
    }

    /// The plane of points whose coordinate `axis` (0, 1, 2 for X, Y, Z) is `value`.
    pub fn plane(axis: usize, value: f64) -> Surface {
        let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
        (point[axis], normal[axis]) = (value, 1.0);
        Surface::Plane { point, normal }
    }

    /// Distance from the surface, m; for a cone measured normal to its axis.
    pub fn distance(&self, place: Vector3<f64>) -> f64 {
        match *self {
            Surface::Plane { point, normal } => {
                (place - Vector3::from(point)).dot(&Vector3::from(normal).normalize()).abs()
            }
            Surface::Cylinder { point, axis, radius } => {
                (polar(point, axis, place).radius - radius).abs()
            }
            Surface::Cone { point, axis, radius, slope } => {
                let polar = polar(point, axis, place);
                (polar.radius - radius - slope * polar.along).abs()
            }
        }
    }

    /// Unit normal of the surface near `place`.
    pub fn normal(&self, place: Vector3<f64>) -> Vector3<f64> {
        match *self {
            Surface::Plane { normal, .. } => Vector3::from(normal).normalize(),
            Surface::Cylinder { point, axis, .. } => polar(point, axis, place).outward,
            Surface::Cone { point, axis, slope, .. } => {
                let polar = polar(point, axis, place);
                (polar.outward - polar.axis * slope).normalize()
            }
        }
    }

    /// Projection of `place` onto the surface, normal to its plane or axis.
    pub fn project(&self, place: Vector3<f64>) -> Vector3<f64> {
        match *self {
            Surface::Plane { point, normal } => {
                let normal = Vector3::from(normal).normalize();
                place - normal * (place - Vector3::from(point)).dot(&normal)
            }
            Surface::Cylinder { point, axis, radius } => {
                let polar = polar(point, axis, place);
                place + polar.outward * (radius - polar.radius)
            }
            Surface::Cone { point, axis, radius, slope } => {
                let polar = polar(point, axis, place);
                place + polar.outward * (radius + slope * polar.along - polar.radius)
            }
        }
    }
}

impl fmt::Display for Surface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Surface::Plane { point, normal } => {
                write!(f, "plane through {} normal to {normal:?}", place(point))
            }
            Surface::Cylinder { point, axis, radius } => {
                let radius = six_digits(*radius);
                write!(f, "cylinder of radius {radius} m about {axis:?} through {}", place(point))
            }
            Surface::Cone { point, axis, radius, slope } => {
                let (radius, point) = (six_digits(*radius), place(point));
                write!(f, "cone of radius {radius} m at {point} and slope {slope} along {axis:?}")
            }
        }
    }
}
