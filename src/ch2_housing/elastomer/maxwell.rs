//! Maxwell elements (2.13), (3.8): each is a spring of γ times the network's deviatoric stiffness in series with a
//! dashpot of relaxation time τ.
//!
//! The recursion is exact if DEV S changes linearly within the step, and of second order otherwise. Only [`commit`]
//! changes a history, once per accepted step; iterations for the next state need only [`relaxed_history`].

use super::ElastomerError;
use crate::kinematics::number::Number;
use crate::kinematics::strain::{Sym3, double_dot};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Maxwell {
    /// Ratio of the spring stiffness to the network stiffness, dimensionless.
    pub gamma: f64,
    /// Relaxation time, s.
    pub tau: f64,
}

impl Maxwell {
    /// # Errors
    /// If a constant is not positive and finite.
    pub fn new(gamma: f64, tau: f64) -> Result<Maxwell, ElastomerError> {
        if !(gamma > 0.0 && gamma.is_finite()) {
            return Err(ElastomerError::Gamma(gamma));
        }
        if !(tau > 0.0 && tau.is_finite()) {
            return Err(ElastomerError::Tau(tau));
        }
        Ok(Maxwell { gamma, tau })
    }
}

/// Recursion factors of one step, the same at every point of a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepFactors {
    /// exp(−Δt/τ) of each element.
    pub decay: Vec<f64>,
    /// γ (1 − exp(−Δt/τ))/(Δt/τ) of each element: its fraction of a change of DEV S.
    pub gain: Vec<f64>,
    /// Sum of the gains: the deviatoric tangent is 1 + this sum times the network's.
    pub total_gain: f64,
}

impl StepFactors {
    /// Sets the factors for a step of `dt` s: zero for an instantaneous change, infinity for full relaxation.
    ///
    /// # Errors
    /// If the step is negative or NaN.
    pub fn set(&mut self, elements: &[Maxwell], dt: f64) -> Result<(), ElastomerError> {
        let forward = dt >= 0.0;
        if !forward {
            return Err(ElastomerError::Step(dt));
        }
        self.fill(elements, dt);
        Ok(())
    }

    /// Like [`StepFactors::set`], for a step known to be non-negative.
    pub(crate) fn fill(&mut self, elements: &[Maxwell], dt: f64) {
        self.decay.clear();
        self.gain.clear();
        self.total_gain = 0.0;
        for Maxwell { gamma, tau } in elements {
            let ratio = dt / tau;
            let gain = if ratio > 0.0 { gamma * -libm::expm1(-ratio) / ratio } else { *gamma };
            self.decay.push(libm::exp(-ratio));
            self.gain.push(gain);
            self.total_gain += gain;
        }
    }

    /// Factors of an instantaneous change.
    pub fn sudden(elements: &[Maxwell]) -> StepFactors {
        let mut factors = StepFactors::default();
        factors.fill(elements, 0.0);
        factors
    }

    /// # Errors
    /// See [`StepFactors::set`].
    pub fn of(elements: &[Maxwell], dt: f64) -> Result<StepFactors, ElastomerError> {
        let mut factors = StepFactors::default();
        factors.set(elements, dt)?;
        Ok(factors)
    }
}

/// Relaxed history of the stress before a step, Pa: the total deviatoric stress (2.14) is (1 +
/// [`StepFactors::total_gain`]) DEV Sⁿ⁺¹ plus this. `history` is Hⱼⁿ, `before` is DEV Sⁿ.
#[inline]
pub fn relaxed_history(history: &[Sym3], before: &Sym3, factors: &StepFactors) -> Sym3 {
    let mut sum = before.map(|s| -factors.total_gain * s);
    for (h, decay) in history.iter().zip(&factors.decay) {
        for (sum, h) in sum.iter_mut().zip(h) {
            *sum += decay * h;
        }
    }
    sum
}

/// Replaces Hⱼⁿ by Hⱼⁿ⁺¹ (2.13); `change` is DEV Sⁿ⁺¹ − DEV Sⁿ, Pa.
#[inline]
pub fn commit(history: &mut [Sym3], change: &Sym3, factors: &StepFactors) {
    for ((h, decay), gain) in history.iter_mut().zip(&factors.decay).zip(&factors.gain) {
        for (h, change) in h.iter_mut().zip(change) {
            *h = decay * *h + gain * change;
        }
    }
}

/// Error of the recursion in a step of `dt` s for unit curvature of DEV S (Pa/s²), s²: Σ γ ∫ exp(−(Δt − s)/τ) (s −
/// Δt/2) ds. Used by the error estimate of the step.
pub fn curvature_error(elements: &[Maxwell], dt: f64) -> f64 {
    let part = |Maxwell { gamma, tau }: &Maxwell| {
        let ratio = dt / tau;
        // The first two orders of the closed form cancel.
        let integral = if ratio < 1e-2 {
            ratio * (1.0 / 12.0 - ratio * (1.0 / 24.0 - ratio / 80.0))
        } else {
            let rest = -libm::expm1(-ratio) / ratio;
            // Divided by Δt²: (1 − e)(1/2)/x − 1/x² + e (1/x² + 1/x), x the ratio.
            0.5 * rest + (libm::exp(-ratio) - rest) / ratio
        };
        gamma * dt * dt * integral
    };
    elements.iter().map(part).sum()
}

/// Spring energy at small strain, J/m³: Σ H:H/(4 μ₀ γ), μ₀ of the network.
pub fn spring_energy(elements: &[Maxwell], history: &[Sym3], shear_modulus: f64) -> f64 {
    let of = |(element, h): (&Maxwell, &Sym3)| double_dot(h, h) / element.gamma;
    elements.iter().zip(history).map(of).sum::<f64>() / (4.0 * shear_modulus)
}

/// Factors of the energy dissipated by the dashpots in one step at small strain: ∫ Σ H:H/(2 μ₀ γ τ) dt, exact if DEV S
/// changes linearly. The same at every point of a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DashpotFactors {
    /// Factors of H:H and of H:ΔDEV S for each element, with H before the step.
    of: Vec<[f64; 2]>,
    /// Factor of ΔDEV S:ΔDEV S.
    of_change: f64,
}

impl DashpotFactors {
    /// Sets the factors for a step of `dt` s ≥ 0; an instantaneous change dissipates nothing.
    pub fn set(&mut self, elements: &[Maxwell], dt: f64) {
        self.of.clear();
        self.of_change = 0.0;
        for Maxwell { gamma, tau } in elements {
            // Within the step H is r + (H − r) exp(−s/τ), with r = γ ΔDEV S/x and x the ratio.
            let x = dt / tau;
            let [once, twice] = [1.0, 2.0].map(|k: f64| -libm::expm1(-k * x) / k);
            let crossed = if x > 0.0 { once * once / x } else { 0.0 };
            let squared = if x < 1e-2 {
                // The first two orders of the closed form cancel.
                x * (1.0 / 3.0 - x * (1.0 / 4.0 - x * (7.0 / 60.0 - x / 24.0)))
            } else {
                (1.0 + (twice - 2.0 * once) / x) / x
            };
            self.of.push([twice / gamma, crossed]);
            self.of_change += gamma * squared;
        }
    }

    /// Dissipated energy at a point, J/m³, with Hⱼ before the step, the `change` of DEV S (Pa) and μ₀ of the network.
    #[inline]
    pub fn energy<T: Number>(
        &self,
        history: &[Sym3<T>],
        change: &Sym3<T>,
        shear_modulus: f64,
    ) -> T {
        let own = T::of(self.of_change) * double_dot(change, change);
        let parts = history.iter().zip(&self.of).map(|(h, [squared, crossed])| {
            T::of(*squared) * double_dot(h, h) + T::of(*crossed) * double_dot(h, change)
        });
        parts.fold(own, |sum, part| sum + part) / T::of(2.0 * shear_modulus)
    }
}

/// Total stress of all elements at a point, Pa.
#[inline(always)]
pub fn summed<T: Number>(history: &[Sym3<T>]) -> Sym3<T> {
    let none = [T::of(0.0); 6];
    history.iter().fold(none, |sum, h| std::array::from_fn(|i| sum[i] + h[i]))
}

/// Work of the elements' stresses in a step beyond the spring and dashpot energies at small strain, J/m³: ½ (ΣH +
/// ΣH′):(ΔE − ΔDEV S/(2 μ₀)), with ΣHⱼ `before` and `after` the step (Pa). At small strain ΔDEV S is 2 μ₀ ΔE apart from
/// a volume change, on which H does no work, and the result is zero. At finite strain the law has no energy in terms of
/// H alone, and this is the remaining work.
#[inline]
pub fn beyond_small_strain<T: Number>(
    [before, after]: [&Sym3<T>; 2],
    strain: &Sym3<T>,
    change: &Sym3<T>,
    shear_modulus: f64,
) -> T {
    let less = T::of(0.5 / shear_modulus);
    let mean: Sym3<T> = std::array::from_fn(|i| T::of(0.5) * (before[i] + after[i]));
    double_dot(&mean, strain) - less * double_dot(&mean, change)
}

/// Storage and loss factor of the deviatoric stiffness relative to the network's, at `pulsation` rad/s (infinity for an
/// instantaneous change): 1 + Σ γ iωτ/(1 + iωτ).
pub fn complex_factor(elements: &[Maxwell], pulsation: f64) -> [f64; 2] {
    let mut sum = [1.0, 0.0];
    for Maxwell { gamma, tau } in elements {
        let x = pulsation * tau;
        let inverse = 1.0 / x;
        // This form is finite for every ωτ, including 0 and infinity.
        sum[0] += gamma / (1.0 + inverse * inverse);
        sum[1] += gamma / (x + inverse);
    }
    sum
}

/// [`complex_factor`] of the recursion in a steady cycle with steps of `dt` s, at the ends of steps: 1 + Σ gain (1 −
/// 1/z)/(1 − decay/z), z = exp(iωΔt).
///
/// # Errors
/// See [`StepFactors::set`].
pub fn complex_factor_of_steps(
    elements: &[Maxwell],
    pulsation: f64,
    dt: f64,
) -> Result<[f64; 2], ElastomerError> {
    let factors = StepFactors::of(elements, dt)?;
    let angle = pulsation * dt;
    let (sine, half) = (libm::sin(angle), libm::sin(0.5 * angle));
    let below = 2.0 * half * half;
    let mut sum = [1.0, 0.0];
    for (decay, gain) in factors.decay.iter().zip(&factors.gain) {
        let left = 1.0 - decay + decay * below;
        let size = left * left + decay * decay * sine * sine;
        if size > 0.0 {
            sum[0] += gain * (below * left + decay * sine * sine) / size;
            sum[1] += gain * sine * (1.0 - decay) / size;
        }
    }
    Ok(sum)
}

/// Deviatoric stiffness of the recursion relative to the network's for a strain that alternates in sign at every step
/// of `dt` s: 1 + Σ γ tanh(x/2)/(x/2), x = Δt/τ. Explicit steps become unstable in this mode only (on the unit circle
/// the response of the recursion is real only there), so that it limits them instead of 1 + Σ γ, to which it tends for
/// steps much shorter than every τ.
pub fn alternating_factor(elements: &[Maxwell], dt: f64) -> f64 {
    let part = |Maxwell { gamma, tau }: &Maxwell| {
        let half = 0.5 * dt / tau;
        if half > 0.0 { gamma * libm::tanh(half) / half } else { *gamma }
    };
    1.0 + elements.iter().map(part).sum::<f64>()
}
