//! Stages of a plan as text.

use bearing_dynamics::solver::plan;
use bearing_dynamics::solver::statics::StaticProblem;

/// The plan of a bearing's statics, one line a stage.
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
