//! Kinematic frequencies of a ball bearing whose balls roll without slip (used in 5.4).

/// Characteristic frequencies over the shaft frequency: inner race turning, outer race fixed.
///
/// They are the rates at which a train of defects would be struck, and the lines to look for in a
/// spectrum. All are dimensionless; multiply by the shaft frequency in Hz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequencies {
    /// Cage, also fundamental train frequency (FTF).
    pub cage: f64,
    /// Balls passing a point of the outer race (BPFO).
    pub ball_pass_outer: f64,
    /// Balls passing a point of the inner race (BPFI).
    pub ball_pass_inner: f64,
    /// Turns of a ball about its own axis, seen from the cage (BSF). A defect of a ball meets a
    /// race twice in each turn.
    pub ball_spin: f64,
}

/// Frequencies over the shaft frequency, from pure rolling at a common contact angle.
///
/// `ball_radius` and `pitch_radius` in the same unit (m), `contact_angle` in rad. With
/// γ = (r_b/R_pitch) cos α: cage ½(1−γ), outer Z/2 (1−γ), inner Z/2 (1+γ), ball
/// R_pitch/(2 r_b) (1−γ²).
///
/// ```
/// use bearing_dynamics::ch2_housing::bearing::frequencies::ratios;
///
/// // Table 5.3: eleven balls, 35° contact angle.
/// let frequencies = ratios(11, 5.953e-3, 30.0e-3, 35f64.to_radians());
/// // Cage and balls share one motion: each ball passes once a turn of the cage.
/// assert!((frequencies.ball_pass_outer - 11.0 * frequencies.cage).abs() <= 1e-14);
/// ```
#[doc(alias = "FTF")]
#[doc(alias = "BPFO")]
#[doc(alias = "BPFI")]
#[doc(alias = "BSF")]
pub fn ratios(
    ball_count: usize,
    ball_radius: f64,
    pitch_radius: f64,
    contact_angle: f64,
) -> Frequencies {
    let gamma = ball_radius / pitch_radius * libm::cos(contact_angle);
    let count = ball_count as f64;
    Frequencies {
        cage: 0.5 * (1.0 - gamma),
        ball_pass_outer: 0.5 * count * (1.0 - gamma),
        ball_pass_inner: 0.5 * count * (1.0 + gamma),
        ball_spin: 0.5 * pitch_radius / ball_radius * (1.0 - gamma * gamma),
    }
}
