//! Commands on a scene with a solid of rubber, and the functions that they share.

pub mod plan;
pub mod statics;

use super::solid;
use bearing_dynamics::scene::build::rubber::{RubberSetup, rubber_setup};
use bearing_dynamics::scene::resolve::solid_scene::RubberScene;
use bearing_dynamics::scene::{Document, SolidScene};
use bearing_dynamics::solids::support::{FreeMotions, free_motions};
use std::error::Error;
use std::path::Path;

pub type Prepared = solid::Prepared<RubberSetup>;

/// Reads or generates the mesh. The document locates errors in the scene.
pub fn prepare(
    document: &Document,
    scene: &SolidScene,
    rubber: &RubberScene,
) -> Result<Prepared, Box<dyn Error>> {
    let of = |setup: &RubberSetup| {
        let problem = &setup.model.problem;
        (setup.notes.clone(), free_motions(&problem.nodes, &problem.prescribed))
    };
    solid::prepared(document, scene, |built| rubber_setup(scene, rubber, built), of)
}

/// Returns an error if the solid can move as a rigid body: without inertia nothing resists that.
pub fn refuse_free(path: &Path, free: &FreeMotions) -> Result<(), Box<dyn Error>> {
    match free.count {
        0 => Ok(()),
        _ => Err(format!(
            "{}: the solid of rubber is free to move {}, and without inertia it needs supports; add [[solid.fixed]]",
            path.display(),
            free.names()
        )
        .into()),
    }
}
