//! Differences between a scene and the run that it is to resume.

use bearing_dynamics::numeric::clock::rounded;
use bearing_dynamics::output::compare::channels::{Leaf, leaves};
use bearing_dynamics::output::json;
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::scene::tables::keys;
use bearing_dynamics::scene::tables::keys::Kind;
use serde_json::{Value, json};
use std::path::Path;

/// Largest number of changes that are listed.
const LISTED: usize = 5;
/// Keys that may change between the parts of a run.
const FREE: [&str; 4] = ["title", "end", "plots", "window_start"];

/// Text of the differences between the summary in a folder and the present scene; empty without a summary.
pub fn since(folder: &Path, record: &RunRecord) -> String {
    let Ok(before) = json::read(&folder.join("summary.json")) else { return String::new() };
    let found = differences(&before["scene"], &record.scene);
    if found.is_empty() {
        return "; bodies and loads are unchanged: check [numerics] (accuracy, integrator, step, start, energy_limit) and the mesh"
            .into();
    }
    let more = found.len().saturating_sub(LISTED);
    let named: Vec<String> =
        found.into_iter().take(LISTED).map(|(path, how)| format!("{path} {how}")).collect();
    let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("; changed: {}{rest}", named.join(", "))
}

/// Path of each value that differs, with its old and new value.
fn differences(before: &Value, now: &Value) -> Vec<(String, String)> {
    let [old, new] =
        [before, now].map(|tree| leaves(&json!({ "scene": tree })).unwrap_or_default());
    let find = |list: &[Leaf], path: &str| {
        list.iter().find(|leaf| leaf.path == path).map_or("absent".to_string(), text)
    };
    let is_free = |leaf: &&Leaf| leaf.path.split('.').any(|part| FREE.contains(&part));
    let removed = old.iter().filter(|leaf| new.iter().all(|other| other.path != leaf.path));
    let all = new.iter().chain(removed).filter(|leaf| !is_free(leaf));
    let paths = all.map(|leaf| leaf.path.as_str());
    paths
        .map(|path| (path, find(&old, path), find(&new, path)))
        .filter(|(_, was, is)| was != is)
        .map(|(path, was, is)| (path.to_string(), format!("was {was}, is {is}")))
        .collect()
}

fn text(leaf: &Leaf) -> String {
    let number = leaf.value.as_real().map(|value| rounded(value).to_string());
    let value = number.unwrap_or_else(|| leaf.value.to_string().trim_matches('"').to_string());
    format!("{value} {}", unit(&leaf.path)).trim_end().to_string()
}

/// Unit of a number of a written-out scene.
fn unit(path: &str) -> &'static str {
    use Kind::{Profile, Quantities, Quantity, QuantityList, TrueOrProfile, Vector};
    let leads = keys::find_named(path.trim_start_matches("scene."));
    match leads.map(|leads| leads.key.kind) {
        Some(
            Quantity(of, _)
            | Vector(of, _)
            | Profile(of, _)
            | TrueOrProfile(of, _)
            | Quantities(of, _)
            | QuantityList(of, _),
        ) => of.si_unit(),
        _ => "",
    }
}
