//! Least-squares fit of a cylinder to points.

use crate::mesh::surface::{Surface, polar};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// An unbounded cylinder. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedCylinder {
    /// A point of the axis.
    pub point: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub radius: f64,
}

impl FittedCylinder {
    /// Radial distance of a point from the cylinder, m; negative inside.
    pub fn outside(&self, place: Vector3<f64>) -> f64 {
        polar(self.point.into(), self.axis.into(), place).radius - self.radius
    }

    pub fn surface(&self) -> Surface {
        let (point, axis) = (self.point.into(), self.axis.into());
        Surface::Cylinder { point, axis, radius: self.radius }
    }
}

/// Fits a cylinder by least squares of the radial distances, with an axis nearly `along`. Points on part of
/// the circumference are enough. Parameters that the points do not determine (the tilt, if they are in one
/// plane) keep the value of `along`.
///
/// `None` for fewer than three points, or for points that are not around an axis.
pub fn fit_cylinder(places: &[Vector3<f64>], along: Vector3<f64>) -> Option<FittedCylinder> {
    /// Gauss-Newton iterations; they converge quadratically for small tilts.
    const ROUNDS: usize = 8;
    /// Eigenvalue, relative to the largest, below which a parameter of the axis is not determined.
    const DETERMINED: f64 = 1e-10;
    if places.len() < 3 {
        return None;
    }
    let along = along.normalize();
    let helper = Vector3::ith(along.iamin(), 1.0);
    let across = along.cross(&helper).normalize();
    let up = along.cross(&across);
    let count = places.len() as f64;
    let middle = places.iter().sum::<Vector3<f64>>() / count;

    // Initial value: circle fit in the plane across the axis, which is linear in its centre.
    let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for place in places {
        let (y, z) = ((place - middle).dot(&across), (place - middle).dot(&up));
        let row = Vector3::new(2.0 * y, 2.0 * z, 1.0);
        matrix += row * row.transpose();
        right += row * (y * y + z * z);
    }
    let centre = matrix.lu().solve(&right)?;
    let mut point = middle + across * centre[0] + up * centre[1];
    let mut axis = along;
    let distance = |place: &Vector3<f64>| polar(point.into(), along.into(), *place).radius;
    let mut radius = places.iter().map(distance).sum::<f64>() / count;

    for _ in 0..ROUNDS {
        let mut matrix = SMatrix::<f64, 5, 5>::zeros();
        let mut right = SVector::<f64, 5>::zeros();
        for place in places {
            let seen = polar(point.into(), axis.into(), *place);
            let (c, s) = (seen.outward.dot(&across), seen.outward.dot(&up));
            let lever = seen.along / radius;
            let row = SVector::from([c, s, lever * c, lever * s, 1.0]);
            matrix += row * row.transpose();
            right += row * (seen.radius - radius);
        }
        if !matrix.iter().chain(right.iter()).all(|value| value.is_finite()) {
            return None;
        }
        let eigen = matrix.symmetric_eigen();
        let least = DETERMINED * eigen.eigenvalues.max();
        let mut step = SVector::<f64, 5>::zeros();
        for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value > least {
                step += vector * (vector.dot(&right) / value);
            }
        }
        point += across * step[0] + up * step[1];
        axis = (axis + (across * step[2] + up * step[3]) / radius).normalize();
        radius += step[4];
    }
    let sound = radius.is_finite() && radius > 0.0 && axis.iter().all(|part| part.is_finite());
    sound.then_some(FittedCylinder { point, axis, radius })
}
