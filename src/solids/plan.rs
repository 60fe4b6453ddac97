//! Plan items of a flexible solid, alone or as a housing: loads and solution.

use crate::plan::{Item, Stage, Subject, does};
use crate::solids::model::{DampedMotion, SolidProblem};

/// Solution of a solid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Method {
    Statics,
    Modes,
    /// Steps of a solid alone; the text describes them.
    Steps(String),
    /// Condensed onto its contact nodes.
    QuasiStatic,
    /// Modes that move with the bearing; the items of the motion describe each evaluation.
    Reduced,
    /// Explicit steps, coupled with the bearing.
    Explicit,
}

/// Items of the `index`-th solid, named by `of` unless it is the only one; `mesh` describes its mesh.
pub fn items(
    problem: &SolidProblem,
    index: usize,
    of: Option<&str>,
    mesh: &str,
    method: &Method,
) -> Vec<Item> {
    let subject = Subject::Solid(index);
    let supports = match problem.prescribed.len() {
        0 => Item::skips(Stage::Supports, subject, "nothing is fixed"),
        count => {
            let why = format!("{count} components fixed or moved");
            Item::does(Stage::Supports, subject, why)
        }
    };
    let mut items = vec![Item::does(Stage::Elements, subject, mesh), supports];
    if *method != Method::Reduced {
        items.extend(acting(problem, subject, method));
    }
    let own = match method {
        Method::Statics => {
            let why = "Newton's method, sparse Cholesky factors";
            Some(Item::does(Stage::SolidStatics, subject, why))
        }
        Method::QuasiStatic => {
            let why = "condensed onto its bore; bearing and bore in one equilibrium";
            Some(Item::does(Stage::QuasiStatic, subject, why).costing(1))
        }
        Method::Explicit => {
            let why = "bearing and housing in their own steps, which exchange impulses";
            Some(Item::does(Stage::Explicit, subject, why))
        }
        Method::Steps(said) => {
            let item = Item::does(Stage::Explicit, subject, said.clone());
            return named(items, of).into_iter().chain([item.named(Some("steps"))]).collect();
        }
        Method::Modes | Method::Reduced => None,
    };
    items.extend(own);
    named(items, of)
}

fn named(items: Vec<Item>, of: Option<&str>) -> Vec<Item> {
    items.into_iter().map(|item| item.named(of)).collect()
}

/// Loads, gravity and damping.
fn acting(problem: &SolidProblem, subject: Subject, method: &Method) -> [Item; 3] {
    const OF_MODES: &str = "modes are those of the unloaded solid, undamped";
    let skips = |stage, why: &str| Item::skips(stage, subject, why);
    let does = |stage, why: &str| Item::does(stage, subject, why);
    let loads = match (problem.loads.len(), method) {
        (0, _) => skips(Stage::Loads, "none is given"),
        (_, Method::Modes) => skips(Stage::Loads, OF_MODES),
        (1, _) => does(Stage::Loads, "one, dead"),
        (count, _) => does(Stage::Loads, &format!("{count}, dead")),
    };
    let gravity = match (problem.gravity == [0.0; 3], method) {
        (true, _) => skips(Stage::Gravity, "none is given"),
        (false, Method::Modes) => skips(Stage::Gravity, OF_MODES),
        (false, _) => does(Stage::Gravity, "on every node's mass"),
    };
    let damping = match (problem.damping == 0.0, method) {
        (true, _) => skips(Stage::Damping, "none is given"),
        (false, Method::Modes) => skips(Stage::Damping, OF_MODES),
        (false, Method::Statics | Method::QuasiStatic) => {
            skips(Stage::Damping, "mass-proportional, in steps; nothing moves in an equilibrium")
        }
        (false, _) => match problem.damped_motion {
            DampedMotion::Absolute => does(Stage::Damping, "mass-proportional, of all motion"),
            DampedMotion::RelativeToRigid => {
                does(Stage::Damping, "mass-proportional, of motion relative to the rigid one")
            }
        },
    };
    [loads, gravity, damping]
}

/// Stages of each force evaluation and step of a solid, read from the items.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SolidSteps {
    pub supports: bool,
    pub loads: bool,
    pub gravity: bool,
    pub damping: bool,
}

impl SolidSteps {
    pub fn new(problem: &SolidProblem, method: &Method) -> SolidSteps {
        let items = items(problem, 0, None, "", method);
        let of = |stage| does(&items, stage, Subject::Solid(0));
        SolidSteps {
            supports: of(Stage::Supports),
            loads: of(Stage::Loads),
            gravity: of(Stage::Gravity),
            damping: of(Stage::Damping),
        }
    }
}
