//! A state, the equations linearised there, and what the matrix leaves over of them.

use crate::dynamics;

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::kinematics::vec3::{Vec3, add, cross, dot, scale};
use bearing_dynamics::members::contacts::{Kernel, Want};
use bearing_dynamics::members::state::{
    Ledger, ORIENTATION, POSITION, SPIN, VELOCITY, quaternion_rate,
};
use bearing_dynamics::motion::block_arrow::BlockArrowMatrix;
use bearing_dynamics::motion::linearised::{Hub, Linearised};
use bearing_dynamics::motion::system::System;
use dynamics::*;

/// Parts of the equations that are judged on their own, each against the largest s J w in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Force on balls along the outer contact's normal, rolling and transverse direction.
    Normal,
    Rolling,
    Transverse,
    /// Moment on balls.
    BallSpin,
    /// Force on a hub (0 inner race, …), moment about its axis and across it.
    Force(usize),
    Torque(usize),
    Tilt(usize),
    /// Power of the drives.
    Drives,
}

pub struct LeftOver(pub Vec<(Part, f64, f64)>);

impl LeftOver {
    pub fn take(&mut self, part: Part, error: f64, change: f64) {
        let at = self.0.iter().position(|(other, ..)| *other == part).unwrap_or_else(|| {
            self.0.push((part, 0.0, 0.0));
            self.0.len() - 1
        });
        let (_, left, whole) = &mut self.0[at];
        // NaN comes in and stays.
        *left = if error.abs() <= *left { *left } else { error.abs() };
        *whole = whole.max(change.abs());
    }

    /// Of the largest s J w of that part.
    pub fn of(&self, part: Part) -> f64 {
        let (_, left, whole) = self.0.iter().find(|(other, ..)| *other == part).unwrap();
        assert!(*whole > 0.0, "nothing happens to {part:?}");
        left / whole
    }

    pub fn check(&self, name: &str, limits: &[(Part, f64)]) {
        let found: Vec<String> =
            self.0.iter().map(|(p, l, w)| format!("{p:?} {:.1e} of {w:.1e}", l / w)).collect();
        println!("{name}: {}", found.join(", "));
        for (part, limit) in limits {
            let part_left = self.of(*part);
            assert!(part_left <= *limit, "{name}, {part:?}: {part_left:e} > {limit:e}");
        }
    }
}

/// A state and what has been linearised there.
pub struct Point {
    pub system: System,
    pub state: Vec<f64>,
    pub linearised: Linearised,
}

pub fn linearised(of: impl Into<Assembly>, state: Vec<f64>) -> Point {
    let mut system = System::new(of, Kernel::Simd);
    let mut rates = vec![0.0; state.len()];
    system.evaluate_with(Want::ForcesAndSlopes, 0.0, &state, &mut rates);
    let mut linearised = Linearised::new(&system);
    linearised.update(&system, &state);
    Point { system, state, linearised }
}

pub fn vector(of: &[f64], at: usize) -> Vec3 {
    [of[at], of[at + 1], of[at + 2]]
}

pub fn six(hub: &Hub, linear: Vec3, turning: Vec3) -> [f64; 6] {
    let [a, b, c] = hub.basis.map(|axis| dot(axis, turning));
    [linear[0], linear[1], linear[2], a, b, c]
}

/// Random displacements (m), velocities (m/s) and both of balls and hubs; angles by the radius.
#[derive(Clone, Copy)]
pub struct Push {
    pub displacement: f64,
    pub velocity: f64,
    /// Displacements of balls only, along the orbit and across it.
    pub tangential: bool,
}

pub const VELOCITIES: Push = Push { displacement: 0.0, velocity: 1.0, tangential: false };
pub const DISPLACEMENTS: Push = Push { displacement: 1.0, velocity: 0.0, tangential: false };

impl Point {
    pub fn push(&self, push: Push, noise: &mut Noise) -> Vec<f64> {
        let layout = self.system.sets[0].layout;
        let geometry = &self.system.assembly.bearings[0].geometry;
        let mut r = vec![0.0; layout.len()];
        for ball in 0..layout.balls {
            let here = self.system.sets[0].table.sliding[layout.padded + ball];
            let (along, across) = (here.rolling_direction, here.transverse_direction);
            let mut moved = noise.vector(push.displacement);
            if push.tangential {
                moved = add(scale(along, moved[0]), scale(across, moved[1]));
            }
            let fast = noise.vector(push.velocity);
            let spin = noise.vector(push.velocity / geometry.ball_radius);
            for i in 0..3 {
                r[layout.ball(POSITION + i) + ball] = moved[i];
                r[layout.ball(VELOCITY + i) + ball] = fast[i];
                r[layout.ball(SPIN + i) + ball] = spin[i];
            }
        }
        for hub in &self.linearised.hubs {
            let per = 1.0 / geometry.pitch_radius;
            let still = if push.tangential { 0.0 } else { 1.0 };
            let moved = noise.vector(push.displacement * still);
            let turned = noise.vector(push.displacement * still * per);
            let (fast, spin) = (noise.vector(push.velocity), noise.vector(push.velocity * per));
            let q = [0, 1, 2, 3].map(|i| self.state[hub.at + ORIENTATION + i]);
            r[hub.at + ORIENTATION..hub.at + VELOCITY].copy_from_slice(&quaternion_rate(q, turned));
            for i in 0..3 {
                r[hub.at + POSITION + i] = moved[i];
                r[hub.at + VELOCITY + i] = fast[i];
                r[hub.at + SPIN + i] = spin[i];
            }
        }
        r
    }

    /// What is left over of the equation for `r`.
    pub fn left_over(&mut self, scale: f64, r: &[f64]) -> LeftOver {
        let Point { system, state, linearised } = self;
        let layout = system.sets[0].layout;
        let mut arrow = BlockArrowMatrix::new(system, linearised);
        arrow.factor(linearised, scale);
        let mut w = vec![0.0; layout.len()];
        arrow.solve(linearised, &system.sets, state, &vec![0.0; state.len()], r, &mut w);
        // Displacements of 1e-11 m at most, a part 1e-5 of the overlaps, and speeds of 1e-6 m/s.
        let displaced = (0..3)
            .flat_map(|i| &w[layout.ball(i)..layout.ball(i) + layout.balls])
            .fold(0.0f64, |largest, x| largest.max(x.abs()));
        let step = (1e-11 / displaced).min(1e-6);
        let sides = [1.0, -1.0].map(|side| {
            let moved: Vec<f64> = state.iter().zip(&w).map(|(x, w)| x + side * step * w).collect();
            let mut rates = vec![0.0; layout.len()];
            system.evaluate(0.0, &moved, &mut rates);
            rates
        });
        let change: Vec<f64> =
            (0..layout.len()).map(|i| scale * (sides[0][i] - sides[1][i]) / (2.0 * step)).collect();
        // The table again as it is at the state itself.
        system.evaluate_with(Want::ForcesAndSlopes, 0.0, state, &mut vec![0.0; layout.len()]);
        let error: Vec<f64> = (0..layout.len()).map(|i| r[i] - w[i] + change[i]).collect();
        let mut left = LeftOver(Vec::new());
        let radius = system.assembly.bearings[0].geometry.ball_radius;
        for ball in 0..layout.balls {
            let contact = system.sets[0].table.contact[layout.padded + ball];
            let tangent = cross([1.0, 0.0, 0.0], contact.outward);
            let directions = [
                (Part::Normal, contact.normal),
                (Part::Rolling, tangent),
                (Part::Transverse, cross(contact.normal, tangent)),
            ];
            let at = |of: &[f64], component| layout.ball_vector(of, component, ball);
            for (part, direction) in directions {
                let along = |of: &[f64]| dot(at(of, VELOCITY), direction);
                left.take(part, along(&error), along(&change));
                let turning = |of: &[f64]| radius * dot(at(of, SPIN), direction);
                left.take(Part::BallSpin, turning(&error), turning(&change));
            }
            // Positions follow from velocities to rounding.
            let (x, v) = (at(&w, POSITION), at(&w, VELOCITY));
            for i in 0..3 {
                let follows = at(r, POSITION)[i] + scale * v[i];
                assert!((x[i] - follows).abs() <= 1e-12 * follows.abs().max(x[i].abs()));
            }
        }
        for (index, hub) in linearised.hubs.iter().enumerate() {
            let part = |of: &[f64]| {
                let turning = vector(of, hub.at + SPIN);
                six(hub, vector(of, hub.at + VELOCITY), turning)
            };
            let (error, change) = (part(&error), part(&change));
            for i in 0..6 {
                let kind = match i {
                    0..3 => Part::Force(index),
                    3 => Part::Torque(index),
                    _ => Part::Tilt(index),
                };
                left.take(kind, error[i], change[i]);
            }
        }
        let drives = layout.ledger_entry(Ledger::Drives);
        left.take(Part::Drives, error[drives], change[drives]);
        left
    }
}
