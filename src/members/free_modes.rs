//! Modes of a free elastic body: natural modes up to a frequency, and static correction modes for loads at chosen
//! coordinates.
//!
//! Both are orthogonal to each other and to the rigid motions under the mass. So the response to a slow load at a
//! chosen coordinate is exact; at frequency f the error is about (f/f_cut)² of the compliance of the omitted natural
//! modes.

use crate::members::shaft_modes::ShapesError;
use crate::numeric::ritz;
use nalgebra::{DMatrix, DVector};

/// Mass and stiffness, and rigid motions that are orthogonal under the mass.
pub(crate) struct FreeBody<'m> {
    pub mass: &'m DMatrix<f64>,
    pub stiffness: &'m DMatrix<f64>,
    pub rigid: &'m [DVector<f64>],
}

/// Modes of unit modal mass, one a column.
pub(crate) struct FreeShapes {
    /// rad/s.
    pub frequencies: Vec<f64>,
    pub shapes: DMatrix<f64>,
    /// Number of natural modes; static correction modes follow.
    pub natural: usize,
    pub cut: Cut,
}

/// The omitted part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cut {
    /// Lowest omitted natural frequency, rad/s; infinite if none.
    pub above: f64,
    /// Largest fraction of the static compliance (without rigid motion) at an attachment in omitted modes.
    pub share: f64,
}

/// Static responses of unit mass of which less than this fraction differs from combinations of the others are dropped.
const DEPENDENT: f64 = 1e-10;

impl FreeBody<'_> {
    /// Natural modes below `limit` (rad/s), at most `most`, and static correction modes for loads at `rows`.
    ///
    /// # Errors
    ///
    /// A mass that is not positive; a motion without strain that is not rigid.
    pub fn shapes(
        &self,
        limit: f64,
        most: usize,
        rows: &[usize],
    ) -> Result<FreeShapes, ShapesError> {
        let (frequencies, all) = self.natural()?;
        let kept: usize = frequencies.iter().take(most).filter(|w| **w <= limit).count();
        let left_out = frequencies.len() - kept;
        // Amplitudes of the omitted natural modes in each static response.
        let answer = |k: usize, row: usize| {
            all[(row, kept + k)] / (frequencies[kept + k] * frequencies[kept + k])
        };
        let mut answers = DMatrix::from_fn(left_out, rows.len(), |k, j| answer(k, rows[j]));
        let share = |row: &usize| {
            let part =
                |k: usize| all[(*row, k)] * all[(*row, k)] / (frequencies[k] * frequencies[k]);
            let total: f64 = (0..frequencies.len()).map(part).sum();
            let beyond: f64 = (kept..frequencies.len()).map(part).sum();
            if total > 0.0 { beyond / total } else { 0.0 }
        };
        let share = rows.iter().map(share).fold(0.0, f64::max);
        for mut column in answers.column_iter_mut() {
            let size = column.norm();
            if size > 0.0 {
                column /= size;
            }
        }
        let (static_frequencies, combined) = independent(&answers, &frequencies[kept..]);
        let count = kept + static_frequencies.len();
        let mut shapes = DMatrix::zeros(self.mass.nrows(), count);
        shapes.columns_mut(0, kept).copy_from(&all.columns(0, kept));
        shapes.columns_mut(kept, count - kept).copy_from(&(all.columns(kept, left_out) * combined));
        let above = frequencies.get(kept).copied().unwrap_or(f64::INFINITY);
        let frequencies: Vec<f64> =
            frequencies[..kept].iter().chain(&static_frequencies).copied().collect();
        Ok(FreeShapes { frequencies, shapes, natural: kept, cut: Cut { above, share } })
    }

    /// All natural modes without rigid motions, with ascending frequencies (rad/s).
    fn natural(&self) -> Result<(Vec<f64>, DMatrix<f64>), ShapesError> {
        let inertia = |motion: &DVector<f64>| (self.mass * motion).dot(motion);
        let weights: Vec<f64> = self.rigid.iter().map(inertia).collect();
        if let Some(mass) = weights.first().filter(|mass| mass.is_nan() || **mass <= 0.0) {
            return Err(ShapesError::Mass(*mass));
        }
        let count = self.mass.nrows();
        let stiffest = (0..count).map(|i| self.stiffness[(i, i)] / self.mass[(i, i)]);
        // Far above rounding, far below the stiffest element.
        let shift = 1e-4 * stiffest.fold(f64::INFINITY, f64::min);
        let found = lowest(self.mass, self.stiffness, shift, count);
        let (modes, _) = found.ok_or(ShapesError::Stiffness)?;
        // The first are the rigid motions.
        let first = self.rigid.len().min(count);
        let mut shapes = DMatrix::zeros(count, count - first);
        let mut frequencies = Vec::with_capacity(count - first);
        for column in first..count {
            let mut shape = modes.column(column).into_owned();
            // Rounding leaves some rigid motion in a mode.
            for (motion, weight) in self.rigid.iter().zip(&weights) {
                let part = (self.mass * motion).dot(&shape) / weight;
                shape -= motion * part;
            }
            shape /= inertia(&shape).sqrt();
            frequencies.push((self.stiffness * &shape).dot(&shape).sqrt());
            shapes.set_column(column - first, &shape);
        }
        let is_positive = |frequency: &f64| frequency.is_finite() && *frequency > 0.0;
        if !frequencies.iter().all(is_positive) {
            return Err(ShapesError::Range);
        }
        Ok((frequencies, shapes))
    }
}

/// The `modes` lowest modes of unit modal mass and their squared frequencies; `None` if `stiffness` plus `shift` times
/// the mass is not positive definite.
///
/// The inverse problem, M x = μ (K + σM) x: its largest values are the lowest frequencies, which are then least
/// affected by rounding; the shift σ admits rigid motions.
pub(crate) fn lowest(
    mass: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
    shift: f64,
    modes: usize,
) -> Option<(DMatrix<f64>, Vec<f64>)> {
    let shifted = stiffness + mass * shift;
    let factor = shifted.cholesky()?.unpack();
    let half = factor.solve_lower_triangular(mass)?;
    let inverse = factor.solve_lower_triangular(&half.transpose())?;
    let descending = |a: &f64, b: &f64| b.total_cmp(a);
    let (values, vectors) = ritz::sorted((&inverse + inverse.transpose()) * 0.5, descending);
    let count = modes.min(values.len());
    let mut shapes = factor.tr_solve_lower_triangular(&vectors.columns(0, count))?;
    for (mut shape, value) in shapes.column_iter_mut().zip(&values) {
        shape /= value.sqrt();
    }
    Some((shapes, values.iter().take(count).map(|value| 1.0 / value - shift).collect()))
}

/// Combinations of `answers` (columns of amplitudes of modes of these frequencies) that are orthogonal under mass and
/// stiffness, and their frequencies.
fn independent(answers: &DMatrix<f64>, frequencies: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
    let basis = answers * ritz::independent(answers.transpose() * answers, |_| 1.0, DEPENDENT);
    let springs = DVector::from_fn(frequencies.len(), |k, _| frequencies[k] * frequencies[k]);
    let stiffness = basis.transpose() * DMatrix::from_diagonal(&springs) * &basis;
    let (squares, vectors) = ritz::sorted(stiffness, f64::total_cmp);
    (squares.into_iter().map(f64::sqrt).collect(), basis * vectors)
}
