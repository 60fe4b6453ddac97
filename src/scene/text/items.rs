//! Lists of tables, such as `[[solid.load]]` or the discs of a shaft. Users number the tables from 1.

use crate::scene::error::{Problem, SceneError};
use crate::scene::tables::keys;
use crate::scene::tables::keys::Leads;
use crate::scene::text::document::{Document, Given, Layer};
use crate::scene::text::tree::{Entry, Value};
use crate::scene::text::value::Checked;

/// One table of a list of tables.
#[derive(Clone, Debug)]
pub(crate) struct Item {
    pub table: &'static str,
    offset: usize,
    given: Vec<(usize, Given)>,
    /// True if it is inside a named table.
    named: bool,
}

impl Item {
    pub fn begins(&self) -> usize {
        self.offset
    }

    pub fn shift(&mut self, by: usize) {
        self.offset += by;
        self.given.iter_mut().for_each(|(_, given)| given.shift(by));
    }
}

/// One table of a list of tables, with its document.
#[derive(Clone, Copy)]
pub(crate) struct ItemRef<'d> {
    document: &'d Document,
    item: &'d Item,
    /// Counted from 1.
    number: usize,
}

impl<'d> ItemRef<'d> {
    /// The checked value of a key of this table by its own name.
    pub fn value(&self, name: &str) -> Option<&'d Checked> {
        let row = keys::find(&format!("{}.{name}", self.item.table)).map(|(row, _)| row)?;
        self.item.given.iter().find(|(given, _)| *given == row).map(|(_, given)| &given.value)
    }

    pub fn error(&self, name: &str, problem: Problem) -> SceneError {
        let table = self.document.shown(self.item.table, self.item.named);
        let path = format!("{table}.{}.{name}", self.number);
        self.document.error_at(self.offset(name), &path, problem)
    }

    /// Offset of a key's value in this table; of the table if the key is not given.
    pub(crate) fn offset(&self, name: &str) -> usize {
        let row = keys::find(&format!("{}.{name}", self.item.table)).map(|(row, _)| row);
        let own = self.item.given.iter().find(|(given, _)| Some(*given) == row);
        own.and_then(|(_, given)| given.offset).unwrap_or(self.item.offset)
    }
}

impl Document {
    pub(crate) fn fill_list(
        &mut self,
        table: &'static keys::Table,
        full: &str,
        entry: &Entry,
    ) -> Result<(), SceneError> {
        let Value::List(tables) = &entry.node.value else {
            return Err(self.not_a_list(table, full, &entry.node));
        };
        if tables.is_empty() {
            self.layer.emptied.push(table.path);
        }
        let shown = self.shown(full, true);
        for (index, node) in tables.iter().enumerate() {
            let Value::Table(entries) = &node.value else {
                return Err(self.not_a_list(table, full, node));
            };
            let mut given = Vec::new();
            for entry in entries {
                let own = format!("{full}.{}", entry.name);
                let known = if entry.name.contains('.') { None } else { keys::find(&own) };
                let Some((row, key)) = known else {
                    return Err(self.unknown_key(full, entry));
                };
                let checked = self.checked(key, &entry.node).map_err(|mut error| {
                    if let Some(rest) = error.key.strip_prefix(&shown) {
                        error.key = format!("{shown}.{}{rest}", index + 1);
                    }
                    error
                })?;
                given.push((row, checked));
            }
            let named = self.scope.is_some();
            self.layer.items.push(Item { table: table.path, offset: node.offset, given, named });
        }
        Ok(())
    }

    /// The tables of a list of tables, in the order of the file.
    pub(crate) fn items<'d>(&'d self, table: &'d str) -> impl Iterator<Item = ItemRef<'d>> {
        let of = self.layer.items.iter().filter(move |item| item.table == table);
        of.enumerate().map(|(index, item)| ItemRef { document: self, item, number: index + 1 })
    }

    /// Problem with the index of a table in a list: missing or out of range; `None` if it is valid.
    pub(crate) fn refused_item(&self, path: &str, leads: &Leads) -> Option<Problem> {
        let key = leads.key;
        if !key.in_list() {
            return None;
        }
        let Some(number) = leads.item else { return Some(which_item(path)) };
        let list = |layer: &Layer| of_table(layer, key.table()).count();
        let own = self.named.iter().find(|named| {
            Some(named.name.as_str()) == leads.name
                && key.path.strip_prefix(named.table).is_some_and(|rest| rest.starts_with('.'))
        });
        let count = match own.map_or(0, |named| list(&named.layer)) {
            0 => list(&self.layer),
            own => own,
        };
        let within = (1..=count).contains(&number);
        (!within).then_some(Problem::NoSuchItem { count })
    }

    /// Replaces or adds a key of one table of an existing list; a name that inherits the list gets its own copy.
    /// Returns the keys that were removed.
    pub(crate) fn put_item(&mut self, leads: &Leads, given: Given) -> Vec<&'static str> {
        let table = leads.key.table();
        let common: Vec<Item> = of_table(&self.layer, table).cloned().collect();
        let layer = match leads.name {
            Some(name) => self.layer_of(leads.key, name),
            None => &mut self.layer,
        };
        if of_table(layer, table).next().is_none() {
            layer.items.extend(common);
        }
        let index = leads.item.map_or(0, |number| number - 1);
        let mut list = layer.items.iter_mut().filter(|item| item.table == table);
        let Some(item) = list.nth(index) else { return Vec::new() };
        let rivals = leads.key.rivals().filter_map(|rival| keys::find(rival.path));
        let mut gone = Vec::new();
        for (row, rival) in rivals {
            if item.given.iter().any(|(own, _)| *own == row) {
                gone.push(rival.path);
            }
            item.given.retain(|(own, _)| *own != row);
        }
        item.given.retain(|(row, _)| *row != leads.row);
        item.given.push((leads.row, given));
        gone
    }
}

fn of_table<'l>(layer: &'l Layer, table: &'l str) -> impl Iterator<Item = &'l Item> {
    layer.items.iter().filter(move |item| item.table == table)
}

/// Problem of a path to a key of a list of tables without an index.
pub(crate) fn which_item(path: &str) -> Problem {
    let (list, name) = path.rsplit_once('.').unwrap_or(("", path));
    Problem::WhichItem { example: format!("{list}.1.{name}") }
}
