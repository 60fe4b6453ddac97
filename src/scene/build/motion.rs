//! From a resolved scene to its bearing in motion.

use crate::assembly::bearing_alone::DynamicProblem;
use crate::ch2_housing::bearing::ball_contact::{BallContactLaw, equal_spheres};
use crate::ch2_housing::bearing::hertz::{HertzError, RaceSide, contact, effective_modulus};
use crate::ch2_housing::bearing::inertia;
use crate::members::body::DrivenBody;
use crate::members::shaft_modes::FreeShaftError;
use crate::scene::resolve::resolved::{CageInRun, RunSettings, Scene};
use thiserror::Error;

/// Errors of a valid scene in a run.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DynamicsError {
    #[error(transparent)]
    Hertz(#[from] HertzError),
    #[error(
        "{part}.inertia: no mass follows from the geometry (it comes out as {mass} kg). \
         Hint: give `inertia = {{ mass = ..., axial = ..., transverse = ... }}` in [{part}]"
    )]
    Inertia { part: &'static str, mass: f64 },
    #[error(
        "bearing.cage.length: no length follows from mass and radii (it comes out as {length} m). \
         Hint: give `length` in [bearing.cage]"
    )]
    CageLength { length: f64 },
    #[error(
        "numerics.end: missing; a run needs it. Hint: add a table [numerics] with `end = \"0.1 s\"`"
    )]
    NoEnd,
    #[error("body.{body}.beam: {error}")]
    Beam { body: String, error: FreeShaftError },
}

/// The bearing in motion of a scene.
///
/// # Errors
///
/// Radii without a valid contact, mass or cage.
pub fn dynamic_problem(scene: &Scene) -> Result<DynamicProblem, DynamicsError> {
    let geometry = scene.geometry;
    let dynamics = &scene.dynamics;
    let side = |side, race| contact(scene.hertz, side, &geometry, &scene.ball_material, race);
    check_mass("inner_race", &dynamics.inner)?;
    if let Some(outer) = &dynamics.outer {
        check_mass("outer_race", outer)?;
    }
    let cage = match &dynamics.cage {
        CageInRun::Body(cage) => {
            let length = cage.contacts.length;
            if !(length > 0.0 && length.is_finite()) {
                return Err(DynamicsError::CageLength { length });
            }
            Some(cage.clone())
        }
        CageInRun::LeftOut(_) => None,
    };
    Ok(DynamicProblem {
        geometry,
        inner_contact: side(RaceSide::Inner, &scene.inner_material)?,
        outer_contact: side(RaceSide::Outer, &scene.outer_material)?,
        ball: inertia::ball(geometry.ball_radius, scene.ball_material.density),
        inner: dynamics.inner.clone(),
        outer: dynamics.outer.clone(),
        outer_start: scene.outer_race,
        cage,
        ball_phase: scene.ball_phase,
        traction: dynamics.traction.clone(),
        slices: dynamics.slices,
        points_across: dynamics.points_across,
        differential_sliding: dynamics.differential_sliding,
        damping: dynamics.damping,
        ball_contact: dynamics.ball_friction.map(|[friction, regularisation_speed]| {
            let modulus = effective_modulus(&scene.ball_material, &scene.ball_material);
            let stiffness = equal_spheres(modulus, geometry.ball_radius);
            BallContactLaw { stiffness, friction, regularisation_speed }
        }),
        raceway_profiles: dynamics.raceway_profiles.clone(),
        ball_deviations: dynamics.ball_deviations.clone(),
        gravity: scene.gravity,
        rotating_load: dynamics.rotating_load.clone(),
        unbalance: dynamics.unbalance,
    })
}

fn check_mass(part: &'static str, race: &DrivenBody) -> Result<(), DynamicsError> {
    let inertia = &race.inertia;
    let all = [inertia.mass, inertia.axial, inertia.transverse];
    if all.iter().all(|value| *value > 0.0 && value.is_finite()) {
        Ok(())
    } else {
        Err(DynamicsError::Inertia { part, mass: inertia.mass })
    }
}

/// Steps and output of the scene's run.
///
/// # Errors
///
/// A scene without an end of the run.
pub fn run_options(scene: &Scene) -> Result<RunSettings, DynamicsError> {
    scene.dynamics.run.clone().ok_or(DynamicsError::NoEnd)
}
