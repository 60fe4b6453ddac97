//! Beams against Euler, and their shear coefficient.

use verification::oracles::timoshenko::{Beam, shear_coefficient};

#[test]
fn slender_beams_are_eulers() {
    let (h, length) = (1e-3, 1.0);
    let beam = Beam {
        length,
        area: h * h,
        inertia: h.powi(4) / 12.0,
        young: 2e11,
        poisson: 0.3,
        density: 8000.0,
        shear_coefficient: 0.87,
    };
    let scale = (2e11 * h * h / 12.0 / 8000.0f64).sqrt() / std::f64::consts::TAU;
    for (f, root) in beam.frequencies(3).into_iter().zip([1.875_104_07, 4.694_091_13, 7.854_757_44])
    {
        let euler = f64::powi(root, 2) * scale;
        // Shear and rotation take (h/L)² times some tens.
        assert!((f / euler - 1.0).abs() <= 1e-4, "{f} {euler}");
    }
}

#[test]
fn coefficient_of_a_tall_thin_section() {
    // Plane stress: 5(1+ν)/(6+5ν).
    let exact = 5.0 * 1.3 / 7.5;
    assert!((shear_coefficient(1e-3, 1.0, 0.3) / exact - 1.0).abs() <= 1e-4);
}
