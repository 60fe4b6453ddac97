//! What `check`, `plan` and `modes` say of shafts and of steps, and what they leave unsaid where it does not apply.

use crate::command_line_common::{changed, done, read, scene, write};
use crate::housed_command_common::scene_text;
use std::path::Path;
use tempfile::tempdir;

/// What a command says of a shipped scene with these words changed.
fn said_of(command: &[&str], shipped: &str, changes: &[(&str, &str)]) -> String {
    let folder = tempdir().unwrap();
    let mut text = read(Path::new(&scene(shipped)));
    for (from, to) in changes {
        text = changed(&text, from, to);
    }
    let path = write(folder.path(), "scene.toml", &text);
    done(&[&command[..1], &[&path[..]], &command[1..]].concat())
}

/// Whirl is that of the speed at the end, the equilibrium that of t = 0; where they differ, a note says what balls feel.
#[test]
fn modes_of_a_ramp_say_at_which_speed_balls_are() {
    const RAMP: &str =
        "speed = { ramp = [\"0 rpm\", \"10000 rpm\"], start = \"0 s\", duration = \"0.2 s\" }";
    const FLUNG: (&str, &str) = ("[traction]", "[ball_forces]\ncentrifugal = true\n\n[traction]");
    let modes = |changes: &[(&str, &str)]| {
        let said = said_of(&["modes", "--dry"], "rotor_run_up.toml", changes);
        said.lines().filter(|line| line.starts_with("note: whirl is")).collect::<String>()
    };
    let ends =
        "at 10000 rpm, where the speed ends, about the equilibrium at t = 0, where it is 0 rpm";
    let without = modes(&[]);
    assert!(without.contains(ends) && without.contains("force is left out"), "{without}");
    let flung = modes(&[FLUNG]);
    assert!(flung.contains(ends) && flung.contains("is that at 0 rpm, too"), "{flung}");
    let from = modes(&[FLUNG, ("[\"0 rpm\"", "[\"3000 rpm\"")]);
    assert!(from.contains("is that at 3000 rpm, too"), "{from}");
    for changes in
        [&[(RAMP, "speed = \"10000 rpm\"")][..], &[FLUNG, (RAMP, "speed = \"10000 rpm\"")]]
    {
        assert_eq!(modes(changes), "");
    }
}

/// A shaft in elements is told what strikes it at the start where something does, and what its mesh is out of balance by where it is.
#[test]
fn a_shaft_in_elements_is_told_what_strikes_it() {
    const SMOOTH: &str = "z = { smooth_ramp = [\"0 N\", \"-600 N\"], duration = \"2 ms\" }";
    let plan = |changes: &[(&str, &str)]| said_of(&["plan"], "rotor_in_elements.toml", changes);
    let grown = plan(&[]);
    assert!(grown.contains("condensed onto its sections\n"), "{grown}");
    assert!(!grown.contains("strike it at the start"), "{grown}");
    // Four-node cells are alike from one half to the other, so that nothing is left but a couple.
    assert!(grown.contains("out of balance by a couple of 1600 g mm^2, which"), "{grown}");
    let sudden = plan(&[(SMOOTH, "z = \"-600 N\"")]);
    assert!(
        sudden.contains("so that loads that are there at t = 0 strike it at the start"),
        "{sudden}"
    );
    let weighs = (
        "[numerics]",
        "[ball_forces]\ngravity = [\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]\n\n[numerics]",
    );
    let out = ("watch = [", "unbalance = [{ at = \"0 mm\", size = \"1e-5 kg m\" }]\nwatch = [");
    let all = plan(&[weighs, out]);
    assert!(all.contains("so that gravity, unbalances at the speed of the start strike"), "{all}");
}

#[test]
fn plans_of_shafts_have_plain_words() {
    let said = said_of(&["plan"], "rotor_run_up.toml", &[]);
    for part in [
        "left out are natural ones from 8044 Hz on, whose part of the static compliance at a hold, up to 27 %, those answers have",
        "1 unbalance at places along the body shaft",
        "in proportion to mass, of bending; where it brakes all motion",
        "strikes of balls or races let it grow; at least",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let said = said_of(
        &["plan"],
        "rotor_run_up.toml",
        &[(
            "damping = \"100 1/s\"",
            "damping = \"100 1/s\"\ndamped_motion = \"relative-to-rigid\"",
        )],
    );
    assert!(said.contains("of bending alone, in proportion to mass"), "{said}");
    assert!(!said.contains("dashpots to the ground under"), "{said}");
}

#[test]
fn check_tells_what_a_shaft_weighs() {
    // 7850 kg/m³ π/4 (30 mm)² 400 mm, and the disc.
    let shaft = 7850.0 * std::f64::consts::PI / 4.0 * 0.03 * 0.03 * 0.4;
    let said = said_of(&["check"], "rotor_run_up.toml", &[]);
    let (_, after) = said.split_once("  body shaft             ").expect(&said);
    let mass: f64 = after.split_once(" kg; 5 of 6").expect(after).0.parse().unwrap();
    assert!((mass / (shaft + 20.0) - 1.0).abs() <= 1e-5, "{mass}");
    let said = said_of(&["check"], "shaft_back_to_back.toml", &[]);
    assert!(said.contains("body shaft             0.67 kg; "), "{said}");
}

/// No step is longer than a window between two exchanges, whatever is asked for.
#[test]
fn steps_that_windows_cut_are_told() {
    let folder = tempdir().unwrap();
    let plan = |housing: &str, numerics: &str| {
        let housing = format!("method = \"explicit\"\n{housing}");
        let text = scene_text(&housing, &format!("[numerics]\nend = \"20 us\"\n{numerics}"));
        done(&["plan", &write(folder.path(), "scene.toml", &text)])
    };
    let plain = plan("", "");
    assert!(!plain.contains("cut to the window"), "{plain}");
    let given = plan("", "step = \"1 us\"");
    assert!(given.contains("numerics.step = 1e-6 s is cut to the window"), "{given}");
    let part = plan("step_fraction = 0.95\nwindow_phase = 0.01\n", "");
    assert!(part.contains("housing.step_fraction = 0.95 comes to 0."), "{part}");
}

/// However many shapes a shaft has, and however stiff: steps of the search go by what bodies stand on.
#[test]
fn an_equilibrium_is_found_with_any_number_of_shapes() {
    let found = |below: &str| {
        let words = "damping = \"20 1/s\"";
        let with = format!("{words}\nbelow = \"{below}\"");
        let said = said_of(&["statics", "--dry"], "stepped_rotor.toml", &[(words, &with)]);
        let last = said.lines().last().unwrap().to_string();
        let iterations: usize = last.split(' ').next().unwrap().parse().unwrap();
        let x = said.lines().find(|line| line.trim_start().starts_with("x ")).unwrap();
        (iterations, x.to_string())
    };
    let few = found("3 kHz");
    for below in ["10 kHz", "300 kHz", "1000 kHz"] {
        let more = found(below);
        // A start in the air takes some fifteen; without a place to go it was two thousand.
        assert!(more.0 <= few.0 + 5, "{below}: {more:?} {few:?}");
        assert_eq!(more.1, few.1, "{below}");
    }
}

/// What cannot stand where it is written is told: a shaft thicker than the race on it, rubber inside its race or beside it.
#[test]
fn parts_that_do_not_go_together_are_told() {
    let shaft = |diameter: &str| {
        let to = format!("outer_diameter = \"{diameter}\"");
        said_of(&["check"], "stepped_rotor.toml", &[("outer_diameter = \"40 mm\"", &to)])
    };
    // The groove of the 6208 has 48 mm.
    assert!(shaft("48.1 mm").contains(
        "is 48.1 mm thick where the inner race of bearing fan sits, whose groove has a diameter of 48 mm"
    ));
    assert!(!shaft("47.9 mm").contains("does not go through"));
    let check =
        |from: &str, to: &str| said_of(&["check"], "bearing_on_bushing.toml", &[(from, to)]);
    let inside = check("inner_diameter = \"71 mm\"", "inner_diameter = \"70.9 mm\"");
    assert!(inside.contains(
        "begins at a diameter of 70.9 mm, inside the outer race that it holds, of 71 mm"
    ));
    let beside = check("[spring.mount.bushing]", "from_at = \"50 mm\"\n[spring.mount.bushing]");
    assert!(
        beside.contains("bushing mount holds the outer race 50 mm beside the race's middle"),
        "{beside}"
    );
    assert!(
        !check("inner_diameter = \"71 mm\"", "inner_diameter = \"71.0 mm\"")
            .contains("inside the outer race")
    );
}

/// Sizes that are allowed and hardly meant are told by `check` and `statics`, and by `plan` of one: an osculation read as a conformity, a cage in a wrong unit, rubber
/// that begins inside its race, springs fitted for slower motions, contacts without spin.
#[test]
fn sizes_that_are_hardly_meant_are_told() {
    let bushing = "bearing_on_bushing.toml";
    let cage = "cage_600rpm.toml";
    let mass = "mass = \"0.069 kg\"";
    let blow = "z = { load = { half_sine = \"-500 N\", base = \"0 N\", start = \"20 ms\", duration = \"0.5 ms\" } }";
    let as_shipped = [bushing, cage].map(|shipped| said_of(&["check"], shipped, &[]));
    let swings =
        "z = { load = { mean = \"-300 N\", amplitude = \"1 N\", frequency = \"200 Hz\" } }";
    for (shipped, changes, words) in [
        (
            cage,
            vec![(
                "[bearing.inner_race]\ngroove_radius = \"6.600 mm\"",
                "[bearing.inner_race]\nconformity = 0.952",
            )],
            "inner groove's radius is 0.952 of the ball's diameter",
        ),
        (cage, vec![(mass, "mass = \"69 kg\"")], "mm long around balls of 11.91 mm"),
        (cage, vec![(mass, "mass = \"0.069 g\"")], "mm long around balls of 11.91 mm"),
        (cage, vec![("-9.80665 m/s^2", "-9.81 g")], "gravity is 96.2 m/s^2"),
        (
            cage,
            vec![(
                "[bearing.ball]\nradius = \"5.953 mm\"\nmaterial = { youngs_modulus = \"210 GPa\", poisson_ratio = 0.3, density = \"7850",
                "[bearing.ball]\nradius = \"5.953 mm\"\nmaterial = { youngs_modulus = \"210 GPa\", poisson_ratio = 0.3, density = \"7.85",
            )],
            "the balls: a density of 7.85 kg/m^3",
        ),
        (
            bushing,
            vec![("inner_diameter = \"71 mm\"", "inner_diameter = \"70.9 mm\"")],
            "inside the outer race that it holds",
        ),
        (
            bushing,
            vec![
                ("inner_diameter = \"71 mm\"", "inner_diameter = \"71 mm\"\nfastest = \"100 Hz\""),
                (blow, swings),
            ],
            "(200 Hz) is faster than the 100 Hz to which the springs of mount answer",
        ),
    ] {
        // A plan of a bushing would look how far its springs hold, which takes seconds.
        let planned = shipped == cage && words.contains("gravity");
        for command in if planned { vec!["check", "plan"] } else { vec!["check"] } {
            let told = said_of(&[command], shipped, &changes);
            assert_eq!(told.matches(words).count(), 1, "{command}: {told}");
        }
        assert!(!as_shipped[usize::from(shipped == cage)].contains(words), "{words}");
        let told = said_of(&["statics", "--dry"], shipped, &changes);
        assert!(told.contains(words), "statics: {told}");
    }
    let told = said_of(&["check"], cage, &[("slices = 15", "slices = 1")]);
    assert!(told.contains("friction from spin is left out"), "{told}");
}
