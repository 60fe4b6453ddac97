//! Members of the sets of an input deck, found when all of it has been read: sets may be used before they are defined.
//!
//! Labels of the assembly without an instance are those of its own nodes and elements if it has any, which are no part of
//! the mesh.

use crate::mesh::read::abaqus_lines::{key, label, unquoted, words};
use crate::mesh::read::abaqus_sets::{Block, Form, Of, Scope, Set, Sets};
use crate::mesh::read::assemble::{Numbered, RawFace, RawMesh, RawSurface};
use crate::mesh::read::error::{Problem, ReadError};
use crate::mesh::read::source::{Source, decode, excerpt};
use crate::mesh::read::{Note, SetKind};
use std::collections::HashMap;

/// Adds all sets to the mesh, or to its list of unusable ones.
///
/// # Errors
/// More members than a file of this length can define.
pub fn resolve(sets: &Sets, raw: &mut RawMesh, source: &Source) -> Result<(), ReadError> {
    let states = sets.sets.iter().map(|_| State::Waiting).collect();
    let mut resolver = Resolver { sets, source, raw, states, missing: HashMap::new() };
    let mut order: Vec<usize> = (0..sets.sets.len()).collect();
    order.sort_by_key(|&set| sets.sets[set].of);
    for set in order {
        if let Err(error) = resolver.publish(set) {
            if matches!(error.problem, Problem::TooManyMembers { .. }) {
                return Err(error);
            }
            let kind = match (sets.sets[set].of, &error.problem) {
                (Of::Nodes | Of::NodeSurface, _) | (_, Problem::TwoSets { .. }) => SetKind::Nodes,
                (Of::Elements, _) => SetKind::Elements,
                (Of::Surface, _) => SetKind::Surface,
            };
            resolver.raw.skip_set(&sets.name_of(set), kind, error);
        }
    }
    Ok(())
}

enum State {
    Waiting,
    Open,
    Done(Result<Vec<u64>, ReadError>),
}

struct Resolver<'r, 's> {
    sets: &'r Sets,
    source: &'r Source<'s>,
    raw: &'r mut RawMesh,
    states: Vec<State>,
    /// Count, first label and position of members that the deck does not define.
    missing: HashMap<usize, (usize, u64, usize)>,
}

/// Most sets within each other.
const DEEPEST: usize = 50;

impl<'r> Resolver<'r, '_> {
    fn error<T>(&self, at: usize, problem: Problem) -> Result<T, ReadError> {
        Err(self.source.error_at(at, problem))
    }

    fn publish(&mut self, set: usize) -> Result<(), ReadError> {
        let Set { of, at, .. } = self.sets.sets[set];
        let name = self.sets.name_of(set);
        let (mut faces, mut members) = (Vec::new(), Vec::new());
        match of {
            Of::Surface => faces = self.faces(set)?,
            _ => members = self.members(set, 0)?,
        }
        if faces.is_empty() && members.is_empty() {
            return self.error(at, Problem::NoMembers { set: name });
        }
        if let Some((count, first, at)) = self.missing.remove(&set) {
            let kind = if of < Of::Elements { "node" } else { "element" };
            let place = self.source.place(at);
            let set = name.clone();
            self.raw.notes.push(Note::Missing { set, kind, count, first, place });
        }
        match of {
            Of::Nodes | Of::NodeSurface => return self.publish_nodes(name, at, members),
            Of::Elements => return self.publish_elements(name, at, members),
            Of::Surface => {
                self.raw.surface_sets.insert(name, RawSurface { at, faces, lines: Vec::new() })
            }
        };
        Ok(())
    }

    fn publish_nodes(&mut self, name: String, at: usize, nodes: Vec<u64>) -> Result<(), ReadError> {
        match self.raw.node_sets.get(&name) {
            Some(other) if *other != nodes => {
                self.raw.node_sets.remove(&name);
                self.error(at, Problem::TwoSets { set: name })
            }
            _ => {
                self.raw.node_sets.insert(name, nodes);
                Ok(())
            }
        }
    }

    /// Tetrahedra become an element set, triangles a surface, lines a node set.
    fn publish_elements(
        &mut self,
        name: String,
        at: usize,
        members: Vec<u64>,
    ) -> Result<(), ReadError> {
        let (mut tets, mut faces, mut nodes) = (Vec::new(), Vec::new(), Vec::new());
        for tag in members {
            match self.raw.numbered.get(&tag) {
                None => tets.push(tag),
                Some(Numbered::Triangle(corners)) => faces.push(RawFace::Corners(*corners)),
                Some(Numbered::Line(ends)) => nodes.extend(ends),
            }
        }
        if !tets.is_empty() {
            self.raw.element_sets.insert(name.clone(), tets);
        }
        if !faces.is_empty() {
            let lines = std::mem::take(&mut nodes);
            self.raw.surface_sets.insert(name.clone(), RawSurface { at, faces, lines });
        }
        if nodes.is_empty() {
            return Ok(());
        }
        nodes.sort_unstable();
        nodes.dedup();
        self.publish_nodes(name, at, nodes)
    }

    /// Data lines of a block, with their positions.
    fn lines(&self, block: &Block) -> Vec<(usize, String)> {
        let mut source = self.source.from(block.start);
        let mut lines = Vec::new();
        loop {
            let at = source.position();
            match source.line() {
                Some(line) if line.is_empty() || line.starts_with(b"**") => {}
                Some(line) if !line.starts_with(b"*") => lines.push((at, decode(line))),
                _ => return lines,
            }
        }
    }

    /// Members of a set of nodes or elements, sorted.
    fn members(&mut self, set: usize, depth: usize) -> Result<Vec<u64>, ReadError> {
        let at = self.sets.sets[set].at;
        match &self.states[set] {
            State::Done(members) => return members.clone(),
            State::Open => {
                let set = self.sets.name_of(set);
                return self.error(at, Problem::Circular { set });
            }
            State::Waiting if depth > DEEPEST => {
                let set = self.sets.name_of(set);
                return self.error(at, Problem::Circular { set });
            }
            State::Waiting => {}
        }
        self.states[set] = State::Open;
        let members = self.collect(set, depth);
        self.states[set] = State::Done(members.clone());
        members
    }

    fn collect(&mut self, set: usize, depth: usize) -> Result<Vec<u64>, ReadError> {
        let sets: &'r Sets = self.sets;
        let Set { of, labels, blocks, .. } = &sets.sets[set];
        let mut members = labels.clone();
        for block in blocks {
            self.check_instance(block)?;
            match &block.form {
                Form::Refused(problem) => return self.error(block.at, problem.clone()),
                Form::NodesOf(elements) => {
                    let elements = self.named(Of::Elements, block, block.at, elements, depth)?;
                    let nodes = self.raw.nodes_of_elements(&elements);
                    self.raw.take_room(self.source, block.at, nodes.len())?;
                    members.extend(nodes);
                }
                Form::Members { generate: true } => {
                    for (at, line) in self.lines(block) {
                        members.extend(self.range(block, *of, at, &words(&line))?);
                    }
                }
                form => {
                    let only_first = matches!(form, Form::Faces);
                    for (at, line) in self.lines(block) {
                        let words = words(&line);
                        let words = if only_first { &words[..1] } else { &words[..] };
                        for word in words.iter().filter(|word| !word.is_empty()) {
                            let found = self.member(set, block, at, word, depth)?;
                            self.raw.take_room(self.source, at, found.len())?;
                            members.extend(found);
                        }
                    }
                }
            }
        }
        members.sort_unstable();
        members.dedup();
        Ok(members)
    }

    fn check_instance(&self, block: &Block) -> Result<(), ReadError> {
        match (&block.instance, &self.sets.instance) {
            (Some(asked), Some((known, _))) if asked == known => Ok(()),
            (Some(asked), _) => {
                self.error(block.at, Problem::UnknownSet { name: excerpt(asked.as_bytes()) })
            }
            (None, _) => Ok(()),
        }
    }

    /// Members that a label, `instance.label` or name of a set stands for.
    fn member(
        &mut self,
        set: usize,
        block: &Block,
        at: usize,
        word: &str,
        depth: usize,
    ) -> Result<Vec<u64>, ReadError> {
        let of = match self.sets.sets[set].of {
            Of::Elements | Of::Surface => Of::Elements,
            Of::Nodes | Of::NodeSurface => Of::Nodes,
        };
        let key = key(word);
        let inside = self.sets.within_instance(&key).and_then(|label| label.parse().ok());
        let tag: u64 = match (word.parse(), inside) {
            (Ok(tag), _) if self.is_of_mesh(of, block) => tag,
            (Err(_), Some(tag)) => tag,
            (Ok(tag), _) => {
                self.miss(set, tag, at);
                return Ok(Vec::new());
            }
            (Err(_), None) if self.sets.find(of, block, word) == Some(set) => {
                return Ok(Vec::new());
            }
            (Err(_), None) => return self.named(of, block, at, word, depth),
        };
        match self.raw.has(of == Of::Elements, tag) {
            true => Ok(vec![tag]),
            false => {
                self.miss(set, tag, at);
                Ok(Vec::new())
            }
        }
    }

    /// Notes a member that is not in the mesh; elements that were skipped have a note of their own.
    fn miss(&mut self, set: usize, tag: u64, at: usize) {
        if !self.raw.skipped_elements.contains(&tag) || self.sets.sets[set].of < Of::Elements {
            self.missing.entry(set).or_insert((0, tag, at)).0 += 1;
        }
    }

    /// Whether plain labels of a block are those of the mesh.
    fn is_of_mesh(&self, of: Of, block: &Block) -> bool {
        let own = if of < Of::Elements { self.sets.own_nodes } else { self.sets.own_elements };
        block.scope == Scope::Part || block.instance.is_some() || !own
    }

    fn named(
        &mut self,
        of: Of,
        block: &Block,
        at: usize,
        word: &str,
        depth: usize,
    ) -> Result<Vec<u64>, ReadError> {
        match self.sets.find(of, block, word) {
            Some(other) => self.members(other, depth + 1),
            None => {
                let name = excerpt(unquoted(word).as_bytes());
                self.error(at, Problem::UnknownSet { name })
            }
        }
    }

    /// Members of the mesh among first, last and step.
    fn range(
        &mut self,
        block: &Block,
        of: Of,
        at: usize,
        words: &[&str],
    ) -> Result<Vec<u64>, ReadError> {
        let mut bounds = [0, 0, 1];
        for (bound, word) in bounds.iter_mut().zip(words).filter(|(_, word)| !word.is_empty()) {
            *bound = label(self.source, at, word, "a number of GENERATE")?;
        }
        let [first, last, step] = bounds;
        if step == 0 || last < first {
            let found = format!("{first}, {last}, {step}");
            let what = "a range: first, last and step";
            return self.error(at, Problem::Number { found, what });
        }
        if !self.is_of_mesh(of, block) {
            return Ok(Vec::new());
        }
        let elements = of == Of::Elements;
        let most = self.raw.count(elements).min(((last - first) / step).saturating_add(1));
        self.raw.take_room(self.source, at, most as usize)?;
        Ok(self.raw.tags_in(elements, [first, last, step]))
    }

    /// Faces of a surface: `set or element, S1`; without a side, all free sides.
    fn faces(&mut self, set: usize) -> Result<Vec<RawFace>, ReadError> {
        let sets: &'r Sets = self.sets;
        let mut faces = Vec::new();
        for block in &sets.sets[set].blocks {
            if let Form::Refused(problem) = &block.form {
                return self.error(block.at, problem.clone());
            }
            for (at, line) in self.lines(block) {
                let words = words(&line);
                let elements = self.member(set, block, at, words[0], 0)?;
                self.raw.take_room(self.source, at, elements.len())?;
                let side = words.get(1).map(|side| side.to_ascii_uppercase()).unwrap_or_default();
                for element in elements {
                    let face = match (self.raw.numbered.get(&element), side.as_str()) {
                        (Some(Numbered::Triangle(corners)), _) => RawFace::Corners(*corners),
                        (Some(Numbered::Line(_)), _) => continue,
                        (None, "") => RawFace::Free { element },
                        (None, "S1") => RawFace::Side { element, side: 0 },
                        (None, "S2") => RawFace::Side { element, side: 1 },
                        (None, "S3") => RawFace::Side { element, side: 2 },
                        (None, "S4") => RawFace::Side { element, side: 3 },
                        (None, other) => {
                            let found = excerpt(other.as_bytes());
                            let what = "a side S1 to S4 of a tetrahedron";
                            return self.error(at, Problem::Number { found, what });
                        }
                    };
                    faces.push(face);
                }
            }
        }
        Ok(faces)
    }
}
