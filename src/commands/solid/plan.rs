//! `bearing plan` of a solid: what each of its commands would do.

use super::{Prepared, prepare};
use crate::commands::{CommandResult, Outcome, say};
use bearing_dynamics::mesh::Order;
use bearing_dynamics::scene::SolidScene;
use bearing_dynamics::scene::solid::MeshSource;
use bearing_dynamics::solver::solid::explicit::ExplicitMethod;
use bearing_dynamics::solver::solid::model::DampedMotion;
use bearing_dynamics::solver::solid::tangent::MassMatrix;

pub fn run(scene: &SolidScene) -> CommandResult {
    let prepared = prepare(scene)?;
    say(&lines(scene, &prepared).iter().map(|line| format!("{line}\n")).collect::<String>())?;
    Ok(Outcome::Done)
}

fn line(included: bool, name: &str, reason: &str) -> String {
    let mark = if included { "does " } else { "skips" };
    format!("{mark} {name:<28} {reason}")
}

/// One line a stage.
pub fn lines(scene: &SolidScene, prepared: &Prepared) -> Vec<String> {
    let (problem, mesh) = (&prepared.setup.problem, &prepared.built.mesh);
    let from = match &scene.mesh.source {
        MeshSource::File { name, .. } => format!("from {name}"),
        _ => "generated".to_string(),
    };
    let kind = match mesh.order() {
        Order::Linear => "constant-strain tetrahedra",
        Order::Quadratic => "ten-node tetrahedra",
    };
    let mut lines = vec![
        line(true, "mesh", &format!("{from}: {} {kind}", mesh.elements.len())),
        line(
            !problem.prescribed.is_empty(),
            "supports",
            &match problem.prescribed.len() {
                0 => "nothing is held".to_string(),
                count => format!("{count} components held or moved"),
            },
        ),
        line(
            !problem.loads.is_empty(),
            "loads",
            &match problem.loads.len() {
                0 => "none is given".to_string(),
                1 => "one, dead".to_string(),
                count => format!("{count}, dead"),
            },
        ),
        line(
            problem.gravity != [0.0; 3],
            "gravity",
            if problem.gravity == [0.0; 3] { "none is given" } else { "on every node's mass" },
        ),
        line(
            problem.damping != 0.0,
            "damping",
            match (problem.damping == 0.0, problem.damped_motion) {
                (true, _) => "none is given",
                (_, DampedMotion::Absolute) => "in a run, of all motion",
                (_, DampedMotion::RelativeToRigid) => "in a run, of motion beside the rigid one",
            },
        ),
    ];
    lines.push(match prepared.free.count {
        0 => line(true, "statics", "Newton's method, sparse Cholesky factors"),
        _ => line(false, "statics", &format!("free to move {}", prepared.free.names())),
    });
    let mass = match scene.mode_mass {
        MassMatrix::Consistent => "consistent",
        MassMatrix::Lumped => "lumped",
    };
    let wanted = format!("the lowest {}, {mass} mass", scene.mode_count);
    lines.push(line(true, "modes", &wanted));
    lines.push(match &scene.run {
        None => line(false, "run", "no `numerics.end`"),
        Some(run) => {
            let method = match run.method {
                ExplicitMethod::CentralDifferences => "central differences",
                ExplicitMethod::RungeKutta => "Runge-Kutta of order 4",
            };
            line(true, "run", &format!("{method} to {} s", run.end))
        }
    });
    lines
}
