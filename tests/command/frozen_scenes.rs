//! Every scene of `scenes/` gives what it gave before: rows and states to the bit, work to the count.
//!
//! `golden/scenes/digests.json` holds a digest of each column, of the last state and of what was counted. Long
//! runs are cut. What goes through the factor of a large matrix is held to 1e-9 in place of bits, since
//! the order of sums there is the processor's.
//!
//! To accept a change, its reason kept beside the numbers: `make golden CASE=scenes REASON="…"`.

use crate::command_line_common::{changed, done, files, json, read, scene, scenes, text, write};
use bearing_dynamics::output::npy;
use serde_json::{Map, Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Ends of runs that are cut so that all scenes take some seconds together.
const CUT: [(&str, &str, &str); 13] = [
    ("cage_600rpm", "3.12144 s", "5 ms"),
    ("cage_telemeter", "1.5 s", "20 ms"),
    ("impact", "60 ms", "6 ms"),
    ("bar_impact", "0.4 ms", "0.05 ms"),
    ("bushing_radial", "0.225 s", "0.08 s"),
    ("creep_on_rubber", "30 s", "0.2 s"),
    ("dented_on_bushing", "60 ms", "10 ms"),
    ("rotating_load_orbit", "1.3 s", "50 ms"),
    ("rotor_in_elements", "5 ms", "0.3 ms"),
    ("settling", "0.2 s", "50 ms"),
    ("spinning_disc", "12 ms", "1 ms"),
    ("stepped_rotor", "0.3 s", "0.05 s"),
    ("varying_compliance_run", "0.4 s", "50 ms"),
];

/// What asks for the equilibrium or the modes of a solid.
const FACTORED: [&str; 9] = [
    "bushing_radial",
    "cage_modes",
    "cantilever",
    "housing_a_rotating_load",
    "housing_c_tet10",
    "interference_fit",
    "ring_modes",
    "rotor_of_tetrahedra",
    "shaft_in_two_housings",
];

/// Of a factored column, against its largest value: DESIGN.md's bound for factorisations.
const FACTORED_DIFFERENCE: f64 = 1e-9;

fn golden() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden/scenes/digests.json")
}

/// FNV-1a over the bits of numbers.
fn digest(values: impl IntoIterator<Item = f64>) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    for byte in values.into_iter().flat_map(|value| value.to_bits().to_le_bytes()) {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    format!("{hash:016x}")
}

/// Every array of numbers called `state`, and the arrays that a state names as a file, in their order.
fn states(of: &Value, folder: &Path, to: &mut Vec<f64>) {
    if let Value::Array(list) = of {
        list.iter().for_each(|value| states(value, folder, to));
    }
    let Value::Object(entries) = of else { return };
    for (key, value) in entries {
        match (key.as_str(), value) {
            ("state", Value::Array(numbers)) => {
                to.extend(numbers.iter().map(|number| number.as_f64().expect("a number")));
            }
            ("arrays", Value::String(name)) => {
                let bytes = fs::read(folder.join(name)).unwrap();
                to.extend(npy::parse(&bytes).unwrap().iter());
            }
            _ => states(value, folder, to),
        }
    }
}

/// Every count in what the summary calls work, by its name.
fn counts(of: &Value) -> Map<String, Value> {
    let work = of.get("work").and_then(Value::as_object).cloned().unwrap_or_default();
    work.into_iter().filter(|(_, value)| value.is_u64()).collect()
}

fn column(values: Vec<f64>, factored: bool) -> Value {
    if !factored {
        return json!(digest(values));
    }
    let largest = values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    // Weights by place, so that rows that change places are seen.
    let weighed: f64 = values.iter().enumerate().map(|(i, v)| v * (1.0 + (i % 7) as f64)).sum();
    json!([largest, weighed / (values.len() as f64)])
}

/// A scene, what it gives now, and its summary.
struct Given {
    name: String,
    now: Value,
    summary: Value,
}

/// Every scene, run once for all tests.
fn all() -> &'static [Given] {
    static ALL: OnceLock<Vec<Given>> = OnceLock::new();
    ALL.get_or_init(|| {
        let scenes = files(&scenes()).into_iter();
        scenes
            .filter_map(|file| file.rsplit_once('.').map(|(name, _)| given(name, &file)))
            .collect()
    })
}

/// What a scene gives now.
fn given(name: &str, file: &str) -> Given {
    let folder = tempfile::tempdir().unwrap();
    let mut content = read(Path::new(&scene(file)));
    let meshes = text(&scenes().join("meshes"));
    content = content.replace("\"meshes/", &format!("\"{meshes}/"));
    if let Some((_, from, to)) = CUT.iter().find(|(cut, _, _)| *cut == name) {
        content = changed(&content, &format!("end = \"{from}\""), &format!("end = \"{to}\""));
        // A window of averages that would begin after the earlier end.
        let kept = content.lines().filter(|line| !line.starts_with("window_start"));
        content = kept.map(|line| format!("{line}\n")).collect();
    }
    let based = content.contains("\nbase = ");
    let command = if based || content.contains("numerics") {
        "run"
    } else if name.ends_with("_modes") {
        "modes"
    } else {
        "statics"
    };
    let written = write(folder.path(), file, &content);
    if let Some((_, name)) = content.split_once("\nbase = \"") {
        let name = name.split('"').next().expect("a file");
        write(folder.path(), name, &read(Path::new(&scene(name))));
    }
    let out = folder.path().join("out");
    done(&[command, &written, "--out", &text(&out)]);
    let names = json(&out.join("series.columns.json"));
    let names: Vec<String> = names
        .as_array()
        .expect("a list of columns")
        .iter()
        .map(|column| column["name"].as_str().expect("a name").to_string())
        .collect();
    let rows = npy::parse(&fs::read(out.join("series.npy")).unwrap()).unwrap();
    assert_eq!(rows.ncols(), names.len(), "{name}");
    let factored = FACTORED.contains(&name);
    let columns: Map<String, Value> = names
        .into_iter()
        .zip(rows.columns())
        .map(|(name, values)| (name, column(values.to_vec(), factored)))
        .collect();
    let mut frozen = Map::new();
    frozen.insert("command".into(), json!(command));
    frozen.insert("rows".into(), json!(rows.nrows()));
    frozen.insert("columns".into(), columns.into());
    let summary = json(&out.join("summary.json"));
    frozen.insert("work".into(), counts(&summary).into());
    let state = out.join("state.json");
    if state.exists() {
        let mut numbers = Vec::new();
        states(&json(&state), &out, &mut numbers);
        assert!(numbers.len() > 100, "{name}: {} numbers of state", numbers.len());
        frozen.insert("state".into(), json!(digest(numbers)));
    }
    Given { name: name.into(), now: frozen.into(), summary }
}

/// A plan is what was done: each stage that it does ran, and nothing else did.
#[test]
fn every_scene_runs_what_its_plan_does_and_nothing_else() {
    let mut wrong = Vec::new();
    for Given { name, summary, .. } in all() {
        let (plan, stages) = (&summary["plan"], &summary["stages"]);
        let lines = plan.as_array().expect("lines");
        let stages = stages.as_array().expect("stages");
        let does = |line: &&Value| line.as_str().expect("a line").starts_with("does ");
        let done = stages.iter().filter(|stage| stage["does"] == true).count();
        assert_eq!(lines.iter().filter(does).count(), done, "{name}");
        assert!(done >= 2 && stages.len() >= lines.len(), "{name}: {plan}");
        for stage in stages {
            let ran = stage["ran"].as_u64().expect("a count");
            if (ran > 0) != (stage["does"] == true) {
                wrong.push(format!("{name}: {stage}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What of `now` is not as it was; a column or a count may be new.
fn differences(before: &Value, now: &Value, at: &str, to: &mut Vec<String>) {
    match (before, now) {
        (Value::Object(before), Value::Object(now)) => {
            for (key, value) in before {
                let at = format!("{at}/{key}");
                match now.get(key) {
                    Some(now) => differences(value, now, &at, to),
                    None => to.push(format!("{at} is gone")),
                }
            }
        }
        (Value::Array(before), Value::Array(now)) => {
            let number = |of: &Value| of.as_f64().expect("a number");
            let largest = number(&before[0]).abs();
            for (before, now) in before.iter().zip(now) {
                let difference = (number(before) - number(now)).abs();
                // NaN is a difference.
                let alike = difference <= FACTORED_DIFFERENCE * largest;
                if !alike {
                    to.push(format!("{at}: {before} became {now}"));
                }
            }
        }
        _ if before == now => {}
        _ => to.push(format!("{at}: {before} became {now}")),
    }
}

#[test]
fn every_scene_gives_what_it_gave() {
    let mut found = Map::new();
    for Given { name, now, .. } in all() {
        found.insert(name.clone(), now.clone());
    }
    assert!(found.len() >= 19, "{} scenes", found.len());
    if let Ok(reason) = std::env::var("FREEZE_REASON") {
        assert!(reason.trim().len() >= 10, "a reason for new numbers: {reason:?}");
        let mut reasons = vec![];
        if golden().exists() {
            reasons = json(&golden())["reasons"].as_array().expect("reasons").clone();
        }
        reasons.push(reason.into());
        let all = json!({ "reasons": reasons, "scenes": found });
        fs::write(golden(), serde_json::to_string_pretty(&all).unwrap() + "\n").unwrap();
        return;
    }
    let before = json(&golden());
    let names = |of: &Map<String, Value>| of.keys().cloned().collect::<Vec<_>>();
    let held = names(before["scenes"].as_object().expect("scenes"));
    assert_eq!(held, names(&found), "every scene is held, and every one that is held is there");
    let mut different = Vec::new();
    differences(&before["scenes"], &Value::Object(found), "scenes", &mut different);
    assert!(different.is_empty(), "{} differences:\n{}", different.len(), different.join("\n"));
}
