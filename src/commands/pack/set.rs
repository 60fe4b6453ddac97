//! A set of case packs from a list of cases.
//!
//! ```toml
//! [[case]]
//! name = "deep_groove_tilt"
//! scene = "../scenes/deep_groove_tilt.toml"   # from the folder of the list
//! of = "statics"                              # or run, modes, sweep, refused
//! set = ["bearing.balls=9"]
//! tags = ["tilt", "hertz-fit"]
//! level = 1
//! # Value and relative tolerance, from another source; entries of lists in order, from 0.
//! expected = { "rotor.whirl.0.frequency" = [13.59, 1e-3] }
//! generated_by = "book"
//! ```

use super::solved::Kind;
use super::tolerances::groups;
use super::{Fallible, write_one};
use crate::commands::earlier::{Writes, claimed};
use crate::commands::{CommandResult, Outcome, print};
use bearing_dynamics::output::compare::tolerance::{ChannelTolerance, Tolerances};
use bearing_dynamics::output::pack::{About, PackInput, write_pack};
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cases {
    case: Vec<Case>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    name: String,
    scene: PathBuf,
    of: String,
    #[serde(default)]
    set: Vec<String>,
    tags: Vec<String>,
    level: u8,
    #[serde(default = "this_program")]
    generated_by: String,
    #[serde(default)]
    expected: BTreeMap<String, [f64; 2]>,
    /// Of a refused scene: line and key that the message names.
    line: Option<u32>,
    key: Option<String>,
}

fn this_program() -> String {
    "this program".into()
}

/// The list in a file; `None` if it is a scene.
pub fn read(path: &Path) -> Fallible<Option<Cases>> {
    let Ok(text) = std::fs::read_to_string(path) else { return Ok(None) };
    if !text.lines().any(|line| line.trim() == "[[case]]") {
        return Ok(None);
    }
    let cases = toml::from_str(&text);
    Ok(Some(cases.map_err(|error| format!("{}: {error}", path.display()))?))
}

/// Writes all packs, each in a folder of its name.
pub fn write(cases: &Cases, list: &Path, folder: &Path, jobs: u16) -> CommandResult {
    let list_folder = list.parent().unwrap_or(Path::new("."));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.into()).build()?;
    let one = |case: &Case| -> Result<(), String> {
        write_case(case, list_folder, &folder.join(&case.name))
            .and_then(|count| print(&format!("{}: {count} files\n", case.name)))
            .map_err(|error| format!("{}: {error}", case.name))
    };
    let each = cases.case.par_iter().map(|case| one(case).err());
    let failed: Vec<String> = pool.install(|| each.flatten_iter().collect());
    print(&format!("wrote {} packs to {}\n", cases.case.len() - failed.len(), folder.display()))?;
    match failed.is_empty() {
        true => Ok(Outcome::Done),
        false => Err(failed.join("; ").into()),
    }
}

fn write_case(case: &Case, list_folder: &Path, folder: &Path) -> Fallible<usize> {
    let folder = claimed(folder, Writes::Pack)?;
    let scene = list_folder.join(&case.scene);
    let about = About {
        kind: case.of.clone(),
        tags: case.tags.clone(),
        level: case.level,
        generated_by: case.generated_by.clone(),
    };
    let kind = match case.of.as_str() {
        "statics" => Kind::Statics,
        "run" => Kind::Run,
        "modes" => Kind::Modes,
        "sweep" => Kind::Sweep,
        "refused" => return write_refused(case, &scene, about, &folder),
        other => {
            return Err(
                format!("of = {other:?}: allowed are statics, run, modes, sweep, refused").into()
            );
        }
    };
    write_one(&scene, (kind, &case.set), about, &case.expected, &folder)
}

/// A scene that is not valid, and what the message names.
fn write_refused(case: &Case, scene: &Path, about: About, folder: &Path) -> Fallible<usize> {
    let text = std::fs::read_to_string(scene)?;
    let summary =
        json!({ "scene": Value::Null, "refused": { "line": case.line, "key": case.key } });
    let input = PackInput {
        scene_name: "scene.toml",
        scene_text: &text,
        files: &[],
        summary: &summary,
        tables: &[],
        tolerances: &Tolerances::default(),
        about,
    };
    Ok(write_pack(folder, &input)?.sha256.len() + 1)
}

/// A summary of the expected values alone, and their tolerances. The units are those of `summary`.
pub fn only_expected(
    summary: &Value,
    expected: &BTreeMap<String, [f64; 2]>,
) -> Fallible<(Value, Tolerances)> {
    let mut only = json!({ "scene": summary["scene"], "kind": summary["kind"] });
    let mut tolerances = Tolerances { groups: groups(), partial: true, ..Tolerances::default() };
    for (path, [value, relative]) in expected {
        let parts: Vec<&str> = path.split('.').collect();
        let pointer = format!("/{}", parts.join("/"));
        let ours = summary.pointer(&pointer).ok_or_else(|| format!("no result {path:?}"))?;
        let mut at = &mut only;
        let mut channel = String::new();
        for part in &parts {
            if let Ok(entry) = part.parse::<usize>() {
                if at.is_null() {
                    *at = json!([]);
                }
                let list = at.as_array_mut().ok_or_else(|| format!("{path}: not a list"))?;
                if list.len() == entry {
                    list.push(Value::Null);
                }
                channel.push_str("[]");
                at = list.get_mut(entry).ok_or_else(|| format!("{path}: entries in order"))?;
            } else {
                let point = if channel.is_empty() { "" } else { "." };
                channel = format!("{channel}{point}{part}");
                at = &mut at[*part];
            }
        }
        *at = json!({ "value": value, "unit": ours["unit"] });
        let own = ChannelTolerance {
            relative: Some(*relative),
            absolute_floor: Some(0.0),
            scale_relative: Some(0.0),
            reason: Some("what the source prints, or its accuracy".into()),
            ..ChannelTolerance::default()
        };
        tolerances.channels.insert(channel, own);
    }
    Ok((only, tolerances))
}
