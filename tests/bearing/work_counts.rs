//! Work counts of the static solver and of error control, exact on any machine: a lost optimisation fails here.

use crate::{common, dynamics};

use bearing_dynamics::equilibrium::statics::{StaticOptions, solve, solve_from};
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Stepping};
use common::{FREE, problem, table_4_1, table_5_3};
use dynamics::{RPM, bearing, traction_laws};

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

#[test]
fn error_controlled_runs_take_a_known_number_of_steps() {
    // Table 3.5 at 1000 rpm and 1500 N, default friction, 2 ms.
    let mut task = bearing(table_4_1(-5e-6), [0.0, 0.0, -1500.0, 0.0, 0.0], 1000.0 * RPM);
    task.traction = traction_laws().swap_remove(2);
    // An attempt costs a factorisation and three evaluations, an accepted one another, the start two.
    let mut counts = Vec::new();
    for accuracy in [1e-2, 1e-3, 1e-4] {
        let options = RunOptions {
            integrator: Integrator::Rosenbrock,
            stepping: Stepping::Accuracy(accuracy),
            ..RunOptions::default()
        };
        let mut simulation = Simulation::new(task.clone(), options).unwrap();
        while simulation.time < 2e-3 {
            simulation.step().unwrap();
        }
        let (steps, work) = (simulation.steps, simulation.system.work);
        let attempts = steps + work.rejected_steps;
        assert_eq!(work.factorisations, attempts);
        assert_eq!(work.evaluations, 3 * attempts + steps + 2);
        assert_eq!(work.distance_tests, 16 * work.evaluations);
        assert_eq!(work.slices, 15 * work.loaded_contacts);
        counts.push((steps, work.rejected_steps));
    }
    assert_eq!(counts, [(29, 5), (48, 4), (87, 3)], "accepted and rejected steps");
}
