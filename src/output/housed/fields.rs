//! Fields of a housing under its bearing, and the table of its bore.

use crate::kinematics::vec3::{Vec3, dot};
use crate::mesh::TetMesh;
use crate::mesh::write::Field;
use crate::output::series::{Column, Series, SeriesError};
use crate::output::solid::fields::{FieldError, Stresses, write_fields_and};
use ndarray::Array2;
use std::path::Path;

/// A node of the bore and what the race does to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoreNodeState {
    pub node: u32,
    /// Undeformed, m.
    pub place: Vec3,
    /// m².
    pub area: f64,
    /// Into the race, m; negative is a gap.
    pub penetration: f64,
    /// On the node, N.
    pub force: Vec3,
}

/// Writes a `.vtu` with displacements, stresses and the force of the race on each node.
///
/// # Errors
/// A value that is not finite, a file that cannot be written.
pub fn write_housing_fields(
    path: &Path,
    mesh: &TetMesh,
    displacement: &[Vec3],
    velocity: Option<&[Vec3]>,
    stresses: &Stresses,
    bore: &[BoreNodeState],
) -> Result<(), FieldError> {
    let mut forces = vec![[0.0; 3]; mesh.nodes.len()];
    let mut pressure = vec![0.0; mesh.nodes.len()];
    for state in bore {
        forces[state.node as usize] = state.force;
        pressure[state.node as usize] = pressure_of(state);
    }
    let further = [
        Field { name: "contact_force", components: 3, values: forces.as_flattened() },
        Field { name: "contact_pressure", components: 1, values: &pressure },
    ];
    write_fields_and(path, mesh, displacement, velocity, stresses, &further)
}

fn pressure_of(state: &BoreNodeState) -> f64 {
    dot(state.force, state.force).sqrt() / state.area
}

/// One row a node: place, azimuth from +Y towards +Z, area, penetration, force, pressure.
///
/// # Errors
/// Never for these columns.
pub fn bore_series(bore: &[BoreNodeState]) -> Result<Series, SeriesError> {
    let columns = [
        ("x", "m"),
        ("y", "m"),
        ("z", "m"),
        ("azimuth", "deg"),
        ("area", "m^2"),
        ("penetration", "m"),
        ("force_x", "N"),
        ("force_y", "N"),
        ("force_z", "N"),
        ("pressure", "Pa"),
    ];
    let columns: Vec<Column> =
        columns.iter().map(|(name, unit)| Column::new(*name, *unit)).collect();
    let mut values = Vec::with_capacity(columns.len() * bore.len());
    for state in bore {
        let azimuth = libm::atan2(state.place[2], state.place[1]).to_degrees();
        values.extend(state.place);
        values.extend([azimuth, state.area, state.penetration]);
        values.extend(state.force);
        values.push(pressure_of(state));
    }
    let data = Array2::from_shape_vec((bore.len(), columns.len()), values)
        .expect("every node gives one value per column");
    Series::new(columns, data)
}
