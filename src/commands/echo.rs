//! What follows from a scene of bearings, as JSON with units: sizes in use, moments of inertia, Hertz constants and
//! kinematic frequencies; and its defaults.

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::geometry::{ClearanceThrough, Raceway};
use bearing_dynamics::ch2_housing::bearing::hertz::HertzContact;
use bearing_dynamics::equilibrium::statics::StaticProblem;
use bearing_dynamics::motion::simulation::Stepping;
use bearing_dynamics::output::results::{ResultsError, quantity};
use bearing_dynamics::scene::build::statics::{ball_mass, kinematic_ratios};
use bearing_dynamics::scene::resolve::resolved::RaceDimensions;
use bearing_dynamics::scene::{Assumption, DefaultUsed, RunSettings, Scene};
use serde_json::{Map, Value, json};

type Echo = Result<Value, ResultsError>;

/// Sizes of a bearing after the clearance has been applied.
pub fn geometry(scene: &Scene) -> Echo {
    let (geometry, sizes) = (&scene.geometry, &scene.dimensions);
    Ok(json!({
        "radial_clearance": length(sizes.radial_clearance)?,
        "clearance_through": through(sizes.clearance_through),
        "pitch_radius": length(geometry.pitch_radius)?,
        "contact_angle": quantity("contact_angle", geometry.contact_angle.to_degrees(), "deg")?,
        "ball_radius": length(geometry.ball_radius)?,
        "ball_mass": quantity("mass", ball_mass(scene), "kg")?,
        "inner_race": race(&sizes.inner_race, &geometry.inner)?,
        "outer_race": race(&sizes.outer_race, &geometry.outer)?,
    }))
}

/// Name, as in a scene, of the part that is resized to give the clearance.
pub fn through(part: ClearanceThrough) -> &'static str {
    match part {
        ClearanceThrough::Ball => "ball",
        ClearanceThrough::InnerRace => "inner-race",
        ClearanceThrough::OuterRace => "outer-race",
        ClearanceThrough::Races => "races",
    }
}

fn length(value: f64) -> Echo {
    quantity("length", value * 1e3, "mm")
}

fn race(sizes: &RaceDimensions, raceway: &Raceway) -> Echo {
    Ok(json!({
        "radius": length(sizes.radius)?,
        "groove_radius": length(sizes.groove_radius)?,
        "conformity": quantity("conformity", sizes.conformity, "1")?,
        "osculation": quantity("osculation", sizes.osculation, "1")?,
        "groove_centre_radius": length(raceway.centre_radius)?,
        "groove_centre_axial": length(raceway.centre_axial)?,
    }))
}

/// Mass, moments of inertia and initial axial position of the moving bodies.
pub fn inertia(assembly: &Assembly) -> Echo {
    let mut all = Map::new();
    for body in &assembly.bodies {
        let Some(inertia) = body.inertia() else { continue };
        let own = json!({
            "mass": quantity("mass", inertia.mass, "kg")?,
            "axial": quantity("axial", inertia.axial, "kg m^2")?,
            "transverse": quantity("transverse", inertia.transverse, "kg m^2")?,
            "centre": length(body.rest[0])?,
        });
        all.insert(body.name.clone(), own);
    }
    Ok(Value::Object(all))
}

/// Defaults in use; for a run also those of its motion, without those of statics alone.
pub fn defaults(scene: &Scene) -> Vec<DefaultUsed> {
    let mut all = scene.defaults_used.clone();
    if scene.dynamics.run.is_none() {
        return all;
    }
    // In a run the centrifugal force follows from the motion of the balls.
    all.retain(|used| used.key != "ball_forces.centrifugal");
    let outer_moves = scene.dynamics.outer.is_some();
    for used in all.iter_mut().filter(|used| outer_moves && used.key.starts_with("outer_race.")) {
        used.reason = "where the outer race starts, before loads and foundation move it".into();
    }
    all.extend_from_slice(&scene.dynamics.defaults_used);
    all
}

/// Defaults for people.
pub fn reported(defaults: &[DefaultUsed]) -> impl Iterator<Item = &DefaultUsed> {
    defaults.iter().filter(|used| used.is_reported())
}

pub fn notes(assumptions: &[Assumption], defaults: &[DefaultUsed]) -> [(&'static str, Value); 2] {
    let assumption = |a: &Assumption| json!({ "name": a.name, "text": a.text });
    let default =
        |used: &DefaultUsed| json!({ "key": used.key, "value": used.value, "reason": used.reason });
    [
        ("assumptions", assumptions.iter().map(assumption).collect()),
        ("defaults", reported(defaults).map(default).collect()),
    ]
}

/// Integrator and step of a run, also those that the plan chooses.
pub fn numerics(run: &RunSettings) -> Echo {
    let (name, value, unit) = match run.options.stepping {
        Stepping::Fixed(step) => ("step", step, "s"),
        Stepping::FractionOfLimit(part) => ("step_fraction", part, "1"),
        Stepping::Accuracy(accuracy) => ("accuracy", accuracy, "1"),
    };
    let integrator = run.options.integrator.name();
    Ok(json!({ "integrator": integrator, name: quantity(name, value, unit)? }))
}

/// Sections of the summary in addition to the solution: Hertz contacts and kinematic frequencies.
pub fn sections(
    scene: &Scene,
    problem: &StaticProblem,
) -> Result<Vec<(String, Value)>, ResultsError> {
    let contacts = [&problem.inner_contact, &problem.outer_contact];
    Ok(vec![("hertz".into(), hertz(contacts)?), ("frequencies".into(), frequencies(scene)?)])
}

pub fn hertz([inner, outer]: [&HertzContact; 2]) -> Echo {
    let contact = |contact: &HertzContact| -> Echo {
        Ok(json!({
            "stiffness": quantity("stiffness", contact.stiffness, "N/m^1.5")?,
            "ellipticity": quantity("ellipticity", contact.ellipticity, "1")?,
            "radius_rolling": length(contact.radius_rolling)?,
            "radius_transverse": length(contact.radius_transverse)?,
        }))
    };
    Ok(json!({
        "inner_race": contact(inner)?,
        "outer_race": contact(outer)?,
    }))
}

/// [`frequencies`] in one line: in Hz, or per turn of the shaft without a speed.
pub fn frequency_line(scene: &Scene) -> Result<String, ResultsError> {
    const NAMES: [(&str, &str); 5] = [
        ("cage and ball set", "cage"),
        ("BPFO", "ball_pass_outer"),
        ("BPFI", "ball_pass_inner"),
        ("BSF", "ball_spin"),
        ("2 BSF", "twice_ball_spin"),
    ];
    let section = frequencies(scene)?;
    let in_hertz = section["cage"]["frequency"].is_object();
    let key = if in_hertz { "frequency" } else { "over_shaft" };
    let texts = NAMES.map(|(label, name)| {
        let value = section[name][key]["value"].as_f64().unwrap_or(0.0);
        format!("{label} {:.4}", value.abs())
    });
    let unit = if in_hertz { "Hz" } else { "per turn of the shaft" };
    Ok(format!("frequencies of rolling without slip: {} {unit}", texts.join(", ")))
}

/// Kinematic frequencies as ratios to the shaft frequency, and in Hz if a speed is given. If the outer race turns,
/// they follow from the relative speed of the races, and its frequency is added to that of the cage.
pub fn frequencies(scene: &Scene) -> Echo {
    let ratios = kinematic_ratios(scene);
    let inner = scene.inner_speed.map(|speed| speed / std::f64::consts::TAU);
    let outer = scene.outer_speed.map_or(0.0, |speed| speed / std::f64::consts::TAU);
    let mut echo = Map::new();
    for (name, ratio, added) in [
        ("cage", ratios.cage, outer),
        ("ball_pass_outer", ratios.ball_pass_outer, 0.0),
        ("ball_pass_inner", ratios.ball_pass_inner, 0.0),
        ("ball_spin", ratios.ball_spin, 0.0),
        ("twice_ball_spin", 2.0 * ratios.ball_spin, 0.0),
    ] {
        let mut entry = Map::new();
        let turns = inner.unwrap_or(0.0);
        let relative = turns - outer;
        // Passing frequencies have no sign if both races turn.
        let relative = if outer != 0.0 && name != "cage" { relative.abs() } else { relative };
        let frequency = added + ratio * relative;
        let against =
            |shaft: f64| if name == "cage" { frequency / shaft } else { frequency / shaft.abs() };
        // The ratio is to the outer race if the shaft is at rest.
        if outer == 0.0 {
            entry.insert("over_shaft".into(), quantity(name, ratio, "1")?);
        } else if turns != 0.0 {
            entry.insert("over_shaft".into(), quantity(name, against(turns), "1")?);
        } else {
            entry.insert("over_outer_race".into(), quantity(name, against(outer), "1")?);
        }
        if inner.is_some() || outer != 0.0 {
            entry.insert("frequency".into(), quantity(name, frequency, "Hz")?);
        }
        echo.insert(name.into(), Value::Object(entry));
    }
    Ok(Value::Object(echo))
}
