//! Named tables: `[bearing.left]` inherits the keys of `[bearing]` and overrides some.

use crate::scene::error::{Problem, SceneError};
use crate::scene::tables::keys;
use crate::scene::tables::keys::Key;
use crate::scene::text::document::{Document, Layer, Named};
use crate::scene::text::items::Item;
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
        let mistyped = keys::nearest(&entry.name, keys::children(path).into_iter(), ALIKE);
        (is_table && mistyped.is_none()).then_some(*table)
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
            let reason = format!("more than {MOST} named tables");
            let advice = "all bodies are solved in one dense matrix; split the scene";
            let problem = Problem::refused(reason, advice);
            return Err(self.error_at(offset, &format!("{table}.{name}"), problem));
        }
        let Value::Table(entries) = node.value else { return Ok(()) };
        let others = std::mem::take(&mut self.layer);
        self.scope = Some(name.clone());
        self.layer.tables.push((table, offset));
        self.fill(table, entries)?;
        self.refuse_rivals()?;
        self.scope = None;
        let layer = std::mem::replace(&mut self.layer, others);
        self.named.push(Named { table, name, offset, layer });
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

    /// Returns whether a path is in the named table that is being read.
    pub(crate) fn is_in_named_table(&self, path: &str) -> bool {
        let top = path.split('.').next();
        self.layer.tables.first().is_some_and(|(table, _)| Some(*table) == top)
    }

    /// Returns whether a key is given in a named table; if it is not given, whether another key of its table is.
    pub(crate) fn is_named(&self, path: &str) -> bool {
        let is_own = |row: usize| self.layer.given[row].as_ref().is_some_and(|given| given.named);
        if let Some((row, _)) = keys::find(path).filter(|(row, _)| self.layer.given[*row].is_some())
        {
            return is_own(row);
        }
        let table = path.rsplit_once('.').map_or(path, |(table, _)| table);
        let in_it =
            |known: &str| known.strip_prefix(table).is_some_and(|rest| rest.starts_with('.'));
        keys::KEYS.iter().enumerate().any(|(row, key)| in_it(key.path) && is_own(row))
    }

    /// Names of one kind of table, in the order of the file.
    pub(crate) fn names<'d>(&'d self, table: &'d str) -> impl Iterator<Item = &'d str> {
        self.named.iter().filter(move |named| named.table == table).map(|n| n.name.as_str())
    }

    /// The document for one name: tables without a name, overridden by those of this name.
    pub fn scoped(&self, name: &str) -> Document {
        let mut scoped = self.clone();
        scoped.scope = Some(name.to_string());
        scoped.named.clear();
        for named in self.named.iter().filter(|named| named.name == name) {
            scoped.layer.lay_over(&named.layer);
        }
        scoped
    }

    /// Refuses named tables in a scene whose bearing has no name; sensors are allowed.
    pub(crate) fn refuse_names(&self) -> Result<(), SceneError> {
        let nobody = |named: &&Named| named.table != "sensor";
        let Some(named) = self.named.iter().find(nobody) else { return Ok(()) };
        let reason = format!("no bearing has the name {:?}", named.name);
        let advice = format!("write [{}], or [bearing.{}] as well", named.table, named.name);
        Err(self.error_of_name(named.table, &named.name, Problem::refused(reason, advice)))
    }

    /// The document without named tables.
    pub(crate) fn common(&self) -> Document {
        let mut common = self.clone();
        common.named.clear();
        common
    }

    /// Copies the value of another document's key to a key of this one.
    pub(crate) fn take_over(&mut self, from: &Document, source: &str, path: &str) {
        let given = keys::find(source).and_then(|(row, _)| from.layer.given[row].clone());
        if let (Some((row, key)), Some(given)) = (keys::find(path), given) {
            self.layer.put(row, key, given);
        }
    }

    /// Problem with the name in a path to this key; `None` if it is known. Tables that describe parts of a bearing use the
    /// names of bearings, whether or not the file has such a table.
    pub(crate) fn refused_name(&self, key: &Key, name: &str) -> Option<Problem> {
        let kind = kind_of(key);
        let known = || self.names(kind);
        known().all(|known| known != name).then(|| no_such(name, kind, known()))
    }

    /// Keys of the table with this name; an empty layer is added if the file has none.
    pub(crate) fn layer_of(&mut self, key: &Key, name: &str) -> &mut Layer {
        let table = table_of(key);
        let own = |named: &Named| named.table == table && named.name == name;
        let index = self.named.iter().position(own).unwrap_or_else(|| {
            let of_kind = |named: &&Named| named.table == kind_of(key) && named.name == name;
            let offset = self.named.iter().find(of_kind).map_or(0, |named| named.offset);
            self.named.push(Named { table, name: name.into(), offset, layer: Layer::default() });
            self.named.len() - 1
        });
        &mut self.named[index].layer
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
    let table = table_of(key);
    if keys::OWN_NAMES.contains(&table) { table } else { "bearing" }
}

/// Problem of an unknown name, with the most similar known one.
pub(crate) fn no_such<'n>(name: &str, kind: &str, known: impl Iterator<Item = &'n str>) -> Problem {
    let known: Vec<&str> = known.collect();
    let nearest = keys::nearest(name, known.iter().copied(), 0.5);
    let reason = match known.is_empty() {
        true => format!("there is no {kind} {name:?}, nor any other named {kind}"),
        false => format!("there is no {kind} {name:?}; there are: {}", known.join(", ")),
    };
    let advice = match nearest {
        Some(nearest) => format!("did you mean {nearest}?"),
        None => format!("add [{kind}.{name}]"),
    };
    Problem::refused(reason, advice)
}

impl Layer {
    /// Merges `other` into this layer; its keys win, and its lists, also empty ones, replace whole lists.
    pub(crate) fn lay_over(&mut self, other: &Layer) {
        for (row, given) in other.given.iter().enumerate() {
            if let Some(given) = given {
                self.put(row, &keys::KEYS[row], given.clone());
            }
        }
        self.tables.extend(&other.tables);
        let replaced = |item: &Item| {
            other.emptied.contains(&item.table)
                || other.items.iter().any(|own| own.table == item.table)
        };
        self.items.retain(|item| !replaced(item));
        self.items.extend(other.items.iter().cloned());
        // Needed when this layer is merged into another.
        self.emptied.retain(|table| other.items.iter().all(|item| item.table != *table));
        self.emptied.extend(&other.emptied);
    }
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
    let advice = "choose another name, such as left";
    Some(Problem::refused(reason, advice))
}
