//! The linear solver of the oracles.

use verification::oracles::dense::{Matrix, dot, solve_positive_definite};

#[test]
fn solves_a_hilbert_like_system_and_refuses_an_indefinite_one() {
    let matrix: Matrix =
        (0..6).map(|i| (0..6).map(|j| 1.0 / (1.0 + (i + j) as f64)).collect()).collect();
    let rhs = [1.0, -2.0, 3.0, 0.5, 0.0, 1.0];
    let x = solve_positive_definite(&matrix, 0.25, &rhs).expect("positive definite");
    for i in 0..6 {
        let product = dot(&matrix[i], &x) + 0.25 * x[i];
        assert!((product - rhs[i]).abs() <= 1e-13, "row {i}: {product}");
    }
    let saddle = vec![vec![1.0, 2.0], vec![2.0, 1.0]];
    assert!(solve_positive_definite(&saddle, 0.0, &[1.0, 1.0]).is_none());
    assert!(solve_positive_definite(&saddle, 1.5, &[1.0, 1.0]).is_some());
}
