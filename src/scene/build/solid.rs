//! From a scene and its mesh to the inputs of the solver: sets become nodes, loads become forces.

use crate::ch2_housing::linear_elastic::LinearElastic;
use crate::kinematics::vec3::Vec3;
use crate::mesh::measure::{Share, tributary_areas};
use crate::mesh::vector_area::vector_areas;
use crate::mesh::{Face, TetMesh};
use crate::numeric::profile::Profile;
use crate::scene::build::about::{SetupError, list};
use crate::scene::build::deck_materials::deck_materials;
use crate::scene::build::solid_mesh::BuiltMesh;
use crate::scene::resolve::solid_scene::{Law, LoadKind, ProbeOf, SolidScene};
use crate::solids::labels::Labels;
use crate::solids::model::{Load, Prescribed, SolidProblem};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

fn place(at: &Vec3) -> String {
    format!("at {:.6}, {:.6}, {:.6} m", at[0], at[1], at[2])
}

/// Named nodes: mean displacements and sums of forces are taken over them.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedNodes {
    /// Letters, digits, `_`, `-` and `.` only, unlike any other of its kind.
    pub name: String,
    pub nodes: Vec<u32>,
}

/// Components fixed by one set. A component of two sets belongs to the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    pub name: String,
    /// Node and axis.
    pub components: Vec<(u32, usize)>,
}

impl Support {
    /// Axes of its components, ascending.
    pub fn axes(&self) -> Vec<usize> {
        (0..3).filter(|axis| self.components.iter().any(|(_, held)| held == axis)).collect()
    }

    /// Sum of vectors over its components, for each of its [`axes`](Support::axes).
    pub fn total(&self, of: &[Vec3]) -> Vec<f64> {
        let along = |axis: usize| {
            let own = self.components.iter().filter(move |(_, held)| *held == axis);
            own.map(|(node, axis)| of[*node as usize][*axis]).sum()
        };
        self.axes().into_iter().map(along).collect()
    }
}

/// A solid ready to be solved, and its outputs.
#[derive(Clone, Debug)]
pub struct SolidSetup {
    pub problem: SolidProblem,
    pub labels: Labels,
    /// Velocities at the start of a run, m/s.
    pub velocity: Vec<Vec3>,
    pub probes: Vec<NamedNodes>,
    /// Supports; their reactions are written.
    pub supports: Vec<Support>,
    /// Notes on valid but unusual input.
    pub notes: Vec<String>,
}

/// Longest name of a probe, bytes: file systems take 255 with prefix and extension.
const LONGEST_NAME: usize = 120;
/// Fraction of a load on fixed components that is worth a note: the edge of a loaded face that is fixed at its end has
/// less on meshes of ten cells or more.
const WORTH_A_WORD: f64 = 0.2;
/// Distance, as a fraction of the longest edge, within which a probe's position is its node's.
const ON_A_NODE: f64 = 0.01;

const AXES: [&str; 3] = ["x", "y", "z"];

/// Supports, loads and probes of a solid.
pub struct Outside {
    pub prescribed: Vec<Prescribed>,
    pub supports: Vec<Support>,
    pub loads: Vec<Load>,
    pub probes: Vec<NamedNodes>,
    pub notes: Vec<String>,
}

/// # Errors
///
/// A set that is missing or does not fit its use; supports that contradict each other.
pub fn outside(scene: &SolidScene, built: &BuiltMesh) -> Result<Outside, SetupError> {
    let mesh = &built.mesh;
    let (prescribed, supports) = supports(scene, mesh)?;
    let (mut notes, mut loads) = (Vec::new(), Vec::new());
    for (index, load) in scene.loads.iter().enumerate() {
        let of_set = set_loads(mesh, index, &load.set, &load.kind)?;
        notes.extend(on_supports(index, &load.set, &of_set, &prescribed)?);
        loads.extend(of_set);
    }
    let probes = probes(scene, mesh, built.quality.longest_edge, &mut notes)?;
    Ok(Outside { prescribed, supports, loads, probes, notes })
}

/// # Errors
///
/// Those of [`outside`]; an invalid material, or one that contradicts a deck.
pub fn setup(scene: &SolidScene, built: &BuiltMesh) -> Result<SolidSetup, SetupError> {
    let mesh = &built.mesh;
    let Law::LinearElastic { youngs_modulus, poisson_ratio } = scene.law else {
        let text = "this command supports linear elastic solids only";
        return Err(SetupError::key("solid.material.law", text));
    };
    let material = LinearElastic::new(youngs_modulus, poisson_ratio)
        .map_err(|error| SetupError::of(Some("solid.material"), error))?;
    let mut notes = deck_materials(scene, [youngs_modulus, poisson_ratio], built)?;
    let Outside { prescribed, supports, loads, probes, notes: of_sets } = outside(scene, built)?;
    notes.extend(of_sets);
    let problem = SolidProblem {
        nodes: mesh.nodes.clone(),
        elements: mesh.elements.clone(),
        material,
        density: scene.density,
        damping: scene.damping,
        damped_motion: scene.damped_motion,
        prescribed,
        loads,
        gravity: scene.gravity,
    };
    let [u, v, w] = scene.velocity;
    let velocity =
        mesh.nodes.iter().map(|[_, y, z]| [u, v - scene.spin * z, w + scene.spin * y]).collect();
    let labels = built.labels.clone();
    Ok(SolidSetup { problem, labels, velocity, probes, supports, notes })
}

/// Every set of the mesh, once.
fn set_names(mesh: &TetMesh) -> Vec<String> {
    let all = mesh.node_sets.keys().chain(mesh.surface_sets.keys()).chain(mesh.element_sets.keys());
    all.cloned().collect::<BTreeSet<_>>().into_iter().collect()
}

/// Nodes of a set of nodes, faces or elements, ascending.
fn nodes_of_set(
    mesh: &TetMesh,
    set: &str,
    part: &'static str,
    index: usize,
) -> Result<Vec<u32>, SetupError> {
    let nodes = if let Some(nodes) = mesh.node_sets.get(set) {
        nodes.clone()
    } else if let Some(faces) = mesh.surface_sets.get(set) {
        mesh.nodes_of_faces(faces)
    } else if let Some(elements) = mesh.element_sets.get(set) {
        let nodes = elements.iter().flat_map(|&element| mesh.elements.nodes(element as usize));
        nodes.copied().collect::<BTreeSet<_>>().into_iter().collect()
    } else {
        return Err(no_such_set(part, index, set, &set_names(mesh)));
    };
    match nodes.is_empty() {
        true => Err(SetupError::item(part, index, "set", format!("set \"{set}\" has no nodes"))),
        false => Ok(nodes),
    }
}

fn no_such_set(part: &'static str, index: usize, set: &str, known: &[String]) -> SetupError {
    let text = format!("no set is called \"{set}\"; there are: {}", list(known));
    SetupError::item(part, index, "set", text)
}

type Supports = (Vec<Prescribed>, Vec<Support>);

/// Fixed components. Two sets may fix one node if their motions are equal.
fn supports(scene: &SolidScene, mesh: &TetMesh) -> Result<Supports, SetupError> {
    let mut owner: BTreeMap<(u32, usize), (&str, &Profile)> = BTreeMap::new();
    let mut named: Vec<Support> = Vec::new();
    for (index, held) in scene.held.iter().enumerate() {
        let nodes = nodes_of_set(mesh, &held.set, "solid.fixed", index)?;
        let mut components = Vec::new();
        for (axis, profile) in held.motion.iter().enumerate() {
            let Some(profile) = profile else { continue };
            for &node in &nodes {
                match owner.entry((node, axis)) {
                    Entry::Vacant(free) => {
                        free.insert((&held.set, profile));
                        components.push((node, axis));
                    }
                    Entry::Occupied(taken) if taken.get().1 == profile => {}
                    Entry::Occupied(taken) => {
                        let (axis, at) = (AXES[axis], place(&mesh.nodes[node as usize]));
                        let text = format!(
                            "sets \"{}\" and \"{}\" move the same node ({at}) along {axis} in different ways",
                            taken.get().0,
                            held.set
                        );
                        return Err(SetupError::item("solid.fixed", index, axis, text));
                    }
                }
            }
        }
        // Two entries for one set, one axis each, are one support.
        let name = column_name(&held.set);
        match named.iter_mut().find(|other| other.name == name) {
            Some(support) => support.components.extend(components),
            None => named.push(Support { name, components }),
        }
    }
    let prescribed = owner
        .into_iter()
        .map(|((node, axis), (_, profile))| Prescribed { node, axis, profile: profile.clone() })
        .collect();
    Ok((prescribed, named))
}

/// Forces of one load: over a surface in proportion to the area, over loose nodes evenly.
fn set_loads(
    mesh: &TetMesh,
    index: usize,
    set: &str,
    kind: &LoadKind,
) -> Result<Vec<Load>, SetupError> {
    match kind {
        LoadKind::Pressure(profile) => {
            let faces = mesh.surface_sets.get(set).ok_or_else(|| {
                let known: Vec<String> = mesh.surface_sets.keys().cloned().collect();
                if !set_names(mesh).iter().any(|name| name == set) {
                    return no_such_set("solid.load", index, set, &known);
                }
                let text = format!(
                    "pressure needs a surface, and \"{set}\" is a set of nodes or elements; the surfaces are: {}",
                    list(&known)
                );
                SetupError::item("solid.load", index, "set", text)
            })?;
            let areas = vector_areas(mesh, faces);
            let forces = (0..).zip(areas).filter(|(_, area)| *area != [0.0; 3]);
            let forces = forces.map(|(node, area)| (node, area.map(|a| -a))).collect();
            Ok(vec![Load { forces, profile: profile.clone() }])
        }
        LoadKind::Force(axes) => {
            let shares = shares(mesh, index, set)?;
            let along = |axis: usize, profile: &Profile| {
                let force = |share: f64| {
                    let mut force = [0.0; 3];
                    force[axis] = share;
                    force
                };
                let forces = shares.iter().map(|(node, share)| (*node, force(*share))).collect();
                Load { forces, profile: profile.clone() }
            };
            let given = axes.iter().enumerate();
            Ok(given.filter_map(|(axis, p)| p.as_ref().map(|p| along(axis, p))).collect())
        }
    }
}

/// Fraction of a force on each node of a set; the sum is one.
fn shares(mesh: &TetMesh, index: usize, set: &str) -> Result<Vec<(u32, f64)>, SetupError> {
    let faces: &[Face] = mesh.surface_sets.get(set).map_or(&[], Vec::as_slice);
    if faces.is_empty() {
        let nodes = nodes_of_set(mesh, set, "solid.load", index)?;
        let share = 1.0 / nodes.len() as f64;
        return Ok(nodes.into_iter().map(|node| (node, share)).collect());
    }
    let areas = tributary_areas(mesh, faces, Share::Consistent);
    let total: f64 = areas.iter().sum();
    let carrying = (0..).zip(areas).filter(|(_, area)| *area != 0.0);
    Ok(carrying.map(|(node, area)| (node, area / total)).collect())
}

/// Checks loads on supports: all of a load is an error, a large part gets a note.
fn on_supports(
    index: usize,
    set: &str,
    loads: &[Load],
    prescribed: &[Prescribed],
) -> Result<Option<String>, SetupError> {
    let held: BTreeSet<(u32, usize)> = prescribed.iter().map(|p| (p.node, p.axis)).collect();
    let (mut all, mut taken) = ([0.0; 3], [0.0; 3]);
    for load in loads.iter().filter(|load| !load.profile.is_zero()) {
        for (node, force) in &load.forces {
            for axis in 0..3 {
                all[axis] += force[axis].abs();
                if held.contains(&(*node, axis)) {
                    taken[axis] += force[axis].abs();
                }
            }
        }
    }
    let (sum, on_held): (f64, f64) = (all.iter().sum(), taken.iter().sum());
    let along: Vec<&str> =
        (0..3).filter(|&axis| taken[axis] > 0.0).map(|axis| AXES[axis]).collect();
    let along = along.join(" and ");
    // Rounding of sums of shares.
    if sum > 0.0 && on_held >= (1.0 - 1e-9) * sum {
        let text = format!(
            "set \"{set}\" is fixed along {along} where it is loaded: the support carries all of the load, and the body \
             none. Load another set, or leave that axis out of [[solid.fixed]]"
        );
        return Err(SetupError::item("solid.load", index, "set", text));
    }
    let part = 100.0 * on_held / sum;
    Ok((on_held > WORTH_A_WORD * sum).then(|| {
        format!(
             "{part:.0} % of the load on set \"{set}\" is on nodes that are fixed along {along}: the support \
              carries it directly"
        )
    }))
}

/// Nodes of the probes; positions away from nodes get a note, those outside the mesh are errors.
fn probes(
    scene: &SolidScene,
    mesh: &TetMesh,
    edge: f64,
    notes: &mut Vec<String>,
) -> Result<Vec<NamedNodes>, SetupError> {
    let mut probes: Vec<NamedNodes> = Vec::new();
    for (index, probe) in scene.probes.iter().enumerate() {
        let nodes = match &probe.of {
            ProbeOf::Set(set) => nodes_of_set(mesh, set, "solid.probe", index)?,
            ProbeOf::Place(at) => {
                let off = |p: &Vec3| (0..3).map(|i| (p[i] - at[i]) * (p[i] - at[i])).sum::<f64>();
                let nearest =
                    (0u32..).zip(&mesh.nodes).min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
                let Some((node, nearest)) = nearest else { continue };
                let distance = off(nearest).sqrt();
                let near = distance <= edge;
                if !near {
                    let text = format!(
                        "the nearest node is {:.4} mm away ({}), farther than the longest edge of the mesh, {:.4} mm: the \
                         place is outside the body. Hint: check the place, its unit and the mesh's; or give the probe a `set`",
                        1e3 * distance,
                        place(nearest),
                        1e3 * edge
                    );
                    return Err(SetupError::item("solid.probe", index, "at", text));
                }
                if distance > ON_A_NODE * edge {
                    notes.push(format!(
                        "probe \"{}\" is at the nearest node, {} ({:.4} mm away)",
                        probe.name,
                        place(nearest),
                        1e3 * distance
                    ));
                }
                vec![node]
            }
        };
        let name = column_name(&probe.name);
        let refused = |text: String| Err(SetupError::item("solid.probe", index, "name", text));
        if name.len() > LONGEST_NAME {
            return refused(format!(
                "a name of {} letters is too long for a file name, which takes {LONGEST_NAME}; give the probe a shorter `name`",
                name.len()
            ));
        }
        if probes.iter().any(|other| other.name == name) {
            return refused(format!(
                "two probes are called \"{name}\"; give one of them another `name`"
            ));
        }
        probes.push(NamedNodes { name, nodes });
    }
    Ok(probes)
}

/// A valid name of a table column.
fn column_name(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || "_-.".contains(c) { c } else { '_' };
    let name: String = name.trim().chars().map(plain).collect();
    if name.is_empty() { "set".to_string() } else { name }
}
