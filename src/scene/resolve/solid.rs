//! From the given keys to a solid: defaults, and checks between keys.

use crate::mesh::{Order, Surface};
use crate::numeric::profile::Profile;
use crate::scene::build::assembly::AssemblyScene;
use crate::scene::build::symmetry;
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::assembly::{assembly, is_assembly};
use crate::scene::resolve::bearing::{Reader, resolve, text};
use crate::scene::resolve::dynamics::within;
use crate::scene::resolve::housing::in_housing;
use crate::scene::resolve::rubber;
use crate::scene::resolve::rubber::{check_order, is_rubber, refuse_rubber};
use crate::scene::resolve::sensor::{add_sensors, refuse_sensors};
use crate::scene::resolve::solid_mesh::source;
use crate::scene::resolve::solid_scene::{
    Held, LoadKind, MeshPlace, MeshRequest, MeshSource, Probe, ProbeOf, RunSteps, SetLoad,
    SetPlace, SetRequest, SolidRun, SolidScene, Subject,
};
use crate::scene::resolve::unused::refuse_unused;
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
        let reason = format!(
            "a bearing and a solid in one scene are coupled by a [housing] table. Hint: add it, or leave out `{other}`, or \
             `solid` and its tables"
        );
        return Err(document.refused(other, reason));
    }
    refuse_sensors(document)?;
    solid_scene(document)
}

/// Refuses a solid, and its keys, in a scene of a bearing.
pub(crate) fn refuse_solid(document: &Document) -> Result<(), SceneError> {
    const NO_SOLID: &str = "only a solid has it, and the scene has none";
    document.refuse_given(&[
        ("housing", "this takes a bearing alone, and the scene has a housing. Hint: `check`, `plan`, `statics`, `sweep` and `run` take a bearing in a housing"),
        ("solid", "this takes a bearing, and the scene has a solid. Hint: `check`, `plan`, `statics`, `modes` and `run` take a solid by itself"),
        ("modes", NO_SOLID),
        ("numerics.method", NO_SOLID),
    ])
}

/// Refuses fields in a scene without elements.
pub(crate) fn refuse_fields(document: &Document) -> Result<(), SceneError> {
    let key = "numerics.fields_interval";
    if document.value(key).is_none() {
        return Ok(());
    }
    let reason = "only solids and shafts in elements have fields, and the scene has none";
    Err(document.refused(key, reason))
}

fn solid_scene(document: &Document) -> Result<SolidScene, SceneError> {
    refuse_bearing_keys(document)?;
    refuse_unused(document, &["modes", "numerics"])?;
    let mut reader = Reader::new(document);
    let mut scene = body(&mut reader)?;
    if !is_rubber(document) {
        scene.mode_count = reader.number("modes.count") as usize;
        scene.mode_mass = match reader.choice("modes.mass") {
            "lumped" => MassMatrix::Lumped,
            _ => MassMatrix::Consistent,
        };
    }
    scene.run = run(&mut reader)?;
    let plots = match document.value("output.plots") {
        Some(Checked::Choices(names)) => names.clone(),
        _ => {
            let usual = vec!["series", "spectrum"];
            let value = Checked::Choices(usual.clone());
            reader
                .note("output.plots", "series, spectrum", "usual plots")
                .fill("output.plots", value);
            usual
        }
    };
    scene.draw_series = plots.contains(&"series");
    scene.draw_spectrum = plots.contains(&"spectrum");
    scene.defaults_used = reader.into_defaults_used();
    Ok(scene)
}

/// The solid of a bearing's housing.
pub(crate) fn housing_solid(document: &Document) -> Result<SolidScene, SceneError> {
    const OF_A_FREE_SOLID: [&str; 5] =
        ["solid.velocity", "solid.spin", "solid.damped_motion", "modes", "numerics.method"];
    let probe = "a housing does not use it. Hint: leave it out: the displacement of every node of the housing is in the \
                 fields (fields.pvd, for ParaView), that of the outer race in series.csv";
    document.refuse_given(&[("solid.probe", probe)])?;
    document.refuse_given(&OF_A_FREE_SOLID.map(|part| (part, "a housing does not use it")))?;
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
    let mut number = |path: &str| if rubber { 0.0 } else { reader.number(path) };
    let (damping, spin) = (number("solid.damping"), number("solid.spin"));
    let damped_motion = match rubber {
        false if reader.choice("solid.damped_motion") == "relative-to-rigid" => {
            DampedMotion::RelativeToRigid
        }
        _ => DampedMotion::Absolute,
    };
    let gravity = reader.vector("solid.gravity");
    let velocity = if rubber { [0.0; 3] } else { reader.vector("solid.velocity") };
    let held: Vec<Held> = document.items("solid.fixed").map(held).collect::<Result<_, _>>()?;
    if mesh.is_quarter() {
        symmetry::check(document, &held)?;
    }
    let loads: Vec<SetLoad> = document.items("solid.load").map(load).collect::<Result<_, _>>()?;
    let probes: Vec<Probe> = document.items("solid.probe").map(probe).collect::<Result<_, _>>()?;
    Ok(SolidScene {
        title: text(document, "title"),
        source: text(document, "source"),
        assumptions: document.assumptions(),
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
    const SHARED: [&str; 13] = [
        "units",
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
            return Err(document.refused(key.path, reason));
        }
    }
    if let Some(Checked::Choices(names)) = document.value("output.plots")
        && !names.iter().all(|name| ["series", "spectrum"].contains(name))
    {
        let reason = "one of these plots is a bearing's. Hint: a solid has `series` and `spectrum`";
        return Err(document.refused("output.plots", reason));
    }
    if !document.sweep().is_empty() && !document.sweeps_runs() {
        let reason =
            "a solid does not use it. Hint: leave out [sweep], or sweep its runs (of = \"runs\")";
        return Err(document.refused("sweep", reason));
    }
    Ok(())
}

fn mesh_request(reader: &mut Reader) -> Result<MeshRequest, SceneError> {
    let document = reader.document;
    let source = source(reader)?;
    let order = reader.given_number("solid.mesh.order").map(|order| match order as u8 {
        1 => Order::Linear,
        _ => Order::Quadratic,
    });
    check_order(document, &source, order)?;
    let renumber = reader.boolean("solid.mesh.renumber");
    let from_file = matches!(source, MeshSource::File { .. });
    let cavities = if from_file { reader.number("solid.mesh.cavities") as usize } else { 0 };
    let repairs = match document.value("solid.mesh.repair") {
        Some(Checked::Choices(names)) => names.clone(),
        _ => Vec::new(),
    };
    let axis = reader.choice_if_given("solid.mesh.axis");
    let axis = AXES.iter().position(|name| Some(*name) == axis).unwrap_or(0);
    let origin = document.value("solid.mesh.origin").and_then(Checked::vector).unwrap_or_default();
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
        largest_aspect: reader.number("solid.mesh.largest_aspect"),
        sets: document.items("solid.set").map(set).collect::<Result<_, _>>()?,
        used_sets: used_sets(document),
    })
}

fn used_sets(document: &Document) -> Vec<String> {
    let tables = ["solid.fixed", "solid.load", "solid.probe"];
    let of_tables = tables.into_iter().flat_map(|table| document.items(table));
    let of_tables = of_tables.map(|item| item.value("set"));
    let names = of_tables.chain([document.value("solid.harmonic.set")]).flatten();
    names.filter_map(Checked::text).map(str::to_string).collect()
}

fn set(item: ItemRef) -> Result<SetRequest, SceneError> {
    let name = item.text("name")?;
    for (key, owner) in [("at", "plane"), ("high", "low")] {
        if item.is_given(key) && !item.is_given(owner) {
            return Err(item.refused(
                key,
                format!("it belongs to another kind of set. Hint: leave it out, or give `{owner}`"),
            ));
        }
    }
    let vector = |key: &str| item.value(key).and_then(Checked::vector);
    let place = if let Some(axis) = item.value("plane").and_then(Checked::choice) {
        let axis = AXES.iter().position(|name| *name == axis).unwrap_or(0);
        SetPlace::Surface(Surface::plane(axis, item.required("at")?))
    } else if let Some(radius) = item.number("cylinder") {
        SetPlace::Surface(Surface::about_x(radius))
    } else if let Some(low) = vector("low") {
        let high = vector("high").ok_or_else(|| item.missing("high", " with `low`"))?;
        SetPlace::Box { low, high }
    } else {
        let because = ", the position of the set is missing".to_string();
        let example = "`plane = \"x\"` with `at`, `cylinder`, or `low` and `high`".to_string();
        return Err(item.error("plane", Problem::Missing { because, example }));
    };
    Ok(SetRequest { name, place, tolerance: item.number("tolerance") })
}

fn exclusive(item: ItemRef, later: &str, earlier: &str) -> SceneError {
    let advice = format!("keep `{earlier}` or `{later}`");
    item.error(later, Problem::Exclusive { rival: earlier.to_string(), advice })
}

fn held(item: ItemRef) -> Result<Held, SceneError> {
    let (set, motion) = (item.text("set")?, AXES.map(|axis| item.profile(axis)));
    if motion.iter().all(Option::is_none) {
        return Err(item.missing("x", ", nothing is fixed"));
    }
    Ok(Held { set, motion })
}

fn load(item: ItemRef) -> Result<SetLoad, SceneError> {
    let (set, axes) = (item.text("set")?, AXES.map(|axis| item.profile(axis)));
    let given = AXES.into_iter().chain(["force", "pressure"]).filter(|key| item.is_given(key));
    let given: Vec<&str> = given.collect();
    let kind = match (item.value("force").and_then(Checked::vector), item.profile("pressure")) {
        (None, None) if given.is_empty() => return Err(item.missing("z", ", no load")),
        (None, None) => LoadKind::Force(axes),
        _ if given.len() > 1 => return Err(exclusive(item, given[given.len() - 1], given[0])),
        (Some(force), _) => {
            LoadKind::Force(force.map(|f| (f != 0.0).then_some(Profile::Constant(f))))
        }
        (None, Some(pressure)) => LoadKind::Pressure(pressure),
    };
    Ok(SetLoad { set, kind })
}

fn probe(item: ItemRef) -> Result<Probe, SceneError> {
    let (set, at) = (item.text("set"), item.value("at").and_then(Checked::vector));
    let of = match (set, at) {
        (Ok(_), Some(_)) => return Err(exclusive(item, "at", "set")),
        (Ok(set), None) => ProbeOf::Set(set),
        (Err(_), Some(place)) => ProbeOf::Place(place),
        (Err(missing), None) => return Err(missing),
    };
    let name = match (item.text("name"), &of) {
        (Err(_), ProbeOf::Set(set)) => set.clone(),
        (name, _) => name?,
    };
    Ok(Probe { name, of })
}

fn run(reader: &mut Reader) -> Result<Option<SolidRun>, SceneError> {
    let Some(end) = reader.given_number("numerics.end") else { return Ok(None) };
    let rubber = is_rubber(reader.document);
    let steps = if rubber { rubber::steps(reader) } else { explicit(reader) };
    let mut interval = |key: &str, parts: f64, reason: &str| -> Result<f64, SceneError> {
        Ok(within(reader, key, end)?.unwrap_or_else(|| {
            let value = end / parts;
            reader.note(key, &format!("{} s", plain(value)), reason).fill(key, value);
            value
        }))
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
        "runge-kutta" => ExplicitMethod::RungeKutta,
        _ => ExplicitMethod::CentralDifferences,
    };
    let fraction = reader.given_number("numerics.step_fraction");
    let stepping = match (reader.given_number("numerics.step"), fraction) {
        (Some(step), _) => SolidStepping::Fixed(step),
        (None, Some(fraction)) => SolidStepping::FractionOfLimit(fraction),
        (None, None) => {
            let reason = "a fraction of the largest stable step of a solid";
            let key = "numerics.step_fraction";
            SolidStepping::FractionOfLimit(reader.number_or(
                key,
                STEP_FRACTION,
                &plain(STEP_FRACTION),
                reason,
            ))
        }
    };
    let reason = "1 % of the energy turned over";
    let energy_limit = reader.number_or("numerics.energy_limit", 0.01, "0.01", reason);
    RunSteps::Explicit { method, stepping, energy_limit }
}
