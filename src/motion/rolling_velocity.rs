//! Velocity of the static equilibrium of a rolling bearing, for a start without transients.
//!
//! As the balls pass under the load the equilibrium oscillates (varying compliance). A race placed in it at rest lacks
//! that velocity and vibrates about the moving equilibrium until damped.
//!
//! Three equilibria give the velocity as long as they are on one branch. If loads do not determine the position, or the
//! race jumps to another branch, all velocities are zero.

use crate::assembly::lists::Assembly;
use crate::assembly::prescribed::orbital_speed;
use crate::equilibrium::initial::{Equilibrium, at};
use crate::equilibrium::statics::Determinacy;
use crate::members::bearing::Bearing;
use crate::members::body::is_fixed;
use crate::members::rigid_body;
use crate::members::rigid_body::kinematics_at_mount;
use crate::numeric::profile::next_corner;
use std::f64::consts::TAU;

/// Largest part of a ball pitch between two equilibria. The formula's error for the first harmonic
/// is a third of the square of its phase: 1e-3.
const PITCH_PART: f64 = 1e-2;
/// Longest time between two of them, s; loads change in the meantime.
const LONGEST: f64 = 1e-4;
/// Largest relative difference of two steps on one branch. Loads that begin at zero displace a contact by t^(2/3),
/// 0.41; a jump is 1.
const BEND: f64 = 0.5;
/// Or this part of overlap and clearance: at a turning point of the equilibrium its steps are as small as their
/// difference, 0.004 of the amplitude.
const TURN: f64 = 1e-2;
/// Largest displacement along directions without stiffness, in the same unit.
const STRAY: f64 = 1e-4;

/// Rates of all coordinates of an equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// x, y, z (m/s) and the tilts (rad/s) of each body.
    pub bodies: Vec<[f64; 5]>,
    /// Along the outer race's axis and away from it for each ball of each bearing, m/s.
    pub balls: Vec<Vec<[f64; 2]>>,
    /// Amplitudes of each flexible body, m/s.
    pub shafts: Vec<Vec<f64>>,
}

impl Rates {
    pub fn rest(assembly: &Assembly) -> Rates {
        let balls = assembly.bearings.iter().map(|bearing| bearing.geometry.ball_count);
        Rates {
            bodies: vec![[0.0; 5]; assembly.bodies.len()],
            balls: balls.map(|count| vec![[0.0; 2]; count]).collect(),
            shafts: assembly.shafts.iter().map(|of| vec![0.0; of.amplitudes()]).collect(),
        }
    }
}

/// Rates of the equilibrium `now` at t = 0 as balls orbit and loads change, from equilibria at and after t = 0, since
/// profiles may begin there.
///
/// Zero if nothing rotates, if a later equilibrium does not exist, if the loads do not determine the position, and if
/// the three are not on one branch. Unloaded balls have no rate.
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
    if !one_branch(assembly, all) {
        return rest;
    }
    // Second order at t = 0; zero to the bit if all three agree.
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
            let outer =
                kinematics_at_mount(&rigid_body::fixed(&of.place(assembly, mount.body)), mount)
                    .state;
            let from_centre =
                of.bearings[bearing].balls[ball].position - nalgebra::Vector3::from(outer.position);
            let local = outer.orientation.inverse() * from_centre;
            [local.x, libm::hypot(local.y, local.z)]
        });
        let steady = |i: usize| bends_little(places.map(|place| place[i]), room(assembly, all));
        if !(steady(0) && steady(1)) {
            return [0.0; 2];
        }
        std::array::from_fn(|i| rate(places.map(|place| place[i])))
    };
    Rates {
        bodies: (0..assembly.bodies.len()).map(body).collect(),
        balls: (0..assembly.bearings.len())
            .map(|of| (0..now.bearings[of].balls.len()).map(|index| ball(of, index)).collect())
            .collect(),
        shafts: (0..assembly.shafts.len())
            .map(|of| {
                let amplitude = |k: usize| rate(all.map(|at| at.amplitudes[of][k]));
                (0..now.amplitudes[of].len()).map(amplitude).collect()
            })
            .collect(),
    }
}

/// Free play of the parts: the deepest overlap of any of the equilibria and the largest clearance, m.
fn room(assembly: &Assembly, all: [&Equilibrium; 3]) -> f64 {
    let balls = all.into_iter().flat_map(|of| of.bearings.iter().flat_map(|b| &b.balls));
    let overlap =
        balls.fold(0.0f64, |most, ball| most.max(ball.inner.approach).max(ball.outer.approach));
    let bearings = assembly.bearings.iter();
    overlap + bearings.fold(0.0f64, |most, bearing| most.max(bearing.geometry.radial_clearance))
}

/// Returns whether three positions (m) at equal times are on one smooth curve.
fn bends_little([f0, f1, f2]: [f64; 3], room: f64) -> bool {
    let [before, after] = [f1 - f0, f2 - f1];
    (after - before).abs() <= (BEND * before.abs().max(after.abs())).max(TURN * room)
}

/// Returns whether all equilibria are determined by the loads and follow each other without a jump.
fn one_branch(assembly: &Assembly, all: [&Equilibrium; 3]) -> bool {
    let [_, first, second] = all;
    // The search near a known equilibrium has jumped to another.
    if first.saddles_left + second.saddles_left > 0 {
        return false;
    }
    let room = room(assembly, all);
    // Tilts as displacements, m, of any bearing.
    let arm = assembly.bearings.iter().fold(0.0f64, |most, b| most.max(b.geometry.pitch_radius));
    let scale = [1.0, 1.0, 1.0, arm, arm];
    let smooth = (0..assembly.bodies.len()).all(|body| {
        let places = all.map(|of| of.place(assembly, body));
        (0..5).all(|i| bends_little(places.map(|place| scale[i] * place[i]), room))
    });
    smooth && !strays(assembly, all, STRAY * room)
}

/// Returns whether the equilibrium moves by more than `allowed` (m) along directions without stiffness.
fn strays(assembly: &Assembly, [now, _, second]: [&Equilibrium; 3], allowed: f64) -> bool {
    let Determinacy::Indeterminate { free_directions } = &now.determinacy else { return false };
    // Unknowns of the search: free bodies, tilts times their bearing's pitch radius.
    let unknowns = assembly.bodies.iter().enumerate().filter(|(_, body)| !is_fixed(body));
    let moved: Vec<f64> = unknowns
        .flat_map(|(body, _)| {
            let is_on_body =
                |bearing: &&Bearing| bearing.mounts.iter().any(|mount| mount.body == body);
            let pitch =
                assembly.bearings.iter().find(is_on_body).map_or(1.0, |b| b.geometry.pitch_radius);
            let [from, to] = [now, second].map(|of| of.place(assembly, body));
            let scale = [1.0, 1.0, 1.0, pitch, pitch];
            std::array::from_fn::<f64, 5, _>(|i| scale[i] * (to[i] - from[i]))
        })
        .collect();
    free_directions.iter().any(|direction| {
        let along: f64 = direction.iter().zip(&moved).map(|(part, moved)| part * moved).sum();
        along.abs() > allowed
    })
}
