//! From a resolved scene to its static problem.

use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::frequencies;
use crate::ch2_housing::bearing::hertz::{HertzError, RaceSide, contact};
use crate::equilibrium::initial::{add_reactions, static_assembly};
use crate::equilibrium::lists::StaticAssembly;
use crate::equilibrium::statics::StaticProblem;
use crate::kinematics::{Pose, euler};
use crate::scene::build::assembly::AssemblyScene;
use crate::scene::resolve::resolved::Scene;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// The static problem of a scene.
///
/// # Errors
///
/// Radii without a valid contact (a ball as large as its groove or race).
pub fn static_problem(scene: &Scene) -> Result<StaticProblem, HertzError> {
    let geometry = scene.geometry;
    let side = |side, race| contact(scene.hertz, side, &geometry, &scene.ball_material, race);
    let [x, y, z, tilt_y, tilt_z] = scene.outer_race;
    Ok(StaticProblem {
        geometry,
        inner_contact: side(RaceSide::Inner, &scene.inner_material)?,
        outer_contact: side(RaceSide::Outer, &scene.outer_material)?,
        ball_phase: scene.ball_phase,
        ball_mass: ball_mass(scene),
        gravity: Vector3::from(scene.gravity),
        orbital_speed: if scene.centrifugal { orbital_speed(scene) } else { 0.0 },
        frame: Pose::identity(),
        outer_pose: Pose {
            position: Vector3::new(x, y, z),
            orientation: euler::quaternion(0.0, tilt_y, tilt_z),
        },
        conditions: scene.conditions,
    })
}

/// The lists of a scene in equilibrium at t = 0, as at the start of a motion, without the centrifugal force of the
/// balls unless requested.
pub fn still_lists(scene: &AssemblyScene, assembly: &Assembly) -> StaticAssembly<'static> {
    let mut still = static_assembly(assembly, 0.0, &[]);
    add_reactions(assembly, 0.0, &mut still);
    for (bearing, placed) in still.bearings.iter_mut().zip(&scene.bearings) {
        let speed = if placed.scene.centrifugal { orbital_speed(&placed.scene) } else { 0.0 };
        bearing.centrifugal = ball_mass(&placed.scene) * speed * speed;
    }
    still
}

/// Mass of one ball, kg.
pub fn ball_mass(scene: &Scene) -> f64 {
    let volume = 4.0 / 3.0 * PI * scene.geometry.ball_radius.powi(3);
    scene.ball_material.density * volume
}

/// Speed of the ball set by pure rolling at the nominal contact angle, rad/s; 0 at standstill.
pub fn orbital_speed(scene: &Scene) -> f64 {
    let outer = scene.outer_speed.unwrap_or(0.0);
    outer + kinematic_ratios(scene).cage * (scene.inner_speed.unwrap_or(0.0) - outer)
}

/// Kinematic frequencies of the scene's bearing as ratios to the shaft frequency.
pub fn kinematic_ratios(scene: &Scene) -> frequencies::Frequencies {
    let geometry = &scene.geometry;
    frequencies::ratios(
        geometry.ball_count,
        geometry.ball_radius,
        geometry.pitch_radius,
        geometry.contact_angle,
    )
}
