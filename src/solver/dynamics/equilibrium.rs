//! Static equilibrium of both races at the start: the inner one by [`crate::solver::statics`], a
//! moving outer race by Newton's method around it.
//!
//! What is unknown of the outer race are the coordinates that loads drive. For each trial position
//! statics finds the inner race and the balls; what then pulls at the outer race (contacts, weight,
//! loads, the springs of its foundation) has to vanish.

use super::model::{Drive, DynamicProblem, RaceBody};
use super::race;
use super::start::{inner_speed, static_problem};
use crate::kinematics::Pose;
use crate::kinematics::euler::{about, quaternion};
use crate::solver::statics::{
    COORDINATE_NAMES, Condition, StaticOptions, StaticSolution, StaticsError, solve, solve_from,
};
use nalgebra::{SMatrix, SVector, Vector3};

type Five = SVector<f64, 5>;

/// Where both races and the balls stand still, in the world.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// Coordinates and ball positions are in the world.
    pub solution: StaticSolution,
    /// Position x, y, z (m) and tilts (rad) of the outer race.
    pub outer: [f64; 5],
}

/// Equilibrium under the loads at t = 0. Forces that turn stand still in the direction that they
/// have then: the rotating load at its phase, an unbalance along the inner race's own Y.
///
/// # Errors
/// When the loads have no equilibrium.
pub fn at_start(problem: &DynamicProblem) -> Result<Equilibrium, StaticsError> {
    let Some(body) = &problem.outer else {
        let outer = problem.outer_start;
        return Ok(Equilibrium { solution: inner_race(problem, &outer, None)?, outer });
    };
    let mut outer = Five::from(problem.outer_start);
    let mut free = [true; 5];
    for i in 0..5 {
        if let Drive::Motion(profile) = &body.drives[i] {
            (outer[i], free[i]) = (profile.value(0.0), false);
        }
    }
    let search = Search { problem, body, free };
    let here = search.try_at(outer, None)?;
    search.descend(here)
}

/// The outer race at a trial position.
struct Trial {
    at: Five,
    solution: StaticSolution,
    /// What pulls at its free coordinates: N, and N·m over the pitch radius.
    force: Five,
    /// Largest force at which it counts as none, N.
    allowed: f64,
}

struct Search<'a> {
    problem: &'a DynamicProblem,
    body: &'a RaceBody,
    free: [bool; 5],
}

impl Search<'_> {
    /// Metres per unit of each coordinate.
    fn scale(&self) -> Five {
        let pitch = self.problem.geometry.pitch_radius;
        Five::from([1.0, 1.0, 1.0, pitch, pitch])
    }

    fn try_at(&self, at: Five, guess: Option<&Five>) -> Result<Trial, StaticsError> {
        let outer: [f64; 5] = at.into();
        let solution = inner_race(self.problem, &outer, guess)?;
        let now = race::fixed(&outer);
        let [e2, e3] = now.tilt_directions.map(Vector3::from);
        let on_race =
            solution.force_on_outer + Vector3::from(self.problem.gravity) * self.body.inertia.mass;
        let moment = solution.moment_on_outer;
        // Conjugate to the coordinates, as the equations of motion have them (race::rates).
        let mut force = Five::from([
            on_race.x,
            on_race.y,
            on_race.z,
            moment.dot(&e2) * now.cos_lambda,
            moment.dot(&e3),
        ]);
        let mut largest = force.component_div(&self.scale()).amax();
        for i in 0..5 {
            let Drive::Load(profile) = &self.body.drives[i] else {
                force[i] = 0.0;
                continue;
            };
            let spring = self.body.foundation_stiffness[i] * (at[i] - self.problem.outer_start[i]);
            force[i] += profile.value(0.0) - spring;
            largest = largest.max(profile.value(0.0).abs() / self.scale()[i]);
        }
        for ball in &solution.balls {
            largest = largest.max(ball.inner.normal_load).max(ball.outer.normal_load);
        }
        // As statics: a part of the largest load, and what rounding of positions leaves; what
        // statics has left over itself shows at both races.
        let stiffness = solution.stiffness.diagonal();
        let stiffest = (0..5).map(|i| stiffness[i] / self.scale()[i].powi(2)).fold(0.0, f64::max);
        let reach = self.problem.geometry.pitch_radius + at.fixed_rows::<3>(0).amax();
        let allowed = StaticOptions::default().tolerance * largest
            + 8.0 * f64::EPSILON * reach * stiffest
            + 2.0 * solution.residual;
        Ok(Trial { at, solution, force: force.component_div(&self.scale()), allowed })
    }

    /// Newton's method, its step bounded by a radius: it follows the force as long as that does not
    /// turn against the step by more than it pulled along it.
    fn descend(&self, mut here: Trial) -> Result<Equilibrium, StaticsError> {
        let ball_radius = self.problem.geometry.ball_radius;
        let mut radius = 1e-3 * ball_radius;
        for _ in 0..200 {
            if here.force.amax() <= here.allowed {
                return Ok(self.finish(here));
            }
            // Moved so far that statics finds nothing: adrift.
            let Ok(step) = self.newton_step(&here, radius) else { break };
            let there = self.try_at(
                here.at + step.component_div(&self.scale()),
                Some(&here.solution.coordinates),
            );
            match there {
                Ok(there) if there.force.dot(&step) >= -0.9 * here.force.dot(&step) => {
                    if step.norm() > 0.9 * radius {
                        radius *= 3.0;
                    }
                    let settled = here.force.amax() <= 1e2 * here.allowed;
                    if settled && there.force.amax() >= here.force.amax() {
                        // Rounding, not the position, is what is left.
                        return Ok(self.finish(here));
                    }
                    here = there;
                }
                _ => radius = 0.25 * radius.min(step.norm()),
            }
            // Soft springs give way by millimetres; nothing that holds gives way by a metre.
            let travel = self.travel(&here).component_mul(&self.scale());
            if !(travel.amax() <= 1.0 && radius > f64::EPSILON * ball_radius) {
                break;
            }
        }
        let worst = here.force.iamax();
        Err(StaticsError::OuterAdrift {
            coordinate: COORDINATE_NAMES[worst],
            force: here.force[worst],
            travel: self.travel(&here)[worst],
        })
    }

    fn travel(&self, trial: &Trial) -> Five {
        trial.at - Five::from(self.problem.outer_start)
    }

    /// Step in metres; with as much of the identity added to the stiffness as makes it positive.
    fn newton_step(&self, here: &Trial, radius: f64) -> Result<Five, StaticsError> {
        // Small beside overlaps of 0.1 µm and more, large beside what statics leaves (1e-11).
        const DIFFERENCE: f64 = 1e-9;
        let mut stiffness = SMatrix::<f64, 5, 5>::zeros();
        for column in (0..5).filter(|&i| self.free[i]) {
            let mut moved = here.at;
            moved[column] += DIFFERENCE / self.scale()[column];
            let there = self.try_at(moved, Some(&here.solution.coordinates))?;
            stiffness.set_column(column, &((here.force - there.force) / DIFFERENCE));
        }
        let stiffness = 0.5 * (stiffness + stiffness.transpose());
        let largest = stiffness.diagonal().amax();
        let floor = if largest > 0.0 { largest } else { here.force.amax() / radius };
        let mut shift = 0.0;
        loop {
            let mut shifted = stiffness;
            for i in 0..5 {
                if self.free[i] {
                    shifted[(i, i)] += shift;
                } else {
                    shifted.fill_row(i, 0.0);
                    shifted.fill_column(i, 0.0);
                    shifted[(i, i)] = floor;
                }
            }
            if let Some(factor) = shifted.cholesky() {
                let step = factor.solve(&here.force);
                let length = step.norm();
                if length.is_finite() {
                    return Ok(if length > radius { step * (radius / length) } else { step });
                }
            }
            shift = if shift == 0.0 { 1e-4 * floor } else { 4.0 * shift };
        }
    }

    fn finish(&self, trial: Trial) -> Equilibrium {
        Equilibrium { solution: trial.solution, outer: trial.at.into() }
    }
}

/// Equilibrium of the inner race and the balls with the outer race at `outer`, in the world.
fn inner_race(
    problem: &DynamicProblem,
    outer: &[f64; 5],
    guess: Option<&Five>,
) -> Result<StaticSolution, StaticsError> {
    let mut statics = static_problem(problem, 0.0);
    let at = Vector3::new(outer[0], outer[1], outer[2]);
    let start = problem.outer_start;
    // Statics looks for the inner race near its origin: it follows an outer race that gives way.
    let shift = at - Vector3::new(start[0], start[1], start[2]);
    statics.frame = Pose { position: shift, ..Pose::identity() };
    statics.outer_pose = Pose { position: at, orientation: quaternion(0.0, outer[3], outer[4]) };
    let mut tilts = [0.0; 2];
    for i in 0..5 {
        if let Condition::Displacement(value) = &mut statics.conditions[i] {
            if i < 3 {
                *value -= shift[i];
            } else {
                tilts[i - 3] = *value;
            }
        }
    }
    let moved = |coordinates: &Five, by: Vector3<f64>| {
        let mut moved = *coordinates;
        for i in 0..3 {
            moved[i] += by[i];
        }
        moved
    };
    let near = guess.map(|guess| {
        tilts = [guess[3], guess[4]];
        moved(guess, -shift)
    });
    let speed = inner_speed(problem, 0.0);
    let size = problem.unbalance * speed * speed;
    let without = statics.conditions;
    let mut before = [f64::NAN; 2];
    // An unbalance follows the race's tilts, by at most tilt · F/(k R) of what they were before.
    for _ in 0..20 {
        statics.conditions = without;
        if size != 0.0 {
            let along =
                about(Vector3::y(), tilts[0]) * about(Vector3::z(), tilts[1]) * Vector3::y();
            for i in 0..3 {
                if let Condition::Load(load) = &mut statics.conditions[i] {
                    *load += size * along[i];
                }
            }
        }
        let mut solution = match &near {
            Some(near) => solve_from(&statics, Some(near), &StaticOptions::default())
                .or_else(|_| solve(&statics))?,
            None => solve(&statics)?,
        };
        let now = [solution.coordinates[3], solution.coordinates[4]];
        let change = (now[0] - tilts[0]).abs().max((now[1] - tilts[1]).abs());
        if size == 0.0 || change <= 1e-14 || now == before {
            solution.coordinates = moved(&solution.coordinates, shift);
            for ball in &mut solution.balls {
                ball.position += shift;
            }
            return Ok(solution);
        }
        (before, tilts) = (tilts, now);
    }
    solve(&statics)
}
