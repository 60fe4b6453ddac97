//! From a scene with a solid of rubber and its mesh to the inputs of the implicit steps.

use crate::elements::tet10::{shape_functions, stiffness_rule};
use crate::mesh::{Elements, TetMesh};
use crate::numeric::profile::Profile;
use crate::scene::build::about::{SetupError, list};
use crate::scene::build::solid::{NamedNodes, Outside, Support, outside};
use crate::scene::build::solid_mesh::BuiltMesh;
use crate::scene::resolve::rubber::FOUR_NODES_LOCK;
use crate::scene::resolve::solid_scene::{Harmonic, Held, MeshSource, RubberScene, SolidScene};
use crate::solids::labels::Labels;
use crate::solids::model::{Load, Prescribed};
use crate::solids::rubber::model::{RubberModel, RubberProblem};
use std::collections::BTreeSet;

/// A solid of rubber ready to be solved, and its outputs.
#[derive(Clone, Debug)]
pub struct RubberSetup {
    pub model: RubberModel,
    pub labels: Labels,
    /// kg/m³.
    pub density: f64,
    pub probes: Vec<NamedNodes>,
    /// Supports; their reactions are written.
    pub supports: Vec<Support>,
    /// Notes on valid but unusual input.
    pub notes: Vec<String>,
}

/// # Errors
///
/// Those of [`crate::scene::build::solid::setup`]; a mesh of four-node elements; an invalid model.
pub fn rubber_setup(
    scene: &SolidScene,
    rubber: &RubberScene,
    built: &BuiltMesh,
) -> Result<RubberSetup, SetupError> {
    let mesh = &built.mesh;
    let Elements::Quadratic(elements) = mesh.elements.clone() else {
        let text = format!(
            "the mesh has four-node elements; {FOUR_NODES_LOCK}. Write `order = 2` in [solid.mesh]"
        );
        return Err(SetupError::key("solid.mesh.file", text));
    };
    let Outside { prescribed, supports, loads, probes, mut notes } = outside(scene, built)?;
    if let Some(deck) = built.materials.first() {
        notes
            .push(format!("the scene's rubber is used, not the deck's material \"{}\"", deck.name));
    }
    notes.extend(sliding_sleeves(scene));
    keeps_between_sleeves(scene)?;
    let (nodes, material) = (mesh.nodes.clone(), rubber.material.clone());
    let problem = RubberProblem { nodes, elements, material, prescribed, loads };
    let mut model =
        RubberModel::new(problem).map_err(|error| SetupError::of(Some("solid"), error))?;
    if scene.gravity != [0.0; 3] {
        model.problem.loads.push(weight(&model, scene.density, scene.gravity));
    }
    if let Some(asked) = &rubber.harmonic {
        moves_as_a_whole(scene, mesh, asked)?;
    }
    let labels = built.labels.clone();
    Ok(RubberSetup { model, labels, density: scene.density, probes, supports, notes })
}

/// Notes for sleeves of a generated bushing that are fixed along some axes only, unlike a bonded one.
fn sliding_sleeves(scene: &SolidScene) -> Vec<String> {
    if !matches!(scene.mesh.source, MeshSource::Bushing(..)) {
        return Vec::new();
    }
    let said = |set: &str| {
        let own = || scene.held.iter().filter(|held| held.set == set);
        let (held, free): (Vec<usize>, Vec<usize>) =
            (0..3).partition(|axis| own().any(|held| held.motion[*axis].is_some()));
        let names =
            |of: &[usize]| of.iter().map(|i| ["x", "y", "z"][*i]).collect::<Vec<_>>().join(" and ");
        let slides = !held.is_empty() && !free.is_empty();
        slides.then(|| {
            format!(
                 "the sleeve \"{set}\" is fixed along {} alone: its rubber slides along {}, where rubber that is bonded to a \
                  sleeve is fixed along all three",
                names(&held),
                names(&free)
            )
        })
    };
    ["inner", "outer"].into_iter().filter_map(said).collect()
}

/// Samples of prescribed motions between corners.
const SAMPLES: usize = 200;

/// Checks that the sleeves of a generated bushing stay apart across its wall.
fn keeps_between_sleeves(scene: &SolidScene) -> Result<(), SetupError> {
    let MeshSource::Bushing(body, _) = &scene.mesh.source else { return Ok(()) };
    let wall = body.thickness;
    let end = scene.run.as_ref().map_or(0.0, |run| run.end);
    let profiles = scene.held.iter().flat_map(|held| held.motion.iter().flatten());
    let even = (0..=SAMPLES).map(|sample| end * sample as f64 / SAMPLES as f64);
    let times = profiles.flat_map(Profile::corners).filter(|time| *time <= end).chain(even);
    let moved = |set: &str, axis: usize, time: f64| {
        let own = scene.held.iter().filter(|held| held.set == set);
        own.filter_map(|held| held.motion[axis].as_ref()).map(|motion| motion.value(time)).next()
    };
    for time in times {
        // About X.
        let across = [1, 2].map(|axis| {
            let [inner, outer] = ["inner", "outer"].map(|set| moved(set, axis, time));
            inner.zip(outer).map_or(0.0, |(inner, outer)| inner - outer)
        });
        let far = libm::hypot(across[0], across[1]);
        let fits = far < wall;
        if !fits {
            let axis = if across[0].abs() > across[1].abs() { 1 } else { 2 };
            let mut held = (0..).zip(&scene.held);
            let own = held.find(|(_, held)| held.set == "inner" && held.motion[axis].is_some());
            let (index, axis) = (own.map_or(0, |(index, _)| index), ["x", "y", "z"][axis]);
            let text = format!(
                "the inner sleeve moves {:.4} mm across at t = {time} s, relative to the outer one, and the rubber between \
                 them is {:.4} mm thick: sleeves would pass through each other. Hint: prescribe less, and check the unit",
                1e3 * far,
                1e3 * wall
            );
            return Err(SetupError::item("solid.fixed", index, axis, text));
        }
    }
    Ok(())
}

/// Checks that no node of a vibrating set is in another set along the same axis: a quarter cannot move across its
/// planes of symmetry.
fn moves_as_a_whole(
    scene: &SolidScene,
    mesh: &TetMesh,
    asked: &Harmonic,
) -> Result<(), SetupError> {
    let holds = |held: &&Held| held.motion[asked.axis].is_some();
    if !scene.held.iter().filter(holds).any(|held| held.set == asked.set) {
        // Reported where its stiffness is requested.
        return Ok(());
    }
    let nodes = |set: &str| mesh.node_sets.get(set).map(Vec::as_slice).unwrap_or_default();
    let own: BTreeSet<u32> = nodes(&asked.set).iter().copied().collect();
    let shares = |held: &&Held| {
        held.set != asked.set && nodes(&held.set).iter().any(|node| own.contains(node))
    };
    scene.held.iter().filter(holds).find(shares).map_or(Ok(()), |held| {
        let (set, other, axis) = (&asked.set, &held.set, ["x", "y", "z"][asked.axis]);
        let text = format!(
            "some nodes of \"{set}\" also belong to \"{other}\", which fixes them along {axis}, so that \"{set}\" cannot \
             move along {axis} as a whole. Hint: a plane of symmetry allows motion within the plane only; mesh the whole \
             body for motion normal to it"
        );
        Err(SetupError::key("solid.harmonic.axis", text))
    })
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
///
/// A set that is not a support along that axis, or without another support.
pub fn vibrating(setup: &RubberSetup, asked: &Harmonic) -> Result<RubberModel, SetupError> {
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
    let (set, axis) = (&asked.set, ["x", "y", "z"][asked.axis]);
    if !any {
        let known: Vec<String> =
            setup.supports.iter().map(|support| support.name.clone()).collect();
        let text = format!(
            "\"{set}\" is not fixed along {axis}; a stiffness can be computed only for a set in [[solid.fixed]], which \
             has: {}",
            list(&known)
        );
        return Err(SetupError::key("solid.harmonic.set", text));
    }
    let mut others = setup.supports.iter().filter(|support| support.name != asked.set);
    let holds = |support: &Support| support.components.iter().any(|(_, of)| *of == asked.axis);
    if !others.any(holds) {
        let text = format!(
            "no set but \"{set}\" is fixed along {axis}, so that nothing resists its motion. Hint: fix another set, or \
             choose another axis"
        );
        return Err(SetupError::key("solid.harmonic.axis", text));
    }
    Ok(model)
}
