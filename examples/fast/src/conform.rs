//! Results of one scene in the form of a case pack: `summary.json` and `series.csv`.

use crate::batch::{append, ellipse, largest};
use crate::lanes::{add, cross, dot};
use crate::motion::{columns, positions, run_of, tables};
use crate::scene::{COORDINATES, Outcome, Race, Scene, Stop, Through};
use crate::statics::{Common, Problem, axes, solve_lanes};
use serde_json::{Map, Value, json};

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// Step of a run as a fraction of 1 rad of its fastest oscillation.
const FRACTION: f64 = 0.02;

/// Tolerance of equilibria, see [`Common`].
const TOLERANCE: f64 = 1e-14;

fn quantity(value: f64, unit: &str) -> Value {
    json!({"value": value, "unit": unit})
}

fn vector(values: [f64; 3], unit: &str) -> Value {
    json!({"x": quantity(values[0], unit), "y": quantity(values[1], unit), "z": quantity(values[2], unit)})
}

fn five(values: [f64; 5], straight: &str, turn: &str, factor: f64) -> Value {
    let unit = |i: usize| if i < 3 { straight } else { turn };
    let value = |i: usize| if i < 3 { values[i] } else { values[i] * factor };
    Value::Object((0..5).map(|i| (COORDINATES[i].into(), quantity(value(i), unit(i)))).collect())
}

/// Column names and values of a tree of quantities: names joined by underscores.
fn flatten(name: &str, node: &Value, names: &mut Vec<String>, values: &mut Vec<f64>) {
    match node {
        Value::Object(items) if !items.contains_key("value") => {
            for (key, item) in items {
                flatten(&if name.is_empty() { key.clone() } else { format!("{name}_{key}") }, item, names, values);
            }
        }
        Value::Object(items) => {
            names.push(format!("{name} [{}]", items["unit"].as_str().unwrap_or("1")));
            values.push(items["value"].as_f64().unwrap_or(f64::NAN));
        }
        number => {
            names.push(format!("{name} [1]"));
            values.push(number.as_f64().unwrap_or(f64::NAN));
        }
    }
}

/// Table with a row for each list of numbers.
fn table(names: &[String], rows: &[Vec<f64>]) -> Vec<u8> {
    let mut text = names.join(",").into_bytes();
    text.push(b'\n');
    for row in rows {
        append(&mut text, row.iter().copied());
        text.pop();
        text.push(b'\n');
    }
    text
}

/// Summary and table of a scene: its run if it has `numerics`, else its equilibrium.
///
/// # Errors
///
/// No determinate equilibrium, or contact between balls.
pub fn solve(scene: &Scene) -> Outcome<(Value, Vec<u8>)> {
    if scene.run.is_some() { run(scene) } else { statics(scene) }
}

fn run(scene: &Scene) -> Outcome<(Value, Vec<u8>)> {
    let mut rows = tables(&[*scene], &Common::new(scene, TOLERANCE), FRACTION)?.remove(0);
    let columns = columns(scene.count);
    let degrees = |unit: &str| if unit == "rad" { ("deg", DEGREES) } else { ("", 1.0) };
    for row in &mut rows {
        for (value, (_, unit)) in row.iter_mut().zip(&columns) {
            *value *= degrees(unit).1;
        }
    }
    let unit = |unit: &'static str| if unit == "rad" { "deg" } else { unit };
    let names: Vec<String> = columns.iter().map(|(name, of)| format!("{name} [{}]", unit(of))).collect();
    let run = run_of(scene)?;
    let [mass, axial, transverse] = run.inertia;
    let inertia = json!({
        "mass": quantity(mass, "kg"), "axial": quantity(axial, "kg m^2"), "transverse": quantity(transverse, "kg m^2"),
        "centre": quantity(0.0, "mm"),
    });
    let time = rows.last().map_or(0.0, |row| row[0]);
    let summary = json!({
        "kind": "run", "end": quantity(run.end, "s"), "time": quantity(time, "s"),
        "body_inertia": {"the inner race": inertia},
    });
    Ok((summary, table(&names, &rows)))
}

fn statics(scene: &Scene) -> Outcome<(Value, Vec<u8>)> {
    let common = Common::new(scene, TOLERANCE);
    let problem = Problem::new(scene, &common);
    let found = solve_lanes(&common, &[problem]).remove(0);
    if !found.converged || !found.determinate {
        return Err(Stop::Unclaimed("a position that the loads do not determine, or that is not found,".into()));
    }
    let q = found.position;
    let places = positions(&common, &found.balls, scene.pitch, problem.phase);
    let frames = [axes(q), common.frame];
    let centres = [[q[0], q[1], q[2]], common.centre];
    let (mut listed, mut names, mut rows) = (Vec::new(), Vec::new(), Vec::new());
    let mut sums = [[[0.0; 3]; 2]; 2];
    let mut peak: f64 = 0.0;
    for (ball, place) in places.iter().enumerate() {
        let [c, s] = common.ring[ball];
        let azimuth = (scene.phase + s.atan2(c)) * DEGREES;
        let mut entry = Map::new();
        entry.insert("ball".into(), json!(ball + 1));
        entry.insert("azimuth".into(), quantity(azimuth.rem_euclid(360.0), "deg"));
        entry.insert("position".into(), vector(*place, "m"));
        for (side, race) in [&scene.inner, &scene.outer].into_iter().enumerate() {
            let arm = [0, 1, 2].map(|i| place[i] - centres[side][i]);
            let axis = frames[side][0];
            let axial = dot(axis, arm);
            let across = add(arm, -axial, axis);
            let radial = dot(across, across).sqrt();
            let (dx, dr) = (axial - race.axial, radial - race.radial);
            let length = dx.hypot(dr);
            let load = found.ball_loads[ball][side];
            let force = [0, 1, 2].map(|i| load * (dx * axis[i] + dr * across[i] / radial) / length);
            let moment = cross(arm, force);
            sums[side] = [add(sums[side][0], 1.0, force), add(sums[side][1], 1.0, moment)];
            if side == 0 {
                // The cage carries what acts along the orbit.
                let axis = common.frame[0];
                let outward = [0, 1, 2].map(|i| place[i] - common.centre[i]);
                let along = cross(axis, outward);
                let size = dot(along, along).sqrt();
                let push = (0..3).map(|i| (force[i] - scene.ball_mass * scene.gravity[i]) * along[i] / size).sum();
                entry.insert("cage_force".into(), quantity(push, "N"));
            }
            let [pressure, major, minor] = ellipse(&problem.hertz[side], load);
            peak = peak.max(pressure);
            let angle = (dx * dr.signum()).atan2(dr.abs()) * DEGREES;
            let contact = json!({
                "load": quantity(load, "N"), "approach": quantity(length - (race.groove - scene.ball_radius), "m"),
                "contact_angle": quantity(angle, "deg"), "semi_major": quantity(major, "m"),
                "semi_minor": quantity(minor, "m"), "peak_pressure": quantity(pressure, "Pa"),
                "force_on_race": vector(force, "N"),
            });
            entry.insert(["inner", "outer"][side].into(), contact);
        }
        let entry = Value::Object(entry);
        let mut values = Vec::new();
        names.clear();
        flatten("", &entry, &mut names, &mut values);
        rows.push(values);
        listed.push(entry);
    }
    let top = largest(&found);
    let loaded = [0, 1].map(|side| {
        let over = |ball: &usize| found.ball_loads[*ball][side] > 0.01 * top[side];
        (0..scene.count).filter(over).collect::<Vec<_>>()
    });
    let gaps = (0..loaded[0].len()).map(|i| {
        let next = loaded[0].get(i + 1).copied().unwrap_or(loaded[0][0] + scene.count);
        next - loaded[0][i]
    });
    let widest = gaps.max().unwrap_or(scene.count) as f64 / scene.count as f64;
    let extent = if loaded[0].len() == scene.count { 360.0 } else { 360.0 * (1.0 - widest) };
    let (gamma, count) = (scene.gamma(), scene.count as f64);
    let spin = 0.5 * scene.pitch / scene.ball_radius * (1.0 - gamma * gamma);
    let ratios = [
        ("cage", 0.5 * (1.0 - gamma)),
        ("ball_pass_outer", 0.5 * count * (1.0 - gamma)),
        ("ball_pass_inner", 0.5 * count * (1.0 + gamma)),
        ("ball_spin", spin),
        ("twice_ball_spin", 2.0 * spin),
    ];
    let frequency = |ratio: f64| {
        let mut entry = json!({"over_shaft": quantity(ratio, "1")});
        if scene.turns {
            entry["frequency"] = quantity(ratio * scene.speed / std::f64::consts::TAU, "Hz");
        }
        entry
    };
    let object = |items: Vec<(&str, Value)>| Value::Object(items.into_iter().map(|(key, item)| (key.into(), item)).collect());
    let units = ["N", "N", "N", "N m", "N m"];
    let stiffness = |i: usize| five(found.stiffness[i], &format!("{}/m", units[i]), &format!("{}/rad", units[i]), 1.0);
    let hertz = |side: usize| {
        let contact = &problem.hertz[side];
        json!({
            "stiffness": quantity(contact.stiffness, "N/m^1.5"), "ellipticity": quantity(contact.ellipticity, "1"),
            "radius_rolling": quantity(contact.rolling * 1e3, "mm"),
            "radius_transverse": quantity(contact.transverse * 1e3, "mm"),
        })
    };
    let length = |value: f64| quantity(value * 1e3, "mm");
    let sizes = |race: &Race, side: f64| {
        json!({
            "radius": length(race.radial - side * race.groove), "groove_radius": length(race.groove),
            "groove_centre_radius": length(race.radial), "groove_centre_axial": length(race.axial),
            "conformity": quantity(0.5 * race.groove / scene.nominal, "1"),
            "osculation": quantity(scene.nominal / race.groove, "1"),
        })
    };
    let through = match scene.through {
        Through::Ball => "ball",
        Through::Inner => "inner-race",
        Through::Outer => "outer-race",
        Through::Races => "races",
    };
    let geometry = json!({
        "radial_clearance": length(scene.clearance), "pitch_radius": length(scene.pitch),
        "ball_radius": length(scene.ball_radius), "clearance_through": through,
        "contact_angle": quantity(scene.contact_angle * DEGREES, "deg"), "ball_mass": quantity(scene.ball_mass, "kg"),
        "inner_race": sizes(&scene.inner, 1.0), "outer_race": sizes(&scene.outer, -1.0),
    });
    let summary = json!({
        "kind": "static solution",
        "geometry": geometry,
        "determinacy": {"kind": "determinate"},
        "inner_race": {
            "position": five(q, "m", "deg", DEGREES), "loads": five(found.loads, "N", "N m", 1.0),
            "contact_force": vector(sums[0][0], "N"), "contact_moment": vector(sums[0][1], "N m"),
        },
        "outer_race": {"contact_force": vector(sums[1][0], "N"), "contact_moment": vector(sums[1][1], "N m")},
        "stiffness": object((0..5).map(|i| (COORDINATES[i], stiffness(i))).collect()),
        "load_zone": {
            "extent": quantity(extent, "deg"), "balls_loaded_inner": loaded[0].len(), "balls_loaded_outer": loaded[1].len(),
            "largest_inner_load": quantity(top[0], "N"), "largest_outer_load": quantity(top[1], "N"),
            "largest_pressure": quantity(peak, "Pa"),
        },
        "balls": listed,
        "frequencies": object(ratios.iter().map(|(name, ratio)| (*name, frequency(*ratio))).collect()),
        "hertz": {"inner_race": hertz(0), "outer_race": hertz(1)},
    });
    Ok((summary, table(&names, &rows)))
}
