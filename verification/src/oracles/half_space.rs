//! Frictionless contact of a rigid surface with an elastic half-space by boundary elements.
//!
//! Pressure is uniform on each rectangle of a grid; the displacement under it is that of Love's four logarithms
//! (Johnson, Contact Mechanics, 3.25), summed by a discrete Fourier transform over twice the grid. Contact is found by
//! active sets (Kalker): the pressures of a set follow from conjugate gradients to the end, rectangles under tension
//! leave it, and overlapping ones join.

use std::f64::consts::{PI, TAU};

/// Sets of contact; a dozen are usual.
const MOST_SETS: usize = 200;

#[derive(Clone, Copy, Debug, Default)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    fn times(self, other: Complex) -> Complex {
        let Complex { re, im } = other;
        Complex { re: self.re * re - self.im * im, im: self.re * im + self.im * re }
    }
}

/// Transform of a power of two, in place; `roots` are exp(−2πi k/N).
fn transform(values: &mut [Complex], roots: &[Complex]) {
    let count = values.len();
    let bits = count.trailing_zeros();
    for i in 0..count {
        let j = (i as u32).reverse_bits() as usize >> (32 - bits);
        if i < j {
            values.swap(i, j);
        }
    }
    let mut half = 1;
    while half < count {
        let stride = count / (2 * half);
        for block in values.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for (k, (low, high)) in low.iter_mut().zip(high).enumerate() {
                let turned = high.times(roots[k * stride]);
                *high = Complex { re: low.re - turned.re, im: low.im - turned.im };
                *low = Complex { re: low.re + turned.re, im: low.im + turned.im };
            }
        }
        half *= 2;
    }
}

/// A square array of complex numbers, row by row, and its transform.
struct Plane {
    side: usize,
    roots: Vec<Complex>,
}

impl Plane {
    fn new(side: usize) -> Plane {
        let root = |k: usize| {
            let (sin, cos) = (-TAU * k as f64 / side as f64).sin_cos();
            Complex { re: cos, im: sin }
        };
        Plane { side, roots: (0..side / 2).map(root).collect() }
    }

    /// Transforms rows, transposes, and transforms again: the transpose of the plain transform, which products of two
    /// of them do not notice. `rows` of them are not zero.
    fn transform(&self, values: &mut [Complex], rows: usize) {
        let side = self.side;
        values.chunks_exact_mut(side).take(rows).for_each(|row| transform(row, &self.roots));
        for i in 0..side {
            for j in 0..i {
                values.swap(i * side + j, j * side + i);
            }
        }
        values.chunks_exact_mut(side).for_each(|row| transform(row, &self.roots));
    }
}

/// A grid of `cells` × `cells` rectangles (a power of two) over [−half, half]², and its influence for E* = 1 Pa.
pub struct HalfSpace {
    cells: usize,
    half: [f64; 2],
    plane: Plane,
    kernel: Vec<Complex>,
}

/// Pressures over E*, row by row of equal x, and the load over E*, m².
pub struct Pressed {
    pub pressure: Vec<f64>,
    pub load: f64,
}

/// x ln(y + √(x² + y²)) and so on of the four corners, over π E*.
fn love([x, y]: [f64; 2], [a, b]: [f64; 2]) -> f64 {
    let log = |top: f64, bottom: f64, lateral: f64| {
        let (far, near) = (top + top.hypot(lateral), bottom + bottom.hypot(lateral));
        (far / near).ln()
    };
    let (xp, xm, yp, ym) = (x + a, x - a, y + b, y - b);
    (xp * log(yp, ym, xp) + yp * log(xp, xm, yp) - xm * log(yp, ym, xm) - ym * log(xp, xm, ym)) / PI
}

impl HalfSpace {
    pub fn new(cells: usize, half: [f64; 2]) -> HalfSpace {
        let side = 2 * cells;
        let plane = Plane::new(side);
        let size = half.map(|half| half / cells as f64);
        let mut kernel = vec![Complex::default(); side * side];
        for i in 0..=cells {
            for j in 0..=cells {
                let at = [2.0 * size[0] * i as f64, 2.0 * size[1] * j as f64];
                let value = Complex { re: love(at, size), im: 0.0 };
                for row in [i, (side - i) % side] {
                    kernel[row * side + j] = value;
                    kernel[row * side + (side - j) % side] = value;
                }
            }
        }
        plane.transform(&mut kernel, side);
        HalfSpace { cells, half, plane, kernel }
    }

    /// Centre of a rectangle, m.
    fn at(&self, cell: usize) -> [f64; 2] {
        let along =
            |index: usize, half: f64| half * ((2 * index + 1) as f64 / self.cells as f64 - 1.0);
        [along(cell / self.cells, self.half[0]), along(cell % self.cells, self.half[1])]
    }

    fn displacement(&self, pressure: &[f64], values: &mut [Complex]) -> Vec<f64> {
        let side = self.plane.side;
        values.fill(Complex::default());
        for (row, own) in values.chunks_exact_mut(side).zip(pressure.chunks_exact(self.cells)) {
            row.iter_mut().zip(own).for_each(|(value, p)| value.re = *p);
        }
        self.plane.transform(values, self.cells);
        // The inverse by the transform of the conjugate.
        for (value, by) in values.iter_mut().zip(&self.kernel) {
            let product = value.times(*by);
            *value = Complex { re: product.re, im: -product.im };
        }
        self.plane.transform(values, side);
        let scale = 1.0 / (side * side) as f64;
        let all = 0..self.cells * self.cells;
        all.map(|at| scale * values[at / self.cells * side + at % self.cells].re).collect()
    }

    /// Contact with a surface at the distance `gap` (m) of a place when it approaches by `approach` (m).
    pub fn press(&self, gap: impl Fn([f64; 2]) -> f64, approach: f64) -> Pressed {
        let count = self.cells * self.cells;
        let over: Vec<f64> = (0..count).map(|cell| approach - gap(self.at(cell))).collect();
        let most = over.iter().copied().fold(0.0, f64::max);
        let mut touches: Vec<bool> = over.iter().map(|over| *over > 0.5 * most).collect();
        let mut pressure = vec![0.0; count];
        let mut values = vec![Complex::default(); self.plane.side * self.plane.side];
        for _ in 0..MOST_SETS {
            // Pressures of the set.
            let sunk = self.displacement(&pressure, &mut values);
            let rest = |cell: usize| if touches[cell] { over[cell] - sunk[cell] } else { 0.0 };
            let mut residual: Vec<f64> = (0..count).map(rest).collect();
            let mut direction = residual.clone();
            let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
            let mut square = dot(&residual, &residual);
            let enough = (1e-7 * most).powi(2);
            while square > enough * touches.iter().filter(|touches| **touches).count() as f64 {
                let sunk = self.displacement(&direction, &mut values);
                let step = square / dot(&direction, &sunk);
                for cell in (0..count).filter(|cell| touches[*cell]) {
                    pressure[cell] += step * direction[cell];
                    residual[cell] -= step * sunk[cell];
                }
                let last = std::mem::replace(&mut square, dot(&residual, &residual));
                for (direction, residual) in direction.iter_mut().zip(&residual) {
                    *direction = residual + square / last * *direction;
                }
            }
            let tense: Vec<usize> = (0..count).filter(|cell| pressure[*cell] < 0.0).collect();
            let sunk = self.displacement(&pressure, &mut values);
            let overlaps =
                |cell: &usize| !touches[*cell] && over[*cell] - sunk[*cell] > 1e-6 * most;
            let joining: Vec<usize> = (0..count).filter(overlaps).collect();
            if tense.is_empty() && joining.is_empty() {
                let area = 4.0 * self.half[0] * self.half[1] / count as f64;
                return Pressed { load: area * pressure.iter().sum::<f64>(), pressure };
            }
            for cell in tense {
                (touches[cell], pressure[cell]) = (false, 0.0);
            }
            joining.into_iter().for_each(|cell| touches[cell] = true);
        }
        Pressed { load: f64::NAN, pressure }
    }
}
