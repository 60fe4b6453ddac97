//! Inheritance of scenes: a scene with `base` overrides keys of another file.
//!
//! Offsets count through both texts, the scene's own first, so that every error has its file and line.

use crate::scene::error::{Place, Problem, SceneError};
use crate::scene::tables::keys;
use crate::scene::text::document::{Document, Named};
use crate::scene::text::source;
use crate::scene::text::source::Source;
use crate::scene::text::table::{Item, Table};
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
                    Err(self
                        .refused(WITHOUT, "there is no base. Hint: leave it out, or name a base"))
                }
                false => Ok(self),
            };
        };
        if above == DEEPEST {
            let reason = format!(
                "this is base number {}; at most {DEEPEST} are read. Hint: is the chain of bases circular?",
                above + 1
            );
            return Err(self.refused(BASE, reason));
        }
        let path = self.folder().join(name);
        let unread = |error: SceneError| {
            let (path, problem) = (path.display(), error.problem);
            let hint = "a relative path starts at the scene's folder";
            let reason = format!("{path} cannot be read: {problem}. Hint: {hint}");
            self.refused(BASE, reason)
        };
        let (mut source, format) = source::read(&path).map_err(unread)?;
        source.is_fixed = Path::new(name).is_absolute();
        let mut base = Document::of_source(source, format, above + 1)?;
        if let Some(Checked::Text(paths)) = self.value(WITHOUT) {
            for path in paths.split(',').map(str::trim) {
                if !base.remove(path) {
                    let reason = format!(
                        "{} does not contain {path:?}. Hint: list keys, tables or named tables of the base, with commas",
                        base.name()
                    );
                    return Err(self.refused(WITHOUT, reason));
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
        self.file_at(self.place_of_key(key), name)
    }

    /// The same for the value of an entry.
    pub(crate) fn file_from(&self, item: &Item, name: &str) -> (PathBuf, String) {
        self.file_at(self.place_of_item(Some(item)), name)
    }

    fn file_at(&self, Place { file: from, .. }: Place, name: &str) -> (PathBuf, String) {
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
        base.tree.lay_over(&self.tree, "");
        for named in self.named {
            let same = |of: &&mut Named| of.table == named.table && of.name == named.name;
            match base.named.iter_mut().find(same) {
                Some(of_base) => of_base.tree.lay_over(&named.tree, ""),
                None => base.named.push(named),
            }
        }
        base.refuse_without_effect(&self.tree)?;
        Ok(base)
    }

    /// Removes a key, a table with its contents, or a named table (`sensor.top`); returns whether anything was removed.
    fn remove(&mut self, path: &str) -> bool {
        if [BASE, WITHOUT].contains(&path) {
            return false;
        }
        let named = self.named.len();
        // A table is removed together with its named tables.
        self.named.retain(|of| of.table != path && format!("{}.{}", of.table, of.name) != path);
        let some = named != self.named.len();
        match keys::without_name(path) {
            (path, None) => self.tree.remove(&path) || some,
            (path, Some(name)) => {
                let of_name = self.named.iter_mut().filter(|of| of.name == name);
                of_name.fold(some, |some, of| of.tree.remove(&path) || some)
            }
        }
    }

    /// Refuses keys without a name that every named table of the base overrides: they would have no effect.
    fn refuse_without_effect(&self, own: &Table) -> Result<(), SceneError> {
        let mut leaves = Vec::new();
        own.leaves("", &mut leaves);
        for (path, item) in leaves {
            if let (names, true) = self.overriding(&path) {
                let (table, rest) = path.split_once('.').unwrap_or((&path, ""));
                let all: Vec<String> =
                    names.iter().map(|name| format!("[{table}.{name}]")).collect();
                let reason = format!(
                    "it has no effect, because {} override it. Hint: write {table}.{}.{rest}",
                    all.join(", "),
                    names[0]
                );
                let problem = Problem::refused(reason);
                return Err(self.error_at(item.offset.unwrap_or(0), &path, problem));
            }
        }
        Ok(())
    }

    /// Shifts all offsets by the length of the text before.
    fn shift(&mut self, by: usize) {
        self.tree.shift(by);
        for named in &mut self.named {
            named.offset += by;
            named.tree.shift(by);
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
