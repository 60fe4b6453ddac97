//! Checks of an equilibrium or a search: bodies or balls that leave their bearing, directions without stiffness.

use crate::ch2_housing::bearing::contact::normal_load;
use crate::equilibrium::lists::{Loaded, Place, StaticAssembly, StaticBearing};
use crate::equilibrium::model::{Evaluation, Five};
use crate::equilibrium::search::Search;
use crate::equilibrium::shaft::SectionPlace;
use crate::equilibrium::statics::{COORDINATE_NAMES, Determinacy, StaticsError};
use crate::members::static_ball::overlap_of_races;
use crate::solids::bore_equilibrium::BoreState;
use nalgebra::{DVector, SymmetricEigen, Vector3};

/// Stiffness below this fraction of the largest one counts as zero. Rounding of the overlaps gives about 1e-12; the
/// softest real direction, the swivel of a loaded ball, has about 1e-3.
const NO_STIFFNESS: f64 = 1e-9;
/// Largest displacement of a race in its bore, in radii, during the search and at the end: a bore moves by less than a
/// hundredth of its radius.
const LOST: f64 = 1e3;
pub(crate) const FAR: f64 = 1e-2;

/// Eigenvalues (N/m) and eigenvectors of a stiffness.
pub(crate) type Modes = Vec<(f64, DVector<f64>)>;

impl Search<'_, '_> {
    /// Checks that every ball has converged, within the range of a torus.
    pub(crate) fn check_balls(&self, here: &Evaluation) -> Result<(), StaticsError> {
        /// Newton's last step leaves 1e-11; a larger residual is not converged.
        const SETTLED: f64 = 1e-8;
        /// Load in parts of a ball's own force (weight, centrifugal) above which a ball is between the races. With less
        /// it hangs loose on the far side of a groove; a warning reports that.
        const PRESSED: f64 = 2.0;
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
                    Some(settled) => {
                        let [along, out] = plane.body_force(settled.position[1]);
                        let own = libm::hypot(along, out);
                        let sides = [
                            (settled.outer_load, &settled.outer, 1.0),
                            (settled.inner_load, &settled.inner, -1.0),
                        ];
                        for (load, contact, outward) in sides {
                            let [axial, radial] = contact.normal;
                            let held = load <= PRESSED * own || outward * radial >= 0.0;
                            if !held {
                                let angle = libm::atan2(axial, outward * radial);
                                let (ball, degrees) = (named(), angle.to_degrees());
                                let overlap = contact.overlap;
                                return Err(StaticsError::BallOutside { ball, overlap, degrees });
                            }
                        }
                    }
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

    pub(crate) fn give_up(
        &self,
        here: &Evaluation,
        residual: f64,
        allowed: f64,
    ) -> Result<(), StaticsError> {
        // Body with the largest residual.
        let worst = |first: usize| {
            (first..first + 5)
                .filter(|&i| self.free[i])
                .map(|i| (here.gradient[i] / self.model.scale[i]).abs())
                .fold(0.0, f64::max)
        };
        let bodies = self.model.loaded().map(|(body, first, _)| (body, first));
        let (body, at) =
            bodies.max_by(|a, b| worst(a.1).total_cmp(&worst(b.1))).unwrap_or_default();
        Err(StaticsError::NotConverged {
            body: self.model.assembly.bodies[body].name.clone(),
            iterations: self.iterations,
            residual,
            allowed,
            position: [here.at[at], here.at[at + 1], here.at[at + 2]],
            tilts: [here.at[at + 3], here.at[at + 4]],
        })
    }

    pub(crate) fn check_travel(&self, here: &Evaluation) -> Result<(), StaticsError> {
        self.check_seats(here, LOST)?;
        for (index, first, body) in self.model.loaded() {
            if self.model.seat_of(index).is_some() {
                continue;
            }
            let from =
                Five::from(body.start.unwrap_or([0.0; 5])) + self.partner_displacement(index, here);
            for i in (0..5).filter(|&i| self.free[first + i]) {
                let travel = (here.at[first + i] - from[i]) * self.model.scale[first + i];
                // NaN must fail.
                let near = travel.abs() <= body.room;
                if !near && !self.is_held_near(index, i, &from, here) {
                    let body = &self.model.assembly.bodies[index];
                    return Err(StaticsError::NoEquilibrium {
                        body: body.name.clone(),
                        coordinate: COORDINATE_NAMES[i],
                        travel,
                        room: match &body.place {
                            Place::Loaded(loaded) => loaded.room,
                            Place::Fixed(_) | Place::Section(_) => 0.0,
                        },
                    });
                }
            }
        }
        Ok(())
    }

    /// Returns whether an attachment of a flexible body is within the body's limits of its position on a straight
    /// shaft, along coordinate `i`: the body's centre moves as far as the shaft bends.
    fn is_held_near(&self, body: usize, i: usize, from: &Five, here: &Evaluation) -> bool {
        let StaticAssembly { bodies, bearings, connections, shafts, .. } = self.model.assembly;
        let Place::Loaded(Loaded { room, .. }) = &bodies[body].place else { return false };
        let takes_hold = |section: usize| {
            let mounts = bearings.iter().flat_map(|bearing| &bearing.mounts);
            let ends = connections.iter().flat_map(|connection| &connection.ends);
            mounts.chain(ends).any(|mount| mount.body == section)
        };
        let sections = bodies.iter().enumerate().filter(|(index, _)| takes_hold(*index));
        i < 3
            && sections
                .filter_map(|(index, place)| match &place.place {
                    Place::Section(of) if shafts[of.shaft].body == body => {
                        Some((of, self.model.unknowns[index]?))
                    }
                    _ => None,
                })
                .any(|(of, first)| {
                    let straight = vec![0.0; shafts[of.shaft].springs.len()];
                    let before = SectionPlace::new(of, from, &straight).coordinates[i];
                    (here.at[first + i] - before).abs() <= *room
                })
    }

    /// Checks that every race is within a fraction of its radius of its position in its bore.
    ///
    /// # Errors
    ///
    /// A race without support; a housing that moves away.
    pub(crate) fn check_seats(&self, here: &Evaluation, part: f64) -> Result<(), StaticsError> {
        for (index, seat) in self.model.assembly.seats.iter().enumerate() {
            let place = self.model.seat_place(index, &here.at);
            let (pose, radius) = (place.pose, seat.fit.radius);
            // Angles of an axis are periodic.
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

    /// State of each race in its bore.
    ///
    /// # Errors
    ///
    /// Contact that does not converge; a race outside the range for which its bore was condensed.
    pub(crate) fn seat_states(
        &mut self,
        here: &Evaluation,
    ) -> Result<Vec<BoreState>, StaticsError> {
        let mut states = Vec::with_capacity(self.bores.len());
        for (index, seat) in self.model.assembly.seats.iter().enumerate() {
            let pose = self.model.seat_place(index, &here.at).pose;
            let bore = &mut self.bores[index];
            // State of the last evaluation, unless that was a rejected step.
            let state =
                if bore.pose() == pose { bore.state() } else { bore.at_pose(&seat.fit, pose) };
            states.push(state.map_err(|source| StaticsError::Seat { of: seat.suffix(), source })?);
        }
        Ok(states)
    }

    /// The body itself, or that of a section.
    fn whole(&self, body: usize) -> usize {
        match &self.model.assembly.bodies[body].place {
            Place::Section(of) => self.model.assembly.shafts[of.shaft].body,
            Place::Fixed(_) | Place::Loaded(_) => body,
        }
    }

    /// Displacement of the body under a body's first outer race, which moves the inner race along; of a fixed one,
    /// zero.
    fn partner_displacement(&self, body: usize, here: &Evaluation) -> Five {
        let on_it = |bearing: &&StaticBearing| self.whole(bearing.mounts[0].body) == body;
        let bearing = self.model.assembly.bearings.iter().find(on_it);
        let under = bearing.map(|bearing| self.whole(bearing.mounts[1].body));
        let is_race = bearing.is_some_and(|bearing| bearing.mounts[0].body == body);
        if let Some(under) = under.filter(|_| is_race)
            && let Place::Loaded(of) = &self.model.assembly.bodies[body].place
            && of.start.is_none()
            && let Place::Fixed(pose) = &self.model.assembly.bodies[under].place
        {
            let [x, y, z] = of.axes().point_to_body(&pose.position).into();
            return Five::from([x, y, z, 0.0, 0.0]);
        }
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

    /// Unknown coordinates of bodies outside bores: a race may be loose in its bore, and the determinacy of other
    /// bodies is relative to it.
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
    fn modes_over(&self, here: &Evaluation, free: &[bool]) -> Modes {
        if free.is_empty() {
            return Vec::new();
        }
        let mut stiffness = self.scaled(here).stiffness;
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

    /// Eigenvalues and eigenvectors of the scaled stiffness over all free coordinates.
    pub(crate) fn modes(&self, here: &Evaluation) -> Modes {
        self.modes_over(here, &self.free)
    }

    /// A small displacement along the most negative stiffness, if there is one.
    pub(crate) fn falling_direction(&self, modes: &Modes) -> Option<DVector<f64>> {
        let largest = modes.iter().map(|mode| mode.0.abs()).fold(0.0, f64::max);
        let (value, vector) = modes.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        if *value >= -NO_STIFFNESS * largest {
            return None;
        }
        let length = 0.1 * self.step_scale();
        Some((vector * length).component_div(&self.model.scale))
    }

    /// Returns whether the position is unstable.
    pub(crate) fn is_falling(&self, here: &Evaluation) -> bool {
        self.falling_direction(&self.modes(here)).is_some()
    }

    /// Determinacy of the position; `modes` are those of `here`.
    pub(crate) fn determinacy(&self, here: &Evaluation, mut modes: Modes) -> Determinacy {
        if !self.model.assembly.seats.is_empty() {
            modes = self.modes_over(here, &self.free_but_for_seats());
        }
        // The scale is that of the whole bearing, so that a single free coordinate is judged too.
        let scaled_diagonal = here.stiffest;
        // An overlap of some ulps of the radius is no contact, without stiffness.
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
