//! `bearing plan SCENE`.

use super::assembly::housings;
use super::housed::plan::windows_text;
use super::plan_step::{note, refused, step_lines};
use super::remarks::of_springs;
use super::run::{ONE_AFTER_THE_OTHER, planned_request};
use super::solve::statics_items;
use super::{CommandResult, Outcome, say};
use bearing_dynamics::output::session::{RunRequest, table_size};
use bearing_dynamics::scene::assembly::{AssemblyScene, PlacedBearing};
use bearing_dynamics::scene::housing::HousingMethod;
use bearing_dynamics::scene::{
    CageInRun, Document, RunSettings, Subject, resolve_subject, statics::static_problem,
};
use bearing_dynamics::solver::dynamics::assembly::Assembly;
use bearing_dynamics::solver::dynamics::foretell::Choice;
use bearing_dynamics::solver::dynamics::run::Start;
use bearing_dynamics::solver::plan::motion::{self, Planned};
use bearing_dynamics::solver::plan::{Item, Stage, Subject as PlanSubject};
use std::error::Error;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json); with a [numerics] table the plan is that of a run
    scene: PathBuf,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let document = Document::read_file(&arguments.scene)?;
    let scene = match resolve_subject(&document)? {
        Subject::Solid(solid) => return super::solid::plan::run(&document, &solid),
        Subject::Housed(housed) => return super::housed::plan::run(&document, &housed),
        Subject::Bearing(scene) => AssemblyScene::alone(*scene),
        Subject::Assembly(scene) => *scene,
    };
    let (items, notes) = match (scene.run(), scene.only()) {
        (Some(_), _) if scene.housing_method() == Some(HousingMethod::QuasiStatic) => {
            let said = format!("WARNING: the run will be refused: {ONE_AFTER_THE_OTHER}");
            let housings = housings::prepare(&document, &scene)?;
            (super::assembly::statics_items(&scene, &housings)?, vec![note("run", &said)])
        }
        (Some(settings), _) => of_run(&document, &scene, settings)?,
        (None, Some(alone)) => (statics_items(&static_problem(alone)?), Vec::new()),
        (None, None) => {
            let housings = housings::prepare(&document, &scene)?;
            (super::assembly::statics_items(&scene, &housings)?, Vec::new())
        }
    };
    let springs = of_springs(&scene);
    let notes = notes.into_iter().chain(springs.iter().map(|said| note("spring", said)));
    let items = items.into_iter().chain(rigid_housing(&scene));
    say_plan(&items.collect::<Vec<_>>(), &notes.collect::<Vec<_>>())?;
    Ok(Outcome::Done)
}

/// Says items, a line each, and then notes.
pub fn say_plan(items: &[Item], notes: &[String]) -> Result<(), Box<dyn Error>> {
    items.iter().try_for_each(|item| say(&format!("{item}\n")))?;
    notes.iter().try_for_each(|line| say(&format!("{line}\n")))
}

/// A housing that the scene asks to leave out.
fn rigid_housing(scene: &AssemblyScene) -> Option<Item> {
    let why = "housing.method = rigid: the outer race is fixed, no mesh is read";
    scene.common().rigid_housing.then(|| Item::skips(Stage::Housing, PlanSubject::Whole, why))
}

/// Items of a run, and what there is to note of its steps and its table.
fn of_run(
    document: &Document,
    scene: &AssemblyScene,
    settings: &RunSettings,
) -> Result<(Vec<Item>, Vec<String>), Box<dyn Error>> {
    let prepared = housings::prepare(document, scene)?;
    let assembly = match scene.housing_method() {
        Some(HousingMethod::Reduced) => housings::reduced(scene, &prepared)?.assembly,
        _ => scene.assembly()?,
    };
    let (request, choice) = planned_request(scene, settings, &assembly, None);
    let solids = housings::items(scene, &prepared, &assembly);
    let items = dynamic_items(scene, &assembly, &request, choice.as_ref(), solids);
    let mut notes = if scene.housing_method() == Some(HousingMethod::Explicit) {
        // Races without their housings would have nothing to hold them.
        let windows =
            housings::explicit(scene, &prepared, 1).and_then(|parts| windows_text(parts, settings));
        vec![note("step", &windows.unwrap_or_else(|error| refused(&*error)))]
    } else {
        step_lines(&assembly, &request)
    };
    notes.push(size_line(&assembly, &request));
    Ok((items, notes))
}

/// How much the run is going to write.
fn size_line(assembly: &Assembly, request: &RunRequest) -> String {
    let said = match table_size(assembly.clone(), request) {
        Ok(size) => size.to_string(),
        Err(error) => format!("WARNING: the run will be refused: {error}"),
    };
    note("table", &said)
}

/// Items of a run; `solids` are those of flexible solids.
pub fn dynamic_items(
    scene: &AssemblyScene,
    assembly: &Assembly,
    request: &RunRequest,
    choice: Option<&Choice>,
    solids: Vec<Item>,
) -> Vec<Item> {
    let left_out = |placed: &PlacedBearing| match &placed.scene.dynamics.cage {
        CageInRun::Body(_) => None,
        CageInRun::LeftOut(reason) => Some(reason.clone()),
    };
    let left_out: Vec<Option<String>> = scene.bearings.iter().map(left_out).collect();
    let left_out: Vec<Option<&str>> = left_out.iter().map(Option::as_deref).collect();
    let mut options = request.options;
    if scene.housing_method() == Some(HousingMethod::Explicit) {
        // Bearings roll in equilibrium with races that are held where they sit in their housings.
        options.start = Start::Equilibrium;
    }
    let mut items = motion::items(Planned {
        assembly,
        options: &options,
        channels: &request.channels,
        cage_left_out: &left_out,
        solids,
    });
    if let Some(choice) = choice {
        let said = format!("{}: {}", choice.integrator.name(), choice.reason());
        items.push(Item::does(Stage::IntegratorChoice, PlanSubject::Whole, said));
    }
    items
}
