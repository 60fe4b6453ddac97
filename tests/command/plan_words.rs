//! Texts of `check` and `plan` on shafts and steps, and parts that `check` refuses.

use crate::command_line_common::{changed, done, read, refused, scene, write};
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

#[test]
fn plans_of_shafts_have_plain_words() {
    let said = said_of(&["plan"], "rotor_run_up.toml", &[]);
    for part in [
        "the omitted modes, from 8044 Hz on, have up to 27 % of the static compliance at an attachment, which the correction modes contain",
        "1 unbalance at places along the body shaft",
        "mass-proportional, of bending; if of all motion",
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
    assert!(said.contains("of bending alone, mass-proportional"), "{said}");
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
    assert!(!plain.contains("cut to the coupling step"), "{plain}");
    let given = plan("", "step = \"1 us\"");
    assert!(given.contains("numerics.step = 1e-6 s is cut to the coupling step"), "{given}");
    let part = plan("step_fraction = 0.95\ncoupling_phase = 0.01\n", "");
    assert!(part.contains("housing.step_fraction = 0.95 becomes 0."), "{part}");
}

/// However many shapes a shaft has, and however stiff: steps of the search go by what bodies stand on.
#[test]
fn an_equilibrium_is_found_with_any_number_of_shapes() {
    let found = |below: &str| {
        let words = "damping = \"20 1/s\"";
        let with = format!("{words}\nmodes_to = \"{below}\"");
        let said = said_of(&["statics", "--dry"], "stepped_rotor.toml", &[(words, &with)]);
        let last = said.lines().find(|line| line.contains(" iterations, ")).unwrap();
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

/// Four-node cells are alike from one half of a shaft to the other, so that nothing is left but a couple.
#[test]
fn a_plan_tells_the_imbalance_of_a_mesh() {
    let plan = said_of(&["plan"], "rotor_in_elements.toml", &[]);
    assert!(plan.contains("an unbalance of a couple of 1600 g mm^2, which"), "{plan}");
}

/// A shaft thicker than the groove of the race on it, rubber that begins inside its race, sizes in a wrong unit.
#[test]
fn parts_that_do_not_go_together_are_refused() {
    let folder = tempdir().unwrap();
    let message = |shipped: &str, (from, to): (&str, &str)| {
        let text = changed(&read(Path::new(&scene(shipped))), from, to);
        refused(&["check", &write(folder.path(), "scene.toml", &text)])
    };
    let shaft = |diameter: &str| format!("outer_diameter = \"{diameter}\"");
    let thick = message("stepped_rotor.toml", ("outer_diameter = \"40 mm\"", &shaft("48.1 mm")));
    // The groove of the 6208 has 48 mm.
    assert!(thick.contains("body.rotor is 48.1 mm thick here, more than the 48 mm"), "{thick}");
    said_of(&["check"], "stepped_rotor.toml", &[("outer_diameter = \"40 mm\"", &shaft("47.9 mm"))]);
    let inner = |diameter: &str| format!("inner_diameter = \"{diameter}\"");
    let bushing = "bearing_on_bushing.toml";
    let inside = message(bushing, (&inner("71 mm"), &inner("70.9 mm")));
    assert!(inside.contains("spring.mount.bushing.inner_diameter: refused"), "{inside}");
    assert!(inside.contains("the rubber begins at 70.9 mm, inside the outer race"), "{inside}");
    let cage = "cage_600rpm.toml";
    for (change, allowed) in [
        (
            (
                "[bearing.inner_race]\ngroove_radius = \"6.600 mm\"",
                "[bearing.inner_race]\nconformity = 0.952",
            ),
            "more than 0.5 to less than 0.6",
        ),
        (
            (
                "[bearing.inner_race]\ngroove_radius = \"6.600 mm\"",
                "[bearing.inner_race]\ngroove_radius = \"11.3 mm\"",
            ),
            "more than 5.953 mm to 7.1436 mm",
        ),
        (("-9.80665 m/s^2", "-9806 m/s^2"), "from -2000 m/s^2 to 2000 m/s^2"),
        (
            (
                "[bearing.ball]\nradius = \"5.953 mm\"\nmaterial = { youngs_modulus = \"210 GPa\", poisson_ratio = 0.3, density = \"7850",
                "[bearing.ball]\nradius = \"5.953 mm\"\nmaterial = { youngs_modulus = \"210 GPa\", poisson_ratio = 0.3, density = \"7.85",
            ),
            "from 500 kg/m^3 to 25000 kg/m^3",
        ),
        (
            (
                "[bearing.ball]\nradius = \"5.953 mm\"\nmaterial = { youngs_modulus = \"210 GPa\"",
                "[bearing.ball]\nradius = \"5.953 mm\"\nmaterial = { youngs_modulus = \"210 MPa\"",
            ),
            "from 0.5 GPa to 1000 GPa",
        ),
    ] {
        let said = message(cage, change);
        assert!(said.contains(allowed), "{allowed}: {said}");
    }
}
