//! Lowest natural frequencies and modes of a solid: Lanczos' method on the shifted and inverted problem.

use crate::kinematics::vec3::Vec3;
use crate::numeric::ritz;
use crate::numeric::sparse::{Factor, FactorError, SymmetricMatrix};
use crate::plan::Stage;
use crate::plan::counts::Counts;
use crate::solids::model::SolidModel;
use crate::solids::tangent::{
    MassMatrix, PRESCRIBED, Unknowns, mass, mass_pattern, pattern, stiffness,
};
use nalgebra::{DMatrix, DVectorView};
use std::f64::consts::TAU;
use std::iter::zip;
use thiserror::Error;

/// Choice of modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// This number of the lowest, rigid motions included.
    Lowest(usize),
    /// All up to a frequency (Hz), at most `most`, and the first one beyond.
    UpTo { frequency: f64, most: usize },
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeOptions {
    pub wanted: Wanted,
    pub mass: MassMatrix,
    /// Largest residual ‖K x − λ M x‖ over ‖(λ − shift) M x‖.
    pub tolerance: f64,
}

impl ModeOptions {
    pub fn new(count: usize) -> ModeOptions {
        let wanted = Wanted::Lowest(count);
        ModeOptions { wanted, mass: MassMatrix::Consistent, tolerance: 1e-8 }
    }
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum ModeError {
    #[error(transparent)]
    Factor(#[from] FactorError),
    #[error(
        "{wanted} modes are requested, but the body has only {unknowns} free degrees of freedom"
    )]
    TooMany { wanted: usize, unknowns: usize },
    #[error("the body has more than {most} natural modes up to {frequency} Hz")]
    MoreThan { most: usize, frequency: f64 },
    #[error(
        "only the lowest {found} of the {wanted} natural modes asked for were found to full accuracy, with \
         {vectors} trial vectors; ask for {found} or fewer (modes.count), and check the mesh's worst elements \
         and Poisson's ratio (0.499 or less), which make modes hard to tell apart"
    )]
    NotConverged { found: usize, wanted: usize, vectors: usize },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Hz; zero but for rounding for a rigid motion.
    pub frequency: f64,
    /// Displacement of all nodes, scaled to xᵀ M x = 1 kg.
    pub shape: Vec<Vec3>,
    /// ‖K x − λ M x‖ over ‖(λ − shift) M x‖.
    pub residual: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// Ascending by frequency.
    pub modes: Vec<Mode>,
    pub unknowns: usize,
    /// Solves with the factorised stiffness.
    pub solves: usize,
    /// Number of runs of each stage.
    pub ran: Counts,
}

/// Block size: pairs of equal frequencies and the six rigid motions are then found together, instead of one after the
/// other by rounding.
pub const BLOCK: usize = 6;

/// Relative change of a value from block to block below which its residual is evaluated.
const STILL: f64 = 1e-8;

/// Usual number of solves for `count` modes.
pub fn usual_solves(count: usize) -> usize {
    4 * count + 38
}

/// Lowest modes about the undeformed state.
///
/// The shift is negative, so that the stiffness of a free body can be factorised too: minus the square of the lowest
/// angular frequency that a body of this size can have, about a tenth of shear wave speed over size.
///
/// # Errors
///
/// More modes than unknowns, a mesh in parts without stiffness, no convergence.
pub fn modes(model: &SolidModel, options: &ModeOptions) -> Result<Modes, ModeError> {
    modes_over(model, &Unknowns::new(model), options)
}

/// Largest number of entries of additional trial vectors, half a gigabyte with their images.
const FREE_TRIALS: usize = 30_000_000;
const MOST_TRIALS: usize = 400;

/// The same over given unknowns.
///
/// # Errors
///
/// See [`modes`].
pub fn modes_over(
    model: &SolidModel,
    unknowns: &Unknowns,
    options: &ModeOptions,
) -> Result<Modes, ModeError> {
    FreeFactor::new(model, unknowns, options.mass)?.modes(model, unknowns, options)
}

/// Factors of K − shift M of a solid that may be free, with `shift` < 0.
pub(crate) struct FreeFactor {
    matrix: SymmetricMatrix,
    pub masses: SymmetricMatrix,
    pub factor: Factor,
    /// (rad/s)².
    pub shift: f64,
}

impl FreeFactor {
    /// # Errors
    ///
    /// A mesh in parts without stiffness; no memory.
    pub fn new(
        model: &SolidModel,
        unknowns: &Unknowns,
        mass: MassMatrix,
    ) -> Result<FreeFactor, FactorError> {
        let shift = shift(model);
        let [mut matrix, masses] = matrices(model, unknowns, mass);
        matrix.add_scaled(-shift, &masses);
        let factor = unknowns.factor(&matrix)?;
        Ok(FreeFactor { matrix, masses, factor, shift })
    }

    /// See [`modes_over`].
    pub fn modes(
        &self,
        model: &SolidModel,
        unknowns: &Unknowns,
        options: &ModeOptions,
    ) -> Result<Modes, ModeError> {
        let FreeFactor { matrix, masses, factor, shift } = self;
        search(model, unknowns, &Shifted { matrix, masses, factor, shift: *shift }, options)
    }
}

/// The same for a solid with supports, with the factors of its undeformed stiffness.
///
/// # Errors
///
/// See [`modes`].
pub fn modes_of_fixed(
    model: &SolidModel,
    unknowns: &Unknowns,
    factor: &Factor,
    options: &ModeOptions,
) -> Result<Modes, ModeError> {
    let [stiffness, masses] = matrices(model, unknowns, options.mass);
    search(
        model,
        unknowns,
        &Shifted { matrix: &stiffness, masses: &masses, factor, shift: 0.0 },
        options,
    )
}

/// Stiffness about the undeformed state, and mass.
fn matrices(model: &SolidModel, unknowns: &Unknowns, kind: MassMatrix) -> [SymmetricMatrix; 2] {
    let mut masses = mass_pattern(&model.problem, unknowns);
    mass(model, unknowns, kind, &mut masses);
    let mut undeformed = pattern(&model.problem, unknowns);
    stiffness(model, unknowns, &vec![[0.0; 3]; model.mass.len()], &mut undeformed);
    [undeformed, masses]
}

/// K − shift M, its factors, and M.
struct Shifted<'a> {
    matrix: &'a SymmetricMatrix,
    masses: &'a SymmetricMatrix,
    factor: &'a Factor,
    shift: f64,
}

fn search(
    model: &SolidModel,
    unknowns: &Unknowns,
    of: &Shifted,
    options: &ModeOptions,
) -> Result<Modes, ModeError> {
    let size = unknowns.count;
    if let Wanted::Lowest(wanted) = options.wanted
        && wanted > size
    {
        return Err(ModeError::TooMany { wanted, unknowns: size });
    }
    let shift = of.shift;
    let mut krylov = Krylov::new(of.masses, of.factor);
    krylov.start(size.min(BLOCK));
    let (mut before, mut looked, mut count) = (Vec::new(), 0, 1);
    loop {
        if let Wanted::Lowest(wanted) = options.wanted {
            count = wanted;
        }
        // Short thick bodies have many close modes; a small one may take more trials.
        let most =
            |count: usize| (4 * count + 60).max((FREE_TRIALS / size).min(MOST_TRIALS)).min(size);
        // A Rayleigh–Ritz step costs the cube of the basis, a block little: large bases take one after a growth by a
        // fraction.
        if krylov.basis.len() < looked + looked / 16 && krylov.grow(most(count)) {
            continue;
        }
        looked = krylov.basis.len();
        // Residuals are evaluated once the values are constant: these converge twice as fast as the vectors.
        let mut values = krylov.largest();
        if let Wanted::UpTo { frequency, most } = options.wanted {
            // Values fall as the space grows.
            let limit = (TAU * frequency).powi(2);
            let within = values.iter().filter(|&&inverse| shift + 1.0 / inverse <= limit).count();
            if within > most {
                return Err(ModeError::MoreThan { most, frequency });
            }
            count = (within + 1).min(size);
        }
        let most = most(count);
        values.truncate(count);
        let still = |(now, old): (&f64, &f64)| (now - old).abs() <= STILL * now.abs();
        let settling = before.len() == values.len() && values.iter().zip(&before).all(still);
        let last = krylov.basis.len() >= most;
        before = values;
        if !settling && !last && krylov.grow(most) {
            continue;
        }
        let found = krylov.ritz(count);
        let checked: Vec<_> = found
            .into_iter()
            .map(|(vector, inverse)| {
                let value = shift + 1.0 / inverse;
                let residual = of.residual(&vector, value);
                (value, vector, residual)
            })
            .collect();
        let settled = checked.iter().filter(|mode| mode.2 <= options.tolerance).count();
        let solves = krylov.solves;
        if settled >= count {
            let mut modes: Vec<Mode> = checked
                .into_iter()
                .map(|(value, vector, residual)| Mode {
                    frequency: value.max(0.0).sqrt() / TAU,
                    shape: spread(unknowns, &vector),
                    residual,
                })
                .collect();
            modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
            let mut ran = Counts::default();
            ran.add(Stage::Elements, model.problem.elements.len() as u64);
            ran.add(Stage::Supports, unknowns.held() as u64);
            ran.add(Stage::Modes, modes.len() as u64);
            return Ok(Modes { modes, unknowns: size, solves, ran });
        }
        if krylov.basis.len() >= most || !krylov.grow(most) {
            return Err(ModeError::NotConverged {
                found: settled,
                wanted: count,
                vectors: krylov.basis.len(),
            });
        }
    }
}

fn shift(model: &SolidModel) -> f64 {
    let problem = &model.problem;
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for node in &problem.nodes {
        for i in 0..3 {
            low[i] = low[i].min(node[i]);
            high[i] = high[i].max(node[i]);
        }
    }
    let size = (0..3).map(|i| (high[i] - low[i]).powi(2)).sum::<f64>();
    -0.1 * problem.material.shear_modulus / (problem.density * size)
}

pub(crate) fn spread(unknowns: &Unknowns, vector: &[f64]) -> Vec<Vec3> {
    let at = |index: usize| if index == PRESCRIBED { 0.0 } else { vector[index] };
    unknowns.of.iter().map(|of| of.map(at)).collect()
}

impl Shifted<'_> {
    /// With K − shift M: (K − λ M) x differs by (λ − shift) M x.
    fn residual(&self, vector: &[f64], value: f64) -> f64 {
        let beyond = value - self.shift;
        let mut force = vec![0.0; vector.len()];
        let mut momentum = vec![0.0; vector.len()];
        self.matrix.multiply(vector, &mut force);
        self.masses.multiply(vector, &mut momentum);
        let (mut gap, mut scale) = (0.0, 0.0);
        for (force, momentum) in force.iter().zip(&momentum) {
            gap += (force - beyond * momentum).powi(2);
            scale += (beyond * momentum).powi(2);
        }
        (gap / scale).sqrt()
    }
}

/// The Krylov space of the inverse, orthonormal under the mass.
struct Krylov<'a> {
    masses: &'a SymmetricMatrix,
    factor: &'a Factor,
    basis: Vec<Vec<f64>>,
    /// Inverse times mass times each vector of the last block.
    images: Vec<Vec<f64>>,
    /// basisᵀ · mass · image.
    projected: DMatrix<f64>,
    solves: usize,
}

/// Eight parallel sums, for the processor's vector units.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// Entries of vectors processed at a time: those of a block and of one basis vector fit into the nearest cache.
const PART: usize = 512;

/// Products of each of `basis` with each of `others`.
fn products(basis: &[Vec<f64>], others: &[Vec<f64>]) -> DMatrix<f64> {
    let mut sums = DMatrix::zeros(basis.len(), others.len());
    let size = others.first().map_or(0, Vec::len);
    for part in (0..size).step_by(PART).map(|first| first..(first + PART).min(size)) {
        for (row, known) in basis.iter().enumerate() {
            for (column, other) in others.iter().enumerate() {
                sums[(row, column)] += dot(&known[part.clone()], &other[part.clone()]);
            }
        }
    }
    sums
}

/// Subtracts from each of `others` its components along `basis`.
fn take_away(basis: &[Vec<f64>], shares: &DMatrix<f64>, others: &mut [Vec<f64>]) {
    let size = others.first().map_or(0, Vec::len);
    for part in (0..size).step_by(PART).map(|first| first..(first + PART).min(size)) {
        for (row, known) in basis.iter().enumerate() {
            for (column, other) in others.iter_mut().enumerate() {
                add_times(&mut other[part.clone()], -shares[(row, column)], &known[part.clone()]);
            }
        }
    }
}

fn add_times(to: &mut [f64], factor: f64, of: &[f64]) {
    to.iter_mut().zip(of).for_each(|(to, of)| *to += factor * of);
}

impl<'a> Krylov<'a> {
    fn new(masses: &'a SymmetricMatrix, factor: &'a Factor) -> Self {
        Krylov {
            masses,
            factor,
            basis: Vec::new(),
            images: Vec::new(),
            projected: DMatrix::zeros(0, 0),
            solves: 0,
        }
    }

    /// Random vectors from a fixed seed.
    fn start(&mut self, count: usize) {
        let mut seed = 0x2545_f491_4f6c_dd1d_u64;
        let mut random = || {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let size = self.masses.size();
        let vectors = (0..count).map(|_| (0..size).map(|_| random()).collect()).collect();
        self.take(vectors);
    }

    /// Adds the new directions of some vectors; returns whether there were any. One pass through the factors, and one
    /// through the basis for each operation, serve all of them.
    fn take(&mut self, vectors: Vec<Vec<f64>>) -> bool {
        let (size, known) = (self.masses.size(), self.basis.len());
        let (vectors, momenta) = self.orthonormal(vectors);
        if vectors.is_empty() {
            return false;
        }
        let mut right = momenta.concat();
        drop(momenta);
        self.basis.extend(vectors);
        let count = self.basis.len();
        self.factor.solve_columns(&mut right, count - known);
        self.solves += count - known;
        self.images = right.chunks_exact(size).map(<[f64]>::to_vec).collect();
        drop(right);
        let old = std::mem::replace(&mut self.projected, DMatrix::zeros(count, count));
        self.projected.view_mut((0, 0), (known, known)).copy_from(&old);
        let new = products(&self.basis, &self.momenta(&self.images));
        for (column, of) in (known..count).zip(new.column_iter()) {
            for (row, value) in of.iter().take(column + 1).enumerate() {
                self.projected[(row, column)] = *value;
                self.projected[(column, row)] = *value;
            }
        }
        true
    }

    fn momenta(&self, vectors: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let of = |vector: &Vec<f64>| {
            let mut momentum = vec![0.0; vector.len()];
            self.masses.multiply(vector, &mut momentum);
            momentum
        };
        vectors.iter().map(of).collect()
    }

    /// New directions of some vectors, orthonormal under the mass, and their momenta.
    fn orthonormal(&self, mut vectors: Vec<Vec<f64>>) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let mut momenta = self.momenta(&vectors);
        // Twice is enough (Kahan, Parlett).
        for _ in 0..2 {
            let whole = zip(&vectors, &momenta).map(|(v, m)| dot(v, m).sqrt()).collect::<Vec<_>>();
            take_away(&self.basis, &products(&self.basis, &momenta), &mut vectors);
            momenta = self.momenta(&vectors);
            let rest = zip(zip(vectors, momenta), whole);
            (vectors, momenta) = (Vec::new(), Vec::new());
            for ((mut vector, mut momentum), whole) in rest {
                for (known, its_momentum) in zip(&vectors, &momenta) {
                    let share = dot(known, &momentum);
                    add_times(&mut vector, -share, known);
                    add_times(&mut momentum, -share, its_momentum);
                }
                let length = dot(&vector, &momentum).sqrt();
                if length.is_nan() || length <= 1e-12 * whole {
                    continue;
                }
                vector.iter_mut().chain(&mut momentum).for_each(|x| *x /= length);
                vectors.push(vector);
                momenta.push(momentum);
            }
        }
        (vectors, momenta)
    }

    /// Adds a block; returns whether the space grew.
    fn grow(&mut self, most: usize) -> bool {
        let mut images = std::mem::take(&mut self.images);
        images.truncate(most - self.basis.len().min(most));
        self.take(images)
    }

    /// Eigenvalues of the inverse within the space, largest first.
    fn largest(&self) -> Vec<f64> {
        let mut values = self.projected.clone().symmetric_eigenvalues().as_slice().to_vec();
        values.sort_by(|a, b| b.total_cmp(a));
        values
    }

    /// The best approximations of the eigenvectors with the largest eigenvalues of the inverse.
    fn ritz(&self, wanted: usize) -> Vec<(Vec<f64>, f64)> {
        let (values, vectors) = ritz::sorted(self.projected.clone(), |a, b| b.total_cmp(a));
        let whole = |(shares, value): (DVectorView<f64>, f64)| {
            let mut vector = vec![0.0; self.masses.size()];
            for (basis, share) in self.basis.iter().zip(shares.iter()) {
                add_times(&mut vector, *share, basis);
            }
            (vector, value)
        };
        vectors.column_iter().zip(values).take(wanted).map(whole).collect()
    }
}
