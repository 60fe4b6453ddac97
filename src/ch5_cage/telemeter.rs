//! Cage telemeter (5.2.1): a loop with a capacitor that moves with the cage, coupled to a fixed transceiver loop.
//!
//! The dissertation measures the reflection coefficient S₁₁ of the fixed loop and prints no formula. Here both loops
//! are circles of thin wire; the loop on the cage and its capacitor form a resonator:
//!
//! Z = R₂ + jωL₂ + ω²M²/(R₁ + jωL₁ + 1/(jωC)), S₁₁ = (Z − 50 Ω)/(Z + 50 Ω).
//!
//! Motion changes only the mutual inductance M. Metal around the loops is neglected.

use crate::ch2_housing::bearing::elliptic::{integral_b, integral_d};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, norm, scale};
use core::f64::consts::{PI, TAU};

/// Permeability of vacuum μ₀, H/m.
pub const PERMEABILITY: f64 = 4e-7 * PI;
/// Resistivity of copper at 20 °C, Ω·m.
pub const COPPER: f64 = 1.68e-8;
/// Reference impedance of network analysers, Ω.
pub const REFERENCE_IMPEDANCE: f64 = 50.0;

/// Circuit data of both loops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telemeter {
    /// Radius of the loop on the cage, m.
    pub radius: f64,
    /// Radius of the transceiver's loop, m.
    pub transceiver_radius: f64,
    /// Radius of both wires, m.
    pub wire_radius: f64,
    /// Capacitance, F.
    pub capacitance: f64,
    /// Resistances of the loop on the cage and of the transceiver's loop, Ω.
    pub resistance: [f64; 2],
    /// Measurement frequency, Hz.
    pub frequency: f64,
}

/// Inductance of a circular loop of thin wire with skin-effect current, H: μ₀ R (ln(8R/r) − 2).
pub fn self_inductance(radius: f64, wire_radius: f64) -> f64 {
    PERMEABILITY * radius * (libm::log(8.0 * radius / wire_radius) - 2.0)
}

/// Natural frequency of a loop with a capacitor, Hz.
pub fn natural_frequency(radius: f64, wire_radius: f64, capacitance: f64) -> f64 {
    1.0 / (TAU * (self_inductance(radius, wire_radius) * capacitance).sqrt())
}

/// Resistance of a circular copper loop, Ω: (R/r) ρ/δ with the skin depth δ = √(ρ/(π f μ₀)), and at least the
/// direct-current value 2ρR/r².
pub fn copper_resistance(radius: f64, wire_radius: f64, frequency: f64) -> f64 {
    let skin = (COPPER / (PI * frequency * PERMEABILITY)).sqrt();
    radius / wire_radius * COPPER / skin.min(0.5 * wire_radius)
}

/// Mutual inductance, H, of a circle of radius `a` (m) about X at the origin and a circle of radius `b` about the unit
/// vector `axis` at `centre` (m): the vector potential of the first integrated along the second.
///
/// A_φ = (μ₀/π) a (D − B)/√((a + ρ)² + x²) with the elliptic integrals of k² = 4aρ/((a + ρ)² + x²), from (1 − k²/2)K −
/// E = k²(D − B)/2. The trapezium rule around a circle converges exponentially; the steps are halved until the relative
/// change is 1e-12, or the limit for nearly touching wires is reached.
///
/// ```
/// use bearing_dynamics::ch5_cage::telemeter::mutual_inductance;
/// // Far apart two loops are dipoles: μ₀ π a² b²/(2 h³).
/// let far = mutual_inductance(0.01, 0.02, [10.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
/// let dipoles = 2e-7 * std::f64::consts::PI.powi(2) * 4e-8 / 1e3;
/// assert!((far / dipoles - 1.0).abs() <= 1e-5);
/// ```
pub fn mutual_inductance(a: f64, b: f64, centre: Vec3, axis: Vec3) -> f64 {
    const FINEST: usize = 1 << 14;
    let first = perpendicular(axis);
    let second = cross(axis, first);
    let at = |angle: f64| {
        let (sin, cos) = libm::sincos(angle);
        let arm = add_scaled(scale(first, cos), sin, second);
        let along = add_scaled(scale(first, -sin), cos, second);
        potential_along(a, add(centre, scale(arm, b)), along)
    };
    let mean = |steps: usize, from: f64| {
        let step = TAU / steps as f64;
        (0..steps).map(|i| at((i as f64 + from) * step)).sum::<f64>() / steps as f64
    };
    let mut steps = 8;
    let mut coarse = mean(steps, 0.0);
    loop {
        let fine = 0.5 * (coarse + mean(steps, 0.5));
        steps *= 2;
        if (fine - coarse).abs() <= 1e-12 * fine.abs() || steps >= FINEST {
            return TAU * b * fine;
        }
        coarse = fine;
    }
}

/// Component along `direction` of the vector potential at `place` of a circle of radius `a` about X carrying one
/// ampere, V·s/m.
fn potential_along(a: f64, place: Vec3, direction: Vec3) -> f64 {
    let [x, y, z] = place;
    let rho = libm::hypot(y, z);
    if rho == 0.0 {
        return 0.0;
    }
    let far = (a + rho) * (a + rho) + x * x;
    let complementary = ((a - rho) * (a - rho) + x * x) / far;
    let around = (direction[2] * y - direction[1] * z) / rho;
    let difference = integral_d(complementary) - integral_b(complementary);
    PERMEABILITY / PI * a * difference / far.sqrt() * around
}

/// Unit vector perpendicular to `axis`.
pub(crate) fn perpendicular(axis: Vec3) -> Vec3 {
    let helper = if axis[1].abs() < 0.6 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
    let across = add_scaled(helper, -dot(helper, axis), axis);
    scale(across, 1.0 / norm(across))
}

impl Telemeter {
    /// Natural frequency of the loop on the cage with its capacitor, Hz.
    pub fn natural_frequency(&self) -> f64 {
        natural_frequency(self.radius, self.wire_radius, self.capacitance)
    }

    /// Input impedance of the transceiver (real and imaginary part, Ω) at a mutual inductance (H).
    pub fn impedance(&self, mutual: f64) -> [f64; 2] {
        let pulsation = TAU * self.frequency;
        let [of_cage, of_transceiver] = [self.radius, self.transceiver_radius]
            .map(|radius| pulsation * self_inductance(radius, self.wire_radius));
        // 1/(R + jX) = (R − jX)/(R² + X²).
        let [r, x] = [self.resistance[0], of_cage - 1.0 / (pulsation * self.capacitance)];
        let coupled = (pulsation * mutual).powi(2) / (r * r + x * x);
        [self.resistance[1] + coupled * r, of_transceiver - coupled * x]
    }

    /// Magnitude of the reflection coefficient |S₁₁|.
    pub fn reflection(&self, mutual: f64) -> f64 {
        let [r, x] = self.impedance(mutual);
        libm::hypot(r - REFERENCE_IMPEDANCE, x) / libm::hypot(r + REFERENCE_IMPEDANCE, x)
    }

    /// |S₁₁| for the loop on the cage at `centre` (m) about the unit vector `axis`, in axes of the transceiver, whose
    /// loop is at the origin about X.
    pub fn signal(&self, centre: Vec3, axis: Vec3) -> f64 {
        self.reflection(mutual_inductance(self.transceiver_radius, self.radius, centre, axis))
    }
}
