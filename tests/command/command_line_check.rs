//! What `check` says it understood, and that two ways to say the same give the same bits.

use crate::command_line_common;

use command_line_common::{
    ANGULAR_CONTACT, DEEP_GROOVE, changed, done, json, read, scene, text, write,
};
use serde_json::{Value, json};
use std::path::Path;
use tempfile::tempdir;

/// `check --json` of a scene given as text.
fn echo(folder: &Path, scene: &str) -> Value {
    let path = write(folder, "scene.toml", scene);
    serde_json::from_str(&done(&["check", &path, "--json"])).unwrap()
}

fn number(echo: &Value, pointer: &str, unit: &str) -> f64 {
    let quantity = echo.pointer(pointer).unwrap_or_else(|| panic!("{pointer} in {echo:#}"));
    assert_eq!(quantity["unit"], unit, "{pointer}");
    quantity["value"].as_f64().unwrap()
}

/// Echoed lengths are in mm; decimal numbers of a few mm survive the way to m and back within two
/// roundings.
fn near(value: f64, expected: f64) {
    assert!((value - expected).abs() <= 4.0 * f64::EPSILON * expected.abs(), "{value} {expected}");
}

#[test]
fn clearance_is_echoed_both_ways_and_through_each_part() {
    let root = tempdir().unwrap();
    let one = "{ radial = \"-5 um\" }";
    // The part that makes the clearance, its pointer, and its size: 31.953 - 20.047 - 2 × 5.953
    // is 0, so -5 um come from a ball thicker by 2.5 um, an inner race larger or an outer one
    // smaller by 5 um.
    for (through, pointer, size) in [
        ("ball", "/geometry/ball_radius", 5.9555),
        ("inner-race", "/geometry/inner_race/radius", 20.052),
        ("outer-race", "/geometry/outer_race/radius", 31.948),
    ] {
        for (kind, value) in [("radial", "-5 um"), ("diametral", "-10 um"), ("radial", "-0.005 mm")]
        {
            let given = format!("{{ {kind} = \"{value}\", through = \"{through}\" }}");
            let scene = changed(DEEP_GROOVE, one, &given);
            let echo = echo(root.path(), &scene);
            near(number(&echo, "/geometry/radial_clearance", "mm"), -0.005);
            assert_eq!(echo["geometry"]["clearance_through"], through);
            near(number(&echo, pointer, "mm"), size);
            for (other, nominal) in [
                ("/geometry/ball_radius", 5.953),
                ("/geometry/inner_race/radius", 20.047),
                ("/geometry/outer_race/radius", 31.953),
            ] {
                if other != pointer {
                    near(number(&echo, other, "mm"), nominal);
                }
            }
            let path = write(root.path(), "scene.toml", &scene);
            let said = done(&["check", &path]);
            let line = format!(
                "-5.0000 um radial = -10.0000 um diametral, made through the {}",
                through.replace('-', " ")
            );
            assert!(said.contains(&line), "{said}");
        }
    }
    let path = write(root.path(), "scene.toml", ANGULAR_CONTACT);
    let said = done(&["check", &path]);
    assert!(said.contains("+0.0000 um diametral\n"), "{said}");
}

#[test]
fn conformity_is_echoed_three_ways_whichever_was_given() {
    let root = tempdir().unwrap();
    let given = "groove_radius = \"6.013 mm\"";
    let (ball, groove) = (5.953, 6.013);
    let [conformity, osculation] = [groove / (2.0 * ball), ball / groove];
    for written in [
        given.to_string(),
        format!("conformity = {conformity:?}"),
        format!("osculation = {osculation:?}"),
    ] {
        let echo = echo(root.path(), &changed(DEEP_GROOVE, given, &written));
        for (pointer, unit, expected) in [
            ("groove_radius", "mm", groove),
            ("conformity", "1", conformity),
            ("osculation", "1", osculation),
        ] {
            near(number(&echo, &format!("/geometry/inner_race/{pointer}"), unit), expected);
        }
        // The outer race is another one.
        near(number(&echo, "/geometry/outer_race/groove_radius", "mm"), 6.310);
        let path = write(root.path(), "scene.toml", &changed(DEEP_GROOVE, given, &written));
        let said = done(&["check", &path]);
        assert!(
            said.contains("groove 6.0130 mm = 0.50504 of the ball diameter = osculation 0.99002"),
            "{said}"
        );
    }
}

#[test]
fn check_names_the_kind_the_defaults_and_the_assumptions() {
    let root = tempdir().unwrap();
    for (kind, scene) in [("deep-groove", DEEP_GROOVE), ("angular-contact", ANGULAR_CONTACT)] {
        let path = write(root.path(), "scene.toml", scene);
        let said = done(&["check", &path]);
        assert!(said.starts_with(&format!("{path}: a valid scene\n")), "{said}");
        assert!(said.contains(&format!("{kind}, ")), "{said}");
        assert!(said.contains("bearing.ball_phase = 0 deg (ball 1 is on the Y axis)"), "{said}");
        assert_eq!(echo(root.path(), scene)["scene"]["bearing"]["kind"], kind);
    }
    let said = done(&["check", &scene("varying_compliance.toml")]);
    assert!(said.contains("assumption             load: the source loads the rotor"), "{said}");
}

/// Series and summary but for the wall times.
fn solution(folder: &Path, path: &str) -> (String, Vec<u8>, Value) {
    let out = folder.join("solution");
    done(&["statics", path, "--out", &text(&out)]);
    let mut summary = json(&out.join("summary.json"));
    // One scene may be written in several ways.
    for part in ["seconds", "scene"] {
        summary.as_object_mut().unwrap().remove(part);
    }
    (read(&out.join("series.csv")), std::fs::read(out.join("series.npy")).unwrap(), summary)
}

#[test]
fn a_scene_in_json_gives_the_bits_of_the_one_in_toml() {
    let root = tempdir().unwrap();
    for name in [
        "angular_contact_axial.toml",
        "cage_600rpm.toml",
        "deep_groove_tilt.toml",
        "interference_fit.toml",
        "shaft_back_to_back.toml",
    ] {
        let path = scene(name);
        let value: Value = toml::from_str(&read(Path::new(&path))).unwrap();
        let same = write(root.path(), "scene.json", &value.to_string());
        assert!(solution(root.path(), &path) == solution(root.path(), &same), "{name}");
    }
}

#[test]
fn twice_the_radial_clearance_as_diametral_gives_the_same_bits() {
    let root = tempdir().unwrap();
    let load = "[inner_race]\nz = { load = \"-1 kN\" }\ntilt_y = { tilt = \"0.1 deg\" }\n";
    let mut previous = None;
    for (radial, diametral) in [("-5 um", "-10 um"), ("3.7 um", "7.4 um"), ("0.011 mm", "22 um")] {
        for through in ["ball", "inner-race", "outer-race"] {
            let [one, two] = [("radial", radial), ("diametral", diametral)].map(|(kind, value)| {
                let given = format!("{{ {kind} = \"{value}\", through = \"{through}\" }}");
                let scene = changed(DEEP_GROOVE, "{ radial = \"-5 um\" }", &given);
                let path = write(root.path(), "scene.toml", &format!("{scene}{load}"));
                solution(root.path(), &path)
            });
            assert!(one == two, "{radial} through {through}");
            // Not because everything gives the same: each clearance and part has its own result.
            assert!(previous.as_ref() != Some(&one));
            previous = Some(one);
        }
    }
}

/// A scene that is printed by `check` is one that can be read: with the same results.
#[test]
fn what_check_prints_is_a_scene() {
    let root = tempdir().unwrap();
    let out = |name: &str| root.path().join(name);
    for name in ["shaft_back_to_back.toml", "deep_groove_tilt.toml", "angular_contact_axial.toml"] {
        let path = scene(name);
        let printed: Value = serde_json::from_str(&done(&["check", &path, "--json"])).unwrap();
        let written = write(root.path(), "scene.json", &printed["scene"].to_string());
        let [one, other] = [&path, &written].map(|path| {
            let (text, bits, _) = solution(root.path(), path);
            (text, bits)
        });
        assert!(one == other, "{name}");
    }
    // So is that of a pack.
    let [pack, one, other] = ["pack", "one", "other"].map(|name| text(&out(name)));
    let path = scene("shaft_back_to_back.toml");
    done(&["pack", &path, "--out", &pack]);
    done(&["statics", &format!("{pack}/resolved.json"), "--out", &one]);
    done(&["statics", &path, "--out", &other]);
    assert_eq!(read(&out("one").join("series.csv")), read(&out("other").join("series.csv")));
}

#[test]
fn numerics_output_assumptions_and_defaults_are_echoed() {
    let root = tempdir().unwrap();
    let text = |name| std::fs::read_to_string(scene(name)).unwrap();
    let echoed = echo(root.path(), &text("settling_by_accuracy.toml"));
    assert_eq!(echoed["scene"]["numerics"]["end"], 0.2);
    assert_eq!(echoed["numerics"]["integrator"], "dormand-prince");
    assert_eq!(number(&echoed, "/numerics/accuracy", "1"), 1e-4);
    let echoed = echo(root.path(), &text("settling.toml"));
    assert_eq!(number(&echoed, "/numerics/step", "s"), 1e-6);
    assert_eq!(echoed["scene"]["output"]["plots"], json!(["series"]));
    for name in ["settling.toml", "varying_compliance.toml", "cage_600rpm.toml", "bar_impact.toml"]
    {
        // As many of either as the text for people has, and the same.
        let path = scene(name);
        let said = done(&["check", &path]);
        let echoed: Value = serde_json::from_str(&done(&["check", &path, "--json"])).unwrap();
        let [assumptions, defaults] =
            ["assumptions", "defaults"].map(|part| echoed[part].as_array().unwrap().clone());
        let lines = |label: &str| said.lines().filter(|l| l.trim().starts_with(label)).count();
        assert_eq!(assumptions.len(), lines("assumption "), "{name}");
        assert_eq!(defaults.len(), lines("default "), "{name}");
        for used in &defaults {
            let [key, value] = ["key", "value"].map(|part| used[part].as_str().unwrap());
            assert!(said.contains(&format!("{key} = {value} (")), "{name}: {key}");
        }
    }
    assert!(echo(root.path(), &text("deep_groove_tilt.toml"))["numerics"].is_null());
}
