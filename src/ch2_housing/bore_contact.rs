//! Contact of a rigid cylinder with the surface of a deformable solid, (2.16)–(2.19): the outer race
//! in its bore, or the cylinder of 2.3.2 on a block.
//!
//! Both are one formula. A node of the solid that is nearer to the cylinder's axis than its radius
//! is pushed outwards: from within a bore that is towards the housing, from above a block into it.
//!
//! The cylinder has its own frame, X along its axis, and a finite width. Energy of a node is
//! ½ K (R − d)², its force the gradient; nodes beyond the width are not touched, and a node that
//! slides over the rim loses its energy at once.

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
    /// Along the axis, half to each side of the centre.
    pub width: f64,
}

/// Contact stiffness K of (2.19).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Penalty {
    /// N/m for each node, as printed. The finer the mesh, the stiffer the contact.
    PerNode(f64),
    /// N/m³: K is this times the node's share of the surface, so that pressure depends on
    /// penetration alone and not on the mesh.
    PerArea(f64),
}

/// K of 2.2.4 between outer race and steel, N/m.
pub const STEEL_NODE_STIFFNESS: f64 = 2.5e8;
/// Share of a node at which an area-weighted stiffness equals the printed one, m². The source states
/// no mesh; 1 mm² stands for bores meshed at about a millimetre.
pub const REFERENCE_AREA: f64 = 1e-6;

impl Penalty {
    /// Pressure over penetration such that a node of [`REFERENCE_AREA`] has the given stiffness.
    pub fn per_area_like(node_stiffness: f64) -> Penalty {
        Penalty::PerArea(node_stiffness / REFERENCE_AREA)
    }

    /// Stiffness of a node that carries `area` (m²) of the surface, N/m.
    pub fn of_node(self, area: f64) -> f64 {
        match self {
            Penalty::PerNode(stiffness) => stiffness,
            Penalty::PerArea(stiffness) => stiffness * area,
        }
    }
}

/// Area-weighted, with the source's value for steel at [`REFERENCE_AREA`].
impl Default for Penalty {
    fn default() -> Self {
        Penalty::per_area_like(STEEL_NODE_STIFFNESS)
    }
}

/// A surface node that may touch the cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactNode {
    pub node: u32,
    /// Undeformed place, m.
    pub place: Vec3,
    /// Its share of the surface, m².
    pub area: f64,
}

/// The nodes of `faces` that carry a share of their area, ascending.
///
/// Each corner of a three-node face has a third of it, each mid-side node of a six-node face what
/// [`Share::ThreeNodes`] gives it, a third where the face is flat: with these shares a uniform
/// pressure is what the elements take it for. Corners of six-node faces carry next to nothing, of
/// either sign, and are left out.
pub fn contact_nodes(mesh: &TetMesh, faces: &[Face]) -> Vec<ContactNode> {
    let areas = tributary_areas(mesh, faces, Share::ThreeNodes);
    let with_share = areas.iter().enumerate().filter(|(_, area)| **area > 0.0);
    with_share
        .map(|(n, &area)| ContactNode { node: n as u32, place: mesh.nodes[n], area })
        .collect()
}

/// The cylinder's frame: what a loop over nodes needs of its pose.
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

    /// Body-fixed components of the vector from the centre to a place (2.17), m.
    pub fn seen(&self, place: Vec3) -> Vec3 {
        let from_centre = sub(place, self.centre);
        self.to_body.map(|axis| dot(axis, from_centre))
    }
}

/// A node inside the cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// R − d, m.
    pub penetration: f64,
    /// d of (2.18), m.
    pub distance: f64,
    /// Outward normal of the cylinder at the node, inertial frame.
    pub normal: Vec3,
    /// Square to it and to the axis, inertial frame.
    pub tangent: Vec3,
    /// From the cylinder's centre to the node, inertial frame, m.
    pub arm: Vec3,
}

/// Whether a node at `place` (m) is inside the cylinder, (2.17) and (2.18). On the axis there is no
/// normal: its components are then not numbers.
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
    /// Force on the node (2.19), N; the cylinder gets its negative.
    pub fn force(&self, stiffness: f64) -> Vec3 {
        scale(self.normal, stiffness * self.penetration)
    }

    /// ½ K (R − d)², J.
    pub fn energy(&self, stiffness: f64) -> f64 {
        0.5 * stiffness * self.penetration * self.penetration
    }

    /// Minus the derivative of the force by the node's place, N/m: K n nᵀ − K (R − d)/d t tᵀ. The
    /// normal turns as the node moves round the cylinder, which pushes it on.
    pub fn stiffness(&self, stiffness: f64) -> Mat3 {
        let geometric = stiffness * self.penetration / self.distance;
        let (n, t) = (self.normal, self.tangent);
        let entry = |i: usize, j: usize| stiffness * n[i] * n[j] - geometric * t[i] * t[j];
        [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| entry(i, j)))
    }

    /// K n nᵀ alone: positive, where the whole would turn a soft solid unstable at a penetration far
    /// beyond that of equilibrium.
    pub fn normal_stiffness(&self, stiffness: f64) -> Mat3 {
        let n = self.normal;
        [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| stiffness * n[i] * n[j]))
    }
}

/// What a contact does to the cylinder, and its measures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactSum {
    /// On the cylinder, N.
    pub force: Vec3,
    /// On the cylinder about its centre, N·m.
    pub moment: Vec3,
    /// Σ K (R − d): what the contact resists growth of the radius with, N.
    pub radial_load: f64,
    /// Of the penalty springs, J.
    pub energy: f64,
    /// Largest penetration, m.
    pub deepest: f64,
    /// Largest nodal force over the node's share of the surface, Pa.
    pub peak_pressure: f64,
    pub touching: usize,
    pub tested: usize,
}

/// Contact of `nodes`, displaced by `displacement` (m, by node number): calls `on_touch` with each
/// node that touches, its stiffness (N/m) and its force (N), in the order of the list.
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

/// Splits nodes into those within `reach` (m) of touching and those beyond: as long as the motion
/// of a far node, of the cylinder at its place, and the growth of the radius sum to less than
/// `reach`, it cannot touch and need not be tested.
pub fn split_by_distance(
    cylinder: &Cylinder,
    frame: &Frame,
    nodes: &[ContactNode],
    displacement: impl Fn(u32) -> Vec3,
    reach: f64,
) -> (Vec<ContactNode>, Vec<ContactNode>) {
    nodes.iter().partition(|node| {
        let [x, y, z] = frame.seen(add(node.place, displacement(node.node)));
        let (gap, beside) =
            ((y * y + z * z).sqrt() - cylinder.radius, x.abs() - 0.5 * cylinder.width);
        // Not `>=`: a place that is not a number stays among those tested.
        !(gap > reach || beside > reach)
    })
}
