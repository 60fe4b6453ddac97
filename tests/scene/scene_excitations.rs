//! Excitation frequencies of a scene, whichever table describes the bodies that drive it.

use super::scene_dynamics::{BEARING, resolved};

use bearing_dynamics::scene::build::excitations::excitations;
use bearing_dynamics::scene::build::statics::kinematic_ratios;
use bearing_dynamics::scene::{Document, Format, Subject, resolve_subject};

fn document(text: &str) -> Document {
    Document::read_str(text, Format::Toml, "test.toml").unwrap_or_else(|error| panic!("{error}"))
}

/// Frequency at which balls pass a rotating load on the inner race, Hz; speeds of the races and of the load in rpm.
///
/// `on_bodies`: the inner and the outer race are mounted on a body with a table of its own.
fn passing(on_bodies: [bool; 2], [inner, outer, load]: [f64; 3]) -> f64 {
    let load = format!("rotating_load = {{ force = \"10 N\", speed = \"{load} rpm\" }}\n");
    let inertia =
        "inertia = { mass = \"1 kg\", axial = \"1e-3 kg m^2\", transverse = \"1e-3 kg m^2\" }\n";
    let mut text = BEARING.to_string();
    text += if on_bodies[0] { "bearing.inner_on = \"shaft\"\n" } else { "" };
    text += if on_bodies[1] { "bearing.outer_on = \"hub\"\n" } else { "" };
    text += &match on_bodies[0] {
        true => format!("[body.shaft]\nspeed = \"{inner} rpm\"\n{load}{inertia}"),
        false => format!("[inner_race]\nspeed = \"{inner} rpm\"\n{load}"),
    };
    text += &match on_bodies[1] {
        true => format!("[body.hub]\nspeed = \"{outer} rpm\"\n{inertia}"),
        false => format!("[outer_race]\nmotion = \"5-dof\"\nspeed = \"{outer} rpm\"\n"),
    };
    let subject = resolve_subject(&document(&text)).unwrap_or_else(|error| panic!("{error}"));
    let Subject::Assembly(scene) = subject else { panic!("a scene of a bearing") };
    let all = excitations(&scene);
    let passing: Vec<f64> =
        all.iter().filter(|one| one.is_ripple).map(|one| one.frequency).collect();
    let [frequency] = passing[..] else { panic!("{all:?}") };
    frequency
}

/// Balls pass a load at their count times the speed of the load relative to them, whichever table turns the races.
#[test]
fn balls_pass_the_load_alike_on_races_and_on_bodies() {
    let cage = kinematic_ratios(&resolved(&document(BEARING))).cage;
    for speeds in [
        [600.0, 0.0, 0.0],
        [0.0, 600.0, 0.0],
        [600.0, 1000.0, 0.0],
        [600.0, -1000.0, 0.0],
        [-300.0, 700.0, 250.0],
        [400.0, 400.0, -90.0],
    ] {
        let [inner, outer, load] = speeds;
        let expected = 8.0 * (load - cage * inner - (1.0 - cage) * outer).abs() / 60.0;
        for on_bodies in [[false, false], [true, false], [false, true], [true, true]] {
            let found = passing(on_bodies, speeds);
            // Rounding of a few products.
            assert!(
                (found / expected - 1.0).abs() <= 1e-12,
                "{on_bodies:?} {speeds:?}: {found} {expected}"
            );
        }
    }
}
