//! How fast the static equilibrium moves as a bearing rolls on: the velocities of a start that does
//! not ring.
//!
//! As the balls pass under the load the equilibrium goes to and fro (varying compliance). A race
//! placed in it at rest lacks that velocity and rings about the moving equilibrium for as long as
//! nothing damps it.

use super::assembly::Assembly;
use super::equilibrium::{Equilibrium, at, orbital_speed};
use super::model::next_corner;
use super::race::{self, mounted};
use std::f64::consts::TAU;

/// Largest part of a ball pitch between two equilibria. The formula's error for the first harmonic
/// is a third of the square of its phase: 1e-3.
const PITCH_PART: f64 = 1e-2;
/// Longest time between two of them, s: loads change in the meantime.
const LONGEST: f64 = 1e-4;

/// Rates of everything that equilibrium places.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// x, y, z (m/s) and the tilts (rad/s) of each body.
    pub bodies: Vec<[f64; 5]>,
    /// Along the outer race's axis and away from it for each ball of each bearing, m/s.
    pub balls: Vec<Vec<[f64; 2]>>,
}

impl Rates {
    pub fn rest(assembly: &Assembly) -> Rates {
        let balls = assembly.bearings.iter().map(|bearing| bearing.geometry.ball_count);
        Rates {
            bodies: vec![[0.0; 5]; assembly.bodies.len()],
            balls: balls.map(|count| vec![[0.0; 2]; count]).collect(),
        }
    }
}

/// Rates of the equilibrium `now` of t = 0 while balls go round and loads
/// change as they do; by equilibria at and after t = 0, since profiles may begin there.
///
/// At rest where nothing goes round, and where the loads have no equilibrium a moment later. A ball
/// without load has no place of its own and no rate.
pub fn rates(assembly: &Assembly, now: &Equilibrium) -> Rates {
    let rest = Rates::rest(assembly);
    let speeds: Vec<f64> =
        assembly.bearings.iter().map(|bearing| orbital_speed(assembly, bearing, 0.0)).collect();
    let passing = speeds.iter().zip(&assembly.bearings).filter(|(speed, _)| **speed != 0.0).map(
        |(speed, bearing)| PITCH_PART * TAU / bearing.geometry.ball_count as f64 / speed.abs(),
    );
    let Some(dt) = passing.reduce(f64::min) else { return rest };
    let mut dt = dt.min(LONGEST);
    if let Some(corner) = next_corner(&assembly.corners(), 0.0) {
        dt = dt.min(0.5 * corner);
    }
    let later = |t: f64| {
        let turned: Vec<f64> = speeds.iter().map(|speed| speed * t).collect();
        at(assembly, t, &turned, Some(now))
    };
    let (Ok(first), Ok(second)) = (later(dt), later(2.0 * dt)) else { return rest };
    let all = [now, &first, &second];
    // Of second order at t = 0; nothing moves to the bit if all three agree.
    let rate = |[f0, f1, f2]: [f64; 3]| (4.0 * (f1 - f0) - (f2 - f0)) / (2.0 * dt);
    let body = |index: usize| {
        let places = all.map(|of| of.place(assembly, index));
        std::array::from_fn(|i| rate(places.map(|place| place[i])))
    };
    let ball = |bearing: usize, ball: usize| {
        if all.iter().any(|of| of.bearings[bearing].balls[ball].outer.normal_load <= 0.0) {
            return [0.0; 2];
        }
        let places = all.map(|of| {
            let mount = &assembly.bearings[bearing].mounts[1];
            let outer = mounted(&race::fixed(&of.place(assembly, mount.body)), mount).state;
            let from_centre =
                of.bearings[bearing].balls[ball].position - nalgebra::Vector3::from(outer.position);
            let local = outer.orientation.inverse() * from_centre;
            [local.x, libm::hypot(local.y, local.z)]
        });
        std::array::from_fn(|i| rate(places.map(|place| place[i])))
    };
    Rates {
        bodies: (0..assembly.bodies.len()).map(body).collect(),
        balls: (0..assembly.bearings.len())
            .map(|of| (0..now.bearings[of].balls.len()).map(|index| ball(of, index)).collect())
            .collect(),
    }
}
