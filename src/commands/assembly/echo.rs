//! The resolved scene of bearings as JSON with units.

use super::housing::method;
use super::lists::Lists;
use super::{Fallible, name_of};
use crate::commands::{echo as bearing_echo, echo_run, solid};
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::ch4_rotor::bore_friction::BoreFriction;
use bearing_dynamics::members::beam::{BeamDisc, BeamSegment};
use bearing_dynamics::members::connection::{CrossCoupling, MaxwellElement};
use bearing_dynamics::output::results::{ResultsError, quantity};
use bearing_dynamics::scene::RunSettings;
use bearing_dynamics::scene::build::assembly::{
    AssemblyScene, BushingInElements, BushingOfSpring, BushingStepping, Carrier, PlacedBearing,
    PlacedHousing, SIX, SceneBeam, Spring, SpringAt, SpringEnd,
};
use bearing_dynamics::scene::build::motion::dynamic_problem;
use bearing_dynamics::scene::build::sensors::{Direction, SceneSensor, SceneSensorKind};
use bearing_dynamics::scene::resolve::housing_scene::{FitSize, HousingMethod, HousingSettings};
use bearing_dynamics::solids::bore_equilibrium::Axial;
use bearing_dynamics::solids::rubber::sleeve::SleeveMotion;
use serde_json::{Map, Value, json};

pub fn echo(lists: &Lists) -> Fallible<Value> {
    let mut echo = match lists.scene.one() {
        Some(one) => of_one(one)?,
        None => of_several(lists)?,
    };
    if !lists.scene.sensors.is_empty() {
        echo["sensors"] = sensors(lists.scene)?;
    }
    Ok(echo)
}

fn of_several(lists: &Lists) -> Fallible<Value> {
    let scene = lists.scene;
    let common = scene.common();
    let mut echo = bearing_echo::head(&common.title, &common.source);
    let mut bearings = Map::new();
    for placed in &scene.bearings {
        let mut own = bearing_echo::scene(&placed.scene)?;
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
            if let Some(housed) = &placed.housing {
                map.insert("housing".into(), housing(&housed.settings)?);
                let solid = placed.housed().map(|housed| solid::echo::scene(&housed.solid));
                map.insert("solid".into(), solid.transpose()?.unwrap_or_default()["solid"].take());
            }
        }
        bearings.insert(name_of(placed).into(), own);
    }
    echo.insert("bearings".into(), Value::Object(bearings));
    let mut bodies = Map::new();
    for (index, body) in scene.bodies.iter().enumerate() {
        let mut own = echo_run::body(body)?;
        if let Some(of) = &body.beam {
            own["beam"] = shaft(of)?;
            let made = &lists.assembly()?.bodies[index];
            let race = made.driven();
            own["inertia"] = race.map(|race| echo_run::inertia(&race.inertia)).transpose()?.into();
            own["centre_of_mass"] = quantity("place", 1e3 * made.rest[0], "mm")?;
        }
        bodies.insert(body.name.clone(), own);
    }
    echo.insert("bodies".into(), Value::Object(bodies));
    let springs = scene.springs.iter().map(|s| Ok((s.name.clone(), spring(scene, s)?)));
    echo.insert("springs".into(), Value::Object(springs.collect::<Result<_, ResultsError>>()?));
    Ok(Value::Object(echo))
}

/// A flexible shaft; positions are from the centre of its body.
fn shaft(of: &SceneBeam) -> Result<Value, ResultsError> {
    let millimetres = |name: &str, metres: f64| quantity(name, 1e3 * metres, "mm");
    let place = |at: f64| millimetres("at", at);
    let segment = |of: &BeamSegment| -> Result<Value, ResultsError> {
        Ok(json!({
            "length": millimetres("length", of.length)?,
            "outer_diameter": millimetres("outer_diameter", of.outer_diameter)?,
            "inner_diameter": millimetres("inner_diameter", of.inner_diameter)?,
            "youngs_modulus": quantity("youngs_modulus", 1e-9 * of.youngs_modulus, "GPa")?,
            "density": quantity("density", of.density, "kg/m^3")?,
        }))
    };
    let disc = |disc: &BeamDisc| -> Result<Value, ResultsError> {
        Ok(json!({
            "at": place(of.start + disc.at)?,
            "mass": quantity("mass", disc.mass, "kg")?,
            "axial": quantity("axial", disc.axial, "kg m^2")?,
            "transverse": quantity("transverse", disc.transverse, "kg m^2")?,
        }))
    };
    let unbalance = |&(at, size, angle): &(f64, f64, f64)| -> Result<Value, ResultsError> {
        Ok(json!({
            "at": place(at)?,
            "size": quantity("size", size, "kg m")?,
            "angle": quantity("angle", angle.to_degrees(), "deg")?,
        }))
    };
    let list = |all: Vec<Result<Value, ResultsError>>| -> Result<Value, ResultsError> {
        Ok(Value::Array(all.into_iter().collect::<Result<_, _>>()?))
    };
    Ok(json!({
        "start": millimetres("start", of.start)?,
        "segments": list(of.beam.segments.iter().map(segment).collect())?,
        "discs": list(of.beam.discs.iter().map(disc).collect())?,
        "loads": list(of.loads.iter().map(|(at, _)| place(*at)).collect())?,
        "unbalances": list(of.unbalances.iter().map(unbalance).collect())?,
        "damping": quantity("damping", of.damping, "1/s")?,
        "internal_damping": quantity("internal_damping", of.internal_damping, "1/s")?,
    }))
}

fn spring(scene: &AssemblyScene, spring: &Spring) -> Result<Value, ResultsError> {
    let end = |end: SpringEnd| -> Result<Value, ResultsError> {
        let body = match end.at {
            SpringAt::Body(index) => scene.bodies[index].name.clone(),
            other => scene.name_of_end(other),
        };
        Ok(json!({ "body": body, "at": quantity("place", 1e3 * end.along, "mm")? }))
    };
    let six = |values: &[f64; 6], units: [&str; 2]| -> Result<Value, ResultsError> {
        let entry = |(i, name): (usize, &&str)| {
            Ok((name.to_string(), quantity(name, values[i], units[usize::from(i > 2)])?))
        };
        Ok(Value::Object(SIX.iter().enumerate().map(entry).collect::<Result<_, ResultsError>>()?))
    };
    let mut echo = json!({
        "from": end(spring.ends[0])?,
        "to": end(spring.ends[1])?,
        "stiffness": six(&spring.stiffness, ["N/m", "N m/rad"])?,
        "damping": six(&spring.damping, ["N s/m", "N m s/rad"])?,
    });
    if spring.cross != CrossCoupling::default() {
        for (table, values, unit) in [
            ("stiffness", spring.cross.stiffness, "N/m"),
            ("damping", spring.cross.damping, "N s/m"),
        ] {
            for (name, value) in ["yz", "zy"].into_iter().zip(values) {
                echo[table][name] = quantity(name, value, unit)?;
            }
        }
    }
    let element = |of: &MaxwellElement| -> Result<Value, ResultsError> {
        let relaxation_time = quantity("relaxation_time", of.relaxation_time, "s")?;
        let stiffness = six(&of.stiffness, ["N/m", "N m/rad"])?;
        Ok(json!({ "relaxation_time": relaxation_time, "stiffness": stiffness }))
    };
    if !spring.maxwell.is_empty() {
        let elements = spring.maxwell.iter().map(element);
        echo["maxwell"] = Value::Array(elements.collect::<Result<_, ResultsError>>()?);
    }
    if let Some(of) = &spring.bushing {
        echo["bushing"] = bushing(of)?;
    }
    Ok(echo)
}

/// Bushing that a spring represents, and the largest errors of the fit.
fn bushing(of: &BushingOfSpring) -> Result<Value, ResultsError> {
    let BushingOfSpring { body, mesh, material, table, fastest, misses, elements } = of;
    let millimetres = |name: &str, metres: f64| quantity(name, 1e3 * metres, "mm");
    let mut echo = json!({
        "inner_diameter": millimetres("inner_diameter", body.inner_diameter)?,
        "outer_diameter": millimetres("outer_diameter", body.inner_diameter + 2.0 * body.thickness)?,
        "length": millimetres("length", body.length)?,
        "material": solid::echo::rubber(material, *table)?,
        "fastest": quantity("fastest", *fastest, "Hz")?,
        "cells": { "around": mesh.around, "radial": mesh.radial, "axial": mesh.axial },
    });
    if let Some(BushingInElements { density, stepping, coupling_phase }) = elements {
        echo["coupling_phase"] = json!(coupling_phase);
        echo["density"] = quantity("density", *density, "kg/m^3")?;
        let (method, key, value) = match stepping {
            BushingStepping::Explicit { fraction } => {
                ("explicit", "step_fraction", json!(fraction))
            }
            BushingStepping::Implicit { step: Some(step) } => {
                ("implicit", "step", quantity("step", *step, "s")?)
            }
            BushingStepping::Implicit { step: None } => {
                ("implicit", "step", json!("as the coupling steps"))
            }
        };
        (echo["method"], echo[key]) = (json!(method), value);
    }
    for (motion, miss) in SleeveMotion::ALL.into_iter().zip(misses) {
        let name = format!("{motion:?}").to_lowercase();
        echo["largest_error_of_springs"][name] = quantity("error", 100.0 * miss, "%")?;
    }
    Ok(echo)
}

fn sensors(scene: &AssemblyScene) -> Result<Value, ResultsError> {
    let mut all = Map::new();
    for SceneSensor { name, kind, acquisition } in &scene.sensors {
        let mut echo = match kind {
            SceneSensorKind::Accelerometer { at, along, radius, angle, direction } => json!({
                "kind": "accelerometer",
                "on": scene.name_of_place(*at),
                "at": quantity("place", 1e3 * along, "mm")?,
                "radius": quantity("radius", 1e3 * radius, "mm")?,
                "angle": quantity("angle", angle.to_degrees(), "deg")?,
                "direction": direction.name(),
            }),
            SceneSensorKind::Telemeter { circuit, distance, offset, runout, .. } => json!({
                "kind": "telemeter",
                "distance": quantity("distance", 1e3 * distance, "mm")?,
                "offset": quantity("offset", 1e3 * offset[0], "mm")?,
                "offset_angle": quantity("angle", offset[1].to_degrees(), "deg")?,
                "runout": quantity("runout", 1e3 * runout[0], "mm")?,
                "runout_angle": quantity("angle", runout[1].to_degrees(), "deg")?,
                "loop_radius": quantity("radius", 1e3 * circuit.radius, "mm")?,
                "transceiver_radius": quantity("radius", 1e3 * circuit.transceiver_radius, "mm")?,
                "wire_radius": quantity("radius", 1e3 * circuit.wire_radius, "mm")?,
                "capacitance": quantity("capacitance", 1e12 * circuit.capacitance, "pF")?,
                "resistance": quantity("resistance", circuit.resistance[0], "ohm")?,
                "transceiver_resistance": quantity("resistance", circuit.resistance[1], "ohm")?,
                "natural_frequency": quantity("frequency", circuit.natural_frequency(), "Hz")?,
                "frequency": quantity("frequency", circuit.frequency, "Hz")?,
            }),
        };
        if let SceneSensorKind::Telemeter { bearing, .. } = kind
            && let Some(of) = &scene.bearings[*bearing].name
        {
            echo["bearing"] = json!(of);
        }
        if let SceneSensorKind::Accelerometer { direction, .. } = kind
            && let Direction::Fixed { azimuth, elevation } = direction
        {
            echo["azimuth"] = quantity("angle", azimuth.to_degrees(), "deg")?;
            echo["elevation"] = quantity("angle", elevation.to_degrees(), "deg")?;
        }
        for (key, value) in [("sampling", acquisition.sampling), ("low_pass", acquisition.low_pass)]
        {
            if let Some(value) = value {
                echo[key] = quantity(key, value, "Hz")?;
            }
        }
        if let Some(band) = acquisition.envelope_band {
            let [low, high] = band.map(|frequency| quantity("envelope_band", frequency, "Hz"));
            echo["envelope_band"] = json!([low?, high?]);
        }
        all.insert(name.clone(), echo);
    }
    Ok(Value::Object(all))
}

/// A single bearing and its housing; with a housing also motion and numerics of a run.
fn of_one(one: &PlacedBearing) -> Fallible<Value> {
    let mut echo = bearing_echo::scene(&one.scene)?;
    let Some(PlacedHousing { settings, solid }) = &one.housing else { return Ok(echo) };
    echo["housing"] = housing(settings)?;
    echo["solid"] = solid::echo::scene(solid)?["solid"].take();
    if let Some(run) = &one.scene.dynamics.run {
        echo["motion"] = echo_run::motion(&dynamic_problem(&one.scene)?)?;
        echo["numerics"] = numerics(run, Some(settings))?;
    }
    Ok(echo)
}

/// Numerical settings of a run; for a quasi-static sequence only those without time steps.
pub fn numerics(
    run: &RunSettings,
    housing: Option<&HousingSettings>,
) -> Result<Value, ResultsError> {
    let mut echo = match housing.map(|housing| housing.method) {
        Some(HousingMethod::QuasiStatic) => json!({
            "end": quantity("end", run.end, "s")?,
            "output_interval": quantity("output_interval", run.output_interval, "s")?,
        }),
        _ => echo_run::numerics(run)?,
    };
    if let Some(interval) = run.fields_interval {
        echo["fields_interval"] = quantity("fields_interval", interval, "s")?;
    }
    Ok(echo)
}

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

fn housing(housing: &HousingSettings) -> Result<Value, ResultsError> {
    let mut echo = Map::new();
    echo.insert("method".into(), json!(method(housing.method)));
    echo.insert("bore".into(), json!(housing.bore));
    match housing.fit {
        FitSize::Interference(fit) => {
            let fit = json!({
                "radial": quantity("fit", 1e6 * fit, "um")?,
                "diametral": quantity("fit", 2e6 * fit, "um")?,
            });
            echo.insert("fit".into(), fit);
        }
        FitSize::OuterRadius(radius) => {
            echo.insert("outer_radius".into(), quantity("outer radius", 1e3 * radius, "mm")?);
        }
    }
    for (name, value, unit) in [("fit_ramp", housing.fit_ramp, "s"), ("width", housing.width, "m")]
    {
        if let Some(value) = value {
            echo.insert(name.into(), quantity(name, value, unit)?);
        }
    }
    let axial = if housing.axial == Axial::Fixed { "fixed" } else { "free" };
    echo.insert("axial".into(), json!(axial));
    let stiffness = match housing.penalty {
        Penalty::PerArea(stiffness) => quantity("stiffness", stiffness, "N/m^3")?,
        Penalty::PerNode(stiffness) => quantity("stiffness", stiffness, "N/m")?,
    };
    echo.insert("contact".into(), json!({ "stiffness": stiffness }));
    if let Some(BoreFriction { coefficient, stretch }) = housing.friction {
        let friction = json!({
            "coefficient": quantity("coefficient", coefficient, "1")?,
            "stretch": quantity("stretch", stretch, "m")?,
        });
        echo.insert("friction".into(), friction);
    }
    if housing.method == HousingMethod::Explicit {
        for (name, value) in
            [("step_fraction", housing.step_fraction), ("coupling_phase", housing.coupling_phase)]
        {
            echo.insert(name.into(), quantity(name, value, "1")?);
        }
    }
    if let Some(modes_to) = housing.modes_to {
        echo.insert("modes_to".into(), quantity("modes_to", modes_to, "Hz")?);
    }
    if let Some(bore_load) = housing.bore_load {
        echo.insert("bore_load".into(), quantity("bore_load", bore_load, "N")?);
    }
    Ok(Value::Object(echo))
}
