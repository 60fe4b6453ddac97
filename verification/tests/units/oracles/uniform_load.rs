//! A bearing under an axial load alone.

use verification::oracles::hertz;
use verification::oracles::uniform_load::UniformLoad;

/// Bearing of Table 5.3, steel E 210 GPa. Race radii, which the table does not state, are
/// where ball and race touch: pitch ∓ r cos α.
fn table_5_3(stiffness_of: fn(hertz::RelativeRadii) -> f64) -> UniformLoad {
    let (ball, groove, pitch) = (5.953e-3_f64, 6.6e-3_f64, 30e-3_f64);
    let free_angle = 35.0_f64.to_radians();
    let inset = ball * free_angle.cos();
    let inner = hertz::ball_on_race(ball, pitch - inset, groove, 1.0);
    let outer = hertz::ball_on_race(ball, pitch + inset, groove, -1.0);
    UniformLoad {
        balls: 11,
        centre_distance: 2.0 * (groove - ball),
        free_angle,
        stiffness: hertz::in_series(stiffness_of(inner), stiffness_of(outer)),
    }
}

#[test]
fn table_5_3_under_445_n() {
    let exact = table_5_3(|radii| hertz::exact(radii, 1.0, 210e9 / 0.91).stiffness);
    let found = exact.solve(445.0);
    assert!((found.contact_angle.to_degrees() - 35.26).abs() <= 0.005, "{found:?}");
    assert!((found.ball_load - 70.1).abs() <= 0.05, "{found:?}");
    // Four micrometres to three digits follow from the exact stiffness; the fit gives 4.16.
    assert!((found.approach - 4.14e-6).abs() <= 0.005e-6, "{found:?}");
    let fit = |radii| hertz::hamrock_brewe(radii, 1.0, 210e9 / 0.91).stiffness;
    assert!((table_5_3(fit).solve(445.0).approach - 4.156e-6).abs() <= 0.001e-6);
}

#[test]
fn solution_satisfies_the_stretched_triangle() {
    let bearing = table_5_3(|radii| hertz::exact(radii, 1.0, 210e9 / 0.91).stiffness);
    for load in [1e-3, 1.0, 445.0, 2e4] {
        let found = bearing.solve(load);
        let carried = 11.0 * found.ball_load * found.contact_angle.sin();
        assert!((carried / load - 1.0).abs() <= 1e-13, "{load} N: {carried}");
        // Pythagoras on the groove centres, independent of the angle's formulas.
        let radial = bearing.centre_distance * bearing.free_angle.cos();
        let axial = bearing.centre_distance * bearing.free_angle.sin() + found.axial_displacement;
        let distance = bearing.centre_distance + found.approach;
        assert!((radial.hypot(axial) - distance).abs() <= 1e-17, "{load} N");
    }
}
