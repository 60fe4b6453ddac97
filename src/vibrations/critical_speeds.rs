//! Critical speeds: where a motion whirls once a turn.

use crate::vibrations::rotor::{RotorError, RotorModel};
use crate::vibrations::whirl::Whirl;
use nalgebra::{Complex, DMatrix, DVector};

/// A speed at which a motion has the frequency of the spin.
#[derive(Clone, Debug, PartialEq)]
pub struct Critical {
    /// rad/s.
    pub speed: f64,
    /// Without damping; an unbalance excites those that are not wholly backward.
    pub whirl: Whirl,
}

impl RotorModel {
    /// All critical speeds without damping, ascending. Motions e^{iΩt} at spin Ω are K p = Ω² A p with A = 1 − iG, a
    /// Hermitian problem: nothing is looked for along lines, none is missed. Rigid motions z, which nothing holds, go along so
    /// that no load is left on them, A_zz p_z = −A_zb p_b, and leave A_bb − A_bz A_zz⁻¹ A_zb of the others.
    ///
    /// # Errors
    /// A shaft none of whose motions is held, or one that nothing holds and whose inertia about its axis is that across it, which whirls
    /// once a turn at every speed.
    pub fn critical_speeds(&self) -> Result<Vec<Critical>, RotorError> {
        Ok(self.criticals()?.0)
    }

    /// The same, and how many more there would be if rigid motions were held, however weakly: these would be the slowest.
    pub(crate) fn criticals(&self) -> Result<(Vec<Critical>, usize), RotorError> {
        let rigid = self.natural.iter().filter(|&&natural| natural == 0.0).count();
        let modes = self.natural.len();
        let held = modes - rigid;
        if held == 0 {
            return Err(RotorError::Unheld);
        }
        let turning = DMatrix::from_fn(modes, modes, |i, j| {
            Complex::new(if i == j { 1.0 } else { 0.0 }, -self.gyroscopic[(i, j)])
        });
        let (across, own) = (turning.view((0, rigid), (rigid, held)), rigid..modes);
        let mut follows = turning.view((0, 0), (rigid, rigid)).into_owned();
        let mut loose = 0;
        if rigid > 0 {
            let values = follows.clone().symmetric_eigenvalues();
            if values.iter().any(|value| value.abs() <= SPHERE) {
                return Err(RotorError::Sphere);
            }
            loose = values.iter().filter(|value| **value > 0.0).count();
            follows = -follows.lu().solve(&across).ok_or(RotorError::Sphere)?;
        } else {
            follows = DMatrix::zeros(0, held);
        }
        let inertia = turning.view((rigid, rigid), (held, held)) + across.adjoint() * &follows;
        // The symmetric part of the stiffness is diagonal here, its entries the natural frequencies' squares.
        let inverse = DMatrix::from_fn(held, held, |i, j| {
            inertia[(i, j)] / (self.natural[rigid + i] * self.natural[rigid + j])
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
            let bent = shape.map_with_location(|i, _, x| x / self.natural[rigid + i]);
            let mut modal = DVector::zeros(modes);
            modal.rows_mut(0, rigid).copy_from(&(&follows * &bent));
            modal.rows_range_mut(own.clone()).copy_from(&bent);
            let norm = modal.norm();
            modal.unscale_mut(norm);
            found.push(Critical { speed, whirl: self.motion(Complex::new(0.0, speed), modal) });
        }
        found.sort_by(|a, b| a.speed.total_cmp(&b.speed));
        Ok((found, loose))
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
            let best = best.ok_or(RotorError::DampedCritical { near: critical.speed })?;
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
        Err(RotorError::DampedCritical { near: critical.speed })
    }
}

/// Steps of a secant; six are usual.
const SECANTS: usize = 40;
/// 1 − J/I of a rigid motion below this is none: rounding of inertias that are the same.
const SPHERE: f64 = 1e-9;
