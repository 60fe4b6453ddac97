//! From the given keys to a solid: defaults, and checks between keys.

use crate::mesh::{Order, Surface};
use crate::numeric::profile::Profile;
use crate::scene::build::assembly::AssemblyScene;
use crate::scene::build::symmetry;
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::assembly::{assembly, is_assembly};
use crate::scene::resolve::bearing::{Reader, resolve, text};
use crate::scene::resolve::housing::in_housing;
use crate::scene::resolve::rubber;
use crate::scene::resolve::rubber::{check_order, is_rubber, refuse_rubber};
use crate::scene::resolve::sensor::{add_sensors, refuse_sensors};
use crate::scene::resolve::solid_mesh::source;
use crate::scene::resolve::solid_scene::{
    Held, LoadKind, MeshPlace, MeshRequest, MeshSource, Probe, ProbeOf, RunSteps, SetLoad,
    SetPlace, SetRequest, SolidRun, SolidScene, Subject,
};
use crate::scene::text::document::Document;
use crate::scene::text::items::ItemRef;
use crate::scene::text::units::plain;
use crate::scene::text::value::Checked;
use crate::solids::explicit::{ExplicitMethod, SolidStepping};
use crate::solids::model::DampedMotion;
use crate::solids::tangent::MassMatrix;

const AXES: [&str; 3] = ["x", "y", "z"];
/// Default step of an explicit method over its limit, which falls as a body stiffens.
const STEP_FRACTION: f64 = 0.8;

/// A scene of bearings, with or without bodies and housings, or of a solid.
///
/// # Errors
///
/// The first key, in a fixed order, that is missing or contradicts others; a bearing and a solid without `[housing]`.
pub fn resolve_subject(document: &Document) -> Result<Subject, SceneError> {
    if let Some(mut scene) = of_bearings(document)? {
        add_sensors(document, &mut scene)?;
        return Ok(Subject::Assembly(Box::new(scene)));
    }
    Ok(Subject::Solid(Box::new(of_solid(document)?)))
}

/// A scene of bearings; `None` for one of a solid.
fn of_bearings(document: &Document) -> Result<Option<AssemblyScene>, SceneError> {
    if is_assembly(document) {
        return Ok(Some(assembly(document)?));
    }
    document.refuse_names()?;
    if document.first_below("housing").is_some() {
        let (bearing, housing) = in_housing(document)?;
        return Ok(Some(AssemblyScene::of_one(bearing, housing)));
    }
    Ok(match document.first_below("solid") {
        None => Some(AssemblyScene::alone(resolve(document)?)),
        Some(_) => None,
    })
}

/// A solid alone.
fn of_solid(document: &Document) -> Result<SolidScene, SceneError> {
    const OF_A_BEARING: [&str; 7] = [
        "bearing",
        "inner_race",
        "outer_race",
        "ball_forces",
        "traction",
        "contact_damping",
        "ball_contact",
    ];
    if let Some(other) = OF_A_BEARING.iter().find_map(|part| document.first_below(part)) {
        let reason = "a bearing and a solid in one scene are coupled by a [housing] table";
        let solid = document.first_below("solid").unwrap_or("solid");
        let advice = format!("add it, or leave out `{other}`, or `{solid}` and its tables");
        return Err(document.refused(other, reason, advice));
    }
    refuse_sensors(document)?;
    solid_scene(document)
}

/// Refuses a solid, and its keys, in a scene of a bearing.
pub(crate) fn refuse_solid(document: &Document) -> Result<(), SceneError> {
    const OF_A_SOLID: [&str; 4] = ["housing", "solid", "modes", "numerics.method"];
    let Some(key) = OF_A_SOLID.iter().find_map(|part| document.first_below(part)) else {
        return Ok(());
    };
    let (reason, advice) = if key.starts_with("housing") {
        let commands = "`check`, `plan`, `statics`, `sweep` and `run` take a bearing in a housing";
        ("this takes a bearing alone, and the scene has a housing", commands.to_string())
    } else if key.starts_with("solid") {
        let commands = "`check`, `plan`, `statics`, `modes` and `run` take a solid by itself";
        ("this takes a bearing, and the scene has a solid", commands.to_string())
    } else {
        ("only a solid has it, and the scene has none", "leave it out".to_string())
    };
    Err(document.refused(key, reason, advice))
}

/// Refuses fields in a scene without elements.
pub(crate) fn refuse_fields(document: &Document) -> Result<(), SceneError> {
    let key = "numerics.fields_interval";
    if document.value(key).is_none() {
        return Ok(());
    }
    let reason = "only solids and shafts in elements have fields, and the scene has none";
    Err(document.refused(key, reason, "leave it out"))
}

fn solid_scene(document: &Document) -> Result<SolidScene, SceneError> {
    refuse_bearing_keys(document)?;
    let mut reader = Reader::new(document);
    let mut scene = body(&mut reader)?;
    if !is_rubber(document) {
        scene.mode_count = reader.number("modes.count").unwrap_or(12.0) as usize;
        scene.mode_mass = match reader.choice("modes.mass") {
            Some("lumped") => MassMatrix::Lumped,
            _ => MassMatrix::Consistent,
        };
    }
    scene.run = run(&mut reader)?;
    let plots = match document.value("output.plots") {
        Some(Checked::Choices(names)) => names.clone(),
        _ => {
            reader.note("output.plots", "series, spectrum", "usual plots");
            vec!["series", "spectrum"]
        }
    };
    scene.draw_series = plots.contains(&"series");
    scene.draw_spectrum = plots.contains(&"spectrum");
    scene.defaults_used = reader.into_defaults_used();
    Ok(scene)
}

/// The solid of a bearing's housing.
pub(crate) fn housing_solid(document: &Document) -> Result<SolidScene, SceneError> {
    const OF_A_FREE_SOLID: [&str; 6] = [
        "solid.velocity",
        "solid.spin",
        "solid.damped_motion",
        "solid.probe",
        "modes",
        "numerics.method",
    ];
    if let Some(key) = OF_A_FREE_SOLID.iter().find_map(|part| document.first_below(part)) {
        let reason = "a housing does not use it";
        let advice = match key.starts_with("solid.probe") {
            true => {
                "leave it out: the displacement of every node of the housing is in the fields (fields.pvd, \
                  for ParaView), that of the outer race in series.csv"
            }
            false => "leave it out",
        };
        return Err(document.refused(key, reason, advice));
    }
    refuse_rubber(document)?;
    let mut reader = Reader::new(document);
    let mut scene = body(&mut reader)?;
    scene.defaults_used = reader.into_defaults_used();
    scene.defaults_used.retain(|used| !OF_A_FREE_SOLID.contains(&used.key.as_str()));
    Ok(scene)
}

/// A solid alone or as a housing, without modes, run and plots.
fn body(reader: &mut Reader) -> Result<SolidScene, SceneError> {
    let document = reader.document;
    let mesh = mesh_request(reader)?;
    let (law, density) = rubber::material(reader)?;
    // Keys without effect on rubber are not read.
    let rubber = is_rubber(document);
    let mut number = |path: &str| if rubber { 0.0 } else { reader.number(path).unwrap_or(0.0) };
    let (damping, spin) = (number("solid.damping"), number("solid.spin"));
    let damped_motion = match document.value("solid.damped_motion") {
        Some(Checked::Choice("relative-to-rigid")) => DampedMotion::RelativeToRigid,
        given => {
            if given.is_none() && !rubber {
                reader.note_default("solid.damped_motion");
            }
            DampedMotion::Absolute
        }
    };
    let gravity = vector(reader, "solid.gravity");
    let velocity = if rubber { [0.0; 3] } else { vector(reader, "solid.velocity") };
    let held: Vec<Held> = document.items("solid.fixed").map(held).collect::<Result<_, _>>()?;
    if mesh.is_quarter() {
        symmetry::check(document, &held)?;
    }
    let loads: Vec<SetLoad> = document.items("solid.load").map(load).collect::<Result<_, _>>()?;
    let probes: Vec<Probe> = document.items("solid.probe").map(probe).collect::<Result<_, _>>()?;
    Ok(SolidScene {
        title: text(document, "title"),
        source: text(document, "source"),
        assumptions: document.assumptions().to_vec(),
        mesh,
        law,
        density,
        damping,
        damped_motion,
        gravity,
        velocity,
        spin,
        held,
        loads,
        probes,
        mode_count: 0,
        mode_mass: MassMatrix::Consistent,
        run: None,
        draw_series: false,
        draw_spectrum: false,
        defaults_used: Vec::new(),
    })
}

/// Refuses keys of runs, plots and sweeps without effect on a solid.
fn refuse_bearing_keys(document: &Document) -> Result<(), SceneError> {
    const SHARED: [&str; 12] = [
        "base",
        "without",
        "title",
        "source",
        "numerics.end",
        "numerics.step",
        "numerics.step_fraction",
        "numerics.output_interval",
        "numerics.energy_limit",
        "output.plots",
        "sweep.of",
        "sweep.together",
    ];
    const OWN: [&str; 4] = ["solid.", "modes.", "numerics.method", "numerics.fields_interval"];
    let reason = "a solid does not use it";
    for key in document.given_keys() {
        let own = OWN.iter().any(|own| key.path.starts_with(own))
            || (is_rubber(document) && key.path == "numerics.accuracy");
        if !own && !SHARED.contains(&key.path) {
            return Err(document.refused(key.path, reason, "leave it out"));
        }
    }
    if let Some(Checked::Choices(names)) = document.value("output.plots")
        && !names.iter().all(|name| ["series", "spectrum"].contains(name))
    {
        let advice = "a solid has `series` and `spectrum`";
        let reason = "one of these plots is a bearing's";
        return Err(document.refused("output.plots", reason, advice));
    }
    if !document.sweep().is_empty() && !document.sweeps_runs() {
        let advice = "leave out [sweep], or sweep its runs (of = \"runs\")";
        return Err(document.refused("sweep", reason, advice));
    }
    Ok(())
}

/// A given vector, else zero, the default of every vector here.
fn vector(reader: &mut Reader, path: &str) -> [f64; 3] {
    match reader.document.value(path) {
        Some(Checked::Vector(vector)) => *vector,
        _ => {
            reader.note_default(path);
            [0.0; 3]
        }
    }
}

fn mesh_request(reader: &mut Reader) -> Result<MeshRequest, SceneError> {
    let document = reader.document;
    let source = source(reader)?;
    let order = reader.given_number("solid.mesh.order").map(|order| match order as u8 {
        1 => Order::Linear,
        _ => Order::Quadratic,
    });
    check_order(document, &source, order)?;
    let renumber = match document.value("solid.mesh.renumber") {
        Some(Checked::Boolean(given)) => *given,
        _ => {
            reader.note_default("solid.mesh.renumber");
            true
        }
    };
    let from_file = matches!(source, MeshSource::File { .. });
    let cavities = if from_file { reader.number("solid.mesh.cavities") } else { None };
    let cavities = cavities.unwrap_or(0.0) as usize;
    let repairs = match document.value("solid.mesh.repair") {
        Some(Checked::Choices(names)) => names.clone(),
        _ => Vec::new(),
    };
    let axis = match reader.choice_if_given("solid.mesh.axis") {
        Some("y") => 1,
        Some("z") => 2,
        _ => 0,
    };
    let origin = match document.value("solid.mesh.origin") {
        Some(Checked::Vector(origin)) => *origin,
        _ => [0.0; 3],
    };
    let place = MeshPlace { origin, axis, at: 0.0 };
    Ok(MeshRequest {
        source,
        place,
        order,
        renumber,
        orient: repairs.contains(&"orient"),
        merge_duplicates: repairs.contains(&"merge-duplicates"),
        drop_unreferenced: repairs.contains(&"drop-unreferenced"),
        cavities,
        largest_aspect: reader.number("solid.mesh.largest_aspect").unwrap_or(1e3),
        sets: document.items("solid.set").map(set).collect::<Result<_, _>>()?,
        used_sets: used_sets(document),
    })
}

fn used_sets(document: &Document) -> Vec<String> {
    let tables = ["solid.fixed", "solid.load", "solid.probe"];
    let of_tables = tables.into_iter().flat_map(|table| document.items(table));
    let of_tables = of_tables.map(|item| item.value("set"));
    let names = of_tables.chain([document.value("solid.harmonic.set")]).flatten();
    let text = |value: &Checked| match value {
        Checked::Text(name) => Some(name.clone()),
        _ => None,
    };
    names.filter_map(text).collect()
}

fn set(item: ItemRef) -> Result<SetRequest, SceneError> {
    let name = item_text(item, "name", "name = \"tip\"")?;
    let given = |key: &str| item.value(key).is_some();
    let ways = ["plane", "cylinder", "low"];
    let chosen: Vec<&str> = ways.into_iter().filter(|way| given(way)).collect();
    let way = match chosen[..] {
        [way] => way,
        [] => {
            let because = ", the position of the set is missing".to_string();
            let example = "`plane = \"x\"` with `at`, `cylinder`, or `low` and `high`".to_string();
            return Err(item.error("plane", Problem::Missing { because, example }));
        }
        [first, second, ..] => return Err(exclusive(item, second, first)),
    };
    for (key, owner) in [("at", "plane"), ("high", "low")] {
        if given(key) && way != owner {
            let problem = Problem::refused(
                "it belongs to another kind of set",
                format!("leave it out, or give `{owner}`"),
            );
            return Err(item.error(key, problem));
        }
    }
    let place = match (way, item.value(way)) {
        ("plane", Some(Checked::Choice(axis))) => {
            let at = item_number(item, "at")
                .ok_or_else(|| missing(item, "at", " with `plane`", "at = \"0 mm\""))?;
            let axis = AXES.iter().position(|name| name == axis).unwrap_or(0);
            SetPlace::Surface(Surface::plane(axis, at))
        }
        ("cylinder", Some(Checked::Number(radius))) => SetPlace::Surface(Surface::about_x(*radius)),
        (_, Some(Checked::Vector(low))) => match item.value("high") {
            Some(Checked::Vector(high)) => SetPlace::Box { low: *low, high: *high },
            _ => {
                let example = "high = [\"1 mm\", \"1 mm\", \"1 mm\"]";
                return Err(missing(item, "high", " with `low`", example));
            }
        },
        _ => return Err(missing(item, way, "", way)),
    };
    Ok(SetRequest { name, place, tolerance: item_number(item, "tolerance") })
}

pub(crate) fn missing(item: ItemRef, name: &str, because: &str, example: &str) -> SceneError {
    let (because, example) = (because.to_string(), format!("`{example}`"));
    item.error(name, Problem::Missing { because, example })
}

fn exclusive(item: ItemRef, later: &str, earlier: &str) -> SceneError {
    let advice = format!("keep `{earlier}` or `{later}`");
    item.error(later, Problem::Exclusive { rival: earlier.to_string(), advice })
}

pub(crate) fn item_text(item: ItemRef, name: &str, example: &str) -> Result<String, SceneError> {
    match item.value(name) {
        Some(Checked::Text(text)) => Ok(text.clone()),
        _ => Err(missing(item, name, "", example)),
    }
}

pub(crate) fn item_number(item: ItemRef, name: &str) -> Option<f64> {
    match item.value(name)? {
        Checked::Number(value) => Some(*value),
        _ => None,
    }
}

pub(crate) fn item_profile(item: ItemRef, name: &str) -> Option<Profile> {
    match item.value(name)? {
        Checked::Number(value) => Some(Profile::Constant(*value)),
        Checked::Boolean(true) => Some(Profile::ZERO),
        Checked::Profile(profile) => Some(profile.clone()),
        _ => None,
    }
}

fn held(item: ItemRef) -> Result<Held, SceneError> {
    let set = item_text(item, "set", "set = \"x_low\"")?;
    let motion = AXES.map(|axis| item_profile(item, axis));
    if motion.iter().all(Option::is_none) {
        return Err(missing(item, "x", ", nothing is fixed", "x = true"));
    }
    Ok(Held { set, motion })
}

fn load(item: ItemRef) -> Result<SetLoad, SceneError> {
    let set = item_text(item, "set", "set = \"x_high\"")?;
    let axes = AXES.map(|axis| item_profile(item, axis));
    let along = AXES.into_iter().find(|axis| item.value(axis).is_some());
    let force = match item.value("force") {
        Some(Checked::Vector(force)) => Some(*force),
        _ => None,
    };
    let pressure = item_profile(item, "pressure");
    let kind = match (along, force, pressure) {
        (Some(_), None, None) => LoadKind::Force(axes),
        (None, Some(force), None) => {
            LoadKind::Force(force.map(|f| (f != 0.0).then_some(Profile::Constant(f))))
        }
        (None, None, Some(pressure)) => LoadKind::Pressure(pressure),
        (None, None, None) => return Err(missing(item, "z", ", no load", "z = \"-100 N\"")),
        (Some(along), Some(_), _) => return Err(exclusive(item, "force", along)),
        (Some(along), None, Some(_)) => return Err(exclusive(item, "pressure", along)),
        (None, Some(_), Some(_)) => return Err(exclusive(item, "pressure", "force")),
    };
    Ok(SetLoad { set, kind })
}

fn probe(item: ItemRef) -> Result<Probe, SceneError> {
    let of = match (item.value("set"), item.value("at")) {
        (Some(_), Some(_)) => return Err(exclusive(item, "at", "set")),
        (Some(Checked::Text(set)), None) => ProbeOf::Set(set.clone()),
        (None, Some(Checked::Vector(place))) => ProbeOf::Place(*place),
        _ => {
            return Err(missing(
                item,
                "set",
                ", the position of the probe is missing",
                "set = \"x_high\"",
            ));
        }
    };
    let name = match (item.value("name"), &of) {
        (Some(Checked::Text(name)), _) => name.clone(),
        (_, ProbeOf::Set(set)) => set.clone(),
        _ => return Err(missing(item, "name", " with `at`", "name = \"tip\"")),
    };
    Ok(Probe { name, of })
}

fn run(reader: &mut Reader) -> Result<Option<SolidRun>, SceneError> {
    let Some(end) = reader.given_number("numerics.end") else { return Ok(None) };
    let rubber = is_rubber(reader.document);
    let steps = if rubber { rubber::steps(reader) } else { explicit(reader) };
    let mut interval = |key: &str, parts: f64, reason: &str| -> Result<f64, SceneError> {
        let Some(value) = reader.given_number(key) else {
            let value = end / parts;
            reader.note(key, &format!("{} s", plain(value)), reason);
            return Ok(value);
        };
        if value <= end {
            return Ok(value);
        }
        let (relation, other_name, other) = ("after", "the end of the run", end);
        let (allowed, advice) = ("up to", "check the units of both");
        let problem = Problem::WrongTime { value, relation, other_name, other, allowed, advice };
        Err(reader.document.error(key, problem))
    };
    let (rows, reason) = if rubber {
        (100.0, "a hundredth of the run")
    } else {
        (1000.0, "a thousandth of the run")
    };
    let output_interval = interval("numerics.output_interval", rows, reason)?;
    let fields_interval = interval("numerics.fields_interval", 20.0, "a twentieth of the run")?;
    Ok(Some(SolidRun { steps, end, output_interval, fields_interval }))
}

fn explicit(reader: &mut Reader) -> RunSteps {
    let method = match reader.choice("numerics.method") {
        Some("runge-kutta") => ExplicitMethod::RungeKutta,
        _ => ExplicitMethod::CentralDifferences,
    };
    let fraction = reader.given_number("numerics.step_fraction");
    let stepping = match (reader.given_number("numerics.step"), fraction) {
        (Some(step), _) => SolidStepping::Fixed(step),
        (None, Some(fraction)) => SolidStepping::FractionOfLimit(fraction),
        (None, None) => {
            let reason = "a fraction of the largest stable step of a solid";
            reader.note("numerics.step_fraction", &plain(STEP_FRACTION), reason);
            SolidStepping::FractionOfLimit(STEP_FRACTION)
        }
    };
    let energy_limit = reader.given_number("numerics.energy_limit").unwrap_or_else(|| {
        reader.note("numerics.energy_limit", "0.01", "1 % of the energy turned over");
        0.01
    });
    RunSteps::Explicit { method, stepping, energy_limit }
}
