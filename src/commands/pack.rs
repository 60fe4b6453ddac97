//! `bearing pack CASE`.

use super::assembly::statics::{Found, find_equilibrium};
use super::earlier::{Writes, claimed};
use super::solve::solve_scene;
use super::{CommandResult, Outcome, say};
use bearing_dynamics::output::assembly_results::{self, Solved};
use bearing_dynamics::output::compare::tolerance::ToleranceClass;
use bearing_dynamics::output::pack::{PackInput, refuse_foreign_files, write_pack};
use bearing_dynamics::output::results::write_static_results;
use bearing_dynamics::scene::{Document, Subject, resolve, resolve_subject};
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file, or the name of one in scenes/
    case: PathBuf,
    /// Folder of the pack [default: packs/<name of the scene>]
    #[arg(long)]
    out: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let path = find(&arguments.case);
    let start = Instant::now();
    let document = Document::read_file(&path)?;
    let subject = resolve_subject(&document)?;
    if !matches!(subject, Subject::Assembly(_)) {
        // What is more than a bearing is refused, with the reason, before anything is written.
        resolve(&document)?;
    }
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("toml");
    let name = format!("scene.{extension}");
    let stem = path.file_stem().unwrap_or(path.as_os_str());
    let folder = arguments.out.clone().unwrap_or_else(|| Path::new("packs").join(stem));
    let folder = claimed(&folder, Writes::Pack)?;
    refuse_foreign_files(&folder, &name)?;
    let read = start.elapsed().as_secs_f64();
    let input = |resolved| PackInput {
        scene_name: &name,
        scene_text: document.text(),
        resolved,
        class: ToleranceClass::F64Reordered,
    };
    let (manifest, runs) = match &subject {
        Subject::Assembly(scene) => {
            let Found { names, assembly, solution, record, .. } =
                find_equilibrium(&document, scene, read)?;
            let solved = Solved { assembly: &assembly, names: &names, solution: &solution };
            let results = |folder: &Path| assembly_results::write(folder, &solved, &record);
            (write_pack(&folder, &input(&record.scene), &record, results)?, scene.run().is_some())
        }
        _ => {
            let scene = resolve(&document)?;
            let super::solve::Solved { solution, record, .. } = solve_scene(&scene, read)?;
            let results = |folder: &Path| write_static_results(folder, &solution, &record);
            let manifest = write_pack(&folder, &input(&record.scene), &record, results)?;
            (manifest, scene.dynamics.run.is_some())
        }
    };
    let of_run = if runs { ": the statics of this scene; its run is not packed" } else { "" };
    let files = manifest.sha256.len() + 1;
    say(&format!("wrote {files} files to {}{of_run}\n", folder.display()))?;
    Ok(Outcome::Done)
}

/// The path itself if there is such a file, otherwise a scene of that name in `scenes/`.
fn find(case: &Path) -> PathBuf {
    if case.exists() {
        return case.to_path_buf();
    }
    ["toml", "json"]
        .iter()
        .map(|ending| Path::new("scenes").join(case).with_extension(ending))
        .find(|path| path.exists())
        .unwrap_or_else(|| case.to_path_buf())
}
