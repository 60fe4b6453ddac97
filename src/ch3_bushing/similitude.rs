//! Bushings of one shape: dimensionless groups (3.15)–(3.19).

use crate::ch3_bushing::hysteresis::Hysteresis;

/// What the groups are formed with. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// C_R, Pa.
    pub modulus: f64,
    /// D, inner.
    pub diameter: f64,
    /// L.
    pub length: f64,
    /// H, radial.
    pub thickness: f64,
}

impl Scale {
    /// F/(C_R L D) of a force in N (3.15).
    pub fn force(&self, force: f64) -> f64 {
        force / (self.modulus * self.length * self.diameter)
    }

    /// D/H (3.16).
    pub fn diameter_ratio(&self) -> f64 {
        self.diameter / self.thickness
    }

    /// L/H (3.17).
    pub fn length_ratio(&self) -> f64 {
        self.length / self.thickness
    }

    /// x/H of a displacement in m (3.18).
    pub fn displacement(&self, x: f64) -> f64 {
        x / self.thickness
    }

    /// K̄_d: dimensionless peak force over dimensionless peak displacement (3.19).
    pub fn dynamic_stiffness(&self, of: &Hysteresis) -> f64 {
        self.force(of.dynamic_stiffness) / self.displacement(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bushing twice as large of twice the modulus: four times the stiffness, the same groups.
    #[test]
    fn like_bushings_have_like_groups() {
        let small = Scale { modulus: 1e6, diameter: 0.04, length: 0.06, thickness: 0.02 };
        let large = Scale { modulus: 2e6, diameter: 0.08, length: 0.12, thickness: 0.04 };
        let of = |k| Hysteresis { dynamic_stiffness: k, damping_ratio: 0.1 };
        assert_eq!(small.diameter_ratio(), large.diameter_ratio());
        assert_eq!(small.length_ratio(), large.length_ratio());
        let [a, b] = [small.dynamic_stiffness(&of(1e6)), large.dynamic_stiffness(&of(4e6))];
        assert!((a / b - 1.0).abs() <= 1e-15);
        // 1e6 N/m · 0.02 m/(1e6 Pa · 0.06 m · 0.04 m).
        assert!((a - 1e6 * 0.02 / (1e6 * 0.06 * 0.04)).abs() <= 1e-12 * a);
        assert!((small.force(2400.0) - 1.0).abs() <= 1e-15);
    }
}
