//! Earlier contents of a results folder: what a command may replace, and its removal.

use super::{pictures, print};
use bearing_dynamics::numeric::clock::rounded;
use bearing_dynamics::output::folder::{FolderContent, ResultsFolder, claim, content};
use bearing_dynamics::output::{fields, json, state};
use std::error::Error;
use std::path::{Path, PathBuf};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Writes {
    Statics,
    Modes,
    /// With `fresh`, also over results of statics or modes.
    Run {
        fresh: bool,
    },
    Sweep,
    Pack,
}

/// Claims the folder for this process. Checks that it is writable, and that only results of the same
/// command are lost.
pub fn claimed(path: &Path, writes: Writes) -> Result<ResultsFolder, Box<dyn Error>> {
    let folder = claim(path)?;
    if !folder.locked {
        print(&format!(
            "note: {} cannot be locked on this file system; let no second command write there\n",
            folder.display()
        ))?;
    }
    refuse_other(&folder, writes)?;
    Ok(folder)
}

/// Returns an error if the folder holds results of another command, or files of another program.
fn refuse_other(folder: &Path, writes: Writes) -> Result<(), Box<dyn Error>> {
    let found = match (content(folder)?, writes) {
        (FolderContent::Nothing, _)
        | (FolderContent::Run, Writes::Run { .. })
        | (FolderContent::Sweep, Writes::Sweep)
        | (FolderContent::Pack, Writes::Pack)
        | (FolderContent::Results(_), Writes::Run { fresh: true }) => return Ok(()),
        (FolderContent::Results(kind), Writes::Statics) if kind.starts_with("static") => {
            return Ok(());
        }
        (FolderContent::Results(kind), Writes::Modes) if kind.contains("modes") => return Ok(()),
        (FolderContent::Results(kind), Writes::Run { fresh: false }) => {
            return Err(format!(
                "{} holds results of another kind ({kind}); name another folder with --out, or write \
                 over them (--fresh)",
                folder.display()
            )
            .into());
        }
        (FolderContent::Results(kind), _) => format!("results of another kind ({kind})"),
        (FolderContent::Run, _) => "a run".to_string(),
        (FolderContent::Sweep, _) => "a sweep".to_string(),
        (FolderContent::Pack, _) => "a case pack".to_string(),
    };
    Err(format!("{} holds {found}; name another folder with --out", folder.display()).into())
}

/// Returns an error if the folder holds an unfinished run.
pub fn refuse_unfinished_run(folder: &Path) -> Result<(), Box<dyn Error>> {
    let of = state::head(&folder.join(state::STATE)).unwrap_or_default();
    if !matches!(of["stopped"].as_str(), Some("running" | "interrupted")) {
        return Ok(());
    }
    let (time, end) = (of["time"].as_f64().unwrap_or(0.0), &of["end"]);
    Err(format!(
        "{} holds an unfinished run at t = {} s of {end} s; resume it (--resume), discard it (--fresh), or \
         choose another --out",
        folder.display(),
        rounded(time)
    )
    .into())
}

/// Removes the result files of an earlier command, and returns whether they were complete. Other files are
/// kept. The summary is removed first, because its presence marks a folder as complete.
pub fn remove_earlier(folder: &Path) -> Result<bool, Box<dyn Error>> {
    const NAMES: [&str; 14] = [
        "summary.json",
        "state.json",
        "series.csv",
        "series.npy",
        "series.columns.json",
        "spectrum.csv",
        "bore.csv",
        "harmonic.csv",
        "curve.csv",
        "reactions.svg",
        "loops.svg",
        fields::LIST,
        "energies.svg",
        "spectrum.svg",
    ];
    let was_complete = folder.join("summary.json").exists();
    // Listed before the columns and the summary that name them are removed.
    let drawn = pictures_by_name(folder);
    let named = NAMES.into_iter().chain(pictures::NAMES).map(|name| folder.join(name));
    let mut to_remove: Vec<_> = named.collect();
    let inside = |folder: &Path, start: &str, end: &str| {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let paths = entries.map(|entry| entry.path());
        let named = paths.filter(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            name.starts_with(start) && name.ends_with(end)
        });
        named.collect::<Vec<_>>()
    };
    to_remove.extend(inside(folder, "probe_", ".svg"));
    to_remove.extend(drawn);
    let files = folder.join(fields::FOLDER);
    for kind in ["fields_", "mode_"] {
        to_remove.extend(inside(&files, kind, ".vtu"));
    }
    for path in to_remove {
        match std::fs::remove_file(&path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(format!("cannot replace {}: {error}", path.display()).into());
            }
            _ => {}
        }
    }
    Ok(was_complete)
}

/// Pictures of the named bodies, sensors and bearings of the earlier results, such as `series_front_loads.svg`. The names
/// come from the columns and the summary; other pictures are kept.
fn pictures_by_name(folder: &Path) -> Vec<PathBuf> {
    const OF_BODIES: [&str; 4] = ["series_", "orbit_", "run_up_", "spectrum_"];
    const OF_BEARINGS: [&str; 4] = ["load_zone_", "slip_", "spin_", "polar_"];
    let columns = json::read(&folder.join("series.columns.json")).unwrap_or_default();
    let summary = json::read(&folder.join("summary.json")).unwrap_or_default();
    let columns: Vec<&str> =
        columns.as_array().into_iter().flatten().filter_map(|of| of["name"].as_str()).collect();
    let has = |name: String| columns.contains(&name.as_str());
    let begins = |name: String| columns.iter().any(|column| column.starts_with(&name));
    // `front_inner_race` has the columns `front_inner_x`, `spindle_at_nose` those of `spindle_nose_y`.
    let of_body = |name: &str| {
        let column = name.strip_suffix("_race").unwrap_or(name).replace("_at_", "_");
        let sensor = name.strip_prefix("sensor_").or_else(|| name.strip_prefix("envelope_"));
        let sensor = sensor.unwrap_or_default();
        let of_sensor = ["acceleration", "reflection"].map(|what| has(format!("{sensor}_{what}")));
        has(format!("{name}_y")) || has(format!("{column}_y")) || of_sensor.contains(&true)
    };
    let of_balls =
        |prefix: &str| ["ball_", "cage_"].iter().any(|of| begins(format!("{prefix}{of}")));
    let of_bearing =
        |name: &str| summary["bearings"][name].is_object() || of_balls(&format!("{name}_"));
    // Spectra of sensors with a sampling rate of their own.
    let is_spectrum = |file: &str| {
        let channel = file.strip_prefix("spectrum_").and_then(|of| of.strip_suffix(".csv"));
        channel.is_some_and(|of| has(of.strip_suffix("_envelope").unwrap_or(of).to_string()))
    };
    let is_drawn = |file: &str| {
        if is_spectrum(file) {
            return true;
        }
        let Some(stem) = file.strip_suffix(".svg") else { return false };
        let loads = stem.strip_prefix("series_").and_then(|of| of.strip_suffix("loads"));
        let of_loads = loads.is_some_and(of_balls);
        let any = |kinds: [&str; 4], of: &dyn Fn(&str) -> bool| {
            kinds.iter().any(|kind| stem.strip_prefix(kind).is_some_and(of))
        };
        let of_one =
            ["slip", "spin", "series_energy", "series_work"].contains(&stem) && has("time".into());
        of_one || of_loads || any(OF_BODIES, &of_body) || any(OF_BEARINGS, &of_bearing)
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    let drawn =
        |path: &PathBuf| path.file_name().is_some_and(|name| is_drawn(&name.to_string_lossy()));
    paths.filter(drawn).collect()
}
