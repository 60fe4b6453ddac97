//! Rubber at a point against its small strains.

use verification::oracles::rubber_point::{Chains, uniaxial};

/// At small strain a suddenly strained bar relaxes between two moduli; at a constant rate the stress is
/// known.
#[test]
fn small_strain_at_a_constant_rate() {
    let chains = Chains { modulus: 1e6, locking: 8.0, bulk: 1e12 };
    let (dt, steps) = (1e-3, 1000);
    let strains: Vec<f64> = (0..=steps).map(|n| 1e-7 * n as f64).collect();
    let course = uniaxial(chains, &[[2.0, 0.25]], &strains, dt, &[0]);
    let c = [0.5, 3.0 / 80.0, 33.0 * 9.0 / (1050.0 * 64.0), 76.0 * 27.0 / (7000.0 * 512.0)];
    let mu = 2e6 * (c.iter().sum::<f64>() + 2595.0 * 81.0 / (673_750.0 * 4096.0));
    let exact = 3.0 * mu * (1e-4 + 2.0 * 0.25 * 1e-4 * (1.0 - (-4.0f64).exp()));
    // Second order in dt/τ but for the first step; strains of 1e-4; μ/B.
    assert!((course[steps][1] / exact - 1.0).abs() <= 2e-4, "{} {exact}", course[steps][1]);
}
