//! How fast the static equilibrium moves as a bearing rolls on: the velocities of a start that does
//! not ring.
//!
//! As the balls pass under the load the equilibrium goes to and fro (varying compliance). A race
//! placed in it at rest lacks that velocity and rings about the moving equilibrium for as long as
//! nothing damps it.

use super::equilibrium::{Equilibrium, at};
use super::model::{DynamicProblem, next_corner};
use super::race;
use std::f64::consts::TAU;

/// Largest part of a ball pitch between two equilibria. The formula's error for the first harmonic
/// is a third of the square of its phase: 1e-3.
const PITCH_PART: f64 = 1e-2;
/// Longest time between two of them, s: loads change in the meantime.
const LONGEST: f64 = 1e-4;

/// Rates of everything that equilibrium places.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// x, y, z (m/s) and the tilts (rad/s) of each race.
    pub inner: [f64; 5],
    pub outer: [f64; 5],
    /// Along the outer race's axis and away from it for each ball, m/s.
    pub balls: Vec<[f64; 2]>,
}

impl Rates {
    pub fn rest(balls: usize) -> Rates {
        Rates { inner: [0.0; 5], outer: [0.0; 5], balls: vec![[0.0; 2]; balls] }
    }
}

/// Rates of the equilibrium `now` of t = 0 while balls go round at `orbital_speed` (rad/s) and loads
/// change as they do; by equilibria at and after t = 0, since profiles may begin there.
///
/// At rest where nothing goes round, and where the loads have no equilibrium a moment later. A ball
/// without load has no place of its own and no rate.
pub fn rates(problem: &DynamicProblem, now: &Equilibrium, orbital_speed: f64) -> Rates {
    let balls = problem.geometry.ball_count;
    let rest = Rates::rest(balls);
    if orbital_speed == 0.0 {
        return rest;
    }
    let mut dt = (PITCH_PART * TAU / balls as f64 / orbital_speed.abs()).min(LONGEST);
    if let Some(corner) = next_corner(&problem.corners(), 0.0) {
        dt = dt.min(0.5 * corner);
    }
    let later = |t: f64| {
        let ball_phase = problem.ball_phase + orbital_speed * t;
        at(&DynamicProblem { ball_phase, ..problem.clone() }, t, Some(now))
    };
    let (Ok(first), Ok(second)) = (later(dt), later(2.0 * dt)) else { return rest };
    // Of second order at t = 0; nothing moves to the bit if all three agree.
    let rate = |f0: f64, f1: f64, f2: f64| (4.0 * (f1 - f0) - (f2 - f0)) / (2.0 * dt);
    let coordinates = |of: &Equilibrium| -> [f64; 5] { of.solution.coordinates.into() };
    let five = |of: &dyn Fn(&Equilibrium) -> [f64; 5]| -> [f64; 5] {
        let [f0, f1, f2] = [now, &first, &second].map(of);
        std::array::from_fn(|i| rate(f0[i], f1[i], f2[i]))
    };
    let ball = |index: usize| {
        let all = [now, &first, &second];
        if all.iter().any(|of| of.solution.balls[index].outer.normal_load <= 0.0) {
            return [0.0; 2];
        }
        let [f0, f1, f2] = all.map(|of| {
            let outer = race::fixed(&of.outer).state;
            let from_centre =
                of.solution.balls[index].position - nalgebra::Vector3::from(outer.position);
            let local = outer.orientation.inverse() * from_centre;
            [local.x, libm::hypot(local.y, local.z)]
        });
        std::array::from_fn(|i| rate(f0[i], f1[i], f2[i]))
    };
    Rates {
        inner: five(&coordinates),
        outer: five(&|of| of.outer),
        balls: (0..balls).map(ball).collect(),
    }
}
