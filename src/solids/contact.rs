//! Contact of a rigid cylinder on a prescribed path with nodes of a solid. Race-bore contact ([`crate::motion::race_in_bore`]) uses the same sum.

use crate::ch2_housing::bore_contact::{
    ContactNode, ContactSum, Cylinder, Frame, Penalty, Touch, contact,
};
use crate::kinematics::Pose;
use crate::kinematics::vec3::Vec3;
use crate::numeric::profile::Profile;
use crate::solids::model::SolidModel;
use crate::solids::step_limit::SolidStepLimit;
use crate::solids::tet4_blocks::Node;

/// Position and radius of a cylinder over time.
#[derive(Clone, Debug, PartialEq)]
pub struct CylinderPath {
    /// Pose before any displacement.
    pub start: Pose,
    /// Displacement of the centre, m.
    pub displacement: [Profile; 3],
    /// Radius, m; a growing interference changes it.
    pub radius: Profile,
}

/// A cylinder that may be in contact with some nodes of a solid.
#[derive(Clone, Debug, PartialEq)]
pub struct CylinderContact {
    pub path: CylinderPath,
    /// Width along its axis, m.
    pub width: f64,
    pub penalty: Penalty,
    /// See [`contact_nodes`](crate::ch2_housing::bore_contact::contact_nodes).
    pub nodes: Vec<ContactNode>,
}

impl CylinderContact {
    /// The cylinder at time `t`.
    pub fn at(&self, t: f64) -> (Cylinder, Frame) {
        self.part_way(t, 1.0)
    }

    /// The cylinder with a fraction of its displacement and of its growth at time `t`.
    pub fn part_way(&self, t: f64, fraction: f64) -> (Cylinder, Frame) {
        let CylinderPath { start, displacement, radius } = &self.path;
        let mut frame = Frame::new(start);
        for i in 0..3 {
            frame.centre[i] += fraction * displacement[i].value(t);
        }
        let first = radius.value(0.0);
        let radius = first + fraction * (radius.value(t) - first);
        (Cylinder { radius, width: self.width }, frame)
    }
}

/// Step limit of a solid with all of `nodes` in contact: by Weyl's bound the square of its highest frequency grows by
/// at most the largest K/m.
pub fn closed_limit(
    model: &SolidModel,
    nodes: &[ContactNode],
    penalty: Penalty,
    of_solid: &SolidStepLimit,
) -> SolidStepLimit {
    let of_node = |node: &ContactNode| {
        let per_mass = model.per_mass[node.node as usize];
        penalty.of_node(node.area) * per_mass[0].max(per_mass[1]).max(per_mass[2])
    };
    of_solid.with(nodes.iter().map(of_node).fold(0.0, f64::max))
}

/// A cylinder and the solid around it.
pub struct Pressed<'s> {
    pub cylinder: &'s Cylinder,
    pub frame: &'s Frame,
    pub penalty: Penalty,
    /// Ascending.
    pub nodes: &'s [ContactNode],
    /// Displacement of each node, m.
    pub displacement: &'s [Node],
}

/// Contact of a cylinder with nodes; adds its forces to theirs, N.
pub fn press(pressed: &Pressed, forces: &mut [Node]) -> ContactSum {
    press_and(pressed, forces, |_, _, _| None)
}

/// The same with an additional force (N) on contact nodes: `also` returns it for a node, its contact and its contact
/// stiffness (N/m).
pub fn press_and(
    pressed: &Pressed,
    forces: &mut [Node],
    mut also: impl FnMut(&ContactNode, &Touch, f64) -> Option<Vec3>,
) -> ContactSum {
    let Pressed { cylinder, frame, penalty, nodes, displacement } = *pressed;
    let moved = |n: u32| moved(displacement, n);
    contact(cylinder, frame, penalty, nodes, moved, |node, touch, stiffness, force| {
        let further = also(node, touch, stiffness);
        let sum = &mut forces[node.node as usize];
        for i in 0..3 {
            sum[i] += force[i];
        }
        if let Some(further) = further {
            for i in 0..3 {
                sum[i] += further[i];
            }
        }
    })
}

/// Displacement of a node, m.
pub fn moved(displacement: &[Node], node: u32) -> Vec3 {
    let u = &displacement[node as usize];
    [u[0], u[1], u[2]]
}
