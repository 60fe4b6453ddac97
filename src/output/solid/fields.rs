//! Fields of a solid as ParaView opens them: displacement, velocity, stress.

use crate::elements::tet4::{Tet4, relative};
use crate::elements::tet10::{POINTS, Tet10};
use crate::kinematics::strain::{Mat3, Sym3, cauchy, green_lagrange, volume_change};
use crate::kinematics::vec3::Vec3;
use crate::mesh::tet_mesh::Elements;
use crate::mesh::write::{Field, write_pvd, write_vtu};
use crate::mesh::{MeshError, TetMesh};
use crate::output::atomic::{WriteError, write_atomic};
use crate::solver::solid::model::{SolidProblem, corners};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Folder of the `.vtu` files, and the list of them beside it.
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
    /// Cauchy stress of each element, the mean over its points by volume: XX YY ZZ XY YZ ZX.
    pub cell: Vec<Sym3>,
    pub cell_von_mises: Vec<f64>,
    /// Von Mises stress at nodes: of the mean, by volume, of the elements around.
    pub node_von_mises: Vec<f64>,
}

/// Calls `visit` with element, undeformed volume and displacement gradient of every integration
/// point.
fn each_point(
    problem: &SolidProblem,
    displacement: &[Vec3],
    mut visit: impl FnMut(usize, f64, &Mat3),
) {
    match &problem.elements {
        Elements::Linear(list) => {
            for (index, nodes) in list.iter().enumerate() {
                let Ok(tet) = Tet4::new(&corners(&problem.nodes, nodes)) else { continue };
                let h = tet.displacement_gradient(&relative(&corners(displacement, nodes)));
                visit(index, tet.volume, &h);
            }
        }
        Elements::Quadratic(list) => {
            for (index, nodes) in list.iter().enumerate() {
                let Ok(tet) = Tet10::new(&corners(&problem.nodes, nodes)) else { continue };
                let moved = corners(displacement, nodes);
                for point in 0..POINTS {
                    let h = tet.displacement_gradient(point, &moved);
                    visit(index, tet.points[point].volume, &h);
                }
            }
        }
    }
}

/// Stresses at given displacements (m, one for each node).
pub fn stresses(problem: &SolidProblem, displacement: &[Vec3]) -> Stresses {
    let elements = &problem.elements;
    let mut cell = vec![[0.0; 6]; elements.len()];
    let mut volumes = vec![0.0; elements.len()];
    each_point(problem, displacement, |element, volume, h| {
        let second = problem.material.second_piola_kirchhoff(&green_lagrange(h));
        let stress = cauchy(h, &second);
        volumes[element] += volume;
        for (sum, s) in cell[element].iter_mut().zip(stress) {
            *sum += volume * s;
        }
    });
    let mut nodal = vec![([0.0; 6], 0.0); problem.nodes.len()];
    for (element, volume) in volumes.iter().enumerate() {
        for node in elements.nodes(element) {
            let (sum, weight) = &mut nodal[*node as usize];
            *weight += volume;
            for (sum, s) in sum.iter_mut().zip(cell[element]) {
                *sum += s;
            }
        }
        cell[element] = cell[element].map(|s| s / volume);
    }
    let mean = |(sum, weight): &(Sym3, f64)| von_mises(&sum.map(|s| s / weight));
    Stresses {
        cell_von_mises: cell.iter().map(von_mises).collect(),
        node_von_mises: nodal.iter().map(mean).collect(),
        cell,
    }
}

/// √(3/2 s:s) of the deviator s.
pub fn von_mises(s: &Sym3) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    let shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// The first element with a point that is turned inside out, and its volume ratio there.
pub fn first_inverted(problem: &SolidProblem, displacement: &[Vec3]) -> Option<(usize, f64)> {
    let mut found = None;
    each_point(problem, displacement, |element, _, h| {
        let ratio = 1.0 + volume_change(h);
        let sound = ratio > 0.0;
        if !sound && found.is_none() {
            found = Some((element, ratio));
        }
    });
    found
}

/// Writes a `.vtu` with displacements, velocities where there are any, and stresses.
///
/// # Errors
/// A value that is not finite, a file that cannot be written.
pub fn write_fields(
    path: &Path,
    mesh: &TetMesh,
    displacement: &[Vec3],
    velocity: Option<&[Vec3]>,
    stresses: &Stresses,
) -> Result<(), FieldError> {
    let mut points =
        vec![Field { name: "displacement", components: 3, values: displacement.as_flattened() }];
    if let Some(velocity) = velocity {
        points.push(Field { name: "velocity", components: 3, values: velocity.as_flattened() });
    }
    let nodal = &stresses.node_von_mises;
    points.push(Field { name: "von_mises_nodal", components: 1, values: nodal });
    let cells = [
        Field { name: "von_mises", components: 1, values: &stresses.cell_von_mises },
        Field { name: "cauchy_stress", components: 6, values: stresses.cell.as_flattened() },
    ];
    Ok(write_atomic(path, &write_vtu(mesh, &points, &cells)?)?)
}

/// Writes the `.vtu` of a mode shape.
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
