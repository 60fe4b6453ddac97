//! A scene as written: every given key, checked against the key table, with its position.

use crate::scene::build::about::About;
use crate::scene::error::{Place, Problem, SceneError};
use crate::scene::tables::keys;
use crate::scene::tables::keys::{KEYS, Key, Leads};
use crate::scene::text::base::{BASE, WITHOUT};
use crate::scene::text::items::Item;
use crate::scene::text::source::{Format, Source};
use crate::scene::text::sweep::SweepAxis;
use crate::scene::text::tree::{Entry, Node, Value};
use crate::scene::text::value::{Checked, ValueError};
use crate::scene::text::{source, sweep, tree, value};
use std::sync::Arc;

/// A named assumption for data that the source does not state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assumption {
    pub name: String,
    pub text: String,
}

/// Given keys of a scene. Cheap to clone and change, for sweeps.
#[derive(Clone, Debug)]
pub struct Document {
    pub(crate) source: Arc<Source>,
    /// Keys of tables without a name; in a [`Document::scoped`] document merged with those of its name.
    pub(crate) layer: Layer,
    /// Tables with a name, such as `[bearing.left]`, in the order of the file.
    pub(crate) named: Vec<Named>,
    /// Name whose tables are being read or have been merged.
    pub(crate) scope: Option<String>,
    pub(crate) assumptions: Vec<Assumption>,
    pub(crate) sweep: Vec<SweepAxis>,
}

/// Given keys, tables and lists.
#[derive(Clone, Debug)]
pub(crate) struct Layer {
    /// One slot for each row of [`KEYS`].
    pub given: Vec<Option<Given>>,
    /// Tables that occur in the file, with offsets.
    pub tables: Vec<(&'static str, usize)>,
    /// Entries of lists of tables, in the order of the file.
    pub items: Vec<Item>,
    /// Empty lists of tables; they remove inherited ones.
    pub emptied: Vec<&'static str>,
}

impl Default for Layer {
    fn default() -> Layer {
        Layer {
            given: vec![None; KEYS.len()],
            tables: Vec::new(),
            items: Vec::new(),
            emptied: Vec::new(),
        }
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Named {
    /// Path without the name, `bearing`.
    pub table: &'static str,
    pub name: String,
    pub offset: usize,
    pub layer: Layer,
}

#[derive(Clone, Debug)]
pub(crate) struct Given {
    pub value: Checked,
    /// `None` for a value that was set after reading.
    pub offset: Option<usize>,
    /// True if it is in a named table.
    pub named: bool,
}

impl Layer {
    /// Sets a value and removes keys that exclude it; returns their paths.
    pub fn put(&mut self, row: usize, key: &'static Key, given: Given) -> Vec<&'static str> {
        let mut gone = Vec::new();
        for rival in key.rivals() {
            if let Some((row, _)) = keys::find(rival.path)
                && self.given[row].take().is_some()
            {
                gone.push(rival.path);
            }
        }
        self.given[row] = Some(given);
        gone
    }
}

impl Document {
    /// Reads a scene file; the format follows from its name.
    pub fn read_file(path: &std::path::Path) -> Result<Document, SceneError> {
        let (source, format) = source::read(path)?;
        Document::of_source(source, format, 0)
    }

    /// Reads a scene from text; messages use `name` as the file name.
    pub fn read_str(text: &str, format: Format, name: &str) -> Result<Document, SceneError> {
        let (name, text) = (name.to_string(), text.to_string());
        let source = Source { name, text, base: None, is_fixed: false };
        Document::of_source(source, format, 0)
    }

    /// Reads a scene from bytes; invalid UTF-8 is an error.
    pub fn read_bytes(bytes: Vec<u8>, format: Format, name: &str) -> Result<Document, SceneError> {
        Document::of_source(source::decode(name.to_string(), bytes)?, format, 0)
    }

    /// `above` is the number of scenes that inherit this one.
    pub(crate) fn of_source(
        source: Source,
        format: Format,
        above: usize,
    ) -> Result<Document, SceneError> {
        let source = source::check(source, format)?;
        let entries = tree::parse(&source, format)?;
        let mut document = Document {
            source: Arc::new(source),
            layer: Layer::default(),
            named: Vec::new(),
            scope: None,
            assumptions: Vec::new(),
            sweep: Vec::new(),
        };
        document.fill("", entries)?;
        document.refuse_rivals()?;
        document.on_base(above)
    }

    pub(crate) fn fill(&mut self, path: &str, entries: Vec<Entry>) -> Result<(), SceneError> {
        for entry in entries {
            let full =
                if path.is_empty() { entry.name.clone() } else { format!("{path}.{}", entry.name) };
            // A name with a dot inside is one quoted key, not a path.
            let known = if entry.name.contains('.') { None } else { keys::find(&full) };
            // `outer_race.x` is both a key and a table; the value decides which is meant.
            let known = known.filter(|_| {
                !matches!(entry.node.value, Value::Table(_)) || keys::find_table(&full).is_none()
            });
            if let Some((row, key)) = known {
                self.layer.given[row] = Some(self.checked(key, &entry.node)?);
                continue;
            }
            let table = if entry.name.contains('.') { None } else { keys::find_table(&full) };
            let Some(table) = table else {
                match self.as_name(path, &entry) {
                    Some(table) => self.fill_named(table, entry)?,
                    None => return Err(self.unknown_key(path, &entry)),
                }
                continue;
            };
            if table.list {
                self.fill_list(table, &full, &entry)?;
                continue;
            }
            let Value::Table(inner) = entry.node.value else {
                return Err(self.not_a_table(table, &full, &entry.node));
            };
            // `[housing.left]` alone does not give other bearings a housing.
            let of_names = |entry: &Entry| self.as_name(&full, entry).is_some();
            if inner.is_empty() || !inner.iter().all(of_names) {
                self.layer.tables.push((table.path, entry.offset));
            }
            match table.path {
                "assumptions" => self.fill_assumptions(inner)?,
                "sweep" => self.fill_sweep("", inner)?,
                _ => self.fill(&full, inner)?,
            }
        }
        Ok(())
    }

    pub(crate) fn checked(&self, key: &'static Key, node: &Node) -> Result<Given, SceneError> {
        let value = value::check(key, node).map_err(|error| {
            let dot = if error.within.is_empty() { "" } else { "." };
            let place = format!("{}{dot}{}", self.shown(key.path, true), error.within);
            self.source.error(error.offset, &place, error.problem)
        })?;
        Ok(Given { value, offset: Some(node.offset), named: self.scope.is_some() })
    }

    pub(crate) fn unknown_key(&self, table: &str, entry: &Entry) -> SceneError {
        let nearest = keys::nearest_key(table, &entry.name);
        let nearest = nearest.map(|path| self.shown(&path, self.is_in_named_table(&path)));
        let allowed = keys::children(table).join(", ");
        let full = match table {
            "" => String::new(),
            _ => format!("{}.", self.shown(table, true)),
        };
        let problem = Problem::UnknownKey { nearest, allowed };
        self.source.error(entry.offset, &format!("{full}{}", entry.name), problem)
    }

    pub(crate) fn not_a_list(&self, table: &keys::Table, full: &str, node: &Node) -> SceneError {
        let problem = Problem::WrongKind {
            expected: format!("a list of tables, [[{full}]]"),
            found: node.value.description().to_string(),
            advice: format!("write {}", table.example.replace('\n', " and below it ")),
        };
        self.source.error(node.offset, full, problem)
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
                    advice: "describe the assumption in quotes".to_string(),
                };
                let key = format!("assumptions.{name}");
                return Err(self.source.error(node.offset, &key, problem));
            };
            self.assumptions.push(Assumption { name, text });
        }
        Ok(())
    }

    /// Reads `[sweep]`. Its other keys are dotted paths, quoted or not: in TOML, `a.b = ...` is a nested table.
    fn fill_sweep(&mut self, prefix: &str, entries: Vec<Entry>) -> Result<(), SceneError> {
        for Entry { name, offset, node } in entries {
            let path = if prefix.is_empty() { name } else { format!("{prefix}.{name}") };
            if let Some((row, key)) = keys::find(&format!("sweep.{path}")) {
                self.layer.given[row] = Some(self.checked(key, &node)?);
                continue;
            }
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

    /// Refuses keys that exclude each other; the later one is reported.
    pub(crate) fn refuse_rivals(&self) -> Result<(), SceneError> {
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
                let rival = self.shown(rival.path, true);
                let problem = Problem::Exclusive { rival, advice };
                Err(self.source.error(offset, &self.shown(key.path, true), problem))
            }
        }
    }

    fn offset(&self, row: usize) -> Option<usize> {
        self.layer.given[row].as_ref().and_then(|given| given.offset)
    }

    /// Replaces or adds one key, as `--set` does: `set("bearing.clearance.radial", "5 um")`,
    /// `set("output.plots", "[]")`.
    ///
    /// Removes keys that exclude it (the diametral clearance, the displacement of a coordinate with a
    /// load) and returns those that the scene had.
    ///
    /// # Errors
    /// An unknown key, or a value its key does not accept.
    pub fn set(&mut self, path: &str, text: &str) -> Result<Vec<&'static str>, SceneError> {
        let leads = self.row(path)?;
        let Leads { row, key, name, item } = leads;
        let checked = match tree::composite_value(text) {
            Some(value) => value::check(key, &Node { value, offset: 0 }).map_err(|e| e.problem),
            None => value::check_bare(key, text),
        };
        let value = checked
            .map_err(|problem| SceneError::new(Place::file(&self.source.name), path, problem))?;
        let given = Given { value, offset: None, named: name.is_some() };
        Ok(match (item, name) {
            (Some(_), _) => self.put_item(&leads, given),
            (None, Some(name)) => self.layer_of(key, name).put(row, key, given),
            (None, None) => self.layer.put(row, key, given),
        })
    }

    /// Names whose own tables override a key without a name, and whether all do, so that the key has no effect. Empty and
    /// false for a key with a name.
    pub fn outside_range(&self, path: &str) -> (Vec<String>, bool) {
        let Some(Leads { row, key, name: None, .. }) = keys::find_named(path) else {
            return (Vec::new(), false);
        };
        let Some(table) =
            keys::NAMED.into_iter().find(|table| Some(*table) == path.split('.').next())
        else {
            return (Vec::new(), false);
        };
        let rows: Vec<usize> =
            key.rivals().filter_map(|rival| keys::find(rival.path)).map(|(row, _)| row).collect();
        let own = |named: &&Named| {
            let Layer { given, items, emptied, .. } = &named.layer;
            let says = given[row].is_some() || rows.iter().any(|at| given[*at].is_some());
            let lists = key.in_list()
                && (items.iter().any(|item| item.table == key.table())
                    || emptied.contains(&key.table()));
            named.table == table && (says || lists)
        };
        let own: Vec<String> = self.named.iter().filter(own).map(|n| n.name.clone()).collect();
        // Bodies, springs and sensors have their own names; all others use those of bearings.
        let by = if keys::OWN_NAMES.contains(&table) { table } else { "bearing" };
        let mut names: Vec<&str> = self.names(by).chain(self.names(table)).collect();
        names.sort_unstable();
        names.dedup();
        let nothing =
            !names.is_empty() && names.iter().all(|name| own.iter().any(|own| own == name));
        (own, nothing)
    }

    /// Reads the values of a varied key: a list `"5 um, 0 um"` or a range `"0 deg .. 45 deg / 91"`.
    pub fn axis(&self, path: &str, values: &str) -> Result<SweepAxis, SceneError> {
        let leads = self.row(path)?;
        sweep::axis_of_text(path, &leads, values)
            .map_err(|problem| SceneError::new(Place::file(&self.source.name), path, problem))
    }

    fn row<'p>(&self, path: &'p str) -> Result<Leads<'p>, SceneError> {
        let error = |problem| SceneError::new(Place::file(&self.source.name), path, problem);
        let leads = keys::find_named(path).ok_or_else(|| error(sweep::unknown_key(path)))?;
        if [BASE, WITHOUT].contains(&leads.key.path) {
            let advice = "change it in the scene file";
            return Err(error(Problem::refused("a base is read before keys are set", advice)));
        }
        let wrong_name = leads.name.and_then(|name| self.refused_name(leads.key, name));
        match wrong_name.or_else(|| self.refused_item(path, &leads)) {
            Some(problem) => Err(error(problem)),
            None => Ok(leads),
        }
    }

    pub fn name(&self) -> &str {
        &self.source.name
    }

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

    /// True if `[sweep]` is of runs instead of statics.
    pub fn sweeps_runs(&self) -> bool {
        matches!(self.value("sweep.of"), Some(Checked::Choice("runs")))
    }

    /// True if the keys of `[sweep]` vary together, value by value.
    pub fn sweeps_together(&self) -> bool {
        matches!(self.value("sweep.together"), Some(Checked::Boolean(true)))
    }

    pub fn is_given(&self, path: &str) -> bool {
        self.value(path).is_some()
    }

    /// The checked value of a key, if given. `path` must be in the key table.
    pub(crate) fn value(&self, path: &str) -> Option<&Checked> {
        let row = keys::find(path).map(|(row, _)| row);
        debug_assert!(row.is_some(), "{path} is not in the key table");
        row.and_then(|row| self.layer.given[row].as_ref()).map(|given| &given.value)
    }

    /// The first given key or table at or below the path, for instance `solid`.
    pub(crate) fn first_below(&self, path: &str) -> Option<&'static str> {
        let below = |known: &str| {
            known.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let tables = self.layer.tables.iter().map(|(table, _)| *table);
        let items = self.layer.items.iter().map(|item| item.table);
        let keys = KEYS.iter().enumerate().filter(|(row, _)| self.layer.given[*row].is_some());
        let all = tables.chain(items).chain(keys.map(|(_, key)| key.path));
        all.into_iter().find(|known| below(known))
    }

    /// Given keys, without those of lists of tables.
    pub(crate) fn given_keys(&self) -> impl Iterator<Item = &'static Key> {
        KEYS.iter()
            .enumerate()
            .filter(|(row, _)| self.layer.given[*row].is_some())
            .map(|(_, key)| key)
    }

    /// An error about a key or table: at its value, else at the innermost table that would contain it.
    pub(crate) fn error(&self, path: &str, problem: Problem) -> SceneError {
        SceneError::new(self.place_of_key(path), &self.shown(path, self.is_named(path)), problem)
    }

    /// An error about a key that is not allowed here.
    pub(crate) fn refused(
        &self,
        path: &str,
        reason: impl Into<String>,
        advice: impl Into<String>,
    ) -> SceneError {
        self.error(path, Problem::refused(reason, advice))
    }

    /// As [`Document::error`], but always with the name that is being read, also if the key is missing there.
    pub(crate) fn error_here(&self, path: &str, problem: Problem) -> SceneError {
        SceneError::new(self.place_of_key(path), &self.shown(path, true), problem)
    }

    pub(crate) fn error_at(&self, offset: usize, path: &str, problem: Problem) -> SceneError {
        self.source.error(offset, path, problem)
    }

    /// Position of the part of the scene that a later error is about.
    pub fn place_of(&self, about: &About) -> Place {
        match about {
            About::Key(path) => self.place_of_key(path),
            About::Item { table, index, key } => match self.items(table).nth(*index) {
                Some(item) => self.source.place(item.offset(key)),
                None => self.place_of_key(table),
            },
        }
    }

    pub(crate) fn place_of_key(&self, path: &str) -> Place {
        let own = keys::find(path).and_then(|(row, _)| self.layer.given[row].as_ref());
        let place = match own {
            Some(given) => given.offset.map(|offset| self.source.place(offset)),
            None => {
                let holds = |table: &str| {
                    path.strip_prefix(table)
                        .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
                };
                let tables = self.layer.tables.iter().filter(|(table, _)| holds(table));
                let innermost = tables.max_by_key(|(table, _)| table.len());
                innermost.or_else(|| self.own_table(path)).map(|&(_, at)| self.source.place(at))
            }
        };
        place.unwrap_or_else(|| Place::file(&self.source.name))
    }

    /// Table of the bearing, body or spring that is being read, for a key of a named table.
    fn own_table(&self, path: &str) -> Option<&(&'static str, usize)> {
        let named = path.split('.').next().is_some_and(|top| keys::NAMED.contains(&top));
        let own = |(table, _): &&(&str, usize)| ["bearing", "body", "spring"].contains(table);
        self.layer.tables.iter().rev().find(own).filter(|_| named && self.scope.is_some())
    }
}
