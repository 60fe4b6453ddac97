//! A clamped beam: tip deflection and bending frequencies against Timoshenko's equations.

use bearing_dynamics::kinematics::strain::von_mises;
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::model::{SolidModel, SolidProblem};
use bearing_dynamics::solids::modes::{Mode, ModeOptions, modes};
use bearing_dynamics::solids::stress::nodal_stresses;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::solid_bodies::cantilever;
use crate::solids::{Vec3, constant_load, name_of, prescribe};
use crate::surface_picture::{SurfacePicture, surface_picture};

pub const CASE: Case = Case {
    id: "cantilever_timoshenko",
    title: "Cantilever: deflection and bending frequencies",
    section: "2.2.2, (2.2)–(2.6)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Element and cells across the half width.
const MESHES: [(Order, usize); 5] = [
    (Order::Quadratic, 1),
    (Order::Quadratic, 2),
    (Order::Linear, 1),
    (Order::Linear, 2),
    (Order::Linear, 4),
];

struct Answer {
    deflection: f64,
    frequencies: Vec<f64>,
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let beam = cantilever::beam();
    let mut exact = vec![cantilever::FORCE * beam.tip_deflection()];
    exact.extend(beam.frequencies(3));
    let mut rows = Vec::new();
    for (order, across) in MESHES {
        let (mesh, problem) = half_beam(order, across)?;
        let answer = solve(&mesh, problem)?;
        let mut found = vec![answer.deflection];
        found.extend(&answer.frequencies);
        let off: Vec<f64> = found.iter().zip(&exact).map(|(a, b)| a / b - 1.0).collect();
        let mut row = vec![name_of(order).to_string(), mesh.nodes.len().to_string()];
        row.extend(off.iter().map(|x| format!("{:+.3}", 100.0 * x)));
        rows.push(row);
        if (order, across) == (Order::Quadratic, 2) {
            checks(context, &found, &exact, mesh.nodes.len());
        }
        if (order, across) == (Order::Linear, 4) {
            context.golden("tet4_deflection_off", off[0], "1", GoldenTolerance::MIXED);
            context.check(
                Check::new(
                    "tet4_too_stiff",
                    "tet4, 8 cells across the height: deflection over Timoshenko's",
                    "1",
                    1.0 + off[0],
                )
                .closed_form(1.0, "Timoshenko")
                .at_most(0.01, "one stress per element cannot follow bending; such a mesh stays some percent too stiff"),
            );
        }
    }
    context.table(
        "errors",
        &format!(
            "Difference from Timoshenko in percent, length over height 10, shear coefficient {:.4}; half \
             of the beam is meshed (symmetry)",
            beam.shear_coefficient
        ),
        &["element", "nodes", "deflection", "mode 1", "mode 2", "mode 3"],
        rows,
    );
    pictures(context)?;
    context.finding(
        "clamp",
        format!(
            "The clamp holds the axial displacement of the whole end, the vertical one on the section's two \
             diagonals, where a bent section's own change of shape leaves it zero, and nothing else: \
             Poisson contraction stays free. With all components held the first frequency would be {:+.2} % off \
             Timoshenko's.",
            100.0 * (fully_clamped()? / exact[1] - 1.0)
        ),
    );
    Ok(())
}

fn checks(context: &mut CaseContext, found: &[f64], exact: &[f64], nodes: usize) {
    let names = [
        ("tip_deflection", "tip deflection under 0.5 N", "m", 5e-4),
        ("mode_1", "first bending frequency", "Hz", 5e-4),
        ("mode_2", "second bending frequency", "Hz", 3e-3),
        ("mode_3", "third bending frequency", "Hz", 5e-3),
    ];
    for (i, (id, text, unit, tolerance)) in names.into_iter().enumerate() {
        context.check(
            Check::new(id, &format!("tet10, {nodes} nodes: {text}"), unit, found[i])
                .closed_form(exact[i], "Timoshenko's beam, Hutchinson's shear coefficient")
                .relative(
                    tolerance,
                    "beam equations leave terms of fourth order in height over wave length and the \
                     warping that the clamp stops",
                )
                .golden(GoldenTolerance::MIXED),
        );
    }
}

fn half_beam(order: Order, across: usize) -> Result<(TetMesh, SolidProblem), CaseError> {
    cantilever::half_beam(order, [20 * across.min(2), across, 2 * across])
}

/// First bending frequency with every component of the end held, Hz.
fn fully_clamped() -> Result<f64, CaseError> {
    let (mesh, mut problem) = half_beam(Order::Quadratic, 2)?;
    problem.prescribed.clear();
    prescribe(&mut problem, |[x, y, _]| {
        let clamped = x < 1e-9;
        [clamped.then_some(0.0), (clamped || y < 1e-9).then_some(0.0), clamped.then_some(0.0)]
    });
    Ok(bending_modes(&problem, &mesh)?[0].frequency)
}

fn solve(mesh: &TetMesh, mut problem: SolidProblem) -> Result<Answer, CaseError> {
    let found = bending_modes(&problem, mesh)?;
    let end = cantilever::tip_load(mesh)?;
    problem.loads.push(constant_load(end.clone()));
    let bent = equilibrium(&SolidModel::new(problem)?, 0.0, &EquilibriumOptions::default())?;
    let deflection = cantilever::deflection(&end, &bent.displacement);
    let frequencies = found.iter().map(|mode| mode.frequency).collect();
    Ok(Answer { deflection, frequencies })
}

/// The lowest three modes whose tip moves across the beam; its first stretching mode lies among them.
fn bending_modes(problem: &SolidProblem, mesh: &TetMesh) -> Result<Vec<Mode>, CaseError> {
    let found = modes(&SolidModel::new(problem.clone())?, &ModeOptions::new(5))?;
    let tip = mesh.node_set("x_high")?;
    let moved = |mode: &Mode, axis: usize| -> f64 {
        tip.iter().map(|n| mode.shape[*n as usize][axis].powi(2)).sum()
    };
    Ok(found.modes.into_iter().filter(|mode| moved(mode, 2) > moved(mode, 0)).take(3).collect())
}

fn pictures(context: &mut CaseContext) -> Result<(), CaseError> {
    let (mesh, mut problem) = half_beam(Order::Quadratic, 2)?;
    let found = bending_modes(&problem, &mesh)?;
    problem.loads.push(constant_load(cantilever::tip_load(&mesh)?));
    let model = SolidModel::new(problem)?;
    let bent = equilibrium(&model, 0.0, &EquilibriumOptions::default())?;
    let stress: Vec<f64> =
        nodal_stresses(&model, &bent.displacement).iter().map(|t| 1e-6 * von_mises(t)).collect();
    let enlarged = |shape: &[Vec3], tip: f64| -> Vec<Vec3> {
        let largest = shape.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        shape.iter().map(|u| u.map(|x| x * tip / largest)).collect()
    };
    let draw = |displacement: &[Vec3], values: &[f64], label: &str| {
        surface_picture(&SurfacePicture {
            mesh: &mesh,
            displacement,
            values,
            label,
            azimuth: -65.0,
            elevation: 18.0,
        })
    };
    context.figure(
        "von_mises",
        draw(&enlarged(&bent.displacement, 0.01), &stress, "von Mises stress, MPa"),
        "The half beam under its tip load, deflection enlarged; outlines: undeformed. Stress falls from the \
         clamp to the tip and vanishes on the neutral plane but for shear.",
    );
    let shape = &found[2].shape;
    let size: Vec<f64> =
        shape.iter().map(|u| u.iter().map(|x| x * x).sum::<f64>().sqrt()).collect();
    let largest = size.iter().fold(0.0f64, |m, x| m.max(*x));
    let size: Vec<f64> = size.iter().map(|x| x / largest).collect();
    context.figure(
        "mode_3_shape",
        draw(&enlarged(shape, 0.012), &size, "size of displacement, largest = 1"),
        "Third bending mode of the half beam; two nodal sections besides the clamp.",
    );
    Ok(())
}
