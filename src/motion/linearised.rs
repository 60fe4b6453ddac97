//! Contacts at one state as springs, dashpots and slopes of friction between a ball and a hub: what
//! a linearly implicit step takes for the Jacobian.
//!
//! In it are, all symmetric: the normal stiffness (Hertz, damping, penalty) of race, pocket and
//! guide contacts; the slope of traction by slip and spin; the slope of the cage's friction by
//! sliding; foundations; springs and dampers of reduced solids and the penalty of their seats.
//!
//! How slip changes as the contact point moves round the bodies, and how traction follows the normal
//! load, is known too, but only for displacements in a right-hand side: that keeps the matrix
//! symmetric and moves its slopes by a part hγ · (turning rate) of themselves. Orbits turn in frames of
//! their own ([`crate::motion::orbit_frame`]). Left out are how the direction of the normal force turns as a
//! ball leaves its frame's axes, how traction follows the entrainment speed,
//! gyroscopic moments, those of bending shafts too. A W-method keeps its order without them.

use crate::assembly::lists::{Bearing, Mobility};
use crate::assembly::loads::{Drive, DrivenBody, Rotation};
use crate::assembly::state::LANES;
use crate::ch2_housing::bearing::cage::cage_stiffness;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::kinematics::vec3::{Vec3, add, cross, dot, scale, sub};
use crate::members::ball_set::{BallSet, guiding_side};
use crate::members::connection;
use crate::members::connection::{Connection, MaxwellElement};
use crate::members::housing_fit::SeatNow;
use crate::members::rigid_body::{BodyKinematics, directions};
use crate::members::section_attachments::{SectionAttachment, kinematics_at_attachment};
use crate::motion::linearised_contacts::{friction, pockets, race_contacts};
use crate::motion::linearised_shafts;
use crate::motion::linearised_shafts::SectionHub;
use crate::motion::system::System;

/// One number for each ball of a block.
pub type Lane = [f64; LANES];

/// Relative motion along n, t, s and spin about n, for each of the six velocities of a body.
pub type Lever<T> = [[T; 6]; 4];

/// Normal, two tangents, spin about the normal.
pub(crate) const ROWS: usize = 4;

/// Contacts of a block of balls with one hub, or with the fixed outer race.
#[derive(Clone, Debug, Default)]
pub struct LaneContact {
    pub hub: Option<usize>,
    /// Rows of the levers in use: 0 without contact, 1 without friction, else 4.
    pub rows: usize,
    pub on_ball: Lever<Lane>,
    pub on_hub: Lever<Lane>,
    /// Along the normal, N/m and N·s/m.
    pub stiffness: Lane,
    pub damping: Lane,
    /// Negated derivatives of t, s and spin parts: tt, ts, tn, ss, sn, nn.
    pub slope: [Lane; 6],
    /// Change of slip along t and s and of spin about n as the ball's centre moves against the
    /// hub's, 1/s and 1/(m·s): the contact point moves round both bodies.
    pub carried: [[Lane; 3]; 3],
    /// Traction along t and s and moment about n that a unit of normal load makes.
    pub per_load: [Lane; 3],
    /// Motion along the four rows that the hub's prescribed velocities make.
    pub driven: [Lane; 4],
    /// How turns of the hub shift the race's centre, where it does not sit at the hub's.
    pub shifts: Option<[[f64; 3]; 3]>,
}

/// What pushes back between two hubs: a cage on its guiding race, a spring with its dashpot.
#[derive(Clone, Copy, Debug, Default)]
pub struct Joint {
    /// `None` for an end that is fixed.
    pub hubs: [Option<usize>; 2],
    /// Rows in use; none where nothing touches.
    pub count: usize,
    pub rows: [JointRow; connection::ROWS],
}

/// One direction of a joint.
#[derive(Clone, Copy, Debug, Default)]
pub struct JointRow {
    /// Relative motion that the six velocities of each hub make.
    pub levers: [[f64; 6]; 2],
    /// N/m, N·m/rad.
    pub stiffness: f64,
    /// N·s/m, N·m·s/rad; of friction the slope by sliding.
    pub damping: f64,
}

/// Maxwell elements along the rows of a joint.
#[derive(Clone, Debug, Default)]
pub struct Relaxing {
    /// In [`Linearised::joints`].
    pub joint: usize,
    /// First of their entries in the state.
    pub at: usize,
    pub elements: Vec<MaxwellElement>,
}

/// Shapes of a reduced solid, one equation each with a mass of 1 kg.
#[derive(Clone, Debug, Default)]
pub struct Shapes {
    /// First of its entries in the state.
    pub at: usize,
    /// ω², 1/s², and α, 1/s.
    pub stiffness: Vec<f64>,
    pub damping: f64,
}

/// A race in the bore of a reduced solid: one direction for each node that touches. How the normals turn, load over
/// radius against the stiffness (a part of 1e-4), is left out.
#[derive(Clone, Debug, Default)]
pub struct SeatJoint {
    pub hub: Option<usize>,
    pub solid: usize,
    pub nodes: Vec<SeatRow>,
}

/// Approach of race and bore at a node.
#[derive(Clone, Copy, Debug, Default)]
pub struct SeatRow {
    /// In the surface.
    pub node: usize,
    /// N/m.
    pub stiffness: f64,
    /// That the six velocities of the hub make.
    pub lever: [f64; 6],
    /// That the node's speed along its own normal makes.
    pub along: f64,
}

/// A body that many balls touch. Its rotations count about `basis`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hub {
    /// First of its 13 entries in the state.
    pub at: usize,
    /// Axis and the two directions of the tilts.
    pub basis: [Vec3; 3],
    /// kg, kg·m².
    pub inertia: [f64; 6],
    /// To the ground.
    pub stiffness: [f64; 6],
    pub damping: [f64; 6],
    /// Zero for what is prescribed, else one.
    pub free: [f64; 6],
    /// Prescribed velocities, zero for what is free.
    pub prescribed: [f64; 6],
}

/// A block of balls of one bearing.
#[derive(Clone, Debug, Default)]
pub struct BallBlock {
    pub bearing: usize,
    /// First ball.
    pub first: usize,
    /// With the inner race, the outer race, the pockets.
    pub contacts: [LaneContact; 3],
}

/// Everything that pushes back at one state.
#[derive(Clone, Debug, Default)]
pub struct Linearised {
    pub blocks: Vec<BallBlock>,
    /// Both ends of the cage of each bearing on its guiding race, two a bearing; then connections.
    pub joints: Vec<Joint>,
    pub relaxing: Vec<Relaxing>,
    /// Bodies that move, in their order; then sections of those that bend where something takes hold of them.
    pub hubs: Vec<Hub>,
    pub sections: Vec<SectionHub>,
    /// Of bodies that bend; their stiffness and damping count along one direction each.
    pub shafts: Vec<Shapes>,
    /// Of each body of the assembly.
    pub hub_of: Vec<Option<usize>>,
    pub solids: Vec<Shapes>,
    pub seats: Vec<SeatJoint>,
}

impl Linearised {
    pub fn new(system: &System) -> Linearised {
        let assembly = &system.assembly;
        let mut hubs = Vec::new();
        let hub_of: Vec<Option<usize>> = assembly
            .bodies
            .iter()
            .enumerate()
            .map(|(index, body)| {
                let at = system.places.body(index);
                hubs.push(match &body.mobility {
                    Mobility::Fixed => return None,
                    Mobility::Driven(race) => race_hub(race, at),
                    Mobility::Free(inertia) => {
                        Hub { at, inertia: six(inertia), free: [1.0; 6], ..Hub::default() }
                    }
                });
                Some(hubs.len() - 1)
            })
            .collect();
        let bodies = hubs.len();
        let sections = linearised_shafts::sections(system, &hub_of, bodies);
        hubs.resize(bodies + sections.len(), linearised_shafts::FREE);
        let mut held = sections.iter().map(|section: &SectionHub| section.hub);
        let mut hub_at = |hold: &Option<SectionAttachment>, body: usize| match hold {
            Some(_) => held.next(),
            None => hub_of[body],
        };
        let (mut blocks, mut joints) = (Vec::new(), Vec::new());
        for (index, (set, bearing)) in system.sets.iter().zip(&assembly.bearings).enumerate() {
            let holds = &system.holds.bearings[index];
            let races = [0, 1].map(|side| hub_at(&holds[side], bearing.mounts[side].body));
            let cage = bearing.cage.as_ref().and_then(|cage| hub_of[cage.body]);
            let contacts =
                [races[0], races[1], cage].map(|hub| LaneContact { hub, ..LaneContact::default() });
            for first in (0..set.layout.padded).step_by(LANES) {
                blocks.push(BallBlock { bearing: index, first, contacts: contacts.clone() });
            }
            let side = bearing.cage.as_ref().and_then(|cage| guiding_side(cage.contacts.guidance));
            let hubs = [side.and_then(|side| races[side]), cage];
            joints.extend([Joint { hubs, ..Joint::default() }; 2]);
        }
        let held_ends = assembly.connections.iter().zip(&system.holds.connections);
        joints.extend(held_ends.map(|(connection, holds)| {
            let hubs = [0, 1].map(|end| hub_at(&holds[end], connection.ends[end].body));
            Joint { hubs, count: connection::ROWS, ..Joint::default() }
        }));
        let relaxing = assembly.connections.iter().zip(&system.connections).enumerate();
        let relaxing = relaxing.filter(|(_, (connection, _))| !connection.maxwell().is_empty());
        let relaxing = relaxing.map(|(index, (connection, &at))| Relaxing {
            joint: 2 * system.sets.len() + index,
            at,
            elements: connection.maxwell().to_vec(),
        });
        let relaxing = relaxing.collect();
        let solids = assembly.solids.iter().zip(&system.solids).map(|(solid, &at)| {
            let stiffness: Vec<f64> = solid.frequencies.iter().map(|w| w * w).collect();
            Shapes { at, stiffness, damping: solid.damping }
        });
        let seated = assembly.seats.iter().zip(&system.seats).zip(&system.holds.seats);
        let seats = seated.map(|((seat, now), hold)| SeatJoint {
            hub: hub_at(hold, seat.race.body),
            solid: seat.solid,
            nodes: Vec::with_capacity(now.outward.len()),
        });
        let (solids, seats) = (solids.collect(), seats.collect());
        let shafts = linearised_shafts::shapes(system);
        Linearised { blocks, joints, relaxing, hubs, sections, shafts, hub_of, solids, seats }
    }

    /// Hubs that are bodies.
    pub fn bodies(&self) -> usize {
        self.hubs.len() - self.sections.len()
    }

    /// Takes up the contacts that `system` has just evaluated, slopes included.
    pub fn update(&mut self, system: &System, state: &[f64]) {
        let Linearised { blocks, joints, hubs, sections, hub_of, seats, .. } = self;
        for ((body, now), hub) in system.assembly.bodies.iter().zip(&system.bodies).zip(hub_of) {
            let Some(hub) = hub.map(|hub| &mut hubs[hub]) else { continue };
            match body.driven() {
                Some(race) => turn_race(hub, race, now),
                None => {
                    let ([e2, e3], _) = directions(now.motion.axis);
                    hub.basis = [now.motion.axis, e2, e3];
                }
            }
        }
        linearised_shafts::update(sections, hubs, system);
        for block in blocks {
            let (set, bearing) =
                (&system.sets[block.bearing], &system.assembly.bearings[block.bearing]);
            for (side, mount) in bearing.mounts.iter().enumerate() {
                let contact = &mut block.contacts[side];
                let hub = contact.hub.map(|hub| &hubs[hub]);
                let hold = &system.holds.bearings[block.bearing][side];
                let centre = centre_of_hub(hold, &system.bodies[mount.body]);
                race_contacts(set, state, side, block.first, (hub, centre), contact);
            }
            let contact = &mut block.contacts[2];
            if let (Some(hub), Some(caged)) = (contact.hub, &bearing.cage) {
                pockets(set, caged, state, block.first, &hubs[hub], contact);
            }
        }
        let (guides, others) = joints.split_at_mut(2 * system.sets.len());
        for (index, (guides, set)) in guides.chunks_mut(2).zip(&system.sets).enumerate() {
            let (bearing, holds) =
                (&system.assembly.bearings[index], &system.holds.bearings[index]);
            update_guides(guides, set, (bearing, holds), &system.bodies, hubs);
        }
        let held = system.assembly.connections.iter().zip(&system.holds.connections);
        for (joint, (connection, holds)) in others.iter_mut().zip(held) {
            update_connection(joint, connection, holds, &system.bodies, hubs);
        }
        let held = system.assembly.seats.iter().zip(&system.holds.seats);
        for ((joint, (seat, hold)), now) in seats.iter_mut().zip(held).zip(&system.seats) {
            // Levers count about the hub's centre, from where the seat may be some way along the shaft.
            let body = &system.bodies[seat.race.body];
            let off = match hold {
                Some(_) => [0.0; 3],
                None => scale(body.motion.axis, seat.race.along),
            };
            update_seat(joint, now, off, hubs);
        }
    }
}

/// About what the levers of a hub count: the centre of a section that is held, else of the body.
fn centre_of_hub(hold: &Option<SectionAttachment>, body: &BodyKinematics) -> Vec3 {
    hold.as_ref().map_or(body.motion.position, |hold| hold.now.race.motion.position)
}

fn update_seat(joint: &mut SeatJoint, now: &SeatNow, off: Vec3, hubs: &[Hub]) {
    let hub = joint.hub.map(|hub| &hubs[hub]);
    joint.nodes.clear();
    joint.nodes.extend(now.touching.iter().map(|node| {
        let turning = cross(add(node.arm, off), node.normal);
        SeatRow {
            node: node.node,
            stiffness: node.stiffness,
            lever: hub.map_or([0.0; 6], |hub| on_hub(hub, node.normal, turning)),
            along: -node.along,
        }
    }));
}

fn update_guides(
    guides: &mut [Joint],
    set: &BallSet,
    (bearing, holds): (&Bearing, &[Option<SectionAttachment>; 2]),
    bodies: &[BodyKinematics],
    hubs: &[Hub],
) {
    let Some(caged) = &bearing.cage else { return };
    let Some(side) = guiding_side(caged.contacts.guidance) else { return };
    let centres = [
        centre_of_hub(&holds[side], &bodies[bearing.mounts[side].body]),
        bodies[caged.body].motion.position,
    ];
    for (guide, contact) in guides.iter_mut().zip(&set.guides) {
        guide.count = if contact.normal_load > 0.0 { 3 } else { 0 };
        if guide.count == 0 {
            continue;
        }
        let (directions, slope) = friction(contact, &caged.contacts);
        let stiffness = cage_stiffness(&caged.contacts.force, contact.penetration);
        for (row, direction) in directions.into_iter().enumerate() {
            let to = &mut guide.rows[row];
            to.stiffness = if row == 0 { stiffness } else { 0.0 };
            to.damping = if row == 0 { 0.0 } else { slope[row - 1] };
            for ((lever, sign), (hub, centre)) in
                to.levers.iter_mut().zip([1.0, -1.0]).zip(guide.hubs.into_iter().zip(centres))
            {
                let turning = cross(sub(contact.point, centre), direction);
                *lever = hub.map_or([0.0; 6], |hub| {
                    on_hub(&hubs[hub], scale(direction, sign), scale(turning, sign))
                });
            }
        }
    }
}

fn update_connection(
    joint: &mut Joint,
    of: &Connection,
    holds: &[Option<SectionAttachment>; 2],
    bodies: &[BodyKinematics],
    hubs: &[Hub],
) {
    let ends = [0, 1].map(|end| {
        let mount = &of.ends[end];
        kinematics_at_attachment(&holds[end], &bodies[mount.body], mount)
    });
    let rows = of.rows([&ends[0], &ends[1]]);
    for (to, row) in joint.rows.iter_mut().zip(rows) {
        (to.stiffness, to.damping) = (row.stiffness, row.damping);
        for (end, [linear, turning]) in row.on.into_iter().enumerate() {
            // Levers count about the hub's centre, from where the section may be some way along the shaft.
            let centre = centre_of_hub(&holds[end], &bodies[of.ends[end].body]);
            let off = sub(ends[end].motion.position, centre);
            to.levers[end] = joint.hubs[end].map_or([0.0; 6], |hub| {
                on_hub(&hubs[hub], linear, add(turning, cross(off, linear)))
            });
        }
    }
}

/// Mass and moments of inertia of a hub.
fn six(inertia: &Inertia) -> [f64; 6] {
    let Inertia { mass, axial, transverse, .. } = *inertia;
    [mass, mass, mass, axial, transverse, transverse]
}

fn race_hub(body: &DrivenBody, at: usize) -> Hub {
    let free = |given: bool| if given { 0.0 } else { 1.0 };
    let held = |i: usize| free(matches!(body.drives[i], Drive::Motion(_)));
    let turned = free(matches!(body.rotation, Rotation::Speed(_)));
    Hub {
        at,
        inertia: six(&body.inertia),
        free: [held(0), held(1), held(2), turned, held(3), held(4)],
        ..Hub::default()
    }
}

/// Directions and foundation of a race where it lies now.
fn turn_race(hub: &mut Hub, body: &DrivenBody, now: &BodyKinematics) {
    let [e2, e3] = now.tilt_directions;
    hub.basis = [now.motion.axis, e2, e3];
    // ξ turns about e₂ by cos λ, and its moment acts about e₂ over cos λ.
    let per = 1.0 / (now.cos_lambda * now.cos_lambda);
    let spread = |of: &[f64; 5]| [of[0], of[1], of[2], 0.0, of[3] * per, of[4]];
    hub.stiffness = spread(&body.foundation_stiffness);
    hub.damping = spread(&body.foundation_damping);
    let rates = to_basis(hub, now.state.velocity, now.state.spin);
    for i in 0..6 {
        hub.prescribed[i] = (1.0 - hub.free[i]) * rates[i];
        hub.stiffness[i] *= hub.free[i];
        hub.damping[i] *= hub.free[i];
    }
}

/// Row of a lever on a hub, what is prescribed left out.
pub(crate) fn on_hub(hub: &Hub, linear: Vec3, turning: Vec3) -> [f64; 6] {
    let [a, b, c] = hub.basis.map(|axis| dot(axis, turning));
    let all = [linear[0], linear[1], linear[2], a, b, c];
    std::array::from_fn(|i| all[i] * hub.free[i])
}

/// Relative motion along a row of a lever that the prescribed velocities of the hub make.
pub(crate) fn driven(hub: &Hub, linear: Vec3, turning: Vec3) -> f64 {
    let [a, b, c] = hub.basis.map(|axis| dot(axis, turning));
    let all = [linear[0], linear[1], linear[2], a, b, c];
    (0..6).map(|i| all[i] * hub.prescribed[i]).sum()
}

/// Writes one ball's row into the lanes.
pub(crate) fn put(row: &mut [Lane; 6], lane: usize, values: [f64; 6]) {
    for (to, value) in row.iter_mut().zip(values) {
        to[lane] = value;
    }
}

pub(crate) fn joined(a: Vec3, b: Vec3) -> [f64; 6] {
    [a[0], a[1], a[2], b[0], b[1], b[2]]
}

/// Linear and angular part of six numbers of a hub, inertial axes.
pub fn from_basis(hub: &Hub, six: &[f64; 6]) -> (Vec3, Vec3) {
    let [a, e2, e3] = hub.basis;
    let turning = add(add(scale(a, six[3]), scale(e2, six[4])), scale(e3, six[5]));
    ([six[0], six[1], six[2]], turning)
}

/// Six numbers of a hub from vectors in inertial axes.
pub fn to_basis(hub: &Hub, linear: Vec3, turning: Vec3) -> [f64; 6] {
    let [a, b, c] = hub.basis.map(|axis| dot(axis, turning));
    [linear[0], linear[1], linear[2], a, b, c]
}
