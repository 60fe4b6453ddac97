//! Work counts of the static solver, exact on any machine: a lost optimisation fails here.

mod common;

use bearing_dynamics::solver::statics::{Condition, StaticOptions, solve, solve_from};
use common::{FREE, problem, table_4_1, table_5_3};

#[test]
fn cold_starts_take_a_known_number_of_iterations_and_evaluations() {
    let tilt = Condition::Displacement(0.15f64.to_radians());
    let upright = Condition::Displacement(0.0);
    let force = Condition::Load;
    let zero = Condition::Load(0.0);
    // (what, clearance in µm, ball phase in deg, conditions, iterations, evaluations of one ball
    // against one race)
    let cases = [
        ("loose and unloaded", 5.0, 6.0, FREE, 0, 16),
        (
            "radial 1500 N, upright",
            -5.0,
            6.0,
            [zero, zero, force(-1500.0), upright, upright],
            4,
            180,
        ),
        ("radial 1500 N, loose", 5.0, 6.0, [zero, zero, force(-1500.0), upright, upright], 3, 112),
        ("tilt of 3.4.5", -5.0, 11.25, [zero, zero, zero, tilt, zero], 2, 144),
        ("moment of Table 3.7", -5.0, 11.25, [zero, zero, zero, force(2.5), zero], 5, 272),
        ("axial", 5.0, 6.0, [force(500.0), zero, zero, zero, zero], 1, 64),
    ];
    for (what, clearance, phase, conditions, iterations, evaluations) in cases {
        let mut task = problem(table_4_1(clearance * 1e-6), conditions);
        task.ball_phase = f64::to_radians(phase);
        let solution = solve(&task).unwrap();
        assert_eq!(
            (solution.iterations, solution.contact_evaluations),
            (iterations, evaluations),
            "{what}"
        );
    }
}

#[test]
fn a_warm_start_from_the_neighbour_takes_two_iterations() {
    let mut conditions = FREE;
    conditions[0] = Condition::Load(445.0);
    conditions[2] = Condition::Load(-100.0);
    let mut task = problem(table_5_3(), conditions);
    let neighbour = solve(&task).unwrap();
    task.ball_phase += 0.01;
    let warm = solve_from(&task, Some(&neighbour.coordinates), &StaticOptions::default()).unwrap();
    assert_eq!(warm.iterations, 2);
}
