//! Stiffnesses of a bonded bushing at small displacements, by one Fourier component n around and polynomials
//! of high degree: displacements are U cos nφ, V sin nφ, W cos nφ with U, V, W over the half section (n = 0: U, V,
//! W alike all around), in rectangles that shrink towards the corners where sleeve and free end meet. Pointwise volume, no
//! tetrahedra, complex moduli from the start.

use nalgebra::Complex;

type C = Complex<f64>;

/// Lengths in m.
#[derive(Clone, Copy)]
pub struct Section {
    pub inner: f64,
    pub outer: f64,
    pub length: f64,
}

/// Gauss–Lobatto points and weights of degree p on (−1, 1), and derivatives of the Lagrange polynomials
/// through them.
pub struct Rule {
    pub points: Vec<f64>,
    pub weights: Vec<f64>,
    pub slopes: Vec<Vec<f64>>,
}

/// Legendre's polynomial of degree n and the one before.
fn legendre(n: usize, x: f64) -> [f64; 2] {
    let (mut before, mut now) = (1.0, x);
    for k in 1..n {
        let k = k as f64;
        (before, now) = (now, ((2.0 * k + 1.0) * x * now - k * before) / (k + 1.0));
    }
    [now, before]
}

/// The rule of degree p, its points by Newton's steps.
pub fn lobatto(p: usize) -> Rule {
    let n = p as f64;
    let points: Vec<f64> = (0..=p)
        .map(|i| {
            let mut x = -(std::f64::consts::PI * i as f64 / n).cos();
            for _ in 0..60 {
                let [l, before] = legendre(p, x);
                // Newton on (1 − x²) P′ = n (P₋ − x P), whose derivative is −n (n + 1) P.
                x += (before - x * l) / ((n + 1.0) * l);
            }
            x
        })
        .collect();
    let weights =
        points.iter().map(|x| 2.0 / (n * (n + 1.0) * legendre(p, *x)[0].powi(2))).collect();
    let slopes = (0..=p)
        .map(|i| {
            (0..=p)
                .map(|j| {
                    let [li, lj] = [points[i], points[j]].map(|x| legendre(p, x)[0]);
                    match (i, j) {
                        _ if i != j => li / (lj * (points[i] - points[j])),
                        (0, _) => -n * (n + 1.0) / 4.0,
                        _ if i == p => n * (n + 1.0) / 4.0,
                        _ => 0.0,
                    }
                })
                .collect()
        })
        .collect();
    Rule { points, weights, slopes }
}

/// Symmetric band matrix, lower part by columns, factorised without pivots.
struct Band {
    width: usize,
    columns: Vec<C>,
}

impl Band {
    fn at(&mut self, row: usize, column: usize) -> &mut C {
        &mut self.columns[column * self.width + row - column]
    }

    /// L D Lᵀ in place, then the solution.
    fn solve(&mut self, right: &mut [C]) {
        let (count, width) = (right.len(), self.width);
        for k in 0..count {
            let reach = width.min(count - k);
            let (head, tail) = self.columns.split_at_mut((k + 1) * width);
            let column = &mut head[k * width..];
            let pivot = column[0];
            for i in 1..reach {
                let factor = column[i] / pivot;
                let to = &mut tail[(i - 1) * width..(i - 1) * width + reach - i];
                for (to, from) in to.iter_mut().zip(&column[i..reach]) {
                    *to -= factor * from;
                }
                let known = right[k];
                right[k + i] -= factor * known;
            }
        }
        for k in (0..count).rev() {
            let reach = width.min(count - k);
            let column = &self.columns[k * width..k * width + reach];
            let sum: C = (1..reach).map(|i| column[i] * right[k + i]).sum();
            right[k] = (right[k] - sum) / column[0];
        }
    }
}

/// Stations over a length of 1 that shrink fivefold towards the given ends.
fn stations(layers: i32, low: bool, high: bool) -> Vec<f64> {
    let inner = |k: i32| 0.5 * 0.2f64.powi(k);
    let mut all = vec![0.0];
    if low {
        all.extend((1..=layers).rev().map(inner));
    }
    all.push(0.5);
    if high {
        all.extend((1..=layers).map(|k| 1.0 - inner(k)));
    }
    all.push(1.0);
    all
}

/// A small motion of the inner sleeve, the outer one held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Across the axis, N/m.
    Radial,
    /// Along it, N/m.
    Axial,
    /// About it, N·m/rad.
    Torsional,
    /// About a line across it through the middle, N·m/rad.
    Conical,
}

impl Motion {
    fn component(self) -> f64 {
        match self {
            Motion::Radial | Motion::Conical => 1.0,
            Motion::Axial | Motion::Torsional => 0.0,
        }
    }

    /// U, V, W of the inner sleeve of radius a at a distance x from the middle.
    fn sleeve(self, a: f64, x: f64) -> [f64; 3] {
        match self {
            Motion::Radial => [1.0, -1.0, 0.0],
            Motion::Axial => [0.0, 0.0, 1.0],
            Motion::Torsional => [0.0, a, 0.0],
            // e × r about the line: a cos φ along the axis, −x across it.
            Motion::Conical => [-x, x, a],
        }
    }

    /// Components that vanish in the middle of the length.
    fn middle(self) -> &'static [usize] {
        match self {
            Motion::Radial | Motion::Torsional => &[2],
            Motion::Axial | Motion::Conical => &[0, 1],
        }
    }
}

/// Force over displacement, N/m, across the axis.
pub fn radial_stiffness(section: Section, shear: C, bulk: f64, p: usize, layers: i32) -> C {
    stiffness(section, Motion::Radial, shear, bulk, p, layers)
}

/// Force or moment over a small motion, of a rubber with the shear modulus μ (complex, Pa) and the bulk
/// modulus B (Pa), by polynomials of degree `p` in `layers` shrinking rectangles at each corner.
pub fn stiffness(
    section: Section,
    motion: Motion,
    shear: C,
    bulk: f64,
    p: usize,
    layers: i32,
) -> C {
    let component = motion.component();
    // ∫ cos² nφ dφ over π.
    let around = if component == 0.0 { 2.0 } else { 1.0 };
    let rule = lobatto(p);
    let r = stations(layers, true, true);
    let x = stations(layers, false, true);
    let (nr, nx) = (p * (r.len() - 1) + 1, p * (x.len() - 1) + 1);
    let unknown = |i: usize, j: usize, c: usize| 3 * (i * nx + j) + c;
    let count = 3 * nr * nx;
    let mut band = Band { width: 3 * (p * nx + p + 1), columns: Vec::new() };
    band.columns = vec![C::new(0.0, 0.0); count * band.width];
    let lambda = shear * (-2.0 / 3.0) + bulk;
    let thickness = section.outer - section.inner;
    let half = 0.5 * section.length;
    let nodes = (p + 1) * (p + 1);
    for er in 0..r.len() - 1 {
        for ex in 0..x.len() - 1 {
            let (hr, hx) =
                (0.5 * thickness * (r[er + 1] - r[er]), 0.5 * half * (x[ex + 1] - x[ex]));
            let mut k = vec![C::new(0.0, 0.0); 9 * nodes * nodes];
            for a in 0..=p {
                for b in 0..=p {
                    let radius = section.inner + thickness * r[er] + hr * (1.0 + rule.points[a]);
                    let weight = around
                        * std::f64::consts::PI
                        * rule.weights[a]
                        * rule.weights[b]
                        * hr
                        * hx
                        * radius;
                    // Nodes whose polynomials or slopes do not vanish here: a cross.
                    let mut rows: Vec<(usize, [[f64; 3]; 6])> = Vec::new();
                    for m in 0..=p {
                        for n in 0..=p {
                            if m != a && n != b {
                                continue;
                            }
                            let here = if m == a && n == b { 1.0 } else { 0.0 };
                            let dr = if n == b { rule.slopes[a][m] / hr } else { 0.0 };
                            let dx = if m == a { rule.slopes[b][n] / hx } else { 0.0 };
                            let by = here / radius;
                            // Strains rr, φφ, xx and shears rφ, φx, rx by U, V, W.
                            let strains = [
                                [dr, 0.0, 0.0],
                                [by, component * by, 0.0],
                                [0.0, 0.0, dx],
                                [-component * by, dr - by, 0.0],
                                [0.0, dx, -component * by],
                                [dx, 0.0, dr],
                            ];
                            rows.push((m * (p + 1) + n, strains));
                        }
                    }
                    for (at, e) in &rows {
                        for (to, f) in &rows {
                            for c in 0..3 {
                                for d in 0..3 {
                                    let trace =
                                        |e: &[[f64; 3]; 6], c: usize| e[0][c] + e[1][c] + e[2][c];
                                    let normal: f64 = (0..3).map(|s| e[s][c] * f[s][d]).sum();
                                    let sheared: f64 = (3..6).map(|s| e[s][c] * f[s][d]).sum();
                                    let value = lambda * (trace(e, c) * trace(f, d))
                                        + shear * (2.0 * normal + sheared);
                                    k[(3 * at + c) * 3 * nodes + 3 * to + d] += value * weight;
                                }
                            }
                        }
                    }
                }
            }
            for row in 0..3 * nodes {
                for column in 0..3 * nodes {
                    let place = |at: usize| {
                        let (node, c) = (at / 3, at % 3);
                        unknown(er * p + node / (p + 1), ex * p + node % (p + 1), c)
                    };
                    let (row_at, column_at) = (place(row), place(column));
                    if row_at >= column_at {
                        *band.at(row_at, column_at) += k[row * 3 * nodes + column];
                    }
                }
            }
        }
    }
    // Sleeves and the middle.
    let whole = Band { width: band.width, columns: band.columns.clone() };
    let mut given: Vec<Option<f64>> = vec![None; count];
    for j in 0..nx {
        let (layer, point) = if j == nx - 1 { (x.len() - 2, p) } else { (j / p, j % p) };
        let part = x[layer] + 0.5 * (x[layer + 1] - x[layer]) * (1.0 + rule.points[point]);
        let moved = motion.sleeve(section.inner, half * part);
        for (c, value) in moved.into_iter().enumerate() {
            given[unknown(0, j, c)] = Some(value);
            given[unknown(nr - 1, j, c)] = Some(0.0);
        }
    }
    for i in 0..nr {
        for c in motion.middle() {
            given[unknown(i, 0, *c)].get_or_insert(0.0);
        }
    }
    let zero = C::new(0.0, 0.0);
    let mut right = vec![zero; count];
    for column in 0..count {
        for row in column..count.min(column + band.width) {
            let value = whole.columns[column * band.width + row - column];
            match (given[row], given[column]) {
                (None, None) => {}
                (None, Some(u)) => right[row] -= value * u,
                (Some(u), None) => right[column] -= value * u,
                _ => {}
            }
            if given[row].is_some() || given[column].is_some() {
                *band.at(row, column) = if row == column { C::new(1.0, 0.0) } else { zero };
            }
        }
    }
    for (right, given) in right.iter_mut().zip(&given) {
        if let Some(u) = given {
            *right = C::new(*u, 0.0);
        }
    }
    band.solve(&mut right);
    // Twice the energy of the half length, twice.
    let mut sum = zero;
    for column in 0..count {
        for row in column..count.min(column + whole.width) {
            let value = whole.columns[column * whole.width + row - column];
            let twice = if row == column { 1.0 } else { 2.0 };
            sum += value * right[row] * right[column] * twice;
        }
    }
    sum * 2.0
}

/// The radial stiffness over shear modulus and length of rubber that keeps its volume, sleeves bonded, ends free:
/// displacements f(r) cos φ, g(r) sin φ across the length, the rest parabolic along it. A closed form by others, within
/// 2 % of converged elements up to a length of twice the wall.
pub fn incompressible_stiffness(section: Section) -> f64 {
    let Section { inner: a, outer: b, length } = section;
    let alpha = 60f64.sqrt() / length;
    // Unknowns r₀, k₂, h₁, h₂ (lengths over b), and those of I₁ and K₁ over their largest values.
    let scale = [bessel_i(1, alpha * b), bessel_k(1, alpha * a)];
    let radial = |r: f64| {
        let x = alpha * r;
        let slopes = [
            (bessel_i(0, x) - bessel_i(1, x) / x) / scale[0],
            (-bessel_k(0, x) - bessel_k(1, x) / x) / scale[1],
        ];
        let ln = (r / b).ln();
        [1.0, -(b / r).powi(2), -(r / b).powi(2) / 32.0, 0.625 * ln, slopes[0], slopes[1]]
    };
    let around = |r: f64| {
        let x = alpha * r;
        let values = [bessel_i(1, x) / scale[0], bessel_k(1, x) / scale[1]];
        let (ln, square) = ((r / b).ln(), (r / b).powi(2));
        [
            -1.0,
            -1.0 / square,
            11.0 / 32.0 * square,
            -(0.625 * ln + 0.375),
            -values[0] / x,
            -values[1] / x,
        ]
    };
    let along = |r: f64| {
        let x = alpha * r;
        let values = [bessel_i(1, x) / scale[0], bessel_k(1, x) / scale[1]];
        let per = alpha * b;
        [0.0, 0.0, 0.25 * r / b, 0.25 * b / r, per * values[0], per * values[1]]
    };
    let rows = [radial(a), around(a), radial(b), around(b), along(a), along(b)];
    let matrix = nalgebra::Matrix6::from_fn(|i, j| rows[i][j]);
    let right = nalgebra::Vector6::new(1.0, -1.0, 0.0, 0.0, 0.0, 0.0);
    let solution = matrix.lu().solve(&right).map_or(f64::NAN, |x| x[3]);
    -std::f64::consts::TAU * solution
}

/// Iₙ by its integral over half a turn, which the trapezoidal rule takes to rounding.
pub fn bessel_i(n: i32, x: f64) -> f64 {
    let count = 200;
    let at = |k: i32| {
        let angle = std::f64::consts::PI * f64::from(k) / f64::from(count);
        (x * angle.cos()).exp() * (f64::from(n) * angle).cos()
    };
    (0.5 * (at(0) + at(count)) + (1..count).map(at).sum::<f64>()) / f64::from(count)
}

/// Kₙ by its integral over exp(−x cosh t) cosh nt.
pub fn bessel_k(n: i32, x: f64) -> f64 {
    let step = 0.02;
    let at = |k: i32| {
        let t = step * f64::from(k);
        (-x * t.cosh()).exp() * (f64::from(n) * t).cosh()
    };
    step * (0.5 * at(0) + (1..600).map(at).sum::<f64>())
}
