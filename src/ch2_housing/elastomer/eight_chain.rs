//! Compressible eight-chain network of Arruda and Boyce (2.8–2.12), (3.1–3.7).
//!
//! The energy is a function of Ī₁ plus a function of J, so that stress and tangent split into a deviatoric part (DEV S,
//! which drives the Maxwell elements) and a volumetric part. With dev E = E − tr(E)/3 the factor 1 − (I₁/3) C⁻¹ of
//! (2.12) is 2 dev(E) C⁻¹, and Ī₁ − 3 follows from invariants of dev E: full precision at small strain.

use super::ElastomerError;
use super::langevin;
use crate::kinematics::number::Number;
use crate::kinematics::strain::{
    Mat3, Sym3, Tangent, determinant, double_dot, full, volume_change,
};

/// Evaluation of the chain force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChainPull {
    /// The five-term series of the dissertation.
    #[default]
    FiveTerms,
    /// Inverse Langevin function, which the series approximates; an error beyond the locking stretch.
    Exact,
}

/// Constants of the eight-chain network.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EightChain {
    /// C_R, Pa.
    pub modulus: f64,
    /// N: the chains are straight at √(Ī₁/3) = √N.
    pub locking: f64,
    /// B, Pa.
    pub bulk: f64,
    pub pull: ChainPull,
}

/// Coefficients of (2.8): factors of Ī₁ᵏ/Nᵏ⁻¹ for k = 1 to 5.
pub(super) const SERIES: [f64; 5] =
    [1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0];

/// Strain measures for stress and tangent.
struct Strained {
    /// C⁻¹.
    inverse: Sym3,
    /// Π = 1 − (I₁/3) C⁻¹.
    projected: Sym3,
    /// I₁ = tr C (2.10), (3.3).
    first_invariant: f64,
    /// J^(−2/3).
    isochoric: f64,
    /// Ī₁ − 3, with Ī₁ = J^(−2/3) I₁ (2.9), (3.2).
    excess: f64,
    /// J − 1.
    volume_change: f64,
}

impl Strained {
    fn of(strain: &Sym3) -> Result<Strained, ElastomerError> {
        let e = strain;
        let third = (e[0] + e[1] + e[2]) / 3.0;
        let deviator = [e[0] - third, e[1] - third, e[2] - third, e[3], e[4], e[5]];
        let mean = 1.0 + 2.0 * third;
        // C = mean (1 + D) with D = 2 dev E/mean, so that det C = mean³ (1 − q).
        let scaled = deviator.map(|x| 2.0 * x / mean);
        let q = 0.5 * double_dot(&scaled, &scaled) - determinant(&full(&scaled));
        let det = mean * mean * mean * (1.0 - q);
        let sound = mean > 0.0 && det > 0.0;
        if !sound {
            return Err(ElastomerError::NoDeformation(det));
        }
        let root = libm::cbrt(1.0 - q);
        let twice: Mat3 = full(&e.map(|x| 2.0 * x));
        let squares = volume_change(&twice);
        let inverse = inverse_of(e, det);
        Ok(Strained {
            projected: commuting_product(&deviator, &inverse).map(|x| 2.0 * x),
            inverse,
            first_invariant: 3.0 * mean,
            isochoric: 1.0 / (mean * root),
            excess: 3.0 * q / (root * (1.0 + root + root * root)),
            volume_change: squares / (1.0 + det.sqrt()),
        })
    }
}

/// C⁻¹ of C = 1 + 2E; `det` is det C.
fn inverse_of(e: &Sym3, det: f64) -> Sym3 {
    let c =
        [1.0 + 2.0 * e[0], 1.0 + 2.0 * e[1], 1.0 + 2.0 * e[2], 2.0 * e[3], 2.0 * e[4], 2.0 * e[5]];
    let per = 1.0 / det;
    [
        (c[1] * c[2] - c[4] * c[4]) * per,
        (c[2] * c[0] - c[5] * c[5]) * per,
        (c[0] * c[1] - c[3] * c[3]) * per,
        (c[4] * c[5] - c[2] * c[3]) * per,
        (c[5] * c[3] - c[0] * c[4]) * per,
        (c[3] * c[4] - c[1] * c[5]) * per,
    ]
}

/// Product of two symmetric tensors with the same principal axes; it is symmetric.
fn commuting_product(a: &Sym3, b: &Sym3) -> Sym3 {
    let (a, b) = (full(a), full(b));
    let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    // Averaging makes the rounded product exactly symmetric.
    let half = |i: usize, j: usize| 0.5 * (entry(i, j) + entry(j, i));
    [entry(0, 0), entry(1, 1), entry(2, 2), half(0, 1), half(1, 2), half(2, 0)]
}

/// Indices of the components of a [`Sym3`].
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]];

/// Adds factor · C⁻¹ ⊙ C⁻¹, which maps dE to C⁻¹ dE C⁻¹.
fn add_inverse_square(tangent: &mut Tangent, factor: f64, inverse: &Sym3) {
    let c = full(inverse);
    for (row, [i, j]) in tangent.iter_mut().zip(PAIRS) {
        for (entry, [k, l]) in row.iter_mut().zip(PAIRS) {
            *entry += 0.5 * factor * (c[i][k] * c[j][l] + c[i][l] * c[j][k]);
        }
    }
}

impl EightChain {
    /// Network from C_R (Pa), N and B (Pa).
    ///
    /// # Errors
    /// If a constant is not positive, or N ≤ 1 with [`ChainPull::Exact`].
    pub fn new(
        modulus: f64,
        locking: f64,
        bulk: f64,
        pull: ChainPull,
    ) -> Result<EightChain, ElastomerError> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        if !positive(modulus) {
            return Err(ElastomerError::Modulus(modulus));
        }
        if !positive(locking) {
            return Err(ElastomerError::Locking(locking));
        }
        if !positive(bulk) {
            return Err(ElastomerError::Bulk(bulk));
        }
        if pull == ChainPull::Exact && locking <= 1.0 {
            return Err(ElastomerError::LockedAtRest(locking));
        }
        Ok(EightChain { modulus, locking, bulk, pull })
    }

    /// ∂W/∂Ī₁ divided by C_R, and its derivative, at Ī₁ = 3 + `excess`.
    fn slope(&self, excess: f64) -> Result<[f64; 2], ElastomerError> {
        let (invariant, per) = (3.0 + excess, 1.0 / self.locking);
        match self.pull {
            ChainPull::FiveTerms => {
                let x = invariant * per;
                let [a, b, c, d, e] = SERIES;
                let slope = a + x * (2.0 * b + x * (3.0 * c + x * (4.0 * d + x * 5.0 * e)));
                let bend = per * (2.0 * b + x * (6.0 * c + x * (12.0 * d + x * 20.0 * e)));
                Ok([slope, bend])
            }
            ChainPull::Exact => {
                // Chain stretch divided by the stretch at which the chain is straight.
                let x = (invariant * per / 3.0).sqrt();
                let short = x < 1.0;
                if !short {
                    let (stretch, limit) = ((invariant / 3.0).sqrt(), self.locking.sqrt());
                    return Err(ElastomerError::Locked { stretch, limit });
                }
                let [beta, rate] = langevin::inverse(x);
                // Derivative of β/(6x) by Ī₁, with dx/dĪ₁ = x/(2 Ī₁).
                Ok([beta / (6.0 * x), (rate - beta / x) / (12.0 * invariant)])
            }
        }
    }

    /// Chain energy divided by C_R at Ī₁ = 3 + `excess`; zero at rest.
    fn chain_energy(&self, excess: f64) -> Result<f64, ElastomerError> {
        match self.pull {
            ChainPull::FiveTerms => {
                // Ī₁ᵏ − 3ᵏ as (Ī₁ − 3) (Ī₁ᵏ⁻¹ + 3 Ī₁ᵏ⁻² + …), each power from the one before.
                let (invariant, per) = (3.0 + excess, 1.0 / self.locking);
                let (mut sum, mut powers, mut three, mut scale) = (0.0, 1.0, 1.0, 1.0);
                for coefficient in SERIES {
                    sum += coefficient * scale * powers;
                    three *= 3.0;
                    powers = powers * invariant + three;
                    scale *= per;
                }
                Ok(excess * sum)
            }
            // The difference of energies below would lose digits. Three-point Gauss quadrature, of degree 5, has an
            // error of order excess⁶.
            ChainPull::Exact if excess < 3e-3 => {
                let root = 0.6f64.sqrt();
                let mut sum = 0.0;
                for (place, weight) in [(-root, 5.0), (0.0, 8.0), (root, 5.0)] {
                    sum += weight / 18.0 * self.slope(0.5 * excess * (1.0 + place))?[0];
                }
                Ok(excess * sum)
            }
            ChainPull::Exact => {
                self.slope(excess)?;
                let energy = |invariant: f64| {
                    let x = (invariant / (3.0 * self.locking)).sqrt();
                    let beta = langevin::inverse(x)[0];
                    self.locking * (x * beta + langevin::log_of_ratio(beta))
                };
                Ok(energy(3.0 + excess) - energy(3.0))
            }
        }
    }

    /// Shear modulus μ at rest, Pa.
    pub fn shear_modulus(&self) -> f64 {
        // No chain is straight at rest; checked in `new`.
        2.0 * self.modulus * self.slope(0.0).map_or(f64::NAN, |[slope, _]| slope)
    }

    /// Chain length divided by its straight length, √(Ī₁/(3N)).
    ///
    /// # Errors
    /// If det C is not positive.
    pub fn chain_length(&self, strain: &Sym3) -> Result<f64, ElastomerError> {
        let invariant = 3.0 + Strained::of(strain)?.excess;
        Ok((invariant / (3.0 * self.locking)).sqrt())
    }

    /// Chain energy, J/m³: (2.8) without its last term.
    ///
    /// # Errors
    /// If det C is not positive; with [`ChainPull::Exact`], also beyond the locking stretch.
    pub fn isochoric_energy(&self, strain: &Sym3) -> Result<f64, ElastomerError> {
        Ok(self.modulus * self.chain_energy(Strained::of(strain)?.excess)?)
    }

    /// Volumetric energy of a volume change J − 1, J/m³: the last term of (2.8).
    pub fn volume_energy(&self, change: f64) -> f64 {
        0.5 * self.bulk * change * change
    }

    /// Mean Cauchy stress of a volume change J − 1, Pa.
    #[inline(always)]
    pub fn mean_stress<T: Number>(&self, change: T) -> T {
        T::of(self.bulk) * change
    }

    /// Strain energy per undeformed volume (2.8), J/m³.
    ///
    /// # Errors
    /// See [`EightChain::isochoric_energy`].
    pub fn energy_density(&self, strain: &Sym3) -> Result<f64, ElastomerError> {
        let at = Strained::of(strain)?;
        Ok(self.modulus * self.chain_energy(at.excess)? + self.volume_energy(at.volume_change))
    }

    /// DEV S, the first term of (2.12), Pa: S minus its part along C⁻¹.
    ///
    /// # Errors
    /// See [`EightChain::isochoric_energy`].
    #[inline]
    pub fn isochoric_stress(&self, strain: &Sym3) -> Result<Sym3, ElastomerError> {
        let at = Strained::of(strain)?;
        let [slope, _] = self.slope(at.excess)?;
        let factor = 2.0 * self.modulus * slope * at.isochoric;
        Ok(at.projected.map(|x| factor * x))
    }

    /// DEV S and its derivative by the strain, Pa.
    ///
    /// # Errors
    /// See [`EightChain::isochoric_energy`].
    pub fn isochoric_tangent(&self, strain: &Sym3) -> Result<(Sym3, Tangent), ElastomerError> {
        let at = Strained::of(strain)?;
        let [slope, bend] = self.slope(at.excess)?;
        let factor = 2.0 * self.modulus * slope * at.isochoric;
        let stiffening = 4.0 * self.modulus * bend * at.isochoric * at.isochoric;
        let (p, c) = (&at.projected, &at.inverse);
        const ONE: Sym3 = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
        let mut tangent = [[0.0; 6]; 6];
        for a in 0..6 {
            for b in 0..6 {
                tangent[a][b] =
                    stiffening * p[a] * p[b] - 2.0 / 3.0 * factor * (p[a] * c[b] + c[a] * ONE[b]);
            }
        }
        add_inverse_square(&mut tangent, 2.0 / 3.0 * factor * at.first_invariant, c);
        Ok((p.map(|x| factor * x), tangent))
    }

    /// Second Piola–Kirchhoff stress (2.12), Pa.
    ///
    /// # Errors
    /// See [`EightChain::isochoric_energy`].
    pub fn second_piola_kirchhoff(&self, strain: &Sym3) -> Result<Sym3, ElastomerError> {
        let at = Strained::of(strain)?;
        let [slope, _] = self.slope(at.excess)?;
        let factor = 2.0 * self.modulus * slope * at.isochoric;
        let volume = (1.0 + at.volume_change) * self.mean_stress(at.volume_change);
        Ok(std::array::from_fn(|i| factor * at.projected[i] + volume * at.inverse[i]))
    }

    /// Second Piola–Kirchhoff stress and its derivative by the strain, Pa.
    ///
    /// # Errors
    /// See [`EightChain::isochoric_energy`].
    pub fn tangent(&self, strain: &Sym3) -> Result<(Sym3, Tangent), ElastomerError> {
        let (_, mut tangent) = self.isochoric_tangent(strain)?;
        let at = Strained::of(strain)?;
        let ratio = 1.0 + at.volume_change;
        let volume = ratio * self.mean_stress(at.volume_change);
        let along = self.bulk * ratio * (ratio + at.volume_change);
        for a in 0..6 {
            for b in 0..6 {
                tangent[a][b] += along * at.inverse[a] * at.inverse[b];
            }
        }
        add_inverse_square(&mut tangent, -2.0 * volume, &at.inverse);
        Ok((self.second_piola_kirchhoff(strain)?, tangent))
    }
}
