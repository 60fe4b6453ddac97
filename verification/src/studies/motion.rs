//! Integrators of the bearing in motion: the method of a run, its history, and its error against a reference.

use bearing_dynamics::motion::simulation::{Integrator, Stepping};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    pub integrator: Integrator,
    pub stepping: Stepping,
}

impl Method {
    pub fn accurate(integrator: Integrator, accuracy: f64) -> Method {
        Method { integrator, stepping: Stepping::Accuracy(accuracy) }
    }

    pub fn variant(&self) -> String {
        match self.stepping {
            Stepping::Fixed(step) => format!("{:.3} µs", 1e6 * step),
            Stepping::Accuracy(accuracy) => format!("accuracy {accuracy:.0e}"),
            Stepping::FractionOfLimit(fraction) => format!("{fraction} of the limit"),
        }
    }
}

/// Result of one run.
#[derive(Clone, Debug)]
pub struct History {
    /// Displacement of the inner race from the outer race, m, one entry a row.
    pub race: Vec<[f64; 3]>,
    pub evaluations: u64,
    /// Wall-clock time of the steps, s.
    pub seconds: f64,
}

/// Column heads of [`errors`].
pub const LABELS: [&str; 2] = [
    "error of the inner race over its largest displacement",
    "error of the inner race over its largest peak-to-peak motion",
];

/// Largest error of the race against a reference, over the largest displacement and over the largest
/// peak-to-peak motion of a coordinate. Infinite where the number of rows differs.
pub fn errors(found: &History, reference: &History) -> [f64; 2] {
    let (mut error, mut peak_to_peak, mut displacement) = (0.0f64, 0.0f64, 0.0f64);
    for i in 0..3 {
        let values = reference.race.iter().map(|position| position[i]);
        let (low, high) =
            values.clone().fold((f64::MAX, f64::MIN), |(l, h), v| (v.min(l), v.max(h)));
        peak_to_peak = peak_to_peak.max(high - low);
        displacement = displacement.max(low.abs()).max(high.abs());
        for (found, value) in found.race.iter().zip(values) {
            let difference = (found[i] - value).abs();
            // NaN stays.
            error = if difference <= error || error.is_nan() { error } else { difference };
        }
    }
    if found.race.len() != reference.race.len() {
        error = f64::INFINITY;
    }
    [error / displacement, error / peak_to_peak]
}
