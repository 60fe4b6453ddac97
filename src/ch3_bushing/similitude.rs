//! Dimensionless groups of geometrically similar bushings (3.15)–(3.19).

use crate::ch3_bushing::hysteresis::Hysteresis;

/// Reference modulus and lengths of the dimensionless groups. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// C_R, Pa.
    pub modulus: f64,
    /// D, inner diameter.
    pub diameter: f64,
    /// L.
    pub length: f64,
    /// H, radial thickness.
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
