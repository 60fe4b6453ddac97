//! Lists of tables, such as `[[solid.load]]` or the discs of a shaft. Users number the tables from 1.

use crate::numeric::profile::Profile;
use crate::scene::error::{Problem, SceneError};
use crate::scene::tables::keys;
use crate::scene::tables::keys::Leads;
use crate::scene::text::document::Document;
use crate::scene::text::table::{Content, Item, Table};
use crate::scene::text::value::Checked;

/// One table of a list of tables, with its document.
#[derive(Clone, Copy)]
pub(crate) struct ItemRef<'d> {
    document: &'d Document,
    /// Path of the list.
    list: &'d str,
    item: &'d Item,
    /// Counted from 1.
    number: usize,
}

impl<'d> ItemRef<'d> {
    fn key(&self, name: &str) -> Option<&'d Item> {
        self.item.table()?.own(name)
    }

    /// Names of the given keys.
    pub fn names(&self) -> impl Iterator<Item = &'d str> {
        self.item.table().into_iter().flat_map(|table| &table.0).map(|(name, _)| name.as_str())
    }

    /// The checked value of a key of this table by its own name.
    pub fn value(&self, name: &str) -> Option<&'d Checked> {
        self.key(name)?.value()
    }

    pub fn is_given(&self, name: &str) -> bool {
        self.key(name).is_some()
    }

    pub fn number(&self, name: &str) -> Option<f64> {
        self.value(name)?.number()
    }

    pub fn profile(&self, name: &str) -> Option<Profile> {
        self.value(name)?.profile()
    }

    pub fn required(&self, name: &str) -> Result<f64, SceneError> {
        self.number(name).ok_or_else(|| self.missing(name, ""))
    }

    pub fn choice(&self, name: &str) -> Result<&'static str, SceneError> {
        let word = self.value(name).and_then(Checked::choice);
        word.ok_or_else(|| self.missing(name, ""))
    }

    pub fn text(&self, name: &str) -> Result<String, SceneError> {
        let text = self.value(name).and_then(Checked::text);
        text.map(str::to_string).ok_or_else(|| self.missing(name, ""))
    }

    /// Path of a key in the key table.
    pub fn path(&self, name: &str) -> String {
        format!("{}.{name}", self.list)
    }

    /// Path of a key of this table, with its number.
    pub fn own_path(&self, name: &str) -> String {
        format!("{}.{}.{name}", self.list, self.number)
    }

    /// The error of a missing key, with an example of the key table.
    pub fn missing(&self, name: &str, because: &str) -> SceneError {
        let example = keys::find(&self.path(name))
            .map_or(String::new(), |(_, key)| format!("`{name} = {}`", key.example()));
        self.error(name, Problem::Missing { because: because.to_string(), example })
    }

    pub fn refused(&self, name: &str, reason: impl Into<String>) -> SceneError {
        self.error(name, Problem::refused(reason))
    }

    pub fn error(&self, name: &str, problem: Problem) -> SceneError {
        let table = self.document.shown(self.list, self.item.named);
        let path = format!("{table}.{}.{name}", self.number);
        self.document.error_at(self.offset(name), &path, problem)
    }

    /// Offset of a key's value in this table; of the table if the key is not given.
    pub(crate) fn offset(&self, name: &str) -> usize {
        let own = self.key(name).and_then(|key| key.offset);
        own.or(self.item.offset).unwrap_or_default()
    }
}

impl Document {
    /// The tables of a list of tables, in the order of the file.
    pub(crate) fn items<'d>(&'d self, list: &'d str) -> impl Iterator<Item = ItemRef<'d>> {
        let items = self.tree.get(list).map_or(&[][..], Item::list).iter().zip(1..);
        items.map(move |(item, number)| ItemRef { document: self, list, item, number })
    }

    /// Problem with the index of a table in a list: missing or out of range; `None` if it is valid.
    pub(crate) fn refused_item(&self, path: &str, leads: &Leads) -> Option<Problem> {
        if !leads.key.in_list() {
            return None;
        }
        let Some(number) = leads.item else { return Some(which_item(path)) };
        let count = |tree: &Table| tree.get(leads.key.table()).map_or(0, |item| item.list().len());
        let own = self.named.iter().find(|named| Some(named.name.as_str()) == leads.name);
        let count = match own.map_or(0, |named| count(&named.tree)) {
            0 => count(&self.tree),
            own => own,
        };
        let within = (1..=count).contains(&number);
        (!within).then_some(Problem::NoSuchItem { count })
    }

    /// Replaces or adds a key of one table of a list, or of one after the last; a name that inherits the list gets its own copy.
    /// Returns the keys that were removed.
    pub(crate) fn put_item(&mut self, leads: &Leads, item: Item) -> Vec<&'static str> {
        let path = leads.key.table();
        let common = self.tree.get(path).map_or(Vec::new(), |item| item.list().to_vec());
        let tree = match leads.name {
            Some(name) => self.tree_of(leads.key, name),
            None => &mut self.tree,
        };
        if tree.get(path).is_none_or(|item| item.list().is_empty()) {
            tree.put_list(path, common);
        }
        let index = leads.item.map_or(0, |number| number - 1);
        let list = tree.list_mut(path);
        let entry = list.and_then(|list| {
            if index == list.len() {
                let content = Content::Table(Table::default());
                list.push(Item { content, offset: None, named: leads.name.is_some() });
            }
            list.get_mut(index)
        });
        match entry {
            Some(Item { content: Content::Table(table), .. }) => table.exchange(leads.key, item),
            _ => Vec::new(),
        }
    }
}

/// Problem of a path to a key of a list of tables without an index.
pub(crate) fn which_item(path: &str) -> Problem {
    let (list, name) = path.rsplit_once('.').unwrap_or(("", path));
    Problem::WhichItem { example: format!("{list}.1.{name}") }
}
