//! Defaults that the readers use are those of the key table.

use super::scene_dynamics::BEARING;
use bearing_dynamics::scene;
use bearing_dynamics::scene::tables::keys;
use bearing_dynamics::scene::tables::keys::{Key, Kind};
use bearing_dynamics::scene::{DefaultUsed, Document, Format, Subject};
use std::path::Path;

/// A default of the key table as JSON.
fn written(key: &Key, value: &str) -> serde_json::Value {
    match key.kind {
        Kind::Boolean => (value == "true").into(),
        Kind::Integer { .. } => value.parse::<i64>().unwrap().into(),
        Kind::Number(_) => value.parse::<f64>().unwrap().into(),
        Kind::Choices(words) => {
            let named: Vec<&str> = value.split(", ").filter(|word| words.contains(word)).collect();
            named.into()
        }
        Kind::Vector(_, range) => vec![format!("0 {}", range.unit); 3].into(),
        _ => value.into(),
    }
}

/// What a scene is resolved to, without the list of defaults.
fn understood(text: &str, name: &str) -> Result<Subject, String> {
    let document = Document::read_str(text, Format::Json, name).map_err(|e| e.to_string())?;
    resolved(&document).map(|(subject, _)| subject)
}

/// A resolved scene without its list of defaults, and the scene written out.
fn resolved(document: &Document) -> Result<(Subject, serde_json::Value), String> {
    let mut subject = scene::resolve_subject(document).map_err(|e| e.to_string())?;
    let defaults = take_defaults(&mut subject);
    Ok((subject, document.written_out(&defaults)))
}

/// Takes the lists of defaults out of a scene.
fn take_defaults(subject: &mut Subject) -> Vec<DefaultUsed> {
    let mut all = Vec::new();
    match subject {
        Subject::Assembly(scene) => {
            all.append(&mut scene.defaults_used);
            for placed in &mut scene.bearings {
                all.append(&mut placed.scene.defaults_used);
                all.append(&mut placed.scene.dynamics.defaults_used);
                if let Some(housing) = &mut placed.housing {
                    all.append(&mut housing.settings.defaults_used);
                    all.append(&mut housing.solid.defaults_used);
                }
            }
        }
        Subject::Solid(scene) => all.append(&mut scene.defaults_used),
    }
    all
}

/// A scene written out in SI with its bases and defaults is read as the same scene, bit by bit, and written out the same.
#[test]
fn a_scene_that_is_written_out_is_the_same() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let entries = ["scenes", "tests/data/asymmetric"]
        .map(|folder| std::fs::read_dir(root.join(folder)).unwrap());
    let (mut seen, mut wrong) = (0, String::new());
    for entry in entries.into_iter().flatten() {
        let path = entry.unwrap().path();
        let name = path.to_str().unwrap();
        let is_scene = name.ends_with(".json") || name.ends_with(".toml");
        // A second scene on rubber tries nothing new.
        if !is_scene || name.contains("dented_on_bushing") {
            continue;
        }
        let (subject, written) = resolved(&Document::read_file(&path).unwrap()).unwrap();
        let document = Document::read_str(&written.to_string(), Format::Json, name);
        match document.map_err(|error| error.to_string()).and_then(|of| resolved(&of)) {
            Ok((same, again)) if same == subject && again == written => {}
            Ok((other, again)) => {
                let one = format!("{subject:#?}");
                let other = format!("{other:#?}");
                let differ = one.lines().zip(other.lines()).filter(|(one, other)| one != other);
                let differ: Vec<_> = differ.take(5).collect();
                wrong += &format!("{name}: {differ:#?}\n{written}\n{again}\n\n");
            }
            Err(error) => wrong += &format!("{name}: {error}\n{written}\n\n"),
        }
        seen += 1;
    }
    assert!(wrong.is_empty(), "{wrong}");
    assert!(seen > 40, "{seen}");
}

/// Numbers are in SI, also those of a table that follow from others; only units that choose a law are written.
#[test]
fn a_scene_is_written_out_in_si() {
    let text =
        format!("{BEARING}[inner_race]\nz = {{ load = \"-1 kN\" }}\n[numerics]\nend = \"20 ms\"\n");
    let document = Document::read_str(&text, Format::Toml, "scene.toml").unwrap();
    let (_, written) = resolved(&document).unwrap();
    let number = |path: &str| written.pointer(path).and_then(|value| value.as_f64());
    assert_eq!(written["units"], "SI");
    assert_eq!(number("/inner_race/z/load"), Some(-1000.0));
    assert_eq!(number("/inner_race/y/load"), Some(0.0));
    assert_eq!(number("/numerics/end"), Some(0.02));
    assert_eq!(number("/output/window_start"), Some(0.01));
    assert_eq!(number("/bearing/ball/material/youngs_modulus"), Some(210e9));
    assert!(number("/inner_race/inertia/mass").is_some_and(|mass| mass > 0.0));
    assert_eq!(number("/traction/b"), Some(22.28));
    // A number without a unit is refused in any other scene.
    let bare = text.replace("\"20 ms\"", "0.02");
    assert!(Document::read_str(&bare, Format::Toml, "scene.toml").is_err());
    let in_si = format!("units = \"SI\"\n{bare}");
    let document = Document::read_str(&in_si, Format::Toml, "scene.toml").unwrap();
    assert_eq!(resolved(&document).unwrap().1["numerics"]["end"], 0.02);
}

/// A default that is written out changes nothing: no reader has another one in mind.
#[test]
fn a_default_of_the_table_is_the_one_in_use() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut trees: Vec<(String, serde_json::Value)> = Vec::new();
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_string();
        if name.ends_with(".toml") {
            let text = std::fs::read_to_string(&path).unwrap();
            let tree: serde_json::Value = toml::from_str(&text).unwrap();
            // What a base says is tried in the base; a second scene on rubber tries nothing new.
            let slow = ["dented_on_bushing", "creep_on_rubber"];
            if tree.get("base").is_none() && !slow.iter().any(|slow| name.contains(slow)) {
                trees.push((path.to_str().unwrap().into(), tree));
            }
        }
    }
    // Laws that no shipped scene has, on one of them.
    let base = |lines: &str| {
        let text = format!("{BEARING}{lines}[numerics]\nend = \"1 s\"\n");
        ("laws.json".to_string(), toml::from_str(&text).unwrap())
    };
    trees.push(base("[traction]\nlaw = \"slide-to-roll\"\n"));
    trees.push(base(
        "[inner_race.rotating_load]\nforce = \"1 N\"\nspeed = \"50 rpm\"\n[outer_race]\nmotion = \"6-dof\"\n",
    ));
    trees.push(base(
        "[body.hub]\nspeed = \"0 rpm\"\n[body.hub.beam]\nsegments = [{ length = \"0.4 m\", outer_diameter = \"30 mm\" }]\n",
    ));
    for along in ["x", "y"] {
        trees.push(base(&format!(
            "[body.hub]\nspeed = \"0 rpm\"\nrotating_load = {{ force = \"1 N\", speed = \"50 rpm\" }}\n\
             inertia = {{ mass = \"1 kg\", axial = \"1 kg m^2\", transverse = \"1 kg m^2\" }}\n\
             [spring.mount]\nfrom = \"hub\"\nstiffness = {{ {along} = \"1 N/m\" }}\n\
             damping = {{ {along} = \"1 N s/m\" }}\n"
        )));
    }
    let on_rubber = trees.iter().find(|(name, _)| name.ends_with("bearing_on_bushing.toml"));
    let (name, tree) = on_rubber.unwrap().clone();
    for method in ["explicit", "implicit"] {
        let mut tree = tree.clone();
        tree["spring"]["mount"]["bushing"]["method"] = method.into();
        trees.push((name.clone(), tree));
    }
    let rough = trees.iter().find(|(name, _)| name.ends_with("race_in_rough_bore.toml"));
    let (name, mut tree) = rough.unwrap().clone();
    assert!(tree["housing"]["friction"].as_object_mut().unwrap().remove("stretch").is_some());
    trees.push((name, tree));
    // What all shipped scenes state.
    for (scene, table, key) in
        [("bar_impact.toml", "solid", "material"), ("interference_fit.toml", "housing", "method")]
    {
        let (name, tree) = trees.iter().find(|(name, _)| name.ends_with(scene)).unwrap();
        let (name, mut tree) = (name.clone(), tree.clone());
        assert!(tree[table].as_object_mut().unwrap().remove(key).is_some());
        trees.push((name, tree));
    }
    // Sensors of either kind that are told nothing else.
    let caged =
        trees.iter().find(|(name, _)| name.ends_with("cage_telemeter.toml")).unwrap().clone();
    for sensor in [
        serde_json::json!({ "kind": "telemeter" }),
        serde_json::json!({ "kind": "accelerometer", "on": "cage" }),
    ] {
        let (name, mut tree) = caged.clone();
        tree["sensor"] = serde_json::json!({ "a": sensor });
        trees.push((name, tree));
    }
    let mut untried = Vec::new();
    for key in keys::KEYS.iter().filter(|key| !key.in_list()) {
        if key.need.default_in("engineering").is_none() {
            continue;
        }
        let mut tried = 0;
        for (name, tree) in &trees {
            let set = tree["defaults"].as_str().unwrap_or("engineering");
            let (value, _) = key.need.default_in(set).expect("a default in each set");
            let given = |path: &str| tree.pointer(&format!("/{}", path.replace('.', "/")));
            if given(key.path).is_some() || key.rivals().any(|rival| given(rival.path).is_some()) {
                continue;
            }
            let mut with = tree.clone();
            let (mut at, mut names) = (&mut with, key.path.split('.').collect::<Vec<_>>());
            if keys::OWN_NAMES.contains(&names[0]) {
                let Some(named) = tree[names[0]].as_object() else { continue };
                let name = named.keys().next().expect("a name");
                if named[name].pointer(&format!("/{}", names[1..].join("/"))).is_some() {
                    continue;
                }
                names.insert(1, name);
            }
            let (last, tables) = names.split_last().unwrap();
            let mut fits = true;
            for table in tables {
                if !at.is_object() {
                    fits = false;
                    break;
                }
                let all = at.as_object_mut().unwrap();
                at = all.entry(*table).or_insert_with(|| serde_json::json!({}));
            }
            if !fits || !at.is_object() {
                continue;
            }
            at[*last] = written(key, value);
            let before = understood(&tree.to_string(), name).unwrap();
            // A key that the scene has no use for is refused.
            let Ok(after) = understood(&with.to_string(), name) else { continue };
            assert_eq!(before, after, "{} = {value} in {name}", key.path);
            tried += 1;
        }
        if tried == 0 {
            untried.push(key.path);
        }
    }
    assert!(untried.is_empty(), "no scene takes {untried:?}");
}
