//! A rotating system over its lowest modes at rest.
//!
//! Rotating bodies are axisymmetric, so that their matrices are constant in axes that do not rotate, as are those of
//! supports and dashpots. Damping that rotates with the shaft, which feeds whirl above the critical speed, is in
//! [`LinearSystem::circulating`].

use crate::members::beam::{BeamError, station_at};
use crate::members::free_modes::lowest;
use crate::vibrations::critical_speeds::Critical;
use crate::vibrations::relaxing::{Relaxing, settled};
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum RotorError {
    #[error(transparent)]
    Beam(#[from] BeamError),
    #[error("every coordinate of the shaft is fixed: nothing can move")]
    NothingMoves,
    #[error("the equilibrium is unstable: the stiffness is negative along some motion")]
    Unstable,
    #[error("the {size} eigenvalues at {speed} rad/s have not been found")]
    Eigenvalues { speed: f64, size: usize },
    #[error(
        "{name} rotates with the body at its first end (`from`), and its stiffnesses along y and z differ. \
         The stiffness of the system therefore changes as the body turns, and it has no natural frequencies. \
         Hint: make both stiffnesses equal, or attach the first end to a body that does not rotate"
    )]
    Uneven { name: String },
    #[error("no stiffness: a rigid shaft that moves freely has no critical speed")]
    Unheld,
    #[error(
        "a body without supports has equal moments of inertia about its axis and across it: its whirl has the \
         frequency of rotation at every speed, so that there is no critical speed"
    )]
    Sphere,
    #[error(
        "a cross-coupled spring (`yz`, `zy`) acts on a motion without stiffness of its own. Hint: read the critical speeds from \
         the crossings with 1X in the Campbell diagram, or give the spring a small stiffness along both y and z"
    )]
    OnlyCoupled,
}

/// Small motions about an equilibrium, M q̈ + (C + Ω G) q̇ + (K + Ω S) q = loads. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearSystem {
    pub mass: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    pub damping: DMatrix<f64>,
    /// G, per rad/s of spin; skew.
    pub gyroscopic: DMatrix<f64>,
    /// S, per rad/s of spin: rotating damping.
    pub circulating: DMatrix<f64>,
    /// Pairs of coordinates: a quarter turn from Y to Z takes the first to the second, and the second to minus the
    /// first.
    pub pairs: Vec<[usize; 2]>,
    /// Free coordinates.
    pub free: Vec<usize>,
    /// Maxwell elements, whose stiffness is not in `stiffness`.
    pub relaxing: Vec<Relaxing>,
}

impl LinearSystem {
    /// The system with the storage stiffness of its Maxwell elements, each at its own frequency (rad/s or infinite),
    /// instead of the elements.
    fn stiffened(&self, frequency: impl Fn(&Relaxing) -> f64) -> LinearSystem {
        let mut stiff = LinearSystem { relaxing: Vec::new(), ..self.clone() };
        self.relaxing.iter().for_each(|of| stiff.stiffness += of.storage(frequency(of)));
        stiff
    }
}

/// A rotating system over its modes at rest, p̈ + (C + Ω G) ṗ + (K + Ω S) p = Bᵀ loads, q = B p.
#[derive(Clone, Debug)]
pub struct RotorModel {
    /// Positions of the stations along the shaft, m.
    pub stations: Vec<f64>,
    /// Modes at rest as columns, of unit modal mass, over y, z, turn_y, turn_z of all stations.
    pub basis: DMatrix<f64>,
    /// Natural frequencies, rad/s, ascending; zero for rigid modes.
    pub natural: Vec<f64>,
    pub damping: DMatrix<f64>,
    pub gyroscopic: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    /// S.
    pub circulating: DMatrix<f64>,
    pub relaxing: Vec<Relaxing>,
    /// Bᵀ M R B, R a quarter turn from Y to Z: ±i for a circular whirl, forward and backward.
    pub(crate) quarter_turn: DMatrix<f64>,
}

/// A squared frequency below this fraction of the stiffness is a rigid mode with rounding.
const RIGID: f64 = 1e-12;

impl RotorModel {
    /// The system over `modes` of its modes; `sections` are y, z, turn_y, turn_z at each of the `stations` per unit of
    /// each coordinate, `None` if they are the coordinates.
    ///
    /// # Errors
    ///
    /// Nothing that moves; an unstable equilibrium.
    pub fn of(
        vibrations: &LinearSystem,
        modes: usize,
        stations: Vec<f64>,
        sections: Option<&DMatrix<f64>>,
    ) -> Result<RotorModel, RotorError> {
        // Modes are those of unrelaxed springs.
        let stiff =
            (!vibrations.relaxing.is_empty()).then(|| vibrations.stiffened(|_| f64::INFINITY));
        let (basis, natural) =
            natural_modes(stiff.as_ref().unwrap_or(vibrations), modes, &vibrations.relaxing)?;
        let LinearSystem { mass, stiffness, damping, gyroscopic, circulating, pairs, .. } =
            vibrations;
        let project = |matrix: &DMatrix<f64>| basis.transpose() * matrix * &basis;
        let mut modal_stiffness = project(stiffness);
        let skew = circulation(&modal_stiffness);
        for rigid in (0..natural.len()).filter(|&i| natural[i] == 0.0) {
            // Rounding that would oscillate. A cross-coupled spring may act on a motion without stiffness of its own.
            for other in 0..natural.len() {
                let coupled = skew.as_ref().map_or(0.0, |skew| skew[(rigid, other)]);
                modal_stiffness[(rigid, other)] = coupled;
                modal_stiffness[(other, rigid)] = -coupled;
            }
        }
        let mut turned = DMatrix::zeros(basis.nrows(), basis.ncols());
        for &[first, second] in pairs {
            turned.row_mut(first).copy_from(&(-basis.row(second)));
            turned.row_mut(second).copy_from(&basis.row(first));
        }
        Ok(RotorModel {
            stations,
            damping: project(damping),
            gyroscopic: project(gyroscopic),
            circulating: project(circulating),
            stiffness: modal_stiffness,
            relaxing: vibrations.relaxing.iter().map(|of| of.over(&basis)).collect(),
            quarter_turn: basis.transpose() * mass * turned,
            basis: match sections {
                Some(sections) => sections * &basis,
                None => basis,
            },
            natural,
        })
    }

    /// Critical speeds up to `limit`, rad/s, and some above it. Maxwell elements have their storage stiffness at the
    /// frequency of synchronous forward whirl in their axes: the spin for elements at rest, zero for elements that
    /// rotate with it.
    ///
    /// # Errors
    ///
    /// See [`RotorModel::critical_speeds`].
    pub fn critical_speeds_up_to(&self, limit: f64) -> Result<Vec<Critical>, RotorError> {
        let at = |speed: f64| {
            let seen = |of: &Relaxing| match of.spin {
                1.0 => 0.0,
                spin => (1.0 - spin).abs() * speed,
            };
            self.stiffened(seen)?.criticals()
        };
        let (stiffest, loose) = at(f64::INFINITY)?;
        if self.relaxing.iter().all(|of| of.spin == 1.0) {
            return Ok(stiffest);
        }
        // A critical speed above the limit with springs relaxed at the limit is not below it.
        let limited = at(limit)?;
        let mut found = Vec::new();
        for (number, critical) in stiffest.iter().enumerate() {
            // Modes that have lost their stiffness no longer count.
            let of = |now: &(Vec<Critical>, usize)| (number + loose).checked_sub(now.1);
            let own = of(&limited).and_then(|own| limited.0.get(own));
            if own.is_some_and(|own| own.speed > limit) {
                break;
            }
            let mut last = critical.clone();
            let value = |square: f64| -> Result<f64, RotorError> {
                let mut all = at(square.sqrt())?;
                Ok(match of(&all).filter(|own| *own < all.0.len()) {
                    Some(own) => {
                        last = all.0.swap_remove(own);
                        last.speed * last.speed
                    }
                    None => 0.0,
                })
            };
            if settled(critical.speed * critical.speed, value)?.is_some() {
                found.push(last);
            }
        }
        found.sort_by(|a, b| a.speed.total_cmp(&b.speed));
        Ok(found)
    }

    /// The model with the storage stiffness of its Maxwell elements, each at its own frequency (rad/s or infinite),
    /// instead of the elements: the same modes in other combinations.
    fn stiffened(&self, frequency: impl Fn(&Relaxing) -> f64) -> Result<RotorModel, RotorError> {
        let mut stiffness = self.stiffness.clone();
        self.relaxing.iter().for_each(|of| stiffness += of.storage(frequency(of)));
        let even = (&stiffness + stiffness.transpose()) * 0.5;
        let count = even.nrows();
        let mass = DMatrix::identity(count, count);
        // Reference stiffness of unrelaxed springs, so that no mode becomes rigid by comparison.
        let held = self.natural.iter().copied().find(|&natural| natural > 0.0).unwrap_or(1.0);
        let (turned, squares) =
            lowest(&mass, &even, 1e-4 * held * held, count).ok_or(RotorError::Unstable)?;
        let over = |matrix: &DMatrix<f64>| turned.tr_mul(&(matrix * &turned));
        let noise = (RIGID * held * held).max(f64::EPSILON * even.amax());
        if squares.iter().any(|&square| square < -10.0 * noise) {
            return Err(RotorError::Unstable);
        }
        let natural = squares.iter().map(|&s| if s <= noise { 0.0 } else { s.sqrt() });
        Ok(RotorModel {
            stations: self.stations.clone(),
            basis: &self.basis * &turned,
            natural: natural.collect(),
            damping: over(&self.damping),
            gyroscopic: over(&self.gyroscopic),
            stiffness: over(&stiffness),
            circulating: over(&self.circulating),
            relaxing: Vec::new(),
            quarter_turn: over(&self.quarter_turn),
        })
    }

    /// Number of rigid modes, the first ones.
    pub(crate) fn rigid(&self) -> usize {
        self.natural.iter().take_while(|&&natural| natural == 0.0).count()
    }

    /// Returns whether a lateral motion has no stiffness, nor any that is cross-coupled.
    pub fn is_loose(&self) -> bool {
        let lateral = |&mode: &usize| self.quarter_turn.column(mode).amax() > 0.01;
        (0..self.rigid()).filter(lateral).any(|mode| self.stiffness.row(mode).amax() == 0.0)
    }

    /// Returns whether motions decay or grow without rotation.
    pub fn is_damped(&self) -> bool {
        self.damping.amax() > 0.0
            || !self.relaxing.is_empty()
            || circulation(&self.stiffness).is_some()
    }

    /// Index of the station at a position (m), if there is one.
    pub fn station(&self, at: f64) -> Option<usize> {
        station_at(&self.stations, at)
    }
}

/// Skew-symmetric part of a stiffness; `None` if it is rounding.
pub(crate) fn circulation(stiffness: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let skew = (stiffness - stiffness.transpose()) * 0.5;
    (skew.amax() > CIRCULATES * stiffness.amax()).then_some(skew)
}

/// Skew-symmetric stiffness below this fraction of the largest stiffness is rounding.
const CIRCULATES: f64 = 1e-12;

/// Basis of unit modal mass, and its frequencies at rest, rad/s: the lowest modes, and static corrections for
/// gyroscopic moments and dashpots of the lowest of these and for forces of `relaxing` springs, to which modes alone
/// converge slowly.
fn natural_modes(
    of: &LinearSystem,
    modes: usize,
    relaxing: &[Relaxing],
) -> Result<(DMatrix<f64>, Vec<f64>), RotorError> {
    let free = &of.free;
    if free.is_empty() || modes == 0 {
        return Err(RotorError::NothingMoves);
    }
    let count = free.len();
    let part =
        |matrix: &DMatrix<f64>| DMatrix::from_fn(count, count, |i, j| matrix[(free[i], free[j])]);
    let mass = part(&of.mass);
    let stiffness = part(&of.stiffness);
    let stiffness = (&stiffness + stiffness.transpose()) * 0.5;
    // Of coordinates with stiffness.
    let ratios = (0..count).map(|i| stiffness[(i, i)] / mass[(i, i)]).filter(|ratio| *ratio > 0.0);
    let lightest = ratios.fold(f64::INFINITY, f64::min);
    let (mut shapes, mut squares) =
        lowest(&mass, &stiffness, 1e-4 * lightest, modes).ok_or(RotorError::Unstable)?;
    if modes < count {
        let corrected = modes / 3;
        let keep = modes - corrected;
        let lowest_ones = shapes.columns(0, corrected);
        let mut loads: Vec<DVector<f64>> = Vec::new();
        for forces in [&of.gyroscopic, &of.damping] {
            let of_motions = part(forces) * lowest_ones;
            loads.extend(of_motions.column_iter().map(|column| column.into_owned()));
        }
        for row in relaxing.iter().flat_map(Relaxing::pulled) {
            loads.push(DVector::from_iterator(count, free.iter().map(|&at| row[at])));
        }
        let loads = DMatrix::from_columns(&loads);
        let shifted = &stiffness + &mass * (1e-4 * lightest);
        let bent = shifted.cholesky().ok_or(RotorError::Unstable)?.solve(&loads);
        let mut ritz = DMatrix::zeros(count, (keep + bent.ncols()).min(count));
        ritz.columns_mut(0, keep).copy_from(&shapes.columns(0, keep));
        let mut at = keep;
        for column in bent.column_iter() {
            // Twice: the rest may be small compared with the removed part.
            let mut column = column.into_owned();
            let before = column.dot(&(&mass * &column)).sqrt();
            for _ in 0..2 {
                let inertia = &mass * &column;
                let taken = ritz.columns(0, at).tr_mul(&inertia);
                column -= ritz.columns(0, at) * taken;
            }
            let left = column.dot(&(&mass * &column)).sqrt();
            // Moments of two discs may give the same deflection, mass damping acts like inertia, and elements of one
            // spring act alike.
            if left > 1e-9 * before && at < ritz.ncols() {
                ritz.set_column(at, &(column / left));
                at += 1;
            }
        }
        let ritz = ritz.columns(0, at).into_owned();
        let own_stiffness = ritz.tr_mul(&(&stiffness * &ritz));
        let own_mass = ritz.tr_mul(&(&mass * &ritz));
        let (combined, own) =
            lowest(&own_mass, &own_stiffness, 1e-4 * lightest, at).ok_or(RotorError::Unstable)?;
        (shapes, squares) = (ritz * combined, own);
    }
    let mut basis = DMatrix::zeros(of.mass.nrows(), shapes.ncols());
    for (i, &at) in free.iter().enumerate() {
        basis.row_mut(at).copy_from(&shapes.row(i));
    }
    let noise = RIGID * lightest;
    if squares.iter().any(|&square| square < -noise) {
        return Err(RotorError::Unstable);
    }
    let natural = squares.iter().map(|&s| if s.abs() <= noise { 0.0 } else { s.sqrt() });
    Ok((basis, natural.collect()))
}
