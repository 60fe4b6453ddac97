//! Conversion of four-node to ten-node elements, with mid-side nodes on the exact curved surfaces.

use crate::mesh::error::MeshError;
use crate::mesh::measure::{least_jacobian, straight_volume};
use crate::mesh::node_order::EDGES;
use crate::mesh::select::faces_on;
use crate::mesh::surface::Surface;
use crate::mesh::tet_mesh::{Elements, Face, TetMesh};
use crate::mesh::topology::surface;
use nalgebra::Vector3;

/// A ten-node mesh, and the number of mid-side nodes that are not on their curved surface because
/// an element would fold.
#[derive(Clone, Debug, PartialEq)]
pub struct Elevated {
    pub mesh: TetMesh,
    pub moved_back: usize,
}

/// Smallest Jacobian of an element, relative to that with straight edges; below it mid-side
/// nodes are moved back.
const LEAST_JACOBIAN: f64 = 0.1;

/// Largest distance of a corner on a curved surface, divided by the mesh's size.
const ON_SURFACE: f64 = 1e-7;

/// Adds a node on every edge. Those on edges of boundary faces on one of `curved` are
/// projected onto it, those on two of them onto both.
///
/// Node sets that share a name with a surface set become the nodes of its faces; other node sets
/// gain the middle of each edge whose two ends they contain.
///
/// # Errors
/// [`MeshError::AlreadyQuadratic`]; [`MeshError::TooLarge`] if the nodes cannot be numbered.
pub fn elevate(mesh: &TetMesh, curved: &[Surface]) -> Result<Elevated, MeshError> {
    let boundary = surface(mesh);
    let on = |shape: &Surface| faces_on(mesh, &boundary, shape, ON_SURFACE * mesh.size());
    let curved: Vec<_> = curved.iter().map(|shape| (*shape, on(shape))).collect();
    elevate_faces(mesh, &curved)
}

/// As [`elevate`], with every layer of cells curved about the X axis, also inside the body: an edge's node is at the mean
/// radius, angle and x of its ends. Thus no element folds if a layer is thinner than the arc height of a cell. No node may be on
/// the axis, and no edge may cross it.
///
/// # Errors
/// Those of [`elevate`].
pub fn elevate_about_x(mesh: &TetMesh) -> Result<Elevated, MeshError> {
    elevate_by(mesh, &[], |a, b| {
        let [from, to] = [a, b].map(|end| libm::hypot(end.y, end.z));
        // The mean angle is that of the sum of both directions.
        let [y, z] = [a.y / from + b.y / to, a.z / from + b.z / to];
        let radius = 0.5 * (from + to) / libm::hypot(y, z);
        Vector3::new(0.5 * (a.x + b.x), radius * y, radius * z)
    })
}

/// As [`elevate`], for surfaces with the faces on each.
///
/// # Errors
/// Those of [`elevate`].
pub fn elevate_faces(
    mesh: &TetMesh,
    curved: &[(Surface, Vec<Face>)],
) -> Result<Elevated, MeshError> {
    elevate_by(mesh, curved, |a, b| (a + b) * 0.5)
}

/// As [`elevate`], from given positions of the mid-side nodes that are on no surface.
fn elevate_by(
    mesh: &TetMesh,
    curved: &[(Surface, Vec<Face>)],
    middle: impl Fn(Vector3<f64>, Vector3<f64>) -> Vector3<f64>,
) -> Result<Elevated, MeshError> {
    let Elements::Linear(list) = &mesh.elements else {
        return Err(MeshError::AlreadyQuadratic);
    };
    let mut edges: Vec<[u32; 2]> = Vec::with_capacity(6 * list.len());
    for corners in list {
        edges.extend(EDGES.map(|[a, b]| sorted(corners[a], corners[b])));
    }
    edges.sort_unstable();
    edges.dedup();
    let first = mesh.nodes.len() as u32;
    if first.checked_add(u32::try_from(edges.len()).unwrap_or(u32::MAX)).is_none() {
        return Err(MeshError::TooLarge { count: mesh.nodes.len() + edges.len() });
    }
    // Every edge is in the list.
    let middle_of = |a: u32, b: u32| edges.binary_search(&sorted(a, b)).unwrap_or(0);

    let straight: Vec<Vector3<f64>> =
        edges.iter().map(|&[a, b]| (mesh.point(a) + mesh.point(b)) * 0.5).collect();
    let mut on: Vec<Vec<usize>> = vec![Vec::new(); edges.len()];
    for (index, (_, faces)) in curved.iter().enumerate() {
        for &face in faces {
            let [a, b, c] = mesh.face_corners(face);
            for edge in [middle_of(a, b), middle_of(b, c), middle_of(c, a)] {
                if !on[edge].contains(&index) {
                    on[edge].push(index);
                }
            }
        }
    }
    let free = edges.iter().map(|&[a, b]| middle(mesh.point(a), mesh.point(b)));
    let mut middles: Vec<Vector3<f64>> = free
        .zip(&on)
        .map(|(place, on)| onto_all(place, &on.iter().map(|&i| curved[i].0).collect::<Vec<_>>()))
        .collect();

    let quadratic: Vec<[u32; 10]> = list
        .iter()
        .map(|&corners| {
            let mut nodes = [0; 10];
            nodes[..4].copy_from_slice(&corners);
            for (middle, [a, b]) in EDGES.into_iter().enumerate() {
                nodes[4 + middle] = first + middle_of(corners[a], corners[b]) as u32;
            }
            nodes
        })
        .collect();
    let moved_back = unfold(mesh, &quadratic, &straight, &mut middles);

    let mut elevated = mesh.clone();
    elevated.elements = Elements::Quadratic(quadratic);
    elevated.nodes.extend(middles.iter().map(|&place| <[f64; 3]>::from(place)));
    for (name, set) in &mut elevated.node_sets {
        if !mesh.surface_sets.contains_key(name) {
            let mut holds = vec![false; mesh.nodes.len()];
            set.iter().for_each(|&node| holds[node as usize] = true);
            let both = |[a, b]: &[u32; 2]| holds[*a as usize] && holds[*b as usize];
            let within = (0..edges.len()).filter(|&edge| both(&edges[edge]));
            set.extend(within.map(|edge| first + edge as u32));
        }
    }
    for (name, faces) in &mesh.surface_sets {
        if mesh.node_sets.contains_key(name) {
            elevated.node_sets.insert(name.clone(), elevated.nodes_of_faces(faces));
        }
    }
    Ok(Elevated { mesh: elevated, moved_back })
}

fn sorted(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Alternating projection onto several surfaces; they intersect at large angles, so it converges fast.
fn onto_all(place: Vector3<f64>, surfaces: &[Surface]) -> Vector3<f64> {
    const ROUNDS: usize = 60;
    let mut place = place;
    let rounds = if surfaces.len() > 1 { ROUNDS } else { 1 };
    for _ in 0..rounds {
        for surface in surfaces {
            place = surface.project(place);
        }
    }
    place
}

/// Moves mid-side nodes of elements that are folded or nearly so half way back to their edges,
/// repeatedly, and finally onto the edge. Returns the number of moved nodes.
fn unfold(
    mesh: &TetMesh,
    elements: &[[u32; 10]],
    straight: &[Vector3<f64>],
    middles: &mut [Vector3<f64>],
) -> usize {
    const HALVINGS: usize = 4;
    let first = mesh.nodes.len();
    let mut moved = vec![false; middles.len()];
    for round in 0..=HALVINGS {
        let mut bad = vec![false; middles.len()];
        for nodes in elements {
            let point = |node: u32| match (node as usize).checked_sub(first) {
                Some(middle) => middles[middle],
                None => mesh.point(node),
            };
            let points = nodes.map(point);
            let whole = 6.0 * straight_volume([points[0], points[1], points[2], points[3]]);
            if least_jacobian(&points) < LEAST_JACOBIAN * whole {
                nodes[4..].iter().for_each(|&node| bad[node as usize - first] = true);
            }
        }
        for middle in (0..middles.len()).filter(|&middle| bad[middle]) {
            if middles[middle] != straight[middle] {
                moved[middle] = true;
                let part = if round < HALVINGS { 0.5 } else { 0.0 };
                middles[middle] = straight[middle] + (middles[middle] - straight[middle]) * part;
            }
        }
    }
    moved.into_iter().filter(|&moved| moved).count()
}
