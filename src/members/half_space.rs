//! Frictionless contact of a rigid surface with an elastic half-space: contact cells and their pressure.
//!
//! Pressure is uniform on each cell of a rectangular grid; the displacement of a cell follows Love's formula for a
//! uniformly loaded rectangle (Love 1929; Johnson, Contact Mechanics, 3.25). The solution of p ≥ 0, gap ≥ 0 and p·gap =
//! 0 is the minimum of ½ pᵀC p − pᵀ(δ − g) over p ≥ 0, found by conjugate gradients (Polonsky and Keer, Wear 231, 1999;
//! here at a given approach δ instead of a given load, and over the cells with pressure, with checks of the others
//! between).
//!
//! The modulus E* is one, since it only scales pressures.

use std::f64::consts::PI;

/// Cells of a rectangle in rows of equal x, `nx` around the origin; `ny` along y around the origin, or on the positive
/// side alone in the symmetric case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    pub nx: usize,
    pub ny: usize,
    /// Size of a cell, m.
    pub hx: f64,
    pub hy: f64,
    /// True if the side y < 0 is the mirror image.
    pub mirrored: bool,
}

impl Grid {
    /// Centre of a cell, m.
    pub fn middle(&self, cell: usize) -> [f64; 2] {
        let [i, j] = [cell / self.ny, cell % self.ny].map(|index| index as f64);
        let first = if self.mirrored { 0.5 } else { -0.5 * (self.ny as f64 - 1.0) };
        [(i - 0.5 * (self.nx as f64 - 1.0)) * self.hx, (j + first) * self.hy]
    }

    pub fn cells(&self) -> usize {
        self.nx * self.ny
    }
}

/// Displacement, m, at x, y (m) from the centre of a rectangle of half sides a, b (m) under unit pressure over unit E*.
pub fn love(x: f64, y: f64, a: f64, b: f64) -> f64 {
    // s ln(t + √(t² + s²)) of the four corners; asinh avoids cancellation for t < 0.
    let corner = |s: f64, t: f64| {
        if s == 0.0 { 0.0 } else { s * libm::asinh(t / s.abs()) }
    };
    let both = |s: f64, t: f64| corner(s, t) + corner(t, s);
    let [xp, xm, yp, ym] = [x + a, x - a, y + b, y - b];
    (both(xp, yp) - both(xp, ym) - both(xm, yp) + both(xm, ym)) / PI
}

/// Columns of a row of cells, up to `to`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Span {
    from: usize,
    to: usize,
}

/// In each row, from the first to the last cell with pressure.
fn pressed_spans(pressure: &[f64], ny: usize) -> Vec<Span> {
    let span = |row: &[f64]| Span {
        from: row.iter().position(|p| *p > 0.0).unwrap_or(0),
        to: row.iter().rposition(|p| *p > 0.0).map_or(0, |last| last + 1),
    };
    pressure.chunks_exact(ny).map(span).collect()
}

/// Displacement of every cell by unit pressure on a cell and on its mirror image, for a grid of one size.
#[derive(Clone, Debug)]
pub struct Influence {
    grid: Grid,
    /// For each distance of rows: if mirrored, every column for each loaded column; otherwise every distance of columns.
    kernel: Vec<f64>,
}

impl Influence {
    pub fn new(grid: Grid) -> Influence {
        let Grid { nx, ny, hx, hy, mirrored } = grid;
        let at = |apart: f64, across: f64| love(apart * hx, across * hy, 0.5 * hx, 0.5 * hy);
        let mut kernel = Vec::new();
        if !mirrored {
            let across = |column: usize| column as f64 - (ny as f64 - 1.0);
            let row = |apart: usize| (0..2 * ny - 1).map(move |j| at(apart as f64, across(j)));
            kernel.extend((0..nx).flat_map(row));
            return Influence { grid, kernel };
        }
        for apart in 0..nx {
            for (pressed, sinks) in (0..ny).flat_map(|l| (0..ny).map(move |j| (l, j))) {
                let (apart, l, j) = (apart as f64, pressed as f64, sinks as f64);
                kernel.push(at(apart, j - l) + at(apart, l + j + 1.0));
            }
        }
        Influence { grid, kernel }
    }

    /// Displacements under `pressure` of the cells in `spans`, and up to seven behind each, for cells `scale` times as
    /// large; others are not changed.
    ///
    /// Several cells of a row at a time, with sums in registers; every sum is over the loaded cells in their order.
    fn sink(&self, scale: f64, pressure: &[f64], spans: &[Span], to: &mut [f64]) {
        let ny = self.grid.ny;
        let pressed = || (0..pressure.len()).filter(|cell| pressure[*cell] != 0.0);
        let pressed: Vec<_> =
            pressed().map(|cell| (cell / ny, cell % ny, scale * pressure[cell])).collect();
        for ((i, row), span) in to.chunks_exact_mut(ny).enumerate().zip(spans) {
            let mut j = span.from;
            while j < span.to {
                let eights = (span.to - j).div_ceil(8).min((ny - j) / 8);
                let row = &mut row[j..];
                j += match eights {
                    0 if ny - j >= 4 => self.fill::<4>(&pressed, i, j, row),
                    0 => self.fill::<1>(&pressed, i, j, row),
                    1 => self.fill::<8>(&pressed, i, j, row),
                    2 => self.fill::<16>(&pressed, i, j, row),
                    3 => self.fill::<24>(&pressed, i, j, row),
                    4 => self.fill::<32>(&pressed, i, j, row),
                    _ => self.fill::<40>(&pressed, i, j, row),
                };
            }
        }
    }

    /// Adds the displacements due to a change of pressure to the cells in `spans`, using `by`; others are invalid until
    /// all are summed again.
    fn sink_further(
        &self,
        scale: f64,
        change: &[f64],
        spans: &[Span],
        by: &mut [f64],
        sunk: &mut [f64],
    ) {
        self.sink(scale, change, spans, by);
        sunk.iter_mut().zip(by.iter()).for_each(|(sunk, by)| *sunk += by);
    }

    /// The next `N` cells of a row; returns their number.
    fn fill<const N: usize>(
        &self,
        pressed: &[(usize, usize, f64)],
        i: usize,
        j: usize,
        row: &mut [f64],
    ) -> usize {
        row[..N].copy_from_slice(&self.sums::<N>(pressed, i, j));
        N
    }

    /// Sums over all loaded cells, as (row, column, pressure), in row `i` from column `j` on.
    fn sums<const N: usize>(
        &self,
        pressed: &[(usize, usize, f64)],
        i: usize,
        j: usize,
    ) -> [f64; N] {
        let Grid { ny, mirrored, .. } = self.grid;
        let mut sums = [0.0; N];
        for &(k, l, p) in pressed {
            let from = match mirrored {
                true => (i.abs_diff(k) * ny + l) * ny + j,
                false => i.abs_diff(k) * (2 * ny - 1) + ny - 1 - l + j,
            };
            for (sum, by) in sums.iter_mut().zip(&self.kernel[from..from + N]) {
                *sum += p * by;
            }
        }
        sums
    }
}

/// A contact at a given approach for E* = 1 Pa: multiply by E*.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pressed {
    /// Over E*, cell by cell.
    pub pressure: Vec<f64>,
    /// Load over E*, m².
    pub load: f64,
    /// Stored energy over E*, m³.
    pub energy: f64,
    /// Conjugate gradient steps, and checks of the cells without pressure.
    pub iterations: usize,
}

/// Cells without pressure are checked when the gaps of the others have fallen to this fraction since the last check.
/// For a dent with a shoulder that is one iteration in ten, with sums three times as long.
const CHECK_AT: f64 = 0.05;
/// Initial pressure of a joining cell, as a fraction of the last step's or of that which closes the gap of a single
/// cell.
const JOINING: f64 = 1e-3;
/// Largest number of iterations including checks; tens are usual.
const MOST_ITERATIONS: usize = 500;

/// Loads the half-space by a rigid surface of `gap`s (m, cell by cell, at zero approach) at an `approach` (m).
///
/// Cells of the influence's grid are `scale` times as large. `guess` is an initial pressure. The gap in contact is
/// closed to `tolerance` times the largest overclosure. `None` if conjugate gradients do not converge.
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
    // Initial pressure of single cells over the whole contact: far too small, but at the right cells.
    let mut p: Vec<f64> = match guess {
        Some(guess) => guess.iter().map(|p| p.max(0.0)).collect(),
        None => {
            let per_depth = 1.0 / (scale * (grid.nx as f64 * grid.hx + grid.ny as f64 * grid.hy));
            gap.iter().map(|gap| (approach - gap).max(0.0) * per_depth).collect()
        }
    };
    let all = vec![Span { from: 0, to: grid.ny }; grid.nx];
    let (mut sunk, mut q) = (vec![0.0; cells], vec![0.0; cells]);
    let (mut t, mut change) = (vec![0.0; cells], vec![0.0; cells]);
    let (mut before, mut conjugate, mut step) = (1.0, 0.0, 0.0);
    influence.sink(scale, &p, &all, &mut sunk);
    // Whether `sunk` is valid for all cells, the loaded columns, and the gap under pressure at that time.
    let (mut everywhere, mut spans, mut looked) = (true, all.clone(), f64::INFINITY);
    for iteration in 0..MOST_ITERATIONS {
        // Positive for an open gap.
        let open = |cell: usize, sunk: &[f64]| gap[cell] + sunk[cell] - approach;
        let (mut square, mut worst) = (0.0, 0.0f64);
        for cell in (0..cells).filter(|cell| p[*cell] > 0.0) {
            let r = open(cell, &sunk);
            square += r * r;
            worst = worst.max(r.abs());
        }
        if !f64::is_finite(square) {
            return None;
        }
        if everywhere {
            let others = (0..cells).filter(|cell| p[*cell] <= 0.0);
            let overclosed_now = others.fold(0.0f64, |most, cell| most.max(-open(cell, &sunk)));
            if worst.max(overclosed_now) <= tolerance * overclosed {
                let load = p.iter().sum::<f64>() * area;
                // The energy is a minimum: remaining gaps have second-order effects.
                let inside = gap.iter().zip(&sunk).map(|(gap, u)| approach - gap - 0.5 * u);
                let energy = p.iter().zip(inside).map(|(p, inside)| p * inside).sum::<f64>() * area;
                // NaN cells are neither loaded nor open.
                return (load + energy).is_finite().then_some(Pressed {
                    load,
                    energy,
                    pressure: p,
                    iterations: iteration,
                });
            }
            // Overclosed cells join with a small pressure, so that the first step does not remove them again, and the
            // directions restart.
            change.fill(0.0);
            let firmness =
                JOINING * if step > 0.0 { step } else { 1.0 / (scale * influence.kernel[0]) };
            for cell in 0..cells {
                let r = open(cell, &sunk);
                if p[cell] <= 0.0 && r < -tolerance * overclosed {
                    p[cell] = -firmness * r;
                    change[cell] = p[cell];
                }
            }
            (spans, looked, everywhere) =
                (pressed_spans(&p, grid.ny), worst.max(overclosed_now), false);
            if change.iter().any(|change| *change != 0.0) {
                influence.sink_further(scale, &change, &spans, &mut q, &mut sunk);
                conjugate = 0.0;
                continue;
            }
        } else if worst <= (CHECK_AT * looked).max(tolerance * overclosed) {
            influence.sink(scale, &p, &all, &mut sunk);
            everywhere = true;
            continue;
        }
        let follow = if before > 0.0 { conjugate * square / before } else { 0.0 };
        for cell in 0..cells {
            t[cell] = if p[cell] > 0.0 { open(cell, &sunk) + follow * t[cell] } else { 0.0 };
        }
        before = square;
        influence.sink(scale, &t, &spans, &mut q);
        let (mut over, mut under) = (0.0, 0.0);
        for cell in (0..cells).filter(|cell| p[*cell] > 0.0) {
            over += t[cell] * open(cell, &sunk);
            under += t[cell] * q[cell];
        }
        (step, conjugate) = (if under > 0.0 { over / under } else { 0.0 }, 1.0);
        change.fill(0.0);
        for cell in 0..cells {
            if p[cell] <= 0.0 {
                continue;
            }
            p[cell] -= step * t[cell];
            sunk[cell] -= step * q[cell];
            if p[cell] < 0.0 {
                (change[cell], p[cell], conjugate) = (-p[cell], 0.0, 0.0);
            }
        }
        // Cells with tension leave the contact, and the directions restart.
        if conjugate == 0.0 {
            influence.sink_further(scale, &change, &spans, &mut q, &mut sunk);
        }
    }
    None
}
