//! From a scene to its static solution and the record of how it was obtained.

use super::{echo, remarks};
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::scene::Scene;
use bearing_dynamics::scene::statics::static_problem;
use bearing_dynamics::solver::plan::Item;
use bearing_dynamics::solver::plan::statics::{self, ASKED_FOR};
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
    let plan = statics_items(&problem);
    let mut record = super::record(echo::scene(scene)?, plan, assumptions, defaults, seconds);
    record.sections = sections;
    record.ran.clone_from(&solution.ran);
    Ok(Solved { problem, solution, remarks, record })
}

/// The plan of statics.
pub fn statics_items(problem: &StaticProblem) -> Vec<Item> {
    statics::items(&problem.assembly(), Vec::new(), ASKED_FOR)
}
