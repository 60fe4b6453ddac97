//! Where a simulation starts: at equilibrium and rolling, or at rest in nominal positions.

use super::equilibrium::{Equilibrium, at_start};
use super::model::{Drive, DynamicProblem, Rotation};
use super::race;
use super::state::{BodyState, Layout};
use crate::ch2_housing::bearing::frequencies::ratios;
use crate::kinematics::Pose;
use crate::kinematics::euler::{about, quaternion};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, norm, scale, sub};
use crate::solver::statics::{Condition, StaticProblem, StaticSolution, StaticsError};
use nalgebra::Vector3;

/// The static problem that the dynamic one settles into at time `t` with the outer race where it
/// started; a rotating load stands still where it is then, an unbalance is left out.
pub fn static_problem(problem: &DynamicProblem, t: f64) -> StaticProblem {
    let mut others = [0.0; 5];
    for (other, gravity) in others.iter_mut().zip(problem.gravity) {
        *other = problem.inner.inertia.mass * gravity;
    }
    if let Some(load) = &problem.rotating_load {
        for (other, force) in others.iter_mut().zip(load.force(t)) {
            *other += force;
        }
    }
    let conditions = std::array::from_fn(|i| match &problem.inner.drives[i] {
        Drive::Load(profile) => Condition::Load(profile.value(t) + others[i]),
        Drive::Motion(profile) => Condition::Displacement(profile.value(t)),
    });
    let at = &problem.outer_start;
    StaticProblem {
        geometry: problem.geometry,
        inner_contact: problem.inner_contact,
        outer_contact: problem.outer_contact,
        ball_phase: problem.ball_phase,
        ball_mass: problem.ball.mass,
        gravity: Vector3::from(problem.gravity),
        orbital_speed: orbital_speed(problem, t),
        frame: Pose::identity(),
        outer_pose: Pose {
            position: Vector3::new(at[0], at[1], at[2]),
            orientation: quaternion(0.0, at[3], at[4]),
        },
        conditions,
    }
}

/// Prescribed speed of the inner race at `t`, rad/s; zero when it is driven by a torque.
pub(super) fn inner_speed(problem: &DynamicProblem, t: f64) -> f64 {
    match &problem.inner.rotation {
        Rotation::Speed(profile) => profile.value(t),
        Rotation::Torque(_) => 0.0,
    }
}

/// Speed of the ball set by pure rolling with the outer race at rest, rad/s.
fn orbital_speed(problem: &DynamicProblem, t: f64) -> f64 {
    let g = &problem.geometry;
    let ratio = ratios(g.ball_count, g.ball_radius, g.pitch_radius, g.contact_angle).cage;
    ratio * inner_speed(problem, t)
}

/// State vector at equilibrium of both races under the loads at t = 0, balls and cage rolling; what
/// turns stands still for it (see [`at_start`]).
///
/// # Errors
/// When the loads have no equilibrium.
pub fn at_equilibrium(
    problem: &DynamicProblem,
    layout: &Layout,
) -> Result<(Vec<f64>, StaticSolution), StaticsError> {
    let Equilibrium { solution, outer } = at_start(problem)?;
    let mut state = vec![0.0; layout.len()];
    let q = &solution.coordinates;
    let positions: Vec<Vec3> = solution.balls.iter().map(|ball| ball.position.into()).collect();
    let inner = [q[0], q[1], q[2], q[3], q[4]];
    fill(problem, layout, &mut state, [&inner, &outer], &positions);
    Ok((state, solution))
}

/// State vector with everything in its nominal position, balls and cage rolling at the prescribed
/// speed; loads hit it suddenly.
pub fn nominal(problem: &DynamicProblem, layout: &Layout) -> Vec<f64> {
    let mut state = vec![0.0; layout.len()];
    let g = &problem.geometry;
    let outer = race::fixed(&problem.outer_start);
    let turn = outer.state.orientation;
    let positions: Vec<Vec3> = (0..layout.balls)
        .map(|ball| {
            let angle =
                problem.ball_phase + std::f64::consts::TAU * ball as f64 / layout.balls as f64;
            let (sin, cos) = libm::sincos(angle);
            let local = Vector3::new(0.0, g.pitch_radius * cos, g.pitch_radius * sin);
            add(outer.state.position, (turn * local).into())
        })
        .collect();
    let mut inner = [0.0; 5];
    for (coordinate, drive) in inner.iter_mut().zip(&problem.inner.drives) {
        if let Drive::Motion(profile) = drive {
            *coordinate = profile.value(0.0);
        }
    }
    fill(problem, layout, &mut state, [&inner, &problem.outer_start], &positions);
    state
}

fn fill(
    problem: &DynamicProblem,
    layout: &Layout,
    state: &mut [f64],
    [inner, outer]: [&[f64; 5]; 2],
    positions: &[Vec3],
) {
    let orbital_speed = orbital_speed(problem, 0.0);
    let axis_spin = |axis: Vec3, speed: f64| scale(axis, speed);
    let write = |state: &mut [f64], at: usize, body: &BodyState| {
        state[at..at + super::state::BODY].copy_from_slice(&body.to_array());
    };
    let mut body = BodyState::at_rest([inner[0], inner[1], inner[2]]);
    body.orientation = about(Vector3::y(), inner[3]) * about(Vector3::z(), inner[4]);
    body.spin = axis_spin(body.axis(), inner_speed(problem, 0.0));
    write(state, layout.inner(), &body);
    let inner_body = body;

    let outer = race::fixed(outer).state;
    write(state, layout.outer(), &outer);
    let axis = outer.axis();
    if layout.has_cage {
        let mut cage = outer;
        cage.spin = axis_spin(axis, orbital_speed);
        write(state, layout.cage(), &cage);
    }
    for (ball, position) in positions.iter().enumerate() {
        let mut body = BodyState::at_rest(*position);
        let from_axis = sub(*position, outer.position);
        let outward = add_scaled(from_axis, -dot(from_axis, axis), axis);
        body.velocity = cross(scale(axis, orbital_speed), outward);
        body.spin = rolling_spin(problem, &inner_body, &body, axis, outward);
        layout.set_ball(state, ball, &body);
    }
    // Lanes beyond the last ball hold a ball that stands in the groove and is never looked at.
    for ball in layout.balls..layout.padded {
        layout.set_ball(state, ball, &BodyState::at_rest(positions[0]));
    }
}

/// Spin that rolls without slip on both races: about the meridian direction across the line from
/// the outer to the inner contact, as fast as the inner race's surface asks for.
fn rolling_spin(
    problem: &DynamicProblem,
    inner: &BodyState,
    ball: &BodyState,
    axis: Vec3,
    outward: Vec3,
) -> Vec3 {
    let angle = problem.geometry.contact_angle;
    let out = scale(outward, 1.0 / norm(outward));
    let (sin, cos) = libm::sincos(angle);
    let normal = add_scaled(scale(out, cos), sin, axis);
    let tangent = cross(axis, out);
    let roll_axis = cross(tangent, normal);
    let radius = problem.geometry.ball_radius;
    let inner_point = scale(normal, -radius);
    let from_inner = sub(add(ball.position, inner_point), inner.position);
    let race_surface = add(inner.velocity, cross(inner.spin, from_inner));
    // Centre plus spin × arm: the outer point stands still, the inner one moves with the race.
    let half_difference = 0.5 * dot(race_surface, tangent);
    let per_spin = dot(cross(roll_axis, inner_point), tangent);
    scale(roll_axis, half_difference / per_spin)
}
