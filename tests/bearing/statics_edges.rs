//! Where static solutions are many, unstable, far or none.

use crate::common;

use bearing_dynamics::equilibrium::statics::{Determinacy, StaticsError, solve};
use bearing_dynamics::members::body::Condition;
use common::{FREE, problem, table_4_1};
use nalgebra::Vector3;

#[test]
fn clearance_without_load_is_said_to_be_indeterminate() {
    let solution = solve(&problem(table_4_1(5e-6), FREE)).unwrap();
    let Determinacy::Indeterminate { free_directions } = &solution.determinacy else {
        panic!("a loose race was called determinate");
    };
    assert_eq!(free_directions.len(), 5);
    assert!(solution.balls.iter().all(|ball| ball.inner.normal_load == 0.0));
}

#[test]
fn preload_without_load_is_determinate() {
    let solution = solve(&problem(table_4_1(-5e-6), FREE)).unwrap();
    assert_eq!(solution.determinacy, Determinacy::Determinate);
    let loads: Vec<f64> = solution.balls.iter().map(|ball| ball.outer.normal_load).collect();
    let spread = loads.iter().fold(0.0_f64, |worst, load| worst.max((load - loads[0]).abs()));
    assert!(spread <= 1e-9 * loads[0], "balls of a concentric race differ by {spread:e} N");
}

#[test]
fn a_load_that_nothing_holds_is_an_error_with_the_direction() {
    // Only the axial coordinate may move, and the balls are not in reach of a race this wide.
    let mut wide = table_4_1(5e-6);
    wide.inner.centre_radius -= 4e-3;
    let mut conditions = [Condition::Displacement(0.0); 5];
    conditions[0] = Condition::Load(100.0);
    let error = solve(&problem(wide, conditions)).unwrap_err();
    let advice = "x = { displacement = \"0 mm\" } holds it";
    assert!(error.to_string().contains("along x") && error.to_string().contains(advice), "{error}");
    let StaticsError::NoEquilibrium { body, travel, room, .. } = error else { panic!("{error}") };
    let tilted = StaticsError::NoEquilibrium { body, coordinate: "tilt_y", travel, room };
    assert!(tilted.to_string().contains("tilt_y = { tilt = \"0 deg\" } holds it"), "{tilted}");
}

/// What a race has room for counts from where the outer one is held: moved along with it, however far, it carries the same.
#[test]
fn a_race_is_looked_for_where_the_outer_one_is_held() {
    let mut conditions = FREE;
    conditions[0] = Condition::Load(100.0);
    let here = solve(&problem(table_4_1(5e-6), conditions)).unwrap();
    let mut moved = problem(table_4_1(5e-6), conditions);
    // Farther than the ball is large.
    moved.outer_pose.position.x = 8e-3;
    let there = solve(&moved).unwrap();
    assert!((there.coordinates[0] - here.coordinates[0] - 8e-3).abs() <= 1e-12);
}

#[test]
fn infinite_and_missing_numbers_are_refused() {
    for bad in [f64::NAN, f64::INFINITY] {
        let mut conditions = FREE;
        conditions[2] = Condition::Load(bad);
        assert!(solve(&problem(table_4_1(0.0), conditions)).is_err());
    }
}

#[test]
fn an_unstable_position_is_left_for_a_stable_one() {
    // With 40 µm of clearance and free tilts a radially loaded inner race cannot stay upright:
    // the symmetric position is a saddle of the energy.
    let mut conditions = FREE;
    conditions[2] = Condition::Load(-1500.0);
    let mut task = problem(table_4_1(40e-6), conditions);
    task.ball_phase = 0.0;
    let solution = solve(&task).unwrap();
    assert!(solution.saddles_left > 0);
    let lowest = solution.stiffness.symmetric_eigenvalues().min();
    assert!(lowest > 0.0, "stiffness {lowest} at the equilibrium");
}

#[test]
fn small_loads_are_solved_from_a_cold_start_too() {
    for force in [0.1, 1.0, 5.0] {
        for clearance in [5e-6, 10e-6, 40e-6] {
            let mut conditions = FREE;
            conditions[2] = Condition::Load(-force);
            let task = problem(table_4_1(clearance), conditions);
            let solution = solve(&task).unwrap_or_else(|error| panic!("{force} N: {error}"));
            let held = solution.force_on_inner.z;
            assert!((held - force).abs() <= 1e-9 * force + 2e-9, "{held} N of {force} N");
        }
    }
}

#[test]
fn gravity_lays_loose_balls_onto_the_races() {
    let mut task = problem(table_4_1(20e-6), [Condition::Displacement(0.0); 5]);
    task.gravity = Vector3::new(0.0, 0.0, -9.81);
    task.ball_phase = 0.0;
    let solution = solve(&task).unwrap();
    let weight = task.ball_mass * 9.81;
    for ball in &solution.balls {
        let (sin, _) = ball.azimuth.sin_cos();
        let (lower, upper) =
            if sin < 0.0 { (ball.outer, ball.inner) } else { (ball.inner, ball.outer) };
        let carried = weight * sin.abs();
        if carried > 1e-6 * weight {
            assert!((lower.normal_load - carried).abs() <= 1e-9 * weight);
            assert_eq!(upper.normal_load, 0.0);
        }
    }
}

/// A groove is a whole torus to the model, whose far side no race has: one race lifted over the other presses balls there.
#[test]
fn a_ball_that_races_press_past_90_deg_is_an_error() {
    // More play than the grooves are wider than the ball: centres of curvature have passed each other.
    let mut small = table_4_1(5e-6);
    small.inner.centre_radius -= 0.5e-3;
    let mut found = 0;
    for tenths in 0..40 {
        let mut conditions = [Condition::Displacement(0.0); 5];
        conditions[0] = Condition::Displacement(1e-4 * f64::from(tenths));
        for gravity in [0.0, 9.81] {
            let mut task = problem(small, conditions);
            task.gravity = Vector3::new(0.0, 0.0, -gravity);
            match solve(&task) {
                Err(StaticsError::BallOutside { degrees, .. }) => {
                    assert!(degrees.abs() > 90.0);
                    found += 1;
                }
                Err(other) => panic!("{tenths}: {other}"),
                Ok(solution) => {
                    for ball in &solution.balls {
                        for contact in [&ball.inner, &ball.outer] {
                            let pressed = contact.normal_load > 2.1 * task.ball_mass * gravity;
                            let angle = contact.contact_angle.to_degrees();
                            assert!(!pressed || angle.abs() <= 90.0, "{tenths}: {angle}");
                        }
                    }
                }
            }
        }
    }
    assert!(found > 0);
}

#[test]
fn a_soft_direction_that_holds_is_determinate() {
    // One ball right under the load holds the race along X by the swivel of its contact line
    // alone, like a link of length L between the groove centres: Q/L, a small part of 3Q/(2δ).
    let geometry = table_4_1(5e-6);
    for (load, ratio) in [(0.03, 1e-5..5e-5), (1e-4, 2e-7..1e-6)] {
        let mut conditions = [Condition::Displacement(0.0); 5];
        conditions[0] = Condition::Load(0.0);
        conditions[2] = Condition::Load(-load);
        let mut task = problem(geometry, conditions);
        task.ball_phase = -std::f64::consts::FRAC_PI_2;
        let solution = solve(&task).unwrap();
        let loaded = solution.balls.iter().filter(|ball| ball.inner.normal_load > 0.0);
        assert_eq!(loaded.count(), 1);
        let ball = &solution.balls[0];
        let overlap = ball.inner.approach + ball.outer.approach;
        let grooves = geometry.inner.groove_radius + geometry.outer.groove_radius;
        let link = grooves - 2.0 * geometry.ball_radius + overlap;
        let (along, across) = (1.5 * load / overlap, load / link);
        // An overlap of 0.4 nm at a radius of 30 mm is known to some 1e-7.
        assert!((solution.stiffness[(0, 0)] / across - 1.0).abs() <= 1e-6);
        assert!((solution.stiffness[(2, 2)] / along - 1.0).abs() <= 1e-6);
        assert!(ratio.contains(&(across / along)), "{:e}", across / along);
        assert_eq!(solution.determinacy, Determinacy::Determinate, "{load} N");
    }
}

#[test]
fn an_unloaded_ball_is_shown_inside_its_room() {
    // On the line of both groove centres; the gap divides as the room in the two grooves does, so
    // that a ball that fills neither is shown between both.
    let (clearance, lift) = (20e-6, 4e-6);
    let mut conditions = [Condition::Displacement(0.0); 5];
    conditions[2] = Condition::Displacement(lift);
    let geometry = table_4_1(clearance);
    let mut task = problem(geometry, conditions);
    task.ball_phase = std::f64::consts::FRAC_PI_2;
    let solution = solve(&task).unwrap();
    let rooms =
        [geometry.inner, geometry.outer].map(|race| race.groove_radius - geometry.ball_radius);
    // Ball 1 on top, where the lifted race has come closer, and ball 5 opposite.
    for (ball, gap) in
        [(&solution.balls[0], clearance - lift), (&solution.balls[4], clearance + lift)]
    {
        let share = |room: f64| gap * room / (rooms[0] + rooms[1]);
        // Differences of lengths of 30 mm.
        assert!((ball.inner.approach + share(rooms[0])).abs() <= 1e-16);
        assert!((ball.outer.approach + share(rooms[1])).abs() <= 1e-16);
        assert_eq!(ball.inner.normal_load + ball.outer.normal_load, 0.0);
        // Groove bottom of the outer race, less gap and ball radius.
        let height = 31.953e-3 - share(rooms[1]) - geometry.ball_radius;
        assert!((ball.position.z.abs() - height).abs() <= 1e-16);
    }
}

/// The race may tilt until its groove has moved by a ball radius at the pitch circle, some 13°; a bearing with
/// much clearance tilts by half a degree before anything resists.
#[test]
fn a_loose_race_tilts_far_under_a_small_moment() {
    let geometry = table_4_1(60e-6);
    let mut conditions = [Condition::Displacement(0.0); 5];
    conditions[3] = Condition::Load(1.0);
    let solution = solve(&problem(geometry, conditions)).unwrap();
    let tilt = solution.coordinates[3];
    assert!(tilt > geometry.ball_radius && tilt < 2.0 * geometry.ball_radius, "{tilt}");
    // Statics leaves 1e-11 of its loads.
    assert!((solution.loads[3] - 1.0).abs() <= 1e-9, "{}", solution.loads[3]);
}
