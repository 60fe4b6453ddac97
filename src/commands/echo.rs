//! The resolved scene as JSON with units, its Hertz constants and kinematic frequencies.

use bearing_dynamics::ch2_housing::bearing::geometry::{
    BearingKind, ClearanceThrough, Material, Raceway,
};
use bearing_dynamics::ch2_housing::bearing::hertz::{HertzContact, HertzModel};
use bearing_dynamics::equilibrium::statics::{COORDINATE_NAMES, StaticProblem};
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::output::results::{ResultsError, quantity};
use bearing_dynamics::scene::build::statics::kinematic_ratios;
use bearing_dynamics::scene::resolve::resolved::RaceDimensions;
use bearing_dynamics::scene::{Cage, Scene};
use serde_json::{Map, Value, json};

type Echo = Result<Value, ResultsError>;

pub fn head(title: &Option<String>, source: &Option<String>) -> Map<String, Value> {
    let given = [("title", title), ("source", source)].into_iter();
    given.filter_map(|(name, text)| Some((name.into(), json!(text.as_ref()?)))).collect()
}

pub fn scene(scene: &Scene) -> Echo {
    let mut echo = head(&scene.title, &scene.source);
    echo.insert("bearing".into(), bearing(scene)?);
    echo.insert("inner_race".into(), conditions(scene)?);
    let mut outer = Map::new();
    for (i, name) in COORDINATE_NAMES.iter().enumerate() {
        outer.insert((*name).into(), coordinate(name, scene.outer_race[i], i)?);
    }
    echo.insert("outer_race".into(), Value::Object(outer));
    let gravity: Result<Vec<_>, _> =
        scene.gravity.iter().map(|g| quantity("gravity", *g, "m/s^2")).collect();
    echo.insert(
        "ball_forces".into(),
        json!({ "gravity": gravity?, "centrifugal": scene.centrifugal }),
    );
    Ok(Value::Object(echo))
}

fn bearing(scene: &Scene) -> Echo {
    let (geometry, sizes) = (&scene.geometry, &scene.dimensions);
    let mut echo = json!({
        "kind": match geometry.kind {
            BearingKind::DeepGroove => "deep-groove",
            BearingKind::AngularContact => "angular-contact",
        },
        "balls": geometry.ball_count,
        "ball_phase": quantity("ball_phase", scene.ball_phase.to_degrees(), "deg")?,
        "hertz": match scene.hertz {
            HertzModel::HamrockBrewe => "hamrock-brewe",
            HertzModel::Exact => "exact",
        },
        "clearance": {
            "radial": length(sizes.radial_clearance)?,
            "diametral": length(sizes.diametral_clearance)?,
            "through": through(sizes.clearance_through),
        },
        "pitch_radius": length(geometry.pitch_radius)?,
        "contact_angle":
            quantity("contact_angle", geometry.contact_angle.to_degrees(), "deg")?,
        "ball": {
            "radius": length(geometry.ball_radius)?,
            "nominal_radius": length(sizes.nominal_ball_radius)?,
            "material": material(&scene.ball_material)?,
        },
        "inner_race": race(&sizes.inner_race, &geometry.inner, &scene.inner_material)?,
        "outer_race": race(&sizes.outer_race, &geometry.outer, &scene.outer_material)?,
    });
    for (part, name, value) in [
        ("inner_race", "bore_radius", sizes.bore_radius),
        ("outer_race", "outer_radius", sizes.outer_radius),
    ] {
        if let Some(value) = value {
            echo[part][name] = length(value)?;
        }
    }
    if let Some(value) = sizes.length {
        echo["length"] = length(value)?;
    }
    if let Some(rating) = scene.dynamic_rating {
        echo["rating"]["dynamic"] = quantity("dynamic", rating, "N")?;
    }
    if let Some(given) = &scene.cage {
        echo["cage"] = cage(given)?;
    }
    Ok(echo)
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

fn material(material: &Material) -> Echo {
    Ok(json!({
        "youngs_modulus": quantity("youngs_modulus", material.youngs_modulus / 1e9, "GPa")?,
        "poisson_ratio": quantity("poisson_ratio", material.poisson_ratio, "1")?,
        "density": quantity("density", material.density, "kg/m^3")?,
    }))
}

fn race(sizes: &RaceDimensions, raceway: &Raceway, steel: &Material) -> Echo {
    Ok(json!({
        "radius": length(sizes.radius)?,
        "groove_radius": length(sizes.groove_radius)?,
        "conformity": quantity("conformity", sizes.conformity, "1")?,
        "osculation": quantity("osculation", sizes.osculation, "1")?,
        "groove_centre_radius": length(raceway.centre_radius)?,
        "groove_centre_axial": length(raceway.centre_axial)?,
        "material": material(steel)?,
    }))
}

fn cage(cage: &Cage) -> Echo {
    let mut echo = Map::new();
    for (name, value) in [
        ("pocket_radius", cage.pocket_radius),
        ("inner_radius", cage.inner_radius),
        ("outer_radius", cage.outer_radius),
        ("race_clearance", cage.race_clearance),
    ] {
        if let Some(value) = value {
            echo.insert(name.into(), length(value)?);
        }
    }
    if let Some(mass) = cage.mass {
        echo.insert("mass".into(), quantity("mass", mass, "kg")?);
    }
    if let Some(guidance) = cage.guidance {
        echo.insert("guidance".into(), json!(guidance.name()));
    }
    Ok(Value::Object(echo))
}

/// A coordinate of the race, in um or deg.
fn coordinate(name: &str, value: f64, index: usize) -> Echo {
    if index < 3 {
        quantity(name, value * 1e6, "um")
    } else {
        quantity(name, value.to_degrees(), "deg")
    }
}

fn conditions(scene: &Scene) -> Echo {
    let mut echo = Map::new();
    for (i, condition) in scene.conditions.iter().enumerate() {
        let name = COORDINATE_NAMES[i];
        let entry = match (condition, i < 3) {
            (Condition::Load(load), true) => json!({ "load": quantity(name, *load, "N")? }),
            (Condition::Load(load), false) => json!({ "moment": quantity(name, *load, "N m")? }),
            (Condition::Displacement(value), true) => {
                json!({ "displacement": coordinate(name, *value, i)? })
            }
            (Condition::Displacement(value), false) => {
                json!({ "tilt": coordinate(name, *value, i)? })
            }
        };
        echo.insert(name.into(), entry);
    }
    if let Some(speed) = scene.inner_speed {
        echo.insert("speed".into(), quantity("speed", speed * 30.0 / std::f64::consts::PI, "rpm")?);
    }
    Ok(Value::Object(echo))
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
