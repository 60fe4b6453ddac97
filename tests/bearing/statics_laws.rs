//! Laws that any static solution obeys, on random bearings of both kinds.

use crate::common;

use bearing_dynamics::ch2_housing::bearing::contact::groove_force;
use bearing_dynamics::ch2_housing::bearing::geometry::{BearingGeometry, ClearanceThrough};
use bearing_dynamics::equilibrium::statics::{
    StaticOptions, StaticProblem, StaticSolution, solve, solve_from,
};
use bearing_dynamics::kinematics::{Pose, euler};
use bearing_dynamics::members::body::Condition;
use common::{FREE, problem, table_4_1, table_5_3};
use nalgebra::{SVector, UnitQuaternion, Vector3};
use proptest::prelude::*;

/// Largest ball load, the scale of every force comparison, N.
fn largest_load(solution: &StaticSolution) -> f64 {
    solution.balls.iter().map(|b| b.inner.normal_load.max(b.outer.normal_load)).fold(0.0, f64::max)
}

prop_compose! {
    fn any_geometry()(
        angular in any::<bool>(),
        ball_count in 6usize..14,
        ball in 3e-3..7e-3f64,
        inner_ratio in 1.01..1.12f64,
        outer_ratio in 1.02..1.12f64,
        pitch_ratio in 1.3..2.0f64,
        angle in 12f64..45.0,
        clearance in -20e-6..40e-6f64,
    ) -> BearingGeometry {
        let pitch = ball * pitch_ratio / (std::f64::consts::PI / ball_count as f64).sin();
        let nominal = if angular {
            BearingGeometry::angular_contact(
                ball_count, pitch, inner_ratio * ball, outer_ratio * ball, ball, angle.to_radians())
        } else {
            BearingGeometry::deep_groove(
                ball_count, pitch - ball, inner_ratio * ball, pitch + ball, outer_ratio * ball, ball)
        };
        nominal.with_radial_clearance(clearance, ClearanceThrough::Ball)
    }
}

prop_compose! {
    /// Displacements and tilts that load some balls: as far as the clearance and a few µm beyond.
    fn any_position()(
        along in prop::array::uniform3(-15e-6..15e-6f64),
        tilts in prop::array::uniform2(-0.5..0.5f64),
    ) -> [f64; 5] {
        [along[0] + 10e-6, along[1], along[2], tilts[0].to_radians(), tilts[1].to_radians()]
    }
}

fn held(geometry: BearingGeometry, position: &[f64; 5]) -> StaticProblem {
    problem(geometry, position.map(Condition::Displacement))
}

fn any_rotation() -> impl Strategy<Value = UnitQuaternion<f64>> {
    (prop::array::uniform3(-1.0..1.0f64), 0.0..3.1f64).prop_map(|(axis, angle)| {
        let axis = Vector3::from(axis) + Vector3::new(0.0, 0.0, 1.01);
        UnitQuaternion::from_scaled_axis(axis.normalize() * angle)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// The analytic stiffness against fourth-order differences of the loads, both triangles.
    #[test]
    fn stiffness_is_symmetric_and_the_derivative_of_the_loads(
        geometry in any_geometry(), position in any_position()
    ) {
        let solution = solve(&held(geometry, &position)).unwrap();
        let stiffness = solution.stiffness;
        let overlap = solution.balls.iter()
            .map(|ball| ball.inner.approach + ball.outer.approach)
            .filter(|total| *total > -1e-6)
            .map(f64::abs).fold(f64::MAX, f64::min);
        // Where a ball is about to lose contact the load has a kink in its slope (δ^1.5) and
        // differences say nothing; steps stay well inside the smallest overlap.
        prop_assume!(overlap > 1e-6);
        let pitch = geometry.pitch_radius;
        let scale = [1.0, 1.0, 1.0, pitch, pitch];
        let largest = (0..5).map(|i| stiffness[(i, i)] / (scale[i] * scale[i])).fold(0.0, f64::max);
        for j in 0..5 {
            let step = 2e-8 / scale[j];
            let loads_at = |steps: f64| {
                let mut moved = position;
                moved[j] += steps * step;
                solve(&held(geometry, &moved)).unwrap().loads
            };
            let slope = ((loads_at(1.0) - loads_at(-1.0)) * 8.0
                - (loads_at(2.0) - loads_at(-2.0))) / (12.0 * step);
            for i in 0..5 {
                let error = (slope[i] - stiffness[(i, j)]).abs() / (scale[i] * scale[j]);
                // Truncation (step/overlap)⁴ ≈ 2e-7 at worst, rounding 1e-12·Q/(k·step) below it.
                prop_assert!(error <= 1e-6 * largest, "({i},{j}): {error:e} of {largest:e}");
            }
        }
    }

    /// Contact forces on the inner race carry the load; on the outer race they carry it through,
    /// but for what the cage takes along the circumference.
    #[test]
    fn ball_forces_add_up_to_the_load(
        geometry in any_geometry(),
        force in prop::array::uniform3(-1000.0..1000.0f64),
        moment in prop::array::uniform2(-3.0..3.0f64),
    ) {
        let axial = force[0].abs() + 500.0;
        let loads = [axial, force[1], force[2], moment[0], moment[1]];
        let solution = match solve(&problem(geometry, loads.map(Condition::Load))) {
            Ok(solution) => solution,
            // A moment too large for the axial load opens an angular-contact bearing for good.
            Err(_) => return Err(TestCaseError::reject("no equilibrium")),
        };
        let scale = largest_load(&solution).max(axial);
        let out_of_balance = solution.force_on_inner + Vector3::new(axial, force[1], force[2]);
        prop_assert!(out_of_balance.amax() <= 1e-10 * scale, "{out_of_balance:?} of {scale}");
        // Conjugate moments: about Y, and about the race's own Z axis.
        let own_z = euler::quaternion(0.0, solution.coordinates[3], solution.coordinates[4])
            * Vector3::z();
        let pitch = geometry.pitch_radius;
        let about_y = (solution.moment_on_inner.y + moment[0]) / pitch;
        let about_z = (solution.moment_on_inner.dot(&own_z) + moment[1]) / pitch;
        prop_assert!(about_y.abs() <= 1e-10 * scale, "about Y {about_y:e}");
        prop_assert!(about_z.abs() <= 1e-10 * scale, "about Z {about_z:e}");
        // A torus cannot be turned about its own axis by forces normal to it.
        let own_axis = euler::quaternion(0.0, solution.coordinates[3], solution.coordinates[4])
            * Vector3::x();
        prop_assert!(solution.moment_on_inner.dot(&own_axis).abs() <= 1e-10 * scale * pitch);
        for ball in &solution.balls {
            let sum = ball.inner.force_on_race + ball.outer.force_on_race;
            let (sin, cos) = ball.azimuth.sin_cos();
            let in_plane = [sum.x, sum.y * cos + sum.z * sin];
            for part in in_plane {
                prop_assert!(part.abs() <= 1e-10 * scale, "ball out of balance by {part:e}");
            }
        }
    }

    /// Turning and moving the whole scene (races, loads, gravity) changes no ball load.
    #[test]
    fn ball_loads_do_not_see_a_rigid_motion_of_the_scene(
        geometry in any_geometry(),
        load in prop::array::uniform2(-800.0..800.0f64),
        shift in prop::array::uniform3(-1.0..1.0f64),
        turn in any_rotation(),
        outer_tilt in -0.3..0.3f64,
    ) {
        let loads = [900.0, load[0], load[1], 0.5, -0.2];
        let mut still = problem(geometry, loads.map(Condition::Load));
        still.gravity = Vector3::new(0.0, 0.0, -9.81);
        still.orbital_speed = 100.0;
        still.outer_pose = Pose {
            position: Vector3::new(2e-6, -3e-6, 1e-6),
            orientation: euler::quaternion(0.0, outer_tilt.to_radians(), 0.001),
        };
        let motion = Pose { position: Vector3::from(shift), orientation: turn };
        let mut moved = still.clone();
        moved.frame = still.frame.seen_from_parent_of(&motion);
        moved.outer_pose = still.outer_pose.seen_from_parent_of(&motion);
        moved.gravity = turn * still.gravity;
        let (Ok(one), Ok(other)) = (solve(&still), solve(&moved)) else {
            return Err(TestCaseError::reject("no equilibrium"));
        };
        let scale = largest_load(&one);
        for (a, b) in one.balls.iter().zip(&other.balls) {
            // A coordinate of 1 m is good to 1e-16 m, an overlap of 1e-6 m then to 1e-10.
            let error = (a.inner.normal_load - b.inner.normal_load).abs()
                .max((a.outer.normal_load - b.outer.normal_load).abs());
            prop_assert!(error <= 1e-9 * scale, "{error:e} of {scale}");
        }
    }

    /// A ball that only its weight or its speed holds is in balance too, however soft its seat.
    #[test]
    fn free_balls_settle(
        geometry in any_geometry(),
        position in any_position(),
        speed in 0.5..60f64,
        pull in prop::array::uniform3(-10.0..10.0f64),
        phase in 0.0..6.3f64,
    ) {
        let mut task = held(geometry, &position);
        task.orbital_speed = speed;
        task.gravity = Vector3::from(pull);
        task.ball_phase = phase;
        let solution = solve(&task).unwrap();
        for ball in &solution.balls {
            let (sin, cos) = ball.azimuth.sin_cos();
            let out = Vector3::new(0.0, cos, sin);
            let force = Vector3::from(pull) * task.ball_mass
                + out * (task.ball_mass * speed * speed * ball.position.dot(&out))
                - ball.inner.force_on_race - ball.outer.force_on_race;
            let scale = ball.inner.normal_load.max(ball.outer.normal_load);
            // Newton ends at 1e-11 of the load, rounding of overlaps at about 1e-9 N.
            let allowed = 1e-8 * scale + 2e-9;
            prop_assert!(force.x.abs() <= allowed, "axial {:e} of {scale}", force.x);
            prop_assert!(force.dot(&out).abs() <= allowed, "radial {:e}", force.dot(&out));
            let around = Vector3::new(0.0, -sin, cos);
            prop_assert!((force.dot(&around) + ball.cage_force).abs() <= allowed);
        }
    }

    /// The contact law itself, evaluated in coordinates a metre away from the origin.
    #[test]
    fn the_contact_force_turns_with_the_scene(
        geometry in any_geometry(),
        position in any_position(),
        azimuth in 0.0..6.3f64,
        shift in prop::array::uniform3(-1.0..1.0f64),
        turn in any_rotation(),
    ) {
        let race = Pose {
            position: Vector3::new(position[0], position[1], position[2]),
            orientation: euler::quaternion(0.0, position[3], position[4]),
        };
        // Pressed 20 µm into the groove bottom of the outer race.
        let reach = geometry.outer.centre_radius + geometry.outer.groove_radius
            - geometry.ball_radius + 20e-6;
        let ball = Vector3::new(
            geometry.outer.centre_axial, reach * azimuth.cos(), reach * azimuth.sin());
        let law = |ball: &Vector3<f64>, race: &Pose| {
            groove_force(ball, race, &geometry.outer, geometry.ball_radius, 3e10)
        };
        let motion = Pose { position: Vector3::from(shift), orientation: turn };
        let here = law(&ball, &race);
        let there = law(&motion.point_to_parent(&ball), &race.seen_from_parent_of(&motion));
        let error = (turn * here.force_on_ball - there.force_on_ball).norm();
        prop_assert!(error <= 1e-9 * here.normal_load.max(1.0), "{error:e}");
    }

    /// A warm start from anywhere near ends in the same place.
    #[test]
    fn warm_and_cold_starts_agree(
        geometry in any_geometry(), offset in prop::array::uniform5(-3e-6..3e-6f64)
    ) {
        let loads = [800.0, 150.0, -300.0, 0.3, 0.1];
        let task = problem(geometry, loads.map(Condition::Load));
        let Ok(cold) = solve(&task) else { return Err(TestCaseError::reject("no equilibrium")) };
        let mut start = cold.coordinates + SVector::from(offset);
        start[3] = cold.coordinates[3] + offset[3] / geometry.pitch_radius;
        start[4] = cold.coordinates[4] + offset[4] / geometry.pitch_radius;
        let warm = solve_from(&task, Some(&start), &StaticOptions::default()).unwrap();
        let scale = largest_load(&cold);
        for (a, b) in cold.balls.iter().zip(&warm.balls) {
            let error = (a.inner.normal_load - b.inner.normal_load).abs();
            prop_assert!(error <= 1e-9 * scale, "{error:e} of {scale}");
        }
    }
}

#[test]
fn centrifugal_force_loads_the_outer_race_and_opens_its_contact_angle() {
    let mut conditions = FREE;
    conditions[0] = Condition::Load(445.0);
    let mut task = problem(table_5_3(), conditions);
    let slow = solve(&task).unwrap();
    task.orbital_speed = 400.0;
    let fast = solve(&task).unwrap();
    for (a, b) in slow.balls.iter().zip(&fast.balls) {
        assert!((a.inner.contact_angle - a.outer.contact_angle).abs() <= 1e-9);
        assert!(b.outer.contact_angle < b.inner.contact_angle);
        // Balance of the ball along the radius and the axis.
        let force = task.ball_mass * 400.0 * 400.0 * b.position.yz().norm();
        let radial = b.outer.normal_load * b.outer.contact_angle.cos()
            - b.inner.normal_load * b.inner.contact_angle.cos();
        let axial = b.outer.normal_load * b.outer.contact_angle.sin()
            - b.inner.normal_load * b.inner.contact_angle.sin();
        assert!((radial - force).abs() <= 1e-9 * b.outer.normal_load, "{radial} N, {force} N");
        assert!(axial.abs() <= 1e-9 * b.outer.normal_load);
    }
}

/// Largest error of the analytic stiffness against fourth-order differences of the loads, over the
/// largest entry of the diagonal; tilts are taken times the pitch radius.
fn stiffness_error(task: &StaticProblem, position: [f64; 5], step: f64) -> f64 {
    let solved = |position: [f64; 5]| {
        let mut task = task.clone();
        task.conditions = position.map(Condition::Displacement);
        solve(&task).unwrap()
    };
    let stiffness = solved(position).stiffness;
    let pitch = task.geometry.pitch_radius;
    let scale = [1.0, 1.0, 1.0, pitch, pitch];
    let largest = (0..5).map(|i| stiffness[(i, i)] / (scale[i] * scale[i])).fold(0.0, f64::max);
    let mut worst = 0.0_f64;
    for j in 0..5 {
        let step = step / scale[j];
        let loads_at = |steps: f64| {
            let mut moved = position;
            moved[j] += steps * step;
            solved(moved).loads
        };
        let slope = ((loads_at(1.0) - loads_at(-1.0)) * 8.0 - (loads_at(2.0) - loads_at(-2.0)))
            / (12.0 * step);
        for i in 0..5 {
            let error = (slope[i] - stiffness[(i, j)]).abs() / (scale[i] * scale[j] * largest);
            assert!(error.is_finite());
            worst = worst.max(error);
        }
    }
    worst
}

#[test]
fn stiffness_of_a_fast_bearing_is_the_derivative_of_the_loads() {
    // The centrifugal force grows with the radius, −mω² of stiffness. Against the swivel of a
    // lightly loaded contact it matters: every ball's inner load stays below its outer one.
    for (speed, axial) in [(500.0, 4e-6), (1000.0, 6e-6), (2000.0, 12e-6)] {
        let mut task = problem(table_5_3(), FREE);
        task.orbital_speed = speed;
        let position = [axial, 0.6e-6, -0.4e-6, 1e-5, -2e-5];
        task.conditions = position.map(Condition::Displacement);
        let solution = solve(&task).unwrap();
        for ball in &solution.balls {
            // Steps of 20 nm stay far from the kink of an opening contact.
            assert!(ball.inner.approach > 3e-7, "{:e}", ball.inner.approach);
            assert!(ball.outer.normal_load > 1.2 * ball.inner.normal_load);
        }
        let error = stiffness_error(&task, position, 2e-8);
        // Truncation (2e-8/3e-7)⁴ ≈ 2e-5 of one soft contact, 1e-7 of the whole; rounding below it.
        assert!(error <= 1e-7, "{error:e} at {speed} rad/s");
    }
}

#[test]
fn moments_count_about_the_centres_of_both_races() {
    // Held in a frame that is neither the world nor the outer race's.
    let frame = Pose {
        position: Vector3::new(0.2, -0.1, 0.05),
        orientation: euler::quaternion(0.4, -0.3, 0.8),
    };
    let outer = Pose {
        position: Vector3::new(-30e-6, 50e-6, 40e-6),
        orientation: euler::quaternion(0.0, 2e-3, -1e-3),
    };
    let at = [-22e-6, 55e-6, 33e-6, 2.4e-3, -0.8e-3];
    for geometry in [table_4_1(-5e-6), table_5_3()] {
        let mut task = problem(geometry, at.map(Condition::Displacement));
        task.frame = frame;
        task.outer_pose = outer.seen_from_parent_of(&frame);
        let solution = solve(&task).unwrap();
        let inner_centre = Vector3::new(at[0], at[1], at[2]);
        let scale = largest_load(&solution) * geometry.pitch_radius;
        let mut about_inner = Vector3::zeros();
        let mut about_outer = Vector3::zeros();
        // What the cage leaves of the moment of all contact forces about the frame's origin.
        let mut of_the_cage = Vector3::zeros();
        for ball in &solution.balls {
            about_inner += (ball.position - inner_centre).cross(&ball.inner.force_on_race);
            about_outer += (ball.position - outer.position).cross(&ball.outer.force_on_race);
            let (sin, cos) = ball.azimuth.sin_cos();
            let around = outer.orientation * Vector3::new(0.0, -sin, cos);
            of_the_cage += ball.position.cross(&(around * ball.cage_force));
        }
        // Forces of some 100 N, 50 µm off their centre, make a thousandth of `scale`.
        assert!((solution.moment_on_outer - about_outer).amax() <= 1e-12 * scale);
        assert!((solution.moment_on_inner - about_inner).amax() <= 1e-12 * scale);
        let whole = solution.moment_on_inner
            + inner_centre.cross(&solution.force_on_inner)
            + solution.moment_on_outer
            + outer.position.cross(&solution.force_on_outer);
        assert!((whole - of_the_cage).amax() <= 1e-9 * scale, "{whole:?}, {of_the_cage:?}");
        // Outer races transmit what inner races get, taken over to the outer centre.
        assert!(outer.position.cross(&solution.force_on_outer).amax() >= 1e-4 * scale);
    }
}
