//! The search for an equilibrium: Newton's method with a trust radius on the energy, over the coordinates
//! of all bodies that are loaded. Balls are in equilibrium at every evaluation.
//!
//! Each bearing, connection and seat adds energy, force and stiffness over the coordinates of its bodies, what is its
//! own eliminated: balls in equilibrium, nodes of a bore in contact or not.

use super::ball::{
    BallContacts, BallPlane, InnerRacePosition, SettledBall, energy_noise, overlap_of_races,
};
use super::dynamics::connection::Connection;
use super::dynamics::race;
use super::housing::bore_equilibrium::{BoreSearch, BoreState};
use super::static_assembly::{Loaded, Place, StaticAssembly, StaticBearing};
use super::static_bearing::{add_bearing, planes};
use super::static_seat::{SeatPlace, add_seat};
use super::static_start;
use super::statics::{COORDINATE_NAMES, Determinacy, StaticOptions, StaticsError};
use crate::ch2_housing::bearing::contact::normal_load;
use crate::kinematics::Pose;
use crate::kinematics::euler::quaternion;
use crate::kinematics::vec3::{Vec3, add, cross, sub};
use nalgebra::{DMatrix, DVector, Matrix3, SVector, SymmetricEigen, Vector3};
use std::f64::consts::TAU;

/// Stiffness below this fraction of the largest one counts as none. Rounding of the overlaps leaves
/// about 1e-12; the softest real direction, the swivel of a loaded ball, has about 1e-3.
const NO_STIFFNESS: f64 = 1e-9;

/// First trust radius where nothing but springs holds, m: it grows by itself.
const WITHOUT_BEARING: f64 = 1e-4;

/// Artificial stiffness of a body in a bore, as a part of its largest: a race that touches nothing, or one row of
/// nodes, stays where it is in directions in which nothing holds it. Its force is nothing in equilibrium.
const HINT: f64 = 1e-8;
/// Part of its radius by which a race may leave its place while it is looked for, and in the end: nothing that a bore
/// holds moves by a hundredth of its radius.
const LOST: f64 = 1e3;
pub(super) const FAR: f64 = 1e-2;

pub(super) type Five = SVector<f64, 5>;

/// What does not change while bodies move.
pub(super) struct Model<'a> {
    pub(super) assembly: &'a StaticAssembly<'a>,
    pub(super) bearings: Vec<BearingModel>,
    /// Axes of each body's coordinates as each seat sees them from where its race's motion is measured.
    seat_axes: Vec<Pose>,
    /// First unknown of each body; `None` where it is held.
    unknowns: Vec<Option<usize>>,
    /// Metres per unit of each unknown: 1 for lengths, a pitch radius (that of a seat, without a bearing) for tilts.
    scale: DVector<f64>,
}

pub(super) struct BearingModel {
    pub(super) contacts: BallContacts,
    pub(super) azimuths: Vec<f64>,
    /// Places of races and balls count from here.
    pub(super) origin: Vector3<f64>,
    /// Where the outer race is held.
    pub(super) planes: Vec<BallPlane>,
}

/// Where a bearing's outer race stands as far as it is known beforehand; for one whose races are bodies
/// themselves that of the frame.
fn origin(assembly: &StaticAssembly, bearing: &StaticBearing) -> Vector3<f64> {
    let [inner, outer] = &bearing.mounts;
    if inner.is_direct() && outer.is_direct() {
        return Vector3::zeros();
    }
    match &assembly.bodies[outer.body].place {
        Place::Held(pose) => pose.position + pose.orientation * Vector3::x() * outer.along,
        Place::Loaded(loaded) => {
            let [x, y, z, ..] = loaded.start.unwrap_or(loaded.rest);
            loaded.axes().point_to_parent(&Vector3::new(x + outer.along, y, z))
        }
    }
}

impl<'a> Model<'a> {
    pub(super) fn new(assembly: &'a StaticAssembly) -> Self {
        let mut unknowns = Vec::with_capacity(assembly.bodies.len());
        let mut scale = Vec::new();
        for (index, body) in assembly.bodies.iter().enumerate() {
            unknowns.push(match body.place {
                Place::Held(_) => None,
                Place::Loaded(_) => {
                    let sits = |bearing: &&StaticBearing| {
                        bearing.mounts.iter().any(|mount| mount.body == index)
                    };
                    let own = assembly.bearings.iter().find(sits);
                    let seat = assembly.seats.iter().find(|seat| seat.mount.body == index);
                    let pitch = match (own, seat) {
                        (Some(bearing), _) => bearing.geometry.pitch_radius,
                        (None, Some(seat)) => seat.fit.radius,
                        (None, None) => 1.0,
                    };
                    scale.extend([1.0, 1.0, 1.0, pitch, pitch]);
                    Some(scale.len() - 5)
                }
            });
        }
        let bearings = assembly.bearings.iter().map(|bearing| {
            let count = bearing.geometry.ball_count;
            let azimuths: Vec<f64> =
                (0..count).map(|j| bearing.ball_phase + TAU * j as f64 / count as f64).collect();
            let mut held = Vec::new();
            let origin = origin(assembly, bearing);
            if let Place::Held(pose) = &assembly.bodies[bearing.mounts[1].body].place {
                planes(bearing, &azimuths, pose, &origin, &mut held);
            }
            BearingModel { contacts: bearing.contacts(), azimuths, origin, planes: held }
        });
        let bearings = bearings.collect();
        let seat_axes = assembly.seats.iter().map(|seat| {
            let axes = match &assembly.bodies[seat.mount.body].place {
                Place::Loaded(loaded) => loaded.axes(),
                Place::Held(_) => Pose::identity(),
            };
            axes.relative_to(&seat.nominal)
        });
        let seat_axes = seat_axes.collect();
        Model { assembly, bearings, seat_axes, unknowns, scale: DVector::from_vec(scale) }
    }

    fn loaded(&self) -> impl Iterator<Item = (usize, usize, &Loaded)> {
        let bodies = self.assembly.bodies.iter().zip(&self.unknowns).enumerate();
        bodies.filter_map(|(index, (body, first))| match (&body.place, first) {
            (Place::Loaded(loaded), Some(first)) => Some((index, *first, loaded)),
            _ => None,
        })
    }

    /// Coordinates of a body.
    pub(super) fn coordinates(&self, body: usize, at: &DVector<f64>) -> Five {
        match (&self.assembly.bodies[body].place, self.unknowns[body]) {
            (Place::Loaded(_), Some(first)) => at.fixed_rows::<5>(first).into_owned(),
            (Place::Held(pose), _) => five(pose),
            _ => Five::zeros(),
        }
    }

    /// Axes of a body's coordinates where they are not the assembly's.
    fn axes(&self, body: usize) -> Option<&Pose> {
        match &self.assembly.bodies[body].place {
            Place::Loaded(loaded) => loaded.axes.as_deref(),
            Place::Held(_) => None,
        }
    }

    /// Whether a body's coordinates are along the assembly's own axes.
    pub(super) fn is_plain(&self, body: usize) -> bool {
        self.axes(body).is_none()
    }

    /// The axes of a body's coordinates in the assembly's frame.
    pub(super) fn turn(&self, body: usize) -> Matrix3<f64> {
        let turn = |axes: &Pose| axes.orientation.to_rotation_matrix().into_inner();
        self.axes(body).map_or(Matrix3::identity(), turn)
    }

    /// About which a body's two tilts turn it, in the assembly's frame.
    pub(super) fn tilt_axes(&self, body: usize, at: &DVector<f64>) -> [Vector3<f64>; 2] {
        let q = self.coordinates(body, at);
        let own = [Vector3::y(), quaternion(0.0, q[3], q[4]) * Vector3::z()];
        match self.axes(body) {
            Some(axes) => own.map(|axis| axes.orientation * axis),
            None => own,
        }
    }

    /// A body in the assembly's frame.
    pub(super) fn pose(&self, body: usize, at: &DVector<f64>) -> Pose {
        let q = self.coordinates(body, at);
        let own = Pose {
            position: Vector3::new(q[0], q[1], q[2]),
            orientation: quaternion(0.0, q[3], q[4]),
        };
        self.axes(body).map_or(own, |axes| own.seen_from_parent_of(axes))
    }

    /// A race of a bearing, its centre from the bearing's origin.
    pub(super) fn race(&self, bearing: usize, side: usize, at: &DVector<f64>) -> InnerRacePosition {
        let mount = &self.assembly.bearings[bearing].mounts[side];
        let coordinates = self.coordinates(mount.body, at);
        let origin = &self.bearings[bearing].origin;
        match self.axes(mount.body) {
            None => InnerRacePosition::mounted(&coordinates, mount, origin),
            Some(axes) => {
                let from_origin = Pose { position: axes.position - origin, ..*axes };
                InnerRacePosition::mounted(&coordinates, mount, &Vector3::zeros())
                    .seen_from_parent_of(&from_origin)
            }
        }
    }

    /// A seat's race in its bore.
    pub(super) fn seat_place(&self, seat: usize, at: &DVector<f64>) -> SeatPlace {
        let (mount, axes) = (&self.assembly.seats[seat].mount, &self.seat_axes[seat]);
        let coordinates = self.coordinates(mount.body, at);
        let own = axes.position == Vector3::zeros() && axes.orientation.imag() == Vector3::zeros();
        if own && mount.is_direct() {
            return SeatPlace::direct(&coordinates);
        }
        let race = InnerRacePosition::mounted(&coordinates, mount, &Vector3::zeros());
        let turn = axes.orientation.to_rotation_matrix().into_inner();
        SeatPlace::new(race.seen_from_parent_of(axes), mount, &turn)
    }

    /// The first seat of a body.
    fn seat_of(&self, body: usize) -> Option<usize> {
        self.assembly.seats.iter().position(|seat| seat.mount.body == body)
    }

    pub(super) fn first_unknown(&self, body: usize) -> Option<usize> {
        self.unknowns[body]
    }
}

/// Position and tilts of a pose.
fn five(pose: &Pose) -> Five {
    let axis = pose.orientation * Vector3::x();
    let tilts = [libm::atan2(-axis.z, axis.x), libm::asin(axis.y.clamp(-1.0, 1.0))];
    let p = pose.position;
    Five::from([p.x, p.y, p.z, tilts[0], tilts[1]])
}

/// Bodies at one place.
#[derive(Clone, Default)]
pub(super) struct Evaluation {
    pub(super) at: DVector<f64>,
    /// Energy of contacts and springs minus the work of loads and body forces, J.
    pub(super) energy: f64,
    pub(super) gradient: DVector<f64>,
    pub(super) stiffness: DMatrix<f64>,
    pub(super) largest_ball_load: f64,
    /// Largest stiffness against one coordinate that is none of a seat's, N/m.
    stiffest: f64,
    /// Forces that have no energy, N.
    pub(super) without_energy: f64,
    /// What rounding leaves of the loads of all seats, N.
    pub(super) seat_noise: f64,
    /// Of each bearing.
    pub(super) balls: Vec<Vec<Option<SettledBall>>>,
    /// Where the outer race is not held.
    pub(super) planes: Vec<Vec<BallPlane>>,
}

impl Evaluation {
    pub(super) fn planes<'e>(&'e self, model: &'e Model, bearing: usize) -> &'e [BallPlane] {
        let moved = &self.planes[bearing];
        if moved.is_empty() { &model.bearings[bearing].planes } else { moved }
    }
}

pub(super) struct Search<'a, 'b> {
    pub(super) model: &'a Model<'a>,
    options: &'a StaticOptions,
    /// Contact in the bore of each seat.
    pub(super) bores: &'a mut [BoreSearch<'b>],
    pub(super) loads: DVector<f64>,
    free: Vec<bool>,
    /// Unknown, stiffness and rest of each spring to the ground.
    springs: Vec<(usize, f64, f64)>,
    pub(super) saddles_left: usize,
    pub(super) iterations: usize,
    pub(super) contact_evaluations: usize,
    spare: Option<Evaluation>,
}

impl<'a, 'b> Search<'a, 'b> {
    pub(super) fn new(
        model: &'a Model<'a>,
        options: &'a StaticOptions,
        bores: &'a mut [BoreSearch<'b>],
    ) -> Self {
        let count = model.scale.len();
        let mut loads = DVector::zeros(count);
        let mut free = vec![false; count];
        let mut springs = Vec::new();
        for (_, first, body) in model.loaded() {
            for i in 0..5 {
                if body.given(i).is_none() {
                    loads[first + i] = body.load(i);
                    free[first + i] = true;
                }
                if body.springs[i] != 0.0 {
                    springs.push((first + i, body.springs[i], body.rest[i]));
                }
            }
        }
        Search {
            model,
            options,
            bores,
            loads,
            free,
            springs,
            saddles_left: 0,
            iterations: 0,
            contact_evaluations: 0,
            spare: None,
        }
    }

    /// Where the search begins.
    pub(super) fn start(&self) -> DVector<f64> {
        let mut at = DVector::zeros(self.free.len());
        for (index, first, body) in self.model.loaded() {
            let start = match body.start {
                Some(start) => Five::from(start),
                None => self.guess(index, body),
            };
            at.fixed_rows_mut::<5>(first).copy_from(&start);
        }
        self.impose(&mut at);
        at
    }

    /// Takes given coordinates to their values.
    pub(super) fn impose(&self, at: &mut DVector<f64>) {
        for (_, first, body) in self.model.loaded() {
            for i in 0..5 {
                if let Some(value) = body.given(i) {
                    at[first + i] = value;
                }
            }
        }
    }

    /// Where the loads would take a body that carries one inner race against a held outer one.
    fn guess(&self, body: usize, loaded: &Loaded) -> Five {
        let on_it = |bearing: &&StaticBearing| bearing.mounts[0].body == body;
        let bearing = self.model.assembly.bearings.iter().find(on_it);
        let Some(bearing) = bearing else { return Five::zeros() };
        let outer = &self.model.assembly.bodies[bearing.mounts[1].body].place;
        let origin = match outer {
            Place::Held(pose) => loaded.axes().point_to_body(&pose.position),
            Place::Loaded(under) => {
                let [x, y, z, ..] = under.start.unwrap_or([0.0; 5]);
                let there = under.axes().point_to_parent(&Vector3::new(x, y, z));
                loaded.axes().point_to_body(&there)
            }
        };
        let loads = [0, 1, 2, 3, 4].map(|i| loaded.load(i));
        static_start::guess(&bearing.geometry, &bearing.contacts(), &loads, &origin)
    }

    /// # Errors
    /// Contact in a bore that does not settle.
    pub(super) fn evaluate(&mut self, at: &DVector<f64>) -> Result<Evaluation, StaticsError> {
        let count = at.len();
        let bearings = self.model.bearings.len();
        let mut here = self.spare.take().unwrap_or_else(|| Evaluation {
            gradient: DVector::zeros(count),
            stiffness: DMatrix::zeros(count, count),
            balls: vec![Vec::new(); bearings],
            planes: vec![Vec::new(); bearings],
            ..Evaluation::default()
        });
        here.at.clone_from(at);
        here.energy = -self.loads.dot(at);
        here.gradient.copy_from(&self.loads);
        here.gradient.neg_mut();
        here.stiffness.fill(0.0);
        here.largest_ball_load = 0.0;
        here.seat_noise = 0.0;
        here.without_energy = 0.0;
        for &(i, spring, rest) in &self.springs {
            let stretch = at[i] - rest;
            here.energy += 0.5 * spring * stretch * stretch;
            here.gradient[i] += spring * stretch;
            here.stiffness[(i, i)] += spring;
        }
        for index in 0..bearings {
            add_bearing(self.model, index, &mut here, &mut self.contact_evaluations);
        }
        for connection in &self.model.assembly.connections {
            self.add_connection(connection, &mut here);
        }
        here.stiffest = (0..count)
            .map(|i| here.stiffness[(i, i)] / self.model.scale[i].powi(2))
            .fold(0.0, f64::max);
        for (index, bore) in self.bores.iter_mut().enumerate() {
            add_seat(self.model, index, bore, &mut here)?;
        }
        Ok(here)
    }

    /// Energy, force and stiffness of springs between two bodies.
    fn add_connection(&self, connection: &Connection, here: &mut Evaluation) {
        let model = self.model;
        let bodies = connection.ends.map(|mount| {
            let race = match model.axes(mount.body) {
                None => race::fixed(&model.coordinates(mount.body, &here.at).into()),
                Some(_) => race::standing(&model.pose(mount.body, &here.at)),
            };
            (race, model.tilt_axes(mount.body, &here.at), model.axes(mount.body))
        });
        let ends = [0, 1].map(|end| race::mounted(&bodies[end].0, &connection.ends[end]));
        let ends = [&ends[0], &ends[1]];
        let pull = connection.pull(ends);
        here.energy += pull.energy;
        // Of a force at a section along its body's coordinates.
        let conjugate = |end: usize, force: Vec3, moment: Vec3| {
            let (body, [e2, e3], axes) = &bodies[end];
            let arm = sub(ends[end].motion.position, body.motion.position);
            let moment = Vector3::from(add(moment, cross(arm, force)));
            let force = Vector3::from(force);
            let force = axes.map_or(force, |a| a.orientation.inverse_transform_vector(&force));
            Five::from([force[0], force[1], force[2], moment.dot(e2), moment.dot(e3)])
        };
        let firsts = connection.ends.map(|mount| model.unknowns[mount.body]);
        for end in 0..2 {
            let Some(first) = firsts[end] else { continue };
            let loads = &pull.on[end];
            let mut rows = here.gradient.fixed_rows_mut::<5>(first);
            rows -= conjugate(end, loads.force, loads.moment);
        }
        for row in connection.rows(ends).iter().filter(|row| row.stiffness != 0.0) {
            let levers = [0, 1].map(|end| conjugate(end, row.on[end][0], row.on[end][1]));
            for (a, one) in firsts.into_iter().enumerate() {
                for (b, other) in firsts.into_iter().enumerate() {
                    let (Some(one), Some(other)) = (one, other) else { continue };
                    let mut block = here.stiffness.fixed_view_mut::<5, 5>(one, other);
                    block += levers[a] * levers[b].transpose() * row.stiffness;
                }
            }
        }
    }

    /// Largest unbalanced load over the free coordinates, N.
    pub(super) fn residual(&self, here: &Evaluation) -> f64 {
        (0..self.free.len())
            .filter(|&i| self.free[i])
            .map(|i| (here.gradient[i] / self.model.scale[i]).abs())
            .fold(0.0, f64::max)
    }

    /// Largest pitch radius, m.
    fn reach(&self) -> f64 {
        let bearings = self.model.assembly.bearings.iter();
        bearings.fold(0.0, |most: f64, bearing| most.max(bearing.geometry.pitch_radius))
    }

    /// Largest load, N.
    fn applied(&self) -> f64 {
        self.loads.component_div(&self.model.scale).amax()
    }

    /// Residual at which to stop, N.
    fn allowed(&self, here: &Evaluation) -> f64 {
        let applied = self.applied();
        // Rounding of positions (some ulps of the pitch radius) times the stiffness cannot go away.
        let noise = 8.0 * f64::EPSILON * self.reach() * here.stiffest + here.seat_noise;
        self.options.tolerance * applied.max(here.largest_ball_load) + noise
    }

    /// What rounding does to the energy, J.
    fn noise(&self, load: f64) -> f64 {
        let bearings = self.model.assembly.bearings.iter();
        bearings
            .map(|bearing| {
                let geometry = &bearing.geometry;
                energy_noise(load, geometry.pitch_radius) * geometry.ball_count as f64
            })
            .sum()
    }

    /// First trust radius, m.
    fn step_scale(&self) -> f64 {
        let largest = |coordinates: std::ops::Range<usize>| {
            self.model
                .loaded()
                .flat_map(|(_, _, body)| coordinates.clone().map(|i| body.load(i).abs()))
                .fold(0.0, f64::max)
        };
        let (force, moment) = (largest(0..3), largest(3..5));
        let bearings = self.model.assembly.bearings.iter().zip(&self.model.bearings);
        if self.model.bearings.is_empty() {
            return WITHOUT_BEARING;
        }
        bearings
            .map(|(bearing, of)| {
                static_start::step_scale(&bearing.geometry, &of.contacts, force, moment)
            })
            .fold(0.0, f64::max)
    }

    /// Newton's method with a trust radius on the energy.
    pub(super) fn descend(&mut self, here: &mut Evaluation) -> Result<(), StaticsError> {
        let mut radius = self.step_scale();
        let begun = self.iterations;
        loop {
            let residual = self.residual(here);
            let allowed = self.allowed(here);
            if residual <= allowed {
                // What is found again stays to the bit.
                return if self.iterations > begun { self.polish(here, residual) } else { Ok(()) };
            }
            if self.iterations >= self.options.max_iterations {
                return self.give_up(here, residual, allowed);
            }
            self.iterations += 1;
            let step = self.newton_step(here, radius);
            let there = self.evaluate(&(&here.at + step.component_div(&self.model.scale)))?;
            let predicted = self.predicted_change(here, &step);
            let change = there.energy - here.energy;
            // Near the end the change drowns in rounding, and the unbalanced load decides alone.
            let mut noise = self.noise(here.largest_ball_load.max(there.largest_ball_load));
            let assembly = self.model.assembly;
            if !(assembly.connections.is_empty() && assembly.seats.is_empty()) {
                // Springs may hold far more energy than contacts.
                noise += 16.0 * f64::EPSILON * here.energy.abs().max(there.energy.abs());
            }
            noise += here.without_energy * step.norm();
            let quieter = self.residual(&there) < residual;
            let accepted = change < (1e-4 * predicted).min(-noise) || (change <= noise && quieter);
            if accepted {
                if change < 0.75 * predicted && step.norm() > 0.9 * radius {
                    radius *= 3.0;
                }
                self.spare = Some(std::mem::replace(here, there));
                self.check_travel(here)?;
            } else {
                self.spare = Some(there);
                if residual <= 1e2 * allowed && change.abs() <= noise {
                    // Rounding, not the position, is what is left.
                    return Ok(());
                }
                radius = 0.25 * radius.min(step.norm());
            }
        }
    }

    /// One more step of Newton's where a race in its bore is soft against tilts: a balance that rounding may already have
    /// spoilt leaves these far less certain than the rest, and the error falls as its square.
    fn polish(&mut self, here: &mut Evaluation, residual: f64) -> Result<(), StaticsError> {
        let strict = self.options.tolerance * self.applied().max(here.largest_ball_load);
        if self.model.assembly.seats.is_empty() || residual <= 1e-2 * strict {
            return Ok(());
        }
        let step = self.newton_step(here, self.step_scale());
        let there = self.evaluate(&(&here.at + step.component_div(&self.model.scale)))?;
        if self.residual(&there) < residual {
            *here = there;
        }
        Ok(())
    }

    /// Every ball settled, and none past the edge of what a torus can hold.
    pub(super) fn check_balls(&self, here: &Evaluation) -> Result<(), StaticsError> {
        /// Newton's last step leaves 1e-11; anything above this is a ball still on its way.
        const SETTLED: f64 = 1e-8;
        for (bearing, of) in self.model.assembly.bearings.iter().enumerate() {
            let race = self.model.race(bearing, 0, &here.at);
            let contacts = &self.model.bearings[bearing].contacts;
            for (index, (plane, ball)) in
                here.planes(self.model, bearing).iter().zip(&here.balls[bearing]).enumerate()
            {
                let named = || format!("ball {}{}", index + 1, of.suffix());
                match ball {
                    Some(ball) if ball.unbalance > SETTLED || ball.unbalance.is_nan() => {
                        let unbalance = ball.unbalance;
                        return Err(StaticsError::BallNotSettled { ball: named(), unbalance });
                    }
                    Some(_) => {}
                    None => {
                        let (overlap, angle) = overlap_of_races(plane, &race, contacts);
                        if overlap > 0.0 && angle.abs() > std::f64::consts::FRAC_PI_2 {
                            let (ball, degrees) = (named(), angle.to_degrees());
                            return Err(StaticsError::BallOutside { ball, overlap, degrees });
                        }
                    }
                }
            }
        }
        Ok(())
    }

    fn give_up(&self, here: &Evaluation, residual: f64, allowed: f64) -> Result<(), StaticsError> {
        // Of the body that is farthest from balance.
        let worst = |first: usize| {
            (first..first + 5)
                .filter(|&i| self.free[i])
                .map(|i| (here.gradient[i] / self.model.scale[i]).abs())
                .fold(0.0, f64::max)
        };
        let bodies = self.model.loaded().map(|(_, first, _)| first);
        let at = bodies.max_by(|a, b| worst(*a).total_cmp(&worst(*b))).unwrap_or(0);
        Err(StaticsError::NotConverged {
            iterations: self.iterations,
            residual,
            allowed,
            position: [here.at[at], here.at[at + 1], here.at[at + 2]],
            tilts: [here.at[at + 3], here.at[at + 4]],
        })
    }

    fn check_travel(&self, here: &Evaluation) -> Result<(), StaticsError> {
        self.check_seats(here, LOST)?;
        for (index, first, body) in self.model.loaded() {
            if self.model.seat_of(index).is_some() {
                continue;
            }
            let from = Five::from(body.start.unwrap_or([0.0; 5])) + self.carried(index, here);
            for i in (0..5).filter(|&i| self.free[first + i]) {
                let travel = (here.at[first + i] - from[i]) * self.model.scale[first + i];
                // NaN leaves here too.
                if travel.is_nan() || travel.abs() > body.room {
                    let body = &self.model.assembly.bodies[index];
                    return Err(StaticsError::NoEquilibrium {
                        body: body.name.clone(),
                        coordinate: COORDINATE_NAMES[i],
                        travel,
                        room: match &body.place {
                            Place::Loaded(loaded) => loaded.room,
                            Place::Held(_) => 0.0,
                        },
                    });
                }
            }
        }
        Ok(())
    }

    /// Every race within a part of its radius of its place in its bore.
    ///
    /// # Errors
    /// A race that nothing holds, a housing that gives way.
    pub(super) fn check_seats(&self, here: &Evaluation, part: f64) -> Result<(), StaticsError> {
        for (index, seat) in self.model.assembly.seats.iter().enumerate() {
            let place = self.model.seat_place(index, &here.at);
            let (pose, radius) = (place.pose, seat.fit.radius);
            // Angles of an axis come round.
            let turn = if place.is_direct() { part } else { part.min(1.0) };
            let allowed = [part * radius, part * radius, turn, turn];
            let parts: [f64; 4] = std::array::from_fn(|i| pose[i].abs() / allowed[i]);
            let worst = (0..4).max_by(|a, b| parts[*a].total_cmp(&parts[*b])).unwrap_or(0);
            let within = parts[worst] <= 1.0;
            if !within {
                let source = self.bores[index].lost(
                    &seat.fit,
                    worst,
                    &pose,
                    self.residual(here),
                    self.applied(),
                );
                return Err(StaticsError::Seat { of: seat.suffix(), source });
            }
        }
        Ok(())
    }

    /// Each race in its bore.
    ///
    /// # Errors
    /// Contact that does not settle, a race beyond what its bore was condensed for.
    pub(super) fn seat_states(
        &mut self,
        here: &Evaluation,
    ) -> Result<Vec<BoreState>, StaticsError> {
        let mut states = Vec::with_capacity(self.bores.len());
        for (index, seat) in self.model.assembly.seats.iter().enumerate() {
            let pose = self.model.seat_place(index, &here.at).pose;
            let bore = &mut self.bores[index];
            // As the last evaluation has it, unless that was a step too far.
            let state =
                if bore.pose() == pose { bore.state() } else { bore.at_pose(&seat.fit, pose) };
            states.push(state.map_err(|source| StaticsError::Seat { of: seat.suffix(), source })?);
        }
        Ok(states)
    }

    /// How far the body under a body's first outer race has gone: it takes the inner one along.
    fn carried(&self, body: usize, here: &Evaluation) -> Five {
        let on_it = |bearing: &&StaticBearing| bearing.mounts[0].body == body;
        let bearing = self.model.assembly.bearings.iter().find(on_it);
        let under = bearing.map(|bearing| bearing.mounts[1].body);
        let Some((under, first)) = under.and_then(|u| Some((u, self.model.unknowns[u]?))) else {
            return Five::zeros();
        };
        let Place::Loaded(loaded) = &self.model.assembly.bodies[under].place else {
            return Five::zeros();
        };
        let mut gone =
            here.at.fixed_rows::<5>(first) - Five::from(loaded.start.unwrap_or([0.0; 5]));
        if let Some(axes) = self.model.axes(under) {
            let shift = axes.orientation * Vector3::new(gone[0], gone[1], gone[2]);
            gone.fixed_rows_mut::<3>(0).copy_from(&shift);
        }
        gone
    }

    /// Gradient and stiffness over metres (tilts times pitch radius), prescribed coordinates
    /// replaced by a unit diagonal so that their step is zero.
    fn scaled(&self, here: &Evaluation) -> (DVector<f64>, DMatrix<f64>) {
        let mut gradient = here.gradient.component_div(&self.model.scale);
        let mut stiffness = here.stiffness.clone();
        let count = self.free.len();
        for i in 0..count {
            for j in 0..count {
                stiffness[(i, j)] /= self.model.scale[i] * self.model.scale[j];
                if !(self.free[i] && self.free[j]) {
                    stiffness[(i, j)] = 0.0;
                }
            }
            if !self.free[i] {
                gradient[i] = 0.0;
            }
        }
        (gradient, stiffness)
    }

    /// Step in metres: Newton's where the stiffness is positive, otherwise with as much of the
    /// identity added as makes it so; never longer than `radius`.
    fn newton_step(&self, here: &Evaluation, radius: f64) -> DVector<f64> {
        let (gradient, stiffness) = self.scaled(here);
        let largest = stiffness.diagonal().amax();
        let floor = if largest > 0.0 { largest } else { gradient.amax() / radius };
        let hints = self.hints(&stiffness);
        let mut shift = 0.0;
        loop {
            let mut shifted = &stiffness + &hints;
            for i in 0..self.free.len() {
                shifted[(i, i)] += if self.free[i] { shift } else { floor };
            }
            if let Some(factor) = shifted.cholesky() {
                let step = -factor.solve(&gradient);
                let length = step.norm();
                if length.is_finite() {
                    return if length > radius { step * (radius / length) } else { step };
                }
            }
            shift = if shift == 0.0 { 1e-4 * floor } else { 4.0 * shift };
        }
    }

    /// Artificial stiffness of bodies in bores.
    fn hints(&self, stiffness: &DMatrix<f64>) -> DMatrix<f64> {
        let mut hints = DMatrix::zeros(stiffness.nrows(), stiffness.ncols());
        for (index, first, _) in self.model.loaded() {
            if self.model.seat_of(index).is_some() {
                let own = first..first + 5;
                let largest = own.clone().map(|i| stiffness[(i, i)]).fold(0.0, f64::max);
                own.for_each(|i| hints[(i, i)] = HINT * largest);
            }
        }
        hints
    }

    fn predicted_change(&self, here: &Evaluation, step: &DVector<f64>) -> f64 {
        let (gradient, stiffness) = self.scaled(here);
        gradient.dot(step) + 0.5 * step.dot(&(stiffness * step))
    }

    /// Coordinates that are looked for, but for those of bodies in bores: a race may be loose in its bore, and
    /// whether loads determine where another body is then means against it.
    fn free_but_for_seats(&self) -> Vec<bool> {
        let mut free = self.free.clone();
        for (index, first, _) in self.model.loaded() {
            if self.model.seat_of(index).is_some() {
                free[first..first + 5].fill(false);
            }
        }
        free
    }

    /// Eigenvalues and eigenvectors of the scaled stiffness over these free coordinates.
    fn free_modes(&self, here: &Evaluation, free: &[bool]) -> Vec<(f64, DVector<f64>)> {
        if free.is_empty() {
            return Vec::new();
        }
        let (_, mut stiffness) = self.scaled(here);
        let count = free.len();
        for i in (0..count).filter(|&i| !free[i]) {
            stiffness.row_mut(i).fill(0.0);
            stiffness.column_mut(i).fill(0.0);
        }
        let eigen = SymmetricEigen::new(stiffness);
        (0..count)
            .map(|k| (eigen.eigenvalues[k], eigen.eigenvectors.column(k).into_owned()))
            .filter(|(_, v)| (0..count).any(|i| free[i] && v[i].abs() > 1e-6))
            .collect()
    }

    /// A small displacement along the most negative stiffness, if there is one.
    pub(super) fn falling_direction(&self, here: &Evaluation) -> Option<DVector<f64>> {
        let modes = self.free_modes(here, &self.free);
        let largest = modes.iter().map(|mode| mode.0.abs()).fold(0.0, f64::max);
        let (value, vector) = modes.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        if value >= -NO_STIFFNESS * largest {
            return None;
        }
        let length = 0.1 * self.step_scale();
        Some((vector * length).component_div(&self.model.scale))
    }

    pub(super) fn determinacy(&self, here: &Evaluation) -> Determinacy {
        let modes = self.free_modes(here, &self.free_but_for_seats());
        // The scale is that of the whole bearing, so that one lone free coordinate is judged too.
        let scaled_diagonal = here.stiffest;
        // An overlap of some ulps of the radius is no contact, and its stiffness none.
        let noise = self.model.bearings.iter().fold(0.0, |most: f64, of| {
            let contacts = &of.contacts;
            let rounding = 256.0 * f64::EPSILON * contacts.outer.centre_radius;
            let stiffest = contacts.inner_stiffness.max(contacts.outer_stiffness);
            most.max(normal_load(stiffest, rounding))
        });
        let springs = !self.springs.is_empty() || !self.model.assembly.connections.is_empty();
        let nothing_touches = here.largest_ball_load <= noise && !springs;
        let threshold =
            if nothing_touches { f64::INFINITY } else { NO_STIFFNESS * scaled_diagonal };
        let free_directions: Vec<_> =
            modes.into_iter().filter(|mode| mode.0 <= threshold).map(|mode| mode.1).collect();
        if free_directions.is_empty() {
            Determinacy::Determinate
        } else {
            Determinacy::Indeterminate { free_directions }
        }
    }
}
