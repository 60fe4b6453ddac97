//! Automatic derivatives against those by hand.

use verification::oracles::hyperdual::Jet;

/// sin(xy)·√(x² + y) + cos x
fn sample(x: f64, y: f64) -> Jet<2> {
    let (x, y) = (Jet::variable(x, 0), Jet::variable(y, 1));
    (x * y).sin() * (x.square() + y).sqrt() + x.cos()
}

#[test]
fn derivatives_equal_those_worked_by_hand() {
    let (x, y) = (0.7_f64, 1.9_f64);
    let (sin, cos) = (x * y).sin_cos();
    let root = (x * x + y).sqrt();
    let jet = sample(x, y);
    let along_x = y * cos * root + sin * x / root - x.sin();
    let along_y = x * cos * root + sin * 0.5 / root;
    let mixed = (cos - x * y * sin) * root + y * cos * 0.5 / root + x * cos * x / root
        - sin * 0.5 * x / root.powi(3);
    assert!((jet.gradient[0] - along_x).abs() <= 1e-14);
    assert!((jet.gradient[1] - along_y).abs() <= 1e-14);
    assert!((jet.hessian[0][1] - mixed).abs() <= 1e-14);
}

#[test]
fn hessian_is_symmetric_and_the_slope_of_the_gradient() {
    let (x, y, step) = (0.7, 1.9, 1e-5);
    let jet = sample(x, y);
    assert!(jet.hessian[0][1] == jet.hessian[1][0]);
    for i in 0..2 {
        let dx = sample(x + step, y).gradient[i] - sample(x - step, y).gradient[i];
        let dy = sample(x, y + step).gradient[i] - sample(x, y - step).gradient[i];
        // Central difference: h² truncation and ε/h rounding are both near 1e-10.
        assert!((dx / (2.0 * step) - jet.hessian[i][0]).abs() <= 1e-9);
        assert!((dy / (2.0 * step) - jet.hessian[i][1]).abs() <= 1e-9);
    }
}
