//! A bearing in the equilibrium search: energy, load and stiffness over the coordinates of both bodies, with its balls
//! eliminated.
//!
//! The energy of the contacts depends on the inner race relative to the outer one. So the load and stiffness of the
//! outer race follow from those of the inner one: a common motion changes nothing. Only the weight of the balls does
//! not rotate with the outer race; its part in the stiffness is omitted, which costs an iteration. The cage forces that
//! keep balls at their azimuths sum to a force on the outer race without an energy.

use crate::equilibrium::lists::StaticBearing;
use crate::equilibrium::model::{BearingModel, Evaluation, Five, Model};
use crate::kinematics::Pose;
use crate::members::mount::Mount;
use crate::members::race_position::InnerRacePosition;
use crate::members::static_ball::{BallPlane, settle};
use crate::members::static_ball_on_race::add_to_race;
use crate::plan::Stage;
use crate::plan::counts::Counts;
use nalgebra::{Matrix3, Matrix3x5, SMatrix, UnitQuaternion, Vector3};

type Block = SMatrix<f64, 5, 5>;

/// Planes of all balls of a bearing whose outer race is on a body at `outer`, from `origin`.
pub(crate) fn planes(
    bearing: &StaticBearing,
    of: &BearingModel,
    outer: &Pose,
    to: &mut Vec<BallPlane>,
) {
    to.clear();
    let mount = &bearing.mounts[1];
    let mut outer = *outer;
    if mount.along != 0.0 {
        outer.position += outer.orientation * Vector3::x() * mount.along;
    }
    outer.position -= of.origin;
    if mount.reversed {
        outer.orientation *=
            UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(0.0, 0.0, 0.0, 1.0));
    }
    let weight_of = &of.weight;
    let axial = outer.orientation * Vector3::x();
    to.extend(of.azimuths.iter().map(|azimuth| {
        let (sin, cos) = libm::sincos(*azimuth);
        let radial = outer.orientation * Vector3::new(0.0, cos, sin);
        let weight = [weight_of.dot(&axial), weight_of.dot(&radial)];
        let weight_around = weight_of.dot(&axial.cross(&radial));
        let (origin, centrifugal) = (outer.position, of.centrifugal);
        BallPlane { origin, axial, radial, weight, weight_around, centrifugal }
    }));
}

/// Adds energy, force and stiffness of one bearing. Counts evaluations of a ball on a race.
pub(crate) fn add_bearing(
    model: &Model,
    index: usize,
    here: &mut Evaluation,
    contact_evaluations: &mut usize,
    ran: &mut Counts,
) {
    let bearing = &model.assembly.bearings[index];
    let of = &model.bearings[index];
    let [inner, outer] = bearing.mounts;
    let race = model.race(index, 0, &here.at);
    let moves = model.first_unknown(outer.body);
    if moves.is_some() {
        let outer = model.pose(outer.body, &here.at);
        planes(bearing, of, &outer, &mut here.planes[index]);
    }
    // A race that is its body writes into the body's rows itself.
    let plain = inner.is_direct() && moves.is_none() && model.is_plain(inner.body);
    let direct = model.first_unknown(inner.body).filter(|_| plain);
    let mut gradient = Five::zeros();
    if let Some(first) = direct {
        gradient.copy_from(&here.gradient.fixed_rows::<5>(first));
    }
    let mut stiffness = Block::zeros();
    let (mut on_outer, mut about_outer) = (Vector3::zeros(), Vector3::zeros());
    let mut outwards = Vector3::zeros();
    let mut balls = std::mem::take(&mut here.balls[index]);
    balls.clear();
    let moved = std::mem::take(&mut here.planes[index]);
    for plane in if moved.is_empty() { &of.planes } else { &moved } {
        let ball = settle(plane, &race, &of.contacts, contact_evaluations);
        ran.add(Stage::DistanceTest, 1);
        ran.add(Stage::BallEquilibrium, u64::from(ball.is_some()));
        ran.add(Stage::BallGravity, u64::from(plane.weight != [0.0; 2]));
        ran.add(Stage::CentrifugalForce, u64::from(plane.centrifugal != 0.0));
        let mut on_race = Vector3::zeros();
        if let Some(ball) = &ball {
            here.energy += ball.energy;
            here.largest_ball_load =
                here.largest_ball_load.max(ball.inner_load).max(ball.outer_load);
            on_race = add_to_race(plane, &race, &of.contacts, ball, &mut gradient, &mut stiffness);
        }
        if moves.is_some() {
            // The outer race carries the balls' load from the inner one, their weight, and the cage forces.
            let place = ball.as_ref().map_or([0.0, bearing.geometry.pitch_radius], |b| b.position);
            let flung = plane.radial * (plane.centrifugal * place[1]);
            let pushed = on_race - of.weight - flung;
            here.energy -= of.weight.dot(&plane.origin);
            outwards += flung;
            on_outer += pushed;
            about_outer += (plane.axial * place[0] + plane.radial * place[1]).cross(&pushed);
        }
        balls.push(ball);
    }
    (here.balls[index], here.planes[index]) = (balls, moved);
    here.without_energy += outwards.norm();
    if let Some(first) = direct {
        here.gradient.fixed_rows_mut::<5>(first).copy_from(&gradient);
        let mut block = here.stiffness.fixed_view_mut::<5, 5>(first, first);
        block += stiffness;
        return;
    }
    let inner_axes = model.turn(inner.body);
    let inner_by = motion_of_race(&race, &inner, &inner_axes);
    if let Some(first) = model.first_unknown(inner.body) {
        let mut rows = here.gradient.fixed_rows_mut::<5>(first);
        rows += inner_by.transpose() * gradient;
        let mut block = here.stiffness.fixed_view_mut::<5, 5>(first, first);
        block += inner_by.transpose() * stiffness * inner_by;
        let force = Vector3::new(gradient[0], gradient[1], gradient[2]);
        block += bending(&race, &inner, &force);
    }
    let Some(first) = moves else { return };
    let outer_race = model.race(index, 1, &here.at);
    let outer_by = motion_of_race(&outer_race, &outer, &model.turn(outer.body));
    let [e2, e3] = model.tilt_axes(outer.body, &here.at);
    let (moment_2, moment_3) = (about_outer.dot(&e2), about_outer.dot(&e3));
    let force =
        outer_by.transpose() * Five::from([on_outer.x, on_outer.y, on_outer.z, moment_2, moment_3]);
    let mut rows = here.gradient.fixed_rows_mut::<5>(first);
    rows += force;
    let pair = Pair { race, gradient, stiffness, outer_race, outer_by, tilt_axes: [e2, e3] };
    let (own, cross) = pair.stiffness(&inner_by, &outer);
    let mut block = here.stiffness.fixed_view_mut::<5, 5>(first, first);
    block += own;
    if let Some(of_inner) = model.first_unknown(inner.body) {
        let mut block = here.stiffness.fixed_view_mut::<5, 5>(of_inner, first);
        block += cross;
        let mut block = here.stiffness.fixed_view_mut::<5, 5>(first, of_inner);
        block += cross.transpose();
    }
}

/// Both races of a bearing, and gradient and curvature of the energy over the inner one's centre and tilts.
struct Pair {
    race: InnerRacePosition,
    gradient: Five,
    stiffness: Block,
    outer_race: InnerRacePosition,
    /// Motion of the outer race's centre, and tilts, per coordinate of its body.
    outer_by: Block,
    /// Axes of these tilts.
    tilt_axes: [Vector3<f64>; 2],
}

impl Pair {
    /// Stiffness over the coordinates of the outer race's body, and between those of the inner race's body (rows) and
    /// them (columns).
    ///
    /// With T the outer race's motion the energy is φ(T⁻¹c, T⁻¹a), c the inner race's centre and a its axis. For a
    /// displacement t and a rotation θ of the outer race, r from its centre to the inner one's, T⁻¹ moves c by δc − t −
    /// θ×r − θ×(δc − t) + ½ θ×(θ×r), a likewise; θ = e₂ δξ + e₃ δλ + ½ e₂×e₃ δξδλ.
    fn stiffness(&self, inner_by: &Block, outer_mount: &Mount) -> (Block, Block) {
        let ([a_xi, a_lambda], [a_xi_xi, a_xi_lambda, _]) = self.race.turning();
        let axis = &self.race.axis;
        let arm = self.race.centre - self.outer_race.centre;
        let g = &self.gradient;
        let force = Vector3::new(g[0], g[1], g[2]);
        // Gradient over the axis, perpendicular to it.
        let per = [a_xi / a_xi.norm_squared(), a_lambda / a_lambda.norm_squared()];
        let axis_slope = per[0] * g[3] + per[1] * g[4];
        let turn = Matrix3x5::from_columns(&[
            Vector3::zeros(),
            Vector3::zeros(),
            Vector3::zeros(),
            self.tilt_axes[0],
            self.tilt_axes[1],
        ]);
        let shift = self.outer_by.fixed_view::<3, 5>(0, 0).into_owned();
        // First order: motion of the inner race in a common motion.
        let mut carried = Block::zeros();
        carried.fixed_view_mut::<3, 5>(0, 0).copy_from(&(shift - arm.cross_matrix() * turn));
        let across = axis.cross_matrix();
        for (row, per) in per.iter().enumerate() {
            let tilt = -(per.transpose() * across) * turn;
            carried.fixed_view_mut::<1, 5>(3 + row, 0).copy_from(&tilt);
        }
        let mut own = carried.transpose() * self.stiffness * carried;
        let mut cross = -(inner_by.transpose() * self.stiffness * carried);
        // Second order of the centre.
        let pulled = force.cross_matrix();
        own += bending(&self.outer_race, outer_mount, &-force);
        let dragged = shift.transpose() * pulled * turn;
        own += dragged + dragged.transpose();
        own += turn.transpose() * turned_back(&force, &arm) * turn;
        let inner_shift = inner_by.fixed_view::<3, 5>(0, 0).into_owned();
        cross -= inner_shift.transpose() * pulled * turn;
        // Second order of the axis, less what the stiffness over the tilts contains.
        own += turn.transpose() * turned_back(&axis_slope, axis) * turn;
        let tilts = carried.fixed_view::<2, 5>(3, 0).into_owned();
        let bends = axis_slope.dot(&a_xi_lambda);
        let bent = nalgebra::Matrix2::new(axis_slope.dot(&a_xi_xi), bends, bends, 0.0);
        own -= tilts.transpose() * bent * tilts;
        let inner_tilts = inner_by.fixed_view::<2, 5>(3, 0).into_owned();
        let inner_axis = nalgebra::Matrix3x2::from_columns(&[a_xi, a_lambda]) * inner_tilts;
        cross += inner_tilts.transpose() * bent * tilts;
        cross -= inner_axis.transpose() * axis_slope.cross_matrix() * turn;
        // Second order of the rotation.
        let moment = arm.cross(&force) + axis.cross(&axis_slope);
        let twist = 0.5 * self.tilt_axes[0].cross(&self.tilt_axes[1]).dot(&moment);
        own[(3, 4)] -= twist;
        own[(4, 3)] -= twist;
        (own, cross)
    }
}

/// Second derivatives of ½ f·(θ×(θ×r)) by θ.
fn turned_back(f: &Vector3<f64>, r: &Vector3<f64>) -> Matrix3<f64> {
    0.5 * (f * r.transpose() + r * f.transpose()) - Matrix3::identity() * f.dot(r)
}

/// Centre and tilts of a race per unit of each coordinate of its body, whose axes are rotated by `axes`.
pub(crate) fn motion_of_race(
    race: &InnerRacePosition,
    mount: &Mount,
    axes: &Matrix3<f64>,
) -> Block {
    let mut motion = Block::identity();
    motion.fixed_view_mut::<3, 3>(0, 0).copy_from(axes);
    if mount.along != 0.0 {
        let (first, _) = race.along(mount);
        for (column, centre) in first.into_iter().enumerate() {
            for i in 0..3 {
                motion[(i, 3 + column)] = centre[i];
            }
        }
    }
    motion
}

/// Stiffness of a force on a race by the curvature of the path of the race's centre.
pub(crate) fn bending(race: &InnerRacePosition, mount: &Mount, force: &Vector3<f64>) -> Block {
    let mut stiffness = Block::zeros();
    if mount.along != 0.0 {
        let (_, [xi_xi, xi_lambda, lambda_lambda]) = race.along(mount);
        stiffness[(3, 3)] = xi_xi.dot(force);
        stiffness[(3, 4)] = xi_lambda.dot(force);
        stiffness[(4, 3)] = stiffness[(3, 4)];
        stiffness[(4, 4)] = lambda_lambda.dot(force);
    }
    stiffness
}
