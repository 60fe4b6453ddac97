//! Frames that rotate with each body within a step.
//!
//! A polynomial in time follows a rotation ωh with an error of (ωh)³, which at some ten thousand revolutions per minute
//! would limit the step. The quaternion is q = r p instead, r the rotation at the angular velocity Ω of the body at the
//! beginning of the step: ṗ = r*(q̇ − ½ Ω q), zero for a steady rotation. Ω is constant within a step, so that any
//! method keeps its order.

use crate::assembly::places::Places;
use crate::kinematics::vec3::{Vec3, dot, scale};
use crate::members::state::{ORIENTATION, SPIN, quaternion_rate};
use nalgebra::Quaternion;

/// Angular velocities of the bodies' frames, rad/s, inertial axes.
#[derive(Clone, Debug)]
pub struct TurningFrames {
    frames: Vec<Frame>,
}

#[derive(Clone, Debug)]
struct Frame {
    /// First entry of the body.
    body: usize,
    spin: Vec3,
    /// Rotation at the last call of [`TurningFrames::turn`].
    turned: Quaternion<f64>,
}

impl TurningFrames {
    pub fn new(places: &Places, bodies: impl Iterator<Item = usize>) -> TurningFrames {
        let frame = |body| Frame {
            body: places.body(body),
            spin: [0.0; 3],
            turned: Quaternion::identity(),
        };
        TurningFrames { frames: bodies.map(frame).collect() }
    }

    /// Sets the angular velocities to those of the bodies; the frames are along inertial axes.
    pub fn follow(&mut self, state: &[f64]) {
        for frame in &mut self.frames {
            frame.spin = [0, 1, 2].map(|i| state[frame.body + SPIN + i]);
            frame.turned = Quaternion::identity();
        }
    }

    /// Rotates the frames by `time` from the beginning of the step.
    pub fn turn(&mut self, time: f64) {
        for frame in &mut self.frames {
            let spin = dot(frame.spin, frame.spin).sqrt();
            let (sin, cos) = libm::sincos(0.5 * spin * time);
            let axis = if spin > 0.0 { scale(frame.spin, sin / spin) } else { [0.0; 3] };
            frame.turned = Quaternion::new(cos, axis[0], axis[1], axis[2]);
        }
    }

    /// Writes `time` times the rates of the quaternions of `state` due to the frames' rotation (see
    /// [`crate::motion::orbit_frame::OrbitFrames::drift`]).
    pub fn drift(&self, time: f64, state: &[f64], to: &mut [f64]) {
        for frame in &self.frames {
            let at = frame.body + ORIENTATION;
            let rate = quaternion_rate(quaternion(state, at), frame.spin);
            (0..4).for_each(|i| to[at + i] = time * rate[i]);
        }
    }

    /// Transforms quaternions of `state` from the rotated frames to inertial axes.
    pub fn to_inertial(&self, state: &mut [f64]) {
        for frame in &self.frames {
            let at = frame.body + ORIENTATION;
            let [w, i, j, k] = quaternion(state, at);
            put(state, at, frame.turned * Quaternion::new(w, i, j, k));
        }
    }

    /// Transforms rates at `state`, both in inertial axes, to those of the frames' quaternions.
    pub fn rates_to_frame(&self, state: &[f64], rates: &mut [f64]) {
        for frame in &self.frames {
            let at = frame.body + ORIENTATION;
            let frame_rate = quaternion_rate(quaternion(state, at), frame.spin);
            let [w, i, j, k] = [0, 1, 2, 3].map(|i| rates[at + i] - frame_rate[i]);
            put(rates, at, frame.turned.conjugate() * Quaternion::new(w, i, j, k));
        }
    }
}

fn quaternion(of: &[f64], at: usize) -> [f64; 4] {
    [of[at], of[at + 1], of[at + 2], of[at + 3]]
}

fn put(to: &mut [f64], at: usize, q: Quaternion<f64>) {
    to[at..at + 4].copy_from_slice(&[q.w, q.i, q.j, q.k]);
}
