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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_sums_to_the_load_and_stress_peaks_where_textbooks_say() {
        let line = line(7e5, 0.0355, 2.1e11, 0.3);
        let steps = 20_000;
        let h = line.half_width / f64::from(steps);
        let sum: f64 = (0..steps).map(|i| 2.0 * h * line.pressure((f64::from(i) + 0.5) * h)).sum();
        assert!((sum / 7e5 - 1.0).abs() <= 1e-5, "{sum}");
        let across = 0.5 * line.half_width;
        assert!(
            (2.0 * line.force_between(0.0, across + line.half_width) / 7e5 - 1.0).abs() <= 1e-12
        );
        let part: f64 = (0..steps / 2).map(|i| h * line.pressure((f64::from(i) + 0.5) * h)).sum();
        assert!((line.force_between(0.0, across) / part - 1.0).abs() <= 1e-6, "{part}");
        let [stress, depth] = von_mises_peak(0.3);
        assert!(
            (stress - 0.5575).abs() <= 5e-4 && (depth - 0.704).abs() <= 1e-3,
            "{stress} {depth}"
        );
        // At the surface all three press, and only Poisson's share differs.
        assert!((von_mises(0.0, 0.3) - 0.4).abs() <= 1e-12);
    }
}
