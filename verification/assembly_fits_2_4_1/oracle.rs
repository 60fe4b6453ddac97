//! A rigid race pressed into a ring through a layer of springs.

/// Ring of steel, held outside and at both ends (plane strain), SI.
#[derive(Clone, Copy, Debug)]
pub struct Ring {
    pub young: f64,
    pub poisson: f64,
    pub inner: f64,
    pub outer: f64,
}

impl Ring {
    /// Widening of the bore under a pressure of one, m/Pa: Lamé's u = A r + B/r with u = 0 outside.
    pub fn compliance(&self) -> f64 {
        let (a, b) = (self.inner, self.outer);
        // With A = −B/b²: u(a) = B (1/a − a/b²), and σ_r(a) = −p gives B.
        let shear = 0.5 * self.young / (1.0 + self.poisson);
        let bulk = shear / (1.0 - 2.0 * self.poisson);
        // σ_r = 2 (λ + μ) A − 2 μ B/r², with λ + μ = μ/(1 − 2ν).
        let stress = 2.0 * bulk / (b * b) + 2.0 * shear / (a * a);
        (1.0 / a - a / (b * b)) / stress
    }
}

/// Pressure by an interference (m) over two compliances in a row (m/Pa).
pub fn in_series(interference: f64, one: f64, other: f64) -> f64 {
    interference / (one + other)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bore in a body without end opens by p a (1 + ν)/E whatever holds it far away; a thin ring by
    /// its thickness under the modulus of a layer held sideways.
    #[test]
    fn limits_of_thick_and_thin_rings() {
        let (young, poisson) = (2.1e11, 0.3);
        let wide = Ring { young, poisson, inner: 0.03, outer: 300.0 };
        assert!((wide.compliance() / (0.03 * 1.3 / young) - 1.0).abs() <= 1e-6);
        let thin = Ring { young, poisson, inner: 0.03, outer: 0.030_003 };
        let modulus = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        assert!((thin.compliance() / (3e-6 / modulus) - 1.0).abs() <= 1e-3);
    }
}
