//! Commands on a scene with a single solid, and the functions that they share.

pub mod check;
pub mod modes;
pub mod plan;
pub mod statics;

use super::{placed, print};
use bearing_dynamics::mesh::repair::Repaired;
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::plan::Item;
use bearing_dynamics::scene::build::about::SetupError;
use bearing_dynamics::scene::build::solid::{SolidSetup, setup};
use bearing_dynamics::scene::build::solid_mesh::{BuiltMesh, build};
use bearing_dynamics::scene::{Document, SolidScene};
use bearing_dynamics::solids::support::{FreeMotions, free_motions};
use std::error::Error;
use std::time::Instant;

pub struct Prepared<S = SolidSetup> {
    pub built: BuiltMesh,
    pub setup: S,
    pub free: FreeMotions,
    pub mesh_seconds: f64,
}

/// Reads or generates the mesh. The document locates errors in the scene.
pub fn prepare(document: &Document, scene: &SolidScene) -> Result<Prepared, Box<dyn Error>> {
    let of = |SolidSetup { notes, problem, .. }: &SolidSetup| {
        (notes.clone(), free_motions(&problem.nodes, &problem.prescribed))
    };
    prepared(document, scene, |built| setup(scene, built), of)
}

/// Builds the mesh and a setup on it; `of` returns the notes of the setup and its free rigid-body motions.
pub fn prepared<S>(
    document: &Document,
    scene: &SolidScene,
    setup: impl FnOnce(&BuiltMesh) -> Result<S, SetupError>,
    of: impl FnOnce(&S) -> (Vec<String>, FreeMotions),
) -> Result<Prepared<S>, Box<dyn Error>> {
    let start = Instant::now();
    let mut built = build(&scene.mesh).map_err(|error| placed(document, error.about(), error))?;
    let setup = setup(&built).map_err(|error| placed(document, error.about(), error))?;
    let (notes, free) = of(&setup);
    built.notes.extend(notes);
    Ok(Prepared { built, setup, free, mesh_seconds: start.elapsed().as_secs_f64() })
}

/// Notes on requested repairs and on the mesh file.
pub fn mesh_notes(built: &BuiltMesh) -> Vec<String> {
    let repaired = &built.repaired;
    let done = (*repaired != Repaired::default()).then(|| {
        format!(
            "repaired: {} elements turned, {} nodes joined, {} nodes dropped",
            repaired.turned_elements, repaired.merged_nodes, repaired.dropped_nodes
        )
    });
    done.into_iter().chain(built.notes.iter().cloned()).collect()
}

pub fn print_mesh_notes(built: &BuiltMesh) -> Result<(), Box<dyn Error>> {
    mesh_notes(built).iter().try_for_each(|note| print(&format!("note: {note}\n")))
}

pub fn title(scene: &SolidScene) -> String {
    let title = scene.title.clone().unwrap_or_else(|| "Solid".into());
    // Its forces are those of a quarter.
    if scene.mesh.is_quarter() { format!("{title} (a quarter)") } else { title }
}

/// Scene, assumptions, defaults and plan for the summary.
pub fn record(
    document: &Document,
    scene: &SolidScene,
    plan: Vec<Item>,
    seconds: Vec<(String, f64)>,
) -> RunRecord {
    let (assumptions, defaults) = (&scene.assumptions, &scene.defaults_used);
    super::record(document, plan, assumptions, defaults, seconds)
}
