//! Where a state has lost its meaning: values that are not finite, balls outside their races, a race
//! that has left its bearing, parts inside each other. Looked at once a step.

use super::failure::SimulationError;
use super::model::DynamicProblem;
use super::run::Simulation;
use super::state::{BODY, BodyState, POSITION};
use super::system::{System, neighbours};
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
pub fn race_limit(problem: &DynamicProblem) -> f64 {
    let geometry = &problem.geometry;
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
        let layout = self.system.layout;
        let outer = BodyState::from_slice(&self.state[layout.outer()..layout.outer() + BODY]);
        self.watch_balls(&outer)?;
        let named = [
            ("the inner race", layout.inner(), true),
            ("the outer race", layout.outer(), self.system.problem.outer.is_some()),
            ("the cage", layout.cage(), layout.has_cage),
        ];
        for (name, at, present) in named {
            let finite = !present || self.state[at..at + BODY].iter().all(|v| v.is_finite());
            if !finite {
                return Err(self.not_finite(name.into()));
            }
        }
        self.watch_races(&outer)?;
        self.watch_depths()
    }

    fn not_finite(&self, body: String) -> SimulationError {
        SimulationError::NotFinite { body, time: self.time, step: self.steps }
    }

    fn watch_balls(&self, outer: &BodyState) -> Result<(), SimulationError> {
        let layout = self.system.layout;
        let geometry = &self.system.problem.geometry;
        let axis = outer.axis();
        for ball in 0..layout.balls {
            let position = layout.ball_vector(&self.state, POSITION, ball);
            let (axial, radial) = split(sub(position, outer.position), axis);
            let distance = libm::hypot(axial, radial - geometry.pitch_radius);
            if !distance.is_finite() {
                return Err(self.not_finite(format!("ball {}", ball + 1)));
            }
            if distance > geometry.ball_radius {
                return Err(SimulationError::BallOutside {
                    ball: ball + 1,
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
    fn watch_races(&self, outer: &BodyState) -> Result<(), SimulationError> {
        let system = &self.system;
        let at = system.layout.inner();
        let inner = BodyState::from_slice(&self.state[at..at + BODY]);
        let axis = outer.axis();
        let (axial, radial) = split(sub(inner.position, outer.position), axis);
        let tilted = system.problem.geometry.pitch_radius * norm(cross(axis, inner.axis()));
        let allowed = race_limit(&system.problem);
        for (way, distance) in
            [("along its axis", axial.abs() + tilted), ("across its axis", radial)]
        {
            // NaN is too far.
            if distance <= allowed {
                continue;
            }
            let (time, step) = (self.time, self.steps);
            return Err(SimulationError::RaceLeft { way, distance, allowed, time, step });
        }
        Ok(())
    }

    /// Contacts as they were evaluated last, within the step just taken; balls where they lie now.
    fn watch_depths(&self) -> Result<(), SimulationError> {
        let System { layout, table, .. } = &self.system;
        let radius = self.system.problem.geometry.ball_radius;
        let allowed = HERTZ_SCALE * radius;
        let check = |depth: f64, names: &dyn Fn() -> [String; 2]| {
            // NaN is too deep.
            if depth <= allowed {
                return Ok(());
            }
            let ([one, other], time, step) = (names(), self.time, self.steps);
            Err(SimulationError::Inside { one, other, depth, allowed, time, step })
        };
        let named = |ball: usize| format!("ball {}", ball + 1);
        for &pair in &table.active {
            let (side, ball) = (pair / layout.padded, pair % layout.padded);
            let race = ["the inner race", "the outer race"][side];
            check(table.contact[pair].overlap, &|| [named(ball), race.into()])?;
        }
        if layout.has_cage {
            for (ball, contact) in self.system.pockets.iter().enumerate() {
                check(contact.penetration, &|| [named(ball), "the cage".into()])?;
            }
            for contact in &self.system.guides {
                check(contact.penetration, &|| ["the cage".into(), "its guiding race".into()])?;
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
