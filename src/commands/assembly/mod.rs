//! The commands on a scene of several bearings and bodies; here what they share. Of a bearing alone all of this
//! is what its own scene says.

pub mod housings;
pub mod statics;

use super::housed::echo as housed_echo;
use super::solid::echo as solid_echo;
use super::{echo, echo_run};
use bearing_dynamics::output::results::{ResultsError, quantity};
use bearing_dynamics::scene::DefaultUsed;
use bearing_dynamics::scene::assembly::{AssemblyScene, Carrier, PlacedBearing, Spring};
use bearing_dynamics::scene::dynamics::dynamic_problem;
use bearing_dynamics::solver::plan::Item;
use bearing_dynamics::solver::plan::motion::race_freedom;
use bearing_dynamics::solver::plan::solid::{self, Method};
use bearing_dynamics::solver::plan::statics as of_statics;
use housings::Housing;
use serde_json::{Map, Value, json};
use std::error::Error;

type Fallible<T> = Result<T, Box<dyn Error>>;

/// Defaults in use: of bodies and springs, then of each bearing.
pub fn defaults(scene: &AssemblyScene) -> Vec<DefaultUsed> {
    let of_bearings = scene.bearings.iter().flat_map(|placed| {
        let of_housing = placed.housing.iter().flat_map(|housing| {
            housing.settings.defaults_used.iter().chain(&housing.solid.defaults_used)
        });
        echo_run::defaults(&placed.scene).into_iter().chain(of_housing.cloned())
    });
    scene.defaults_used.iter().cloned().chain(of_bearings).collect()
}

/// Name of a bearing in tables of names.
pub fn name_of(placed: &PlacedBearing) -> &str {
    placed.name.as_deref().unwrap_or("bearing")
}

/// The scene as understood, every dimensional value with its unit.
pub fn echo(scene: &AssemblyScene) -> Result<Value, ResultsError> {
    if let Some(alone) = scene.only() {
        return echo::scene(alone);
    }
    let mut echo = Map::new();
    let common = scene.common();
    for (name, text) in [("title", &common.title), ("source", &common.source)] {
        if let Some(text) = text {
            echo.insert(name.into(), json!(text));
        }
    }
    let mut bearings = Map::new();
    for placed in &scene.bearings {
        let mut own = echo::scene(&placed.scene)?;
        if let Value::Object(map) = &mut own {
            map.remove("title");
            map.remove("source");
            for ((race, side), carrier) in
                [("inner_race", "inner"), ("outer_race", "outer")].into_iter().zip(placed.carriers)
            {
                let at = quantity("place", 1e3 * carrier.at(), "mm")?;
                let on = match carrier {
                    Carrier::Own { .. } => json!(race),
                    Carrier::Body { index, .. } => {
                        map.remove(race);
                        json!(scene.bodies[index].name)
                    }
                };
                map.insert(format!("{side}_on"), on);
                map.insert(format!("{side}_at"), at);
            }
            map.insert("reversed".into(), json!(placed.reversed));
            if let Some(housed) = placed.housed() {
                map.insert("housing".into(), housed_echo::housing(&housed)?);
                map.insert("solid".into(), solid_echo::scene(&housed.solid)?["solid"].take());
            }
        }
        bearings.insert(name_of(placed).into(), own);
    }
    echo.insert("bearings".into(), Value::Object(bearings));
    let bodies = scene.bodies.iter().map(|body| Ok((body.name.clone(), echo_run::body(body)?)));
    echo.insert("bodies".into(), Value::Object(bodies.collect::<Result<_, ResultsError>>()?));
    let springs = scene.springs.iter().map(|s| Ok((s.name.clone(), spring(scene, s)?)));
    echo.insert("springs".into(), Value::Object(springs.collect::<Result<_, ResultsError>>()?));
    Ok(Value::Object(echo))
}

fn spring(scene: &AssemblyScene, spring: &Spring) -> Result<Value, ResultsError> {
    let end = |(body, at): (Option<usize>, f64)| -> Result<Value, ResultsError> {
        let name = body.map_or("ground", |index| scene.bodies[index].name.as_str());
        Ok(json!({ "body": name, "at": quantity("place", 1e3 * at, "mm")? }))
    };
    let six = |values: &[f64; 6], units: [&str; 2]| -> Result<Value, ResultsError> {
        let names = ["x", "y", "z", "turn_x", "turn_y", "turn_z"];
        let entry = |(i, name): (usize, &&str)| {
            Ok((name.to_string(), quantity(name, values[i], units[usize::from(i > 2)])?))
        };
        Ok(Value::Object(names.iter().enumerate().map(entry).collect::<Result<_, ResultsError>>()?))
    };
    Ok(json!({
        "from": end(spring.ends[0])?,
        "to": end(spring.ends[1])?,
        "stiffness": six(&spring.stiffness, ["N/m", "N m/rad"])?,
        "damping": six(&spring.damping, ["N s/m", "N m s/rad"])?,
    }))
}

/// Bodies, loads and laws of a motion.
pub fn motion(scene: &AssemblyScene) -> Fallible<Value> {
    if let Some(alone) = scene.only() {
        return Ok(echo_run::motion(&dynamic_problem(alone)?)?);
    }
    let mut bearings = Map::new();
    for placed in &scene.bearings {
        let mut own = echo_run::motion(&dynamic_problem(&placed.scene)?)?;
        for (race, carrier) in ["inner_race", "outer_race"].into_iter().zip(placed.carriers) {
            if let (Value::Object(map), Carrier::Body { .. }) = (&mut own, carrier) {
                map.remove(race);
            }
        }
        bearings.insert(name_of(placed).into(), own);
    }
    Ok(Value::Object(bearings))
}

/// Where bearings sit and how bodies move, a line each.
pub fn lines(scene: &AssemblyScene) -> Vec<(String, String)> {
    let mut said = Vec::new();
    for placed in &scene.bearings {
        let sits = |carrier: &Carrier, own: &str| {
            let on = match carrier {
                Carrier::Own { .. } => own.to_string(),
                Carrier::Body { index, .. } => format!("body.{}", scene.bodies[*index].name),
            };
            format!("{on} at {:.4} mm", 1e3 * carrier.at())
        };
        let [inner, outer] = &placed.carriers;
        let way = if placed.reversed { ", reversed" } else { "" };
        said.push((
            format!("bearing {}", name_of(placed)),
            format!(
                "inner race on {}, outer race on {}{way}",
                sits(inner, "a body of its own"),
                sits(outer, "a body of its own")
            ),
        ));
    }
    for body in &scene.bodies {
        said.push((format!("body {}", body.name), race_freedom(&body.race)));
    }
    for spring in &scene.springs {
        let end = |(body, _): (Option<usize>, f64)| {
            body.map_or("the ground".to_string(), |index| {
                format!("body.{}", scene.bodies[index].name)
            })
        };
        let [from, to] = spring.ends.map(end);
        said.push((format!("spring {}", spring.name), format!("from {from} to {to}")));
    }
    said
}

/// What statics does: of each bearing, one search, and the housings in it.
pub fn statics_items(scene: &AssemblyScene, housings: &[Housing]) -> Fallible<Vec<Item>> {
    let still = scene.statics()?;
    let mut solids = Vec::new();
    for (index, housing) in housings.iter().enumerate() {
        let problem = &housing.mesh.setup.solid.problem;
        let mesh = super::housed::mesh_text(&housing.mesh.built);
        solids.extend(solid::items(
            problem,
            index,
            Some(&housing.of()),
            &mesh,
            &Method::QuasiStatic,
        ));
        let body = still.bearings[housing.bearing].mounts[1].body;
        solids.push(of_statics::seat(index, &still.bodies[body].name));
    }
    Ok(of_statics::items(&still, solids, of_statics::ASKED_FOR))
}
