//! Friction of a race in the bore of a solid in explicit steps: a spring for each node that touches, which changes
//! once in every step of the solid.

use crate::ch2_housing::bore_contact::{ContactNode, ContactSum, Frame, Touch};
use crate::ch4_rotor::bore_friction::{BoreFriction, FrictionUpdate, Spring};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale};
pub use crate::solids::contact::Pressed;
use crate::solids::contact::press_and;
use crate::solids::tet4_blocks::Node;

/// What friction does at one time, and has done until then.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionSum {
    /// On the race, N.
    pub force: Vec3,
    /// On the race about its centre, N·m.
    pub moment: Vec3,
    /// Nodes that slip.
    pub slipping: usize,
    /// In the springs, J.
    pub stored: f64,
    /// Of slipping, since the start, J.
    pub heat: f64,
    /// What changes of the normal load have stored in the springs since the start, J; see
    /// [`FrictionUpdate::load_work`].
    pub load_work: f64,
}

impl FrictionSum {
    /// What the surfaces have done to each other since the start, J: it has gone from bodies and solids.
    pub fn taken(&self) -> f64 {
        self.stored + self.heat - self.load_work
    }
}

/// A node's number and its spring.
pub type NodeSpring = (u32, Spring);

/// The friction of a seat at the present time.
#[derive(Clone, Debug)]
pub struct SeatFriction {
    pub law: BoreFriction,
    /// Of the nodes that touched in the last step, ascending.
    pub springs: Vec<NodeSpring>,
    /// As of the last step.
    pub sum: FrictionSum,
    /// Of springs, in all steps.
    pub pulls: u64,
    /// Of the step that is being taken.
    next: Vec<NodeSpring>,
}

impl SeatFriction {
    /// Of a seat with so many nodes.
    pub fn new(law: BoreFriction, nodes: usize) -> SeatFriction {
        let [springs, next] = [(), ()].map(|()| Vec::with_capacity(nodes));
        SeatFriction { law, springs, sum: FrictionSum::default(), pulls: 0, next }
    }

    /// Contact and friction in a step of the solid, after which the springs are those of this step; adds both to the
    /// nodes' forces (N).
    pub fn push(&mut self, pressed: &Pressed, forces: &mut [Node]) -> ContactSum {
        let SeatFriction { law, springs, sum, pulls, next } = self;
        next.clear();
        let (contact, now) =
            pull_all(law, springs, *sum, pressed, forces, |node, spring| next.push((node, spring)));
        std::mem::swap(springs, next);
        *sum = now;
        *pulls += contact.touching as u64;
        contact
    }

    /// The same without a step: nothing is kept.
    pub fn check(&self, pressed: &Pressed, forces: &mut [Node]) -> (ContactSum, FrictionSum) {
        pull_all(&self.law, &self.springs, self.sum, pressed, forces, |_, _| {})
    }
}

/// The springs of nodes that touched, walked through as nodes that touch come by.
struct Walk<'s> {
    left: &'s [NodeSpring],
    /// In springs of nodes that touch no longer, J.
    released: f64,
}

impl Walk<'_> {
    /// The spring of a node; one without stiffness where it did not touch.
    fn spring_of(&mut self, node: u32) -> Spring {
        while let [(other, spring), rest @ ..] = self.left
            && *other <= node
        {
            self.left = rest;
            if *other == node {
                return *spring;
            }
            self.released += spring.energy();
        }
        Spring::default()
    }

    /// What is left in springs that no node came by for, J.
    fn finish(self) -> f64 {
        self.left.iter().fold(self.released, |sum, (_, spring)| sum + spring.energy())
    }
}

fn pull_all(
    law: &BoreFriction,
    springs: &[NodeSpring],
    before: FrictionSum,
    pressed: &Pressed,
    forces: &mut [Node],
    mut keep: impl FnMut(u32, Spring),
) -> (ContactSum, FrictionSum) {
    let frame = pressed.frame;
    let FrictionSum { heat, load_work, .. } = before;
    let mut sum = FrictionSum { heat, load_work, ..FrictionSum::default() };
    let mut walk = Walk { left: springs, released: 0.0 };
    let also = |node: &ContactNode, touch: &Touch, stiffness: f64| {
        let [place, normal] =
            [touch.arm, touch.normal].map(|v| frame.to_body.map(|axis| dot(axis, v)));
        let before = walk.spring_of(node.node);
        let load = stiffness * touch.penetration;
        let FrictionUpdate { spring, slips, heat, load_work } =
            law.pull(&before, place, normal, load, stiffness);
        keep(node.node, spring);
        sum.heat += heat;
        sum.load_work += load_work;
        if spring.stiffness == 0.0 {
            return None;
        }
        sum.slipping += usize::from(slips);
        sum.stored += spring.energy();
        // The node drags the race along.
        let on_race = to_world(frame, spring.force());
        sum.force = add(sum.force, on_race);
        sum.moment = add(sum.moment, cross(touch.arm, on_race));
        Some(scale(on_race, -1.0))
    };
    let mut contact = press_and(pressed, forces, also);
    // The load was eased to nothing.
    sum.load_work -= walk.finish();
    contact.force = add(contact.force, sum.force);
    contact.moment = add(contact.moment, sum.moment);
    (contact, sum)
}

fn to_world(frame: &Frame, [x, y, z]: Vec3) -> Vec3 {
    let [along, across, up] = frame.to_body;
    add_scaled(add_scaled(scale(along, x), y, across), z, up)
}
