//! Conversion from the file's numbers to a mesh: tags become indices, triangles become faces.

use crate::mesh::read::error::{Problem, ReadError};
use crate::mesh::read::source::Source;
use crate::mesh::read::{
    DeckMaterial, FileNumbers, LengthUnit, Loaded, Note, SetKind, Unusable, size_note,
};
use crate::mesh::tet_mesh::{Elements, Face, TetMesh};
use crate::mesh::topology::sorted_faces;
use std::collections::{BTreeMap, HashMap, HashSet};

/// An element with the file's numbers, in this program's node order.
struct RawTet {
    tag: u64,
    nodes: [u64; 10],
    at: usize,
}

/// A member of a named surface.
#[derive(Clone, Copy)]
pub enum RawFace {
    /// Three corner nodes of a triangle in the file.
    Corners([u64; 3]),
    /// A side (0…3) of an element.
    Side { element: u64, side: u8 },
    /// All boundary sides of an element.
    Free { element: u64 },
}

/// Members of a named surface, and its position in the file.
pub struct RawSurface {
    pub at: usize,
    pub faces: Vec<RawFace>,
    /// Nodes of its lines.
    pub lines: Vec<u64>,
}

/// A numbered element that is not a tetrahedron.
pub enum Numbered {
    Triangle([u64; 3]),
    Line(Vec<u64>),
}

/// Content of a file, collected while it is read.
pub struct RawMesh {
    /// Whether the file is an input deck, where a node set and a surface are two things.
    deck: bool,
    /// Remaining number of set members: sets that contain sets could grow without limit.
    room: usize,
    nodes: Vec<[f64; 3]>,
    node_index: HashMap<u64, u32>,
    tets: Vec<RawTet>,
    tet_index: HashMap<u64, u32>,
    nodes_per_element: usize,
    pub node_sets: BTreeMap<String, Vec<u64>>,
    pub element_sets: BTreeMap<String, Vec<u64>>,
    pub surface_sets: BTreeMap<String, RawSurface>,
    pub numbered: HashMap<u64, Numbered>,
    /// Elements of a deck that do not describe the mesh.
    pub skipped_elements: HashSet<u64>,
    ignored: BTreeMap<String, usize>,
    unusable: Vec<Unusable>,
    pub notes: Vec<Note>,
    /// Materials in the units of the file.
    pub materials: Vec<DeckMaterial>,
}

impl RawMesh {
    /// An empty mesh of a file of this many bytes. A member of a set takes eight bytes in memory and
    /// at least two in the file, unless ranges and groups repeat it. The number of members is limited to a few
    /// repetitions of the whole file.
    pub fn new(file_length: usize, deck: bool) -> RawMesh {
        const REPETITIONS: usize = 4;
        const ANY_FILE: usize = 10_000;
        RawMesh {
            deck,
            room: file_length.saturating_mul(REPETITIONS).saturating_add(ANY_FILE),
            nodes: Vec::new(),
            node_index: HashMap::new(),
            tets: Vec::new(),
            tet_index: HashMap::new(),
            nodes_per_element: 0,
            node_sets: BTreeMap::new(),
            element_sets: BTreeMap::new(),
            surface_sets: BTreeMap::new(),
            numbered: HashMap::new(),
            skipped_elements: HashSet::new(),
            ignored: BTreeMap::new(),
            unusable: Vec::new(),
            notes: Vec::new(),
            materials: Vec::new(),
        }
    }

    /// Reserves `count` more members of sets before they are stored.
    pub fn take_room(&mut self, source: &Source, at: usize, count: usize) -> Result<(), ReadError> {
        match self.room.checked_sub(count) {
            Some(room) => {
                self.room = room;
                Ok(())
            }
            None => {
                let problem = Problem::TooManyMembers { length: source.length() };
                Err(source.error_at(at, problem))
            }
        }
    }

    pub fn ignore(&mut self, what: String) {
        *self.ignored.entry(what).or_default() += 1;
    }

    /// Adds a numbered triangle or line, which element sets may contain like a tetrahedron.
    pub fn add_numbered(
        &mut self,
        source: &Source,
        at: usize,
        tag: u64,
        other: Numbered,
    ) -> Result<(), ReadError> {
        if self.numbered.insert(tag, other).is_some() {
            return Err(source.error_at(at, Problem::Duplicate { kind: "element", tag }));
        }
        Ok(())
    }

    /// Records a set that cannot be used.
    pub fn skip_set(&mut self, name: &str, kind: SetKind, error: ReadError) {
        let new = |last: &Unusable| last.name != name || last.kind != kind;
        if self.unusable.last().is_none_or(new) {
            self.unusable.push(Unusable { name: name.to_string(), kind, error });
        }
    }

    /// Number of nodes, or of elements.
    pub fn count(&self, elements: bool) -> u64 {
        let of_elements = self.tet_index.len() + self.numbered.len();
        (if elements { of_elements } else { self.node_index.len() }) as u64
    }

    /// Whether the file has this node, or this element.
    pub fn has(&self, element: bool, tag: u64) -> bool {
        match element {
            true => self.tet_index.contains_key(&tag) || self.numbered.contains_key(&tag),
            false => self.node_index.contains_key(&tag),
        }
    }

    /// Nodes, or elements, of the file among first, last and step.
    pub fn tags_in(&self, elements: bool, [first, last, step]: [u64; 3]) -> Vec<u64> {
        if (last - first) / step <= self.count(elements) {
            let range = (first..=last).step_by(usize::try_from(step).unwrap_or(usize::MAX));
            return range.filter(|&tag| self.has(elements, tag)).collect();
        }
        let inside = |tag: &u64| (first..=last).contains(tag) && (tag - first).is_multiple_of(step);
        match elements {
            true => {
                self.tet_index.keys().chain(self.numbered.keys()).copied().filter(inside).collect()
            }
            false => self.node_index.keys().copied().filter(inside).collect(),
        }
    }

    /// Nodes of elements, with repetitions.
    pub fn nodes_of_elements(&self, elements: &[u64]) -> Vec<u64> {
        let mut nodes = Vec::new();
        for tag in elements {
            match (self.tet_index.get(tag), self.numbered.get(tag)) {
                (Some(tet), _) => {
                    nodes.extend(&self.tets[*tet as usize].nodes[..self.nodes_per_element]);
                }
                (None, Some(Numbered::Triangle(of))) => nodes.extend(of),
                (None, Some(Numbered::Line(of))) => nodes.extend(of),
                (None, None) => {}
            }
        }
        nodes
    }

    pub fn add_node(
        &mut self,
        source: &Source,
        at: usize,
        tag: u64,
        place: [f64; 3],
    ) -> Result<(), ReadError> {
        if self.node_index.insert(tag, self.nodes.len() as u32).is_some() {
            return Err(source.error_at(at, Problem::Duplicate { kind: "node", tag }));
        }
        self.nodes.push(place);
        Ok(())
    }

    /// Adds an element of 4 or 10 nodes.
    pub fn add_tet(
        &mut self,
        source: &Source,
        at: usize,
        tag: u64,
        nodes: &[u64],
    ) -> Result<(), ReadError> {
        let fail = |problem| Err(source.error_at(at, problem));
        if self.tets.is_empty() {
            self.nodes_per_element = nodes.len();
        } else if nodes.len() != self.nodes_per_element {
            let (first, this) = (self.nodes_per_element, nodes.len());
            return fail(Problem::MixedOrders { first, this });
        }
        if let Some(i) = (1..nodes.len()).find(|&i| nodes[..i].contains(&nodes[i])) {
            return fail(Problem::RepeatedNode { element: tag, node: nodes[i] });
        }
        if self.tet_index.insert(tag, self.tets.len() as u32).is_some() {
            return fail(Problem::Duplicate { kind: "element", tag });
        }
        let mut all = [0; 10];
        all[..nodes.len()].copy_from_slice(nodes);
        self.tets.push(RawTet { tag, nodes: all, at });
        Ok(())
    }

    /// Builds the mesh in metres, with all sets.
    pub fn finish(mut self, source: &Source, unit: LengthUnit) -> Result<Loaded, ReadError> {
        let end = |problem: Problem| source.error(problem);
        if self.tets.is_empty() {
            let advice = match self.deck {
                true => "the elements of a body are of type C3D4 or C3D10",
                false => "in Gmsh, assign a physical group to the volume, or save all elements",
            };
            return Err(end(Problem::NoTetrahedra { advice }));
        }
        let factor = unit.in_metres();
        let nodes = self.nodes.iter().map(|place| place.map(|x| x * factor)).collect();
        let elements = match self.nodes_per_element {
            4 => Elements::Linear(self.resolved(source)?),
            _ => Elements::Quadratic(self.resolved(source)?),
        };
        let mut mesh = TetMesh::new(nodes, elements).map_err(|error| end(error.into()))?;

        for (name, tags) in &self.element_sets {
            let indices = members(name, "element", tags, &self.tet_index).map_err(end)?;
            mesh.element_sets.insert(name.clone(), indices);
        }
        let faces = if self.surface_sets.is_empty() { Vec::new() } else { sorted_faces(&mesh) };
        let mut unusable = std::mem::take(&mut self.unusable);
        for (name, RawSurface { at, faces: own, lines }) in &self.surface_sets {
            let mut set = Vec::new();
            let resolved = own
                .iter()
                .try_for_each(|member| self.resolve_face(name, *member, &faces, &mut set));
            if let Err(problem) = resolved {
                let (name, error) = (name.clone(), source.error_at(*at, problem));
                unusable.push(Unusable { name, kind: SetKind::Surface, error });
                continue;
            }
            set.sort_unstable();
            set.dedup();
            let mut nodes = mesh.nodes_of_faces(&set);
            nodes.extend(members(name, "node", lines, &self.node_index).map_err(end)?);
            nodes.sort_unstable();
            nodes.dedup();
            mesh.node_sets.insert(name.clone(), nodes);
            mesh.surface_sets.insert(name.clone(), set);
        }
        for (name, tags) in &self.node_sets {
            let indices = members(name, "node", tags, &self.node_index).map_err(end)?;
            let of_faces = self.surface_sets.get(name).zip(mesh.node_sets.get(name));
            if let Some((surface, nodes)) = of_faces
                && self.deck
                && *nodes != indices
            {
                let error = source.error_at(surface.at, Problem::TwoSets { set: name.clone() });
                unusable.push(Unusable { name: name.clone(), kind: SetKind::Nodes, error });
                mesh.node_sets.remove(name);
                continue;
            }
            let set = mesh.node_sets.entry(name.clone()).or_default();
            set.extend(indices);
            set.sort_unstable();
            set.dedup();
        }
        let ignored = self.ignored.into_iter().map(|(what, count)| Note::Ignored { what, count });
        let notes = size_note(&mesh, unit).into_iter().chain(ignored).chain(self.notes).collect();
        let mut numbers = FileNumbers {
            nodes: vec![0; mesh.nodes.len()],
            elements: self.tets.iter().map(|tet| tet.tag).collect(),
        };
        for (tag, index) in self.node_index {
            numbers.nodes[index as usize] = tag;
        }
        let [stress, density] = unit.of_materials();
        let in_si = |material: DeckMaterial| DeckMaterial {
            elastic: material.elastic.map(|[young, poisson]| [stress * young, poisson]),
            density: material.density.map(|given| density * given),
            ..material
        };
        let materials = self.materials.into_iter().map(in_si).collect();
        Ok(Loaded { mesh, notes, numbers, materials, unusable, any_case: self.deck })
    }

    /// Elements by node indices, the first N nodes of each.
    fn resolved<const N: usize>(&self, source: &Source) -> Result<Vec<[u32; N]>, ReadError> {
        let mut elements = Vec::with_capacity(self.tets.len());
        for tet in &self.tets {
            let mut nodes = [0; N];
            for (node, tag) in nodes.iter_mut().zip(tet.nodes) {
                *node = *self.node_index.get(&tag).ok_or_else(|| {
                    let problem = Problem::UnknownNode { element: tet.tag, node: tag };
                    source.error_at(tet.at, problem)
                })?;
            }
            elements.push(nodes);
        }
        Ok(elements)
    }

    fn resolve_face(
        &self,
        set: &str,
        member: RawFace,
        faces: &[([u32; 3], Face)],
        into: &mut Vec<Face>,
    ) -> Result<(), Problem> {
        let element_of = |tag: u64| {
            let unknown = || Problem::UnknownMember { set: set.to_string(), kind: "element", tag };
            self.tet_index.get(&tag).copied().ok_or_else(unknown)
        };
        let owners = |key: [u32; 3]| {
            let first = faces.partition_point(|(other, _)| *other < key);
            faces[first..].iter().take_while(move |(other, _)| *other == key).map(|(_, face)| *face)
        };
        match member {
            RawFace::Corners(tags) => {
                let loose = || Problem::LooseFace { set: set.to_string(), nodes: tags };
                let mut key = [0; 3];
                for (node, tag) in key.iter_mut().zip(tags) {
                    *node = *self.node_index.get(&tag).ok_or_else(loose)?;
                }
                key.sort_unstable();
                // A triangle between two elements becomes a side of the first one.
                into.push(owners(key).next().ok_or_else(loose)?);
            }
            RawFace::Side { element, side } => {
                into.push(Face { element: element_of(element)?, side });
            }
            RawFace::Free { element } => {
                let element = element_of(element)?;
                // Look up each side of the element by its corners.
                let tet = &self.tets[element as usize];
                for (side, corners) in crate::mesh::node_order::SIDES.iter().enumerate() {
                    let mut key = corners.map(|local| self.node_index[&tet.nodes[local]]);
                    key.sort_unstable();
                    if owners(key).count() == 1 {
                        into.push(Face { element, side: side as u8 });
                    }
                }
            }
        }
        Ok(())
    }
}

fn members(
    set: &str,
    kind: &'static str,
    tags: &[u64],
    index: &HashMap<u64, u32>,
) -> Result<Vec<u32>, Problem> {
    let find = |&tag: &u64| {
        let unknown = || Problem::UnknownMember { set: set.to_string(), kind, tag };
        index.get(&tag).copied().ok_or_else(unknown)
    };
    let mut indices: Vec<u32> = tags.iter().map(find).collect::<Result<_, _>>()?;
    indices.sort_unstable();
    indices.dedup();
    Ok(indices)
}
