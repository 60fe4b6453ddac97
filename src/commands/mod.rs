//! One file a subcommand; here what they share.

pub mod check;
pub mod compare;
pub mod echo;
pub mod echo_run;
pub mod housed;
pub mod memory;
pub mod modes;
pub mod pack;
pub mod pictures;
pub mod plan;
pub mod plan_step;
pub mod run;
pub mod run_figures;
pub mod schema;
pub mod solid;
pub mod solve;
pub mod statics;
pub mod sweep;
pub mod table;

use bearing_dynamics::scene::Document;
use bearing_dynamics::scene::about::About;
use bearing_dynamics::solver::clock::rounded;
use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

/// What a command came to when nothing stood in its way.
pub enum Outcome {
    Done,
    /// `compare` found a difference.
    Different,
}

/// Any error that ends a command: it is shown as one message, with exit code 2.
pub type CommandResult = Result<Outcome, Box<dyn Error>>;

/// Writes to standard output; a reader that went away (`bearing … | head`) is no error.
pub fn say(text: &str) -> Result<(), Box<dyn Error>> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write to standard output: {error}").into())
        }
        _ => Ok(()),
    }
}

/// An error that shows only with the mesh, with its place in the scene where it has one.
pub fn placed(
    document: &Document,
    about: Option<About>,
    error: impl Error + 'static,
) -> Box<dyn Error> {
    match about {
        Some(about) => format!("{}: {error}", document.place_of(&about)).into(),
        None => error.into(),
    }
}

/// Refuses to write another kind of results over those of a run, which may be half way.
pub fn refuse_folder_of_run(folder: &Path) -> Result<(), Box<dyn Error>> {
    if folder.join("state.json").exists() {
        let folder = folder.display();
        let text = format!("{folder} holds a run (state.json); name another folder with --out");
        return Err(text.into());
    }
    Ok(())
}

/// Refuses to write a run over results of another kind.
pub fn refuse_folder_of_other(folder: &Path) -> Result<(), Box<dyn Error>> {
    let summary = std::fs::read(folder.join("summary.json")).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap_or_default();
    match summary["kind"].as_str() {
        None | Some("run") => Ok(()),
        Some(kind) => {
            let folder = folder.display();
            let text = format!(
                "{folder} holds results of another kind ({kind}); name another folder with --out, \
                 or write over them (--fresh)"
            );
            Err(text.into())
        }
    }
}

/// Refuses to write over a run of any kind that stands half way.
pub fn refuse_folder_half_way(folder: &Path) -> Result<(), Box<dyn Error>> {
    let state = std::fs::read(folder.join("state.json")).unwrap_or_default();
    let state: serde_json::Value = serde_json::from_slice(&state).unwrap_or_default();
    // That of a bearing in its housing lies a level deeper.
    let of = if state["bearing"].is_object() { &state["bearing"] } else { &state };
    if !matches!(of["stopped"].as_str(), Some("running" | "interrupted")) {
        return Ok(());
    }
    let (time, end) = (of["time"].as_f64().unwrap_or(0.0), &of["end"]);
    Err(format!(
        "{} holds a run that stands at t = {} s of {end} s; go on with it (--resume), discard it \
         (--fresh), or choose another --out",
        folder.display(),
        rounded(time)
    )
    .into())
}

/// `results/<name of the scene>` unless a folder was given.
pub fn results_folder(scene: &Path, given: &Option<PathBuf>) -> PathBuf {
    given.clone().unwrap_or_else(|| {
        let name = scene.file_stem().unwrap_or(scene.as_os_str());
        Path::new("results").join(name)
    })
}
