//! Modes of a rotating system: eigenvalues, direction of whirl, mode shapes; lines over speeds (Campbell diagram).

use crate::members::beam::STATION;
use crate::vibrations::relaxing::Relaxing;
use crate::vibrations::rotor::{RotorError, RotorModel};
use faer::Mat;
use nalgebra::{Complex, DMatrix, DVector};

/// A mode at a speed, q = Re(shape · e^{λt}).
#[derive(Clone, Debug, PartialEq)]
pub struct Whirl {
    /// λ, 1/s; its imaginary part is above 0.
    pub eigenvalue: Complex<f64>,
    /// Direction, weighted by inertia: 1 (circular, with the spin), 0 (to and fro), −1 (circular, against the spin).
    pub direction: f64,
    /// Fraction of the motion, by inertia, across the axis: 0 for an axial vibration.
    pub across: f64,
    /// Mode shape over y, z, turn_y, turn_z of each station, scaled to a largest deflection of 1 (largest rotation
    /// without deflection).
    pub shape: Vec<[Complex<f64>; STATION]>,
    /// The same over the modes at rest, of norm 1.
    pub(crate) modal: DVector<Complex<f64>>,
}

impl Whirl {
    /// Damped frequency, rad/s.
    pub fn frequency(&self) -> f64 {
        self.eigenvalue.im
    }

    /// Damping ratio; negative for a growing motion.
    pub fn damping_ratio(&self) -> f64 {
        // 0, not −0, without damping.
        0.0 - self.eigenvalue.re / self.eigenvalue.norm()
    }

    /// Similarity of two mode shapes, 0 to 1.
    pub fn likeness(&self, other: &Whirl) -> f64 {
        self.modal.dotc(&other.modal).norm_sqr()
    }

    pub fn is_forward(&self) -> bool {
        self.direction > 0.0
    }

    /// "forward", "backward" or "planar".
    pub fn turns(&self) -> &'static str {
        match self.direction {
            d if d > 0.5 => "forward",
            d if d < -0.5 => "backward",
            _ => "planar",
        }
    }
}

/// Whirl over speeds: each line is one mode followed from speed to speed by its shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Campbell {
    /// rad/s.
    pub speeds: Vec<f64>,
    /// Ascending by frequency at the last speed; each has one mode for each speed down to where it no longer
    /// oscillates.
    pub lines: Vec<Vec<Whirl>>,
}

impl RotorModel {
    /// The lowest `count` oscillating modes, without relaxation of springs, at spin `speed` (rad/s about X), ascending
    /// by frequency.
    ///
    /// # Errors
    ///
    /// Eigenvalues that do not converge.
    pub fn whirls(&self, speed: f64, count: usize) -> Result<Vec<Whirl>, RotorError> {
        self.motions(speed, count, |value| !self.decays(value))
    }

    fn motions(
        &self,
        speed: f64,
        count: usize,
        which: impl Fn(&Complex<f64>) -> bool,
    ) -> Result<Vec<Whirl>, RotorError> {
        let damping = &self.damping + &self.gyroscopic * speed;
        let stiffness = &self.stiffness + &self.circulating * speed;
        let values = self.eigenvalues(speed, &damping, &stiffness)?;
        let values = values.into_iter().filter(which).enumerate();
        let both = [&damping, &stiffness];
        // For a reversed spin forward is the other circle; −0, where its Campbell lines begin, counts as reversed.
        let side = 1f64.copysign(speed);
        let whirls = values.filter_map(|(number, value)| self.whirl(value, (speed, both), number));
        let whirls = whirls.map(|whirl| Whirl { direction: side * whirl.direction, ..whirl });
        Ok(whirls.take(count).collect())
    }

    /// Returns whether a motion is relaxation of springs or creep of dashpots, slightly rotated by the spin: it decays
    /// faster than it rotates, and has no resonance.
    fn decays(&self, value: &Complex<f64>) -> bool {
        let turns = if self.relaxing.is_empty() { CREEPS } else { 1.0 };
        -value.re > turns * value.im
    }

    /// Eigenvalues of the matrix of (D p, ṗ) and the states of Maxwell elements, with D the natural frequencies:
    /// skew-symmetric without damping, so well scaled. Growth within rounding is set to 0.
    fn eigenvalues(
        &self,
        speed: f64,
        damping: &DMatrix<f64>,
        stiffness: &DMatrix<f64>,
    ) -> Result<Vec<Complex<f64>>, RotorError> {
        let modes = self.natural.len();
        let least = self.natural.iter().copied().find(|&natural| natural > 0.0).unwrap_or(1.0);
        let scale: Vec<f64> =
            self.natural.iter().map(|natural| natural.max(1e-3 * least)).collect();
        let states: usize = self.relaxing.iter().map(Relaxing::states).sum();
        let size = 2 * modes + states;
        let mut state = DMatrix::zeros(size, size);
        let mut first = 2 * modes;
        for of in &self.relaxing {
            of.put(speed, &scale, first, &mut state);
            first += of.states();
        }
        for i in 0..modes {
            state[(i, modes + i)] = scale[i];
            for j in 0..modes {
                state[(modes + i, j)] = -stiffness[(i, j)] / scale[j];
                state[(modes + i, modes + j)] = -damping[(i, j)];
            }
        }
        let state = Mat::from_fn(size, size, |i, j| state[(i, j)]);
        let found = state.eigenvalues().map_err(|_| RotorError::Eigenvalues { speed, size })?;
        let rounding = 2.0 * modes as f64 * f64::EPSILON * state.norm_max();
        let settled = |value: &Complex<f64>| match value.re.abs() <= rounding {
            true => Complex::new(0.0, value.im),
            false => *value,
        };
        let oscillates = |value: &Complex<f64>| value.im > ROUNDING * least;
        let found = found.iter().map(|found| settled(&Complex::new(found.re, found.im)));
        let mut values: Vec<Complex<f64>> = found.filter(oscillates).collect();
        values.sort_by(|a, b| a.im.total_cmp(&b.im));
        Ok(values)
    }

    /// Mode shape of the `number`-th eigenvalue by inverse iteration on λ²I + λ(C + ΩG) + K + ΩS plus the Maxwell
    /// elements at λ. `None` if the motion is relaxation of the springs.
    fn whirl(
        &self,
        value: Complex<f64>,
        (speed, [damping, stiffness]): (f64, [&DMatrix<f64>; 2]),
        number: usize,
    ) -> Option<Whirl> {
        let modes = self.natural.len();
        // Far enough from the eigenvalue for the factors to exist, close enough for two iterations.
        let near = value * Complex::new(1.0 + 1e-11, 1e-11);
        let mut pencil = DMatrix::from_fn(modes, modes, |i, j| {
            let inertia = if i == j { near * near } else { Complex::new(0.0, 0.0) };
            inertia + near * damping[(i, j)] + stiffness[(i, j)]
        });
        self.relaxing.iter().for_each(|of| pencil += of.stiffness_at(near, speed));
        let factors = pencil.lu();
        // Contains both directions of whirl, one more than the other, alternating, so that two modes of one frequency
        // (at rest) differ.
        let start = DVector::from_fn(modes, |i, _| 1.0 + 0.11 * (i % 7) as f64);
        let side = if number.is_multiple_of(2) { -0.9 } else { 0.9 };
        let turned = &self.quarter_turn * &start * side;
        let mut modal = start.zip_map(&turned, Complex::new);
        let mut grown = 0.0;
        for _ in 0..3 {
            let Some(next) = factors.solve(&modal) else { break };
            let norm = next.norm();
            if !(norm.is_finite() && norm > 0.0) {
                break;
            }
            modal = next.unscale(norm);
            grown = norm;
        }
        let moves = self.relaxing.is_empty() || {
            let yielding = self.relaxing.iter().map(|of| of.yielding(near, speed, &modal));
            let oscillates =
                value.re > 0.0 || yielding.sum::<f64>() <= YIELDING * 2.0 * near.norm();
            oscillates && grown * near.norm_sqr() > MOVES
        };
        moves.then(|| self.motion(value, modal))
    }

    /// The mode with the modal combination `modal`.
    pub(crate) fn motion(&self, eigenvalue: Complex<f64>, modal: DVector<Complex<f64>>) -> Whirl {
        let turned = self.quarter_turn.map(|value| Complex::new(value, 0.0)) * &modal;
        let direction = modal.dotc(&turned).im / modal.norm_squared();
        let coordinates = self.basis.map(|value| Complex::new(value, 0.0)) * &modal;
        let largest = |from: usize| {
            let of_station = coordinates.as_slice().chunks_exact(STATION);
            of_station
                .flat_map(|at| [at[from], at[from + 1]])
                .max_by(|a, b| a.norm_sqr().total_cmp(&b.norm_sqr()))
                .unwrap_or(Complex::new(1.0, 0.0))
        };
        let (deflection, turn) = (largest(0), largest(2));
        let by = if deflection.norm() > 1e-9 * turn.norm() { deflection } else { turn };
        let shape = coordinates
            .as_slice()
            .chunks_exact(STATION)
            .map(|at| std::array::from_fn(|i| at[i] / by))
            .collect();
        let across = turned.norm() / modal.norm();
        Whirl { eigenvalue, direction, across, shape, modal }
    }

    /// The `count` lowest modes at the last of `speeds` (rad/s), followed to the other speeds.
    ///
    /// # Errors
    ///
    /// Eigenvalues that do not converge.
    pub fn campbell(&self, speeds: &[f64], count: usize) -> Result<Campbell, RotorError> {
        let mut lines: Vec<Vec<Whirl>> = Vec::new();
        let mut followed = 1;
        for &speed in speeds.iter().rev() {
            if lines.is_empty() {
                lines = self.whirls(speed, count)?.into_iter().map(|whirl| vec![whirl]).collect();
                continue;
            }
            // Lines cross: more candidates than lines, or all if decaying motions are among them.
            let most = if self.relaxing.is_empty() { 2 * count } else { usize::MAX };
            let mut found = self.motions(speed, most, |_| true)?;
            for line in lines.iter_mut().filter(|line| line.len() == followed) {
                let last = line.last().expect("each line has a first mode");
                let best = (0..found.len())
                    .max_by(|&a, &b| last.likeness(&found[a]).total_cmp(&last.likeness(&found[b])));
                if let Some(best) = best.filter(|&best| last.likeness(&found[best]) > ALIKE) {
                    line.push(found.remove(best));
                }
            }
            followed += 1;
        }
        for line in &mut lines {
            line.reverse();
        }
        Ok(Campbell { speeds: speeds.to_vec(), lines })
    }
}

/// Ratio of decay to rotation above which a motion is creep of dashpots: no oscillation is so damped.
const CREEPS: f64 = 1e3;
/// Modes less similar than this are different.
const ALIKE: f64 = 0.1;
/// Ratio of spring relaxation to the motion of masses above which a decaying motion is not reported; growing ones
/// always are.
const YIELDING: f64 = 3.0;
/// At 1e-11 of an eigenvalue the response to a load is about 1e11 times the load over λ²; below this ratio λ is not an
/// eigenvalue of the masses.
const MOVES: f64 = 1e5;

/// A frequency below this fraction of the lowest one with stiffness is rounding of a rigid mode, whose two eigenvalues
/// coincide.
const ROUNDING: f64 = 1e-5;
