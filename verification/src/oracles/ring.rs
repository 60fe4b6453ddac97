//! Natural frequencies of a free ring: Ritz' method in cylindrical coordinates, three-dimensional
//! and without any mesh; and the closed form for a thin ring.

use crate::oracles::dense::{Matrix, solve_positive_definite};

/// A ring of rectangular section, SI.
#[derive(Clone, Copy)]
pub struct Ring {
    pub inner: f64,
    pub outer: f64,
    pub width: f64,
    pub young: f64,
    pub poisson: f64,
    pub density: f64,
}

/// Which way the ring bends.
#[derive(Clone, Copy, PartialEq)]
pub enum Plane {
    In,
    OutOf,
}

/// Gauss' five-point rule on (−1, 1).
fn gauss() -> [(f64, f64); 5] {
    let root = (10f64 / 7.0).sqrt();
    let (near, far) = ((5.0 - 2.0 * root).sqrt() / 3.0, (5.0 + 2.0 * root).sqrt() / 3.0);
    let tail = 13.0 * 70f64.sqrt();
    let (inner, outer) = ((322.0 + tail) / 900.0, (322.0 - tail) / 900.0);
    [(-far, outer), (-near, inner), (0.0, 128.0 / 225.0), (near, inner), (far, outer)]
}

/// One function of the basis: component (radial, hoop, axial) and powers of ρ and ξ, both in
/// (−1, 1) across the section.
type Function = (usize, i32, i32);

impl Ring {
    /// Lowest natural frequency with `waves` ≥ 2 waves around, Hz: radial and axial displacement as
    /// cos nθ, hoop as sin nθ, each a polynomial across the section.
    pub fn frequency(&self, waves: u32, plane: Plane) -> f64 {
        let n = f64::from(waves);
        let basis = basis(plane);
        let size = basis.len();
        let mut stiffness: Matrix = vec![vec![0.0; size]; size];
        let mut mass: Matrix = vec![vec![0.0; size]; size];
        let lambda =
            self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson));
        let mu = 0.5 * self.young / (1.0 + self.poisson);
        let (half_height, half_width) = (0.5 * (self.outer - self.inner), 0.5 * self.width);
        for (rho, weight_r) in gauss() {
            for (xi, weight_x) in gauss() {
                let r = 0.5 * (self.inner + self.outer) + half_height * rho;
                let share = weight_r * weight_x * half_height * half_width * r;
                // Strains rr, θθ, xx (as cos), doubled shears rθ, θx (as sin), rx (as cos).
                let strains: Vec<[f64; 6]> = basis
                    .iter()
                    .map(|&(component, i, j)| {
                        let value = rho.powi(i) * xi.powi(j);
                        let by_r = slope(rho, i) * xi.powi(j) / half_height;
                        let by_x = rho.powi(i) * slope(xi, j) / half_width;
                        match component {
                            0 => [by_r, value / r, 0.0, -n * value / r, 0.0, by_x],
                            1 => [0.0, n * value / r, 0.0, by_r - value / r, by_x, 0.0],
                            _ => [0.0, 0.0, by_x, 0.0, -n * value / r, by_r],
                        }
                    })
                    .collect();
                for a in 0..size {
                    for b in 0..size {
                        let (s, t) = (strains[a], strains[b]);
                        let trace = (s[0] + s[1] + s[2]) * (t[0] + t[1] + t[2]);
                        let normal = s[0] * t[0] + s[1] * t[1] + s[2] * t[2];
                        let shear = s[3] * t[3] + s[4] * t[4] + s[5] * t[5];
                        stiffness[a][b] +=
                            share * (lambda * trace + 2.0 * mu * normal + mu * shear);
                        if basis[a].0 == basis[b].0 {
                            let product = rho.powi(basis[a].1 + basis[b].1)
                                * xi.powi(basis[a].2 + basis[b].2);
                            mass[a][b] += share * self.density * product;
                        }
                    }
                }
            }
        }
        lowest(&stiffness, &mass).sqrt() / std::f64::consts::TAU
    }

    /// Hoppe's frequency of an inextensible thin ring bending in its plane, Hz.
    pub fn thin_ring(&self, waves: u32) -> f64 {
        let n = f64::from(waves);
        let height = self.outer - self.inner;
        let radius = 0.5 * (self.inner + self.outer);
        let slender = (self.young / self.density / 12.0).sqrt() * height / (radius * radius);
        n * (n * n - 1.0) / (n * n + 1.0).sqrt() * slender / std::f64::consts::TAU
    }
}

fn slope(x: f64, power: i32) -> f64 {
    if power == 0 { 0.0 } else { f64::from(power) * x.powi(power - 1) }
}

/// Bending in the plane is even in x for radial and hoop motion and odd for axial; out of the
/// plane the other way round.
fn basis(plane: Plane) -> Vec<Function> {
    let mut functions = Vec::new();
    for component in 0..3 {
        let even = (component < 2) == (plane == Plane::In);
        for i in 0..=4 {
            for j in 0..=4 {
                if (j % 2 == 0) == even {
                    functions.push((component, i, j));
                }
            }
        }
    }
    functions
}

/// Lowest eigenvalue by inverse iteration; the stiffness is positive definite for two waves or more.
fn lowest(stiffness: &Matrix, mass: &Matrix) -> f64 {
    let size = mass.len();
    // To unit diagonal, for the dense solver's pivots.
    let scale: Vec<f64> = (0..size).map(|i| 1.0 / stiffness[i][i].sqrt()).collect();
    let scaled = |m: &Matrix| -> Matrix {
        (0..size).map(|i| (0..size).map(|j| m[i][j] * scale[i] * scale[j]).collect()).collect()
    };
    let (stiffness, mass) = (scaled(stiffness), scaled(mass));
    let times = |m: &Matrix, x: &[f64]| -> Vec<f64> {
        m.iter().map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
    };
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let mut x: Vec<f64> = (0..size).map(|i| 1.0 + 0.3 * (i as f64).sin()).collect();
    let mut value = f64::NAN;
    for _ in 0..200 {
        let right = times(&mass, &x);
        let Some(next) = solve_positive_definite(&stiffness, 0.0, &right) else {
            return f64::NAN;
        };
        let length = dot(&next, &times(&mass, &next)).sqrt();
        x = next.iter().map(|v| v / length).collect();
        value = dot(&x, &times(&stiffness, &x));
    }
    value
}
