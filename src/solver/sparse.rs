//! Sparse symmetric matrices and their Cholesky factors (faer, one thread).

use faer::prelude::{MatMut, Solve};
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Side, linalg::cholesky::llt::factor::LltError};
use thiserror::Error;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum FactorError {
    #[error(
        "the stiffness is not positive definite (pivot {pivot}): a part is free to move, or the \
         body has buckled"
    )]
    NotPositiveDefinite { pivot: usize },
    #[error("the stiffness could not be factorised: {0}")]
    Other(String),
}

/// A place on or below the diagonal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    pub row: usize,
    pub column: usize,
}

/// The lower triangle of a symmetric matrix, column by column.
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetricMatrix {
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl SymmetricMatrix {
    /// Zero, with room for the given rows of each column, ascending from the diagonal on.
    pub fn new(columns: Vec<Vec<usize>>) -> SymmetricMatrix {
        let mut starts = Vec::with_capacity(columns.len() + 1);
        starts.push(0);
        let mut rows = Vec::new();
        for mut column in columns {
            rows.append(&mut column);
            starts.push(rows.len());
        }
        let values = vec![0.0; rows.len()];
        SymmetricMatrix { starts, rows, values }
    }

    pub fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// Stored values, a measure of memory and work.
    pub fn stored(&self) -> usize {
        self.values.len()
    }

    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// # Panics
    /// If there is no room at that place.
    pub fn add(&mut self, Entry { row, column }: Entry, value: f64) {
        let start = self.starts[column];
        let of_column = &self.rows[start..self.starts[column + 1]];
        let at = of_column.binary_search(&row).expect("a place of the pattern");
        self.values[start + at] += value;
    }

    /// Adds `factor` times a matrix of the same pattern.
    pub fn add_scaled(&mut self, factor: f64, other: &SymmetricMatrix) {
        assert_eq!(self.rows.len(), other.rows.len(), "matrices of one pattern");
        for (value, other) in self.values.iter_mut().zip(&other.values) {
            *value += factor * other;
        }
    }

    /// y = A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for column in 0..self.size() {
            let mut sum = 0.0;
            for at in self.starts[column]..self.starts[column + 1] {
                let (row, value) = (self.rows[at], self.values[at]);
                y[row] += value * x[column];
                if row != column {
                    sum += value * x[row];
                }
            }
            y[column] += sum;
        }
    }

    fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let size = self.size();
        SymbolicSparseColMatRef::new_checked(size, size, &self.starts, None, &self.rows)
    }
}

/// Cholesky factors; the order of elimination is found once for a pattern.
pub struct Factor {
    symbolic: SymbolicLlt<usize>,
    numeric: Llt<usize, f64>,
}

impl Factor {
    /// # Errors
    /// A matrix that is not positive definite.
    pub fn new(matrix: &SymmetricMatrix) -> Result<Factor, FactorError> {
        let symbolic = SymbolicLlt::try_new(matrix.symbolic(), Side::Lower)
            .map_err(|error| FactorError::Other(format!("{error:?}")))?;
        let numeric = numeric(&symbolic, matrix)?;
        Ok(Factor { symbolic, numeric })
    }

    /// New values on the same pattern.
    ///
    /// # Errors
    /// As [`Factor::new`]; the factors stay as they were.
    pub fn refactor(&mut self, matrix: &SymmetricMatrix) -> Result<(), FactorError> {
        self.numeric = numeric(&self.symbolic, matrix)?;
        Ok(())
    }

    /// Solves in place.
    pub fn solve(&self, right: &mut [f64]) {
        self.solve_columns(right, 1);
    }

    /// Solves in place for `columns` right-hand sides, one after the other in `right`. Many at once
    /// read the factors once.
    pub fn solve_columns(&self, right: &mut [f64], columns: usize) {
        let rows = right.len() / columns;
        self.numeric.solve_in_place(MatMut::from_column_major_slice_mut(right, rows, columns));
    }
}

fn numeric(
    symbolic: &SymbolicLlt<usize>,
    matrix: &SymmetricMatrix,
) -> Result<Llt<usize, f64>, FactorError> {
    let values = SparseColMatRef::new(matrix.symbolic(), &matrix.values);
    Llt::try_new_with_symbolic(symbolic.clone(), values, Side::Lower).map_err(|error| match error {
        faer::sparse::linalg::LltError::Numeric(LltError::NonPositivePivot { index }) => {
            FactorError::NotPositiveDefinite { pivot: index }
        }
        other => FactorError::Other(format!("{other:?}")),
    })
}
