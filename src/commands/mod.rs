//! Subcommands of `bearing`, one module each, and the functions that they share.

mod asked;
pub mod assembly;
mod bushing_warnings;
pub mod check;
pub mod check_mesh;
pub mod compare;
pub mod conform;
mod drift;
pub mod earlier;
pub mod echo;
mod life;
pub mod memory;
pub mod modes;
pub mod pack;
pub mod pictures;
pub mod plan;
pub mod plan_step;
pub mod rubber;
pub mod run;
pub mod schema;
pub mod solid;
pub mod statics;
pub mod sweep;
pub mod table;
mod warnings;

use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::output::visible::visible;
use bearing_dynamics::plan::Item;
use bearing_dynamics::plan::counts::StageCounts;
use bearing_dynamics::scene::build::about::About;
use bearing_dynamics::scene::{Assumption, DefaultUsed, Document};
use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Result of a command that ended without an error.
pub enum Outcome {
    Done,
    /// `compare` found a difference.
    Different,
}

/// An error ends the command: it is printed as one message, with exit code 2.
pub type CommandResult = Result<Outcome, Box<dyn Error>>;

/// Scene keys replaced on the command line (`--set`).
#[derive(clap::Args)]
pub struct Changes {
    /// Replace the value of a scene key, with keys and values as for `sweep --vary`; repeat for more keys
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
}

impl Changes {
    /// The changes as command-line arguments, with a leading space.
    pub fn again(&self) -> String {
        self.set.iter().map(|change| format!(" --set \"{change}\"")).collect()
    }

    /// Reads the scene and replaces its keys; prints a note for each key that this removes.
    pub fn read(&self, scene: &Path) -> Result<Document, Box<dyn Error>> {
        let (document, notes) = self.read_quietly(scene)?;
        notes.iter().try_for_each(|note| print(&format!("note: {note}\n")))?;
        Ok(document)
    }

    /// Reads the scene and replaces its keys; returns the notes instead of printing them.
    pub fn read_quietly(&self, scene: &Path) -> Result<(Document, Vec<String>), Box<dyn Error>> {
        let mut document = Document::read_file(scene)?;
        let (mut keys, mut notes) = (Vec::new(), Vec::new());
        for change in &self.set {
            let (key, value) = change
                .split_once('=')
                .ok_or_else(|| format!("--set {change}: write --set \"key=value\""))?;
            let key = key.trim();
            if keys.contains(&key) {
                return Err(format!("--set {change}: {key} is set twice; give it once").into());
            }
            notes.extend(reach(&document, "--set", change, key)?);
            let removed = document.set(key, value.trim())?;
            if let Some(other) = removed.iter().find(|other| keys.contains(*other)) {
                return Err(format!("--set {change}: it excludes {other}, which is set too").into());
            }
            notes.extend(removed.iter().map(|other| {
                format!("--set {change}: {other} of the scene, which it excludes, is removed")
            }));
            keys.push(key);
        }
        Ok((document, notes))
    }
}

/// Flag set by the first interrupt signal; `again` is called at the second.
///
/// # Errors
/// If the signal handler cannot be installed.
pub fn interruption(again: fn()) -> Result<Arc<AtomicBool>, Box<dyn Error>> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = interrupted.clone();
    ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            again();
        }
    })?;
    Ok(interrupted)
}

/// Note on named tables that override `key` by their own value; `None` if there are none.
///
/// # Errors
/// If all named tables override it, so that `key` has no effect.
pub fn reach(
    document: &Document,
    flag: &str,
    given: &str,
    key: &str,
) -> Result<Option<String>, Box<dyn Error>> {
    let (own, nothing) = document.outside_range(key);
    let table = key.split('.').next().unwrap_or_default();
    let named = |name: &String| format!("[{table}.{name}]");
    let all = own.iter().map(named).collect::<Vec<_>>().join(", ");
    if nothing {
        let name = &own[0];
        let rest = &key[table.len()..];
        return Err(format!(
            "{flag} {given}: {key} has no effect, because {all} {} a value of {} own; write {table}.{name}{rest}",
            if own.len() == 1 { "has" } else { "have" },
            if own.len() == 1 { "its" } else { "their" }
        )
        .into());
    }
    Ok((!own.is_empty()).then(|| {
        format!(
            "{flag} {given}: {all} {} a value of {} own, which is kept",
            if own.len() == 1 { "has" } else { "have" },
            if own.len() == 1 { "its" } else { "their" }
        )
    }))
}

/// Writes to standard output, with terminal control characters made visible. A closed pipe
/// (`bearing … | head`) is no error.
pub fn print(text: &str) -> Result<(), Box<dyn Error>> {
    match std::io::stdout().lock().write_all(visible(text).as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write to standard output: {error}").into())
        }
        _ => Ok(()),
    }
}

/// An error that depends on the mesh, with its position in the scene if it has one.
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

/// Scene, plan, assumptions and defaults for a summary.
pub fn record(
    document: &Document,
    plan: Vec<Item>,
    assumptions: &[Assumption],
    defaults: &[DefaultUsed],
    seconds: Vec<(String, f64)>,
) -> RunRecord {
    let assumptions = assumptions.iter().map(|a| (a.name.clone(), a.text.clone()));
    let default =
        |used: &DefaultUsed| (used.key.clone(), format!("{} ({})", used.value, used.reason));
    RunRecord {
        scene: document.written_out(defaults),
        plan,
        ran: StageCounts::default(),
        assumptions: assumptions.chain(echo::reported(defaults).map(default)).collect(),
        threads: 1,
        seconds,
        sections: Vec::new(),
    }
}

/// The folder given, or `results/NAME-KIND`: one folder for each kind of result of a scene.
pub fn results_folder(scene: &Path, kind: &str, given: &Option<PathBuf>) -> PathBuf {
    given.clone().unwrap_or_else(|| {
        let mut name = scene.file_stem().unwrap_or(scene.as_os_str()).to_os_string();
        name.push("-");
        name.push(kind);
        Path::new("results").join(name)
    })
}
