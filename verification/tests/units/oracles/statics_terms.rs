//! Terms of the energy in the static oracle: derivatives, values, directions.

use verification::oracles::statics::{Coordinates, OracleBearing};

/// Axis and centre far from the trivial, both contacts loaded.
fn sample() -> (OracleBearing, Coordinates, f64, [f64; 2]) {
    let (sin, cos) = 0.3_f64.sin_cos();
    let mut bearing = OracleBearing::at_origin(
        9,
        6.0e-3,
        [26.05e-3, 2e-4, 6.1e-3],
        [25.6e-3, -2e-4, 6.3e-3],
        [5e10, 3e10],
        0.2,
    );
    bearing.outer_rotation = [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]];
    (bearing, [6e-5, -3e-5, 4e-5, 0.303, 0.004], 1.1, [5e-5, 25.93e-3])
}

#[test]
fn terms_have_the_derivatives_of_their_values() {
    let (bearing, race, azimuth, ball) = sample();
    let terms = |shift: [f64; 7]| {
        let race: Coordinates = std::array::from_fn(|i| race[i] + shift[i]);
        let ball = [ball[0] + shift[5], ball[1] + shift[6]];
        let inner = bearing.inner_term(&race, azimuth, ball).expect("inner contact");
        let outer = bearing.outer_term(ball).expect("outer contact");
        [inner, outer]
    };
    let here = terms([0.0; 7]);
    for i in 0..7 {
        let (step, unit) = if i == 3 || i == 4 { (4e-7, 0.026) } else { (1e-8, 1.0) };
        let shifted = |amount: f64| {
            let mut shift = [0.0; 7];
            shift[i] = amount;
            terms(shift)
        };
        let (ahead, behind) = (shifted(step), shifted(-step));
        for contact in 0..2 {
            let load = here[contact].gradient[5].hypot(here[contact].gradient[6]);
            let slope = (ahead[contact].value - behind[contact].value) / (2.0 * step);
            let error = (slope - here[contact].gradient[i]).abs() / (unit * load);
            assert!(error <= 1e-6, "gradient {i} of contact {contact}: {error:e}");
            for j in 0..7 {
                let unit_j = if j == 3 || j == 4 { 0.026 } else { 1.0 };
                let slope =
                    (ahead[contact].gradient[j] - behind[contact].gradient[j]) / (2.0 * step);
                let stiffness = here[contact].hessian[i][j];
                // Contact stiffness: load over approach, at most 50 µm.
                let size = unit * unit_j * load / 5e-5;
                let error = (slope - stiffness).abs() / size;
                assert!(error <= 1e-5, "Hessian {i}, {j} of contact {contact}: {error:e}");
                assert!(stiffness == here[contact].hessian[j][i], "symmetry {i}, {j}");
            }
        }
    }
}

#[test]
fn values_are_those_of_the_plain_approach() {
    let (bearing, race, azimuth, ball) = sample();
    let energy = |k: f64, approach: f64| 0.4 * k * approach.powf(2.5);
    let inner = bearing.inner_term(&race, azimuth, ball).expect("inner contact").value;
    let outer = bearing.outer_term(ball).expect("outer contact").value;
    let plain_inner = energy(5e10, bearing.approach_inner(&race, azimuth, ball));
    let plain_outer = energy(3e10, bearing.approach_outer(ball));
    assert!((inner / plain_inner - 1.0).abs() <= 1e-11);
    assert!((outer / plain_outer - 1.0).abs() <= 1e-11);
}

#[test]
fn azimuth_runs_from_y_towards_z_and_the_race_pushes_the_ball_ahead() {
    let bearing = OracleBearing::at_origin(
        4,
        5.953e-3,
        [26.06e-3, 0.0, 6.013e-3],
        [25.643e-3, 0.0, 6.31e-3],
        [5e10, 3e10],
        0.0,
    );
    let (_, loads, balls) = bearing.evaluate(&[0.0, 0.0, 8e-6, 0.0, 0.0]);
    assert!(loads[2] > 0.0 && balls[1].inner.load > 0.0, "{balls:?}");
    assert!([0, 2, 3].iter().all(|&ball: &usize| balls[ball].inner.load <= 1.0), "{balls:?}");
    let (_, loads, balls) = bearing.evaluate(&[5e-5, 0.0, 0.0, 0.0, 0.0]);
    assert!(loads[0] > 0.0 && balls[0].inner.angle > 0.0 && balls[0].outer.angle > 0.0);
}
