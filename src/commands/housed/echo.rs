//! What was understood of a bearing in its housing, as JSON with units.

use crate::commands::{echo, echo_run, solid};
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::output::results::{ResultsError, quantity};
use bearing_dynamics::scene::RunSettings;
use bearing_dynamics::scene::dynamics::dynamic_problem;
use bearing_dynamics::scene::housing::{FitSize, HousedScene, HousingMethod};
use bearing_dynamics::solver::housing::bore_equilibrium::Axial;
use serde_json::{Map, Value, json};
use std::error::Error;

pub fn method(scene: &HousedScene) -> &'static str {
    match scene.housing.method {
        HousingMethod::QuasiStatic => "quasi-static",
        HousingMethod::Explicit => "explicit",
        HousingMethod::Reduced => "reduced",
    }
}

/// The resolved scene, every dimensional value with its unit.
pub fn scene(scene: &HousedScene) -> Result<Value, Box<dyn Error>> {
    let mut echo = echo::scene(&scene.bearing)?;
    echo["housing"] = housing(scene)?;
    echo["solid"] = solid::echo::scene(&scene.solid)?["solid"].take();
    if scene.bearing.dynamics.run.is_some() {
        echo["motion"] = echo_run::motion(&dynamic_problem(&scene.bearing)?)?;
    }
    if let Some(run) = &scene.bearing.dynamics.run {
        echo["numerics"] = numerics(scene, run)?;
    }
    Ok(echo)
}

/// How a run is computed; of a course of equilibria what has a meaning without steps.
fn numerics(scene: &HousedScene, run: &RunSettings) -> Result<Value, ResultsError> {
    let mut echo = match scene.housing.method {
        HousingMethod::Explicit | HousingMethod::Reduced => echo_run::numerics(run)?,
        HousingMethod::QuasiStatic => json!({
            "end": quantity("end", run.end, "s")?,
            "output_interval": quantity("output_interval", run.output_interval, "s")?,
        }),
    };
    if let Some(interval) = scene.housing.fields_interval {
        echo["fields_interval"] = quantity("fields_interval", interval, "s")?;
    }
    Ok(echo)
}

/// What `[housing]` says.
pub fn housing(scene: &HousedScene) -> Result<Value, ResultsError> {
    let housing = &scene.housing;
    let mut echo = Map::new();
    echo.insert("method".into(), json!(method(scene)));
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
    let axial = if housing.axial == Axial::Held { "held" } else { "free" };
    echo.insert("axial".into(), json!(axial));
    let stiffness = match housing.penalty {
        Penalty::PerArea(stiffness) => quantity("stiffness", stiffness, "N/m^3")?,
        Penalty::PerNode(stiffness) => quantity("stiffness", stiffness, "N/m")?,
    };
    echo.insert("contact".into(), json!({ "stiffness": stiffness }));
    if housing.method == HousingMethod::Explicit {
        for (name, value) in
            [("step_fraction", housing.step_fraction), ("window_phase", housing.window_phase)]
        {
            echo.insert(name.into(), quantity(name, value, "1")?);
        }
    }
    if let Some(modes_to) = housing.modes_to {
        echo.insert("modes_to".into(), quantity("modes_to", modes_to, "Hz")?);
    }
    Ok(Value::Object(echo))
}
