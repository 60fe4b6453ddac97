//! Creep by inverse Laplace transforms against its closed forms.

use nalgebra::Complex;
use verification::oracles::creep::{OnBushing, inverse};

type C = Complex<f64>;

/// A standard solid creeps by a single exponential.
#[test]
fn standard_solid() {
    let (relaxed, gain, tau) = (3.0, 0.5, 2.0);
    let k = |s: C| (s * tau / (s * tau + 1.0) * gain + 1.0) * relaxed;
    let on = OnBushing { mass: 0.0, stiffness: k };
    let late = tau * (1.0 + gain);
    let step = |t: f64| (t - gain * late / (1.0 + gain) * (1.0 - (-t / late).exp())) / relaxed;
    for t in [0.3, 1.0, 5.0, 20.0] {
        let (exact, found) = (step(t) - step((t - 0.25).max(0.0)), on.after_ramp(1.0, 0.25, t, 24));
        assert!((found - exact / 0.25).abs() <= 1e-8, "{t}: {found} for {}", exact / 0.25);
    }
}

/// A mass on a spring and a dashpot rings.
#[test]
fn swinging() {
    let (mass, k, c) = (2.0, 800.0, 4.0);
    let on = OnBushing { mass, stiffness: |s: C| s * c + k };
    let (own, decay) = (20.0f64, 1.0f64);
    let swing = (own * own - decay * decay).sqrt();
    for t in [0.05, 0.2, 0.9] {
        // Transform of a sudden load.
        let found = inverse(|s: C| ((on.stiffness)(s) + s * s * mass).inv() / s, t, 40);
        let (sin, cos) = (swing * t).sin_cos();
        let exact = (1.0 - (-decay * t).exp() * (cos + decay / swing * sin)) / k;
        assert!((found - exact).abs() <= 1e-7 / k, "{t}: {found} for {exact}");
    }
}
