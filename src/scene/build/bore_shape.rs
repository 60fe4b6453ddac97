//! Shape of a bore in its mesh: cylinder, out-of-roundness, curvature of edges.
//!
//! Fits are micrometres, as are errors of a mesh. The contact of ten-node elements is at mid-side nodes, so that
//! straight edges make a bore smaller by most of their sagitta.

use crate::ch2_housing::bore_contact::Frame;
use crate::kinematics::{Pose, euler};
use crate::mesh::cylinder_fit::{FittedCylinder, fit_cylinder};
use crate::mesh::measure::face_normal;
use crate::mesh::quadratic::{Elevated, elevate_faces};
use crate::mesh::select::faces_on;
use crate::mesh::topology::surface;
use crate::mesh::{Face, MeshError, Order, TetMesh};
use crate::scene::build::solid_mesh::ON_SURFACE;
use crate::scene::resolve::housing_scene::HousedScene;
use crate::scene::resolve::solid_scene::{MeshRequest, SetPlace};
use crate::solids::condensation::is_under;
use nalgebra::Vector3;
use std::collections::BTreeSet;

/// Largest distance of bore nodes from its cylinder, as a fraction of the radius. Bores for bearings have tolerances up
/// to IT7 of ISO 286, 30 um at a diameter of 71 mm, and are out of round by half of that at most: 0.4 thousandths of
/// the radius. Beyond that it is an error of the mesh.
pub const LARGEST_OUT_OF_ROUND: f64 = 5e-4;

/// Negligible out-of-roundness, m: the race penetrates steel by as much under 2.5 MPa, and coordinates with six
/// decimals of a millimetre are ten times better.
pub const ROUND: f64 = 1e-8;

/// Largest distance of mid-side nodes from their arcs, as a fraction of the sagitta: 1 for straight edges, 0 for curved
/// ones.
pub const LARGEST_MISSING: f64 = 0.25;

/// The bore of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct BorePlace {
    /// Surface set.
    pub set: String,
    /// Nominal pose of the outer race.
    pub nominal: Pose,
    /// Width of the race, m; `None`: as wide as the bore.
    pub width: Option<f64>,
}

impl BorePlace {
    pub fn of(scene: &HousedScene) -> BorePlace {
        let [x, y, z, tilt_y, tilt_z] = scene.bearing.outer_race;
        let orientation = euler::quaternion(0.0, tilt_y, tilt_z);
        let nominal = Pose { position: Vector3::new(x, y, z), orientation };
        BorePlace { set: scene.housing.bore.clone(), nominal, width: scene.housing.width }
    }

    /// The axis of the race, a unit vector.
    pub fn axis(&self) -> Vector3<f64> {
        Vector3::from(Frame::new(&self.nominal).to_body[0])
    }

    /// The cylinder through the corners of `faces` under the race; through all, if there are few.
    pub fn corner_cylinder(&self, mesh: &TetMesh, faces: &[Face]) -> Option<FittedCylinder> {
        /// Twice the unknowns of a cylinder.
        const FEW: usize = 10;
        let corners: BTreeSet<u32> = faces.iter().flat_map(|&f| mesh.face_corners(f)).collect();
        let places: Vec<Vector3<f64>> = corners.into_iter().map(|node| mesh.point(node)).collect();
        let frame = Frame::new(&self.nominal);
        let width = self.width.unwrap_or(f64::INFINITY);
        let under = |place: &&Vector3<f64>| is_under(frame.seen((**place).into())[0], width);
        let near: Vec<Vector3<f64>> = places.iter().filter(under).copied().collect();
        fit_cylinder(if near.len() < FEW { &places } else { &near }, self.axis())
    }
}

/// Faces with one common normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flat {
    /// m².
    pub area: f64,
    /// Outward, a unit vector.
    pub normal: [f64; 3],
}

/// Returns the area and normal if a set of faces is flat and so no part of a bore.
pub fn flat(mesh: &TetMesh, faces: &[Face]) -> Option<Flat> {
    /// Largest relative difference of the vector area of a flat set: far more than rounding of printed nodes, far less
    /// than the 3e-3 of an arc of 15 degrees.
    const FLAT: f64 = 1e-4;
    let normals = faces.iter().map(|face| 0.5 * face_normal(mesh, *face));
    let area: f64 = normals.clone().map(|normal| normal.norm()).sum();
    let together: Vector3<f64> = normals.sum();
    let (length, is_flat) = (together.norm(), together.norm() >= (1.0 - FLAT) * area);
    // Zeros without a sign.
    let normal = (together / length).map(|part| part + 0.0).into();
    (length > 0.0 && is_flat).then_some(Flat { area, normal })
}

/// Mid-side nodes of a bore's edges compared with the arcs between their corners.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MidSideNodes {
    /// Number of edges with both corners on the cylinder.
    pub count: usize,
    /// Largest sagitta, m: L²/8R of an edge of length L.
    pub sagitta: f64,
    /// Largest distance of a mid-side node inside its arc, m.
    pub inside: f64,
    /// Mean distance inside the arcs over the mean sagitta: 1 for straight edges.
    pub missing: f64,
}

impl MidSideNodes {
    /// Returns whether the mesh has straight edges along arcs of a relevant sagitta.
    pub fn straight(&self) -> bool {
        self.sagitta > ROUND && self.missing > LARGEST_MISSING
    }
}

/// Mid-side nodes of `faces` of ten-node elements. Arcs go through the corners, with their rounding.
pub fn middle_nodes(mesh: &TetMesh, faces: &[Face], cylinder: &FittedCylinder) -> MidSideNodes {
    let mut found = MidSideNodes::default();
    if mesh.order() == Order::Linear {
        return found;
    }
    let mut seen = BTreeSet::new();
    let (mut chords, mut insides) = (0.0, 0.0);
    let tolerance = LARGEST_OUT_OF_ROUND * cylinder.radius;
    for face in faces_on(mesh, faces, &cylinder.surface(), tolerance) {
        let nodes: Vec<u32> = mesh.face_nodes(face).collect();
        for side in 0..3 {
            let middle = nodes[3 + side];
            if !seen.insert(middle) {
                continue;
            }
            let [a, b] = [nodes[side], nodes[(side + 1) % 3]].map(|node| mesh.point(node));
            let arc = 0.5 * (cylinder.outside(a) + cylinder.outside(b));
            let sagitta = arc - cylinder.outside((a + b) * 0.5);
            let inside = arc - cylinder.outside(mesh.point(middle));
            found.count += 1;
            found.sagitta = found.sagitta.max(sagitta);
            found.inside = found.inside.max(inside);
            chords += sagitta;
            insides += inside;
        }
    }
    if chords > 0.0 {
        found.missing = insides / chords;
    }
    found
}

/// Ten-node elements from four-node ones, with the mid-side nodes of the bore's edges on the cylinder through its
/// corners, and a note. If the bore is not a cylinder, edges stay straight.
///
/// # Errors
///
/// Those of [`elevate`](crate::mesh::quadratic::elevate).
pub fn elevate_with_bore(
    mesh: &TetMesh,
    request: &MeshRequest,
    place: &BorePlace,
) -> Result<(Elevated, Option<String>), MeshError> {
    let faces = bore_faces(mesh, request, &place.set);
    let Some(cylinder) = place.corner_cylinder(mesh, &faces) else {
        return Ok((elevate_faces(mesh, &[])?, None));
    };
    let tolerance = LARGEST_OUT_OF_ROUND * cylinder.radius;
    let on = faces_on(mesh, &faces, &cylinder.surface(), tolerance);
    let elevated = elevate_faces(mesh, &[(cylinder.surface(), on.clone())])?;
    // Corners and sides of elements have not changed, and so are the faces.
    let middles = middle_nodes(&elevated.mesh, &on, &cylinder);
    let note = (middles.count > 0).then(|| {
        let with_race_fixed = match elevated.moved_back {
            0 => String::new(),
            count => format!(", but for {count} where an element would have folded"),
        };
        format!(
            "the file's four-node elements were raised to ten nodes: the {} mid-side nodes of \"{}\" were \
             put on the cylinder of radius {:.4} mm through its corners, up to {:.1} um off their \
             chords{with_race_fixed}; other edges are straight",
            middles.count,
            place.set,
            1e3 * cylinder.radius,
            1e6 * middles.sagitta
        )
    });
    Ok((elevated, note))
}

/// Faces of the bore's set, also if the scene makes the set by geometry; empty if there is none.
fn bore_faces(mesh: &TetMesh, request: &MeshRequest, set: &str) -> Vec<Face> {
    if let Some(faces) = mesh.surface_sets.get(set) {
        return faces.clone();
    }
    let Some(made) = request.sets.iter().find(|made| made.name == set) else {
        return Vec::new();
    };
    let tolerance = made.tolerance.unwrap_or(ON_SURFACE * mesh.size());
    match &made.place {
        SetPlace::Surface(on) => faces_on(mesh, &surface(mesh), on, tolerance),
        SetPlace::Box { .. } => Vec::new(),
    }
}
