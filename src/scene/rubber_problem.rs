//! From a scene with a solid of rubber and its mesh to what the implicit steps take.

use crate::elements::tet10::{shape_functions, stiffness_rule};
use crate::mesh::Elements;
use crate::scene::solid::{Harmonic, RubberScene, SolidScene};
use crate::scene::solid_mesh::BuiltMesh;
use crate::scene::solid_problem::{NamedNodes, Outside, SolidSetupError, Support, outside};
use crate::solver::profile::Profile;
use crate::solver::solid::labels::Labels;
use crate::solver::solid::model::{Load, Prescribed};
use crate::solver::solid::rubber::model::{RubberModel, RubberProblem};

/// A solid of rubber ready to be solved, and what is to be written of it.
#[derive(Clone, Debug)]
pub struct RubberSetup {
    pub model: RubberModel,
    pub labels: Labels,
    /// kg/m³.
    pub density: f64,
    pub probes: Vec<NamedNodes>,
    /// Supports; their reactions are written.
    pub supports: Vec<Support>,
    /// What is no error and perhaps not meant.
    pub notes: Vec<String>,
}

/// # Errors
/// As [`super::solid_problem::setup`]; a mesh of four-node elements, a body that no model is made of.
pub fn rubber_setup(
    scene: &SolidScene,
    rubber: &RubberScene,
    built: &BuiltMesh,
) -> Result<RubberSetup, SolidSetupError> {
    let mesh = &built.mesh;
    let Elements::Quadratic(elements) = mesh.elements.clone() else {
        return Err(SolidSetupError::FourNodes);
    };
    let Outside { prescribed, supports, loads, probes, mut notes } = outside(scene, built)?;
    if let Some(deck) = built.materials.first() {
        notes
            .push(format!("the scene's rubber is used, not the deck's material \"{}\"", deck.name));
    }
    let (nodes, material) = (mesh.nodes.clone(), rubber.material.clone());
    let mut model =
        RubberModel::new(RubberProblem { nodes, elements, material, prescribed, loads })?;
    if scene.gravity != [0.0; 3] {
        model.problem.loads.push(weight(&model, scene.density, scene.gravity));
    }
    let labels = built.labels.clone();
    Ok(RubberSetup { model, labels, density: scene.density, probes, supports, notes })
}

/// Weight of every element on its nodes.
fn weight(model: &RubberModel, density: f64, gravity: [f64; 3]) -> Load {
    let mut masses = vec![0.0; model.problem.nodes.len()];
    for (nodes, tet) in model.problem.elements.iter().zip(&model.tets) {
        for (at, point) in tet.points.iter().enumerate() {
            for (node, share) in nodes.iter().zip(shape_functions(&stiffness_rule(at))) {
                masses[*node as usize] += density * point.volume * share;
            }
        }
    }
    let forces = (0..).zip(masses).map(|(node, mass)| (node, gravity.map(|g| mass * g))).collect();
    Load { forces, profile: Profile::Constant(1.0) }
}

/// The same body with one set moved by 1 m along an axis, all other supports at rest and no loads.
///
/// # Errors
/// A set that the supports do not hold along that axis.
pub fn vibrating(setup: &RubberSetup, asked: &Harmonic) -> Result<RubberModel, SolidSetupError> {
    let known = || setup.supports.iter().map(|support| support.name.clone()).collect();
    let support = setup.supports.iter().find(|support| support.name == asked.set);
    let moved = support.map_or(&[][..], |support| support.components.as_slice());
    let moves = |node: u32, axis: usize| axis == asked.axis && moved.contains(&(node, axis));
    let mut model = setup.model.clone();
    model.problem.loads.clear();
    let mut any = false;
    for Prescribed { node, axis, profile } in &mut model.problem.prescribed {
        let is_moved = moves(*node, *axis);
        any |= is_moved;
        *profile = if is_moved { Profile::Constant(1.0) } else { Profile::ZERO };
    }
    let axis = ["x", "y", "z"][asked.axis];
    any.then_some(model).ok_or_else(|| SolidSetupError::NotHeld {
        set: asked.set.clone(),
        axis,
        known: known(),
    })
}
