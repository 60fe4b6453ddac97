//! A scene as written: every given key, checked against the key table, with its position.

use crate::scene::build::about::About;
use crate::scene::error::{Place, Problem, SceneError};
use crate::scene::tables::keys;
use crate::scene::tables::keys::{Key, Leads, SI, UNITS};
use crate::scene::text::base::{BASE, WITHOUT};
use crate::scene::text::source::{Format, Source};
use crate::scene::text::sweep;
use crate::scene::text::sweep::SweepAxis;
use crate::scene::text::table::{Content, Item, Table};
use crate::scene::text::tree::{Entry, Node, Value};
use crate::scene::text::value::Checked;
use crate::scene::text::{source, tree, value};
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
    pub(crate) tree: Table,
    /// Tables with a name, such as `[bearing.left]`, in the order of the file.
    pub(crate) named: Vec<Named>,
    /// Name whose tables are being read or have been merged.
    pub(crate) scope: Option<String>,
    /// True if numbers without a unit are quantities in SI.
    pub(crate) in_si: bool,
}

#[derive(Clone, Debug)]
pub(crate) struct Named {
    /// Path without the name, `bearing`.
    pub table: &'static str,
    pub name: String,
    pub offset: usize,
    /// The table, under its path without the name.
    pub tree: Table,
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
        let in_si = |entry: &Entry| {
            entry.name == UNITS && matches!(&entry.node.value, Value::Text(text) if text == SI)
        };
        let in_si = entries.iter().any(in_si);
        let (source, tree) = (Arc::new(source), Table::default());
        let mut document = Document { source, tree, named: Vec::new(), scope: None, in_si };
        document.tree = document.table("", "", entries)?;
        document.on_base(above)
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
        let Leads { key, name, item, .. } = leads;
        let checked = match tree::composite_value(text) {
            Some(value) => {
                value::check(key, &Node { value, offset: 0 }, false).map_err(|e| e.problem)
            }
            None => value::check_bare(key, text),
        };
        let value = checked
            .map_err(|problem| SceneError::new(Place::file(&self.source.name), path, problem))?;
        let given = Item { content: Content::Value(value), offset: None, named: name.is_some() };
        Ok(match (item, name) {
            (Some(_), _) => self.put_item(&leads, given),
            (None, Some(name)) => self.tree_of(key, name).exchange(key, given),
            (None, None) => self.tree.exchange(key, given),
        })
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
            return Err(error(Problem::refused(
                "a base is read before keys are set. Hint: change it in the scene file",
            )));
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

    pub fn assumptions(&self) -> Vec<Assumption> {
        let table = self.tree.own("assumptions").and_then(Item::table);
        let named = table.into_iter().flat_map(|table| &table.0);
        let text = |item: &Item| item.value().and_then(Checked::text).unwrap_or_default().into();
        named.map(|(name, item)| Assumption { name: name.clone(), text: text(item) }).collect()
    }

    /// The `[sweep]` table, in the order of the file.
    pub fn sweep(&self) -> Vec<SweepAxis> {
        let table = self.tree.own("sweep").and_then(Item::table);
        let axis = |(_, item): &(String, Item)| match item.value() {
            Some(Checked::Axis(axis)) => Some(axis.clone()),
            _ => None,
        };
        table.into_iter().flat_map(|table| &table.0).filter_map(axis).collect()
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
        debug_assert!(keys::find(path).is_some(), "{path} is not in the key table");
        self.tree.get(path)?.value()
    }

    /// The path, if a key, table or list of it is given.
    pub(crate) fn first_below<'p>(&self, path: &'p str) -> Option<&'p str> {
        let empty = |item: &Item| matches!(&item.content, Content::List(list) if list.is_empty());
        self.tree.get(path).filter(|item| !empty(item)).map(|_| path)
    }

    /// Given keys, without those of lists of tables.
    pub(crate) fn given_keys(&self) -> impl Iterator<Item = &'static Key> {
        let mut leaves = Vec::new();
        self.tree.leaves("", &mut leaves);
        leaves.into_iter().filter_map(|(path, _)| keys::find(&path)).map(|(_, key)| key)
    }

    /// An error about a key or table: at its value, else at the innermost table that would contain it.
    pub(crate) fn error(&self, path: &str, problem: Problem) -> SceneError {
        SceneError::new(self.place_of_key(path), &self.shown(path, self.is_named(path)), problem)
    }

    /// An error about a key that is not allowed here.
    pub(crate) fn refused(&self, path: &str, reason: impl Into<String>) -> SceneError {
        self.error(path, Problem::refused(reason))
    }

    /// Refuses keys, tables and lists that have no place here, for these reasons.
    pub(crate) fn refuse_given(&self, parts: &[(&str, &str)]) -> Result<(), SceneError> {
        match parts.iter().find(|(part, _)| self.first_below(part).is_some()) {
            Some((part, reason)) => Err(self.refused(part, *reason)),
            None => Ok(()),
        }
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
        self.place_of_item(self.tree.innermost(path).or_else(|| self.own_table(path)))
    }

    pub(crate) fn place_of_item(&self, item: Option<&Item>) -> Place {
        let offset = item.and_then(|item| item.offset);
        offset.map_or_else(|| Place::file(&self.source.name), |at| self.source.place(at))
    }

    /// Table of the bearing, body or spring that is being read, for a key of a named table.
    fn own_table(&self, path: &str) -> Option<&Item> {
        let named = path.split('.').next().is_some_and(|top| keys::NAMED.contains(&top));
        let mut own = ["bearing", "body", "spring"].into_iter().filter_map(|t| self.tree.own(t));
        own.find(|item| item.named).filter(|_| named && self.scope.is_some())
    }
}
