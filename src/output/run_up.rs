//! Vibration amplitude over speed in a run-up, turn by turn.

use std::f64::consts::TAU;

/// Amplitudes over one turn of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Mean speed, rad/s.
    pub speed: f64,
    /// Half of the peak-to-peak value.
    pub half_peak_to_peak: f64,
    /// Once-per-turn part (1X).
    pub once_per_turn: f64,
}

/// Fewest rows in a turn.
const FEWEST: usize = 8;

/// Amplitudes of each whole turn from `speed` (rad/s) and `values` at equal intervals, s. Turns with fewer than eight
/// rows are left out.
pub fn turns(speed: &[f64], values: &[f64], interval: f64) -> Vec<Turn> {
    let mut angle = 0.0;
    let mut angles = Vec::with_capacity(speed.len());
    for (row, now) in speed.iter().enumerate() {
        if row > 0 {
            angle += 0.5 * (now + speed[row - 1]).abs() * interval;
        }
        angles.push(angle);
    }
    let mut turns = Vec::new();
    let mut first = 0;
    while first < angles.len() {
        let end = angles[first..].partition_point(|angle| angle - angles[first] < TAU) + first;
        if end >= angles.len() {
            break;
        }
        if end - first >= FEWEST {
            turns.push(turn(&angles[first..=end], &values[first..=end], &speed[first..=end]));
        }
        first = end;
    }
    turns
}

/// The trapezoidal rule over the angle; the last interval is cut where the turn ends.
fn turn(angles: &[f64], values: &[f64], speed: &[f64]) -> Turn {
    let start = angles[0];
    let (mut cosine, mut sine) = (0.0, 0.0);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut add = |from: [f64; 2], to: [f64; 2]| {
        let width = to[0] - from[0];
        for [angle, value] in [from, to] {
            let (s, c) = libm::sincos(angle);
            cosine += 0.5 * width * value * c;
            sine += 0.5 * width * value * s;
        }
    };
    for k in 1..angles.len() {
        let from = [angles[k - 1] - start, values[k - 1]];
        let mut to = [angles[k] - start, values[k]];
        if to[0] > TAU {
            let part = (TAU - from[0]) / (to[0] - from[0]);
            to = [TAU, from[1] + part * (to[1] - from[1])];
        }
        add(from, to);
        low = low.min(from[1]).min(to[1]);
        high = high.max(from[1]).max(to[1]);
    }
    let count = speed.len() as f64;
    Turn {
        speed: speed.iter().sum::<f64>().abs() / count,
        half_peak_to_peak: 0.5 * (high - low),
        once_per_turn: libm::hypot(cosine, sine) / (0.5 * TAU),
    }
}
