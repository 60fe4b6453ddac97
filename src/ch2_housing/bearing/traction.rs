//! Friction laws between ball and race (2.2.1): coefficient as a function of sliding, and its force on a slice of the
//! contact ([`slices`](super::slices)).
//!
//! The functions are scalar and branch-free: the scalar path and the vectorised path over contacts give the same bits.

/// Friction coefficient as a function of sliding.
#[derive(Clone, Debug, PartialEq)]
pub enum TractionLaw {
    /// No traction.
    None,
    /// Coulomb's law, regularised below a sliding speed (m/s): κ u/√(u² + u₀²).
    Constant { coefficient: f64, regularisation_speed: f64 },
    /// Exponential in the slide-to-roll ratio s = u/U: κ = (a + b s) e^(−c s) + d. The entrainment speed U has a lower
    /// limit (m/s), because s is singular at rest.
    SlideToRoll { curve: ExponentialCurve, entrainment_floor: f64 },
    /// Exponential in the sliding speed u: κ = (a + b u) e^(−c u) + d.
    SlipSpeed { curve: ExponentialCurve },
}

/// κ(x) = (a + b x) e^(−c x) + d with a = −d, so that κ(0) = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExponentialCurve {
    pub b: f64,
    pub c: f64,
    pub d: f64,
}

impl ExponentialCurve {
    /// Typical boundary-lubrication curve over the slide-to-roll ratio: κ = (−0.1 + 22.28 s) e^(−181.46 s) + 0.1, with
    /// its peak of 0.12 at s = 0.010. An assumption: the dissertation does not print its curve.
    pub const BOUNDARY: ExponentialCurve = ExponentialCurve { b: 22.28, c: 181.46, d: 0.1 };

    #[inline(always)]
    pub fn coefficient(&self, x: f64) -> f64 {
        (self.b * x - self.d) * exp_of_negative(-self.c * x) + self.d
    }

    /// κ and dκ/dx.
    #[inline(always)]
    pub fn coefficient_and_slope(&self, x: f64) -> (f64, f64) {
        let decay = exp_of_negative(-self.c * x);
        let linear = self.b * x - self.d;
        (linear * decay + self.d, (self.b - self.c * linear) * decay)
    }
}

/// e^x for x ≤ 0, to 2 ulp, without branches; constant e^−708 below −708.
///
/// Unlike the system's exponential it vectorises and gives the same bits on every processor.
#[inline(always)]
pub fn exp_of_negative(x: f64) -> f64 {
    const LOG2_E: f64 = std::f64::consts::LOG2_E;
    // ln 2 in two parts: the first has trailing zeros, so that k·ln2 is exact.
    const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
    const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    // 1.5·2⁵²: adding it leaves the nearest integer in the low bits.
    const MAGIC: f64 = 6_755_399_441_055_744.0;
    let x = if x < -708.0 { -708.0 } else { x };
    let shifted = x * LOG2_E + MAGIC;
    let k = shifted - MAGIC;
    let r = (x - k * LN2_HIGH) - k * LN2_LOW;
    // |r| ≤ 0.347: the Taylor series to r¹³ has an error of 4e-18.
    let mut p = 1.0 / 6_227_020_800.0;
    p = p * r + 1.0 / 479_001_600.0;
    p = p * r + 1.0 / 39_916_800.0;
    p = p * r + 1.0 / 3_628_800.0;
    p = p * r + 1.0 / 362_880.0;
    p = p * r + 1.0 / 40_320.0;
    p = p * r + 1.0 / 5_040.0;
    p = p * r + 1.0 / 720.0;
    p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0;
    p = p * r + 1.0 / 6.0;
    p = p * r + 0.5;
    p = p * r + 1.0;
    p = p * r + 1.0;
    let power_of_two = f64::from_bits((shifted.to_bits() << 52).wrapping_add(1023 << 52));
    p * power_of_two
}

/// Friction coefficient at a sliding speed and an entrainment speed (m/s, both ≥ 0).
#[inline(always)]
pub fn coefficient(law: &TractionLaw, slip: f64, entrainment: f64) -> f64 {
    match law {
        TractionLaw::None => 0.0,
        TractionLaw::Constant { coefficient, regularisation_speed } => {
            let u0 = *regularisation_speed;
            coefficient * slip / (slip * slip + u0 * u0).sqrt()
        }
        TractionLaw::SlideToRoll { curve, entrainment_floor } => {
            curve.coefficient(slip * per_entrainment(entrainment, *entrainment_floor))
        }
        TractionLaw::SlipSpeed { curve } => curve.coefficient(slip),
    }
}

/// Friction coefficient and its derivative by the sliding speed (s/m).
pub fn coefficient_and_slope(law: &TractionLaw, slip: f64, entrainment: f64) -> (f64, f64) {
    match law {
        TractionLaw::None => (0.0, 0.0),
        TractionLaw::Constant { coefficient, regularisation_speed } => {
            regularised(*coefficient, *regularisation_speed, slip)
        }
        TractionLaw::SlideToRoll { curve, entrainment_floor } => {
            let per_rolling = per_entrainment(entrainment, *entrainment_floor);
            let (value, slope) = curve.coefficient_and_slope(slip * per_rolling);
            (value, slope * per_rolling)
        }
        TractionLaw::SlipSpeed { curve } => curve.coefficient_and_slope(slip),
    }
}

/// Regularised Coulomb law, and its slope.
#[inline(always)]
fn regularised(coefficient: f64, speed: f64, slip: f64) -> (f64, f64) {
    let square = slip * slip + speed * speed;
    let root = square.sqrt();
    (coefficient * slip / root, coefficient * speed * speed / (square * root))
}

/// Derivative of a slice's friction force by the slip, divided by the normal load: the isotropic part, s/m, and the
/// additional part along the slip divided by the square of the speed, (s/m)³.
pub type Steepness = [f64; 2];

/// [`Steepness`] from a friction coefficient and its slope, at the `square` of the sliding speed. Beyond the peak of
/// the friction curve the slope is taken as zero, so that the derivatives are always dissipative.
#[inline(always)]
pub fn steepness(square: f64, share: f64, friction: impl Fn(f64) -> (f64, f64)) -> Steepness {
    let speed = square.sqrt();
    let (coefficient, rise) = friction(speed);
    let rise = if rise > 0.0 { rise } else { 0.0 };
    // The secant κ/u tends to the tangent; 1e-12 m/s is far below any creep.
    let is_sliding = speed > 1e-12;
    let per = 1.0 / if is_sliding { speed } else { 1e-12 };
    let secant = share * if is_sliding { coefficient * per } else { rise };
    [secant, (share * rise - secant) * per * per]
}

/// [`Steepness`] of the regularised Coulomb law.
#[inline(always)]
pub fn rounded_steepness(
    square: f64,
    share: f64,
    coefficient: f64,
    regularisation_speed: f64,
) -> Steepness {
    let square = square + regularisation_speed * regularisation_speed;
    let secant = share * coefficient / square.sqrt();
    [secant, -secant / square]
}

/// [`Steepness`] of any law, at an entrainment speed (m/s).
#[inline(always)]
pub(super) fn steepness_of(
    law: &TractionLaw,
    square: f64,
    share: f64,
    entrainment: f64,
) -> Steepness {
    match law {
        TractionLaw::Constant { coefficient, regularisation_speed } => {
            rounded_steepness(square, share, *coefficient, *regularisation_speed)
        }
        law => steepness(square, share, |speed| coefficient_and_slope(law, speed, entrainment)),
    }
}

/// 1/U with the lower limit of U, s/m; computed once per contact.
#[inline(always)]
pub fn per_entrainment(entrainment: f64, floor: f64) -> f64 {
    1.0 / if entrainment > floor { entrainment } else { floor }
}

/// Friction of a slice divided by the normal load: force divided by the sliding speed, s/m, and dissipated power, m/s.
pub type Resistance = [f64; 2];

/// [`Resistance`] from a friction coefficient, at the `square` of the sliding speed.
#[inline(always)]
pub fn resistance(square: f64, share: f64, coefficient: impl Fn(f64) -> f64) -> Resistance {
    let speed = square.sqrt();
    // Avoids a division by zero; without sliding the friction is zero.
    let divisor = if speed > 1e-300 { speed } else { 1e-300 };
    let per_speed = share * coefficient(speed) / divisor;
    [per_speed, per_speed * speed * speed]
}

/// [`Resistance`] of the regularised Coulomb law: κ u/√(u² + u₀²) divided by u needs neither u nor a division by it.
#[inline(always)]
pub fn rounded_resistance(
    square: f64,
    share: f64,
    coefficient: f64,
    regularisation_speed: f64,
) -> Resistance {
    let root = (square + regularisation_speed * regularisation_speed).sqrt();
    let per_speed = share * coefficient / root;
    [per_speed, per_speed * square]
}

/// [`Resistance`] of any law, at an entrainment speed (m/s).
#[inline(always)]
pub(super) fn resistance_of(
    law: &TractionLaw,
    square: f64,
    share: f64,
    entrainment: f64,
) -> Resistance {
    match law {
        TractionLaw::Constant { coefficient, regularisation_speed } => {
            rounded_resistance(square, share, *coefficient, *regularisation_speed)
        }
        law => resistance(square, share, |speed| coefficient(law, speed, entrainment)),
    }
}
