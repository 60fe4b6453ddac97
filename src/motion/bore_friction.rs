//! Friction of a race in the bore of a solid in explicit steps: one spring for each contact node, updated once in every
//! step of the solid.

use crate::ch2_housing::bore_contact::{ContactNode, ContactSum, Frame, Touch};
use crate::ch4_rotor::bore_friction::{BoreFriction, FrictionUpdate, Spring};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale};
pub use crate::solids::contact::Pressed;
use crate::solids::contact::press_and;
use crate::solids::tet4_blocks::Node;

/// Friction forces at one time, and energies until then.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionSum {
    /// Force on the race, N.
    pub force: Vec3,
    /// Moment on the race about its centre, N·m.
    pub moment: Vec3,
    /// Number of slipping nodes.
    pub slipping: usize,
    /// Stored in the springs, J.
    pub stored: f64,
    /// Heat of slip since the start, J.
    pub heat: f64,
    /// Energy stored in the springs by changes of the normal load since the start, J; see
    /// [`FrictionUpdate::load_work`].
    pub load_work: f64,
}

impl FrictionSum {
    /// Energy taken from bodies and solids since the start, J.
    pub fn taken(&self) -> f64 {
        self.stored + self.heat - self.load_work
    }
}

/// A node's number and its spring.
pub type NodeSpring = (u32, Spring);

/// Friction of a housing fit at the present time.
#[derive(Clone, Debug)]
pub struct SeatFriction {
    pub law: BoreFriction,
    /// Springs of the nodes in contact in the last step, ascending.
    pub springs: Vec<NodeSpring>,
    /// Sums of the last step.
    pub sum: FrictionSum,
    /// Number of spring updates in all steps.
    pub updates: u64,
    /// Springs of the present step.
    next: Vec<NodeSpring>,
}

impl SeatFriction {
    /// Friction of a housing fit with this number of nodes.
    pub fn new(law: BoreFriction, nodes: usize) -> SeatFriction {
        let [springs, next] = [(), ()].map(|()| Vec::with_capacity(nodes));
        SeatFriction { law, springs, sum: FrictionSum::default(), updates: 0, next }
    }

    /// Contact and friction in a step of the solid, with an update of the springs; adds both to the forces of the nodes
    /// (N).
    pub fn step(&mut self, pressed: &Pressed, forces: &mut [Node]) -> ContactSum {
        let SeatFriction { law, springs, sum, updates, next } = self;
        next.clear();
        let (contact, now) =
            pull_all(law, springs, *sum, pressed, forces, |node, spring| next.push((node, spring)));
        std::mem::swap(springs, next);
        *sum = now;
        *updates += contact.touching as u64;
        contact
    }

    /// The same without an update of the springs.
    pub fn check(&self, pressed: &Pressed, forces: &mut [Node]) -> (ContactSum, FrictionSum) {
        pull_all(&self.law, &self.springs, self.sum, pressed, forces, |_, _| {})
    }
}

/// Walk through the springs of the last step in step with the contact nodes.
struct Walk<'s> {
    left: &'s [NodeSpring],
    /// Energy in springs of nodes that have lost contact, J.
    released: f64,
}

impl Walk<'_> {
    /// Spring of a node; without stiffness if it was not in contact.
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

    /// Energy left in the springs of nodes not visited, J.
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
            law.update(&before, place, normal, load, stiffness);
        keep(node.node, spring);
        sum.heat += heat;
        sum.load_work += load_work;
        if spring.stiffness == 0.0 {
            return None;
        }
        sum.slipping += usize::from(slips);
        sum.stored += spring.energy();
        // Force of the node on the race.
        let on_race = to_world(frame, spring.force());
        sum.force = add(sum.force, on_race);
        sum.moment = add(sum.moment, cross(touch.arm, on_race));
        Some(scale(on_race, -1.0))
    };
    let mut contact = press_and(pressed, forces, also);
    // The load fell to zero.
    sum.load_work -= walk.finish();
    contact.force = add(contact.force, sum.force);
    contact.moment = add(contact.moment, sum.moment);
    (contact, sum)
}

fn to_world(frame: &Frame, [x, y, z]: Vec3) -> Vec3 {
    let [along, across, up] = frame.to_body;
    add_scaled(add_scaled(scale(along, x), y, across), z, up)
}
