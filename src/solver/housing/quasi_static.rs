//! A bearing in its housing along a course of loads, one equilibrium after the other.
//!
//! Balls go round at the speed of the cage in pure rolling; nothing is inert but, on wish, the balls
//! in their orbit. What that leaves out [`super::inertia`] estimates.

use super::bore_equilibrium::Fit;
use super::housed::{HousedSearch, HousedState};
use crate::ch2_housing::bearing::frequencies::ratios;
use crate::kinematics::vec3::Vec3;
use crate::solver::dynamics::model::RotatingLoad;
use crate::solver::profile::Profile;
use crate::solver::statics::{Condition, StaticProblem, StaticsError};
use thiserror::Error;

/// What happens over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// When to look, ascending, s.
    pub times: Vec<f64>,
    /// On the inner race, in the place of the bearing's conditions: loads stay loads and
    /// displacements displacements.
    pub conditions: [Profile; 5],
    /// Besides them, on y and z.
    pub rotating_load: Option<RotatingLoad>,
    /// Of the inner race, rad/s; its balls roll.
    pub shaft_speed: Profile,
    /// Added to the race's radius, m: the outer race grows into its fit.
    pub interference: Profile,
    /// Further force on the outer race, N in the world.
    pub weight: Vec3,
    /// Whether balls press outwards as they go round.
    pub centrifugal: bool,
}

/// The assembly at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// s.
    pub time: f64,
    /// Azimuth of ball 1, rad.
    pub ball_phase: f64,
    pub state: HousedState,
}

#[derive(Clone, Debug, PartialEq, Error)]
#[error("at t = {time} s: {source}")]
pub struct CourseError {
    pub time: f64,
    pub source: StaticsError,
}

/// Equilibria at the times of a course. `fit.radius` is the race's before it grows.
///
/// # Errors
/// The first time at which there is no equilibrium.
pub fn history(
    search: &mut HousedSearch,
    bearing: &StaticProblem,
    fit: &Fit,
    course: &Course,
) -> Result<Vec<Moment>, CourseError> {
    let geometry = &bearing.geometry;
    let cage = ratios(
        geometry.ball_count,
        geometry.ball_radius,
        geometry.pitch_radius,
        geometry.contact_angle,
    )
    .cage;
    let mut problem = bearing.clone();
    let at = |&time: &f64| {
        let turning = course.rotating_load.as_ref().map_or([0.0; 3], |load| load.force(time));
        for (i, (condition, profile)) in
            problem.conditions.iter_mut().zip(&course.conditions).enumerate()
        {
            let value = profile.value(time);
            *condition = match condition {
                Condition::Load(_) => {
                    Condition::Load(value + turning.get(i).copied().unwrap_or(0.0))
                }
                Condition::Displacement(_) => Condition::Displacement(value),
            };
        }
        problem.ball_phase = bearing.ball_phase + cage * course.shaft_speed.integral(time);
        let turns = if course.centrifugal { course.shaft_speed.value(time) } else { 0.0 };
        problem.orbital_speed = cage * turns;
        let grown = Fit { radius: fit.radius + course.interference.value(time), ..*fit };
        let state = search
            .solve(&problem, &grown, course.weight)
            .map_err(|source| CourseError { time, source })?;
        Ok(Moment { time, ball_phase: problem.ball_phase, state })
    };
    course.times.iter().map(at).collect()
}
