//! Fields of a solid as VTK files for ParaView: displacement, velocity, stress, contact force on the bore.

pub mod bore;
pub mod size;

use crate::kinematics::strain::{Sym3, von_mises};
use crate::kinematics::vec3::Vec3;
use crate::mesh::write::{Field, write_pvd, write_vtu};
use crate::mesh::{MeshError, TetMesh};
use crate::output::atomic::{WriteError, write_atomic};
use crate::solids::error::StepFailure;
use crate::solids::model::SolidModel;
use crate::solids::rubber::checkpoint::RubberState;
use crate::solids::rubber::measures;
use crate::solids::rubber::model::RubberModel;
use crate::solids::stress::{element_stresses, nodal_stresses};
use bore::{BoreNodeState, on_nodes};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Folder of the `.vtu` files, and their list next to it.
pub const FOLDER: &str = "fields";
pub const LIST: &str = "fields.pvd";

#[derive(Debug, Error)]
pub enum FieldError {
    #[error(transparent)]
    Mesh(#[from] MeshError),
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Stress of a deformed solid, Pa.
#[derive(Clone, Debug, PartialEq)]
pub struct Stresses {
    /// Cauchy stress of each element, volume average over its integration points: XX YY ZZ XY YZ ZX.
    pub cell: Vec<Sym3>,
    pub cell_von_mises: Vec<f64>,
    /// Cauchy stress at nodes, from [`nodal_stresses`].
    pub nodal: Vec<Sym3>,
    /// Von Mises stress at nodes, from the nodal stress.
    pub node_von_mises: Vec<f64>,
}

impl Stresses {
    pub fn new(cell: Vec<Sym3>, nodal: Vec<Sym3>) -> Stresses {
        Stresses {
            cell_von_mises: cell.iter().map(von_mises).collect(),
            node_von_mises: nodal.iter().map(von_mises).collect(),
            nodal,
            cell,
        }
    }
}

/// Stresses of a model at displacements in m, one per node.
pub fn stresses(model: &SolidModel, displacement: &[Vec3]) -> Stresses {
    Stresses::new(element_stresses(model, displacement), nodal_stresses(model, displacement))
}

/// Stresses of a rubber solid.
///
/// # Errors
/// An inverted element.
pub fn rubber_stresses(model: &RubberModel, state: &RubberState) -> Result<Stresses, StepFailure> {
    let found = measures::stresses(model, state)?;
    Ok(Stresses::new(found.cells, found.nodes))
}

/// Writes a `.vtu` file with displacement, velocity if present, stress, and for a housing the contact force and
/// pressure of the race at each node of its bore.
///
/// # Errors
/// A value that is not finite, a file that cannot be written.
pub fn write_fields(
    path: &Path,
    mesh: &TetMesh,
    displacement: &[Vec3],
    velocity: Option<&[Vec3]>,
    stresses: &Stresses,
    bore: Option<&[BoreNodeState]>,
) -> Result<(), FieldError> {
    let mut points =
        vec![Field { name: "displacement", components: 3, values: displacement.as_flattened() }];
    if let Some(velocity) = velocity {
        points.push(Field { name: "velocity", components: 3, values: velocity.as_flattened() });
    }
    let nodal = &stresses.node_von_mises;
    points.push(Field { name: "von_mises_nodal", components: 1, values: nodal });
    let of_bore = bore.map(|bore| on_nodes(bore, mesh.nodes.len()));
    if let Some((forces, pressure)) = &of_bore {
        let values = forces.as_flattened();
        points.push(Field { name: "contact_force", components: 3, values });
        points.push(Field { name: "contact_pressure", components: 1, values: pressure });
    }
    let cells = [
        Field { name: "von_mises", components: 1, values: &stresses.cell_von_mises },
        Field { name: "cauchy_stress", components: 6, values: stresses.cell.as_flattened() },
    ];
    Ok(write_atomic(path, &write_vtu(mesh, &points, &cells)?)?)
}

/// Content of a `.vtu` file with the mesh and, for each of its sets, a field that is one at its nodes or in its elements and zero elsewhere.
///
/// # Errors
/// A set name that the format cannot hold.
pub fn mesh_with_sets(mesh: &TetMesh) -> Result<Vec<u8>, MeshError> {
    let marked = |count: usize, members: &[u32]| {
        let mut values = vec![0.0; count];
        members.iter().for_each(|member| values[*member as usize] = 1.0);
        values
    };
    let at_nodes = |members: &[u32]| marked(mesh.nodes.len(), members);
    let surfaces = mesh.surface_sets.iter();
    let mut points: BTreeMap<&str, Vec<f64>> = surfaces
        .map(|(name, faces)| (name.as_str(), at_nodes(&mesh.nodes_of_faces(faces))))
        .collect();
    points.extend(mesh.node_sets.iter().map(|(name, set)| (name.as_str(), at_nodes(set))));
    let cells: Vec<(&str, Vec<f64>)> = mesh
        .element_sets
        .iter()
        .map(|(name, set)| (name.as_str(), marked(mesh.elements.len(), set)))
        .collect();
    let field = |(name, values)| Field { name, components: 1, values };
    let points: Vec<Field> =
        points.iter().map(|(name, values)| field((*name, values.as_slice()))).collect();
    let cells: Vec<Field> =
        cells.iter().map(|(name, values)| field((*name, values.as_slice()))).collect();
    write_vtu(mesh, &points, &cells)
}

/// Writes the `.vtu` file of a mode shape.
///
/// # Errors
/// As [`write_fields`].
pub fn write_mode(path: &Path, mesh: &TetMesh, shape: &[Vec3]) -> Result<(), FieldError> {
    let points = [Field { name: "mode_shape", components: 3, values: shape.as_flattened() }];
    Ok(write_atomic(path, &write_vtu(mesh, &points, &[])?)?)
}

/// Name of file number `index`, relative to the results folder.
pub fn file_name(kind: &str, index: usize) -> String {
    format!("{FOLDER}/{kind}_{index:06}.vtu")
}

/// Writes the list that ParaView opens: times (s), or frequencies of modes (Hz), and file names.
///
/// # Errors
/// As [`write_fields`].
pub fn write_list(folder: &Path, steps: &[(f64, String)]) -> Result<PathBuf, FieldError> {
    let steps: Vec<(f64, &str)> = steps.iter().map(|(time, name)| (*time, name.as_str())).collect();
    let path = folder.join(LIST);
    write_atomic(&path, write_pvd(&steps)?.as_bytes())?;
    Ok(path)
}
