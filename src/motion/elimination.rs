//! Elimination without pivots, LDLᵀ of symmetric positive definite matrices: 6 × 6 for a block of
//! balls at a time, and one small dense matrix.
//!
//! The upper triangle goes in; factors are stored unscaled, with reciprocal pivots on the diagonal.

use crate::members::state::LANES;
use crate::motion::linearised::Lane;

pub const ZERO: Lane = [0.0; LANES];
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

/// One small dense matrix, its upper triangle row by row.
#[derive(Clone, Debug, Default)]
pub struct LdltMatrix {
    size: usize,
    values: Vec<f64>,
}

impl LdltMatrix {
    pub fn new(size: usize) -> LdltMatrix {
        LdltMatrix { size, values: vec![0.0; size * size] }
    }

    /// Sets the size, all entries zero.
    pub fn resize(&mut self, size: usize) {
        self.size = size;
        self.values.clear();
        self.values.resize(size * size, 0.0);
    }

    /// A row from its diagonal on.
    pub fn row_from(&mut self, row: usize) -> &mut [f64] {
        &mut self.values[row * self.size + row..(row + 1) * self.size]
    }

    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    #[inline(always)]
    pub fn at(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.values[row * self.size + column]
    }

    /// Adds a multiple of some values to a row from a column on.
    #[inline(always)]
    pub fn add_to_row(&mut self, row: usize, column: usize, factor: f64, values: &[f64]) {
        let from = row * self.size + column;
        for (to, value) in self.values[from..from + values.len()].iter_mut().zip(values) {
            *to += factor * value;
        }
    }

    pub fn factor(&mut self) {
        let n = self.size;
        for k in 0..n {
            let (above, below) = self.values.split_at_mut((k + 1) * n);
            let pivot_row = &mut above[k * n..];
            let per_pivot = 1.0 / pivot_row[k];
            for (row, i) in below.chunks_exact_mut(n).zip(k + 1..) {
                let factor = pivot_row[i] * per_pivot;
                for (value, pivot) in row[i..].iter_mut().zip(&pivot_row[i..]) {
                    *value -= factor * pivot;
                }
            }
            pivot_row[k] = per_pivot;
        }
    }

    pub fn solve(&self, right: &mut [f64]) {
        let n = self.size;
        let row = |k: usize| &self.values[k * n..(k + 1) * n];
        for k in 0..n {
            let factors = row(k);
            let scaled = right[k] * factors[k];
            for i in k + 1..n {
                right[i] -= factors[i] * scaled;
            }
        }
        for k in (0..n).rev() {
            let factors = row(k);
            let mut sum = right[k];
            for (factor, known) in factors[k + 1..].iter().zip(&right[k + 1..]) {
                sum -= factor * known;
            }
            right[k] = sum * factors[k];
        }
    }

    /// [`LdltMatrix::solve`] for six right-hand sides.
    pub fn solve_six(&self, right: &mut [[f64; 6]]) {
        let n = self.size;
        let row = |k: usize| &self.values[k * n..(k + 1) * n];
        for k in 0..n {
            let factors = row(k);
            let scaled = right[k].map(|of| of * factors[k]);
            for (right, factor) in right[k + 1..n].iter_mut().zip(&factors[k + 1..]) {
                for i in 0..6 {
                    right[i] -= factor * scaled[i];
                }
            }
        }
        for k in (0..n).rev() {
            let factors = row(k);
            let mut sum = right[k];
            for (factor, known) in factors[k + 1..].iter().zip(&right[k + 1..n]) {
                for i in 0..6 {
                    sum[i] -= factor * known[i];
                }
            }
            right[k] = sum.map(|of| of * factors[k]);
        }
    }
}
