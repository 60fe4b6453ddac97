//! Balls at the edges of what the model can hold: with nothing but their own speed to hold them,
//! pressed out of their grooves, and in a preload that has slid away.

use crate::common;

use bearing_dynamics::ch2_housing::bearing::geometry::{BearingGeometry, ClearanceThrough};
use bearing_dynamics::equilibrium::statics::{Determinacy, StaticsError, solve};
use bearing_dynamics::members::body::Condition;
use common::problem;

/// An angular-contact bearing held askew at 100 rpm, on which a search that starts between the
/// races ends before it has found the ball's place.
#[test]
fn a_ball_between_askew_races_finds_its_place() {
    let ball = 3.932619087933043e-3;
    let geometry = BearingGeometry::angular_contact(
        10,
        15.04009509982684e-3,
        ball / 0.970873786407767,
        ball / 0.9433962264150944,
        ball,
        15f64.to_radians(),
    )
    .with_radial_clearance(40e-6, ClearanceThrough::OuterRace);
    let held = [
        83.96829216157062e-6,
        14.61468117431637e-6,
        -18.16320472417738e-6,
        -0.003975701278768757,
        0.0024141405092271574,
    ];
    let mut task = problem(geometry, held.map(Condition::Displacement));
    task.ball_phase = 105.14244264870685f64.to_radians();
    // A third of 100 rpm, about what the cage does.
    task.orbital_speed = 0.37 * 100.0 * std::f64::consts::PI / 30.0;
    let solution = solve(&task).unwrap();
    for (index, ball) in solution.balls.iter().enumerate() {
        let (sin, cos) = ball.azimuth.sin_cos();
        let centrifugal = task.ball_mass
            * task.orbital_speed.powi(2)
            * (ball.position.y * cos + ball.position.z * sin);
        let on_races = ball.inner.force_on_race + ball.outer.force_on_race;
        let radial = centrifugal - (on_races.y * cos + on_races.z * sin);
        // Newton ends at 1e-11 of the load; rounding of overlaps leaves about 1e-9 N.
        let allowed = 1e-8 * ball.inner.normal_load.max(ball.outer.normal_load) + 2e-9;
        assert!(radial.abs() <= allowed, "ball {}: radial {radial:e} N", index + 1);
        assert!(on_races.x.abs() <= allowed, "ball {}: axial {:e} N", index + 1, on_races.x);
    }
}

/// A load that turns one contact of this small bearing past 90° while its neighbour still carries.
#[test]
fn a_ball_pressed_out_of_its_grooves_is_an_error_that_names_it() {
    let nominal = 5e-3;
    let geometry = BearingGeometry::deep_groove(
        8,
        21e-3,
        nominal / 0.9875722345775562,
        31e-3,
        nominal / 0.9790317931249473,
        nominal,
    )
    .with_radial_clearance(40e-6, ClearanceThrough::Ball);
    let zero = Condition::Load(0.0);
    let force = 44485.465689857156;
    let tilt = Condition::Displacement(-0.003032714644415977);
    let conditions = [Condition::Load(force), zero, Condition::Load(-force), zero, tilt];
    let mut task = problem(geometry, conditions);
    task.ball_phase = 45f64.to_radians();
    let error = solve(&task).unwrap_err();
    assert!(
        matches!(&error, StaticsError::BallOutside { ball, .. } if ball == "ball 2"),
        "{error}"
    );
}

/// Free along X and Z, the bearing pushes itself out of its preload until rounding alone is left.
#[test]
fn a_preload_that_has_slid_away_holds_nothing() {
    let geometry = BearingGeometry::angular_contact(
        8,
        26e-3,
        5.078_080_717_522_497e-3,
        5.121316701954446e-3,
        5e-3,
        13.930546377604271f64.to_radians(),
    )
    .with_radial_clearance(-5e-6, ClearanceThrough::Ball);
    let (held, free) = (Condition::Displacement(0.0), Condition::Load(0.0));
    let mut task = problem(geometry, [free, held, free, held, held]);
    task.ball_phase = 22.5f64.to_radians();
    let solution = solve(&task).unwrap();
    assert!(matches!(solution.determinacy, Determinacy::Indeterminate { .. }));
}
