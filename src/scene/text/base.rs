//! A scene on a base: what another file says, with the scene's own keys laid over it.
//!
//! Both are read as one text, the scene's own before that of its base, so that every error says in which file and line it is.

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
/// Key of what the base says and the scene has not.
pub(crate) const WITHOUT: &str = "without";
/// Bases may have bases, so many in all.
const DEEPEST: usize = 8;

impl Document {
    /// Reads the base that the scene names, if it does, and lays the scene's own keys over it. `above` scenes are on this one.
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
            let reason = format!("this is base number {}, and up to {DEEPEST} are read", above + 1);
            return Err(self.refused(BASE, reason, "do they go round in a circle?"));
        }
        let path = self.folder().join(name);
        let unread = |error: SceneError| {
            let reason = format!("{} cannot be read: {}", path.display(), error.problem);
            self.refused(BASE, reason, "a relative name starts at the scene's folder")
        };
        let (mut source, format) = source::read(&path).map_err(unread)?;
        source.is_fixed = Path::new(name).is_absolute();
        let mut base = Document::of_source(source, format, above + 1)?;
        if let Some(Checked::Text(paths)) = self.value(WITHOUT) {
            for path in paths.split(',').map(str::trim) {
                if !base.take_away(path) {
                    let reason = format!("{} says nothing of {path:?}", base.name());
                    let advice = "name keys, tables or names of the base, with commas between";
                    return Err(self.refused(WITHOUT, reason, advice));
                }
            }
        }
        self.laid_over(base)
    }

    /// Folder of the scene's file.
    fn folder(&self) -> &Path {
        Path::new(self.name()).parent().unwrap_or(Path::new(""))
    }

    /// A file that the value of a key names, from the folder of the file that the value stands in, and the same from the scene's unless
    /// its path begins at the root.
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

    /// The scene and its bases, and whether a path from the root leads to them.
    fn sources(&self) -> impl Iterator<Item = (&Source, bool)> {
        let first = (&*self.source, false);
        std::iter::successors(Some(first), |(of, fixed)| {
            let base = of.base.as_deref()?;
            Some((base, *fixed || base.is_fixed))
        })
    }

    /// This scene over its base.
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
        }
        base.refuse_unheard(&self.layer)?;
        Ok(base)
    }

    /// Takes away a key, a table with all that is in it, or all that has a name (`sensor.top`); whether there was anything.
    fn take_away(&mut self, path: &str) -> bool {
        if [BASE, WITHOUT].contains(&path) {
            return false;
        }
        let (named, assumed, swept) = (self.named.len(), self.assumptions.len(), self.sweep.len());
        // A whole table goes with those that have names.
        self.named.retain(|of| of.table != path && format!("{}.{}", of.table, of.name) != path);
        self.assumptions.retain(|of| !is_at(&format!("assumptions.{}", of.name), path));
        self.sweep.retain(|_| path != "sweep");
        let some =
            (named, assumed, swept) != (self.named.len(), self.assumptions.len(), self.sweep.len());
        match keys::without_name(path) {
            (path, None) => self.layer.take_away(&path) || some,
            (path, Some(name)) => {
                let of_name = self.named.iter_mut().filter(|of| of.name == name);
                // Each of them, not up to the first.
                let taken: Vec<bool> = of_name.map(|of| of.layer.take_away(&path)).collect();
                taken.contains(&true) || some
            }
        }
    }

    /// What the scene says without a name and every name has for itself would change nothing.
    fn refuse_unheard(&self, own: &Layer) -> Result<(), SceneError> {
        for (key, given) in KEYS.iter().zip(&own.given) {
            let in_list = || {
                let listed = own.items.iter().find(|item| item.table == key.table());
                listed.map(Item::begins).or(own.emptied.contains(&key.table()).then_some(0))
            };
            let given = given.as_ref().and_then(|given| given.offset);
            let Some(offset) = given.or_else(in_list) else { continue };
            let (names, nothing) = self.out_of_reach(key.path);
            if nothing {
                let path = if given.is_some() { key.path } else { key.table() };
                let (table, rest) = path.split_once('.').unwrap_or((path, ""));
                let all: Vec<String> =
                    names.iter().map(|name| format!("[{table}.{name}]")).collect();
                let reason =
                    format!("it changes nothing, since {} say it themselves", all.join(", "));
                let advice = format!("write {table}.{}.{rest}", names[0]);
                return Err(self.error_at(offset, path, Problem::refused(reason, advice)));
            }
        }
        Ok(())
    }

    /// Moves all places by the length of the text before.
    fn shift(&mut self, by: usize) {
        self.layer.shift(by);
        for named in &mut self.named {
            named.offset += by;
            named.layer.shift(by);
        }
    }

    /// Files that the scene is on, its base first: names from the scene's folder, and texts.
    pub fn bases(&self) -> Vec<(String, &str)> {
        let name = |source: &Source, fixed| self.shown_path(Path::new(&source.name), fixed);
        let bases = self.sources().skip(1);
        bases.map(|(source, fixed)| (name(source, fixed), source.text.as_str())).collect()
    }
}

/// A path without the ways into a folder and out again.
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

/// Whether a key or table is this one or in it.
fn is_at(known: &str, path: &str) -> bool {
    known.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

impl Layer {
    fn take_away(&mut self, path: &str) -> bool {
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
