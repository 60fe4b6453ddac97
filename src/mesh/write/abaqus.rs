//! Writer of `.inp` for Abaqus and CalculiX; numbers from 1, lengths in m.

use crate::mesh::error::MeshError;
use crate::mesh::tet_mesh::{Order, TetMesh};
use std::fmt::Write;

/// Numbers on a data line; the formats allow 16.
const PER_LINE: usize = 12;

/// Longest number that CalculiX reads, characters.
const NUMBER_WIDTH: usize = 20;

const ALL_NODES: &str = "all_nodes";
const ALL_ELEMENTS: &str = "all_elements";

/// Writes nodes, elements (C3D4 or C3D10) and all sets of `mesh`. Surface sets become element surfaces.
///
/// Coordinates have at most CalculiX' 20 characters; most are exact.
///
/// # Errors
/// [`MeshError::Name`] for a set whose name the format does not allow.
pub fn write_abaqus(mesh: &TetMesh) -> Result<String, MeshError> {
    let names =
        mesh.node_sets.keys().chain(mesh.element_sets.keys()).chain(mesh.surface_sets.keys());
    for name in names {
        check_name(name)?;
    }
    check_own_name(ALL_NODES, mesh.node_sets.get(ALL_NODES), mesh.nodes.len())?;
    check_own_name(ALL_ELEMENTS, mesh.element_sets.get(ALL_ELEMENTS), mesh.elements.len())?;
    let mut text = format!("** Lengths in m\n*NODE, NSET={ALL_NODES}\n");
    let out = &mut text;
    for (node, [x, y, z]) in mesh.nodes.iter().enumerate() {
        let [x, y, z] = [x, y, z].map(|x| number(*x));
        line(out, format_args!("{}, {x}, {y}, {z}", node + 1));
    }
    let kind = match mesh.order() {
        Order::Linear => "C3D4",
        Order::Quadratic => "C3D10",
    };
    line(out, format_args!("*ELEMENT, TYPE={kind}, ELSET={ALL_ELEMENTS}"));
    for element in 0..mesh.elements.len() {
        let nodes: Vec<String> =
            mesh.elements.nodes(element).iter().map(|node| (node + 1).to_string()).collect();
        line(out, format_args!("{}, {}", element + 1, nodes.join(", ")));
    }
    for (name, set) in mesh.node_sets.iter().filter(|(name, _)| *name != ALL_NODES) {
        line(out, format_args!("*NSET, NSET={name}"));
        numbers(out, set);
    }
    for (name, set) in mesh.element_sets.iter().filter(|(name, _)| *name != ALL_ELEMENTS) {
        line(out, format_args!("*ELSET, ELSET={name}"));
        numbers(out, set);
    }
    for (name, faces) in &mesh.surface_sets {
        line(out, format_args!("*SURFACE, NAME={name}, TYPE=ELEMENT"));
        for face in faces {
            line(out, format_args!("{}, S{}", face.element + 1, face.side + 1));
        }
    }
    Ok(text)
}

/// A number in the shortest exact form, or with as many digits as fit.
fn number(x: f64) -> String {
    let fits = |text: &String| text.len() <= NUMBER_WIDTH;
    let exact = [format!("{x}"), format!("{x:e}")].into_iter().filter(fits).min_by_key(String::len);
    let rounded = || (0..=16).rev().map(|digits| format!("{x:.digits$e}")).find(fits);
    exact.or_else(rounded).unwrap_or_default()
}

/// Adds a line; writing to a string cannot fail.
fn line(out: &mut String, text: std::fmt::Arguments) {
    let _ = out.write_fmt(text);
    out.push('\n');
}

fn numbers(out: &mut String, set: &[u32]) {
    for chunk in set.chunks(PER_LINE) {
        let words: Vec<String> = chunk.iter().map(|index| (index + 1).to_string()).collect();
        line(out, format_args!("{}", words.join(", ")));
    }
}

/// Allows letters, digits, `_`, `-` and `.`, a letter first, at most 80 characters (CalculiX).
fn check_name(name: &str) -> Result<(), MeshError> {
    let fail = |why| Err(MeshError::Name { name: name.to_string(), why });
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return fail("it must begin with a letter");
    }
    if name.len() > 80 {
        return fail("it is longer than 80 characters");
    }
    if name.contains(|c: char| !c.is_ascii_alphanumeric() && !"_-.".contains(c)) {
        return fail("only letters, digits, _, - and . are allowed");
    }
    Ok(())
}

/// A set with a name that the file uses for all nodes or elements must contain all, as after reading such a file.
fn check_own_name(name: &str, set: Option<&Vec<u32>>, count: usize) -> Result<(), MeshError> {
    if set.is_none_or(|set| set.len() == count) {
        return Ok(());
    }
    Err(MeshError::Name {
        name: name.to_string(),
        why: "the file uses it for all nodes or elements",
    })
}
