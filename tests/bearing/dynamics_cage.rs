//! Where a cage touches: its pockets and its guide against the surfaces they stand for.

use crate::{common, dynamics};

use bearing_dynamics::ch2_housing::bearing::cage::{
    AxisMotion, CageContacts, Guidance, Pocket, guide_contact, pocket_contact,
};
use bearing_dynamics::kinematics::vec3::{add, add_scaled, cross, dot, norm, scale, sub};
use common::table_4_1;
use dynamics::cage;

const AXIS: [f64; 3] = [1.0, 0.0, 0.0];

fn at_rest(position: [f64; 3]) -> AxisMotion {
    AxisMotion { position, axis: AXIS, ..AxisMotion::default() }
}

fn law(pocket: Pocket, guidance: Guidance) -> CageContacts {
    cage(&table_4_1(0.0), pocket, guidance).contacts
}

/// Unit vector across the axis.
fn across(angle: f64) -> [f64; 3] {
    [0.0, angle.cos(), angle.sin()]
}

/// How deep a ball lies in the wall, which is rounded to the last bits of a position of 26 mm.
fn assert_depth(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-16, "{found} m for {expected} m");
}

#[test]
fn a_ball_has_the_room_of_its_pocket() {
    let radius = table_4_1(0.0).ball_radius;
    let cage = at_rest([1e-4, -2e-4, 3e-4]);
    let towards = across(0.7);
    let sideways = cross(AXIS, towards);
    for pocket in [Pocket::Cylindrical, Pocket::Spherical] {
        let law = law(pocket, Guidance::OuterRace);
        let room = law.pocket_radius - radius;
        assert!(room > 0.0 && law.pocket_pitch_radius != law.guide_radius);
        let centre = add_scaled(cage.position, law.pocket_pitch_radius, towards);
        let touch = |from_centre| {
            pocket_contact(&law, &cage, towards, &at_rest(add(centre, from_centre)), radius)
        };
        // All round the pocket, just before and just after the ball's surface meets the wall.
        for i in 0..8 {
            let (sin, cos) = f64::sin_cos(0.3 + f64::from(i));
            let way = add(scale(AXIS, cos), scale(sideways, sin));
            for beyond in [-1e-6, 1e-6] {
                let contact = touch(scale(way, room + beyond));
                assert_depth(contact.penetration, beyond);
                assert_eq!(contact.normal_load > 0.0, beyond > 0.0);
                // Back to the middle.
                assert!(dot(contact.force, way) <= 0.0);
            }
        }
        // Along the pocket's own axis: a hole lets the ball through, a sphere holds it.
        let depth = touch(scale(towards, room + 1e-6)).penetration;
        assert_depth(depth, if pocket == Pocket::Spherical { 1e-6 } else { -room });
    }
}

#[test]
fn a_pocket_brakes_a_ball_that_spins_in_it() {
    let radius = table_4_1(0.0).ball_radius;
    let towards = across(0.0);
    for pocket in [Pocket::Cylindrical, Pocket::Spherical] {
        let law = law(pocket, Guidance::OuterRace);
        // Pressed against the front wall (along X), spinning about the pocket's axis.
        let room = law.pocket_radius - radius;
        let mut ball = at_rest([room + 5e-6, law.pocket_pitch_radius, 0.0]);
        ball.spin = [0.0, 200.0, 0.0];
        let contact = pocket_contact(&law, &at_rest([0.0; 3]), towards, &ball, radius);
        // Where it touches, its surface moves along ω × r X = −Z; friction pushes it along +Z, and
        // its moment takes spin away.
        let friction = contact.force[2];
        let arm = sub(contact.point, ball.position);
        let moment = cross(arm, contact.force)[1];
        // Slip of 1.2 m/s beside a regularisation of 0.01: Coulomb's law to 4e-5.
        let coulomb = law.friction * contact.normal_load;
        assert!((friction / coulomb - 1.0).abs() <= 1e-4, "{friction} N of {coulomb} N");
        assert!((moment / (-coulomb * radius) - 1.0).abs() <= 1e-4, "{moment} N·m");
        assert!((contact.power / (-coulomb * radius * 200.0) - 1.0).abs() <= 1e-4);
    }
}

#[test]
fn a_cage_touches_its_guide_where_both_surfaces_are() {
    for (guidance, side) in [(Guidance::OuterRace, 1.0), (Guidance::InnerRace, -1.0)] {
        let law = law(Pocket::Cylindrical, guidance);
        // The race's surface lies beyond the cage's by the clearance.
        let surface = law.guide_radius + side * law.race_clearance;
        let race = at_rest([1e-3, 2e-4, -3e-4]);
        let way = across(2.2);
        for beyond in [-1e-6, 1e-6] {
            let moved = scale(way, law.race_clearance + beyond);
            let cage = at_rest(add(race.position, moved));
            for end in [-1.0, 1.0] {
                let contact = guide_contact(&law, &cage, &race, end);
                assert_depth(contact.penetration, beyond);
                assert_eq!(contact.normal_load > 0.0, beyond > 0.0);
                if beyond < 0.0 {
                    continue;
                }
                let arm = sub(contact.point, race.position);
                assert!((arm[0] - 0.5 * end * law.length).abs() <= 1e-16);
                let radial = norm([0.0, arm[1], arm[2]]);
                assert!((radial - surface).abs() <= 1.001 * beyond, "{radial} for {surface}");
                // The race is pushed the way the cage has gone.
                assert!((dot(contact.force, way) / contact.normal_load - 1.0).abs() <= 1e-12);
            }
        }
    }
}

#[test]
fn a_tilted_cage_touches_with_its_ends() {
    for guidance in [Guidance::OuterRace, Guidance::InnerRace] {
        let law = law(Pocket::Cylindrical, guidance);
        let race = at_rest([0.0; 3]);
        // Half the length moves out by its sine.
        let touching = (2.0 * law.race_clearance / law.length).asin();
        for (share, loaded) in [(0.999, false), (1.001, true)] {
            let (sin, cos) = f64::sin_cos(share * touching);
            // Turned about Y.
            let cage = AxisMotion { axis: [cos, 0.0, -sin], ..at_rest([0.0; 3]) };
            let ends = [-1.0, 1.0].map(|side| guide_contact(&law, &cage, &race, side));
            assert!(ends.iter().all(|end| (end.normal_load > 0.0) == loaded), "{ends:?}");
            let force = add(ends[0].force, ends[1].force);
            let moment = ends.map(|end| cross(end.point, scale(end.force, -1.0))[1]);
            let size = ends[0].normal_load;
            assert!(norm(force) <= 1e-9 * size);
            // The cage is turned back: both ends by their load and their arm.
            let expected = -size * law.length * cos;
            assert!((moment[0] + moment[1] - expected).abs() <= 1e-6 * expected.abs());
        }
    }
}
