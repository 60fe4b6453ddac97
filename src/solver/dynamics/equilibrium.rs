//! Where bodies and balls of an assembly stand still: the place that a motion starts from and settles into.
//!
//! One search over the coordinates of all bodies ([`solve_assembly`]). Loads that follow the place they
//! act at (an unbalance, the traction that holds rolling balls in their orbits, damping inside a bent shaft that
//! spins) are taken as they are at the last place until they change no more.

use super::assembly::{Assembly, Bearing, Body};
use super::bounds::FARTHEST;
use super::model::{Drive, RaceBody, Rotation};
use super::static_sections;
use crate::ch2_housing::bearing::frequencies::ratios;
use crate::ch2_housing::bearing::traction::{TractionLaw, coefficient};
use crate::kinematics::Pose;
use crate::kinematics::euler::{about, quaternion};
use crate::solver::mount::Mount;
use crate::solver::static_assembly::{Loaded, Place, StaticAssembly, StaticBearing, StaticBody};
use crate::solver::static_tables::BearingState;
use crate::solver::statics::{
    AssemblySolution, Condition, StaticOptions, StaticsError, solve_assembly,
};
use nalgebra::{SVector, Vector3};

type Five = SVector<f64, 5>;

/// Where all bodies and the balls stand still, in the world.
pub type Equilibrium = AssemblySolution;

impl Equilibrium {
    /// Position (m) and tilts (rad) of a body.
    pub fn place(&self, assembly: &Assembly, body: usize) -> [f64; 5] {
        let of = &assembly.bodies[body];
        if of.moves() { self.coordinates[body].into() } else { of.rest }
    }
}

/// Equilibrium under the loads at t = 0. Forces that turn stand still in the direction that they
/// have then: the rotating load at its phase, an unbalance along its body's own Y. Balls that
/// roll are held in their orbit by traction, where there is any.
///
/// # Errors
/// When the loads have no equilibrium.
pub fn at_start(assembly: &Assembly) -> Result<Equilibrium, StaticsError> {
    at(assembly, 0.0, &[], None)
}

/// The same under the loads at `t`, the balls of each bearing moved on by `turned` (rad; none where it is
/// empty), looked for `near` one that is known.
///
/// # Errors
/// When the loads have no equilibrium.
pub(super) fn at(
    assembly: &Assembly,
    t: f64,
    turned: &[f64],
    near: Option<&Equilibrium>,
) -> Result<Equilibrium, StaticsError> {
    let mut plain = static_assembly(assembly, t, turned);
    let options = StaticOptions::default();
    let bend = |still: &mut StaticAssembly, known: &Equilibrium| {
        let shafts = still.shafts.iter_mut().zip(&known.amplitudes);
        shafts.for_each(|(shaft, amplitudes)| shaft.start.clone_from(amplitudes));
    };
    if let Some(near) = near {
        bend(&mut plain, near);
    }
    let mut near = near.map(|near| near.coordinates.clone());
    let mut tilts = near.clone().unwrap_or_else(|| given(&plain));
    let mut extra = Extra::none(&plain);
    let mut follows: Vec<bool> = assembly.bodies.iter().map(|body| unbalanced(body, t)).collect();
    follows.resize(plain.bodies.len(), false);
    for (section, _) in static_sections::unbalance_loads(assembly, &plain, t, &tilts) {
        follows[section] = true;
    }
    let mut dragged: Vec<Vec<f64>> = vec![Vec::new(); plain.shafts.len()];
    let mut before: Option<Vec<Five>> = None;
    let mut solution = None;
    let mut unsettled = None;
    // An unbalance follows the race's tilts, by at most tilt · F/(k R) of what they were before;
    // traction that holds balls in their orbit changes by its own shift over the pitch radius; what damping inside drags a shaft
    // by is a part cΩ/ω² of what bends it.
    let drags = assembly.shafts.iter().any(|shaft| shaft.internal_damping != 0.0);
    for _ in 0..if drags { DRAGGED_ROUNDS } else { ROUNDS } {
        let mut loaded = plain.clone();
        for (shaft, dragged) in loaded.shafts.iter_mut().zip(&dragged) {
            shaft.loads.clone_from(dragged);
        }
        let on_sections = static_sections::unbalance_loads(assembly, &plain, t, &tilts);
        for (index, body) in loaded.bodies.iter_mut().enumerate() {
            let mut add = extra.loads[index];
            if let Place::Section(of) = &mut body.place {
                let unbalances = on_sections.iter().filter(|(section, _)| *section == index);
                unbalances.for_each(|(_, force)| add += force);
                of.loads.iter_mut().zip(&add).for_each(|(load, add)| *load += add);
            }
            let Place::Loaded(place) = &mut body.place else { continue };
            if follows[index] {
                let at = &tilts[index];
                add += unbalance(&assembly.bodies[index], t, [at[3], at[4]]);
            }
            for (condition, add) in place.conditions.iter_mut().zip(add.iter()) {
                if let Condition::Load(load) = condition
                    && *add != 0.0
                {
                    *load += add;
                }
            }
        }
        let mut found = match &near {
            Some(at) => solve_assembly(&loaded, Some(at), &options)
                .or_else(|_| solve_assembly(&loaded, None, &options))?,
            None => solve_assembly(&loaded, None, &options)?,
        };
        // As they are given, and not as a pose has them.
        for (coordinates, body) in found.coordinates.iter_mut().zip(&assembly.bodies) {
            if let Some(at) = body.driven().and_then(|race| all_given(race, t)) {
                *coordinates = at.into();
            }
        }
        bend(&mut plain, &found);
        let now = &found.coordinates;
        let next = Extra::of(assembly, &plain, t, &found);
        let largest = largest_load(&found.bearings);
        // Below what statics itself leaves over.
        let mut settled = next.differs(&extra) <= options.tolerance * largest;
        unsettled = None;
        for ((of, shaft), (dragged, amplitudes)) in assembly
            .shafts
            .iter()
            .zip(&plain.shafts)
            .zip(dragged.iter_mut().zip(&found.amplitudes))
            .filter(|((of, _), _)| of.internal_damping != 0.0)
        {
            let spin = given_speed(&assembly.bodies[of.body], t);
            let next = of.dragged(spin, amplitudes);
            let most = |of: &mut dyn Iterator<Item = f64>| of.fold(0.0, |m: f64, x| m.max(x.abs()));
            let bends = most(&mut amplitudes.iter().zip(&shaft.springs).map(|(a, w)| a * w));
            let old = dragged.iter().copied().chain(std::iter::repeat(0.0));
            let changed = most(&mut next.iter().zip(old).map(|(new, old)| new - old));
            let still = changed <= options.tolerance * bends;
            unsettled = (!still).then_some(of.body).or(unsettled);
            settled &= still;
            *dragged = next;
        }
        if follows.contains(&true) {
            let change = |a: &[Five]| {
                let tilts = a.iter().zip(now).zip(&follows).filter(|(_, follows)| **follows);
                tilts.fold(0.0f64, |most, ((a, b), _)| {
                    most.max((a[3] - b[3]).abs()).max((a[4] - b[4]).abs())
                })
            };
            let circles = before.as_ref().is_some_and(|before| change(before) == 0.0);
            settled &= change(&tilts) <= 1e-14 || circles;
            before = Some(std::mem::replace(&mut tilts, now.clone()));
        }
        near = Some(now.clone());
        extra = next;
        solution = Some(found);
        if settled {
            break;
        }
    }
    if let Some(body) = unsettled {
        let body = assembly.bodies[body].name.clone();
        return Err(StaticsError::Dragged { body });
    }
    // So many rounds at most are made, and one at least.
    solution.ok_or(StaticsError::NotFinite { what: "rounds", value: f64::NAN })
}

/// Coordinates as far as they are given.
fn given(assembly: &StaticAssembly) -> Vec<Five> {
    let of = |body: &StaticBody| match &body.place {
        Place::Held(_) | Place::Section(_) => Five::zeros(),
        Place::Loaded(loaded) => Five::from_fn(|i, _| loaded.given(i).unwrap_or(0.0)),
    };
    assembly.bodies.iter().map(of).collect()
}

fn largest_load(bearings: &[BearingState]) -> f64 {
    let balls = bearings.iter().flat_map(|bearing| &bearing.balls);
    balls.fold(0.0f64, |most, ball| most.max(ball.inner.normal_load))
}

/// The static problem of an assembly at time `t`; a rotating load stands still where it is then, an
/// unbalance is left out.
pub fn static_assembly(assembly: &Assembly, t: f64, turned: &[f64]) -> StaticAssembly<'static> {
    let carries_outer =
        |body: usize| assembly.bearings.iter().any(|bearing| bearing.mounts[1].body == body);
    let room = |body: usize| {
        let on = assembly.bearings.iter().filter(|bearing| bearing.mounts[0].body == body);
        let ball = on.map(|bearing| bearing.geometry.ball_radius).fold(FARTHEST, f64::min);
        if carries_outer(body) { FARTHEST } else { ball }
    };
    let bodies = assembly.bodies.iter().enumerate().map(|(index, body)| {
        let rest = &body.rest;
        let place = match body.driven() {
            None => held_at(rest),
            Some(race) if let Some(at) = all_given(race, t) => held_at(&at),
            Some(race) => {
                // A race alone against one that is held is looked for where its load would take it.
                let alone = !carries_outer(index)
                    && assembly.bearings.len() == 1
                    && rest[0] == 0.0
                    && assembly.bearings[0].mounts.iter().all(Mount::is_direct)
                    && is_held(&assembly.bodies[assembly.bearings[0].mounts[1].body]);
                Place::Loaded(Loaded {
                    axes: None,
                    conditions: conditions(assembly, body, race, t),
                    springs: race.foundation_stiffness,
                    rest: *rest,
                    start: (!alone).then_some(*rest),
                    room: room(index),
                })
            }
        };
        StaticBody { name: body.name.clone(), place }
    });
    let bearings = assembly.bearings.iter().enumerate().map(|(index, bearing)| StaticBearing {
        name: bearing.name.clone(),
        geometry: bearing.geometry,
        inner_contact: bearing.inner_contact,
        outer_contact: bearing.outer_contact,
        mounts: bearing.mounts,
        ball_phase: bearing.ball_phase + turned.get(index).copied().unwrap_or(0.0),
        weight: Vector3::from(assembly.gravity) * bearing.ball.mass,
        centrifugal: bearing.ball.mass * orbital_speed(assembly, bearing, t).powi(2),
    });
    let mut still = StaticAssembly {
        bodies: bodies.collect(),
        bearings: bearings.collect(),
        connections: assembly.connections.clone(),
        ..StaticAssembly::default()
    };
    static_sections::add(assembly, t, &mut still);
    still
}

/// What is given of a body's coordinates or acts along them at time `t`: its drives, weight, rotating load.
pub fn conditions(assembly: &Assembly, body: &Body, race: &RaceBody, t: f64) -> [Condition; 5] {
    let mut others = [0.0; 5];
    for (other, gravity) in others.iter_mut().zip(assembly.gravity) {
        *other = race.inertia.mass * gravity;
    }
    if let Some(load) = &body.rotating_load {
        for (other, force) in others.iter_mut().zip(load.force(t)) {
            *other += force;
        }
    }
    std::array::from_fn(|i| match &race.drives[i] {
        Drive::Load(profile) => Condition::Load(profile.value(t) + others[i]),
        Drive::Motion(profile) => Condition::Displacement(profile.value(t)),
    })
}

fn held_at(at: &[f64; 5]) -> Place {
    Place::Held(Pose {
        position: Vector3::new(at[0], at[1], at[2]),
        orientation: quaternion(0.0, at[3], at[4]),
    })
}

/// Coordinates of a body all of which are given.
fn all_given(race: &RaceBody, t: f64) -> Option<[f64; 5]> {
    let mut at = [0.0; 5];
    for (at, drive) in at.iter_mut().zip(&race.drives) {
        let Drive::Motion(profile) = drive else { return None };
        *at = profile.value(t);
    }
    Some(at)
}

/// Whether nothing is looked for of a body.
pub(super) fn is_held(body: &Body) -> bool {
    body.driven().is_none_or(|race| all_given(race, 0.0).is_some())
}

/// Given speed of a body about its own axis at `t`, rad/s; zero when it is driven by a torque, or fixed.
pub(super) fn given_speed(body: &Body, t: f64) -> f64 {
    match body.driven().map(|race| &race.rotation) {
        Some(Rotation::Speed(profile)) => profile.value(t),
        Some(Rotation::Torque(_)) | None => 0.0,
    }
}

/// Angle by which the given speed has turned a body since t = 0, rad.
pub(super) fn given_angle(body: &Body, t: f64) -> f64 {
    match body.driven().map(|race| &race.rotation) {
        Some(Rotation::Speed(profile)) => profile.integral(t),
        Some(Rotation::Torque(_)) | None => 0.0,
    }
}

/// Given speeds of both races of a bearing about the bearing's axis, rad/s.
pub(super) fn race_speeds(assembly: &Assembly, bearing: &Bearing, t: f64) -> [f64; 2] {
    of_races(assembly, bearing, |body| given_speed(body, t))
}

/// What both races of a bearing have about the bearing's axis.
fn of_races(assembly: &Assembly, bearing: &Bearing, of: impl Fn(&Body) -> f64) -> [f64; 2] {
    bearing.mounts.map(|mount| {
        let own = of(&assembly.bodies[mount.body]);
        if mount.reversed { -own } else { own }
    })
}

/// Speed of the ball set by pure rolling about the bearing's axis, rad/s.
pub(super) fn orbital_speed(assembly: &Assembly, bearing: &Bearing, t: f64) -> f64 {
    rolled(bearing, race_speeds(assembly, bearing, t))
}

/// Angle by which pure rolling has taken the ball set about the bearing's axis since t = 0, rad.
pub fn orbital_angle(assembly: &Assembly, bearing: &Bearing, t: f64) -> f64 {
    rolled(bearing, of_races(assembly, bearing, |body| given_angle(body, t)))
}

/// What is left to balls of turns of the inner and of the outer race.
fn rolled(bearing: &Bearing, [inner, outer]: [f64; 2]) -> f64 {
    let g = &bearing.geometry;
    let ratio = ratios(g.ball_count, g.ball_radius, g.pitch_radius, g.contact_angle).cage;
    // Both races' surfaces move past the balls: the outer one's share is the rest.
    if outer == 0.0 { ratio * inner } else { ratio * inner + (1.0 - ratio) * outer }
}

fn unbalanced(body: &Body, t: f64) -> bool {
    let speed = given_speed(body, t);
    body.unbalance * speed * speed != 0.0
}

/// Centrifugal force of an unbalance on x, y and z with the body at these tilts.
fn unbalance(body: &Body, t: f64, [xi, lambda]: [f64; 2]) -> Five {
    let speed = given_speed(body, t);
    let size = body.unbalance * speed * speed;
    let turned = about(Vector3::x(), given_angle(body, t)) * Vector3::y();
    let along = about(Vector3::y(), xi) * about(Vector3::z(), lambda) * turned;
    Five::from([size * along.x, size * along.y, size * along.z, 0.0, 0.0])
}

/// Rounds of loads that follow the place they act at, and with damping inside shafts, whose pull may be a good part of what bends
/// them.
const ROUNDS: usize = 20;
const DRAGGED_ROUNDS: usize = 60;

/// Largest slip of rolling contacts over their rolling speed.
const CREEP: f64 = 0.01;

/// Loads on bodies besides those that are given, conjugate to their coordinates.
///
/// Normal loads, whose lines do not quite meet, and weight push a ball along its orbit. Statics
/// holds it there, on the outer race; in a bearing that rolls steadily traction does, half of it at each race so
/// that the ball's spin stays as it is, and as far as a slip of [`CREEP`] gives that much. Nothing
/// holds the balls of one that does not roll.
#[derive(Clone, Debug)]
struct Extra {
    loads: Vec<Five>,
}

impl Extra {
    fn none(still: &StaticAssembly) -> Extra {
        Extra { loads: vec![Five::zeros(); still.bodies.len()] }
    }

    fn of(
        assembly: &Assembly,
        still: &StaticAssembly,
        t: f64,
        solution: &AssemblySolution,
    ) -> Extra {
        let mut extra = Extra::none(still);
        let bearings = assembly.bearings.iter().zip(&still.bearings).zip(&solution.bearings);
        for ((bearing, StaticBearing { mounts, .. }), state) in bearings {
            let [inner, outer] = race_speeds(assembly, bearing, t);
            let rolls = inner != outer && bearing.traction != TractionLaw::None;
            let moves = !is_held(&assembly.bodies[bearing.mounts[1].body]);
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
                    // What statics has put on the outer race in the cage's place.
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
    fn differs(&self, other: &Extra) -> f64 {
        let forces = self.loads.iter().zip(&other.loads);
        forces.fold(0.0, |most: f64, (a, b)| most.max((a - b).fixed_rows::<3>(0).amax()))
    }
}

/// Of a bearing's outer race, as its body's coordinates have it.
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
