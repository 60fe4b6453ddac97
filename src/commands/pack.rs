//! `bearing pack CASE`.

use super::assembly::statics::find_equilibrium;
use super::earlier::{Writes, claimed};
use super::sweep::housings::mesh_files;
use super::{CommandResult, Outcome, print};
use bearing_dynamics::output::compare::tolerance::ToleranceClass;
use bearing_dynamics::output::pack::{PackInput, refuse_foreign_files, write_pack};
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
    let Subject::Assembly(scene) = subject else {
        // Returns the reason.
        resolve(&document)?;
        return Err("a case pack needs a scene with bearings".into());
    };
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("toml");
    let name = format!("scene.{extension}");
    let stem = path.file_stem().unwrap_or(path.as_os_str());
    let folder = arguments.out.clone().unwrap_or_else(|| Path::new("packs").join(stem));
    let folder = claimed(&folder, Writes::Pack)?;
    let mut files = mesh_files(&scene)?;
    files.extend(document.bases().into_iter().map(|(name, text)| (name, text.as_bytes().to_vec())));
    let own: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    refuse_foreign_files(&folder, &name, &own)?;
    let read = start.elapsed().as_secs_f64();
    let found = find_equilibrium(&document, &scene, read)?;
    let record = &found.record;
    let input = PackInput {
        scene_name: &name,
        scene_text: document.text(),
        files: &files,
        resolved: &record.scene,
        class: ToleranceClass::F64Reordered,
    };
    let manifest = write_pack(&folder, &input, record, |folder| found.write(folder, record))?;
    let of_run = if scene.run().is_some() {
        ": the statics of this scene; its run is not packed"
    } else {
        ""
    };
    let count = manifest.sha256.len() + 1;
    print(&format!("wrote {count} files to {}{of_run}\n", folder.display()))?;
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
