//! Keys of lists of tables, by their numbers.

use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::{Document, Format, Subject, resolve_subject};
use std::path::Path;

fn stepped_rotor() -> Document {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    Document::read_file(&scenes.join("stepped_rotor.toml")).unwrap()
}

fn resolved(document: &Document) -> AssemblyScene {
    match resolve_subject(document).unwrap() {
        Subject::Assembly(scene) => *scene,
        Subject::Solid(_) => panic!("no bearings"),
    }
}

#[test]
fn set_reaches_the_tables_of_a_list() {
    let mut document = stepped_rotor();
    let shaft = |document: &Document| resolved(document).bodies[0].beam.clone().unwrap();
    let mut expected = shaft(&document);
    for (key, value) in [
        ("body.rotor.beam.segments.2.outer_diameter", "31 mm"),
        ("body.rotor.beam.segments.5.inner_diameter", "11 mm"),
        ("body.rotor.beam.unbalance.1.size", "5e-4 kg m"),
    ] {
        assert!(document.set(key, value).unwrap().is_empty());
    }
    expected.beam.segments[1].outer_diameter = 31e-3;
    expected.beam.segments[4].inner_diameter = 11e-3;
    expected.unbalances[0].1 = 5e-4;
    assert_eq!(shaft(&document), expected);
    let axis = document.axis("body.rotor.beam.load.1.z", "-1 N .. -3 N / 3").unwrap();
    assert_eq!((axis.len(), axis.value(1).unwrap().as_str()), (3, "-2 N"));
}

/// What a key excludes goes, of its own table alone.
#[test]
fn a_key_in_a_list_takes_away_what_it_excludes() {
    let text =
        "[[solid.set]]\nname = \"a\"\nplane = \"x\"\n[[solid.set]]\nname = \"b\"\nplane = \"y\"\n";
    let mut document = Document::read_str(text, Format::Toml, "scene.toml").unwrap();
    assert_eq!(document.set("solid.set.2.cylinder", "20 mm").unwrap(), ["solid.set.plane"]);
    assert_eq!(document.set("solid.set.2.cylinder", "30 mm").unwrap(), [""; 0]);
    assert_eq!(document.set("solid.set.1.cylinder", "30 mm").unwrap(), ["solid.set.plane"]);
}

#[test]
fn a_number_that_the_list_does_not_have_is_refused() {
    let mut document = stepped_rotor();
    for (key, expected) in [
        ("body.rotor.beam.segments.6.length", "has 5 tables. Allowed: 1 to 5"),
        ("body.rotor.beam.segments.0.length", "has 5 tables. Allowed: 1 to 5"),
        ("body.rotor.beam.disc.2.mass", "has one table. Allowed: 1."),
        ("body.rotor.beam.segments.length", "as in body.rotor.beam.segments.1.length"),
        ("bearing.fan.dent.1.angle", "has no tables"),
        ("body.rotor.2.beam.segments.length", "unknown key"),
        ("body.rotor.beam.2.damping", "unknown key"),
    ] {
        let error = document.set(key, "1 mm").unwrap_err().to_string();
        assert!(error.contains(expected), "{key}: {error}");
        assert_eq!(document.axis(key, "1 mm").unwrap_err().to_string(), error);
    }
}

/// A name whose list is that of all takes it for its own; the others keep theirs.
#[test]
fn a_name_takes_a_common_list_for_its_own() {
    let text = r#"
defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 8
clearance = { radial = "0 um" }
ball = { radius = "5.953 mm" }
inner_race = { radius = "20.047 mm", groove_radius = "6.013 mm" }
outer_race = { groove_radius = "6.310 mm" }
[body.shaft]
[spring]
from = "ground"
to = "shaft"
maxwell = [{ relaxation_time = "1 s", z = "1 N/m" }, { relaxation_time = "2 s", z = "1 N/m" }]
[spring.one]
[spring.two]
"#;
    let mut document = Document::read_str(text, Format::Toml, "scene.toml").unwrap();
    document.set("spring.two.maxwell.2.relaxation_time", "3 s").unwrap();
    let times = resolved(&document).springs.into_iter().map(|spring| {
        spring.maxwell.iter().map(|element| element.relaxation_time).collect::<Vec<_>>()
    });
    assert_eq!(times.collect::<Vec<_>>(), [[1.0, 2.0], [1.0, 3.0]]);
    // All that do not say otherwise.
    document.set("spring.maxwell.1.relaxation_time", "5 s").unwrap();
    assert_eq!(
        document.outside_range("spring.maxwell.1.relaxation_time"),
        (vec!["two".into()], false)
    );
    let first = |index: usize| resolved(&document).springs[index].maxwell[0].relaxation_time;
    assert_eq!([first(0), first(1)], [5.0, 1.0]);
}

/// Suggestions have the name of the table, and are not what was written.
#[test]
fn suggestions_can_be_followed() {
    let mut document = stepped_rotor();
    for (key, meant) in [
        ("body.rotor.beam.dampin", "`body.rotor.beam.damping`"),
        ("bearing.fan.clearance.radail", "`bearing.fan.clearance.radial`"),
        ("inner_race.load.z", "`inner_race.z`"),
        ("bearing.clearance", "Allowed here: bearing.clearance.radial"),
        ("body.rotor.beam.load[1].z", "`body.rotor.beam.load.z`"),
    ] {
        let error = document.set(key, "1 um").unwrap_err().to_string();
        assert!(error.contains(meant) && !error.contains(&format!("mean `{key}`")), "{error}");
    }
    let text = "[spring.mount]\nfrom = \"ground\"\n[spring.mount.stiffnes]\nx = \"1 N/m\"\n";
    let error = Document::read_str(text, Format::Toml, "scene.toml").unwrap_err().to_string();
    assert!(error.contains("did you mean `spring.mount.stiffness`?"), "{error}");
}
