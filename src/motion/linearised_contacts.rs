//! Contacts of a block of balls with races and pockets as springs, dashpots and slopes of friction.

use crate::ch2_housing::bearing::cage::{CageContact, CageContacts};
use crate::ch2_housing::bearing::contact::{normal_load, normal_stiffness};
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, norm, scale, sub};
use crate::members::ball_set::BallSet;
use crate::members::bearing::Caged;
use crate::members::state::{LANES, POSITION};
use crate::motion::linearised::{Hub, LaneContact, ROWS, driven, joined, on_hub, put};

pub(crate) fn race_contacts(
    set: &BallSet,
    state: &[f64],
    side: usize,
    first: usize,
    (hub, hub_centre): (Option<&Hub>, Vec3),
    to: &mut LaneContact,
) {
    let BallSet { layout, laws, table, .. } = set;
    let race = &set.races[side];
    let law = &laws.races[side];
    // Levers are about the hub's centre, which may be at another position along the shaft than the race.
    let off = sub(race.motion.position, hub_centre);
    to.shifts = hub.filter(|_| off != [0.0; 3]).map(|hub| hub.basis.map(|axis| cross(axis, off)));
    to.rows = 0;
    let rows = if laws.traction == TractionLaw::None { 1 } else { ROWS };
    for lane in 0..LANES {
        let ball = first + lane;
        let pair = side * layout.padded + ball;
        if ball >= layout.balls || table.load[pair] <= 0.0 {
            // No restoring force: the levers are irrelevant.
            to.stiffness[lane] = 0.0;
            to.damping[lane] = 0.0;
            for slope in &mut to.slope {
                slope[lane] = 0.0;
            }
            continue;
        }
        to.rows = rows;
        let contact = &table.contact[pair];
        let motion = &race.motion;
        let normal = contact.normal;
        let (elastic, stiffness) = match table.profiled(pair) {
            Some(profiled) => (profiled.elastic, profiled.stiffness),
            None => (
                normal_load(law.stiffness, contact.overlap),
                normal_stiffness(law.stiffness, contact.overlap),
            ),
        };
        // K δ^{3/2} (1 + c δ̇).
        let share = table.load[pair] / elastic;
        to.stiffness[lane] = share * stiffness;
        to.damping[lane] = elastic * set.damping;
        let between = sub(layout.ball_vector(state, POSITION, ball), motion.position);
        put(&mut to.on_ball[0], lane, joined(normal, [0.0; 3]));
        if let Some(hub) = hub {
            let (linear, turning) =
                (scale(normal, -1.0), cross(normal, from_hub(to, between, off)));
            put(&mut to.on_hub[0], lane, on_hub(hub, linear, turning));
            to.driven[0][lane] = driven(hub, linear, turning);
        }
        if rows == 1 {
            continue;
        }
        let load = table.load[pair];
        for (slope, value) in to.slope.iter_mut().zip(table.slope[pair]) {
            slope[lane] = load * value;
        }
        let here = &table.sliding[pair];
        let traction = &table.traction[pair];
        let (along, across) = (here.rolling_direction, here.transverse_direction);
        to.per_load[0][lane] = dot(traction.force, along) / load;
        to.per_load[1][lane] = dot(traction.force, across) / load;
        to.per_load[2][lane] = dot(traction.moment, normal) / load;
        // As the ball moves by u, n turns by t (t·u) per_radius + s (s·u) per_distance.
        let per_distance = 1.0 / (contact.overlap + law.room);
        let per_radius = dot(normal, contact.outward) / dot(between, contact.outward);
        let reach = laws.ball_radius - 0.5 * contact.overlap;
        let [about_t, about_s, about_n] = here.relative_spin;
        let slip_change = [
            sub(
                add_scaled(scale(normal, -0.5 * about_s), -reach * per_distance * about_n, across),
                cross(along, motion.spin),
            ),
            sub(
                add_scaled(scale(normal, 0.5 * about_t), reach * per_radius * about_n, along),
                cross(across, motion.spin),
            ),
            add_scaled(scale(along, about_t * per_radius), about_s * per_distance, across),
        ];
        for (row, values) in to.slip_change.iter_mut().zip(slip_change) {
            for (to, value) in row.iter_mut().zip(values) {
                to[lane] = value;
            }
        }
        for (row, direction) in [(1, here.rolling_direction), (2, here.transverse_direction)] {
            put(&mut to.on_ball[row], lane, joined(direction, cross(here.arm_on_ball, direction)));
            if let Some(hub) = hub {
                let (linear, turning) =
                    (scale(direction, -1.0), cross(direction, from_hub(to, here.arm_on_race, off)));
                put(&mut to.on_hub[row], lane, on_hub(hub, linear, turning));
                to.driven[row][lane] = driven(hub, linear, turning);
            }
        }
        put(&mut to.on_ball[3], lane, joined([0.0; 3], normal));
        if let Some(hub) = hub {
            put(&mut to.on_hub[3], lane, on_hub(hub, [0.0; 3], scale(normal, -1.0)));
            to.driven[3][lane] = driven(hub, [0.0; 3], scale(normal, -1.0));
        }
    }
}

/// An arm from a race's centre as one from its hub's centre.
pub(crate) fn from_hub(contact: &LaneContact, arm: Vec3, off: Vec3) -> Vec3 {
    if contact.shifts.is_some() { add(arm, off) } else { arm }
}

/// Contact force, direction of sliding, direction across it; slopes of the friction along the latter two.
pub(crate) fn friction(contact: &CageContact, law: &CageContacts) -> ([Vec3; 3], [f64; 2]) {
    let push = contact.push;
    let speed = norm(contact.slip);
    let along = if speed > 0.0 {
        scale(contact.slip, 1.0 / speed)
    } else {
        // Nothing slides: any direction across the contact force.
        let aside = if push[0] * push[0] < 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let across = cross(push, aside);
        scale(across, 1.0 / norm(across))
    };
    let u0 = law.regularisation_speed;
    let square = speed * speed + u0 * u0;
    let secant = law.friction * contact.normal_load / square.sqrt();
    ([push, along, cross(push, along)], [secant * u0 * u0 / square, secant])
}

pub(crate) fn pockets(
    set: &BallSet,
    caged: &Caged,
    state: &[f64],
    first: usize,
    hub: &Hub,
    to: &mut LaneContact,
) {
    let BallSet { layout, pockets, cage: Some(cage), .. } = set else { return };
    to.rows = 0;
    for lane in 0..LANES {
        let ball = first + lane;
        let contact = pockets.get(ball).filter(|contact| contact.normal_load > 0.0);
        let Some(contact) = contact else {
            to.stiffness[lane] = 0.0;
            for slope in &mut to.slope {
                slope[lane] = 0.0;
            }
            continue;
        };
        to.rows = 3;
        let (directions, slope) = friction(contact, &caged.contacts);
        to.stiffness[lane] = caged.stiffness(contact);
        to.slope[0][lane] = slope[0];
        to.slope[3][lane] = slope[1];
        let arm_on_ball = sub(contact.point, layout.ball_vector(state, POSITION, ball));
        let arm_on_cage = sub(contact.point, cage.motion.position);
        for (row, direction) in directions.into_iter().enumerate() {
            put(&mut to.on_ball[row], lane, joined(direction, cross(arm_on_ball, direction)));
            let turning = cross(direction, arm_on_cage);
            put(&mut to.on_hub[row], lane, on_hub(hub, scale(direction, -1.0), turning));
        }
    }
}
