//! Two masses, a spring between them and a bushing under the second: what a pulse on the first one does, by its
//! spectrum, without any step in time.

use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

type C = Complex<f64>;

/// Complex stiffness over frequency, by cubics in ln f between frequencies spread evenly there.
pub struct Stiffness {
    relaxed: C,
    lowest: f64,
    per_decade: f64,
    values: Vec<C>,
}

impl Stiffness {
    /// Of `k(f)`, f in Hz, from `lowest` to `highest`; below `lowest` it goes straight to `k(0)`.
    pub fn new(k: impl Fn(f64) -> C, lowest: f64, highest: f64, per_decade: f64) -> Stiffness {
        let count = ((highest / lowest).log10() * per_decade).ceil() as usize + 4;
        let values = (0..count).map(|i| k(lowest * 10f64.powf((i as f64 - 1.0) / per_decade)));
        Stiffness { relaxed: k(0.0), lowest, per_decade, values: values.collect() }
    }

    pub fn at(&self, frequency: f64) -> C {
        if frequency < self.lowest {
            let part = frequency / self.lowest;
            return self.relaxed * (1.0 - part) + self.values[1] * part;
        }
        let x = (frequency / self.lowest).log10() * self.per_decade + 1.0;
        let i = (x.floor() as usize).clamp(1, self.values.len() - 3);
        let t = x - i as f64;
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| self.values[i - 1 + k]);
        a * (-t * (t - 1.0) * (t - 2.0) / 6.0)
            + b * ((t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0)
            + c * (-(t + 1.0) * t * (t - 2.0) / 2.0)
            + d * ((t + 1.0) * t * (t - 1.0) / 6.0)
    }
}

/// Masses (kg) and the spring between them, N/m.
#[derive(Clone, Copy)]
pub struct TwoMasses {
    pub masses: [f64; 2],
    pub between: f64,
}

impl TwoMasses {
    /// Displacements of both by a unit force on the first, m/N.
    pub fn receptance(&self, bushing: C, frequency: f64) -> [C; 2] {
        let square = (TAU * frequency).powi(2);
        let first = C::new(self.between - self.masses[0] * square, 0.0);
        let second = bushing + (self.between - self.masses[1] * square);
        let det = first * second - self.between * self.between;
        [second / det, C::new(self.between, 0.0) / det]
    }

    /// Force of the bushing on the second mass at `times` (s) after the start of half a sine of `height` N and
    /// `duration` s on the first: harmonics of `period` s up to `highest` Hz.
    pub fn force_after_pulse(
        &self,
        bushing: &Stiffness,
        [height, duration]: [f64; 2],
        times: &[f64],
        [period, highest]: [f64; 2],
    ) -> Vec<f64> {
        let own = PI / duration;
        let spectrum: Vec<C> = (0..=(highest * period) as usize)
            .map(|n| {
                let frequency = n as f64 / period;
                let w = TAU * frequency;
                let below = own * own - w * w;
                // At ω = π/T the transform is −iT/2.
                let pulse = if below.abs() <= 1e-9 * own * own {
                    C::new(0.0, -0.5 * duration)
                } else {
                    (C::new(0.0, -w * duration).exp() + 1.0) * (own / below)
                };
                let k = bushing.at(frequency);
                let weight = if n == 0 { 1.0 } else { 2.0 } / period;
                -k * self.receptance(k, frequency)[1] * pulse * (height * weight)
            })
            .collect();
        let at = |time: &f64| {
            let turn = C::new(0.0, TAU * time / period).exp();
            // Horner, from the quickest harmonic on.
            spectrum.iter().rev().fold(C::new(0.0, 0.0), |sum, term| sum * turn + term).re
        };
        times.iter().map(at).collect()
    }
}
