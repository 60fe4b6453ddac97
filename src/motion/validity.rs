//! Validity of a state: finite values, balls between their races, races and cages in their bearings, springs within
//! their range, parts that do not interpenetrate. Checked at the start and after each step.

use crate::ch2_housing::bearing::ball_contact::are_apart;
use crate::ch2_housing::bearing::cage::{AxisMotion, CageContact};
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::equilibrium::statics::COORDINATE_NAMES;
use crate::kinematics::vec3::{Vec3, add_scaled, cross, dot, norm, sub};
use crate::members::ball_set::{BallSet, neighbours};
use crate::members::bearing::{Bearing, Caged, HERTZ_SCALE, cage_room};
use crate::members::body::{Drive, FARTHEST};
use crate::members::housing_fit::Seat;
use crate::members::rigid_body::BodyKinematics;
use crate::members::state::{BODY, POSITION};
use crate::motion::error::SimulationError;
use crate::motion::simulation::Simulation;
use crate::numeric::clock::to_digits;
use std::f64::consts::PI;

/// Largest displacement of a race from its nominal position (m), along and across its axis: the free play in the
/// grooves plus a ball radius. Beyond it the rings of a real bearing have met (usual shoulders leave 1.2 ball radii
/// between them), or the balls have left their grooves.
pub fn race_limit(geometry: &BearingGeometry) -> f64 {
    let grooves = geometry.inner.groove_radius + geometry.outer.groove_radius;
    let play = grooves - 2.0 * geometry.ball_radius + geometry.radial_clearance.max(0.0);
    geometry.ball_radius + play
}

/// Largest displacement of a race across its bore, in radii of the race.
const FARTHEST_IN_BORE: f64 = 0.1;

/// Largest tilt of a race in its bore, rad. At the ends of a race half as wide as its radius that is a fortieth of the
/// radius, a hundred times the deflection of contact and modes; linear modes are wrong by θ²/2, 0.5 % of the radius.
/// Contact nodes limit tilts to thousandths.
const FARTHEST_TILT: f64 = 0.1;

/// Largest rotation of a section relative to its body, rad: bending is linear in rotations except for shortening, an
/// error of θ²/2, half a percent.
pub const FARTHEST_BENT: f64 = 0.1;

/// Largest rotation measured by the springs of a connection, rad: beyond half a turn a wound spring would change its
/// sign.
const FARTHEST_TURN: f64 = 160.0 / 180.0 * PI;

/// Largest depth of a cage in balls or its guide at a start in equilibrium, in ball radii, if no contact of a race is
/// deeper.
const CAGE_AT_START: f64 = 1e-3;

/// Axial and radial part of an arm.
fn split(arm: Vec3, axis: Vec3) -> (f64, f64) {
    let axial = dot(arm, axis);
    (axial, norm(add_scaled(arm, -axial, axis)))
}

impl Simulation {
    /// Checks a state after a step. Non-finite values spread within a step from any body to the velocities of the
    /// races, so that the positions of balls and races show them all.
    ///
    /// # Errors
    ///
    /// The first violation: body, distance, step and time.
    pub(crate) fn watch(&self) -> Result<(), SimulationError> {
        let system = &self.system;
        for (index, (set, bearing)) in system.sets.iter().zip(&system.assembly.bearings).enumerate()
        {
            let outer = system.race_motion(&self.state, index, 1);
            self.watch_balls(set, bearing, &outer)?;
        }
        for (index, body) in system.assembly.bodies.iter().enumerate() {
            let at = system.places.body(index);
            if !self.state[at..at + BODY].iter().all(|v| v.is_finite()) {
                return Err(self.not_finite(body.name.clone()));
            }
        }
        for (solid, at) in system.assembly.solids.iter().zip(&system.solids) {
            if !self.state[*at..at + 2 * solid.count()].iter().all(|v| v.is_finite()) {
                return Err(self.not_finite(solid.name.clone()));
            }
        }
        for (shaft, at) in system.assembly.shafts.iter().zip(&system.shafts) {
            if !self.state[*at..at + shaft.entries()].iter().all(|v| v.is_finite()) {
                return Err(self.not_finite(system.assembly.bodies[shaft.body].name.clone()));
            }
        }
        for (index, solid) in system.assembly.floating.iter().enumerate() {
            if !system.deformed(&self.state, index).iter().all(|v| v.is_finite()) {
                return Err(self.not_finite(system.assembly.bodies[solid.body].name.clone()));
            }
        }
        self.watch_bending()?;
        self.watch_springs()?;
        for (index, seat) in system.assembly.seats.iter().enumerate() {
            self.watch_seat(index, seat)?;
        }
        for (index, (set, bearing)) in system.sets.iter().zip(&system.assembly.bearings).enumerate()
        {
            let races = [0, 1].map(|side| system.race_motion(&self.state, index, side));
            self.watch_travel(bearing)?;
            self.watch_races(&races, bearing)?;
            self.watch_depths(set, bearing)?;
            if let Some(cage) = &bearing.cage {
                self.watch_cage(&races[1], bearing, cage)?;
            }
        }
        Ok(())
    }

    fn not_finite(&self, body: String) -> SimulationError {
        SimulationError::NotFinite { body, time: self.time, step: self.steps }
    }

    /// Sections of flexible bodies with attachments, loads or probes.
    fn watch_bending(&self) -> Result<(), SimulationError> {
        let system = &self.system;
        let assembly = &system.assembly;
        let held = system.holds.all(assembly).map(|(hold, _)| (hold.shaft, &hold.section));
        let shafts = assembly.shafts.iter().enumerate();
        let own = shafts.flat_map(|(index, shaft)| shaft.sections().map(move |of| (index, of)));
        for (index, section) in held.chain(own) {
            let shaft = &assembly.shafts[index];
            let turn = section.turned(&shaft.bend(system.shafts[index], &self.state));
            // NaN must fail.
            if turn <= FARTHEST_BENT {
                continue;
            }
            return Err(SimulationError::BentTooFar {
                body: assembly.bodies[shaft.body].name.clone(),
                along: section.along,
                turn,
                allowed: FARTHEST_BENT,
                time: self.time,
                step: self.steps,
            });
        }
        Ok(())
    }

    /// Connections between bodies, as last evaluated.
    fn watch_springs(&self) -> Result<(), SimulationError> {
        let system = &self.system;
        for (index, connection) in system.assembly.connections.iter().enumerate() {
            let [stretch, turn, across] = system.extension(index);
            let wall = connection.wall();
            // NaN must fail.
            let (reaches, turns) = (stretch <= FARTHEST, turn <= FARTHEST_TURN);
            if reaches && turns && across <= wall {
                continue;
            }
            let (spring, time, step) = (connection.name.clone(), self.time, self.steps);
            if reaches && turns {
                return Err(SimulationError::ThroughWall { spring, across, wall, time, step });
            }
            let how = if reaches {
                let [turn, allowed] = [turn, FARTHEST_TURN].map(|of| to_digits(of.to_degrees(), 6));
                format!("turned by {turn} deg, more than {allowed} deg")
            } else {
                format!("stretched by {} m, more than {FARTHEST} m", to_digits(stretch, 6))
            };
            return Err(SimulationError::SpringBeyond { spring, how, time, step });
        }
        Ok(())
    }

    fn watch_balls(
        &self,
        set: &BallSet,
        bearing: &Bearing,
        outer: &AxisMotion,
    ) -> Result<(), SimulationError> {
        let geometry = &bearing.geometry;
        let near = 0.25 * geometry.ball_radius * geometry.ball_radius;
        for ball in 0..set.layout.balls {
            let position = set.layout.ball_vector(&self.state, POSITION, ball);
            let (axial, radial) = split(sub(position, outer.position), outer.axis);
            let across = radial - geometry.pitch_radius;
            // The common case needs no square root.
            if axial * axial + across * across <= near {
                continue;
            }
            let distance = libm::hypot(axial, across);
            if !distance.is_finite() {
                return Err(self.not_finite(format!("ball {}{}", ball + 1, bearing.suffix())));
            }
            if distance > geometry.ball_radius {
                return Err(SimulationError::BallOutside {
                    ball: format!("ball {}{}", ball + 1, bearing.suffix()),
                    time: self.time,
                    step: self.steps,
                    distance,
                    ball_radius: geometry.ball_radius,
                });
            }
        }
        Ok(())
    }

    /// Displacement of the inner race from the outer one, in the frame of the outer one; a tilt counts as the
    /// displacement at the pitch circle.
    fn watch_races(
        &self,
        [inner, outer]: &[AxisMotion; 2],
        bearing: &Bearing,
    ) -> Result<(), SimulationError> {
        let axis = outer.axis;
        let (axial, radial) = split(sub(inner.position, outer.position), axis);
        let tilted = bearing.geometry.pitch_radius * norm(cross(axis, inner.axis));
        let allowed = race_limit(&bearing.geometry);
        for (way, distance) in
            [("along its axis", axial.abs() + tilted), ("across its axis", radial)]
        {
            // NaN must fail.
            if distance <= allowed {
                continue;
            }
            let (time, step) = (self.time, self.steps);
            let bearing = bearing
                .name
                .as_ref()
                .map_or("the bearing".into(), |name| format!("bearing {name}"));
            return Err(SimulationError::RaceLeft { bearing, way, distance, allowed, time, step });
        }
        Ok(())
    }

    /// Displacement of the body under the outer race from its rest position, along its free coordinates, beyond the
    /// prescribed displacement of the other race.
    fn watch_travel(&self, bearing: &Bearing) -> Result<(), SimulationError> {
        let bodies = &self.system.assembly.bodies;
        let [inner, outer] = bearing.mounts.map(|mount| &bodies[mount.body]);
        let Some(race) = outer.driven() else { return Ok(()) };
        let at = self.system.body_state(&self.state, bearing.mounts[1].body).position;
        for i in 0..3 {
            if matches!(race.drives[i], Drive::Motion(_)) {
                continue;
            }
            let taken_along = match inner.driven().map(|race| &race.drives[i]) {
                Some(Drive::Motion(profile)) => (profile.value(self.time) - inner.rest[i]).abs(),
                _ => 0.0,
            };
            let (distance, allowed) = ((at[i] - outer.rest[i]).abs(), FARTHEST + taken_along);
            // NaN must fail.
            if distance <= allowed {
                continue;
            }
            let (body, coordinate) = (outer.name.clone(), COORDINATE_NAMES[i]);
            let (time, step) = (self.time, self.steps);
            return Err(SimulationError::FlownOff {
                body,
                coordinate,
                distance,
                allowed,
                time,
                step,
            });
        }
        Ok(())
    }

    /// A race in its bore: beyond these limits its contact nodes no longer represent the bore under it.
    fn watch_seat(&self, index: usize, seat: &Seat) -> Result<(), SimulationError> {
        let body = BodyKinematics::new(self.system.body_state(&self.state, seat.race.body));
        let hold = &self.system.holds.seats[index];
        let race = self.system.on_body(hold, &self.state, &body, &seat.race).motion;
        let (along, across) = split(sub(race.position, seat.nominal), race.axis);
        let radius = seat.radius.value(self.time);
        for (way, distance, allowed) in [
            ("along the axis", along.abs(), seat.rim),
            ("across it", across, FARTHEST_IN_BORE * radius),
        ] {
            // NaN must fail.
            if distance <= allowed {
                continue;
            }
            let body = self.system.assembly.bodies[seat.race.body].name.clone();
            let (seat, time, step) = (seat.name.clone(), self.time, self.steps);
            return Err(SimulationError::LeftSeat {
                body,
                seat,
                way,
                distance,
                allowed,
                time,
                step,
            });
        }
        let tilt = libm::atan2(norm(cross(seat.axis, race.axis)), dot(seat.axis, race.axis));
        // NaN must fail.
        if tilt <= FARTHEST_TILT {
            return Ok(());
        }
        let body = self.system.assembly.bodies[seat.race.body].name.clone();
        let (seat, time, step) = (seat.name.clone(), self.time, self.steps);
        let allowed = FARTHEST_TILT;
        Err(SimulationError::TiltedInSeat { body, seat, tilt, allowed, time, step })
    }

    /// The ring of the cage in both races.
    fn watch_cage(
        &self,
        outer: &AxisMotion,
        bearing: &Bearing,
        cage: &Caged,
    ) -> Result<(), SimulationError> {
        let centre = self.system.body_state(&self.state, cage.body).position;
        let (_, distance) = split(sub(centre, outer.position), outer.axis);
        let allowed = cage_room(&bearing.geometry, &cage.contacts);
        // NaN must fail.
        if distance <= allowed {
            return Ok(());
        }
        let body = self.system.assembly.bodies[cage.body].name.clone();
        let (time, step) = (self.time, self.steps);
        Err(SimulationError::CageLeft { body, distance, allowed, time, step })
    }

    /// Checks the cage at a start in equilibrium, which does not include it: no cage contact may be deeper than those
    /// of the races.
    ///
    /// # Errors
    ///
    /// The deepest contact of a cage.
    pub(crate) fn watch_cages_at_start(&self) -> Result<(), SimulationError> {
        for (set, bearing) in self.system.sets.iter().zip(&self.system.assembly.bearings) {
            let Some(cage) = &bearing.cage else { continue };
            let races = set.table.active.iter().map(|pair| set.table.contact[*pair].overlap);
            let allowed = races.fold(CAGE_AT_START * bearing.geometry.ball_radius, f64::max);
            // A cage without stiffness carries no load.
            let pushes = |contact: &CageContact| contact.normal_load > 0.0;
            let pockets = set.pockets.iter().enumerate().filter(|(_, contact)| pushes(contact));
            let pockets = pockets.map(|(ball, contact)| (Some(ball), contact.penetration));
            let guides = set.guides.iter().filter(|contact| pushes(contact));
            let guides = guides.map(|contact| (None, contact.penetration));
            let deepest = pockets.chain(guides).fold((None, 0.0f64), |most, one| {
                // NaN is kept.
                if one.1 <= most.1 || most.1.is_nan() { most } else { one }
            });
            if deepest.1 <= allowed {
                continue;
            }
            let other = match deepest.0 {
                Some(ball) => format!("ball {}{}", ball + 1, bearing.suffix()),
                None => "its guiding race".into(),
            };
            let cage = self.system.assembly.bodies[cage.body].name.clone();
            return Err(SimulationError::CageInTheWay { cage, other, depth: deepest.1, allowed });
        }
        Ok(())
    }

    /// Advice for interpenetrating parts.
    fn advice(&self, bearing: &Bearing, between_balls: bool) -> String {
        if between_balls && bearing.ball_contact.is_none() {
            return "nothing keeps balls apart here: give them a contact law (ball_contact.law) or a cage".into();
        }
        let given: Vec<String> = bearing
            .mounts
            .iter()
            .flat_map(|mount| {
                let body = &self.system.assembly.bodies[mount.body];
                let drives = body.driven().map(|race| &race.drives);
                drives.into_iter().flatten().enumerate().filter_map(|(i, drive)| {
                    let Drive::Motion(profile) = drive else { return None };
                    let off = profile.value(self.time) - body.rest[i];
                    let unit = if i < 3 { "m" } else { "rad" };
                    let name = COORDINATE_NAMES[i];
                    (off != 0.0)
                        .then(|| format!("{name} of {} by {} {unit}", body.name, to_digits(off, 3)))
                })
            })
            .collect();
        if !between_balls && !given.is_empty() {
            return format!("the prescribed motion may be too large: {}", given.join(", "));
        }
        if self.steps == 0 {
            return "it starts so: check clearances, and the direction of the loads on the races"
                .into();
        }
        "check loads and stiffnesses, or take shorter steps (numerics.step, numerics.accuracy)"
            .into()
    }

    /// Contacts as last evaluated, within the step just taken; balls at their present position.
    fn watch_depths(&self, set: &BallSet, bearing: &Bearing) -> Result<(), SimulationError> {
        let BallSet { layout, table, .. } = set;
        let radius = bearing.geometry.ball_radius;
        let named = |ball: usize| format!("ball {}{}", ball + 1, bearing.suffix());
        let body = |index: usize| self.system.assembly.bodies[index].name.clone();
        for &pair in &table.active {
            let (side, ball) = layout.race_and_ball(pair);
            let race = bearing.mounts[side].body;
            let depth = table.contact[pair].overlap;
            self.watch_depth(bearing, depth, false, || [named(ball), body(race)])?;
        }
        if let Some(cage) = &bearing.cage {
            for (ball, contact) in set.pockets.iter().enumerate() {
                let depth = contact.penetration;
                self.watch_depth(bearing, depth, false, || [named(ball), body(cage.body)])?;
            }
            for contact in &set.guides {
                let names = || [body(cage.body), "its guiding race".into()];
                self.watch_depth(bearing, contact.penetration, false, names)?;
            }
        }
        let place = |ball: usize| layout.ball_vector(&self.state, POSITION, ball);
        let mut there = place(0);
        for one in 0..neighbours(layout.balls) {
            let other = if one + 1 == layout.balls { 0 } else { one + 1 };
            let here = there;
            there = place(other);
            if are_apart(radius, here, there) {
                continue;
            }
            let depth = 2.0 * radius - norm(sub(there, here));
            self.watch_depth(bearing, depth, true, || [named(one), named(other)])?;
        }
        Ok(())
    }

    /// Checks the depth of two parts of a bearing.
    #[inline(always)]
    fn watch_depth(
        &self,
        bearing: &Bearing,
        depth: f64,
        between_balls: bool,
        names: impl Fn() -> [String; 2],
    ) -> Result<(), SimulationError> {
        let allowed = HERTZ_SCALE * bearing.geometry.ball_radius;
        // NaN must fail.
        if depth <= allowed {
            return Ok(());
        }
        let ([one, other], time, step) = (names(), self.time, self.steps);
        let advice = self.advice(bearing, between_balls);
        Err(SimulationError::Inside { one, other, depth, allowed, time, step, advice })
    }
}
