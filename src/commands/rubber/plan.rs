//! `bearing plan` of a solid of rubber: what each of its commands would do.

use super::{Prepared, prepare};
use crate::commands::plan::say_plan;
use crate::commands::plan_step::note;
use crate::commands::solid::mesh_notes;
use crate::commands::solid::plan::{fields_line, from};
use crate::commands::{CommandResult, Outcome, memory};
use bearing_dynamics::scene::solid::{RubberScene, RunSteps, SolidRun};
use bearing_dynamics::scene::{Document, SolidScene};
use bearing_dynamics::solver::clock::{whole_number, whole_steps};
use bearing_dynamics::solver::plan::rubber::{self, Method};
use bearing_dynamics::solver::plan::{Item, Stage, Subject};
use bearing_dynamics::solver::solid::foretold;
use bearing_dynamics::solver::solid::rubber::steps::Stepping;

pub fn run(document: &Document, scene: &SolidScene, rubber: &RubberScene) -> CommandResult {
    let prepared = prepare(document, scene, rubber)?;
    let mut lines: Vec<String> =
        mesh_notes(&prepared.built).iter().map(|said| note("mesh", said)).collect();
    if prepared.free.count == 0 {
        let cost = foretold::rubber(&prepared.setup.model, "an equilibrium");
        lines.push(note("an equilibrium takes", &memory::text(&cost)));
        lines.push(note("equilibria at rest", WAY));
        let rows = scene.run.as_ref().map(|run| whole_number(run.end, run.output_interval));
        if let Some(rows) = rows {
            let number = match scene.run.as_ref().map(|run| (run.steps, run.output_interval)) {
                Some((RunSteps::Implicit(Stepping::Fixed(step)), interval)) => format!(
                    "{}, and one more for each corner of motions and loads that lies within one",
                    rows * whole_steps(interval, step)
                ),
                _ => format!("{rows} at least, one a row"),
            };
            let said = format!(
                "{number}; each takes an equilibrium, most with the factors of an earlier one"
            );
            lines.push(note("steps", &said));
            lines.push(note("factorisations", &factorisations(&prepared, scene.run.as_ref())));
        } else {
            let vibrations =
                if rubber.harmonic.is_some() { "; one more for all vibrations" } else { "" };
            let said = format!("2 or more{vibrations}");
            lines.push(note("factorisations", &said));
        }
    }
    lines.extend(scene.run.as_ref().map(|run| fields_line(run, &prepared.built.mesh)));
    say_plan(&all_items(scene, rubber, &prepared), &lines)?;
    Ok(Outcome::Done)
}

/// How many factorisations the equilibrium of `bearing statics` takes, which nobody knows before it is found.
const WAY: &str = "their way is taken in parts in which strains change by 2 % or less, two or three factorisations each: a few where strains \
                   stay below a per cent, hundreds where they reach a tenth, as in a thin wall";

/// How many there will be at least: a step at the start and behind each corner of what drives the body begins with
/// its own.
fn factorisations(prepared: &Prepared, run: Option<&SolidRun>) -> String {
    let end = run.map_or(0.0, |run| run.end);
    let corners = prepared.setup.model.corners();
    let corners = corners.iter().filter(|corner| (0.0..end).contains(*corner) && **corner > 0.0);
    let corners = corners.count();
    format!(
        "{} at least: one at the start, one behind each of {corners} corners of motions and loads; one more where \
         steps change so much that an earlier one serves no longer, or the body bends",
        corners + 1
    )
}

/// Items of a run, or without one of statics.
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

/// Items of a run, or of statics of what has none, and in a line each what the other commands would do.
fn all_items(scene: &SolidScene, rubber: &RubberScene, prepared: &Prepared) -> Vec<Item> {
    let subject = Subject::Solid(0);
    let held = prepared.free.count == 0;
    let free = format!("free to move {}: rubber must be held", prepared.free.names());
    let mut items = items(scene, rubber, prepared, scene.run.as_ref());
    if !held {
        items.retain(|item| !matches!(item.stage, Stage::Implicit | Stage::SolidStatics));
        items.push(Item::skips(Stage::SolidStatics, subject, free));
    } else if scene.run.is_some() {
        let why = "relaxed equilibrium at the end of the run, by `bearing statics`";
        items.push(Item::does(Stage::SolidStatics, subject, why));
        let asked = rubber.harmonic.as_ref();
        items.push(match asked.map(|asked| asked.frequencies.len()) {
            Some(count) => {
                let why = format!("at {count} frequencies, about rest, by `bearing statics`");
                Item::does(Stage::Vibrations, subject, why)
            }
            None => Item::skips(Stage::Vibrations, subject, "no [solid.harmonic]"),
        });
    } else {
        items.push(Item::skips(Stage::Implicit, subject, "no `numerics.end`"));
    }
    items.push(Item::skips(Stage::Modes, subject, NO_MODES));
    items
}

pub const NO_MODES: &str = "rubber is solved without inertia, and has no natural modes";
