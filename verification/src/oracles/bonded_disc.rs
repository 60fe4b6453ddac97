//! The radial stiffness of a bonded bushing of finite length in closed form, for rubber that keeps its volume:
//! sections stay alike along the axis but for a parabola, free ends bear no shear in the mean. Exact for
//! plane strain and for thin discs; a few per cent from the truth between.

use std::f64::consts::PI;

/// I₁(x) e⁻ˣ and its function's derivative times e⁻ˣ, by (1/π) ∫ exp(x (cos θ − 1)) cosᵏ θ dθ.
pub fn first_kind(x: f64) -> [f64; 2] {
    const COUNT: usize = 400;
    let mut sums = [0.0; 2];
    for n in 0..COUNT {
        let c = (2.0 * PI * n as f64 / COUNT as f64).cos();
        let w = (x * (c - 1.0)).exp() / COUNT as f64;
        sums[0] += w * c;
        sums[1] += w * c * c;
    }
    sums
}

/// K₁(x) eˣ and its function's derivative times eˣ, by ∫ exp(−x (cosh t − 1)) coshᵏ t dt.
pub fn second_kind(x: f64) -> [f64; 2] {
    const STEP: f64 = 0.01;
    let mut sums = [0.0; 2];
    for n in 0..1000 {
        let c = (STEP * n as f64).cosh();
        let w = STEP * (-x * (c - 1.0)).exp() * if n == 0 { 0.5 } else { 1.0 };
        sums[0] += w * c;
        sums[1] -= w * c * c;
    }
    sums
}

/// Solution of a small system by elimination with pivots.
fn solve(mut a: [[f64; 6]; 6], mut b: [f64; 6]) -> [f64; 6] {
    for k in 0..6 {
        let best = (k..6).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs())).unwrap_or(k);
        a.swap(k, best);
        b.swap(k, best);
        for i in k + 1..6 {
            let factor = a[i][k] / a[k][k];
            for j in k..6 {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    let mut x = [0.0; 6];
    for k in (0..6).rev() {
        let known: f64 = (k + 1..6).map(|j| a[k][j] * x[j]).sum();
        x[k] = (b[k] - known) / a[k][k];
    }
    x
}

/// Force over displacement, shear modulus and length, of radii a and b and the length L in m.
pub fn radial_stiffness(a: f64, b: f64, length: f64) -> f64 {
    // In units of b; Bessel functions relative to their largest in the wall.
    let (a, alpha) = (a / b, 60f64.sqrt() * b / length);
    // Columns: r₀, k₂, h₁, h₂, A, B.
    let at = |r: f64| {
        let [i, i_slope] = first_kind(alpha * r).map(|x| x * (alpha * (r - 1.0)).exp());
        let [k, k_slope] = second_kind(alpha * r).map(|x| x * (-alpha * (r - a)).exp());
        let (square, log) = (r * r, r.ln());
        let f = [1.0, -1.0 / square, -square / 32.0, 0.625 * log, i_slope / alpha, k_slope / alpha];
        let g = [
            -1.0,
            -1.0 / square,
            11.0 / 32.0 * square,
            -(0.625 * log + 0.375),
            -i / (r * alpha * alpha),
            -k / (r * alpha * alpha),
        ];
        let d = [0.0, 0.0, 0.25 * r, 0.25 / r, i, k];
        [f, g, d]
    };
    let ([fa, ga, da], [fb, gb, db]) = (at(a), at(1.0));
    let found = solve([fa, ga, fb, gb, da, db], [1.0, -1.0, 0.0, 0.0, 0.0, 0.0]);
    -2.0 * PI * found[3]
}
