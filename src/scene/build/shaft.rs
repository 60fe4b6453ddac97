//! Shafts of a scene in elements: from bodies to solids with their attachments.

use crate::assembly::lists::{Assembly, INNER};
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::ch4_rotor::section::RotorSection;
use crate::kinematics::vec3::Vec3;
use crate::members::beam::{BeamDisc, BeamError};
use crate::members::body::{Body, Drive, DrivenBody, Mobility, Rotation};
use crate::members::condensed_shaft::{SolidShaftError, section};
use crate::members::connection::SpringDashpot;
use crate::members::mount::Mount;
use crate::mesh::{Order, TetMesh};
use crate::motion::coupling::SolidPart;
use crate::motion::explicit_shaft::{Joint, SectionUnbalance, ShaftPart};
use crate::numeric::profile::Profile;
use crate::scene::build::assembly::{AssemblyScene, Carrier, RaceJoint, SceneBeam, SceneBody};
use crate::solids::error::SolidError;
use crate::solids::model::{Load, SolidModel, SolidProblem};
use thiserror::Error;

/// A shaft ready for explicit steps.
#[derive(Clone, Debug)]
pub struct ShaftElements {
    /// Name of its body, and index.
    pub name: String,
    pub body: usize,
    pub mesh: TetMesh,
    pub part: SolidPart,
}

impl ShaftElements {
    /// Σ m (y, z), kg·m, and Σ m x (y, z) about their centre, kg·m²: static and couple unbalance of lumped masses of a
    /// mesh that is not quite axisymmetric.
    pub fn imbalance(&self) -> [[f64; 2]; 2] {
        let model = &self.part.model;
        let nodes = || model.mass.iter().zip(&model.problem.nodes);
        let sum = |of: &dyn Fn(&Vec3) -> f64| -> f64 { nodes().map(|(m, at)| m * of(at)).sum() };
        let centre = sum(&|at| at[0]) / model.mass.iter().sum::<f64>();
        let [y, z] = [1, 2].map(|axis: usize| sum(&|at| at[axis]));
        let [by_y, by_z] = [1, 2].map(|axis: usize| sum(&|at| (at[0] - centre) * at[axis]));
        [[y, z], [by_y, by_z]]
    }

    /// "33280 four-node elements, 6120 nodes".
    pub fn mesh_text(&self) -> String {
        let kind = match self.mesh.order() {
            Order::Linear => "four",
            Order::Quadratic => "ten",
        };
        let (elements, nodes) = (self.mesh.elements.len(), self.mesh.nodes.len());
        format!("{elements} {kind}-node elements, {nodes} nodes")
    }
}

#[derive(Clone, Debug, PartialEq, Error)]
#[error("body.{body}.beam.mesh: {error}")]
pub struct ShaftError {
    body: String,
    error: Reason,
}

#[derive(Clone, Debug, PartialEq, Error)]
enum Reason {
    #[error(transparent)]
    Beam(#[from] BeamError),
    #[error(transparent)]
    Section(#[from] SolidShaftError),
    #[error(transparent)]
    Solid(#[from] SolidError),
}

/// Positions on a shaft closer than this fraction of its length are equal.
const SAME: f64 = 1e-9;

/// Removes shafts in elements from an assembly of the scene and makes these. Each race and disc on them becomes a body
/// of its own, which rotates with the shaft's speed.
///
/// # Errors
///
/// Sizes without a valid mesh.
pub fn take_shafts(
    scene: &AssemblyScene,
    assembly: &mut Assembly,
) -> Result<Vec<ShaftElements>, ShaftError> {
    let mut found = Vec::new();
    for (index, body) in scene.bodies.iter().enumerate() {
        let Some(beam) = body.beam.as_deref() else { continue };
        let Some(joint) = beam.in_elements else { continue };
        let named = |error| ShaftError { body: body.name.clone(), error };
        let sitting = take_sitting(scene, assembly, (index, body, beam));
        found.push(made((index, body), (beam, joint), sitting, assembly.gravity).map_err(named)?);
    }
    Ok(found)
}

/// Index of a body, and its position along X, m.
type Sitting = Vec<(usize, f64)>;

/// Makes bodies of races and discs; the shaft's body remains without attachments.
fn take_sitting(
    scene: &AssemblyScene,
    assembly: &mut Assembly,
    (index, of, beam): (usize, &SceneBody, &SceneBeam),
) -> Sitting {
    assembly.shafts.retain(|shaft| shaft.body != index);
    let body = &mut assembly.bodies[index];
    (body.mobility, body.label, body.rest) = (Mobility::Fixed, None, [0.0; 5]);
    let near = SAME * beam.beam.length();
    let places = beam.beam.discs.iter().map(|disc| (disc, disc.at + beam.start));
    let mut discs: Vec<Option<(&BeamDisc, f64)>> = places.map(Some).collect();
    let mut sitting = Sitting::new();
    let mut sit = |assembly: &mut Assembly, name: String, at: f64, inertia: Inertia| {
        let Inertia { mass, transverse, .. } = inertia;
        let race = DrivenBody {
            inertia,
            drives: [const { Drive::Load(Profile::ZERO) }; 5],
            rotation: of.race.rotation.clone(),
            foundation_stiffness: [0.0; 5],
            foundation_damping: [mass, mass, mass, transverse, transverse]
                .map(|of| of * beam.damping),
        };
        sitting.push((assembly.bodies.len(), at));
        assembly.bodies.push(Body {
            name,
            label: None,
            mobility: Mobility::Driven(Box::new(race)),
            rest: [at, 0.0, 0.0, 0.0, 0.0],
            rotating_load: None,
            unbalance: 0.0,
        });
        assembly.bodies.len() - 1
    };
    for (bearing, placed) in scene.bearings.iter().enumerate() {
        let Carrier::Body { index: on, at } = placed.carriers[INNER] else { continue };
        if on != index {
            continue;
        }
        // A disc at the position of a race is merged with the race; otherwise it is a ring of its sizes.
        let here = |disc: &&mut Option<(&BeamDisc, f64)>| {
            disc.is_some_and(|(_, place)| (place - at).abs() <= near)
        };
        let inertia = match discs.iter_mut().find(here).and_then(Option::take) {
            Some((disc, _)) => inertia_of(disc),
            None => placed.scene.dynamics.inner.inertia,
        };
        let suffix = assembly.bearings[bearing].suffix();
        let body = sit(assembly, format!("the inner race{suffix}"), at, inertia);
        let reversed = assembly.bearings[bearing].mounts[INNER].reversed;
        assembly.bearings[bearing].mounts[INNER] = Mount { body, along: 0.0, reversed };
    }
    for (number, disc) in discs.into_iter().enumerate() {
        if let Some((disc, at)) = disc {
            let name = format!("disc {} of the body {}", number + 1, of.name);
            sit(assembly, name, at, inertia_of(disc));
        }
    }
    sitting
}

fn inertia_of(disc: &BeamDisc) -> Inertia {
    let BeamDisc { mass, axial, transverse, .. } = *disc;
    Inertia { mass, axial, transverse }
}

/// Positions along X, m.
fn places_of(beam: &SceneBeam, sitting: &Sitting) -> Vec<f64> {
    let sitting = sitting.iter().map(|(_, at)| *at);
    let loads = beam.loads.iter().map(|(at, _)| *at);
    let unbalances = beam.unbalances.iter().map(|(at, ..)| *at);
    let probes = beam.probes.iter().map(|(_, at)| *at);
    sitting.chain(loads).chain(unbalances).chain(probes).collect()
}

/// Outer diameter at a position along X, m: of the thinner segment at a step.
fn diameter_at(beam: &SceneBeam, at: f64) -> f64 {
    let near = SAME * beam.beam.length();
    let mut end = beam.start;
    let mut here = f64::INFINITY;
    for segment in &beam.beam.segments {
        let from = end;
        end += segment.length;
        if from - near <= at && at <= end + near {
            here = here.min(segment.outer_diameter);
        }
    }
    here
}

/// Springs between a race or a disc and the section at its position; those against rotation are those against
/// displacement at an arm of the shaft's diameter.
fn joint_at(section: RotorSection, body: usize, springs: RaceJoint, diameter: f64) -> Joint {
    let turn = diameter * diameter;
    let along = |of: f64| [of, of, of, of * turn, of * turn, of * turn];
    let (stiffness, damping) = (along(springs.stiffness), along(springs.damping));
    let law = SpringDashpot { stiffness, damping, ..SpringDashpot::default() };
    Joint { body, section, law }
}

/// Forces on a section over time, as a load for each direction.
fn pulls<'l>(
    section: &'l RotorSection,
    force: &'l [Profile; 3],
) -> impl Iterator<Item = Load> + 'l {
    force.iter().enumerate().filter(|(_, profile)| !profile.is_zero()).map(|(axis, profile)| {
        let mut unit = [0.0; 3];
        unit[axis] = 1.0;
        let forces = section.forces(unit, [0.0; 3]).collect();
        Load { forces, profile: profile.clone() }
    })
}

fn made(
    (index, body): (usize, &SceneBody),
    (beam, springs): (&SceneBeam, RaceJoint),
    sitting: Sitting,
    gravity: Vec3,
) -> Result<ShaftElements, Reason> {
    let start = beam.start;
    let places: Vec<f64> = places_of(beam, &sitting).iter().map(|at| at - start).collect();
    let (mut mesh, problem) = beam.beam.solid(&places)?.ok_or(BeamError::NoSegment)?;
    mesh.nodes.iter_mut().for_each(|node| node[0] += start);
    let section = |at: f64| section(&mesh, at);
    let joint = |(body, at): (usize, f64)| -> Result<Joint, Reason> {
        Ok(joint_at(section(at)?, body, springs, diameter_at(beam, at)))
    };
    let joints = sitting.into_iter().map(joint).collect::<Result<_, _>>()?;
    let unbalances = beam
        .unbalances
        .iter()
        .map(|&(at, size, angle)| Ok(SectionUnbalance { section: section(at)?, size, angle }));
    let probes = beam.probes.iter().map(|(name, at)| Ok((name.clone(), section(*at)?)));
    let speed = match &body.race.rotation {
        Rotation::Speed(speed) => speed.clone(),
        Rotation::Torque(_) => Profile::ZERO,
    };
    let shaft = ShaftPart {
        speed,
        joints,
        unbalances: unbalances.collect::<Result<_, Reason>>()?,
        probes: probes.collect::<Result<_, Reason>>()?,
    };
    let mut loads = Vec::new();
    for (at, force) in &beam.loads {
        loads.extend(pulls(&section(*at)?, force));
    }
    let (nodes, damping) = (mesh.nodes.clone(), beam.damping);
    let problem = SolidProblem { nodes, loads, gravity, damping, ..problem };
    let name = Some(body.name.clone());
    let mut part = SolidPart::undeformed(name, SolidModel::new(problem)?);
    part.shaft = Some(shaft);
    Ok(ShaftElements { name: body.name.clone(), body: index, mesh, part })
}
