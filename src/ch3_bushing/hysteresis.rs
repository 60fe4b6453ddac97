//! How stiff a bushing is in a cycle and how much it takes of its energy (3.13)–(3.14).

use crate::ch2_housing::elastomer::ElastomerError;
use crate::ch2_housing::elastomer::maxwell::{Maxwell, complex_factor, complex_factor_of_steps};
use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

/// Of a loop of force over displacement, or of a complex stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hysteresis {
    /// K_d, N/m.
    pub dynamic_stiffness: f64,
    /// η_d.
    pub damping_ratio: f64,
}

/// Energy that a closed loop of displacement (m) and force (N) encloses, J: positive where force leads. Its
/// points are joined by straight lines, the last with the first.
pub fn loop_area(points: &[[f64; 2]]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| 0.5 * (a[1] + b[1]) * (b[0] - a[0])).sum()
}

/// K_d = F_max/x_max (3.13) and η_d = E_d/(π K_d x_max²) (3.14) of a closed loop of displacement (m) and
/// force (N), largest magnitudes counting. `None` of a loop without displacement or force.
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

/// The same of a linear bushing with a complex stiffness, N/m: K_d = |K|, η_d = K″/|K|.
pub fn of_complex_stiffness(storage: f64, loss: f64) -> Hysteresis {
    let magnitude = (storage * storage + loss * loss).sqrt();
    Hysteresis { dynamic_stiffness: magnitude, damping_ratio: loss / magnitude }
}

/// First harmonic of force over that of displacement, N/m, of one steady cycle at even times. `None` of fewer
/// than three points, and of displacements without one.
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

/// The same of a steady cycle of `period` s whose points are ends of even implicit steps of a bushing with these
/// Maxwell elements. What the recursion of the steps makes of steady cycles is known, and the stiffness of a bonded
/// bushing nearly proportional to the shear modulus: it is divided by that and multiplied by what it should be.
///
/// # Errors
/// A period that is negative or not a number.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ch2_housing::elastomer::maxwell::StepFactors;
    use crate::ch2_housing::elastomer::named::table_3_1;

    /// A point of the rubber of Table 3.1, sheared at 0.1 Hz in twelve steps a cycle.
    #[test]
    fn the_error_of_the_recursion_is_known() {
        let elements = table_3_1().maxwell;
        let (per, period, amplitude) = (12, 10.0, 1e-3);
        let factors = StepFactors::of(&elements, period / f64::from(per)).unwrap();
        let x = |n: i32| amplitude * (TAU * f64::from(n) / f64::from(per)).sin();
        let mut history = vec![0.0; elements.len()];
        let mut points = Vec::new();
        for n in 1..=60 * per {
            for ((h, decay), gain) in history.iter_mut().zip(&factors.decay).zip(&factors.gain) {
                *h = decay * *h + gain * (x(n) - x(n - 1));
            }
            points.push([x(n), x(n) + history.iter().sum::<f64>()]);
        }
        let points = &points[59 * per as usize..];
        let [storage, loss] = complex_factor(&elements, TAU / period);
        let exact = of_complex_stiffness(storage, loss);
        let corrected = of_steps(points, &elements, period).unwrap().unwrap();
        // Nearly all of it is a rounding; after 59 cycles the slowest element forgot its start to e⁻⁵⁹.
        assert!((corrected.dynamic_stiffness / exact.dynamic_stiffness - 1.0).abs() <= 1e-12);
        assert!((corrected.damping_ratio / exact.damping_ratio - 1.0).abs() <= 1e-12);
        let read = of_loop(points).unwrap();
        assert!((read.damping_ratio / exact.damping_ratio - 1.0).abs() > 0.05, "{read:?}");
        assert_eq!(first_harmonic(&points[..2]), None);
        assert_eq!(first_harmonic(&[[1.0, 1.0]; 8]), None);
        assert!(of_steps(points, &elements, -1.0).is_err());
    }

    #[test]
    fn a_loop_of_sines_is_its_complex_stiffness() {
        let (storage, loss, amplitude) = (3.0e6, 1.1e6, 1e-3);
        let points: Vec<[f64; 2]> = (0..4000)
            .map(|n| {
                let phase = TAU * f64::from(n) / 4000.0;
                [amplitude * phase.sin(), amplitude * (storage * phase.sin() + loss * phase.cos())]
            })
            .collect();
        let (ours, exact) = (of_loop(&points).unwrap(), of_complex_stiffness(storage, loss));
        // Chords for arcs: (2π/4000)²/6; the peak between two points, (2π/4000)²/8.
        assert!((ours.dynamic_stiffness / exact.dynamic_stiffness - 1.0).abs() <= 5e-7);
        assert!((ours.damping_ratio / exact.damping_ratio - 1.0).abs() <= 1e-6);
        let backwards: Vec<[f64; 2]> = points.iter().rev().copied().collect();
        // 3.5 J of four thousand sums.
        assert!((loop_area(&backwards) + loop_area(&points)).abs() <= 1e-12);
        assert_eq!(of_loop(&[]), None);
        assert_eq!(of_loop(&[[1.0, 0.0], [0.0, 0.0]]), None);
    }

    /// What is largest is so on either side: a lopsided loop the other way round has the same stiffness and damping.
    #[test]
    fn a_lopsided_loop_is_the_same_the_other_way_round() {
        let points = [[0.0, 0.5], [1e-3, 2.0], [0.0, -0.5], [-3e-3, -9.0]];
        let turned = points.map(|point| point.map(|x| -x));
        let [found, other] = [&points, &turned].map(|points| of_loop(points).unwrap());
        assert_eq!(found, other);
        // 9 N over 3 mm.
        assert!((found.dynamic_stiffness / 3e3 - 1.0).abs() <= 1e-14, "{found:?}");
    }
}
