//! The search behind [`super::statics`]: Newton's method with a trust radius on the energy, and the
//! solution's tables.

use super::ball::{
    BallContacts, BallPlane, InnerRacePosition, SettledBall, add_to_race, energy_noise,
    overlap_of_races, settle,
};
use super::static_start;
use super::statics::{
    BallState, COORDINATE_NAMES, Condition, ContactState, Determinacy, StaticOptions,
    StaticProblem, StaticSolution, StaticsError,
};
use crate::ch2_housing::bearing::contact::{MeridianContact, normal_load};
use crate::ch2_housing::bearing::hertz::{HertzContact, contact_ellipse};
use nalgebra::{SMatrix, SVector, SymmetricEigen, Vector3};
use std::f64::consts::TAU;

/// Stiffness below this fraction of the largest one counts as none. Rounding of the overlaps leaves
/// about 1e-12; the softest real direction, the swivel of a loaded ball, has about 1e-3.
const NO_STIFFNESS: f64 = 1e-9;

/// What does not change while the race moves.
pub(super) struct Model {
    pub(super) contacts: BallContacts,
    planes: Vec<BallPlane>,
    azimuths: Vec<f64>,
    /// Metres per unit of each coordinate: 1 for lengths, the pitch radius for tilts.
    scale: SVector<f64, 5>,
}

impl Model {
    pub(super) fn new(problem: &StaticProblem) -> Self {
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
pub(super) struct Evaluation {
    pub(super) at: SVector<f64, 5>,
    /// Contact energy minus the work of loads and body forces, J.
    pub(super) energy: f64,
    gradient: SVector<f64, 5>,
    stiffness: SMatrix<f64, 5, 5>,
    largest_ball_load: f64,
    balls: Vec<Option<SettledBall>>,
}

pub(super) struct Search<'a> {
    model: &'a Model,
    problem: &'a StaticProblem,
    options: &'a StaticOptions,
    loads: SVector<f64, 5>,
    free: [bool; 5],
    pub(super) saddles_left: usize,
    iterations: usize,
    contact_evaluations: usize,
    spare: Vec<Option<SettledBall>>,
}

impl<'a> Search<'a> {
    pub(super) fn new(
        model: &'a Model,
        problem: &'a StaticProblem,
        options: &'a StaticOptions,
    ) -> Self {
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

    pub(super) fn evaluate(&mut self, at: SVector<f64, 5>) -> Evaluation {
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
    pub(super) fn descend(&mut self, here: &mut Evaluation) -> Result<(), StaticsError> {
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
    pub(super) fn check_balls(&self, here: &Evaluation) -> Result<(), StaticsError> {
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
    pub(super) fn falling_direction(&self, here: &Evaluation) -> Option<SVector<f64, 5>> {
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

    pub(super) fn solution(&self, here: Evaluation) -> StaticSolution {
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
