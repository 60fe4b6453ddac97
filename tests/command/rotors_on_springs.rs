//! Rotors on springs alone, held against the values of a textbook.

use crate::command_line_common;

use command_line_common::{done, refused, scene, text, write};
use std::f64::consts::TAU;
use tempfile::tempdir;

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

/// A rigid rotor on damped springs with the cross-coupled stiffness of oil films.
const CROSS_COUPLED: &str = r#"
[body.rotor]
x = { displacement = "0 mm" }
inertia = { mass = "20 kg", axial = "0.15 kg m^2", transverse = "0.4 kg m^2" }
[spring.left]
from = "ground"
to = "rotor"
to_at = "-200 mm"
from_at = "-200 mm"
stiffness = { y = "8e6 N/m", z = "1.2e7 N/m", yz = "6e6 N/m", zy = "-6e6 N/m" }
damping = { y = "3000 N s/m", z = "4000 N s/m", yz = "200 N s/m", zy = "200 N s/m" }
[spring.right]
from = "ground"
to = "rotor"
to_at = "150 mm"
from_at = "150 mm"
stiffness = { y = "6e6 N/m", z = "9e6 N/m", yz = "6e6 N/m", zy = "-6e6 N/m" }
damping = { y = "3000 N s/m", z = "4000 N s/m" }
"#;

/// Eigenvalues of M s² + C s + K by NumPy; a rotor without either has natural modes alone.
#[test]
fn whirl_at_rest_is_printed_with_damping_or_cross_coupled_stiffness() {
    let folder = tempdir().unwrap();
    let path = write(folder.path(), "rotor.toml", CROSS_COUPLED);
    let said = done(&["modes", &path, "--dry"]);
    assert!(said.contains("with the mean of `yz` and `zy`"), "{said}");
    let (_, table) = said.split_once("whirl at 0.0 rpm").expect(&said);
    let rows = table.lines().skip(2).map(|line| {
        line.split_whitespace().skip(1).map_while(|word| word.parse().ok()).collect::<Vec<f64>>()
    });
    let rows: Vec<Vec<f64>> = rows.take_while(|row| !row.is_empty()).collect();
    let expected =
        [(141.8299, Some(-0.16007)), (144.253, None), (200.005, Some(-0.06593)), (203.432, None)];
    assert_eq!(rows.len(), expected.len(), "{said}");
    for (row, (frequency, ratio)) in rows.iter().zip(expected) {
        assert!((row[0] - frequency).abs() <= 1e-3, "{said}");
        assert!(ratio.is_none_or(|ratio| (row[1] - ratio).abs() <= 1e-5), "{said}");
    }
    assert_eq!(said.matches("W17").count(), 2, "{said}");
    assert!(!said.contains("critical speeds"), "{said}");
    let still = done(&[
        "modes",
        &scene("rotor_on_springs.toml"),
        "--dry",
        "--set",
        "body.rotor.speed=0 rpm",
    ]);
    assert!(!still.contains("whirl") && !still.contains("`yz`"), "{still}");
}

/// Without contacts there is no overlap to which an accuracy could refer.
#[test]
fn the_step_of_a_run_without_bearings_follows_from_the_stability_limit() {
    let folder = tempdir().unwrap();
    let path = write(folder.path(), "rotor.toml", CROSS_COUPLED);
    let end = ["--set", "numerics.end=1 ms"];
    let plan = done(&[&["plan", &path][..], &end].concat());
    assert!(
        plan.contains("from 0.1 of the largest stable one") && !plan.contains("balls stay"),
        "{plan}"
    );
    let out = text(&folder.path().join("run"));
    done(&[&["run", &path, "--out", &out][..], &end].concat());
    let out = text(&folder.path().join("long"));
    let long = ["--out", &out, "--set", "numerics.step=4 ms"];
    let message = refused(&[&["run", &path][..], &end, &long].concat());
    assert!(message.contains("leave it out"), "{message}");
    let accuracy = [&["run", &path, "--set", "numerics.accuracy=0.001"][..], &end].concat();
    assert!(refused(&accuracy).contains("numerics.accuracy"), "{}", refused(&accuracy));
    let method = [&["run", &path, "--set", "numerics.integrator=rosenbrock"][..], &end].concat();
    assert!(refused(&method).contains("numerics.step"), "{}", refused(&method));
}
