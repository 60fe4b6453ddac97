//! Position and orientation of the cage from several transceivers (6.2.4).
//!
//! The dissertation asks for three displacements and three rotations and gives no method. Here the readings |S₁₁| of n
//! transceivers at known places are solved for the six coordinates by the Gauss-Newton method.
//!
//! A circular loop has a centre and an axis, five coordinates: rotating it about its own axis changes no reading, wherever
//! the transceivers are. One loop therefore never determines all six coordinates. A centred loop leaves the rotation of
//! the cage undetermined, a loop with a runout the combination of that rotation and a displacement. Two loops with
//! different centres determine all six. Each loop has its own resonance and is read at its own frequency; the coupling
//! of the loops on the cage with each other is neglected.

use crate::ch5_cage::telemeter::{Telemeter, perpendicular};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, norm, scale, sub};
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

/// A transceiver loop, in axes in which the cage's nominal axis is X through the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transceiver {
    /// m.
    pub centre: Vec3,
    /// Unit vector.
    pub axis: Vec3,
}

/// A loop on the cage, about an axis parallel to that of the cage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CageLoop {
    pub circuit: Telemeter,
    /// Centre of the loop in the axes of the cage, m.
    pub centre: Vec3,
}

/// Loops on a cage, each read by all transceivers.
#[derive(Clone, Debug, PartialEq)]
pub struct TelemeterArray {
    pub loops: Vec<CageLoop>,
    pub transceivers: Vec<Transceiver>,
}

/// Displacement along X, Y, Z, m, and rotation vector, rad, of a cage from its nominal position.
pub type CagePose = [f64; 6];

/// Coordinates that readings determine, and how well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observability {
    /// Singular values of the scaled Jacobian, largest first: |S₁₁| per radius of the first loop, or per rad.
    pub singular_values: [f64; 6],
    /// Largest over smallest singular value; infinite if a combination of coordinates changes no reading.
    pub condition: f64,
    /// Standard deviation of each coordinate, m or rad, per standard deviation of independent errors of all readings;
    /// infinite for coordinates that are not observable.
    pub noise_gain: [f64; 6],
}

/// Pose of least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseEstimate {
    pub pose: CagePose,
    /// Root mean square of the differences of the readings.
    pub residual: f64,
    pub iterations: usize,
    pub observability: Observability,
}

#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ArrayError {
    #[error("{found} readings are too few for six coordinates; add transceivers or loops")]
    TooFew { found: usize },
    #[error("{found} readings were given for {wanted} pairs of a loop and a transceiver")]
    OtherCount { found: usize, wanted: usize },
    #[error(
        "the readings cannot be computed at the pose {pose:?} (m, rad): loops touch or values are not finite"
    )]
    NotFinite { pose: CagePose },
    #[error(
        "the pose did not converge in {iterations} iterations; the last residual is {residual:e}"
    )]
    NotConverged { iterations: usize, residual: f64 },
}

/// Difference of the scaled coordinates for the Jacobian: 3 µm for a loop of 31 mm, a thousandth of the distance of the
/// loops.
const STEP: f64 = 1e-4;
/// Singular values below this part of the largest are those of combinations that change no reading.
const BLIND: f64 = 1e-9;
/// Component in such a combination from which on a coordinate is not observable.
const TAKES_PART: f64 = 1e-6;
const MOST_ITERATIONS: usize = 50;
/// Scaled step below which the readings are rounding.
const ROUNDING: f64 = 1e-11;
/// Smallest part of a step that is tried.
const LEAST_FRACTION: f64 = 1e-3;

impl TelemeterArray {
    /// |S₁₁| of every transceiver for the first loop, then for the second, ….
    pub fn readings(&self, pose: &CagePose) -> Vec<f64> {
        let [x, y, z, a, b, c] = *pose;
        let turn = |vector: Vec3| rotated([a, b, c], vector);
        let axis = turn([1.0, 0.0, 0.0]);
        let mut readings = Vec::with_capacity(self.loops.len() * self.transceivers.len());
        for CageLoop { circuit, centre } in &self.loops {
            let centre = add([x, y, z], turn(*centre));
            for transceiver in &self.transceivers {
                let first = perpendicular(transceiver.axis);
                let second = cross(transceiver.axis, first);
                let own = |of: Vec3| [dot(of, transceiver.axis), dot(of, first), dot(of, second)];
                readings.push(circuit.signal(own(sub(centre, transceiver.centre)), own(axis)));
            }
        }
        readings
    }

    /// Pose whose readings are nearest to `readings` in least squares, by Gauss-Newton steps from `start`. Steps are
    /// halved until the residual falls. Combinations of coordinates that change no reading keep their start.
    ///
    /// # Errors
    /// Fewer than six readings, loops that touch, no convergence.
    pub fn estimate(&self, readings: &[f64], start: CagePose) -> Result<PoseEstimate, ArrayError> {
        let wanted = self.loops.len() * self.transceivers.len();
        if readings.len() != wanted {
            return Err(ArrayError::OtherCount { found: readings.len(), wanted });
        }
        let mut pose = start;
        let mut difference = self.difference(readings, &pose)?;
        for iterations in 1..=MOST_ITERATIONS {
            let decomposed = Decomposed::of(&self.jacobian(&pose)?);
            let step = decomposed.step(&difference);
            // A step that is rounding is tried once.
            let least = if step.norm() <= ROUNDING { 1.0 } else { LEAST_FRACTION };
            let mut fraction = 1.0;
            let better = loop {
                let next = self.moved(&pose, &step, fraction);
                let at_next = self.difference(readings, &next);
                if let Some(found) = at_next.ok().filter(|found| found.norm() < difference.norm()) {
                    break Some((next, found));
                }
                fraction *= 0.5;
                if fraction < least {
                    break None;
                }
            };
            let Some((next, found)) = better else {
                // Rounding, or the least residual.
                let residual = rms(&difference);
                let observability = decomposed.observability(&self.scales());
                return Ok(PoseEstimate { pose, residual, iterations, observability });
            };
            (pose, difference) = (next, found);
        }
        let residual = rms(&difference);
        Err(ArrayError::NotConverged { iterations: MOST_ITERATIONS, residual })
    }

    /// Observability of the coordinates at a pose.
    ///
    /// # Errors
    /// As [`TelemeterArray::estimate`].
    pub fn observability(&self, pose: &CagePose) -> Result<Observability, ArrayError> {
        Ok(Decomposed::of(&self.jacobian(pose)?).observability(&self.scales()))
    }

    /// Units of the scaled coordinates: the radius of the first loop, m, and 1 rad.
    fn scales(&self) -> [f64; 6] {
        let radius = self.loops.first().map_or(1.0, |of| of.circuit.radius);
        [radius, radius, radius, 1.0, 1.0, 1.0]
    }

    fn moved(&self, pose: &CagePose, step: &DVector<f64>, fraction: f64) -> CagePose {
        let scales = self.scales();
        [0, 1, 2, 3, 4, 5].map(|i| pose[i] + fraction * scales[i] * step[i])
    }

    fn difference(&self, readings: &[f64], pose: &CagePose) -> Result<DVector<f64>, ArrayError> {
        let own = self.readings(pose);
        let difference = readings.iter().zip(&own).map(|(given, own)| given - own);
        let difference = DVector::from_vec(difference.collect());
        match difference.norm().is_finite() {
            true => Ok(difference),
            false => Err(ArrayError::NotFinite { pose: *pose }),
        }
    }

    /// Central differences of the readings over the scaled coordinates.
    fn jacobian(&self, pose: &CagePose) -> Result<DMatrix<f64>, ArrayError> {
        let count = self.loops.len() * self.transceivers.len();
        if count < 6 {
            return Err(ArrayError::TooFew { found: count });
        }
        let scales = self.scales();
        let columns: Vec<DVector<f64>> = (0..6)
            .map(|i| {
                let [before, after] = [-STEP, STEP].map(|step| {
                    let mut moved = *pose;
                    moved[i] += step * scales[i];
                    DVector::from_vec(self.readings(&moved))
                });
                (after - before) / (2.0 * STEP)
            })
            .collect();
        let jacobian = DMatrix::from_columns(&columns);
        match jacobian.iter().all(|of| of.is_finite()) {
            true => Ok(jacobian),
            false => Err(ArrayError::NotFinite { pose: *pose }),
        }
    }
}

/// Singular value decomposition of a scaled Jacobian, largest singular value first.
struct Decomposed {
    values: Vec<f64>,
    /// Combinations of readings and of coordinates, one a column.
    readings: DMatrix<f64>,
    coordinates: DMatrix<f64>,
}

impl Decomposed {
    fn of(jacobian: &DMatrix<f64>) -> Decomposed {
        // Of the normal matrix the small singular values would lose half their digits.
        let svd = jacobian.clone().svd(true, true);
        let (u, v_t) = (svd.u.unwrap_or_default(), svd.v_t.unwrap_or_default());
        let values = svd.singular_values.iter().copied().collect();
        Decomposed { values, readings: u, coordinates: v_t.transpose() }
    }

    fn is_seen(&self, k: usize) -> bool {
        self.values[k] > BLIND * self.values[0]
    }

    /// Scaled step of least squares in the observable combinations.
    fn step(&self, difference: &DVector<f64>) -> DVector<f64> {
        let mut step = DVector::zeros(6);
        for k in (0..6).filter(|k| self.is_seen(*k)) {
            let along = self.readings.column(k).dot(difference) / self.values[k];
            step += self.coordinates.column(k) * along;
        }
        step
    }

    fn observability(&self, scales: &[f64; 6]) -> Observability {
        let least = if self.is_seen(5) { self.values[5] } else { 0.0 };
        let gain = |i: usize| {
            let share = |k: usize| self.coordinates[(i, k)];
            if (0..6).any(|k| !self.is_seen(k) && share(k).abs() > TAKES_PART) {
                return f64::INFINITY;
            }
            let seen = (0..6).filter(|k| self.is_seen(*k));
            let squares: f64 = seen.map(|k| (share(k) / self.values[k]).powi(2)).sum();
            scales[i] * squares.sqrt()
        };
        Observability {
            singular_values: [0, 1, 2, 3, 4, 5].map(|k| self.values[k]),
            condition: self.values[0] / least,
            noise_gain: [0, 1, 2, 3, 4, 5].map(gain),
        }
    }
}

fn rms(difference: &DVector<f64>) -> f64 {
    difference.norm() / (difference.len() as f64).sqrt()
}

/// A vector rotated by a rotation vector, rad (Rodrigues).
fn rotated(rotation: Vec3, vector: Vec3) -> Vec3 {
    let angle = norm(rotation);
    if angle == 0.0 {
        return vector;
    }
    let (sin, cos) = libm::sincos(angle);
    let axis = scale(rotation, 1.0 / angle);
    let across = add_scaled(scale(vector, cos), sin, cross(axis, vector));
    add_scaled(across, (1.0 - cos) * dot(axis, vector), axis)
}
