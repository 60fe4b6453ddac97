//! From bushings of a scene in elements to these elements between their bodies.

use crate::assembly::lists::Assembly;
use crate::members::connection::Connection;
use crate::mesh::generate::{BushingMesh, Part, bushing};
use crate::mesh::{Elements, TetMesh};
use crate::motion::bonded_bushing::{BondedElements, BondedPart, Sleeve, add_mass};
use crate::numeric::profile::Profile;
use crate::scene::build::assembly::{
    AssemblyScene, BushingInElements, BushingOfSpring, BushingStepping, Spring, SpringAt,
};
use crate::solids::error::SolidError;
use crate::solids::model::Prescribed;
use crate::solids::rubber::explicit::RubberBody;
use crate::solids::rubber::model::{RubberModel, RubberProblem};
use crate::solids::rubber::plan::Bonded;
use crate::solids::rubber::tet_forces::MeanStress;
use thiserror::Error;

/// The elements of a bushing and its bodies.
#[derive(Clone, Debug)]
pub struct BushingElements {
    /// Name of the spring.
    pub name: String,
    /// Ten-node elements with their mass, without that of the sleeve nodes.
    pub model: RubberModel,
    pub solved: Solved,
    sleeves: [Sleeve; 2],
    spring: Connection,
    coupling_phase: f64,
}

/// Integration of the elements of a bushing.
#[derive(Clone, Debug)]
pub enum Solved {
    /// Four-node elements of the same corners, with this fraction of the longest stable step.
    Explicit { body: Box<RubberBody>, fraction: f64 },
    /// Steps of at most this length, s.
    Implicit { step: Option<f64> },
}

/// Error in the elements of a bushing.
#[derive(Debug, Error)]
#[error("the bushing of spring {name}: {reason}")]
pub struct BushingError {
    pub name: String,
    pub reason: String,
}

/// Removes springs that are bushings in elements from an assembly of the scene and makes these; the bodies of their
/// sleeves get the mass of the nodes there.
///
/// # Errors
///
/// Sizes and rubber without a valid mesh or material.
/// Sizes and rubber from which there is no mesh or material.
pub fn take_bushings(
    scene: &AssemblyScene,
    assembly: &mut Assembly,
) -> Result<Vec<BushingElements>, BushingError> {
    let mut found = Vec::new();
    let mut kept = Vec::with_capacity(assembly.connections.len());
    let connections = std::mem::take(&mut assembly.connections);
    for connection in connections {
        let spring = scene.springs.iter().find(|of| connection.label.as_ref() == Some(&of.name));
        let in_elements = spring.and_then(|spring| {
            let of = spring.bushing.as_deref()?;
            Some((spring, of, of.elements?))
        });
        match in_elements {
            None => kept.push(connection),
            Some((spring, of, elements)) => {
                let made = made(scene, spring, (of, elements), connection);
                let name = spring.name.clone();
                let made = made.map_err(|reason| BushingError { name, reason })?;
                for sleeve in &made.sleeves {
                    add_mass(assembly, sleeve, &made.all_masses(elements.density));
                }
                found.push(made);
            }
        }
    }
    assembly.connections = kept;
    Ok(found)
}

/// The whole of a bushing whose cells are given for a quarter.
fn whole(of: &BushingOfSpring) -> BushingMesh {
    let BushingMesh { around, radial, axial, grading, .. } = of.mesh;
    BushingMesh { around: 2 * around, radial, axial: 2 * axial, grading, part: Part::Whole }
}

fn made(
    scene: &AssemblyScene,
    spring: &Spring,
    (of, elements): (&BushingOfSpring, BushingInElements),
    connection: Connection,
) -> Result<BushingElements, String> {
    let solid = bushing(&of.body, &whole(of)).map_err(|error| error.to_string())?;
    let four = solid.mesh.clone();
    let ten = solid.quadratic().map_err(|error| error.to_string())?.mesh;
    // The ground has the outer sleeve; otherwise the first body has it.
    let outer = usize::from(spring.ends[1].at == SpringAt::Ground);
    let middle = scene.place(spring.ends[outer]);
    let sleeve = |end: usize, set: &str| {
        let at = spring.ends[end];
        let nominal = [scene.place(at) - at.along, 0.0, 0.0];
        let nodes = ten.node_sets.get(set).cloned().unwrap_or_default();
        let arm = |node: &u32| {
            let [x, y, z] = ten.nodes[*node as usize];
            [x + middle - nominal[0], y, z]
        };
        let arms = nodes.iter().map(arm).collect();
        Sleeve { body: connection.ends[end].body, nodes, arms, nominal }
    };
    let mut sleeves = [sleeve(outer, "outer"), sleeve(1 - outer, "inner")];
    let prescribed = sleeve_nodes(&ten, "outer").chain(sleeve_nodes(&ten, "inner")).collect();
    let model = ten_nodes(&ten, of, prescribed).map_err(|error| error.to_string())?;
    let mut model = model.with_inertia(elements.density);
    for node in sleeves.iter().flat_map(|sleeve| &sleeve.nodes) {
        model.mass[*node as usize] = 0.0;
    }
    let solved = match elements.stepping {
        BushingStepping::Implicit { step } => Solved::Implicit { step },
        BushingStepping::Explicit { fraction } => {
            // Four-node elements have corners only.
            let corners = four.nodes.len() as u32;
            for sleeve in &mut sleeves {
                let own = sleeve.nodes.iter().zip(&sleeve.arms);
                (sleeve.nodes, sleeve.arms) = own.filter(|(node, _)| **node < corners).unzip();
            }
            Solved::Explicit { body: Box::new(four_nodes(&four, of, elements.density)), fraction }
        }
    };
    let (name, spring) = (spring.name.clone(), connection);
    let coupling_phase = elements.coupling_phase;
    Ok(BushingElements { name, model, solved, sleeves, spring, coupling_phase })
}

/// All components of the nodes of a sleeve, which move with a body.
fn sleeve_nodes<'m>(mesh: &'m TetMesh, set: &str) -> impl Iterator<Item = Prescribed> + use<'m> {
    let nodes = mesh.node_sets.get(set).into_iter().flatten();
    nodes.flat_map(|node| {
        [0, 1, 2].map(|axis| Prescribed { node: *node, axis, profile: Profile::ZERO })
    })
}

fn four_nodes(mesh: &TetMesh, of: &BushingOfSpring, density: f64) -> RubberBody {
    RubberBody {
        nodes: mesh.nodes.clone(),
        elements: match &mesh.elements {
            Elements::Linear(list) => list.clone(),
            Elements::Quadratic(_) => Vec::new(),
        },
        material: of.material.clone(),
        density,
        mean_stress: MeanStress::AroundNodes,
        mass_scale: 1.0,
        prescribed: sleeve_nodes(mesh, "outer").chain(sleeve_nodes(mesh, "inner")).collect(),
        loads: Vec::new(),
        gravity: [0.0; 3],
    }
}

fn ten_nodes(
    mesh: &TetMesh,
    of: &BushingOfSpring,
    prescribed: Vec<Prescribed>,
) -> Result<RubberModel, SolidError> {
    let elements = match &mesh.elements {
        Elements::Quadratic(list) => list.clone(),
        Elements::Linear(_) => return Err(SolidError::FourNodes),
    };
    let (nodes, material) = (mesh.nodes.clone(), of.material.clone());
    RubberModel::new(RubberProblem { nodes, elements, material, prescribed, loads: Vec::new() })
}

impl BushingElements {
    /// The bushing in a run.
    pub fn part(&self) -> BondedPart<'_> {
        let elements = match &self.solved {
            Solved::Explicit { body, fraction } => {
                BondedElements::Explicit { body, fraction: *fraction }
            }
            Solved::Implicit { step } => {
                BondedElements::Implicit { model: &self.model, step: *step }
            }
        };
        let (name, sleeves) = (self.name.clone(), self.sleeves.clone());
        let (spring, coupling_phase) = (self.spring.clone(), self.coupling_phase);
        BondedPart { name, sleeves, spring, elements, coupling_phase }
    }

    /// The bushing in a plan, as the `index`-th solid of a run.
    pub fn planned(&self, index: usize) -> Bonded<'_> {
        let problem = &self.model.problem;
        let (name, terms) = (self.name.as_str(), problem.material.maxwell.len());
        let is_explicit = matches!(self.solved, Solved::Explicit { .. });
        Bonded { name, index, is_explicit, elements: problem.elements.len(), terms }
    }

    /// Masses of the nodes, kg, sleeves included.
    fn all_masses(&self, density: f64) -> Vec<f64> {
        match &self.solved {
            Solved::Explicit { body, .. } => {
                body.model().map(|model| model.mass).unwrap_or_default()
            }
            Solved::Implicit { .. } => self.model.clone().with_inertia(density).mass,
        }
    }
}
