//! The minimiser of the oracles.

use verification::oracles::trust_region::{Expansion, minimise};

#[test]
fn finds_the_bottom_of_rosenbrocks_valley() {
    let minimum = minimise(&[-1.2, 1.0], 0.1, |p| {
        let (x, y) = (p[0], p[1]);
        let bend = y - x * x;
        Expansion {
            value: 100.0 * bend * bend + (1.0 - x).powi(2),
            noise: f64::EPSILON * (100.0 * bend * bend + (1.0 - x).powi(2)),
            gradient: vec![-400.0 * x * bend - 2.0 * (1.0 - x), 200.0 * bend],
            hessian: vec![
                vec![1200.0 * x * x - 400.0 * y + 2.0, -400.0 * x],
                vec![-400.0 * x, 200.0],
            ],
        }
    });
    assert!((minimum.point[0] - 1.0).abs() <= 1e-12, "{:?}", minimum.point);
    assert!((minimum.point[1] - 1.0).abs() <= 1e-12, "{:?}", minimum.point);
}

#[test]
fn leaves_a_saddle() {
    // x⁴/4 − x²/2 + y²/2 from (0, 1) with a nudge: minima at x = ±1.
    let minimum = minimise(&[1e-3, 1.0], 0.1, |p| Expansion {
        value: p[0].powi(4) / 4.0 - p[0] * p[0] / 2.0 + p[1] * p[1] / 2.0,
        noise: f64::EPSILON * (p[0] * p[0] + p[1] * p[1]),
        gradient: vec![p[0].powi(3) - p[0], p[1]],
        hessian: vec![vec![3.0 * p[0] * p[0] - 1.0, 0.0], vec![0.0, 1.0]],
    });
    assert!((minimum.point[0] - 1.0).abs() <= 1e-12, "{:?}", minimum.point);
}
