//! Bearing and housing in motion together, each in steps of its own; what they exchange is momentum.
//!
//! Central differences know the housing's velocities half a step before its displacements. The
//! bearing's time is that of the velocities. From there on both go through a window of equal length:
//! the outer race as if free, while the housing takes its steps against it and the impulses of the
//! contact are summed; then the bearing, under the mean of these impulses. Whatever the housing gets
//! the race gets too, with the other sign. Drift, kick, drift: of second order, and an elastic
//! contact between the two neither makes nor loses energy in the long run.

use super::condensed::{is_under, rim};
use crate::ch2_housing::bore_contact::{
    ContactNode, ContactSum, Cylinder, Frame, Penalty, contact, split_by_reach,
};
use crate::kinematics::Pose;
use crate::kinematics::vec3::{Vec3, add, add_scaled, dot, norm, scale, sub};
use crate::solver::dynamics::assembly::OUTER;
use crate::solver::dynamics::model::DynamicProblem;
use crate::solver::dynamics::race::{self, RaceLoads};
use crate::solver::dynamics::run::{RunOptions, Simulation, SimulationError, Snapshot};
use crate::solver::dynamics::start;
use crate::solver::dynamics::state::{BODY, BodyState, Ledger, Places};
use crate::solver::profile::Profile;
use crate::solver::solid::contact::{closed_limit, moved, press};
use crate::solver::solid::energy::SolidLedger;
use crate::solver::solid::explicit::{ExplicitMethod, ExplicitSolid};
use crate::solver::solid::model::{SolidError, SolidModel};
use crate::solver::solid::step_limit::step_limit;
use crate::solver::solid::tet4_blocks::Node;
use crate::solver::statics::StaticsError;
use nalgebra::{UnitQuaternion, Vector3};
use thiserror::Error;

/// The outer race's seat in the bore.
#[derive(Clone, Debug, PartialEq)]
pub struct Seat {
    /// Of the outer race's outside, m; an interference grows in by it.
    pub radius: Profile,
    /// Of the outer race, m.
    pub width: f64,
    pub penalty: Penalty,
    /// From [`contact_nodes`](crate::ch2_housing::bore_contact::contact_nodes).
    pub nodes: Vec<ContactNode>,
    /// Nodes farther than this from touching are not tested until something has moved half as far,
    /// m. Infinite: all are.
    pub reach: f64,
}

/// How far to go in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExchangeOptions {
    /// Steps of the housing, as a fraction of their stability limit with the contact closed.
    pub solid_fraction: f64,
    /// Windows, as ωH of the outer race on its whole seat; stable below 2.
    pub seat_phase: f64,
    pub bearing: RunOptions,
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum ExchangeError {
    #[error(transparent)]
    Bearing(#[from] SimulationError),
    #[error(transparent)]
    Solid(#[from] SolidError),
    #[error("the start has no equilibrium: {0}")]
    Start(#[from] StaticsError),
    #[error(
        "the outer race is fixed: it needs equations of its own to move in a housing \
         (outer_race.motion)"
    )]
    FixedRace,
    #[error(
        "the outer race rests on a foundation and in a housing; take one of them \
         (outer_race.foundation)"
    )]
    Foundation,
    #[error("{name} is {value}; it must be between 0 and {most}")]
    Option { name: &'static str, value: f64, most: f64 },
    #[error(
        "no node of the housing carries a part of the bore's surface; check the set of the bore"
    )]
    NoSeat,
    #[error(
        "the outer race has left its bore at t = {time} s, step {step}: it is {distance:.3e} m off \
         {way}, where {allowed:.3e} m are left of its seat"
    )]
    LeftBore { way: &'static str, distance: f64, allowed: f64, time: f64, step: u64 },
}

/// Steps between two looks at how far things have moved.
const LOOK: u64 = 16;

/// A bearing in a flexible housing.
pub struct HousedBearing {
    pub bearing: Simulation,
    pub solid: ExplicitSolid,
    /// Its nodes are those under the race at the start.
    pub seat: Seat,
    /// How far a node may slide over the rim and still be touched, m.
    pub rim: f64,
    /// Of the window in which both are taken on, s, and the steps of the housing in it.
    pub window: f64,
    pub solid_steps: usize,
    pub exchanges: u64,
    /// Of the contact as last evaluated.
    pub contact: ContactSum,
    /// On the outer race since the start, N·s.
    pub impulse: Vec3,
    /// Of an interference that grows in.
    pub growth: Growth,
    /// Nodes tested so far, and how often they were sorted by reach.
    pub tested: u64,
    pub sorts: u64,
    pub(super) near: Vec<ContactNode>,
    pub(super) far: Vec<(ContactNode, Vec3)>,
    pub(super) sorted_at: (Cylinder, Frame),
    /// What the ledgers of the bearing and of both held at the start, J.
    pub(super) first_bearing: f64,
    pub(super) first: f64,
}

/// Work that growth of the race's radius does against the contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Growth {
    /// Since the start, J.
    pub work: f64,
    /// When the contact was last evaluated, m, and what it resisted growth with, N.
    pub radius: f64,
    pub load: f64,
}

impl Growth {
    /// With the contact as it is at a later radius: the trapezium between the two.
    fn to(self, radius: f64, load: f64) -> Growth {
        let work = self.work + 0.5 * (self.load + load) * (radius - self.radius);
        Growth { work, radius, load }
    }
}

/// Everything at the present time.
#[derive(Clone, Copy, Debug)]
pub struct HousedSnapshot {
    pub bearing: Snapshot,
    pub outer: BodyState,
    pub solid: SolidLedger,
    pub contact: ContactSum,
    /// Of an interference that grew in, J.
    pub growth_work: f64,
    /// Energy unaccounted for in both together, J.
    pub residual: f64,
    /// Energy held in both and all work and losses, J: what the residual is a part of.
    pub turned_over: f64,
}

impl Seat {
    /// The race at time `t`, wider by `rim` (m) at each end.
    fn race(&self, t: f64, rim: f64) -> Cylinder {
        Cylinder { radius: self.radius.value(t), width: self.width + 2.0 * rim }
    }

    /// Leaves out the nodes beside a race that starts at `start` (X, Y, Z, m; tilts, rad), as a condensed
    /// housing does. How far the others may slide over the rim and still be touched, m.
    pub(super) fn keep_under(&mut self, start: &[f64; 5]) -> f64 {
        let frame = Frame::new(&pose_after(&race::fixed(start).state, 0.0));
        let width = self.width;
        self.nodes.retain(|node| is_under(frame.seen(node.place)[0], width));
        rim(self.nodes.iter().map(|node| node.area), width)
    }
}

/// ΣK of a seat for a shift of the race, N/m, and ΣKx² for a tilt, N·m/rad, all nodes touching.
fn seat_stiffness(seat: &Seat, centre: f64) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for node in &seat.nodes {
        let along = node.place[0] - centre;
        let stiffness = seat.penalty.of_node(node.area);
        sums[0] += stiffness;
        sums[1] += stiffness * along * along;
    }
    sums
}

impl HousedBearing {
    /// Starts with the outer race where `problem.outer_start` puts it, the bearing in equilibrium with
    /// it there and rolling, the housing still and displaced by `displacement` (m, one for each node).
    ///
    /// # Errors
    /// No equilibrium, a fixed race or one on a foundation, options out of range.
    pub fn new(
        problem: DynamicProblem,
        model: SolidModel,
        mut seat: Seat,
        displacement: Vec<Vec3>,
        options: &ExchangeOptions,
    ) -> Result<HousedBearing, ExchangeError> {
        let ranges = [
            ("the fraction of the solid's step limit", options.solid_fraction, 1.0),
            ("the phase of the seat in a window", options.seat_phase, 1.9),
        ];
        for (name, value, most) in ranges {
            if !(value > 0.0 && value <= most) {
                return Err(ExchangeError::Option { name, value, most });
            }
        }
        let outer = problem.outer.as_ref().ok_or(ExchangeError::FixedRace)?;
        if outer.foundation_stiffness.iter().chain(&outer.foundation_damping).any(|k| *k != 0.0) {
            return Err(ExchangeError::Foundation);
        }
        let rim = seat.keep_under(&problem.outer_start);
        let [shift, tilt] = seat_stiffness(&seat, problem.outer_start[0]);
        let square = (shift / outer.inertia.mass).max(tilt / outer.inertia.transverse);
        if square.is_nan() || square <= 0.0 {
            return Err(ExchangeError::NoSeat);
        }
        let longest = options.seat_phase / square.sqrt();
        let displacement: Vec<Node> =
            displacement.into_iter().map(|u| [u[0], u[1], u[2], 0.0]).collect();
        let method = ExplicitMethod::CentralDifferences;
        let limit = step_limit(&model, &displacement, method);
        let stable = closed_limit(&model, &seat.nodes, seat.penalty, &limit).step;
        let mut step = (options.solid_fraction * stable).min(longest);
        let state = held_start(&problem)?;
        let bearing = Simulation::from_state(problem, options.bearing, state, 0.0)?;
        // Windows of as many steps as the race allows; the bearing's own steps divide them or are
        // divided by them.
        let solid_steps = ((longest / step) as usize).max(1);
        let window = solid_steps as f64 * step;
        step = window / solid_steps as f64;
        let mut solid = ExplicitSolid::at_rest(model, method, step, limit);
        solid.displacement = displacement;
        solid.time = 0.5 * step;
        let frame = Frame::new(&pose_after(&outer_state(&bearing), 0.0));
        let cylinder = seat.race(0.0, rim);
        let mut housed = HousedBearing {
            bearing,
            solid,
            seat,
            rim,
            window,
            solid_steps,
            exchanges: 0,
            contact: ContactSum::default(),
            impulse: [0.0; 3],
            growth: Growth { radius: cylinder.radius, ..Growth::default() },
            tested: 0,
            sorts: 0,
            near: Vec::new(),
            far: Vec::new(),
            sorted_at: (cylinder, frame),
            first_bearing: 0.0,
            first: 0.0,
        };
        housed.growth.radius = housed.ahead().0.radius;
        housed.sort();
        housed.count_from_here()?;
        Ok(housed)
    }

    /// Balances energy from the present state on.
    fn count_from_here(&mut self) -> Result<(), ExchangeError> {
        self.first_bearing = 0.0;
        let start = self.balance()?;
        self.first_bearing = start.bearing.ledger[Ledger::Foundation as usize];
        // The balance counts from there.
        self.first = start.residual - self.first_bearing;
        Ok(())
    }

    /// Shortens windows and steps so that a whole number of windows makes `interval` (s), before the
    /// first exchange; returns how many.
    ///
    /// # Errors
    /// As [`HousedBearing::snapshot`].
    pub fn divide(&mut self, interval: f64) -> Result<u64, ExchangeError> {
        // A ratio that is whole but for rounding is whole.
        let windows = (interval / self.window * (1.0 - 1e-12)).ceil().max(1.0);
        self.window = interval / windows;
        self.solid.step_size = self.window / self.solid_steps as f64;
        self.solid.time = 0.5 * self.solid.step_size;
        // No step of the bearing is longer than its window, whatever it might be by itself.
        if self.bearing.control.is_none() {
            self.bearing.step_size = self.bearing.step_size.min(self.window);
        }
        // Where the contact is looked at first, it has not grown yet.
        self.growth = Growth::default();
        let (cylinder, _) = self.ahead();
        self.growth.radius = cylinder.radius;
        self.sort();
        self.count_from_here()?;
        Ok(windows as u64)
    }

    /// Present time: that of the bearing and of the housing's velocities, s.
    pub fn time(&self) -> f64 {
        self.bearing.time
    }

    /// Takes both through one window.
    ///
    /// # Errors
    /// What ends either, or a race that has left its bore.
    pub fn exchange(&mut self) -> Result<(), ExchangeError> {
        if self.exchanges.is_multiple_of(LOOK) {
            self.look()?;
        }
        let race = outer_state(&self.bearing);
        let step = self.solid.step_size;
        let mut impulse = RaceLoads::default();
        for k in 0..self.solid_steps {
            let pose = pose_after(&race, (k as f64 + 0.5) * step);
            let HousedBearing { solid, seat, near, contact: last, growth, rim, .. } = self;
            let frame = Frame::new(&pose);
            solid.step(|t, displacement, forces| {
                let cylinder = seat.race(t, *rim);
                *last = press(&cylinder, &frame, seat.penalty, near, displacement, forces);
                *growth = growth.to(cylinder.radius, last.radial_load);
            })?;
            self.tested += self.contact.tested as u64;
            impulse.force = add_scaled(impulse.force, step, self.contact.force);
            impulse.moment = add_scaled(impulse.moment, step, self.contact.moment);
        }
        self.impulse = add(self.impulse, impulse.force);
        self.bearing.set_outside_load(
            OUTER,
            RaceLoads {
                force: scale(impulse.force, 1.0 / self.window),
                moment: scale(impulse.moment, 1.0 / self.window),
            },
        );
        self.exchanges += 1;
        let target = self.window * self.exchanges as f64;
        let mut left = target - self.bearing.time;
        while left > 1e-9 * self.window {
            let parts = (left / self.bearing.step_size * (1.0 - 1e-9)).ceil().max(1.0);
            left -= self.bearing.step_by(left / parts)?;
        }
        self.bearing.time = target;
        Ok(())
    }

    /// The seat and its frame half a step of the housing ahead, where its displacements are.
    fn ahead(&self) -> (Cylinder, Frame) {
        let race = outer_state(&self.bearing);
        let frame = Frame::new(&pose_after(&race, 0.5 * self.solid.step_size));
        (self.seat.race(self.solid.time, self.rim), frame)
    }

    /// Sorts the nodes of the bore into those that are tested and those out of reach.
    pub(super) fn sort(&mut self) {
        let (cylinder, frame) = self.ahead();
        let displacement = &self.solid.displacement;
        let at = |n: u32| moved(displacement, n);
        let (near, far) = split_by_reach(&cylinder, &frame, &self.seat.nodes, at, self.seat.reach);
        self.near = near;
        self.far = far.into_iter().map(|node| (node, at(node.node))).collect();
        self.sorted_at = (cylinder, frame);
        self.sorts += 1;
    }

    /// Whether the race is still in its bore, and nodes out of reach still are.
    fn look(&mut self) -> Result<(), ExchangeError> {
        let (cylinder, frame) = self.ahead();
        let (time, step) = (self.bearing.time, self.exchanges);
        let [along, across, up] = frame.centre;
        let start = self.bearing.system.assembly.bodies[OUTER].rest;
        // Nodes no longer stand for what is under the race, or it hangs in the wall.
        for (way, distance, allowed) in [
            ("along the axis", (along - start[0]).abs(), self.rim),
            ("across it", libm::hypot(across - start[1], up - start[2]), 0.1 * cylinder.radius),
        ] {
            if distance.is_nan() || distance > allowed {
                return Err(ExchangeError::LeftBore { way, distance, allowed, time, step });
            }
        }
        if self.far.is_empty() {
            return Ok(());
        }
        let displacement = &self.solid.displacement;
        let by_nodes = self
            .far
            .iter()
            .map(|(node, then)| norm(sub(moved(displacement, node.node), *then)))
            .fold(0.0, f64::max);
        let before = &self.sorted_at.1;
        let turned: f64 = norm(sub(frame.to_body[0], before.to_body[0]));
        let by_race = norm(sub(frame.centre, before.centre))
            + turned * (cylinder.radius + cylinder.width)
            + (cylinder.radius - self.sorted_at.0.radius).max(0.0);
        if by_nodes + by_race > 0.5 * self.seat.reach {
            self.sort();
        }
        Ok(())
    }

    /// Nodes that are tested, and nodes out of reach.
    pub fn counts(&self) -> (usize, usize) {
        (self.near.len(), self.far.len())
    }

    /// Nodes that touch now, and the force on each, N.
    pub fn nodal_forces(&self) -> Vec<(ContactNode, Vec3)> {
        let (cylinder, frame) = self.ahead();
        let at = |n: u32| moved(&self.solid.displacement, n);
        let mut found = Vec::new();
        contact(&cylinder, &frame, self.seat.penalty, &self.near, at, |node, _, _, force| {
            found.push((*node, force));
        });
        found
    }

    /// Loads, energies and what is unaccounted for.
    ///
    /// # Errors
    /// More energy unaccounted for in the bearing than its options allow.
    pub fn snapshot(&mut self) -> Result<HousedSnapshot, ExchangeError> {
        let mut snapshot = self.balance()?;
        snapshot.residual -= self.first;
        Ok(snapshot)
    }

    /// The bearing is balanced where its time is, housing and contact half a step later: what the
    /// contact does to the race in between is added.
    fn balance(&mut self) -> Result<HousedSnapshot, ExchangeError> {
        let bearing = self.bearing.snapshot()?;
        let outer = outer_state(&self.bearing);
        let (cylinder, frame) = self.ahead();
        let HousedBearing { solid, seat, near, .. } = self;
        let mut touching = ContactSum::default();
        let solid = solid.ledger_with(|_, displacement, forces| {
            touching = press(&cylinder, &frame, seat.penalty, near, displacement, forces);
        });
        let ahead = 0.5 * self.solid.step_size;
        let power = dot(touching.force, outer.velocity) + dot(touching.moment, outer.spin);
        let on_race = bearing.ledger[Ledger::Foundation as usize] - self.first_bearing;
        let growth_work = self.growth.to(cylinder.radius, touching.radial_load).work;
        let held = solid.energy.strain + solid.energy.kinetic + touching.energy;
        let residual = bearing.residual + on_race + ahead * power + held
            - solid.external_work
            - solid.damping_work
            - growth_work;
        let work: f64 = bearing.ledger.iter().map(|entry| entry.abs()).sum();
        let turned_over = bearing.energy.contact
            + held
            + work
            + solid.external_work.abs()
            + solid.damping_work.abs()
            + growth_work.abs();
        let contact = touching;
        Ok(HousedSnapshot { bearing, outer, solid, contact, growth_work, residual, turned_over })
    }
}

/// The outer race of a simulation.
pub fn outer_state(bearing: &Simulation) -> BodyState {
    let at = bearing.system.places.body(OUTER);
    BodyState::from_slice(&bearing.state[at..at + BODY])
}

/// Where a race is after `time` s if nothing pushes it.
fn pose_after(race: &BodyState, time: f64) -> Pose {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::from(race.spin) * time);
    Pose {
        position: add_scaled(race.position, time, race.velocity).into(),
        orientation: turn * race.orientation,
    }
}

/// State of a bearing in equilibrium whose outer race is held where it starts.
fn held_start(problem: &DynamicProblem) -> Result<Vec<f64>, StaticsError> {
    let held = DynamicProblem { outer: None, ..problem.clone() }.assembly();
    let mut state = start::at_equilibrium(&held)?;
    let outer = race::fixed(&problem.outer_start).state.to_array();
    let at = Places::of(&held).body(OUTER);
    state[at..at + BODY].copy_from_slice(&outer);
    Ok(state)
}
