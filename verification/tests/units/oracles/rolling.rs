//! Balls that roll between two races, written out with vectors.

use verification::oracles::rolling::{RollingBall, RollingContact, spin_moment};

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
