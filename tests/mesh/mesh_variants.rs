//! One body in hundreds of input decks and Gmsh files: all are the same mesh with the same sets.

use crate::deck_common;

use bearing_dynamics::mesh::check::{Limits, check};
use bearing_dynamics::mesh::read::{LengthUnit, read_abaqus, read_gmsh};
use bearing_dynamics::mesh::repair::{Repair, repair};
use bearing_dynamics::mesh::{Elements, TetMesh};
use deck_common::{NODES, TETS, Variant, decks, gmsh_files};
use std::collections::BTreeMap;

/// The only set of this name, whose case counts in Gmsh alone.
fn only<'s, T>(
    sets: &'s BTreeMap<String, Vec<T>>,
    name: &str,
    deck: bool,
) -> Result<&'s Vec<T>, String> {
    let same = |other: &str| other == name || deck && other.eq_ignore_ascii_case(name);
    let found: Vec<&Vec<T>> =
        sets.iter().filter(|(other, _)| same(other)).map(|(_, set)| set).collect();
    match found[..] {
        [set] => Ok(set),
        _ => Err(format!("{} sets {name} of {:?}", found.len(), sets.keys())),
    }
}

/// What is wrong with the mesh of a file.
fn fault(variant: &Variant, deck: bool) -> Result<(), String> {
    let reader = if deck { read_abaqus } else { read_gmsh };
    let loaded = reader(&variant.bytes, LengthUnit::Millimetre).map_err(|e| e.to_string())?;
    let wanted = Repair { drop_unreferenced: variant.stray, ..Repair::default() };
    let (mut mesh, _) = repair(loaded.mesh, &wanted).map_err(|e| e.to_string())?;
    mesh.node_sets.retain(|_, set| !variant.stray || !set.is_empty());
    check(&mesh, &Limits::default()).map_err(|e| e.to_string())?;
    same_body(&mesh)?;
    let [fix, tip, end] = variant.sets;
    for (name, nodes) in [(fix, [0, 1, 2, 3]), (tip, [8, 9, 10, 11]), (end, [8, 9, 10, 11])] {
        let found = only(&mesh.node_sets, name, deck)?;
        if *found != nodes {
            return Err(format!("nodes of {name}: {found:?}"));
        }
    }
    let faces = only(&mesh.surface_sets, end, deck)?;
    let mut of: Vec<u32> = faces.iter().map(|face| face.element).collect();
    of.sort_unstable();
    if of != [10, 11] {
        return Err(format!("faces of {end}: {faces:?}"));
    }
    Ok(())
}

fn same_body(mesh: &TetMesh) -> Result<(), String> {
    let nodes: Vec<[f64; 3]> =
        NODES.iter().map(|place| place.map(|x| 1e-3 * f64::from(x))).collect();
    let elements = TETS.map(|tet| tet.map(|node| node as u32 - 1));
    let near = mesh.nodes.len() == nodes.len()
        && mesh
            .nodes
            .as_flattened()
            .iter()
            .zip(nodes.as_flattened())
            .all(|(a, b)| (a - b).abs() < 1e-17);
    if !near {
        return Err(format!("nodes: {:?}", mesh.nodes));
    }
    match &mesh.elements {
        Elements::Linear(found) if *found == elements => Ok(()),
        other => Err(format!("elements: {other:?}")),
    }
}

fn all_are_the_body(variants: &[Variant], deck: bool, least: usize) {
    assert!(variants.len() >= least, "{} variants", variants.len());
    let faults: Vec<String> = variants
        .iter()
        .filter_map(|variant| {
            fault(variant, deck).err().map(|why| format!("{}: {why}", variant.name))
        })
        .collect();
    assert!(faults.is_empty(), "{} of {}:\n{}", faults.len(), variants.len(), faults.join("\n"));
}

#[test]
fn decks_in_every_form_are_one_mesh() {
    all_are_the_body(&decks(), true, 300);
}

#[test]
fn gmsh_files_in_every_form_are_one_mesh() {
    all_are_the_body(&gmsh_files(), false, 100);
}

/// A file in Latin-1: names that differ in a letter outside ASCII are two.
#[test]
fn names_in_latin_1_stay_apart() {
    let latin =
        |text: &str| text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect::<Vec<u8>>();
    let plain = String::from_utf8(decks()[0].bytes.clone()).unwrap();
    let deck = plain.replace("=fix", "=Geh\u{e4}use").replace("=tip", "=Geh\u{f6}use");
    let gmsh = String::from_utf8(gmsh_files()[0].bytes.clone()).unwrap();
    let gmsh = gmsh.replace("\"fix\"", "\"Geh\u{e4}use\"").replace("\"tip\"", "\"Geh\u{f6}use\"");
    for (bytes, reader) in [
        (latin(&deck), read_abaqus as fn(&[u8], LengthUnit) -> _),
        (deck.into_bytes(), read_abaqus),
        (latin(&gmsh), read_gmsh),
        (gmsh.into_bytes(), read_gmsh),
    ] {
        let mesh = reader(&bytes, LengthUnit::Millimetre).unwrap().mesh;
        assert_eq!(mesh.node_sets["Geh\u{e4}use"], [0, 1, 2, 3]);
        assert_eq!(mesh.node_sets["Geh\u{f6}use"], [8, 9, 10, 11]);
    }
}
