//! Contact of a rigid cylinder with the surface of a deformable solid, (2.16)–(2.19): the outer race in its bore, or
//! the cylinder on a block in 2.3.2.
//!
//! Both cases use the same formula. A node of the solid closer to the cylinder's axis than its radius is forced
//! outwards.
//!
//! The cylinder has its own frame, X along its axis, and a finite width. The energy of a node is ½ K (R − d)², its
//! force the gradient. Nodes beyond the width have no contact; a node that slides over the rim loses its energy at
//! once.

use crate::kinematics::Pose;
use crate::kinematics::strain::Mat3;
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};
use crate::mesh::measure::{Share, tributary_areas};
use crate::mesh::{Face, TetMesh};

/// A rigid cylinder about the X axis of its own frame, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// R_OR of (2.19).
    pub radius: f64,
    /// Width along the axis, m, centred on the origin.
    pub width: f64,
}

/// Contact stiffness K of (2.19).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Penalty {
    /// N/m per node, as printed. The contact becomes stiffer as the mesh is refined.
    PerNode(f64),
    /// N/m³: K is this value times the node's tributary area, so that pressure depends only on penetration and not on
    /// the mesh.
    PerArea(f64),
}

/// K of 2.2.4 between outer race and steel, N/m.
pub const STEEL_NODE_STIFFNESS: f64 = 2.5e8;
/// Tributary area of a node at which an area-weighted stiffness equals the printed one, m². The dissertation gives no
/// mesh; 1 mm² represents bores meshed at about 1 mm.
pub const REFERENCE_AREA: f64 = 1e-6;

impl Penalty {
    /// Area-weighted stiffness for which a node of [`REFERENCE_AREA`] has `node_stiffness` (N/m).
    pub fn per_area_like(node_stiffness: f64) -> Penalty {
        Penalty::PerArea(node_stiffness / REFERENCE_AREA)
    }

    /// Stiffness of a node with tributary area `area` (m²), N/m.
    pub fn of_node(self, area: f64) -> f64 {
        match self {
            Penalty::PerNode(stiffness) => stiffness,
            Penalty::PerArea(stiffness) => stiffness * area,
        }
    }
}

/// Area-weighted, with the printed value for steel at [`REFERENCE_AREA`].
impl Default for Penalty {
    fn default() -> Self {
        Penalty::per_area_like(STEEL_NODE_STIFFNESS)
    }
}

/// Surface node that can touch the cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactNode {
    pub node: u32,
    /// Undeformed position, m.
    pub place: Vec3,
    /// Tributary area of the surface, m².
    pub area: f64,
}

/// Nodes of `faces` with a tributary area, ascending.
///
/// Each corner of a three-node face has a third of its area; each mid-side node of a six-node face has its
/// [`Share::ThreeNodes`], a third for a flat face. With these areas a uniform pressure gives the consistent nodal
/// forces. Corners of six-node faces have nearly zero areas of either sign and are left out.
pub fn contact_nodes(mesh: &TetMesh, faces: &[Face]) -> Vec<ContactNode> {
    let areas = tributary_areas(mesh, faces, Share::ThreeNodes);
    let with_share = areas.iter().enumerate().filter(|(_, area)| **area > 0.0);
    with_share
        .map(|(n, &area)| ContactNode { node: n as u32, place: mesh.nodes[n], area })
        .collect()
}

/// Position and orientation of the cylinder for a loop over nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Centre C of the cylinder in the inertial frame, m.
    pub centre: Vec3,
    /// T_trans of (2.16): its rows are the body-fixed axes.
    pub to_body: Mat3,
}

impl Frame {
    pub fn new(pose: &Pose) -> Frame {
        let rotation = pose.orientation.to_rotation_matrix();
        let row = |i: usize| [0, 1, 2].map(|j: usize| rotation[(j, i)]);
        Frame { centre: pose.position.into(), to_body: [row(0), row(1), row(2)] }
    }

    /// Body-fixed components of the vector from the centre to `place` (2.17), m.
    pub fn seen(&self, place: Vec3) -> Vec3 {
        let from_centre = sub(place, self.centre);
        self.to_body.map(|axis| dot(axis, from_centre))
    }
}

/// Contact of a node inside the cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// R − d, m.
    pub penetration: f64,
    /// d of (2.18), m.
    pub distance: f64,
    /// Outward normal of the cylinder at the node, inertial frame.
    pub normal: Vec3,
    /// Circumferential unit vector at the node, perpendicular to normal and axis, inertial frame.
    pub tangent: Vec3,
    /// From the cylinder's centre to the node, inertial frame, m.
    pub arm: Vec3,
}

/// Contact of a node at `place` (m), (2.17) and (2.18); `None` if it is outside the cylinder. On the axis the normal is
/// undefined and its components are NaN.
#[inline]
pub fn touch(cylinder: &Cylinder, frame: &Frame, place: Vec3) -> Option<Touch> {
    let [x, y, z] = frame.seen(place);
    let distance = (y * y + z * z).sqrt();
    if !(distance < cylinder.radius && x.abs() <= 0.5 * cylinder.width) {
        return None;
    }
    let [_, across, up] = frame.to_body;
    let (cos, sin) = (y / distance, z / distance);
    Some(Touch {
        penetration: cylinder.radius - distance,
        distance,
        normal: add_scaled(scale(across, cos), sin, up),
        tangent: add_scaled(scale(across, -sin), cos, up),
        arm: sub(place, frame.centre),
    })
}

impl Touch {
    /// Force on the node (2.19), N; the cylinder takes the opposite force.
    pub fn force(&self, stiffness: f64) -> Vec3 {
        scale(self.normal, stiffness * self.penetration)
    }

    /// ½ K (R − d)², J.
    pub fn energy(&self, stiffness: f64) -> f64 {
        0.5 * stiffness * self.penetration * self.penetration
    }

    /// Tangent stiffness, minus the derivative of the force by the node's position, N/m: K n nᵀ − K (R − d)/d t tᵀ. The
    /// second term is negative because the normal turns as the node moves around the cylinder.
    pub fn stiffness(&self, stiffness: f64) -> Mat3 {
        let geometric = stiffness * self.penetration / self.distance;
        let (n, t) = (self.normal, self.tangent);
        let entry = |i: usize, j: usize| stiffness * n[i] * n[j] - geometric * t[i] * t[j];
        [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| entry(i, j)))
    }

    /// K n nᵀ alone, N/m: positive semidefinite. The full tangent can make a soft solid unstable at penetrations far
    /// beyond equilibrium.
    pub fn normal_stiffness(&self, stiffness: f64) -> Mat3 {
        let n = self.normal;
        [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| stiffness * n[i] * n[j]))
    }
}

/// Force and moment of a contact on the cylinder, with summary values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactSum {
    /// Force on the cylinder, N.
    pub force: Vec3,
    /// Moment on the cylinder about its centre, N·m.
    pub moment: Vec3,
    /// Radial contact load Σ K (R − d), which resists growth of the radius, N.
    pub radial_load: f64,
    /// Energy of the penalty springs, J.
    pub energy: f64,
    /// Largest penetration, m.
    pub deepest: f64,
    /// Largest ratio of nodal force to tributary area, Pa.
    pub peak_pressure: f64,
    pub touching: usize,
    pub tested: usize,
}

/// Contact of `nodes`, displaced by `displacement` (m, by node number). Calls `on_touch` with each contact node, its
/// stiffness (N/m) and its force (N), in the order of the list.
pub fn contact(
    cylinder: &Cylinder,
    frame: &Frame,
    penalty: Penalty,
    nodes: &[ContactNode],
    displacement: impl Fn(u32) -> Vec3,
    mut on_touch: impl FnMut(&ContactNode, &Touch, f64, Vec3),
) -> ContactSum {
    let mut sum = ContactSum { tested: nodes.len(), ..ContactSum::default() };
    for node in nodes {
        let place = add(node.place, displacement(node.node));
        let Some(touch) = touch(cylinder, frame, place) else { continue };
        let stiffness = penalty.of_node(node.area);
        let force = touch.force(stiffness);
        let load = stiffness * touch.penetration;
        sum.force = sub(sum.force, force);
        sum.moment = sub(sum.moment, cross(touch.arm, force));
        sum.radial_load += load;
        sum.energy += touch.energy(stiffness);
        sum.deepest = sum.deepest.max(touch.penetration);
        sum.peak_pressure = sum.peak_pressure.max(load / node.area);
        sum.touching += 1;
        on_touch(node, &touch, stiffness, force);
    }
    sum
}

/// Splits nodes into those within `margin` (m) of touching and those beyond. A far node needs no test as long
/// as its displacement, the cylinder's displacement there and the growth of the radius sum to less than `margin`.
pub fn split_by_distance(
    cylinder: &Cylinder,
    frame: &Frame,
    nodes: &[ContactNode],
    displacement: impl Fn(u32) -> Vec3,
    margin: f64,
) -> (Vec<ContactNode>, Vec<ContactNode>) {
    nodes.iter().partition(|node| {
        let [x, y, z] = frame.seen(add(node.place, displacement(node.node)));
        let (gap, beyond_rim) =
            ((y * y + z * z).sqrt() - cylinder.radius, x.abs() - 0.5 * cylinder.width);
        // Not `>=`: a NaN position stays among the tested nodes.
        !(gap > margin || beyond_rim > margin)
    })
}
