//! A rigid shaft on several bearings: the energies of [`super::statics`] in one sum over the shaft's five
//! coordinates.
//!
//! Each bearing is described in axes of its own: those of the frame, or turned by half a turn about Z where it is
//! put in the other way round. The shaft's coordinates are its centre (m) and the angles ξ, λ of its
//! orientation Ry(ξ)·Rz(λ); its axis is (cos λ cos ξ, sin λ, −cos λ sin ξ).

use super::dense::{Matrix, norm, solve_positive_definite};
use super::statics::{Coordinates, OracleBall, OracleBearing};

/// A bearing whose inner race sits on the shaft.
#[derive(Clone, Debug, PartialEq)]
pub struct Seat {
    /// In its own axes; the outer race's place counts from the frame's origin.
    pub bearing: OracleBearing,
    /// Of the inner race's centre from the shaft's along the shaft's axis, m.
    pub along: f64,
    pub reversed: bool,
}

/// Equilibrium of the shaft.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftSolution {
    pub coordinates: Coordinates,
    /// Of each seat.
    pub balls: Vec<Vec<OracleBall>>,
    /// Norm of the unbalanced loads, moments over `lever`, N.
    pub residual: f64,
}

/// The axis of the shaft and its derivatives by ξ and λ.
fn axis([.., xi, lambda]: &Coordinates) -> [[f64; 3]; 3] {
    let ((sx, cx), (sl, cl)) = (xi.sin_cos(), lambda.sin_cos());
    [[cl * cx, sl, -cl * sx], [-cl * sx, 0.0, -cl * cx], [-sl * cx, cl, sl * sx]]
}

impl Seat {
    /// The inner race as the bearing's own axes have it.
    fn race(&self, shaft: &Coordinates) -> Coordinates {
        let [axis, ..] = axis(shaft);
        let [x, y, z] = std::array::from_fn(|i| shaft[i] + self.along * axis[i]);
        if self.reversed { [-x, -y, z, -shaft[3], shaft[4]] } else { [x, y, z, shaft[3], shaft[4]] }
    }

    /// Energy, what holds the shaft there conjugate to its coordinates, and the balls.
    fn evaluate(&self, shaft: &Coordinates) -> (f64, Coordinates, Vec<OracleBall>) {
        let (energy, own, balls) = self.bearing.evaluate(&self.race(shaft));
        let turned = if self.reversed { -1.0 } else { 1.0 };
        let force = [turned * own[0], turned * own[1], own[2]];
        let [_, by_xi, by_lambda] = axis(shaft);
        let lever = |by: [f64; 3]| -> f64 { (0..3).map(|i| self.along * by[i] * force[i]).sum() };
        let moments = [turned * own[3] + lever(by_xi), own[4] + lever(by_lambda)];
        (energy, [force[0], force[1], force[2], moments[0], moments[1]], balls)
    }
}

/// Energy of all bearings and the loads that hold the shaft at these coordinates.
pub fn evaluate(seats: &[Seat], shaft: &Coordinates) -> (f64, Coordinates, Vec<Vec<OracleBall>>) {
    let (mut energy, mut loads) = (0.0, [0.0; 5]);
    let mut balls = Vec::new();
    for seat in seats {
        let (own, held, seen) = seat.evaluate(shaft);
        energy += own;
        loads = std::array::from_fn(|i| loads[i] + held[i]);
        balls.push(seen);
    }
    (energy, loads, balls)
}

/// Equilibrium under `applied` near `start`: Newton's method on the loads, slopes by differences,
/// steps halved until less is unbalanced. `lever` (m) makes moments comparable with forces.
pub fn solve(
    seats: &[Seat],
    applied: &Coordinates,
    start: Coordinates,
    lever: f64,
) -> ShaftSolution {
    let unit = [1.0, 1.0, 1.0, lever, lever];
    let unbalanced = |shaft: &Coordinates| -> Vec<f64> {
        let (_, loads, _) = evaluate(seats, shaft);
        (0..5).map(|i| (applied[i] - loads[i]) / unit[i]).collect()
    };
    let mut at = start;
    let mut left = unbalanced(&at);
    for _ in 0..60 {
        // Far below an overlap, far above what rounding leaves of one.
        const STEP: f64 = 2e-9;
        let mut slopes: Matrix = vec![vec![0.0; 5]; 5];
        for column in 0..5 {
            let mut there = at;
            there[column] += STEP / unit[column];
            let moved = unbalanced(&there);
            for row in 0..5 {
                slopes[row][column] = (left[row] - moved[row]) / STEP;
            }
        }
        for i in 0..5 {
            for j in 0..i {
                let mean = 0.5 * (slopes[i][j] + slopes[j][i]);
                (slopes[i][j], slopes[j][i]) = (mean, mean);
            }
        }
        let Some(step) = solve_positive_definite(&slopes, 0.0, &left) else { break };
        let mut part = 1.0;
        let better = loop {
            let there = std::array::from_fn(|i| at[i] + part * step[i] / unit[i]);
            let after = unbalanced(&there);
            // Less than half of it left: what goes on from there is rounding.
            if norm(&after) < 0.5 * norm(&left) {
                break Some((there, after));
            }
            part *= 0.5;
            if part < 0.1 {
                break None;
            }
        };
        let Some((there, after)) = better else { break };
        (at, left) = (there, after);
    }
    let (_, _, balls) = evaluate(seats, &at);
    ShaftSolution { coordinates: at, balls, residual: norm(&left) }
}
