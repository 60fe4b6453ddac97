//! Our own past: the numbers each case gave when they were last accepted, and why.
//!
//! `golden/<case>.json` is compared in every verification run. A difference means that behaviour
//! changed; it is accepted only by writing the file anew with a reason, which is kept. Beside the
//! numbers stand commit, compiler and date of their acceptance, and a digest over all of it, so that
//! a number edited by hand is noticed ([`GoldenFile::unsound`]).

use std::collections::HashSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use thiserror::Error;

use crate::machine::Machine;
use crate::{date, number};

/// Allowed difference: `absolute + relative · |expected|`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoldenTolerance {
    #[serde(with = "number")]
    pub relative: f64,
    /// Floor in the value's unit, for values that may be near zero.
    #[serde(with = "number")]
    pub absolute: f64,
}

impl GoldenTolerance {
    /// Bit for bit: counts, and double precision with a fixed order of operations.
    pub const EXACT: GoldenTolerance = GoldenTolerance { relative: 0.0, absolute: 0.0 };
    /// Double precision whose sums may be ordered differently.
    pub const REORDERED: GoldenTolerance = GoldenTolerance { relative: 1e-9, absolute: 0.0 };
    /// Single and double precision mixed.
    pub const MIXED: GoldenTolerance = GoldenTolerance { relative: 1e-4, absolute: 0.0 };

    /// The same with an absolute floor.
    pub const fn floor(self, absolute: f64) -> GoldenTolerance {
        GoldenTolerance { relative: self.relative, absolute }
    }

    /// Allowed absolute difference from `expected`.
    pub fn allowed(self, expected: f64) -> f64 {
        self.absolute + self.relative * expected.abs()
    }
}

/// One pinned number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoldenValue {
    pub name: String,
    #[serde(with = "number")]
    pub value: f64,
    pub unit: String,
    pub tolerance: GoldenTolerance,
}

/// When the numbers were accepted, and why.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reason {
    pub date: String,
    pub reason: String,
}

/// A `golden/<case>.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoldenFile {
    pub case: String,
    pub crate_version: String,
    pub date: String,
    /// Commit whose program gave the numbers, `+changes` where the work tree differed from it.
    #[serde(default)]
    pub commit: String,
    /// What `rustc --version` said.
    #[serde(default)]
    pub compiler: String,
    /// Oldest first.
    pub history: Vec<Reason>,
    pub values: Vec<GoldenValue>,
    /// [`GoldenFile::digest_of_content`] when the numbers were accepted.
    #[serde(default)]
    pub digest: String,
}

impl GoldenFile {
    /// sha256 over case, version, date, commit, compiler, reasons and values, bit for bit.
    pub fn digest_of_content(&self) -> String {
        let mut hash = Sha256::new();
        // Each part ends in a byte that none contains, so that no two contents read alike.
        let mut part = |text: &str| {
            hash.update(text.as_bytes());
            hash.update([0]);
        };
        for text in [&self.case, &self.crate_version, &self.date, &self.commit, &self.compiler] {
            part(text);
        }
        for entry in &self.history {
            part(&entry.date);
            part(&entry.reason);
        }
        for value in &self.values {
            let GoldenTolerance { relative, absolute } = value.tolerance;
            part(&value.name);
            part(&value.unit);
            for number in [value.value, relative, absolute] {
                part(&format!("{:016x}", number.to_bits()));
            }
        }
        hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// What is wrong with the record of where the numbers come from, if anything is.
    pub fn unsound(&self) -> Option<String> {
        let (hash, changed) = match self.commit.strip_suffix("+changes") {
            Some(hash) => (hash, true),
            None => (self.commit.as_str(), false),
        };
        let is_hash = (7..=40).contains(&hash.len())
            && hash.chars().all(|c| c.is_ascii_digit() || ('a'..='f').contains(&c));
        let well_formed = is_hash || (hash == "unknown" && !changed);
        if !well_formed {
            return Some(format!("its commit is `{}`", self.commit));
        }
        if !self.compiler.starts_with("rustc ") {
            return Some(format!("its compiler is `{}`", self.compiler));
        }
        if self.crate_version.split('.').filter(|part| part.parse::<u32>().is_ok()).count() != 3 {
            return Some(format!("its version is `{}`", self.crate_version));
        }
        if self.history.last().is_none_or(|last| last.date != self.date) {
            return Some("its last reason is not of the date of its numbers".into());
        }
        for entry in &self.history {
            if entry.reason.trim().is_empty() || !date::is_day(&entry.date) {
                return Some(format!("a reason of `{}` is `{}`", entry.date, entry.reason));
            }
        }
        (self.digest != self.digest_of_content()).then(|| {
            "it was edited by hand: what stands there is not what was accepted (digest)".into()
        })
    }
}

#[derive(Debug, Error)]
pub enum GoldenError {
    #[error("a golden file is written only with a reason")]
    EmptyReason,
    #[error("case `{case}` pins nothing")]
    Nothing { case: String },
    #[error("golden value `{name}` is {value}, which is not finite")]
    NotFinite { name: String, value: f64 },
    #[error("golden value `{name}` is pinned twice")]
    Duplicate { name: String },
    #[error("golden value `{name}` has tolerance {relative} relative, {absolute} absolute")]
    Tolerance { name: String, relative: f64, absolute: f64 },
    #[error("{path}: {source}")]
    Io { path: PathBuf, source: io::Error },
    #[error("{path}: {source}")]
    Json { path: PathBuf, source: serde_json::Error },
    #[error("{path} says it belongs to case `{found}`")]
    WrongCase { path: PathBuf, found: String },
}

/// The repository's golden folder.
pub fn default_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../golden")
}

/// Refuse what cannot be pinned: values or tolerances not finite, names used twice.
pub fn validate(values: &[GoldenValue]) -> Result<(), GoldenError> {
    let mut seen = HashSet::new();
    for GoldenValue { name, value, tolerance, .. } in values {
        let name = name.clone();
        if !value.is_finite() {
            return Err(GoldenError::NotFinite { name, value: *value });
        }
        let GoldenTolerance { relative, absolute } = *tolerance;
        let sound = |limit: f64| limit >= 0.0 && limit.is_finite();
        if !(sound(relative) && sound(absolute)) {
            return Err(GoldenError::Tolerance { name, relative, absolute });
        }
        if !seen.insert(name.clone()) {
            return Err(GoldenError::Duplicate { name });
        }
    }
    Ok(())
}

/// Read a case's golden file; `None` where there is none.
pub fn read(folder: &Path, case: &str) -> Result<Option<GoldenFile>, GoldenError> {
    let path = folder.join(format!("{case}.json"));
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(GoldenError::Io { path, source }),
    };
    let file: GoldenFile = serde_json::from_str(&text)
        .map_err(|source| GoldenError::Json { path: path.clone(), source })?;
    if file.case != case {
        return Err(GoldenError::WrongCase { path, found: file.case });
    }
    Ok(Some(file))
}

/// Write a case's golden file with its reason. Returns false, and writes nothing, where every
/// value is already there bit for bit.
pub fn write(
    folder: &Path,
    case: &str,
    values: &[GoldenValue],
    reason: &str,
) -> Result<bool, GoldenError> {
    if reason.trim().is_empty() {
        return Err(GoldenError::EmptyReason);
    }
    if values.is_empty() {
        return Err(GoldenError::Nothing { case: case.to_string() });
    }
    validate(values)?;
    let old = read(folder, case)?;
    if old.as_ref().is_some_and(|file| file.values == values && file.unsound().is_none()) {
        return Ok(false);
    }
    let mut history = old.map_or(Vec::new(), |file| file.history);
    history.push(Reason { date: date::today(), reason: reason.trim().to_string() });
    let machine = Machine::facts();
    let mut file = GoldenFile {
        case: case.to_string(),
        crate_version: machine.crate_version,
        date: date::today(),
        commit: machine.commit.unwrap_or_else(|| "unknown".into()),
        compiler: machine.rustc,
        history,
        values: values.to_vec(),
        digest: String::new(),
    };
    file.digest = file.digest_of_content();
    let path = folder.join(format!("{case}.json"));
    let mut text = serde_json::to_string_pretty(&file)
        .map_err(|source| GoldenError::Json { path: path.clone(), source })?;
    text.push('\n');
    fs::create_dir_all(folder)
        .and_then(|()| crate::report::write_atomically(&path, &text))
        .map_err(|source| GoldenError::Io { path, source })?;
    Ok(true)
}

/// Differences between what was accepted and what a run gave; empty where there is none.
pub fn differences(accepted: &[GoldenValue], now: &[GoldenValue]) -> Vec<String> {
    let mut found = Vec::new();
    for old in accepted {
        let Some(new) = now.iter().find(|value| value.name == old.name) else {
            found.push(format!("{}: no longer computed", old.name));
            continue;
        };
        let allowed = old.tolerance.allowed(old.value);
        let difference = (new.value - old.value).abs();
        let within = difference <= allowed; // false for NaN
        if new.unit != old.unit {
            found.push(format!("{}: unit {} instead of {}", old.name, new.unit, old.unit));
        } else if new.tolerance != old.tolerance {
            found.push(format!("{}: its tolerance changed", old.name));
        } else if !within {
            found.push(format!(
                "{}: {} instead of {} {} (difference {difference:.3e}, allowed {allowed:.3e})",
                old.name, new.value, old.value, old.unit
            ));
        }
    }
    for new in now {
        if !accepted.iter().any(|old| old.name == new.name) {
            found.push(format!("{}: not in the golden file", new.name));
        }
    }
    found
}
