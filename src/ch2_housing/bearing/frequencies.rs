//! Kinematic frequencies of a ball bearing whose balls roll without slip (used in 5.4).

/// Characteristic frequencies divided by the shaft frequency: inner race rotating, outer race fixed. Dimensionless.
///
/// They are the defect frequencies to look for in a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequencies {
    /// Cage rotation, also fundamental train frequency (FTF).
    pub cage: f64,
    /// Ball pass frequency of the outer race (BPFO).
    pub ball_pass_outer: f64,
    /// Ball pass frequency of the inner race (BPFI).
    pub ball_pass_inner: f64,
    /// Ball spin frequency (BSF), relative to the cage. A ball defect strikes a race twice per revolution.
    pub ball_spin: f64,
}

/// Characteristic frequencies divided by the shaft frequency, for pure rolling at a common contact angle.
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
/// // The balls orbit with the cage, so each passes once per revolution of the cage.
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
