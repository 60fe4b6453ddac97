//! Housing fit of a race in the bore of a solid in explicit steps: tested nodes, contact forces on race and solid,
//! impulse and work since the start.

use crate::ch2_housing::bore_contact::{
    ContactNode, ContactSum, Cylinder, Frame, Penalty, contact, split_by_distance,
};
use crate::ch4_rotor::bore_friction::BoreFriction;
use crate::kinematics::Pose;
use crate::kinematics::vec3::{Vec3, add, add_scaled, dot, norm, scale, sub};
use crate::members::ball_set::onto_body;
use crate::members::body::Body;
use crate::members::mount::Mount;
use crate::members::rigid_body;
use crate::members::rigid_body::{BodyKinematics, Wrench, kinematics_at_mount};
use crate::members::state::BodyState;
use crate::motion::bore_friction::{FrictionSum, Pressed, SeatFriction};
use crate::numeric::profile::Profile;
use crate::solids::condensation::{is_under, rim};
use crate::solids::contact::{moved, press};
use crate::solids::explicit::ExplicitSolid;
use crate::solids::tet4_blocks::Node;
use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// A race in a bore.
#[derive(Clone, Debug, PartialEq)]
pub struct Seat {
    /// Name in messages and columns; `None` for the only one.
    pub name: Option<String>,
    /// Mount of the race on a body of the assembly.
    pub mount: Mount,
    /// Index of the solid with the bore.
    pub solid: usize,
    /// Outside radius of the race, m; a growing interference changes it.
    pub radius: Profile,
    /// Width of the race, m.
    pub width: f64,
    pub penalty: Penalty,
    /// `None`: the bore is smooth.
    pub friction: Option<BoreFriction>,
    /// From [`contact_nodes`](crate::ch2_housing::bore_contact::contact_nodes).
    pub nodes: Vec<ContactNode>,
    /// Nodes farther than this from contact are not tested until something has moved half as far, m. Infinite: all are
    /// tested.
    pub reach: f64,
}

/// Work of a growing race radius against the contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Growth {
    /// Since the start, J.
    pub work: f64,
    /// Radius at the last evaluation of the contact, m, and the contact's radial load, N.
    pub radius: f64,
    pub load: f64,
}

impl Growth {
    /// Adds the work up to a later radius, by the trapezoidal rule.
    fn to(self, radius: f64, load: f64) -> Growth {
        let work = self.work + 0.5 * (self.load + load) * (radius - self.radius);
        Growth { work, radius, load }
    }
}

impl Seat {
    /// " left" in messages; empty for the only one.
    pub fn suffix(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!(" {name}"))
    }

    /// The race at time `t`, wider by `rim` (m) at each end.
    pub(crate) fn cylinder(&self, t: f64, rim: f64) -> Cylinder {
        Cylinder { radius: self.radius.value(t), width: self.width + 2.0 * rim }
    }

    /// Drops the nodes beside the race at the start of its body (X, Y, Z, m; tilts, rad), as a condensed housing does.
    /// Returns the axial displacement within which the others stay in contact, m.
    fn keep_under(&mut self, start: &[f64; 5]) -> f64 {
        let frame = self.frame_after(&rigid_body::fixed(start).state, 0.0);
        let width = self.width;
        self.nodes.retain(|node| is_under(frame.seen(node.place)[0], width));
        rim(self.nodes.iter().map(|node| node.area), width)
    }

    /// Stiffness with all nodes in contact and without slip, of a displacement, N/m, and of a tilt and a rotation about
    /// the axis, N·m/rad, of a body at rest at `centre` (m).
    pub(crate) fn stiffness(&self, centre: Vec3) -> [f64; 3] {
        let mut sums = [0.0; 3];
        let (mut about_y, mut about_z) = (0.0, 0.0);
        for node in &self.nodes {
            let [along, across, up] = sub(node.place, centre);
            let stiffness = self.penalty.of_node(node.area);
            sums[0] += stiffness;
            sums[1] += stiffness * along * along;
            if let Some(friction) = &self.friction {
                let tangential = friction.stiffest(stiffness);
                about_y += tangential * up * up;
                about_z += tangential * across * across;
            }
        }
        sums[1] += f64::max(about_y, about_z);
        sums[2] = about_y + about_z;
        sums
    }

    /// Kinematics of the body of the race and of the race, after `time` s of free motion.
    fn in_free_motion_with_race(&self, body: &BodyState, time: f64) -> [BodyKinematics; 2] {
        let body = BodyKinematics::new(in_free_motion(body, time));
        [body, kinematics_at_mount(&body, &self.mount)]
    }

    fn frame_after(&self, body: &BodyState, time: f64) -> Frame {
        frame(&self.in_free_motion_with_race(body, time)[1])
    }
}

/// A body after `time` s of free motion.
pub(crate) fn in_free_motion(body: &BodyState, time: f64) -> BodyState {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::from(body.spin) * time);
    BodyState {
        position: add_scaled(body.position, time, body.velocity),
        orientation: turn * body.orientation,
        ..*body
    }
}

/// Mean wrench of an impulse and an angular impulse (N·s, N·m·s) over a coupling step (s).
pub(crate) fn mean_over(handed: &Wrench, coupling_step: f64) -> Wrench {
    Wrench {
        force: scale(handed.force, 1.0 / coupling_step),
        moment: scale(handed.moment, 1.0 / coupling_step),
    }
}

/// Work of a constant wrench on a body in a coupling step, J.
pub(crate) fn work_on_way(loads: &Wrench, from: &BodyState, to: &BodyState) -> f64 {
    let way = sub(to.position, from.position);
    // The rotation in a coupling step is so small that its sine equals the angle.
    let turn = (to.orientation * from.orientation.inverse()).into_inner();
    let turn = scale([turn.i, turn.j, turn.k], 2.0 * turn.w.signum());
    dot(loads.force, way) + dot(loads.moment, turn)
}

fn frame(race: &BodyKinematics) -> Frame {
    let BodyState { position, orientation, .. } = race.state;
    Frame::new(&Pose { position: position.into(), orientation })
}

/// A housing fit at the present time.
pub struct SeatState {
    /// With the nodes under the race at the start.
    pub seat: Seat,
    /// Axial displacement within which nodes stay in contact, m.
    pub rim: f64,
    /// Contact as last evaluated, friction included.
    pub contact: ContactSum,
    pub friction: Option<SeatFriction>,
    /// Impulse on the race since the start, N·s.
    pub impulse: Vec3,
    /// Work on its body since the start, J.
    pub work: f64,
    /// Work of a growing interference.
    pub growth: Growth,
    /// Number of nodes tested, and of sorts by distance.
    pub tested: u64,
    pub sorts: u64,
    /// Evaluations of the contact.
    pub presses: u64,
    near: Vec<ContactNode>,
    far: Vec<(ContactNode, Vec3)>,
    sorted_at: (Cylinder, Frame),
    /// Position of the race at the start, m.
    start: Vec3,
    /// In the present coupling step: its body at the beginning; impulse (N·s) and angular impulse about the body's
    /// centre (N·m·s) on the body.
    from: BodyState,
    handed: Wrench,
}

/// Energies of a housing fit at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeatSnapshot {
    /// With friction, whose springs are not in its energy.
    pub contact: ContactSum,
    pub friction: FrictionSum,
    /// Work on its body since the start, J.
    pub work: f64,
    /// Work of the contact on the race up to the time of the solid's displacements, J.
    pub to_come: f64,
    /// Work of a growing interference, J.
    pub growth_work: f64,
}

/// Failure of a housing fit.
pub(crate) enum Lost {
    /// The race has left its bore: direction, displacement and its limit, m.
    Bore(&'static str, f64, f64),
    /// Race and bore moved by more than the tested distance (m) between two checks: nodes may have touched untested.
    Reach(f64),
}

impl SeatState {
    pub(crate) fn new(mut seat: Seat, body: &Body) -> SeatState {
        let rim = seat.keep_under(&body.rest);
        let from = rigid_body::fixed(&body.rest).state;
        let first = seat.frame_after(&from, 0.0);
        let cylinder = seat.cylinder(0.0, rim);
        let friction = seat.friction.map(|law| {
            seat.nodes.sort_by_key(|node| node.node);
            SeatFriction::new(law, seat.nodes.len())
        });
        SeatState {
            rim,
            contact: ContactSum::default(),
            friction,
            impulse: [0.0; 3],
            work: 0.0,
            growth: Growth { radius: cylinder.radius, ..Growth::default() },
            tested: 0,
            sorts: 0,
            presses: 0,
            near: Vec::new(),
            far: Vec::new(),
            sorted_at: (cylinder, first),
            start: first.centre,
            from,
            handed: Wrench::default(),
            seat,
        }
    }

    /// Race and frame half a step of the solid ahead of `body`, at the time of its displacements.
    fn ahead(&self, body: &BodyState, solid: &ExplicitSolid) -> (Cylinder, Frame) {
        let frame = self.seat.frame_after(body, 0.5 * solid.step_size);
        (self.seat.cylinder(solid.time, self.rim), frame)
    }

    /// Starts the work of growth at the first evaluation of the contact.
    pub(crate) fn grow_from(&mut self, solid: &ExplicitSolid) {
        let radius = self.seat.cylinder(solid.time, self.rim).radius;
        self.growth = Growth { radius, ..Growth::default() };
    }

    pub(crate) fn begin_coupling_step(&mut self, body: BodyState) {
        self.from = body;
        self.handed = Wrench::default();
    }

    /// Contact in a step of the solid at its time `t` (s), `after` s from the beginning of the coupling step: adds its
    /// forces to those of the nodes (N) and its impulse over `step` (s) to the body.
    pub(crate) fn push_both(
        &mut self,
        t: f64,
        [after, step]: [f64; 2],
        displacement: &[Node],
        forces: &mut [Node],
    ) {
        let [body, race] = self.seat.in_free_motion_with_race(&self.from, after);
        let cylinder = self.seat.cylinder(t, self.rim);
        let (cylinder, frame) = (&cylinder, &frame(&race));
        let (nodes, penalty) = (&self.near[..], self.seat.penalty);
        let pressed = Pressed { cylinder, frame, penalty, nodes, displacement };
        let sum = match &mut self.friction {
            None => press(&pressed, forces),
            Some(friction) => friction.step(&pressed, forces),
        };
        self.growth = self.growth.to(cylinder.radius, sum.radial_load);
        self.tested += sum.tested as u64;
        self.presses += 1;
        let on_race = Wrench { force: sum.force, moment: sum.moment };
        let on_body = onto_body(&self.seat.mount, &race, &body, &on_race);
        self.handed.force = add_scaled(self.handed.force, step, on_body.force);
        self.handed.moment = add_scaled(self.handed.moment, step, on_body.moment);
        self.contact = sum;
    }

    /// Mean load of the impulse on the body over the coupling step (N, N·m); counts as its load from here on.
    pub(crate) fn take_mean_load(&mut self, coupling_step: f64) -> Wrench {
        self.impulse = add(self.impulse, self.handed.force);
        mean_over(&self.handed, coupling_step)
    }

    /// Books the work of that load on the body up to its state `to`.
    pub(crate) fn book(&mut self, coupling_step: f64, to: &BodyState) {
        self.work += work_on_way(&mean_over(&self.handed, coupling_step), &self.from, to);
    }

    /// Sorts the bore nodes into tested and distant ones.
    pub(crate) fn sort(&mut self, body: &BodyState, solid: &ExplicitSolid) {
        let (cylinder, frame) = self.ahead(body, solid);
        let at = |n: u32| moved(&solid.displacement, n);
        let (near, far) =
            split_by_distance(&cylinder, &frame, &self.seat.nodes, at, self.seat.reach);
        self.near = near;
        self.far = far.into_iter().map(|node| (node, at(node.node))).collect();
        self.sorted_at = (cylinder, frame);
        self.sorts += 1;
    }

    /// Sorts again after a motion of half the tested distance.
    ///
    /// # Errors
    ///
    /// A race outside its bore, or distant nodes that may have touched.
    pub(crate) fn check(&mut self, body: &BodyState, solid: &ExplicitSolid) -> Result<(), Lost> {
        let (cylinder, frame) = self.ahead(body, solid);
        let [along, across, up] = frame.centre;
        let start = self.start;
        // Beyond these limits the nodes no longer represent the bore under the race.
        for (way, distance, allowed) in [
            ("along the axis", (along - start[0]).abs(), self.rim),
            ("across it", libm::hypot(across - start[1], up - start[2]), 0.1 * cylinder.radius),
        ] {
            if distance.is_nan() || distance > allowed {
                return Err(Lost::Bore(way, distance, allowed));
            }
        }
        if self.far.is_empty() {
            return Ok(());
        }
        let by_nodes = self
            .far
            .iter()
            .map(|(node, then)| norm(sub(moved(&solid.displacement, node.node), *then)))
            .fold(0.0, f64::max);
        let before = &self.sorted_at.1;
        let turned: f64 = norm(sub(frame.to_body[0], before.to_body[0]));
        let by_race = norm(sub(frame.centre, before.centre))
            + turned * (cylinder.radius + cylinder.width)
            + (cylinder.radius - self.sorted_at.0.radius).max(0.0);
        let gone = by_nodes + by_race;
        if gone.is_nan() || gone > self.seat.reach {
            return Err(Lost::Reach(gone));
        }
        if gone > 0.5 * self.seat.reach {
            self.sort(body, solid);
        }
        Ok(())
    }

    /// Resets the counts.
    pub(crate) fn forget_ran(&mut self) {
        self.presses = 0;
        self.friction.iter_mut().for_each(|friction| friction.updates = 0);
    }

    /// Number of tested and of distant nodes.
    pub fn counts(&self) -> (usize, usize) {
        (self.near.len(), self.far.len())
    }

    /// Contact nodes for this state of its body, and the force on each, N.
    pub(crate) fn nodal_forces(
        &self,
        body: &BodyState,
        solid: &ExplicitSolid,
    ) -> Vec<(ContactNode, Vec3)> {
        let (cylinder, frame) = self.ahead(body, solid);
        let at = |n: u32| moved(&solid.displacement, n);
        let mut found = Vec::new();
        contact(&cylinder, &frame, self.seat.penalty, &self.near, at, |node, _, _, force| {
            found.push((*node, force));
        });
        found
    }

    /// Contact at time `t` of the solid, `ahead` s after that of `body`; adds its forces to those of the nodes (N).
    pub(crate) fn snapshot(
        &self,
        body: &BodyState,
        [t, ahead]: [f64; 2],
        displacement: &[Node],
        forces: &mut [Node],
    ) -> SeatSnapshot {
        let cylinder = self.seat.cylinder(t, self.rim);
        let there = self.seat.frame_after(body, ahead);
        let (cylinder, frame) = (&cylinder, &there);
        let (nodes, penalty) = (&self.near[..], self.seat.penalty);
        let pressed = Pressed { cylinder, frame, penalty, nodes, displacement };
        let (contact, friction) = match &self.friction {
            None => (press(&pressed, forces), FrictionSum::default()),
            Some(friction) => friction.check(&pressed, forces),
        };
        let race = kinematics_at_mount(&BodyKinematics::new(*body), &self.seat.mount).state;
        let power = dot(contact.force, race.velocity) + dot(contact.moment, race.spin);
        SeatSnapshot {
            contact,
            friction,
            work: self.work,
            to_come: ahead * power,
            growth_work: self.growth.to(cylinder.radius, contact.radial_load).work,
        }
    }
}
