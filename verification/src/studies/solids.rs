//! Tip deflection of a cantilever: four-node and ten-node tetrahedra, mesh by mesh.
//!
//! The time is that from a mesh to the number; meshing is not counted. The reference is the limit of
//! three meshes of ten-node elements.

use bearing_dynamics::mesh::Order;
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::model::{SolidModel, SolidProblem};

use crate::case::CaseError;
use crate::pareto::{ParetoContext, Point, Stopwatch, Study, cheapest_ways};
use crate::solid_bodies::cantilever;
use crate::solids::{constant_load, name_of};

pub const DEFLECTION: Study = Study {
    id: "solid_cantilever_deflection",
    title: "Cantilever, tip deflection",
    error_label: "error of the deflection",
    more_errors: &["difference from Timoshenko's beam"],
    run,
};

/// A variant is repeated for this many seconds, or this many times.
const PATIENCE: f64 = 0.4;
const MOST_REPEATS: usize = 5;

const TEN: [[usize; 3]; 5] = [[5, 1, 2], [10, 1, 2], [20, 1, 2], [40, 2, 4], [80, 4, 8]];
const FOUR: [[usize; 3]; 5] = [[20, 1, 2], [40, 2, 4], [80, 4, 8], [120, 6, 12], [160, 8, 16]];
/// Meshes of [`TEN`] whose cells are halved from one to the next.
const HALVED: [usize; 3] = [2, 3, 4];

/// Tip deflection (m), time of the fastest run (s) and number of runs.
fn timed(problem: &SolidProblem) -> Result<(f64, f64, usize), CaseError> {
    let (mut seconds, mut spent, mut repeats) = (f64::INFINITY, 0.0, 0);
    loop {
        let watch = Stopwatch::start();
        let model = SolidModel::new(problem.clone())?;
        let found = equilibrium(&model, 0.0, &EquilibriumOptions::default())?.displacement;
        let deflection = cantilever::deflection(&problem.loads[0].forces, &found);
        let taken = watch.seconds();
        (seconds, spent, repeats) = (seconds.min(taken), spent + taken, repeats + 1);
        if repeats == MOST_REPEATS || spent > PATIENCE {
            return Ok((deflection, seconds, repeats));
        }
    }
}

fn run(context: &mut ParetoContext) -> Result<(), CaseError> {
    let mut found = Vec::new();
    for (order, meshes) in [(Order::Linear, FOUR), (Order::Quadratic, TEN)] {
        for cells in meshes {
            let (mesh, mut problem) = cantilever::half_beam(order, cells)?;
            problem.loads.push(constant_load(cantilever::tip_load(&mesh)?));
            found.push((name_of(order), mesh.nodes.len(), timed(&problem)?));
        }
    }
    // Richardson's extrapolation: the change by each refinement falls by a constant factor.
    let [coarse, middle, fine] = HALVED.map(|mesh| found[FOUR.len() + mesh].2.0);
    let factor = (middle - coarse) / (fine - middle);
    let limit = fine + (fine - middle) / (factor - 1.0);
    let timoshenko = cantilever::FORCE * cantilever::beam().tip_deflection();
    let difference = |value: f64, reference: f64| (value / reference - 1.0).abs();
    for (series, nodes, (value, seconds, repeats)) in found {
        context.push(Point {
            repeats,
            more_errors: vec![difference(value, timoshenko)],
            ..Point::new(series, &format!("{nodes} nodes"), seconds, difference(value, limit))
        });
    }
    let ways = cheapest_ways(context.points(), "the deflection");
    context.sentence(format!("The {ways}"));
    context.sentence(format!(
        "Reference: three meshes of ten-node elements, each with half the cell size of the one before, \
         extrapolated to {limit:.6e} m (observed order {:.1}; error of the finest mesh {:.1e}).",
        factor.log2(),
        difference(fine, limit)
    ));
    context.sentence(format!(
        "Timoshenko's beam differs from it by {:+.2} %.",
        100.0 * (timoshenko / limit - 1.0)
    ));
    context.sentence(
        "The clamp fixes the in-plane displacement of lines only. Lines carry no load in a continuum, so that \
         refinement changes the deflection by about 1e-5. Errors below 1e-4 only rank meshes.",
    );
    Ok(())
}
