//! Springs in series with dashpots (Maxwell elements) in small motions: stiffness at a frequency, and states of their
//! own.
//!
//! With x = L q the displacements along an element's six directions, its spring has the elongation s with ṡ = ẋ − s/τ,
//! and the force Lᵀ k s. An element that rotates with a body at Ω has its rates in rotating axes: ṡ = ẋ − Ω × (x − s) −
//! s/τ. This feeds whirl above a critical speed, as a rotating dashpot does.

use nalgebra::{Complex, DMatrix, DVector, SMatrix};

/// One element of one connection.
#[derive(Clone, Debug, PartialEq)]
pub struct Relaxing {
    /// L: six rows over coordinates.
    pub levers: DMatrix<f64>,
    /// k, N/m and N·m/rad; equal along Y and Z for a rotating element.
    pub stiffness: [f64; 6],
    /// τ, s.
    pub relaxation_time: f64,
    /// Rotation speed Ω as a fraction of the spin.
    pub spin: f64,
}

/// Y and Z of displacements and of rotations.
const PAIRS: [[usize; 2]; 2] = [[1, 2], [4, 5]];

impl Relaxing {
    /// Storage stiffness at `frequency` (rad/s, or infinite) over coordinates, without that of a parallel spring, of an
    /// element that does not rotate or is equal along Y and Z.
    pub fn storage(&self, frequency: f64) -> DMatrix<f64> {
        let turns = (frequency * self.relaxation_time).powi(2);
        let part = if turns.is_finite() { turns / (1.0 + turns) } else { 1.0 };
        let stored = DMatrix::from_fn(6, self.levers.ncols(), |i, j| {
            part * self.stiffness[i] * self.levers[(i, j)]
        });
        self.levers.tr_mul(&stored)
    }

    /// The element over other coordinates, one for each column of `basis`.
    pub(crate) fn over(&self, basis: &DMatrix<f64>) -> Relaxing {
        Relaxing { levers: &self.levers * basis, ..*self }
    }

    /// Directions with stiffness.
    fn directions(&self) -> impl Iterator<Item = usize> + '_ {
        (0..6).filter(|&i| self.stiffness[i] != 0.0 && self.levers.row(i).amax() > 0.0)
    }

    /// Rows of L in directions with stiffness.
    pub(crate) fn pulled(&self) -> impl Iterator<Item = Vec<f64>> + '_ {
        self.directions().map(|i| self.levers.row(i).iter().copied().collect())
    }

    /// Number of its states.
    pub(crate) fn states(&self) -> usize {
        self.directions().count()
    }

    /// Writes its rows and columns into the matrix of (D p, ṗ, …), D = `scale`, at spin `speed`; its states, √k s,
    /// begin at `first`.
    pub(crate) fn put(&self, speed: f64, scale: &[f64], first: usize, state: &mut DMatrix<f64>) {
        let modes = scale.len();
        let mut own = [None; 6];
        for (number, i) in self.directions().enumerate() {
            let at = first + number;
            own[i] = Some(at);
            let root = self.stiffness[i].sqrt();
            for (j, lever) in self.levers.row(i).iter().enumerate() {
                state[(modes + j, at)] = -root * lever;
                state[(at, modes + j)] = root * lever;
            }
            state[(at, at)] = -1.0 / self.relaxation_time;
        }
        let turning = self.spin * speed;
        for [y, z] in PAIRS {
            // Ω × (x − s): each direction takes the displacement of the other.
            for (to, of, turning) in [(y, z, turning), (z, y, -turning)] {
                let Some(at) = own[to].filter(|_| turning != 0.0) else { continue };
                let root = self.stiffness[to].sqrt();
                for (j, lever) in self.levers.row(of).iter().enumerate() {
                    state[(at, j)] += turning * root * lever / scale[j];
                }
                if let Some(other) = own[of] {
                    state[(at, other)] -= turning;
                }
            }
        }
    }

    /// Complex stiffness Lᵀ k Z L of a motion e^{λt} at spin `speed`.
    pub fn stiffness_at(&self, value: Complex<f64>, speed: f64) -> DMatrix<Complex<f64>> {
        let relaxes = 1.0 / self.relaxation_time;
        let follows = |value: Complex<f64>| value / (value + relaxes);
        let mut elongated = SMatrix::<Complex<f64>, 6, 6>::zeros();
        elongated[(0, 0)] = follows(value);
        elongated[(3, 3)] = follows(value);
        let turning = Complex::new(0.0, self.spin * speed);
        // On circles, forward and backward, it is one number each.
        let [forward, backward] = [follows(value - turning), follows(value + turning)];
        for [y, z] in PAIRS {
            let own = (forward + backward) * 0.5;
            let across = Complex::new(0.0, 0.5) * (forward - backward);
            (elongated[(y, y)], elongated[(z, z)]) = (own, own);
            (elongated[(y, z)], elongated[(z, y)]) = (across, -across);
        }
        let levers = self.levers.map(|lever| Complex::new(lever, 0.0));
        let pulls =
            SMatrix::<Complex<f64>, 6, 6>::from_fn(|i, j| elongated[(i, j)] * self.stiffness[i]);
        levers.tr_mul(&(pulls * &levers))
    }

    /// Σ k |dz/dλ| |x|², with z the elongation per displacement x of the springs. Compared with 2 |λ| |p|² of the
    /// masses it is the part of the springs' relaxation in a motion e^{λt} of the modal combination p of norm 1.
    pub(crate) fn yielding(
        &self,
        value: Complex<f64>,
        speed: f64,
        modal: &DVector<Complex<f64>>,
    ) -> f64 {
        let relaxes = 1.0 / self.relaxation_time;
        let slope = |value: Complex<f64>| relaxes / (value + relaxes).norm_sqr();
        let turning = Complex::new(0.0, self.spin * speed);
        let gone = |i: usize| -> Complex<f64> {
            self.levers.row(i).iter().zip(modal.iter()).map(|(lever, p)| p * *lever).sum()
        };
        let along = [0, 3].map(|i| self.stiffness[i] * slope(value) * gone(i).norm_sqr());
        let across = PAIRS.map(|[y, z]| {
            let (in_y, in_z) = (gone(y), gone(z) * Complex::i());
            let circles = slope(value - turning) * (in_y + in_z).norm_sqr()
                + slope(value + turning) * (in_y - in_z).norm_sqr();
            0.25 * (self.stiffness[y] + self.stiffness[z]) * circles
        });
        along.iter().chain(&across).sum()
    }
}

/// The largest fixed point s of `value`: ω² from the stiffness stored at ω². `above` is a value of unrelaxed springs;
/// from there it falls ever more slowly towards the fixed point (the storage of a Maxwell element is concave over ω²),
/// so that secants stay above; a step that overshoots is halved. `None` if there is no fixed point above zero.
///
/// # Errors
///
/// Those of `value`.
/// Those of `value`.
pub(crate) fn settled<E>(
    above: f64,
    mut value: impl FnMut(f64) -> Result<f64, E>,
) -> Result<Option<f64>, E> {
    let mut before = (above, value(above)? - above);
    if before.1.abs() <= SETTLED * above {
        return Ok(Some(above));
    }
    let mut now = (above + before.1, 0.0);
    for _ in 0..ROUNDS {
        let gone = now.0 > NOTHING * above;
        if !gone {
            return Ok(None);
        }
        now.1 = value(now.0)? - now.0;
        // Beyond the fixed point: halve the step, repeatedly.
        while now.1 > SETTLED * now.0 {
            let middle = 0.5 * (now.0 + before.0);
            if before.0 - middle <= SETTLED * middle {
                return Ok(Some(middle));
            }
            now = (middle, value(middle)? - middle);
        }
        let step = now.1 * (now.0 - before.0) / (now.1 - before.1);
        let near = now.1.abs() <= SETTLED * now.0 && step.abs() <= 1e3 * SETTLED * now.0;
        // Close, but no longer approaching: rounding of the value.
        let rounding = now.1.abs() <= ROUNDING * now.0 && now.1.abs() >= before.1.abs();
        if near || step == 0.0 || rounding {
            return Ok(Some(now.0));
        }
        before = now;
        now = (now.0 - if step.is_finite() { step } else { -now.1 }, 0.0);
    }
    Ok(Some(now.0))
}

/// Relative change of s at which the iteration ends, and below which s counts as zero; number of secant steps, a dozen
/// are usual.
const SETTLED: f64 = 1e-13;
const NOTHING: f64 = 1e-13;
/// Relative rounding of a value: of a slow mode among fast ones.
const ROUNDING: f64 = 1e-9;
const ROUNDS: usize = 200;
