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

/// Where a cylinder is, and how large, over time.
#[derive(Clone, Debug, PartialEq)]
pub struct CylinderPath {
    /// Pose before any displacement.
    pub start: Pose,
    /// Displacement of the centre, m.
    pub displacement: [Profile; 3],
    /// Radius, m; an interference grows in by it.
    pub radius: Profile,
}

/// A cylinder that may touch some nodes of a solid.
#[derive(Clone, Debug, PartialEq)]
pub struct CylinderContact {
    pub path: CylinderPath,
    /// Of the cylinder, along its axis, m.
    pub width: f64,
    pub penalty: Penalty,
    /// From [`contact_nodes`](crate::ch2_housing::bore_contact::contact_nodes).
    pub nodes: Vec<ContactNode>,
}

impl CylinderContact {
    /// The cylinder at time `t`.
    pub fn at(&self, t: f64) -> (Cylinder, Frame) {
        self.part_way(t, 1.0)
    }

    /// As at time `t`, but gone a fraction of the way from its start and its radius at time 0.
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

/// The step limit of a solid whose contact is closed at every one of `nodes`: by Weyl's bound its
/// highest frequency squared is at most the body's own plus the largest K/m.
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

/// Where a cylinder is, and the solid around it.
pub struct Pressed<'s> {
    pub cylinder: &'s Cylinder,
    pub frame: &'s Frame,
    pub penalty: Penalty,
    /// Ascending.
    pub nodes: &'s [ContactNode],
    /// m, for each node of the solid.
    pub displacement: &'s [Node],
}

/// Contact of a cylinder with nodes; adds its forces to theirs, N.
pub fn press(pressed: &Pressed, forces: &mut [Node]) -> ContactSum {
    press_and(pressed, forces, |_, _, _| None)
}

/// The same with a further force (N) on nodes that touch, if there is one: `also` is given the node, its contact and how
/// stiff that is (N/m).
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
