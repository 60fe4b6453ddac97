//! Rating life of a ball bearing with one row: ISO/TS 16281 from the ball loads, with the basic dynamic load rating of
//! ISO 281 (ISO/TR 1281-1). For bearing steel and contact angles up to 45°, without factors for lubricant, dirt and
//! reliability.

use super::geometry::BearingGeometry;

/// Largest nominal contact angle of a radial bearing, rad.
pub const LARGEST_CONTACT_ANGLE: f64 = std::f64::consts::FRAC_PI_4;

/// Groove radius over ball diameter, inner and outer race, up to which the ratings of ISO 281 apply.
const STANDARD: [f64; 2] = [0.52, 0.53];

/// D cos α/D_pw.
fn gamma(geometry: &BearingGeometry) -> f64 {
    geometry.ball_radius * libm::cos(geometry.contact_angle) / geometry.pitch_radius
}

fn conformities(geometry: &BearingGeometry) -> [f64; 2] {
    [geometry.inner, geometry.outer].map(|race| 0.5 * race.groove_radius / geometry.ball_radius)
}

/// Rating of a ball on the inner race over that on the outer race.
fn race_ratio(factor: f64, gamma: f64, [inner, outer]: [f64; 2]) -> f64 {
    let grooves = inner / outer * (2.0 * outer - 1.0) / (2.0 * inner - 1.0);
    factor * libm::pow((1.0 - gamma) / (1.0 + gamma), 1.72) * libm::pow(grooves, 0.41)
}

/// (1 + ratio^exponent)^0.3
fn joined(ratio: f64, exponent: f64) -> f64 {
    libm::pow(1.0 + libm::pow(ratio, exponent), 0.3)
}

/// f_c of ISO 281, from the formula of ISO/TR 1281-1.
fn geometry_factor(gamma: f64, conformities: [f64; 2]) -> f64 {
    let inner = conformities[0];
    let shape = libm::pow(gamma, 0.3) * libm::pow(1.0 - gamma, 1.39) / libm::cbrt(1.0 + gamma);
    let ratio = race_ratio(1.04, gamma, conformities);
    0.95 * 0.41 * 98.0665 * shape * libm::pow(2.0 * inner / (2.0 * inner - 1.0), 0.41)
        / joined(ratio, 10.0 / 3.0)
}

/// Basic dynamic radial load rating, N, of ISO 281: 1.3 f_c cos^0.7 α Z^(2/3) D^1.8, and 3.647 D^1.4 instead of D^1.8
/// above 25.4 mm. The table of f_c is for two grooves of 0.52 ball diameters; wider ones than 0.52 (inner) and 0.53
/// (outer) reduce it.
pub fn dynamic_rating(geometry: &BearingGeometry) -> f64 {
    let gamma = gamma(geometry);
    let own = conformities(geometry);
    let wide = [0, 1].map(|race| own[race].max(STANDARD[race]));
    let factor = geometry_factor(gamma, [STANDARD[0]; 2]) * geometry_factor(gamma, wide)
        / geometry_factor(gamma, STANDARD);
    let diameter = 2e3 * geometry.ball_radius;
    let size = match diameter {
        small if small <= 25.4 => libm::pow(small, 1.8),
        large => 3.647 * libm::pow(large, 1.4),
    };
    let balls = libm::cbrt(geometry.ball_count as f64);
    1.3 * factor * libm::pow(libm::cos(geometry.contact_angle), 0.7) * balls * balls * size
}

/// Ball loads, N, under which 90 % of inner and of outer races survive 10⁶ revolutions, for the dynamic load rating
/// `rating`, N: Q_ci and Q_ce of ISO/TS 16281.
pub fn race_ratings(geometry: &BearingGeometry, rating: f64) -> [f64; 2] {
    let ratio = race_ratio(1.044, gamma(geometry), conformities(geometry));
    let each = rating / (geometry.ball_count as f64 * libm::cos(geometry.contact_angle));
    [each / 0.407 * joined(ratio, 10.0 / 3.0), each / 0.389 * joined(ratio, -10.0 / 3.0)]
}

/// Basic reference rating life L₁₀ᵣ of ISO/TS 16281, 10⁶ revolutions; `None` without a loaded ball.
///
/// `loads` are those of each ball on the inner and the outer race, N; `turns` says which race rotates relative to the
/// load.
pub fn reference_life(
    geometry: &BearingGeometry,
    rating: f64,
    loads: &[[f64; 2]],
    turns: [bool; 2],
) -> Option<f64> {
    let ratings = race_ratings(geometry, rating);
    let mut damage = 0.0;
    for race in 0..2 {
        let exponent = if turns[race] { 3.0 } else { 10.0 / 3.0 };
        let sum: f64 =
            loads.iter().map(|load| libm::pow(load[race] / ratings[race], exponent)).sum();
        damage += libm::pow(sum / loads.len() as f64, 10.0 / (3.0 * exponent));
    }
    let life = libm::pow(damage, -0.9);
    life.is_finite().then_some(life)
}
