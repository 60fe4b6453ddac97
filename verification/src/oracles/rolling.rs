//! Orbit of a ball that rolls on both races at two different contact angles.
//!
//! Rolling alone leaves the tilt of the ball's own axis open. Between no spin at the outer race and
//! none at the inner one it settles where the spin moments of both contacts balance.

use std::f64::consts::FRAC_PI_2;

/// One contact of the ball; angle in rad from the radial direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollingContact {
    /// From the ball's centre, m.
    pub arm: f64,
    pub angle: f64,
    /// N.
    pub load: f64,
    /// Semi-axis of the contact ellipse across the rolling direction, m.
    pub semi_axis: f64,
}

/// One ball between its races.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollingBall {
    /// Of the ball's centre about the bearing's axis, m.
    pub orbit_radius: f64,
    pub inner: RollingContact,
    pub outer: RollingContact,
}

impl RollingBall {
    /// Distances of both contacts from the bearing's axis, m.
    fn contact_radii(&self) -> [f64; 2] {
        let reach = |contact: RollingContact| contact.arm * contact.angle.cos();
        [self.orbit_radius - reach(self.inner), self.orbit_radius + reach(self.outer)]
    }

    /// Orbital speed over the inner race's, outer race at rest, for a ball whose own axis is tilted
    /// by `roll` out of the bearing's axis.
    ///
    /// Seen from the orbiting centre the outer race passes at ω_c (R + a cos α) and the inner one,
    /// the other way, at (Ω − ω_c)(R − a cos α); the ball's surface passes each contact at its spin
    /// times a cos(roll − α).
    pub fn orbit_ratio(&self, roll: f64) -> f64 {
        let [inner, outer] = self.contact_radii();
        let turns = |radius: f64, contact: RollingContact| {
            radius / (contact.arm * (roll - contact.angle).cos())
        };
        let (inner, outer) = (turns(inner, self.inner), turns(outer, self.outer));
        inner / (inner + outer)
    }

    /// Spin about the normals of the inner and the outer contact, ball against race, over the
    /// inner race's speed.
    pub fn spins(&self, roll: f64) -> [f64; 2] {
        let orbit = self.orbit_ratio(roll);
        let own =
            orbit * self.contact_radii()[1] / (self.outer.arm * (roll - self.outer.angle).cos());
        [
            (1.0 - orbit) * self.inner.angle.sin() - own * (roll - self.inner.angle).sin(),
            orbit * self.outer.angle.sin() + own * (roll - self.outer.angle).sin(),
        ]
    }

    /// Tilt of the ball's axis without spin at the outer race, and without spin at the inner one.
    pub fn race_control(&self) -> [f64; 2] {
        let limit = |contact: RollingContact, sign: f64| {
            let ratio = contact.arm / self.orbit_radius;
            contact.angle.sin().atan2(contact.angle.cos() + sign * ratio)
        };
        [limit(self.outer, 1.0), limit(self.inner, -1.0)]
    }

    /// Tilt at which both contacts brake the ball's spin equally, for a friction coefficient over
    /// the slide-to-roll ratio. The scale of the friction does not matter.
    pub fn balanced_roll(&self, friction: impl Fn(f64) -> f64) -> f64 {
        let excess = |roll: f64| {
            let [inner, outer] = self.spins(roll);
            let through = self.orbit_ratio(roll) * self.contact_radii()[1];
            let moment = |contact: RollingContact, spin: f64| {
                spin_moment(contact, spin.abs() / through, &friction)
            };
            moment(self.inner, inner) - moment(self.outer, outer)
        };
        let [mut low, mut high] = self.race_control();
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if excess(middle) > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }
}

/// Moment about the normal for a spin over the rolling speed (1/m): Hertz's pressure summed over
/// the rolling direction, 3W/4a (1 − y²/a²), times friction times |y|; with y = a sin φ, midpoints.
pub fn spin_moment(contact: RollingContact, spin: f64, friction: impl Fn(f64) -> f64) -> f64 {
    const COUNT: usize = 400;
    let width = FRAC_PI_2 / COUNT as f64;
    let half: f64 = (0..COUNT)
        .map(|i| {
            let (sin, cos) = ((i as f64 + 0.5) * width).sin_cos();
            let y = contact.semi_axis * sin;
            0.75 * cos * cos * cos * width * y * friction(spin * y)
        })
        .sum();
    2.0 * contact.load * half
}
