//! Shapes of bending of a free shaft: natural ones up to a frequency, and beside them its static answers to what
//! takes hold of it, as far as the natural ones leave these out.
//!
//! Both are orthogonal to each other and to the shaft's rigid motions under its mass. A load at a place where something
//! takes hold is so answered exactly as long as it is slow; of one at frequency f what is missed is about (f/f_cut)² of
//! the part of the compliance that the natural shapes left out would have had.

use crate::solver::dynamics::shaft::Section;
use crate::solver::rotor::beam::{Beam, BeamError, BeamMatrices, STATION};
use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};
use std::f64::consts::TAU;

/// One plane of bending over [deflection (m), turn of the section (rad)] at each station, SI units. The turn is positive where
/// the deflection grows along the shaft.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BendingPlane {
    /// Places along the shaft, m, in order.
    pub stations: Vec<f64>,
    pub mass: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    /// Inertia about the axis: Ω times it couples the two planes.
    pub axial_inertia: DMatrix<f64>,
}

/// Where something takes hold of a shaft: index of the station, and whether it may turn it too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hold {
    pub station: usize,
    pub turns: bool,
}

/// Of a shaft, about its centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidPart {
    /// Along the shaft, m.
    pub centre: f64,
    /// kg, kg·m².
    pub mass: f64,
    pub axial: f64,
    pub transverse: f64,
}

/// Shapes with a mass of 1 kg each, the same along both directions across the shaft.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShaftShapes {
    /// rad/s.
    pub frequencies: Vec<f64>,
    /// From the centre of mass, m, in order.
    pub stations: Vec<f64>,
    /// Of a unit of each shape, station by station: all shapes at the first, at the second, …
    pub deflection: Vec<f64>,
    pub turn: Vec<f64>,
    /// g: inertia about the axis that each shape tilts, kg·m² for a unit of it.
    pub tilt_coupling: Vec<f64>,
    /// G, row by row.
    pub gyroscopic: Vec<f64>,
    /// How many of them are natural ones; the others are static answers.
    pub natural: usize,
    pub cut: Cut,
}

/// What the shapes leave out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cut {
    /// Lowest natural frequency that is not among them, rad/s; none where all are.
    pub above: f64,
    /// Largest part of the static compliance (beside rigid motion) at a hold that lies above.
    pub share: f64,
}

/// Static answers that differ by less than this part of themselves from the others are none of their own.
const DEPENDENT: f64 = 1e-10;

/// Why a shaft has no shapes.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ShapesError {
    #[error("the mass of the shaft is not positive: {0} kg")]
    Mass(f64),
}

impl From<&BeamMatrices> for BendingPlane {
    /// A shaft of revolution bends in both planes alike: the one of Y is taken.
    fn from(beam: &BeamMatrices) -> BendingPlane {
        let size = 2 * beam.stations.len();
        let towards_y = |i: usize| STATION * (i / 2) + [0, 3][i % 2];
        // (coordinate, its sign) of deflection along Z and turn towards Z.
        let towards_z = |i: usize| (STATION * (i / 2) + 1 + i % 2, [1.0, -1.0][i % 2]);
        let in_plane = |of: &DMatrix<f64>| {
            DMatrix::from_fn(size, size, |i, j| of[(towards_y(i), towards_y(j))])
        };
        BendingPlane {
            stations: beam.stations.clone(),
            mass: in_plane(&beam.mass),
            stiffness: in_plane(&beam.stiffness),
            axial_inertia: DMatrix::from_fn(size, size, |i, j| {
                let (column, sign) = towards_z(j);
                sign * beam.gyroscopic[(towards_y(i), column)]
            }),
        }
    }
}

impl BendingPlane {
    fn rigid(&self, centre: f64) -> [DVector<f64>; 2] {
        let size = 2 * self.stations.len();
        let odd = |i: usize| i % 2 == 1;
        [
            DVector::from_fn(size, |i, _| if odd(i) { 0.0 } else { 1.0 }),
            DVector::from_fn(size, |i, _| if odd(i) { 1.0 } else { self.stations[i / 2] - centre }),
        ]
    }

    /// Mass, centre and inertias.
    pub fn rigid_part(&self) -> RigidPart {
        let [shift, about_origin] = self.rigid(0.0);
        let of = |a: &DVector<f64>, matrix: &DMatrix<f64>, b: &DVector<f64>| (matrix * b).dot(a);
        let mass = of(&shift, &self.mass, &shift);
        let centre = of(&shift, &self.mass, &about_origin) / mass;
        let [_, turn] = self.rigid(centre);
        RigidPart {
            centre,
            mass,
            axial: of(&turn, &self.axial_inertia, &turn),
            transverse: of(&turn, &self.mass, &turn),
        }
    }

    /// Natural shapes below `limit` (rad/s), `most` of them, and the static answers at `holds`.
    ///
    /// # Errors
    /// A mass that is not positive.
    pub fn shapes(
        &self,
        limit: f64,
        most: usize,
        holds: &[Hold],
    ) -> Result<ShaftShapes, ShapesError> {
        let rigid = self.rigid_part();
        let Some(factor) = Cholesky::new(self.mass.clone()) else {
            return Err(ShapesError::Mass(rigid.mass));
        };
        let (frequencies, all) = self.natural(&factor, &rigid);
        let kept: usize = frequencies.iter().take(most).filter(|w| **w <= limit).count();
        let answers = |hold: &Hold| {
            let turn = hold.turns.then_some(2 * hold.station + 1);
            [Some(2 * hold.station), turn].into_iter().flatten()
        };
        let rows: Vec<usize> = holds.iter().flat_map(answers).collect();
        let left_out = frequencies.len() - kept;
        // Amplitudes of the natural shapes left out in each static answer.
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
        let (static_frequencies, combined) = self.independent(&answers, &frequencies[kept..]);
        let count = kept + static_frequencies.len();
        let size = 2 * self.stations.len();
        let mut shapes = DMatrix::zeros(size, count);
        shapes.columns_mut(0, kept).copy_from(&all.columns(0, kept));
        shapes.columns_mut(kept, count - kept).copy_from(&(all.columns(kept, left_out) * combined));
        let above = frequencies.get(kept).copied().unwrap_or(f64::INFINITY);
        let frequencies: Vec<f64> =
            frequencies[..kept].iter().chain(&static_frequencies).copied().collect();
        let cut = Cut { above, share };
        Ok(self.told(&rigid, frequencies, &shapes, kept, cut))
    }

    /// All natural shapes beside the rigid motions, in the order of their frequencies (rad/s).
    fn natural(
        &self,
        factor: &Cholesky<f64, nalgebra::Dyn>,
        rigid: &RigidPart,
    ) -> (Vec<f64>, DMatrix<f64>) {
        let lower = factor.l();
        let solved = |matrix: &DMatrix<f64>| {
            lower.solve_lower_triangular(matrix).unwrap_or_else(|| matrix.clone())
        };
        let scaled = solved(&solved(&self.stiffness).transpose());
        let symmetric = (&scaled + scaled.transpose()) * 0.5;
        let eigen = SymmetricEigen::new(symmetric);
        let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
        // The first two are the rigid motions.
        let order = &order[2.min(order.len())..];
        let back = lower.transpose();
        let mut shapes = DMatrix::zeros(self.mass.nrows(), order.len());
        let motions = self.rigid(rigid.centre);
        let weights = [rigid.mass, rigid.transverse];
        let mut frequencies = Vec::with_capacity(order.len());
        for (column, &index) in order.iter().enumerate() {
            let own = eigen.eigenvectors.column(index).into_owned();
            let mut shape = back.solve_upper_triangular(&own).unwrap_or(own);
            // Rounding leaves some rigid motion in a shape, and its frequency to the square root of its part.
            for (motion, weight) in motions.iter().zip(weights) {
                let part = (&self.mass * motion).dot(&shape) / weight;
                shape -= motion * part;
            }
            shape /= (&self.mass * &shape).dot(&shape).sqrt();
            frequencies.push((&self.stiffness * &shape).dot(&shape).sqrt());
            shapes.set_column(column, &shape);
        }
        (frequencies, shapes)
    }

    /// Combinations of `answers` (columns of amplitudes of shapes of these frequencies) that are orthogonal under mass and
    /// stiffness, and their frequencies.
    fn independent(&self, answers: &DMatrix<f64>, frequencies: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
        let mass = answers.transpose() * answers;
        if answers.is_empty() {
            return (Vec::new(), DMatrix::zeros(answers.nrows(), 0));
        }
        let gram = SymmetricEigen::new(mass);
        let most = gram.eigenvalues.max();
        let used: Vec<usize> = (0..gram.eigenvalues.len())
            .filter(|i| gram.eigenvalues[*i] > DEPENDENT * most)
            .collect();
        let basis = DMatrix::from_fn(answers.ncols(), used.len(), |i, j| {
            gram.eigenvectors[(i, used[j])] / gram.eigenvalues[used[j]].sqrt()
        });
        let basis = answers * basis;
        let springs = DVector::from_fn(frequencies.len(), |k, _| frequencies[k] * frequencies[k]);
        let stiffness = basis.transpose() * DMatrix::from_diagonal(&springs) * &basis;
        let eigen = SymmetricEigen::new(stiffness);
        let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
        let frequencies = order.iter().map(|i| eigen.eigenvalues[*i].sqrt()).collect();
        let chosen =
            DMatrix::from_fn(order.len(), order.len(), |i, j| eigen.eigenvectors[(i, order[j])]);
        (frequencies, basis * chosen)
    }

    fn told(
        &self,
        rigid: &RigidPart,
        frequencies: Vec<f64>,
        shapes: &DMatrix<f64>,
        natural: usize,
        cut: Cut,
    ) -> ShaftShapes {
        let [_, tilt] = self.rigid(rigid.centre);
        let coupling = shapes.transpose() * (&self.axial_inertia * tilt);
        let gyroscopic = shapes.transpose() * &self.axial_inertia * shapes;
        let rows = |odd: usize| {
            let at = move |i: usize, k: usize| shapes[(2 * i + odd, k)];
            (0..self.stations.len())
                .flat_map(|i| (0..frequencies.len()).map(move |k| at(i, k)))
                .collect::<Vec<f64>>()
        };
        ShaftShapes {
            stations: self.stations.iter().map(|x| x - rigid.centre).collect(),
            deflection: rows(0),
            turn: rows(1),
            tilt_coupling: coupling.iter().copied().collect(),
            gyroscopic: gyroscopic.transpose().iter().copied().collect(),
            natural,
            cut,
            frequencies,
        }
    }
}

impl ShaftShapes {
    pub fn count(&self) -> usize {
        self.frequencies.len()
    }

    /// Shapes at a place (m from the centre of mass): at a station exactly, else on the line between two.
    pub fn section(&self, along: f64) -> Section {
        let count = self.count();
        let last = self.stations.len().saturating_sub(1);
        let next = self.stations.partition_point(|x| *x <= along).clamp(1.min(last), last);
        let before = next.saturating_sub(1);
        let row = |of: &[f64], at: usize| of[at * count..(at + 1) * count].to_vec();
        let length = self.stations[next] - self.stations[before];
        let part = if length > 0.0 {
            ((along - self.stations[before]) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let between = |of: &[f64]| {
            let both = row(of, before).into_iter().zip(row(of, next));
            both.map(|(a, b)| a + part * (b - a)).collect()
        };
        Section { along, deflection: between(&self.deflection), turn: between(&self.turn) }
    }

    /// Hz.
    pub fn hertz(&self) -> Vec<f64> {
        self.frequencies.iter().map(|w| w / TAU).collect()
    }
}

/// Why a shaft does not bend as asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FreeShaftError {
    #[error(transparent)]
    Beam(#[from] BeamError),
    #[error(transparent)]
    Shapes(#[from] ShapesError),
}

/// How many shapes a shaft gets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kept {
    /// Natural ones up to here, rad/s.
    pub below: f64,
    /// And no more than these.
    pub most: usize,
}

impl Kept {
    pub const ALL: Kept = Kept { below: f64::INFINITY, most: usize::MAX };
}

/// The rigid part and the shapes of a beam; something takes hold of it at `holds` (m from its first end, and
/// whether it may turn the section too), `others` are places where its sections are asked for besides.
///
/// # Errors
/// A beam that is none.
pub fn free_shaft(
    beam: &Beam,
    kept: Kept,
    holds: &[(f64, bool)],
    others: &[f64],
) -> Result<(RigidPart, ShaftShapes), FreeShaftError> {
    let places: Vec<f64> = holds.iter().map(|(at, _)| *at).chain(others.iter().copied()).collect();
    let matrices = beam.matrices(&places)?;
    let plane = BendingPlane::from(&matrices);
    let held = holds
        .iter()
        .filter_map(|&(at, turns)| matrices.station(at).map(|station| Hold { station, turns }));
    let shapes = plane.shapes(kept.below, kept.most, &held.collect::<Vec<Hold>>())?;
    Ok((plane.rigid_part(), shapes))
}
