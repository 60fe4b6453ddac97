//! Plan items of a solid of rubber, which is solved without inertia.

use crate::plan::{Item, Stage, Subject};
use crate::solids::rubber::model::RubberProblem;

/// Solution of a solid of rubber.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Method {
    /// Relaxed equilibrium, and vibrations at this number of frequencies.
    Statics { frequencies: usize },
    /// Steps; the text describes them.
    Steps(String),
}

/// A bushing in elements between two bodies.
#[derive(Clone, Copy, Debug)]
pub struct Bonded<'n> {
    pub name: &'n str,
    /// Index among the solids of the run.
    pub index: usize,
    pub is_explicit: bool,
    pub elements: usize,
    /// Number of Maxwell elements of its rubber.
    pub terms: usize,
}

/// Items of a bushing in elements.
pub fn bonded(of: &Bonded) -> Vec<Item> {
    let subject = Subject::Solid(of.index);
    let (nodes, stage, way) = match of.is_explicit {
        true => ("four", Stage::Explicit, "explicit steps"),
        false => ("ten", Stage::Implicit, "implicit steps"),
    };
    let mesh =
        format!("{} elements of {nodes} nodes with {} Maxwell elements", of.elements, of.terms);
    let why = format!("{way}, exchanging impulses with the bearing; instead of its springs");
    let items = [Item::does(Stage::Elements, subject, mesh), Item::does(stage, subject, why)];
    items.into_iter().map(|item| item.named(Some(of.name))).collect()
}

/// Items of the `index`-th solid; `mesh` describes its mesh.
pub fn items(problem: &RubberProblem, index: usize, mesh: &str, method: &Method) -> Vec<Item> {
    let subject = Subject::Solid(index);
    let either = |stage, does: bool, why: String| Item::new(stage, subject, does, why);
    let supports = match problem.prescribed.len() {
        0 => either(Stage::Supports, false, "nothing is fixed".into()),
        count => either(Stage::Supports, true, format!("{count} components fixed or moved")),
    };
    let loads = match problem.loads.len() {
        0 => either(Stage::Loads, false, "none is given".into()),
        1 => either(Stage::Loads, true, "one, dead; weight included".into()),
        count => either(Stage::Loads, true, format!("{count}, dead; weight included")),
    };
    let viscous = match (problem.material.maxwell.len(), method) {
        (0, _) => either(Stage::Maxwell, false, "none is given: the network alone".into()),
        (_, Method::Statics { frequencies: 0 }) => {
            either(Stage::Maxwell, false, "relaxed: the network alone".into())
        }
        (count, Method::Statics { .. }) => {
            either(Stage::Maxwell, true, format!("{count} at every point, in vibrations alone"))
        }
        (count, Method::Steps(_)) => {
            either(Stage::Maxwell, true, format!("{count} at every point"))
        }
    };
    let mut items = vec![Item::does(Stage::Elements, subject, mesh), supports, loads, viscous];
    match method {
        Method::Statics { frequencies } => {
            let why =
                "relaxed equilibrium: implicit steps, Newton's method, sparse Cholesky factors";
            items.push(Item::does(Stage::SolidStatics, subject, why));
            items.push(match frequencies {
                0 => Item::skips(Stage::LinearSystem, subject, "no [solid.harmonic]"),
                1 => Item::does(Stage::LinearSystem, subject, "at one frequency, about rest"),
                count => {
                    let why = format!("at {count} frequencies, about rest");
                    Item::does(Stage::LinearSystem, subject, why)
                }
            });
        }
        Method::Steps(how) => items.push(Item::does(Stage::Implicit, subject, how.clone())),
    }
    items
}
