//! A bar or cube of rubber under homogeneous tension or compression, free at its sides: one material point.

use crate::ch2_housing::elastomer::Elastomer;
use crate::ch2_housing::elastomer::maxwell::{StepFactors, commit, relaxed_history};
use crate::kinematics::strain::Sym3;
use crate::solids::error::{SolidError, StepFailure};

/// The bar after an accepted step; axis X.
#[derive(Clone, Debug)]
pub struct Bar<'a> {
    material: &'a Elastomer,
    pub time: f64,
    /// Stretch less one, along and across.
    pub axial: f64,
    pub lateral: f64,
    /// Cauchy stress along the axis, Pa.
    pub stress: f64,
    deviatoric: Sym3,
    history: Vec<Sym3>,
    factors: StepFactors,
}

const MOST_ITERATIONS: usize = 60;

impl<'a> Bar<'a> {
    /// At rest at t = 0.
    ///
    /// # Errors
    ///
    /// Invalid material constants.
    pub fn new(material: &'a Elastomer) -> Result<Bar<'a>, SolidError> {
        material.check()?;
        Ok(Bar {
            material,
            time: 0.0,
            axial: 0.0,
            lateral: 0.0,
            stress: 0.0,
            deviatoric: [0.0; 6],
            history: vec![[0.0; 6]; material.maxwell.len()],
            factors: StepFactors::default(),
        })
    }

    /// A step of `dt` s (zero: sudden) to the axial true strain `strain`; the lateral stretch without lateral stress is
    /// found by Newton's method.
    ///
    /// # Errors
    ///
    /// A negative step; a strain beyond the material's limit, or without a stress-free lateral stretch. The bar then
    /// stays unchanged.
    pub fn step(&mut self, dt: f64, strain: f64) -> Result<(), SolidError> {
        self.factors.set(&self.material.maxwell, dt)?;
        let axial = libm::expm1(strain);
        // Start with constant volume.
        let kept = (1.0 + self.axial) / (1.0 + axial);
        let mut lateral = (1.0 + self.lateral) * kept.sqrt() - 1.0;
        let network = &self.material.network;
        let gain = self.factors.total_gain;
        let past = relaxed_history(&self.history, &self.deviatoric, &self.factors);
        let scale = network.bulk + (1.0 + gain) * network.shear_modulus();
        let mut last = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let half = |h: f64| h + 0.5 * h * h;
            let e = [half(axial), half(lateral), half(lateral), 0.0, 0.0, 0.0];
            let (whole, of_whole) = network.tangent(&e)?;
            let (own, of_own) = network.isochoric_tangent(&e)?;
            let total: Sym3 = std::array::from_fn(|i| whole[i] + gain * own[i] + past[i]);
            let slope = (of_whole[1][1] + of_whole[1][2] + gain * (of_own[1][1] + of_own[1][2]))
                * (1.0 + lateral);
            let step = -total[1] / slope;
            // Converged to rounding.
            let done = total[1].abs() <= 1e-15 * scale
                || (total[1].abs() <= 1e-11 * scale && total[1].abs() >= 0.5 * last);
            if done {
                let side = 1.0 + lateral;
                self.stress = total[0] * (1.0 + axial) / (side * side);
                let change: Sym3 = std::array::from_fn(|i| own[i] - self.deviatoric[i]);
                commit(&mut self.history, &change, &self.factors);
                self.deviatoric = own;
                (self.axial, self.lateral) = (axial, lateral);
                self.time += dt;
                return Ok(());
            }
            last = total[1].abs();
            // At most half of the lateral stretch at once.
            lateral += step.clamp(-0.5 * (1.0 + lateral), 0.5 * (1.0 + lateral));
        }
        let failure =
            StepFailure::NotConverged { residual: last, scale, iterations: MOST_ITERATIONS };
        Err(SolidError::NoEquilibrium { time: self.time, step: dt, failure })
    }
}
