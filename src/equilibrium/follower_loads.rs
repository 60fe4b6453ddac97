//! Loads in an equilibrium that depend on the position: unbalance, traction on orbiting balls, internal damping of a
//! bent spinning shaft. They are evaluated at the last position found until they converge.

use crate::assembly::lists::Assembly;
use crate::assembly::prescribed::race_speeds;
use crate::ch2_housing::bearing::traction::{TractionLaw, coefficient};
use crate::equilibrium::bearing_tables::BearingState;
use crate::equilibrium::lists::{Place, StaticAssembly, StaticBearing};
use crate::equilibrium::sections::unbalance_loads;
use crate::equilibrium::statics::{AssemblySolution, StaticsError};
use crate::kinematics::euler::{about, quaternion};
use crate::members::bearing::Bearing;
use crate::members::body::{Body, Condition, is_fixed, prescribed_angle, prescribed_speed};
use nalgebra::{SVector, Vector3};

type Five = SVector<f64, 5>;

/// Largest number of iterations with follower loads, and with internal damping, whose force may be comparable with the
/// load.
const ROUNDS: usize = 20;
const DRAGGED_ROUNDS: usize = 60;

/// Change of tilts in an iteration within their rounding, rad.
const STILL: f64 = 1e-14;
/// Relative error of an unbalance force accepted at the end of all iterations: less than the accuracy of any run, more
/// than the rounding of tilts with little stiffness.
const CLOSE: f64 = 1e-9;

/// Follower loads at the last position found.
///
/// An unbalance rotates with the race's tilts and changes by at most tilt · F/(k R) of the previous change; traction on
/// orbiting balls changes by its own displacement over the pitch radius; internal damping is a part cΩ/ω² of the
/// bending load.
pub(crate) struct FollowerLoadRounds<'a> {
    assembly: &'a Assembly,
    t: f64,
    extra: FollowerLoads,
    /// For each static body: whether an unbalance acts on it, its coordinates in the last iteration and in the one
    /// before.
    follows: Vec<bool>,
    tilts: Vec<Five>,
    before: Option<Vec<Five>>,
    /// Modal forces of internal damping of each shaft, N.
    dragged: Vec<Vec<f64>>,
    /// Error of the last iteration.
    unsettled: Option<StaticsError>,
}

impl<'a> FollowerLoadRounds<'a> {
    /// Before the first iteration, with static bodies at these coordinates.
    pub fn new(
        assembly: &'a Assembly,
        plain: &StaticAssembly,
        t: f64,
        tilts: Vec<Five>,
    ) -> FollowerLoadRounds<'a> {
        let mut follows: Vec<bool> =
            assembly.bodies.iter().map(|body| unbalanced(body, t)).collect();
        follows.resize(plain.bodies.len(), false);
        for (section, _) in unbalance_loads(assembly, plain, t, &tilts) {
            follows[section] = true;
        }
        FollowerLoadRounds {
            assembly,
            t,
            extra: FollowerLoads::none(plain),
            follows,
            tilts,
            before: None,
            dragged: vec![Vec::new(); plain.shafts.len()],
            unsettled: None,
        }
    }

    /// Largest number of iterations.
    pub fn rounds(&self) -> usize {
        let drags = self.assembly.shafts.iter().any(|shaft| shaft.internal_damping != 0.0);
        if drags { DRAGGED_ROUNDS } else { ROUNDS }
    }

    /// Error of the last iteration, if larger than rounding.
    pub fn unsettled(self) -> Option<StaticsError> {
        self.unsettled
    }

    /// The lists with these loads.
    pub fn loaded<'s>(&self, plain: &StaticAssembly<'s>) -> StaticAssembly<'s> {
        let mut loaded = plain.clone();
        for (shaft, dragged) in loaded.shafts.iter_mut().zip(&self.dragged) {
            shaft.loads.clone_from(dragged);
        }
        let on_sections = unbalance_loads(self.assembly, plain, self.t, &self.tilts);
        for (index, body) in loaded.bodies.iter_mut().enumerate() {
            let mut add = self.extra.loads[index];
            if let Place::Section(of) = &mut body.place {
                let unbalances = on_sections.iter().filter(|(section, _)| *section == index);
                unbalances.for_each(|(_, force)| add += force);
                of.loads.iter_mut().zip(&add).for_each(|(load, add)| *load += add);
            }
            let Place::Loaded(place) = &mut body.place else { continue };
            if self.follows[index] {
                let at = &self.tilts[index];
                add += unbalance(&self.assembly.bodies[index], self.t, [at[3], at[4]]);
            }
            for (condition, add) in place.conditions.iter_mut().zip(add.iter()) {
                if let Condition::Load(load) = condition
                    && *add != 0.0
                {
                    *load += add;
                }
            }
        }
        loaded
    }

    /// Evaluates all loads at the position found; returns whether they have converged to `tolerance`.
    pub fn follow(
        &mut self,
        plain: &StaticAssembly,
        found: &AssemblySolution,
        tolerance: f64,
    ) -> bool {
        self.unsettled = None;
        let next = FollowerLoads::of(self.assembly, plain, self.t, found);
        // Below the tolerance of statics itself.
        let orbits = next.differs(&self.extra) <= tolerance * largest_load(&found.bearings);
        self.extra = next;
        let drags = self.follow_drags(plain, found, tolerance);
        let unbalances = self.follow_unbalances(plain, &found.coordinates);
        orbits && drags && unbalances
    }

    /// Internal damping of shafts, compared with the bending load.
    fn follow_drags(
        &mut self,
        plain: &StaticAssembly,
        found: &AssemblySolution,
        tolerance: f64,
    ) -> bool {
        let most = |of: &mut dyn Iterator<Item = f64>| of.fold(0.0, |m: f64, x| m.max(x.abs()));
        let shafts = self.assembly.shafts.iter().zip(&plain.shafts);
        let pulls = self.dragged.iter_mut().zip(&found.amplitudes);
        for ((of, shaft), (dragged, amplitudes)) in shafts.zip(pulls) {
            if of.internal_damping == 0.0 {
                continue;
            }
            let body = &self.assembly.bodies[of.body];
            let next = of.dragged(prescribed_speed(body, self.t), amplitudes);
            let bends = most(&mut amplitudes.iter().zip(&shaft.springs).map(|(a, w)| a * w));
            let old = dragged.iter().copied().chain(std::iter::repeat(0.0));
            let changed = most(&mut next.iter().zip(old).map(|(new, old)| new - old));
            let still = changed <= tolerance * bends;
            if !still {
                self.unsettled = Some(StaticsError::Dragged { body: body.name.clone() });
            }
            *dragged = next;
        }
        self.unsettled.is_none()
    }

    /// Unbalance: its force rotates with the tilts, which converge to their rounding or alternate by it.
    fn follow_unbalances(&mut self, plain: &StaticAssembly, now: &[Five]) -> bool {
        if !self.follows.contains(&true) {
            return true;
        }
        let change = |from: &[Five], index: usize| {
            let (from, now) = (&from[index], &now[index]);
            (from[3] - now[3]).abs().max((from[4] - now[4]).abs())
        };
        let bodies: Vec<usize> = (0..now.len()).filter(|body| self.follows[*body]).collect();
        let most = |from: &[Five]| bodies.iter().fold(0.0, |m: f64, of| m.max(change(from, *of)));
        let changed = most(&self.tilts);
        let circles = self.before.as_ref().is_some_and(|before| most(before) == 0.0);
        let far = bodies.iter().find(|body| change(&self.tilts, **body) > CLOSE);
        if let Some(body) = far {
            let body = plain.bodies[*body].name.clone();
            self.unsettled.get_or_insert(StaticsError::Unbalanced { body });
        }
        let still = changed <= STILL || (circles && far.is_none());
        self.before = Some(std::mem::replace(&mut self.tilts, now.to_vec()));
        still
    }
}

fn unbalanced(body: &Body, t: f64) -> bool {
    let speed = prescribed_speed(body, t);
    body.unbalance * speed * speed != 0.0
}

/// Centrifugal force of an unbalance on x, y and z with the body at these tilts.
fn unbalance(body: &Body, t: f64, [xi, lambda]: [f64; 2]) -> Five {
    let speed = prescribed_speed(body, t);
    let size = body.unbalance * speed * speed;
    let turned = about(Vector3::x(), prescribed_angle(body, t)) * Vector3::y();
    let along = about(Vector3::y(), xi) * about(Vector3::z(), lambda) * turned;
    Five::from([size * along.x, size * along.y, size * along.z, 0.0, 0.0])
}

fn largest_load(bearings: &[BearingState]) -> f64 {
    let balls = bearings.iter().flat_map(|bearing| &bearing.balls);
    balls.fold(0.0f64, |most, ball| most.max(ball.inner.normal_load))
}

/// Largest slip of rolling contacts over their rolling speed.
const CREEP: f64 = 0.01;

/// Additional loads on bodies, conjugate to their coordinates.
///
/// Normal loads, whose lines do not quite meet, and weight push a ball along its orbit. Statics lets the cage hold it
/// there, on the outer race. In a steadily rolling bearing traction does, half of it at each race so that the ball's
/// spin is constant, up to the traction of a slip of [`CREEP`]. Balls of a bearing at rest are not held.
/// holds the balls of one that does not roll.
#[derive(Clone, Debug)]
struct FollowerLoads {
    loads: Vec<Five>,
}

impl FollowerLoads {
    fn none(still: &StaticAssembly) -> FollowerLoads {
        FollowerLoads { loads: vec![Five::zeros(); still.bodies.len()] }
    }

    fn of(
        assembly: &Assembly,
        still: &StaticAssembly,
        t: f64,
        solution: &AssemblySolution,
    ) -> FollowerLoads {
        let mut extra = FollowerLoads::none(still);
        let bearings = assembly.bearings.iter().zip(&still.bearings).zip(&solution.bearings);
        for ((bearing, StaticBearing { mounts, .. }), state) in bearings {
            let [inner, outer] = race_speeds(assembly, bearing, t);
            let rolls = inner != outer && bearing.traction != TractionLaw::None;
            let moves = !is_fixed(&assembly.bodies[bearing.mounts[1].body]);
            if !(rolls || moves) {
                continue;
            }
            let rolling_speed = 0.5 * ((inner - outer) * bearing.geometry.pitch_radius).abs();
            let grip = coefficient(&bearing.traction, CREEP * rolling_speed, rolling_speed);
            let outer_body = &solution.coordinates[mounts[1].body];
            let orientation = outer_orientation(assembly, bearing, outer_body);
            for ball in &state.balls {
                let (sin, cos) = libm::sincos(ball.azimuth);
                let around = orientation * Vector3::new(0.0, -sin, cos);
                if moves {
                    // The cage force of statics on the outer race.
                    let by_cage = around * ball.cage_force;
                    extra.add(solution, mounts[1].body, &ball.position, &by_cage);
                }
                let contacts = [&ball.inner, &ball.outer];
                if !rolls || contacts.iter().any(|contact| contact.normal_load <= 0.0) {
                    continue;
                }
                let most = grip * ball.inner.normal_load.min(ball.outer.normal_load);
                let force = around * (-0.5 * ball.cage_force).clamp(-most, most);
                for (side, contact) in contacts.into_iter().enumerate() {
                    let towards_race = contact.force_on_race / contact.force_on_race.norm();
                    let point = ball.position + towards_race * bearing.geometry.ball_radius;
                    extra.add(solution, mounts[side].body, &point, &force);
                }
            }
        }
        extra
    }

    /// Adds a force at a point of a static body.
    fn add(
        &mut self,
        solution: &AssemblySolution,
        body: usize,
        point: &Vector3<f64>,
        force: &Vector3<f64>,
    ) {
        let q = &solution.coordinates[body];
        let moment = (point - Vector3::new(q[0], q[1], q[2])).cross(force);
        let tilted = about(Vector3::y(), q[3]) * about(Vector3::z(), q[4]) * Vector3::z();
        self.loads[body] += Five::from([force.x, force.y, force.z, moment.y, moment.dot(&tilted)]);
    }

    /// Largest difference of a force, N.
    fn differs(&self, other: &FollowerLoads) -> f64 {
        let forces = self.loads.iter().zip(&other.loads);
        forces.fold(0.0, |most: f64, (a, b)| most.max((a - b).fixed_rows::<3>(0).amax()))
    }
}

/// Orientation of a bearing's outer race from its body's coordinates.
fn outer_orientation(
    assembly: &Assembly,
    bearing: &Bearing,
    coordinates: &Five,
) -> nalgebra::UnitQuaternion<f64> {
    let mount = &bearing.mounts[1];
    let body = &assembly.bodies[mount.body];
    let [xi, lambda] =
        if body.moves() { [coordinates[3], coordinates[4]] } else { [body.rest[3], body.rest[4]] };
    let turn = quaternion(0.0, xi, lambda);
    if mount.reversed { turn * about(Vector3::z(), std::f64::consts::PI) } else { turn }
}
