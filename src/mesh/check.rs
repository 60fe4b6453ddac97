//! Mesh checks: all faults of a mesh with numbers and positions. Nothing is repaired.

use crate::mesh::error::Fault;
use crate::mesh::measure::{least_jacobian, straight_volume, volume};
use crate::mesh::node_order::EDGES;
use crate::mesh::quality::shape;
use crate::mesh::repair::coincident_nodes;
use crate::mesh::tet_mesh::{Elements, Face, TetMesh};
use crate::mesh::topology::{Union, sorted_faces};
use nalgebra::Vector3;
use std::fmt;

/// Limits of the mesh checks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest aspect ratio of an element (1 for a regular tetrahedron).
    pub aspect: f64,
    /// Distance of coincident nodes, divided by the size of the mesh.
    pub duplicate: f64,
    /// Intended enclosed cavities.
    pub cavities: usize,
    /// Intended separate bodies.
    pub bodies: usize,
}

impl Default for Limits {
    fn default() -> Limits {
        Limits { aspect: 1e3, duplicate: 1e-8, cavities: 0, bodies: 1 }
    }
}

/// All faults of a mesh; displayed in one line.
#[derive(Clone, Debug, PartialEq)]
pub struct Faults(pub Vec<Fault>);

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all: Vec<String> = self.0.iter().map(Fault::to_string).collect();
        write!(f, "{}", all.join("; "))
    }
}

impl std::error::Error for Faults {}

/// Largest distance of a mid-side node from the middle of its edge, divided by the edge's length. The
/// arc height of a quarter circle over its chord is 0.21.
const FARTHEST_MID_SIDE: f64 = 0.25;

/// Checks a mesh.
///
/// # Errors
/// [`Faults`] with all results of [`faults`].
pub fn check(mesh: &TetMesh, limits: &Limits) -> Result<(), Faults> {
    let found = faults(mesh, limits);
    if found.is_empty() { Ok(()) } else { Err(Faults(found)) }
}

/// Faults of `mesh`, each kind once with its number and its worst or first position.
pub fn faults(mesh: &TetMesh, limits: &Limits) -> Vec<Fault> {
    let mut found = Vec::new();
    found.extend(inverted(mesh));
    let turned = !found.is_empty();
    found.extend(folded(mesh));
    found.extend(slivers(mesh, limits.aspect));
    found.extend(mid_sides(mesh));
    found.extend(duplicates(mesh, limits.duplicate * mesh.size()));
    found.extend(unreferenced(mesh));
    let faces = sorted_faces(mesh);
    found.extend(overlapping(mesh, &faces, turned));
    found.extend(boundary(mesh, &faces, limits.cavities));
    found.extend(bodies(mesh, &faces, limits.bodies));
    found.extend(empty_sets(mesh));
    found
}

fn centre(mesh: &TetMesh, element: u32) -> [f64; 3] {
    let [a, b, c, d] = mesh.corner_points(element as usize);
    ((a + b + c + d) / 4.0).into()
}

/// Number of elements for which `bad` returns a value, and the one with the largest value.
fn worst(mesh: &TetMesh, bad: impl Fn(usize) -> Option<f64>) -> Option<(usize, u32, f64)> {
    let mut result: Option<(usize, u32, f64)> = None;
    for index in 0..mesh.elements.len() {
        if let Some(value) = bad(index) {
            let (count, element, most) = result.unwrap_or((0, index as u32, value));
            let next = if value > most { (index as u32, value) } else { (element, most) };
            result = Some((count + 1, next.0, next.1));
        }
    }
    result
}

fn inverted(mesh: &TetMesh) -> Option<Fault> {
    let bad = |index: usize| {
        let points = mesh.corner_points(index);
        let volume = straight_volume(points);
        // Rounding error of the volume, a difference of products of this size.
        let longest =
            EDGES.map(|[a, b]| (points[b] - points[a]).norm()).into_iter().fold(0.0, f64::max);
        let rounding = 1e-14 * longest * longest * longest;
        let sound = volume > rounding;
        (!sound).then_some(-volume)
    };
    worst(mesh, bad).map(|(count, element, value)| Fault::Inverted {
        count,
        of: mesh.elements.len(),
        element: element.into(),
        at: centre(mesh, element),
        volume: -value,
    })
}

fn folded(mesh: &TetMesh) -> Option<Fault> {
    let Elements::Quadratic(list) = &mesh.elements else { return None };
    let bad = |index: usize| {
        let least = least_jacobian(&list[index].map(|node| mesh.point(node)));
        let corners_in_order = straight_volume(mesh.corner_points(index)) > 0.0;
        let open = least > 0.0;
        (corners_in_order && !open).then(|| -least / (6.0 * volume(mesh, index).abs()))
    };
    worst(mesh, bad).map(|(count, element, value)| Fault::Folded {
        count,
        element: element.into(),
        at: centre(mesh, element),
        ratio: -value,
    })
}

fn slivers(mesh: &TetMesh, limit: f64) -> Option<Fault> {
    let bad = |index: usize| {
        let aspect = shape(mesh.corner_points(index)).aspect;
        let allowed = aspect <= limit;
        (!allowed).then_some(if aspect.is_nan() { f64::INFINITY } else { aspect })
    };
    worst(mesh, bad).map(|(count, element, aspect)| Fault::Sliver {
        count,
        element: element.into(),
        at: centre(mesh, element),
        aspect,
        limit,
    })
}

fn mid_sides(mesh: &TetMesh) -> Option<Fault> {
    let Elements::Quadratic(list) = &mesh.elements else { return None };
    let mut found: Option<(usize, u32, u32, f64)> = None;
    for (element, nodes) in list.iter().enumerate() {
        for (middle, [a, b]) in EDGES.into_iter().enumerate() {
            let [p, q, m] = [nodes[a], nodes[b], nodes[4 + middle]].map(|node| mesh.point(node));
            let off = (m - (p + q) * 0.5).norm() / (q - p).norm();
            let near = off <= FARTHEST_MID_SIDE;
            if !near {
                let first = found.unwrap_or((0, element as u32, nodes[4 + middle], off));
                found = Some((first.0 + 1, first.1, first.2, first.3));
            }
        }
    }
    found.map(|(count, element, node, off)| {
        let [element, node] = [element, node].map(u64::from);
        Fault::MidSide { count, element, node, off }
    })
}

fn duplicates(mesh: &TetMesh, tolerance: f64) -> Option<Fault> {
    let first_at = coincident_nodes(&mesh.nodes, tolerance);
    let pairs = || (0..mesh.nodes.len() as u32).filter(|&node| first_at[node as usize] != node);
    pairs().next().map(|second| Fault::DuplicateNodes {
        count: pairs().count(),
        first: first_at[second as usize].into(),
        second: second.into(),
        at: mesh.nodes[second as usize],
        tolerance,
    })
}

fn unreferenced(mesh: &TetMesh) -> Option<Fault> {
    let mut used = vec![false; mesh.nodes.len()];
    for &node in mesh.elements.all_nodes() {
        used[node as usize] = true;
    }
    let first = used.iter().position(|&used| !used)?;
    let count = used.iter().filter(|&&used| !used).count();
    Some(Fault::UnreferencedNodes { count, first: first as u64 })
}

/// Returns whether two faces with the same corners have the same orientation.
fn same_direction(mesh: &TetMesh, a: Face, b: Face) -> bool {
    let [a, b] = [mesh.face_corners(a), mesh.face_corners(b)];
    (0..3).any(|turn| (0..3).all(|i| a[i] == b[(i + turn) % 3]))
}

fn overlapping(mesh: &TetMesh, faces: &[([u32; 3], Face)], turned: bool) -> Option<Fault> {
    let wrong = |owners: &&[([u32; 3], Face)]| match owners {
        [_] => false,
        // With inverted elements, which are reported, orientations are meaningless.
        [a, b] => !turned && same_direction(mesh, a.1, b.1),
        _ => true,
    };
    let groups = || faces.chunk_by(|a, b| a.0 == b.0).filter(wrong);
    groups().next().map(|owners| Fault::Overlapping {
        count: groups().count(),
        element: owners[0].1.element.into(),
        at: centre(mesh, owners[0].1.element),
    })
}

/// Edges of the surface that do not join two faces, and cavities: closed parts with inward orientation.
fn boundary(mesh: &TetMesh, faces: &[([u32; 3], Face)], cavities: usize) -> Vec<Fault> {
    let alone = |owners: &&[([u32; 3], Face)]| owners.len() == 1;
    let surface: Vec<Face> =
        faces.chunk_by(|a, b| a.0 == b.0).filter(alone).map(|owners| owners[0].1).collect();
    let mut edges = Vec::with_capacity(3 * surface.len());
    for (index, &face) in surface.iter().enumerate() {
        let [a, b, c] = mesh.face_corners(face);
        for (p, q) in [(a, b), (b, c), (c, a)] {
            edges.push((p.min(q), p.max(q), index as u32));
        }
    }
    edges.sort_unstable();
    let mut found = Vec::new();
    let mut parts = Union::new(surface.len());
    let mut open = 0;
    let mut first_open = None;
    for around in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        for pair in around.windows(2) {
            parts.join(pair[0].2, pair[1].2);
        }
        if around.len() != 2 {
            open += 1;
            first_open.get_or_insert((around[0].0, around[0].1));
        }
    }
    if let Some((first, second)) = first_open {
        let at = ((mesh.point(first) + mesh.point(second)) / 2.0).into();
        let [first, second] = [first, second].map(u64::from);
        found.push(Fault::NonManifold { count: open, first, second, at });
    }
    // Volume enclosed by each closed part by the divergence theorem: negative for a cavity. Coordinates
    // relative to the mesh's corner avoid cancellation far from the origin.
    let origin = Vector3::from(mesh.bounding_box().0);
    let mut volumes = vec![0.0; surface.len()];
    let mut sizes = vec![0usize; surface.len()];
    for (index, &face) in surface.iter().enumerate() {
        let [a, b, c] = mesh.face_corners(face).map(|node| mesh.point(node) - origin);
        let root = parts.root(index as u32) as usize;
        volumes[root] += a.dot(&b.cross(&c)) / 6.0;
        sizes[root] += 1;
    }
    let hollow: Vec<usize> = (0..surface.len()).filter(|&root| volumes[root] < 0.0).collect();
    let total: f64 = volumes.iter().sum();
    if hollow.len() > cavities && total > 0.0 {
        let first = hollow[0];
        found.push(Fault::Cavity {
            count: hollow.len(),
            faces: sizes[first],
            at: mesh.nodes[mesh.face_corners(surface[first])[0] as usize],
            volume: -volumes[first],
        });
    }
    found
}

fn bodies(mesh: &TetMesh, faces: &[([u32; 3], Face)], allowed: usize) -> Option<Fault> {
    let mut parts = Union::new(mesh.elements.len());
    for owners in faces.chunk_by(|a, b| a.0 == b.0) {
        for pair in owners.windows(2) {
            parts.join(pair[0].1.element, pair[1].1.element);
        }
    }
    let all = 0..mesh.elements.len() as u32;
    let roots: Vec<u32> = all.filter(|&element| parts.root(element) == element).collect();
    (roots.len() > allowed && roots.len() > 1).then(|| Fault::SeveralBodies {
        count: roots.len(),
        first: roots[0].into(),
        second: roots[1].into(),
    })
}

fn empty_sets(mesh: &TetMesh) -> Vec<Fault> {
    let nodes = mesh.node_sets.iter().map(|(name, set)| ("node", name, set.is_empty()));
    let elements = mesh.element_sets.iter().map(|(name, set)| ("element", name, set.is_empty()));
    let surfaces = mesh.surface_sets.iter().map(|(name, set)| ("surface", name, set.is_empty()));
    nodes
        .chain(elements)
        .chain(surfaces)
        .filter(|(_, _, empty)| *empty)
        .map(|(kind, name, _)| Fault::EmptySet { kind, name: name.clone() })
        .collect()
}
