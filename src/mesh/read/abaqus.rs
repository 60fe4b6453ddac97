//! Reader of `.inp` files (Abaqus, CalculiX): nodes, tetrahedra, node and element sets, surfaces, materials.
//!
//! Keywords and elements that do not describe the mesh are skipped and reported. One part with one instance that is
//! not moved is read; more than one is refused, because their numbers overlap. The set of a part has the name
//! `instance.set`. Labels are equal if they differ in case alone.

use crate::mesh::read::abaqus_elements::{Kind, kind};
use crate::mesh::read::abaqus_lines::{
    Keyword, coordinate, key, keyword, label, real, unquoted, words,
};
use crate::mesh::read::abaqus_members::resolve;
use crate::mesh::read::abaqus_sets::{Block as SetBlock, Form, Of, Scope, Sets};
use crate::mesh::read::assemble::{Numbered, RawMesh};
use crate::mesh::read::error::{Problem, ReadError};
use crate::mesh::read::source::{Source, decode, excerpt};
use crate::mesh::read::{DeckMaterial, LengthUnit, Loaded};

/// Kind of the data lines of the current keyword.
enum Block {
    /// Lines that are skipped, or read when all sets are known.
    Later,
    Nodes {
        set: Option<usize>,
    },
    Elements {
        kind: Kind,
        set: Option<usize>,
        pending: Vec<u64>,
        from: usize,
    },
    /// Elements that are skipped; whether the next line continues one.
    Skipped {
        continued: bool,
    },
    Instance,
    /// The first line of a material's constants, and its keyword.
    Constants(Constants, String),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Constants {
    Elastic,
    Density,
}

/// Reads an input deck.
///
/// # Errors
/// [`ReadError`] with the line of the error.
pub fn read_abaqus(bytes: &[u8], unit: LengthUnit) -> Result<Loaded, ReadError> {
    let mut source = Source::new(bytes);
    if bytes.trim_ascii().is_empty() {
        return Err(source.error(Problem::Empty));
    }
    let mut deck = Deck {
        raw: RawMesh::new(bytes.len(), true),
        sets: Sets::default(),
        scope: Scope::Model,
        in_assembly: false,
        parts: 0,
        instances: 0,
    };
    let mut block = Block::Later;
    let mut first = true;
    loop {
        let at = source.position();
        let Some(line) = source.line() else { break };
        if line.is_empty() || line.starts_with(b"**") {
            continue;
        }
        if first && !line.starts_with(b"*") {
            let expected = "an Abaqus or CalculiX .inp";
            let found = excerpt(line);
            return Err(source.error_at(at, Problem::OtherFormat { expected, found }));
        }
        first = false;
        if line.starts_with(b"*") {
            finish(&source, &block)?;
            let keyword = keyword(&mut source, line, at);
            block = deck.open(&source, &keyword)?;
        } else if !matches!(block, Block::Later) {
            deck.data(&source, at, line, &mut block)?;
        }
    }
    finish(&source, &block)?;
    let Deck { mut raw, sets, .. } = deck;
    resolve(&sets, &mut raw, &source)?;
    raw.finish(&source, unit)
}

/// Refuses an element whose list of nodes is incomplete at the end of its block.
fn finish(source: &Source, block: &Block) -> Result<(), ReadError> {
    match block {
        Block::Elements { pending, from, .. } if !pending.is_empty() => {
            let what = format!("the nodes of element {}", pending[0]);
            Err(source.error_at(*from, Problem::Truncated { what }))
        }
        _ => Ok(()),
    }
}

struct Deck {
    raw: RawMesh,
    sets: Sets,
    scope: Scope,
    /// Within the assembly of a deck with parts: nodes and elements are none of a part's.
    in_assembly: bool,
    parts: usize,
    instances: usize,
}

impl Deck {
    fn open(&mut self, source: &Source, keyword: &Keyword) -> Result<Block, ReadError> {
        let refuse = |what: String, hint| {
            Err(source.error_at(keyword.at, Problem::Unsupported { what, hint }))
        };
        let name = keyword.name.as_str();
        if matches!(name, "NODE" | "ELEMENT") && keyword.word("INPUT").is_some() {
            return refuse(format!("*{name}, INPUT"), "join the files into one");
        }
        match name {
            "NODE" => match keyword.choice("SYSTEM").as_deref().unwrap_or("R") {
                "R" => {
                    self.sets.own_nodes |= self.is_reference();
                    Ok(Block::Nodes { set: self.set_of(Of::Nodes, keyword, "NSET") })
                }
                other => refuse(format!("the coordinate system {other}"), "write Cartesian nodes"),
            },
            "ELEMENT" => self.elements(source, keyword),
            "NSET" => {
                let form = match keyword.word("ELSET") {
                    Some(elements) => Form::NodesOf(elements.to_string()),
                    None => Form::Members { generate: keyword.word("GENERATE").is_some() },
                };
                self.set(source, keyword, Of::Nodes, "NSET", form)
            }
            "ELSET" => {
                let form = Form::Members { generate: keyword.word("GENERATE").is_some() };
                self.set(source, keyword, Of::Elements, "ELSET", form)
            }
            "SURFACE" => {
                let kind = keyword.choice("TYPE").unwrap_or_else(|| "ELEMENT".into());
                let combined = keyword.word("COMBINE").map(|_| "combined surface".to_string());
                let hint = "define it by elements and their sides";
                match (kind.as_str(), combined) {
                    ("ELEMENT", None) => {
                        self.set(source, keyword, Of::Surface, "NAME", Form::Faces)
                    }
                    ("NODE", None) => {
                        self.set(source, keyword, Of::NodeSurface, "NAME", Form::Faces)
                    }
                    (other, combined) => {
                        let what = combined.unwrap_or_else(|| format!("surface of type {other}"));
                        let form = Form::Refused(Problem::Unsupported { what, hint });
                        self.set(source, keyword, Of::Surface, "NAME", form)
                    }
                }
            }
            "PART" | "INSTANCE" => {
                let count = if name == "PART" { &mut self.parts } else { &mut self.instances };
                *count += 1;
                if *count > 1 {
                    let hint = "flatten the model or write one part to a file";
                    return refuse(format!("a second *{name}"), hint);
                }
                self.scope = Scope::Part;
                if name == "PART" {
                    return Ok(Block::Later);
                }
                let label = keyword.word("NAME").unwrap_or_default();
                self.sets.instance = Some((key(label), unquoted(label)));
                Ok(Block::Instance)
            }
            "END PART" | "END INSTANCE" | "ASSEMBLY" | "END ASSEMBLY" => {
                self.scope = Scope::Model;
                match name {
                    "ASSEMBLY" => self.in_assembly = true,
                    "END ASSEMBLY" => self.in_assembly = false,
                    _ => {}
                }
                Ok(Block::Later)
            }
            "INCLUDE" => refuse("*INCLUDE".into(), "join the files into one"),
            "SYSTEM" | "NGEN" | "NCOPY" | "ELGEN" | "ELCOPY" | "NFILL" => {
                refuse(format!("*{name}"), "write all nodes and elements explicitly")
            }
            "HEADING" => Ok(Block::Later),
            other => {
                self.raw.ignore(format!("*{}", excerpt(other.as_bytes())));
                Ok(self.material(other, keyword))
            }
        }
    }

    /// Whether nodes and elements are the assembly's own.
    fn is_reference(&self) -> bool {
        self.in_assembly && self.scope == Scope::Model && self.parts + self.instances > 0
    }

    fn set_of(&mut self, of: Of, keyword: &Keyword, name: &str) -> Option<usize> {
        let label = keyword.word(name).filter(|label| !label.is_empty())?;
        Some(self.sets.named(of, self.scope, label, keyword.at))
    }

    /// Adds the data lines of a keyword to a set.
    fn set(
        &mut self,
        source: &Source,
        keyword: &Keyword,
        of: Of,
        name: &'static str,
        form: Form,
    ) -> Result<Block, ReadError> {
        let label = keyword.required(source, name)?;
        let set = self.sets.named(of, self.scope, label, keyword.at);
        let (at, start, scope) = (keyword.at, source.position(), self.scope);
        let instance = keyword.word("INSTANCE").map(key);
        self.sets.add_block(set, SetBlock { at, start, scope, instance, form });
        Ok(Block::Later)
    }

    fn elements(&mut self, source: &Source, keyword: &Keyword) -> Result<Block, ReadError> {
        let kind = kind(source, keyword, &mut self.raw)?;
        let set = self.set_of(Of::Elements, keyword, "ELSET");
        let reference = self.is_reference();
        self.sets.own_elements |= reference;
        match kind {
            Kind::Tet(_) if reference => {
                let what = "a body within *ASSEMBLY".to_string();
                let hint = "write its elements into the part";
                Err(source.error_at(keyword.at, Problem::Unsupported { what, hint }))
            }
            Kind::Other => Ok(Block::Skipped { continued: false }),
            _ if reference => Ok(Block::Later),
            kind => Ok(Block::Elements { kind, set, pending: Vec::new(), from: keyword.at }),
        }
    }

    /// Records a material. The mesh does not use it; the scene's material is compared with it.
    fn material(&mut self, name: &str, keyword: &Keyword) -> Block {
        let isotropic = keyword.choice("TYPE").is_none_or(|kind| kind.starts_with("ISO"));
        match name {
            "MATERIAL" => {
                let name = unquoted(keyword.word("NAME").unwrap_or_default());
                self.raw.materials.push(DeckMaterial { name, ..DeckMaterial::default() });
            }
            "ELASTIC" if isotropic => {
                return Block::Constants(Constants::Elastic, keyword.text());
            }
            "DENSITY" => return Block::Constants(Constants::Density, keyword.text()),
            other if STIFFNESS.iter().any(|word| other.contains(word)) => {
                self.unread(keyword.text());
            }
            _ => {}
        }
        Block::Later
    }

    fn unread(&mut self, keyword: String) {
        if let Some(material) = self.raw.materials.last_mut() {
            material.unread.get_or_insert(keyword);
        }
    }

    /// Records constants of a material; those that belong to no material are ignored.
    fn constants(&mut self, words: &[&str], kind: Constants, keyword: String) {
        let number = |index: usize| real(words.get(index).copied().unwrap_or_default());
        let Some(material) = self.raw.materials.last_mut() else { return };
        match (kind, number(0), number(1)) {
            (Constants::Elastic, Some(young), Some(poisson)) => {
                material.elastic = Some([young, poisson]);
            }
            (Constants::Density, Some(density), _) => material.density = Some(density),
            _ => self.unread(keyword),
        }
    }

    fn data(
        &mut self,
        source: &Source,
        at: usize,
        line: &[u8],
        block: &mut Block,
    ) -> Result<(), ReadError> {
        let text = decode(line);
        let words = words(&text);
        match block {
            Block::Later => Ok(()),
            Block::Constants(kind, keyword) => {
                self.constants(&words, *kind, std::mem::take(keyword));
                // Further lines are for other temperatures.
                *block = Block::Later;
                Ok(())
            }
            // Reference nodes are no part of the mesh.
            Block::Nodes { .. } if self.is_reference() => {
                self.raw.ignore("a node of *ASSEMBLY".into());
                Ok(())
            }
            Block::Nodes { set } => {
                let tag = label(source, at, words[0], "the number of a node")?;
                let mut place = [0.0; 3];
                // Coordinates that are left out are zero.
                for (x, word) in place.iter_mut().zip(&words[1..]) {
                    *x = coordinate(source, at, word)?;
                }
                self.raw.add_node(source, at, tag, place)?;
                set.iter().for_each(|set| self.sets.add_label(*set, tag));
                Ok(())
            }
            Block::Elements { kind, set, pending, from } => {
                if pending.is_empty() {
                    *from = at;
                }
                for word in words {
                    pending.push(label(source, at, word, "the number of a node")?);
                }
                let wanted = kind.node_count() + 1;
                if pending.len() > wanted {
                    let expected = format!("{wanted} numbers per element");
                    let found = pending.len().to_string();
                    return Err(source.error_at(at, Problem::Expected { expected, found }));
                }
                if pending.len() == wanted {
                    self.element(source, *from, *kind, pending)?;
                    set.iter().for_each(|set| self.sets.add_label(*set, pending[0]));
                    pending.clear();
                }
                Ok(())
            }
            Block::Skipped { continued } => {
                if let (false, Ok(tag)) = (*continued || self.is_reference(), words[0].parse()) {
                    self.raw.skipped_elements.insert(tag);
                }
                *continued = line.ends_with(b",");
                Ok(())
            }
            // No translation, or a rotation by no angle, the last number.
            Block::Instance
                if words.iter().all(|word| real(word) == Some(0.0))
                    || words.get(6).and_then(|angle| real(angle)) == Some(0.0) =>
            {
                Ok(())
            }
            Block::Instance => {
                let what = "a moved instance".to_string();
                let hint = "write the part at its final position";
                Err(source.error_at(at, Problem::Unsupported { what, hint }))
            }
        }
    }

    fn element(
        &mut self,
        source: &Source,
        at: usize,
        kind: Kind,
        numbers: &[u64],
    ) -> Result<(), ReadError> {
        let (tag, nodes) = (numbers[0], &numbers[1..]);
        match kind {
            Kind::Triangle(_) => {
                let corners = [nodes[0], nodes[1], nodes[2]];
                self.raw.add_numbered(source, at, tag, Numbered::Triangle(corners))
            }
            Kind::Line(_) => self.raw.add_numbered(source, at, tag, Numbered::Line(nodes.to_vec())),
            _ => self.raw.add_tet(source, at, tag, nodes),
        }
    }
}

/// Words in keywords of laws that determine the stiffness of a material.
const STIFFNESS: [&str; 5] = ["ELASTIC", "PLASTICITY", "FOAM", "USER MATERIAL", "FABRIC"];
