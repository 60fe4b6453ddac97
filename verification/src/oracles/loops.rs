//! Circular loops of wire: mutual inductance by formulas of other forms than the vector potential.

use std::f64::consts::{PI, TAU};

use super::elliptic::{e_of_complement, k_of_complement};

const PERMEABILITY: f64 = 4e-7 * PI;

/// Grover's integral for loops of radius `a` and `b` in parallel planes `distance` apart, their axes `offset` apart, H.
pub fn beside(a: f64, b: f64, distance: f64, offset: f64) -> f64 {
    let (alpha, beta, aside) = (b / a, distance / a, offset / b);
    let at = |angle: f64| {
        let cos = angle.cos();
        let v = (1.0 + aside * aside - 2.0 * aside * cos).sqrt();
        let square = 4.0 * alpha * v / ((1.0 + alpha * v).powi(2) + beta * beta);
        let complement =
            ((1.0 - alpha * v).powi(2) + beta * beta) / ((1.0 + alpha * v).powi(2) + beta * beta);
        let psi = (1.0 - 0.5 * square) * k_of_complement(complement) - e_of_complement(complement);
        (1.0 - aside * cos) * psi / (square * v.powi(3)).sqrt()
    };
    // Equal steps round a smooth period.
    let steps = 400;
    let mean =
        (0..steps).map(|i| at(TAU * (i as f64 + 0.5) / steps as f64)).sum::<f64>() / steps as f64;
    2.0 * PERMEABILITY * (a * b).sqrt() * mean
}

/// Neumann's double sum for a loop of radius `a` about X at the origin and one of radius `b` at `centre` about a unit vector, H.
pub fn anywhere(a: f64, b: f64, centre: [f64; 3], axis: [f64; 3]) -> f64 {
    let steps = 600;
    // Across the axis, which is near X.
    let norm = axis[0].hypot(axis[1]);
    let first = [-axis[1] / norm, axis[0] / norm, 0.0];
    let second = [
        axis[1] * first[2] - axis[2] * first[1],
        axis[2] * first[0] - axis[0] * first[2],
        axis[0] * first[1] - axis[1] * first[0],
    ];
    let round: Vec<[f64; 2]> = (0..2 * steps)
        .map(|i| (PI * i as f64 / steps as f64).sin_cos())
        .map(|(sin, cos)| [sin, cos])
        .collect();
    let mut sum = 0.0;
    for [sin, cos] in round.iter().step_by(2) {
        for [s, c] in round.iter().skip(1).step_by(2) {
            let at = [0, 1, 2].map(|i| centre[i] + b * (c * first[i] + s * second[i]));
            let way = [1, 2].map(|i| b * (c * second[i] - s * first[i]));
            let apart = at[0].powi(2) + (at[1] - a * cos).powi(2) + (at[2] - a * sin).powi(2);
            sum += a * (cos * way[1] - sin * way[0]) / apart.sqrt();
        }
    }
    1e-7 * sum * (TAU / steps as f64).powi(2)
}
