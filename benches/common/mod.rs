//! What the benches of solids share: a mesh of a cube, and a timer.

use bearing_dynamics::mesh::generate::bar;
use bearing_dynamics::mesh::numbering::reverse_cuthill_mckee;
use bearing_dynamics::mesh::tet_mesh::TetMesh;
use std::time::Instant;

/// A cube of 100 mm, six tetrahedra a cell, numbered for the cache.
pub fn cube(cells: usize) -> TetMesh {
    let mesh = bar([0.1, 0.1, 0.1], [cells; 3]).expect("a cube").mesh;
    reverse_cuthill_mckee(mesh).mesh
}

/// Least seconds a step over several rounds.
pub fn least(rounds: usize, steps: usize, mut step: impl FnMut(usize)) -> f64 {
    step(steps.min(3));
    (0..rounds)
        .map(|_| {
            let start = Instant::now();
            step(steps);
            start.elapsed().as_secs_f64() / steps as f64
        })
        .fold(f64::INFINITY, f64::min)
}
