//! Dense symmetric matrices and their Cholesky factorisation (faer, one thread).

use crate::numeric::sparse::FactorError;
use faer::linalg::cholesky::llt::factor::LltError;
use faer::linalg::solvers::Llt;
use faer::prelude::{MatMut, Solve};
use faer::{Mat, Side};

/// Symmetric matrix with all entries stored, column by column.
#[derive(Clone, Debug, PartialEq)]
pub struct DenseSymmetric {
    size: usize,
    values: Vec<f64>,
}

impl DenseSymmetric {
    /// Matrix from its columns, symmetrised. The second value is the largest asymmetry divided by the largest entry.
    ///
    /// # Panics
    /// If `values` does not have `size` squared entries.
    pub fn new(size: usize, mut values: Vec<f64>) -> (DenseSymmetric, f64) {
        assert_eq!(values.len(), size * size, "a square matrix");
        let (mut gap, mut largest) = (0.0f64, 0.0f64);
        for column in 0..size {
            for row in 0..=column {
                let (one, other) = (values[row + column * size], values[column + row * size]);
                gap = gap.max((one - other).abs());
                largest = largest.max(one.abs());
                let mean = 0.5 * (one + other);
                (values[row + column * size], values[column + row * size]) = (mean, mean);
            }
        }
        let asymmetry = if largest > 0.0 { gap / largest } else { 0.0 };
        (DenseSymmetric { size, values }, asymmetry)
    }

    pub fn size(&self) -> usize {
        self.size
    }

    pub fn column(&self, column: usize) -> &[f64] {
        &self.values[column * self.size..(column + 1) * self.size]
    }

    /// y += A x; `x` has one entry for each of the `picked` columns.
    pub fn add_product(&self, picked: &[usize], x: &[f64], y: &mut [f64]) {
        for (&column, &factor) in picked.iter().zip(x) {
            for (y, a) in y.iter_mut().zip(self.column(column)) {
                *y += factor * a;
            }
        }
    }

    /// Cholesky factorisation of the `picked` rows and columns with `diagonal` (one entry for each) added.
    ///
    /// # Errors
    /// If this submatrix is not positive definite.
    pub fn factor(&self, picked: &[usize], diagonal: &[f64]) -> Result<DenseFactor, FactorError> {
        let part = Mat::from_fn(picked.len(), picked.len(), |i, j| {
            let value = self.values[picked[i] + picked[j] * self.size];
            if i == j { value + diagonal[i] } else { value }
        });
        match Llt::new(part.as_ref(), Side::Lower) {
            Ok(numeric) => Ok(DenseFactor { numeric }),
            Err(LltError::NonPositivePivot { index }) => {
                Err(FactorError::NotPositiveDefinite { pivot: index })
            }
        }
    }
}

pub struct DenseFactor {
    numeric: Llt<f64>,
}

impl DenseFactor {
    /// Solves in place for `columns` right-hand sides, stored one after the other in `right`.
    pub fn solve_columns(&self, right: &mut [f64], columns: usize) {
        let rows = right.len() / columns;
        self.numeric.solve_in_place(MatMut::from_column_major_slice_mut(right, rows, columns));
    }
}
