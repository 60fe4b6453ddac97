//! Bonded bushings in elements of high degree: rules, closed forms, convergence, other programs.

use nalgebra::Complex;
use verification::oracles::bonded_bushing::{
    Motion, Section, bessel_i, bessel_k, incompressible_stiffness, lobatto, radial_stiffness,
    stiffness,
};

type C = Complex<f64>;

const BODY: Section = Section { inner: 0.02, outer: 0.04, length: 0.04 };

fn radial(shear: C, p: usize, layers: i32) -> C {
    radial_stiffness(BODY, shear, 64.7e6, p, layers)
}

#[test]
fn the_rule_integrates_and_differentiates_polynomials() {
    let rule = lobatto(6);
    for degree in 0..=11i32 {
        let sum: f64 = rule.points.iter().zip(&rule.weights).map(|(x, w)| w * x.powi(degree)).sum();
        let exact = if degree % 2 == 0 { 2.0 / f64::from(degree + 1) } else { 0.0 };
        assert!((sum - exact).abs() <= 1e-14, "{degree}");
    }
    for i in 0..=6 {
        let slope: f64 = (0..=6).map(|j| rule.slopes[i][j] * rule.points[j].powi(5)).sum();
        assert!((slope - 5.0 * rule.points[i].powi(4)).abs() <= 1e-12);
    }
}

/// A long bushing, held against plane strain: Adkins and Gent for rubber that keeps its volume.
#[test]
fn a_long_bushing_is_in_plane_strain() {
    let (a, b) = (0.02f64, 0.04f64);
    let squares = a * a + b * b;
    let exact = 4.0 * std::f64::consts::PI * squares / (squares * (b / a).ln() - (b * b - a * a));
    let per_length = |length: f64| {
        let body = Section { length, ..BODY };
        radial_stiffness(body, C::new(1.0, 0.0), 1e5, 5, 2).re
    };
    // Two lengths, so that the ends drop out.
    let middle = (per_length(1.2) - per_length(0.8)) / 0.4;
    // μ/B, and slender rectangles.
    assert!((middle / exact - 1.0).abs() <= 2e-3, "{middle} {exact}");
}

/// Torsion is exact at any length, 4πμL/(1/a² − 1/b²); long bushings shear by 2πμL/ln(b/a) along the axis.
#[test]
fn torsion_and_axial_shear_are_the_closed_forms() {
    let (a, b, mu) = (0.02f64, 0.04f64, C::new(0.7e6, 0.2e6));
    let twist = stiffness(BODY, Motion::Torsional, mu, 64.7e6, 6, 3);
    let exact = mu * (4.0 * std::f64::consts::PI * 0.04 / (1.0 / (a * a) - 1.0 / (b * b)));
    // Polynomials for r and 1/r over two thirds of the wall.
    assert!((twist - exact).norm() <= 1e-6 * exact.norm(), "{twist} {exact}");
    let of = |length: f64| {
        stiffness(Section { length, ..BODY }, Motion::Axial, C::new(1.0, 0.0), 1e3, 7, 3).re
    };
    let middle = (of(0.4) - of(0.2)) / 0.2;
    let exact = 2.0 * std::f64::consts::PI / (b / a).ln();
    // Two lengths, so that the ends drop out but for how well slender rectangles have them.
    assert!((middle / exact - 1.0).abs() <= 1e-4, "{middle} {exact}");
}

/// A long bushing that tilts is a row of slices that move across: K L²/12 but for shear and ends.
#[test]
fn a_long_bushing_tilts_as_a_row_of_slices() {
    let of = |motion, length: f64| {
        stiffness(Section { length, ..BODY }, motion, C::new(1.0, 0.0), 1e3, 5, 2).re
    };
    let per_length = (of(Motion::Radial, 1.2) - of(Motion::Radial, 0.8)) / 0.4;
    let length = 2.0f64;
    let slices = per_length * length.powi(3) / 12.0;
    let tilt = of(Motion::Conical, length);
    // Ends lack a few of fifty wall thicknesses on each side, which count threefold.
    assert!((tilt / slices - 1.0).abs() <= 0.1, "{tilt} {slices}");
}

#[test]
fn it_is_converged() {
    let mu = C::new(0.7e6, 0.2e6);
    let (coarse, fine) = (radial(mu, 5, 2), radial(mu, 7, 3));
    assert!((coarse - fine).norm() <= 3e-4 * fine.norm(), "{coarse} {fine}");
    assert!(coarse.re > fine.re);
}

#[test]
fn bessel_functions_are_those_of_the_tables() {
    // Abramowitz and Stegun, tables 9.8.
    for (ours, table) in [
        (bessel_i(0, 1.0), 1.266_065_877_752),
        (bessel_i(1, 2.0), 1.590_636_854_637),
        (bessel_k(0, 1.0), 0.421_024_438_241),
        (bessel_k(1, 2.0), 0.139_865_881_817),
    ] {
        assert!((ours - table).abs() <= 1e-11, "{ours} {table}");
    }
}

/// Against the closed form of Adkins and Gent for short bushings, from which it departs with the length of the layer at
/// the sleeves; and against converged elements by others, from which it is within 2 %.
#[test]
fn rubber_that_keeps_its_volume_is_as_others_have_it() {
    let (a, b) = (0.02f64, 0.04f64);
    let (squares, ln) = (a * a + b * b, (b / a).ln());
    let short =
        80.0 * std::f64::consts::PI * squares / (25.0 * squares * ln - 9.0 * (b * b - a * a));
    let over = |length: f64| incompressible_stiffness(Section { length, ..BODY }) / short - 1.0;
    let (two, one) = (over(2e-3), over(1e-3));
    assert!(two <= 0.02 && (one / two - 0.5).abs() <= 0.02, "{two} {one}");
    let kadlowec = Section { inner: 0.00985, outer: 0.0182, length: 0.06 };
    for (section, theirs) in [(BODY, 34.46), (kadlowec, 110.9)] {
        let ours = incompressible_stiffness(section);
        assert!((ours / theirs - 1.0).abs() <= 0.01, "{ours} {theirs}");
    }
}
