//! The clamped beam: deflection of its tip, first natural frequency.

use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::solids::model::{SolidModel, SolidProblem};

use super::{
    Limit, conclude, explicit_sentence, frequency_by_modes, frequency_by_steps, off, record,
    settle, timed,
};
use crate::case::CaseError;
use crate::pareto::{ParetoContext, Study};
use crate::solid_bodies::cantilever;
use crate::solids::{Vec3, constant_load, name_of};

pub const DEFLECTION: Study = Study {
    id: "solid_cantilever_deflection",
    title: "Cantilever, tip deflection",
    error_label: "error of the deflection",
    more_errors: &["difference from Timoshenko"],
    run: cantilever_deflection,
};

pub const FREQUENCY: Study = Study {
    id: "solid_cantilever_frequency",
    title: "Cantilever, first natural frequency",
    error_label: "error of the frequency",
    more_errors: &["difference from Timoshenko"],
    run: cantilever_frequency,
};

const TEN: [[usize; 3]; 5] = [[5, 1, 2], [10, 1, 2], [20, 1, 2], [40, 2, 4], [80, 4, 8]];
const FOUR: [[usize; 3]; 5] = [[20, 1, 2], [40, 2, 4], [80, 4, 8], [120, 6, 12], [160, 8, 16]];
/// Of [`TEN`], those with cells half as large as the one before.
const HALVED: [usize; 3] = [2, 3, 4];

/// What limits the cantilever's reference.
const LINES: &str = "The clamp holds the section's diagonals alone across the beam. Lines carry no load in a \
                     continuum, so that meshes go on giving way there, by some 1e-5: a rank below 1e-4 is one among \
                     meshes.";

/// First bending mode of Euler's cantilever, with the rotation of its sections.
fn beam_shape(mesh: &TetMesh) -> Vec<Vec3> {
    const ROOT: f64 = 1.875_104_068_711_961;
    let share = (ROOT.cosh() + ROOT.cos()) / (ROOT.sinh() + ROOT.sin());
    let at = |place: &Vec3| {
        let s = ROOT * place[0] / cantilever::LENGTH;
        let deflection = s.cosh() - s.cos() - (s.sinh() - s.sin()) / share;
        let slope = (s.sinh() + s.sin() - (s.cosh() - s.cos()) / share) * ROOT / cantilever::LENGTH;
        [-place[2] * slope, 0.0, deflection]
    };
    mesh.nodes.iter().map(at).collect()
}

fn beside(timoshenko: f64, limit: &Limit) -> String {
    format!("Timoshenko's beam lies {:+.2} % from it.", 100.0 * (timoshenko / limit.value - 1.0))
}

fn cantilever_deflection(context: &mut ParetoContext) -> Result<(), CaseError> {
    let solve = |order, cells| -> Result<(TetMesh, SolidProblem), CaseError> {
        let (mesh, mut problem) = cantilever::half_beam(order, cells)?;
        problem.loads.push(constant_load(cantilever::tip_load(&mesh)?));
        Ok((mesh, problem))
    };
    let deflection = |problem: &SolidProblem| -> Result<f64, CaseError> {
        let model = SolidModel::new(problem.clone())?;
        let found = settle(&model)?;
        Ok(cantilever::deflection(&problem.loads[0].forces, &found))
    };
    let mut all = Vec::new();
    for (order, meshes) in [(Order::Linear, FOUR), (Order::Quadratic, TEN)] {
        for cells in meshes {
            let (mesh, problem) = solve(order, cells)?;
            let series = format!("{}, equilibrium", name_of(order));
            all.push(timed(series, &mesh, || Ok((deflection(&problem)?, None)))?);
        }
    }
    let limit = Limit::new(&all, "tet10, equilibrium", HALVED);
    let timoshenko = cantilever::FORCE * cantilever::beam().tip_deflection();
    record(context, &all, |value| vec![off(value, limit.value), off(value, timoshenko)]);
    conclude(context, "the deflection");
    context.sentence(LINES);
    context.sentence(limit.sentence("m"));
    context.sentence(beside(timoshenko, &limit));
    Ok(())
}

fn cantilever_frequency(context: &mut ParetoContext) -> Result<(), CaseError> {
    let by_modes = |problem: &SolidProblem, mesh: &TetMesh| {
        frequency_by_modes(problem, 0, 1, &beam_shape(mesh))
    };
    let timoshenko = cantilever::beam().frequencies(1)[0];
    let mut all = Vec::new();
    for (order, meshes) in [(Order::Linear, FOUR), (Order::Quadratic, TEN)] {
        for cells in meshes {
            let (mesh, problem) = cantilever::half_beam(order, cells)?;
            let series = format!("{}, modes", name_of(order));
            all.push(timed(series, &mesh, || Ok((by_modes(&problem, &mesh)?, None)))?);
        }
    }
    for (order, meshes) in [(Order::Linear, &FOUR[..3]), (Order::Quadratic, &TEN[..4])] {
        for &cells in meshes {
            let (mesh, problem) = cantilever::half_beam(order, cells)?;
            let shape = beam_shape(&mesh);
            let series = format!("{}, explicit steps", name_of(order));
            let swing = || frequency_by_steps(&problem, &shape, timoshenko);
            all.push(timed(series, &mesh, swing)?);
        }
    }
    let limit = Limit::new(&all, "tet10, modes", HALVED);
    record(context, &all, |value| vec![off(value, limit.value), off(value, timoshenko)]);
    conclude(context, "the frequency");
    context.sentence(LINES);
    context.sentence(limit.sentence("Hz"));
    context.sentence(beside(timoshenko, &limit));
    context.sentence(explicit_sentence());
    Ok(())
}
