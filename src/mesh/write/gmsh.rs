//! Writer of Gmsh's `.msh` 4.1 as text; tags from 1, lengths in m.
//!
//! Gmsh has physical groups of geometric entities instead of sets. Members that belong to
//! the same sets form an entity; nodes of a set are written as point elements.

use crate::mesh::error::MeshError;
use crate::mesh::node_order::swap_gmsh;
use crate::mesh::tet_mesh::{Elements, Order, TetMesh};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Entities of a dimension: the tags of their physical groups, and their members.
type Entities = BTreeMap<Vec<usize>, Vec<Vec<u32>>>;

/// Writes nodes, elements and all sets of `mesh`; coordinates are exact. Element sets become
/// physical volumes, surface sets physical surfaces, and node sets physical points unless a surface
/// set of the same name has exactly these nodes. Elements are written entity by entity, so their
/// order may change.
///
/// # Errors
/// [`MeshError::Name`] for a set whose name the format does not allow, or a node set that differs
/// from the nodes of the surface set of the same name.
pub fn write_gmsh(mesh: &TetMesh) -> Result<String, MeshError> {
    let mut points = Vec::new();
    for (name, set) in &mesh.node_sets {
        let Some(faces) = mesh.surface_sets.get(name) else {
            points.push((name, set));
            continue;
        };
        let (mut own, mut of_faces) = (set.clone(), mesh.nodes_of_faces(faces));
        own.sort_unstable();
        of_faces.sort_unstable();
        if own != of_faces {
            let why = "node set and surface set of that name have different nodes";
            return Err(MeshError::Name { name: name.clone(), why });
        }
    }
    let names = points.iter().map(|(name, _)| (0, *name));
    let names = names
        .chain(mesh.surface_sets.keys().map(|name| (2, name)))
        .chain(mesh.element_sets.keys().map(|name| (3, name)));
    let groups: Vec<(usize, &String)> = names.collect();
    for (_, name) in &groups {
        check_name(name)?;
    }

    // Physical tags are consecutive over all dimensions, in the order of `groups`.
    let mut tag = 0;
    let mut next = || {
        tag += 1;
        tag
    };
    let mut of_points: BTreeMap<Vec<u32>, Vec<usize>> = BTreeMap::new();
    for (_, set) in &points {
        let tag = next();
        for node in *set {
            of_points.entry(vec![node + 1]).or_default().push(tag);
        }
    }
    let mut of_faces: BTreeMap<Vec<u32>, Vec<usize>> = BTreeMap::new();
    for faces in mesh.surface_sets.values() {
        let tag = next();
        for face in faces {
            let nodes = mesh.face_nodes(*face).map(|node| node + 1).collect();
            of_faces.entry(nodes).or_default().push(tag);
        }
    }
    let mut of_elements = vec![Vec::new(); mesh.elements.len()];
    for set in mesh.element_sets.values() {
        let tag = next();
        for element in set {
            of_elements[*element as usize].push(tag);
        }
    }
    let gather = |members: &mut dyn Iterator<Item = (Vec<u32>, Vec<usize>)>| {
        let mut entities = Entities::new();
        for (nodes, tags) in members {
            entities.entry(tags).or_default().push(nodes);
        }
        entities
    };
    let points = gather(&mut of_points.into_iter());
    let surfaces = gather(&mut of_faces.into_iter());
    let volumes = gather(
        &mut (0..mesh.elements.len())
            .map(|e| (tetrahedron(mesh, e), e))
            .map(|(nodes, element)| (nodes, std::mem::take(&mut of_elements[element]))),
    );

    let mut text = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    let out = &mut text;
    line(out, format_args!("$PhysicalNames\n{}", groups.len()));
    for (index, (dimension, name)) in groups.iter().enumerate() {
        line(out, format_args!("{dimension} {} \"{name}\"", index + 1));
    }
    line(out, format_args!("$EndPhysicalNames"));
    write_entities(out, mesh, [&points, &surfaces, &volumes]);
    write_nodes(out, mesh);
    let (triangle, tetrahedron) = match mesh.order() {
        Order::Linear => (2, 4),
        Order::Quadratic => (9, 11),
    };
    write_elements(out, [(0, 15, &points), (2, triangle, &surfaces), (3, tetrahedron, &volumes)]);
    Ok(text)
}

/// Nodes of an element in Gmsh's order, counted from 1.
fn tetrahedron(mesh: &TetMesh, element: usize) -> Vec<u32> {
    let nodes = match &mesh.elements {
        Elements::Linear(list) => list[element].to_vec(),
        Elements::Quadratic(list) => swap_gmsh(list[element]).to_vec(),
    };
    nodes.into_iter().map(|node| node + 1).collect()
}

/// Points with the position of their first node, surfaces and volumes with the bounding box of the mesh.
fn write_entities(out: &mut String, mesh: &TetMesh, of: [&Entities; 3]) {
    let [points, surfaces, volumes] = of;
    let (low, high) = mesh.bounding_box();
    let place = |x: [f64; 3]| format!("{:?} {:?} {:?}", x[0], x[1], x[2]);
    let listed = |tags: &Vec<usize>| {
        let words: Vec<String> = tags.iter().map(usize::to_string).collect();
        format!("{} {}", tags.len(), words.join(" "))
    };
    line(out, format_args!("$Entities\n{} 0 {} {}", points.len(), surfaces.len(), volumes.len()));
    for (index, (tags, members)) in points.iter().enumerate() {
        let at = mesh.nodes[members[0][0] as usize - 1];
        line(out, format_args!("{} {} {}", index + 1, place(at), listed(tags)));
    }
    for entities in [surfaces, volumes] {
        for (index, tags) in entities.keys().enumerate() {
            let (low, high) = (place(low), place(high));
            line(out, format_args!("{} {low} {high} {} 0", index + 1, listed(tags)));
        }
    }
    line(out, format_args!("$EndEntities"));
}

/// Writes all nodes as those of the first volume.
fn write_nodes(out: &mut String, mesh: &TetMesh) {
    let count = mesh.nodes.len();
    line(out, format_args!("$Nodes\n1 {count} 1 {count}\n3 1 0 {count}"));
    for tag in 1..=count {
        line(out, format_args!("{tag}"));
    }
    for [x, y, z] in &mesh.nodes {
        line(out, format_args!("{x:?} {y:?} {z:?}"));
    }
    line(out, format_args!("$EndNodes"));
}

/// Writes elements; each entry has the dimension, Gmsh's element type and the entities.
fn write_elements(out: &mut String, of: [(usize, usize, &Entities); 3]) {
    let blocks: usize = of.iter().map(|(_, _, entities)| entities.len()).sum();
    let members = of.iter().flat_map(|(_, _, entities)| entities.values());
    let count: usize = members.map(Vec::len).sum();
    line(out, format_args!("$Elements\n{blocks} {count} 1 {count}"));
    let mut tag = 0;
    for (dimension, kind, entities) in of {
        for (index, members) in entities.values().enumerate() {
            line(out, format_args!("{dimension} {} {kind} {}", index + 1, members.len()));
            for nodes in members {
                tag += 1;
                let nodes: Vec<String> = nodes.iter().map(u32::to_string).collect();
                line(out, format_args!("{tag} {}", nodes.join(" ")));
            }
        }
    }
    line(out, format_args!("$EndElements"));
}

/// Adds a line; writing to a string cannot fail.
fn line(out: &mut String, text: std::fmt::Arguments) {
    let _ = out.write_fmt(text);
    out.push('\n');
}

/// Allows at most 127 characters (Gmsh), without quotes and control characters.
fn check_name(name: &str) -> Result<(), MeshError> {
    let fail = |why| Err(MeshError::Name { name: name.to_string(), why });
    if name.is_empty() || name.len() > 127 {
        return fail("it must have 1 to 127 characters");
    }
    if name.contains(|c: char| c == '"' || c.is_control()) {
        return fail("quotes and control characters are not allowed");
    }
    Ok(())
}
