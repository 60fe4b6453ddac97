//! Energies of single tetrahedra with exact derivatives, and a displacement field with the body
//! force that it needs.
//!
//! Strain comes from C = FᵀF in plain products, where the library works with H alone; forces are
//! exact derivatives of the energy, where the library has stresses.

use crate::oracles::hyperdual::Jet;

/// Lamé's constants, Pa.
#[derive(Clone, Copy)]
pub struct Lame {
    pub lambda: f64,
    pub mu: f64,
}

/// ∂N/∂ξ for ξ the second, third and fourth barycentric coordinate; 4 or 10 nodes, mid-side nodes
/// between corners 12, 23, 31, 14, 24, 34.
fn derivatives(nodes: usize, l: [f64; 4]) -> Vec<[f64; 3]> {
    let along = |by: [f64; 4]| [by[1] - by[0], by[2] - by[0], by[3] - by[0]];
    let mut all = Vec::new();
    for corner in 0..4 {
        let mut by = [0.0; 4];
        by[corner] = if nodes == 4 { 1.0 } else { 4.0 * l[corner] - 1.0 };
        all.push(along(by));
    }
    if nodes == 10 {
        for [a, b] in [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]] {
            let mut by = [0.0; 4];
            by[a] = 4.0 * l[b];
            by[b] = 4.0 * l[a];
            all.push(along(by));
        }
    }
    all
}

fn inverse(m: [[f64; 3]; 3]) -> ([[f64; 3]; 3], f64) {
    let minor = |r: usize, c: usize| {
        let (r1, r2) = ((r + 1) % 3, (r + 2) % 3);
        let (c1, c2) = ((c + 1) % 3, (c + 2) % 3);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let det = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    let mut out = [[0.0; 3]; 3];
    for (r, row) in out.iter_mut().enumerate() {
        for (c, entry) in row.iter_mut().enumerate() {
            *entry = minor(c, r) / det;
        }
    }
    (out, det)
}

/// Strain energy of one element, J, as a function of its nodal displacements; `N` is three times
/// the number of nodes. One point for four nodes, the four-point rule of degree two for ten.
pub fn energy<const N: usize>(
    places: &[[f64; 3]],
    displacement: &[[f64; 3]],
    material: Lame,
) -> Jet<N> {
    let far = 0.25 + 0.15 * 5f64.sqrt();
    let near = 0.25 - 0.05 * 5f64.sqrt();
    let points: Vec<[f64; 4]> = if places.len() == 4 {
        vec![[0.25; 4]]
    } else {
        (0..4).map(|p| [0, 1, 2, 3].map(|i: usize| if i == p { far } else { near })).collect()
    };
    let mut sum = Jet::constant(0.0);
    for l in &points {
        let shape = derivatives(places.len(), *l);
        // ∂X/∂ξ, rows X.
        let mut map = [[0.0; 3]; 3];
        for (x, d) in places.iter().zip(&shape) {
            for i in 0..3 {
                for k in 0..3 {
                    map[i][k] += x[i] * d[k];
                }
            }
        }
        let (back, det) = inverse(map);
        let mut f = [[Jet::<N>::constant(0.0); 3]; 3];
        for (node, (x, u)) in places.iter().zip(displacement).enumerate() {
            for i in 0..3 {
                let place = Jet::variable(x[i] + u[i], 3 * node + i);
                for j in 0..3 {
                    let gradient: f64 = (0..3).map(|k| shape[node][k] * back[k][j]).sum();
                    f[i][j] = f[i][j] + place.scale(gradient);
                }
            }
        }
        let mut trace = Jet::constant(0.0);
        let mut squares = Jet::constant(0.0);
        for i in 0..3 {
            for j in 0..3 {
                let c = f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j];
                let e = if i == j { c.shift(-1.0).scale(0.5) } else { c.scale(0.5) };
                if i == j {
                    trace = trace + e;
                }
                squares = squares + e.square();
            }
        }
        let density = trace.square().scale(0.5 * material.lambda) + squares.scale(material.mu);
        sum = sum + density.scale(det / 6.0 / points.len() as f64);
    }
    sum
}

/// A smooth displacement field on the unit cube, m, with strains of some percent.
fn field([x, y, z]: [f64; 3]) -> [Jet<3>; 3] {
    const SIZE: f64 = 0.02;
    let (x, y, z) = (Jet::variable(x, 0), Jet::variable(y, 1), Jet::variable(z, 2));
    [
        ((x.scale(2.0) + y).sin() * z.scale(1.5).cos()).scale(SIZE),
        ((y.scale(2.0) - z).sin() * x.shift(0.3).cos()).scale(SIZE),
        ((z + x.scale(1.3)).cos() * y.scale(2.2).sin()).scale(SIZE),
    ]
}

pub fn displacement(place: [f64; 3]) -> [f64; 3] {
    field(place).map(|u| u.value)
}

type Matrix = [[f64; 3]; 3];

fn product(a: Matrix, b: Matrix) -> Matrix {
    let mut out = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            out[i][j] = (0..3).map(|k| a[i][k] * b[k][j]).sum();
        }
    }
    out
}

fn transposed(a: Matrix) -> Matrix {
    [0, 1, 2].map(|i: usize| [a[0][i], a[1][i], a[2][i]])
}

/// λ tr(E) 1 + 2μ E of a symmetric E.
fn stress(e: Matrix, material: Lame) -> Matrix {
    let mut s = e.map(|row| row.map(|x| 2.0 * material.mu * x));
    for i in 0..3 {
        s[i][i] += material.lambda * (e[0][0] + e[1][1] + e[2][2]);
    }
    s
}

/// The force per undeformed volume that holds [`displacement`] in equilibrium, N/m³: minus the
/// divergence of P = F S, from exact first and second derivatives of the field.
pub fn body_force(place: [f64; 3], material: Lame) -> [f64; 3] {
    let u = field(place);
    let mut f = u.map(|u| u.gradient);
    for (i, row) in f.iter_mut().enumerate() {
        row[i] += 1.0;
    }
    let strain = |c: Matrix| {
        let mut e = c.map(|row| row.map(|x| 0.5 * x));
        for (i, row) in e.iter_mut().enumerate() {
            row[i] -= 0.5;
        }
        e
    };
    let s = stress(strain(product(transposed(f), f)), material);
    let mut force = [0.0; 3];
    for along in 0..3 {
        let df = u.map(|u| u.hessian[along]);
        let half = product(transposed(f), df);
        let other = transposed(half);
        let mut de = half;
        for i in 0..3 {
            for j in 0..3 {
                de[i][j] = 0.5 * (half[i][j] + other[i][j]);
            }
        }
        let first = product(df, s);
        let second = product(f, stress(de, material));
        for i in 0..3 {
            force[i] -= first[i][along] + second[i][along];
        }
    }
    force
}
