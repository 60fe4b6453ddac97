//! Hertz' line contact of a rigid cylinder on a half space in plane strain, and the stresses below it.

#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Peak pressure, Pa.
    pub peak: f64,
    /// Half of the contact's width, m.
    pub half_width: f64,
}

/// Under a load per length P′ (N/m): b = √(4P′R/(πE*)), p₀ = √(P′E*/(πR)).
pub fn line(load: f64, radius: f64, young: f64, poisson: f64) -> Line {
    let modulus = young / (1.0 - poisson * poisson);
    let pi = std::f64::consts::PI;
    Line {
        peak: (load * modulus / (pi * radius)).sqrt(),
        half_width: (4.0 * load * radius / (pi * modulus)).sqrt(),
    }
}

impl Line {
    /// Pressure at a distance from the middle, Pa.
    pub fn pressure(&self, y: f64) -> f64 {
        let part = y / self.half_width;
        if part.abs() < 1.0 { self.peak * (1.0 - part * part).sqrt() } else { 0.0 }
    }

    /// Its integral from one distance to another, N/m.
    pub fn force_between(&self, from: f64, to: f64) -> f64 {
        let up_to = |y: f64| {
            let part = (y / self.half_width).clamp(-1.0, 1.0);
            0.5 * (part * (1.0 - part * part).sqrt() + part.asin())
        };
        self.peak * self.half_width * (up_to(to) - up_to(from))
    }
}

/// Von Mises stress over p₀ on the axis of symmetry, `depth` half widths below the surface.
pub fn von_mises(depth: f64, poisson: f64) -> f64 {
    let root = (1.0 + depth * depth).sqrt();
    let down = -1.0 / root;
    let across = -((1.0 + 2.0 * depth * depth) / root - 2.0 * depth);
    let along = poisson * (down + across);
    let squares = (down - across).powi(2) + (across - along).powi(2) + (along - down).powi(2);
    (0.5 * squares).sqrt()
}

/// Its maximum, and where, by trying depths.
pub fn von_mises_peak(poisson: f64) -> [f64; 2] {
    let steps = (1..200_000).map(|i| 1e-5 * f64::from(i));
    let best = steps.max_by(|a, b| von_mises(*a, poisson).total_cmp(&von_mises(*b, poisson)));
    best.map_or([f64::NAN; 2], |depth| [von_mises(depth, poisson), depth])
}
