//! Frames that rotate with each ball's orbit within a step.
//!
//! A stage along the tangent of an orbit of radius R leaves it by s²/2R: micrometres, as much as a contact is deep. In
//! a frame that rotates about X with the ball, and lies along the inertial axes at the beginning of the step, a rolling
//! ball moves little: z' = Rᵀv − Ω × z, likewise for velocity and spin. Ω is constant within a step, so that any method
//! keeps its order.

use crate::members::state::{Layout, POSITION, SPIN, VELOCITY};

/// Rotated vectors of a ball; its orientation stays inertial.
const VECTORS: [usize; 3] = [POSITION, VELOCITY, SPIN];

/// Angular velocities of the balls' frames about X, rad/s.
#[derive(Clone, Debug)]
pub struct OrbitFrames {
    rates: Vec<f64>,
    /// Sine and cosine of the angles at the last call of [`OrbitFrames::turn`].
    turned: Vec<(f64, f64)>,
}

impl OrbitFrames {
    pub fn new(layout: &Layout) -> OrbitFrames {
        OrbitFrames { rates: vec![0.0; layout.balls], turned: vec![(0.0, 1.0); layout.balls] }
    }

    /// Sets the angular velocities to those of the balls about X; the frames are along inertial axes.
    pub fn follow(&mut self, layout: &Layout, state: &[f64]) {
        for (ball, rate) in self.rates.iter_mut().enumerate() {
            let [_, y, z] = layout.ball_vector(state, POSITION, ball);
            let [_, v, w] = layout.ball_vector(state, VELOCITY, ball);
            let square = y * y + z * z;
            *rate = if square > 0.0 { (y * w - z * v) / square } else { 0.0 };
        }
        self.turned.fill((0.0, 1.0));
    }

    /// Rotates the frames by `time` from the beginning of the step.
    pub fn turn(&mut self, time: f64) {
        for (turned, rate) in self.turned.iter_mut().zip(&self.rates) {
            *turned = libm::sincos(rate * time);
        }
    }

    /// Writes `time` times the velocities of the balls of `state` due to the frames' rotation to the entries of their
    /// positions. In a frame the races and pockets rotate backwards: a change with time that closes contacts and that a
    /// linearly implicit step has to include.
    pub fn drift(&self, layout: &Layout, time: f64, state: &[f64], to: &mut [f64]) {
        for (ball, rate) in self.rates.iter().enumerate() {
            let [_, y, z] = layout.ball_vector(state, POSITION, ball);
            to[layout.ball(1) + ball] = -time * rate * z;
            to[layout.ball(2) + ball] = time * rate * y;
        }
    }

    /// Transforms vectors of `state` from the rotated frames to inertial axes.
    pub fn to_inertial(&self, layout: &Layout, state: &mut [f64]) {
        for (ball, (sin, cos)) in self.turned.iter().enumerate() {
            for vector in VECTORS {
                let (at_y, at_z) = (layout.ball(vector + 1) + ball, layout.ball(vector + 2) + ball);
                let (y, z) = (state[at_y], state[at_z]);
                state[at_y] = cos * y - sin * z;
                state[at_z] = sin * y + cos * z;
            }
        }
    }

    /// Transforms rates at `state`, both in inertial axes, to those of the frames' vectors.
    pub fn rates_to_frame(&self, layout: &Layout, state: &[f64], rates: &mut [f64]) {
        for (ball, (rate, (sin, cos))) in self.rates.iter().zip(&self.turned).enumerate() {
            for vector in VECTORS {
                let (at_y, at_z) = (layout.ball(vector + 1) + ball, layout.ball(vector + 2) + ball);
                // Rᵀ(ẋ − Ω × x).
                let y = rates[at_y] + rate * state[at_z];
                let z = rates[at_z] - rate * state[at_y];
                rates[at_y] = cos * y + sin * z;
                rates[at_z] = cos * z - sin * y;
            }
        }
    }
}
