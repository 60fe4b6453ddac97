//! Springs in series with dashpots (Maxwell elements) in small motions: their stiffness at a frequency, and states of their own.
//!
//! With x = L q how far an element's ends have gone along its six directions, its spring is elongated by s: ṡ = ẋ − s/τ, and pulls by
//! Lᵀ k s. One that turns with a body at Ω feels rates in the axes that turn: ṡ = ẋ − Ω × (x − s) − s/τ, which feeds whirl above a
//! critical speed as a dashpot that turns does.

use nalgebra::{Complex, DMatrix, DVector, SMatrix};

/// One element of one connection.
#[derive(Clone, Debug, PartialEq)]
pub struct Relaxing {
    /// L: six rows, over coordinates.
    pub levers: DMatrix<f64>,
    /// k, N/m and N·m/rad; of one that turns alike along Y and Z.
    pub stiffness: [f64; 6],
    /// τ, s.
    pub relaxation_time: f64,
    /// Ω over the speed that is asked for.
    pub spin: f64,
}

/// Y and Z of displacements and of turns.
const PAIRS: [[usize; 2]; 2] = [[1, 2], [4, 5]];

impl Relaxing {
    /// What it stores of an oscillation at `frequency` (rad/s, or infinite) beside what the spring beside it does, over coordinates;
    /// of what stands still or turns alike.
    pub fn storage(&self, frequency: f64) -> DMatrix<f64> {
        let turns = (frequency * self.relaxation_time).powi(2);
        let part = if turns.is_finite() { turns / (1.0 + turns) } else { 1.0 };
        let stored = DMatrix::from_fn(6, self.levers.ncols(), |i, j| {
            part * self.stiffness[i] * self.levers[(i, j)]
        });
        self.levers.tr_mul(&stored)
    }

    /// The same over other coordinates, of which each column of `basis` is one.
    pub(crate) fn over(&self, basis: &DMatrix<f64>) -> Relaxing {
        Relaxing { levers: &self.levers * basis, ..*self }
    }

    /// Directions in which it pulls.
    fn directions(&self) -> impl Iterator<Item = usize> + '_ {
        (0..6).filter(|&i| self.stiffness[i] != 0.0 && self.levers.row(i).amax() > 0.0)
    }

    /// L's rows of the directions in which it pulls.
    pub(crate) fn pulled(&self) -> impl Iterator<Item = Vec<f64>> + '_ {
        self.directions().map(|i| self.levers.row(i).iter().copied().collect())
    }

    /// How many states it has.
    pub(crate) fn states(&self) -> usize {
        self.directions().count()
    }

    /// Writes its rows and columns into the matrix of (D p, ṗ, …), D = `scale`, at speed `speed`; its states, √k s, begin at `first`.
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
            // Ω × (x − s) of the one is what the other has gone.
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

    /// Complex stiffness Lᵀ k Z L of a motion e^{λt} at speed `speed`.
    pub fn stiffness_at(&self, value: Complex<f64>, speed: f64) -> DMatrix<Complex<f64>> {
        let relaxes = 1.0 / self.relaxation_time;
        let follows = |value: Complex<f64>| value / (value + relaxes);
        let mut elongated = SMatrix::<Complex<f64>, 6, 6>::zeros();
        elongated[(0, 0)] = follows(value);
        elongated[(3, 3)] = follows(value);
        let turning = Complex::new(0.0, self.spin * speed);
        // On circles either way it is one number each.
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

    /// Σ k |dz/dλ| |x|², z the part of x that its springs are elongated by: beside 2 |λ| |p|² of what has mass, whose rates these are, it
    /// says how much of a motion e^{λt} of the natural ones' combination p, of norm 1, is the springs' own relaxing.
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

/// The largest s at which `value` is s: ω² that a stiffness gives, as a function of the ω² at which springs store it. `above` is a
/// value of springs that have not relaxed, below which it falls slower and slower towards it (the storage of a Maxwell element is concave
/// over ω²), so that secants stay above; where one does not its step is halved. [`None`] where it comes down to nothing.
///
/// # Errors
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
        // Past it: half way back, as often as it takes.
        while now.1 > SETTLED * now.0 {
            let middle = 0.5 * (now.0 + before.0);
            if before.0 - middle <= SETTLED * middle {
                return Ok(Some(middle));
            }
            now = (middle, value(middle)? - middle);
        }
        let step = now.1 * (now.0 - before.0) / (now.1 - before.1);
        let near = now.1.abs() <= SETTLED * now.0 && step.abs() <= 1e3 * SETTLED * now.0;
        // What is near and comes no nearer is rounding of the value.
        let rounding = now.1.abs() <= ROUNDING * now.0 && now.1.abs() >= before.1.abs();
        if near || step == 0.0 || rounding {
            return Ok(Some(now.0));
        }
        before = now;
        now = (now.0 - if step.is_finite() { step } else { -now.1 }, 0.0);
    }
    Ok(Some(now.0))
}

/// Part by which s still changes once it has settled, and below which, of what it was, it is nothing; rounds of secants, a dozen are
/// usual.
const SETTLED: f64 = 1e-13;
const NOTHING: f64 = 1e-13;
/// Part of s to which a value may be rounded: a slow motion's among fast ones.
const ROUNDING: f64 = 1e-9;
const ROUNDS: usize = 200;
