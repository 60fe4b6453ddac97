//! A second, two-dimensional solution of the pressed block: bilinear quadrilaterals, small strains,
//! hard contact through the compliances of the surface nodes. It shares nothing with the library.

/// What a solution in the plane shows, SI.
#[derive(Clone, Copy, Debug)]
pub struct Pressed {
    /// Largest nodal force over nodal width.
    pub pressure: f64,
    /// Largest von Mises stress of an element's centre.
    pub von_mises: f64,
    /// Load per depth of the whole block.
    pub load: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    Strain,
    Stress,
}

/// Half of a block of width 2·`half_width`: y ≥ 0, z ≤ 0, its base fixed.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    pub half_width: f64,
    pub height: f64,
    /// Reach of the fine zone and size of its cells.
    pub fine: f64,
    pub cell: f64,
    pub young: f64,
    pub poisson: f64,
    pub plane: Plane,
}

pub struct Factored {
    of: Block,
    y: Vec<f64>,
    z: Vec<f64>,
    /// Cholesky factor, one row of `band` entries an unknown, the diagonal last.
    rows: Vec<f64>,
    band: usize,
    /// Settlement of surface node j under a unit load on surface node i.
    compliance: Vec<Vec<f64>>,
}

fn places(fine: f64, cell: f64, end: f64) -> Vec<f64> {
    let count = (fine / cell).round() as usize;
    let mut all: Vec<f64> = (0..=count).map(|i| fine * i as f64 / count as f64).collect();
    let rest = end - fine;
    let (growth, mut sum, mut steps, mut next) = (1.15, 0.0, Vec::new(), cell);
    while sum < rest {
        next *= growth;
        sum += next;
        steps.push(next);
    }
    let mut at = fine;
    for step in steps {
        at += step * rest / sum;
        all.push(at);
    }
    all
}

impl Block {
    /// λ and μ; in plane stress λ is the one that leaves no stress across.
    fn moduli(&self) -> [f64; 2] {
        let shear = 0.5 * self.young / (1.0 + self.poisson);
        let lambda = 2.0 * shear * self.poisson / (1.0 - 2.0 * self.poisson);
        match self.plane {
            Plane::Strain => [lambda, shear],
            Plane::Stress => [2.0 * lambda * shear / (lambda + 2.0 * shear), shear],
        }
    }

    pub fn factor(self) -> Factored {
        let y = places(self.fine, self.cell, self.half_width);
        let z: Vec<f64> = places(self.fine, self.cell, self.height).iter().map(|z| -z).collect();
        let (ny, nz) = (y.len(), z.len());
        let band = 2 * (nz + 1) + 2;
        let count = 2 * ny * nz;
        let mut rows = vec![0.0; count * band];
        let [lambda, shear] = self.moduli();
        for i in 0..ny - 1 {
            for j in 0..nz - 1 {
                let nodes = [i * nz + j, (i + 1) * nz + j, (i + 1) * nz + j + 1, i * nz + j + 1];
                let size = [y[i + 1] - y[i], z[j + 1] - z[j]];
                let volume = 0.25 * (size[0] * size[1]).abs();
                let gauss = 1.0 / 3f64.sqrt();
                for at in [[-gauss, -gauss], [gauss, -gauss], [gauss, gauss], [-gauss, gauss]] {
                    let d = slopes(at, size);
                    for a in 0..4 {
                        for b in 0..4 {
                            for p in 0..2 {
                                for q in 0..2 {
                                    let (row, column) = (2 * nodes[a] + p, 2 * nodes[b] + q);
                                    if column > row {
                                        continue;
                                    }
                                    let along = if p == q {
                                        d[a][0] * d[b][0] + d[a][1] * d[b][1]
                                    } else {
                                        0.0
                                    };
                                    let k = lambda * d[a][p] * d[b][q]
                                        + shear * (along + d[a][q] * d[b][p]);
                                    rows[row * band + band - 1 - (row - column)] += volume * k;
                                }
                            }
                        }
                    }
                }
            }
        }
        // The base, and the plane of symmetry along Y.
        for i in 0..ny {
            for j in 0..nz {
                let n = i * nz + j;
                let base = j == nz - 1;
                for (p, held) in [(0, base || i == 0), (1, base)] {
                    if held {
                        rows[(2 * n + p) * band + band - 1] += 1e8 * self.young;
                    }
                }
            }
        }
        cholesky(&mut rows, band);
        let mut all = Factored { of: self, y, z, rows, band, compliance: Vec::new() };
        let under = all.y.iter().filter(|y| **y <= self.fine).count();
        let compliance = (0..under).map(|i| {
            let u = all.solve(|load| load[2 * i * nz + 1] = -1.0);
            (0..under).map(|k| -u[2 * k * nz + 1]).collect()
        });
        all.compliance = compliance.collect();
        all
    }
}

/// Gradients of the four shape functions.
fn slopes([r, s]: [f64; 2], [width, height]: [f64; 2]) -> [[f64; 2]; 4] {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[a, b]: [f64; 2]| [0.5 * a * (1.0 + b * s) / width, 0.5 * b * (1.0 + a * r) / height])
}

fn cholesky(rows: &mut [f64], band: usize) {
    let count = rows.len() / band;
    for i in 0..count {
        let first = (i + 1).saturating_sub(band);
        for j in first..=i {
            let from = first.max((j + 1).saturating_sub(band));
            let (a, b) = (i * band + band - 1 - i, j * band + band - 1 - j);
            let sum: f64 = (from..j).map(|k| rows[a + k] * rows[b + k]).sum();
            let rest = rows[a + j] - sum;
            rows[a + j] = if i == j { rest.sqrt() } else { rest / rows[b + j] };
        }
    }
}

impl Factored {
    fn solve(&self, load: impl FnOnce(&mut [f64])) -> Vec<f64> {
        let count = self.rows.len() / self.band;
        let mut x = vec![0.0; count];
        load(&mut x);
        let entry = |i: usize, j: usize| self.rows[i * self.band + self.band - 1 - (i - j)];
        for i in 0..count {
            let first = (i + 1).saturating_sub(self.band);
            let sum: f64 = (first..i).map(|j| entry(i, j) * x[j]).sum();
            x[i] = (x[i] - sum) / entry(i, i);
        }
        for i in (0..count).rev() {
            x[i] /= entry(i, i);
            let first = (i + 1).saturating_sub(self.band);
            for j in first..i {
                x[j] -= entry(i, j) * x[i];
            }
        }
        x
    }

    /// Pressed by a cylinder that goes down by `indentation`: nodes that would pull are let go, nodes
    /// that the cylinder would enter are taken in, until neither is left.
    pub fn pressed(&self, radius: f64, indentation: f64) -> Pressed {
        let goal = |i: usize| indentation - 0.5 * self.y[i] * self.y[i] / radius;
        let all = self.compliance.len();
        let mut touching: Vec<bool> = (0..all).map(|i| goal(i) > 0.0).collect();
        let mut forces = vec![0.0; all];
        for _ in 0..200 {
            let list: Vec<usize> = (0..all).filter(|i| touching[*i]).collect();
            let matrix: Vec<Vec<f64>> = (list.iter())
                .map(|i| list.iter().map(|j| self.compliance[*j][*i]).collect())
                .collect();
            let found = dense(matrix, list.iter().map(|i| goal(*i)).collect());
            forces = vec![0.0; all];
            for (i, force) in list.iter().zip(found) {
                forces[*i] = force;
            }
            let next: Vec<bool> = (0..all)
                .map(|i| match touching[i] {
                    true => forces[i] >= 0.0,
                    false => {
                        let down: f64 = (0..all).map(|j| self.compliance[j][i] * forces[j]).sum();
                        down < goal(i)
                    }
                })
                .collect();
            if next == touching {
                break;
            }
            touching = next;
        }
        let width = |i: usize| match i {
            0 => 0.5 * self.y[1],
            _ => 0.5 * (self.y[i + 1] - self.y[i - 1]),
        };
        Pressed {
            pressure: (0..all).map(|i| forces[i] / width(i)).fold(0.0, f64::max),
            von_mises: self.von_mises(&forces),
            load: 2.0 * forces.iter().sum::<f64>(),
        }
    }

    fn von_mises(&self, forces: &[f64]) -> f64 {
        let nz = self.z.len();
        let u = self.solve(|load| {
            for (i, force) in forces.iter().enumerate() {
                load[2 * i * nz + 1] = -force;
            }
        });
        let [lambda, shear] = self.of.moduli();
        let mut most = 0.0f64;
        for i in 0..self.y.len() - 1 {
            for j in 0..nz - 1 {
                let nodes = [i * nz + j, (i + 1) * nz + j, (i + 1) * nz + j + 1, i * nz + j + 1];
                let size = [self.y[i + 1] - self.y[i], self.z[j + 1] - self.z[j]];
                let mut h = [[0.0; 2]; 2];
                for (n, d) in nodes.iter().zip(slopes([0.0, 0.0], size)) {
                    for p in 0..2 {
                        for q in 0..2 {
                            h[p][q] += u[2 * n + p] * d[q];
                        }
                    }
                }
                let volume = lambda * (h[0][0] + h[1][1]);
                let (s, t) = (volume + 2.0 * shear * h[0][0], volume + 2.0 * shear * h[1][1]);
                let across = match self.of.plane {
                    Plane::Strain => self.of.poisson * (s + t),
                    Plane::Stress => 0.0,
                };
                let tau = shear * (h[0][1] + h[1][0]);
                let squares = (s - t).powi(2) + (t - across).powi(2) + (across - s).powi(2);
                most = most.max((0.5 * squares + 3.0 * tau * tau).sqrt());
            }
        }
        most
    }
}

/// Gauss' elimination without pivots: compliances are positive definite.
fn dense(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        for i in k + 1..n {
            let part = a[i][k] / a[k][k];
            for j in k..n {
                a[i][j] -= part * a[k][j];
            }
            b[i] -= part * b[k];
        }
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - sum) / a[k][k];
    }
    b
}
