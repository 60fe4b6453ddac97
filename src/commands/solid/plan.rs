//! `bearing plan` of a solid: what each of its commands would do.

use super::{Prepared, mesh_notes, prepare};
use crate::commands::{CommandResult, Outcome, memory, say};
use bearing_dynamics::mesh::Order;
use bearing_dynamics::scene::solid::{MeshSource, SolidRun};
use bearing_dynamics::scene::{Document, SolidScene};
use bearing_dynamics::solver::clock::whole_number;
use bearing_dynamics::solver::solid::explicit::{ExplicitMethod, SolidStepping};
use bearing_dynamics::solver::solid::foretold;
use bearing_dynamics::solver::solid::model::{DampedMotion, SolidModel};
use bearing_dynamics::solver::solid::step_limit::step_limit;
use bearing_dynamics::solver::solid::tangent::{MassMatrix, Unknowns};
use bearing_dynamics::solver::sparse::Cost;

pub fn run(document: &Document, scene: &SolidScene) -> CommandResult {
    let prepared = prepare(document, scene)?;
    let mut lines = lines(scene, &prepared);
    let notes = mesh_notes(&prepared.built);
    lines.extend(notes.iter().map(|note| format!("notes {:<28} {note}", "mesh")));
    let model =
        SolidModel::labelled(prepared.setup.problem.clone(), prepared.setup.labels.clone())?;
    lines.extend(factor_lines(scene, &prepared, &model));
    if let Some(run) = &scene.run {
        lines.push(step_line(&model, run));
    }
    say(&lines.iter().map(|line| format!("{line}\n")).collect::<String>())?;
    Ok(Outcome::Done)
}

fn line(included: bool, name: &str, reason: &str) -> String {
    let mark = if included { "does " } else { "skips" };
    format!("{mark} {name:<28} {reason}")
}

/// The step of a run, what limits it, and how many there are; as the run finds them.
fn step_line(model: &SolidModel, run: &SolidRun) -> String {
    let still = vec![[0.0; 4]; model.mass.len()];
    let limit = step_limit(model, &still, run.method);
    let (step, _) = run.stepping.divide(run.output_interval, limit.step);
    let ratio = step / limit.step;
    let [x, y, z] = limit.at.map(|at| 1e3 * at);
    let bound =
        if limit.is_bound { " (a safe bound: the search for it did not settle)" } else { "" };
    let (name, verdict) = match run.stepping {
        SolidStepping::Fixed(_) if ratio > 1.0 => {
            ("given step", ": WARNING: too long, the run will be refused")
        }
        SolidStepping::Fixed(_) => ("given step", ""),
        SolidStepping::FractionOfLimit(_) => ("step", ""),
    };
    let said = format!(
        "{:.3e} s is {ratio:.3} of the stability limit {:.3e} s{bound}{verdict}; the fastest element \
         is {} at x {x:.3}, y {y:.3}, z {z:.3} mm; {} steps to t = {} s",
        step,
        limit.step,
        model.labels.element(limit.element),
        whole_number(run.end, step),
        run.end
    );
    format!("notes {name:<28} {said}")
}

/// Memory and time of what takes factors of the stiffness, from its structure alone.
fn factor_lines(scene: &SolidScene, prepared: &Prepared, model: &SolidModel) -> Vec<String> {
    let unknowns = Unknowns::new(model);
    let statics = (prepared.free.count == 0).then(|| foretold::statics(model, &unknowns));
    let modes = foretold::modes(model, &unknowns, scene.mode_count);
    let line = |cost: Cost| {
        format!("notes {:<28} {}", format!("{} takes", cost.task.name), memory::text(&cost))
    };
    statics.into_iter().chain([modes]).map(line).collect()
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
