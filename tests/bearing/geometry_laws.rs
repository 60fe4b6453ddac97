//! Laws of sizes: what a clearance means, what a ball weighs and how it turns.

use crate::common;

use bearing_dynamics::ch2_housing::bearing::geometry::ClearanceThrough;
use bearing_dynamics::ch2_housing::bearing::inertia;
use bearing_dynamics::equilibrium::statics::solve;
use bearing_dynamics::members::body::Condition;
use common::{problem, table_4_1, table_5_3};

#[test]
fn a_clearance_is_how_far_the_race_moves() {
    use ClearanceThrough::{Ball, InnerRace, OuterRace};
    let clearance = 20e-6;
    for geometry in [table_4_1(0.0), table_5_3()] {
        for through in [Ball, InnerRace, OuterRace] {
            let loose = geometry.with_radial_clearance(clearance, through);
            // Straight down onto one ball; 5 nm before and after it touches. Groove centres are
            // some 0.6 mm apart, so that rounding and a sideways slope are far below that.
            let load = |down: f64| {
                let mut held = [Condition::Displacement(0.0); 5];
                held[2] = Condition::Displacement(-down);
                let mut task = problem(loose, held);
                task.ball_phase = -std::f64::consts::FRAC_PI_2;
                solve(&task).unwrap().balls[0].inner.normal_load
            };
            assert_eq!(load(clearance - 5e-9), 0.0, "{through:?}");
            assert!(load(clearance + 5e-9) > 0.0, "{through:?}");
        }
    }
}

#[test]
fn a_ball_is_a_stack_of_discs() {
    let (radius, density) = (5.953e-3, 7850.0);
    let ball = inertia::ball(radius, density);
    let (mut mass, mut axial) = (0.0, 0.0);
    let slices = 20_000;
    for i in 0..slices {
        // From pole to pole; a disc has the inertia ½ m r² about its axis.
        let height = 2.0 * radius / f64::from(slices);
        let at = -radius + height * (f64::from(i) + 0.5);
        let square = radius * radius - at * at;
        let disc = density * std::f64::consts::PI * square * height;
        mass += disc;
        axial += 0.5 * disc * square;
    }
    // The midpoint rule is off by the second derivative, 1/(2 n²) here: 1e-9.
    assert!((ball.mass / mass - 1.0).abs() <= 1e-8);
    assert!((ball.axial / axial - 1.0).abs() <= 1e-8);
    assert_eq!(ball.axial, ball.transverse);
}
