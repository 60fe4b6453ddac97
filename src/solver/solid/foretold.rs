//! What statics, modes and condensing will take in memory and time, without doing any of it.

use super::model::SolidModel;
use super::modes;
use super::rubber::model::RubberModel;
use super::tangent::Unknowns;
use crate::elements::tet10::POINTS;
use crate::kinematics::strain::Sym3;
use crate::mesh::tet_mesh::Elements;
use crate::solver::sparse::{Cost, Task};

/// Tangent stiffness and forces of an element take as long as so many multiplications and additions
/// of dense products.
const OF_FOUR_NODES: f64 = 8e4;
const OF_TEN_NODES: f64 = 1e6;
/// Newton's method on small loads: one factorisation, and the residual falls tenfold or more a step.
const NEWTON_STEPS: usize = 3;
/// Right-hand side, old and new displacements (with fourth components), internal and external forces.
const NEWTON_VECTORS: usize = 8;

fn assembly(model: &SolidModel) -> f64 {
    match &model.problem.elements {
        Elements::Linear(list) => OF_FOUR_NODES * list.len() as f64,
        Elements::Quadratic(list) => OF_TEN_NODES * list.len() as f64,
    }
}

/// Equilibrium under loads that leave the solid nearly linear; each further factorisation takes the
/// same time again, and no more memory.
pub fn statics(model: &SolidModel, unknowns: &Unknowns) -> Cost {
    let task = Task {
        name: "statics",
        factorisations: 1,
        repeats: true,
        passes: NEWTON_STEPS,
        columns: 1,
        matrix: unknowns.stored,
        vectors: NEWTON_VECTORS,
        other: 0,
        operations: assembly(model),
        four_nodes: true,
        traffic: 0.0,
    };
    Cost::new(&unknowns.elimination, task)
}

/// An equilibrium of a solid of rubber, for `name` of it: with what its points keep from step to step.
pub fn rubber(model: &RubberModel, name: &'static str) -> Cost {
    let elements = model.tets.len();
    // DEV S and its rate, what is carried over, and each Maxwell element, now and in a checkpoint.
    let tensors = 2 * (3 + model.problem.material.maxwell.len());
    let task = Task {
        name,
        factorisations: 1,
        repeats: true,
        passes: NEWTON_STEPS,
        columns: 1,
        matrix: model.unknowns.stored,
        vectors: NEWTON_VECTORS,
        other: size_of::<Sym3>() * POINTS * elements * tensors,
        operations: OF_TEN_NODES * elements as f64,
        four_nodes: false,
        traffic: 0.0,
    };
    Cost::new(&model.unknowns.elimination, task)
}

/// The lowest `count` modes.
pub fn modes(model: &SolidModel, unknowns: &Unknowns, count: usize) -> Cost {
    let solves = modes::usual_solves(count).min(unknowns.count.max(1));
    let task = Task {
        name: "modes",
        factorisations: 1,
        repeats: false,
        passes: solves.div_ceil(modes::BLOCK),
        columns: modes::BLOCK,
        matrix: unknowns.stored + unknowns.mass_stored,
        // The space itself, a block before and after its solution, the modes found in it.
        vectors: solves + 3 * modes::BLOCK + count,
        other: 0,
        operations: assembly(model),
        // Each new vector is made orthogonal to all others, twice, and goes five times through the
        // masses, in places picked from it; bytes fitted as those of `Cost::seconds`.
        four_nodes: true,
        traffic: (40 * solves * solves) as f64 * unknowns.count as f64
            + (160 * solves) as f64 * unknowns.mass_stored as f64,
    };
    Cost::new(&unknowns.elimination, task)
}

/// The lowest `count` modes of a solid that is held and has been factorised.
pub fn modes_of_held(model: &SolidModel, unknowns: &Unknowns, count: usize) -> Cost {
    let mut cost = modes(model, unknowns, count);
    cost.task.name = "natural shapes of the housing";
    cost.task.factorisations = 0;
    cost.factor_bytes = 0.0;
    cost
}

/// A solid condensed onto `kept` nodes of its bore, with `columns` solved at once.
pub fn condensed(model: &SolidModel, unknowns: &Unknowns, kept: usize, columns: usize) -> Cost {
    let task = Task {
        name: "condensing the housing",
        factorisations: 1,
        repeats: false,
        passes: kept.div_ceil(columns) + 1,
        columns: columns.min(kept),
        matrix: unknowns.stored,
        vectors: 2 * columns + 2,
        other: 8 * kept * kept,
        operations: assembly(model),
        four_nodes: true,
        traffic: 0.0,
    };
    Cost::new(&unknowns.elimination, task)
}
