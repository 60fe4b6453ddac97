//! Linear elastic law of steel parts (2.2.2): second Piola–Kirchhoff stress linear in the Green–Lagrange strain.

use crate::kinematics::number::Number;
use crate::kinematics::strain::Sym3;
use thiserror::Error;

/// Isotropic St. Venant–Kirchhoff solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearElastic {
    /// Lamé's first parameter, Pa.
    pub lambda: f64,
    /// Shear modulus, Pa.
    pub shear_modulus: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ElasticError {
    #[error("Young's modulus is {0} Pa; it must be positive and finite")]
    YoungsModulus(f64),
    #[error(
        "Poisson's ratio is {0}; it must lie between -1 and 0.5, both excluded: at 0.5 a solid \
         cannot change its volume"
    )]
    PoissonRatio(f64),
}

impl LinearElastic {
    /// From Young's modulus (Pa) and Poisson's ratio.
    ///
    /// # Errors
    /// If the modulus is not positive or the ratio is outside (−1, ½).
    pub fn new(youngs_modulus: f64, poisson_ratio: f64) -> Result<LinearElastic, ElasticError> {
        if !(youngs_modulus > 0.0 && youngs_modulus.is_finite()) {
            return Err(ElasticError::YoungsModulus(youngs_modulus));
        }
        if !(poisson_ratio > -1.0 && poisson_ratio < 0.5) {
            return Err(ElasticError::PoissonRatio(poisson_ratio));
        }
        Ok(LinearElastic {
            lambda: youngs_modulus * poisson_ratio
                / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio)),
            shear_modulus: 0.5 * youngs_modulus / (1.0 + poisson_ratio),
        })
    }

    /// ν.
    pub fn poisson_ratio(&self) -> f64 {
        0.5 * self.lambda / (self.lambda + self.shear_modulus)
    }

    /// E, Pa.
    pub fn youngs_modulus(&self) -> f64 {
        2.0 * self.shear_modulus * (1.0 + self.poisson_ratio())
    }

    /// Second Piola–Kirchhoff stress (2.4): S = E/(1+ν)·(E + ν/(1−2ν)·tr(E) 1), Pa.
    #[inline(always)]
    pub fn second_piola_kirchhoff<T: Number>(&self, strain: &Sym3<T>) -> Sym3<T> {
        let double = T::of(2.0 * self.shear_modulus);
        let pressure = T::of(self.lambda) * (strain[0] + strain[1] + strain[2]);
        [
            double * strain[0] + pressure,
            double * strain[1] + pressure,
            double * strain[2] + pressure,
            double * strain[3],
            double * strain[4],
            double * strain[5],
        ]
    }

    /// Strain energy per undeformed volume, J/m³; its derivative is (2.4).
    pub fn energy_density(&self, strain: &Sym3) -> f64 {
        let trace = strain[0] + strain[1] + strain[2];
        let squares: f64 = strain[..3].iter().map(|e| e * e).sum::<f64>()
            + 2.0 * strain[3..].iter().map(|e| e * e).sum::<f64>();
        0.5 * self.lambda * trace * trace + self.shear_modulus * squares
    }
}
