//! Elliptic contacts against closed forms, other arithmetic and numbers that are stated.

use std::f64::consts::PI;

use verification::oracles::elliptic::{e_of_complement, k_of_complement};
use verification::oracles::hertz::{
    PRECISION, RelativeRadii, ball_on_race, exact, hamrock_brewe, potential_integrals,
};

const STEEL: f64 = 210e9 / (1.0 - 0.09);

#[test]
fn sphere_on_plane_has_its_closed_form() {
    let (radius, load) = (0.01, 250.0);
    let found = exact(RelativeRadii { rolling: radius, transverse: radius }, load, STEEL);
    // a³ = 3PR/(4E*), δ = a²/R, p₀ = 3P/(2πa²), E* = E′/2.
    let a = (1.5 * load * radius / STEEL).cbrt();
    for (value, closed) in [
        (found.semi_axis_rolling, a),
        (found.semi_axis_transverse, a),
        (found.approach, a * a / radius),
        (found.peak_pressure, 1.5 * load / (PI * a * a)),
        (found.stiffness, 2.0 / 3.0 * STEEL * radius.sqrt()),
    ] {
        assert!((value / closed - 1.0).abs() <= 2e-14, "{value} for {closed}");
    }
}

#[test]
fn quadrature_of_the_potential_lines_up_with_k_and_e() {
    for ratio in [1.001_f64, 1.3, 3.0, 8.0, 25.0, 100.0] {
        let m1 = ratio.powi(-2);
        let (k, e) = (k_of_complement(m1), e_of_complement(m1));
        let (rolling, transverse, approach) = potential_integrals(ratio);
        assert!((approach / (2.0 * k / ratio) - 1.0).abs() <= 1e-14);
        // Integration by parts: ∫ over the minor axis + ∫ over the major axis = 2E/(a²b).
        let total = rolling + transverse;
        assert!((total / (2.0 * e / ratio) - 1.0).abs() <= 1e-14, "{ratio}");
        // ∫ over the major axis = 2(K − E)/(b³ (1 − m₁)), ill-conditioned near a circle.
        let major = 2.0 * (k - e) / (ratio.powi(3) * (1.0 - m1));
        let conditioning = k / (k - e);
        assert!((transverse / major - 1.0).abs() <= 4e-15 * conditioning, "{ratio}");
    }
}

#[test]
fn agrees_with_forty_digit_arithmetic() {
    for row in &PRECISION {
        let radii = RelativeRadii { rolling: 5e-3, transverse: 5e-3 * row.ratio };
        let found = exact(radii, 100.0, STEEL);
        for (value, reference) in [
            (found.stiffness, row.stiffness),
            (found.semi_axis_transverse, row.semi_axis_transverse),
            (found.semi_axis_rolling, row.semi_axis_rolling),
            (found.peak_pressure, row.peak_pressure),
        ] {
            let error = (value / reference - 1.0).abs();
            assert!(error <= 2e-14, "ratio {}: {value}, error {error:e}", row.ratio);
        }
    }
}

#[test]
fn stiffness_is_that_of_the_solution_and_turning_the_ellipse_changes_nothing() {
    let radii = RelativeRadii { rolling: 4.59e-3, transverse: 0.6e-3 };
    let turned = RelativeRadii { rolling: 0.6e-3, transverse: 4.59e-3 };
    let (one, other) = (exact(radii, 80.0, STEEL), exact(turned, 80.0, STEEL));
    assert!((one.stiffness * one.approach.powf(1.5) / 80.0 - 1.0).abs() <= 1e-14);
    assert!((one.approach / other.approach - 1.0).abs() <= 1e-14);
    assert!((one.semi_axis_rolling / other.semi_axis_transverse - 1.0).abs() <= 1e-13);
    let fit = hamrock_brewe(turned, 80.0, STEEL);
    assert!((fit.stiffness / other.stiffness - 1.0).abs() <= 0.02);
}

#[test]
fn table_2_2_stiffness() {
    let inner = ball_on_race(5.955e-3, 20.047e-3, 6.013e-3, 1.0);
    let outer = ball_on_race(5.955e-3, 31.953e-3, 6.310e-3, -1.0);
    for (found, stated) in [
        (hamrock_brewe(inner, 1.0, STEEL).stiffness, 5.695e10),
        (hamrock_brewe(outer, 1.0, STEEL).stiffness, 2.937e10),
        (exact(inner, 1.0, STEEL).stiffness, 5.304e10),
        (exact(outer, 1.0, STEEL).stiffness, 2.942e10),
    ] {
        // Half a unit of the last digit stated.
        assert!((found - stated).abs() <= 0.5e7, "{found:e} for {stated:e}");
    }
}
