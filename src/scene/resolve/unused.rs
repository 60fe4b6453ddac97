//! Refuses keys that the chosen kind, law or method does not use.

use crate::scene::error::SceneError;
use crate::scene::tables::keys;
use crate::scene::tables::keys::{DEFAULT_SETS, Key, Need};
use crate::scene::text::document::Document;
use crate::scene::text::table::Item;
use crate::scene::text::value::Checked;

/// # Errors
///
/// The first such key of these tables.
pub(crate) fn refuse_unused(document: &Document, tables: &[&str]) -> Result<(), SceneError> {
    for table in tables {
        let mut leaves = Vec::new();
        if let Some(inner) = document.tree.get(table).and_then(Item::table) {
            inner.leaves(table, &mut leaves);
        }
        for (path, _) in leaves {
            if let Some((_, key)) = keys::find(&path)
                && let Some(reason) = unused(key, |choice| document.value(choice))
            {
                return Err(document.refused(&path, reason));
            }
            for item in document.items(&path) {
                let choice = |choice: &'static str| match choice.strip_prefix(path.as_str()) {
                    Some(name) => item.value(name.trim_start_matches('.')),
                    None => document.value(choice),
                };
                for name in item.names() {
                    if let Some((_, key)) = keys::find(&item.path(name))
                        && let Some(reason) = unused(key, choice)
                    {
                        return Err(item.refused(name, reason));
                    }
                }
            }
        }
    }
    Ok(())
}

/// Reason of a key without effect.
pub(crate) fn unused<'d>(
    key: &Key,
    choice: impl Fn(&'static str) -> Option<&'d Checked>,
) -> Option<String> {
    let (path, words) = key.only?;
    let (_, chooser) = keys::find(path)?;
    let given = choice(path).and_then(Checked::choice);
    if given.is_none() && chooser.need == Need::Required {
        return None;
    }
    let default = || chooser.need.default_in(DEFAULT_SETS[0]).map(|(value, _)| value);
    if given.or_else(default).is_some_and(|chosen| words.contains(&chosen)) {
        return None;
    }
    let name = if chooser.table() == key.table() { chooser.name() } else { path };
    let users = words.iter().filter(|word| **word != "none");
    let users: Vec<String> = users.map(|word| format!("`{name} = \"{word}\"`")).collect();
    Some(format!("only with {}. Hint: leave it out, or change that", users.join(" or ")))
}
