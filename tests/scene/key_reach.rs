//! Each key of a table changes resolved values of its own: keys of one kind in one table never reach the same place.

use bearing_dynamics::scene::tables::keys::{KEYS, Key, Kind};
use bearing_dynamics::scene::{Document, Format, Subject, resolve_subject};
use std::collections::{BTreeMap, BTreeSet};

const SCENE: &str = r#"
[bearing.left]
kind = "deep-groove"
balls = 9
pitch_radius = "19.25 mm"
ball.diameter = "7.938 mm"
clearance.radial = "5 um"
inner_race = { conformity = 0.515 }
outer_race = { conformity = 0.525 }
inner_on = "shaft"
[outer_race.left]
motion = "6-dof"
inertia = { mass = "0.2 kg", axial = "1e-4 kg m^2", transverse = "1e-4 kg m^2" }
foundation.stiffness = { x = "1e8 N/m", y = "1e8 N/m", z = "1e8 N/m", tilt_y = "1e5 N m/rad", tilt_z = "1e5 N m/rad" }
[bearing.right]
kind = "deep-groove"
balls = 9
pitch_radius = "19.25 mm"
ball.diameter = "7.938 mm"
clearance.radial = "5 um"
inner_race = { conformity = 0.515 }
outer_race = { conformity = 0.525 }
inner_on = "shaft"
inner_at = "80 mm"
[body.shaft]
speed = "1000 rpm"
inertia = { mass = "1 kg", axial = "1e-3 kg m^2", transverse = "2e-3 kg m^2" }
[body.hub]
inertia = { mass = "2 kg", axial = "1e-3 kg m^2", transverse = "2e-3 kg m^2" }
[spring.one]
from = "ground"
to = "hub"
stiffness = { x = "1e7 N/m", y = "1e7 N/m", z = "1e7 N/m", turn_x = "1e4 N m/rad", turn_y = "1e4 N m/rad", turn_z = "1e4 N m/rad" }
[[spring.one.maxwell]]
relaxation_time = "10 ms"
x = "1e6 N/m"
[spring.two]
from = "ground"
to = "hub"
stiffness = { x = "1e7 N/m" }
[traction]
law = "slide-to-roll"
[numerics]
end = "1 ms"
output_interval = "1 us"
"#;

/// Tables, with the names of their instances, whose keys are looked at.
const TABLES: [(&str, &[&str]); 11] = [
    ("spring.stiffness", &["one", "two"]),
    ("spring.damping", &["one", "two"]),
    ("body.foundation.stiffness", &["hub", "shaft"]),
    ("body.foundation.damping", &["hub", "shaft"]),
    ("outer_race.foundation.stiffness", &["left"]),
    ("outer_race.foundation.damping", &["left"]),
    ("body.inertia", &["hub", "shaft"]),
    ("bearing.inner_race.material", &["left", "right"]),
    ("bearing.outer_race.material", &["left", "right"]),
    ("bearing.ball.material", &["left", "right"]),
    ("traction", &[""]),
];

/// Leaves of a value printed by `{:#?}`, by their path.
fn leaves(text: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    // Name of each open level, and the number of unnamed entries in it.
    let mut open: Vec<(String, usize)> = vec![(String::new(), 0)];
    for line in text.lines() {
        let line = line.trim().trim_end_matches(',');
        if line.starts_with(['}', ']', ')']) {
            open.pop();
            continue;
        }
        let (name, value) = match line.split_once(": ") {
            Some((name, value)) if name.chars().all(|c| c.is_alphanumeric() || c == '_') => {
                (name.to_string(), value)
            }
            _ => {
                let count = &mut open.last_mut().expect("a level is open").1;
                *count += 1;
                (count.to_string(), line)
            }
        };
        let path = open.iter().map(|(name, _)| name.as_str()).chain([name.as_str()]);
        let path: String = path.collect::<Vec<_>>().join(".");
        if value.ends_with(['{', '[', '(']) {
            open.push((name, 0));
        }
        found.insert(path, value.to_string());
    }
    found
}

fn resolved(scene: &str, change: Option<(&str, &str)>) -> Result<BTreeMap<String, String>, String> {
    let mut document = Document::read_str(scene, Format::Toml, "scene").unwrap();
    if let Some((key, value)) = change {
        document.set(key, value).map_err(|error| error.to_string())?;
    }
    match resolve_subject(&document).map_err(|error| error.to_string())? {
        Subject::Assembly(scene) => Ok(leaves(&format!("{scene:#?}"))),
        Subject::Solid(_) => panic!("a scene of bearings"),
    }
}

/// Places that differ from the scene as it is, apart from the list of defaults in use.
///
/// `None` for a key that the scene refuses.
fn reach(scene: &str, key: &str, value: &str) -> Option<BTreeSet<String>> {
    let base = resolved(scene, None).unwrap();
    let now = match resolved(scene, Some((key, value))) {
        Err(error) if error.contains("refused") => return None,
        now => now.unwrap_or_else(|error| panic!("{key} = {value}: {error}")),
    };
    let all: BTreeSet<&String> = base.keys().chain(now.keys()).collect();
    let changed = all
        .into_iter()
        .filter(|path| !path.contains("defaults_used") && base.get(*path) != now.get(*path))
        .cloned()
        .collect();
    Some(changed)
}

/// A value that is no default of any key here, in the unit of the key's range.
fn other_value(key: &Key) -> Option<String> {
    match key.kind {
        Kind::Quantity(_, range) => {
            let example = key.example();
            let unit = if example.contains(range.unit) { range.unit } else { return None };
            let value = match range.unit {
                "GPa" => 187.0,
                "kg" => 3.75,
                "kg/m^3" => 7123.0,
                "m/s" => 12.5,
                _ if key.path.contains("inertia") => 1.7e-3,
                _ => 1234.5,
            };
            Some(format!("{value} {unit}"))
        }
        Kind::Number(_) => Some("0.271".into()),
        _ => None,
    }
}

#[test]
fn a_key_reaches_places_of_its_own() {
    assert_eq!(resolved(SCENE, None), resolved(SCENE, None));
    let mut looked = 0;
    for (table, names) in TABLES {
        let mut seen: Vec<(String, BTreeSet<String>)> = Vec::new();
        for name in names {
            for key in KEYS.iter().filter(|key| key.table() == table) {
                let Some(value) = other_value(key) else { continue };
                let (first, rest) = key.path.split_once('.').unwrap();
                let path = if name.is_empty() {
                    key.path.to_string()
                } else {
                    format!("{first}.{name}.{rest}")
                };
                let Some(own) = reach(SCENE, &path, &value) else { continue };
                assert!(!own.is_empty(), "{path} = {value} changes nothing");
                for (other, places) in &seen {
                    let shared: Vec<_> = own.intersection(places).collect();
                    assert!(shared.is_empty(), "{path} and {other} both change {shared:?}");
                }
                seen.push((path, own));
                looked += 1;
            }
        }
        assert!(!seen.is_empty(), "{table}");
    }
    assert!(looked >= 60, "{looked}");
}

/// A bearing whose races both move, with the inertia of the outer one from its sizes.
const RACES: &str = r#"
[bearing]
kind = "deep-groove"
balls = 9
pitch_radius = "19.25 mm"
ball.diameter = "7.938 mm"
clearance.radial = "5 um"
inner_race = { conformity = 0.515 }
outer_race = { conformity = 0.525 }
[inner_race]
z = { load = "-100 N" }
[outer_race]
motion = "5-dof"
[numerics]
end = "1 ms"
output_interval = "1 us"
"#;

/// A key of one race changes no resolved value that a key of the other race changes.
#[test]
fn keys_of_a_race_leave_the_other_race_as_it_is() {
    let given =
        "inertia = { mass = \"0.2 kg\", axial = \"1e-4 kg m^2\", transverse = \"1e-4 kg m^2\" }\n";
    let of_both = RACES
        .replace("[inner_race]\n", &format!("[inner_race]\n{given}"))
        .replace("[outer_race]\n", &format!("[outer_race]\n{given}"));
    for (scene, fewest) in [(RACES, 8), (&of_both, 14)] {
        let mut looked = 0;
        let [inner, outer] = ["inner_race", "outer_race"].map(|race| {
            let below = |path: &str| path.strip_prefix(race).is_some_and(|of| of.starts_with('.'));
            let mut places = BTreeMap::new();
            for key in KEYS.iter().filter(|key| below(key.path)) {
                let Some(value) = other_value(key) else { continue };
                let Ok(_) = resolved(scene, Some((key.path, &value))) else { continue };
                let own = reach(scene, key.path, &value).expect("not refused");
                places.extend(own.into_iter().map(|place| (place, key.path)));
                looked += 1;
            }
            places
        });
        for (place, key) in &inner {
            assert!(!outer.contains_key(place), "{key} and {} both change {place}", outer[place]);
        }
        assert!(inner.len() >= 2 && looked >= fewest, "{looked} {inner:?}");
    }
}
