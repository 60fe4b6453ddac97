//! Springs between bodies in an equilibrium: dashpots have no force, Maxwell elements are relaxed.

use crate::equilibrium::model::{Evaluation, Five, Model};
use crate::kinematics::Pose;
use crate::kinematics::vec3::{Vec3, add, cross, dot, sub};
use crate::members::connection::{Connection, Row};
use crate::members::rigid_body;
use crate::members::rigid_body::BodyKinematics;
use nalgebra::{DMatrix, Vector3};

/// A body, its tilt axes, and the axes of its coordinates.
type End<'m> = (BodyKinematics, [Vector3<f64>; 2], Option<&'m Pose>);

/// The two ends of a connection.
struct Joined<'m> {
    bodies: [End<'m>; 2],
    ends: [BodyKinematics; 2],
    firsts: [Option<usize>; 2],
}

impl<'m> Joined<'m> {
    fn new(model: &'m Model, connection: &Connection, here: &Evaluation) -> Joined<'m> {
        let bodies = connection.ends.map(|mount| {
            let race = match model.axes(mount.body) {
                None => rigid_body::fixed(&model.coordinates(mount.body, &here.at).into()),
                Some(_) => rigid_body::kinematics_at_rest(&model.pose(mount.body, &here.at)),
            };
            (race, model.tilt_axes(mount.body, &here.at), model.axes(mount.body))
        });
        let ends = [0, 1]
            .map(|end| rigid_body::kinematics_at_mount(&bodies[end].0, &connection.ends[end]));
        let firsts = connection.ends.map(|mount| model.unknowns[mount.body]);
        Joined { bodies, ends, firsts }
    }

    /// Components of a wrench at a section along its body's coordinates.
    fn conjugate(&self, end: usize, force: Vec3, moment: Vec3) -> Five {
        let (body, [e2, e3], axes) = &self.bodies[end];
        let arm = sub(self.ends[end].motion.position, body.motion.position);
        let moment = Vector3::from(add(moment, cross(arm, force)));
        let force = Vector3::from(force);
        let force = axes.map_or(force, |a| a.orientation.inverse_transform_vector(&force));
        Five::from([force[0], force[1], force[2], moment.dot(e2), moment.dot(e3)])
    }

    /// Adds the product of each row with itself, times `size`.
    fn add_rows(&self, rows: &[Row], size: impl Fn(&Row) -> f64, to: &mut DMatrix<f64>) {
        for row in rows.iter().filter(|row| size(row) != 0.0) {
            self.add_product([row, row], size(row), to);
        }
    }

    /// Adds the coefficients of y by z and of z by y.
    fn add_cross(&self, rows: &[Row], [yz, zy]: [f64; 2], to: &mut DMatrix<f64>) {
        self.add_product([&rows[1], &rows[2]], yz, to);
        self.add_product([&rows[2], &rows[1]], zy, to);
    }

    /// Adds the product of two rows, times `size`.
    fn add_product(&self, rows: [&Row; 2], size: f64, to: &mut DMatrix<f64>) {
        let levers =
            rows.map(|row| [0, 1].map(|end| self.conjugate(end, row.on[end][0], row.on[end][1])));
        for (a, one) in self.firsts.into_iter().enumerate() {
            for (b, other) in self.firsts.into_iter().enumerate() {
                let (Some(one), Some(other)) = (one, other) else { continue };
                let mut block = to.fixed_view_mut::<5, 5>(one, other);
                block += levers[0][a] * levers[1][b].transpose() * size;
            }
        }
    }
}

/// Energy, force and stiffness of springs between two bodies.
pub(crate) fn add_connection(model: &Model, connection: &Connection, here: &mut Evaluation) {
    let joined = Joined::new(model, connection, here);
    let ends = [&joined.ends[0], &joined.ends[1]];
    let forces = connection.forces(ends, &[]);
    here.energy += forces.energy;
    for end in 0..2 {
        let Some(first) = joined.firsts[end] else { continue };
        let loads = &forces.on[end];
        let mut rows = here.gradient.fixed_rows_mut::<5>(first);
        rows -= joined.conjugate(end, loads.force, loads.moment);
    }
    let rows = connection.rows(ends);
    joined.add_rows(&rows, |row| row.stiffness, &mut here.stiffness);
    if let Some(cross) = connection.cross() {
        joined.add_cross(&rows, cross.stiffness, &mut here.stiffness);
    }
}

/// Adds the circulatory part of its cross-coupled stiffness, and none of the rest.
pub(crate) fn add_circulatory(model: &Model, connection: &Connection, here: &mut Evaluation) {
    if let Some(cross) = connection.cross() {
        let joined = Joined::new(model, connection, here);
        let rows = connection.rows([&joined.ends[0], &joined.ends[1]]);
        let [_, odd] = cross.parts();
        joined.add_cross(&rows, [odd, -odd], &mut here.stiffness);
    }
}

/// Adds the circulation of its dashpots that rotate with the first body, of spin `spin` (per rad/s of the reference
/// speed), to the stiffness: a fixed position q moves by −Ω × q in their axes, −c (q̇ − Ω × q). They are equal along Y
/// and Z.
pub(crate) fn add_circulation(
    model: &Model,
    connection: &Connection,
    spin: f64,
    here: &mut Evaluation,
) {
    let joined = Joined::new(model, connection, here);
    let rows = connection.rows([&joined.ends[0], &joined.ends[1]]);
    let spin = spin_of(model, connection, spin, here);
    for [y, z] in [[&rows[1], &rows[2]], [&rows[4], &rows[5]]] {
        joined.add_product([y, z], spin * y.damping, &mut here.stiffness);
        joined.add_product([z, y], -spin * y.damping, &mut here.stiffness);
    }
}

/// Displacements of the ends along its six directions per unit of each coordinate; those of sections follow the
/// unknowns.
pub(crate) fn levers(model: &Model, connection: &Connection, here: &Evaluation) -> DMatrix<f64> {
    let joined = Joined::new(model, connection, here);
    let rows = connection.rows([&joined.ends[0], &joined.ends[1]]);
    let mut levers = DMatrix::zeros(rows.len(), model.coordinates);
    for (i, row) in rows.iter().enumerate() {
        for (end, first) in joined.firsts.into_iter().enumerate() {
            let Some(first) = first else { continue };
            let own = joined.conjugate(end, row.on[end][0], row.on[end][1]);
            let mut part = levers.fixed_view_mut::<1, 5>(i, first);
            part += own.transpose();
        }
    }
    levers
}

/// Spin of its first end's axes for the spin `spin` of the body: a reversed end has the opposite X.
pub(crate) fn spin_of(model: &Model, connection: &Connection, spin: f64, here: &Evaluation) -> f64 {
    let joined = Joined::new(model, connection, here);
    spin * dot(joined.ends[0].motion.axis, joined.bodies[0].0.motion.axis)
}

/// Adds its damping to the stiffness.
pub(crate) fn add_damping(model: &Model, connection: &Connection, here: &mut Evaluation) {
    let joined = Joined::new(model, connection, here);
    let rows = connection.rows([&joined.ends[0], &joined.ends[1]]);
    joined.add_rows(&rows, |row| row.damping, &mut here.stiffness);
    if let Some(cross) = connection.cross() {
        joined.add_cross(&rows, cross.damping, &mut here.stiffness);
    }
}
