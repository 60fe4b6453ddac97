//! Hertz contact of a ball with a raceway: stiffness coefficient K_H of (2.1), contact ellipse and pressure.
//!
//! The dissertation takes K_H from Hamrock's curve fit; the exact solution by complete elliptic integrals is also
//! available. K_H is fixed at the nominal contact geometry, so that the contact force derives from an energy.

use super::elliptic::{first_kind, integral_b, integral_d, second_kind};
use super::geometry::{BearingGeometry, Material, Raceway};
use std::f64::consts::PI;
use thiserror::Error;

/// Solution of the elliptic contact problem that gives K_H.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HertzModel {
    /// Curve fit of Hamrock and Brewe (1983), used in the dissertation.
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
    /// Ratio k of the major to the minor axis of the contact ellipse.
    pub ellipticity: f64,
    /// Complete elliptic integral of the first kind (or its fit).
    pub integral_first: f64,
    /// Complete elliptic integral of the second kind (or its fit).
    pub integral_second: f64,
    /// E' = 2/[(1−ν₁²)/E₁ + (1−ν₂²)/E₂], Pa.
    pub effective_modulus: f64,
}

/// Dimensions and pressure of a loaded contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEllipse {
    /// m.
    pub semi_major: f64,
    /// m.
    pub semi_minor: f64,
    /// Peak pressure, Pa.
    pub peak_pressure: f64,
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum HertzError {
    #[error(
        "relative radii must be positive and finite, but are {rolling} m in the rolling direction \
         and {transverse} m across the groove: the ball must be smaller than the raceway and groove radii"
    )]
    NotConvex { rolling: f64, transverse: f64 },
}

/// Solution of the elliptic problem for the ratio of relative radii (larger over smaller, ≥ 1):
/// ellipticity k and the complete elliptic integrals of first and second kind.
///
/// Hamrock and Brewe's fit: k = 1.0339 a^0.636, E = 1.0003 + 0.5968/a, F = 1.5277 + 0.6023 ln a.
pub fn hamrock_brewe(radius_ratio: f64) -> (f64, f64, f64) {
    let ellipticity = 1.0339 * libm::pow(radius_ratio, 0.636);
    let first = 1.5277 + 0.6023 * libm::log(radius_ratio);
    let second = 1.0003 + 0.5968 / radius_ratio;
    (ellipticity, first, second)
}

/// Exact counterpart of [`hamrock_brewe`]: the root k of k² B(m)/D(m) = radius ratio with m = 1 − 1/k². This is the
/// classical condition (k²E − K)/(K − E) without its cancellations.
pub fn exact_elliptic(radius_ratio: f64) -> (f64, f64, f64) {
    let ratio_at = |k: f64| {
        let complementary = 1.0 / (k * k);
        k * k * integral_b(complementary) / integral_d(complementary)
    };
    // B ≤ D gives k² ≥ ratio; B/D falls more slowly than 1/k, which gives k ≤ ratio.
    let (mut low, mut high) = (radius_ratio.sqrt(), radius_ratio);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if ratio_at(middle) < radius_ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    let complementary = 1.0 / (high * high);
    (high, first_kind(complementary), second_kind(complementary))
}

/// Hertz contact from relative radii (m) and effective modulus E' (Pa).
///
/// K_H = π k E' √(2 E R/(9 F³)) with 1/R = 1/R_rolling + 1/R_transverse.
pub fn contact_from_radii(
    model: HertzModel,
    radius_rolling: f64,
    radius_transverse: f64,
    effective_modulus: f64,
) -> Result<HertzContact, HertzError> {
    let positive = |radius: f64| radius > 0.0 && radius.is_finite();
    if !(positive(radius_rolling) && positive(radius_transverse)) {
        return Err(HertzError::NotConvex {
            rolling: radius_rolling,
            transverse: radius_transverse,
        });
    }
    let ratio = (radius_transverse / radius_rolling).max(radius_rolling / radius_transverse);
    let (ellipticity, first, second) = match model {
        HertzModel::HamrockBrewe => hamrock_brewe(ratio),
        HertzModel::Exact => exact_elliptic(ratio),
    };
    let radius = 1.0 / (1.0 / radius_rolling + 1.0 / radius_transverse);
    let stiffness = PI
        * ellipticity
        * effective_modulus
        * (2.0 * second * radius / (9.0 * first * first * first)).sqrt();
    Ok(HertzContact {
        stiffness,
        radius_rolling,
        radius_transverse,
        ellipticity,
        integral_first: first,
        integral_second: second,
        effective_modulus,
    })
}

/// E' = 2/[(1−ν₁²)/E₁ + (1−ν₂²)/E₂] in Pa.
pub fn effective_modulus(one: &Material, other: &Material) -> f64 {
    let compliance = |m: &Material| (1.0 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus;
    2.0 / (compliance(one) + compliance(other))
}

/// Race of a contact: convex (inner) or concave (outer) rolling surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RaceSide {
    Inner,
    Outer,
}

/// Contact of the bearing's ball with one raceway at the nominal contact angle:
/// 1/R_rolling = 1/r_ball ± 1/R_race (+ inner, − outer), 1/R_transverse = 1/r_ball − 1/r_groove.
///
/// R_race is the principal radius of the raceway in the rolling direction, measured along the
/// contact normal: the groove-bottom radius of a deep-groove race, longer by 1/cos α otherwise.
pub fn contact(
    model: HertzModel,
    side: RaceSide,
    geometry: &BearingGeometry,
    ball: &Material,
    race: &Material,
) -> Result<HertzContact, HertzError> {
    let cos_angle = libm::cos(geometry.contact_angle);
    let curvature_race = match side {
        RaceSide::Inner => 1.0 / principal_radius(&geometry.inner, -1.0, cos_angle),
        RaceSide::Outer => -1.0 / principal_radius(&geometry.outer, 1.0, cos_angle),
    };
    let raceway = match side {
        RaceSide::Inner => &geometry.inner,
        RaceSide::Outer => &geometry.outer,
    };
    let curvature_ball = 1.0 / geometry.ball_radius;
    contact_from_radii(
        model,
        1.0 / (curvature_ball + curvature_race),
        1.0 / (curvature_ball - 1.0 / raceway.groove_radius),
        effective_modulus(ball, race),
    )
}

fn principal_radius(raceway: &Raceway, outward: f64, cos_angle: f64) -> f64 {
    raceway.centre_radius / cos_angle + outward * raceway.groove_radius
}

/// Contact ellipse and peak pressure under a normal load in N; all zero for zero load.
pub fn contact_ellipse(contact: &HertzContact, normal_load: f64) -> ContactEllipse {
    if normal_load <= 0.0 {
        return ContactEllipse { semi_major: 0.0, semi_minor: 0.0, peak_pressure: 0.0 };
    }
    let k = contact.ellipticity;
    let radius = 1.0 / (1.0 / contact.radius_rolling + 1.0 / contact.radius_transverse);
    let semi_major = libm::cbrt(
        6.0 * k * k * contact.integral_second * normal_load * radius
            / (PI * contact.effective_modulus),
    );
    let semi_minor = semi_major / k;
    let peak_pressure = 1.5 * normal_load / (PI * semi_major * semi_minor);
    ContactEllipse { semi_major, semi_minor, peak_pressure }
}

/// Stiffness coefficient of two contacts in series, (K₁^{-2/3} + K₂^{-2/3})^{-3/2}, N/m^1.5.
pub fn series_stiffness(one: f64, other: f64) -> f64 {
    let compliance = |k: f64| 1.0 / (libm::cbrt(k) * libm::cbrt(k));
    let sum = compliance(one) + compliance(other);
    1.0 / (sum * sum.sqrt())
}
