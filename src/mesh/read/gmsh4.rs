//! Sections of `.msh` version 4.1. Text and binary contain the same numbers.

use crate::mesh::read::assemble::RawMesh;
use crate::mesh::read::error::{Problem, ReadError};
use crate::mesh::read::gmsh::{Names, kind, place_element};
use crate::mesh::read::source::{Source, count_of};
use std::collections::HashMap;

/// Physical groups of each geometric entity, by its dimension and tag.
#[derive(Default)]
pub(super) struct Entities(HashMap<(i64, i64), Vec<i64>>);

pub(super) fn entities(source: &mut Source) -> Result<Entities, ReadError> {
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = source.size("a count of entities")?;
    }
    let mut entities = Entities::default();
    for (dimension, count) in counts.into_iter().enumerate() {
        // Tag, coordinates and the number of groups: at least five numbers.
        source.expect_room("entities", count, 10)?;
        for _ in 0..count {
            let tag = source.int("the number of an entity")?;
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                source.double("a coordinate")?;
            }
            let groups = int_list(source, "groups of an entity")?;
            if dimension > 0 {
                int_list(source, "borders of an entity")?;
            }
            entities.0.insert((dimension as i64, tag), groups);
        }
    }
    Ok(entities)
}

fn int_list(source: &mut Source, what: &'static str) -> Result<Vec<i64>, ReadError> {
    let count = source.size(what)?;
    source.expect_room(what, count, 2)?;
    (0..count).map(|_| source.int(what)).collect()
}

/// Number of blocks and total number of entries; the range of tags that follows is redundant.
fn totals(source: &mut Source, what: &'static str) -> Result<(u64, u64), ReadError> {
    let blocks = source.size("a count of blocks")?;
    let total = source.size(count_of(what))?;
    source.size("the least tag")?;
    source.size("the greatest tag")?;
    source.expect_room("blocks", blocks, 8)?;
    source.expect_room(what, total, 4)?;
    Ok((blocks, total))
}

fn expect_total(source: &Source, what: &str, announced: u64, found: u64) -> Result<(), ReadError> {
    if announced == found {
        return Ok(());
    }
    let expected = format!("{announced} {what} in all");
    Err(source.error(Problem::Expected { expected, found: found.to_string() }))
}

pub(super) fn nodes(source: &mut Source, raw: &mut RawMesh) -> Result<(), ReadError> {
    let (blocks, total) = totals(source, "nodes")?;
    let mut found = 0;
    for _ in 0..blocks {
        let dimension = source.int("a dimension")?;
        source.int("the number of an entity")?;
        let parametric = source.int("0 or 1 for parameters")?;
        let count = source.size("a count of nodes")?;
        source.expect_room("nodes", count, 8)?;
        let start = source.position();
        let mut tags = Vec::new();
        for _ in 0..count {
            tags.push(source.size("the number of a node")?);
        }
        let parameters = if parametric == 1 { dimension.clamp(0, 3) } else { 0 };
        for tag in tags {
            let mut place = [0.0; 3];
            for x in &mut place {
                *x = source.double("a coordinate")?;
            }
            for _ in 0..parameters {
                source.double("a parameter")?;
            }
            raw.add_node(source, start, tag, place)?;
        }
        found += count;
    }
    expect_total(source, "nodes", total, found)
}

pub(super) fn elements(
    source: &mut Source,
    entities: &Entities,
    names: &Names,
    raw: &mut RawMesh,
) -> Result<(), ReadError> {
    let (blocks, total) = totals(source, "elements")?;
    let mut found = 0;
    for _ in 0..blocks {
        let dimension = source.int("a dimension")?;
        let entity = source.int("the number of an entity")?;
        let start = source.position();
        let code = source.int("an element type")?;
        let count = source.size("a count of elements")?;
        let (kind, node_count) = kind(source, start, code)?;
        source.expect_room("elements", count, 2 * (1 + node_count as u64))?;
        let tags = entities.0.get(&(dimension, entity)).map(Vec::as_slice).unwrap_or_default();
        let groups: Vec<String> = tags.iter().map(|tag| names.of(dimension, tag.abs())).collect();
        let mut nodes = [0; 10];
        for _ in 0..count {
            let at = source.position();
            let tag = source.size("the number of an element")?;
            for node in &mut nodes[..node_count] {
                *node = source.size("the number of a node")?;
            }
            place_element(source, at, (kind, tag), &nodes[..node_count], &groups, raw)?;
        }
        found += count;
    }
    expect_total(source, "elements", total, found)
}
