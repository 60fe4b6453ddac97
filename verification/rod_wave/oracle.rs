//! Longitudinal waves in a thin rod (d'Alembert), and how its lateral inertia slows them (Love).

/// m/s: √(E/ρ).
pub fn bar_speed(young: f64, density: f64) -> f64 {
    (young / density).sqrt()
}

/// Part by which lateral inertia slows the phases of a wave with this wave number (1/m) in a rod
/// whose section has the polar radius of gyration `gyration` (m): (ν k K)²/2, Love's first term.
pub fn love_slowing(poisson: f64, wave_number: f64, gyration: f64) -> f64 {
    0.5 * (poisson * wave_number * gyration).powi(2)
}

/// Displacement behind a push of impulse `impulse` (N·s) on the end of a long rod, m: I/(ρ A c).
pub fn displacement_behind(impulse: f64, density: f64, area: f64, speed: f64) -> f64 {
    impulse / (density * area * speed)
}
