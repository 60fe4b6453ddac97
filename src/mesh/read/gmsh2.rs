//! Sections of `.msh` version 2.2. Counts are text even if the rest is binary.

use crate::mesh::read::assemble::RawMesh;
use crate::mesh::read::error::{Problem, ReadError};
use crate::mesh::read::gmsh::{Kind, Names, in_coding, kind, place_element};
use crate::mesh::read::source::{Coding, Source, count_of};
use std::collections::HashMap;

/// A count on a line of its own.
fn count(source: &mut Source, what: &'static str) -> Result<u64, ReadError> {
    let count = source.text_number(count_of(what))?;
    source.line();
    source.expect_room(what, count, 4)?;
    Ok(count)
}

/// A number that must not be negative: version 2.2 writes tags with a sign.
fn tag(source: &mut Source, what: &'static str) -> Result<u64, ReadError> {
    let at = source.position();
    let number = source.int(what)?;
    u64::try_from(number)
        .map_err(|_| source.error_at(at, Problem::Number { found: number.to_string(), what }))
}

pub(super) fn nodes(
    source: &mut Source,
    coding: Coding,
    parametric: bool,
    raw: &mut RawMesh,
) -> Result<(), ReadError> {
    let total = count(source, "nodes")?;
    in_coding(source, coding, |source| {
        for _ in 0..total {
            let at = source.position();
            let tag = tag(source, "the number of a node")?;
            let mut place = [0.0; 3];
            for x in &mut place {
                *x = source.double("a coordinate")?;
            }
            if parametric {
                // The entity, and the place on a curve or surface.
                let dimension = source.int("a dimension")?;
                source.int("the number of an entity")?;
                for _ in 0..if matches!(dimension, 1 | 2) { dimension } else { 0 } {
                    source.double("a parameter")?;
                }
            }
            raw.add_node(source, at, tag, place)?;
        }
        Ok(())
    })
}

pub(super) fn elements(
    source: &mut Source,
    coding: Coding,
    names: &Names,
    raw: &mut RawMesh,
) -> Result<(), ReadError> {
    let total = count(source, "elements")?;
    let mut groups = Groups { names, tets: HashMap::new() };
    in_coding(source, coding, |source| {
        let mut read = 0;
        while read < total {
            // Binary data has runs of one element type; text has the type of each element.
            let at = source.position();
            let text_tag = match coding {
                Coding::Text => Some(tag(source, "the number of an element")?),
                _ => None,
            };
            let code = source.int("an element type")?;
            let (kind, node_count) = kind(source, at, code)?;
            let run = if text_tag.is_some() { 1 } else { tag(source, "a count of elements")? };
            let tag_count = tag(source, "a count of tags")?;
            source.expect_room("tags of an element", tag_count, 2)?;
            source.expect_room("elements", run, 2 * node_count as u64)?;
            for _ in 0..run {
                let at = source.position();
                let tag = match text_tag {
                    Some(tag) => tag,
                    None => tag_of(source)?,
                };
                let mut physical = 0;
                for index in 0..tag_count {
                    let value = source.int("a tag")?;
                    if index == 0 {
                        physical = value.abs();
                    }
                }
                let mut nodes = [0; 10];
                for node in &mut nodes[..node_count] {
                    *node = self::tag(source, "the number of a node")?;
                }
                groups.place(source, at, (kind, tag), &nodes[..node_count], physical, raw)?;
            }
            // An empty run would never end.
            read += run.max(1);
        }
        if read == total {
            return Ok(());
        }
        let expected = format!("{total} elements in all");
        Err(source.error(Problem::Expected { expected, found: read.to_string() }))
    })
}

fn tag_of(source: &mut Source) -> Result<u64, ReadError> {
    tag(source, "the number of an element")
}

struct Groups<'n> {
    names: &'n Names,
    /// Tetrahedra seen, by their nodes: an element of several groups occurs once for each.
    tets: HashMap<Vec<u64>, u64>,
}

impl Groups<'_> {
    fn place(
        &mut self,
        source: &Source,
        at: usize,
        (kind, tag): (Kind, u64),
        nodes: &[u64],
        physical: i64,
        raw: &mut RawMesh,
    ) -> Result<(), ReadError> {
        let dimension = match kind {
            Kind::Point => 0,
            Kind::Line => 1,
            Kind::Triangle | Kind::Quadrangle => 2,
            Kind::Tet => 3,
        };
        let groups: Vec<String> =
            (physical != 0).then(|| self.names.of(dimension, physical)).into_iter().collect();
        if kind == Kind::Tet {
            let first = *self.tets.entry(nodes.to_vec()).or_insert(tag);
            if first != tag {
                raw.take_room(source, at, groups.len())?;
                for group in groups {
                    raw.element_sets.entry(group).or_default().push(first);
                }
                return Ok(());
            }
        }
        place_element(source, at, (kind, tag), nodes, &groups, raw)
    }
}
