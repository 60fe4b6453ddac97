//! The keys of a scene as a tree of checked values with their positions.

use crate::scene::tables::keys;
use crate::scene::tables::keys::Key;
use crate::scene::text::value::Checked;

/// A key, a table or a list of tables.
#[derive(Clone, Debug)]
pub(crate) struct Item {
    pub content: Content,
    /// `None` for a value that was set after reading.
    pub offset: Option<usize>,
    /// True if it is in a named table.
    pub named: bool,
}

#[derive(Clone, Debug)]
pub(crate) enum Content {
    Value(Checked),
    Table(Table),
    /// The tables of a list; an empty list removes an inherited one.
    List(Vec<Item>),
}

impl Item {
    pub fn value(&self) -> Option<&Checked> {
        if let Content::Value(value) = &self.content { Some(value) } else { None }
    }

    pub fn table(&self) -> Option<&Table> {
        if let Content::Table(table) = &self.content { Some(table) } else { None }
    }

    pub fn list(&self) -> &[Item] {
        if let Content::List(list) = &self.content { list } else { &[] }
    }

    fn shift(&mut self, by: usize) {
        self.offset = self.offset.map(|offset| offset + by);
        match &mut self.content {
            Content::Value(_) => {}
            Content::Table(table) => table.shift(by),
            Content::List(list) => list.iter_mut().for_each(|item| item.shift(by)),
        }
    }
}

/// Entries in the order of the file, those of a base first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table(pub Vec<(String, Item)>);

impl Table {
    pub fn own(&self, name: &str) -> Option<&Item> {
        self.0.iter().find(|(own, _)| own == name).map(|(_, item)| item)
    }

    fn own_mut(&mut self, name: &str) -> Option<&mut Item> {
        self.0.iter_mut().find(|(own, _)| own == name).map(|(_, item)| item)
    }

    /// The entry at a dotted path.
    pub fn get(&self, path: &str) -> Option<&Item> {
        match path.split_once('.') {
            None => self.own(path),
            Some((name, rest)) => self.own(name)?.table()?.get(rest),
        }
    }

    /// The entry at a dotted path, else the innermost table that would contain it.
    pub fn innermost(&self, path: &str) -> Option<&Item> {
        let (name, rest) = path.split_once('.').unwrap_or((path, ""));
        let item = self.own(name)?;
        item.table().and_then(|table| table.innermost(rest)).or(Some(item))
    }

    /// Sets the entry at a dotted path; tables on the way are made.
    fn put(&mut self, path: &str, item: Item, outside: Option<usize>) {
        let Some((name, rest)) = path.split_once('.') else {
            match self.own_mut(path) {
                Some(own) => *own = item,
                None => self.0.push((path.to_string(), item)),
            }
            return;
        };
        if self.own(name).is_none_or(|own| own.table().is_none()) {
            let content = Content::Table(Table::default());
            self.put(name, Item { content, offset: outside, named: item.named }, None);
        }
        if let Some(Item { content: Content::Table(table), offset, .. }) = self.own_mut(name) {
            table.put(rest, item, *offset);
        }
    }

    /// Sets a key, and removes those that it excludes; returns their paths.
    pub fn exchange(&mut self, key: &'static Key, item: Item) -> Vec<&'static str> {
        let local = |key: &'static Key| if key.in_list() { key.name() } else { key.path };
        let rivals = key.rivals().filter(|rival| self.remove(local(rival)));
        let gone = rivals.map(|rival| rival.path).collect();
        self.put(local(key), item, None);
        gone
    }

    /// The tables of the list at a dotted path.
    pub fn list_mut(&mut self, path: &str) -> Option<&mut Vec<Item>> {
        match (path.split_once('.'), self) {
            (None, table) => match &mut table.own_mut(path)?.content {
                Content::List(list) => Some(list),
                _ => None,
            },
            (Some((name, rest)), table) => match &mut table.own_mut(name)?.content {
                Content::Table(table) => table.list_mut(rest),
                _ => None,
            },
        }
    }

    /// Puts a list at a dotted path.
    pub fn put_list(&mut self, path: &str, list: Vec<Item>) {
        let item = Item { content: Content::List(list), offset: None, named: true };
        self.put(path, item, None);
    }

    /// Removes a key, list or table; returns whether there was one.
    pub fn remove(&mut self, path: &str) -> bool {
        let (name, rest) = path.split_once('.').unwrap_or((path, ""));
        if rest.is_empty() {
            let before = self.0.len();
            self.0.retain(|(own, _)| own != name);
            return before != self.0.len();
        }
        match self.own_mut(name) {
            Some(Item { content: Content::Table(table), .. }) => table.remove(rest),
            _ => false,
        }
    }

    /// Merges other entries into the table `path`. They win and remove keys that they exclude; a list, also an empty
    /// one, and `[sweep]` replace the whole.
    pub fn lay_over(&mut self, other: &Table, path: &str) {
        for (name, item) in &other.0 {
            let full = joined(path, name);
            if full != "sweep"
                && let (Some(inner), Some(own)) = (item.table(), self.own_mut(name))
                && let Content::Table(table) = &mut own.content
            {
                table.lay_over(inner, &full);
                own.offset = item.offset;
                own.named |= item.named;
                continue;
            }
            for rival in keys::find(&full).into_iter().flat_map(|(_, key)| key.rivals()) {
                if rival.table() == path {
                    self.remove(rival.name());
                }
            }
            self.put(name, item.clone(), None);
        }
    }

    pub fn shift(&mut self, by: usize) {
        self.0.iter_mut().for_each(|(_, item)| item.shift(by));
    }

    /// Paths of keys and lists below the table `path`, with their entries.
    pub fn leaves<'t>(&'t self, path: &str, found: &mut Vec<(String, &'t Item)>) {
        for (name, item) in &self.0 {
            let full = joined(path, name);
            match item.table() {
                Some(table) => table.leaves(&full, found),
                None => found.push((full, item)),
            }
        }
    }

    /// Returns whether a key of the table, or of one inside, is in a named table.
    pub fn any_named(&self) -> bool {
        self.0.iter().any(|(_, item)| match &item.content {
            Content::Value(_) => item.named,
            Content::Table(table) => table.any_named(),
            Content::List(_) => false,
        })
    }
}

/// A dotted path.
pub(crate) fn joined(table: &str, name: &str) -> String {
    if table.is_empty() { name.to_string() } else { format!("{table}.{name}") }
}
