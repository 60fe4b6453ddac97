//! Scenes are read as written: shipped scenes, every way to state a geometry, defaults, sweeps.

use bearing_dynamics::ch2_housing::bearing::geometry::{BearingKind, ClearanceThrough, Material};
use bearing_dynamics::ch2_housing::bearing::hertz::HertzModel;
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::scene;
use bearing_dynamics::scene::tables::keys;
use bearing_dynamics::scene::tables::keys::{Kind, Need};
use bearing_dynamics::scene::{Document, Format, Plot, Scene, Subject};
use std::path::{Path, PathBuf};

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

fn read(text: &str) -> Scene {
    scene::read_str(text, Format::Toml, "test.toml").unwrap_or_else(|error| panic!("{error}"))
}

/// Deep-groove scene of Table 4.1 with the given lines inside `[bearing]`.
fn deep_groove(lines: &str) -> String {
    format!(
        "defaults = \"dissertation\"\n[bearing]\nkind = \"deep-groove\"\nballs = 8\n{lines}\n\
         inner_race.groove_radius = \"6.013 mm\"\nouter_race.groove_radius = \"6.310 mm\"\n"
    )
}

/// Lengths that follow from each other by a few additions differ by a few roundings of the largest
/// radius, 32 mm, whose last place is 7e-18 m.
fn assert_close(ours: f64, expected: f64) {
    assert!((ours - expected).abs() <= 1e-16, "{ours:e} is not {expected:e}");
}

#[test]
fn every_shipped_scene_resolves_and_cites_its_source() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            continue;
        }
        match scene::read_subject(&path).unwrap_or_else(|error| panic!("{error}")) {
            Subject::Assembly(scene) => {
                let source =
                    scene.common().source.as_ref().expect("every shipped scene names its source");
                // A bearing from a catalogue is not the dissertation's.
                if source.contains("bore 25 mm") {
                    continue;
                }
                // One in its housing, or whose shaft bends, is of a section.
                let bends = scene.bodies.iter().any(|body| body.beam.is_some());
                let of = if scene.housing_method().is_some() || bends { "ection" } else { "Table" };
                assert!(source.contains(of), "{}: {source}", path.display());
            }
            Subject::Solid(scene) => assert!(scene.source.is_some(), "{}", path.display()),
        }
        count += 1;
    }
    assert!(count >= 5);
}

#[test]
fn the_bearing_of_table_3_5() {
    let scene = scene::read_file(&shipped("deep_groove_tilt.toml")).unwrap();
    let geometry = scene.geometry;
    assert_eq!(geometry.kind, BearingKind::DeepGroove);
    assert_eq!(geometry.ball_count, 8);
    assert_close(geometry.ball_radius, 5.9555e-3);
    assert_close(geometry.inner.centre_radius, 26.06e-3);
    assert_close(geometry.outer.centre_radius, 25.643e-3);
    assert_eq!(geometry.inner.groove_radius, 6.013e-3);
    assert_eq!(geometry.outer.centre_axial, 0.0);
    assert_close(geometry.pitch_radius, 26e-3);
    assert_eq!(geometry.radial_clearance, -5e-6);
    assert_eq!(scene.dimensions.diametral_clearance, -10e-6);
    assert_eq!(scene.hertz, HertzModel::HamrockBrewe);
    let free = Condition::Load(0.0);
    let tilted = Condition::Displacement(0.15_f64.to_radians());
    assert_eq!(scene.conditions, [free, free, free, tilted, free]);
    assert_eq!(scene.outer_race, [0.0; 5]);
    assert_eq!(scene.plots, [Plot::Polar, Plot::MomentTilt]);
}

#[test]
fn the_bearing_of_table_5_3_is_loaded_by_a_push_along_x() {
    let scene = scene::read_file(&shipped("angular_contact_axial.toml")).unwrap();
    let g = scene.geometry;
    assert_eq!(g.kind, BearingKind::AngularContact);
    let distance = |shift: f64| {
        let radial = g.inner.centre_radius - g.outer.centre_radius;
        radial.hypot(g.inner.centre_axial + shift - g.outer.centre_axial)
    };
    // The groove centres are as far apart as the just-touching ball needs.
    assert_close(
        distance(0.0),
        g.inner.groove_radius + g.outer.groove_radius - 2.0 * g.ball_radius,
    );
    assert!(distance(1e-6) > distance(0.0), "a push along +X must close the contacts");
    let angle = (g.inner.centre_axial - g.outer.centre_axial)
        .atan2(g.inner.centre_radius - g.outer.centre_radius);
    assert!((angle - 35_f64.to_radians()).abs() <= 1e-12, "{}", angle.to_degrees());
    assert_eq!(scene.conditions[0], Condition::Load(445.0));
    assert_eq!(scene.cage.unwrap().mass, Some(0.069));
}

#[test]
fn any_three_of_radii_and_clearance_give_the_same_bearing() {
    let given = |lines: &str| read(&deep_groove(lines)).geometry;
    let all_radii = given(
        "inner_race.radius = \"20.047 mm\"\nouter_race.radius = \"31.953 mm\"\nball.diameter = \"11.901 mm\"",
    );
    assert_close(all_radii.radial_clearance, 5e-6);
    let without = [
        "inner_race.radius = \"20.047 mm\"\nouter_race.radius = \"31.953 mm\"\nclearance.radial = \"5 um\"",
        "inner_race.radius = \"20.047 mm\"\nball.radius = \"5.9505 mm\"\nclearance.diametral = \"10 um\"",
        "outer_race.radius = \"31.953 mm\"\nball.radius = \"5.9505 mm\"\nclearance.radial = \"0.005 mm\"",
    ];
    for lines in without {
        let geometry = given(lines);
        assert_close(geometry.ball_radius, all_radii.ball_radius);
        assert_close(geometry.inner.centre_radius, all_radii.inner.centre_radius);
        assert_close(geometry.outer.centre_radius, all_radii.outer.centre_radius);
        assert_close(geometry.radial_clearance, 5e-6);
    }
}

#[test]
fn the_clearance_changes_the_part_it_goes_through() {
    for (through, part) in [
        ("ball", ClearanceThrough::Ball),
        ("inner-race", ClearanceThrough::InnerRace),
        ("outer-race", ClearanceThrough::OuterRace),
        ("races", ClearanceThrough::Races),
    ] {
        let scene = read(&deep_groove(&format!(
            "inner_race.radius = \"20.047 mm\"\nouter_race.radius = \"31.953 mm\"\n\
             ball.radius = \"5.953 mm\"\nclearance = {{ radial = \"20 um\", through = \"{through}\" }}"
        )));
        let sizes = scene.dimensions;
        assert_eq!(sizes.clearance_through, part);
        let both = |through| part == ClearanceThrough::Races && through != ClearanceThrough::Ball;
        let expected = |through, value, change: f64| match part == through {
            true => value + change,
            false if both(through) => value + 0.5 * change,
            false => value,
        };
        assert_close(
            scene.geometry.ball_radius,
            expected(ClearanceThrough::Ball, 5.953e-3, -10e-6),
        );
        assert_close(
            sizes.inner_race.radius,
            expected(ClearanceThrough::InnerRace, 20.047e-3, -20e-6),
        );
        assert_close(
            sizes.outer_race.radius,
            expected(ClearanceThrough::OuterRace, 31.953e-3, 20e-6),
        );
        assert_eq!(sizes.nominal_ball_radius, 5.953e-3);
    }
}

#[test]
fn a_clearance_of_an_angular_contact_bearing_is_the_travel_to_contact() {
    for through in ["ball", "inner-race", "outer-race", "races"] {
        for clearance in ["20 um", "-20 um"] {
            let text = std::fs::read_to_string(shipped("angular_contact_axial.toml")).unwrap();
            let mut document = Document::read_str(&text, Format::Toml, "test").unwrap();
            document.set("bearing.clearance.radial", clearance).unwrap();
            document.set("bearing.clearance.through", through).unwrap();
            let g = scene::resolve(&document).unwrap().geometry;
            // After a radial travel C of the inner race the ball just fits.
            let radial = g.inner.centre_radius + g.radial_clearance - g.outer.centre_radius;
            let distance = radial.hypot(g.inner.centre_axial - g.outer.centre_axial);
            let room = g.inner.groove_radius + g.outer.groove_radius - distance;
            assert_close(room, 2.0 * g.ball_radius);
        }
    }
}

#[test]
fn radius_conformity_and_osculation_say_the_same() {
    let race = |line: &str| {
        let text = format!(
            "[bearing]\nkind = \"deep-groove\"\nballs = 8\nball.radius = \"6 mm\"\n\
             inner_race.radius = \"20 mm\"\nouter_race.radius = \"32 mm\"\n\
             inner_race.{line}\nouter_race.groove_radius = \"6.3 mm\""
        );
        read(&text).dimensions.inner_race
    };
    for line in
        ["groove_radius = \"6.24 mm\"", "conformity = 0.52", "osculation = 0.9615384615384616"]
    {
        let race = race(line);
        assert_close(race.groove_radius, 6.24e-3);
        assert!((race.conformity - 0.52).abs() <= 1e-15);
        assert!((race.osculation - 1.0 / 1.04).abs() <= 1e-15);
    }
}

#[test]
fn defaults_are_the_documented_ones_and_every_one_is_named() {
    let scene = read(&deep_groove(
        "inner_race.radius = \"20.047 mm\"\nouter_race.radius = \"31.953 mm\"\nball.radius = \"5.953 mm\"",
    ));
    assert_eq!(scene.ball_material, Material::STEEL);
    assert_eq!(scene.ball_phase, 0.0);
    assert_eq!(scene.conditions, [Condition::Load(0.0); 5]);
    assert!(scene.cage.is_none() && scene.inner_speed.is_none() && !scene.centrifugal);
    let named: Vec<&str> = scene.defaults_used.iter().map(|used| used.key.as_str()).collect();
    for key in [
        "bearing.hertz",
        "bearing.ball_phase",
        "bearing.ball.material",
        "bearing.inner_race.material",
        "bearing.outer_race.material",
        "inner_race.x",
        "inner_race.tilt_z",
        "outer_race.tilt_y",
        "ball_forces.gravity",
        "ball_forces.centrifugal",
    ] {
        assert!(named.contains(&key), "{key} is not among {named:?}");
    }
    let partly = read(&deep_groove(
        "inner_race.radius = \"20.047 mm\"\nouter_race.radius = \"31.953 mm\"\nball.radius = \"5.953 mm\"\nball.material.density = \"3.2 g/cm^3\"",
    ));
    assert_eq!(partly.ball_material, Material { density: 3200.0, ..Material::STEEL });
    assert!(partly.defaults_used.iter().any(|d| d.key == "bearing.ball.material.youngs_modulus"));
}

#[test]
fn json_and_toml_of_the_same_scene_resolve_equally() {
    let json = r#"{"bearing": {"kind": "deep-groove", "balls": 8, "clearance": {"radial": "-5 um"},
        "inner_race": {"radius": "20.047 mm", "conformity": 0.51},
        "outer_race": {"radius": "31.953 mm", "osculation": 0.96}},
        "inner_race": {"z": {"load": "-1.5 kN"}}, "ball_forces": {"gravity": ["0 g", "0 g", "-1 g"]}}"#;
    let toml = r#"
        [bearing]
        kind = "deep-groove"
        balls = 8
        clearance.radial = "-5 um"
        inner_race = { radius = "20.047 mm", conformity = 0.51 }
        [bearing.outer_race]
        radius = "31.953 mm"
        osculation = 0.96
        [inner_race]
        z.load = "-1500 N"
        [ball_forces]
        gravity = ["0 m/s^2", "0 m/s^2", "-9.80665 m/s^2"]"#;
    let from_json = scene::read_str(json, Format::Json, "a.json").unwrap();
    assert_eq!(from_json, read(toml));
}

#[test]
fn a_byte_order_mark_is_no_part_of_the_text() {
    let text = std::fs::read_to_string(shipped("deep_groove_tilt.toml")).unwrap();
    let marked = format!("\u{feff}{text}");
    assert_eq!(read(&marked), read(&text));
}

#[test]
fn setting_a_key_takes_its_rivals_away() {
    let path = shipped("misaligned_radial.json");
    let mut document = Document::read_file(&path).unwrap();
    document.set("bearing.clearance.radial", "-5 um").unwrap();
    document.set("inner_race.tilt_y.moment", "2.5 N m").unwrap();
    document.set("bearing.balls", "7").unwrap();
    document.set("ball_forces.centrifugal", "false").unwrap();
    document.set("bearing.hertz", "hamrock-brewe").unwrap();
    document.set("bearing.inner_race.conformity", "0.515").unwrap();
    let scene = scene::resolve(&document).unwrap();
    assert_eq!(scene.geometry.radial_clearance, -5e-6);
    assert_eq!(scene.conditions[3], Condition::Load(2.5));
    assert_eq!(scene.geometry.ball_count, 7);
    assert!(!scene.centrifugal);
    assert_close(scene.geometry.inner.groove_radius, 0.515 * 2.0 * 5.953e-3);
}

#[test]
fn set_names_the_key_and_what_is_wrong() {
    let mut document = Document::read_file(&shipped("varying_compliance.toml")).unwrap();
    let unknown = document.set("bearing.clearance.radal", "5 um").unwrap_err().to_string();
    assert!(unknown.contains("did you mean `bearing.clearance.radial`"), "{unknown}");
    let bare = document.set("bearing.clearance.radial", "5").unwrap_err().to_string();
    assert!(bare.contains("no unit") && bare.contains("5 um"), "{bare}");
    let word = document.set("bearing.hertz", "exakt").unwrap_err().to_string();
    assert!(word.contains("did you mean `exact`"), "{word}");
    let gravity = document.set("ball_forces.gravity", "1 g").unwrap_err().to_string();
    assert!(gravity.contains("list of three") && gravity.contains("[\"0 m/s^2\""), "{gravity}");
    let none = document.set("output.plots", "").unwrap_err().to_string();
    assert!(none.contains("[\"load-zone\"]"), "{none}");
    document.set("bearing.ball.radius", "7 mm").unwrap();
    let late = scene::resolve(&document).unwrap_err().to_string();
    assert!(late.contains("bearing.ball.radius"), "{late}");
}

#[test]
fn sweep_values_include_both_ends_and_keep_their_decimals() {
    let document = Document::read_file(&shipped("varying_compliance.toml")).unwrap();
    let axis = &document.sweep()[1];
    assert_eq!((axis.key.as_str(), axis.len()), ("bearing.ball_phase", 91));
    assert_eq!(axis.value(0).unwrap(), "0 deg");
    assert_eq!(axis.value(1).unwrap(), "0.5 deg");
    assert_eq!(axis.value(90).unwrap(), "45 deg");
    assert_eq!(axis.value(91), None);

    let values = |key: &str, text: &str| -> Vec<String> {
        let axis = document.axis(key, text).unwrap_or_else(|error| panic!("{error}"));
        (0..axis.len()).map(|index| axis.value(index).unwrap()).collect()
    };
    assert_eq!(values("bearing.clearance.radial", "5 um,0um, -5 um"), ["5 um", "0um", "-5 um"]);
    assert_eq!(values("bearing.clearance.radial", "-5um..5um/3"), ["-5 um", "0 um", "5 um"]);
    assert_eq!(values("bearing.clearance.radial", "0 mm .. 10 um / 2"), ["0 mm", "0.01 mm"]);
    assert_eq!(values("inner_race.speed", "1 rad/s .. 2 rad/s / 2"), ["1 rad/s", "2 rad/s"]);
    assert_eq!(values("bearing.balls", "7 .. 9 / 3"), ["7", "8", "9"]);
    assert_eq!(values("bearing.hertz", "exact, hamrock-brewe"), ["exact", "hamrock-brewe"]);
    for (key, text) in [
        ("bearing.clearance.radial", "0 um .. 5 um"),
        ("bearing.clearance.radial", "0 um .. 5 um / 1"),
        ("bearing.clearance.radial", "0 um .. 5 um / x"),
        ("bearing.clearance.radial", "0 .. 5 um / 2"),
        ("bearing.clearance.radial", "1 um,,2 um"),
        ("bearing.clearance.radial", ""),
        ("bearing.hertz", "exact .. hamrock-brewe / 2"),
        ("bearing.balls", "7 .. 8 / 3"),
        ("title", "a, b"),
        ("bearing.ball", "1 mm"),
    ] {
        let error = document.axis(key, text).unwrap_err().to_string();
        assert!(error.contains("Hint: "), "{error}");
    }
}

#[test]
fn sweep_keys_may_be_quoted_or_dotted() {
    let base = deep_groove(
        "inner_race.radius = \"20.047 mm\"\nouter_race.radius = \"31.953 mm\"\nball.radius = \"5.953 mm\"",
    );
    let quoted = read(&format!("{base}[sweep]\n\"bearing.balls\" = [7, 8]\n"));
    let dotted = read(&format!("{base}[sweep]\nbearing.balls = \"7, 8\"\n"));
    assert_eq!(quoted.sweep, dotted.sweep);
}

/// A document in which any key may be set: both kinds' keys are checked only by `resolve`.
fn any_document() -> Document {
    Document::read_str("title = \"empty\"", Format::Toml, "test").unwrap()
}

#[test]
fn ranges_end_exactly_where_the_table_says() {
    let mut checked = 0;
    for key in keys::KEYS.iter().filter(|key| !key.in_list()) {
        let (low, high, low_included, high_included, unit) = match key.kind {
            Kind::Integer { low, high } => (low as f64, high as f64, true, true, ""),
            Kind::Number(r) | Kind::Quantity(_, r) | Kind::Profile(_, r) => {
                (r.low, r.high, r.low_included, r.high_included, r.unit)
            }
            _ => continue,
        };
        let accepted =
            |number: f64| any_document().set(key.path, &format!("{number} {unit}")).is_ok();
        let whole = matches!(key.kind, Kind::Integer { .. }) || (unit.is_empty() && high > 100.0);
        let step = if whole { 1.0 } else { 1e-9 * (high - low) };
        assert_eq!(accepted(low), low_included, "{} at {low}", key.path);
        assert_eq!(accepted(high), high_included, "{} at {high}", key.path);
        assert!(!accepted(low - step) && !accepted(high + step), "{} outside", key.path);
        assert!(accepted(low + step) && accepted(high - step), "{} inside", key.path);
        checked += 1;
    }
    assert!(checked > 100);
}

#[test]
fn every_default_and_every_example_is_a_value_its_key_takes() {
    // A base is a file, read at once.
    for key in keys::KEYS.iter().filter(|key| !["base", "without"].contains(&key.path)) {
        let text = match key.in_list() {
            true => format!("[[{}]]\n{} = {}", key.table(), key.name(), key.example()),
            false => format!("{} = {}", key.path, key.example()),
        };
        Document::read_str(&text, Format::Toml, "test").unwrap_or_else(|error| panic!("{error}"));
        let lists = key.in_list();
        let mut document = any_document();
        let set = document.set(key.path, key.example().trim_matches('"'));
        assert_eq!(set.is_ok(), !lists, "{}", key.path);
        let several = matches!(
            key.kind,
            Kind::Vector(..) | Kind::Choices(_) | Kind::Quantities(..) | Kind::QuantityList(..)
        );
        if let Need::Default { value, .. } = key.need
            && !(lists || several)
        {
            document.set(key.path, value).unwrap_or_else(|error| panic!("{error}"));
        }
    }
}
