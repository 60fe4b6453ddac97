//! Deviations of raceways and balls from their ideal shape: dents, spalls, waviness.
//!
//! Each is a function of place that reduces the approach δ of a contact by Δ. The contact stores the energy
//! U = (2/5) K_H w^{5/2} with w = δ − Δ, and all its forces are derivatives of U.

use crate::ch3_bushing::dent::Dent;
use crate::ch5_cage::spall::SpallShape;
use crate::kinematics::vec3::Vec3;

/// Part that has a profile, and the place on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    Race {
        /// 0 inner, 1 outer.
        side: usize,
        /// Angle around the race from its own Y towards its own Z, rad; rotates with the race.
        angle: f64,
        /// Angle around the groove from its bottom towards the race's X, rad.
        groove_angle: f64,
    },
    Ball {
        /// Index of the ball, from 0.
        ball: usize,
        /// Angle about the ball's X from its own Y towards its own Z, and from there towards its own X, rad. A ball's
        /// own axes are those of the scene at the start.
        angle: f64,
        groove_angle: f64,
    },
}

impl Surface {
    /// Direction of the place in the ball's own axes, unit vector.
    pub fn direction(angle: f64, groove_angle: f64) -> Vec3 {
        let ((sin, cos), (up, out)) = (libm::sincos(angle), libm::sincos(groove_angle));
        [up, out * cos, out * sin]
    }
}

/// A spall (5.4.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spall {
    pub shape: SpallShape,
    pub on: Surface,
}

/// Waviness of a race around its axis: Δ = −A cos(n θ + φ), θ from the race's own Y. Crests (cosine 1) increase the
/// approach by A. On a ball θ is the angle between the contact and the pole of the wave, and φ = 0: the wave is the same
/// on each great circle through the pole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waviness {
    /// Waves per revolution n.
    pub order: f64,
    /// A, m.
    pub amplitude: f64,
    /// φ, rad.
    pub phase: f64,
    /// Race, whose angles are not used, or ball with the pole of the wave.
    pub on: Surface,
}

impl Waviness {
    /// Loss of approach Δ (m) at an angle θ (rad), and its slope, m/rad.
    #[inline]
    pub fn lost(&self, theta: f64) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.order * theta + self.phase);
        [-self.amplitude * cos, self.amplitude * self.order * sin]
    }
}

/// Deviation of a raceway or a ball from its ideal shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RacewayProfile {
    Dent(Dent),
    Spall(Spall),
    Waviness(Waviness),
}

impl RacewayProfile {
    /// Returns whether the profile leaves the shape ideal.
    pub fn vanishes(&self) -> bool {
        match self {
            RacewayProfile::Dent(dent) => dent.shape.vanishes(),
            RacewayProfile::Spall(spall) => spall.shape.vanishes(),
            RacewayProfile::Waviness(wave) => wave.amplitude == 0.0,
        }
    }

    pub fn is_on_ball(&self) -> bool {
        let on = match self {
            RacewayProfile::Dent(_) => return false,
            RacewayProfile::Spall(spall) => &spall.on,
            RacewayProfile::Waviness(wave) => &wave.on,
        };
        matches!(on, Surface::Ball { .. })
    }
}
