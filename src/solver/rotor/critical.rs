//! Critical speeds: where a motion whirls once a turn.

use super::model::{RotorError, RotorModel};
use super::whirl::Whirl;
use nalgebra::{Complex, DMatrix};

/// A speed at which a motion has the frequency of the spin.
#[derive(Clone, Debug, PartialEq)]
pub struct Critical {
    /// rad/s.
    pub speed: f64,
    /// Without damping; an unbalance excites those that are not wholly backward.
    pub whirl: Whirl,
}

impl RotorModel {
    /// All critical speeds without damping, ascending. Motions e^{iΩt} at spin Ω are K p = Ω² (1 − iG) p, a
    /// Hermitian problem: nothing is looked for along lines, none is missed.
    ///
    /// # Errors
    /// A shaft that is not held.
    pub fn critical_speeds(&self) -> Result<Vec<Critical>, RotorError> {
        let frequency = self.natural.first().copied().unwrap_or(0.0);
        let is_sound = frequency > 0.0;
        if !is_sound {
            return Err(RotorError::Unheld { frequency });
        }
        let modes = self.natural.len();
        // The symmetric part of the stiffness is diagonal here, its entries the natural frequencies' squares.
        let inverse = DMatrix::from_fn(modes, modes, |i, j| {
            let inertia = if i == j { 1.0 } else { 0.0 };
            Complex::new(inertia, -self.gyroscopic[(i, j)]) / (self.natural[i] * self.natural[j])
        });
        let eigen = inverse.symmetric_eigen();
        let mut found: Vec<Critical> = Vec::new();
        for (mode, &value) in eigen.eigenvalues.iter().enumerate() {
            let is_speed = value > 0.0;
            if !is_speed {
                continue;
            }
            let speed = 1.0 / value.sqrt();
            let shape = eigen.eigenvectors.column(mode);
            let mut modal = shape.map_with_location(|i, _, x| x / self.natural[i]);
            let norm = modal.norm();
            modal.unscale_mut(norm);
            found.push(Critical { speed, whirl: self.motion(Complex::new(0.0, speed), modal) });
        }
        found.sort_by(|a, b| a.speed.total_cmp(&b.speed));
        Ok(found)
    }

    /// The speed near `critical` at which the motion's damped frequency is that of the spin, rad/s, to 1e-12 of it.
    ///
    /// # Errors
    /// Eigenvalues that are not found; damping so large that the motion does not oscillate there.
    pub fn damped_critical_speed(&self, critical: &Critical) -> Result<f64, RotorError> {
        let excess = |speed: f64| -> Result<f64, RotorError> {
            let whirls = self.whirls(speed, 2 * self.natural.len())?;
            let best = whirls
                .into_iter()
                .max_by(|a, b| critical.whirl.likeness(a).total_cmp(&critical.whirl.likeness(b)));
            let best = best.ok_or(RotorError::Eigenvalues { speed, iterations: 0 })?;
            Ok(best.frequency() - speed)
        };
        let mut from = (critical.speed, excess(critical.speed)?);
        let next = critical.speed + from.1;
        let mut to = (next, if from.1 == 0.0 { 0.0 } else { excess(next)? });
        for _ in 0..SECANTS {
            if (to.0 - from.0).abs() <= 1e-12 * critical.speed || to.1 == from.1 {
                return Ok(to.0);
            }
            let next = to.0 - to.1 * (to.0 - from.0) / (to.1 - from.1);
            (from, to) = (to, (next, excess(next)?));
        }
        Err(RotorError::Eigenvalues { speed: to.0, iterations: SECANTS })
    }
}

/// Steps of a secant; six are usual.
const SECANTS: usize = 40;
