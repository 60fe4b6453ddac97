//! The commands on a scene with a solid of rubber; here what they share.

pub mod plan;
pub mod statics;

use super::placed;
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::scene::rubber_problem::{RubberSetup, rubber_setup};
use bearing_dynamics::scene::solid::RubberScene;
use bearing_dynamics::scene::solid_mesh::{BuiltMesh, build};
use bearing_dynamics::scene::{Document, SolidScene};
use bearing_dynamics::solver::plan::Item;
use bearing_dynamics::solver::solid::support::{FreeMotions, free_motions};
use std::error::Error;
use std::path::Path;
use std::time::Instant;

/// A scene with its mesh, ready to be solved.
pub struct Prepared {
    pub built: BuiltMesh,
    pub setup: RubberSetup,
    pub free: FreeMotions,
    pub mesh_seconds: f64,
}

/// Reads or makes the mesh; the document says where in the scene an error stands.
pub fn prepare(
    document: &Document,
    scene: &SolidScene,
    rubber: &RubberScene,
) -> Result<Prepared, Box<dyn Error>> {
    let start = Instant::now();
    let mut built = build(&scene.mesh).map_err(|error| placed(document, error.about(), error))?;
    let setup = rubber_setup(scene, rubber, &built)
        .map_err(|error| placed(document, Some(error.about()), error))?;
    built.notes.extend(setup.notes.iter().cloned());
    let problem = &setup.model.problem;
    let free = free_motions(&problem.nodes, &problem.prescribed);
    Ok(Prepared { built, setup, free, mesh_seconds: start.elapsed().as_secs_f64() })
}

/// Without inertia nothing stands against a motion of the whole.
pub fn refuse_free(path: &Path, free: &FreeMotions) -> Result<(), Box<dyn Error>> {
    match free.count {
        0 => Ok(()),
        _ => Err(format!(
            "{}: a solid of rubber is solved without inertia and must be held, and this one is free to move {}; add \
             [[solid.held]]",
            path.display(),
            free.names()
        )
        .into()),
    }
}

/// Scene, assumptions, defaults and plan, as every summary has them.
pub fn record(
    scene: &SolidScene,
    plan: Vec<Item>,
    seconds: Vec<(String, f64)>,
) -> Result<RunRecord, Box<dyn Error>> {
    super::solid::record(scene, plan, seconds)
}
