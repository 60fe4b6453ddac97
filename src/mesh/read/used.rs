//! Sets of a file that a scene uses.

use crate::mesh::read::{Loaded, Note, Problem, ReadError, SetKind};
use std::collections::BTreeMap;
use std::mem::{discriminant, take};

impl Loaded {
    /// Gives each set the name that the scene uses for it, and adds a note for every kind of fault of the others.
    ///
    /// # Errors
    /// The fault of a set that is used.
    pub fn use_sets(&mut self, used: &[&str]) -> Result<(), ReadError> {
        for name in used {
            if self.any_case {
                rename(&mut self.mesh.node_sets, name, used);
                rename(&mut self.mesh.surface_sets, name, used);
                rename(&mut self.mesh.element_sets, name, used);
            }
            let mesh = &self.mesh;
            let found = match () {
                () if mesh.node_sets.contains_key(*name) => Some(SetKind::Nodes),
                () if mesh.surface_sets.contains_key(*name) => Some(SetKind::Surface),
                () if mesh.element_sets.contains_key(*name) => Some(SetKind::Elements),
                () => None,
            };
            let same =
                |other: &str| other == *name || self.any_case && other.eq_ignore_ascii_case(name);
            let fault = self
                .unusable
                .iter()
                .find(|set| same(&set.name) && found.is_none_or(|kind| set.kind < kind));
            if let Some(set) = fault {
                return Err(set.error.clone());
            }
        }
        let mut skipped: Vec<(Vec<String>, ReadError)> = Vec::new();
        for set in take(&mut self.unusable) {
            let kind = |error: &ReadError| discriminant::<Problem>(&error.problem);
            match skipped.iter_mut().find(|(_, error)| kind(error) == kind(&set.error)) {
                Some((names, _)) => names.push(set.name),
                None => skipped.push((vec![set.name], set.error)),
            }
        }
        let notes = skipped.into_iter().map(|(names, error)| Note::SetsSkipped { names, error });
        self.notes.extend(notes);
        Ok(())
    }
}

/// Renames the set whose name differs from `name` in case alone, if there is one; copies it if both names are used.
fn rename<T: Clone>(sets: &mut BTreeMap<String, Vec<T>>, name: &str, used: &[&str]) {
    if sets.contains_key(name) {
        return;
    }
    let same = |other: &&String| other.eq_ignore_ascii_case(name);
    let found: Vec<String> = sets.keys().filter(same).cloned().collect();
    let [other] = &found[..] else { return };
    let set = match used.contains(&other.as_str()) {
        true => sets.get(other).cloned(),
        false => sets.remove(other),
    };
    sets.extend(set.map(|set| (name.to_string(), set)));
}
