//! Springs that begin at bodies that spin, and what speed and unbalance do that an equilibrium or its motions leave out.

use super::run_command::{bearing, code, run, said};
use crate::solid_command_common::{Place, column, json, number, stderr};

use std::f64::consts::TAU;

/// A bearing that touches nothing: a scene has one.
const BEARING: &str = r#"
[bearing.dummy]
kind = "deep-groove"
balls = 8
clearance = { radial = "0 um" }
ball = { radius = "5.953 mm" }
inner_race = { radius = "20.047 mm", groove_radius = "6.013 mm" }
outer_race = { groove_radius = "6.310 mm" }
inner_on = "inner_race"
[inner_race.dummy]
x = { displacement = "0 um" }
y = { displacement = "0 um" }
z = { displacement = "0 um" }
tilt_y = { tilt = "0 deg" }
tilt_z = { tilt = "0 deg" }
[traction]
law = "none"
[output]
plots = []
"#;

/// A disc on springs, which begin at it or at the ground.
fn disc(ends: &str, damping: &str, numerics: &str) -> String {
    format!(
        r#"{BEARING}
[body.disc]
speed = "6000 rpm"
inertia = {{ mass = "2 kg", axial = "4e-3 kg m^2", transverse = "5e-3 kg m^2" }}
z = {{ load = {{ half_sine = "-5 N", duration = "1 ms" }} }}
[spring.mount]
{ends}
stiffness = {{ x = "1e6 N/m", y = "2e5 N/m", z = "2e5 N/m", turn_y = "2000 N m/rad", turn_z = "2000 N m/rad" }}
damping = {damping}
[numerics]
output_interval = "0.1 ms"
accuracy = 1e-5
{numerics}
"#
    )
}

/// 2 kg on 2e5 N/m and 100 N s/m, of which the dashpot turns at 628 rad/s: m s² + c s + k − iΩc = 0 grows by 24.2 1/s. So say `modes`
/// and a run.
#[test]
fn a_dashpot_that_turns_feeds_whirl_in_modes_and_in_a_run() {
    let place = Place::new();
    let alike = r#"{ y = "100 N s/m", z = "100 N s/m" }"#;
    for (ends, turning) in
        [("from = \"disc\"", TAU * 100.0), ("from = \"ground\"\nto = \"disc\"", 0.0)]
    {
        // (−c + √(c² − 4m(k − iΩc)))/2m.
        let [m, c, k] = [2.0, 100.0, 2e5];
        let inside = [c * c - 4.0 * m * k, 4.0 * m * turning * c];
        let size = libm::hypot(inside[0], inside[1]);
        let root = [((size + inside[0]) / 2.0).sqrt(), ((size - inside[0]) / 2.0).sqrt()];
        let [growth, speed] = [(root[0] - c) / (2.0 * m), root[1] / (2.0 * m)];
        let ratio = -growth / libm::hypot(growth, speed);

        let scene = place.scene("scene.toml", &disc(ends, alike, "end = \"0.15 s\""));
        let out = place.path("modes");
        let output = bearing(&["modes", scene.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let summary = json(out.join("summary.json"));
        let ratios = summary["rotor"]["whirl"].as_array().unwrap().iter();
        let ratios = ratios.map(|whirl| number(&whirl["damping_ratio"]));
        let nearest = ratios.map(|found| (found / ratio - 1.0).abs()).fold(f64::INFINITY, f64::min);
        assert!(nearest <= 1e-9, "{ratio}: {nearest:e}");
        assert_eq!(said(&output).contains(" grows at 6000.0 rpm"), turning != 0.0);

        let out = place.path("run");
        let output = run(&scene, &out, &[]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let [y, z] = ["disc_y", "disc_z"].map(|name| column(&out, name));
        // The growing motion turns at a speed of its own, so that its radius alone tells the growth; what else there is has died away.
        let radius = |row: usize| libm::hypot(y[row], z[row]);
        if turning != 0.0 {
            let found = (radius(1500) / radius(1000)).ln() / 0.05;
            // Of the backward motion e^(−98 · 0.1) of the forward one is left.
            assert!((found / growth - 1.0).abs() <= 2e-3, "{found} {growth}");
        }
    }
}

/// Unlike along y and z, forces change as the body turns: there is no whirl to tell, and `modes` says why.
#[test]
fn whirl_on_an_uneven_spring_that_turns_is_not_told() {
    let place = Place::new();
    let uneven = r#"{ y = "100 N s/m", z = "50 N s/m" }"#;
    for (ends, told) in [("from = \"disc\"", false), ("from = \"ground\"\nto = \"disc\"", true)] {
        let scene = place.scene("scene.toml", &disc(ends, uneven, "end = \"1 ms\""));
        let output = bearing(&["modes", scene.to_str().unwrap(), "--dry"]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let said = said(&output);
        assert_eq!(said.contains("whirl at 6000.0 rpm"), told, "{said}");
        let why = "are not told: the spring mount turns with the body where it begins";
        assert_eq!(said.contains(why), !told, "{said}");
    }
}

/// A spring holds nothing that has gone a metre, and knows no more than half a turn.
#[test]
fn springs_beyond_their_reach_end_a_run() {
    let place = Place::new();
    let flying =
        disc("from = \"disc\"", "{ y = \"1000 N s/m\", z = \"1000 N s/m\" }", "end = \"2 s\"");
    let wound = disc("from = \"ground\"\nto = \"disc\"", "{ y = \"1 N s/m\" }", "end = \"20 ms\"")
        .replace("turn_y = \"2000", "turn_x = \"1 N m/rad\", turn_y = \"2000");
    for (text, how) in [
        (flying, "m, more than 1 m, up to which it is a spring"),
        (wound, "the spring mount is turned by 160.0"),
    ] {
        let scene = place.scene("scene.toml", &text);
        let out = place.path("out");
        let output = run(&scene, &out, &[]);
        assert_eq!(code(&output), 2, "{}", said(&output));
        assert!(stderr(&output).contains(how), "{}", stderr(&output));
        assert!(column(&out, "disc_y").len() > 10);
    }
    // What a trial comes to is told instead of how many steps the run would take.
    let output = bearing(&["plan", place.path("scene.toml").to_str().unwrap()]);
    let told = said(&output);
    assert!(told.contains("as the run will: the spring mount is turned by 160.0"), "{told}");
    assert!(!told.contains("steps to t = "), "{told}");
}

/// Whirl is of the bearings' stiffness at one speed, with or without the balls' centrifugal force.
#[test]
fn modes_say_which_centrifugal_force_they_have() {
    let place = Place::new();
    let scene = |further: &str| {
        let text = format!(
            r#"
[bearing]
kind = "angular-contact"
balls = 11
pitch_radius = "30 mm"
contact_angle = "35 deg"
inner_race = {{ groove_radius = "6.4 mm", bore_radius = "20 mm" }}
outer_race = {{ groove_radius = "6.6 mm" }}
ball = {{ radius = "5.953 mm" }}
[inner_race]
speed = "30000 rpm"
inertia = {{ mass = "0.5 kg", axial = "2e-4 kg m^2", transverse = "1.5e-4 kg m^2" }}
x = {{ load = "800 N" }}
{further}
[traction]
law = "none"
"#
        );
        place.scene("scene.toml", &text)
    };
    let modes = |further: &str| {
        let output = bearing(&["modes", scene(further).to_str().unwrap(), "--dry"]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        said(&output)
    };
    let with = modes("[ball_forces]\ncentrifugal = true");
    assert!(with.contains("hold near 30000 rpm alone"), "{with}");
    assert!(with.contains("which has the balls' centrifugal force"), "{with}");
    assert!(!with.contains("is left out") && !with.contains("nothing turning"), "{with}");
    let without = modes("");
    assert!(without.contains("the centrifugal force of a ball at this speed"), "{without}");
    assert!(!without.contains("hold near") && without.contains("nothing turning"), "{without}");
}

/// Shapes that answer loads swing too fast to be natural motions.
#[test]
fn modes_say_which_of_them_are_beyond_the_natural_shapes() {
    let place = Place::new();
    let note_of = |scene: &str, limit: &str| {
        let out = place.path("out");
        let set = format!("body.rotor.beam.below={limit}");
        let output = bearing(&["modes", scene, "--out", out.to_str().unwrap(), "--set", &set]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let said = said(&output);
        let note = said
            .lines()
            .find(|line| line.contains("beyond the natural shapes"))
            .map(str::to_string);
        let modes = json(out.join("summary.json"))["modes"].as_array().unwrap().clone();
        let found: Vec<f64> = modes.iter().map(|mode| number(&mode["frequency"])).collect();
        (note, found)
    };
    let shipped = crate::command_line_common::scene("stepped_rotor.toml");
    for below in ["500 Hz", "5 kHz"] {
        let (note, found) = note_of(&shipped, below);
        let note = note.unwrap();
        let numbers = note.split([' ', ',']).filter_map(|word| word.parse().ok());
        let [count, limit] = numbers.collect::<Vec<f64>>()[..] else { panic!("{note}") };
        let beyond = found.iter().filter(|frequency| **frequency > limit).count();
        assert!(beyond > 0 && beyond as f64 == count, "{note}: {found:?}");
    }
}

/// An equilibrium has no unbalances, whatever carries them.
#[test]
fn statics_of_bodies_say_that_unbalances_are_left_out() {
    let place = Place::new();
    let ground = "from = \"ground\"\nto = \"disc\"";
    let own = disc(ground, "{ y = \"1 N s/m\" }", "end = \"1 ms\"");
    let with =
        |size: &str| own.replace("[body.disc]", &format!("[body.disc]\nunbalance = \"{size}\""));
    let statics = |text: &str| {
        let scene = place.scene("scene.toml", text);
        let output = bearing(&["statics", scene.to_str().unwrap(), "--dry"]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        said(&output)
    };
    // 1e-2 kg m at 628.3 rad/s.
    let told = statics(&with("1e-2 kg m"));
    assert!(told.contains("the largest one, of body disc, with 3947.842 N"), "{told}");
    assert!(!statics(&own).contains("unbalances"));
}

/// Maxwell elements are relaxed in `modes`, which says how much stiffer springs are at the lowest frequency that it finds.
#[test]
fn modes_say_how_far_relaxed_springs_are_off() {
    let place = Place::new();
    let relaxing = "[[spring.mount.maxwell]]\nrelaxation_time = \"3 ms\"\ny = \"5e5 N/m\"\n";
    let text = disc("from = \"ground\"\nto = \"disc\"", "{}", "end = \"1 ms\"") + relaxing;
    let scene = place.scene("scene.toml", &text);
    let output = bearing(&["modes", scene.to_str().unwrap(), "--dry"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let told = said(&output);
    let told = told.lines().find(|line| line.contains("Maxwell elements take no part")).unwrap();
    let number = |before: &str, after: &str| -> f64 {
        let (_, rest) = told.split_once(before).unwrap();
        rest.split_once(after).unwrap().0.parse().unwrap()
    };
    let square = (TAU * number("at ", " Hz") * 3e-3).powi(2);
    let times = 1.0 + 5e5 / 2e5 * square / (1.0 + square);
    // Told to three digits.
    assert!((number("spring mount is ", " times") / times - 1.0).abs() <= 5e-3, "{told} {times}");
}
