//! Complete elliptic integrals against a table and a relation of Legendre.

use std::f64::consts::FRAC_PI_2;

use verification::oracles::elliptic::{TABLE_17_1, e_of_complement, k_of_complement};

#[test]
fn quadrature_agrees_with_the_table() {
    for row in &TABLE_17_1 {
        let k = k_of_complement(row.complement);
        let e = e_of_complement(row.complement);
        assert!((k / row.k - 1.0).abs() <= 1e-14, "K at m₁ = {}: {k}", row.complement);
        assert!((e / row.e - 1.0).abs() <= 1e-14, "E at m₁ = {}: {e}", row.complement);
    }
}

#[test]
fn legendre_relation_holds_for_axis_ratios_to_1000() {
    for axis_ratio in [1.0_f64, 1.5, 3.0, 10.0, 31.0, 100.0, 1000.0] {
        let m1 = axis_ratio.powi(-2);
        let m = 1.0 - m1;
        let (k, e) = (k_of_complement(m1), e_of_complement(m1));
        let (k1, e1) = if m > 0.0 { (k_of_complement(m), e_of_complement(m)) } else { continue };
        let relation = e * k1 + e1 * k - k * k1;
        // The terms are up to four times their sum.
        assert!((relation - FRAC_PI_2).abs() <= 2e-14, "{axis_ratio}");
    }
}
