//! Springs between bodies in an equilibrium: dashpots push nothing, Maxwell elements have relaxed.

use super::dynamics::connection::Connection;
use super::dynamics::race;
use super::static_model::{Evaluation, Five, Model};
use crate::kinematics::vec3::{Vec3, add, cross, sub};
use nalgebra::Vector3;

/// Energy, force and stiffness of springs between two bodies.
pub(super) fn add_connection(model: &Model, connection: &Connection, here: &mut Evaluation) {
    let bodies = connection.ends.map(|mount| {
        let race = match model.axes(mount.body) {
            None => race::fixed(&model.coordinates(mount.body, &here.at).into()),
            Some(_) => race::standing(&model.pose(mount.body, &here.at)),
        };
        (race, model.tilt_axes(mount.body, &here.at), model.axes(mount.body))
    });
    let ends = [0, 1].map(|end| race::mounted(&bodies[end].0, &connection.ends[end]));
    let ends = [&ends[0], &ends[1]];
    let pull = connection.pull(ends, &[]);
    here.energy += pull.energy;
    // Of a force at a section along its body's coordinates.
    let conjugate = |end: usize, force: Vec3, moment: Vec3| {
        let (body, [e2, e3], axes) = &bodies[end];
        let arm = sub(ends[end].motion.position, body.motion.position);
        let moment = Vector3::from(add(moment, cross(arm, force)));
        let force = Vector3::from(force);
        let force = axes.map_or(force, |a| a.orientation.inverse_transform_vector(&force));
        Five::from([force[0], force[1], force[2], moment.dot(e2), moment.dot(e3)])
    };
    let firsts = connection.ends.map(|mount| model.unknowns[mount.body]);
    for end in 0..2 {
        let Some(first) = firsts[end] else { continue };
        let loads = &pull.on[end];
        let mut rows = here.gradient.fixed_rows_mut::<5>(first);
        rows -= conjugate(end, loads.force, loads.moment);
    }
    for row in connection.rows(ends).iter().filter(|row| row.stiffness != 0.0) {
        let levers = [0, 1].map(|end| conjugate(end, row.on[end][0], row.on[end][1]));
        for (a, one) in firsts.into_iter().enumerate() {
            for (b, other) in firsts.into_iter().enumerate() {
                let (Some(one), Some(other)) = (one, other) else { continue };
                let mut block = here.stiffness.fixed_view_mut::<5, 5>(one, other);
                block += levers[a] * levers[b].transpose() * row.stiffness;
            }
        }
    }
}
