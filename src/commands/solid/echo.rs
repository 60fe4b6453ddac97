//! What was understood of a solid, as JSON with units.

use crate::commands::echo::head;
use crate::commands::echo_run::profile;
use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::ch2_housing::elastomer::maxwell::Maxwell;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::read::LengthUnit;
use bearing_dynamics::output::results::{ResultsError, quantity};
use bearing_dynamics::scene::SolidScene;
use bearing_dynamics::scene::solid::{
    Harmonic, Law, LoadKind, MeshSource, ProbeOf, RunSteps, SolidRun,
};
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::solid::explicit::{ExplicitMethod, SolidStepping};
use bearing_dynamics::solver::solid::model::DampedMotion;
use bearing_dynamics::solver::solid::rubber::steps::Stepping;
use bearing_dynamics::solver::solid::tangent::MassMatrix;
use serde_json::{Map, Value, json};

type Echo = Result<Value, ResultsError>;

const AXES: [&str; 3] = ["x", "y", "z"];

/// The resolved scene, every dimensional value with its unit.
pub fn scene(scene: &SolidScene) -> Echo {
    let mut echo = head(&scene.title, &scene.source);
    let held: Result<Vec<Value>, ResultsError> = scene
        .held
        .iter()
        .map(|held| Ok(merged(json!({ "set": held.set }), along_axes(&held.motion, "m")?)))
        .collect();
    let loads: Result<Vec<Value>, ResultsError> = scene
        .loads
        .iter()
        .map(|load| {
            let of = match &load.kind {
                LoadKind::Force(axes) => along_axes(axes, "N")?,
                LoadKind::Pressure(given) => json!({ "pressure": profile(given, "Pa")? }),
            };
            Ok(merged(json!({ "set": load.set }), of))
        })
        .collect();
    let probes: Result<Vec<Value>, ResultsError> = scene
        .probes
        .iter()
        .map(|probe| {
            Ok(match &probe.of {
                ProbeOf::Set(set) => json!({ "name": probe.name, "set": set }),
                ProbeOf::Place(at) => json!({ "name": probe.name, "at": vector(at, "m")? }),
            })
        })
        .collect();
    echo.insert(
        "solid".into(),
        json!({
            "mesh": mesh(scene)?,
            "material": material(scene)?,
            "damping": quantity("damping", scene.damping, "1/s")?,
            "damped_motion": match scene.damped_motion {
                DampedMotion::Absolute => "absolute",
                DampedMotion::RelativeToRigid => "relative-to-rigid",
            },
            "gravity": vector(&scene.gravity, "m/s^2")?,
            "velocity": vector(&scene.velocity, "m/s")?,
            "spin": quantity("spin", scene.spin, "rad/s")?,
            "held": held?,
            "load": loads?,
            "probe": probes?,
        }),
    );
    match &scene.law {
        Law::LinearElastic { .. } => {
            let mass = match scene.mode_mass {
                MassMatrix::Consistent => "consistent",
                MassMatrix::Lumped => "lumped",
            };
            echo.insert("modes".into(), json!({ "count": scene.mode_count, "mass": mass }));
        }
        Law::Elastomer(rubber) => {
            if let Some(asked) = &rubber.harmonic {
                echo.insert("harmonic".into(), harmonic(asked)?);
            }
        }
    }
    if let Some(run) = &scene.run {
        echo.insert("numerics".into(), numerics(run)?);
    }
    Ok(Value::Object(echo))
}

fn merged(mut into: Value, from: Value) -> Value {
    if let (Value::Object(into), Value::Object(from)) = (&mut into, from) {
        into.extend(from);
    }
    into
}

fn vector(of: &[f64; 3], unit: &str) -> Echo {
    let parts: Result<Vec<Value>, _> =
        of.iter().zip(AXES).map(|(value, axis)| quantity(axis, *value, unit)).collect();
    Ok(json!(parts?))
}

fn along_axes(profiles: &[Option<Profile>; 3], unit: &str) -> Echo {
    let mut echo = Map::new();
    for (axis, given) in AXES.iter().zip(profiles) {
        if let Some(given) = given {
            echo.insert((*axis).into(), profile(given, unit)?);
        }
    }
    Ok(Value::Object(echo))
}

fn material(scene: &SolidScene) -> Echo {
    let density = quantity("density", scene.density, "kg/m^3")?;
    let rubber = match &scene.law {
        Law::LinearElastic { youngs_modulus, poisson_ratio } => {
            return Ok(json!({
                "youngs_modulus": quantity("youngs_modulus", *youngs_modulus, "Pa")?,
                "poisson_ratio": quantity("poisson_ratio", *poisson_ratio, "1")?,
                "density": density,
            }));
        }
        Law::Elastomer(rubber) => rubber,
    };
    let network = &rubber.material.network;
    let mut maxwell = Vec::new();
    for Maxwell { gamma, tau } in &rubber.material.maxwell {
        let gamma = quantity("gamma", *gamma, "1")?;
        maxwell.push(json!({ "gamma": gamma, "relaxation_time": quantity("tau", *tau, "s")? }));
    }
    Ok(json!({
        "law": "elastomer",
        "table": rubber.table.unwrap_or("none"),
        "rubber_modulus": quantity("rubber_modulus", network.modulus, "Pa")?,
        "chain": quantity("chain", network.locking, "1")?,
        "chain_pull": match network.pull {
            ChainPull::FiveTerms => "five-terms",
            ChainPull::Exact => "inverse-langevin",
        },
        "bulk_modulus": quantity("bulk_modulus", network.bulk, "Pa")?,
        "density": density,
        "maxwell": maxwell,
    }))
}

/// Vibrations that are asked for.
fn harmonic(asked: &Harmonic) -> Echo {
    let frequencies = asked.frequencies.iter().map(|f| quantity("frequency", *f, "Hz"));
    let frequencies: Vec<Value> = frequencies.collect::<Result<_, _>>()?;
    Ok(json!({ "set": asked.set, "axis": AXES[asked.axis], "frequencies": frequencies }))
}

fn numerics(run: &SolidRun) -> Echo {
    let mut echo = json!({
        "end": quantity("end", run.end, "s")?,
        "output_interval": quantity("output_interval", run.output_interval, "s")?,
        "fields_interval": quantity("fields_interval", run.fields_interval, "s")?,
    });
    match run.steps {
        RunSteps::Explicit { method, stepping, energy_limit } => {
            echo["method"] = json!(match method {
                ExplicitMethod::CentralDifferences => "central-differences",
                ExplicitMethod::RungeKutta => "runge-kutta",
            });
            match stepping {
                SolidStepping::Fixed(step) => echo["step"] = quantity("step", step, "s")?,
                SolidStepping::FractionOfLimit(part) => {
                    echo["step_fraction"] = quantity("step_fraction", part, "1")?;
                }
            }
            echo["energy_limit"] = quantity("energy_limit", energy_limit, "1")?;
        }
        RunSteps::Implicit(Stepping::Fixed(step)) => echo["step"] = quantity("step", step, "s")?,
        RunSteps::Implicit(Stepping::Accuracy(accuracy)) => {
            echo["accuracy"] = quantity("accuracy", accuracy, "1")?;
        }
    }
    Ok(echo)
}

/// Where the mesh comes from; its numbers are in the summary's own part.
fn mesh(scene: &SolidScene) -> Echo {
    let request = &scene.mesh;
    let mut echo = source(&request.source)?;
    if let Some(order) = request.order {
        echo["order"] = json!(if order == Order::Linear { 1 } else { 2 });
    }
    echo["renumber"] = json!(request.renumber);
    echo["largest_aspect"] = quantity("largest_aspect", request.largest_aspect, "1")?;
    echo["cavities"] = json!(request.cavities);
    let repairs = [
        (request.orient, "orient"),
        (request.merge_duplicates, "merge-duplicates"),
        (request.drop_unreferenced, "drop-unreferenced"),
    ];
    let wanted: Vec<&str> = repairs.iter().filter(|(on, _)| *on).map(|(_, name)| *name).collect();
    echo["repair"] = json!(wanted);
    let sets: Vec<&str> = request.sets.iter().map(|set| set.name.as_str()).collect();
    echo["sets_by_geometry"] = json!(sets);
    Ok(echo)
}

fn source(source: &MeshSource) -> Echo {
    let made = |name: &str, dimensions: String| json!({ "generate": name, "si": dimensions });
    Ok(match source {
        MeshSource::File { name, unit, .. } => json!({
            "file": name,
            "unit": match unit { LengthUnit::Metre => "m", LengthUnit::Millimetre => "mm" },
        }),
        MeshSource::Bar { size, cells } => {
            json!({ "generate": "bar", "size": vector(size, "m")?, "cells": cells })
        }
        MeshSource::Block(block) => made("block", format!("{block:?}")),
        MeshSource::Ring(shape, cells) => made("ring", format!("{shape:?}, {cells:?}")),
        MeshSource::Shaft { radius, stations, longest_layer, around, radial } => made(
            "shaft",
            format!(
                "radius {radius}, stations {stations:?}, longest layer {longest_layer}, {around} \
                 cells around, {radial} radial"
            ),
        ),
        MeshSource::Cage(cage, cells) => made("cage", format!("{cage:?}, {cells:?}")),
        MeshSource::Housing(housing, cells) => made("housing", format!("{housing:?}, {cells:?}")),
        MeshSource::Bushing(body, cells) => made("bushing", format!("{body:?}, {cells:?}")),
    })
}
