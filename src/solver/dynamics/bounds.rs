//! Where a state has lost its meaning: values that are not finite, balls outside their races, a race
//! that has left its bearing, parts inside each other. Looked at once a step.

use super::assembly::Bearing;
use super::ball_set::{BallSet, neighbours};
use super::failure::SimulationError;
use super::race::{RaceNow, mounted};
use super::run::Simulation;
use super::state::{BODY, POSITION};
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::kinematics::vec3::{Vec3, add_scaled, cross, dot, norm, sub};

/// How deep parts may lie in each other, in ball radii. Pressure in a Hertz contact of balls follows
/// from δ/r alone: steel on steel would carry 20 GPa at this depth, five times what leaves a dent (ISO 76),
/// on a contact a fifth of the ball wide, so that neither elasticity nor Hertz's half-space holds.
/// The cage's contacts, whose stiffness is a choice, are held to the same depth.
pub const HERTZ_SCALE: f64 = 0.1;

/// How far a race may be from where it lies nominally (m), along its axis and across it: what the
/// grooves leave free, and a ball's radius besides. Before that the rings of a real bearing have run into each
/// other (shoulders of usual height leave 1.2 ball radii between them), or the balls are out of
/// their grooves.
pub fn race_limit(geometry: &BearingGeometry) -> f64 {
    let grooves = geometry.inner.groove_radius + geometry.outer.groove_radius;
    let play = grooves - 2.0 * geometry.ball_radius + geometry.radial_clearance.max(0.0);
    geometry.ball_radius + play
}

/// Axial and radial part of an arm.
fn split(arm: Vec3, axis: Vec3) -> (f64, f64) {
    let axial = dot(arm, axis);
    (axial, norm(add_scaled(arm, -axial, axis)))
}

impl Simulation {
    /// What ends a run. Non-finite values spread within a step from any body to the races'
    /// velocities, so that a look at the balls' and races' positions finds them all.
    ///
    /// # Errors
    /// The first thing found: body, how far, step and time.
    pub(super) fn watch(&self) -> Result<(), SimulationError> {
        let system = &self.system;
        for (set, bearing) in system.sets.iter().zip(&system.assembly.bearings) {
            let outer = self.race(bearing, 1);
            self.watch_balls(set, bearing, &outer)?;
        }
        for (index, body) in system.assembly.bodies.iter().enumerate() {
            let at = system.places.body(index);
            if !self.state[at..at + BODY].iter().all(|v| v.is_finite()) {
                return Err(self.not_finite(body.name.clone()));
            }
        }
        for (set, bearing) in system.sets.iter().zip(&system.assembly.bearings) {
            self.watch_races(bearing)?;
            self.watch_depths(set, bearing)?;
        }
        Ok(())
    }

    /// A race of a bearing in the present state.
    fn race(&self, bearing: &Bearing, side: usize) -> RaceNow {
        let mount = &bearing.mounts[side];
        let body = self.system.body_state(&self.state, mount.body);
        mounted(&RaceNow::new(body), mount)
    }

    fn not_finite(&self, body: String) -> SimulationError {
        SimulationError::NotFinite { body, time: self.time, step: self.steps }
    }

    fn watch_balls(
        &self,
        set: &BallSet,
        bearing: &Bearing,
        outer: &RaceNow,
    ) -> Result<(), SimulationError> {
        let geometry = &bearing.geometry;
        let axis = outer.motion.axis;
        for ball in 0..set.layout.balls {
            let position = set.layout.ball_vector(&self.state, POSITION, ball);
            let (axial, radial) = split(sub(position, outer.motion.position), axis);
            let distance = libm::hypot(axial, radial - geometry.pitch_radius);
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

    /// The inner race against the outer one, in the latter's frame; a tilt counts as what it moves
    /// the race by at the pitch circle.
    fn watch_races(&self, bearing: &Bearing) -> Result<(), SimulationError> {
        let [inner, outer] = [0, 1].map(|side| self.race(bearing, side).motion);
        let axis = outer.axis;
        let (axial, radial) = split(sub(inner.position, outer.position), axis);
        let tilted = bearing.geometry.pitch_radius * norm(cross(axis, inner.axis));
        let allowed = race_limit(&bearing.geometry);
        for (way, distance) in
            [("along its axis", axial.abs() + tilted), ("across its axis", radial)]
        {
            // NaN is too far.
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

    /// Contacts as they were evaluated last, within the step just taken; balls where they lie now.
    fn watch_depths(&self, set: &BallSet, bearing: &Bearing) -> Result<(), SimulationError> {
        let BallSet { layout, table, .. } = set;
        let radius = bearing.geometry.ball_radius;
        let allowed = HERTZ_SCALE * radius;
        let check = |depth: f64, names: &dyn Fn() -> [String; 2]| {
            // NaN is too deep.
            if depth <= allowed {
                return Ok(());
            }
            let ([one, other], time, step) = (names(), self.time, self.steps);
            Err(SimulationError::Inside { one, other, depth, allowed, time, step })
        };
        let named = |ball: usize| format!("ball {}{}", ball + 1, bearing.suffix());
        let body = |index: usize| self.system.assembly.bodies[index].name.clone();
        for &pair in &table.active {
            let (side, ball) = (pair / layout.padded, pair % layout.padded);
            let race = bearing.mounts[side].body;
            check(table.contact[pair].overlap, &|| [named(ball), body(race)])?;
        }
        if let Some(cage) = &bearing.cage {
            for (ball, contact) in set.pockets.iter().enumerate() {
                check(contact.penetration, &|| [named(ball), body(cage.body)])?;
            }
            for contact in &set.guides {
                check(contact.penetration, &|| [body(cage.body), "its guiding race".into()])?;
            }
        }
        for one in 0..neighbours(layout.balls) {
            let other = (one + 1) % layout.balls;
            let [here, there] =
                [one, other].map(|ball| layout.ball_vector(&self.state, POSITION, ball));
            let between = sub(there, here);
            check(2.0 * radius - norm(between), &|| [named(one), named(other)])?;
        }
        Ok(())
    }
}
