//! Dynamic stiffness and damping ratio of a bushing in a cycle (3.13)–(3.14).

use crate::ch2_housing::elastomer::ElastomerError;
use crate::ch2_housing::elastomer::maxwell::{Maxwell, complex_factor, complex_factor_of_steps};
use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

/// Dynamic stiffness and damping ratio of a force–displacement loop or of a complex stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hysteresis {
    /// K_d, N/m.
    pub dynamic_stiffness: f64,
    /// η_d.
    pub damping_ratio: f64,
}

/// Energy enclosed by a closed loop of displacement (m) and force (N), J; positive if the force leads. The points are
/// joined by straight lines, the last to the first.
pub fn loop_area(points: &[[f64; 2]]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| 0.5 * (a[1] + b[1]) * (b[0] - a[0])).sum()
}

/// K_d = F_max/x_max (3.13) and η_d = E_d/(π K_d x_max²) (3.14) of a closed loop of displacement (m) and force (N),
/// from the largest magnitudes. `None` if displacement or force is zero.
pub fn of_loop(points: &[[f64; 2]]) -> Option<Hysteresis> {
    let largest = |i: usize| points.iter().map(|p| p[i].abs()).fold(0.0, f64::max);
    let (x, force) = (largest(0), largest(1));
    let some = x > 0.0 && force > 0.0;
    let dynamic_stiffness = force / x;
    some.then(|| Hysteresis {
        dynamic_stiffness,
        damping_ratio: loop_area(points) / (PI * dynamic_stiffness * x * x),
    })
}

/// Dynamic stiffness and damping ratio of a linear bushing with a complex stiffness, N/m: K_d = |K|, η_d = K″/|K|.
pub fn of_complex_stiffness(storage: f64, loss: f64) -> Hysteresis {
    let magnitude = (storage * storage + loss * loss).sqrt();
    Hysteresis { dynamic_stiffness: magnitude, damping_ratio: loss / magnitude }
}

/// Complex stiffness from first harmonics, N/m: force divided by displacement over one steady cycle of equally spaced
/// points. `None` for fewer than three points or zero displacement harmonic.
pub fn first_harmonic(points: &[[f64; 2]]) -> Option<Complex<f64>> {
    let turn = TAU / points.len() as f64;
    let [x, force] = [0, 1].map(|of: usize| {
        points.iter().enumerate().fold(Complex::new(0.0, 0.0), |sum, (n, point)| {
            let angle = turn * n as f64;
            sum + Complex::new(libm::cos(angle), -libm::sin(angle)) * point[of]
        })
    });
    let largest = points.iter().map(|point| point[0].abs()).fold(0.0, f64::max);
    let some = points.len() > 2 && x.norm() > 1e-9 * largest;
    some.then(|| force / x)
}

/// [`first_harmonic`] of a steady cycle of `period` s whose points are ends of equal implicit steps of a bushing with
/// these Maxwell elements. The stiffness of a bonded bushing is nearly proportional to the shear modulus. The known
/// stiffness factor of the discrete recursion is therefore replaced by the exact one.
///
/// # Errors
/// If the period is negative or NaN.
pub fn of_steps(
    points: &[[f64; 2]],
    elements: &[Maxwell],
    period: f64,
) -> Result<Option<Hysteresis>, ElastomerError> {
    let pulsation = TAU / period;
    let [storage, loss] =
        complex_factor_of_steps(elements, pulsation, period / points.len() as f64)?;
    let stepped = Complex::new(storage, loss);
    let [storage, loss] = complex_factor(elements, pulsation);
    let exact = Complex::new(storage, loss);
    Ok(first_harmonic(points).map(|found| {
        let stiffness = found * (exact / stepped);
        of_complex_stiffness(stiffness.re, stiffness.im)
    }))
}
