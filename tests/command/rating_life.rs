//! Rating life in what `statics` prints and writes.

use crate::command_line_common::{done, json, refused, scene, text};

fn life_line(printed: &str) -> &str {
    printed.lines().find(|line| line.starts_with("rating life")).expect(printed)
}

#[test]
fn statics_reports_the_rating_life() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let scene = scene("angular_contact_axial.toml");
    let with = |set: &[&str]| {
        let mut arguments = vec!["statics", &scene];
        set.iter().for_each(|key| arguments.extend(["--set", key]));
        let out = text(&out);
        arguments.extend(["--out", &out]);
        let printed = done(&arguments);
        let summary = json(&folder.path().join("out/summary.json"));
        (life_line(&printed).to_string(), summary["rating_life"].clone())
    };
    let value = |section: &serde_json::Value, name: &str| section[name]["value"].as_f64().unwrap();
    let (line, by_iso) = with(&["inner_race.speed=3000 rpm"]);
    assert!(line.contains("(ISO 281)") && line.contains(" h at 3000 rpm"), "{line}");
    assert_eq!(by_iso["dynamic_rating_is"], "ISO 281");
    let hours = value(&by_iso, "revolutions") / 3000.0 / 60.0;
    assert!((value(&by_iso, "hours") / hours - 1.0).abs() <= 1e-12);
    let (line, given) = with(&["bearing.rating.dynamic=20 kN"]);
    assert!(line.contains("20.00 kN (given)"), "{line}");
    // (C/P)³ in millions, whatever the rating.
    let ratio = value(&given, "revolutions") / value(&by_iso, "revolutions");
    let cube = (20e3 / value(&by_iso, "dynamic_rating")).powi(3);
    assert!((ratio / cube - 1.0).abs() <= 1e-9, "{ratio} {cube}");
    let load = value(&given, "equivalent_load");
    assert!((value(&given, "revolutions") / (1e6 * (20e3 / load).powi(3)) - 1.0).abs() <= 1e-9);
}

#[test]
fn a_thrust_bearing_has_no_rating() {
    let scene = scene("angular_contact_axial.toml");
    let steep = ["--dry", "--set", "bearing.contact_angle=60 deg"];
    let printed = done(&[&["statics", &scene], &steep[..]].concat());
    assert!(!printed.contains("rating life"), "{printed}");
    let rated = ["--set", "bearing.rating.dynamic=20 kN"];
    let said = refused(&[&["statics", &scene], &steep[..], &rated[..]].concat());
    assert!(
        said.contains("bearing.rating.dynamic: refused: the rating life of a thrust"),
        "{said}"
    );
}
