//! A shaft of one section on two bearings at rest, in closed form: a cantilever from the first bearing.
//!
//! The shaft moves as a rigid body with the first race and bends from there: deflections of a Timoshenko cantilever under a
//! force or a moment at one place are textbook formulas. Unknown are the five coordinates of both inner races; what is
//! unbalanced is the whole shaft, and what does not fit is where the second race would be.

use super::statics::{Coordinates, OracleBearing};

/// Of one round section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// EI, N·m²; κGA, N; EA, N.
    pub bending: f64,
    pub shear: f64,
    pub stretch: f64,
}

/// Force and moment at the end of the shaft or between: place from the first bearing (m), x, y, z, about Y, about Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    pub at: f64,
    pub load: Coordinates,
}

/// Both inner races, and the loads that hold them there against their bearings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Races {
    pub coordinates: [Coordinates; 2],
    pub holds: [Coordinates; 2],
    /// Largest unbalanced force and moment of the shaft, N and N·m.
    pub unbalanced: f64,
}

impl Stiffness {
    /// [w by force, w by moment, turn by force, turn by moment] at x of a cantilever loaded at a.
    fn cantilever(&self, x: f64, a: f64) -> [f64; 4] {
        let b = self.bending;
        if x <= a {
            let w = x * x * (3.0 * a - x) / (6.0 * b) + x / self.shear;
            [w, x * x / (2.0 * b), x * (2.0 * a - x) / (2.0 * b), x / b]
        } else {
            let w = a * a * (3.0 * x - a) / (6.0 * b) + a / self.shear;
            [w, a * a / (2.0 * b) + a * (x - a) / b, a * a / (2.0 * b), a / b]
        }
    }

    /// Where the section at x goes from its place on a straight shaft.
    fn bent(&self, x: f64, of: &Load) -> Coordinates {
        let [wf, wm, tf, tm] = self.cantilever(x, of.at);
        let [fx, fy, fz, my, mz] = of.load;
        // Towards Z the slope is −turn_y, and the moment that makes it −my.
        [
            x.min(of.at) * fx / self.stretch,
            wf * fy + wm * mz,
            wf * fz - wm * my,
            -tf * fz + tm * my,
            tf * fy + tm * mz,
        ]
    }
}

/// The section at x of a straight shaft that moves with its first section.
fn carried(first: &Coordinates, x: f64) -> Coordinates {
    let [along, y, z, turn_y, turn_z] = *first;
    [along, y + x * turn_z, z - x * turn_y, turn_y, turn_z]
}

/// Force and moment that a load is at the first section.
fn at_first(of: &Load) -> Coordinates {
    let [fx, fy, fz, my, mz] = of.load;
    [fx, fy, fz, my - of.at * fz, mz + of.at * fy]
}

/// A typical compliance along each coordinate, so that misfits count as forces and moments do.
fn scaled(shaft: &Stiffness, span: f64, misfit: &Coordinates) -> Coordinates {
    let force = span.powi(3) / (3.0 * shaft.bending);
    let moment = span / shaft.bending;
    [misfit[0] * 1e8, misfit[1] / force, misfit[2] / force, misfit[3] / moment, misfit[4] / moment]
}

/// Equilibrium near `start` (coordinates of both races): Newton's method with slopes by differences.
pub fn solve(
    shaft: &Stiffness,
    bearings: [&OracleBearing; 2],
    span: f64,
    load: &Load,
    start: [Coordinates; 2],
) -> Races {
    let residual = |at: &[f64; 10]| -> ([f64; 10], [Coordinates; 2]) {
        let races: [Coordinates; 2] = [0, 5].map(|first| std::array::from_fn(|i| at[first + i]));
        let holds = [0, 1].map(|i| bearings[i].evaluate(&races[i]).1);
        let second = Load { at: span, load: holds[1].map(|value| -value) };
        let straight = carried(&races[0], span);
        let (by_load, by_second) = (shaft.bent(span, load), shaft.bent(span, &second));
        let misfit = std::array::from_fn(|i| races[1][i] - straight[i] - by_load[i] - by_second[i]);
        let misfit = scaled(shaft, span, &misfit);
        let (whole, right) = (at_first(load), at_first(&second));
        let out = std::array::from_fn(|i| match i {
            0..5 => whole[i] + right[i] - holds[0][i],
            _ => misfit[i - 5],
        });
        (out, holds)
    };
    let mut at: [f64; 10] = std::array::from_fn(|i| start[i / 5][i % 5]);
    let (mut left, mut holds) = residual(&at);
    let size = |of: &[f64; 10]| of.iter().map(|value| value * value).sum::<f64>().sqrt();
    for _ in 0..60 {
        // Far below an overlap, far above what rounding leaves of one.
        const STEP: f64 = 2e-9;
        let lever = |i: usize| if i % 5 < 3 { 1.0 } else { 0.026 };
        let mut slopes = [[0.0; 11]; 10];
        for column in 0..10 {
            let mut sides = [[0.0; 10]; 2];
            for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
                let mut there = at;
                there[column] += sign * STEP / lever(column);
                *side = residual(&there).0;
            }
            for row in 0..10 {
                slopes[row][column] =
                    (sides[0][row] - sides[1][row]) * lever(column) / (2.0 * STEP);
            }
        }
        for row in 0..10 {
            slopes[row][10] = -left[row];
        }
        let step = eliminated(slopes);
        let mut part = 1.0;
        let better = loop {
            let there: [f64; 10] = std::array::from_fn(|i| at[i] + part * step[i]);
            let (after, held) = residual(&there);
            if size(&after) < 0.5 * size(&left) || (part < 1.0 && size(&after) < size(&left)) {
                break Some((there, after, held));
            }
            part *= 0.5;
            if part < 1e-3 {
                break None;
            }
        };
        let Some((there, after, held)) = better else { break };
        (at, left, holds) = (there, after, held);
    }
    Races {
        coordinates: [0, 5].map(|first| std::array::from_fn(|i| at[first + i])),
        holds,
        unbalanced: left.iter().fold(0.0, |most: f64, value| most.max(value.abs())),
    }
}

/// Gauss' elimination with the largest pivot of a column; the last column is the right-hand side.
fn eliminated(mut rows: [[f64; 11]; 10]) -> [f64; 10] {
    for column in 0..10 {
        let best = (column..10)
            .max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()))
            .unwrap_or(column);
        rows.swap(column, best);
        for row in 0..10 {
            if row != column {
                let factor = rows[row][column] / rows[column][column];
                for i in column..11 {
                    rows[row][i] -= factor * rows[column][i];
                }
            }
        }
    }
    std::array::from_fn(|i| rows[i][10] / rows[i][i])
}
