//! A case pack: a scene and its expected results, for checking another program.
//!
//! | file | content |
//! |---|---|
//! | `scene.toml` or `scene.json` | the scene as written by the user; with changed keys as in `resolved.json` |
//! | meshes and bases | files that the scene refers to, in folders of the same names |
//! | `resolved.json` | the scene as one file that can be read, in SI: bases merged, defaults filled in |
//! | `summary.json`, `series.csv`, … | the expected results, without what describes the solution process |
//! | `tolerances.json` | tolerances of the comparison |
//! | `README.txt` | how to use the pack |
//! | `manifest.json` | kind, tags, level, origin, sha256 of all files, and the program version |

use crate::output::atomic::{WriteError, write_atomic};
use crate::output::compare::tolerance::{ToleranceError, Tolerances};
use crate::output::results::pretty;
use crate::scene::text::input_file;
use crate::scene::text::input_file::{InputError, LARGEST_DATA, LARGEST_JSON};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use thiserror::Error;

pub const MANIFEST: &str = "manifest.json";
/// Only packs have this file: a folder with it and without a manifest is an incomplete pack.
pub const RESOLVED: &str = "resolved.json";

/// What a case is about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct About {
    /// The command that gives its results: `statics`, `run`, `modes`, `sweep`; `refused` for a scene that is not valid.
    pub kind: String,
    /// What a program needs for it.
    pub tags: Vec<String>,
    /// 1: equilibria of bearings, 2: motion, 3: solids, 4: coupled; 0: not stated.
    pub level: u8,
    /// Where the expected numbers are from: `this program`, `closed form`, `book`, `other program`.
    pub generated_by: String,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    pub program: String,
    pub version: String,
    pub about: About,
    /// File name → sha256 of its bytes, as 64 lower-case hexadecimal digits.
    pub sha256: BTreeMap<String, String>,
}

#[derive(Clone, Debug)]
pub struct PackInput<'a> {
    /// `scene.toml` or `scene.json`.
    pub scene_name: &'a str,
    pub scene_text: &'a str,
    /// Files that the scene refers to: paths relative to it, and contents.
    pub files: &'a [(String, Vec<u8>)],
    /// Expected `summary.json`, as a command wrote it; its `scene` becomes `resolved.json`.
    pub summary: &'a Value,
    /// Expected tables: names and contents.
    pub tables: &'a [(String, Vec<u8>)],
    pub tolerances: &'a Tolerances,
    pub about: About,
}

#[derive(Debug, Error)]
pub enum PackError {
    #[error("{name:?} is not a plain file name")]
    SceneName { name: String },
    #[error(
        "{name:?} is outside the scene's folder or has the name of another file of the pack. Hint: put meshes \
         and bases next to the scene and write their names without a path"
    )]
    Elsewhere { name: String },
    #[error(
        "{} exists and holds {found:?}, which is not part of a case pack; name another folder with --out",
        folder.display()
    )]
    Foreign { folder: PathBuf, found: String },
    #[error(transparent)]
    Tolerance(#[from] ToleranceError),
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error("cannot read {}: {source}", path.display())]
    Read { path: PathBuf, source: InputError },
    #[error("{} is not a manifest: {source}", path.display())]
    Manifest { path: PathBuf, source: serde_json::Error },
    #[error("{name}: sha256 is {found}, the manifest says {expected}")]
    Hash { name: String, expected: String, found: String },
    #[error("{name} is in the folder but not in the manifest")]
    Unlisted { name: String },
    #[error("the manifest does not list {name}")]
    Incomplete { name: String },
}

/// Parts of a summary that describe the solution process or repeat the input: not expected of another program.
const NOT_PACKED: [&str; 16] = [
    "program",
    "threads",
    "seconds",
    "plan",
    "stages",
    "solver",
    "work",
    "step",
    "output",
    "scene",
    "assumptions",
    "defaults",
    "warnings",
    "mesh",
    "motion",
    "complete",
];

/// The parts of a summary that a pack expects; a sweep has none.
pub fn expected(summary: &Value) -> Option<Value> {
    let mut kept = summary.clone();
    let parts = kept.as_object_mut()?;
    parts.retain(|name, _| !NOT_PACKED.contains(&name.as_str()));
    if parts.is_empty() {
        return None;
    }
    without_process(&mut kept, false);
    Some(kept)
}

/// At any place: meshes and solvers of housings and shafts, shares of energy in modes, and explanations.
const NOT_PACKED_BELOW: [&str; 17] = [
    "turned_over",
    "mesh",
    "solver",
    "condensed",
    "largest_unbalanced_part_of_load",
    "across",
    "housings_share",
    "moves_most",
    "fastest_excitation",
    "peak_pressure_note",
    "leakage",
    "rolling_at",
    "slip_is",
    "contact_angle_is",
    "amplitude_is",
    "median_around_is",
    "not_separated_from",
];

/// Parts whose entries have names that the scene gives.
const NAMED: [&str; 9] = [
    "probes",
    "supports",
    "bearings",
    "housings",
    "bodies",
    "geometry",
    "hertz",
    "rating_life",
    "kinematics",
];

/// Removes what describes the process from a part of a summary; of one with names only texts.
fn without_process(value: &mut Value, is_named: bool) {
    match value {
        Value::Object(parts) => {
            parts.retain(|name, of| {
                // "every accepted step", "kinematic frequencies".
                let explains = of.is_string() && ["of", "are"].contains(&name.as_str());
                let is_process = NOT_PACKED_BELOW.contains(&name.as_str());
                !explains && (!is_process || is_named && !of.is_string())
            });
            for (name, part) in parts {
                without_process(part, NAMED.contains(&name.as_str()));
            }
        }
        Value::Array(list) => list.iter_mut().for_each(|of| without_process(of, false)),
        _ => {}
    }
}

/// Writes the pack and returns its manifest.
///
/// # Errors
/// A folder that holds other files, a file that cannot be written.
pub fn write_pack(folder: &Path, input: &PackInput) -> Result<Manifest, PackError> {
    let taken = |name: &str| EXPECTED.contains(&name) || name == "summary.json";
    if !is_plain_name(input.scene_name) || taken(input.scene_name) {
        return Err(PackError::SceneName { name: input.scene_name.to_string() });
    }
    let taken = |name: &str| {
        taken(name)
            || name == input.scene_name
            || input.tables.iter().any(|(table, _)| table == name)
    };
    if let Some((name, _)) = input.files.iter().find(|(name, _)| !is_below(name) || taken(name)) {
        return Err(PackError::Elsewhere { name: name.clone() });
    }
    let tables = input.tables.iter();
    let own: Vec<&str> = input.files.iter().chain(tables).map(|(name, _)| name.as_str()).collect();
    refuse_foreign_files(folder, input.scene_name, &own)?;
    input.tolerances.check()?;
    // The manifest is written last: a pack without one is incomplete.
    let _ = std::fs::remove_file(folder.join(MANIFEST));
    let tolerances = serde_json::to_value(input.tolerances).expect("tolerances are plain JSON");
    let mut texts = vec![
        (input.scene_name, input.scene_text.to_string()),
        (RESOLVED, pretty(&input.summary["scene"])),
        ("tolerances.json", pretty(&tolerances)),
        ("README.txt", readme(input)),
    ];
    texts.extend(expected(input.summary).map(|summary| ("summary.json", pretty(&summary))));
    for (name, text) in &texts {
        write_atomic(&folder.join(name), text.as_bytes())?;
    }
    for (name, bytes) in input.files.iter().chain(input.tables) {
        let path = folder.join(name);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(|source| PackError::Read {
                path: parent.to_path_buf(),
                source: source.into(),
            })?;
        }
        write_atomic(&path, bytes)?;
    }
    let mut sha256 = BTreeMap::new();
    for name in texts.iter().map(|(name, _)| *name).chain(own) {
        sha256.insert(name.to_string(), hash(&folder.join(name))?);
    }
    let version = env!("CARGO_PKG_VERSION").to_string();
    let about = input.about.clone();
    let manifest = Manifest { program: "bearing-dynamics".into(), version, about, sha256 };
    let text = pretty(&serde_json::to_value(&manifest).expect("a manifest is plain JSON"));
    write_atomic(&folder.join(MANIFEST), text.as_bytes())?;
    Ok(manifest)
}

/// What every pack has, besides scene and manifest; only a sweep has no summary.
const EXPECTED: [&str; 3] = ["README.txt", RESOLVED, "tolerances.json"];

/// Checks every file of a pack against its manifest.
///
/// # Errors
/// The first file that is missing, altered, or not listed; a manifest without a required file.
pub fn verify_pack(folder: &Path) -> Result<Manifest, PackError> {
    let path = folder.join(MANIFEST);
    let bytes = input_file::read(&path, LARGEST_JSON)
        .map_err(|source| PackError::Read { path: path.clone(), source })?;
    let manifest: Manifest =
        serde_json::from_slice(&bytes).map_err(|source| PackError::Manifest { path, source })?;
    // Without its summary a pack would pass with less compared.
    let summary = (manifest.about.kind != "sweep").then_some("summary.json");
    for name in EXPECTED.into_iter().chain(summary) {
        if !manifest.sha256.contains_key(name) {
            return Err(PackError::Incomplete { name: name.to_string() });
        }
    }
    for (name, expected) in &manifest.sha256 {
        if !is_below(name) {
            return Err(PackError::SceneName { name: name.clone() });
        }
        let found = hash(&folder.join(name))?;
        if found != *expected {
            return Err(PackError::Hash { name: name.clone(), expected: expected.clone(), found });
        }
    }
    for name in file_names(folder)? {
        if name != MANIFEST && !manifest.sha256.contains_key(&name) {
            return Err(PackError::Unlisted { name });
        }
    }
    Ok(manifest)
}

fn readme(input: &PackInput) -> String {
    let rows = input.tolerances.rows.map(|rows| {
        format!(
            "The run is chaotic: the first {rows} rows of tables are compared, and statistics.\n"
        )
    });
    let kind = input.about.kind.as_str();
    if kind == "refused" {
        return format!(
            "Case pack: a scene that is not valid. A program refuses {}: exit code 2, and a message with the key and the \
             line that summary.json names.\n",
            input.scene_name
        );
    }
    let files = if kind == "sweep" { "the tables" } else { "summary.json and the tables" };
    format!(
        "Case pack: a scene, and the expected results for checking another program.

1. Solve resolved.json ({kind}) with your program. {scene} is the same scene, as written or with changed keys.
2. Write {files} in the same format into a folder, say candidate.
3. Run, from the folder that holds this one:

       bearing compare pack/ candidate/

   (with the name of this folder for pack/). Exit code 0: equal within tolerance; 1: different,
   with the first difference; 2: a file could not be read.

{rows}tolerances.json has the tolerances and their reasons. manifest.json has the sha256 of every file. If a ball has no load in both
contacts of the reference, its position, approaches (gaps) and contact angles are not compared
either (except in class f64-exact), because they are not determined. Units are in the headers of tables and
in the values of summary.json.
",
        scene = input.scene_name,
        rows = rows.unwrap_or_default(),
    )
}

fn is_plain_name(name: &str) -> bool {
    is_below(name) && Path::new(name).components().count() == 1
}

/// Returns whether a relative path leads to a file in the same folder or below, other than the manifest.
fn is_below(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    let written: Vec<&str> = name.split('/').collect();
    parts.clone().count() == written.len()
        && parts.all(|part| matches!(part, Component::Normal(_)))
        && name != MANIFEST
}

/// Rejects a folder with files that are not part of a pack; an older pack may be replaced.
///
/// # Errors
/// [`PackError::Foreign`] with the first such file; a folder that cannot be read.
pub fn refuse_foreign_files(
    folder: &Path,
    scene_name: &str,
    files: &[&str],
) -> Result<(), PackError> {
    if !folder.exists() {
        return Ok(());
    }
    for name in file_names(folder)? {
        let known = [MANIFEST, "summary.json", scene_name]
            .into_iter()
            .chain(EXPECTED)
            .chain(files.iter().copied());
        if known.into_iter().all(|known| known != name) {
            return Err(PackError::Foreign { folder: folder.to_path_buf(), found: name });
        }
    }
    Ok(())
}

/// Relative paths of all files in a folder and below.
fn file_names(folder: &Path) -> Result<Vec<String>, PackError> {
    let failed = |source: std::io::Error| PackError::Read {
        path: folder.to_path_buf(),
        source: source.into(),
    };
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.file_type().map_err(failed)?.is_dir() {
            names.extend(file_names(&entry.path())?.into_iter().map(|own| format!("{name}/{own}")));
        } else {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

fn hash(path: &Path) -> Result<String, PackError> {
    let bytes = input_file::read(path, LARGEST_DATA)
        .map_err(|source| PackError::Read { path: path.to_path_buf(), source })?;
    Ok(Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect())
}
