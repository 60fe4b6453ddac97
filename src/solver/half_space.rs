//! Frictionless contact of a rigid surface with an elastic half-space: which cells touch and how hard.
//!
//! Pressure is uniform on each cell of a rectangular grid; a cell sinks by Love's formula for a uniformly loaded
//! rectangle (Love 1929; Johnson, Contact Mechanics, 3.25). Where the surface comes to lie,
//! p ≥ 0, gap ≥ 0 and p·gap = 0 is the minimum of ½ pᵀC p − pᵀ(δ − g) over p ≥ 0, which conjugate gradients find
//! (Polonsky and Keer, Wear 231, 1999; here at a given approach δ instead of a given load).
//!
//! The modulus E* is one, since it scales pressures alone.

use std::f64::consts::PI;

/// Cells of a rectangle in rows of equal x, `nx` around the origin; `ny` along y around the origin, or
/// on the positive side alone where both sides are alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    pub nx: usize,
    pub ny: usize,
    /// Size of a cell, m.
    pub hx: f64,
    pub hy: f64,
    /// Whether the side y < 0 is the mirror image.
    pub mirrored: bool,
}

impl Grid {
    /// Middle of a cell by its number, m.
    pub fn middle(&self, cell: usize) -> [f64; 2] {
        let [i, j] = [cell / self.ny, cell % self.ny].map(|index| index as f64);
        let first = if self.mirrored { 0.5 } else { -0.5 * (self.ny as f64 - 1.0) };
        [(i - 0.5 * (self.nx as f64 - 1.0)) * self.hx, (j + first) * self.hy]
    }

    pub fn cells(&self) -> usize {
        self.nx * self.ny
    }
}

/// How deep a point sinks at x, y (m) from the middle of a rectangle of half sides a, b (m) under unit pressure
/// over unit E*, m.
pub fn love(x: f64, y: f64, a: f64, b: f64) -> f64 {
    // s ln(t + √(t² + s²)) of the four corners; asinh needs no cancellation where t < 0.
    let corner = |s: f64, t: f64| {
        if s == 0.0 { 0.0 } else { s * libm::asinh(t / s.abs()) }
    };
    let both = |s: f64, t: f64| corner(s, t) + corner(t, s);
    let [xp, xm, yp, ym] = [x + a, x - a, y + b, y - b];
    (both(xp, yp) - both(xp, ym) - both(xm, yp) + both(xm, ym)) / PI
}

/// Cells of a row that are summed at a time: of the usual twenty all.
const WIDE: usize = 20;

/// What unit pressure on a cell, and on its mirror image, does to every cell, for a grid of one size.
#[derive(Clone, Debug)]
pub struct Influence {
    grid: Grid,
    /// For rows so far apart and a pressed column, every column.
    kernel: Vec<f64>,
}

impl Influence {
    pub fn new(grid: Grid) -> Influence {
        let Grid { nx, ny, hx, hy, mirrored } = grid;
        let at = |apart: f64, across: f64| love(apart * hx, across * hy, 0.5 * hx, 0.5 * hy);
        let mut kernel = Vec::with_capacity(nx * ny * ny);
        for apart in 0..nx {
            for (pressed, sinks) in (0..ny).flat_map(|l| (0..ny).map(move |j| (l, j))) {
                let (apart, l, j) = (apart as f64, pressed as f64, sinks as f64);
                let image = if mirrored { at(apart, l + j + 1.0) } else { 0.0 };
                kernel.push(at(apart, j - l) + image);
            }
        }
        Influence { grid, kernel }
    }

    /// How deep all cells sink under `pressure`, where each cell of the grid is `scale` times as large.
    ///
    /// Some cells of a row at a time, whose sums stay in registers while the kernel goes by; every sum is over the
    /// pressed cells in their order.
    fn sink(&self, scale: f64, pressure: &[f64], to: &mut [f64]) {
        let ny = self.grid.ny;
        let pressed = || (0..pressure.len()).filter(|cell| pressure[*cell] != 0.0);
        let pressed: Vec<_> =
            pressed().map(|cell| (cell / ny, cell % ny, scale * pressure[cell])).collect();
        for (i, row) in to.chunks_exact_mut(ny).enumerate() {
            let wide = ny - ny % WIDE;
            let (blocks, rest) = row.split_at_mut(wide);
            for (block, sums) in blocks.chunks_exact_mut(WIDE).enumerate() {
                sums.copy_from_slice(&self.sums::<WIDE>(&pressed, i, block * WIDE));
            }
            for (j, sum) in rest.iter_mut().enumerate() {
                [*sum] = self.sums(&pressed, i, wide + j);
            }
        }
    }

    /// Sums over all pressed cells, as (row, column, pressure), in row `i` from column `j` on.
    fn sums<const N: usize>(
        &self,
        pressed: &[(usize, usize, f64)],
        i: usize,
        j: usize,
    ) -> [f64; N] {
        let ny = self.grid.ny;
        let mut sums = [0.0; N];
        for &(k, l, p) in pressed {
            let from = (i.abs_diff(k) * ny + l) * ny + j;
            for (sum, by) in sums.iter_mut().zip(&self.kernel[from..from + N]) {
                *sum += p * by;
            }
        }
        sums
    }
}

/// A contact at a given approach, E* = 1 Pa: multiply by E*.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pressed {
    /// Over E*, cell by cell.
    pub pressure: Vec<f64>,
    /// Load over E*, m².
    pub load: f64,
    /// Stored energy over E*, m³.
    pub energy: f64,
    pub iterations: usize,
}

/// Iterations after which a solve is given up; tens are usual.
const MOST_ITERATIONS: usize = 500;

/// Presses a rigid surface of `gap`s (m, cell by cell, at no approach) into the half-space by `approach` (m).
///
/// Cells of the influence's grid are `scale` times as large. `guess` is a pressure to begin with. The gap in contact
/// is closed to `tolerance` times the largest overclosure. `None` where conjugate gradients do not get there.
pub fn press(
    influence: &Influence,
    scale: f64,
    gap: &[f64],
    approach: f64,
    guess: Option<&[f64]>,
    tolerance: f64,
) -> Option<Pressed> {
    let grid = influence.grid;
    let sides = if grid.mirrored { 2.0 } else { 1.0 };
    let area = sides * scale * scale * grid.hx * grid.hy;
    let cells = grid.cells();
    let overclosed = gap.iter().fold(0.0f64, |most, gap| most.max(approach - gap));
    if overclosed <= 0.0 {
        return Some(Pressed { pressure: vec![0.0; cells], ..Pressed::default() });
    }
    // A first pressure as of a cell by itself over the whole contact: far too small, but where it belongs.
    let mut p: Vec<f64> = match guess {
        Some(guess) => guess.to_vec(),
        None => {
            let per_depth = 1.0 / (scale * (grid.nx as f64 * grid.hx + grid.ny as f64 * grid.hy));
            gap.iter().map(|gap| (approach - gap).max(0.0) * per_depth).collect()
        }
    };
    let (mut sunk, mut q) = (vec![0.0; cells], vec![0.0; cells]);
    let mut t = vec![0.0; cells];
    let (mut before, mut conjugate) = (1.0, 0.0);
    let mut renewed = true;
    for iteration in 0..MOST_ITERATIONS {
        if renewed {
            influence.sink(scale, &p, &mut sunk);
        }
        // Positive is open, and wants less pressure.
        let open = |cell: usize, sunk: &[f64]| gap[cell] + sunk[cell] - approach;
        let mut square = 0.0;
        // NaN ends the search.
        let mut worst = 0.0f64;
        if !sunk.iter().all(|sunk| sunk.is_finite()) {
            return None;
        }
        for cell in 0..cells {
            let r = open(cell, &sunk);
            if p[cell] > 0.0 {
                square += r * r;
                worst = worst.max(r.abs());
            } else {
                worst = worst.max(-r);
            }
        }
        if worst <= tolerance * overclosed {
            let load = p.iter().sum::<f64>() * area;
            // The minimum, which what is left of the gaps changes to second order only.
            let inside = gap.iter().zip(&sunk).map(|(gap, u)| approach - gap - 0.5 * u);
            let energy = p.iter().zip(inside).map(|(p, inside)| p * inside).sum::<f64>() * area;
            return Some(Pressed { load, energy, pressure: p, iterations: iteration });
        }
        let follow = if before > 0.0 { conjugate * square / before } else { 0.0 };
        for cell in 0..cells {
            let along = open(cell, &sunk) + follow * t[cell];
            t[cell] = if p[cell] > 0.0 { along } else { 0.0 };
        }
        before = square;
        influence.sink(scale, &t, &mut q);
        let (mut over, mut under) = (0.0, 0.0);
        for cell in 0..cells {
            over += t[cell] * if p[cell] > 0.0 { open(cell, &sunk) } else { 0.0 };
            under += t[cell] * q[cell];
        }
        let step = if under > 0.0 { over / under } else { 0.0 };
        (conjugate, renewed) = (1.0, false);
        // Overclosed cells without pressure join, and the directions begin anew.
        let alone = scale * influence.kernel[0];
        for cell in 0..cells {
            if p[cell] > 0.0 {
                p[cell] -= step * t[cell];
                if p[cell] < 0.0 {
                    (p[cell], renewed) = (0.0, true);
                }
            } else {
                let r = open(cell, &sunk) - step * q[cell];
                if r < 0.0 {
                    p[cell] = if step > 0.0 { -step * r } else { -r / alone };
                    (conjugate, renewed) = (0.0, true);
                }
            }
        }
        if !renewed {
            sunk.iter_mut().zip(&q).for_each(|(sunk, q)| *sunk -= step * q);
        }
    }
    None
}
