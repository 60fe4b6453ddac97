//! Reader of `.inp` files (Abaqus, CalculiX): nodes, C3D4 and C3D10 elements, node and element sets, surfaces.
//!
//! Keywords that do not describe the mesh are skipped and reported. One part with one instance that is not moved
//! is read; more than one is refused, because their numbers overlap.

use crate::mesh::read::abaqus_lines::{Keyword, extend_set, keyword, member_count, number};
use crate::mesh::read::assemble::{Numbered, RawFace, RawMesh};
use crate::mesh::read::error::{Problem, ReadError};
use crate::mesh::read::source::{Source, excerpt};
use crate::mesh::read::{DeckMaterial, LengthUnit, Loaded};

/// Kind of the data lines of the current keyword.
enum Block {
    Nothing,
    Nodes {
        set: Option<String>,
    },
    Elements {
        kind: Kind,
        set: Option<String>,
        pending: Vec<u64>,
        from: usize,
    },
    NodeSet {
        name: String,
        generate: bool,
    },
    ElementSet {
        name: String,
        generate: bool,
    },
    Surface {
        name: String,
    },
    Instance,
    /// The first line of a material's constants.
    Constants(Constants),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Constants {
    Elastic,
    Density,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Tet(usize),
    Triangle(usize),
    Line(usize),
}

impl Kind {
    fn node_count(self) -> usize {
        match self {
            Kind::Tet(count) | Kind::Triangle(count) | Kind::Line(count) => count,
        }
    }
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
    let mut deck = Deck { raw: RawMesh::new(bytes.len()), parts: 0, instances: 0 };
    let mut block = Block::Nothing;
    let mut first = true;
    loop {
        let at = source.position();
        let Some(line) = source.line() else { break };
        if line.is_empty() || line.starts_with(b"**") {
            continue;
        }
        if first && !line.starts_with(b"*") {
            let found = excerpt(line);
            return Err(
                source.error_at(at, Problem::OtherFormat { expected: "Abaqus .inp", found })
            );
        }
        first = false;
        if line.starts_with(b"*") {
            finish(&source, &block)?;
            let keyword = keyword(&mut source, line, at);
            block = deck.open(&source, &keyword)?;
        } else {
            deck.data(&source, at, line, &mut block)?;
        }
    }
    finish(&source, &block)?;
    deck.raw.finish(&source, unit)
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
    parts: usize,
    instances: usize,
}

impl Deck {
    fn open(&mut self, source: &Source, keyword: &Keyword) -> Result<Block, ReadError> {
        let refuse = |what: String, hint| {
            Err(source.error_at(keyword.at, Problem::Unsupported { what, hint }))
        };
        let name = |key| keyword.required(source, key).map(str::to_string);
        match keyword.name.as_str() {
            "NODE" => match keyword.parameter("SYSTEM").unwrap_or("R") {
                "R" | "r" => {
                    Ok(Block::Nodes { set: keyword.parameter("NSET").map(str::to_string) })
                }
                other => refuse(format!("the coordinate system {other}"), "write Cartesian nodes"),
            },
            "ELEMENT" => {
                let kind = kind(source, keyword.at, keyword.required(source, "TYPE")?)?;
                let set = keyword.parameter("ELSET").map(str::to_string);
                Ok(Block::Elements { kind, set, pending: Vec::new(), from: keyword.at })
            }
            "NSET" => {
                let generate = keyword.parameter("GENERATE").is_some();
                let name = name("NSET")?;
                self.raw.node_sets.entry(name.clone()).or_default();
                Ok(Block::NodeSet { name, generate })
            }
            "ELSET" => {
                let generate = keyword.parameter("GENERATE").is_some();
                let name = name("ELSET")?;
                self.raw.element_sets.entry(name.clone()).or_default();
                Ok(Block::ElementSet { name, generate })
            }
            "SURFACE" => {
                match keyword.parameter("TYPE").unwrap_or("ELEMENT").to_ascii_uppercase().as_str() {
                    "ELEMENT" => Ok(Block::Surface { name: name("NAME")? }),
                    other => {
                        let hint = "define it by elements and their sides";
                        refuse(format!("a surface of type {other}"), hint)
                    }
                }
            }
            "PART" | "INSTANCE" => {
                let is_part = keyword.name == "PART";
                let count = if is_part { &mut self.parts } else { &mut self.instances };
                *count += 1;
                if *count > 1 {
                    let hint = "flatten the model or write one part to a file";
                    return refuse(format!("a second *{}", keyword.name), hint);
                }
                Ok(if is_part { Block::Nothing } else { Block::Instance })
            }
            "INCLUDE" => refuse("*INCLUDE".into(), "join the files into one"),
            "SYSTEM" | "NGEN" | "NCOPY" | "ELGEN" | "ELCOPY" | "NFILL" => {
                refuse(format!("*{}", keyword.name), "write all nodes and elements explicitly")
            }
            "HEADING" | "END PART" | "END INSTANCE" | "ASSEMBLY" | "END ASSEMBLY" => {
                Ok(Block::Nothing)
            }
            other => {
                self.raw.ignore(format!("*{}", excerpt(other.as_bytes())));
                Ok(self.material(other, keyword))
            }
        }
    }

    /// Records a material. The mesh does not use it; a note compares it with the material of the scene.
    fn material(&mut self, keyword: &str, of: &Keyword) -> Block {
        let isotropic = of.parameter("TYPE").is_none_or(|kind| {
            ["ISO", "ISOTROPIC"].iter().any(|name| kind.eq_ignore_ascii_case(name))
        });
        match keyword {
            "MATERIAL" => {
                let name = of.parameter("NAME").unwrap_or_default().to_string();
                self.raw.materials.push(DeckMaterial { name, ..DeckMaterial::default() });
                Block::Nothing
            }
            "ELASTIC" if isotropic => Block::Constants(Constants::Elastic),
            "DENSITY" => Block::Constants(Constants::Density),
            _ => Block::Nothing,
        }
    }

    /// Records constants of a material; those that are not numbers or belong to no material are ignored.
    fn constants(&mut self, words: &[&str], kind: Constants) {
        let number = |index: usize| {
            let value: Option<f64> = words.get(index).and_then(|word| word.parse().ok());
            value.filter(|value| value.is_finite())
        };
        let Some(material) = self.raw.materials.last_mut() else { return };
        match (kind, number(0), number(1)) {
            (Constants::Elastic, Some(young), Some(poisson)) => {
                material.elastic = Some([young, poisson]);
            }
            (Constants::Density, Some(density), _) => material.density = Some(density),
            _ => {}
        }
    }

    fn data(
        &mut self,
        source: &Source,
        at: usize,
        line: &[u8],
        block: &mut Block,
    ) -> Result<(), ReadError> {
        let text = String::from_utf8_lossy(line);
        let words: Vec<&str> = text.split(',').map(str::trim).collect();
        // A comma may end a line.
        let words = match words.split_last() {
            Some((&"", before)) => before,
            _ => &words[..],
        };
        match block {
            Block::Nothing => Ok(()),
            Block::Constants(kind) => {
                self.constants(words, *kind);
                // Further lines are for other temperatures.
                *block = Block::Nothing;
                Ok(())
            }
            Block::Nodes { set } => self.node(source, at, words, set.as_deref()),
            Block::Elements { kind, set, pending, from } => {
                if pending.is_empty() {
                    *from = at;
                }
                for word in words {
                    pending.push(number(source, at, word, "the number of a node")?);
                }
                let wanted = kind.node_count() + 1;
                if pending.len() > wanted {
                    let expected = format!("{wanted} numbers per element");
                    let found = pending.len().to_string();
                    return Err(source.error_at(at, Problem::Expected { expected, found }));
                }
                if pending.len() == wanted {
                    self.element(source, *from, *kind, pending, set.as_deref())?;
                    pending.clear();
                }
                Ok(())
            }
            Block::NodeSet { name, generate } => {
                let count = member_count(source, at, words, *generate, &self.raw.node_sets)?;
                self.raw.take_room(source, at, count)?;
                extend_set(words, *generate, name, &mut self.raw.node_sets);
                Ok(())
            }
            Block::ElementSet { name, generate } => {
                let count = member_count(source, at, words, *generate, &self.raw.element_sets)?;
                self.raw.take_room(source, at, count)?;
                extend_set(words, *generate, name, &mut self.raw.element_sets);
                Ok(())
            }
            Block::Surface { name } => self.surface(source, at, words, name),
            Block::Instance => {
                let what = "a moved instance".to_string();
                let hint = "write the part at its final position";
                Err(source.error_at(at, Problem::Unsupported { what, hint }))
            }
        }
    }

    fn node(
        &mut self,
        source: &Source,
        at: usize,
        words: &[&str],
        set: Option<&str>,
    ) -> Result<(), ReadError> {
        if words.len() < 4 {
            let what = "a node: its number and three coordinates".to_string();
            return Err(source.error_at(at, Problem::Truncated { what }));
        }
        let tag = number(source, at, words[0], "the number of a node")?;
        let mut place = [0.0; 3];
        for (x, word) in place.iter_mut().zip(&words[1..]) {
            *x = number(source, at, word, "a coordinate")?;
            if !f64::is_finite(*x) {
                let problem = Problem::Number { found: word.to_string(), what: "a coordinate" };
                return Err(source.error_at(at, problem));
            }
        }
        self.raw.add_node(source, at, tag, place)?;
        if let Some(set) = set {
            self.raw.node_sets.entry(set.to_string()).or_default().push(tag);
        }
        Ok(())
    }

    fn element(
        &mut self,
        source: &Source,
        at: usize,
        kind: Kind,
        numbers: &[u64],
        set: Option<&str>,
    ) -> Result<(), ReadError> {
        let (tag, nodes) = (numbers[0], &numbers[1..]);
        match kind {
            Kind::Tet(_) => self.raw.add_tet(source, at, tag, nodes)?,
            Kind::Triangle(_) => {
                let corners = [nodes[0], nodes[1], nodes[2]];
                self.raw.add_numbered(source, at, tag, Numbered::Triangle(corners))?;
            }
            Kind::Line(_) => {
                self.raw.add_numbered(source, at, tag, Numbered::Line(nodes.to_vec()))?;
            }
        }
        if let Some(set) = set {
            self.raw.element_sets.entry(set.to_string()).or_default().push(tag);
        }
        Ok(())
    }

    /// Reads `set or element, S1`; without a side, all free sides.
    fn surface(
        &mut self,
        source: &Source,
        at: usize,
        words: &[&str],
        name: &str,
    ) -> Result<(), ReadError> {
        let elements = match words[0].parse::<u64>() {
            Ok(tag) => vec![tag],
            Err(_) => match self.raw.element_sets.get(words[0]).cloned() {
                Some(tags) => {
                    self.raw.take_room(source, at, tags.len())?;
                    tags
                }
                None => {
                    let problem = Problem::UnknownSet { name: words[0].to_string() };
                    return Err(source.error_at(at, problem));
                }
            },
        };
        let side = match words.get(1).map(|side| side.to_ascii_uppercase()).as_deref() {
            None | Some("") => None,
            Some("S1") => Some(0),
            Some("S2") => Some(1),
            Some("S3") => Some(2),
            Some("S4") => Some(3),
            Some(other) => {
                let problem = Problem::Number { found: other.to_string(), what: "a side S1 to S4" };
                return Err(source.error_at(at, problem));
            }
        };
        let faces = elements.into_iter().map(|element| match side {
            Some(side) => RawFace::Side { element, side },
            None => RawFace::Free { element },
        });
        self.raw.surface_sets.entry(name.to_string()).or_default().extend(faces);
        Ok(())
    }
}

fn kind(source: &Source, at: usize, name: &str) -> Result<Kind, ReadError> {
    match name.to_ascii_uppercase().as_str() {
        "C3D4" => Ok(Kind::Tet(4)),
        "C3D10" => Ok(Kind::Tet(10)),
        "S3" | "CPS3" | "CPE3" | "STRI3" | "M3D3" | "SFM3D3" => Ok(Kind::Triangle(3)),
        "S6" | "CPS6" | "CPE6" | "STRI65" | "M3D6" | "SFM3D6" => Ok(Kind::Triangle(6)),
        "T3D2" | "B31" => Ok(Kind::Line(2)),
        "T3D3" | "B32" => Ok(Kind::Line(3)),
        other => {
            let found = excerpt(other.as_bytes());
            Err(source.error_at(at, Problem::ElementType { found }))
        }
    }
}
