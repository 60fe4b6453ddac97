//! `bearing pack CASE`: a case pack, or with a list of cases a set of them.

mod neighbours;
mod set;
mod solved;
mod spread;
mod tolerances;

use super::earlier::{Writes, claimed};
use super::sweep::housings::{mesh_files, solid_mesh_files};
use super::{CommandResult, Outcome, print};
use bearing_dynamics::output::pack::{About, PackInput, refuse_foreign_files, write_pack};
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::scene::{Document, Subject, resolve_subject};
use solved::{Kind, Solved};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Component, Path, PathBuf};

type Fallible<T> = Result<T, Box<dyn Error>>;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file, the name of one in scenes/, or a list of cases (.toml with [[case]])
    case: PathBuf,
    /// Results to pack [default: statics of a scene with bearings, else the run]
    #[arg(long, value_enum)]
    of: Option<Kind>,
    /// Folder of the pack [default: packs/<name of the scene>]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Packs of a list at a time
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: u16,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let path = find(&arguments.case);
    let stem = path.file_stem().unwrap_or(path.as_os_str());
    let folder = arguments.out.clone().unwrap_or_else(|| Path::new("packs").join(stem));
    if let Some(cases) = set::read(&path)? {
        return set::write(&cases, &path, &folder, arguments.jobs);
    }
    let folder = claimed(&folder, Writes::Pack)?;
    let document = Document::read_file(&path)?;
    let subject = resolve_subject(&document)?;
    let kind = arguments.of.unwrap_or(match &subject {
        Subject::Assembly(_) => Kind::Statics,
        Subject::Solid(_) => Kind::Run,
    });
    let about = About {
        kind: kind.name().into(),
        tags: Vec::new(),
        level: 0,
        generated_by: "this program".into(),
    };
    let count = write_one(&path, (kind, &[]), about, &BTreeMap::new(), &folder)?;
    print(&format!("wrote {count} files to {}: {}\n", folder.display(), kind.name()))?;
    Ok(Outcome::Done)
}

/// Solves a scene and writes its pack, with all results or only those that are `expected` from another source;
/// returns the number of files.
fn write_one(
    path: &Path,
    (kind, changes): (Kind, &[String]),
    about: About,
    expected: &BTreeMap<String, [f64; 2]>,
    folder: &Path,
) -> Fallible<usize> {
    let document = Document::read_file(path)?;
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("toml");
    let bases = document.bases();
    let folder_of_scene = path.parent().unwrap_or(Path::new(""));
    let is_inside = |(base, _): &(String, &str)| {
        let is_below =
            Path::new(base).components().all(|part| matches!(part, Component::Normal(_)));
        is_below && folder_of_scene.join(base).exists()
    };
    // With changed keys, or with a base outside, the text of the scene is not the scene.
    let is_as_written = changes.is_empty() && bases.iter().all(is_inside);
    let scene_name = format!("scene.{}", if is_as_written { extension } else { "json" });
    let (mut files, is_meshed) = match resolve_subject(&document)? {
        Subject::Assembly(scene) => {
            let is_housed = scene.bearings.iter().any(|placed| placed.housing.is_some());
            (mesh_files(&scene)?, is_housed)
        }
        Subject::Solid(scene) => (solid_mesh_files(std::iter::once(&*scene))?, true),
    };
    if is_as_written {
        files.extend(bases.into_iter().map(|(name, text)| (name, text.as_bytes().to_vec())));
    }
    let meshes = if is_meshed { solved::meshes(path, changes, &files)? } else { Vec::new() };
    let own: Vec<&str> = files.iter().chain(&meshes).map(|(name, _)| name.as_str()).collect();
    refuse_foreign_files(folder, &scene_name, &[&own[..], &solved::TABLES].concat())?;
    let solved = Solved::of(kind, path, changes)?;
    let (summary, tolerances, tables) = if expected.is_empty() {
        (solved.summary.clone(), tolerances::of(kind, &solved, &files)?, solved.tables(kind)?)
    } else {
        let (summary, tolerances) = set::only_expected(&solved.summary, expected)?;
        (summary, tolerances, Vec::new())
    };
    let scene_text = match is_as_written {
        true => document.text().to_string(),
        false => pretty(&solved.summary["scene"]),
    };
    files.extend(meshes);
    let input = PackInput {
        scene_name: &scene_name,
        scene_text: &scene_text,
        files: &files,
        summary: &summary,
        tables: &tables,
        tolerances: &tolerances,
        about,
    };
    Ok(write_pack(folder, &input)?.sha256.len() + 1)
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
