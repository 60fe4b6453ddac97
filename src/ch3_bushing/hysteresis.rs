//! How stiff a bushing is in a cycle and how much it takes of its energy (3.13)–(3.14).

use std::f64::consts::PI;

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

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

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
}
