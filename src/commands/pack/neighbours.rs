//! Scenes next to a scene: with finer steps, other rounding, shorter beams, balls that start elsewhere.

use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Relative change of densities and moduli that is far above rounding and far below every tolerance: of equal values
/// it makes another one the largest.
const NOISE: f64 = 1e-11;
/// Relative change of all numbers that is rounding: it decides whether what just touches does.
const ROUNDING: f64 = 1e-15;
/// Shift of the balls that shows how neighbouring runs part, rad.
const NEIGHBOUR: f64 = 1e-9;
/// Shift of the balls from one start to the next, rad.
const NEXT_START: f64 = 1e-6;
/// Other starts of a chaotic run.
pub const STARTS: usize = 16;
/// Parts of a segment of a beam: discs and bearings, where elements end anyway, are seldom at fifths.
const PARTS: usize = 5;
/// Largest shift of a start, rad.
pub const FARTHEST_START: f64 = STARTS as f64 * NEXT_START;

/// Scenes whose results differ by rounding alone, by the length of the elements of beams, by the modes of shafts, or by
/// meshes that a pack does not have.
pub fn alike(scene: &Value) -> Vec<Value> {
    let noises = [NOISE, -NOISE].map(|noise| {
        scaled(scene, &[("density", 1.0 + noise), ("youngs_modulus", 1.0 - noise)], &[])
    });
    let modes = scaled(scene, &[("modes_to", 2.0)], &["body"]);
    let others = [shifted(scene, TAU), shorter_beams(scene), modes, finer_meshes(scene)];
    let others = noises.into_iter().chain(others);
    others.flatten().chain([rounded(scene, 0), rounded(scene, 1)]).collect()
}

/// The scene with all its numbers rounded, up and down in turns from the one that `first` says.
fn rounded(scene: &Value, first: usize) -> Value {
    fn round(value: &mut Value, count: &mut usize) {
        match value {
            Value::Number(number) if number.is_f64() => {
                let sign = if count.is_multiple_of(2) { 1.0 } else { -1.0 };
                *count += 1;
                *value = json!(number.as_f64().unwrap_or(0.0) * (1.0 + sign * ROUNDING));
            }
            Value::Array(list) => list.iter_mut().for_each(|of| round(of, count)),
            Value::Object(map) => map.values_mut().for_each(|of| round(of, count)),
            _ => {}
        }
    }
    let (mut other, mut count) = (scene.clone(), first);
    // Times of rows are compared, and sweeps have texts.
    let parts = other.as_object_mut().into_iter().flatten();
    let parts = parts.filter(|(name, _)| !["numerics", "output", "sweep"].contains(&name.as_str()));
    parts.for_each(|(_, part)| round(part, &mut count));
    other
}

/// The scene with half the steps, or a tenth of the accuracy, and with a third of it; none without steps.
pub fn finer(scene: &Value) -> Vec<Value> {
    const TABLES: [&str; 3] = ["numerics", "housing", "solid"];
    let steps = |accuracy: f64| {
        let halves = ["step", "step_fraction", "coupling_phase"].map(|name| (name, 0.5));
        [&halves[..], &[("accuracy", accuracy)]].concat()
    };
    let third = scaled(scene, &[("accuracy", 0.3)], &TABLES);
    scaled(scene, &steps(0.1), &TABLES).into_iter().chain(third).collect()
}

/// The scene whose run shows whether runs part; `None` without bearings.
pub fn neighbour(scene: &Value) -> Option<Value> {
    shifted(scene, NEIGHBOUR)
}

/// Other starts of the same motion.
pub fn starts(scene: &Value) -> impl Iterator<Item = Value> {
    (1..=STARTS).filter_map(|start| shifted(scene, start as f64 * NEXT_START))
}

/// The scene with numbers of these keys multiplied, in the named tables or in all; `None` without such keys.
fn scaled(scene: &Value, factors: &[(&str, f64)], tables: &[&str]) -> Option<Value> {
    let mut other = scene.clone();
    let scale = |map: &mut serde_json::Map<String, Value>| {
        let mut any = false;
        for (key, factor) in factors {
            if let Some(number) = map.get(*key).and_then(Value::as_f64) {
                map.insert(key.to_string(), json!(factor * number));
                any = true;
            }
        }
        any
    };
    let changed = match tables {
        [] => in_tables(&mut other, &scale),
        _ => {
            let found = tables
                .iter()
                .map(|table| other.get_mut(*table).is_some_and(|table| in_tables(table, &scale)));
            found.fold(false, |any, found| any | found)
        }
    };
    changed.then_some(other)
}

/// The scene with the balls of all bearings shifted; `None` without bearings.
fn shifted(scene: &Value, by: f64) -> Option<Value> {
    let mut other = scene.clone();
    let shift = |map: &mut serde_json::Map<String, Value>| {
        let has_balls = map.contains_key("balls");
        if has_balls {
            let phase = map.get("ball_phase").and_then(Value::as_f64).unwrap_or(0.0);
            // Forth or back, so that a whole turn stays within a turn of zero.
            let shifted = if phase > 0.0 { phase - by } else { phase + by };
            map.insert("ball_phase".into(), shifted.into());
        }
        has_balls
    };
    other.get_mut("bearing").is_some_and(|of| in_tables(of, &shift)).then_some(other)
}

/// The scene with half as many cells again in shafts of elements and bushings, and with bushings fitted to ten times the
/// frequency; `None` without them.
pub fn finer_meshes(scene: &Value) -> Option<Value> {
    let mut other = scene.clone();
    let finer = |map: &mut serde_json::Map<String, Value>| {
        let mut any = false;
        for key in ["around", "radial", "axial"] {
            // Cells come in twos.
            if let Some(cells) = map.get(key).and_then(Value::as_u64).filter(|cells| cells % 4 == 0)
            {
                map.insert(key.into(), json!(cells + cells / 2));
                any = true;
            }
        }
        if let Some(fastest) = map.get("fastest").and_then(Value::as_f64) {
            map.insert("fastest".into(), json!(10.0 * fastest));
        }
        any
    };
    let tables = ["body", "spring"].iter();
    let found =
        tables.filter(|table| other.get_mut(**table).is_some_and(|of| in_tables(of, &finer)));
    let count = found.count();
    (count > 0).then_some(other)
}

/// Returns whether there are shafts, as beams or of elements.
pub fn has_shafts(scene: &Value) -> bool {
    let bodies = scene["body"].as_object().into_iter().flatten();
    bodies.into_iter().any(|(_, body)| body.get("beam").is_some())
}

pub fn has_beams(scene: &Value) -> bool {
    shorter_beams(scene).is_some()
}

/// The scene with each segment of a beam as [`PARTS`]; `None` without beams.
fn shorter_beams(scene: &Value) -> Option<Value> {
    let mut other = scene.clone();
    let divide = |map: &mut serde_json::Map<String, Value>| {
        // Of a shaft of tetrahedra the mesh would change.
        if map.contains_key("mesh") {
            return false;
        }
        let Some(Value::Array(segments)) = map.get_mut("segments") else { return false };
        let parts = |segment: &Value| {
            let mut part = segment.clone();
            let length = segment["length"].as_f64().unwrap_or(f64::NAN);
            part["length"] = json!(length / PARTS as f64);
            vec![part; PARTS]
        };
        *segments = segments.iter().flat_map(parts).collect();
        true
    };
    other.get_mut("body").is_some_and(|of| in_tables(of, &divide)).then_some(other)
}

/// Changes every table at and below a value; returns whether one was changed.
fn in_tables(
    value: &mut Value,
    change: &impl Fn(&mut serde_json::Map<String, Value>) -> bool,
) -> bool {
    match value {
        Value::Object(map) => {
            let own = change(map);
            map.values_mut().fold(own, |any, below| in_tables(below, change) | any)
        }
        Value::Array(list) => list.iter_mut().fold(false, |any, of| in_tables(of, change) | any),
        _ => false,
    }
}
