//! Contacts at one state as springs, dashpots and slopes of friction between a ball and a hub: the Jacobian of a
//! linearly implicit step.
//!
//! The symmetric matrix contains the normal stiffness (Hertz, damping, penalty) of race, pocket and guide contacts; the
//! slope of traction by slip and spin; the slope of cage friction by sliding; foundations; springs and dashpots of
//! reduced solids and the penalty of their housing fits.
//!
//! The change of slip as the contact point moves on the bodies, and of traction with the normal load, is included for
//! displacements in a right-hand side only. That keeps the matrix symmetric and changes its slopes by a part hγ ·
//! (rotation rate). Orbits are described in rotating frames ([`crate::motion::orbit_frame`]). The matrix omits the
//! rotation of the normal force as a ball leaves the axes of its frame, the dependence of traction on entrainment
//! speed, gyroscopic moments, also those of flexible shafts, and the coupling of a flexible cage's modes with its contacts and
//! its frame. A W-method keeps its order without them.

use crate::ch2_housing::bearing::inertia::Inertia;
use crate::kinematics::vec3::{Vec3, add, cross, dot, scale, sub};
use crate::members::ball_set::{BallSet, guiding_side};
use crate::members::bearing::Bearing;
use crate::members::body::{Drive, DrivenBody, Mobility, Rotation};
use crate::members::connection;
use crate::members::connection::{Connection, MaxwellElement};
use crate::members::housing_fit::SeatNow;
use crate::members::rigid_body::{BodyKinematics, directions};
use crate::members::section_attachment::{SectionAttachment, kinematics_at_attachment};
use crate::members::state::LANES;
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
    /// Normal stiffness and damping, N/m and N·s/m.
    pub stiffness: Lane,
    pub damping: Lane,
    /// Negated derivatives of t, s and spin parts: tt, ts, tn, ss, sn, nn.
    pub slope: [Lane; 6],
    /// Change of slip along t and s and of spin about n per displacement of the ball's centre relative to the hub, 1/s
    /// and 1/(m·s): the contact point moves on both bodies.
    pub slip_change: [[Lane; 3]; 3],
    /// Traction along t and s and moment about n per unit of normal load.
    pub per_load: [Lane; 3],
    /// Relative motion along the four rows due to prescribed velocities of the hub.
    pub driven: [Lane; 4],
    /// Displacement of the race's centre per rotation of the hub; `None` if the centres coincide.
    pub shifts: Option<[[f64; 3]; 3]>,
}

/// Contact or spring between two hubs: a cage on its guiding race, a spring with its dashpot.
#[derive(Clone, Copy, Debug, Default)]
pub struct Joint {
    /// `None` for a fixed end.
    pub hubs: [Option<usize>; 2],
    /// Rows in use; zero without contact.
    pub count: usize,
    pub rows: [JointRow; connection::ROWS],
}

/// One direction of a joint.
#[derive(Clone, Copy, Debug, Default)]
pub struct JointRow {
    /// Relative motion per velocity of each hub, six each.
    pub levers: [[f64; 6]; 2],
    /// N/m, N·m/rad.
    pub stiffness: f64,
    /// N·s/m, N·m·s/rad; for friction the slope by sliding.
    pub damping: f64,
}

/// Maxwell elements along the rows of a joint.
#[derive(Clone, Debug, Default)]
pub struct Relaxing {
    /// Index in [`Linearised::joints`].
    pub joint: usize,
    /// First entry in the state.
    pub at: usize,
    pub elements: Vec<MaxwellElement>,
}

/// Modes of a reduced solid, one equation each with a mass of 1 kg.
#[derive(Clone, Debug, Default)]
pub struct Shapes {
    /// First entry in the state.
    pub at: usize,
    /// ω², 1/s², and α, 1/s.
    pub stiffness: Vec<f64>,
    pub damping: f64,
}

/// A race in the bore of a reduced solid: one row for each contact node. The rotation of the normals, load over radius
/// relative to the stiffness (1e-4), is omitted. Or a flexible cage on its guiding race: one row for each end.
#[derive(Clone, Debug, Default)]
pub struct SeatJoint {
    /// The race, and the frame of a floating solid.
    pub hubs: [Option<usize>; 2],
    pub solid: usize,
    pub nodes: Vec<SeatRow>,
    /// Modes at the rows of a cage, which change from step to step: all modes of the first row, of the second; empty for
    /// a bore.
    pub shapes: Vec<f64>,
}

/// Approach of race and bore at a node.
#[derive(Clone, Copy, Debug, Default)]
pub struct SeatRow {
    /// Index in the surface.
    pub node: usize,
    /// N/m.
    pub stiffness: f64,
    /// Approach per velocity of each hub.
    pub levers: [[f64; 6]; 2],
    /// Approach per speed of the node along its own normal.
    pub along: f64,
}

/// A body in contact with many balls. Its rotations are about `basis`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hub {
    /// First of its 13 entries in the state.
    pub at: usize,
    /// Axis and the two tilt directions.
    pub basis: [Vec3; 3],
    /// kg, kg·m².
    pub inertia: [f64; 6],
    /// Stiffness to the ground.
    pub stiffness: [f64; 6],
    pub damping: [f64; 6],
    /// Zero for a prescribed velocity, otherwise one.
    pub free: [f64; 6],
    /// Prescribed velocities, zero where free.
    pub prescribed: [f64; 6],
}

/// A block of balls of one bearing.
#[derive(Clone, Debug, Default)]
pub struct BallBlock {
    pub bearing: usize,
    /// Index of the first ball.
    pub first: usize,
    /// Contacts with the inner race, the outer race, the pockets.
    pub contacts: [LaneContact; 3],
}

/// All contacts and springs at one state.
#[derive(Clone, Debug, Default)]
pub struct Linearised {
    pub blocks: Vec<BallBlock>,
    /// Both ends of the cage of each bearing on its guiding race, two a bearing; then connections.
    pub joints: Vec<Joint>,
    pub relaxing: Vec<Relaxing>,
    /// Moving bodies in their order, then attachment sections of flexible bodies.
    pub hubs: Vec<Hub>,
    pub sections: Vec<SectionHub>,
    /// Modes of flexible bodies; stiffness and damping of one direction each.
    pub shafts: Vec<Shapes>,
    /// Hub of each body of the assembly.
    pub hub_of: Vec<Option<usize>>,
    /// Reduced solids, then floating ones.
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
                    Mobility::Fixed | Mobility::Carried => return None,
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
            hubs: [hub_at(hold, seat.race.body), None],
            solid: seat.solid,
            nodes: Vec::with_capacity(now.outward.len()),
            shapes: Vec::new(),
        });
        let seats: Vec<SeatJoint> = seats.collect();
        let cages = assembly.bearings.iter().enumerate().filter_map(|(index, bearing)| {
            let nodes = bearing.cage.as_ref()?.nodes.as_ref()?;
            let count = nodes.largest.len();
            // Fewer modes than rows: the joint of the guide has the contact of a rigid cage.
            (count >= 2).then(|| SeatJoint {
                hubs: joints[2 * index].hubs,
                solid: assembly.solids.len() + nodes.floating,
                nodes: Vec::with_capacity(2),
                shapes: vec![0.0; 2 * count],
            })
        });
        let seats = seats.into_iter().chain(cages);
        // The forces of contact nodes on modes are omitted: they are far softer than the modes.
        let floating = assembly.floating.iter().zip(&system.floating).map(|(solid, &at)| {
            let stiffness: Vec<f64> = solid.frame.frequencies.iter().map(|w| w * w).collect();
            Shapes { at, stiffness, damping: solid.frame.damping }
        });
        let (solids, seats) = (solids.chain(floating).collect(), seats.collect());
        let shafts = linearised_shafts::shapes(system);
        Linearised { blocks, joints, relaxing, hubs, sections, shafts, hub_of, solids, seats }
    }

    /// Number of hubs that are bodies.
    pub fn bodies(&self) -> usize {
        self.hubs.len() - self.sections.len()
    }

    /// Linearises the contacts that `system` has just evaluated, slopes included.
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
        let of_cages =
            system.sets.iter().enumerate().filter(|(_, set)| set.guide_modes[0].len() >= 2);
        let first_cage = system.assembly.seats.len();
        for (joint, (index, set)) in seats[first_cage..].iter_mut().zip(of_cages) {
            flexible_guides(joint, &mut guides[2 * index..2 * index + 2], set);
        }
        let held = system.assembly.connections.iter().zip(&system.holds.connections);
        for (joint, (connection, holds)) in others.iter_mut().zip(held) {
            update_connection(joint, connection, holds, &system.bodies, hubs);
        }
        let held = system.assembly.seats.iter().zip(&system.holds.seats);
        for ((joint, (seat, hold)), now) in seats.iter_mut().zip(held).zip(&system.seats) {
            // Levers are about the hub's centre, which may be at another position along the shaft than the race.
            let body = &system.bodies[seat.race.body];
            let off = match hold {
                Some(_) => [0.0; 3],
                None => scale(body.motion.axis, seat.race.along),
            };
            update_seat(joint, now, off, hubs);
        }
    }
}

/// Reference point of the levers of a hub: the centre of its section, or of the body.
fn centre_of_hub(hold: &Option<SectionAttachment>, body: &BodyKinematics) -> Vec3 {
    hold.as_ref().map_or(body.motion.position, |hold| hold.now.race.motion.position)
}

fn update_seat(joint: &mut SeatJoint, now: &SeatNow, off: Vec3, hubs: &[Hub]) {
    let hub = joint.hubs[0].map(|hub| &hubs[hub]);
    joint.nodes.clear();
    joint.nodes.extend(now.touching.iter().map(|node| {
        let turning = cross(add(node.arm, off), node.normal);
        SeatRow {
            node: node.node,
            stiffness: node.stiffness,
            levers: [hub.map_or([0.0; 6], |hub| on_hub(hub, node.normal, turning)), [0.0; 6]],
            along: -node.along,
        }
    }));
}

/// Moves the normal contact of a flexible cage with its guiding race from the joints of a rigid one to its modes.
fn flexible_guides(joint: &mut SeatJoint, guides: &mut [Joint], set: &BallSet) {
    joint.nodes.clear();
    let count = joint.shapes.len() / 2;
    for (end, (guide, contact)) in guides.iter_mut().zip(&set.guides).enumerate() {
        if guide.count == 0 {
            continue;
        }
        let row = &mut guide.rows[0];
        // A joint's lever is positive along the force on the race, which reduces the penetration.
        let levers = row.levers.map(|lever| lever.map(|part| -part));
        joint.nodes.push(SeatRow { node: end, stiffness: row.stiffness, levers, along: 1.0 });
        row.stiffness = 0.0;
        let shapes = &mut joint.shapes[end * count..(end + 1) * count];
        for (to, force) in shapes.iter_mut().zip(&set.guide_modes[end]) {
            *to = force / contact.normal_load;
        }
    }
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
        let stiffness = caged.stiffness(contact);
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
            // Levers are about the hub's centre, which may be at another position along the shaft than the section.
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

/// Updates directions and foundation of a race.
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

/// Row of a lever on a hub, without prescribed velocities.
pub(crate) fn on_hub(hub: &Hub, linear: Vec3, turning: Vec3) -> [f64; 6] {
    let [a, b, c] = hub.basis.map(|axis| dot(axis, turning));
    let all = [linear[0], linear[1], linear[2], a, b, c];
    std::array::from_fn(|i| all[i] * hub.free[i])
}

/// Relative motion along a row of a lever due to prescribed velocities of the hub.
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
