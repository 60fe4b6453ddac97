//! `bearing plan` of a scene of bearings: stages of its solution method, and the cost of another method for the housings.

use super::housing::Housing;
use super::lists::Lists;
use super::shapes::{Shapes, shapes};
use super::windows::windows_text;
use super::{Fallible, housings, still};
use crate::commands::plan::print_plan;
use crate::commands::plan_step::{note, refused, step_line};
use crate::commands::run::{self, planned_request};
use crate::commands::{CommandResult, Outcome, memory, warnings};
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::equilibrium::lists::{Place, StaticAssembly};
use bearing_dynamics::equilibrium::plan as statics;
use bearing_dynamics::equilibrium::plan::ASKED_FOR;
use bearing_dynamics::equilibrium::statics::StaticProblem;
use bearing_dynamics::members::body::Rotation;
use bearing_dynamics::motion::coupling::SolidPart;
use bearing_dynamics::motion::integrator_choice::Choice;
use bearing_dynamics::motion::plan as motion;
use bearing_dynamics::motion::plan::Planned;
use bearing_dynamics::motion::plan_solids::{stepped_cage, stepped_shaft};
use bearing_dynamics::motion::simulation::Start;
use bearing_dynamics::numeric::clock::{rounded, to_digits, whole_number};
use bearing_dynamics::output::fields::size::{fields_size, file_bytes};
use bearing_dynamics::output::session::{RunRequest, table_size};
use bearing_dynamics::plan::{Item, Stage, Subject};
use bearing_dynamics::scene::build::assembly::{AssemblyScene, PlacedBearing};
use bearing_dynamics::scene::build::bushing::{BushingElements, take_bushings};
use bearing_dynamics::scene::build::cage::BuiltCage;
use bearing_dynamics::scene::build::shaft::{ShaftElements, take_shafts};
use bearing_dynamics::scene::build::statics::static_problem;
use bearing_dynamics::scene::resolve::housing_scene::HousingMethod;
use bearing_dynamics::scene::{CageInRun, Document, RunSettings};
use bearing_dynamics::solids::condensation::Sizes;
use bearing_dynamics::solids::plan::Method;
use bearing_dynamics::solids::rubber::plan as rubber;

pub fn run(document: &Document, scene: &AssemblyScene) -> CommandResult {
    let housings = housings::prepare(document, scene)?;
    let lists = &Lists::of(scene);
    let method = scene.housing_method();
    match (method, scene.run()) {
        (Some(HousingMethod::QuasiStatic), Some(_)) => housings::refuse_steps(document)?,
        (Some(HousingMethod::QuasiStatic), None) => {}
        _ => housings::refuse(document, scene, &housings)?,
    }
    let reduced = match method {
        Some(HousingMethod::Reduced) => Some(shapes(lists, &housings)?),
        _ => None,
    };
    let (items, mut notes) = match (scene.run(), method) {
        (None, _) => {
            scene.check_statics()?;
            (of_statics(lists, &housings)?, Vec::new())
        }
        (Some(settings), Some(HousingMethod::QuasiStatic)) => {
            let fields = fields_line(settings, &of_housings(&housings));
            (of_sequence(lists, &housings, settings)?, fields.into_iter().collect())
        }
        (Some(settings), _) => of_steps(lists, &housings, reduced.as_ref(), settings)?,
    };
    notes.extend(warnings::of_bushings(scene).iter().map(ToString::to_string));
    for housing in &housings {
        notes.extend(housing.notes().iter().map(|text| note("housing mesh", text)));
    }
    if let Some(shapes) = &reduced {
        notes.extend(shapes.notes(scene, &housings));
    }
    let undeformed = housings.iter().any(|housing| !housing.scene.housing.from_equilibrium);
    if method == Some(HousingMethod::Explicit) && undeformed {
        notes.push(note("start of the housing", UNDEFORMED));
    }
    if !housings.is_empty() {
        notes.extend(condensing_notes(lists, &housings));
    }
    // `of_steps` reports the steps of scenes with bushings or shafts in elements.
    let in_elements = scene.has_parts_in_elements();
    let has_step_note = housings.is_empty() || in_elements;
    if let (Some(settings), false) = (scene.run(), has_step_note) {
        notes.push(explicit_note(lists, &housings, settings));
    }
    if scene.common().rigid_housing {
        let text = "housing.method = rigid: the outer race is fixed, no mesh is read";
        notes.push(note("housing", text));
    }
    print_plan(&items, &notes)?;
    Ok(Outcome::Done)
}

/// Start of explicit steps that do not start in equilibrium.
const UNDEFORMED: &str =
    "undeformed, the outer race in its initial position: initial loads cause oscillations";

/// Items of a run in time steps, and notes on its steps and the size of its table.
fn of_steps(
    lists: &Lists,
    housings: &[Housing],
    reduced: Option<&Shapes>,
    settings: &RunSettings,
) -> Fallible<(Vec<Item>, Vec<String>)> {
    let scene = lists.scene;
    let mut assembly = match reduced {
        Some(shapes) => shapes.assembly.clone(),
        None => lists.assembly()?.clone(),
    };
    let cages = scene.add_cage_nodes(&mut assembly)?;
    let bushings = take_bushings(scene, &mut assembly)?;
    let shafts = take_shafts(scene, &mut assembly)?;
    let elements = (&bushings[..], &shafts[..], &cages[..]);
    let in_elements = scene.has_parts_in_elements();
    // Races without their housings or bushings would have no support.
    let alone = !in_elements && (housings.is_empty() || reduced.is_some());
    let (request, choice) = if in_elements {
        (run::request(scene.common(), settings), None)
    } else {
        planned_request(scene, settings, &assembly)
    };
    let items = stages(scene, (housings, elements), &assembly, &request, choice.as_ref());
    let mut notes = Vec::new();
    if alone {
        notes.push(step_line(&assembly, &request));
    }
    if in_elements {
        let parts = housings::explicit(scene, assembly.clone(), housings, elements, 1)?;
        notes.push(note("step", &windows_text(scene, parts, settings)?));
    }
    for shaft in &shafts {
        notes.extend(imbalance_text(scene, shaft).map(|text| note("shaft", &text)));
    }
    notes.push(size_line(&assembly, &request));
    let of_shafts = shafts.iter().map(|shaft| file_bytes(&shaft.mesh, false));
    let of_cages = cages.iter().filter(|cage| cage.part().is_some());
    let of_cages = of_cages.map(|cage| file_bytes(&cage.mesh, false));
    let solids: Vec<f64> =
        of_housings(housings).into_iter().chain(of_shafts).chain(of_cages).collect();
    notes.extend(fields_line(settings, &solids));
    Ok((items, notes))
}

/// Size of one fields file of each housing, bytes.
pub fn of_housings(housings: &[Housing]) -> Vec<f64> {
    housings.iter().map(|housing| file_bytes(&housing.built.mesh, true)).collect()
}

fn fields_line(run: &RunSettings, solids: &[f64]) -> Option<String> {
    let size = fields_size(run.end, run.output_interval, run.fields_interval, solids);
    size.interval.filter(|_| !solids.is_empty()).map(|_| note("fields", &size.to_string()))
}

/// Unbalance that counts as rounding error, as a part of mass times length of a shaft (couples: length squared).
const ROUNDING: f64 = 1e-12;

/// Unbalance of the mesh of a shaft; `None` if it is balanced.
fn imbalance_text(scene: &AssemblyScene, shaft: &ShaftElements) -> Option<String> {
    let length = scene.bodies[shaft.body].beam.as_ref()?.beam.length();
    let mass: f64 = shaft.part.model.mass.iter().sum();
    let [balance, couple] = shaft.imbalance().map(|[y, z]| y.hypot(z));
    let is = |size: f64, of: f64| size > ROUNDING * of;
    let balance =
        is(balance, mass * length).then(|| format!("{} g mm", to_digits(1e6 * balance, 2)));
    let couple = is(couple, mass * length * length)
        .then(|| format!("a couple of {} g mm^2", to_digits(1e9 * couple, 2)));
    let all: Vec<String> = [balance, couple].into_iter().flatten().collect();
    (!all.is_empty()).then(|| {
        format!(
            "the mesh of {} is not axisymmetric: it has an unbalance of {}, which turns with the shaft",
            shaft.name,
            all.join(" and ")
        )
    })
}

pub type Elements<'e> = (&'e [BushingElements], &'e [ShaftElements], &'e [BuiltCage]);

pub fn stages(
    scene: &AssemblyScene,
    (housings, (bushings, shafts, cages)): (&[Housing], Elements),
    assembly: &Assembly,
    request: &RunRequest,
    choice: Option<&Choice>,
) -> Vec<Item> {
    let left_out = |placed: &PlacedBearing| match &placed.scene.dynamics.cage {
        CageInRun::Body(_) => None,
        CageInRun::LeftOut(reason) => Some(reason.clone()),
    };
    let left_out: Vec<Option<String>> = scene.bearings.iter().map(left_out).collect();
    let left_out: Vec<Option<&str>> = left_out.iter().map(Option::as_deref).collect();
    let mut options = request.options;
    let stepped: Vec<(usize, &SolidPart)> =
        cages.iter().filter_map(|cage| Some((cage.bearing, cage.part()?))).collect();
    if !(housings.is_empty() && bushings.is_empty() && shafts.is_empty() && stepped.is_empty()) {
        // Balls start in equilibrium with races fixed in their housings.
        options.start = Start::Equilibrium;
    }
    let is_explicit = scene.housing_method() == Some(HousingMethod::Explicit);
    let method = if is_explicit { Method::Explicit } else { Method::Reduced };
    let mut solids = Vec::new();
    for (index, housing) in housings.iter().enumerate() {
        solids.extend(housing.items(index, &method));
        if is_explicit {
            let body = assembly.bearings[housing.bearing].mounts[1].body;
            let seat = (body, housing.name.as_deref());
            let friction = housing.scene.housing.friction.as_ref();
            solids.extend(motion::stepped_seat(assembly, index, seat, friction));
        }
    }
    for (index, shaft) in shafts.iter().enumerate() {
        let of = (&shaft.name[..], &shaft.part);
        solids.extend(stepped_shaft(assembly, housings.len() + index, of, &shaft.mesh_text()));
    }
    for (index, (bearing, part)) in stepped.iter().enumerate() {
        let index = housings.len() + shafts.len() + index;
        solids.extend(stepped_cage(assembly, &assembly.bearings[*bearing], index, part));
    }
    for (index, bushing) in bushings.iter().enumerate() {
        let index = housings.len() + shafts.len() + stepped.len() + index;
        solids.extend(rubber::bonded(&bushing.planned(index)));
    }
    let mut items = motion::items(Planned {
        assembly,
        options: &options,
        channels: &request.channels,
        cage_left_out: &left_out,
        solids,
    });
    for shaft in shafts {
        let of_body = |item: &&mut Item| item.subject == Subject::Body(shaft.body);
        for item in items.iter_mut().filter(of_body).filter(|item| item.stage == Stage::Motion) {
            item.why =
                "moves by its elements and what is mounted on them; it is not a rigid body".into();
        }
    }
    if let Some(choice) = choice {
        let text = format!("{}: {}", choice.integrator.name(), choice.reason);
        items.push(Item::does(Stage::IntegratorChoice, Subject::Whole, text));
    }
    items
}

pub fn of_statics(lists: &Lists, housings: &[Housing]) -> Fallible<Vec<Item>> {
    Ok(of_equilibrium(&still(lists)?, housings, ASKED_FOR))
}

fn of_equilibrium(still: &StaticAssembly, housings: &[Housing], centrifugal: &str) -> Vec<Item> {
    let mut solids = Vec::new();
    for (index, housing) in housings.iter().enumerate() {
        solids.extend(housing.items(index, &Method::QuasiStatic));
        let body = still.bearings[housing.bearing].mounts[1].body;
        let seat = statics::seat(index, &still.bodies[body].name);
        solids.push(seat.named(housing.name.clone()));
    }
    statics::items(still, solids, centrifugal)
}

pub fn of_sequence(lists: &Lists, housings: &[Housing], run: &RunSettings) -> Fallible<Vec<Item>> {
    const CAGE_ROTATES: &str =
        "in `run`, because the cage rotates; `statics` omits it, it is not requested";
    let mut still = still(lists)?;
    for (bearing, placed) in still.bearings.iter_mut().zip(&lists.scene.bearings) {
        let turning = &placed.scene.dynamics.inner.rotation;
        let turns = matches!(turning, Rotation::Speed(speed) if !speed.is_zero());
        // Non-zero if the bearing turns, whatever its speed.
        bearing.centrifugal = f64::from(u8::from(turns));
    }
    let mut items = of_equilibrium(&still, housings, CAGE_ROTATES);
    let count = whole_number(run.end, run.output_interval) + 1;
    let last = rounded((count - 1) as f64 * run.output_interval);
    let why = format!("{count} equilibria to t = {last} s, one a row");
    items.push(Item::does(Stage::Equilibria, Subject::Whole, why));
    Ok(items)
}

/// Static problem of a single bearing under its loads at t = 0.
pub fn of_one(one: &PlacedBearing, still: &StaticAssembly) -> Fallible<StaticProblem> {
    let problem = static_problem(&one.scene)?;
    Ok(match &still.bodies[0].place {
        Place::Loaded(inner) => StaticProblem { conditions: inner.conditions, ..problem },
        Place::Fixed(_) | Place::Section(_) => problem,
    })
}

fn size_line(assembly: &Assembly, request: &RunRequest) -> String {
    let text = match table_size(assembly.clone(), request) {
        Ok(size) => size.to_string(),
        Err(error) => refused(&error),
    };
    note("table", &text)
}

/// Sizes and memory of condensing. Nothing is factorised here.
fn condensing_notes(lists: &Lists, housings: &[Housing]) -> Vec<String> {
    let chosen = lists.scene.housing_method() == Some(HousingMethod::QuasiStatic);
    let name = if chosen { "quasi-static" } else { "quasi-static instead" };
    let mut planned = Vec::new();
    for housing in housings {
        let of = housing.before();
        let condensing = housing.constant().and_then(|()| housing.condensing());
        let (sizes, needed) = match condensing {
            Ok((_, sizes, needed)) => (sizes, needed),
            Err(error) => return vec![note(name, &format!("not possible: {error}"))],
        };
        planned.push(note("condensed bore", &format!("{of}{}", condensed_text(&sizes))));
        planned.push(note("memory of condensing", &format!("{of}{}", memory::text(&needed))));
    }
    planned
}

fn condensed_text(sizes: &Sizes) -> String {
    format!(
        "{} unknowns onto {} of {} bore nodes; left out are {} not under the race and {} too far \
         from it",
        sizes.unknowns, sizes.kept, sizes.bore, sizes.beside, sizes.outside_range
    )
}

fn explicit_note(lists: &Lists, housings: &[Housing], run: &RunSettings) -> String {
    let chosen = lists.scene.housing_method() == Some(HousingMethod::Explicit);
    // The start does not matter here, and finding an equilibrium takes long.
    let parts = housings::undeformed(lists, housings, 1);
    match (parts.and_then(|parts| windows_text(lists.scene, parts, run)), chosen) {
        (Ok(text), true) => note("step", &text),
        (Ok(text), false) => note("explicit instead", &text),
        (Err(error), true) => note("step", &refused(&*error)),
        (Err(error), false) => note("explicit instead", &format!("not possible: {error}")),
    }
}
