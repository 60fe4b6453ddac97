//! Critical speeds: whirl with the frequency of the spin.

use crate::vibrations::rotor::{RotorError, RotorModel, circulation};
use crate::vibrations::whirl::Whirl;
use nalgebra::{Complex, DMatrix, DVector};

/// A speed at which a mode whirls with the frequency of the spin.
#[derive(Clone, Debug, PartialEq)]
pub struct Critical {
    /// rad/s.
    pub speed: f64,
    /// The undamped mode; unbalance excites all that are not purely backward.
    pub whirl: Whirl,
}

impl RotorModel {
    /// All undamped critical speeds, ascending. Motions e^{iΩt} at spin Ω satisfy K p = Ω² A p with A = 1 − iG, a
    /// Hermitian problem for a symmetric K, so that none is missed; the skew-symmetric part of K
    /// is added afterwards. Rigid modes z without stiffness follow so that their load vanishes,
    /// A_zz p_z = −A_zb p_b, and leave A_bb − A_bz A_zz⁻¹ A_zb for the others.
    ///
    /// # Errors
    ///
    /// A shaft without any stiffness; a motion with cross-coupled stiffness alone; a free shaft with equal moments of inertia about and across its axis, which whirls
    /// once a turn at every speed.
    pub fn critical_speeds(&self) -> Result<Vec<Critical>, RotorError> {
        Ok(self.criticals()?.0)
    }

    /// Critical speeds, and the number of additional ones if rigid modes had a small stiffness: these would be the
    /// lowest.
    pub(crate) fn criticals(&self) -> Result<(Vec<Critical>, usize), RotorError> {
        let rigid = self.rigid();
        let modes = self.natural.len();
        let held = modes - rigid;
        if rigid > 0 && self.stiffness.rows(0, rigid).amax() > 0.0 {
            return Err(RotorError::OnlyCoupled);
        }
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
        // The symmetric part of the stiffness is diagonal here: squares of the natural frequencies.
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
        if circulation(&self.stiffness).is_some() {
            found = self.with_circulation(found)?;
        }
        found.sort_by(|a, b| a.speed.total_cmp(&b.speed));
        Ok((found, loose))
    }

    /// Crossings of the lines of undamped whirl with ω = Ω, found by secants from critical speeds with the symmetric
    /// part of the stiffness. A mode that no longer oscillates has none.
    fn with_circulation(&self, symmetric: Vec<Critical>) -> Result<Vec<Critical>, RotorError> {
        let modes = self.natural.len();
        let none = DMatrix::zeros(modes, modes);
        let undamped = RotorModel { damping: none.clone(), circulating: none, ..self.clone() };
        let mut found = Vec::with_capacity(symmetric.len());
        for Critical { mut speed, mut whirl } in symmetric {
            let mut before: Option<[f64; 2]> = None;
            for _ in 0..SECANTS {
                let alike = |of: &Whirl| of.modal.dotc(&whirl.modal).norm() / of.modal.norm();
                let at_speed = undamped.whirls(speed, modes)?;
                let Some(nearest) =
                    at_speed.into_iter().max_by(|a, b| alike(a).total_cmp(&alike(b)))
                else {
                    break;
                };
                whirl = nearest;
                let gap = whirl.frequency() - speed;
                if gap.abs() <= CROSSES * speed {
                    found.push(Critical { speed, whirl });
                    break;
                }
                let slope = before.map_or(-1.0, |[at, had]| (gap - had) / (speed - at));
                before = Some([speed, gap]);
                speed -= gap / slope;
            }
        }
        Ok(found)
    }
}

/// Relative distance of frequency and speed at a crossing, and secants after which there is none: 5 are usual.
const CROSSES: f64 = 1e-10;
const SECANTS: usize = 30;

/// Below this 1 − J/I of a rigid mode is rounding of equal inertias.
const SPHERE: f64 = 1e-9;
