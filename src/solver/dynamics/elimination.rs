//! Elimination without pivots, LDLᵀ of symmetric positive definite matrices: 6 × 6 for a block of
//! balls at a time, and one small dense matrix.
//!
//! The upper triangle goes in; factors leave it unscaled, with reciprocal pivots on the diagonal.

use super::linearised::Lane;
use super::state::LANES;

pub const ZERO: Lane = [0.0; LANES];
/// Most equations of the dense matrix: six for each race and the cage.
pub const MOST: usize = 18;

/// One matrix for each ball of a block.
pub type Block = [[Lane; 6]; 6];

#[inline(always)]
pub fn add_product(sum: &mut Lane, a: &Lane, b: &Lane) {
    for l in 0..LANES {
        sum[l] += a[l] * b[l];
    }
}

#[inline(always)]
pub fn subtract_product(sum: &mut Lane, a: &Lane, b: &Lane) {
    for l in 0..LANES {
        sum[l] -= a[l] * b[l];
    }
}

#[inline(always)]
pub fn total(lane: &Lane) -> f64 {
    let [a, b, c, d, e, f, g, h] = *lane;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

pub fn factor_lanes(matrix: &mut Block) {
    for k in 0..6 {
        let mut per_pivot = ZERO;
        for l in 0..LANES {
            per_pivot[l] = 1.0 / matrix[k][k][l];
        }
        for i in k + 1..6 {
            let mut factor = ZERO;
            for l in 0..LANES {
                factor[l] = matrix[k][i][l] * per_pivot[l];
            }
            for j in i..6 {
                let above = matrix[k][j];
                subtract_product(&mut matrix[i][j], &factor, &above);
            }
        }
        matrix[k][k] = per_pivot;
    }
}

#[inline(always)]
pub fn solve_lanes(factors: &Block, right: &mut [Lane; 6]) {
    for k in 0..6 {
        let mut scaled = ZERO;
        for l in 0..LANES {
            scaled[l] = right[k][l] * factors[k][k][l];
        }
        for i in k + 1..6 {
            subtract_product(&mut right[i], &factors[k][i], &scaled);
        }
    }
    for k in (0..6).rev() {
        for j in k + 1..6 {
            let known = right[j];
            subtract_product(&mut right[k], &factors[k][j], &known);
        }
        for l in 0..LANES {
            right[k][l] *= factors[k][k][l];
        }
    }
}

pub fn solve_columns(factors: &Block, columns: &mut Block) {
    for j in 0..6 {
        let mut column = [0, 1, 2, 3, 4, 5].map(|i: usize| columns[i][j]);
        solve_lanes(factors, &mut column);
        for i in 0..6 {
            columns[i][j] = column[i];
        }
    }
}

pub fn factor_dense(matrix: &mut [[f64; MOST]; MOST], count: usize) {
    for k in 0..count {
        let per_pivot = 1.0 / matrix[k][k];
        for i in k + 1..count {
            let factor = matrix[k][i] * per_pivot;
            for j in i..count {
                matrix[i][j] -= factor * matrix[k][j];
            }
        }
        matrix[k][k] = per_pivot;
    }
}

pub fn solve_dense(factors: &[[f64; MOST]; MOST], count: usize, right: &mut [f64; MOST]) {
    for k in 0..count {
        let scaled = right[k] * factors[k][k];
        for i in k + 1..count {
            right[i] -= factors[k][i] * scaled;
        }
    }
    for k in (0..count).rev() {
        for j in k + 1..count {
            right[k] -= factors[k][j] * right[j];
        }
        right[k] *= factors[k][k];
    }
}
