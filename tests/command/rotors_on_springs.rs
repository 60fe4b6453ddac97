//! Rotors on springs alone, held against the values of a textbook.

use crate::command_line_common;

use command_line_common::{done, refused, scene};
use std::f64::consts::TAU;

/// Frequencies in the table of `bearing modes` under "whirl", Hz.
fn whirl(set: &[&str]) -> Vec<f64> {
    let path = scene("rotor_on_springs.toml");
    let mut arguments = vec!["modes", &path, "--dry"];
    set.iter().for_each(|change| arguments.extend(["--set", change]));
    let said = done(&arguments);
    let table = said.split_once("whirl at").unwrap().1.lines().skip(2);
    table.map_while(|line| line.split_whitespace().nth(1)?.parse().ok()).collect()
}

fn compare(found: &[f64], expected: &[f64]) {
    for (found, expected) in found.iter().zip(expected) {
        // The book's six elements are up to 0.07 % too stiff.
        assert!((found - expected).abs() <= 1e-3 * expected, "{found} {expected}");
    }
    assert!(found.len() >= expected.len());
}

/// Friswell, Penny, Garvey, Lees (2010), examples 5.9.1, 5.9.2 and 5.9.4: rad/s at 4000 rpm, and Hz at rest.
#[test]
fn whirl_on_springs_is_that_of_a_textbook() {
    let hertz = |speeds: [f64; 5]| speeds.map(|speed| speed / TAU);
    compare(&whirl(&[]), &hertz([85.39, 87.80, 251.78, 294.71, 600.18]));
    let uneven = ["spring.left.stiffness.z=8e5 N/m", "spring.right.stiffness.z=8e5 N/m"];
    compare(&whirl(&uneven), &hertz([82.33, 86.86, 239.64, 287.25, 583.49]));
    let cross = ["left", "right"]
        .map(|side| ["yz", "zy"].map(|pair| format!("spring.{side}.stiffness.{pair}=5e5 N/m")));
    let mut set: Vec<&str> = cross.iter().flatten().map(String::as_str).collect();
    set.push("body.rotor.speed=0.01 rpm");
    compare(&whirl(&set), &[11.66, 14.80, 33.97, 49.19, 97.97, 126.61]);
}

#[test]
fn scenes_without_bearings_refuse_keys_of_bearings_and_circulatory_equilibria() {
    let path = scene("rotor_on_springs.toml");
    let message = refused(&["statics", &path, "--dry", "--set", "traction.law=none"]);
    assert!(message.contains("no bearing"), "{message}");
    let circulatory = "spring.left.stiffness.yz=1e5 N/m";
    let message = refused(&["statics", &path, "--dry", "--set", circulatory]);
    assert!(message.contains("circulatory") && message.contains("left"), "{message}");
    let varied = "spring.left.stiffness.yz=1e5 N/m, 2e5 N/m";
    let message = refused(&["sweep", &path, "--vary", varied]);
    assert!(message.contains("circulatory"), "{message}");
    // Whirl at rest has no damping, circulatory stiffness feeds one direction.
    let said = done(&["modes", &path, "--dry", "--set", circulatory]);
    assert!(said.contains("W17"), "{said}");
    // Static sag of the springs' centre: weight over twice the stiffness, and the shaft's bending.
    let said = done(&["statics", &path, "--dry", "--set", "body.rotor.z.load=-100 N"]);
    assert!(said.contains("-100.000000 N"), "{said}");
}

#[test]
fn a_run_without_bearings_is_checked() {
    let path = scene("rotor_on_springs.toml");
    let run = ["--set", "numerics.end=1 ms", "--set", "numerics.step=10 us"];
    for more in [&run[..], &run[..2]] {
        let said = done(&[&["check", &path], more].concat());
        assert!(said.contains("a valid scene"), "{said}");
    }
}
