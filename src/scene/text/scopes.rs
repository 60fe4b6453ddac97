//! Named tables: `[bearing.left]` inherits the keys of `[bearing]` and overrides some.

use crate::scene::error::{Problem, SceneError};
use crate::scene::tables::keys;
use crate::scene::tables::keys::{Key, Leads};
use crate::scene::text::document::{Document, Named};
use crate::scene::text::table::{Content, Item, Table};
use crate::scene::text::tree::{Entry, Value};

/// Similarity (0 to 1) from which a name is taken for a mistyped key or table of the same level.
const ALIKE: f64 = 0.75;
/// Maximum number of named tables in a scene.
const MOST: usize = 500;
/// Maximum length of a name, which is a prefix of column names.
const LONGEST_NAME: usize = 32;

impl Document {
    /// The table of which this entry is a named table; `None` if it cannot be one.
    pub(crate) fn as_name(&self, path: &str, entry: &Entry) -> Option<&'static str> {
        let table = keys::NAMED.iter().find(|table| **table == path)?;
        let is_table = matches!(entry.node.value, Value::Table(_)) && self.scope.is_none();
        let is_known = self.named.iter().any(|named| named.name == entry.name);
        let mistyped = keys::nearest(&entry.name, keys::children(path).into_iter(), ALIKE);
        (is_table && (is_known || mistyped.is_none())).then_some(*table)
    }

    pub(crate) fn fill_named(
        &mut self,
        table: &'static str,
        entry: Entry,
    ) -> Result<(), SceneError> {
        let Entry { name, offset, node } = entry;
        if let Some(problem) = unfit(&name) {
            return Err(self.error_at(offset, &format!("{table}.{name}"), problem));
        }
        if self.named.len() == MOST {
            let reason = format!(
                "more than {MOST} named tables. Hint: all bodies are solved in one dense matrix; split the scene"
            );
            let problem = Problem::refused(reason);
            return Err(self.error_at(offset, &format!("{table}.{name}"), problem));
        }
        let Value::Table(entries) = node.value else { return Ok(()) };
        self.scope = Some(name.clone());
        let inner = self.table(table, &format!("{table}.{name}"), entries)?;
        self.scope = None;
        let item = Item { content: Content::Table(inner), offset: Some(offset), named: true };
        let tree = Table(vec![(table.to_string(), item)]);
        self.named.push(Named { table, name, offset, tree });
        Ok(())
    }

    /// A path as in the file: with the name if it is in a named table.
    pub(crate) fn shown(&self, path: &str, named: bool) -> String {
        match &self.scope {
            Some(name) if named => match path.split_once('.') {
                Some((table, rest)) => format!("{table}.{name}.{rest}"),
                None => format!("{path}.{name}"),
            },
            _ => path.to_string(),
        }
    }

    /// Returns whether a key is given in a named table; if it is not given, whether another key of its table is.
    pub(crate) fn is_named(&self, path: &str) -> bool {
        let table = path.rsplit_once('.').map_or(path, |(table, _)| table);
        match self.tree.get(path) {
            Some(Item { content: Content::Value(_), named, .. }) => *named,
            _ => self.tree.get(table).and_then(Item::table).is_some_and(Table::any_named),
        }
    }

    /// Names of one kind of table, in the order of the file.
    pub(crate) fn names<'d>(&'d self, table: &'d str) -> impl Iterator<Item = &'d str> {
        self.named.iter().filter(move |named| named.table == table).map(|n| n.name.as_str())
    }

    /// The document for one name: tables without a name, overridden by those of this name.
    pub fn scoped(&self, name: &str) -> Document {
        let (source, tree, scope) =
            (self.source.clone(), self.merged(name), Some(name.to_string()));
        Document { source, tree, named: Vec::new(), scope, in_si: self.in_si }
    }

    /// Tables without a name, overridden by those of this name.
    pub(crate) fn merged(&self, name: &str) -> Table {
        let mut tree = self.tree.clone();
        let own = self.named.iter().filter(|named| named.name == name);
        own.for_each(|named| tree.lay_over(&named.tree, ""));
        tree
    }

    /// Refuses named tables in a scene whose bearing has no name; sensors are allowed.
    pub(crate) fn refuse_names(&self) -> Result<(), SceneError> {
        let nobody = |named: &&Named| named.table != "sensor";
        let Some(named) = self.named.iter().find(nobody) else { return Ok(()) };
        let reason = format!(
            "no bearing has the name {:?}. Hint: write [{}], or [bearing.{}] as well",
            named.name, named.table, named.name
        );
        Err(self.error_of_name(named.table, &named.name, Problem::refused(reason)))
    }

    /// The document without named tables.
    pub(crate) fn common(&self) -> Document {
        let mut common = self.clone();
        common.named.clear();
        common
    }

    /// Copies the value of another document's key to a key of this one.
    pub(crate) fn take_over(&mut self, from: &Document, source: &str, path: &str) {
        if let (Some((_, key)), Some(given)) = (keys::find(path), from.tree.get(source)) {
            self.tree.exchange(key, given.clone());
        }
    }

    /// Names whose own tables override a key without a name, and whether all do, so that the key has no effect. Empty and
    /// false for a key with a name.
    pub fn outside_range(&self, path: &str) -> (Vec<String>, bool) {
        match keys::find_named(path) {
            Some(Leads { key, name: None, .. }) if key.in_list() => self.overriding(key.table()),
            Some(Leads { key, name: None, .. }) => self.overriding(key.path),
            _ => (Vec::new(), false),
        }
    }

    /// The same for a key or list.
    pub(crate) fn overriding(&self, path: &str) -> (Vec<String>, bool) {
        let Some(table) =
            keys::NAMED.into_iter().find(|table| Some(*table) == path.split('.').next())
        else {
            return (Vec::new(), false);
        };
        let rivals = keys::find(path).into_iter().flat_map(|(_, key)| key.rivals());
        let paths: Vec<&str> = rivals.map(|rival| rival.path).chain([path]).collect();
        let overrides = |named: &&Named| {
            named.table == table && paths.iter().any(|path| named.tree.get(path).is_some())
        };
        let own: Vec<String> =
            self.named.iter().filter(overrides).map(|n| n.name.clone()).collect();
        let mut names = self.names(keys::kind_of_names(table)).chain(self.names(table)).peekable();
        let nothing = names.peek().is_some() && names.all(|name| own.iter().any(|own| own == name));
        (own, nothing)
    }

    /// Problem with the name in a path to this key; `None` if it is known. Tables that describe parts of a bearing use the
    /// names of bearings, whether or not the file has such a table.
    pub(crate) fn refused_name(&self, key: &Key, name: &str) -> Option<Problem> {
        let kind = kind_of(key);
        let known = || self.names(kind);
        known().all(|known| known != name).then(|| no_such(name, kind, known()))
    }

    /// Keys of the table with this name; an empty table is added if the file has none.
    pub(crate) fn tree_of(&mut self, key: &Key, name: &str) -> &mut Table {
        let table = table_of(key);
        let own = |named: &Named| named.table == table && named.name == name;
        let index = self.named.iter().position(own).unwrap_or_else(|| {
            let of_kind = |named: &&Named| named.table == kind_of(key) && named.name == name;
            let offset = self.named.iter().find(of_kind).map_or(0, |named| named.offset);
            self.named.push(Named { table, name: name.into(), offset, tree: Table::default() });
            self.named.len() - 1
        });
        &mut self.named[index].tree
    }

    /// An error of a key of a bearing with or without a name.
    pub(crate) fn error_of(&self, name: Option<&str>, key: &str, problem: Problem) -> SceneError {
        match name {
            Some(name) => self.scoped(name).error(key, problem),
            None => self.error(key, problem),
        }
    }

    pub(crate) fn error_of_name(&self, table: &str, name: &str, problem: Problem) -> SceneError {
        let own = self.named.iter().find(|named| named.table == table && named.name == name);
        let path = format!("{table}.{name}");
        match own {
            Some(named) => self.error_at(named.offset, &path, problem),
            None => self.error(table, problem),
        }
    }
}

/// The table of [`keys::NAMED`] that contains a key.
fn table_of(key: &Key) -> &'static str {
    let table = key.path.split('.').next();
    keys::NAMED.into_iter().find(|named| Some(*named) == table).unwrap_or("bearing")
}

/// Kind of the names of that table: bodies, springs and sensors have their own, all others those of bearings.
fn kind_of(key: &Key) -> &'static str {
    keys::kind_of_names(table_of(key))
}

/// Problem of an unknown name, with the most similar known one.
pub(crate) fn no_such<'n>(name: &str, kind: &str, known: impl Iterator<Item = &'n str>) -> Problem {
    let known: Vec<&str> = known.collect();
    let nearest = keys::nearest(name, known.iter().copied(), 0.5);
    let others = match known.is_empty() {
        true => format!(", nor any other named {kind}"),
        false => format!("; there are: {}", known.join(", ")),
    };
    let hint = match nearest {
        Some(nearest) => format!("did you mean {nearest}?"),
        None => format!("add [{kind}.{name}]"),
    };
    Problem::refused(format!("there is no {kind} {name:?}{others}. Hint: {hint}"))
}

/// Problem with a user's name, which is part of column and file names; `None` if it is valid.
pub(crate) fn unfit(name: &str) -> Option<Problem> {
    const RESERVED: [&str; 5] = ["inner_race", "outer_race", "ground", "inner", "outer"];
    let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic());
    let reason = if !begins || !name.chars().all(letters) {
        "a name consists of letters, digits and underscores and begins with a letter"
    } else if name.len() > LONGEST_NAME {
        "a name has up to 32 letters, because it is a prefix of column names"
    } else if RESERVED.contains(&name) {
        "this name is reserved"
    } else {
        return None;
    };
    Some(Problem::refused(format!("{reason}. Hint: choose another name, such as left")))
}
