//! The list of seeded faults, and where each stands in `src`.

use std::collections::{BTreeMap, HashSet};
use std::fmt;
use std::fs;
use std::path::Path;

use serde::Deserialize;

/// Text of every file of `src`, by its path from the root of the repository.
pub type Sources = BTreeMap<String, String>;

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct List {
    #[serde(rename = "mutant")]
    pub mutants: Vec<Mutant>,
}

/// One fault.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mutant {
    pub id: String,
    /// Text that occurs once in all of `src`.
    pub find: String,
    pub replace: String,
    /// What is then wrong, in one sentence.
    pub breaks: String,
    /// The smallest checks that fail.
    pub caught_by: Vec<Check>,
}

impl Mutant {
    /// The file with the text to replace, and the byte at which the text begins.
    ///
    /// # Errors
    /// When the text does not occur exactly once.
    pub fn place<'a>(&self, sources: &'a Sources) -> Result<(&'a str, usize), String> {
        let found: Vec<(&str, usize)> = sources
            .iter()
            .flat_map(|(file, text)| text.match_indices(&self.find).map(|(at, _)| (&**file, at)))
            .collect();
        match found[..] {
            [place] => Ok(place),
            [] => Err(format!("fault `{}`: its text does not occur in src", self.id)),
            _ => {
                let files: Vec<&str> = found.iter().map(|(file, _)| *file).collect();
                Err(format!("fault `{}`: its text occurs in {}", self.id, files.join(", ")))
            }
        }
    }
}

/// A check, written as its arguments: `--test NAME [FUNCTION]`, NAME a file of `tests/` without `.rs`, or `--case ID`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(try_from = "String")]
pub struct Check(Vec<String>);

impl Check {
    /// Name of the test binary, the first folder below `tests/`; `None` for a case.
    pub fn binary(&self) -> Option<&str> {
        self.test().and_then(|(name, _)| name.split('/').next())
    }

    /// File and function of a test.
    pub fn test(&self) -> Option<(&str, Option<&str>)> {
        (self.0[0] == "--test").then(|| (&*self.0[1], self.0.get(2).map(String::as_str)))
    }

    /// Id of a case.
    pub fn case(&self) -> Option<&str> {
        (self.0[0] == "--case").then_some(&self.0[1])
    }
}

impl TryFrom<String> for Check {
    type Error = String;

    fn try_from(text: String) -> Result<Check, String> {
        let words: Vec<String> = text.split_whitespace().map(String::from).collect();
        match (words.first().map(String::as_str), words.len()) {
            (Some("--test"), 2 | 3) | (Some("--case"), 2) => Ok(Check(words)),
            _ => Err(format!("`{text}` is no check: --test NAME [FUNCTION] or --case ID")),
        }
    }
}

impl fmt::Display for Check {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0.join(" "))
    }
}

impl List {
    /// Reads `verification/mutants/mutants.toml` of the repository at `root`.
    ///
    /// # Errors
    /// When the file cannot be read, an id occurs twice, a field is empty, or a fault changes nothing.
    pub fn read(root: &Path) -> Result<List, String> {
        let path = root.join("verification/mutants/mutants.toml");
        let at = |error: &dyn fmt::Display| format!("{}: {error}", path.display());
        let text = fs::read_to_string(&path).map_err(|error| at(&error))?;
        let list: List = toml::from_str(&text).map_err(|error| at(&error))?;
        let mut ids = HashSet::new();
        for mutant in &list.mutants {
            let id = &mutant.id;
            let fields = [id, &mutant.find, &mutant.breaks];
            if fields.iter().any(|field| field.trim().is_empty()) || mutant.caught_by.is_empty() {
                return Err(at(&format!("fault `{id}` has an empty field")));
            }
            if mutant.find == mutant.replace {
                return Err(at(&format!("fault `{id}` changes nothing")));
            }
            if !ids.insert(id) {
                return Err(at(&format!("id `{id}` is used twice")));
            }
        }
        Ok(list)
    }
}

/// Reads every Rust file of `src` below `root`.
///
/// # Errors
/// When a file cannot be read.
pub fn read_sources(root: &Path) -> Result<Sources, String> {
    let mut sources = Sources::new();
    let mut folders = vec![String::from("src")];
    while let Some(folder) = folders.pop() {
        let at = |error: &dyn fmt::Display| format!("{}: {error}", root.join(&folder).display());
        for entry in fs::read_dir(root.join(&folder)).map_err(|error| at(&error))? {
            let path = entry.map_err(|error| at(&error))?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let below = format!("{folder}/{name}");
            if path.is_dir() {
                folders.push(below);
            } else if below.ends_with(".rs") {
                sources.insert(below, fs::read_to_string(&path).map_err(|error| at(&error))?);
            }
        }
    }
    Ok(sources)
}
