//! Small symmetric eigenvalue problems of the Rayleigh–Ritz method.

use nalgebra::{DMatrix, SymmetricEigen};
use std::cmp::Ordering;

/// Eigenvalues of a symmetric matrix in an order, and its eigenvectors as columns.
pub fn sorted(
    matrix: DMatrix<f64>,
    order: impl Fn(&f64, &f64) -> Ordering,
) -> (Vec<f64>, DMatrix<f64>) {
    if matrix.is_empty() {
        return (Vec::new(), matrix);
    }
    let eigen = SymmetricEigen::new(matrix);
    let mut numbers: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    numbers.sort_by(|a, b| order(&eigen.eigenvalues[*a], &eigen.eigenvalues[*b]));
    let values = numbers.iter().map(|k| eigen.eigenvalues[*k]).collect();
    (values, eigen.eigenvectors.select_columns(&numbers))
}

/// Combinations of vectors, scaled by `unit`, that are orthonormal under their Gram matrix, as columns. Those of which
/// less than `least` is independent of the others are dropped.
pub fn independent(gram: DMatrix<f64>, unit: impl Fn(usize) -> f64, least: f64) -> DMatrix<f64> {
    let size = gram.nrows();
    let (values, vectors) = sorted(gram, |_, _| Ordering::Equal);
    let new: Vec<usize> = (0..size).filter(|k| values[*k] > least).collect();
    DMatrix::from_fn(size, new.len(), |i, k| unit(i) * vectors[(i, new[k])] / values[new[k]].sqrt())
}
