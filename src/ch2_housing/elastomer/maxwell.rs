//! Maxwell elements (2.13), (3.8): each is a spring of γ times the network's deviatoric stiffness in
//! series with a dashpot that lets it relax over τ.
//!
//! The recursion is exact where DEV S changes along a straight line within the step, hence of second
//! order in the step otherwise. A history is changed by [`commit`] and by nothing else, once per
//! accepted step; all that a search for the next state needs of it is [`carried`].

use super::ElastomerError;
use crate::kinematics::number::Number;
use crate::kinematics::strain::{Sym3, double_dot};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Maxwell {
    /// Stiffness over the network's.
    pub gamma: f64,
    /// Relaxation time, s.
    pub tau: f64,
}

impl Maxwell {
    /// # Errors
    /// A constant that is not positive and finite.
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

/// What the elements do in one step, the same at every point of a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepFactors {
    /// exp(−Δt/τ) of each element.
    pub decay: Vec<f64>,
    /// γ (1 − exp(−Δt/τ))/(Δt/τ) of each: how much of a change of DEV S it takes up.
    pub gain: Vec<f64>,
    /// Sum of the gains: the tangent's deviatoric part is 1 + this times the network's.
    pub total_gain: f64,
}

impl StepFactors {
    /// For a step of `dt` s; zero is a sudden change, infinity leaves nothing of the elements.
    ///
    /// # Errors
    /// A step that is negative or not a number.
    pub fn set(&mut self, elements: &[Maxwell], dt: f64) -> Result<(), ElastomerError> {
        let forward = dt >= 0.0;
        if !forward {
            return Err(ElastomerError::Step(dt));
        }
        self.fill(elements, dt);
        Ok(())
    }

    /// As [`StepFactors::set`], of a step that is known to go forward.
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

    /// Of a change in no time.
    pub fn sudden(elements: &[Maxwell]) -> StepFactors {
        let mut factors = StepFactors::default();
        factors.fill(elements, 0.0);
        factors
    }

    /// # Errors
    /// As [`StepFactors::set`].
    pub fn of(elements: &[Maxwell], dt: f64) -> Result<StepFactors, ElastomerError> {
        let mut factors = StepFactors::default();
        factors.set(elements, dt)?;
        Ok(factors)
    }
}

/// What the stress after a step owes to the state before it, Pa: the total deviatoric stress (2.14)
/// is (1 + [`StepFactors::total_gain`]) DEV Sⁿ⁺¹ plus this. `history` has Hⱼⁿ, `before` is DEV Sⁿ.
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

/// Hⱼⁿ⁺¹ in the place of Hⱼⁿ (2.13), `change` being DEV Sⁿ⁺¹ − DEV Sⁿ, Pa.
#[inline]
pub fn commit(history: &mut [Sym3], change: &Sym3, factors: &StepFactors) {
    for ((h, decay), gain) in history.iter_mut().zip(&factors.decay).zip(&factors.gain) {
        for (h, change) in h.iter_mut().zip(change) {
            *h = decay * *h + gain * change;
        }
    }
}

/// How far the recursion strays in a step of `dt` s from a DEV S with the curvature 1 (Pa/s²), s²:
/// Σ γ ∫ exp(−(Δt − s)/τ) (s − Δt/2) ds. What a step's error is estimated with.
pub fn curvature_error(elements: &[Maxwell], dt: f64) -> f64 {
    let part = |Maxwell { gamma, tau }: &Maxwell| {
        let ratio = dt / tau;
        // Of the closed form the first two orders cancel.
        let integral = if ratio < 1e-2 {
            ratio * (1.0 / 12.0 - ratio * (1.0 / 24.0 - ratio / 80.0))
        } else {
            let rest = -libm::expm1(-ratio) / ratio;
            // In Δt²: (1 − e)(1/2)/x − 1/x² + e (1/x² + 1/x), x the ratio.
            0.5 * rest + (libm::exp(-ratio) - rest) / ratio
        };
        gamma * dt * dt * integral
    };
    elements.iter().map(part).sum()
}

/// Energy in the springs at small strain, J/m³: Σ H:H/(4 μ₀ γ), μ₀ of the network.
pub fn spring_energy(elements: &[Maxwell], history: &[Sym3], shear_modulus: f64) -> f64 {
    let of = |(element, h): (&Maxwell, &Sym3)| double_dot(h, h) / element.gamma;
    elements.iter().zip(history).map(of).sum::<f64>() / (4.0 * shear_modulus)
}

/// What the dashpots take at small strain in one step, the same at every point of a body: ∫ Σ H:H/(2 μ₀ γ τ) dt,
/// exact where DEV S changes along a straight line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DashpotFactors {
    /// Of each element what stands before H:H and before H:ΔDEV S, H as it is before the step.
    of: Vec<[f64; 2]>,
    /// Before ΔDEV S:ΔDEV S.
    of_change: f64,
}

impl DashpotFactors {
    /// For a step of `dt` s ≥ 0; a sudden change takes nothing.
    pub fn set(&mut self, elements: &[Maxwell], dt: f64) {
        self.of.clear();
        self.of_change = 0.0;
        for Maxwell { gamma, tau } in elements {
            // Within the step H goes as r + (H − r) exp(−s/τ), r = γ ΔDEV S/x, x the ratio.
            let x = dt / tau;
            let [once, twice] = [1.0, 2.0].map(|k: f64| -libm::expm1(-k * x) / k);
            let crossed = if x > 0.0 { once * once / x } else { 0.0 };
            let squared = if x < 1e-2 {
                // Of the closed form the first two orders cancel.
                x * (1.0 / 3.0 - x * (1.0 / 4.0 - x * (7.0 / 60.0 - x / 24.0)))
            } else {
                (1.0 + (twice - 2.0 * once) / x) / x
            };
            self.of.push([twice / gamma, crossed]);
            self.of_change += gamma * squared;
        }
    }

    /// J/m³ at a point with Hⱼ as before the step, `change` being that of DEV S, Pa; μ₀ of the network.
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

/// The stress of all elements at a point, Pa.
#[inline(always)]
pub fn summed<T: Number>(history: &[Sym3<T>]) -> Sym3<T> {
    let none = [T::of(0.0); 6];
    history.iter().fold(none, |sum, h| std::array::from_fn(|i| sum[i] + h[i]))
}

/// What the elements' stresses, ΣHⱼ `before` and `after` a step (Pa), do in it beyond what springs and dashpots account
/// for at small strain, J/m³: ½ (ΣH + ΣH′):(ΔE − ΔDEV S/(2 μ₀)). At small strain ΔDEV S is 2 μ₀ ΔE but for a change of volume,
/// on which no H works, and nothing is left. At finite strain the law has no energy of H alone, and this is the rest of its power.
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

/// Storage and loss of the deviatoric stiffness over the network's, at `pulsation` rad/s, infinity being a
/// sudden change: 1 + Σ γ iωτ/(1 + iωτ).
pub fn complex_factor(elements: &[Maxwell], pulsation: f64) -> [f64; 2] {
    let mut sum = [1.0, 0.0];
    for Maxwell { gamma, tau } in elements {
        let x = pulsation * tau;
        let inverse = 1.0 / x;
        // Both parts are finite however fast or slow the element is, at 0 and at infinity too.
        sum[0] += gamma / (1.0 + inverse * inverse);
        sum[1] += gamma / (x + inverse);
    }
    sum
}

/// As [`complex_factor`] what the recursion shows in steady cycles by steps of `dt` s, at their ends:
/// 1 + Σ gain (1 − 1/z)/(1 − decay/z), z = exp(iωΔt).
///
/// # Errors
/// As [`StepFactors::set`].
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

/// Deviatoric stiffness over the network's that the recursion shows in steps of `dt` s to a strain that changes its
/// sign with every step: 1 + Σ γ tanh(x/2)/(x/2), x = Δt/τ. Explicit steps turn unstable with that motion and
/// with no other (on the unit circle the recursion's answer is real there alone), so that they are limited by
/// this and not by 1 + Σ γ, which it is for steps shorter than every τ.
pub fn alternating_factor(elements: &[Maxwell], dt: f64) -> f64 {
    let part = |Maxwell { gamma, tau }: &Maxwell| {
        let half = 0.5 * dt / tau;
        if half > 0.0 { gamma * libm::tanh(half) / half } else { *gamma }
    };
    1.0 + elements.iter().map(part).sum::<f64>()
}
