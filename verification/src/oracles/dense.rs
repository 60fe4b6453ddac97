//! Small dense symmetric systems.

/// Symmetric matrix, row by row.
pub type Matrix = Vec<Vec<f64>>;

/// Solution of `(matrix + shift·1) x = rhs` by Cholesky, or `None` if the shifted matrix is not
/// positive definite.
pub fn solve_positive_definite(matrix: &Matrix, shift: f64, rhs: &[f64]) -> Option<Vec<f64>> {
    let n = rhs.len();
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let mut sum = matrix[i][j];
            sum -= dot(&lower[i][..j], &lower[j][..j]);
            if i == j {
                sum += shift;
                // A pivot that is only rounding is no pivot.
                let floor = 1e-15 * (matrix[i][i].abs() + shift);
                if sum.is_nan() || sum <= floor {
                    return None;
                }
                lower[i][i] = sum.sqrt();
            } else {
                lower[i][j] = sum / lower[j][j];
            }
        }
    }
    let mut x = rhs.to_vec();
    for i in 0..n {
        for j in 0..i {
            x[i] -= lower[i][j] * x[j];
        }
        x[i] /= lower[i][i];
    }
    for i in (0..n).rev() {
        for j in i + 1..n {
            x[i] -= lower[j][i] * x[j];
        }
        x[i] /= lower[i][i];
    }
    Some(x)
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
