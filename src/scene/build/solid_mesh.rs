//! The mesh of a scene: read or made, repaired as requested, checked, with its sets.

use crate::mesh::check::{Faults, Limits, check};
use crate::mesh::generate::{Solid, bar, bushing, contact_block, ring, shaft};
use crate::mesh::numbering::reverse_cuthill_mckee;
use crate::mesh::quadratic::elevate;
use crate::mesh::quality::{Quality, quality};
use crate::mesh::read::{DeckMaterial, read_abaqus, read_gmsh};
use crate::mesh::repair::{Repair, Repaired, repair};
use crate::mesh::select::Region;
use crate::mesh::topology::surface;
use crate::mesh::{MeshError, Order, TetMesh};
use crate::scene::build::about::SetupError;
use crate::scene::build::bore_shape::{BorePlace, elevate_with_bore};
use crate::scene::resolve::housing_scene::HousedScene;
use crate::scene::resolve::solid_mesh::{extension, key_of_dimension};
use crate::scene::resolve::solid_scene::{MeshRequest, MeshSource, SetPlace};
use crate::scene::text::input_file;
use crate::scene::text::input_file::{InputError, LARGEST_DATA};
use crate::solids::labels::Labels;
use std::fmt::Display;
use std::path::Path;

/// A valid mesh, and its origin.
#[derive(Clone, Debug)]
pub struct BuiltMesh {
    pub mesh: TetMesh,
    /// Numbers of elements and nodes in messages, as in the file.
    pub labels: Labels,
    pub quality: Quality,
    pub repaired: Repaired,
    /// Mid-side nodes that could not be moved onto a curved surface.
    pub moved_back: usize,
    /// Notes of the reading.
    pub notes: Vec<String>,
    /// Materials of an input deck, for comparison with the scene's.
    pub materials: Vec<DeckMaterial>,
}

/// Advice for a missing file.
fn where_it_is(path: &Path, source: &InputError) -> String {
    match std::path::absolute(path) {
        Ok(whole) if source.is_missing() => format!(
            ". Hint: a relative name starts at the scene's folder, and this one is {}",
            whole.display()
        ),
        _ => String::new(),
    }
}

/// Tolerance of the nodes on the surface of a set, as a fraction of the mesh's size.
pub(crate) const ON_SURFACE: f64 = 1e-6;

/// Largest number of hexahedra of a generator, six tetrahedra each: some gigabytes.
const MOST_CELLS: f64 = 1e7;

/// Note for results on a quarter of a bushing.
const QUARTER: &str = "the mesh is a quarter of the bushing: forces, stiffness and energies of the whole are four times \
                       those of the results";

/// Reads or makes the mesh.
///
/// # Errors
///
/// A file that cannot be read, a mesh with a fault without a requested repair, invalid dimensions, an empty set.
pub fn build(request: &MeshRequest) -> Result<BuiltMesh, SetupError> {
    build_around(request, None)
}

/// The same for a housing: if a file's elements are raised to ten nodes, the bore stays round.
///
/// # Errors
///
/// Those of [`build`].
pub fn build_housing(scene: &HousedScene) -> Result<BuiltMesh, SetupError> {
    build_around(&scene.solid.mesh, Some(&BorePlace::of(scene)))
}

fn build_around(request: &MeshRequest, bore: Option<&BorePlace>) -> Result<BuiltMesh, SetupError> {
    let (mut notes, mut materials) = (Vec::new(), Vec::new());
    let mut repaired = Repaired::default();
    let mut labels = Labels::default();
    let limits =
        Limits { aspect: request.largest_aspect, cavities: request.cavities, ..Limits::default() };
    let (mesh, moved_back) = match &request.source {
        MeshSource::File { path, unit, .. } => {
            let bytes = input_file::read(path, LARGEST_DATA).map_err(|error| {
                let where_it_is = where_it_is(path, &error);
                let text = format!("cannot read {}: {error}{where_it_is}", path.display());
                SetupError::key("solid.mesh.file", text)
            })?;
            let loaded = match extension(&path.to_string_lossy()).as_str() {
                "inp" => read_abaqus(&bytes, *unit),
                _ => read_gmsh(&bytes, *unit),
            };
            let mut loaded = loaded.map_err(|error| in_file(path, error))?;
            let used = used_sets(request, bore);
            loaded.use_sets(&used).map_err(|error| in_file(path, error))?;
            request.place.put(&mut loaded.mesh.nodes);
            notes.extend(loaded.notes.iter().map(ToString::to_string));
            materials = loaded.materials;
            let tolerance = limits.duplicate * loaded.mesh.size();
            let wanted = Repair {
                orient: request.orient,
                merge_duplicates: request.merge_duplicates.then_some(tolerance),
                drop_unreferenced: request.drop_unreferenced,
            };
            let places = loaded.mesh.nodes.clone();
            labels.elements = loaded.numbers.elements;
            let (mut mesh, done) = repair(loaded.mesh, &wanted)
                .map_err(|error| in_file(path, named_in_file(error, &labels)))?;
            notes.extend(without_emptied_sets(&mut mesh, &used, path)?);
            repaired = done;
            labels.nodes = labels_of_nodes(&mesh, &places, &loaded.numbers.nodes);
            check(&mesh, &limits).map_err(|faults| in_file(path, named(faults, &labels)))?;
            let (mesh, moved_back, bent) = from_file(mesh, request, bore, path)?;
            notes.extend(bent);
            // Mid-side nodes come last, and the file has none of them.
            labels.nodes.resize(mesh.nodes.len(), None);
            (mesh, moved_back)
        }
        made => {
            let cells = cells(made);
            if cells > MOST_CELLS {
                let text = format!(
                    "{cells:.1e} cells, more than the limit of {MOST_CELLS:.0e}; take fewer"
                );
                return Err(SetupError::key("solid.mesh.cells", text));
            }
            let failed = |source: MeshError| {
                let dimension = match &source {
                    MeshError::Dimension { what, .. } => key_of_dimension(what),
                    _ => None,
                };
                let key = format!("solid.mesh.{}", dimension.unwrap_or("generate"));
                SetupError::key(&key, source)
            };
            let solid = generate(made).map_err(failed)?;
            let (mut mesh, moved_back) = of_order(solid, request.order).map_err(failed)?;
            if moved_back > 0 {
                notes.push(format!(
                     "{moved_back} mid-side nodes are not on their curved surfaces, because elements thinner than the sagitta of a \
                      cell would fold: the body is a polygon there; take more cells around, or fewer through the wall"
                ));
            }
            if request.is_quarter() {
                notes.push(QUARTER.to_string());
            }
            request.place.put(&mut mesh.nodes);
            check(&mesh, &limits).map_err(|faults| {
                let faults = named(faults, &labels);
                let text = "these dimensions and cells do not make a valid mesh, change them";
                SetupError::key("solid.mesh", format!("{text}: {faults}"))
            })?;
            (mesh, moved_back)
        }
    };
    let mesh = with_sets(mesh, request)?;
    let (mesh, labels) = match request.renumber {
        true => {
            let renumbered = reverse_cuthill_mckee(mesh);
            let labels = labels.renumbered(&renumbered.element, &renumbered.node);
            (renumbered.mesh, labels)
        }
        false => (mesh, labels),
    };
    Ok(BuiltMesh { quality: quality(&mesh), mesh, labels, repaired, moved_back, notes, materials })
}

/// Names of the file's sets that the scene uses.
fn used_sets<'r>(request: &'r MeshRequest, bore: Option<&'r BorePlace>) -> Vec<&'r str> {
    let names =
        request.used_sets.iter().map(String::as_str).chain(bore.map(|bore| bore.set.as_str()));
    names.filter(|name| request.sets.iter().all(|set| set.name != *name)).collect()
}

/// Takes away node sets that a repair has emptied: their nodes belonged to no element.
fn without_emptied_sets(
    mesh: &mut TetMesh,
    used: &[&str],
    path: &Path,
) -> Result<Option<String>, SetupError> {
    let empty: Vec<String> = mesh
        .node_sets
        .iter()
        .filter(|(_, set)| set.is_empty())
        .map(|(name, _)| name.clone())
        .collect();
    if let Some(name) = empty.iter().find(|name| used.contains(&name.as_str())) {
        let text = format!(
            "no node of set \"{name}\", which the scene uses, belongs to an element; name a set on the body"
        );
        return Err(in_file(path, text));
    }
    mesh.node_sets.retain(|_, set| !set.is_empty());
    let note = || {
        format!(
            "no node of these sets belongs to an element, and they were dropped: {}",
            empty.join(", ")
        )
    };
    Ok((!empty.is_empty()).then(note))
}

/// An error inside a mesh file.
fn in_file(path: &Path, error: impl Display) -> SetupError {
    SetupError::of(None, format!("{}: {error}", path.display()))
}

/// Faults with the file's numbers of elements and nodes.
fn named(faults: Faults, labels: &Labels) -> Faults {
    let element = |index: u64| labels.element(index as usize);
    let node = |index: u64| labels.node(index as usize).unwrap_or(index + 1);
    Faults(faults.0.into_iter().map(|fault| fault.renumbered(element, node)).collect())
}

/// Error of a repair, with the file's number of the element.
fn named_in_file(error: MeshError, labels: &Labels) -> MeshError {
    match error {
        MeshError::Collapsed { element, tolerance } => {
            MeshError::Collapsed { element: labels.element(element as usize), tolerance }
        }
        other => other,
    }
}

/// The file's numbers of the nodes left by repairs, which drop nodes without moving or reordering any: found one after
/// the other by their positions.
fn labels_of_nodes(mesh: &TetMesh, places: &[[f64; 3]], numbers: &[u64]) -> Vec<Option<u64>> {
    let mut read = places.iter().zip(numbers);
    let next = |place: &[f64; 3]| read.find(|(at, _)| *at == place).map(|(_, number)| *number);
    mesh.nodes.iter().map(next).collect()
}

/// A file's mesh in the requested order, mid-side nodes off curved surfaces, and a note.
fn from_file(
    mesh: TetMesh,
    request: &MeshRequest,
    bore: Option<&BorePlace>,
    path: &Path,
) -> Result<(TetMesh, usize, Option<String>), SetupError> {
    match (mesh.order(), request.order) {
        (Order::Quadratic, Some(Order::Linear)) => {
            let text = format!(
                "{} has ten-node elements, which are not converted to four-node ones; leave `order` out, or save the mesh \
                 with elements of first order",
                path.display()
            );
            Err(SetupError::key("solid.mesh.order", text))
        }
        (Order::Linear, Some(Order::Quadratic)) => {
            let raised = match bore {
                Some(bore) => elevate_with_bore(&mesh, request, bore),
                None => elevate(&mesh, &[]).map(|elevated| (elevated, None)),
            };
            let (elevated, note) = raised.map_err(|error| in_file(path, error))?;
            Ok((elevated.mesh, elevated.moved_back, note))
        }
        _ => Ok((mesh, 0, None)),
    }
}

fn of_order(solid: Solid, order: Option<Order>) -> Result<(TetMesh, usize), MeshError> {
    if order != Some(Order::Quadratic) {
        return Ok((solid.mesh, 0));
    }
    let elevated = solid.quadratic()?;
    Ok((elevated.mesh, elevated.moved_back))
}

/// Approximate number of hexahedra of a generator.
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
        MeshSource::Bushing(_, mesh) => product(&[mesh.around, mesh.radial, mesh.axial]),
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
        MeshSource::Bushing(body, cells) => bushing(body, cells),
    }
}

/// Adds sets by geometry to those of the mesh.
fn with_sets(mut mesh: TetMesh, request: &MeshRequest) -> Result<TetMesh, SetupError> {
    let boundary = if request.sets.is_empty() { Vec::new() } else { surface(&mesh) };
    for (index, set) in request.sets.iter().enumerate() {
        let tolerance = set.tolerance.unwrap_or(ON_SURFACE * mesh.size());
        let failed = |error: MeshError| SetupError::item("solid.set", index, "name", error);
        if mesh.node_sets.contains_key(&set.name) || mesh.surface_sets.contains_key(&set.name) {
            let text = format!(
                "the mesh, or an earlier [[solid.set]], already has a set called \"{}\"",
                set.name
            );
            return Err(SetupError::item("solid.set", index, "name", text));
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
