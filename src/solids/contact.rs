//! A rigid cylinder on a given path against a solid: data for equilibrium, and explicit steps of the
//! solid with the contact's work and impulse booked. Seats of races ([`crate::motion::race_in_bore`]) press by the same sum.

use crate::ch2_housing::bore_contact::{
    ContactNode, ContactSum, Cylinder, Frame, Penalty, Touch, contact, split_by_reach,
};
use crate::kinematics::Pose;
use crate::kinematics::vec3::{Vec3, add, add_scaled, dot, norm, sub};
use crate::numeric::profile::Profile;
use crate::solids::explicit::{ExplicitMethod, ExplicitSolid};
use crate::solids::model::{SolidError, SolidModel};
use crate::solids::step_limit::SolidStepLimit;
use crate::solids::tet4_blocks::Node;
use thiserror::Error;

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

    /// See [`closed_limit`].
    pub fn step_limit(&self, model: &SolidModel, of_solid: &SolidStepLimit) -> SolidStepLimit {
        closed_limit(model, &self.nodes, self.penalty, of_solid)
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

#[derive(Clone, Debug, PartialEq, Error)]
pub enum ContactError {
    #[error(transparent)]
    Solid(#[from] SolidError),
    #[error(
        "the step of {step:.3e} s is beyond the stability limit of {limit:.3e} s with the contact \
         closed; take a smaller step, a lower contact stiffness, or a coarser surface"
    )]
    Step { step: f64, limit: f64 },
    #[error(
        "at t = {time} s cylinder and surface have moved {moved:.3e} m towards each other within {} \
         steps, more than the reach of {reach:.3e} m within which nodes are tested; take a larger reach",
        LOOK
    )]
    Outrun { moved: f64, reach: f64, time: f64 },
}

/// Steps between two looks at whether nodes out of reach still are.
const LOOK: u64 = 16;

/// Energy held and work done since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactLedger {
    /// Work of the contact on the solid.
    pub on_solid: f64,
    /// Work of what moves the cylinder, and of what lets its radius grow.
    pub drive: f64,
    /// In the penalty springs.
    pub penalty: f64,
}

impl ContactLedger {
    /// Zero if all is accounted for: what the drive put in is in the solid or in the springs.
    pub fn balance(&self) -> f64 {
        self.on_solid + self.penalty - self.drive
    }
}

/// A contact that follows a solid in explicit steps.
pub struct ContactRun {
    pub contact: CylinderContact,
    /// As of the last evaluation.
    pub sum: ContactSum,
    /// ∫ force dt on the cylinder, N·s, as the method sums it.
    pub impulse: Vec3,
    pub ledger: ContactLedger,
    /// Nodes tested so far, and how often they were sorted by reach.
    pub tested: u64,
    pub sorts: u64,
    reach: f64,
    near: Vec<ContactNode>,
    far: Vec<(ContactNode, Vec3)>,
    sorted_at: (Cylinder, Frame),
    last: Snapshot,
}

/// What work is booked from: at the start of a step.
#[derive(Clone, Default)]
struct Snapshot {
    /// Of the near nodes.
    displacement: Vec<Vec3>,
    force: Vec<Vec3>,
    centre: Vec3,
    radius: f64,
    sum: ContactSum,
}

impl ContactRun {
    /// Nodes are tested while they may be within `reach` (m) of touching; infinite to test all always.
    ///
    /// # Errors
    /// A step that the closed contact makes unstable.
    pub fn new(
        contact: CylinderContact,
        solid: &ExplicitSolid,
        reach: f64,
    ) -> Result<ContactRun, ContactError> {
        let limit = contact.step_limit(&solid.model, &solid.limit).step;
        if solid.step_size.is_nan() || solid.step_size > limit {
            return Err(ContactError::Step { step: solid.step_size, limit });
        }
        let sorted_at = contact.at(solid.time);
        let mut run = ContactRun {
            contact,
            sum: ContactSum::default(),
            impulse: [0.0; 3],
            ledger: ContactLedger::default(),
            tested: 0,
            sorts: 0,
            reach,
            near: Vec::new(),
            far: Vec::new(),
            sorted_at,
            last: Snapshot::default(),
        };
        run.sort(solid.time, &solid.displacement);
        Ok(run)
    }

    /// One step of the solid with this contact.
    ///
    /// # Errors
    /// A value that is not finite; motion beyond the reach.
    pub fn step(&mut self, solid: &mut ExplicitSolid) -> Result<(), ContactError> {
        if solid.steps.is_multiple_of(LOOK) {
            self.check(solid.time, &solid.displacement)?;
        }
        let weights: &[f64] = match solid.method {
            ExplicitMethod::CentralDifferences => &[1.0],
            ExplicitMethod::RungeKutta => &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
        };
        let (h, mut stage) = (solid.step_size, 0);
        solid.step(|t, displacement, forces| {
            if stage == 0 {
                self.book(t, displacement);
            }
            self.add_forces(t, displacement, forces);
            self.impulse = add_scaled(self.impulse, h * weights[stage], self.sum.force);
            stage += 1;
        })?;
        Ok(())
    }

    /// Books what happened until now, and gives the ledger of the contact; the solid's own, with
    /// velocities under this contact, from [`ExplicitSolid::ledger_with`].
    pub fn ledger_at(&mut self, solid: &ExplicitSolid) -> ContactLedger {
        self.book(solid.time, &solid.displacement);
        self.ledger
    }

    /// Adds the contact's forces on the nodes, N.
    pub fn add_forces(&mut self, t: f64, displacement: &[Node], forces: &mut [Node]) {
        let (cylinder, frame) = self.contact.at(t);
        let penalty = self.contact.penalty;
        let (cylinder, frame, nodes) = (&cylinder, &frame, &self.near[..]);
        self.sum = press(&Pressed { cylinder, frame, penalty, nodes, displacement }, forces);
        self.tested += self.sum.tested as u64;
    }

    /// Nodes that touch now, with the force on each, N.
    pub fn nodal_forces(&self, t: f64, displacement: &[Node]) -> Vec<(ContactNode, Vec3)> {
        let (cylinder, frame) = self.contact.at(t);
        let moved = |n: u32| moved(displacement, n);
        let mut found = Vec::new();
        contact(&cylinder, &frame, self.contact.penalty, &self.near, moved, |node, _, _, force| {
            found.push((*node, force));
        });
        found
    }

    /// Work since the last snapshot by the trapezoidal rule: exact for springs, and what central
    /// differences balance their kinetic energy with.
    fn book(&mut self, t: f64, displacement: &[Node]) {
        let now = self.snapshot(t, displacement);
        let last = &self.last;
        for n in 0..self.near.len() {
            let way = sub(now.displacement[n], last.displacement[n]);
            self.ledger.on_solid += 0.5 * dot(add(now.force[n], last.force[n]), way);
        }
        let way = sub(now.centre, last.centre);
        self.ledger.drive -= 0.5 * dot(add(now.sum.force, last.sum.force), way);
        let load = now.sum.radial_load + last.sum.radial_load;
        self.ledger.drive += 0.5 * load * (now.radius - last.radius);
        self.ledger.penalty = now.sum.energy;
        self.last = now;
    }

    fn snapshot(&self, t: f64, displacement: &[Node]) -> Snapshot {
        let (cylinder, frame) = self.contact.at(t);
        let moved = |n: u32| moved(displacement, n);
        let displacements = self.near.iter().map(|node| moved(node.node)).collect();
        let mut forces = vec![[0.0; 3]; self.near.len()];
        let mut at = 0;
        let penalty = self.contact.penalty;
        let sum = contact(&cylinder, &frame, penalty, &self.near, moved, |node, _, _, force| {
            while self.near[at].node != node.node {
                at += 1;
            }
            forces[at] = force;
        });
        Snapshot {
            displacement: displacements,
            force: forces,
            centre: frame.centre,
            radius: cylinder.radius,
            sum,
        }
    }

    /// Sorts again once half of the reach is used up.
    fn check(&mut self, t: f64, displacement: &[Node]) -> Result<(), ContactError> {
        if self.far.is_empty() {
            return Ok(());
        }
        let (cylinder, frame) = self.contact.at(t);
        let by_nodes = self
            .far
            .iter()
            .map(|(node, then)| norm(sub(moved(displacement, node.node), *then)))
            .fold(0.0, f64::max);
        let by_cylinder = norm(sub(frame.centre, self.sorted_at.1.centre));
        let moved = by_nodes + by_cylinder + (cylinder.radius - self.sorted_at.0.radius).max(0.0);
        if moved > self.reach {
            return Err(ContactError::Outrun { moved, reach: self.reach, time: t });
        }
        if moved > 0.5 * self.reach {
            self.book(t, displacement);
            self.sort(t, displacement);
        }
        Ok(())
    }

    fn sort(&mut self, t: f64, displacement: &[Node]) {
        let (cylinder, frame) = self.contact.at(t);
        let moved = |n: u32| moved(displacement, n);
        let (near, far) = split_by_reach(&cylinder, &frame, &self.contact.nodes, moved, self.reach);
        self.near = near;
        self.far = far.into_iter().map(|node| (node, moved(node.node))).collect();
        self.sorted_at = (cylinder, frame);
        self.sorts += 1;
        self.last = self.snapshot(t, displacement);
        self.ledger.penalty = self.last.sum.energy;
    }

    /// How many nodes are tested, and how many are out of reach.
    pub fn counts(&self) -> (usize, usize) {
        (self.near.len(), self.far.len())
    }
}
