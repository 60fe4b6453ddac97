//! Rating life in what `statics` prints and writes.

use super::bearing_laws::{BALL, CONFORMITY, found, scene as deep_groove};
use crate::command_line_common::{changed, done, json, refused, scene, text};

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

/// The life follows from the written ball loads with ISO/TS 16281: cubes for a race that rotates, powers of 10/3 for one that
/// stands still.
#[test]
fn a_race_that_stands_still_averages_its_loads_by_the_power_of_ten_thirds() {
    let fixed =
        ["x", "y", "z"].map(|axis| format!("{axis} = {{ displacement = \"0 mm\" }}\n")).concat();
    let life = |inner: f64, outer: f64, turns: [bool; 2]| {
        let content = deep_groove(
            "",
            &format!(
                "[inner_race]\nspeed = \"{inner} rpm\"\nx = {{ load = \"200 N\" }}\nz = {{ load = \"-900 N\" }}\n[outer_race]\n\
                 motion = \"5-dof\"\nspeed = \"{outer} rpm\"\n{fixed}tilt_y = {{ tilt = \"0 deg\" }}\ntilt_z = {{ tilt = \"0 deg\" }}\n"
            ),
        );
        // Without clearance balls have their nominal diameter.
        let (summary, balls) = found("statics", &changed(&content, "10 um", "0 um"));
        let value = |name: &str| summary["rating_life"][name]["value"].as_f64().unwrap();
        let gamma = 0.5 * BALL / 19.25e-3;
        let [inner_groove, outer_groove] = CONFORMITY;
        let grooves =
            inner_groove * (2.0 * outer_groove - 1.0) / (outer_groove * (2.0 * inner_groove - 1.0));
        let ratio = 1.044 * ((1.0 - gamma) / (1.0 + gamma)).powf(1.72) * grooves.powf(0.41);
        let damage = |race: usize| {
            let (name, factor, sign) = [("inner", 0.407, 1.0), ("outer", 0.389, -1.0)][race];
            let rating = value("dynamic_rating") / (factor * balls.len() as f64)
                * (1.0 + ratio.powf(sign * 10.0 / 3.0)).powf(0.3);
            let power = if turns[race] { 3.0 } else { 10.0 / 3.0 };
            let loads = balls.iter().map(|ball| ball[&format!("{name}_load")]);
            let mean = loads.map(|load| load.powf(power)).sum::<f64>() / balls.len() as f64;
            (mean.powf(1.0 / power) / rating).powf(10.0 / 3.0)
        };
        let expected = 1e6 * (damage(0) + damage(1)).powf(-0.9);
        let revolutions = value("revolutions");
        // Rounding of powers.
        assert!(
            (revolutions / expected - 1.0).abs() <= 1e-9,
            "{inner} {outer}: {revolutions} {expected}"
        );
        if inner != outer {
            let hours = revolutions / ((inner - outer).abs() * 60.0);
            assert!((value("hours") / hours - 1.0).abs() <= 1e-9, "{inner} {outer}: {hours}");
        }
        revolutions
    };
    let lives = [
        life(3000.0, 0.0, [true, false]),
        life(0.0, -500.0, [false, true]),
        life(3000.0, -500.0, [true, true]),
    ];
    // Without speeds the inner race is the rotating one.
    life(0.0, 0.0, [true, false]);
    for (one, other) in [(0, 1), (1, 2), (2, 0)] {
        assert!((lives[one] / lives[other] - 1.0).abs() > 0.01, "{lives:?}");
    }
}
