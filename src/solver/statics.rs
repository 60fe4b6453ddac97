//! Static equilibrium of one bearing: five coordinates of the inner race, two of every ball.
//!
//! The equilibrium is the minimum of contact energy minus the work of the loads. Newton's method
//! with the analytic stiffness, its step bounded by a trust radius, descends on that energy from a
//! cold start; the balls are in equilibrium at every evaluation, so that the race's five
//! coordinates are the only unknowns of the outer loop.

use super::ball::{
    BallContacts, BallPlane, InnerRacePosition, SettledBall, add_to_race, energy_noise,
    overlap_of_races, settle,
};
use super::static_start;
use crate::ch2_housing::bearing::contact::{MeridianContact, normal_load};
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::{HertzContact, contact_ellipse};
use crate::kinematics::Pose;
use nalgebra::{SMatrix, SVector, SymmetricEigen, Vector3};
use std::f64::consts::TAU;
use thiserror::Error;

/// The five coordinates of a race, in this order: x, y, z (m), tilt_y, tilt_z (rad). The tilts are
/// the Euler angles ξ and λ of (2.16) with η = 0.
pub const COORDINATE_NAMES: [&str; 5] = ["x", "y", "z", "tilt_y", "tilt_z"];

/// What is prescribed for one coordinate of the inner race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// Applied force (N) or moment (N·m) on the inner race; the coordinate is unknown.
    Load(f64),
    /// Given displacement (m) or tilt (rad); the reaction is unknown.
    Displacement(f64),
}

/// A bearing, the position of its outer race and what is prescribed for its inner race.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticProblem {
    pub geometry: BearingGeometry,
    pub inner_contact: HertzContact,
    pub outer_contact: HertzContact,
    /// Azimuth of ball 1 in the outer race's frame, from +Y towards +Z, rad.
    pub ball_phase: f64,
    /// kg; only used with `gravity` or `orbital_speed`.
    pub ball_mass: f64,
    /// World axes, m/s².
    pub gravity: Vector3<f64>,
    /// Speed of the ball set about the bearing axis, rad/s (centrifugal force); 0 leaves it out.
    pub orbital_speed: f64,
    /// Frame in which the inner race's five coordinates and loads are measured, in the world.
    pub frame: Pose,
    /// Pose of the outer race in the world.
    pub outer_pose: Pose,
    /// Conditions on x, y, z, tilt_y, tilt_z of the inner race in `frame`.
    pub conditions: [Condition; 5],
}

/// How far to iterate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticOptions {
    /// Unbalanced load, as a fraction of the largest applied or ball load, at which to stop.
    /// Rounding of the overlaps sets a floor of about 1e-12.
    pub tolerance: f64,
    pub max_iterations: usize,
}

impl Default for StaticOptions {
    fn default() -> Self {
        StaticOptions { tolerance: 1e-11, max_iterations: 200 }
    }
}

/// One loaded or unloaded contact in the solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactState {
    /// N.
    pub normal_load: f64,
    /// δ of (2.1), m; zero or negative when open (negative: gap).
    pub approach: f64,
    /// Angle of the contact normal to the race's radial plane, rad; positive when the inner race
    /// is pushed towards +X.
    pub contact_angle: f64,
    /// Semi-axes of the contact ellipse, m.
    pub semi_major: f64,
    pub semi_minor: f64,
    /// Largest contact pressure, Pa.
    pub peak_pressure: f64,
    /// Force on the race, in `frame`, N.
    pub force_on_race: Vector3<f64>,
}

/// One ball in the solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallState {
    /// rad, in the outer race's frame.
    pub azimuth: f64,
    /// Ball centre in `frame`, m.
    pub position: Vector3<f64>,
    pub inner: ContactState,
    pub outer: ContactState,
    /// Force along the circumference (towards larger azimuth) with which the cage keeps the ball at
    /// its azimuth, N: what the contacts and the weight leave over in that direction.
    pub cage_force: f64,
}

/// Whether the loads determine the position.
#[derive(Clone, Debug, PartialEq)]
pub enum Determinacy {
    Determinate,
    /// The position is one of many: these directions (unit vectors over the five coordinates,
    /// tilts multiplied by the pitch radius) meet no stiffness.
    Indeterminate {
        free_directions: Vec<SVector<f64, 5>>,
    },
}

/// Equilibrium of the bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticSolution {
    /// x, y, z (m), tilt_y, tilt_z (rad) of the inner race in `frame`.
    pub coordinates: SVector<f64, 5>,
    /// Loads that hold the inner race there: N, N, N, N·m, N·m. They are energy-conjugate to the
    /// coordinates: the moments act about Y and about the race's own (tilted) Z axis.
    pub loads: SVector<f64, 5>,
    /// ∂loads/∂coordinates, symmetric, SI units.
    pub stiffness: SMatrix<f64, 5, 5>,
    /// Sum of contact forces on the inner race and their moment about its centre, in `frame`.
    pub force_on_inner: Vector3<f64>,
    pub moment_on_inner: Vector3<f64>,
    /// Sum of contact forces on the outer race and their moment about its centre, in `frame`.
    pub force_on_outer: Vector3<f64>,
    pub moment_on_outer: Vector3<f64>,
    pub balls: Vec<BallState>,
    pub determinacy: Determinacy,
    /// How often the search left an unstable equilibrium; not zero where symmetry lets the race
    /// tip over to either side, so that the mirrored position is an equilibrium too.
    pub saddles_left: usize,
    /// Newton iterations on the race's coordinates.
    pub iterations: usize,
    /// Evaluations of one ball against one race, distance tests included.
    pub contact_evaluations: usize,
    /// Largest unbalanced load over the free coordinates (moments divided by the pitch radius), N.
    pub residual: f64,
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum StaticsError {
    #[error("{what} is {value}: every input of the static problem must be finite")]
    NotFinite { what: &'static str, value: f64 },
    #[error(
        "no equilibrium: the inner race leaves the bearing along {coordinate} \
         ({travel:.3e} m, farther than a ball radius of {ball_radius:.3e} m); nothing holds it \
         against the load in this direction: hold the coordinate by a displacement, or turn the load"
    )]
    NoEquilibrium { coordinate: &'static str, travel: f64, ball_radius: f64 },
    #[error(
        "ball {ball} has found no equilibrium between the races: {unbalance:.1e} of the force on it is \
         unbalanced; hold or load the inner race differently, or leave the forces on balls out"
    )]
    BallNotSettled { ball: usize, unbalance: f64 },
    #[error(
        "ball {ball} leaves its grooves: pressed {overlap:.3e} m deep at a contact angle of \
         {degrees:.1} deg, past the 90 deg where the races hold it; the load is too large for this \
         bearing, check it and its unit"
    )]
    BallOutside { ball: usize, overlap: f64, degrees: f64 },
    #[error(
        "no equilibrium found in {iterations} iterations: unbalanced load {residual:.3e} N against \
         {allowed:.3e} N allowed; last position x, y, z {position:?} m, tilts {tilts:?} rad"
    )]
    NotConverged {
        iterations: usize,
        residual: f64,
        allowed: f64,
        position: [f64; 3],
        tilts: [f64; 2],
    },
}

/// Stiffness below this fraction of the largest one counts as none. Rounding of the overlaps leaves
/// about 1e-12; the softest real direction, the swivel of a loaded ball, has about 1e-3.
const NO_STIFFNESS: f64 = 1e-9;

/// Equilibrium from a cold start.
pub fn solve(problem: &StaticProblem) -> Result<StaticSolution, StaticsError> {
    solve_from(problem, None, &StaticOptions::default())
}

/// Equilibrium from a given position (`guess`: x, y, z in m, tilt_y, tilt_z in rad), as in a sweep
/// where the neighbour's solution is at hand; `None` is a cold start.
pub fn solve_from(
    problem: &StaticProblem,
    guess: Option<&SVector<f64, 5>>,
    options: &StaticOptions,
) -> Result<StaticSolution, StaticsError> {
    check_finite(problem)?;
    match solve_directly(problem, guess, options) {
        // A loose bearing under a small load lies in a long curved valley of the energy, along
        // which Newton's method creeps. A larger load straightens it; follow that down.
        Err(StaticsError::NotConverged { .. }) if guess.is_none() => unload(problem, options),
        result => result,
    }
}

/// Equilibrium under ever smaller multiples of the loads, down to the loads themselves.
fn unload(
    problem: &StaticProblem,
    options: &StaticOptions,
) -> Result<StaticSolution, StaticsError> {
    let mut start = None;
    let mut work = (0, 0);
    let patient = StaticOptions { max_iterations: 10 * options.max_iterations, ..*options };
    for halvings in (1..=24).rev() {
        let factor = f64::powi(2.0, halvings);
        let mut loaded = problem.clone();
        for condition in &mut loaded.conditions {
            if let Condition::Load(load) = condition {
                *load *= factor;
            }
        }
        // Loads too large for the bearing fail; a smaller multiple starts from where it was.
        if let Ok(solution) = solve_directly(&loaded, start.as_ref(), options) {
            work.0 += solution.iterations;
            work.1 += solution.contact_evaluations;
            start = Some(solution.coordinates);
        }
    }
    let mut solution = solve_directly(problem, start.as_ref(), &patient)?;
    solution.iterations += work.0;
    solution.contact_evaluations += work.1;
    Ok(solution)
}

fn solve_directly(
    problem: &StaticProblem,
    guess: Option<&SVector<f64, 5>>,
    options: &StaticOptions,
) -> Result<StaticSolution, StaticsError> {
    let model = Model::new(problem);
    let mut at = guess.copied().unwrap_or_else(|| static_start::guess(problem, &model.contacts));
    for (i, condition) in problem.conditions.iter().enumerate() {
        if let Condition::Displacement(value) = condition {
            at[i] = *value;
        }
    }
    let mut search = Search::new(&model, problem, options);
    let mut here = search.evaluate(at);
    search.descend(&mut here)?;
    // A cold start on a plane of symmetry can end on a saddle, from which a real race would fall;
    // so leave it along the direction of negative stiffness and descend again.
    for _ in 0..5 {
        let Some(direction) = search.falling_direction(&here) else { break };
        let trials = [1.0, -1.0].map(|sign| search.evaluate(here.at + direction * sign));
        search.saddles_left += 1;
        here = trials.into_iter().min_by(|a, b| a.energy.total_cmp(&b.energy)).unwrap_or(here);
        search.descend(&mut here)?;
    }
    search.check_balls(&here)?;
    Ok(search.solution(here))
}

fn check_finite(problem: &StaticProblem) -> Result<(), StaticsError> {
    let loads = problem.conditions.iter().map(|condition| match condition {
        Condition::Load(value) => ("a load", *value),
        Condition::Displacement(value) => ("a displacement", *value),
    });
    let geometry = &problem.geometry;
    let others = [
        ("ball_radius", geometry.ball_radius),
        ("the inner groove's centre", geometry.inner.centre_radius + geometry.inner.centre_axial),
        ("the outer groove's centre", geometry.outer.centre_radius + geometry.outer.centre_axial),
        ("a groove radius", geometry.inner.groove_radius + geometry.outer.groove_radius),
        ("pitch_radius", geometry.pitch_radius),
        ("ball_phase", problem.ball_phase),
        ("orbital_speed", problem.orbital_speed),
        ("ball_mass", problem.ball_mass),
        ("gravity", problem.gravity.sum()),
        ("the inner contact's stiffness", problem.inner_contact.stiffness),
        ("the outer contact's stiffness", problem.outer_contact.stiffness),
        ("the outer race's position", problem.outer_pose.position.sum()),
        ("the frame's position", problem.frame.position.sum()),
    ];
    for (what, value) in loads.chain(others) {
        if !value.is_finite() {
            return Err(StaticsError::NotFinite { what, value });
        }
    }
    Ok(())
}

/// What does not change while the race moves.
struct Model {
    contacts: BallContacts,
    planes: Vec<BallPlane>,
    azimuths: Vec<f64>,
    /// Metres per unit of each coordinate: 1 for lengths, the pitch radius for tilts.
    scale: SVector<f64, 5>,
}

impl Model {
    fn new(problem: &StaticProblem) -> Self {
        let geometry = &problem.geometry;
        let contacts = static_start::ball_contacts(problem);
        let outer = problem.outer_pose.relative_to(&problem.frame);
        let gravity = problem.frame.orientation.inverse_transform_vector(&problem.gravity)
            * problem.ball_mass;
        let centrifugal = problem.ball_mass * problem.orbital_speed.powi(2);
        let azimuths: Vec<f64> = (0..geometry.ball_count)
            .map(|j| problem.ball_phase + TAU * j as f64 / geometry.ball_count as f64)
            .collect();
        let axial = outer.orientation * Vector3::x();
        let planes = azimuths
            .iter()
            .map(|azimuth| {
                let (sin, cos) = libm::sincos(*azimuth);
                let radial = outer.orientation * Vector3::new(0.0, cos, sin);
                let weight = [gravity.dot(&axial), gravity.dot(&radial)];
                let weight_around = gravity.dot(&axial.cross(&radial));
                let origin = outer.position;
                BallPlane { origin, axial, radial, weight, weight_around, centrifugal }
            })
            .collect();
        let pitch = geometry.pitch_radius;
        Model { contacts, planes, azimuths, scale: SVector::from([1.0, 1.0, 1.0, pitch, pitch]) }
    }
}

/// The bearing at one position of the inner race.
#[derive(Clone)]
struct Evaluation {
    at: SVector<f64, 5>,
    /// Contact energy minus the work of loads and body forces, J.
    energy: f64,
    gradient: SVector<f64, 5>,
    stiffness: SMatrix<f64, 5, 5>,
    largest_ball_load: f64,
    balls: Vec<Option<SettledBall>>,
}

struct Search<'a> {
    model: &'a Model,
    problem: &'a StaticProblem,
    options: &'a StaticOptions,
    loads: SVector<f64, 5>,
    free: [bool; 5],
    saddles_left: usize,
    iterations: usize,
    contact_evaluations: usize,
    spare: Vec<Option<SettledBall>>,
}

impl<'a> Search<'a> {
    fn new(model: &'a Model, problem: &'a StaticProblem, options: &'a StaticOptions) -> Self {
        let mut loads = SVector::zeros();
        let mut free = [false; 5];
        for (i, condition) in problem.conditions.iter().enumerate() {
            if let Condition::Load(load) = condition {
                loads[i] = *load;
                free[i] = true;
            }
        }
        Search {
            model,
            problem,
            options,
            loads,
            free,
            saddles_left: 0,
            iterations: 0,
            contact_evaluations: 0,
            spare: Vec::with_capacity(model.planes.len()),
        }
    }

    fn evaluate(&mut self, at: SVector<f64, 5>) -> Evaluation {
        let race = InnerRacePosition::new(&at);
        let mut energy = -self.loads.dot(&at);
        let mut gradient = -self.loads;
        let mut stiffness = SMatrix::zeros();
        let mut largest_ball_load = 0.0_f64;
        let mut balls = std::mem::take(&mut self.spare);
        balls.clear();
        for plane in &self.model.planes {
            let contacts = &self.model.contacts;
            let ball = settle(plane, &race, contacts, &mut self.contact_evaluations);
            if let Some(ball) = &ball {
                energy += ball.energy;
                largest_ball_load = largest_ball_load.max(ball.inner_load).max(ball.outer_load);
                add_to_race(plane, &race, contacts, ball, &mut gradient, &mut stiffness);
            }
            balls.push(ball);
        }
        Evaluation { at, energy, gradient, stiffness, largest_ball_load, balls }
    }

    /// Largest unbalanced load over the free coordinates, N.
    fn residual(&self, here: &Evaluation) -> f64 {
        (0..5)
            .filter(|&i| self.free[i])
            .map(|i| (here.gradient[i] / self.model.scale[i]).abs())
            .fold(0.0, f64::max)
    }

    /// Residual at which to stop, N.
    fn allowed(&self, here: &Evaluation) -> f64 {
        let applied = self.loads.component_div(&self.model.scale).amax();
        let pitch = self.problem.geometry.pitch_radius;
        let stiffest = (0..5)
            .map(|i| here.stiffness[(i, i)] / self.model.scale[i].powi(2))
            .fold(0.0, f64::max);
        // Rounding of positions (some ulps of the pitch radius) times the stiffness cannot go away.
        let noise = 8.0 * f64::EPSILON * pitch * stiffest;
        self.options.tolerance * applied.max(here.largest_ball_load) + noise
    }

    /// Newton's method with a trust radius on the energy.
    fn descend(&mut self, here: &mut Evaluation) -> Result<(), StaticsError> {
        let mut radius = static_start::step_scale(self.problem, &self.model.contacts);
        loop {
            let residual = self.residual(here);
            let allowed = self.allowed(here);
            if residual <= allowed {
                return Ok(());
            }
            if self.iterations >= self.options.max_iterations {
                return self.give_up(here, residual, allowed);
            }
            self.iterations += 1;
            let step = self.newton_step(here, radius);
            let there = self.evaluate(here.at + step.component_div(&self.model.scale));
            let predicted = self.predicted_change(here, &step);
            let change = there.energy - here.energy;
            // Near the end the change drowns in rounding, and the unbalanced load decides alone.
            let load = here.largest_ball_load.max(there.largest_ball_load);
            let pitch = self.problem.geometry.pitch_radius;
            let noise = energy_noise(load, pitch) * self.model.planes.len() as f64;
            let quieter = self.residual(&there) < residual;
            let accepted = change < (1e-4 * predicted).min(-noise) || (change <= noise && quieter);
            if accepted {
                if change < 0.75 * predicted && step.norm() > 0.9 * radius {
                    radius *= 3.0;
                }
                self.spare = std::mem::replace(here, there).balls;
                self.check_travel(here)?;
            } else {
                self.spare = there.balls;
                if residual <= 1e2 * allowed && change.abs() <= noise {
                    // Rounding, not the position, is what is left.
                    return Ok(());
                }
                radius = 0.25 * radius.min(step.norm());
            }
        }
    }

    /// Every ball settled, and none past the edge of what a torus can hold.
    fn check_balls(&self, here: &Evaluation) -> Result<(), StaticsError> {
        /// Newton's last step leaves 1e-11; anything above this is a ball still on its way.
        const SETTLED: f64 = 1e-8;
        let race = InnerRacePosition::new(&here.at);
        for (index, (plane, ball)) in self.model.planes.iter().zip(&here.balls).enumerate() {
            let ball_number = index + 1;
            match ball {
                Some(ball) if ball.unbalance > SETTLED || ball.unbalance.is_nan() => {
                    let unbalance = ball.unbalance;
                    return Err(StaticsError::BallNotSettled { ball: ball_number, unbalance });
                }
                Some(_) => {}
                None => {
                    let (overlap, angle) = overlap_of_races(plane, &race, &self.model.contacts);
                    if overlap > 0.0 && angle.abs() > std::f64::consts::FRAC_PI_2 {
                        let degrees = angle.to_degrees();
                        return Err(StaticsError::BallOutside {
                            ball: ball_number,
                            overlap,
                            degrees,
                        });
                    }
                }
            }
        }
        Ok(())
    }

    fn give_up(&self, here: &Evaluation, residual: f64, allowed: f64) -> Result<(), StaticsError> {
        Err(StaticsError::NotConverged {
            iterations: self.iterations,
            residual,
            allowed,
            position: [here.at[0], here.at[1], here.at[2]],
            tilts: [here.at[3], here.at[4]],
        })
    }

    fn check_travel(&self, here: &Evaluation) -> Result<(), StaticsError> {
        let ball_radius = self.model.contacts.ball_radius;
        for i in (0..5).filter(|&i| self.free[i]) {
            let travel = here.at[i] * self.model.scale[i];
            // NaN leaves here too.
            if travel.is_nan() || travel.abs() > ball_radius {
                let coordinate = COORDINATE_NAMES[i];
                return Err(StaticsError::NoEquilibrium { coordinate, travel, ball_radius });
            }
        }
        Ok(())
    }

    /// Gradient and stiffness over metres (tilts times pitch radius), prescribed coordinates
    /// replaced by a unit diagonal so that their step is zero.
    fn scaled(&self, here: &Evaluation) -> (SVector<f64, 5>, SMatrix<f64, 5, 5>) {
        let mut gradient = here.gradient.component_div(&self.model.scale);
        let mut stiffness = here.stiffness;
        for i in 0..5 {
            for j in 0..5 {
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
    fn newton_step(&self, here: &Evaluation, radius: f64) -> SVector<f64, 5> {
        let (gradient, stiffness) = self.scaled(here);
        let largest = stiffness.diagonal().amax();
        let floor = if largest > 0.0 { largest } else { gradient.amax() / radius };
        let mut shift = 0.0;
        loop {
            let mut shifted = stiffness;
            for i in 0..5 {
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

    fn predicted_change(&self, here: &Evaluation, step: &SVector<f64, 5>) -> f64 {
        let (gradient, stiffness) = self.scaled(here);
        gradient.dot(step) + 0.5 * step.dot(&(stiffness * step))
    }

    /// Eigenvalues and eigenvectors of the scaled stiffness over the free coordinates.
    fn free_modes(&self, here: &Evaluation) -> Vec<(f64, SVector<f64, 5>)> {
        let (_, stiffness) = self.scaled(here);
        let eigen = SymmetricEigen::new(stiffness);
        (0..5)
            .map(|k| (eigen.eigenvalues[k], eigen.eigenvectors.column(k).into_owned()))
            .filter(|(_, v)| (0..5).any(|i| self.free[i] && v[i].abs() > 1e-6))
            .collect()
    }

    /// A small displacement along the most negative stiffness, if there is one.
    fn falling_direction(&self, here: &Evaluation) -> Option<SVector<f64, 5>> {
        let modes = self.free_modes(here);
        let largest = modes.iter().map(|mode| mode.0.abs()).fold(0.0, f64::max);
        let (value, vector) = modes.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        if value >= -NO_STIFFNESS * largest {
            return None;
        }
        let length = 0.1 * static_start::step_scale(self.problem, &self.model.contacts);
        Some((vector * length).component_div(&self.model.scale))
    }

    fn determinacy(&self, here: &Evaluation) -> Determinacy {
        let modes = self.free_modes(here);
        // The scale is that of the whole bearing, so that one lone free coordinate is judged too.
        let scaled_diagonal = (0..5)
            .map(|i| here.stiffness[(i, i)] / self.model.scale[i].powi(2))
            .fold(0.0, f64::max);
        // An overlap of some ulps of the radius is no contact, and its stiffness none.
        let contacts = &self.model.contacts;
        let rounding = 256.0 * f64::EPSILON * contacts.outer.centre_radius;
        let noise = normal_load(contacts.inner_stiffness.max(contacts.outer_stiffness), rounding);
        let threshold = if here.largest_ball_load <= noise {
            f64::INFINITY
        } else {
            NO_STIFFNESS * scaled_diagonal
        };
        let free_directions: Vec<_> =
            modes.into_iter().filter(|mode| mode.0 <= threshold).map(|mode| mode.1).collect();
        if free_directions.is_empty() {
            Determinacy::Determinate
        } else {
            Determinacy::Indeterminate { free_directions }
        }
    }

    fn solution(&self, here: Evaluation) -> StaticSolution {
        let model = self.model;
        let race = InnerRacePosition::new(&here.at);
        let mut force_on_inner = Vector3::zeros();
        let mut moment_on_inner = Vector3::zeros();
        let mut force_on_outer = Vector3::zeros();
        let mut moment_on_outer = Vector3::zeros();
        let mut balls = Vec::with_capacity(model.planes.len());
        for ((plane, azimuth), settled) in model.planes.iter().zip(&model.azimuths).zip(&here.balls)
        {
            let ball = self.ball_state(plane, *azimuth, &race, settled.as_ref());
            force_on_inner += ball.inner.force_on_race;
            force_on_outer += ball.outer.force_on_race;
            moment_on_inner += (ball.position - race.centre).cross(&ball.inner.force_on_race);
            moment_on_outer += (ball.position - plane.origin).cross(&ball.outer.force_on_race);
            balls.push(ball);
        }
        StaticSolution {
            coordinates: here.at,
            loads: here.gradient + self.loads,
            stiffness: here.stiffness,
            force_on_inner,
            moment_on_inner,
            force_on_outer,
            moment_on_outer,
            balls,
            determinacy: self.determinacy(&here),
            saddles_left: self.saddles_left,
            iterations: self.iterations,
            contact_evaluations: self.contact_evaluations,
            residual: self.residual(&here),
        }
    }

    fn ball_state(
        &self,
        plane: &BallPlane,
        azimuth: f64,
        race: &InnerRacePosition,
        settled: Option<&SettledBall>,
    ) -> BallState {
        let contacts = &self.model.contacts;
        // An unloaded ball may be anywhere in its room; it is shown in the middle of it.
        let in_plane = match settled {
            Some(ball) => ball.position,
            None => middle_of_room(plane, race, contacts),
        };
        let position = plane.origin + plane.axial * in_plane[0] + plane.radial * in_plane[1];
        let (inner_contact, outer_contact) =
            super::ball::contacts_at(plane, race, contacts, in_plane);
        let (inner_load, outer_load) =
            settled.map_or((0.0, 0.0), |ball| (ball.inner_load, ball.outer_load));
        let arm = position - race.centre;
        let radial = (arm - race.axis * race.axis.dot(&arm)).normalize();
        let inner_normal = race.axis * inner_contact.normal[0] + radial * inner_contact.normal[1];
        let outer_normal =
            plane.axial * outer_contact.normal[0] + plane.radial * outer_contact.normal[1];
        let inner_angle = libm::atan2(-inner_contact.normal[0], -inner_contact.normal[1]);
        let outer_angle = libm::atan2(outer_contact.normal[0], outer_contact.normal[1]);
        let problem = self.problem;
        let inner = contact_state(
            &problem.inner_contact,
            &inner_contact,
            inner_load,
            inner_angle,
            inner_normal,
        );
        let outer = contact_state(
            &problem.outer_contact,
            &outer_contact,
            outer_load,
            outer_angle,
            outer_normal,
        );
        let around = plane.axial.cross(&plane.radial);
        let contact_force = (inner.force_on_race + outer.force_on_race).dot(&around);
        let cage_force = contact_force - plane.weight_around;
        BallState { azimuth, position, inner, outer, cage_force }
    }
}

fn middle_of_room(
    plane: &BallPlane,
    race: &InnerRacePosition,
    contacts: &BallContacts,
) -> [f64; 2] {
    let outer = [contacts.outer.centre_axial, contacts.outer.centre_radius];
    let inner = super::ball::inner_centre_in_plane(plane, race, &contacts.inner, outer);
    let outer_room = contacts.outer.groove_radius - contacts.ball_radius;
    let inner_room = contacts.inner.groove_radius - contacts.ball_radius;
    let share = outer_room / (outer_room + inner_room);
    [outer[0] + share * (inner[0] - outer[0]), outer[1] + share * (inner[1] - outer[1])]
}

fn contact_state(
    hertz: &HertzContact,
    contact: &MeridianContact,
    normal_load: f64,
    contact_angle: f64,
    normal: Vector3<f64>,
) -> ContactState {
    let ellipse = contact_ellipse(hertz, normal_load);
    ContactState {
        normal_load,
        approach: contact.overlap,
        contact_angle,
        semi_major: ellipse.semi_major,
        semi_minor: ellipse.semi_minor,
        peak_pressure: ellipse.peak_pressure,
        force_on_race: normal * normal_load,
    }
}
