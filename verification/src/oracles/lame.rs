//! Lamé's thick ring under inner pressure.

/// SI.
#[derive(Clone, Copy)]
pub struct ThickRing {
    pub inner: f64,
    pub outer: f64,
    pub young: f64,
    pub poisson: f64,
    pub pressure: f64,
}

/// What the end faces may do.
#[derive(Clone, Copy, PartialEq)]
pub enum Ends {
    /// No axial strain.
    Held,
    /// No axial stress.
    Free,
}

impl ThickRing {
    /// Radial and hoop stress at a radius, Pa; the same for both ends.
    pub fn stresses(&self, radius: f64) -> [f64; 2] {
        let (a, b) = (self.inner * self.inner, self.outer * self.outer);
        let uniform = self.pressure * a / (b - a);
        let varying = uniform * b / (radius * radius);
        [uniform - varying, uniform + varying]
    }

    /// Axial stress, Pa.
    pub fn axial_stress(&self, ends: Ends) -> f64 {
        let [radial, hoop] = self.stresses(self.inner);
        match ends {
            Ends::Held => self.poisson * (radial + hoop),
            Ends::Free => 0.0,
        }
    }

    /// Radial displacement, m: radius times hoop strain by Hooke's law.
    pub fn displacement(&self, radius: f64, ends: Ends) -> f64 {
        let [radial, hoop] = self.stresses(radius);
        radius * (hoop - self.poisson * (radial + self.axial_stress(ends))) / self.young
    }
}
