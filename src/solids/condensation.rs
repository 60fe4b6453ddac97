//! A linear elastic solid condensed onto the radial displacement of its bore nodes.
//!
//! Contact without friction acts along the normals of the bore and depends on displacements along them. So contact
//! needs the outward displacement of node i under an outward force on node j: a dense compliance, one solve of the
//! sparse stiffness for each node.

use crate::ch2_housing::bore_contact::{ContactNode, Frame};
use crate::kinematics::Pose;
use crate::kinematics::euler::{angles, quaternion};
use crate::kinematics::vec3::{Vec3, add, dot, scale};
use crate::numeric::dense::DenseSymmetric;
use crate::numeric::sparse::{Factor, Memory};
use crate::plan::Stage;
use crate::plan::counts::Counts;
use crate::solids::error::{SolidError, at_rest};
use crate::solids::memory::condensed;
use crate::solids::model::SolidModel;
use crate::solids::modes::{ModeError, ModeOptions, Modes, modes_of_fixed};
use crate::solids::tangent::{PRESCRIBED, Unknowns, pattern, stiffness};
use nalgebra::Vector3;
use std::fmt;
use thiserror::Error;

/// Range of possible contact in a bore.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Nominal pose of the race, its axis along its own X.
    pub nominal: Pose,
    /// Largest radius of the race, m.
    pub radius: f64,
    /// Axial width of the race, m. Nodes beside it are left out.
    pub width: f64,
    /// Largest displacement of a bore node and the race towards each other, m: nodes farther from the race are left
    /// out. `None`: all nodes under the race are kept.
    pub travel: Option<f64>,
}

/// Fraction of the width by which a node may be outside each end and still count as under the race: rounding of nodes
/// on its rim.
const RIM: f64 = 1e-3;

/// Returns whether a node at `along` (m from the race's centre, along its axis) is under a race of `width` (m).
pub fn is_under(along: f64, width: f64) -> bool {
    along.abs() <= (0.5 + RIM) * width
}

/// Axial displacement over the rim of a race of `width` (m) at which a bore node is still in contact, m: half of a
/// node's share, since the part of the bore that it represents is still under the race, and at most a quarter of the
/// width. `areas` (m²) are those of the nodes under the race.
pub fn rim(areas: impl ExactSizeIterator<Item = f64>, width: f64) -> f64 {
    let count = areas.len().max(1);
    let area: f64 = areas.sum();
    (0.5 * (area / count as f64).sqrt()).min(0.25 * width)
}

/// Number of right-hand sides solved at once.
const BLOCK: usize = 32;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum CondenseError {
    #[error(transparent)]
    Solid(SolidError),
    #[error(
        "none of the {bore} bore nodes is within the width of the race; check the width and position of the race"
    )]
    NoNodes { bore: usize },
    #[error(
        "node {node} has a prescribed displacement of {value:.3e} m; a condensed housing is fixed at \
         zero"
    )]
    PrescribedSupport { node: u32, value: f64 },
    #[error("bore node {node} is on the race's axis, where there is no radial direction")]
    OnAxis { node: u32 },
}

/// A bore node of the condensed solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoreNode {
    pub node: u32,
    /// Position from the race's nominal centre, in its nominal axes, m.
    pub arm: Vec3,
    /// Components of the outward normal on the nominal Y and Z.
    pub normal: [f64; 2],
    /// Distance from the race's nominal axis, m.
    pub distance: f64,
    /// Share of the bore surface, m².
    pub area: f64,
}

/// Size of a condensation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// Bore nodes with a share of its surface.
    pub bore: usize,
    /// Nodes left out beside the race.
    pub beside: usize,
    /// Nodes left out for their distance from the race.
    pub outside_range: usize,
    pub kept: usize,
    /// Free displacement components of the solid.
    pub unknowns: usize,
}

/// A solid condensed onto its bore.
pub struct CondensedBore {
    pub reach: Reach,
    pub nodes: Vec<BoreNode>,
    /// Outward displacement of node i under an outward unit force on node j, m/N.
    pub compliance: DenseSymmetric,
    /// Asymmetry of the compliance as solved, over its largest entry.
    pub asymmetry: f64,
    /// Outward displacement of the nodes under the solid's own loads and weight, m.
    pub own: Vec<f64>,
    /// Energy of these loads in the solid without contact, J.
    pub own_energy: f64,
    pub sizes: Sizes,
    /// Young's modulus of the solid, Pa.
    pub youngs_modulus: f64,
    frame: Frame,
    factor: Factor,
    unknowns: Unknowns,
    own_displacement: Vec<Vec3>,
    /// Number of runs of each stage.
    pub ran: Counts,
}

impl fmt::Debug for CondensedBore {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        let CondensedBore { reach, sizes, .. } = self;
        to.debug_struct("CondensedBore").field("reach", reach).field("sizes", sizes).finish()
    }
}

/// The bore nodes under the race, and the number of those left out.
struct Picked {
    frame: Frame,
    nodes: Vec<BoreNode>,
    sizes: Sizes,
}

/// Size of the condensation onto `bore`, without solving.
///
/// # Errors
///
/// See [`condense`], except for a solid that is free to move.
pub fn sizes(
    model: &SolidModel,
    unknowns: &Unknowns,
    bore: &[ContactNode],
    reach: &Reach,
) -> Result<Sizes, CondenseError> {
    Ok(pick(model, unknowns, bore, reach)?.sizes)
}

/// Memory of a condensation of this size.
pub fn memory(unknowns: &Unknowns, sizes: &Sizes) -> Memory {
    condensed(unknowns, sizes.kept, BLOCK)
}

fn pick(
    model: &SolidModel,
    unknowns: &Unknowns,
    bore: &[ContactNode],
    reach: &Reach,
) -> Result<Picked, CondenseError> {
    for held in &model.problem.prescribed {
        let value = held.profile.value(0.0);
        if value != 0.0 || !held.profile.is_zero() {
            return Err(CondenseError::PrescribedSupport { node: held.node, value });
        }
    }
    let frame = Frame::new(&reach.nominal);
    let mut sizes =
        Sizes { bore: bore.len(), beside: 0, outside_range: 0, kept: 0, unknowns: unknowns.count };
    let mut nodes = Vec::with_capacity(bore.len());
    for contact in bore {
        let arm = frame.seen(contact.place);
        let distance = (arm[1] * arm[1] + arm[2] * arm[2]).sqrt();
        if !is_under(arm[0], reach.width) {
            sizes.beside += 1;
        } else if reach.travel.is_some_and(|travel| distance - reach.radius > travel) {
            sizes.outside_range += 1;
        } else if distance == 0.0 {
            return Err(CondenseError::OnAxis { node: contact.node });
        } else {
            let normal = [arm[1] / distance, arm[2] / distance];
            nodes.push(BoreNode { node: contact.node, arm, normal, distance, area: contact.area });
        }
    }
    sizes.kept = nodes.len();
    if nodes.is_empty() {
        return Err(CondenseError::NoNodes { bore: bore.len() });
    }
    Ok(Picked { frame, nodes, sizes })
}

/// Condenses `model` at zero displacement onto the nodes of `bore` under the race.
///
/// # Errors
///
/// A solid that is free to move, supports that move, no node under the race.
pub fn condense(
    model: &SolidModel,
    bore: &[ContactNode],
    reach: &Reach,
) -> Result<CondensedBore, CondenseError> {
    condense_over(model, Unknowns::new(model), bore, reach)
}

/// The same over given unknowns.
///
/// # Errors
///
/// See [`condense`].
pub fn condense_over(
    model: &SolidModel,
    unknowns: Unknowns,
    bore: &[ContactNode],
    reach: &Reach,
) -> Result<CondensedBore, CondenseError> {
    let Picked { frame, nodes, sizes } = pick(model, &unknowns, bore, reach)?;
    let mut matrix = pattern(&model.problem, &unknowns);
    stiffness(model, &unknowns, &vec![[0.0; 3]; model.mass.len()], &mut matrix);
    let factor = unknowns.factor(&matrix).map_err(|error| {
        let error = at_rest(error, &model.problem.nodes, &model.labels, &unknowns);
        CondenseError::Solid(error)
    })?;
    drop(matrix);

    let count = nodes.len();
    let outward: Vec<Vec3> = nodes.iter().map(|node| in_world(&frame, node.normal)).collect();
    let mut compliance = Vec::with_capacity(count * count);
    for block in (0..count).step_by(BLOCK).map(|start| start..(start + BLOCK).min(count)) {
        let columns = block.len();
        let mut right = vec![0.0; columns * unknowns.count];
        for (column, loaded) in right.chunks_exact_mut(unknowns.count).zip(block) {
            scatter(&unknowns, nodes[loaded].node, outward[loaded], column);
        }
        factor.solve_columns(&mut right, columns);
        for column in right.chunks_exact(unknowns.count) {
            let along = |(node, &outward): (&BoreNode, &Vec3)| {
                dot(gather(&unknowns, node.node, column), outward)
            };
            compliance.extend(nodes.iter().zip(&outward).map(along));
        }
    }
    let (compliance, asymmetry) = DenseSymmetric::new(count, compliance);

    let mut forces = vec![[0.0; 4]; model.mass.len()];
    let mut ran = Counts::default();
    ran.add(Stage::Elements, model.problem.elements.len() as u64);
    ran.add(Stage::Supports, unknowns.held() as u64);
    model.add_static_forces(0.0, &mut forces, &mut ran);
    let loaded = forces.iter().any(|force| *force != [0.0; 4]);
    let own_displacement = if loaded {
        let mut right = vec![0.0; unknowns.count];
        for (node, force) in (0u32..).zip(&forces) {
            scatter(&unknowns, node, [force[0], force[1], force[2]], &mut right);
        }
        factor.solve(&mut right);
        (0..model.mass.len() as u32).map(|node| gather(&unknowns, node, &right)).collect()
    } else {
        vec![[0.0; 3]; model.mass.len()]
    };
    let own = nodes
        .iter()
        .zip(&outward)
        .map(|(node, &outward)| dot(own_displacement[node.node as usize], outward));
    // Half of the work of constant loads along their own displacement.
    let work = forces.iter().zip(&own_displacement);
    let work: f64 = work.map(|([x, y, z, _], u)| dot([*x, *y, *z], *u)).sum();
    Ok(CondensedBore {
        reach: *reach,
        own: own.collect(),
        own_energy: 0.5 * work,
        nodes,
        compliance,
        asymmetry,
        sizes,
        youngs_modulus: model.problem.material.youngs_modulus(),
        frame,
        factor,
        unknowns,
        own_displacement,
        ran,
    })
}

impl CondensedBore {
    /// Displacement of all nodes, m, under outward forces on the bore nodes (N, in the order of `nodes`) and the
    /// solid's own loads.
    pub fn displacement(&self, loads: &[f64]) -> Vec<Vec3> {
        let by_contact = self.response(loads);
        by_contact.into_iter().zip(&self.own_displacement).map(|(u, own)| add(u, *own)).collect()
    }

    /// The same without the solid's own loads.
    pub fn response(&self, loads: &[f64]) -> Vec<Vec3> {
        self.response_to(self.nodal_forces(loads))
    }

    /// Displacement of all nodes, m, under forces on nodes (N).
    pub fn response_to(&self, forces: impl Iterator<Item = (u32, Vec3)>) -> Vec<Vec3> {
        let mut right = vec![0.0; self.unknowns.count];
        for (node, force) in forces {
            scatter(&self.unknowns, node, force, &mut right);
        }
        self.factor.solve(&mut right);
        self.field(&right)
    }

    /// The same for many loads, a block at a time.
    pub fn responses_to(&self, loads: &[Vec<(u32, Vec3)>]) -> Vec<Vec<Vec3>> {
        let size = self.unknowns.count;
        let mut all = Vec::with_capacity(loads.len());
        for block in loads.chunks(BLOCK) {
            let mut right = vec![0.0; block.len() * size];
            for (forces, column) in block.iter().zip(right.chunks_exact_mut(size)) {
                for (node, force) in forces {
                    scatter(&self.unknowns, *node, *force, column);
                }
            }
            self.factor.solve_columns(&mut right, block.len());
            all.extend(right.chunks_exact(size).map(|column| self.field(column)));
        }
        all
    }

    /// Displacements of all nodes.
    fn field(&self, solution: &[f64]) -> Vec<Vec3> {
        let nodes = 0..self.unknowns.of.len() as u32;
        nodes.map(|node| gather(&self.unknowns, node, solution)).collect()
    }

    /// Outward forces on the bore nodes as vectors in the world, N.
    pub fn nodal_forces<'a>(&'a self, loads: &'a [f64]) -> impl Iterator<Item = (u32, Vec3)> + 'a {
        let force = |(node, &load): (&BoreNode, &f64)| {
            (node.node, scale(in_world(&self.frame, node.normal), load))
        };
        self.nodes.iter().zip(loads).map(force)
    }

    /// Natural modes of the solid, `model`, by the existing factors.
    ///
    /// # Errors
    ///
    /// See [`modes_of_fixed`].
    pub fn modes(&self, model: &SolidModel, options: &ModeOptions) -> Result<Modes, ModeError> {
        modes_of_fixed(model, &self.unknowns, &self.factor, options)
    }

    /// The unknowns of the solid.
    pub fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    /// World components of a vector in the race's nominal axes.
    pub fn to_world(&self, vector: Vec3) -> Vec3 {
        self.reach.nominal.orientation.transform_vector(&Vector3::from(vector)).into()
    }

    /// Position (m) and tilts (rad) in the world of a race at a pose from its nominal one.
    pub fn race(&self, pose: &[f64; 4]) -> [f64; 5] {
        let race = placed(&self.reach.nominal, pose);
        let (_, tilt_y, tilt_z) = angles(&race.orientation);
        let at = race.position;
        [at.x, at.y, at.z, tilt_y, tilt_z]
    }

    /// Components in the race's nominal axes of a world vector.
    pub fn to_nominal(&self, vector: Vec3) -> Vec3 {
        self.reach.nominal.orientation.inverse_transform_vector(&Vector3::from(vector)).into()
    }
}

/// Error of the distances from the race's axis with fixed normals: the largest difference over the bore nodes, m, from
/// those of the displaced nodes (m, one vector for each node of the solid) and the race at its pose (y, z in m, tilts
/// in rad).
pub fn geometry_error(bore: &CondensedBore, displacement: &[Vec3], pose: &[f64; 4]) -> f64 {
    let moved = bore.nodes.iter().map(|node| displacement[node.node as usize]);
    beyond_normals(bore, moved, pose).fold(0.0, |largest: f64, beyond| largest.max(beyond.abs()))
}

/// By how much each node is farther from the race's axis than its motion along its normal and that of the race make it, m; `moved` are
/// the displacements of the bore's nodes in the world, m.
pub fn beyond_normals<'a>(
    bore: &'a CondensedBore,
    moved: impl Iterator<Item = Vec3> + 'a,
    pose: &'a [f64; 4],
) -> impl Iterator<Item = f64> + 'a {
    let race = Frame::new(&placed(&bore.reach.nominal, pose));
    bore.nodes.iter().zip(moved).map(move |(node, u)| {
        let place = add(add(bore.reach.nominal.position.into(), bore.to_world(node.arm)), u);
        let [_, y, z] = race.seen(place);
        let exact = (y * y + z * z).sqrt() - node.distance;
        let outward = in_world(&bore.frame, node.normal);
        exact - (dot(u, outward) - race_motion(node, pose))
    })
}

/// Outward displacement of the race's surface at a node for small coordinates of the race: y, z (m) and the tilts about
/// Y and Z (rad).
pub(crate) fn race_motion(node: &BoreNode, pose: &[f64; 4]) -> f64 {
    let by = lever(node);
    by[0] * pose[0] + by[1] * pose[1] + by[2] * pose[2] + by[3] * pose[3]
}

/// Derivatives of [`race_motion`]: the normal, and its moment about the race's Y and Z.
pub(crate) fn lever(node: &BoreNode) -> [f64; 4] {
    let [ny, nz] = node.normal;
    [ny, nz, -node.arm[0] * nz, node.arm[0] * ny]
}

/// The race moved by its coordinates y, z, tilt_y, tilt_z from the nominal pose.
pub fn placed(nominal: &Pose, pose: &[f64; 4]) -> Pose {
    let own = Pose {
        position: Vector3::new(0.0, pose[0], pose[1]),
        orientation: quaternion(0.0, pose[2], pose[3]),
    };
    own.seen_from_parent_of(nominal)
}

fn in_world(frame: &Frame, [ny, nz]: [f64; 2]) -> Vec3 {
    add(scale(frame.to_body[1], ny), scale(frame.to_body[2], nz))
}

/// Adds a force on a node to a right-hand side; fixed components ignore it.
fn scatter(unknowns: &Unknowns, node: u32, force: Vec3, right: &mut [f64]) {
    for (of, force) in unknowns.of[node as usize].into_iter().zip(force) {
        if of != PRESCRIBED {
            right[of] += force;
        }
    }
}

fn gather(unknowns: &Unknowns, node: u32, solution: &[f64]) -> Vec3 {
    unknowns.of[node as usize].map(|of| if of == PRESCRIBED { 0.0 } else { solution[of] })
}
