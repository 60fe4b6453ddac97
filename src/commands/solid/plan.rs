//! `bearing plan` of a solid: stages of each command.

use super::{Prepared, mesh_notes, prepare};
use crate::commands::plan::print_plan;
use crate::commands::plan_step::note;
use crate::commands::{CommandResult, Outcome, memory, rubber};
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::numeric::clock::whole_number;
use bearing_dynamics::numeric::sparse::Memory;
use bearing_dynamics::output::fields::size::{fields_size, file_bytes};
use bearing_dynamics::plan::{Item, Stage, Subject};
use bearing_dynamics::scene::resolve::solid_scene::{Law, MeshSource, RunSteps, SolidRun};
use bearing_dynamics::scene::{Document, SolidScene};
use bearing_dynamics::solids::explicit::{ExplicitMethod, SolidStepping};
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::plan::Method;
use bearing_dynamics::solids::step_limit::step_limit;
use bearing_dynamics::solids::tangent::{MassMatrix, Unknowns};
use bearing_dynamics::solids::{memory as needed, plan as solid};

pub fn run(document: &Document, scene: &SolidScene) -> CommandResult {
    if let Law::Elastomer(rubber) = &scene.law {
        return rubber::plan::run(document, scene, rubber);
    }
    let prepared = prepare(document, scene)?;
    let mut lines: Vec<String> =
        mesh_notes(&prepared.built).iter().map(|text| note("mesh", text)).collect();
    let model =
        SolidModel::labelled(prepared.setup.problem.clone(), prepared.setup.labels.clone())?;
    lines.extend(memory_lines(scene, &prepared, &model));
    lines.extend(scene.run.as_ref().map(|run| fields_line(run, &prepared.built.mesh)));
    if let Some(run) = &scene.run
        && let RunSteps::Explicit { method, stepping, .. } = run.steps
    {
        lines.push(step_line(&model, (method, stepping), run.output_interval, run.end));
    }
    print_plan(&all_items(scene, &prepared), &lines)?;
    Ok(Outcome::Done)
}

pub fn fields_line(run: &SolidRun, mesh: &TetMesh) -> String {
    let bytes = file_bytes(mesh, false);
    let size = fields_size(run.end, run.output_interval, Some(run.fields_interval), &[bytes]);
    note("fields", &size.to_string())
}

/// Time step of a run, its limit, and the number of steps, as in the run.
fn step_line(
    model: &SolidModel,
    (method, stepping): (ExplicitMethod, SolidStepping),
    interval: f64,
    end: f64,
) -> String {
    let still = vec![[0.0; 4]; model.mass.len()];
    let limit = step_limit(model, &still, method);
    let (step, _) = stepping.divide(interval, limit.step);
    let ratio = step / limit.step;
    let [x, y, z] = limit.at.map(|at| 1e3 * at);
    let bound = if limit.is_bound { " (a safe bound: the iteration did not converge)" } else { "" };
    let (name, verdict) = match stepping {
        SolidStepping::Fixed(_) if ratio > 1.0 => {
            ("given step", ": too long, the run will be refused")
        }
        SolidStepping::Fixed(_) => ("given step", ""),
        SolidStepping::FractionOfLimit(_) => ("step", ""),
    };
    let text = format!(
        "{:.3e} s is {ratio:.3} of the stability limit {:.3e} s{bound}{verdict}; the limiting element \
         is {} at x {x:.3}, y {y:.3}, z {z:.3} mm; {} steps to t = {} s",
        step,
        limit.step,
        model.labels.element(limit.element),
        whole_number(end, step),
        end
    );
    note(name, &text)
}

/// Memory of the methods that factorise the stiffness, from its structure alone.
fn memory_lines(scene: &SolidScene, prepared: &Prepared, model: &SolidModel) -> Vec<String> {
    let unknowns = Unknowns::new(model);
    let statics = (prepared.free.count == 0).then(|| needed::statics(&unknowns));
    let modes = needed::modes(&unknowns, scene.mode_count);
    let line = |of: Memory| note(&format!("memory of {}", of.task.name), &memory::text(&of));
    statics.into_iter().chain([modes]).map(line).collect()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    Statics,
    Modes,
    Run,
}

pub fn items(scene: &SolidScene, prepared: &Prepared, of: Of) -> Vec<Item> {
    let (problem, mesh) = (&prepared.setup.problem, &prepared.built.mesh);
    let kind = match mesh.order() {
        Order::Linear => "constant-strain tetrahedra",
        Order::Quadratic => "ten-node tetrahedra",
    };
    let method = match (of, &scene.run) {
        (Of::Run, Some(run)) => {
            let method = match run.steps {
                RunSteps::Explicit { method: ExplicitMethod::RungeKutta, .. } => {
                    "Runge-Kutta of order 4"
                }
                _ => "central differences",
            };
            Method::Steps(format!("{method} to {} s", run.end))
        }
        (Of::Modes, _) => Method::Modes,
        _ => Method::Statics,
    };
    let mesh = from(scene, mesh.elements.len(), kind);
    let mut items = solid::items(problem, 0, None, &mesh, &method);
    if of == Of::Modes {
        items.push(modes(scene));
    }
    items
}

/// Source, number and kind of the elements.
pub fn from(scene: &SolidScene, count: usize, kind: &str) -> String {
    let from = match &scene.mesh.source {
        MeshSource::File { name, .. } => format!("from {name}"),
        _ => "generated".to_string(),
    };
    format!("{from}: {count} {kind}")
}

fn modes(scene: &SolidScene) -> Item {
    let mass = match scene.mode_mass {
        MassMatrix::Consistent => "consistent",
        MassMatrix::Lumped => "lumped",
    };
    let wanted = format!("the lowest {}, {mass} mass", scene.mode_count);
    Item::does(Stage::Modes, Subject::Solid(0), wanted)
}

/// Items of a run, or of statics without one, and one item for each other command.
fn all_items(scene: &SolidScene, prepared: &Prepared) -> Vec<Item> {
    let subject = Subject::Solid(0);
    let supported = prepared.free.count == 0;
    let of = match (&scene.run, supported) {
        (Some(_), _) => Of::Run,
        (None, true) => Of::Statics,
        (None, false) => Of::Modes,
    };
    let mut items = items(scene, prepared, of);
    if of != Of::Statics {
        let free = format!("free to move {}", prepared.free.names());
        let why = if supported { "Newton's method, sparse Cholesky factors" } else { &free };
        items.push(Item::new(Stage::SolidStatics, subject, supported, why));
    }
    if of != Of::Modes {
        items.push(modes(scene));
    }
    if of != Of::Run {
        let steps = Item::skips(Stage::Explicit, subject, "no `numerics.end`");
        items.push(steps.named(Some("steps")));
    }
    items
}
