//! Oracles that stand in the folder of their case.

use verification::cases::assembly_fits_2_4_1::oracle::Ring;
use verification::cases::cylinder_on_block_table_2_1::oracle::{Block, Plane};
use verification::cases::line_contact_plane_strain::oracle::{line, von_mises, von_mises_peak};

/// A bore in a body without end opens by p a (1 + ν)/E whatever holds it far away; a thin ring by
/// its thickness under the modulus of a layer held sideways.
#[test]
fn limits_of_thick_and_thin_rings() {
    let (young, poisson) = (2.1e11, 0.3);
    let wide = Ring { young, poisson, inner: 0.03, outer: 300.0 };
    assert!((wide.compliance() / (0.03 * 1.3 / young) - 1.0).abs() <= 1e-6);
    let thin = Ring { young, poisson, inner: 0.03, outer: 0.030_003 };
    let modulus = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    assert!((thin.compliance() / (3e-6 / modulus) - 1.0).abs() <= 1e-3);
}

/// A block of sixty half widths: Hertz' pressure under the load found, and von Mises stress of 0.5575
/// of it in plane strain (the block's own size adds some 1 %), of just it at the surface in plane
/// stress (the centres of the first cells, a fortieth of a half width deep, have 3 % less).
#[test]
fn large_block_is_that_of_hertz() {
    let (b, radius) = (1e-4, 0.0355);
    for (plane, modulus, stress, room) in
        [(Plane::Strain, 210e9 / 0.91, 0.5575, 0.02), (Plane::Stress, 210e9, 1.0, 0.04)]
    {
        let block = Block {
            half_width: 60.0 * b,
            height: 60.0 * b,
            fine: 1.5 * b,
            cell: b / 20.0,
            young: 210e9,
            poisson: 0.3,
            plane,
        };
        let indentation = b * b / (4.0 * radius) * (2.0 * 120f64.ln() - 0.43);
        let found = block.factor().pressed(radius, indentation);
        let peak = (found.load * modulus / (std::f64::consts::PI * radius)).sqrt();
        assert!((found.pressure / peak - 1.0).abs() <= 0.002, "{plane:?}: {found:?}");
        assert!(
            (found.von_mises / found.pressure / stress - 1.0).abs() <= room,
            "{plane:?}: {found:?}"
        );
    }
}

#[test]
fn pressure_sums_to_the_load_and_stress_peaks_where_textbooks_say() {
    let line = line(7e5, 0.0355, 2.1e11, 0.3);
    let steps = 20_000;
    let h = line.half_width / f64::from(steps);
    let sum: f64 = (0..steps).map(|i| 2.0 * h * line.pressure((f64::from(i) + 0.5) * h)).sum();
    assert!((sum / 7e5 - 1.0).abs() <= 1e-5, "{sum}");
    let across = 0.5 * line.half_width;
    assert!((2.0 * line.force_between(0.0, across + line.half_width) / 7e5 - 1.0).abs() <= 1e-12);
    let part: f64 = (0..steps / 2).map(|i| h * line.pressure((f64::from(i) + 0.5) * h)).sum();
    assert!((line.force_between(0.0, across) / part - 1.0).abs() <= 1e-6, "{part}");
    let [stress, depth] = von_mises_peak(0.3);
    assert!((stress - 0.5575).abs() <= 5e-4 && (depth - 0.704).abs() <= 1e-3, "{stress} {depth}");
    // At the surface all three press, and only Poisson's share differs.
    assert!((von_mises(0.0, 0.3) - 0.4).abs() <= 1e-12);
}
