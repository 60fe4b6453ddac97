//! From a scene to its static solution and the record of how it was obtained.

use super::{echo, remarks};
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::scene::Scene;
use bearing_dynamics::scene::statics::static_problem;
use bearing_dynamics::solver::plan;
use bearing_dynamics::solver::statics::{StaticProblem, StaticSolution, solve};
use serde_json::json;
use std::error::Error;
use std::time::Instant;

/// A solved scene and everything its results folder records.
pub struct Solved {
    pub problem: StaticProblem,
    pub solution: StaticSolution,
    pub remarks: Vec<String>,
    pub record: RunRecord,
}

/// Solves a scene; `read_seconds` is the time that reading it took.
pub fn solve_scene(scene: &Scene, read_seconds: f64) -> Result<Solved, Box<dyn Error>> {
    let problem = static_problem(scene)?;
    let start = Instant::now();
    let solution = solve(&problem)?;
    let solve_seconds = start.elapsed().as_secs_f64();
    let mut sections = echo::sections(scene, &problem)?;
    let remarks = remarks::of_statics(scene, &problem, &solution);
    sections.push(("remarks".into(), json!(remarks)));
    let seconds = vec![("read".into(), read_seconds), ("solve".into(), solve_seconds)];
    let (assumptions, defaults) = (&scene.assumptions, &scene.defaults_used);
    let plan = plan_lines(&problem);
    let mut record = super::record(echo::scene(scene)?, plan, assumptions, defaults, seconds);
    record.sections = sections;
    Ok(Solved { problem, solution, remarks, record })
}

/// The plan as text, one line a stage.
pub fn plan_lines(problem: &StaticProblem) -> Vec<String> {
    lines(plan::statics(problem))
}

/// Stages as text, one line each.
pub fn lines(stages: Vec<plan::Stage>) -> Vec<String> {
    stages
        .into_iter()
        .map(|stage| {
            let mark = if stage.included { "does " } else { "skips" };
            format!("{mark} {:<28} {}", stage.name, stage.reason)
        })
        .collect()
}
