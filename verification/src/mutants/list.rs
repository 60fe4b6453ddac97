//! The list of faults: reading it, and whether each still applies.

use std::collections::HashSet;
use std::fmt;
use std::fs;
use std::path::Path;

use serde::{Deserialize, Deserializer, de};

/// The data file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct List {
    /// Run in turn on a fault that the checks named for it let pass.
    pub fallback: Vec<Check>,
    #[serde(rename = "mutant")]
    pub mutants: Vec<Mutant>,
}

/// One fault.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mutant {
    pub id: String,
    /// From the repository's root.
    pub file: String,
    /// Text that stands in the file exactly once.
    pub find: String,
    pub replace: String,
    /// What is wrong with the physics then.
    pub breaks: String,
    /// The smallest checks that notice.
    pub caught_by: Vec<Check>,
}

impl Mutant {
    /// Everything that decides what the fault is.
    pub fn text(&self) -> String {
        format!("{}\n{}\n{}", self.file, self.find, self.replace)
    }

    /// The file's text with the fault in it.
    ///
    /// # Errors
    /// When the text to replace does not stand there exactly once.
    pub fn seeded(&self, source: &str) -> Result<String, String> {
        match source.matches(&self.find).count() {
            1 => Ok(source.replacen(&self.find, &self.replace, 1)),
            count => Err(format!(
                "mutant `{}` no longer applies: its text stands {count} times in {}",
                self.id, self.file
            )),
        }
    }
}

/// What may notice a fault, written as its arguments: `--test NAME [FUNCTION]` or `--case ID`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Check {
    /// A file of `tests/`, by its path there without `.rs`, and which of its tests. The first folder is the
    /// binary it belongs to.
    Test { name: String, filter: Option<String> },
    /// A verification case.
    Case { id: String },
}

impl Check {
    /// What is built to run it: checks of one program build nothing but what a fault changes.
    pub fn program(&self) -> String {
        match self {
            Check::Test { name, .. } => format!("--test {}", binary_of(name)),
            Check::Case { .. } => "--case".into(),
        }
    }

    /// # Errors
    /// In words, when the text is no check.
    pub fn parse(text: &str) -> Result<Check, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        match words.as_slice() {
            ["--test", name, filter @ ..] if filter.len() <= 1 => Ok(Check::Test {
                name: (*name).into(),
                filter: filter.first().map(|f| (*f).into()),
            }),
            ["--case", id] => Ok(Check::Case { id: (*id).into() }),
            _ => Err(format!("`{text}` is no check: --test NAME [FUNCTION] or --case ID")),
        }
    }
}

/// The binary that a file of `tests/` belongs to.
pub fn binary_of(name: &str) -> &str {
    name.split('/').next().unwrap_or(name)
}

impl fmt::Display for Check {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kind, name, filter) = match self {
            Check::Test { name, filter } => ("--test ", name.as_str(), filter.as_ref()),
            Check::Case { id } => ("--case ", id.as_str(), None),
        };
        write!(formatter, "{kind}{name}")?;
        filter.map_or(Ok(()), |filter| write!(formatter, " {filter}"))
    }
}

impl<'de> Deserialize<'de> for Check {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Check, D::Error> {
        Check::parse(&String::deserialize(deserializer)?).map_err(de::Error::custom)
    }
}

impl List {
    /// # Errors
    /// In words: not readable, not of this form, ids used twice, empty fields, faults that change
    /// nothing.
    pub fn read(path: &Path) -> Result<List, String> {
        let at = |error: &dyn fmt::Display| format!("{}: {error}", path.display());
        let text = fs::read_to_string(path).map_err(|error| at(&error))?;
        let list: List = toml::from_str(&text).map_err(|error| at(&error))?;
        let mut ids = HashSet::new();
        for mutant in &list.mutants {
            let id = &mutant.id;
            if !ids.insert(id) {
                return Err(at(&format!("id `{id}` is used twice")));
            }
            let fields = [id, &mutant.file, &mutant.find, &mutant.breaks];
            if fields.iter().any(|field| field.trim().is_empty()) || mutant.caught_by.is_empty() {
                return Err(at(&format!("mutant `{id}` has an empty field")));
            }
            if mutant.find == mutant.replace {
                return Err(at(&format!("mutant `{id}` changes nothing")));
            }
        }
        Ok(list)
    }

    /// # Errors
    /// Names the first mutant whose text is not found exactly once below `root`.
    pub fn check_applies(&self, root: &Path) -> Result<(), String> {
        for mutant in &self.mutants {
            let path = root.join(&mutant.file);
            let source = fs::read_to_string(&path)
                .map_err(|error| format!("mutant `{}`: {}: {error}", mutant.id, path.display()))?;
            mutant.seeded(&source)?;
        }
        Ok(())
    }
}
