//! Energy of a uniform deformation, from the invariants of C.

type Matrix = [[f64; 3]; 3];

/// Strain energy per undeformed volume of a St. Venant–Kirchhoff solid, J/m³: with I₁ and I₂ of
/// C = FᵀF it is λ/8 (I₁ − 3)² + μ/4 (I₁² − 2 I₂ − 2 I₁ + 3).
pub fn energy_density(f: Matrix, young: f64, poisson: f64) -> f64 {
    let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let mu = 0.5 * young / (1.0 + poisson);
    let mut c = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            c[i][j] = (0..3).map(|k| f[k][i] * f[k][j]).sum();
        }
    }
    let minor = |i: usize, j: usize| c[i][i] * c[j][j] - c[i][j] * c[j][i];
    let first: f64 = c[0][0] + c[1][1] + c[2][2];
    let second: f64 = minor(0, 1) + minor(1, 2) + minor(2, 0);
    0.125 * lambda * (first - 3.0).powi(2)
        + 0.25 * mu * (first * first - 2.0 * second - 2.0 * first + 3.0)
}
