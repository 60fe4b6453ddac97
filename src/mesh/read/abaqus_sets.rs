//! Named sets of an input deck: labels, scopes and the positions of their data lines.

use crate::mesh::read::abaqus_lines::{key, unquoted};
use crate::mesh::read::error::Problem;
use std::collections::HashMap;

/// Namespaces of labels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Of {
    Nodes,
    NodeSurface,
    Elements,
    Surface,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scope {
    /// The part or its instance.
    Part,
    /// The assembly, or a deck without parts.
    Model,
}

/// Data lines that add to a set.
pub struct Block {
    /// Positions of the keyword and of the first data line.
    pub at: usize,
    pub start: usize,
    pub scope: Scope,
    /// Key of the instance that is named.
    pub instance: Option<String>,
    pub form: Form,
}

pub enum Form {
    /// Labels and names of sets, or with GENERATE first, last and step.
    Members {
        generate: bool,
    },
    /// All nodes of an element set.
    NodesOf(String),
    /// A label or set a line, and a side or an area.
    Faces,
    Refused(Problem),
}

pub struct Set {
    pub of: Of,
    pub scope: Scope,
    /// As first written.
    pub name: String,
    pub at: usize,
    /// Members from *NODE and *ELEMENT.
    pub labels: Vec<u64>,
    pub blocks: Vec<Block>,
}

#[derive(Default)]
pub struct Sets {
    pub sets: Vec<Set>,
    index: HashMap<(Of, Scope, String), usize>,
    /// Labels as first written, by their keys.
    spelling: HashMap<(Scope, String), String>,
    /// Key and name of the instance.
    pub instance: Option<(String, String)>,
    /// Whether the assembly has nodes or elements of its own.
    pub own_nodes: bool,
    pub own_elements: bool,
}

impl Sets {
    /// Index of the set with this label; an empty one if it is new.
    pub fn named(&mut self, of: Of, scope: Scope, word: &str, at: usize) -> usize {
        let next = self.sets.len();
        let set = *self.index.entry((of, scope, key(word))).or_insert(next);
        if set == next {
            let first = self.spelling.entry((scope, key(word)));
            let name = first.or_insert_with(|| unquoted(word)).clone();
            self.sets.push(Set { of, scope, name, at, labels: Vec::new(), blocks: Vec::new() });
        }
        set
    }

    pub fn add_label(&mut self, set: usize, label: u64) {
        self.sets[set].labels.push(label);
    }

    pub fn add_block(&mut self, set: usize, block: Block) {
        self.sets[set].blocks.push(block);
    }

    pub fn find(&self, of: Of, block: &Block, word: &str) -> Option<usize> {
        let key = key(word);
        let get = |scope, key: &str| self.index.get(&(of, scope, key.to_string())).copied();
        if block.scope == Scope::Part || block.instance.is_some() {
            return get(Scope::Part, &key);
        }
        get(Scope::Model, &key).or_else(|| get(Scope::Part, self.within_instance(&key)?))
    }

    /// The part of a label behind the name of the instance: `SET` of `P-1.SET`.
    pub fn within_instance<'k>(&self, key: &'k str) -> Option<&'k str> {
        key.strip_prefix(self.instance.as_ref()?.0.as_str())?.strip_prefix('.')
    }

    /// Name in scenes: that of a set in a part is `instance.set`.
    pub fn name_of(&self, set: usize) -> String {
        let Set { scope, name, .. } = &self.sets[set];
        match (&self.instance, scope) {
            (Some((_, instance)), Scope::Part) => format!("{instance}.{name}"),
            _ => name.clone(),
        }
    }
}
