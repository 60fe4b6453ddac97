//! What long cases have computed, kept for the next run.
//!
//! A record is taken only while the case, the code and its inputs are the same: its key is a hash
//! of every source ([`sources`]), the build and the processor. The program itself must have been
//! built from the sources that lie on disk. Only what a case *recorded* is kept; its judgement,
//! by published numbers and golden values, is made anew in every run.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use crate::case::{Case, Tier};
use crate::context::CaseContext;
use crate::runner::Run;
use crate::sources::{self, Sources};
use crate::{date, machine, report};

const FORMAT: &str = "bearing-dynamics verification record 1";
/// Records of a case that stay, so that going back to an earlier state of the code finds its own.
const RECORDS_PER_CASE: usize = 4;

/// A folder of records, and what they are keyed by. [`Cache::none`] holds and keeps nothing.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: PathBuf,
    /// The state of the code, or why there is no telling.
    state: State,
}

#[derive(Clone, Debug)]
enum State {
    Off,
    /// The sources cannot be read: no record is taken or kept.
    Unknown(String),
    Known {
        built_from: Sources,
        on_disk: Sources,
        /// Compiler, flags, target and processor.
        build: String,
    },
}

/// A file of the folder.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    /// Of `kept`, as JSON without blanks.
    sha256: String,
    kept: Kept,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Kept {
    format: String,
    case: String,
    key: String,
    /// Date and time.
    computed: String,
    seconds: f64,
    record: CaseContext,
}

impl Cache {
    /// The cache of this program in `folder`, which need not exist.
    pub fn open(folder: &Path) -> Cache {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let cpu = machine::cpu_model().unwrap_or_default();
        let build = format!("{}{cpu}", include_str!(concat!(env!("OUT_DIR"), "/build.txt")));
        Cache::with(folder, built_from(), &root, &build)
    }

    /// A cache for a program that was built from `built_from`, as `build` says, from what may lie
    /// at `root`.
    pub fn with(folder: &Path, built_from: Sources, root: &Path, build: &str) -> Cache {
        let state = match sources::read(root) {
            Ok(on_disk) => State::Known { built_from, on_disk, build: build.to_string() },
            Err(error) => State::Unknown(format!("{}: {error}", root.display())),
        };
        Cache { folder: folder.to_path_buf(), state }
    }

    /// No cache: every case is computed, nothing is kept.
    pub fn none() -> Cache {
        Cache { folder: PathBuf::new(), state: State::Off }
    }

    /// What a case's record is kept under: the same only if everything that decides its numbers
    /// is. `None` for cases that are always computed, and without a cache.
    ///
    /// # Errors
    /// The program was not built from the sources on disk, or these cannot be read.
    pub fn key(&self, case: &Case) -> Result<Option<String>, String> {
        let (built_from, on_disk, build) = match &self.state {
            _ if case.tier == Tier::Smoke => return Ok(None),
            State::Off => return Ok(None),
            State::Unknown(reason) => return Err(reason.clone()),
            State::Known { built_from, on_disk, build } => (built_from, on_disk, build),
        };
        let (built, now) = (of_case(built_from, case.id), of_case(on_disk, case.id));
        if let Some(path) = first_difference(&built, &now) {
            return Err(format!("{path} is not what this program was built from"));
        }
        if !now.keys().any(|path| path.ends_with("/case.rs")) {
            return Err(format!("case `{}` has no sources", case.id));
        }
        let list = now.iter().map(|(path, hash)| format!("{hash} {path}\n")).collect::<String>();
        let text = format!("{FORMAT}\n{}\n{build}\n{list}", case.id);
        Ok(Some(sources::sha256(text.as_bytes())))
    }

    /// The run that was kept for a case. A file that is missing, cut short or altered is no
    /// record, and no error.
    pub fn take(&self, case: &Case) -> Option<Run> {
        let key = self.key(case).ok()??;
        let text = fs::read_to_string(self.path(case, &key)).ok()?;
        let entry: Entry = serde_json::from_str(&text).ok()?;
        // Byte for byte what was written: a misspelt name of an absent field would read as well.
        let as_written = serde_json::to_string(&entry).ok()? == text;
        let Entry { sha256, kept } = entry;
        let sound = as_written
            && kept.format == FORMAT
            && kept.case == case.id
            && kept.key == key
            && sha256 == hash(&kept).ok()?;
        let Kept { computed, seconds, record, .. } = kept;
        sound.then_some(Run { record, error: None, seconds, computed: Some(computed) })
    }

    /// Keep a run that has just ended, unless it ended early or is of a case always computed.
    ///
    /// # Errors
    /// Why it cannot be kept, in words.
    pub fn keep(&self, case: &Case, run: &Run) -> Result<(), String> {
        if run.error.is_some() {
            return Ok(());
        }
        let Some(key) = self.key(case)? else { return Ok(()) };
        let path = self.path(case, &key);
        let kept = Kept {
            format: FORMAT.to_string(),
            case: case.id.to_string(),
            key,
            computed: date::now(),
            seconds: run.seconds,
            record: run.record.clone(),
        };
        let entry = Entry { sha256: hash(&kept)?, kept };
        let text = serde_json::to_string(&entry).map_err(|error| error.to_string())?;
        fs::create_dir_all(&self.folder)
            .and_then(|()| report::write_atomically(&path, &text))
            .map_err(|error| format!("{}: {error}", path.display()))?;
        self.forget_old(case.id);
        Ok(())
    }

    fn path(&self, case: &Case, key: &str) -> PathBuf {
        self.folder.join(format!("{}-{key}.json", case.id))
    }

    /// Remove all but the newest records of a case; one that cannot be removed does no harm.
    fn forget_old(&self, id: &str) {
        let is_record = |name: &str| {
            let key = name.strip_prefix(id).and_then(|rest| rest.strip_prefix('-'));
            key.and_then(|key| key.strip_suffix(".json")).is_some_and(|key| key.len() == 64)
        };
        let Ok(entries) = fs::read_dir(&self.folder) else { return };
        let mut records = Vec::new();
        for entry in entries.flatten() {
            if is_record(&entry.file_name().to_string_lossy()) {
                let age = entry.metadata().and_then(|facts| facts.modified());
                records.push((age.unwrap_or(SystemTime::UNIX_EPOCH), entry.path()));
            }
        }
        records.sort();
        let surplus = records.len().saturating_sub(RECORDS_PER_CASE);
        for (_, path) in records.into_iter().take(surplus) {
            let _ = fs::remove_file(path);
        }
    }
}

/// The sources this program was built from.
pub fn built_from() -> Sources {
    let list = include_str!(concat!(env!("OUT_DIR"), "/sources.txt"));
    let pairs = list.lines().filter_map(|line| line.split_once(' '));
    pairs.map(|(hash, path)| (path.to_string(), hash.to_string())).collect()
}

/// What a case is built from: everything but the folders of the other cases.
fn of_case(sources: &Sources, id: &str) -> Sources {
    let belongs = |path: &str| {
        let folder = path.strip_prefix("verification/").and_then(|rest| rest.split_once('/'));
        folder.is_none_or(|(name, _)| name == "src" || name == id)
    };
    let of_case = sources.iter().filter(|(path, _)| belongs(path));
    of_case.map(|(path, hash)| (path.clone(), hash.clone())).collect()
}

fn first_difference(one: &Sources, other: &Sources) -> Option<String> {
    let paths = one.keys().chain(other.keys());
    paths.filter(|path| one.get(*path) != other.get(*path)).min().cloned()
}

/// Hash of what is kept, as it reads back: what does not read back the same (a tolerance that is
/// not finite) has none.
fn hash(kept: &Kept) -> Result<String, String> {
    let text = serde_json::to_string(kept).map_err(|error| error.to_string())?;
    serde_json::from_str::<Kept>(&text)
        .map_err(|error| format!("the record does not read back: {error}"))?;
    Ok(sources::sha256(text.as_bytes()))
}
