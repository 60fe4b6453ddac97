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
