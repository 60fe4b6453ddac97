//! What `modes` says of housings that swing.

use super::run_command::{bearing, code, said};
use crate::solid_command_common::{Place, json, number, shipped};

use std::f64::consts::TAU;

/// A damping α M of the elements of both housings takes α s/2ω of a motion of which they have the part s; nothing else damps here. The
/// lowest motion is that of a housing, which swings along the axis with a race in its bore.
#[test]
fn whirl_is_damped_by_what_damps_a_housing() {
    let place = Place::new();
    let out = place.path("out");
    let alpha = 200.0;
    let scene = shipped("shaft_in_two_housings.toml");
    let scene = scene.to_str().unwrap();
    let set = format!("solid.damping={alpha} 1/s");
    let output = bearing(&["modes", scene, "--set", &set, "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0);
    let summary = json(out.join("summary.json"));
    let modes: Vec<[f64; 2]> = summary["modes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|mode| [number(&mode["frequency"]), number(&mode["housings_share"])])
        .collect();
    let whirls = summary["rotor"]["whirl"].as_array().unwrap();
    let mut seen = Vec::new();
    for whirl in whirls {
        let frequency = number(&whirl["frequency"]);
        // At 1000 rpm next to nothing turns the motions into others.
        let off = |mode: &&[f64; 2]| (mode[0] / frequency - 1.0).abs();
        let [_, share] = modes.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
        let expected = alpha * share / (2.0 * TAU * frequency);
        let error = (number(&whirl["damping_ratio"]) - expected).abs();
        // Damping couples motions, to second order of 200/s over the distance of 2π 40 Hz between the nearest two.
        assert!(error <= 0.02 * expected + 1e-6, "{frequency}: {error:e} {expected:e}");
        seen.push(*share);
    }
    assert!(seen.len() == 8 && seen[0] > 0.9 && seen[1] < 0.1, "{seen:?}");
    let text = said(&output);
    assert!(text.contains("left_housing_mode_1"), "{text}");
    assert!(text.contains("mostly along the axis or of a housing"), "{text}");
}

/// Listed modes against those with many more natural modes of the housing.
#[test]
fn modes_are_listed_up_to_where_natural_modes_of_a_housing_suffice() {
    let scene = shipped("housing_a_rotating_load.toml");
    let scene = scene.to_str().unwrap();
    let with = |more: &[&str]| {
        let text = said(&bearing(
            &[&["modes", scene, "--dry", "--set", "housing.method=reduced"], more].concat(),
        ));
        let modes = text.lines().filter_map(|line| {
            let mut words = line.split_whitespace();
            words.next()?.parse::<usize>().ok()?;
            Some((words.next()?.parse().ok()?, words.next()?.starts_with("housing_mode_")))
        });
        (modes.collect::<Vec<(f64, bool)>>(), text)
    };
    let (all, _) = with(&["--set", "housing.modes_to=150 kHz"]);
    for (limit, of_housing) in [("", 1), ("40 kHz", 0), ("100 Hz", 0)] {
        let set = format!("housing.modes_to={limit}");
        let more = if limit.is_empty() { vec![] } else { vec!["--set", &set] };
        let (found, text) = with(&more);
        assert!(text.contains("Hz are not listed"), "{text}");
        assert!(found.iter().filter(|(_, housing)| *housing).count() >= of_housing, "{text}");
        let off = found.iter().zip(&all).map(|((found, _), (exact, _))| found / exact - 1.0);
        let most = off.fold(0.0, f64::max);
        println!("{limit}: {} modes, {most:.1e}", found.len());
        assert!(most <= 1e-3, "{limit}: {most:e} {text}");
    }
}

/// What equilibria leave out is judged by the frequencies that `modes` tells: housing C rocks, which its race does not follow.
#[test]
fn statics_reports_the_lowest_frequency_of_modes() {
    let scene = shipped("housing_c_tet10.toml");
    let scene = scene.to_str().unwrap();
    let after = |text: &str, words: &str| {
        let (_, after) = text.split_once(words).unwrap_or_else(|| panic!("{text}"));
        after.split(' ').next().unwrap().parse::<f64>().unwrap()
    };
    let place = Place::new();
    let out = place.path("out");
    let statics = said(&bearing(&["statics", scene, "--out", out.to_str().unwrap()]));
    let motions = said(&bearing(&["modes", scene, "--dry"]));
    let mode = |name: &str| {
        let line = motions.lines().find(|line| line.ends_with(name)).unwrap();
        line.split_whitespace().nth(1).unwrap().parse::<f64>().unwrap()
    };
    let rocks = mode("outer_race_tilt_y");
    assert!((1300.0..1500.0).contains(&rocks), "{motions}");
    let lowest = "lowest natural frequency ";
    let off = |found: f64, expected: f64| (found / expected - 1.0).abs();
    let inertia = &json(out.join("summary.json"))["inertia"];
    assert!(off(number(&inertia["lowest_frequency"]), rocks) <= 5e-4, "{statics}");
    // To the digits that are printed.
    assert!(off(after(&statics, lowest), rocks) <= 1e-3, "{statics}");

    // And how a shaft bends between them; Hz, mode 2 of all, since nothing drives the shaft along its axis.
    let scene = shipped("rotor_in_pillow_blocks.toml");
    let scene = scene.to_str().unwrap();
    let quasi_static = ["--set", "housing.method=quasi-static"];
    let bends =
        |command: &str| said(&bearing(&[&[command, scene, "--dry"], &quasi_static[..]].concat()));
    let (statics, motions) = (bends("statics"), bends("modes"));
    let line = motions.lines().find(|line| line.ends_with("shaft_y")).unwrap();
    let swings = line.split_whitespace().nth(1).unwrap().parse::<f64>().unwrap();
    assert!(off(after(&statics, lowest), swings) <= 5e-4, "{statics} {motions}");
}
