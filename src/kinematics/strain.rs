//! Deformation at a point of a solid, from the displacement gradient H.
//!
//! Strains are computed from H, never from F − 1: FᵀF − 1 loses ten digits at a strain of 1e-6. All functions are
//! inlined and branch-free, and give the same bits for one element and for SIMD lanes.

use crate::kinematics::number::Number;
use crate::kinematics::vec3::cross;

/// Rows of a 3 × 3 matrix, of numbers or SIMD lanes.
pub type Mat3<T = f64> = [[T; 3]; 3];

/// Symmetric tensor: xx, yy, zz, xy, yz, zx.
pub type Sym3<T = f64> = [T; 6];

/// Fourth-order tensor from a change of strain to a change of stress: symmetric in its first and in its last two
/// indices, pairs in the order of [`Sym3`].
pub type Tangent = [[f64; 6]; 6];

/// Product of the tangent and a change of strain; off-diagonal components count twice.
#[inline(always)]
pub fn applied(tangent: &Tangent, change: &Sym3) -> Sym3 {
    let mut sum = [0.0; 6];
    for (sum, row) in sum.iter_mut().zip(tangent) {
        *sum = double_dot(row, change);
    }
    sum
}

/// A : B.
#[inline(always)]
pub fn double_dot<T: Number>(a: &Sym3<T>, b: &Sym3<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + T::of(2.0) * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])
}

/// Full matrix of a symmetric tensor.
#[inline(always)]
pub fn full<T: Number>(s: &Sym3<T>) -> Mat3<T> {
    [[s[0], s[3], s[5]], [s[3], s[1], s[4]], [s[5], s[4], s[2]]]
}

/// Deformation gradient F = 1 + H (4.2).
#[inline(always)]
pub fn deformation_gradient<T: Number>(h: &Mat3<T>) -> Mat3<T> {
    let mut f = *h;
    for i in 0..3 {
        f[i][i] = f[i][i] + T::of(1.0);
    }
    f
}

/// Right Cauchy–Green tensor C = FᵀF (2.2). For strains use [`green_lagrange`], which keeps full precision.
#[inline(always)]
pub fn right_cauchy_green(h: &Mat3) -> Sym3 {
    let e = green_lagrange(h);
    [1.0 + 2.0 * e[0], 1.0 + 2.0 * e[1], 1.0 + 2.0 * e[2], 2.0 * e[3], 2.0 * e[4], 2.0 * e[5]]
}

/// Green–Lagrange strain (2.3) in terms of the displacement gradient: E = (H + Hᵀ + HᵀH)/2.
#[inline(always)]
pub fn green_lagrange<T: Number>(h: &Mat3<T>) -> Sym3<T> {
    let half = T::of(0.5);
    let product = |i: usize, j: usize| h[0][i] * h[0][j] + h[1][i] * h[1][j] + h[2][i] * h[2][j];
    [
        h[0][0] + half * product(0, 0),
        h[1][1] + half * product(1, 1),
        h[2][2] + half * product(2, 2),
        half * (h[0][1] + h[1][0] + product(0, 1)),
        half * (h[1][2] + h[2][1] + product(1, 2)),
        half * (h[2][0] + h[0][2] + product(2, 0)),
    ]
}

/// Linearised change of [`green_lagrange`] for a `change` of H: sym(Fᵀ dH).
#[inline(always)]
pub fn green_lagrange_change(h: &Mat3, change: &Mat3) -> Sym3 {
    let f = deformation_gradient(h);
    let half = |i: usize, j: usize| {
        f[0][i] * change[0][j] + f[1][i] * change[1][j] + f[2][i] * change[2][j]
    };
    [
        half(0, 0),
        half(1, 1),
        half(2, 2),
        0.5 * (half(0, 1) + half(1, 0)),
        0.5 * (half(1, 2) + half(2, 1)),
        0.5 * (half(2, 0) + half(0, 2)),
    ]
}

/// J − 1 with J = det F (3.5), with full precision at small H.
#[inline(always)]
pub fn volume_change<T: Number>(h: &Mat3<T>) -> T {
    let minor = |i: usize, j: usize| h[i][i] * h[j][j] - h[i][j] * h[j][i];
    h[0][0] + h[1][1] + h[2][2] + minor(0, 1) + minor(1, 2) + minor(2, 0) + determinant(h)
}

/// Cofactors of F, the derivative of J by F: J F⁻ᵀ.
#[inline(always)]
pub fn cofactor<T: Number>(f: &Mat3<T>) -> Mat3<T> {
    [cross(f[1], f[2]), cross(f[2], f[0]), cross(f[0], f[1])]
}

#[inline(always)]
pub fn determinant<T: Number>(a: &Mat3<T>) -> T {
    a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1])
        - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
        + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0])
}

/// First Piola–Kirchhoff stress P = F S, as S + H S.
#[inline(always)]
pub fn first_piola_kirchhoff<T: Number>(h: &Mat3<T>, second: &Sym3<T>) -> Mat3<T> {
    let s = full(second);
    let mut p = s;
    for i in 0..3 {
        for j in 0..3 {
            p[i][j] = p[i][j] + (h[i][0] * s[0][j] + h[i][1] * s[1][j] + h[i][2] * s[2][j]);
        }
    }
    p
}

/// Cauchy stress T = F S Fᵀ/J (2.5).
pub fn cauchy(h: &Mat3, second: &Sym3) -> Sym3 {
    let f = deformation_gradient(h);
    let p = first_piola_kirchhoff(h, second);
    let per_volume = 1.0 / (1.0 + volume_change(h));
    let entry = |i: usize, j: usize| {
        per_volume * (p[i][0] * f[j][0] + p[i][1] * f[j][1] + p[i][2] * f[j][2])
    };
    [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)]
}

#[inline(always)]
pub fn times<T: Number>(a: &Mat3<T>, v: [T; 3]) -> [T; 3] {
    [
        a[0][0] * v[0] + a[0][1] * v[1] + a[0][2] * v[2],
        a[1][0] * v[0] + a[1][1] * v[1] + a[1][2] * v[2],
        a[2][0] * v[0] + a[2][1] * v[1] + a[2][2] * v[2],
    ]
}

/// von Mises stress of a Cauchy stress.
pub fn von_mises(t: &Sym3) -> f64 {
    let square = |x: f64| x * x;
    (0.5 * (square(t[0] - t[1]) + square(t[1] - t[2]) + square(t[2] - t[0]))
        + 3.0 * (square(t[3]) + square(t[4]) + square(t[5])))
    .sqrt()
}

/// Principal values of a symmetric tensor, largest first.
pub fn principal(t: &Sym3) -> [f64; 3] {
    let values = nalgebra::Matrix3::from(full(t)).symmetric_eigenvalues();
    let mut values = [values[0], values[1], values[2]];
    values.sort_by(|a, b| b.total_cmp(a));
    values
}
