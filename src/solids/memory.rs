//! Memory of statics, modes and condensation of a solid, from its structure alone.

use crate::elements::tet10::POINTS;
use crate::kinematics::strain::Sym3;
use crate::numeric::sparse::{Memory, Task};
use crate::solids::modes;
use crate::solids::rubber::model::RubberModel;
use crate::solids::tangent::Unknowns;

/// Right-hand side, old and new displacements (with fourth components), internal and external forces.
const NEWTON_VECTORS: usize = 8;

/// Equilibrium of a solid, with any number of factorisations.
pub fn statics(unknowns: &Unknowns) -> Memory {
    let task = Task {
        name: "statics",
        matrix: unknowns.stored,
        vectors: NEWTON_VECTORS,
        other: 0,
        four_nodes: true,
    };
    Memory::new(&unknowns.elimination, task)
}

/// An equilibrium of a solid of rubber, with the history of its points.
pub fn rubber(model: &RubberModel) -> Memory {
    // DEV S and its rate, the history, and each Maxwell element, now and in a checkpoint.
    let tensors = 2 * (3 + model.problem.material.maxwell.len());
    let task = Task {
        name: "statics",
        matrix: model.unknowns.stored,
        vectors: NEWTON_VECTORS,
        other: size_of::<Sym3>() * POINTS * model.tets.len() * tensors,
        four_nodes: false,
    };
    Memory::new(&model.unknowns.elimination, task)
}

/// The lowest `count` modes.
pub fn modes(unknowns: &Unknowns, count: usize) -> Memory {
    let solves = modes::usual_solves(count).min(unknowns.count.max(1));
    let task = Task {
        name: "modes",
        matrix: unknowns.stored + unknowns.mass_stored,
        // The space itself, a block before and after its solution, the modes found in it.
        vectors: solves + 3 * modes::BLOCK + count,
        other: 0,
        four_nodes: true,
    };
    Memory::new(&unknowns.elimination, task)
}

/// The lowest `count` modes of a factorised solid with supports.
pub fn modes_of_fixed(unknowns: &Unknowns, count: usize) -> Memory {
    let mut memory = modes(unknowns, count);
    memory.task.name = "modes of the housing";
    memory.factor_bytes = 0.0;
    memory
}

/// A solid condensed onto `kept` nodes of its bore, with `columns` solved at once.
pub fn condensed(unknowns: &Unknowns, kept: usize, columns: usize) -> Memory {
    let task = Task {
        name: "condensing the housing",
        matrix: unknowns.stored,
        vectors: 2 * columns + 2,
        other: 8 * kept * kept,
        four_nodes: true,
    };
    Memory::new(&unknowns.elimination, task)
}
