//! A shaft on supports, over its lowest natural motions at rest.
//!
//! What turns with the shaft is a body of revolution, so that its matrices stand still in axes that do not turn;
//! supports and damping stand still too. Damping in the turning shaft itself, which feeds whirl above the critical speed, is not here.

use crate::members::beam::{Beam, BeamError, BeamMatrices, STATION, station_at};
use crate::solids::free_modes::lowest;
use crate::vibrations::critical_speeds::Critical;
use crate::vibrations::relaxing::{Relaxing, settled};
use nalgebra::{DMatrix, DVector, Matrix4};
use thiserror::Error;

/// What holds the shaft elastically at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// m from the shaft's first end.
    pub at: f64,
    /// Over y, z, turn_y, turn_z; of a bearing the rows and columns of these in its stiffness at equilibrium.
    pub stiffness: Matrix4<f64>,
    /// N·s/m, N·s, N·m·s.
    pub damping: Matrix4<f64>,
}

/// Coordinates that do not move at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// m from the shaft's first end.
    pub at: f64,
    /// y, z, turn_y, turn_z.
    pub coordinates: [bool; 4],
}

impl Held {
    /// In y and z.
    pub fn pin(at: f64) -> Held {
        Held { at, coordinates: [true, true, false, false] }
    }

    pub fn clamp(at: f64) -> Held {
        Held { at, coordinates: [true; 4] }
    }
}

/// A shaft and what holds it.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotor {
    pub beam: Beam,
    pub supports: Vec<Support>,
    pub held: Vec<Held>,
    /// α of a damping α M that brakes lateral motion in axes that do not turn, 1/s.
    pub mass_damping: f64,
    /// Further places with stations, m: of loads and sensors.
    pub places: Vec<f64>,
    /// How many shapes are kept; all where there are fewer. Two thirds are natural motions at rest.
    pub modes: usize,
}

/// Shapes that are kept where nothing else is said: twelve in each plane.
pub const MODES: usize = 24;

impl Rotor {
    /// Without supports.
    pub fn new(beam: Beam) -> Rotor {
        let (supports, held, places) = (Vec::new(), Vec::new(), Vec::new());
        Rotor { beam, supports, held, mass_damping: 0.0, places, modes: MODES }
    }
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum RotorError {
    #[error(transparent)]
    Beam(#[from] BeamError),
    #[error("support {number} of the shaft: its stiffness or damping is not finite")]
    Support { number: usize },
    #[error("the damping of the shaft is {0} 1/s: it has to be 0 or more")]
    Damping(f64),
    #[error("every coordinate of the shaft is held: nothing is left that could move")]
    NothingMoves,
    #[error("the shaft on its supports falls over: their stiffness is negative along some motion")]
    Unstable,
    #[error("the {size} eigenvalues at {speed} rad/s have not been found")]
    Eigenvalues { speed: f64, size: usize },
    #[error("no speed near {near} rad/s was found at which the damped motion whirls once a turn")]
    DampedCritical { near: f64 },
    #[error(
        "{name} turns with the body where it begins and is not alike along y and z: what it does changes as the body turns, and \
         motions about the equilibrium have no frequencies. Hint: make it alike along both, or begin it at a body that does not turn"
    )]
    Uneven { name: String },
    #[error("nothing holds or bends: a rigid shaft that moves freely has no critical speed")]
    Unheld,
    #[error(
        "nothing holds a motion whose inertia about the axis is that across it: it whirls once a turn at every speed"
    )]
    Sphere,
}

/// Small motions about an equilibrium, M q̈ + (C + Ω G) q̇ + (K + Ω S) q = loads. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearSystem {
    pub mass: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    pub damping: DMatrix<f64>,
    /// G, per rad/s of spin; skew.
    pub gyroscopic: DMatrix<f64>,
    /// S, per rad/s of spin: damping that turns along.
    pub circulating: DMatrix<f64>,
    /// Coordinates that a quarter turn from Y to Z takes the first one to the second one, the second one to less the first.
    pub pairs: Vec<[usize; 2]>,
    /// Coordinates that may move.
    pub free: Vec<usize>,
    /// Springs that relax, whose stiffness is not in that above.
    pub relaxing: Vec<Relaxing>,
}

impl LinearSystem {
    /// With what the springs that relax store of an oscillation, each at its own frequency (rad/s or infinite), and nothing that relaxes.
    fn stiffened(&self, frequency: impl Fn(&Relaxing) -> f64) -> LinearSystem {
        let mut stiff = LinearSystem { relaxing: Vec::new(), ..self.clone() };
        self.relaxing.iter().for_each(|of| stiff.stiffness += of.storage(frequency(of)));
        stiff
    }
}

/// What turns over its natural motions at rest, p̈ + (C + Ω G) ṗ + (K + Ω S) p = Bᵀ loads, q = B p.
#[derive(Clone, Debug)]
pub struct RotorModel {
    /// Places along the shaft at which motions are told, m.
    pub stations: Vec<f64>,
    /// Each column a natural motion at rest, its modal mass 1, over y, z, turn_y, turn_z of all stations.
    pub basis: DMatrix<f64>,
    /// rad/s, ascending; zero for rigid motions.
    pub natural: Vec<f64>,
    pub damping: DMatrix<f64>,
    pub gyroscopic: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    /// S.
    pub circulating: DMatrix<f64>,
    pub relaxing: Vec<Relaxing>,
    /// Bᵀ M R B, R a quarter turn from Y to Z: ±i on a motion that whirls in circles, forward and backward.
    pub(crate) quarter_turn: DMatrix<f64>,
}

/// Below this part of the stiffness a frequency counts as that of a rigid motion: what rounding leaves.
const RIGID: f64 = 1e-12;

impl RotorModel {
    /// # Errors
    /// Values that no shaft has, supports that let it fall.
    pub fn new(rotor: &Rotor) -> Result<RotorModel, RotorError> {
        let supports = rotor.supports.iter().map(|support| support.at);
        let held = rotor.held.iter().map(|held| held.at);
        let places: Vec<f64> = supports.chain(held).chain(rotor.places.iter().copied()).collect();
        let matrices = rotor.beam.matrices(&places)?;
        if !(rotor.mass_damping >= 0.0 && rotor.mass_damping.is_finite()) {
            return Err(RotorError::Damping(rotor.mass_damping));
        }
        let mut stiffness = matrices.stiffness.clone();
        let mut damping = &matrices.mass * rotor.mass_damping;
        for (index, support) in rotor.supports.iter().enumerate() {
            let values = support.stiffness.iter().chain(support.damping.iter());
            if values.into_iter().any(|value| !value.is_finite()) {
                return Err(RotorError::Support { number: index + 1 });
            }
            let first = STATION * station(&matrices, support.at);
            let mut view = stiffness.fixed_view_mut::<STATION, STATION>(first, first);
            view += support.stiffness;
            let mut view = damping.fixed_view_mut::<STATION, STATION>(first, first);
            view += support.damping;
        }
        let free = free_coordinates(&matrices, &rotor.held);
        let size = matrices.mass.nrows();
        let pairs = (0..size / 2).map(|pair| [2 * pair, 2 * pair + 1]).collect();
        let vibrations = LinearSystem {
            mass: matrices.mass,
            stiffness,
            damping,
            gyroscopic: matrices.gyroscopic,
            circulating: DMatrix::zeros(size, size),
            pairs,
            free,
            relaxing: Vec::new(),
        };
        RotorModel::of(&vibrations, rotor.modes, matrices.stations, None)
    }

    /// Of any motions that `modes` shapes are kept of; `sections` are y, z, turn_y, turn_z at each of the `stations` for a unit
    /// of each coordinate, [`None`] where they are the coordinates.
    ///
    /// # Errors
    /// Nothing that moves, an equilibrium that is none.
    pub fn of(
        vibrations: &LinearSystem,
        modes: usize,
        stations: Vec<f64>,
        sections: Option<&DMatrix<f64>>,
    ) -> Result<RotorModel, RotorError> {
        // Shapes are those of springs that have not relaxed.
        let stiff =
            (!vibrations.relaxing.is_empty()).then(|| vibrations.stiffened(|_| f64::INFINITY));
        let (basis, natural) =
            natural_motions(stiff.as_ref().unwrap_or(vibrations), modes, &vibrations.relaxing)?;
        let LinearSystem { mass, stiffness, damping, gyroscopic, circulating, pairs, .. } =
            vibrations;
        let project = |matrix: &DMatrix<f64>| basis.transpose() * matrix * &basis;
        let mut modal_stiffness = project(stiffness);
        for rigid in (0..natural.len()).filter(|&i| natural[i] == 0.0) {
            // Rounding that would oscillate.
            modal_stiffness.row_mut(rigid).fill(0.0);
            modal_stiffness.column_mut(rigid).fill(0.0);
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

    /// Critical speeds up to `limit`, rad/s, and some above it: springs that relax have the stiffness that they store at the frequency that
    /// forward whirl once a turn has in their axes, that of the speed where they stand still and none where they turn at the speed.
    ///
    /// # Errors
    /// As [`RotorModel::critical_speeds`].
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
        // A speed that springs give which have relaxed less than at the limit is not below it.
        let limited = at(limit)?;
        let mut found = Vec::new();
        for (number, critical) in stiffest.iter().enumerate() {
            // What has come to be held by nothing is no longer counted.
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

    /// With what the springs that relax store of an oscillation, each at its own frequency (rad/s or infinite), and nothing that relaxes: the
    /// same shapes in other combinations.
    fn stiffened(&self, frequency: impl Fn(&Relaxing) -> f64) -> Result<RotorModel, RotorError> {
        let mut stiffness = self.stiffness.clone();
        self.relaxing.iter().for_each(|of| stiffness += of.storage(frequency(of)));
        let even = (&stiffness + stiffness.transpose()) * 0.5;
        let count = even.nrows();
        let mass = DMatrix::identity(count, count);
        // Of springs that have not relaxed, so that nothing comes to be rigid by comparison.
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

    /// Whether nothing brings back a motion across the axis.
    pub fn is_loose(&self) -> bool {
        let rigid = self.natural.iter().take_while(|&&natural| natural == 0.0).count();
        self.quarter_turn.columns(0, rigid).amax() > 0.01
    }

    /// The station that stands at a place (m), if one does.
    pub fn station(&self, at: f64) -> Option<usize> {
        station_at(&self.stations, at)
    }

    /// Loads over all coordinates seen by the natural motions.
    pub fn modal_load(&self, station: usize, load: [f64; STATION]) -> DVector<f64> {
        let first = STATION * station;
        let mut modal = DVector::zeros(self.natural.len());
        for (i, value) in load.into_iter().enumerate() {
            modal += self.basis.row(first + i).transpose() * value;
        }
        modal
    }
}

/// The station at a place that was asked for.
pub(crate) fn station(matrices: &BeamMatrices, at: f64) -> usize {
    matrices.station(at).expect("places that were asked for have stations")
}

fn free_coordinates(matrices: &BeamMatrices, held: &[Held]) -> Vec<usize> {
    let mut free = vec![true; matrices.mass.nrows()];
    for held in held {
        let first = STATION * station(matrices, held.at);
        for (i, &is_held) in held.coordinates.iter().enumerate() {
            free[first + i] &= !is_held;
        }
    }
    (0..free.len()).filter(|&i| free[i]).collect()
}

/// Shapes of unit modal mass that the rotor's motions are made of, and their frequencies at rest, rad/s: the lowest natural motions,
/// and what natural motions alone approach slowly: what gyroscopic moments and dashpots of the lowest of these bend besides, and what forces of
/// `relaxing` springs do.
fn natural_motions(
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
    // Of what is held at all.
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
            // Twice: what is left may be small beside what was taken away.
            let mut column = column.into_owned();
            let before = column.dot(&(&mass * &column)).sqrt();
            for _ in 0..2 {
                let inertia = &mass * &column;
                let taken = ritz.columns(0, at).tr_mul(&inertia);
                column -= ritz.columns(0, at) * taken;
            }
            let left = column.dot(&(&mass * &column)).sqrt();
            // Two discs' moments may bend the shaft alike, damping of the mass does what inertia does, and elements of one spring pull alike.
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
