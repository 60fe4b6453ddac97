//! Springs that begin at bodies that spin.

use super::run_command::{bearing, code, run, said};
use crate::solid_command_common::{Place, column, json, number, stderr};

use nalgebra::Complex;
use std::f64::consts::TAU;

/// A bearing that touches nothing: a scene has one.
const BEARING: &str = r#"
defaults = "dissertation"
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
pub fn disc(ends: &str, damping: &str, numerics: &str) -> String {
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
        assert_eq!(said(&output).contains("W17-whirl-unstable"), turning != 0.0);

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
        let why = "not computed: the spring mount rotates with the body at its first end";
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
        (flying, "m, more than 1 m, the limit of its law"),
        (wound, "the spring mount is turned by 16"),
    ] {
        let scene = place.scene("scene.toml", &text);
        let out = place.path("out");
        let output = run(&scene, &out, &[]);
        assert_eq!(code(&output), 2, "{}", said(&output));
        assert!(stderr(&output).contains(how), "{}", stderr(&output));
        assert!(column(&out, "disc_y").len() > 10);
    }
}

/// Listed modes against those with all component modes of the shaft, at any limit in the scene.
#[test]
fn modes_are_listed_up_to_where_component_modes_suffice() {
    let place = Place::new();
    let of = |limit: &str| {
        let out = place.path("out");
        let set = format!("body.rotor.beam.modes_to={limit}");
        let shipped = crate::command_line_common::scene("stepped_rotor.toml");
        let output = bearing(&["modes", &shipped, "--out", out.to_str().unwrap(), "--set", &set]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let summary = json(out.join("summary.json"));
        let frequencies = |list: &serde_json::Value| -> Vec<f64> {
            list.as_array().unwrap().iter().map(|mode| number(&mode["frequency"])).collect()
        };
        assert_eq!(summary["warnings"].as_array().unwrap().len(), 0);
        (frequencies(&summary["modes"]), frequencies(&summary["rotor"]["whirl"]), said(&output))
    };
    let (all, whirls, text) = of("10 MHz");
    assert!(!text.contains("are not listed"), "{text}");
    for limit in [0.0, 300.0, 1000.0, 1700.0, 3000.0, 5000.0, 8000.0, 19000.0] {
        let (found, whirl, text) = of(&format!("{limit} Hz"));
        let (_, after) = text.split_once("modes above ").expect(&text);
        let listed: f64 = after.split(' ').next().unwrap().parse().unwrap();
        let expected = all.iter().filter(|frequency| **frequency <= listed).count();
        assert!(listed >= limit && found.len() == expected, "{limit}: {listed} {found:?}");
        let off = |(found, exact): (&f64, &f64)| found / exact - 1.0;
        let most = found.iter().zip(&all).map(off).fold(0.0, f64::max);
        let whirl =
            whirl.iter().zip(&whirls).map(off).fold(0.0f64, |most, off| most.max(off.abs()));
        println!("{limit} Hz: {expected} modes up to {listed} Hz, {most:.1e}, whirl {whirl:.1e}");
        assert!(most <= 1e-3 && whirl <= 1e-3, "{limit}: {most:e} {whirl:e}");
    }
}

/// Maxwell elements beside the springs of 2 kg, turning at Ω with it: m λ² + k + k_e (λ − iΩ)/(λ − iΩ + 1/τ) = 0 grows; standing still
/// (Ω = 0) it dies out. So say `modes` and a run.
#[test]
fn a_maxwell_element_that_turns_feeds_whirl_in_modes_and_in_a_run() {
    let place = Place::new();
    let relaxing =
        "[[spring.mount.maxwell]]\nrelaxation_time = \"3 ms\"\ny = \"5e5 N/m\"\nz = \"5e5 N/m\"\n";
    let [mass, spring, element, time] = [2.0, 2e5, 5e5, 3e-3];
    for (ends, turning) in
        [("from = \"disc\"", TAU * 100.0), ("from = \"ground\"\nto = \"disc\"", 0.0)]
    {
        let lag = |value: Complex<f64>| value - Complex::new(0.0, turning);
        let balance = |value: Complex<f64>| {
            value * value * mass + spring + element * (lag(value) / (lag(value) + 1.0 / time))
        };
        // Newton's method from what hardly relaxes, standing still, or has relaxed, once a turn.
        let stiff = if turning == 0.0 { spring + element } else { spring };
        let mut value = Complex::new(0.0, (stiff / mass).sqrt());
        for _ in 0..50 {
            let slope = (balance(value + 1e-4) - balance(value - 1e-4)) / 2e-4;
            value -= balance(value) / slope;
        }
        assert!(balance(value).norm() <= 1e-6 * spring);
        assert_eq!(value.re > 0.0, turning != 0.0);
        let ratio = -value.re / value.norm();

        let text = disc(ends, "{}", "end = \"0.1 s\"") + relaxing;
        let scene = place.scene("scene.toml", &text);
        let out = place.path("modes");
        let output = bearing(&["modes", scene.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let summary = json(out.join("summary.json"));
        let whirls = summary["rotor"]["whirl"].as_array().unwrap().iter();
        let off = whirls.map(|whirl| {
            let [frequency, found] = ["frequency", "damping_ratio"].map(|key| number(&whirl[key]));
            (frequency * TAU / value.im - 1.0).abs() + (found / ratio - 1.0).abs()
        });
        let nearest = off.fold(f64::INFINITY, f64::min);
        assert!(nearest <= 1e-6, "{value}: {nearest:e}");
        assert_eq!(said(&output).contains("W17-whirl-unstable"), turning != 0.0);

        let out = place.path("run");
        let output = run(&scene, &out, &[]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let [y, z] = ["disc_y", "disc_z"].map(|name| column(&out, name));
        if turning != 0.0 {
            // By then the other motions have died away.
            let radius = |row: usize| libm::hypot(y[row], z[row]);
            let found = (radius(1000) / radius(700)).ln() / 0.03;
            assert!((found / value.re - 1.0).abs() <= 2e-3, "{found} {value}");
        } else {
            // Along Z a sum of e^{λt}, e^{λ*t} and e^{rt}, r = −1/τ − 2 Re λ, each 1 ms after the other by the same factors.
            let rate = -1.0 / time - 2.0 * value.re;
            let [swing, relax] = [(value * 1e-3).exp(), Complex::new((rate * 1e-3).exp(), 0.0)];
            let [twice, square] = [2.0 * swing.re, swing.norm_sqr()];
            let factors = [twice + relax.re, -(square + relax.re * twice), square * relax.re];
            let largest = z.iter().fold(0.0, |most: f64, z| most.max(z.abs()));
            for at in (20..400).step_by(10) {
                let sum: f64 = (0..3).map(|k| factors[k] * z[at + 20 - 10 * k]).sum();
                let off = (z[at + 30] - sum).abs();
                assert!(off <= 1e-4 * largest, "{at}: {off:e} of {largest:e}");
            }
        }
    }
}

/// Dashpots so strong that tilts die out without swinging at rest, and whirl at speed: a line of the diagram has nothing there.
#[test]
fn a_motion_that_swings_at_speed_alone_has_a_line_of_zeros_below() {
    let place = Place::new();
    let strong = r#"{ y = "2000 N s/m", z = "2000 N s/m", turn_y = "30 N m s/rad", turn_z = "30 N m s/rad" }"#;
    let fast = disc("from = \"ground\"\nto = \"disc\"", strong, "end = \"1 ms\"");
    let scene = place.scene("scene.toml", &fast.replace("6000 rpm", "60000 rpm"));
    let out = place.path("modes");
    let output = bearing(&["modes", scene.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let text = std::fs::read_to_string(out.join("campbell.csv")).unwrap();
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|value| value.parse().unwrap()).collect())
        .collect();
    let lines = (names.len() - 1) / 3;
    let silent = |row: &Vec<f64>| (0..lines).any(|k| row[1 + 3 * k..4 + 3 * k] == [0.0, 0.0, 1.0]);
    assert!(silent(&rows[0]) && !silent(&rows[50]), "{text}");
}

/// A torque gives no speed up to which whirl could be told.
#[test]
fn modes_of_what_a_torque_turns_say_that_they_want_a_speed() {
    let place = Place::new();
    let given = disc("from = \"ground\"\nto = \"disc\"", "{}", "end = \"1 ms\"");
    for (text, told) in [
        (given.replace("speed = \"6000 rpm\"", "torque = \"0.1 N m\""), true),
        (given.replace("speed = \"6000 rpm\"", "torque = \"0 N m\""), false),
        (given, false),
    ] {
        let scene = place.scene("scene.toml", &text);
        let output = bearing(&["modes", scene.to_str().unwrap(), "--dry"]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let said = said(&output);
        assert_eq!(
            said.contains("the body disc is driven by a torque, so that its speed is not known"),
            told,
            "{said}"
        );
    }
}
