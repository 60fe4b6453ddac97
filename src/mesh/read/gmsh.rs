//! Reader of Gmsh's `.msh`: header, names of physical groups, supported elements. Quadrangles are skipped and reported.
//!
//! Physical volumes become element sets, surfaces become surface sets with their nodes, curves
//! and points become node sets. A group without a name is named `physical_<dimension>_<tag>`.

use crate::mesh::TetMesh;
use crate::mesh::node_order::swap_gmsh;
use crate::mesh::read::assemble::{RawFace, RawMesh, RawSurface};
use crate::mesh::read::error::{Problem, ReadError};
use crate::mesh::read::source::{Coding, Source, decode, excerpt};
use crate::mesh::read::{LengthUnit, Loaded, Note, SetKind, gmsh2, gmsh4};
use std::collections::HashMap;

#[derive(Default)]
pub(super) struct Names(HashMap<(i64, i64), String>);

impl Names {
    pub(super) fn of(&self, dimension: i64, tag: i64) -> String {
        let given = self.0.get(&(dimension, tag)).cloned();
        given.unwrap_or_else(|| format!("physical_{dimension}_{tag}"))
    }
}

/// Reads a `.msh` file of version 4.1 or 2 to 2.2, text or binary.
///
/// # Errors
/// [`ReadError`] with the line, or in binary data the byte, of the error.
pub fn read_gmsh(bytes: &[u8], unit: LengthUnit) -> Result<Loaded, ReadError> {
    let mut source = Source::new(bytes);
    if bytes.trim_ascii().is_empty() {
        return Err(source.error(Problem::Empty));
    }
    find_header(&mut source)?;
    let (version, coding) = header(&mut source)?;
    let mut names = Names::default();
    let mut raw = RawMesh::new(bytes.len(), false);
    let mut entities = gmsh4::Entities::default();
    let (mut nodes_seen, mut elements_seen) = (false, false);
    while let Some(line) = source.full_line() {
        let start = source.position();
        let Some(section) = line.strip_prefix(b"$") else {
            let expected = "a section ($…)".to_string();
            return Err(
                source.error_at(start, Problem::Expected { expected, found: excerpt(line) })
            );
        };
        match (section, version) {
            (b"PhysicalNames", _) => names = physical_names(&mut source)?,
            (b"Entities", Version::V41) => {
                entities = in_coding(&mut source, coding, gmsh4::entities)?
            }
            (b"Nodes", Version::V41) => {
                in_coding(&mut source, coding, |source| gmsh4::nodes(source, &mut raw))?;
                nodes_seen = true;
            }
            (b"Elements", Version::V41) => {
                let read =
                    |source: &mut Source| gmsh4::elements(source, &entities, &names, &mut raw);
                in_coding(&mut source, coding, read)?;
                elements_seen = true;
            }
            (b"Nodes" | b"ParametricNodes", Version::V22) => {
                let parametric = section != b"Nodes";
                gmsh2::nodes(&mut source, coding, parametric, &mut raw)?;
                nodes_seen = true;
            }
            (b"Elements", Version::V22) => {
                gmsh2::elements(&mut source, coding, &names, &mut raw)?;
                elements_seen = true;
            }
            (b"PartitionedEntities", _) => {
                let what = "a partitioned mesh".to_string();
                let hint = "save it unpartitioned";
                return Err(source.error_at(start, Problem::Unsupported { what, hint }));
            }
            (other, _) => {
                let end = [b"\n$End", other].concat();
                // The line end before the marker belongs to the skipped section.
                source.skip_behind(&end)?;
                source.line();
                raw.ignore(format!("section ${}", excerpt(other)));
                continue;
            }
        }
        let end = source.position();
        let closing = source.full_line().unwrap_or_default();
        if closing.strip_prefix(b"$End") != Some(section) {
            if source.left() == 0 && b"$End".starts_with(&closing[..closing.len().min(4)]) {
                let what = format!("section ${}", excerpt(section));
                return Err(source.error_at(end, Problem::Truncated { what }));
            }
            let expected = format!("$End{}", excerpt(section));
            return Err(
                source.error_at(end, Problem::Expected { expected, found: excerpt(closing) })
            );
        }
    }
    for (seen, section) in [(nodes_seen, "$Nodes"), (elements_seen, "$Elements")] {
        if !seen {
            return Err(source.error(Problem::MissingSection { section }));
        }
    }
    source.coding = coding;
    let mut loaded = raw.finish(&source, unit)?;
    let names = volumes(&loaded.mesh);
    if names.len() > 1 {
        loaded.notes.push(Note::SeveralVolumes { names });
    }
    Ok(loaded)
}

/// Names of groups that share no element. Smaller groups take precedence, so that a group of all elements does
/// not count in addition to its parts.
fn volumes(mesh: &TetMesh) -> Vec<String> {
    let mut sets: Vec<(&String, &Vec<u32>)> = mesh.element_sets.iter().collect();
    sets.sort_by_key(|(_, elements)| elements.len());
    let mut claimed = vec![false; mesh.elements.len()];
    let mut names = Vec::new();
    for (name, elements) in sets {
        if elements.iter().any(|element| claimed[*element as usize]) {
            continue;
        }
        elements.iter().for_each(|element| claimed[*element as usize] = true);
        names.push(name.clone());
    }
    names.sort();
    names
}

/// Runs `read` with numbers in the file's coding, then returns to text.
pub(super) fn in_coding<'a, T>(
    source: &mut Source<'a>,
    coding: Coding,
    read: impl FnOnce(&mut Source<'a>) -> Result<T, ReadError>,
) -> Result<T, ReadError> {
    source.coding = coding;
    let result = read(source);
    source.coding = Coding::Text;
    result
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    V22,
    V41,
}

/// Skips comments before the header.
fn find_header(source: &mut Source) -> Result<(), ReadError> {
    let first = source.from(source.position()).full_line().unwrap_or_default();
    while let Some(line) = source.full_line() {
        if line == b"$MeshFormat" {
            return Ok(());
        }
    }
    if first == b"$NOD" {
        return Err(source.error_at(0, Problem::Version { found: "1".into() }));
    }
    let found = excerpt(first);
    Err(source.error_at(0, Problem::OtherFormat { expected: "a Gmsh .msh", found }))
}

fn header(source: &mut Source) -> Result<(Version, Coding), ReadError> {
    let start = source.position();
    let line = source.full_line().unwrap_or_default();
    let words: Vec<String> = line
        .split(|byte| byte.is_ascii_whitespace())
        .filter(|w| !w.is_empty())
        .map(excerpt)
        .collect();
    let word = |index: usize| words.get(index).map(String::as_str).unwrap_or_default();
    let version = match word(0) {
        "4.1" => Version::V41,
        "2" | "2.0" | "2.1" | "2.2" => Version::V22,
        "" => return Err(source.error(Problem::Truncated { what: "section $MeshFormat".into() })),
        other => return Err(source.error_at(start, Problem::Version { found: other.into() })),
    };
    if word(2) != "8" {
        let (what, hint) =
            ("a size of numbers other than 8 bytes".to_string(), "save it on a 64-bit system");
        return Err(source.error_at(start, Problem::Unsupported { what, hint }));
    }
    let coding = match word(1) {
        "0" => Coding::Text,
        "1" => {
            source.coding = Coding::Little;
            let one = source.int("the mark of the byte order");
            source.coding = Coding::Text;
            match one? {
                1 => Coding::Little,
                0x0100_0000 => Coding::Big,
                other => {
                    let what = "the mark of the byte order (1)";
                    return Err(source.error(Problem::Number { found: other.to_string(), what }));
                }
            }
        }
        other => {
            let problem = Problem::Number { found: other.into(), what: "a file type (0 or 1)" };
            return Err(source.error_at(start, problem));
        }
    };
    let end = source.position();
    match source.full_line() {
        Some(b"$EndMeshFormat") => Ok((version, coding)),
        None => Err(source.error(Problem::Truncated { what: "section $MeshFormat".into() })),
        Some(other) => {
            let expected = "$EndMeshFormat".to_string();
            Err(source.error_at(end, Problem::Expected { expected, found: excerpt(other) }))
        }
    }
}

/// Reads names, which are text in every version and coding: dimension, tag and a quoted name per line.
fn physical_names(source: &mut Source) -> Result<Names, ReadError> {
    let count: u64 = source.text_number("a count of names")?;
    source.line();
    source.expect_room("names of groups", count, 6)?;
    let mut names = Names::default();
    for _ in 0..count {
        let dimension = source.text_number("a dimension")?;
        let tag = source.text_number("the number of a group")?;
        let start = source.position();
        let line = decode(source.line().unwrap_or_default());
        let name = line.strip_prefix('"').and_then(|rest| rest.split_once('"'));
        let Some((name, _)) = name else {
            let problem = Problem::Number { found: line, what: "a name in quotes" };
            return Err(source.error_at(start, problem));
        };
        names.0.insert((dimension, tag), name.to_string());
    }
    Ok(names)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Point,
    Line,
    Triangle,
    Quadrangle,
    Tet,
}

/// Kind and number of nodes of Gmsh's element type.
pub(super) fn kind(source: &Source, at: usize, code: i64) -> Result<(Kind, usize), ReadError> {
    match code {
        15 => Ok((Kind::Point, 1)),
        1 => Ok((Kind::Line, 2)),
        8 => Ok((Kind::Line, 3)),
        2 => Ok((Kind::Triangle, 3)),
        9 => Ok((Kind::Triangle, 6)),
        3 => Ok((Kind::Quadrangle, 4)),
        10 => Ok((Kind::Quadrangle, 9)),
        16 => Ok((Kind::Quadrangle, 8)),
        4 => Ok((Kind::Tet, 4)),
        11 => Ok((Kind::Tet, 10)),
        other => {
            let name = match other {
                5 | 12 | 17 => "hexahedron",
                6 | 13 | 18 => "prism",
                7 | 14 | 19 => "pyramid",
                20..=25 => "triangle of higher order; write second order at most",
                26..=28 => "line of higher order; write second order at most",
                29..=31 => "tetrahedron of higher order; write second order at most",
                _ => "unknown",
            };
            Err(source.error_at(at, Problem::ElementType { found: format!("{other} ({name})") }))
        }
    }
}

/// Adds one element to the mesh and the sets `groups`.
pub(super) fn place_element(
    source: &Source,
    at: usize,
    (kind, tag): (Kind, u64),
    nodes: &[u64],
    groups: &[String],
    raw: &mut RawMesh,
) -> Result<(), ReadError> {
    raw.take_room(source, at, groups.len() * nodes.len())?;
    match kind {
        Kind::Point | Kind::Line => {
            for group in groups {
                raw.node_sets.entry(group.clone()).or_default().extend(nodes);
            }
        }
        Kind::Triangle => {
            let corners = RawFace::Corners([nodes[0], nodes[1], nodes[2]]);
            for group in groups {
                let surface = RawSurface { at, faces: Vec::new(), lines: Vec::new() };
                raw.surface_sets.entry(group.clone()).or_insert(surface).faces.push(corners);
            }
        }
        Kind::Quadrangle => {
            raw.ignore("a quadrangle".into());
            for group in groups {
                let what = format!("a quadrangle in \"{group}\"");
                let hint = "mesh the surface with triangles";
                let error = source.error_at(at, Problem::Unsupported { what, hint });
                raw.skip_set(group, SetKind::Nodes, error);
            }
        }
        Kind::Tet => {
            match <[u64; 10]>::try_from(nodes) {
                Ok(nodes) => raw.add_tet(source, at, tag, &swap_gmsh(nodes))?,
                Err(_) => raw.add_tet(source, at, tag, nodes)?,
            }
            for group in groups {
                raw.element_sets.entry(group.clone()).or_default().push(tag);
            }
        }
    }
    Ok(())
}
