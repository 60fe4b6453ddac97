//! How far the inner sleeve of a bonded bushing may go before springs fitted to small vibrations stop holding: by
//! relaxed equilibria of the rubber itself at large displacements.

use crate::ch2_housing::elastomer::Elastomer;
use crate::kinematics::vec3::{add, dot};
use crate::mesh::generate::Bushing;
use crate::mesh::{Elements, TetMesh};
use crate::numeric::profile::Profile;
use crate::solids::model::Prescribed;
use crate::solids::rubber::model::{RubberModel, RubberProblem, supports};
use crate::solids::rubber::relaxed::{RelaxedError, relaxed, relaxed_in_parts};
use crate::solids::rubber::sleeve::SleeveMotion;

/// Of the wall: where the stiffness counts as that of rest, where it is first looked at, and as far as is looked.
const REST: f64 = 1e-3;
const FIRST: f64 = 0.05;
const FARTHEST: f64 = 0.3;
/// Strain that a part of the way there may add, and how far that is trusted (of the wall): the same amplitudes to seven digits as
/// in parts of 2 %, for a third of the time. Jumps and folds that were met lie at 30 % of a wall and beyond (decision 54).
const PARTS: f64 = 0.1;
const TRUSTED: f64 = 0.2;

/// Amplitude of a motion, m or rad, at which force or moment over displacement differs by `part` from that of small amplitudes;
/// infinite where it does not within 30 % of the wall. The mesh is that of a whole bushing.
///
/// The difference grows with the square of the amplitude: one equilibrium at 5 % of the wall says where to look, one there says
/// where it is.
///
/// # Errors
/// Those of [`relaxed`]; a mesh of four-node elements.
pub fn holds(
    mesh: &TetMesh,
    body: &Bushing,
    material: &Elastomer,
    motion: SleeveMotion,
    part: f64,
) -> Result<f64, RelaxedError> {
    let arm = lever(motion, body);
    let secant = |walls: f64| {
        let amount = walls * body.thickness / arm;
        stiffness(mesh, material, motion, amount, (walls <= TRUSTED).then_some(PARTS))
    };
    let rest = secant(REST)?;
    let off = |walls: f64| -> Result<f64, RelaxedError> { Ok((secant(walls)? / rest - 1.0).abs()) };
    let look = FIRST * (part / off(FIRST)?).sqrt();
    if look > FARTHEST {
        return Ok(f64::INFINITY);
    }
    let walls = look * (part / off(look)?).sqrt();
    Ok(walls * body.thickness / arm)
}

/// What a unit of the motion moves the sleeve by where it goes farthest: 1, or m a radian.
pub fn lever(motion: SleeveMotion, body: &Bushing) -> f64 {
    let (radius, half) = (0.5 * body.inner_diameter, 0.5 * body.length);
    match motion {
        SleeveMotion::Radial | SleeveMotion::Axial => 1.0,
        SleeveMotion::Torsional => radius,
        SleeveMotion::Conical => (radius * radius + half * half).sqrt(),
    }
}

/// Relaxed force or moment over the motion, N/m or N·m/rad; in parts that change strains by up to `strain` in place of those of
/// [`relaxed`].
///
/// # Errors
/// Those of [`relaxed`]; a mesh of four-node elements.
pub fn stiffness(
    mesh: &TetMesh,
    material: &Elastomer,
    motion: SleeveMotion,
    amount: f64,
    strain: Option<f64>,
) -> Result<f64, RelaxedError> {
    const HELD: Option<Profile> = Some(Profile::ZERO);
    let Elements::Quadratic(elements) = &mesh.elements else {
        return Err(crate::solids::rubber::error::RubberError::FourNodes.into());
    };
    let inner = mesh.node_sets.get("inner").map(Vec::as_slice).unwrap_or_default();
    let mut prescribed = supports(mesh, &[("outer", [HELD; 3])]);
    for &node in inner {
        let place = mesh.nodes[node as usize];
        let by = motion.displacement_by(amount, place);
        let of = |axis: usize| Prescribed { node, axis, profile: Profile::Constant(by[axis]) };
        prescribed.extend([0, 1, 2].map(of));
    }
    let model = RubberModel::new(RubberProblem {
        nodes: mesh.nodes.clone(),
        elements: elements.clone(),
        material: material.clone(),
        prescribed,
        loads: Vec::new(),
    })?;
    let found = match strain {
        Some(strain) => relaxed_in_parts(&model, 0.0, strain)?,
        None => relaxed(&model, 0.0)?,
    };
    let pushes = inner.iter().map(|&node| {
        let node = node as usize;
        let place = add(mesh.nodes[node], found.state.displacement[node]);
        dot(found.reactions[node], motion.displacement(place))
    });
    Ok(pushes.sum::<f64>() / amount)
}
