//! The mesh that a scene asks for: read or made, repaired as asked, checked, with its sets.

use crate::mesh::check::{Faults, Limits, check};
use crate::mesh::generate::{Solid, bar, contact_block, ring, shaft};
use crate::mesh::numbering::reverse_cuthill_mckee;
use crate::mesh::quadratic::elevate;
use crate::mesh::quality::{Quality, quality};
use crate::mesh::read::{FileNumbers, ReadError, read_abaqus, read_gmsh};
use crate::mesh::repair::{Repair, Repaired, repair};
use crate::mesh::select::Region;
use crate::mesh::topology::surface;
use crate::mesh::{MeshError, Order, TetMesh};
use crate::scene::resolve_solid_mesh::extension;
use crate::scene::solid::{MeshRequest, MeshSource, SetPlace};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A mesh that can be solved on, and how it came about.
#[derive(Clone, Debug)]
pub struct BuiltMesh {
    pub mesh: TetMesh,
    pub quality: Quality,
    pub repaired: Repaired,
    /// Mid-side nodes that had to stay off a curved surface.
    pub pulled_back: usize,
    /// What a person should know about the reading.
    pub notes: Vec<String>,
}

#[derive(Debug, Error)]
pub enum SolidMeshError {
    #[error("solid.mesh.file: cannot read {}: {source}", path.display())]
    File { path: PathBuf, source: std::io::Error },
    #[error("{}: {source}", path.display())]
    Read { path: PathBuf, source: ReadError },
    #[error("{name}: {faults}")]
    Faults { name: String, faults: Faults },
    #[error("{name}: {source}")]
    Mesh { name: String, source: MeshError },
    #[error(
        "solid.mesh.order: {} has ten-node elements, from which no four-node ones are made; leave \
         `order` out, or save the mesh with elements of first order",
        path.display()
    )]
    Order { path: PathBuf },
    #[error(
        "solid.set: the mesh, or an earlier [[solid.set]], already has a set called \"{name}\""
    )]
    SetTwice { name: String },
    #[error(
        "solid.mesh: {cells:.1e} cells, more than the {MOST_CELLS:.0e} that are made; take fewer"
    )]
    TooFine { cells: f64 },
    #[error("solid.set: {source}")]
    Set { source: MeshError },
}

/// Part of the mesh's size within which nodes lie on the surface of a set.
const ON_SURFACE: f64 = 1e-6;

/// Hexahedra that a generator may make, six tetrahedra each: some gigabytes.
const MOST_CELLS: f64 = 1e7;

/// Reads or makes the mesh.
///
/// # Errors
/// A file that cannot be read, a mesh with a fault that no repair was asked for, dimensions that do
/// not fit, a set that matches nothing.
pub fn build(request: &MeshRequest) -> Result<BuiltMesh, SolidMeshError> {
    let mut notes = Vec::new();
    let mut repaired = Repaired::default();
    let limits =
        Limits { aspect: request.largest_aspect, cavities: request.cavities, ..Limits::default() };
    let (mesh, pulled_back) = match &request.source {
        MeshSource::File { path, unit, .. } => {
            let bytes = std::fs::read(path)
                .map_err(|source| SolidMeshError::File { path: path.clone(), source })?;
            let loaded = match extension(&path.to_string_lossy()).as_str() {
                "inp" => read_abaqus(&bytes, *unit),
                _ => read_gmsh(&bytes, *unit),
            };
            let loaded =
                loaded.map_err(|source| SolidMeshError::Read { path: path.clone(), source })?;
            notes.extend(loaded.notes.iter().map(ToString::to_string));
            let tolerance = limits.duplicate * loaded.mesh.size();
            let wanted = Repair {
                orient: request.orient,
                merge_duplicates: request.merge_duplicates.then_some(tolerance),
                drop_unreferenced: request.drop_unreferenced,
            };
            let places = loaded.mesh.nodes.clone();
            let (mesh, done) = repair(loaded.mesh, &wanted).map_err(|e| in_mesh(path, e))?;
            repaired = done;
            let name = path.display().to_string();
            check(&mesh, &limits).map_err(|faults| {
                let faults = in_numbers_of_file(faults, &mesh, &places, &loaded.numbers);
                SolidMeshError::Faults { name, faults }
            })?;
            from_file(mesh, request.order, path)?
        }
        made => {
            let name = "solid.mesh";
            let cells = cells(made);
            if cells > MOST_CELLS {
                return Err(SolidMeshError::TooFine { cells });
            }
            let solid = generate(made)
                .map_err(|source| SolidMeshError::Mesh { name: name.to_string(), source })?;
            let (mesh, pulled_back) = of_order(solid, request.order)
                .map_err(|source| SolidMeshError::Mesh { name: name.to_string(), source })?;
            check(&mesh, &limits)
                .map_err(|faults| SolidMeshError::Faults { name: name.to_string(), faults })?;
            (mesh, pulled_back)
        }
    };
    let mesh = with_sets(mesh, request)?;
    let mesh = if request.renumber { reverse_cuthill_mckee(mesh).mesh } else { mesh };
    Ok(BuiltMesh { quality: quality(&mesh), mesh, repaired, pulled_back, notes })
}

fn in_mesh(path: &Path, source: MeshError) -> SolidMeshError {
    SolidMeshError::Mesh { name: path.display().to_string(), source }
}

/// Faults by the numbers that the file has for elements and nodes; `places` are those of its nodes.
fn in_numbers_of_file(
    faults: Faults,
    mesh: &TetMesh,
    places: &[[f64; 3]],
    numbers: &FileNumbers,
) -> Faults {
    let element = |index: u64| numbers.elements[index as usize];
    let node = |index: u64| {
        let index = index as usize;
        // Repairs drop nodes and move none: those that are left are found by their places.
        let first = || places.iter().position(|place| *place == mesh.nodes[index]);
        let read = if places.len() == mesh.nodes.len() { Some(index) } else { first() };
        read.map_or(index as u64, |read| numbers.nodes[read])
    };
    Faults(faults.0.into_iter().map(|fault| fault.renumbered(element, node)).collect())
}

/// A file's mesh in the order that is asked for.
fn from_file(
    mesh: TetMesh,
    order: Option<Order>,
    path: &Path,
) -> Result<(TetMesh, usize), SolidMeshError> {
    match (mesh.order(), order) {
        (Order::Quadratic, Some(Order::Linear)) => {
            Err(SolidMeshError::Order { path: path.to_path_buf() })
        }
        (Order::Linear, Some(Order::Quadratic)) => {
            let elevated = elevate(&mesh, &[]).map_err(|source| in_mesh(path, source))?;
            Ok((elevated.mesh, elevated.pulled_back))
        }
        _ => Ok((mesh, 0)),
    }
}

fn of_order(solid: Solid, order: Option<Order>) -> Result<(TetMesh, usize), MeshError> {
    if order != Some(Order::Quadratic) {
        return Ok((solid.mesh, 0));
    }
    let elevated = solid.quadratic()?;
    Ok((elevated.mesh, elevated.pulled_back))
}

/// About how many hexahedra a generator makes.
fn cells(source: &MeshSource) -> f64 {
    let product = |counts: &[usize]| counts.iter().map(|count| *count as f64).product::<f64>();
    match source {
        MeshSource::File { .. } => 0.0,
        MeshSource::Bar { cells, .. } => product(cells),
        MeshSource::Block(block) => {
            let fine = block.cells_per_half_width;
            40.0 * product(&[fine, fine, block.depth_cells])
        }
        MeshSource::Ring(_, mesh) => product(&[mesh.around, mesh.radial, mesh.axial]),
        MeshSource::Shaft { stations, longest_layer, around, radial, .. } => {
            let length = stations[stations.len() - 1] - stations[0];
            let layers = length / longest_layer + stations.len() as f64;
            layers * product(&[*around, radial + around.div_ceil(16)])
        }
        MeshSource::Cage(cage, mesh) => {
            4.0 * product(&[cage.pocket_count, mesh.quarter, mesh.bar, mesh.wall])
        }
        MeshSource::Housing(_, mesh) => 2.0 * product(&[mesh.around, mesh.radial, mesh.axial]),
    }
}

fn generate(source: &MeshSource) -> Result<Solid, MeshError> {
    match source {
        MeshSource::File { .. } => Err(MeshError::NoElements),
        MeshSource::Bar { size, cells } => bar(*size, *cells),
        MeshSource::Block(block) => contact_block(block),
        MeshSource::Ring(shape, cells) => ring(shape, cells),
        MeshSource::Shaft { radius, stations, longest_layer, around, radial } => {
            shaft(*radius, stations, *longest_layer, *around, *radial)
        }
        MeshSource::Cage(cage, cells) => cage.solid(cells),
        MeshSource::Housing(housing, cells) => housing.solid(cells),
    }
}

/// Sets by geometry, beside those the mesh has.
fn with_sets(mut mesh: TetMesh, request: &MeshRequest) -> Result<TetMesh, SolidMeshError> {
    let boundary = if request.sets.is_empty() { Vec::new() } else { surface(&mesh) };
    for set in &request.sets {
        let tolerance = set.tolerance.unwrap_or(ON_SURFACE * mesh.size());
        let failed = |source| SolidMeshError::Set { source };
        if mesh.node_sets.contains_key(&set.name) || mesh.surface_sets.contains_key(&set.name) {
            return Err(SolidMeshError::SetTwice { name: set.name.clone() });
        }
        match set.place {
            SetPlace::Surface(on) => {
                mesh.add_surface_set(&set.name, &boundary, &on, tolerance).map_err(failed)?;
            }
            SetPlace::Box { low, high } => {
                let region = Region::Box {
                    low: low.map(|x| x - tolerance),
                    high: high.map(|x| x + tolerance),
                };
                mesh.add_node_set(&set.name, &region).map_err(failed)?;
            }
        }
    }
    Ok(mesh)
}
