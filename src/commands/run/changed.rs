//! What has changed in a scene since the run that is to go on was begun.

use bearing_dynamics::output::json;
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::solver::clock::rounded;
use serde_json::Value;
use std::path::Path;

/// Changes that are named.
const MOST: usize = 5;
/// What may change from one part of a run to the next.
const FREE: [&str; 4] = ["title", "end", "plots", "window_start"];

/// What the summary in a folder has otherwise than the scene as it is now; empty where there is none.
pub fn since(folder: &Path, record: &RunRecord) -> String {
    let Ok(before) = json::read(&folder.join("summary.json")) else { return String::new() };
    let mut found = Vec::new();
    differences("scene", &before["scene"], &record.scene, &mut found);
    for (name, now) in record.sections.iter().filter(|(name, _)| name == "motion") {
        let mut of_motion = Vec::new();
        differences("scene", &before[name], now, &mut of_motion);
        let key = |said: &String| said.split(' ').next().map(String::from);
        of_motion.retain(|said| found.iter().all(|other| key(other) != key(said)));
        found.append(&mut of_motion);
    }
    let more = found.len().saturating_sub(MOST);
    found.truncate(MOST);
    match (found.len(), more) {
        (0, _) => {
            "; nothing of bodies and loads is otherwise: look at [numerics] (accuracy, integrator, step, start, energy_limit) and at \
             the mesh"
                .into()
        }
        (_, 0) => format!("; changed: {}", found.join(", ")),
        _ => format!("; changed: {} and {more} more", found.join(", ")),
    }
}

fn differences(path: &str, before: &Value, now: &Value, found: &mut Vec<String>) {
    let is_quantity = |of: &Value| of.get("value").is_some();
    match (before, now) {
        (Value::Object(old), Value::Object(new)) if !is_quantity(before) && !is_quantity(now) => {
            let added = new.keys().filter(|key| !old.contains_key(*key));
            for key in old.keys().chain(added).filter(|key| !FREE.contains(&key.as_str())) {
                let of = |list: &serde_json::Map<String, Value>| list.get(key).cloned();
                let [old, new] = [of(old), of(new)].map(Option::unwrap_or_default);
                differences(&format!("{path}.{key}"), &old, &new, found);
            }
        }
        _ if before != now => {
            found.push(format!("{path} was {}, is {}", text(before), text(now)));
        }
        _ => {}
    }
}

fn text(value: &Value) -> String {
    let number =
        |of: &Value| of.as_f64().map_or_else(|| of.to_string(), |x| rounded(x).to_string());
    match (&value["value"], value["unit"].as_str(), value) {
        (_, _, Value::Null) => "not there".into(),
        (Value::Null, ..) => number(value),
        (of, Some("1") | None, _) => number(of),
        (of, Some(unit), _) => format!("{} {unit}", number(of)),
    }
}
