//! A scene as a person wrote it: every given key, checked against the key table, with its place.

use crate::scene::error::{Place, Problem, SceneError};
use crate::scene::keys::{self, KEYS, Key};
use crate::scene::source::{self, Format, Source};
use crate::scene::sweep::{self, SweepAxis};
use crate::scene::tree::{self, Entry, Node, Value};
use crate::scene::value::{self, Checked, ValueError};
use std::sync::Arc;

/// A named hole in the source that the scene fills.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assumption {
    pub name: String,
    pub text: String,
}

/// The given keys of a scene. Cheap to clone and change, for sweeps.
#[derive(Clone, Debug)]
pub struct Document {
    source: Arc<Source>,
    /// One slot for each row of [`KEYS`].
    given: Vec<Option<Given>>,
    /// Tables that occur in the file and where.
    tables: Vec<(&'static str, usize)>,
    assumptions: Vec<Assumption>,
    sweep: Vec<SweepAxis>,
}

#[derive(Clone, Debug)]
struct Given {
    value: Checked,
    /// `None` for a value that was set after reading.
    offset: Option<usize>,
}

impl Document {
    /// Reads a scene file; its name tells the format.
    pub fn read_file(path: &std::path::Path) -> Result<Document, SceneError> {
        let (source, format) = source::read(path)?;
        Document::from_source(source, format)
    }

    /// Reads a scene from text; `name` stands for the file in messages.
    pub fn read_str(text: &str, format: Format, name: &str) -> Result<Document, SceneError> {
        let source = Source { name: name.to_string(), text: text.to_string() };
        Document::from_source(source, format)
    }

    /// Reads a scene from bytes that need not be text.
    pub fn read_bytes(bytes: Vec<u8>, format: Format, name: &str) -> Result<Document, SceneError> {
        Document::from_source(source::decode(name.to_string(), bytes)?, format)
    }

    fn from_source(source: Source, format: Format) -> Result<Document, SceneError> {
        let source = source::check(source, format)?;
        let entries = tree::parse(&source, format)?;
        let mut document = Document {
            source: Arc::new(source),
            given: vec![None; KEYS.len()],
            tables: Vec::new(),
            assumptions: Vec::new(),
            sweep: Vec::new(),
        };
        document.fill("", entries)?;
        document.refuse_rivals()?;
        Ok(document)
    }

    /// Takes the entries of the table `path`.
    fn fill(&mut self, path: &str, entries: Vec<Entry>) -> Result<(), SceneError> {
        for entry in entries {
            let full =
                if path.is_empty() { entry.name.clone() } else { format!("{path}.{}", entry.name) };
            // A name with a dot inside is one quoted key, not a path.
            let known = if entry.name.contains('.') { None } else { keys::find(&full) };
            // `outer_race.x` is a key and a table as well: what stands there tells which is meant.
            let known = known.filter(|_| {
                !matches!(entry.node.value, Value::Table(_)) || keys::find_table(&full).is_none()
            });
            if let Some((row, key)) = known {
                let value = value::check(key, &entry.node).map_err(|error| {
                    let dot = if error.within.is_empty() { "" } else { "." };
                    let place = format!("{full}{dot}{}", error.within);
                    self.source.error(error.offset, &place, error.problem)
                })?;
                self.given[row] = Some(Given { value, offset: Some(entry.node.offset) });
                continue;
            }
            let table = if entry.name.contains('.') { None } else { keys::find_table(&full) };
            let Some(table) = table else {
                let nearest = keys::nearest_key(path, &entry.name);
                let allowed = keys::children(path).join(", ");
                let problem = Problem::UnknownKey { nearest, allowed };
                return Err(self.source.error(entry.offset, &full, problem));
            };
            let Value::Table(inner) = entry.node.value else {
                return Err(self.not_a_table(table, &full, &entry.node));
            };
            self.tables.push((table.path, entry.offset));
            match table.path {
                "assumptions" => self.fill_assumptions(inner)?,
                "sweep" => self.fill_sweep("", inner)?,
                _ => self.fill(&full, inner)?,
            }
        }
        Ok(())
    }

    fn not_a_table(&self, table: &keys::Table, full: &str, node: &Node) -> SceneError {
        let problem = Problem::WrongKind {
            expected: "a table of keys".to_string(),
            found: node.value.description().to_string(),
            advice: format!("write {}", table.example.replace('\n', " and below it ")),
        };
        self.source.error(node.offset, full, problem)
    }

    fn fill_assumptions(&mut self, entries: Vec<Entry>) -> Result<(), SceneError> {
        for Entry { name, node, .. } in entries {
            let Value::Text(text) = node.value else {
                let problem = Problem::WrongKind {
                    expected: "a text in quotes".to_string(),
                    found: node.value.description().to_string(),
                    advice: "say in words what is assumed".to_string(),
                };
                let key = format!("assumptions.{name}");
                return Err(self.source.error(node.offset, &key, problem));
            };
            self.assumptions.push(Assumption { name, text });
        }
        Ok(())
    }

    /// Keys of `[sweep]` are dotted paths, quoted or not: `a.b = ...` is a table in a table to TOML.
    fn fill_sweep(&mut self, prefix: &str, entries: Vec<Entry>) -> Result<(), SceneError> {
        for Entry { name, offset, node } in entries {
            let path = if prefix.is_empty() { name } else { format!("{prefix}.{name}") };
            if let Value::Table(inner) = node.value {
                self.fill_sweep(&path, inner)?;
                continue;
            }
            let error = |error: ValueError| {
                self.source.error(error.offset, &format!("sweep.\"{path}\""), error.problem)
            };
            let axis = sweep::axis_of_node(&path, offset, &node).map_err(error)?;
            if self.sweep.iter().any(|other| other.key == axis.key) {
                return Err(error((offset, Problem::DuplicateKey).into()));
            }
            self.sweep.push(axis);
        }
        Ok(())
    }

    /// Keys that exclude each other must not both be given; the later one is reported.
    fn refuse_rivals(&self) -> Result<(), SceneError> {
        let mut first: Option<(usize, &Key, &Key)> = None;
        for (row, key) in KEYS.iter().enumerate() {
            let Some(offset) = self.offset(row) else { continue };
            for rival in key.rivals() {
                let rival_offset = keys::find(rival.path).and_then(|(row, _)| self.offset(row));
                if rival_offset.is_some_and(|rival| rival < offset)
                    && first.is_none_or(|(earliest, ..)| offset < earliest)
                {
                    first = Some((offset, key, rival));
                }
            }
        }
        match first {
            None => Ok(()),
            Some((offset, key, rival)) => {
                let advice = format!("keep `{}` or `{}`", rival.name(), key.name());
                let problem = Problem::Exclusive { rival: rival.path.to_string(), advice };
                Err(self.source.error(offset, key.path, problem))
            }
        }
    }

    fn offset(&self, row: usize) -> Option<usize> {
        self.given[row].as_ref().and_then(|given| given.offset)
    }

    /// Replaces or adds one key, as `--vary` and `[sweep]` do: `set("bearing.clearance.radial", "5 um")`.
    ///
    /// Keys that exclude it (the diametral clearance, the displacement of a coordinate that gets a
    /// load) are taken away.
    ///
    /// # Errors
    /// An unknown key, or a value its key does not accept.
    pub fn set(&mut self, path: &str, text: &str) -> Result<(), SceneError> {
        let (row, key) = self.row(path)?;
        let value = value::check_bare(key, text)
            .map_err(|problem| SceneError::new(Place::file(&self.source.name), path, problem))?;
        for rival in key.rivals() {
            if let Some((row, _)) = keys::find(rival.path) {
                self.given[row] = None;
            }
        }
        self.given[row] = Some(Given { value, offset: None });
        Ok(())
    }

    /// Reads what to vary: a list `"5 um, 0 um"` or a range `"0 deg .. 45 deg / 91"` for a key.
    pub fn axis(&self, path: &str, values: &str) -> Result<SweepAxis, SceneError> {
        let (_, key) = self.row(path)?;
        sweep::axis_of_text(key, values)
            .map_err(|problem| SceneError::new(Place::file(&self.source.name), path, problem))
    }

    fn row(&self, path: &str) -> Result<(usize, &'static Key), SceneError> {
        keys::find(path).ok_or_else(|| {
            SceneError::new(Place::file(&self.source.name), path, sweep::unknown_key(path))
        })
    }

    /// File name as given.
    pub fn name(&self) -> &str {
        &self.source.name
    }

    /// The text that was read.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    pub fn assumptions(&self) -> &[Assumption] {
        &self.assumptions
    }

    /// The `[sweep]` table, in the order of the file.
    pub fn sweep(&self) -> &[SweepAxis] {
        &self.sweep
    }

    /// The checked value of a key, if given. `path` must be in the key table.
    pub(crate) fn value(&self, path: &str) -> Option<&Checked> {
        let row = keys::find(path).map(|(row, _)| row);
        debug_assert!(row.is_some(), "{path} is not in the key table");
        row.and_then(|row| self.given[row].as_ref()).map(|given| &given.value)
    }

    /// An error about a key or table: at its value, else at the innermost table that would hold it.
    pub(crate) fn error(&self, path: &str, problem: Problem) -> SceneError {
        let own = keys::find(path).and_then(|(row, _)| self.given[row].as_ref());
        let place = match own {
            Some(given) => given.offset.map(|offset| self.source.place(offset)),
            None => {
                let holds = |table: &str| {
                    path.strip_prefix(table)
                        .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
                };
                let tables = self.tables.iter().filter(|(table, _)| holds(table));
                tables.max_by_key(|(table, _)| table.len()).map(|&(_, at)| self.source.place(at))
            }
        };
        SceneError::new(place.unwrap_or_else(|| Place::file(&self.source.name)), path, problem)
    }
}
