//! Bending and stretching modes of a free shaft: natural modes up to a frequency, and static correction modes for its
//! attachments ([`crate::members::free_modes`]).

use crate::ch4_rotor::beam::{NODES, PlaneMatrix};
use crate::members::beam::{Beam, BeamError, BeamMatrices, STATION};
use crate::members::flexible_shaft::Section;
use crate::members::free_modes::{Cut, FreeBody, FreeShapes};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// One plane of bending over [deflection (m), rotation of the section (rad)] at each station, SI units. The rotation is
/// positive for a deflection that grows along the shaft.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BendingPlane {
    /// Positions along the shaft, m, ascending.
    pub stations: Vec<f64>,
    pub mass: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    /// Axial inertia: times Ω it couples the two planes.
    pub axial_inertia: DMatrix<f64>,
    /// Axial mass of each station, kg.
    pub along: Vec<f64>,
    /// ∫ w′² between neighbouring stations of each element, over its stations.
    pub shortening: Vec<[PlaneMatrix; NODES - 1]>,
}

/// Attachment to a shaft: index of the station, and whether it has a moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AttachedStation {
    pub station: usize,
    pub turns: bool,
}

/// Rigid body part of a shaft, about its centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidPart {
    /// Position along the shaft, m.
    pub centre: f64,
    /// kg, kg·m².
    pub mass: f64,
    pub axial: f64,
    pub transverse: f64,
}

/// Modes of unit modal mass: of bending, equal in both planes, and of stretching.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShaftShapes {
    /// Frequencies of bending, rad/s.
    pub frequencies: Vec<f64>,
    /// Positions from the centre of mass, m, ascending.
    pub stations: Vec<f64>,
    /// Per unit of each mode, station by station: all modes at the first, at the second, …
    pub deflection: Vec<f64>,
    pub turn: Vec<f64>,
    /// g: axial inertia tilted by each mode, kg·m² per unit.
    pub tilt_coupling: Vec<f64>,
    /// G, row by row.
    pub gyroscopic: Vec<f64>,
    /// Number of natural modes; the others are static correction modes.
    pub natural: usize,
    pub cut: Cut,
    /// Lowest omitted natural frequency of bending and stretching, rad/s; infinite if none.
    pub first_omitted: f64,
    /// Frequencies of stretching, rad/s, and axial displacements in the order of those of bending.
    pub stretch_frequencies: Vec<f64>,
    pub stretch: Vec<f64>,
    /// D of each station, row by row: a shaft with bending amplitudes a and no stretch is shortened towards its centre
    /// of mass by ½ a·D a.
    pub shortening: Vec<f64>,
}

/// Error in the modes of a shaft.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ShapesError {
    #[error("the mass of the shaft is not positive: {0} kg")]
    Mass(f64),
    #[error(
        "stiffnesses and inertias along the shaft differ too much for its modes to be computed; check sizes of segments and discs \
         and their units"
    )]
    Range,
    #[error("the shaft has a zero-stiffness mode that is not a rigid-body motion")]
    Stiffness,
}

impl From<&BeamMatrices> for BendingPlane {
    /// An axisymmetric shaft bends equally in both planes: the one of Y is taken.
    fn from(beam: &BeamMatrices) -> BendingPlane {
        let size = 2 * beam.stations.len();
        let towards_y = |i: usize| STATION * (i / 2) + [0, 3][i % 2];
        // Coordinate and sign of deflection along Z and rotation towards Z.
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
            along: beam.axial_mass.column_sum().iter().copied().collect(),
            shortening: beam.shortening.clone(),
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

    /// Natural modes below `limit` (rad/s), at most `most`, and static correction modes of the attachments `holds`.
    ///
    /// # Errors
    ///
    /// A mass that is not positive.
    pub fn shapes(
        &self,
        limit: f64,
        most: usize,
        holds: &[AttachedStation],
    ) -> Result<ShaftShapes, ShapesError> {
        let rigid = self.rigid_part();
        let answers = |hold: &AttachedStation| {
            let turn = hold.turns.then_some(2 * hold.station + 1);
            [Some(2 * hold.station), turn].into_iter().flatten()
        };
        let rows: Vec<usize> = holds.iter().flat_map(answers).collect();
        let motions = self.rigid(rigid.centre);
        let free = FreeBody { mass: &self.mass, stiffness: &self.stiffness, rigid: &motions };
        let FreeShapes { frequencies, shapes, natural, cut } = free.shapes(limit, most, &rows)?;
        Ok(self.shaft_shapes(&rigid, frequencies, &shapes, natural, cut))
    }

    fn shaft_shapes(
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
            shortening: self.shortenings(shapes),
            frequencies,
            ..ShaftShapes::default()
        }
    }

    /// D of all stations: ∫ w′² from the first one on, less its mean over the mass.
    fn shortenings(&self, shapes: &DMatrix<f64>) -> Vec<f64> {
        let count = shapes.ncols();
        let mut at = vec![DMatrix::zeros(count, count)];
        for (element, parts) in self.shortening.iter().enumerate() {
            let own = shapes.rows(2 * (NODES - 1) * element, 2 * NODES);
            for part in parts {
                let last = &at[at.len() - 1];
                at.push(last + own.transpose() * part * own);
            }
        }
        let mass: f64 = self.along.iter().sum();
        let all = self.along.iter().zip(&at);
        let mean = all.fold(DMatrix::zeros(count, count), |sum, (m, at)| sum + at * (m / mass));
        at.iter().flat_map(|at| (at - &mean).iter().copied().collect::<Vec<f64>>()).collect()
    }
}

impl ShaftShapes {
    pub fn count(&self) -> usize {
        self.frequencies.len()
    }

    /// Modes at a position (m from the centre of mass): exact at a station, otherwise interpolated linearly.
    pub fn section(&self, along: f64) -> Section {
        let count = self.count();
        let last = self.stations.len().saturating_sub(1);
        let next = self.stations.partition_point(|x| *x <= along).clamp(1.min(last), last);
        let before = next.saturating_sub(1);
        let row = |of: &[f64], count: usize, at: usize| of[at * count..(at + 1) * count].to_vec();
        let length = self.stations[next] - self.stations[before];
        let part = if length > 0.0 {
            ((along - self.stations[before]) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let between = |of: &[f64], count: usize| {
            let both = row(of, count, before).into_iter().zip(row(of, count, next));
            both.map(|(a, b)| a + part * (b - a)).collect()
        };
        let stretches = self.stretch_frequencies.len();
        Section {
            along,
            deflection: between(&self.deflection, count),
            turn: between(&self.turn, count),
            stretch: between(&self.stretch, stretches),
            shortening: between(&self.shortening, count * count),
        }
    }

    /// Frequencies, Hz.
    pub fn hertz(&self) -> Vec<f64> {
        self.frequencies.iter().map(|w| w / TAU).collect()
    }
}

/// Error in a flexible shaft.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FreeShaftError {
    #[error(transparent)]
    Beam(#[from] BeamError),
    #[error(transparent)]
    Shapes(#[from] ShapesError),
    #[error(
        "the unbalances of a shaft driven by a torque have a moment of inertia of at least {least} kg m^2 \
         about its axis, but the whole shaft has only {axial} kg m^2. Hint: check their units, or give the \
         disc that carries them ([[body.NAME.beam.disc]])"
    )]
    Unbalances { least: f64, axial: f64 },
}

/// Number of modes of a shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kept {
    /// Highest natural frequency kept, rad/s.
    pub below: f64,
    /// Largest number of natural modes.
    pub most: usize,
}

impl Kept {
    pub const ALL: Kept = Kept { below: f64::INFINITY, most: usize::MAX };
    /// Static correction modes alone.
    pub const STATIC: Kept = Kept { below: 0.0, most: 0 };
}

/// Rigid body part and modes of a beam; `holds` are its attachments (m from its first end, and whether they have a
/// moment), `others` are positions of further sections.
///
/// # Errors
///
/// An invalid beam.
pub fn free_shaft(
    beam: &Beam,
    kept: Kept,
    holds: &[(f64, bool)],
    others: &[f64],
) -> Result<(RigidPart, ShaftShapes), FreeShaftError> {
    let places: Vec<f64> = holds.iter().map(|(at, _)| *at).chain(others.iter().copied()).collect();
    let matrices = beam.matrices(&places)?;
    let plane = BendingPlane::from(&matrices);
    let held = holds.iter().filter_map(|&(at, turns)| {
        matrices.station(at).map(|station| AttachedStation { station, turns })
    });
    let held: Vec<AttachedStation> = held.collect();
    let mut shapes = plane.shapes(kept.below, kept.most, &held)?;
    let even = [DVector::repeat(matrices.stations.len(), 1.0)];
    let (mass, stiffness) = (&matrices.axial_mass, &matrices.axial_stiffness);
    // Attachments without a moment act along the shaft as well.
    let rows: Vec<usize> = held.iter().map(|hold| hold.station).collect();
    let free = FreeBody { mass, stiffness, rigid: &even };
    let stretch = free.shapes(kept.below, kept.most, &rows)?;
    shapes.first_omitted = shapes.cut.above.min(stretch.cut.above);
    shapes.stretch = stretch.shapes.transpose().iter().copied().collect();
    shapes.stretch_frequencies = stretch.frequencies;
    Ok((plane.rigid_part(), shapes))
}
