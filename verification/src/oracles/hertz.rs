//! Hertz contact of two bodies with elliptical contact area, and the Hamrock–Brewe fit to it.
//!
//! The exact solution is taken from the potential of an ellipsoidal pressure (Landau & Lifshitz,
//! Theory of Elasticity, §9) by quadrature, not from formulas in K and E:
//! with the gap x²/2Rx + y²/2Ry, semi-axes a (along x, rolling) and b (along y, transverse) and
//! w(s) = √((a²+s)(b²+s)s),
//! 1/2Rx = c ∫ ds/[(a²+s) w], 1/2Ry = c ∫ ds/[(b²+s) w], δ = c ∫ ds/w, c = 3P/(2πE′).
//!
//! E′ = 2/[(1−ν₁²)/E₁ + (1−ν₂²)/E₂].

use super::elliptic::{TAIL, line_integral};
use std::f64::consts::PI;

/// Relative radii of curvature of a contact, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativeRadii {
    /// In the direction of rolling, Rx.
    pub rolling: f64,
    /// Across it, Ry.
    pub transverse: f64,
}

/// Ball on the inner (`sign = +1`) or outer (`sign = −1`) race: 1/Rx = 1/r ± 1/R, 1/Ry = 1/r − 1/g.
pub fn ball_on_race(ball: f64, race: f64, groove: f64, sign: f64) -> RelativeRadii {
    RelativeRadii {
        rolling: 1.0 / (1.0 / ball + sign / race),
        transverse: 1.0 / (1.0 / ball - 1.0 / groove),
    }
}

/// E′, Pa.
pub fn effective_modulus(e1: f64, nu1: f64, e2: f64, nu2: f64) -> f64 {
    2.0 / ((1.0 - nu1 * nu1) / e1 + (1.0 - nu2 * nu2) / e2)
}

/// Result for one load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzSolution {
    /// δ, m.
    pub approach: f64,
    /// Semi-axis along the rolling direction, m.
    pub semi_axis_rolling: f64,
    /// Semi-axis across it, m.
    pub semi_axis_transverse: f64,
    /// Pa.
    pub peak_pressure: f64,
    /// K of P = K δ^(3/2), N/m^1.5.
    pub stiffness: f64,
}

/// The three integrals for semi-axes 1 (rolling) and `ratio` (transverse): (rolling, transverse,
/// approach). Substitution s = e^(2u): analytic for |Im u| < π/2, decaying like e^(−2|u|/2).
pub fn potential_integrals(ratio: f64) -> (f64, f64, f64) {
    let square = ratio * ratio;
    let spread = ratio.ln().abs();
    let (lower, upper) = (-TAIL - spread, TAIL + spread);
    // ds/√s = 2 eᵘ du.
    let weight = |s: f64, root: f64| 2.0 * root / ((1.0 + s) * (square + s)).sqrt();
    let integral = |extra: &dyn Fn(f64) -> f64| {
        line_integral(lower, upper, |u| {
            let root = u.exp();
            let s = root * root;
            weight(s, root) * extra(s)
        })
    };
    (integral(&|s| 1.0 / (1.0 + s)), integral(&|s| 1.0 / (square + s)), integral(&|_| 1.0))
}

/// Ratio transverse : rolling semi-axis, by bisection on its logarithm to the last bit.
fn axis_ratio(radii: RelativeRadii) -> f64 {
    let wanted = radii.rolling / radii.transverse;
    // Wider across than 1e6 : 1 is a line contact, for which this theory has no answer.
    let (mut low, mut high) = (-(1e6_f64.ln()), 1e6_f64.ln());
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high || high - low <= 1e-16 {
            return middle.exp();
        }
        let (rolling, transverse, _) = potential_integrals(middle.exp());
        if transverse / rolling > wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// Exact Hertz solution under `load` (N).
pub fn exact(radii: RelativeRadii, load: f64, effective_modulus: f64) -> HertzSolution {
    let ratio = axis_ratio(radii);
    let (rolling, _, approach) = potential_integrals(ratio);
    let scale = 3.0 * load / (2.0 * PI * effective_modulus);
    let a = (2.0 * radii.rolling * scale * rolling).cbrt();
    let b = ratio * a;
    HertzSolution {
        approach: scale * approach / a,
        semi_axis_rolling: a,
        semi_axis_transverse: b,
        peak_pressure: 1.5 * load / (PI * a * b),
        stiffness: (2.0 * radii.rolling * rolling / approach).sqrt() / approach * 2.0 * PI / 3.0
            * effective_modulus,
    }
}

/// Hamrock & Brewe's fit (coefficients 1.0339, 0.636; 1.0003, 0.5968; 1.5277, 0.6023).
pub fn hamrock_brewe(radii: RelativeRadii, load: f64, effective_modulus: f64) -> HertzSolution {
    let ratio = radii.transverse / radii.rolling;
    let ellipticity = 1.0339 * ratio.powf(0.636);
    let second = 1.0003 + 0.5968 / ratio;
    let first = 1.5277 + 0.6023 * ratio.ln();
    let curvature_radius = radii.rolling * radii.transverse / (radii.rolling + radii.transverse);
    let stiffness = PI
        * ellipticity
        * effective_modulus
        * (2.0 * second * curvature_radius / (9.0 * first.powi(3))).sqrt();
    let b = (6.0 * ellipticity * ellipticity * second * load * curvature_radius
        / (PI * effective_modulus))
        .cbrt();
    let a = b / ellipticity;
    HertzSolution {
        approach: (load / stiffness).powf(2.0 / 3.0),
        semi_axis_rolling: a,
        semi_axis_transverse: b,
        peak_pressure: 1.5 * load / (PI * a * b),
        stiffness,
    }
}

/// Stiffness of two 3/2-power contacts in series, N/m^1.5.
pub fn in_series(inner: f64, outer: f64) -> f64 {
    (inner.powf(-2.0 / 3.0) + outer.powf(-2.0 / 3.0)).powf(-1.5)
}

/// Exact solution for one curvature ratio: rolling radius 5 mm, 100 N, E′ = 210 GPa/0.91.
pub struct PrecisionRow {
    /// Ry/Rx.
    pub ratio: f64,
    pub stiffness: f64,
    pub semi_axis_transverse: f64,
    pub semi_axis_rolling: f64,
    pub peak_pressure: f64,
}

/// 40-digit arithmetic in mpmath 1.3, by the formulas in K and E: [E/(1−m) − K]/(K − E) = Ry/Rx,
/// K_H = πkE′√(2ER/9F³).
pub const PRECISION: [PrecisionRow; 5] = [
    PrecisionRow {
        ratio: 1.25,
        stiffness: 11514613243.44383,
        semi_axis_transverse: 0.00016549140061789485,
        semi_axis_rolling: 0.00014262104648443403,
        peak_pressure: 2022936898.4439943,
    },
    PrecisionRow {
        ratio: 2.0,
        stiffness: 13066149873.327772,
        semi_axis_transverse: 0.00020800017971092544,
        semi_axis_rolling: 0.00013116401922198183,
        peak_pressure: 1750100383.6391747,
    },
    PrecisionRow {
        ratio: 10.0,
        stiffness: 21454527496.867786,
        semi_axis_transverse: 0.00043217456515288143,
        semi_axis_rolling: 9.605058933567267e-05,
        peak_pressure: 1150223268.082917,
    },
    PrecisionRow {
        ratio: 130.0,
        stiffness: 54627407629.89494,
        semi_axis_transverse: 0.0012283623301977181,
        semi_axis_rolling: 5.7945552539978054e-05,
        peak_pressure: 670802678.8967452,
    },
    PrecisionRow {
        ratio: 1000.0,
        stiffness: 123604967267.4867,
        semi_axis_transverse: 0.0026709295705863844,
        semi_axis_rolling: 3.935217596417068e-05,
        peak_pressure: 454265964.13727516,
    },
];
