//! The resolved solid as JSON with units.

use crate::commands::echo::head;
use crate::commands::echo_run::profile;
use bearing_dynamics::ch2_housing::elastomer::Elastomer;
use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::ch2_housing::elastomer::maxwell::Maxwell;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::generate::{
    CageMesh, ContactBlock, Housing, HousingMesh, Part, PillowBlock,
};
use bearing_dynamics::mesh::read::LengthUnit;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::results::{ResultsError, quantity};
use bearing_dynamics::scene::SolidScene;
use bearing_dynamics::scene::resolve::solid_scene::{
    Harmonic, Law, LoadKind, MeshSource, ProbeOf, RunSteps, SolidRun,
};
use bearing_dynamics::solids::explicit::{ExplicitMethod, SolidStepping};
use bearing_dynamics::solids::model::DampedMotion;
use bearing_dynamics::solids::rubber::steps::Stepping;
use bearing_dynamics::solids::tangent::MassMatrix;
use serde_json::{Map, Value, json};

type Echo = Result<Value, ResultsError>;

const AXES: [&str; 3] = ["x", "y", "z"];

pub fn scene(scene: &SolidScene) -> Echo {
    let mut echo = head(&scene.title, &scene.source);
    let fixed: Result<Vec<Value>, ResultsError> = scene
        .held
        .iter()
        .map(|support| Ok(merged(json!({ "set": support.set }), along_axes(&support.motion, "m")?)))
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
            "held": fixed?,
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
    let mut echo = self::rubber(&rubber.material, rubber.table)?;
    echo["density"] = density;
    Ok(echo)
}

/// Rubber network and its Maxwell elements; `table` is that of the source, if any.
pub fn rubber(material: &Elastomer, table: Option<&str>) -> Echo {
    let network = &material.network;
    let mut maxwell = Vec::new();
    for Maxwell { gamma, tau } in &material.maxwell {
        let gamma = quantity("gamma", *gamma, "1")?;
        maxwell.push(json!({ "gamma": gamma, "relaxation_time": quantity("tau", *tau, "s")? }));
    }
    Ok(json!({
        "law": "elastomer",
        "table": table.unwrap_or("none"),
        "rubber_modulus": quantity("rubber_modulus", network.modulus, "Pa")?,
        "chain": quantity("chain", network.locking, "1")?,
        "chain_force": match network.pull {
            ChainPull::FiveTerms => "five-terms",
            ChainPull::Exact => "inverse-langevin",
        },
        "bulk_modulus": quantity("bulk_modulus", network.bulk, "Pa")?,
        "maxwell": maxwell,
    }))
}

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

/// Source and settings of the mesh; its size is in a section of its own.
fn mesh(scene: &SolidScene) -> Echo {
    let request = &scene.mesh;
    let mut echo = source(&request.source)?;
    if let Some(order) = request.order {
        echo["order"] = json!(if order == Order::Linear { 1 } else { 2 });
    }
    // The axial position of a bearing is added to the place of its housing's mesh.
    echo["origin"] = vector(&request.place.origin, "m")?;
    echo["axis"] = json!(["x", "y", "z"][request.place.axis]);
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
    Ok(match source {
        MeshSource::File { name, unit, .. } => json!({
            "file": name,
            "unit": match unit { LengthUnit::Metre => "m", LengthUnit::Millimetre => "mm" },
        }),
        MeshSource::Bar { size, cells } => {
            json!({ "generate": "bar", "size": vector(size, "m")?, "cells": cells })
        }
        MeshSource::Block(ContactBlock {
            half_width,
            cells_per_half_width,
            depth_cells,
            growth,
        }) => merged(
            json!({
                "generate": "block",
                "cells": { "per_half_width": cells_per_half_width, "deep": depth_cells, "growth": growth },
            }),
            lengths(&[("half_width", *half_width)])?,
        ),
        MeshSource::Ring(ring, cells) => merged(
            json!({ "generate": "ring", "cells": around(cells.around, cells.radial, cells.axial, cells.radial_growth) }),
            lengths(&[
                ("inner_radius", ring.inner_radius),
                ("outer_radius", ring.outer_radius),
                ("width", ring.width),
            ])?,
        ),
        MeshSource::Shaft { radius, stations, longest_layer, around, radial } => {
            let places = stations.iter().map(|at| quantity("station", *at, "m"));
            let stations: Vec<Value> = places.collect::<Result<_, _>>()?;
            merged(
                json!({
                    "generate": "shaft",
                    "stations": stations,
                    "cells": { "around": around, "radial": radial },
                }),
                lengths(&[("radius", *radius), ("longest_layer", *longest_layer)])?,
            )
        }
        MeshSource::Cage(cage, cells) => {
            let mut sizes = vec![
                ("pocket_radius", cage.pocket_radius),
                ("inner_radius", cage.inner_radius),
                ("outer_radius", cage.outer_radius),
                ("width", cage.width),
            ];
            if let Some(relief) = cage.relief {
                sizes.extend([("relief_depth", relief.depth), ("belt_width", relief.belt_width)]);
            }
            let CageMesh { quarter, bar, wall } = cells;
            merged(
                json!({
                    "generate": "cage",
                    "pockets": cage.pocket_count,
                    "cells": { "quarter": quarter, "bar": bar, "wall": wall },
                }),
                lengths(&sizes)?,
            )
        }
        MeshSource::Housing(housing, cells) => housing_source(housing, cells)?,
        MeshSource::Bushing(body, cells) => merged(
            json!({
                "generate": "bushing",
                "part": match cells.part { Part::Whole => "whole", Part::Quarter => "quarter" },
                "cells": {
                    "around": cells.around,
                    "radial": cells.radial,
                    "axial": cells.axial,
                    "grading": cells.grading,
                },
            }),
            lengths(&[
                ("inner_diameter", body.inner_diameter),
                ("thickness", body.thickness),
                ("length", body.length),
            ])?,
        ),
    })
}

fn housing_source(housing: &Housing, cells: &HousingMesh) -> Echo {
    let (name, sizes) = match housing {
        Housing::Square { bore_radius, side, depth } => {
            ("housing-a", vec![("bore_radius", *bore_radius), ("side", *side), ("depth", *depth)])
        }
        Housing::Annulus { bore_radius, outer_radius, depth } => (
            "housing-d",
            vec![("bore_radius", *bore_radius), ("outer_radius", *outer_radius), ("depth", *depth)],
        ),
        Housing::MirroredPillowBlock(block) => ("housing-b", pillow_block(block)),
        Housing::PillowBlock(block) => ("housing-c", pillow_block(block)),
    };
    let HousingMesh { around: about, radial, axial, radial_growth } = *cells;
    let made = json!({ "generate": name, "cells": around(about, radial, axial, radial_growth) });
    Ok(merged(made, lengths(&sizes)?))
}

fn pillow_block(block: &PillowBlock) -> Vec<(&'static str, f64)> {
    vec![
        ("bore_radius", block.bore_radius),
        ("outer_radius", block.outer_radius),
        ("centre_height", block.centre_height),
        ("base_width", block.base_width),
        ("base_height", block.base_height),
        ("neck_width", block.neck_width),
        ("fillet_radius", block.fillet_radius),
        ("depth", block.depth),
    ]
}

fn around(around: usize, radial: usize, axial: usize, growth: f64) -> Value {
    json!({ "around": around, "radial": radial, "axial": axial, "growth": growth })
}

/// Sizes in m.
fn lengths(sizes: &[(&str, f64)]) -> Echo {
    let size = |(name, value): &(&str, f64)| Ok((name.to_string(), quantity(name, *value, "m")?));
    Ok(Value::Object(sizes.iter().map(size).collect::<Result<_, ResultsError>>()?))
}
