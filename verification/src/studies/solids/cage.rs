//! The cage of Table 5.3 as printed: how a pressure ovals it, first natural frequency.

use bearing_dynamics::mesh::generate::CageMesh;
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::solids::model::{SolidModel, SolidProblem};

use super::ring::oval_shape;
use super::{
    Limit, conclude, explicit_sentence, frequency_by_modes, frequency_by_steps, off, record,
    settle, timed, work_of_loads,
};
use crate::case::CaseError;
use crate::pareto::{ParetoContext, Study};
use crate::solid_bodies::cage;
use crate::solids::{
    STEEL, Vec3, constant_load, free_body, mesh_of, name_of, prescribe, surface_force,
};

pub const DEFLECTION: Study = Study {
    id: "solid_cage_deflection",
    title: "Cage of Table 5.3, work of a pressure that ovals it",
    error_label: "error of the work",
    more_errors: &[],
    run: cage_deflection,
};

pub const FREQUENCY: Study = Study {
    id: "solid_cage_frequency",
    title: "Free cage of Table 5.3, first natural frequency",
    error_label: "error of the frequency",
    more_errors: &[],
    run: cage_frequency,
};

const TEN: [CageMesh; 5] = [
    CageMesh { quarter: 2, bar: 1, wall: 1 },
    CageMesh { quarter: 3, bar: 2, wall: 1 },
    CageMesh { quarter: 4, bar: 2, wall: 2 },
    CageMesh { quarter: 6, bar: 3, wall: 2 },
    CageMesh { quarter: 8, bar: 4, wall: 4 },
];
const FOUR: [CageMesh; 4] = [
    CageMesh { quarter: 2, bar: 1, wall: 1 },
    CageMesh { quarter: 4, bar: 2, wall: 2 },
    CageMesh { quarter: 8, bar: 4, wall: 4 },
    CageMesh { quarter: 10, bar: 5, wall: 5 },
];
/// Of [`TEN`], those with cells half as large as the one before.
const HALVED: [usize; 3] = [0, 2, 4];

/// First pair in the plane, Hz, as the case `cage_modes_table_5_3` has it.
const OTHER_PROGRAMS: f64 = 2271.5;

fn cage_deflection(context: &mut ParetoContext) -> Result<(), CaseError> {
    let body = |order, cells: &CageMesh| -> Result<(TetMesh, SolidProblem), CaseError> {
        let mesh = mesh_of(&cage::LITERAL.solid(cells)?, order)?;
        let mut problem = free_body(&mesh, STEEL);
        hold_lightly(&mut problem, &mesh)?;
        let oval = |[_, y, z]: Vec3, normal: Vec3| {
            let pressure = 1e4 * (2.0 * z.atan2(y)).cos();
            normal.map(|n| pressure * n)
        };
        let load = surface_force(&mesh, mesh.surface_set("outer")?, oval);
        problem.loads.push(constant_load(load));
        Ok((mesh, problem))
    };
    let work = |problem: &SolidProblem| -> Result<f64, CaseError> {
        let model = SolidModel::new(problem.clone())?;
        let found = settle(&model)?;
        Ok(work_of_loads(&model, &found))
    };
    let mut all = Vec::new();
    for (order, meshes) in [(Order::Linear, &FOUR[..]), (Order::Quadratic, &TEN)] {
        for cells in meshes {
            let (mesh, problem) = body(order, cells)?;
            let series = format!("{}, equilibrium", name_of(order));
            all.push(timed(series, &mesh, || Ok((work(&problem)?, None)))?);
        }
    }
    let limit = Limit::new(&all, "tet10, equilibrium", HALVED);
    record(context, &all, |value| vec![off(value, limit.value)]);
    conclude(context, "the work");
    context.sentence(limit.sentence("J"));
    context.sentence("Pressure of up to 10 kPa as cos 2θ on the outer surface; nothing holds the cage but three nodes that carry nothing.");
    Ok(())
}

/// Three nodes hold a body whose loads balance: no support carries anything.
fn hold_lightly(problem: &mut SolidProblem, mesh: &TetMesh) -> Result<(), CaseError> {
    let outer = mesh.node_set("outer")?;
    let extreme = |along: Vec3| {
        let height = |node: &&u32| {
            let x = mesh.nodes[**node as usize];
            x[0] * along[0] + x[1] * along[1] + x[2] * along[2]
        };
        outer.iter().max_by(|a, b| height(a).total_cmp(&height(b))).copied()
    };
    let found = [[0.01, 1.0, 0.0], [0.01, -1.0, 0.0], [0.01, 0.0, 1.0]].map(extreme);
    let [Some(right), Some(left), Some(top)] = found else {
        return Err(CaseError::message("the cage has no outer surface"));
    };
    let places = [right, left, top].map(|node| mesh.nodes[node as usize]);
    prescribe(problem, |place| {
        let still = |held: bool| held.then_some(0.0);
        let [at_right, at_left, at_top] = places.map(|held| held == place);
        [still(at_right || at_left || at_top), still(at_right), still(at_right || at_left)]
    });
    Ok(())
}

fn cage_frequency(context: &mut ParetoContext) -> Result<(), CaseError> {
    let mean = 0.5 * (cage::LITERAL.inner_radius + cage::LITERAL.outer_radius);
    let body = |order, cells: &CageMesh| -> Result<(TetMesh, SolidProblem), CaseError> {
        let mesh = mesh_of(&cage::LITERAL.solid(cells)?, order)?;
        let problem = free_body(&mesh, STEEL);
        Ok((mesh, problem))
    };
    let by_modes = |problem: &SolidProblem, mesh: &TetMesh| {
        frequency_by_modes(problem, 6, 2, &oval_shape(mesh, mean))
    };
    let mut all = Vec::new();
    for (order, meshes) in [(Order::Linear, &FOUR[..]), (Order::Quadratic, &TEN)] {
        for cells in meshes {
            let (mesh, problem) = body(order, cells)?;
            let series = format!("{}, modes", name_of(order));
            all.push(timed(series, &mesh, || Ok((by_modes(&problem, &mesh)?, None)))?);
        }
    }
    for (order, meshes) in [(Order::Linear, &FOUR[..3]), (Order::Quadratic, &TEN[..3])] {
        for cells in meshes {
            let (mesh, problem) = body(order, cells)?;
            let shape = oval_shape(&mesh, mean);
            let series = format!("{}, explicit steps", name_of(order));
            let swing = || frequency_by_steps(&problem, &shape, OTHER_PROGRAMS);
            all.push(timed(series, &mesh, swing)?);
        }
    }
    let limit = Limit::new(&all, "tet10, modes", HALVED);
    record(context, &all, |value| vec![off(value, limit.value)]);
    conclude(context, "the frequency");
    context.sentence(limit.sentence("Hz"));
    let apart = 100.0 * (OTHER_PROGRAMS / limit.value - 1.0);
    context.sentence(format!(
        "Two other finite-element programs, converged, have {OTHER_PROGRAMS} Hz, {apart:+.2} % from it."
    ));
    context.sentence(explicit_sentence());
    Ok(())
}
