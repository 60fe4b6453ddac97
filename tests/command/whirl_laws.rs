//! Laws of whirl, critical speeds and Campbell diagrams, on the command's own results.

use crate::command_line_common;

use command_line_common::{done, json, read, scene, text, write};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::tempdir;

/// A rotor whose bending is damped in its own axes, with extra tables behind it.
fn rotor(speed: &str, more: &str) -> String {
    let shipped = read(Path::new(&scene("rotor_on_springs.toml")));
    let damped = "density = \"7810 kg/m^3\"\ninternal_damping = \"30 1/s\"\ndamping = \"5 1/s\"";
    shipped.replace("density = \"7810 kg/m^3\"", damped).replace("4000 rpm", speed) + more
}

/// A hub on springs of its own, far above the rotor's frequencies, that nothing joins to the rotor.
fn hub(speed: &str) -> String {
    format!(
        "\n[body.hub]\nspeed = \"{speed}\"\n\
         inertia = {{ mass = \"1 kg\", axial = \"1e-3 kg m^2\", transverse = \"1e-3 kg m^2\" }}\n\
         [spring.hub_support]\nfrom = \"ground\"\nto = \"hub\"\n\
         stiffness = {{ x = \"3e10 N/m\", y = \"3e10 N/m\", z = \"3e10 N/m\", turn_y = \"3e7 N m/rad\", turn_z = \"3e7 N m/rad\" }}\n"
    )
}

struct Modes {
    /// Frequency, damping ratio and direction of each whirl mode.
    whirl: Vec<[f64; 3]>,
    /// Critical speeds, rad/s, and their directions.
    critical: Vec<[f64; 2]>,
    warnings: Vec<String>,
    /// Speed and lines of the Campbell diagram.
    campbell: Vec<Vec<f64>>,
}

fn modes(scene: &str) -> Modes {
    let root = tempdir().unwrap();
    let path = write(root.path(), "scene.toml", scene);
    let out = root.path().join("out");
    done(&["modes", &path, "--out", &text(&out)]);
    let summary = json(&out.join("summary.json"));
    let section = &summary["rotor"];
    let numbers = |of: &Value, key: &str| of[key]["value"].as_f64().unwrap();
    let list = |name: &str| section[name].as_array().unwrap().clone();
    let warnings = summary["warnings"].as_array().unwrap().iter();
    let campbell = fs::read_to_string(out.join("campbell.csv")).unwrap();
    Modes {
        whirl: list("whirl")
            .iter()
            .map(|of| ["frequency", "damping_ratio", "direction"].map(|key| numbers(of, key)))
            .collect(),
        critical: list("critical_speeds")
            .iter()
            .map(|of| ["speed", "direction"].map(|key| numbers(of, key)))
            .collect(),
        warnings: warnings.map(|of| of["code"].as_str().unwrap().to_string()).collect(),
        campbell: campbell
            .lines()
            .skip(1)
            .map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect())
            .collect(),
    }
}

fn assert_close(one: &[f64], other: &[f64], what: &str) {
    assert_eq!(one.len(), other.len(), "{what}");
    for (a, b) in one.iter().zip(other) {
        assert!((a - b).abs() <= 1e-9 * a.abs().max(1.0), "{what}: {one:?} {other:?}");
    }
}

/// A body that nothing joins to the rotor changes none of its numbers, whatever its speed; where it is the fastest, speeds
/// are printed as its own.
#[test]
fn an_unconnected_body_changes_nothing() {
    let alone = modes(&rotor("4000 rpm", ""));
    assert!(alone.whirl.len() >= 6 && alone.critical.len() >= 2);
    for (speed, ratio) in
        [("1000 rpm", 1.0), ("-3000 rpm", 1.0), ("12000 rpm", 3.0), ("-9000 rpm", -2.25)]
    {
        let with = modes(&rotor("4000 rpm", &hub(speed)));
        for (own, other) in alone.whirl.iter().zip(&with.whirl) {
            assert_close(&own[..2], &other[..2], speed);
            // Directions are those of the fastest body.
            assert_close(&[own[2].abs()], &[other[2].abs()], speed);
        }
        // With a faster body, critical speeds are those at which that body excites a whirl.
        if ratio == 1.0 {
            for (own, other) in alone.critical.iter().zip(&with.critical) {
                assert_close(own, other, speed);
            }
        }
        for (own, other) in alone.campbell.iter().zip(&with.campbell) {
            let lines = (own.len() - 1) / 3;
            assert_close(&[own[0] * ratio], &[other[0]], speed);
            for line in 0..lines {
                let at = 1 + 3 * line;
                assert_close(&[own[at], own[at + 2]], &[other[at], other[at + 2]], speed);
            }
        }
    }
}

/// The other sense of rotation: the same frequencies, damping, critical speeds and warnings.
#[test]
fn the_sense_of_rotation_changes_nothing() {
    let [one, other] = ["12000 rpm", "-12000 rpm"].map(|speed| modes(&rotor(speed, "")));
    assert!(!one.warnings.is_empty(), "internal damping drives the rotor");
    assert_eq!(one.warnings, other.warnings);
    for (a, b) in one.whirl.iter().zip(&other.whirl) {
        assert_close(a, b, "whirl");
    }
    for (a, b) in one.critical.iter().zip(&other.critical) {
        assert_close(a, b, "critical");
    }
    assert_eq!(one.whirl.len(), other.whirl.len());
    assert_eq!(one.critical.len(), other.critical.len());
}
