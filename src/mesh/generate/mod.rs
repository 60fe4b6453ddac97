//! Mesh generators for the dissertation's parts: mapped blocks of hexahedra, cut into tetrahedra.
//!
//! Every generator returns a [`Solid`]: a four-node mesh with named surface sets, and the curved
//! surfaces it approximates, on which [`Solid::quadratic`] places mid-side nodes.
//! Dimensions are inputs, in m.
mod bushing;
mod cage;
mod grading;
mod hexahedra;
mod housing;
mod outline;
mod solids;
mod stepped;

pub use bushing::{Bushing, BushingMesh, Part, bushing};
pub use cage::{Cage, CageMesh, RailRelief};
pub use grading::{graded, uniform};
pub use housing::{Housing, HousingMesh, PillowBlock};
pub use solids::{ContactBlock, Ring, RingMesh, bar, block, contact_block, ring, shaft};
pub use stepped::{ShaftStep, stepped_shaft};

use crate::mesh::error::{MeshError, six_digits};
use crate::mesh::quadratic::{Elevated, elevate, elevate_about_x};
use crate::mesh::surface::Surface;
use crate::mesh::tet_mesh::TetMesh;
use crate::mesh::topology::surface;

/// A generated mesh and the curved boundary surfaces of the exact body.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    pub mesh: TetMesh,
    pub curved: Vec<Surface>,
}

/// Distance of generated nodes from their surfaces, divided by the mesh's size.
const ON_SURFACE: f64 = 1e-9;

impl Solid {
    /// The body in ten-node elements with mid-side nodes on the curved surfaces. In hollow bodies about the X axis all layers
    /// are curved if elements between straight ones would fold.
    ///
    /// # Errors
    /// As [`elevate`].
    pub fn quadratic(&self) -> Result<Elevated, MeshError> {
        let elevated = elevate(&self.mesh, &self.curved)?;
        if elevated.moved_back == 0 || !self.is_hollow_about_x() {
            return Ok(elevated);
        }
        let curved = elevate_about_x(&self.mesh)?;
        Ok(if curved.moved_back < elevated.moved_back { curved } else { elevated })
    }

    /// Returns whether the body is bounded by cylinders about the X axis and no node is on the axis.
    fn is_hollow_about_x(&self) -> bool {
        let about_x = |shape: &Surface| {
            matches!(shape, Surface::Cylinder { point, axis, .. }
                if point[1..] == [0.0; 2] && axis[1..] == [0.0; 2])
        };
        let innermost = self.mesh.nodes.iter().map(|node| libm::hypot(node[1], node[2]));
        let size = self.mesh.size();
        self.curved.iter().all(about_x)
            && innermost.fold(f64::INFINITY, f64::min) > ON_SURFACE * size
    }
}

/// Adds named surface sets to a generated mesh; surfaces with the same name are merged.
fn with_sets(
    mut mesh: TetMesh,
    sets: &[(&str, Surface)],
    curved: Vec<Surface>,
) -> Result<Solid, MeshError> {
    let boundary = surface(&mesh);
    let tolerance = ON_SURFACE * mesh.size();
    for (name, on) in sets {
        let before = mesh.surface_sets.remove(*name).unwrap_or_default();
        mesh.add_surface_set(name, &boundary, on, tolerance)?;
        let faces = mesh.surface_sets.entry((*name).to_string()).or_default();
        faces.extend(before);
        faces.sort_unstable();
        let nodes = mesh.nodes_of_faces(&mesh.surface_sets[*name]);
        mesh.node_sets.insert((*name).to_string(), nodes);
    }
    Ok(Solid { mesh, curved })
}

/// Refuses a length (m) outside the open interval from `low` to `high`.
fn between(what: &'static str, value: f64, low: f64, high: f64) -> Result<(), MeshError> {
    within(what, value, low, high, " m")
}

/// As [`between`], for a ratio.
fn ratio_between(what: &'static str, value: f64, low: f64, high: f64) -> Result<(), MeshError> {
    within(what, value, low, high, "")
}

fn within(
    what: &'static str,
    value: f64,
    low: f64,
    high: f64,
    unit: &'static str,
) -> Result<(), MeshError> {
    if value > low && value < high {
        return Ok(());
    }
    let [least, most] = [low, high].map(six_digits);
    let allowed = match high.is_finite() {
        true => format!("{least} to {most}{unit} (both excluded)"),
        false => format!("more than {least}{unit}"),
    };
    Err(MeshError::Dimension { what, value, unit, allowed })
}

/// Refuses a count outside `low..=MOST_DIVISIONS`.
fn divisions(what: &'static str, count: usize, low: usize) -> Result<(), MeshError> {
    const MOST_DIVISIONS: usize = 100_000;
    if (low..=MOST_DIVISIONS).contains(&count) {
        return Ok(());
    }
    let allowed = format!("{low} to {MOST_DIVISIONS}");
    Err(MeshError::Dimension { what, value: count as f64, unit: "", allowed })
}
