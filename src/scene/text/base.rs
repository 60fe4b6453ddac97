//! Inheritance of scenes: a scene with `base` overrides keys of another file.
//!
//! Offsets count through both texts, the scene's own first, so that every error has its file and line.

use crate::scene::error::{Problem, SceneError};
use crate::scene::tables::keys;
use crate::scene::tables::keys::KEYS;
use crate::scene::text::document::{Document, Given, Layer};
use crate::scene::text::items::Item;
use crate::scene::text::source;
use crate::scene::text::source::Source;
use crate::scene::text::value::Checked;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Key of the base's file.
pub(crate) const BASE: &str = "base";
/// Key of the parts of the base that are not inherited.
pub(crate) const WITHOUT: &str = "without";
/// Maximum number of bases in a chain.
const DEEPEST: usize = 8;

impl Document {
    /// Reads the scene's base, if any, and overrides its keys. `above` is the number of scenes that inherit this one.
    pub(crate) fn on_base(self, above: usize) -> Result<Document, SceneError> {
        let Some(Checked::Text(name)) = self.value(BASE) else {
            return match self.is_given(WITHOUT) {
                true => {
                    Err(self.refused(WITHOUT, "there is no base", "leave it out, or name a base"))
                }
                false => Ok(self),
            };
        };
        if above == DEEPEST {
            let reason = format!("this is base number {}; at most {DEEPEST} are read", above + 1);
            return Err(self.refused(BASE, reason, "is the chain of bases circular?"));
        }
        let path = self.folder().join(name);
        let unread = |error: SceneError| {
            let reason = format!("{} cannot be read: {}", path.display(), error.problem);
            self.refused(BASE, reason, "a relative path starts at the scene's folder")
        };
        let (mut source, format) = source::read(&path).map_err(unread)?;
        source.is_fixed = Path::new(name).is_absolute();
        let mut base = Document::of_source(source, format, above + 1)?;
        if let Some(Checked::Text(paths)) = self.value(WITHOUT) {
            for path in paths.split(',').map(str::trim) {
                if !base.remove(path) {
                    let reason = format!("{} does not contain {path:?}", base.name());
                    let advice = "list keys, tables or named tables of the base, with commas";
                    return Err(self.refused(WITHOUT, reason, advice));
                }
            }
        }
        self.laid_over(base)
    }

    fn folder(&self) -> &Path {
        Path::new(self.name()).parent().unwrap_or(Path::new(""))
    }

    /// Path of the file named by a key's value, relative to the file that contains the key; and the same relative to the scene's
    /// folder, for messages, unless it is absolute.
    pub(crate) fn file(&self, key: &str, name: &str) -> (PathBuf, String) {
        let from = self.place_of_key(key).file;
        let path = Path::new(&from).parent().unwrap_or(Path::new("")).join(name);
        let fixed = Path::new(name).is_absolute()
            || self.sources().any(|(source, fixed)| fixed && source.name == from);
        let shown = self.shown_path(&path, fixed);
        (path, shown)
    }

    fn shown_path(&self, path: &Path, fixed: bool) -> String {
        let path = straight(path);
        let own = path.strip_prefix(straight(self.folder())).ok().filter(|_| !fixed);
        own.unwrap_or(&path).display().to_string()
    }

    /// The scene and its bases, each with true if it is named by an absolute path.
    fn sources(&self) -> impl Iterator<Item = (&Source, bool)> {
        let first = (&*self.source, false);
        std::iter::successors(Some(first), |(of, fixed)| {
            let base = of.base.as_deref()?;
            Some((base, *fixed || base.is_fixed))
        })
    }

    /// Merges this scene into its base; the scene's keys win.
    fn laid_over(self, mut base: Document) -> Result<Document, SceneError> {
        base.shift(self.source.length());
        let own = Arc::unwrap_or_clone(self.source);
        base.source = Arc::new(Source { base: Some(base.source), ..own });
        base.layer.lay_over(&self.layer);
        for named in self.named {
            let same = |of: &&mut crate::scene::text::document::Named| {
                of.table == named.table && of.name == named.name
            };
            match base.named.iter_mut().find(same) {
                Some(of_base) => of_base.layer.lay_over(&named.layer),
                None => base.named.push(named),
            }
        }
        let own_names: Vec<&String> = self.assumptions.iter().map(|of| &of.name).collect();
        base.assumptions.retain(|of| !own_names.contains(&&of.name));
        base.assumptions.extend(self.assumptions);
        if self.layer.tables.iter().any(|(table, _)| *table == "sweep") {
            base.sweep = self.sweep;
            for (row, _) in ["sweep.of", "sweep.together"].into_iter().filter_map(keys::find) {
                base.layer.given[row] = self.layer.given[row].clone();
            }
        }
        base.refuse_without_effect(&self.layer)?;
        Ok(base)
    }

    /// Removes a key, a table with its contents, or a named table (`sensor.top`); returns whether anything was removed.
    fn remove(&mut self, path: &str) -> bool {
        if [BASE, WITHOUT].contains(&path) {
            return false;
        }
        let (named, assumed, swept) = (self.named.len(), self.assumptions.len(), self.sweep.len());
        // A table is removed together with its named tables.
        self.named.retain(|of| of.table != path && format!("{}.{}", of.table, of.name) != path);
        self.assumptions.retain(|of| !is_at(&format!("assumptions.{}", of.name), path));
        self.sweep.retain(|_| path != "sweep");
        let some =
            (named, assumed, swept) != (self.named.len(), self.assumptions.len(), self.sweep.len());
        match keys::without_name(path) {
            (path, None) => self.layer.remove(&path) || some,
            (path, Some(name)) => {
                let of_name = self.named.iter_mut().filter(|of| of.name == name);
                // Collected, so that all are removed and not only up to the first.
                let taken: Vec<bool> = of_name.map(|of| of.layer.remove(&path)).collect();
                taken.contains(&true) || some
            }
        }
    }

    /// Refuses keys without a name that every named table of the base overrides: they would have no effect.
    fn refuse_without_effect(&self, own: &Layer) -> Result<(), SceneError> {
        for (key, given) in KEYS.iter().zip(&own.given) {
            let in_list = || {
                let listed = own.items.iter().find(|item| item.table == key.table());
                listed.map(Item::begins).or(own.emptied.contains(&key.table()).then_some(0))
            };
            let given = given.as_ref().and_then(|given| given.offset);
            let Some(offset) = given.or_else(in_list) else { continue };
            let (names, nothing) = self.outside_range(key.path);
            if nothing {
                let path = if given.is_some() { key.path } else { key.table() };
                let (table, rest) = path.split_once('.').unwrap_or((path, ""));
                let all: Vec<String> =
                    names.iter().map(|name| format!("[{table}.{name}]")).collect();
                let reason = format!("it has no effect, because {} override it", all.join(", "));
                let advice = format!("write {table}.{}.{rest}", names[0]);
                return Err(self.error_at(offset, path, Problem::refused(reason, advice)));
            }
        }
        Ok(())
    }

    /// Shifts all offsets by the length of the text before.
    fn shift(&mut self, by: usize) {
        self.layer.shift(by);
        for named in &mut self.named {
            named.offset += by;
            named.layer.shift(by);
        }
    }

    /// Bases of the scene, the nearest first: path relative to the scene's folder, and text.
    pub fn bases(&self) -> Vec<(String, &str)> {
        let name = |source: &Source, fixed| self.shown_path(Path::new(&source.name), fixed);
        let bases = self.sources().skip(1);
        bases.map(|(source, fixed)| (name(source, fixed), source.text.as_str())).collect()
    }
}

/// Normalises a path: removes `folder/..`.
fn straight(path: &Path) -> PathBuf {
    let mut straight = PathBuf::new();
    for part in path.components() {
        let back = part == Component::ParentDir
            && matches!(straight.components().next_back(), Some(Component::Normal(_)));
        if back {
            straight.pop();
        } else {
            straight.push(part);
        }
    }
    straight
}

/// Returns whether the key or table `known` is `path` or inside it.
fn is_at(known: &str, path: &str) -> bool {
    known.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

impl Layer {
    fn remove(&mut self, path: &str) -> bool {
        let mut some = false;
        for (key, given) in KEYS.iter().zip(&mut self.given) {
            some |= is_at(key.path, path) && given.take().is_some();
        }
        let lists = (self.items.len(), self.emptied.len());
        self.items.retain(|item| !is_at(item.table, path));
        self.emptied.retain(|table| !is_at(table, path));
        self.tables.retain(|(table, _)| !is_at(table, path));
        some || lists != (self.items.len(), self.emptied.len())
    }

    fn shift(&mut self, by: usize) {
        self.given.iter_mut().flatten().for_each(|given| given.shift(by));
        self.tables.iter_mut().for_each(|(_, offset)| *offset += by);
        self.items.iter_mut().for_each(|item| item.shift(by));
    }
}

impl Given {
    pub(crate) fn shift(&mut self, by: usize) {
        self.offset = self.offset.map(|offset| offset + by);
    }
}
