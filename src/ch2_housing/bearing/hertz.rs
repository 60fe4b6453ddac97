//! Hertz contact of a ball with a raceway: stiffness coefficient of (2.1), ellipse and pressure.

/// Which solution of the elliptic contact problem gives K_H.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HertzModel {
    /// Curve fit of Hamrock and Brewe, the source's choice.
    HamrockBrewe,
    /// Complete elliptic integrals.
    Exact,
}

/// Contact of a ball with one raceway at the nominal contact geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzContact {
    /// K_H of (2.1), N/m^1.5.
    pub stiffness: f64,
    /// Relative radius in the rolling direction, m.
    pub radius_rolling: f64,
    /// Relative radius across the groove, m.
    pub radius_transverse: f64,
    /// Ratio k of the ellipse's major to its minor axis.
    pub ellipticity: f64,
    /// Complete elliptic integral of the first kind (or its fit).
    pub integral_first: f64,
    /// Complete elliptic integral of the second kind (or its fit).
    pub integral_second: f64,
    /// E' = 2/[(1−ν₁²)/E₁ + (1−ν₂²)/E₂], Pa.
    pub effective_modulus: f64,
}
