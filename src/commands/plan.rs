//! `bearing plan SCENE`.

use super::run::request;
use super::solve::{lines, plan_lines};
use super::{CommandResult, Outcome, say};
use bearing_dynamics::output::dynamics::session::RunRequest;
use bearing_dynamics::scene::dynamics::{dynamic_problem, run_options};
use bearing_dynamics::scene::{self, CageInRun, Scene, Subject, statics::static_problem};
use bearing_dynamics::solver::dynamics::model::DynamicProblem;
use bearing_dynamics::solver::dynamics::run::{RunOptions, Simulation, SimulationError, Stepping};
use bearing_dynamics::solver::dynamics::step_watch::TOLERATED;
use bearing_dynamics::solver::plan;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file (.toml or .json); with a [numerics] table the plan is that of a run
    scene: PathBuf,
}

pub fn run(arguments: &Arguments) -> CommandResult {
    let scene = match scene::read_subject(&arguments.scene)? {
        Subject::Solid(solid) => return super::solid::plan::run(&solid),
        Subject::Bearing(scene) => *scene,
    };
    let planned = match run_options(&scene) {
        Ok(settings) => {
            let problem = dynamic_problem(&scene)?;
            let mut lines = dynamic_plan_lines(&scene, &problem, &request(&scene, &settings));
            lines.extend(step_against_limit(&problem, &settings.options));
            lines
        }
        Err(_) => plan_lines(&static_problem(&scene)?),
    };
    say(&planned.iter().map(|line| format!("{line}\n")).collect::<String>())?;
    Ok(Outcome::Done)
}

/// A given step beside the largest stable one at the start, with a warning where it is longer.
fn step_against_limit(problem: &DynamicProblem, options: &RunOptions) -> Option<String> {
    let Stepping::Fixed(step) = options.stepping else { return None };
    let limited = RunOptions { stepping: Stepping::FractionOfLimit(1.0), ..*options };
    let said = match Simulation::new(problem.clone(), limited).map(|simulation| simulation.limit) {
        Ok(Some(limit)) => {
            let ratio = step / limit.step;
            let verdict = match ratio {
                r if r > TOLERATED => "WARNING: too long, the run will be refused",
                r if r > 1.0 => "WARNING: longer than stable",
                _ => "stable at the start",
            };
            format!(
                "{step:.3e} s is {ratio:.3} of the largest stable one at the start, {:.3e} s ({}): \
                 {verdict}",
                limit.step,
                limit.reason()
            )
        }
        Ok(None) | Err(SimulationError::NoStep) => "no contact is stiff at the start".into(),
        Err(error) => format!("WARNING: the run will be refused: {error}"),
    };
    Some(format!("notes {:<28} {said}", "given step"))
}

/// The plan of a run as text, one line a stage.
pub fn dynamic_plan_lines(
    scene: &Scene,
    problem: &DynamicProblem,
    request: &RunRequest,
) -> Vec<String> {
    let cage_left_out = match &scene.dynamics.cage {
        CageInRun::Body(_) => None,
        CageInRun::LeftOut(reason) => Some(reason.as_str()),
    };
    lines(plan::dynamics(problem, &request.options, &request.channels, cage_left_out))
}
