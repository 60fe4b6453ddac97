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
fn spin_moment(contact: RollingContact, spin: f64, friction: impl Fn(f64) -> f64) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(arm: f64, angle: f64) -> RollingContact {
        RollingContact { arm, angle, load: 70.0, semi_axis: 0.3 }
    }

    #[test]
    fn one_angle_gives_the_textbook_ratio_whatever_the_tilt() {
        for degrees in [0.0, 15.0, 35.26, 60.0] {
            let angle = f64::to_radians(degrees);
            let same = contact(5.953, angle);
            let ball = RollingBall { orbit_radius: 30.0, inner: same, outer: same };
            let textbook = 0.5 * (1.0 - 5.953 / 30.0 * angle.cos());
            for tilt in [-0.1, 0.0, 0.1] {
                let ratio = ball.orbit_ratio(angle + tilt);
                assert!((ratio - textbook).abs() <= 1e-15, "{degrees}: {ratio}");
            }
        }
    }

    /// Velocities of both surfaces at both contacts, and spins, written out with vectors.
    #[test]
    fn nothing_slides_at_either_contact() {
        let ball =
            RollingBall { orbit_radius: 30.0, inner: contact(5.9, 0.7), outer: contact(5.8, 0.6) };
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        for roll in [0.5f64, 0.65, 0.8] {
            let orbit = ball.orbit_ratio(roll);
            // Axes: bearing, radial, tangential. The ball turns against the orbit, across its contacts.
            let spin = |own: f64| [orbit - own * roll.cos(), own * roll.sin(), 0.0];
            let surface = |own: f64, arm: [f64; 3]| orbit * 30.0 + cross(spin(own), arm)[2];
            let outer = [5.8 * 0.6f64.sin(), 5.8 * 0.6f64.cos(), 0.0];
            let inner = [-5.9 * 0.7f64.sin(), -5.9 * 0.7f64.cos(), 0.0];
            // The spin that stops the surface at the outer contact; it is linear in the spin.
            let (at_0, at_1) = (surface(0.0, outer), surface(1.0, outer));
            let own = at_0 / (at_0 - at_1);
            let slip = surface(own, inner) - (30.0 + inner[1]);
            assert!(slip.abs() <= 1e-12, "{roll}: {slip}");
            let turning = spin(own);
            let [spin_inner, spin_outer] = ball.spins(roll);
            let about_outer = turning[0] * 0.6f64.sin() + turning[1] * 0.6f64.cos();
            let about_inner = (turning[0] - 1.0) * 0.7f64.sin() + turning[1] * 0.7f64.cos();
            assert!((about_outer.abs() - spin_outer.abs()).abs() <= 1e-12, "{roll}");
            assert!((about_inner.abs() - spin_inner.abs()).abs() <= 1e-12, "{roll}");
        }
        let [outer_control, inner_control] = ball.race_control();
        assert!(ball.spins(outer_control)[1].abs() <= 1e-12);
        assert!(ball.spins(inner_control)[0].abs() <= 1e-12);
    }

    #[test]
    fn constant_friction_gives_the_known_spin_moment() {
        let here = contact(5.9, 0.6);
        let moment = spin_moment(here, 1.0, |_| 0.1);
        let known = 3.0 * 0.1 * 70.0 * 0.3 / 8.0;
        assert!((moment / known - 1.0).abs() <= 1e-5, "{moment} {known}");
    }
}
