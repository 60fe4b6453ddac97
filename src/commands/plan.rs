//! `bearing plan SCENE`.

use super::assembly::housings;
use super::housed::plan::windows_text;
use super::plan_step::{note, refused, step_lines};
use super::remarks::of_springs;
use super::run::{ONE_AFTER_THE_OTHER, planned_request};
use super::solve::{lines, plan_lines};
use super::{CommandResult, Outcome, say};
use bearing_dynamics::output::session::{RunRequest, table_size};
use bearing_dynamics::scene::assembly::{AssemblyScene, PlacedBearing};
use bearing_dynamics::scene::housing::HousingMethod;
use bearing_dynamics::scene::{
    CageInRun, Document, Subject, resolve_subject, statics::static_problem,
};
use bearing_dynamics::solver::dynamics::assembly::Assembly;
use bearing_dynamics::solver::dynamics::foretell::Choice;
use bearing_dynamics::solver::plan;
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
    let prepared = housings::prepare(&document, &scene)?;
    let mut planned = match (scene.run(), scene.only()) {
        (Some(_), _) if scene.housing_method() == Some(HousingMethod::QuasiStatic) => {
            let mut lines = super::assembly::plan_lines(&scene)?;
            let said = format!("WARNING: the run will be refused: {ONE_AFTER_THE_OTHER}");
            lines.push(format!("notes {:<28} {said}", "run"));
            lines
        }
        (Some(settings), _) => {
            let assembly = match scene.housing_method() {
                Some(HousingMethod::Reduced) => housings::reduced(&scene, &prepared)?.assembly,
                _ => scene.assembly()?,
            };
            let (request, choice) = planned_request(&scene, settings, &assembly, None);
            let mut lines = dynamic_plan_lines(&scene, &assembly, &request, choice.as_ref());
            if scene.housing_method() == Some(HousingMethod::Explicit) {
                // Races without their housings would have nothing to hold them.
                let windows = housings::explicit(&scene, &prepared, 1)
                    .and_then(|parts| windows_text(parts, settings));
                let said = windows.unwrap_or_else(|error| refused(&*error));
                lines.push(note("step", &said));
            } else {
                lines.extend(step_lines(&assembly, &request));
            }
            lines.push(size_line(&assembly, &request));
            lines.retain(|line| prepared.is_empty() || !line.contains("flexible bodies"));
            lines.extend(
                prepared.iter().map(|housing| format!("does{}", &housing.text().trim_end()[1..])),
            );
            lines
        }
        (None, Some(alone)) => plan_lines(&static_problem(alone)?),
        (None, None) => super::assembly::plan_lines(&scene)?,
    };
    planned.extend(of_springs(&scene).iter().map(|said| note("spring", said)));
    if scene.common().rigid_housing {
        let reason = "housing.method = rigid: the outer race is fixed, no mesh is read";
        planned.push(format!("skips {:<28} {reason}", "housing"));
    }
    say(&planned.iter().map(|line| format!("{line}\n")).collect::<String>())?;
    Ok(Outcome::Done)
}

/// How much the run is going to write.
fn size_line(assembly: &Assembly, request: &RunRequest) -> String {
    let said = match table_size(assembly.clone(), request) {
        Ok(size) => size.to_string(),
        Err(error) => format!("WARNING: the run will be refused: {error}"),
    };
    format!("notes {:<28} {said}", "table")
}

/// The plan of a run as text, one line a stage.
pub fn dynamic_plan_lines(
    scene: &AssemblyScene,
    assembly: &Assembly,
    request: &RunRequest,
    choice: Option<&Choice>,
) -> Vec<String> {
    let left_out = |placed: &PlacedBearing| match &placed.scene.dynamics.cage {
        CageInRun::Body(_) => None,
        CageInRun::LeftOut(reason) => Some(reason.clone()),
    };
    let left_out: Vec<Option<String>> = scene.bearings.iter().map(left_out).collect();
    let left_out: Vec<Option<&str>> = left_out.iter().map(Option::as_deref).collect();
    let mut all = lines(plan::dynamics(assembly, &request.options, &request.channels, &left_out));
    if let Some(choice) = choice {
        let said = format!("{}: {}", choice.integrator.name(), choice.reason());
        all.push(format!("does  {:<28} {said}", "choice of the integrator"));
    }
    all
}
