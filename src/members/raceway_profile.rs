//! Contacts of balls with raceways and balls that are not ideal: dents (3.20), spalls (5.4.3), waviness, balls of
//! different size.
//!
//! Each profile reduces the approach δ by Δ, and the reductions of all profiles at a contact add up. Without friction all
//! forces of such a contact are the gradient of its energy U = (2/5) K_H w^{5/2}, w = δ − Δ. Δ depends on the position
//! of the ball relative to the race (profiles of races) and on the orientation of the ball relative to the contact normal
//! (profiles of balls). Forces act through the ball's centre, moments are couples between ball and race, so that momentum
//! and energy are conserved. The contact is treated from here on as that of Hertz with the same energy: its overlap is w.
//!
//! Contact damping takes the rate of δ, not of w: it does not brake a ball that rolls up the wall of a spall.

use crate::ch2_housing::bearing::contact::{RaceContact, RaceLaw, normal_load, normal_stiffness};
use crate::ch2_housing::bearing::geometry::Raceway;
use crate::ch3_bushing::dent::{DentTable, Lost};
use crate::ch5_cage::raceway_profile::{RacewayProfile, Surface, Waviness};
use crate::ch5_cage::spall::SpallLaw;
use crate::kinematics::vec3::{Vec3, add_scaled, cross, dot, norm, scale, sub};
use crate::members::ball_set::BallSet;
use crate::members::bearing::Bearing;
use crate::members::contacts::{ContactTable, Set, Want};
use crate::members::dent_table::{DentError, DentedContact, usual_table};
use crate::members::rigid_body::BodyKinematics;
use crate::members::state::{Layout, ORIENTATION, POSITION, SPIN, VELOCITY};
use crate::plan::Stage;
use crate::plan::counts::Counts;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Law of one profile.
#[derive(Clone, Debug)]
pub enum ProfileLaw {
    Dent(Arc<DentTable>),
    Spall(SpallLaw),
    Waviness(Waviness),
}

/// A profile of a race.
#[derive(Clone, Debug)]
pub struct ProfileOnRace {
    pub law: ProfileLaw,
    /// 0 inner, 1 outer.
    side: usize,
    /// cos and sin of its angle around the race.
    turn: [f64; 2],
    /// Angle around the groove, rad.
    groove_angle: f64,
    /// Distance of the place from the race's axis, and radius of the groove, m.
    radius: f64,
    groove_radius: f64,
}

/// A profile of a ball.
#[derive(Clone, Debug)]
pub struct ProfileOnBall {
    law: ProfileLaw,
    ball: usize,
    /// Middle or pole in the ball's own axes, unit vector.
    direction: Vector3<f64>,
}

/// RacewayProfiles of a bearing, without vanishing ones.
#[derive(Clone, Debug, Default)]
pub struct RacewayProfiles {
    pub on_races: Vec<ProfileOnRace>,
    pub on_balls: Vec<ProfileOnBall>,
    /// Excess of each ball's radius, m; empty for equal balls.
    deviations: Vec<f64>,
    /// Counted tests of one evaluation.
    tests: u64,
}

/// A contact changed by a profile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProfiledPair {
    pub pair: usize,
    /// ∂U/∂δ, N, before damping.
    pub elastic: f64,
    /// ∂²U/∂δ², N/m, if slopes are requested; never negative.
    pub stiffness: f64,
    /// Force on the ball along the walls of profiles, N, inertial axes.
    pub aside: Vec3,
    /// Couple on the ball from profiles of the ball, N·m, inertial axes; zero for profiles of races.
    pub couple: Vec3,
}

/// Laws of the profiles of a bearing. Equal dents share a table.
///
/// # Errors
///
/// A dent without a converged contact.
pub fn profiles(bearing: &Bearing) -> Result<RacewayProfiles, DentError> {
    let geometry = &bearing.geometry;
    let (mut on_races, mut on_balls) = (Vec::new(), Vec::new());
    for profile in bearing.raceway_profiles.iter().filter(|profile| !profile.vanishes()) {
        let (law, on) = match profile {
            RacewayProfile::Dent(dent) => {
                let hertz =
                    if dent.side == 0 { &bearing.inner_contact } else { &bearing.outer_contact };
                let table = usual_table(&DentedContact::new(dent.shape, hertz))?;
                let (side, angle, groove_angle) = (dent.side, dent.angle, dent.groove_angle);
                (ProfileLaw::Dent(table), Surface::Race { side, angle, groove_angle })
            }
            RacewayProfile::Spall(spall) => {
                (ProfileLaw::Spall(SpallLaw::new(&spall.shape, geometry.ball_radius)), spall.on)
            }
            RacewayProfile::Waviness(wave) => (ProfileLaw::Waviness(*wave), wave.on),
        };
        match on {
            Surface::Race { side, angle, groove_angle } => {
                let (raceway, outward) = match side {
                    0 => (&geometry.inner, -1.0),
                    _ => (&geometry.outer, 1.0),
                };
                let (sin, cos) = libm::sincos(angle);
                let Raceway { centre_radius, groove_radius, .. } = *raceway;
                on_races.push(ProfileOnRace {
                    law,
                    side,
                    turn: [cos, sin],
                    groove_angle,
                    radius: centre_radius + outward * groove_radius * libm::cos(groove_angle),
                    groove_radius,
                });
            }
            Surface::Ball { ball, angle, groove_angle } => {
                let direction = Vector3::from(Surface::direction(angle, groove_angle));
                on_balls.push(ProfileOnBall { law, ball, direction });
            }
        }
    }
    let tests = bearing.profile_tests();
    let deviations =
        if bearing.has_equal_balls() { Vec::new() } else { bearing.ball_deviations.clone() };
    Ok(RacewayProfiles { on_races, on_balls, deviations, tests })
}

/// A ball relative to a race.
struct Observed {
    /// Direction from the race's axis to the ball along its own Y and Z, unit vector.
    across: [f64; 2],
    /// Angle around the groove from its bottom towards X, rad.
    groove_angle: f64,
}

impl ProfileOnRace {
    /// The table of a dent.
    pub fn dent_table(&self) -> Option<&DentTable> {
        match &self.law {
            ProfileLaw::Dent(table) => Some(table),
            ProfileLaw::Spall(_) | ProfileLaw::Waviness(_) => None,
        }
    }

    /// Position of a ball relative to the place along the rolling direction and across the groove, m; `None` on the
    /// other side of the race.
    fn place(&self, seen: &Observed) -> Option<[f64; 2]> {
        let ([y, z], [cos, sin]) = (seen.across, self.turn);
        let near = y * cos + z * sin;
        if near <= 0.0 {
            return None;
        }
        let along = self.radius * libm::atan2(z * cos - y * sin, near);
        let across = self.groove_radius * (seen.groove_angle - self.groove_angle);
        Some([along, across])
    }

    /// Loss of approach, and its derivatives by the approach and along arcs of `radius` and `groove_radius`.
    fn lost(&self, seen: &Observed, approach: f64) -> Option<Lost> {
        match &self.law {
            ProfileLaw::Dent(table) => table.lost(approach, self.place(seen)?),
            ProfileLaw::Spall(law) => law.lost(self.place(seen)?),
            ProfileLaw::Waviness(wave) => {
                let [y, z] = seen.across;
                let [value, slope] = wave.lost(libm::atan2(z, y));
                Some(Lost { value, along: slope / self.radius, ..Lost::default() })
            }
        }
    }
}

impl ProfileOnBall {
    /// Loss of approach at an angle ψ (rad) between middle and contact, and its slope, m/rad.
    fn lost(&self, angle: f64, ball_radius: f64) -> Option<[f64; 2]> {
        match &self.law {
            ProfileLaw::Dent(_) => None,
            ProfileLaw::Spall(law) => {
                law.along(ball_radius * angle).map(|[value, slope]| [value, slope * ball_radius])
            }
            ProfileLaw::Waviness(wave) => Some(wave.lost(angle)),
        }
    }
}

/// Sum of the profiles of a race at an approach, and the derivatives of its lengths by the ball's position.
fn sum_of(
    profiles: &[ProfileOnRace],
    side: usize,
    seen: &Observed,
    approach: f64,
    scales: [f64; 2],
) -> Option<Lost> {
    let mut sum: Option<Lost> = None;
    for profile in profiles.iter().filter(|profile| profile.side == side) {
        let Some(lost) = profile.lost(seen, approach) else { continue };
        let so_far = sum.get_or_insert_default();
        so_far.value += lost.value;
        so_far.by_approach += lost.by_approach;
        so_far.along += lost.along * profile.radius * scales[0];
        so_far.across += lost.across * profile.groove_radius * scales[1];
    }
    sum
}

/// RacewayProfiles of a ball at one contact.
#[derive(Clone, Copy, Default)]
struct LostOfBall {
    /// Loss of approach, m.
    value: f64,
    /// Σ (dΔ/dψ) e/sin ψ, m/rad, with e the direction of each middle: dΔ = −tilt · dn + n × tilt · dθ for a change of
    /// the normal n and a rotation dθ of the ball.
    tilt: Vec3,
}

fn sum_of_ball(
    profiles: &[ProfileOnBall],
    ball: usize,
    (layout, state): (&Layout, &[f64]),
    normal: Vec3,
    ball_radius: f64,
) -> Option<LostOfBall> {
    let mut sum: Option<LostOfBall> = None;
    for profile in profiles.iter().filter(|profile| profile.ball == ball) {
        let direction = inertial(layout, state, profile);
        let (sine, cosine) = (norm(cross(normal, direction)), dot(normal, direction));
        let Some([value, slope]) = profile.lost(libm::atan2(sine, cosine), ball_radius) else {
            continue;
        };
        let so_far = sum.get_or_insert_default();
        so_far.value += value;
        // In the middle of a profile the slope is zero.
        if sine > 0.0 {
            so_far.tilt = add_scaled(so_far.tilt, slope / sine, direction);
        }
    }
    sum
}

/// Middle of a ball's profile in inertial axes, unit vector.
fn inertial(layout: &Layout, state: &[f64], profile: &ProfileOnBall) -> Vec3 {
    let q = [0, 1, 2, 3].map(|i| state[layout.ball(ORIENTATION + i) + profile.ball]);
    // Stages of a step leave the unit sphere a little.
    let turn = UnitQuaternion::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3]));
    (turn * profile.direction).into()
}

/// Fraction of a profile's extent that a ball may move in a step: four steps and their stages resolve it.
const PART_OF_REACH: f64 = 0.5;
/// Fraction of a wave that a ball may pass in a step.
const PART_OF_WAVE: f64 = 0.125;

/// Largest rotation of a ball with a profile in a step, rad: error control does not watch orientations of balls. A step of
/// fourth order errs by 1e-7 rad.
const LARGEST_TURN: f64 = 0.2;

/// Longest step, s, in which every ball of `set` meets the profiles on its path, from the races as last evaluated.
///
/// Error control does not see what is between the stages: in smooth rolling steps grow until a ball passes a dent
/// within one.
pub(crate) fn longest_step(set: &BallSet, state: &[f64]) -> f64 {
    let mut longest = f64::INFINITY;
    for profile in &set.laws.raceway_profiles.on_races {
        let BodyKinematics { state: race, motion, .. } = &set.races[profile.side];
        let own: [Vec3; 2] =
            [(race.orientation * Vector3::y()).into(), (race.orientation * Vector3::z()).into()];
        let [cos, sin] = profile.turn;
        for ball in 0..set.layout.balls {
            let arm = sub(set.layout.ball_vector(state, POSITION, ball), race.position);
            let velocity = sub(set.layout.ball_vector(state, VELOCITY, ball), race.velocity);
            let [y, z] = own.map(|direction| dot(direction, arm));
            let orbit = dot(motion.axis, cross(arm, velocity)) / (y * y + z * z);
            let speed = profile.radius * (orbit - dot(motion.axis, race.spin)).abs();
            let away = profile.radius * libm::atan2(z * cos - y * sin, y * cos + z * sin).abs();
            let may_move = match &profile.law {
                // The contact's own length counts, at the highest pressure of the table.
                ProfileLaw::Dent(table) => {
                    let felt = table.reach + table.spread[0] * table.deepest;
                    (away - felt).max(0.0) + PART_OF_REACH * table.reach
                }
                ProfileLaw::Spall(law) => spall_room(law, away),
                ProfileLaw::Waviness(wave) => PART_OF_WAVE * TAU * profile.radius / wave.order,
            };
            longest = longest.min(may_move / speed);
        }
    }
    for profile in &set.laws.raceway_profiles.on_balls {
        let (radius, ball) = (set.laws.ball_radius, profile.ball);
        let direction = inertial(&set.layout, state, profile);
        let spin = set.layout.ball_vector(state, SPIN, ball);
        for (side, race) in set.races.iter().enumerate() {
            let contact = &set.table.contact[side * set.layout.padded + ball];
            let arm = sub(set.layout.ball_vector(state, POSITION, ball), race.state.position);
            let velocity = sub(set.layout.ball_vector(state, VELOCITY, ball), race.state.velocity);
            let axis = race.motion.axis;
            let across = add_scaled(arm, -dot(axis, arm), axis);
            // The contact moves on the ball with its spin relative to the orbit.
            let orbit = dot(axis, cross(arm, velocity)) / dot(across, across);
            let speed = radius * norm(add_scaled(spin, -orbit, axis));
            let (sine, cosine) =
                (norm(cross(contact.normal, direction)), dot(contact.normal, direction));
            let away = radius * libm::atan2(sine, cosine);
            let may_move = match &profile.law {
                ProfileLaw::Dent(_) => f64::INFINITY,
                ProfileLaw::Spall(law) => spall_room(law, away),
                ProfileLaw::Waviness(wave) => PART_OF_WAVE * TAU * radius / wave.order,
            };
            longest = longest.min(may_move.min(LARGEST_TURN * radius) / speed);
        }
    }
    longest
}

/// Distance that a contact may move in a step at a distance from the middle of a spall, m.
fn spall_room(law: &SpallLaw, away: f64) -> f64 {
    (away - law.half_length()).max(0.0) + PART_OF_REACH * law.half_length()
}

/// Relative difference of the approach for the stiffness.
const NEARBY: f64 = 1e-4;

/// Includes profiles in the contacts found.
pub(crate) fn apply(
    set: &Set,
    state: &[f64],
    want: Want,
    table: &mut ContactTable,
    ran: &mut Counts,
) {
    let Set { laws, layout, races, damping, .. } = *set;
    let RacewayProfiles { on_races, on_balls, deviations, tests } = &laws.raceway_profiles;
    table.profiled.clear();
    ran.add(Stage::RacewayProfiles, *tests);
    for (side, now) in races.into_iter().enumerate() {
        let race_is_ideal = on_races.iter().all(|profile| profile.side != side);
        if race_is_ideal && on_balls.is_empty() && deviations.is_empty() {
            continue;
        }
        let mut of_side = on_races.iter().filter(|profile| profile.side == side);
        let has_dents = of_side.any(|profile| profile.dent_table().is_some());
        let law = &laws.races[side];
        let orientation = now.state.orientation;
        let own: [Vec3; 2] =
            [(orientation * Vector3::y()).into(), (orientation * Vector3::z()).into()];
        let axis = now.motion.axis;
        for ball in 0..layout.balls {
            let pair = side * layout.padded + ball;
            let contact = table.contact[pair];
            let arm = sub(layout.ball_vector(state, POSITION, ball), now.motion.position);
            // Components of the normal towards X and towards the groove's bottom.
            let (sine, cosine) =
                (dot(contact.normal, axis), law.outward * dot(contact.normal, contact.outward));
            let seen = Observed {
                across: own.map(|direction| dot(direction, arm)),
                groove_angle: libm::atan2(sine, cosine),
            };
            let scales = [1.0 / dot(arm, contact.outward), 1.0 / (contact.overlap + law.room)];
            let at = |approach: f64| sum_of(on_races, side, &seen, approach, scales);
            let of_race = at(contact.overlap);
            let of_ball =
                sum_of_ball(on_balls, ball, (layout, state), contact.normal, laws.ball_radius);
            let deviation = deviations.get(ball).copied();
            if of_race.is_none() && of_ball.is_none() && deviation.is_none() {
                continue;
            }
            let (mut lost, of_ball) = (of_race.unwrap_or_default(), of_ball.unwrap_or_default());
            let curvature = if want == Want::ForcesAndSlopes && has_dents {
                let step = NEARBY * contact.overlap.abs();
                let by = |approach: f64| at(approach).map_or(0.0, |lost| lost.by_approach);
                (by(contact.overlap - step) - by(contact.overlap + step)) / (2.0 * step)
            } else {
                0.0
            };
            lost.value += of_ball.value - deviation.unwrap_or(0.0);
            let along = cross(axis, contact.outward);
            let across = add_scaled(scale(axis, cosine), -law.outward * sine, contact.outward);
            let mut profiled = profiled(law, pair, &contact, &lost, curvature, [along, across]);
            if of_ball.tilt != [0.0; 3] {
                // ∂n/∂x = t tᵀ (n·o)/radius + s sᵀ/distance.
                let load = normal_load(law.stiffness, contact.overlap - lost.value);
                let tilt = of_ball.tilt;
                let t = load * dot(along, tilt) * law.outward * cosine * scales[0];
                let s = load * dot(across, tilt) * scales[1];
                profiled.aside = add_scaled(add_scaled(profiled.aside, -t, along), -s, across);
                profiled.couple = scale(cross(contact.normal, tilt), load);
            }
            let share = 1.0 + damping * contact.closing_speed;
            table.load[pair] = profiled.elastic * if share < 0.0 { 0.0 } else { share };
            table.contact[pair].overlap -= lost.value;
            table.profiled.push(profiled);
        }
    }
}

/// The slopes of U = (2/5) K w^{5/2}, w = δ − Δ.
fn profiled(
    law: &RaceLaw,
    pair: usize,
    contact: &RaceContact,
    lost: &Lost,
    curvature: f64,
    [along, across]: [Vec3; 2],
) -> ProfiledPair {
    let held = contact.overlap - lost.value;
    let (load, slope) = (normal_load(law.stiffness, held), 1.0 - lost.by_approach);
    let stiffness = normal_stiffness(law.stiffness, held) * slope * slope + load * curvature;
    ProfiledPair {
        pair,
        elastic: load * slope,
        stiffness: stiffness.max(0.0),
        aside: add_scaled(scale(along, load * lost.along), load * lost.across, across),
        couple: [0.0; 3],
    }
}
