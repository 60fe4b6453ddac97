//! Selection by geometry: nodes in a box or on a surface, boundary faces on a surface.

use crate::mesh::error::{MeshError, place, six_digits};
use crate::mesh::measure::face_normal;
use crate::mesh::surface::Surface;
use crate::mesh::tet_mesh::{Face, TetMesh};
use nalgebra::Vector3;
use std::fmt;

/// Region for the selection of nodes. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// A box between two corners, faces included.
    Box { low: [f64; 3], high: [f64; 3] },
    /// The neighbourhood of a surface, within `tolerance`.
    On { surface: Surface, tolerance: f64 },
}

impl Region {
    /// Distance of a point from the region, m; 0 inside.
    fn outside(&self, place: Vector3<f64>) -> f64 {
        match self {
            Region::Box { low, high } => {
                let off = |i: usize| (low[i] - place[i]).max(place[i] - high[i]).max(0.0);
                Vector3::new(off(0), off(1), off(2)).norm()
            }
            Region::On { surface, tolerance } => (surface.distance(place) - tolerance).max(0.0),
        }
    }
}

impl fmt::Display for Region {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Region::Box { low, high } => write!(f, "box {} to {}", place(low), place(high)),
            Region::On { surface, tolerance } => {
                write!(f, "{surface}, within {:e} m", six_digits(*tolerance))
            }
        }
    }
}

/// Nodes in a region, ascending.
pub fn nodes_in(mesh: &TetMesh, region: &Region) -> Vec<u32> {
    // `<=`, so that NaN selects nothing.
    let inside = |&node: &u32| region.outside(mesh.point(node)) <= 0.0;
    (0..mesh.nodes.len() as u32).filter(inside).collect()
}

/// Faces of `boundary` (from [`surface`](crate::mesh::topology::surface)) on
/// `surface`: corners within `tolerance` and normals along its own. The second condition
/// excludes a triangle of an end face with three corners on the rim.
pub fn faces_on(mesh: &TetMesh, boundary: &[Face], surface: &Surface, tolerance: f64) -> Vec<Face> {
    let lies_on = |&face: &Face| {
        let corners = mesh.face_corners(face).map(|node| mesh.point(node));
        let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
        let normal = face_normal(mesh, face).normalize();
        corners.iter().all(|&corner| surface.distance(corner) <= tolerance)
            && normal.dot(&surface.normal(centre)).abs() >= 0.7
    };
    boundary.iter().copied().filter(lies_on).collect()
}

impl TetMesh {
    /// Adds the node set `name` and returns its number of nodes.
    ///
    /// # Errors
    /// [`MeshError::EmptySet`] with the distance of the nearest node.
    pub fn add_node_set(&mut self, name: &str, region: &Region) -> Result<usize, MeshError> {
        let nodes = nodes_in(self, region);
        if nodes.is_empty() {
            return Err(self.empty_set(name, region));
        }
        let count = nodes.len();
        self.node_sets.insert(name.to_string(), nodes);
        Ok(count)
    }

    /// Adds the surface set `name` from faces of `boundary`, and the node set of its nodes.
    ///
    /// # Errors
    /// [`MeshError::EmptySet`] with the distance of the nearest node, [`MeshError::NoSurfaceThere`]
    /// if only nodes are on `surface`.
    pub fn add_surface_set(
        &mut self,
        name: &str,
        boundary: &[Face],
        surface: &Surface,
        tolerance: f64,
    ) -> Result<usize, MeshError> {
        let faces = faces_on(self, boundary, surface, tolerance);
        if faces.is_empty() {
            let region = Region::On { surface: *surface, tolerance };
            return Err(match nodes_in(self, &region).len() {
                0 => self.empty_set(name, &region),
                nodes => {
                    let (name, region) = (name.to_string(), region.to_string());
                    MeshError::NoSurfaceThere { name, region, nodes }
                }
            });
        }
        let count = faces.len();
        self.node_sets.insert(name.to_string(), self.nodes_of_faces(&faces));
        self.surface_sets.insert(name.to_string(), faces);
        Ok(count)
    }

    fn empty_set(&self, name: &str, region: &Region) -> MeshError {
        let distances = self.nodes.iter().map(|&p| region.outside(Vector3::from(p)));
        MeshError::EmptySet {
            name: name.to_string(),
            region: region.to_string(),
            nearest: distances.fold(f64::INFINITY, f64::min),
        }
    }
}
