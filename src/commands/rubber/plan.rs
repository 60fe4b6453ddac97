//! `bearing plan` of a solid of rubber: stages of each command.

use super::{Prepared, prepare};
use crate::commands::plan::print_plan;
use crate::commands::plan_step::note;
use crate::commands::solid::mesh_notes;
use crate::commands::solid::plan::{fields_line, from};
use crate::commands::{CommandResult, Outcome, memory};
use bearing_dynamics::numeric::clock::{whole_number, whole_steps};
use bearing_dynamics::plan::{Item, Stage, Subject};
use bearing_dynamics::scene::resolve::solid_scene::{RubberScene, RunSteps, SolidRun};
use bearing_dynamics::scene::{Document, SolidScene};
use bearing_dynamics::solids::memory as needed;
use bearing_dynamics::solids::rubber::plan as rubber;
use bearing_dynamics::solids::rubber::plan::Method;
use bearing_dynamics::solids::rubber::steps::Stepping;

pub fn run(document: &Document, scene: &SolidScene, rubber: &RubberScene) -> CommandResult {
    let prepared = prepare(document, scene, rubber)?;
    let mut lines: Vec<String> =
        mesh_notes(&prepared.built).iter().map(|text| note("mesh", text)).collect();
    if prepared.free.count == 0 {
        lines.push(note("memory", &memory::text(&needed::rubber(&prepared.setup.model))));
        lines.extend(scene.run.as_ref().map(|run| note("steps", &count(run))));
    }
    lines.extend(scene.run.as_ref().map(|run| fields_line(run, &prepared.built.mesh)));
    print_plan(&all_items(scene, rubber, &prepared), &lines)?;
    Ok(Outcome::Done)
}

fn count(run: &SolidRun) -> String {
    let rows = whole_number(run.end, run.output_interval);
    let steps = match run.steps {
        RunSteps::Implicit(Stepping::Fixed(step)) => format!(
            "{}, and one more for each corner of motions and loads within a step",
            rows * whole_steps(run.output_interval, step)
        ),
        _ => format!("at least {rows}, one a row"),
    };
    format!("{steps}; each solves an equilibrium, most with factors of an earlier one")
}

/// Items of a run, or of statics without one.
pub fn items(
    scene: &SolidScene,
    rubber: &RubberScene,
    prepared: &Prepared,
    run: Option<&SolidRun>,
) -> Vec<Item> {
    let problem = &prepared.setup.model.problem;
    let kind = "ten-node tetrahedra with a continuous mean stress";
    let mesh = from(scene, problem.elements.len(), kind);
    let method = match run {
        Some(run) => Method::Steps(steps(run)),
        None => Method::Statics {
            frequencies: rubber.harmonic.as_ref().map_or(0, |asked| asked.frequencies.len()),
        },
    };
    rubber::items(problem, 0, &mesh, &method)
}

fn steps(run: &SolidRun) -> String {
    match run.steps {
        RunSteps::Implicit(Stepping::Accuracy(accuracy)) => {
            format!("to {} s, no inertia, accuracy {accuracy}", run.end)
        }
        RunSteps::Implicit(Stepping::Fixed(step)) => {
            format!("to {} s, no inertia, of {step} s", run.end)
        }
        RunSteps::Explicit { .. } => format!("to {} s", run.end),
    }
}

/// Items of a run, or of statics without one, and one item for each other command.
fn all_items(scene: &SolidScene, rubber: &RubberScene, prepared: &Prepared) -> Vec<Item> {
    let subject = Subject::Solid(0);
    let supported = prepared.free.count == 0;
    let free = format!("free to move {}: rubber needs supports", prepared.free.names());
    let mut items = items(scene, rubber, prepared, scene.run.as_ref());
    if !supported {
        items.retain(|item| !matches!(item.stage, Stage::Implicit | Stage::SolidStatics));
        items.push(Item::skips(Stage::SolidStatics, subject, free));
    } else if scene.run.is_some() {
        let why = "relaxed equilibrium at the end of the run, by `bearing statics`";
        items.push(Item::does(Stage::SolidStatics, subject, why));
        let asked = rubber.harmonic.as_ref();
        items.push(match asked.map(|asked| asked.frequencies.len()) {
            Some(count) => {
                let why = format!("at {count} frequencies, about rest, by `bearing statics`");
                Item::does(Stage::LinearSystem, subject, why)
            }
            None => Item::skips(Stage::LinearSystem, subject, "no [solid.harmonic]"),
        });
    } else {
        items.push(Item::skips(Stage::Implicit, subject, "no `numerics.end`"));
    }
    items.push(Item::skips(Stage::Modes, subject, NO_MODES));
    items
}

pub const NO_MODES: &str = "rubber is solved without inertia, so it has no natural modes";
