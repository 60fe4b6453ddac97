//! A shaft of one section on two bearings at rest: a geometrically exact rod, integrated from the first race on.
//!
//! A rod that bends, shears and stretches (Simo and Reissner): with n and m what the rest of the rod does to the part up to
//! s, r′ = R (1 + n₁/EA, n₂/κGA, n₃/κGA), R′ = R (0, m₂/EI, m₃/EI)×, m′ = −r′ × n in directions of the section R;
//! n and m jump where something acts. No deflection is taken as small. Unknown are the five coordinates of both inner races;
//! what does not fit is where the second race is, and what is left of n and m at the free end.

use super::statics::{Coordinates, OracleBearing};

/// Of one round section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// EI, N·m²; κGA, N; EA, N.
    pub bending: f64,
    pub shear: f64,
    pub stretch: f64,
    /// Whether the part of the force along X stretches the rod, and not the part along each section's own axis: tells what leaving out
    /// the difference does.
    pub pulled_along_x: bool,
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

type Vector = [f64; 3];

fn plus(a: Vector, factor: f64, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + factor * b[i])
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Place, directions of the section, force and moment.
#[derive(Clone, Copy)]
struct Cut {
    at: Vector,
    directions: [Vector; 3],
    force: Vector,
    moment: Vector,
}

impl Cut {
    /// The section of a race at these coordinates, a free end.
    fn of(x: f64, race: &Coordinates) -> Cut {
        let [along, y, z, turn_y, turn_z] = *race;
        let ((sy, cy), (sz, cz)) = (turn_y.sin_cos(), turn_z.sin_cos());
        let directions = [[cy * cz, sz, -sy * cz], [-cy * sz, cz, sy * sz], [sy, 0.0, cy]];
        Cut { at: [x + along, y, z], directions, force: [0.0; 3], moment: [0.0; 3] }
    }

    /// x (beside its place on the straight rod), y, z and the angles of its axis.
    fn coordinates(&self, x: f64) -> Coordinates {
        let axis = self.directions[0];
        [self.at[0] - x, self.at[1], self.at[2], (-axis[2]).atan2(axis[0]), axis[1].asin()]
    }

    /// What acts here on the rod: along x, y, z, about Y and about the section's own Z.
    fn jump(&mut self, load: &Coordinates) {
        let [fx, fy, fz, about_y, about_own] = *load;
        self.force = plus(self.force, -1.0, [fx, fy, fz]);
        // A moment without a part about the axis that has these two parts.
        let [_, across, own] = self.directions;
        let part = (about_y - own[1] * about_own) / across[1];
        let moment = plus(plus([0.0; 3], part, across), about_own, own);
        self.moment = plus(self.moment, -1.0, moment);
    }

    fn slope(&self, rod: &Stiffness) -> Cut {
        let [axis, across, own] = self.directions;
        let pull = if rod.pulled_along_x { self.force[0] } else { dot(self.force, axis) };
        let strain = [
            1.0 + pull / rod.stretch,
            dot(self.force, across) / rod.shear,
            dot(self.force, own) / rod.shear,
        ];
        let along = plus(plus(plus([0.0; 3], strain[0], axis), strain[1], across), strain[2], own);
        let bends = [dot(self.moment, across) / rod.bending, dot(self.moment, own) / rod.bending];
        let turn = plus(plus([0.0; 3], bends[0], across), bends[1], own);
        Cut {
            at: along,
            directions: self.directions.map(|direction| cross(turn, direction)),
            force: [0.0; 3],
            moment: cross(self.force, along),
        }
    }

    fn moved(&self, by: f64, slope: &Cut) -> Cut {
        Cut {
            at: plus(self.at, by, slope.at),
            directions: std::array::from_fn(|i| plus(self.directions[i], by, slope.directions[i])),
            force: self.force,
            moment: plus(self.moment, by, slope.moment),
        }
    }

    /// On along the rod by four-stage steps; their error is the fifth power of the turn within one.
    fn follow(mut self, rod: &Stiffness, length: f64) -> Cut {
        const STEPS: usize = 12;
        let step = length / STEPS as f64;
        for _ in 0..STEPS {
            let a = self.slope(rod);
            let b = self.moved(0.5 * step, &a).slope(rod);
            let c = self.moved(0.5 * step, &b).slope(rod);
            let d = self.moved(step, &c).slope(rod);
            self = self.moved(step / 6.0, &a).moved(step / 3.0, &b);
            self = self.moved(step / 3.0, &c).moved(step / 6.0, &d);
        }
        self
    }
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
        let mut cut = Cut::of(0.0, &races[0]);
        cut.jump(&holds[0].map(|value| -value));
        let mut acting = [(span, holds[1].map(|value| -value)), (load.at, load.load)];
        acting.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut from, mut misfit) = (0.0, [0.0; 5]);
        for (x, of) in acting {
            cut = cut.follow(shaft, x - from);
            if x == span {
                let reached = cut.coordinates(span);
                misfit = std::array::from_fn(|i| races[1][i] - reached[i]);
            }
            cut.jump(&of);
            from = x;
        }
        let misfit = scaled(shaft, span, &misfit);
        let left = [cut.force[0], cut.force[1], cut.force[2], cut.moment[1], cut.moment[2]];
        let out = std::array::from_fn(|i| if i < 5 { left[i] } else { misfit[i - 5] });
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
