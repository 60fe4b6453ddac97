//! Contacts of balls with dented races: the law of (3.20) for a ball near a dent.
//!
//! Without friction all forces of such a contact are the gradient of its energy U(δ, s, y): the normal force, and a
//! tangential force of the dent's wall. Both act through the ball's centre, and U depends on its position relative to
//! the race, so that momentum and energy are conserved. The contact is treated from here on as that of Hertz with the
//! same energy: its overlap is w = δ − Δ.

use crate::assembly::lists::Bearing;
use crate::assembly::plan::Stage;
use crate::assembly::plan::counts::Counts;
use crate::assembly::state::{POSITION, VELOCITY};
use crate::ch2_housing::bearing::contact::{RaceContact, RaceLaw, normal_load, normal_stiffness};
use crate::ch2_housing::bearing::geometry::Raceway;
use crate::ch3_bushing::dent::{Dent, DentTable, Lost};
use crate::kinematics::vec3::{Vec3, add_scaled, cross, dot, scale, sub};
use crate::members::ball_set::BallSet;
use crate::members::contacts::{ContactTable, Set, Want};
use crate::members::dent_table::{DentError, DentedContact, usual_table};
use crate::members::rigid_body::BodyKinematics;
use nalgebra::Vector3;
use std::sync::Arc;

/// A dent with its law.
#[derive(Clone, Debug)]
pub struct DentOnRace {
    pub dent: Dent,
    pub table: Arc<DentTable>,
    /// cos and sin of its angle around the race.
    turn: [f64; 2],
    /// Distance of the dent from the race's axis, and radius of the groove, m.
    radius: f64,
    groove_radius: f64,
}

/// A contact changed by a dent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DentedPair {
    pub pair: usize,
    /// ∂U/∂δ, N, before damping.
    pub elastic: f64,
    /// ∂²U/∂δ², N/m, if slopes are requested; never negative.
    pub stiffness: f64,
    /// Tangential force on the ball, N, inertial axes.
    pub aside: Vec3,
}

/// Laws of the dents of a bearing, without vanishing ones. Equal dents share a table.
///
/// # Errors
///
/// A dent without a converged contact.
pub fn dents(bearing: &Bearing) -> Result<Vec<DentOnRace>, DentError> {
    let real = bearing.dents.iter().filter(|dent| !dent.shape.vanishes());
    real.map(|dent| {
        let geometry = &bearing.geometry;
        let (raceway, hertz, outward) = match dent.side {
            0 => (&geometry.inner, &bearing.inner_contact, -1.0),
            _ => (&geometry.outer, &bearing.outer_contact, 1.0),
        };
        let table = usual_table(&DentedContact::new(dent.shape, hertz))?;
        Ok(DentOnRace::new(*dent, table, raceway, outward))
    })
    .collect()
}

impl DentOnRace {
    fn new(dent: Dent, table: Arc<DentTable>, raceway: &Raceway, outward: f64) -> DentOnRace {
        let (sin, cos) = libm::sincos(dent.angle);
        let Raceway { centre_radius, groove_radius, .. } = *raceway;
        DentOnRace {
            radius: centre_radius + outward * groove_radius * libm::cos(dent.groove_angle),
            groove_radius,
            turn: [cos, sin],
            dent,
            table,
        }
    }
}

/// A ball relative to a race.
struct Observed {
    /// Direction from the race's axis to the ball along its own Y and Z, unit vector.
    across: [f64; 2],
    /// Angle around the groove from its bottom towards X, rad.
    groove_angle: f64,
}

impl Observed {
    /// Position relative to a dent along the rolling direction and across the groove, m; `None` on the other side of
    /// the race.
    fn from(&self, dent: &DentOnRace) -> Option<[f64; 2]> {
        let ([y, z], [cos, sin]) = (self.across, dent.turn);
        let near = y * cos + z * sin;
        if near <= 0.0 {
            return None;
        }
        let along = dent.radius * libm::atan2(z * cos - y * sin, near);
        let across = dent.groove_radius * (self.groove_angle - dent.dent.groove_angle);
        Some([along, across])
    }
}

/// Sum of the dents at an approach, and the derivatives of its lengths by the ball's position.
fn sum_of(
    dents: &[DentOnRace],
    side: usize,
    seen: &Observed,
    approach: f64,
    scales: [f64; 2],
) -> Option<Lost> {
    let mut sum: Option<Lost> = None;
    for dent in dents.iter().filter(|dent| dent.dent.side == side) {
        let Some(place) = seen.from(dent) else { continue };
        let Some(lost) = dent.table.lost(approach, place) else { continue };
        let so_far = sum.get_or_insert_default();
        so_far.value += lost.value;
        so_far.by_approach += lost.by_approach;
        so_far.along += lost.along * dent.radius * scales[0];
        so_far.across += lost.across * dent.groove_radius * scales[1];
    }
    sum
}

/// Fraction of a dent's extent that a ball may move in a step: four steps and their stages resolve the dent.
const PART_OF_REACH: f64 = 0.5;

/// Longest step, s, in which every ball of `set` meets the dents on its path, from the races as last evaluated.
///
/// Error control does not see what is between the stages: in smooth rolling steps grow until a ball passes a dent
/// within one.
pub(crate) fn longest_step(set: &BallSet, state: &[f64]) -> f64 {
    let mut longest = f64::INFINITY;
    for dent in &set.laws.dents {
        let BodyKinematics { state: race, motion, .. } = &set.races[dent.dent.side];
        let own: [Vec3; 2] =
            [(race.orientation * Vector3::y()).into(), (race.orientation * Vector3::z()).into()];
        let [cos, sin] = dent.turn;
        for ball in 0..set.layout.balls {
            let arm = sub(set.layout.ball_vector(state, POSITION, ball), race.position);
            let velocity = sub(set.layout.ball_vector(state, VELOCITY, ball), race.velocity);
            let [y, z] = own.map(|direction| dot(direction, arm));
            let orbit = dot(motion.axis, cross(arm, velocity)) / (y * y + z * z);
            let speed = dent.radius * (orbit - dot(motion.axis, race.spin)).abs();
            let away = dent.radius * libm::atan2(z * cos - y * sin, y * cos + z * sin).abs();
            // The contact's own length counts, at the highest pressure of the table.
            let felt = dent.table.reach + dent.table.spread[0] * dent.table.deepest;
            let free = (away - felt).max(0.0);
            longest = longest.min((free + PART_OF_REACH * dent.table.reach) / speed);
        }
    }
    longest
}

/// Relative difference of the approach for the stiffness.
const NEARBY: f64 = 1e-4;

/// Includes dents in the contacts found.
pub(crate) fn apply(
    set: &Set,
    state: &[f64],
    want: Want,
    table: &mut ContactTable,
    ran: &mut Counts,
) {
    let Set { laws, layout, races, damping, .. } = *set;
    let dents = &laws.dents[..];
    table.dented.clear();
    ran.add(Stage::Dents, (dents.len() * layout.balls) as u64);
    for (side, now) in races.into_iter().enumerate() {
        if dents.iter().all(|dent| dent.dent.side != side) {
            continue;
        }
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
            let at = |approach: f64| sum_of(dents, side, &seen, approach, scales);
            let Some(lost) = at(contact.overlap) else { continue };
            let curvature = if want == Want::ForcesAndSlopes {
                let step = NEARBY * contact.overlap.abs();
                let by = |approach: f64| at(approach).map_or(0.0, |lost| lost.by_approach);
                (by(contact.overlap - step) - by(contact.overlap + step)) / (2.0 * step)
            } else {
                0.0
            };
            let along = cross(axis, contact.outward);
            let across = add_scaled(scale(axis, cosine), -law.outward * sine, contact.outward);
            let directions = [along, across];
            let dented = dented(law, pair, &contact, &lost, curvature, directions);
            let share = 1.0 + damping * contact.closing_speed;
            table.load[pair] = dented.elastic * if share < 0.0 { 0.0 } else { share };
            table.contact[pair].overlap -= lost.value;
            table.dented.push(dented);
        }
    }
}

/// The slopes of U = (2/5) K w^{5/2}, w = δ − Δ.
fn dented(
    law: &RaceLaw,
    pair: usize,
    contact: &RaceContact,
    lost: &Lost,
    curvature: f64,
    [along, across]: [Vec3; 2],
) -> DentedPair {
    let held = contact.overlap - lost.value;
    let (load, slope) = (normal_load(law.stiffness, held), 1.0 - lost.by_approach);
    let stiffness = normal_stiffness(law.stiffness, held) * slope * slope + load * curvature;
    DentedPair {
        pair,
        elastic: load * slope,
        stiffness: stiffness.max(0.0),
        aside: add_scaled(scale(along, load * lost.along), load * lost.across, across),
    }
}
