//! Reading of a document: entries of the file are checked against the key table.

use crate::scene::error::{Problem, SceneError};
use crate::scene::tables::keys;
use crate::scene::tables::keys::Key;
use crate::scene::text::document::Document;
use crate::scene::text::table::{Content, Item, Table, joined};
use crate::scene::text::tree::{Entry, Node, Value};
use crate::scene::text::value::{Checked, ValueError};
use crate::scene::text::{sweep, value};

impl Document {
    /// Checks the entries of the table `path`, which messages call `shown`.
    pub(crate) fn table(
        &mut self,
        path: &str,
        shown: &str,
        entries: Vec<Entry>,
    ) -> Result<Table, SceneError> {
        let mut checked = Table::default();
        for Entry { name, offset, node } in entries {
            let (full, shown) = (joined(path, &name), joined(shown, &name));
            // A name with a dot inside is one quoted key, not a path.
            let known = !name.contains('.');
            let (key, table) = (keys::find(&full), keys::find_table(&full));
            let is_table = matches!(node.value, Value::Table(_));
            // `outer_race.x` is both a key and a table; the value decides which is meant.
            let (content, at) = match (key, table) {
                (Some((_, key)), table) if known && (!is_table || table.is_none()) => {
                    let value = self.checked(key, &node, &shown)?;
                    let rival = key.rivals().find(|rival| {
                        rival.table() == key.table() && checked.own(rival.name()).is_some()
                    });
                    if let Some(rival) = rival {
                        let advice = format!("keep `{}` or `{name}`", rival.name());
                        let rival =
                            format!("{}{}", &shown[..shown.len() - name.len()], rival.name());
                        let problem = Problem::Exclusive { rival, advice };
                        return Err(self.source.error(node.offset, &shown, problem));
                    }
                    (Content::Value(value), node.offset)
                }
                (_, Some(table)) if known && table.list => {
                    (Content::List(self.list(table, &shown, node)?), offset)
                }
                (_, Some(table)) if known => {
                    let Value::Table(inner) = node.value else {
                        return Err(self.wrong_kind("a table of keys", table, &full, &node));
                    };
                    // `[housing.left]` alone does not give other bearings a housing.
                    let of_names = |entry: &Entry| self.as_name(&full, entry).is_some();
                    if !inner.is_empty() && inner.iter().all(of_names) {
                        self.table(&full, &shown, inner)?;
                        continue;
                    }
                    let inner = match table.path {
                        "assumptions" => self.assumed(inner)?,
                        "sweep" => {
                            let mut axes = Table::default();
                            self.fill_sweep("", inner, &mut axes)?;
                            axes
                        }
                        _ => self.table(&full, &shown, inner)?,
                    };
                    (Content::Table(inner), offset)
                }
                _ => {
                    let entry = Entry { name, offset, node };
                    match self.as_name(path, &entry) {
                        Some(table) => self.fill_named(table, entry)?,
                        None => return Err(self.unknown_key(path, &shown, &entry)),
                    }
                    continue;
                }
            };
            checked.0.push((name, self.item(content, at)));
        }
        Ok(checked)
    }

    fn item(&self, content: Content, offset: usize) -> Item {
        Item { content, offset: Some(offset), named: self.scope.is_some() }
    }

    fn list(
        &mut self,
        table: &'static keys::Table,
        shown: &str,
        node: Node,
    ) -> Result<Vec<Item>, SceneError> {
        let expected = format!("a list of tables, [[{}]]", table.path);
        let Value::List(tables) = node.value else {
            return Err(self.wrong_kind(&expected, table, table.path, &node));
        };
        let mut list = Vec::new();
        for (node, number) in tables.into_iter().zip(1..) {
            let Value::Table(entries) = node.value else {
                return Err(self.wrong_kind(&expected, table, table.path, &node));
            };
            let inner = self.table(table.path, &format!("{shown}.{number}"), entries)?;
            list.push(self.item(Content::Table(inner), node.offset));
        }
        Ok(list)
    }

    fn checked(&self, key: &'static Key, node: &Node, shown: &str) -> Result<Checked, SceneError> {
        value::check(key, node, self.in_si).map_err(|error| {
            let dot = if error.within.is_empty() { "" } else { "." };
            self.source.error(error.offset, &format!("{shown}{dot}{}", error.within), error.problem)
        })
    }

    fn unknown_key(&self, table: &str, shown: &str, entry: &Entry) -> SceneError {
        let top = |path: &str| path.split('.').next().map(str::to_string);
        let nearest = keys::nearest_key(table, &entry.name);
        let nearest = nearest.map(|path| self.shown(&path, top(&path) == top(table)));
        let allowed = keys::children(table).join(", ");
        self.source.error(entry.offset, shown, Problem::UnknownKey { nearest, allowed })
    }

    fn wrong_kind(
        &self,
        expected: &str,
        table: &keys::Table,
        full: &str,
        node: &Node,
    ) -> SceneError {
        let problem = Problem::WrongKind {
            expected: expected.to_string(),
            found: node.value.description().to_string(),
            advice: format!("write {}", table.example.replace('\n', " and below it ")),
        };
        self.source.error(node.offset, full, problem)
    }

    fn assumed(&self, entries: Vec<Entry>) -> Result<Table, SceneError> {
        let mut assumed = Table::default();
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
            assumed.0.push((name, self.item(Content::Value(Checked::Text(text)), node.offset)));
        }
        Ok(assumed)
    }

    /// Reads `[sweep]`. Its other keys are dotted paths, quoted or not: in TOML, `a.b = ...` is a nested table.
    fn fill_sweep(
        &self,
        prefix: &str,
        entries: Vec<Entry>,
        axes: &mut Table,
    ) -> Result<(), SceneError> {
        for Entry { name, offset, node } in entries {
            let path = joined(prefix, &name);
            let checked = if let Some((_, key)) = keys::find(&format!("sweep.{path}")) {
                self.checked(key, &node, key.path)?
            } else if let Value::Table(inner) = node.value {
                self.fill_sweep(&path, inner, axes)?;
                continue;
            } else {
                let error = |error: ValueError| {
                    self.source.error(error.offset, &format!("sweep.\"{path}\""), error.problem)
                };
                if axes.own(&path).is_some() {
                    return Err(error((offset, Problem::DuplicateKey).into()));
                }
                Checked::Axis(sweep::axis_of_node(&path, offset, &node).map_err(error)?)
            };
            axes.0.push((path, self.item(Content::Value(checked), node.offset)));
        }
        Ok(())
    }
}
